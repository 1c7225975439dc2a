// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shape statements with the full geometry. A new geometry does not compile without its own
// function.
#include <algorithm>
#include <numbers>

#include "export/detail/families.h"
#include "scene/part_materials.h"

namespace caplet::pbrt_text {

namespace {

constexpr const char* cap_names[] = {"flat", "round", "open"};

/// Writes the parameters of shapes whose model names its fields.
struct WriteFields : Fields {
  explicit WriteFields(Statement& statement) : to(statement) {}
  Statement& to;
  void corners(const char* name0, const char* name1, glm::dvec3& p0, glm::dvec3& p1) override {
    to.point(name0, p0);
    to.point(name1, p1);
  }
  void positive(const char* name, double& value) override { to.number(name, value); }
};

struct GeometryWriter {
  const Shape& shape;
  const ShapeReferences& references;

  Statement begin(const char* type) const {
    return {std::string("Shape \"") + type + "\"", "shape", shape.where};
  }

  template <FieldedShape Type>
  Statement write(const Type& of, const char* name) const {
    Statement out = begin(name);
    Type copy = of;
    WriteFields each(out);
    fields(copy, each);
    return out;
  }

  Statement write(const SphereShape& of, const char*) const {
    Statement out = begin("sphere");
    out.number("radius", of.radius);
    return out;
  }
  Statement write(const PartialSphereShape& of, const char*) const {
    const bool is_within = of.z_min >= -of.radius && of.z_max <= of.radius;
    if (!is_within || (of.z_min == -of.radius && of.z_max == of.radius && of.phi_max == full_turn))
      refuse(shape.where, "the part of a sphere is no part");
    Statement out = begin("sphere");
    part(out, of);
    return out;
  }
  Statement write(const OpenCylinderShape& of, const char*) const {
    Statement out = begin("cylinder");
    part(out, of);
    return out;
  }
  Statement write(const DiskShape& of, const char*) const {
    Statement out = begin("disk");
    out.number("radius", of.radius);
    if (of.height != 0) out.number("height", of.height);
    if (of.inner_radius != 0) out.number("innerradius", of.inner_radius);
    phi(out, of.phi_max);
    return out;
  }
  Statement write(const CylinderShape& of, const char*) const {
    Statement out = begin("cylinder");
    ends(out, of);
    out.number("radius", of.radius);
    return out;
  }
  Statement write(const ConeShape& of, const char*) const {
    Statement out = begin("cone");
    ends(out, of);
    out.numbers("float", "radius", {of.radius[0], of.radius[1]});
    return out;
  }
  Statement write(const PolyhedronShape& of, const char*) const {
    Statement out = begin("polyhedron");
    points(out, "point3", "P", of.points);
    points(out, "normal", "N", of.normals);
    return out;
  }
  Statement write(const TriangleMeshShape& of, const char*) const {
    Statement out = begin("trianglemesh");
    key_times(out, of.times);
    mesh(out, of, of.triangles);
    return out;
  }
  Statement write(const BilinearMeshShape& of, const char*) const {
    Statement out = begin("bilinearmesh");
    mesh(out, of, of.patches);
    return out;
  }
  Statement write(const CsgShape& of, const char*) const {
    static constexpr const char* operations[] = {"union", "intersection", "difference"};
    Statement out = begin("csg");
    out.text("operation", operations[static_cast<std::size_t>(of.operation)]);
    std::vector<std::string> operands;
    for (std::size_t i = 0; i < of.operands.size(); ++i)
      operands.push_back(references.operand(of, i));
    out.texts("operands", operands);
    return out;
  }
  Statement write(const CapsulesShape& of, const char*) const {
    if (of.p0.size() == 1) return one_capsule(of);
    Statement out = begin("capsules");
    key_times(out, of.times);
    points(out, "point3", "p0", of.p0);
    points(out, "point3", "p1", of.p1);
    floats(out, "radius", of.radius0);
    if (of.radius1 != of.radius0) floats(out, "radius1", of.radius1);
    chain(out, of);
    listed_materials(out, "capsulematerials", of.materials);
    return out;
  }
  Statement write(const MolecularSurfaceShape& of, const char*) const {
    Statement out = begin("molecularsurface");
    points(out, "point3", "P", of.centers);
    floats(out, "radius", of.radii);
    out.number("probe", of.probe);
    listed_materials(out, "ballmaterials", of.materials);
    return out;
  }

 private:
  /// Lists each material that is used once, and which of them each thing has.
  void listed_materials(Statement& to, const char* list,
                        const std::vector<std::uint32_t>& materials) const {
    if (materials.empty()) return;
    constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> place(references.scene.materials.size(), none);
    std::vector<std::string> used;
    for (const std::uint32_t material : materials)
      if (place[material] == none) {
        place[material] = static_cast<std::uint32_t>(used.size());
        used.push_back(references.names.materials[material]);
      }
    to.texts(list, used);
    to.list("integer", "materialindices", materials.size(),
            [&materials, place = std::move(place)](Text& text, std::size_t i) {
              text << std::int64_t{place[materials[i]]};
            });
  }
  Statement one_capsule(const CapsulesShape& of) const {
    Statement out = begin("capsule");
    points(out, "point3", "p0", of.p0);
    points(out, "point3", "p1", of.p1);
    const bool is_tapered = !of.radius1.empty() && of.radius1[0] != of.radius0[0];
    out.list("float", "radius", is_tapered ? 2 : 1, [&of](Text& text, std::size_t i) {
      text << (i == 0 ? of.radius0[0] : of.radius1[0]);
    });
    chain(out, of);
    return out;
  }
  static void chain(Statement& to, const CapsulesShape& of) {
    to.list("float", "u", 2 * of.u.size(), [&of](Text& text, std::size_t i) {
      text << (i % 2 == 0 ? of.u[i / 2].x : of.u[i / 2].y);
    });
  }
  template <class Part>
  static void part(Statement& to, const Part& of) {
    to.number("radius", of.radius);
    to.number("zmin", of.z_min);
    to.number("zmax", of.z_max);
    phi(to, of.phi_max);
  }
  static void phi(Statement& to, double phi_max) {
    if (phi_max < full_turn) to.number("phimax", degrees_of(phi_max));
  }
  template <class Solid>
  static void ends(Statement& to, const Solid& of) {
    to.point("p0", of.p0);
    to.point("p1", of.p1);
    if (of.caps[0] == Cap::flat && of.caps[1] == Cap::flat) return;
    to.texts("caps", {cap_names[static_cast<std::size_t>(of.caps[0])],
                      cap_names[static_cast<std::size_t>(of.caps[1])]});
  }
  template <class Points>
  static void points(Statement& to, const char* type, const char* name, const Points& of) {
    to.list(type, name, of.size(), [&of](Text& text, std::size_t i) {
      text << of[i].x << " " << of[i].y << " " << of[i].z;
    });
  }
  static void key_times(Statement& to, const std::vector<double>& times) {
    to.list("float", "times", times.size(),
            [&times](Text& text, std::size_t i) { text << times[i]; });
  }
  static void floats(Statement& to, const char* name, const std::vector<float>& of) {
    to.list("float", name, of.size(), [&of](Text& text, std::size_t i) { text << of[i]; });
  }
  template <class Mesh, class Faces>
  static void mesh(Statement& to, const Mesh& of, const Faces& faces) {
    points(to, "point3", "P", of.positions);
    to.list("integer", "indices", faces.size(), [&faces](Text& text, std::size_t i) {
      for (std::size_t k = 0; k < faces[i].size(); ++k) {
        if (k > 0) text << " ";
        text << std::int64_t{faces[i][k]};
      }
    });
    points(to, "normal", "N", of.normals);
    to.list("point2", "uv", of.uvs.size(),
            [&of](Text& text, std::size_t i) { text << of.uvs[i].x << " " << of.uvs[i].y; });
  }
};

bool any_hair(const Scene& scene, const Shape& shape) {
  const auto hair = [&](std::uint32_t material) {
    return std::holds_alternative<HairMaterial>(scene.materials[material].model);
  };
  if (hair(shape.material) || std::ranges::any_of(shape.materials, hair)) return true;
  if (const auto* parts = part_materials(shape)) return std::ranges::any_of(*parts, hair);
  const auto* csg = std::get_if<CsgShape>(&shape.geometry);
  return csg && std::ranges::any_of(csg->operands,
                                    [&](const auto& operand) { return any_hair(scene, *operand); });
}

}  // namespace

bool is_hair(const Scene& scene, const Shape& shape) {
  return is_closed(shape) && any_hair(scene, shape);
}

Statement shape_statement(const Shape& shape, const ShapeReferences& references, bool as_operand) {
  const auto& [geometry, world_from_object, material, materials, alpha, is_backdrop, one_sided,
               emission, reversed, media, name, where] = shape;
  const GeometryWriter writer{shape, references};
  static constexpr const char* types[] = {
#define GEOMETRY(Type, row) #row,
#include "scene/geometries.def"
  };
  const char* const type =
      types[geometry.index()];  // clang 14 cannot capture a structured binding in a lambda
  Statement out = std::visit([&](const auto& own) { return writer.write(own, type); }, geometry);
  if (!name.empty()) out.text("name", name);
  if (!materials.empty()) {
    std::vector<std::string> all;
    all.reserve(materials.size());
    for (const std::uint32_t one : materials) all.push_back(references.names.materials[one]);
    out.texts("materials", all);
  }
  if (as_operand) return out;
  if (one_sided != is_hair(references.scene, shape)) out.boolean("onesided", one_sided);
  if (alpha && alpha->texture) out.texture("alpha", references.names.textures[*alpha->texture]);
  if (alpha && !alpha->texture) out.number("alpha", std::get<ConstantSpectrum>(alpha->value).value);
  return out;
}

}  // namespace caplet::pbrt_text
