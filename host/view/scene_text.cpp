// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/scene_text.h"

#include <filesystem>

#include "lower/identity.h"
#include "scene/bounds.h"

namespace caplet::view {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

Json camera_text(const Look& look) {
  Json rows = Json::array();
  for (int i = 0; i < 16; ++i) rows.push_back(look.world_from_camera[i % 4][i / 4]);
  return {{"world_from_camera", rows}, {"fov", look.fov}, {"lens_radius", look.lens_radius}, {"focal_distance", look.focal_distance}};
}

Json scene_text(const Scene& scene, const std::string& device, std::uint32_t samples) {
  Json out{{"type", "scene"}};
  out["name"] = std::filesystem::path(scene.source).filename().string();
  out["device"] = device;
  out["samples"] = samples;
  const Bounds bounds = bounds_of(scene);
  out["bounds"] = {to_json(bounds.min), to_json(bounds.max)};
  // By the numbers of the layer object.id (lower/identity.h).
  Json things = Json::array();
  for (const Shape& shape : scene.shapes) {
    if (things.size() >= most_named) break;
    Json row{{"name", object_label(scene, {&shape, {}})}, {"primitives", primitive_count(shape)}};
    row["material"] = material_label(scene, shape.materials.empty() ? shape.material : shape.materials.front());
    things.push_back(std::move(row));
  }
  for (const Instance& instance : scene.instances) {
    if (things.size() >= most_named) break;
    things.push_back({{"name", scene.objects[instance.object].name}, {"instance", true}});
  }
  out["things"] = std::move(things);
  out["thing_count"] = scene.shapes.size() + scene.instances.size();
  Json materials = Json::array();
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) materials.push_back(material_label(scene, i));
  out["materials"] = std::move(materials);
  return out;
}

}  // namespace caplet::view
