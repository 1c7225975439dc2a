// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/pick_report.h"

#include <fmt/format.h>

#include <charconv>
#include <glm/geometric.hpp>

#include "lower/identity.h"
#include "reference/scene_reference.h"
#include "report/summary.h"
#include "scene/frozen.h"

namespace caplet::report {

namespace {

using Json = nlohmann::ordered_json;
using glm::dvec3;

/// Returns the double that prints as the float does.
double as_printed(float value) {
  const std::string text = fmt::format("{}", value);
  double out = value;
  std::from_chars(text.data(), text.data() + text.size(), out);
  return out;
}

Json to_json(const float (&v)[3]) {
  return Json::array({as_printed(v[0]), as_printed(v[1]), as_printed(v[2])});
}

/// Returns a name as a string, or the number if there is no name.
Json label(const std::string& name, std::uint32_t number) {
  return name.empty() ? Json(number) : Json(name);
}

Json to_json(const PickRecord& p, const Scene& scene) {
  const Identity identity = identity_of(scene, p);
  Json out;
  out["t"] = as_printed(p.t);
  out["object"] = label(identity.shape->name, p.object);
  out["object_id"] = p.object;
  out["instance"] = identity.instance ? Json(*identity.instance) : Json(nullptr);
  out["primitive"] = p.primitive;
  out["surface"] = p.surface;
  out["material"] = label(scene.materials[p.material].name, p.material);
  out["material_id"] = p.material;
  out["entering"] = p.leaving == 0;
  out["point"] = to_json(p.point);
  out["normal"] = to_json(p.normal);
  out["uv"] = {as_printed(p.u), as_printed(p.v)};
  out["error"] = as_printed(p.error);
  return out;
}

Json to_json(const ReferenceCrossing& c, const Scene& scene) {
  Json out;
  out["t"] = c.t;
  out["object"] = label(c.name, c.object);
  out["object_id"] = c.object;
  out["primitive"] = c.primitive;
  out["surface"] = c.surface;
  out["material"] = label(scene.materials[c.material].name, c.material);
  out["entering"] = c.entering;
  out["point"] = {c.point.x, c.point.y, c.point.z};
  return out;
}

Json list_or_first(const std::vector<Json>& crossings, bool all) {
  if (all) return crossings;
  return crossings.empty() ? Json(nullptr) : crossings.front();
}

const char* side(bool entering) { return entering ? "entering" : "leaving"; }

std::string numbers(const float (&v)[3]) { return fmt::format("({}, {}, {})", v[0], v[1], v[2]); }

std::string crossing_text(const PickRecord& p, const Scene& scene) {
  const Identity identity = identity_of(scene, p);
  std::string out = fmt::format("object     {}\n", object_label(scene, identity));
  if (identity.instance) out += fmt::format("instance   {}\n", *identity.instance);
  out += fmt::format("primitive  {}\nsurface    {}\nmaterial   {}\n", p.primitive, p.surface,
                     material_label(scene, p.material));
  out += fmt::format("t          {}, {}\n", p.t, side(p.leaving == 0));
  out += fmt::format("point      {}, within {:.2g}\n", numbers(p.point), p.error);
  out += fmt::format("normal     {}\nuv         ({}, {})\n", numbers(p.normal), p.u, p.v);
  return out;
}

std::string reference_text(const ReferenceCrossing& c, const Scene& scene) {
  return fmt::format(
      "reference    t {:.9g}, {}, object {}, primitive {}, surface {}, material {}, at ({:.9g}, "
      "{:.9g}, {:.9g})\n",
      c.t, side(c.entering), c.name.empty() ? std::to_string(c.object) : c.name, c.primitive,
      c.surface, material_label(scene, c.material), c.point.x, c.point.y, c.point.z);
}

bool is_sheet(const Shape& shape) {
  return std::holds_alternative<TriangleMeshShape>(shape.geometry) ||
         std::holds_alternative<DiskShape>(shape.geometry) ||
         std::holds_alternative<PartialSphereShape>(shape.geometry) ||
         std::holds_alternative<OpenCylinderShape>(shape.geometry) ||
         std::holds_alternative<BilinearMeshShape>(shape.geometry) ||
         std::holds_alternative<MolecularSurfaceShape>(shape.geometry);
}

}  // namespace

std::vector<ReferenceCrossing> reference_crossings(const Scene& scene, const RayRecord& ray,
                                                   bool all) {
  // Rays see a scene that moves as it is when the shutter opens.
  const reference::SceneReference reference(
      moves(scene) ? frozen_at(scene, scene.view.film.shutter_open) : scene);
  const reference::Ray asked{dvec3(ray.ox, ray.oy, ray.oz), dvec3(ray.dx, ray.dy, ray.dz),
                             ray.t_min, ray.t_max};
  std::vector<reference::SceneHit> hits;
  if (all)
    hits = reference.all(asked);
  else if (const auto hit = reference.closest(asked))
    hits = {*hit};
  std::vector<ReferenceCrossing> out;
  for (const reference::SceneHit& hit : hits) {
    const bool placed = hit.instance != reference::no_instance;
    const Shape& shape =
        placed ? scene.objects[hit.object].shapes[hit.shape] : scene.shapes[hit.shape];
    const Identity identity{&shape, placed ? std::optional(hit.instance) : std::nullopt};
    ReferenceCrossing crossing;
    crossing.t = hit.t;
    crossing.name = shape.name;
    crossing.object = object_number(scene, identity);
    crossing.primitive = hit.primitive;
    crossing.surface = hit.surface;
    crossing.material = hit.material;
    crossing.entering = hit.leaving == (is_sheet(shape) && shape.reverse_orientation);
    crossing.point = asked.origin + hit.t * asked.direction;
    out.push_back(crossing);
  }
  return out;
}

std::string plain_text(const PickReport& report, const Scene& scene) {
  const RayRecord& r = report.ray;
  std::string out;
  if (report.pixel)
    out += fmt::format("pixel      {}, {}\n", (*report.pixel)[0], (*report.pixel)[1]);
  out += fmt::format("ray        from ({}, {}, {}) along ({}, {}, {})\n", r.ox, r.oy, r.oz, r.dx,
                     r.dy, r.dz);
  if (report.crossings.empty()) out += "hit        nothing\n";
  const std::size_t references = report.reference ? report.reference->size() : 0;
  for (std::size_t i = 0; i < std::max(report.crossings.size(), references); ++i) {
    if (report.all) out += fmt::format("\ncrossing   {}\n", i);
    if (i < report.crossings.size()) out += crossing_text(report.crossings[i], scene);
    if (i < references) out += reference_text((*report.reference)[i], scene);
    if (report.reference && i >= references) out += "reference    nothing\n";
  }
  if (report.reference && report.crossings.empty() && references == 0)
    out += "reference    nothing\n";
  return out;
}

std::string json_text(const PickReport& report, const Scene& scene) {
  const RayRecord& r = report.ray;
  Json out;
  out["scene"] = scene.source;
  out["device"] = report.device;
  if (report.pixel) out["pixel"] = {(*report.pixel)[0], (*report.pixel)[1]};
  out["ray"] = {{"origin", {as_printed(r.ox), as_printed(r.oy), as_printed(r.oz)}},
                {"direction", {as_printed(r.dx), as_printed(r.dy), as_printed(r.dz)}}};
  out["hit"] = !report.crossings.empty();
  std::vector<Json> crossings, references;
  for (const PickRecord& p : report.crossings) crossings.push_back(to_json(p, scene));
  if (report.all)
    out["crossings"] = crossings;
  else if (!crossings.empty())
    out.update(crossings.front());
  if (report.reference) {
    for (const ReferenceCrossing& c : *report.reference) references.push_back(to_json(c, scene));
    out["reference"] = list_or_first(references, report.all);
  }
  return to_text(out);
}

}  // namespace caplet::report
