// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/scene_text.h"

#include <filesystem>

#include "lower/identity.h"
#include "present/present.h"
#include "scene/bounds.h"
#include "scene/edit.h"
#include "scene/frozen.h"
#include "view/detail/snapshot.h"

namespace caplet::view {

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const glm::dmat4& m) {
  Json rows = Json::array();
  for (int i = 0; i < 16; ++i) rows.push_back(m[i % 4][i / 4]);
  return rows;
}

Json to_json(const Bounds& bounds) {
  return {view::to_json(bounds.min), view::to_json(bounds.max)};
}

}  // namespace

Json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json camera_text(const ShowView& look) {
  Json clip;
  if (look.clip) clip = {{"normal", to_json(look.clip->normal)}, {"offset", look.clip->offset}};
  return {{"world_from_camera", to_json(look.world_from_camera)},
          {"fov", look.fov},
          {"lens_radius", look.lens_radius},
          {"focal_distance", look.focal_distance},
          {"orthographic", look.orthographic},
          {"separation", look.separation},
          {"convergence", look.convergence},
          {"clip", clip}};
}

Json exposure_text(const PreviewExposure& exposure) {
  return {{"stops", exposure.stops}, {"auto", exposure.is_automatic}};
}

Json backdrop_text(const std::optional<Backdrop>& backdrop) {
  if (!is_put_under_by_page(backdrop)) return nullptr;
  if (backdrop->kind == Backdrop::Kind::transparent) return "transparent";
  return to_json(backdrop->color);
}

Json scene_text(const Scene& scene, const std::string& device, std::uint32_t samples,
                double noise) {
  Json out{{"type", "scene"}};
  out["name"] = std::filesystem::path(scene.source).filename().string();
  out["device"] = device;
  out["samples"] = samples;
  out["noise"] = noise;
  out["bounds"] = to_json(bounds_or_unit_of(scene));
  out["unit"] = scene.unit;
  if (const auto span = motion_span(scene)) out["moves"] = {(*span)[0], (*span)[1]};
  out["time"] = scene.view.film.shutter_open;
  // Things are numbered as in the layer object.id (lower/identity.h).
  Json things = Json::array();
  for (const Shape& shape : scene.shapes) {
    if (things.size() >= most_named) break;
    Json row{{"name", object_label(scene, {&shape, {}})}, {"primitives", primitive_count(shape)}};
    row["material"] =
        material_label(scene, shape.materials.empty() ? shape.material : shape.materials.front());
    things.push_back(std::move(row));
  }
  for (const Instance& instance : scene.instances) {
    if (things.size() >= most_named) break;
    things.push_back({{"name", scene.objects[instance.object].name}, {"instance", true}});
  }
  out["things"] = std::move(things);
  out["shape_count"] = scene.shapes.size();
  out["thing_count"] = scene.shapes.size() + scene.instances.size();
  Json materials = Json::array();
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i)
    materials.push_back(material_label(scene, i));
  out["materials"] = std::move(materials);
  return out;
}

Json hidden_text(const Scene& scene, const Hidden& hidden) {
  Json out = Json::array();
  for (const auto& [place, shape] : hidden.shapes)
    if (out.size() < most_named)
      out.push_back(shape->name.empty() ? geometry_name(*shape) : shape->name);
  for (const auto& [place, instance] : hidden.instances)
    if (out.size() < most_named) out.push_back(scene.objects[instance->object].name);
  return out;
}

Json thing_text(const Scene& scene, std::uint32_t id, std::uint32_t primitive) {
  Json out;
  if (id < scene.shapes.size()) {
    const Shape& shape = scene.shapes[id];
    out["world_from_object"] = to_json(shape.world_from_object);
    out["bounds"] = to_json(bounds_of(shape));
    Json materials = Json::array();
    for (std::size_t i = 0; i < surface_count(shape); ++i)
      materials.push_back(shape.materials.empty() ? shape.material : shape.materials[i]);
    out["materials"] = std::move(materials);
    const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
    if (!capsules || primitive >= count_of(*capsules)) return out;
    const Capsule capsule = capsule_at(scene, {std::nullopt, id}, primitive);
    const auto place = [&shape](const glm::vec3& p) {
      return to_json(glm::dvec3(shape.world_from_object * glm::dvec4(p, 1)));
    };
    out["capsule"] = {{"number", primitive},
                      {"p0", place(capsule.p0)},
                      {"p1", place(capsule.p1)},
                      {"radius0", capsule.radius0},
                      {"radius1", capsule.radius1}};
    return out;
  }
  const std::size_t instance = id - scene.shapes.size();
  if (instance >= scene.instances.size()) return nullptr;
  const glm::dmat4& world_from_object = scene.instances[instance].world_from_object;
  out["world_from_object"] = to_json(world_from_object);
  Bounds bounds;
  for (const Shape& shape : scene.objects[scene.instances[instance].object].shapes)
    bounds.extend(bounds_of(shape.geometry, world_from_object * shape.world_from_object));
  out["bounds"] = to_json(bounds);
  return out;
}

}  // namespace caplet::view
