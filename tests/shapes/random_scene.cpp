// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "random_scene.h"

#include <fmt/format.h>

#include <memory>

namespace caplet::test {

using glm::dmat4;
using glm::dvec3;

namespace {

/// Returns uvs for half of the meshes of four vertices.
std::vector<glm::vec2> own_uvs(double r) {
  if (r < 0.6) return {};
  return {{0.1f, 0.2f}, {0.9f, -0.3f}, {-0.2f, 2}, {1.5f, 2.5f}};
}

void keep_first(CapsulesShape& capsules) {
  const auto keep = [](auto& values) {
    if (values.size() > 1) values.erase(values.begin() + 1, values.end());
  };
  keep(capsules.p0);
  keep(capsules.p1);
  keep(capsules.radius0);
  keep(capsules.radius1);
  keep(capsules.u);
}

}  // namespace

decltype(Shape::geometry) SceneMaker::geometry(int kind) {
  const double r = uniform(0.2, 1);
  const glm::vec3 a(direction()), b(direction()), c(direction());
  const auto f = static_cast<float>(r);
  switch (kind) {
    case 0:
      return SphereShape{r};
    case 1:
      // Half of them are chains.
      return CapsulesShape{
          {a, b},
          {b, c},
          {0.3f * f, 0.2f * f},
          {0.3f * f, 0.4f * f},
          {},
          r < 0.6 ? std::vector<glm::vec2>{} : std::vector<glm::vec2>{{-0.5f, f}, {f, 3}}};
    case 2:
      return TriangleMeshShape{{a, b, c, -a}, {{0, 1, 2}, {1, 2, 3}}, {}, own_uvs(r)};
    case 3:
      return DiskShape{uniform(-1, 1), r, 0, full_turn};
    case 4:
      return DiskShape{uniform(-1, 1), r, 0.3 * r, uniform(1, 6)};
    case 5:
      return CylinderShape{direction(), dvec3(0), 0.5 * r, {cap(), cap()}};
    case 6:
      return ConeShape{direction(), dvec3(0), {r, below(3) == 0 ? 0 : 0.4 * r}, {cap(), cap()}};
    case 7:
      return BoxShape{-r * dvec3(1, 0.5, 0.3), r * dvec3(0.2, 0.4, 0.6)};
    case 8:
      return PolyhedronShape{
          {dvec3(-r), dvec3(-r), dvec3(-r), dvec3(0.3 * r), dvec3(0, 0, 0.5 * r)},
          {{-1, 0, 0}, {0, -2, 0}, {0, 0, -1}, {1, 1, 1}, {0.1, 0.2, 1}}};
    case 9:
      return PartialSphereShape{r, -0.6 * r, 0.8 * r, uniform(2, 6)};
    case 10:
      return OpenCylinderShape{0.5 * r, -r, 0.7 * r, uniform(2, 6)};
    case 11:
      return BilinearMeshShape{{a, b, c, glm::vec3(direction())}, {{0, 1, 2, 3}}, {}, own_uvs(r)};
    case 12:
      return make_molecule({0.5f * a, 0.5f * b, 0.5f * c}, {0.5f * f, 0.4f * f, 0.3f * f}, 0.5 * r);
    default: {
      CsgShape csg;
      csg.operation = static_cast<CsgShape::Operation>(below(3));
      for (const int operand : {0, 7, 8, 1}) {
        auto one = std::make_shared<Shape>();
        one->geometry = geometry(operand);
        if (auto* capsules = std::get_if<CapsulesShape>(&one->geometry)) keep_first(*capsules);
        one->world_from_object = glm::translate(dmat4(1), 0.3 * r * direction());
        one->material = static_cast<std::uint32_t>(below(20));
        csg.operands.push_back(one);
      }
      return csg;
    }
  }
}

Scene random_scene(std::uint32_t seed) {
  SceneMaker make(seed);
  Scene scene;
  for (int i = 0; i < 20; ++i)
    scene.materials.push_back({DiffuseMaterial{}, fmt::format("{}", i), {}});
  for (int i = 0; i < SceneMaker::kinds; ++i) scene.shapes.push_back(make.shape(i));
  for (int i = 0; i < 5; ++i) {
    Object object;
    object.name = fmt::format("object {}", i);
    for (int k = 0; k < 3; ++k)
      object.shapes.push_back(make.shape((3 * i + k) % SceneMaker::kinds));
    scene.objects.push_back(object);
    for (int k = make.below(2); k < 2; ++k)
      scene.instances.push_back({static_cast<std::uint32_t>(i), make.placement(4), {}});
  }
  return scene;
}

}  // namespace caplet::test
