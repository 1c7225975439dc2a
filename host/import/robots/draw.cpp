// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The geoms of a robot as shapes.
#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "base/check.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/robot.h"
#include "import/import.h"
#include "scene/texture_image.h"

namespace caplet {

namespace {

class Drawing {
 public:
  Drawing(Scene& scene, const ImageReader& images, const glm::dmat4& world) : scene_(scene), images_(images), world_(world) {}

  void add(const RobotGeom& geom) {
    if (!(geom.rgba.a > 0)) return;
    switch (geom.kind) {
      case GeomKind::sphere:
        return add(geom, SphereShape{geom.size.x}, glm::dmat4(1));
      case GeomKind::capsule: {
        const auto h = static_cast<float>(geom.size.y);
        return add(geom, CapsulesShape{{{0, 0, -h}}, {{0, 0, h}}, {static_cast<float>(geom.size.x)}, {}, {}}, glm::dmat4(1));
      }
      case GeomKind::cylinder:
        return add(geom, CylinderShape{{0, 0, -geom.size.y}, {0, 0, geom.size.y}, geom.size.x}, glm::dmat4(1));
      case GeomKind::box:
        return add(geom, BoxShape{-geom.size, geom.size}, glm::dmat4(1));
      case GeomKind::mesh:
        return add_mesh(geom);
    }
  }

 private:
  std::uint32_t material(const glm::dvec4& rgba) {
    const auto [entry, fresh] = materials_.try_emplace({rgba.r, rgba.g, rgba.b}, narrow<std::uint32_t>(scene_.materials.size()));
    const auto linear = [](double v) { return decoded_value({}, std::clamp(v, 0.0, 1.0)); };
    if (fresh)
      scene_.materials.push_back({DiffuseMaterial{RgbSpectrum{{linear(rgba.r), linear(rgba.g), linear(rgba.b)}}},
                                  "color " + std::to_string(materials_.size()),
                                  {scene_.source, 0, 0}});
    return entry->second;
  }

  void add(const RobotGeom& geom, Geometry geometry, const glm::dmat4& geom_from_shape) {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.name = geom.name;
    shape.where = geom.where;
    shape.world_from_object = world_ * geom.world * geom_from_shape;
    shape.material = material(geom.rgba);
    if (geom.rgba.a < 1) shape.alpha = TextureOperand(geom.rgba.a);
    scene_.shapes.push_back(std::move(shape));
  }

  void add_mesh(const RobotGeom& geom) {
    std::error_code ignored;
    std::string extension = geom.mesh.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (extension != ".stl" && extension != ".obj") {
      Diagnostics().warning(geom.where, "the mesh '" + geom.mesh.string() + "' is left out: STL and OBJ are read");
      return;
    }
    if (!std::filesystem::exists(geom.mesh, ignored)) {
      Diagnostics().warning(geom.where, "the mesh '" + geom.mesh.string() + "' is left out: no such file");
      return;
    }
    for (const Geometry& part : meshes_of(geom.mesh)) add(geom, part, glm::scale(glm::dmat4(1), geom.size));
  }

  /// The meshes of a file, which is read once.
  const std::vector<Geometry>& meshes_of(const std::filesystem::path& path) {
    const auto [entry, fresh] = meshes_.try_emplace(path.string());
    if (fresh) {
      ImportOptions as_it_is;
      as_it_is.set("up", "y");
      Scene file = read_scene(path, images_, as_it_is).scene;
      for (Shape& part : file.shapes)
        if (std::holds_alternative<TriangleMeshShape>(part.geometry)) entry->second.push_back(std::move(part.geometry));
    }
    return entry->second;
  }

  Scene& scene_;
  const ImageReader& images_;
  glm::dmat4 world_;
  std::map<std::array<double, 3>, std::uint32_t> materials_;
  std::map<std::string, std::vector<Geometry>> meshes_;
};

}  // namespace

Scene import_urdf(const std::filesystem::path& path, const ImageReader& images, const ImportOptions& options) {
  Scene scene;
  scene.source = path.string();
  const Robot robot = read_urdf(path, Pose(options));
  enum Groups : std::size_t { visual, collision, all };
  const std::size_t groups = options.choice("groups", {"visual", "collision", "all"}, visual);
  Drawing drawing(scene, images, world_from_file(options, "z"));
  for (const RobotGeom& geom : robot.geoms)
    if (groups == all || geom.collides == (groups == collision)) drawing.add(geom);
  if (scene.shapes.empty()) throw InputError({scene.source, 0, 0}, "holds no geometry of the groups that are asked for");
  return scene;
}

}  // namespace caplet
