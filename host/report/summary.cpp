// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/summary.h"

#include <sys/resource.h>

#include <algorithm>
#include <set>

#include "base/utf8.h"
#include "report/picture.h"

namespace caplet::report {

namespace {

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

using Counted = std::set<const void*>;

/// Operands that csg shapes share are counted once.
std::uint64_t bytes_of(const Shape& shape, Counted& counted) {
  std::uint64_t out = sizeof(Shape);
  if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
    out += bytes_of(capsules->p0) + bytes_of(capsules->p1) + bytes_of(capsules->radius0) +
           bytes_of(capsules->radius1) + bytes_of(capsules->materials) + bytes_of(capsules->times);
  if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
    out += bytes_of(mesh->positions) + bytes_of(mesh->triangles) + bytes_of(mesh->normals) +
           bytes_of(mesh->uvs) + bytes_of(mesh->times);
  if (const auto* mesh = std::get_if<BilinearMeshShape>(&shape.geometry))
    out += bytes_of(mesh->positions) + bytes_of(mesh->patches) + bytes_of(mesh->normals) +
           bytes_of(mesh->uvs);
  if (const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry))
    out += bytes_of(molecule->centers) + bytes_of(molecule->radii) + bytes_of(molecule->materials) +
           bytes_of(molecule->patches->planes) + bytes_of(molecule->patches->balls) +
           bytes_of(molecule->patches->tori);
  if (const auto* polyhedron = std::get_if<PolyhedronShape>(&shape.geometry))
    out += bytes_of(polyhedron->points) + bytes_of(polyhedron->normals);
  if (const auto* csg = std::get_if<CsgShape>(&shape.geometry))
    for (const auto& operand : csg->operands)
      if (counted.insert(operand.get()).second) out += bytes_of(*operand, counted);
  return out + bytes_of(shape.materials);
}

/// Counts the primitives of a geometry whose points move.
template <class Type>
std::uint64_t moving_count(const Scene& scene) {
  std::uint64_t out = 0;
  const auto add = [&](const std::vector<Shape>& shapes) {
    for (const Shape& shape : shapes)
      if (std::holds_alternative<Type>(shape.geometry) && !key_times(shape).empty())
        out += primitive_count(shape);
  };
  add(scene.shapes);
  for (const Object& object : scene.objects) add(object.shapes);
  return out;
}

nlohmann::ordered_json to_json(const glm::dvec3& v) {
  return nlohmann::ordered_json::array({v.x, v.y, v.z});
}

}  // namespace

std::uint64_t model_bytes(const Scene& scene) {
  std::uint64_t out =
      bytes_of(scene.materials) + bytes_of(scene.instances) + bytes_of(scene.lights);
  Counted counted;
  for (const Shape& shape : scene.shapes) out += bytes_of(shape, counted);
  for (const Object& object : scene.objects)
    for (const Shape& shape : object.shapes) out += bytes_of(shape, counted);
  std::set<const EnvironmentImage*> images;
  const auto add = [&](const std::shared_ptr<const EnvironmentImage>& image) {
    if (image && images.insert(image.get()).second) out += bytes_of(image->rgb);
  };
  for (const Light& light : scene.lights)
    std::visit(
        [&](const auto& model) {
          if constexpr (requires { model.image; }) add(model.image);
        },
        light.model);
  for (const Shape& shape : scene.shapes)
    if (shape.emission) add(shape.emission->image);
  return out;
}

std::uint64_t light_count(const FlatScene& flat) { return flat.lights.size(); }

std::uint64_t peak_process_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

nlohmann::ordered_json scene_summary(const Scene& scene, const FlatScene& flat) {
  nlohmann::ordered_json out;
  out["scene"] = scene.source;
  out["primitives"] = nlohmann::ordered_json::object();
  for (const auto& [kind, count] : count_primitives(scene)) out["primitives"][kind] = count;
  out["contents"] = nlohmann::ordered_json::object();
  for (const auto& [what, count] : scene.contents) out["contents"][what] = count;
  const Bounds bounds = bounds_of(scene);
  if (bounds.empty())
    out["bounds"] = nullptr;
  else
    out["bounds"] = {{"min", to_json(bounds.min)}, {"max", to_json(bounds.max)}};
  out["materials"] = scene.materials.size();
  out["lights"] = nullptr;
  out["objects"] = scene.objects.size();
  out["instances"] = scene.instances.size();
  out["moving"] = std::ranges::count_if(scene.instances,
                                        [](const Instance& one) { return !one.motion.empty(); });
  out["moving_capsules"] = moving_count<CapsulesShape>(scene);
  out["moving_triangles"] = moving_count<TriangleMeshShape>(scene);
  out["image"] = {{"width", scene.view.film.width}, {"height", scene.view.film.height}};
  out["samples_per_pixel"] = scene.view.sampler.samples_per_pixel;
  if (scene.view.sampler.noise > 0) out["noise"] = scene.view.sampler.noise;
  out["max_depth"] = scene.view.integrator.max_depth;
  out["bytes"] = {{"host", model_bytes(scene)}};
  tell_lowered(out, flat);
  return out;
}

void tell_lowered(nlohmann::ordered_json& summary, const FlatScene& flat) {
  summary["lights"] = light_count(flat);
  summary["bytes"]["device"] = flat.device_bytes();
  summary["bvh"] = {{"nodes", flat.bvh_nodes}, {"depth", flat.bvh_depth}, {"sah", flat.bvh_sah}};
}

nlohmann::ordered_json run_summary(const RunSeconds& seconds, const RenderResult& result) {
  nlohmann::ordered_json out;
  out["seconds"] = {{"load", seconds.load},       {"build", seconds.build},
                    {"compile", seconds.compile}, {"render", seconds.render},
                    {"write", seconds.write},     {"total", seconds.total}};
  if (seconds.denoise > 0) out["seconds"]["denoise"] = seconds.denoise;
  out["first_pass_seconds"] = result.first_pass_seconds;
  out["compile_seconds"] = nlohmann::ordered_json::object();
  for (const auto& [stage, stage_seconds] : result.stage_compile_seconds)
    out["compile_seconds"][stage] = stage_seconds;
  out["stage_seconds"] = nlohmann::ordered_json::object();
  for (const auto& [stage, stage_seconds] : result.stage_seconds)
    out["stage_seconds"][stage] = stage_seconds;
  out["samples_per_pixel"] = result.samples_per_pixel;
  out["interrupted"] = result.interrupted;
  if (result.noise) out["noise"] = *result.noise;
  out["rays"] = {{"camera", result.camera_rays},
                 {"bounce", result.bounce_rays},
                 {"shadow", result.shadow_rays}};
  out["device"] = of_devices(result, &DeviceWork::name);
  out["driver"] = of_devices(result, &DeviceWork::driver);
  out["devices"] = nlohmann::ordered_json::array();
  for (const DeviceWork& device : result.devices)
    out["devices"].push_back({{"name", device.name},
                              {"driver", device.driver},
                              {"paths", device.paths},
                              {"paths_per_second", device.paths_a_second},
                              {"lost", device.lost}});
  out["peak_bytes"] = peak_process_bytes();
  out["peak_device_bytes"] = result.peak_device_bytes;
  return out;
}

std::string to_text(const nlohmann::ordered_json& json) { return json_dump(json, 2) + "\n"; }

}  // namespace caplet::report
