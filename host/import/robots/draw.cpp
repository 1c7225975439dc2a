// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes shapes and materials of a robot's geoms, and its own lights.
#include "import/detail/robot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include "base/check.h"
#include "base/reading.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/text_file.h"
#include "import/import.h"
#include "present/present.h"
#include "scene/append.h"
#include "scene/texture_image.h"

namespace caplet {

namespace {

constexpr glm::dvec4 kGrey{0.5, 0.5, 0.5, 1};
constexpr double kFar =
    50;  // an infinite plane extends so many times the size of the objects on it to each side
constexpr double kBrightestSky = 0.35;  // the mean of its radiance
constexpr std::size_t kMostTriangles = std::size_t{1} << 26;
constexpr std::size_t kMostTinted = std::size_t{1} << 30;  // bytes

double linear(double screen) { return decoded_value({}, std::clamp(screen, 0.0, 1.0)); }
RgbSpectrum linear(const glm::dvec3& screen) {
  return {{linear(screen.r), linear(screen.g), linear(screen.b)}};
}

class RobotDrawing {
 public:
  RobotDrawing(const Robot& robot, Scene& scene, const glm::dmat4& world, const ImageReader& images)
      : robot_(robot), scene_(scene), world_(world), images_(images) {}

  void add(const RobotGeom& geom) {
    if (!(rgba_of(geom).a > 0)) return;
    if (geom.fit) return add_fitted(geom);
    switch (geom.kind) {
      case GeomKind::sphere:
        return add(geom, SphereShape{geom.size.x}, glm::dmat4(1));
      case GeomKind::ellipsoid:
        return add(geom, SphereShape{1}, glm::scale(glm::dmat4(1), geom.size));
      case GeomKind::capsule: {
        const auto h = static_cast<float>(geom.size.y);
        return add(
            geom,
            CapsulesShape{{{0, 0, -h}}, {{0, 0, h}}, {static_cast<float>(geom.size.x)}, {}, {}},
            glm::dmat4(1));
      }
      case GeomKind::cylinder:
        return add(geom, CylinderShape{{0, 0, -geom.size.y}, {0, 0, geom.size.y}, geom.size.x},
                   glm::dmat4(1));
      case GeomKind::box:
        return add(geom, BoxShape{-geom.size, geom.size}, glm::dmat4(1));
      case GeomKind::mesh:
        return add_mesh(geom);
      case GeomKind::plane:
        planes_.push_back(&geom);
    }
  }

  /// Runs after everything else, because the size of infinite planes depends on it.
  void finish() {
    const Bounds bounds = bounds_of(scene_);
    const bool alone = scene_.shapes.empty();
    const glm::dvec3 middle = alone ? glm::dvec3(0) : (bounds.min + bounds.max) / 2.0;
    const double size = alone ? 1 : std::max(glm::length(bounds.max - bounds.min) / 2, 1e-6);
    for (const RobotGeom* plane : planes_) {
      const glm::dvec3 at(glm::inverse(world_ * plane->world) * glm::dvec4(middle, 1));
      glm::dvec2 least, most;
      for (int k = 0; k < 2; ++k) {
        const bool endless = !(plane->size[k] > 0);
        least[k] = endless ? at[k] - kFar * size : -plane->size[k];
        most[k] = endless ? at[k] + kFar * size : plane->size[k];
      }
      TriangleMeshShape mesh;
      mesh.positions = {
          {least.x, least.y, 0}, {most.x, least.y, 0}, {most.x, most.y, 0}, {least.x, most.y, 0}};
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
      add(*plane, std::move(mesh), glm::dmat4(1));
      scene_.shapes.back().one_sided = true;
      scene_.shapes.back().is_backdrop = true;
    }
  }

 private:
  const RobotMaterial* material_of(const RobotGeom& geom) const {
    return geom.material ? &robot_.materials[*geom.material] : nullptr;
  }
  glm::dvec4 rgba_of(const RobotGeom& geom) const {
    const RobotMaterial* material = material_of(geom);
    return geom.rgba ? *geom.rgba : material ? material->rgba : kGrey;
  }

  std::uint32_t add_material(Material material) {
    scene_.materials.push_back(std::move(material));
    return narrow<std::uint32_t>(scene_.materials.size() - 1);
  }

  /// Plain colours are diffuse. MuJoCo's specular and shininess become an interface whose
  /// reflectance at normal incidence is 0.08 specular, and whose GGX roughness matches Phong's
  /// exponent 128 shininess; reflectance is the share of a mirror.
  std::uint32_t material(const RobotGeom& geom, bool has_uvs) {
    const glm::dvec4 rgba = rgba_of(geom);
    const RobotMaterial* of = material_of(geom);
    const bool textured = of && of->texture && of->texture->image;
    const Key key{rgba.r, rgba.g, rgba.b, geom.material ? static_cast<double>(*geom.material) : -1};
    if (!textured) {
      const auto known = materials_.find(key);
      if (known != materials_.end()) return known->second;
    }
    const std::string name = of ? of->name : "color " + std::to_string(materials_.size() + 1);
    Material base{DiffuseMaterial{linear(glm::dvec3(rgba))}, name, {scene_.source, 0, 0}};
    std::string field = "reflectance";
    if (of && (of->specular > 0 || of->metallic)) {
      PrincipledMaterial model;
      model.base_color = linear(glm::dvec3(rgba));
      const double at_right_angles = std::sqrt(0.08 * of->specular);
      model.eta = (1 + at_right_angles) / (1 - at_right_angles);
      model.roughness =
          of->roughness ? *of->roughness : std::pow(2 / (128 * of->shininess + 2), 0.25);
      model.metallic = of->metallic.value_or(0);
      base.model = model;
      field = "base_color";
    }
    if (textured) base.textures.push_back({field, texture(geom, *of, rgba, has_uvs)});
    std::uint32_t out = add_material(std::move(base));
    if (of && of->reflectance > 0) {
      if (!mirror_) {
        ConductorMaterial metal;
        metal.reflectance = ConstantSpectrum{1};
        mirror_ = add_material({metal, "mirror", {scene_.source, 0, 0}});
      }
      out = add_material({MixMaterial{{out, *mirror_}, of->reflectance},
                          name + " reflecting",
                          {scene_.source, 0, 0}});
    }
    if (!textured) materials_[key] = out;
    return out;
  }

  /// Adds the image times the colour, and returns its index.
  std::uint32_t texture(const RobotGeom& geom, const RobotMaterial& of, const glm::dvec4& rgba,
                        bool has_uvs) {
    ImagemapTexture image;
    image.filter = 2;
    TextureMapping& mapping = image.mapping;
    glm::dmat4 texture_from_geom(1);
    glm::dvec3 size = geom.size;
    if (geom.kind == GeomKind::capsule || geom.kind == GeomKind::cylinder)
      size = {size.x, size.x, size.y};
    if (geom.kind == GeomKind::sphere) size = glm::dvec3(size.x);
    if (geom.kind == GeomKind::mesh) size = glm::dvec3(1);
    const glm::bvec3 is_endless(!(size.x > 0), !(size.y > 0), !(size.z > 0));
    for (int k = 0; k < 3; ++k)
      if (is_endless[k]) size[k] = 1;
    if (of.texture->by_direction) {
      mapping.kind = TextureMapping::Kind::spherical;
      if (!of.texuniform) texture_from_geom = glm::scale(texture_from_geom, 1.0 / size);
    } else if (has_uvs) {
      mapping.uscale = of.texrepeat.x;
      mapping.vscale = of.texrepeat.y;
    } else {
      // Uniform textures repeat by length: that many times in two units, from the geom's edge.
      glm::dvec2 repeat = of.texrepeat;
      for (int k = 0; k < 2; ++k)
        if (of.texuniform && !is_endless[k]) repeat[k] *= size[k];
      if (geom.kind == GeomKind::plane || geom.kind == GeomKind::box ||
          geom.kind == GeomKind::mesh) {
        // The texture is projected along z.
        mapping.kind = TextureMapping::Kind::planar;
        mapping.v1 = {0.5 * repeat.x / size.x, 0, 0};
        mapping.v2 = {0, 0.5 * repeat.y / size.y, 0};
        mapping.udelta = is_endless.x ? 0.5 : 0.5 * repeat.x;
        mapping.vdelta = is_endless.y ? 0.5 : 1 - 0.5 * repeat.y;
      } else {
        // The texture wraps around z, from the top down.
        mapping.uscale = repeat.x;
        mapping.vscale = repeat.y;
        mapping.vdelta = 1 - repeat.y;
        if (geom.kind == GeomKind::capsule) {
          // v covers the whole profile of a capsule: the texture covers its side once.
          const double cap = 0.5 * std::numbers::pi * geom.size.x, side = 2 * geom.size.y;
          mapping.vscale = repeat.y * (2 * cap + side) / side;
          mapping.vdelta = 1 - repeat.y * (1 + cap / side);
        }
      }
    }
    if (mapping.kind != TextureMapping::Kind::uv)
      mapping.texture_from_world = texture_from_geom * glm::inverse(world_ * geom.world);
    image.image = tinted(of.texture->image, glm::dvec3(rgba), of.where);
    scene_.textures.push_back({image, false, of.name, of.where});
    return narrow<std::uint32_t>(scene_.textures.size() - 1);
  }

  /// Multiplies the image by a colour in sRGB, as MuJoCo does.
  std::shared_ptr<const TextureImage> tinted(const std::shared_ptr<const TextureImage>& image,
                                             const glm::dvec3& color, const SourceLocation& where) {
    if (color == glm::dvec3(1)) return image;
    std::shared_ptr<const TextureImage>& known = tinted_[{image.get(), color.r, color.g, color.b}];
    if (known) return known;
    tinted_bytes_ += image->bytes.size() + sizeof(float) * image->floats.size();
    if (tinted_bytes_ > kMostTinted)
      throw InputError(where,
                       "the textures in the colours of all materials take more than 2^30 bytes");
    auto out = std::make_shared<TextureImage>(*image);
    out->file.clear();
    const std::size_t channels = static_cast<std::size_t>(image->channels),
                      pixels = image->values() / channels;
    out->channels = 3;
    out->bytes.assign(image->bytes.empty() ? 0 : 3 * pixels, 0);
    out->floats.assign(image->floats.empty() ? 0 : 3 * pixels, 0);
    for (std::size_t i = 0; i < pixels; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t from = channels * i + (channels >= 3 ? k : 0);
        const double factor = std::clamp(color[static_cast<int>(k)], 0.0, 1.0);
        if (!out->bytes.empty())
          out->bytes[3 * i + k] = static_cast<std::uint8_t>(image->bytes[from] * factor);
        if (!out->floats.empty())
          out->floats[3 * i + k] = image->floats[from] * static_cast<float>(linear(factor));
      }
    return known = out;
  }

  void add(const RobotGeom& geom, Geometry geometry, const glm::dmat4& geom_from_shape) {
    const auto* mesh = std::get_if<TriangleMeshShape>(&geometry);
    const bool has_uvs = mesh && !mesh->uvs.empty();
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.name = geom.name;
    shape.where = geom.where;
    shape.world_from_object = world_ * geom.world * geom_from_shape;
    shape.material = material(geom, has_uvs);
    const glm::dvec4 rgba = rgba_of(geom);
    if (rgba.a < 1) shape.alpha = TextureOperand(rgba.a);
    if (const RobotMaterial* of = material_of(geom); of && of->emission > 0) {
      AreaEmission emission;
      emission.radiance = linear(glm::dvec3(rgba));
      emission.scale = of->emission;
      if (glm::dvec3(rgba) != glm::dvec3(0)) shape.emission = emission;
    }
    scene_.shapes.push_back(std::move(shape));
  }

  void add_fitted(const RobotGeom& geom) {
    RobotGeom fitted = geom;
    if (!fit(fitted, geom.parts ? *geom.parts : *files_.read(geom.mesh, geom.where)))
      return Diagnostics().warning(
          geom.where, "the geom is left out: the mesh that it is fitted to holds nothing");
    add(fitted);
  }

  void add_mesh(const RobotGeom& geom) {
    std::shared_ptr<const MeshParts> parts = geom.parts;
    if (!parts && !geom.needs_mesh) {
      const char* why =
          !is_mesh_file(geom.mesh) ? "STL, OBJ, DAE, PLY, OFF and MSH are read" : "no such file";
      if (!is_mesh_file(geom.mesh) || !is_there(geom.mesh, geom.where))
        return Diagnostics().warning(geom.where,
                                     "the mesh '" + geom.mesh.string() + "' is left out: " + why);
    }
    if (!parts && geom.has_mesh_looks && has_looks(geom.mesh)) return add_with_looks(geom);
    if (!parts) parts = files_.read(geom.mesh, geom.where);
    for (const TriangleMeshShape& part : *parts) {
      count(part, geom);
      add(geom, part, geom.geom_from_mesh);
    }
  }

  void count(const TriangleMeshShape& part, const RobotGeom& geom) {
    triangles_ += part.triangles.size();
    if (triangles_ > kMostTriangles)
      throw InputError(geom.where, "the meshes of all geoms have more than 2^26 triangles");
  }

  static bool has_looks(const std::filesystem::path& mesh) {
    const std::string ending = lower_case_ending(mesh);
    return ending == ".dae" || ending == ".obj";
  }

  /// A part of a mesh's file, in the file's coordinates. `shape` has a material of the scene where
  /// `has_look`.
  struct LookedPart {
    Shape shape;
    bool has_look = false;
  };

  /// Parts that have no material in the mesh's file have the geom's, as in RViz.
  void add_with_looks(const RobotGeom& geom) {
    for (const LookedPart& part : looked(geom)) {
      const auto& mesh = std::get<TriangleMeshShape>(part.shape.geometry);
      count(mesh, geom);
      if (!part.has_look) {
        add(geom, mesh, geom.geom_from_mesh * part.shape.world_from_object);
        continue;
      }
      Shape shape = part.shape;
      shape.name = geom.name;
      shape.where = geom.where;
      shape.world_from_object =
          world_ * geom.world * geom.geom_from_mesh * part.shape.world_from_object;
      scene_.shapes.push_back(std::move(shape));
    }
  }

  const std::vector<LookedPart>& looked(const RobotGeom& geom) {
    const auto [known, is_new] = looked_.try_emplace(geom.mesh.string());
    std::vector<LookedPart>& out = known->second;
    if (!is_new) return out;
    check_may_read(geom.mesh, geom.where);
    // As in ROS, the up axis of a COLLADA file does not count.
    ImportOptions as_it_is;
    as_it_is.set("up", "y");
    Scene file = lower_case_ending(geom.mesh) == ".dae" ? import_dae(geom.mesh, images_, as_it_is)
                                                        : import_obj(geom.mesh, images_, as_it_is);
    std::erase_if(file.shapes, [](const Shape& shape) {
      return std::get<TriangleMeshShape>(shape.geometry).triangles.empty();
    });
    if (file.shapes.empty())
      throw InputError(geom.where, "the mesh '" + geom.mesh.string() + "' holds no faces");
    for (const Shape& shape : file.shapes) {
      // The importers' own material for parts without one has no line, and no colours of vertices.
      const Material& look = file.materials.at(shape.material);
      out.push_back({{}, look.where.line > 0 || !look.textures.empty()});
    }
    if (std::ranges::none_of(out, &LookedPart::has_look)) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i].shape = std::move(file.shapes[i]);
      return out;
    }
    const std::size_t first = scene_.shapes.size();
    append(scene_, std::move(file));
    for (std::size_t i = 0; i < out.size(); ++i) out[i].shape = std::move(scene_.shapes[first + i]);
    scene_.shapes.resize(first);
    return out;
  }

  using Key = std::array<double, 4>;
  const Robot& robot_;
  Scene& scene_;
  glm::dmat4 world_;
  const ImageReader& images_;
  MeshFiles files_;
  std::map<std::string, std::vector<LookedPart>> looked_;  // by file
  std::size_t triangles_ = 0;
  std::map<Key, std::uint32_t> materials_;
  std::map<std::tuple<const TextureImage*, double, double, double>,
           std::shared_ptr<const TextureImage>>
      tinted_;
  std::size_t tinted_bytes_ = 0;
  std::optional<std::uint32_t> mirror_;
  std::vector<const RobotGeom*> planes_;
};

/// Reads "visual", "collision", "all", or numbers of groups.
std::function<bool(const RobotGeom&)> shown_by(const ImportOptions& options) {
  const std::string text = options.text("groups").value_or("visual");
  if (text == "all") return [](const RobotGeom&) { return true; };
  if (text == "collision") return [](const RobotGeom& geom) { return geom.collides; };
  std::set<int> groups{0, 1, 2};
  if (text != "visual") {
    groups.clear();
    std::string_view rest = text;
    for (;;) {
      const std::string_view word = rest.substr(0, rest.find(','));
      int group = 0;
      if (!parse_number(word, group) || group < 0 || group > 5)
        throw InputError(
            {"--groups"},
            "'" + text + "' is none of: visual, collision, all, numbers of groups (0 to 5)");
      groups.insert(group);
      if (word.size() == rest.size()) break;
      rest.remove_prefix(word.size() + 1);
    }
  }
  return [groups](const RobotGeom& geom) { return groups.contains(geom.group); };
}

/// Returns the mean over all directions and channels.
double mean_of(const EnvironmentImage& image) {
  double sum = 0, weight = 0;
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    const std::size_t row = i / 3 / width;
    const double across =
        std::sin(std::numbers::pi * (static_cast<double>(row) + 0.5) / image.height);
    sum += across * static_cast<double>(image.rgb[i]);
    weight += across;
  }
  return sum / weight;
}

/// MuJoCo's lights do not fade with distance; ours get the same strength at the centre of the
/// visible scene.
void light_by_robot(const Robot& robot, const glm::dmat4& world, Scene& scene) {
  Bounds bounds;
  for (const Shape& shape : scene.shapes) {
    if (shape.is_backdrop) continue;
    const Bounds one = bounds_of(shape);
    bounds.extend(one.min);
    bounds.extend(one.max);
  }
  const glm::dvec3 middle = bounds.empty() ? glm::dvec3(0) : (bounds.min + bounds.max) / 2.0;
  const auto add = [&](auto model, const SourceLocation& where) {
    Light light;
    light.model = std::move(model);
    light.where = where;
    scene.lights.push_back(std::move(light));
  };
  const SourceLocation whole{scene.source, 0, 0};
  glm::dvec3 ambient = robot.headlight_ambient.value_or(glm::dvec3(0));
  for (const RobotLight& light : robot.lights) {
    ambient += light.ambient;
    if (light.diffuse == glm::dvec3(0)) continue;
    const glm::dvec3 position(world * glm::dvec4(light.position, 1)),
        direction = glm::dmat3(world) * light.direction;
    const glm::dvec3 irradiance = std::numbers::pi * light.diffuse;
    const double away = std::max(glm::dot(position - middle, position - middle), 1e-12);
    if (light.kind == RobotLight::Kind::distant)
      add(DistantLight{RgbSpectrum{irradiance}, direction}, light.where);
    else if (light.kind == RobotLight::Kind::point)
      add(PointLight{RgbSpectrum{irradiance * away}, position}, light.where);
    else
      add(SpotLight{RgbSpectrum{irradiance * away}, position, direction, glm::radians(light.cutoff),
                    0.8 * glm::radians(light.cutoff)},
          light.where);
  }
  if (robot.headlight_diffuse && *robot.headlight_diffuse != glm::dvec3(0))
    add(DistantLight{RgbSpectrum{std::numbers::pi * *robot.headlight_diffuse},
                     glm::normalize(glm::dvec3(scene.view.camera.world_from_camera[2]))},
        whole);
  InfiniteLight sky;
  sky.radiance = RgbSpectrum{ambient + 1e-6};
  if (robot.sky) {
    sky.image = robot.sky;
    sky.world_from_light = glm::dmat3(world);
  }
  add(sky, whole);
  // MuJoCo's sky emits no light. Here it replaces the ambient light, and is at most as bright as
  // that usually is.
  if (robot.sky)
    scene.lights.back().scale = std::min(1.0, kBrightestSky / std::max(mean_of(*robot.sky), 1e-6));
}

/// Sets the requested camera and the robot's lights.
void present(const Robot& robot, const glm::dmat4& world, const ImportOptions& options,
             Imported& out) {
  Scene& scene = out.scene;
  out.is_lit = !robot.lights.empty();
  if (out.is_lit) frame_camera(scene);  // the headlight needs it
  if (const std::optional<std::string> name = options.text("camera")) {
    const auto camera = std::ranges::find(robot.cameras, *name, &RobotCamera::name);
    if (camera == robot.cameras.end()) {
      std::string known;
      for (const RobotCamera& one : robot.cameras) known += (known.empty() ? "" : ", ") + one.name;
      throw InputError({"--camera"}, "the file has no camera '" + *name + "'" +
                                         (known.empty() ? "" : " (it has: " + known + ")"));
    }
    out.has_camera = true;
    scene.automatic_camera = false;
    const glm::dmat4 at = world * camera->world;
    scene.view.camera = Camera{};
    scene.view.camera.world_from_camera = glm::dmat4(at[0], at[1], -at[2], at[3]);
    scene.view.camera.projection = PerspectiveProjection{glm::radians(camera->fovy)};
    if (camera->orthographic) {
      const double aspect = static_cast<double>(scene.view.film.width) / scene.view.film.height,
                   half = camera->fovy / 2;
      scene.view.camera.projection = OrthographicProjection{};
      scene.view.camera.screen_window = {-half * aspect, half * aspect, -half, half};
    }
  }
  if (out.is_lit) light_by_robot(robot, world, scene);
}

void draw(const Robot& robot, const glm::dmat4& world,
          const std::function<bool(const RobotGeom&)>& shown, const ImageReader& images,
          Scene& scene) {
  scene.world_from_file = glm::dmat3(world);
  scene.unit = "m";
  RobotDrawing drawing(robot, scene, world, images);
  for (const RobotGeom& geom : robot.geoms)
    if (shown(geom)) drawing.add(geom);
  drawing.finish();
  if (scene.shapes.empty())
    throw InputError({scene.source, 0, 0}, "holds no geometry of the groups that are asked for");
}

}  // namespace

Scene import_urdf(const std::filesystem::path& path, const ImageReader& images,
                  const ImportOptions& options) {
  Scene scene;
  scene.source = path.string();
  enum Groups : std::size_t { visual, collision, all };
  const std::size_t groups = options.choice("groups", {"visual", "collision", "all"}, visual);
  const glm::dmat4 world = world_from_file(options, "z");
  const Robot robot = read_urdf(path, Pose(options));
  bool collides = groups == collision;
  if (!options.text("groups") && !robot.geoms.empty() &&
      std::ranges::all_of(robot.geoms, &RobotGeom::collides)) {
    Diagnostics().warning({scene.source}, "has nothing that is to be seen: what collides is drawn");
    collides = true;
  }
  draw(
      robot, world,
      [&](const RobotGeom& geom) { return groups == all || geom.collides == collides; }, images,
      scene);
  return scene;
}

Imported import_mjcf(const std::filesystem::path& path, const ImageReader& images,
                     const ImportOptions& options) {
  Scene scene;
  scene.source = path.string();
  const auto shown = shown_by(options);
  const glm::dmat4 world = world_from_file(options, "z");
  const Robot robot = read_mjcf(path, Pose(options), images);
  draw(robot, world, shown, images, scene);
  Imported out(std::move(scene));
  present(robot, world, options, out);
  return out;
}

}  // namespace caplet
