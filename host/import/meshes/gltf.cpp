// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// glTF 2.0 and GLB: nodes, meshes (instanced where nodes share them or move), metallic-roughness
// materials, cameras, lights, animations.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "base/check.h"
#include "import/detail/gltf.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "present/open_shutter.h"

namespace caplet {

namespace {

constexpr std::size_t kDeepestChild = 256;      // nesting of nodes
constexpr std::size_t kMostNodes = 10'000'000;  // placed nodes; shared children count each time
constexpr double kLumensPerWatt = 683;          // as in Blender's exporter
constexpr double kExposure = 0.02;              // seconds, of a file that moves
constexpr double kHighestPicture = 65535;       // pixels, of an orthographic camera's window

using Json = nlohmann::json;

class GltfReader {
 public:
  GltfReader(gltf::File file, const ImageReader& reader, const ImportOptions& options)
      : file_(std::move(file)),
        json_(file_.json),
        options_(options),
        materials_(file_, scene_, reader),
        animation_(file_),
        bending_(file_, animation_, world_) {
    scene_.source = file_.path.string();
    scene_.unit = "m";
  }

  Imported read() {
    file_.check_version();
    const Json& nodes = file_.list("nodes");
    std::vector<std::size_t> roots;
    const Json& scenes = file_.list("scenes");
    if (!scenes.empty()) {
      const std::size_t which = file_.index(json_, "scene", scenes.size(), "scene").value_or(0);
      for (const Json& root : file_.list_of(scenes[which], "nodes"))
        roots.push_back(file_.index_value(root, nodes.size(), "node"));
    } else {
      for (std::size_t i = 0; i < nodes.size(); ++i) roots.push_back(i);
    }
    const glm::dmat4 world = world_from_file(options_, "y");
    scene_.world_from_file = glm::dmat3(world);
    world_ = world;
    for (const std::size_t root : roots) visit(root, world, 0);
    place_meshes();
    if (scene_.shapes.empty() && scene_.instances.empty()) file_.fail("holds no triangles");
    const bool is_lit = !scene_.lights.empty() || (emits_ && camera_);
    if (camera_) scene_.view.camera = *camera_;
    if (moves_) expose(scene_.view.film, kExposure);
    Imported out(std::move(scene_));
    out.has_camera = camera_.has_value();
    out.is_lit = is_lit;
    return out;
  }

 private:
  void visit(std::size_t index, const glm::dmat4& parent, std::size_t depth) {
    if (depth > kDeepestChild)
      file_.fail(fmt::format("node {} lies within more than {} others: are there cycles?", index,
                             kDeepestChild));
    if (++visited_ > kMostNodes) too_many();
    const Json& node = file_.list("nodes")[index];
    chain_.push_back(index);
    glm::dmat4 world = parent * file_.transform_of(node);
    TransformKeys keys = animation_.keys(chain_, world_);
    if (!keys.empty()) world = keys.front().matrix;
    if (keys.size() < 2) keys.clear();
    const std::string name = file_.text(node, "name", "");
    if (const auto mesh = file_.index(node, "mesh", file_.list("meshes").size(), "mesh")) {
      if (!bending_.bends(index))
        for (const glm::dmat4& copy : copies_of(node)) {
          Placed& placed = placed_[*mesh].emplace_back(Placed{world * copy, name, keys});
          for (TransformKey& key : placed.motion) key.matrix *= copy;
          if (++visited_ > kMostNodes) too_many();
        }
      else if (bending_.has_skin(index))  // whose vertices are in the world
        place_mesh(*mesh, index, {{glm::dmat4(1), name, {}}});
      else
        place_mesh(*mesh, index, {{world, name, keys}});
    }
    if (const auto camera = file_.index(node, "camera", file_.list("cameras").size(), "camera");
        camera && !camera_)
      add_camera(file_.list("cameras")[*camera], world, keys);
    add_light(node, world);
    for (const Json& child : file_.list_of(node, "children"))
      visit(file_.index_value(child, file_.list("nodes").size(), "node"), world, depth + 1);
    chain_.pop_back();
  }

  [[noreturn]] void too_many() const {
    file_.fail(fmt::format("more than {} nodes are placed", kMostNodes));
  }

  /// Returns where a node's mesh is placed in its space: once, or as EXT_mesh_gpu_instancing says.
  std::vector<glm::dmat4> copies_of(const Json& node) {
    const Json& from = file_.object(file_.extension(node, "EXT_mesh_gpu_instancing"), "attributes");
    const std::size_t accessors = file_.list("accessors").size();
    std::vector<gltf::Parts> parts;
    const auto read = [&]<class Vector>(const char* name, Vector, const auto& set) {
      const auto accessor = file_.index(from, name, accessors, "accessor");
      if (!accessor) return;
      const std::vector<Vector> values = file_.vectors<Vector>(*accessor);
      if (parts.empty()) parts.resize(values.size());
      if (parts.size() != values.size())
        file_.fail(fmt::format("{} places and {} values of {} of instances", parts.size(),
                               values.size(), name));
      for (std::size_t i = 0; i < values.size(); ++i) set(parts[i], values[i]);
    };
    read("TRANSLATION", glm::vec3(),
         [](gltf::Parts& to, const glm::vec3& value) { to.translation = value; });
    read("SCALE", glm::vec3(), [](gltf::Parts& to, const glm::vec3& value) { to.scale = value; });
    read("ROTATION", glm::vec4(), [&](gltf::Parts& to, const glm::vec4& value) {
      if (!(glm::length(value) > 0)) file_.fail("a rotation is no quaternion");
      const glm::dvec4 q = glm::normalize(glm::dvec4(value));
      to.rotation = glm::dquat(q.w, q.x, q.y, q.z);
    });
    std::vector<glm::dmat4> out;
    for (const gltf::Parts& one : parts) out.push_back(one.matrix());
    if (!from.contains("TRANSLATION") && !from.contains("ROTATION") && !from.contains("SCALE"))
      out.emplace_back(1);
    return out;
  }

  void add_camera(const Json& camera, const glm::dmat4& world, const TransformKeys& keys) {
    Camera out = scene_.view.camera;
    if (file_.text(camera, "type", "") == "orthographic") {
      const Json& window = file_.object(camera, "orthographic");
      const double x = std::abs(file_.number(window, "xmag", 1)),
                   y = std::abs(file_.number(window, "ymag", 1));
      const double height = std::round(scene_.view.film.width * y / x);
      if (!(height >= 1 && height <= kHighestPicture))
        file_.fail("a camera's xmag and ymag are no window");
      out.projection = OrthographicProjection{};
      out.screen_window = {-x, x, -y, y};
      scene_.view.film.height = static_cast<int>(height);
    } else {
      const double fov = file_.number(file_.object(camera, "perspective"), "yfov", 0.8);
      if (!(fov > 0 && fov < 3.1)) file_.fail("a camera's yfov is not within 0 and pi");
      out.projection = PerspectiveProjection{fov};
    }
    // glTF's camera looks along -z, ours along +z.
    const auto rigid = [](const glm::dmat4& node) {
      glm::dmat4 turned(1);
      for (int k = 0; k < 3; ++k) turned[k] = glm::dvec4(glm::normalize(glm::dvec3(node[k])), 0);
      turned[3] = node[3];
      return glm::scale(turned, glm::dvec3(1, 1, -1));
    };
    out.world_from_camera = rigid(world);
    for (const TransformKey& key : keys) out.motion.push_back({key.time, rigid(key.matrix)});
    moves_ |= !keys.empty();
    camera_ = out;
  }

  void add_light(const Json& node, const glm::dmat4& world) {
    const Json& of_node = file_.extension(node, "KHR_lights_punctual");
    const Json& all = file_.list_of(file_.extension(json_, "KHR_lights_punctual"), "lights");
    const auto index = file_.index(of_node, "light", all.size(), "light");
    if (!index) return;
    const Json& from = all[*index];
    const double intensity = file_.number(from, "intensity", 1) / kLumensPerWatt;
    const RgbSpectrum color{file_.vector(from, "color", glm::dvec3(1))};
    const glm::dvec3 position(world[3]), direction(glm::normalize(glm::dvec3(-world[2])));
    Light light;
    light.where = {scene_.source, 0, 0};
    light.scale = intensity;
    const std::string type = file_.text(from, "type", "");
    if (type == "point") {
      light.model = PointLight{color, position};
    } else if (type == "directional") {
      light.model = DistantLight{color, direction};
    } else if (type == "spot") {
      const Json& spot = file_.object(from, "spot");
      SpotLight model;
      model.intensity = color;
      model.position = position;
      model.direction = direction;
      model.total_angle =
          std::clamp(file_.number(spot, "outerConeAngle", 0.7853981633974483), 1e-3, 1.5707);
      model.falloff_start_angle =
          std::clamp(file_.number(spot, "innerConeAngle", 0), 0.0, model.total_angle);
      light.model = model;
    } else {
      file_.fail("a light of type '" + type + "'");
    }
    scene_.lights.push_back(std::move(light));
  }

  struct Placed {
    glm::dmat4 world;
    std::string name;
    TransformKeys motion;
  };

  void place_meshes() {
    for (auto& [mesh, places] : placed_) place_mesh(mesh, std::nullopt, std::move(places));
  }

  /// `bent`: the node that moves the mesh's vertices.
  void place_mesh(std::size_t mesh, std::optional<std::size_t> bent, std::vector<Placed> places) {
    std::vector<Shape> shapes = shapes_of(mesh, bent);
    if (shapes.empty()) return;
    for (const Shape& shape : shapes) {
      emits_ |= shape.emission.has_value();
      moves_ |= !key_times(shape).empty();
    }
    if (places.size() == 1 && !places[0].name.empty())
      for (Shape& shape : shapes) shape.name = places[0].name;
    if (places.size() == 1 && places[0].motion.empty()) {
      for (Shape& shape : shapes) {
        shape.world_from_object = places[0].world;
        scene_.shapes.push_back(std::move(shape));
      }
      return;
    }
    Object object;
    object.name = shapes[0].name;
    object.where = {scene_.source, 0, 0};
    object.shapes = std::move(shapes);
    for (Placed& place : places) {
      moves_ |= !place.motion.empty();
      scene_.instances.push_back({narrow<std::uint32_t>(scene_.objects.size()), place.world,
                                  object.where, std::move(place.motion)});
    }
    scene_.objects.push_back(std::move(object));
  }

  std::vector<Shape> shapes_of(std::size_t index, std::optional<std::size_t> bent) {
    const Json& mesh = file_.list("meshes")[index];
    std::vector<Shape> out;
    for (const Json& primitive : file_.list_of(mesh, "primitives")) {
      TriangleMeshShape triangles = mesh_of(primitive);
      if (triangles.triangles.empty()) continue;
      if (bent) bending_.bend(*bent, primitive, triangles);
      const gltf::MeshMaterial look = materials_.look(
          file_.index(primitive, "material", file_.list("materials").size(), "material"));
      Shape shape =
          mesh_shape(std::move(triangles), file_.text(mesh, "name", fmt::format("mesh {}", index)),
                     look.material, {scene_.source, 0, 0});
      shape.emission = look.emission;
      shape.alpha = look.alpha;
      color(shape, primitive);
      out.push_back(std::move(shape));
    }
    return out;
  }

  /// Multiplies COLOR_0 by the material's colour.
  void color(Shape& shape, const Json& primitive) {
    const auto accessor = file_.index(file_.object(primitive, "attributes"), "COLOR_0",
                                      file_.list("accessors").size(), "accessor");
    if (!accessor) return;
    const auto& mesh = std::get<TriangleMeshShape>(shape.geometry);
    const std::vector<glm::vec3> given = file_.colors(*accessor);
    if (given.size() != vertex_count(mesh))
      file_.fail("a mesh has another number of colours than of positions");
    std::vector<glm::vec3> corners;
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) corners.push_back(given[vertex]);
    if (!color_corners(scene_, shape, std::move(corners)))
      Diagnostics().warning(shape.where, "the colours of the vertices of '" + shape.name +
                                             "' are left out: its material has textures");
  }

  TriangleMeshShape mesh_of(const Json& primitive) {
    TriangleMeshShape mesh;
    const Json& attributes = file_.object(primitive, "attributes");
    const std::size_t accessors = file_.list("accessors").size();
    const auto positions = file_.index(attributes, "POSITION", accessors, "accessor");
    const double mode = file_.number(primitive, "mode", 4);
    if (!positions) return mesh;
    if (mode < 4) {
      Diagnostics().warning({scene_.source, 0, 0}, "points and lines of a mesh are left out");
      return mesh;
    }
    mesh.positions = file_.vectors<glm::vec3>(*positions);
    const std::size_t count = mesh.positions.size();
    if (const auto normals = file_.index(attributes, "NORMAL", accessors, "accessor"))
      mesh.normals = file_.vectors<glm::vec3>(*normals);
    if (const auto uvs = file_.index(attributes, "TEXCOORD_0", accessors, "accessor"))
      mesh.uvs = file_.vectors<glm::vec2>(*uvs);
    for (glm::vec2& uv : mesh.uvs) uv.y = 1 - uv.y;  // glTF's v starts at the top
    if ((!mesh.normals.empty() && mesh.normals.size() != count) ||
        (!mesh.uvs.empty() && mesh.uvs.size() != count))
      file_.fail("a mesh has another number of normals or texture coordinates than of positions");
    std::vector<std::uint32_t> indices;
    if (const auto accessor = file_.index(primitive, "indices", accessors, "accessor"))
      indices = file_.indices(*accessor);
    else
      for (std::uint32_t i = 0; i < count; ++i) indices.push_back(i);
    for (const std::uint32_t i : indices)
      if (i >= count) file_.fail(fmt::format("a mesh has the index {}, but {} vertices", i, count));
    add_triangles(indices, mode, mesh);
    return mesh;
  }

  static void add_triangles(const std::vector<std::uint32_t>& indices, double mode,
                            TriangleMeshShape& mesh) {
    if (mode == 4)
      for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    else if (mode == 5)
      for (std::size_t i = 0; i + 2 < indices.size(); ++i)
        mesh.triangles.push_back({indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]});
    else
      for (std::size_t i = 1; i + 1 < indices.size(); ++i)
        mesh.triangles.push_back({indices[0], indices[i], indices[i + 1]});
  }

  gltf::File file_;
  const Json& json_;
  const ImportOptions& options_;
  Scene scene_;
  gltf::Materials materials_;
  gltf::Animation animation_;
  glm::dmat4 world_{1};
  gltf::Bending bending_;
  std::vector<std::size_t> chain_;  // the node that is visited, behind all that it lies within
  bool moves_ = false;
  std::optional<Camera> camera_;
  std::map<std::size_t, std::vector<Placed>> placed_;
  std::size_t visited_ = 0;
  bool emits_ = false;
};

}  // namespace

Imported import_gltf(const std::filesystem::path& path, const ImageReader& images,
                     const ImportOptions& options) {
  return GltfReader(gltf::File(path, read_file(path, {})), images, options).read();
}

}  // namespace caplet
