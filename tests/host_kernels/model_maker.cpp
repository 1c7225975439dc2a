// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "host_kernels/model_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace caplet::test {

const char* ModelMaker::kind_name(unsigned kind) {
  static constexpr std::array<const char*, kinds> names = {
      "sphere", "capsule",    "tapered_capsule", "triangle",      "disk",     "cylinder", "cone",
      "box",    "polyhedron", "partial_sphere",  "open_cylinder", "bilinear", "csg"};
  return names[kind];
}

glm::dvec3 ModelMaker::point() {
  const double x = numbers_.coordinate(), y = numbers_.coordinate(), z = numbers_.coordinate();
  return {x, y, z};
}

/// Half of them none; moved, turned and stretched by columns; or any matrix at all.
glm::dmat4 ModelMaker::transform() {
  glm::dmat4 m(1);
  switch (numbers_.below(6)) {
    case 0:
      return glm::translate(m, point());
    case 1:
      m = glm::rotate(glm::translate(m, point()), full_turn * numbers_.fraction(),
                      glm::dvec3(0.6, 0, 0.8));
      return glm::scale(m, glm::dvec3{numbers_.length(), numbers_.length(), numbers_.length()});
    case 2:
      for (int column = 0; column < 4; ++column)
        m[column] = glm::dvec4(point(), column == 3 ? 1 : 0);
      return m;
    default:
      return m;
  }
}

Spectrum ModelMaker::spectrum(double greatest) {
  switch (numbers_.below(4)) {
    case 0:
      return ConstantSpectrum{greatest * numbers_.fraction()};
    case 1:
      return RgbSpectrum{{greatest * numbers_.fraction(), greatest * numbers_.fraction(),
                          greatest * numbers_.fraction()},
                         {}};
    case 2:
      return SampledSpectrum{{400, 500 + 100 * numbers_.fraction()},
                             {greatest * numbers_.fraction(), greatest}};
    default:
      return ConstantSpectrum{greatest};
  }
}

template <class Mesh, std::size_t corners>
void ModelMaker::mesh(Mesh& out, std::vector<std::array<std::uint32_t, corners>>& faces) {
  const unsigned vertices = corners + numbers_.below(3);
  for (unsigned i = 0; i < vertices; ++i) out.positions.push_back(small_point());
  if (numbers_.below(2) == 0)
    for (unsigned i = 0; i < vertices; ++i) out.normals.push_back(small_point());
  if (numbers_.below(2) == 0)
    for (unsigned i = 0; i < vertices; ++i) out.uvs.push_back(glm::vec2(point()));
  faces.resize(1 + numbers_.below(2));
  for (auto& face : faces)
    for (std::size_t i = 0; i < corners; ++i)
      face[i] = (static_cast<std::uint32_t>(i) + numbers_.below(vertices)) % vertices;
  for (std::uint32_t i = 0; i < corners; ++i) faces[0][i] = i;
}

/// A box around a point, and planes that cut it.
PolyhedronShape ModelMaker::polyhedron() {
  PolyhedronShape out;
  const glm::dvec3 center = point();
  for (int side = 0; side < 6; ++side) {
    glm::dvec3 normal(0);
    normal[side / 2] = side % 2 ? 1 : -1;
    out.points.push_back(center + numbers_.length() * normal);
    out.normals.push_back(normal);
  }
  for (unsigned more = numbers_.below(4); more > 0; --more) {
    const glm::dvec3 normal = point();
    out.points.push_back(center + numbers_.length() * normal);
    out.normals.push_back(normal);
  }
  return out;
}

CsgShape ModelMaker::csg(int depth) {
  CsgShape out;
  out.operation = static_cast<CsgShape::Operation>(numbers_.below(3));
  const unsigned count = 2 + numbers_.below(2);
  for (unsigned i = 0; i < count; ++i) {
    constexpr unsigned closed[] = {0, 1, 2, 5, 6, 7, 8};
    auto operand = std::make_shared<Shape>();
    if (depth > 0 && numbers_.below(4) == 0)
      operand->geometry = csg(depth - 1);
    else
      operand->geometry = geometry(closed[numbers_.below(std::size(closed))]);
    operand->world_from_object = transform();
    out.operands.push_back(std::move(operand));
  }
  return out;
}

decltype(Shape::geometry) ModelMaker::geometry(unsigned kind) {
  switch (kind) {
    case 0:
      return SphereShape{numbers_.length()};
    case 1:
    case 2: {
      CapsulesShape out;
      out.p0 = {small_point()};
      out.p1 = {small_point()};
      out.radius0 = {static_cast<float>(numbers_.length())};
      if (kind == 2) out.radius1 = {static_cast<float>(numbers_.length())};
      if (numbers_.below(2) == 0) out.u = {glm::vec2{numbers_.coordinate(), numbers_.coordinate()}};
      return out;
    }
    case 3: {
      TriangleMeshShape out;
      mesh(out, out.triangles);
      return out;
    }
    case 4: {
      DiskShape out{numbers_.coordinate(), numbers_.length(), 0, full_turn};
      if (numbers_.below(2) == 0) out.inner_radius = out.radius * numbers_.fraction();
      if (numbers_.below(2) == 0) out.phi_max = full_turn * numbers_.fraction();
      return out;
    }
    case 5: {
      CylinderShape out{point(), point(), numbers_.length(), {cap(), cap()}};
      return out;
    }
    case 6: {
      ConeShape out{point(), point(), {numbers_.length(), numbers_.length()}, {cap(), cap()}};
      if (numbers_.below(4) == 0) out.radius[0] = 0;
      return out;
    }
    case 7:
      return BoxShape{point(), point()};
    case 8:
      return polyhedron();
    case 9:
    case 10: {
      const double a = numbers_.coordinate(), b = numbers_.coordinate(), radius = numbers_.length();
      const double phi = numbers_.below(2) == 0 ? full_turn : full_turn * numbers_.fraction();
      if (kind == 9) return PartialSphereShape{radius, std::min(a, b), std::max(a, b), phi};
      return OpenCylinderShape{radius, std::min(a, b), std::max(a, b), phi};
    }
    case 11: {
      BilinearMeshShape out;
      mesh(out, out.patches);
      return out;
    }
    default:
      return csg(1);
  }
}

Shape ModelMaker::shape(unsigned kind) {
  Shape out;
  out.geometry = geometry(kind);
  out.world_from_object = transform();
  out.material = numbers_.below(materials_);
  if (numbers_.below(4) == 0)
    for (std::size_t i = 0; i < surface_count(out); ++i)
      out.materials.push_back(numbers_.below(materials_));
  out.one_sided = numbers_.below(4) == 0;
  out.reverse_orientation = numbers_.below(4) == 0;
  if (numbers_.below(3) == 0) {
    AreaEmission emission;
    emission.radiance = spectrum(10);
    emission.two_sided = numbers_.below(2) == 0;
    if (numbers_.below(4) == 0)
      emission.surfaces = {
          numbers_.below(static_cast<unsigned>(std::max<std::size_t>(1, surface_count(out))))};
    out.emission = emission;
  }
  return out;
}

Material ModelMaker::material() {
  Material out;
  const double u = numbers_.fraction(), v = numbers_.below(2) == 0 ? u : numbers_.fraction();
  const auto layer = [&] {
    CoatLayer coat;
    coat.thickness = numbers_.fraction();
    coat.albedo = spectrum(1);
    coat.g = 1.8 * numbers_.fraction() - 0.9;
    coat.max_depth = static_cast<int>(numbers_.below(20));
    return coat;
  };
  switch (numbers_.below(9)) {
    case 8: {
      PrincipledMaterial made{spectrum(1), u, v};
      made.anisotropic = numbers_.fraction();
      made.eta = 1 + v;
      made.spec_tint = u;
      made.spec_trans = numbers_.fraction();
      made.sheen = made.coat_roughness = v;
      made.sheen_tint = made.coat = numbers_.fraction();
      made.coat_color = spectrum(1);
      out.model = made;
      break;
    }
    case 0:
      out.model = DiffuseMaterial{spectrum(1)};
      break;
    case 2:
      out.model = ThinDielectricMaterial{spectrum(2)};
      break;
    case 3:
      out.model = DiffuseTransmissionMaterial{spectrum(1), spectrum(1), numbers_.fraction()};
      break;
    case 4:
      out.model = CoatedDiffuseMaterial{spectrum(1), spectrum(2), u, v, layer()};
      break;
    case 5:
      out.model = CoatedConductorMaterial{spectrum(2),  u, v, spectrum(4), spectrum(4),
                                          std::nullopt, v, u, layer()};
      break;
    case 6:
      out.model = HairMaterial{spectrum(4), std::nullopt, 1 + u, u, v, 4 * v};
      break;
    case 1:
      out.model = ConductorMaterial{spectrum(4), spectrum(4), std::nullopt, u, v};
      break;
    default:
      out.model = DielectricMaterial{spectrum(2), u, v};
      break;
  }
  return out;
}

Light ModelMaker::light() {
  Light out;
  const auto unit = [&] {
    const double z = 2 * numbers_.fraction() - 1, phi = full_turn * numbers_.fraction(),
                 r = std::sqrt(std::max(0.0, 1 - z * z));
    return glm::dvec3(r * std::cos(phi), r * std::sin(phi), z);
  };
  const auto image = [&](int width, int height) {
    auto made = std::make_shared<EnvironmentImage>();
    made->width = width;
    made->height = height;
    made->equal_area = width == height;
    for (int i = 0; i < 3 * width * height; ++i)
      made->rgb.push_back(static_cast<float>(numbers_.fraction()));
    return made;
  };
  switch (numbers_.below(5)) {
    case 0:
      out.model = PointLight{spectrum(10), point()};
      break;
    case 1:
      out.model =
          SpotLight{spectrum(10), point(), unit(), numbers_.fraction(), numbers_.fraction()};
      break;
    case 2:
      out.model = DistantLight{spectrum(10), unit()};
      break;
    case 3:
      switch (numbers_.below(5)) {
        case 1:
          out.model = GoniometricLight{spectrum(10), image(2, 2), point(), glm::dmat3(1)};
          break;
        case 2:
          out.model =
              ProjectionLight{image(2, 1), 1 + 170 * numbers_.fraction(), point(), glm::dmat3(1)};
          break;
        case 3:
          out.model = IesLight{spectrum(10),
                               std::make_shared<IesProfile>(IesProfile{
                                   {0, 1 + numbers_.fraction()}, {0}, {numbers_.fraction(), 1}}),
                               point(), glm::dmat3(1)};
          break;
        case 4: {
          const glm::dvec3 corner = point(), x(numbers_.length(), 0, 0), y(0, numbers_.length(), 0);
          InfiniteLight model{spectrum(10), nullptr, glm::dmat3(1),
                              LightPortal{corner, corner + y, corner + x + y, corner + x}};
          if (numbers_.below(2) == 0) model.image = image(2, 2);
          out.model = model;
          break;
        }
        default:
          out.model = InfiniteLight{spectrum(10), nullptr, glm::dmat3(1), {}};
      }
      break;
    default: {
      const bool square = numbers_.below(2) == 0;
      out.model = InfiniteLight{ConstantSpectrum{1}, image(2, square ? 2 : 1), glm::dmat3(1), {}};
      break;
    }
  }
  return out;
}

Scene ModelMaker::scene(unsigned kind, unsigned count) {
  Scene out;
  materials_ = 1 + numbers_.below(3);
  for (unsigned i = 0; i < materials_; ++i) out.materials.push_back(material());
  const bool instanced = numbers_.below(3) == 0;
  for (unsigned i = 0; i < count; ++i) {
    const unsigned this_kind =
        kind < kinds ? kind : numbers_.below(kind == simple_kinds ? csg_kind : kinds);
    if (instanced && i % 2 == 0) {
      if (out.objects.empty()) out.objects.emplace_back();
      out.objects[0].shapes.push_back(shape(this_kind));
    } else {
      out.shapes.push_back(shape(this_kind));
    }
  }
  if (instanced)
    for (unsigned i = 0; i <= numbers_.below(2); ++i) out.instances.push_back({0, transform(), {}});
  for (unsigned i = numbers_.below(3); i > 0; --i) out.lights.push_back(light());
  out.view.film.width = out.view.film.height = 16;
  return out;
}

}  // namespace caplet::test
