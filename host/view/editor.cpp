// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <tuple>
#include <utility>

#include "base/error.h"
#include "view/detail/rearrange.h"

namespace caplet::view {

namespace {

/// Throws InputError when the thing does not exist.
void check_thing(const Scene& scene, std::uint32_t id) {
  const std::size_t count = scene.shapes.size() + scene.instances.size();
  if (id >= count)
    throw InputError(fmt::format("there is no thing {}, of {} counted from 0", id, count));
}

/// Two edits with the same key replace each other.
std::tuple<std::size_t, std::uint32_t, std::size_t> place_of(const SceneEdit& edit) {
  if (const auto* capsule = std::get_if<CapsuleEdit>(&edit))
    return {edit.index(), capsule->at.shape, capsule->capsule};
  if (const auto* transform = std::get_if<TransformEdit>(&edit))
    return {edit.index(), transform->at.shape, 0};
  if (const auto* material = std::get_if<MaterialEdit>(&edit))
    return {edit.index(), material->material, 0};
  if (const auto* light = std::get_if<LightEdit>(&edit)) return {edit.index(), light->light, 0};
  if (const auto* emission = std::get_if<EmissionEdit>(&edit))
    return {edit.index(), emission->at.shape, 0};
  return {edit.index(), std::get<InstanceEdit>(edit).instance, 0};
}

SceneEdit moved(const Scene& scene, std::uint32_t id, const glm::dmat4& world_from_world) {
  check_thing(scene, id);
  if (id < scene.shapes.size())
    return TransformEdit{{std::nullopt, id}, world_from_world * scene.shapes[id].world_from_object};
  const auto instance = static_cast<std::uint32_t>(id - scene.shapes.size());
  return InstanceEdit{instance, world_from_world * scene.instances[instance].world_from_object};
}

}  // namespace

std::uint32_t world_shape(const Scene& scene, std::uint32_t id) {
  check_thing(scene, id);
  if (id >= scene.shapes.size())
    throw InputError(
        fmt::format("thing {} is an instance: its shapes are those of its object", id));
  return id;
}

namespace {

using Materials =
    std::vector<std::pair<std::uint32_t, std::pair<std::uint32_t, std::vector<std::uint32_t>>>>;

/// Returns the rearrangement that sets the materials of shapes.
template <class Rearrange>
Rearrange painting(Materials materials) {
  return {[materials = std::move(materials)](Scene& scene, HiddenPointer&) {
    Materials before;
    for (const auto& [id, of] : materials) {
      Shape& shape = scene.shapes[id];
      before.emplace_back(id, std::pair(shape.material, shape.materials));
      std::tie(shape.material, shape.materials) = of;
    }
    return painting<Rearrange>(std::move(before));
  }};
}

}  // namespace

Editor::Step Editor::step_of(const Change& change) const {
  const Scene& scene = live_.scene();
  if (const auto* move = std::get_if<Move>(&change)) {
    InPlace out;
    for (const std::uint32_t id : move->ids)
      out.push_back(moved(scene, id, move->world_from_world));
    return out;
  }
  if (const auto* reshape = std::get_if<Reshape>(&change)) {
    const ShapeAt at{std::nullopt, world_shape(scene, reshape->id)};
    (void)capsule_at(scene, at, reshape->capsule);
    const glm::dmat4 object_from_world = glm::inverse(scene.shapes[reshape->id].world_from_object);
    const auto place = [&](const glm::dvec3& p) {
      return glm::vec3(object_from_world * glm::dvec4(p, 1));
    };
    return InPlace{
        CapsuleEdit{at,
                    reshape->capsule,
                    {place(reshape->p0), place(reshape->p1), static_cast<float>(reshape->radius0),
                     static_cast<float>(reshape->radius1)}}};
  }
  if (const auto* paint = std::get_if<Paint>(&change)) {
    if (paint->material >= scene.materials.size())
      throw InputError(SourceLocation{"material"},
                       fmt::format("there are {} materials", scene.materials.size()));
    Materials out;
    for (const std::uint32_t id : paint->ids) {
      const Shape& shape = scene.shapes[world_shape(scene, id)];
      const std::size_t surfaces = surface_count(shape);
      if (!paint->surface) {
        out.emplace_back(id, std::pair(paint->material, std::vector<std::uint32_t>()));
        continue;
      }
      if (*paint->surface >= surfaces)
        throw InputError(SourceLocation{"surface"},
                         fmt::format("thing {} has {} surfaces", id, surfaces));
      std::vector<std::uint32_t> each =
          shape.materials.empty() ? std::vector(surfaces, shape.material) : shape.materials;
      each[*paint->surface] = paint->material;
      out.emplace_back(id, std::pair(shape.material, std::move(each)));
    }
    return painting<Rearrange>(std::move(out));
  }
  if (const auto* again = std::get_if<Redraw>(&change)) return redraw(*again);
  if (auto part = step_of_part(change)) return *std::move(part);
  std::vector<std::size_t> shapes, instances;
  const auto sort_out = [&](const std::vector<std::uint32_t>& ids) {
    for (const std::uint32_t id : ids) {
      check_thing(scene, id);
      if (id < scene.shapes.size())
        shapes.push_back(id);
      else
        instances.push_back(id - scene.shapes.size());
    }
  };
  if (const auto* copy = std::get_if<Duplicate>(&change)) {
    sort_out(copy->ids);
    const glm::dmat4 by = glm::translate(glm::dmat4(1), copy->by);
    auto things = std::make_shared<Things>();
    for (const std::size_t i : shapes) {
      things->shapes.emplace_back(scene.shapes.size() + things->shapes.size(), scene.shapes[i]);
      Shape& shape = things->shapes.back().second;
      shape.world_from_object = by * shape.world_from_object;
      if (!shape.name.empty()) shape.name += " copy";
    }
    for (const std::size_t i : instances) {
      things->instances.emplace_back(scene.instances.size() + things->instances.size(),
                                     scene.instances[i]);
      Instance& instance = things->instances.back().second;
      instance.world_from_object = by * instance.world_from_object;
      move(instance.motion, by);
    }
    return addition<Rearrange>(std::move(things));
  }
  sort_out(std::get<Delete>(change).ids);
  return removal<Rearrange>(std::move(shapes), std::move(instances));
}

namespace {

/// Returns the rearrangement that puts another scene in place of the present one.
template <class Rearrange>
Rearrange replacement(std::shared_ptr<const Scene> by) {
  return {[by = std::move(by)](Scene& scene, HiddenPointer&) {
    auto before = std::make_shared<const Scene>(std::move(scene));
    scene = *by;
    return replacement<Rearrange>(std::move(before));
  }};
}

}  // namespace

Editor::Step Editor::redraw(const Redraw& redraw) const {
  if (!files_.read) throw InputError("the scene's files are not read again");
  FileOptions options = changed_options(files_, files_.now, redraw.options);
  auto out = replacement<Rearrange>(
      std::make_shared<const Scene>(redrawn(files_, options, live_.scene())));
  out.hidden = std::make_shared<const Hidden>();
  out.options = std::move(options);
  return out;
}

/// Makes the step and returns the one that undoes it. Throws InputError and then changes nothing.
Editor::Step Editor::take(const Step& step) {
  if (const auto* rearrange = std::get_if<Rearrange>(&step)) {
    Scene scene = live_.scene();
    HiddenPointer hidden = hidden_;
    Rearrange back = rearrange->work(scene, hidden);
    if (rearrange->hidden) hidden = rearrange->hidden;
    back.hidden = hidden_;
    if (rearrange->options) back.options = files_.now;
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    diagnostics.finish();
    const Scene& before = live_.scene();
    if (before.shapes.size() != scene.shapes.size() ||
        before.instances.size() != scene.instances.size())
      ++renumberings_;
    ++rearrangements_;
    live_.replace(std::move(scene));
    hidden_ = std::move(hidden);
    if (rearrange->options) files_.now = *rearrange->options;
    return back;
  }
  if (const auto* setting = std::get_if<Setting>(&step)) return take_setting(*setting);
  const InPlace& edits = std::get<InPlace>(step);
  InPlace back;
  try {
    for (const SceneEdit& edit : edits) back.insert(back.begin(), live_.edit(edit));
  } catch (const InputError&) {
    for (const SceneEdit& before : back) live_.put(before);
    throw;
  }
  return back;
}

Editor::Step Editor::take_setting(const Setting& setting) {
  View to = view_;
  if (setting.part == FormSubject::Kind::camera) {
    to.camera = setting.to.camera;
    to.clip = setting.to.clip;
  }
  if (setting.part == FormSubject::Kind::film) to.film = setting.to.film;
  if (setting.part == FormSubject::Kind::filter) to.filter = setting.to.filter;
  if (setting.part == FormSubject::Kind::sampler) to.sampler = setting.to.sampler;
  if (setting.part == FormSubject::Kind::integrator) to.integrator = setting.to.integrator;
  live_.edit(to);
  if (setting.part == FormSubject::Kind::camera) ++camera_changes_;
  return Setting{setting.part, std::exchange(view_, std::move(to))};
}

void Editor::make(const Change& change, bool goes_on) {
  Step back = take(step_of(change));
  made_ = made_by(change);
  ++states_;
  const Step* before = goes_on ? log_.open() : nullptr;
  if (before && have_same_places(*before, back))
    log_.merge(states_);
  else
    log_.add(std::move(back), states_);
}

bool Editor::have_same_places(const Step& a, const Step& b) {
  const Setting* setting_of_a = std::get_if<Setting>(&a);
  const Setting* setting_of_b = std::get_if<Setting>(&b);
  if (setting_of_a && setting_of_b) return setting_of_a->part == setting_of_b->part;
  const InPlace* of_a = std::get_if<InPlace>(&a);
  const InPlace* of_b = std::get_if<InPlace>(&b);
  return of_a && of_b &&
         std::ranges::equal(*of_a, *of_b, [](const SceneEdit& x, const SceneEdit& y) {
           return place_of(x) == place_of(y);
         });
}

}  // namespace caplet::view
