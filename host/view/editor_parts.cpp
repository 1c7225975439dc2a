// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Changes of parts by their forms, new and removed parts, and hidden things.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "view/detail/form_fields.h"
#include "view/detail/rearrange.h"
#include "view/editor.h"
#include "view/forms.h"

namespace caplet::view {

namespace {

/// Returns the rearrangement that replaces one of the scene's lists.
template <auto list, class Rearrange, class List>
Rearrange replacing(List to) {
  return {[to = std::move(to)](Scene& scene, HiddenPointer&) {
    List before = std::exchange(scene.*list, to);
    return replacing<list, Rearrange>(std::move(before));
  }};
}

/// Returns the rearrangement that replaces a shape of the world.
template <class Rearrange>
Rearrange reshaping(std::uint32_t id, std::shared_ptr<const Shape> to) {
  return {[id, to = std::move(to)](Scene& scene, HiddenPointer&) {
    auto before = std::make_shared<const Shape>(std::move(scene.shapes[id]));
    scene.shapes[id] = *to;
    return reshaping<Rearrange>(id, std::move(before));
  }};
}

template <class T>
const T& at(const std::vector<T>& of, std::uint32_t number, const char* what) {
  if (number >= of.size())
    throw InputError(SourceLocation{"part"}, fmt::format("there is no {} {}, of {} counted from 0",
                                                         what, number, of.size()));
  return of[number];
}

template <class T>
void hide_some(std::vector<T>& of, const std::vector<std::size_t>& places, HiddenList<T>& hidden,
               std::vector<std::pair<std::size_t, T>>& things) {
  const std::vector<std::size_t> in_whole = places_in_whole(hidden, places);
  take_out(of, places, things);
  for (std::size_t i = 0; i < places.size(); ++i)
    hidden.emplace_back(in_whole[i], std::make_shared<const T>(things[i].second));
  std::ranges::sort(hidden, {}, [](const auto& one) { return one.first; });
}

/// Moves those of `hidden` whose index `is_wanted` accepts to the shown things.
template <class T, class Wanted>
void show_some(HiddenList<T>& hidden, Wanted&& is_wanted,
               std::vector<std::pair<std::size_t, T>>& things) {
  HiddenList<T> rest;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    if (is_wanted(i))
      things.emplace_back(hidden[i].first - rest.size(), *hidden[i].second);
    else
      rest.push_back(hidden[i]);
  }
  hidden = std::move(rest);
}

template <class T>
void add_all(const HiddenList<T>& hidden, std::vector<T>& to) {
  std::vector<std::pair<std::size_t, T>> things;
  for (const auto& [place, thing] : hidden) things.emplace_back(place, *thing);
  put(to, things);
}

}  // namespace

Editor::Step Editor::set(const Set& set) const {
  const Scene& scene = live_.scene();
  const std::uint32_t number = set.part.number;
  switch (set.part.kind) {
    case FormSubject::Kind::material: {
      Material to = at(scene.materials, number, "material");
      const auto displacement = to.displacement;
      const std::string name = to.name;
      set_field(to, scene, set);
      if (to.displacement == displacement && to.name == name)
        return InPlace{MaterialEdit{number, to.model, to.textures}};
      auto list = scene.materials;
      list[number] = std::move(to);
      return replacing<&Scene::materials, Rearrange>(std::move(list));
    }
    case FormSubject::Kind::texture: {
      auto list = scene.textures;
      (void)at(list, number, "texture");
      set_field(list[number], scene, set);
      return replacing<&Scene::textures, Rearrange>(std::move(list));
    }
    case FormSubject::Kind::light: {
      Light to = at(scene.lights, number, "light");
      set_field(to, scene, set);
      return InPlace{LightEdit{number, std::move(to)}};
    }
    case FormSubject::Kind::emission: {
      const Shape& shape = scene.shapes[world_shape(scene, number)];
      auto to = shape.emission;
      set_field(to, scene, set);
      if (to && shape.emission)
        return InPlace{EmissionEdit{{std::nullopt, number}, *std::move(to)}};
      Shape changed = shape;
      changed.emission = std::move(to);
      return reshaping<Rearrange>(number, std::make_shared<const Shape>(std::move(changed)));
    }
    case FormSubject::Kind::shape: {
      Shape to = scene.shapes[world_shape(scene, number)];
      set_field(to, scene, set);
      return reshaping<Rearrange>(number, std::make_shared<const Shape>(std::move(to)));
    }
    default: {
      Setting to{set.part.kind, view_};
      set_field(to.to, scene, set);
      return to;
    }
  }
}

Editor::Step Editor::add(const Add& add) const {
  const Scene& scene = live_.scene();
  if (add.what == FormSubject::Kind::shape) {
    auto things = std::make_shared<Things>();
    things->shapes.emplace_back(scene.shapes.size(), new_shape(scene, add));
    return addition<Rearrange>(std::move(things));
  }
  const auto with = [](auto list, auto one) {
    list.push_back(std::move(one));
    return list;
  };
  if (add.what == FormSubject::Kind::material)
    return replacing<&Scene::materials, Rearrange>(with(scene.materials, new_material(scene, add)));
  if (add.what == FormSubject::Kind::texture)
    return replacing<&Scene::textures, Rearrange>(with(scene.textures, new_texture(scene, add)));
  if (add.what == FormSubject::Kind::light)
    return replacing<&Scene::lights, Rearrange>(with(scene.lights, new_light(add)));
  throw InputError(SourceLocation{"of"}, "is nothing that can be added");
}

Editor::Step Editor::hide(const Hide& hide) const {
  const Scene& scene = live_.scene();
  const std::size_t count = scene.shapes.size() + scene.instances.size();
  std::vector<bool> is_chosen(count, hide.others);
  for (const std::uint32_t id : hide.ids) {
    if (id >= count)
      throw InputError(fmt::format("there is no thing {}, of {} counted from 0", id, count));
    is_chosen[id] = !hide.others;
  }
  std::vector<std::size_t> shapes, instances;
  for (std::size_t id = 0; id < count; ++id)
    if (is_chosen[id])
      (id < scene.shapes.size() ? shapes : instances)
          .push_back(id < scene.shapes.size() ? id : id - scene.shapes.size());
  if (shapes.size() + instances.size() == count)
    throw InputError("something has to be shown: the scene would be empty");
  return Rearrange{[shapes = std::move(shapes), instances = std::move(instances)](
                       Scene& whole, HiddenPointer& hidden) {
    auto things = std::make_shared<Things>();
    auto now = std::make_shared<Hidden>(*hidden);
    hide_some(whole.shapes, shapes, now->shapes, things->shapes);
    hide_some(whole.instances, instances, now->instances, things->instances);
    hidden = std::move(now);
    return addition<Rearrange>(std::move(things));
  }};
}

Editor::Step Editor::show(const Show& show) const {
  const std::size_t shapes = hidden_->shapes.size(), count = shapes + hidden_->instances.size();
  if (show.hidden && *show.hidden >= count)
    throw InputError(
        SourceLocation{"hidden"},
        fmt::format("there is no hidden thing {}, of {} counted from 0", *show.hidden, count));
  if (count == 0) throw InputError("nothing is hidden");
  auto things = std::make_shared<Things>();
  auto now = std::make_shared<Hidden>(*hidden_);
  const auto is_it = [&](std::size_t i) { return !show.hidden || *show.hidden == i; };
  show_some(now->shapes, is_it, things->shapes);
  show_some(
      now->instances, [&](std::size_t i) { return is_it(shapes + i); }, things->instances);
  Rearrange shown = addition<Rearrange>(std::move(things));
  shown.hidden = std::move(now);
  return shown;
}

std::optional<Editor::Step> Editor::step_of_part(const Change& change) const {
  if (const auto* one = std::get_if<Set>(&change)) return set(*one);
  if (const auto* one = std::get_if<Add>(&change)) return add(*one);
  if (const auto* one = std::get_if<Hide>(&change)) return hide(*one);
  if (const auto* one = std::get_if<Show>(&change)) return show(*one);
  if (const auto* one = std::get_if<Remove>(&change)) {
    auto list = live_.scene().lights;
    (void)at(list, one->part.number, "light");
    list.erase(list.begin() + one->part.number);
    return replacing<&Scene::lights, Rearrange>(std::move(list));
  }
  return {};
}

std::vector<std::uint32_t> Editor::made_by(const Change& change) const {
  const Scene& scene = live_.scene();
  const auto last = [](const auto& list, std::size_t count = 1) {
    std::vector<std::uint32_t> out(count);
    std::iota(out.begin(), out.end(), static_cast<std::uint32_t>(list.size() - count));
    return out;
  };
  if (const auto* add = std::get_if<Add>(&change)) {
    if (add->what == FormSubject::Kind::shape) return last(scene.shapes);
    if (add->what == FormSubject::Kind::material) return last(scene.materials);
    return add->what == FormSubject::Kind::texture ? last(scene.textures) : last(scene.lights);
  }
  if (const auto* copy = std::get_if<Duplicate>(&change)) {
    // Copies follow the things of their kind, and instances are numbered behind all shapes.
    const auto below = [copy](std::size_t end) {
      return static_cast<std::size_t>(
          std::count_if(copy->ids.begin(), copy->ids.end(), [end](auto id) { return id < end; }));
    };
    std::size_t shapes = 0;
    while (below(scene.shapes.size() - shapes) != shapes) ++shapes;
    std::vector<std::uint32_t> out = last(scene.shapes, shapes);
    for (const std::uint32_t i : last(scene.instances, copy->ids.size() - shapes))
      out.push_back(static_cast<std::uint32_t>(scene.shapes.size()) + i);
    return out;
  }
  if (const auto* hide = std::get_if<Hide>(&change); hide && hide->others) {
    std::vector<std::uint32_t> out(hide->ids.size());
    std::iota(out.begin(), out.end(), 0u);
    return out;
  }
  return {};
}

Scene Editor::document() const {
  Scene out = live_.scene();
  add_all(hidden_->shapes, out.shapes);
  add_all(hidden_->instances, out.instances);
  out.view = view_;
  return out;
}

}  // namespace caplet::view
