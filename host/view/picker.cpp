// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/picker.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <span>
#include <utility>

#include "lower/camera.h"
#include "report/pick_report.h"
#include "scene/shape.h"
#include "view/detail/scene_text.h"
#include "view/detail/shown_view.h"
#include "view/forms.h"

namespace caplet::view {

namespace {

constexpr std::size_t most_crossings = 4096;

bool is_closed_thing(const Scene& scene, std::uint32_t id) {
  if (id < scene.shapes.size()) return is_watertight(scene.shapes[id]);
  const std::size_t instance = id - scene.shapes.size();
  return instance < scene.instances.size() &&
         std::ranges::all_of(scene.objects[scene.instances[instance].object].shapes, is_watertight);
}

/// Puts the pick of a solid that the clipping plane cuts on its face there: the ray, which begins
/// at the plane, leaves it before it enters it.
void put_on_face(PickRecord& pick, const RayRecord& ray, const ClipPlane& clip,
                 const Scene& scene) {
  if (!(ray.t_min > 0) || pick.leaving == 0 || !is_closed_thing(scene, pick.object)) return;
  const glm::vec3 at =
      glm::vec3(ray.ox, ray.oy, ray.oz) + ray.t_min * glm::vec3(ray.dx, ray.dy, ray.dz);
  pick.t = ray.t_min;
  pick.leaving = 0;
  for (int k = 0; k < 3; ++k) {
    pick.point[k] = at[k];
    pick.normal[k] = static_cast<float>(clip.normal[k]);
  }
}

}  // namespace

Picker::Picker(const LiveScene& live, const Editor& editor, const EyeFilms& films,
               std::string device)
    : live_(live),
      editor_(editor),
      films_(films),
      device_(std::move(device)),
      query_(films.device_scene()) {
  const RayRecord any{0, 0, 0, 0, 0, 0, 1, INFINITY};
  (void)query_.closest(std::span(&any, 1));  // compiles the query's kernel
}

Text Picker::answer(const Question& question, const ShowView& shown) {
  return std::visit([&](const auto& one) { return answer_to(one, shown); }, question);
}

Text Picker::answer_to(const Ask& ask, const ShowView& shown) {
  nlohmann::ordered_json out{{"type", "answer"}, {"number", ask.number}};
  const Scene& scene = live_.scene();
  const RayRecord ray = ray_at(ask, shown);
  report::PickReport told;
  told.pixel = {ask.x, ask.y};
  told.ray = ray;
  told.device = device_;
  told.all = true;  // reports a list, even for the nearest crossing only
  if (ask.all) {
    told.crossings = query_.all(std::span(&ray, 1), most_crossings).crossings;
  } else {
    Query drawn(films_.drawn_scene());
    const std::span one(&ray, 1);
    PickRecord pick = (ask.reference ? query_ : drawn).closest(one)[0];
    if (shown.clip && !ask.reference && pick.object != CAPLET_NONE)
      put_on_face(pick, ray, *shown.clip, scene);
    if (pick.object != CAPLET_NONE) told.crossings = {pick};
  }
  if (ask.reference) told.reference = report::reference_crossings(scene, ray, ask.all);
  out["pick"] = nlohmann::ordered_json::parse(report::json_text(told, scene));
  return text_of(out);
}

Text Picker::answer_to(const Describe& describe, const ShowView&) {
  nlohmann::ordered_json out{{"type", "answer"}, {"number", describe.number}};
  out["thing"] = thing_text(live_.scene(), describe.id, describe.primitive);
  return text_of(out);
}

Text Picker::answer_to(const Form& form, const ShowView&) {
  nlohmann::ordered_json out{{"type", "answer"}, {"number", form.number}};
  out["form"] = form_text(live_.scene(), editor_.view(), form.part);
  return text_of(out);
}

RayRecord Picker::ray_at(const Ask& ask, const ShowView& shown) const {
  View own = live_.scene().view;
  own.camera = editor_.view().camera;
  const View view = shown_view(own, shown, 1, ask.eye);
  Scene looked;
  looked.view = view;
  return ray_of_pixel(looked, std::min(ask.x, shown.width - 1), std::min(ask.y, shown.height - 1));
}

}  // namespace caplet::view
