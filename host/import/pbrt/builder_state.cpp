// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Directives that open and close blocks, change the graphics state other than its transform, or
// read other files.
#include <algorithm>
#include <memory>
#include <utility>

#include "base/spelling.h"
#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/names.h"
#include "scene/frozen.h"

namespace caplet::pbrt {

namespace {

constexpr std::size_t most_attributes =
    256;  // Attributes of different names; no statement has as many parameters

}  // namespace

void Blocks::begin(const Statement& at, const GraphicsState& state) {
  blocks_.push_back({at.directive, at.where, state});
}

GraphicsState Blocks::end(const Statement& at, std::string_view opener) {
  const std::string directive(at.directive);
  if (blocks_.size() <= floor_)
    throw SyntaxError{at.where, directive + " without " + std::string(opener)};
  Block& block = blocks_.back();
  if (block.opener != opener)
    throw SyntaxError{at.where, directive + " while the " + std::string(block.opener) + " of " +
                                    block.where.to_string() + " is open"};
  GraphicsState saved = std::move(block.saved);
  blocks_.pop_back();
  return saved;
}

std::size_t Blocks::enter() { return std::exchange(floor_, blocks_.size()); }

bool Blocks::report_unclosed(Diagnostics& diagnostics) {
  bool has_object = false;
  for (; blocks_.size() > floor_; blocks_.pop_back()) {
    has_object = has_object || blocks_.back().opener == "ObjectBegin";
    diagnostics.error(blocks_.back().where,
                      std::string(blocks_.back().opener) + " is never closed");
  }
  return has_object;
}

StateBuilder::StateBuilder(Building& building)
    : to_(building), includes_(building.draft.main_file, building.draft.diagnostics) {}

void StateBuilder::attribute(const Statement&, const Word& target, ParameterList own) {
  static const std::vector<std::string> targets = {"light", "material", "medium", "shape",
                                                   "texture"};
  ParameterList given = to_.taken(std::move(own));
  if (std::ranges::find(targets, target.text) == targets.end()) {
    to_.draft.diagnostics.error(target.where, "unknown Attribute target " + in_quotes(target.text) +
                                                  "; the nearest known name is \"" +
                                                  nearest_name(target.text, targets) + "\"");
    return;
  }
  SharedParameters& current = to_.state.attributes[target.text];
  for (Parameter& parameter : given) {
    to_.draft.attributes.push_back(std::make_shared<Parameter>(std::move(parameter)));
    const auto& fresh = to_.draft.attributes.back();
    const auto same = [&](const auto& other) { return other->name == fresh->name; };
    if (const auto found = std::find_if(current.begin(), current.end(), same);
        found != current.end()) {
      (*found)->replaced_by = fresh;
      *found = fresh;
    } else if (current.size() < most_attributes) {
      current.push_back(fresh);
    } else {
      throw SyntaxError{fresh->where, "more than " + std::to_string(most_attributes) +
                                          " attributes of one target"};
    }
  }
}

void StateBuilder::attribute_begin(const Statement& at) { blocks_.begin(at, to_.state); }

void StateBuilder::attribute_end(const Statement& at) {
  to_.state = blocks_.end(at, "AttributeBegin");
}

void StateBuilder::transform_begin(const Statement& at) {
  if (!std::exchange(warned_transform_begin_, true))
    to_.draft.diagnostics.warning(
        at.where, "TransformBegin is deprecated in pbrt-v4 and does what AttributeBegin does");
  blocks_.begin(at, to_.state);
}

void StateBuilder::transform_end(const Statement& at) {
  to_.state = blocks_.end(at, "TransformBegin");
}

void StateBuilder::color_space(const Statement& at, const Word& name) {
  if (!check_name(at.directive, name.text, name.where, to_.draft.diagnostics)) return;
  to_.state.space = static_cast<ColorSpace>(std::ranges::find(color_space_names, name.text) -
                                            color_space_names.begin());
}

void StateBuilder::reverse_orientation(const Statement&) {
  to_.state.reverse_orientation = !to_.state.reverse_orientation;
}

void StateBuilder::include(const Statement& at, const Word& file, const ParseText& parse) {
  includes_.begin(at, file);
  includes_.read(file, parse);
}

void StateBuilder::import(const Statement& at, const Word& file, const ParseText& parse) {
  includes_.begin(at, file);
  const GraphicsState saved = to_.state;
  const auto saved_systems = to_.coordinate_systems;
  const std::size_t outer = blocks_.enter();
  includes_.read(file, parse);
  report_unclosed();
  blocks_.leave(outer);
  to_.state = saved;
  to_.coordinate_systems = saved_systems;
}

void StateBuilder::report_unclosed() {
  if (blocks_.report_unclosed(to_.draft.diagnostics)) to_.draft.objects.open.reset();
}

void StateBuilder::object_begin(const Statement& at, const std::string& name) {
  ObjectDraft& objects = to_.draft.objects;
  Scene& scene = to_.draft.scene;
  if (objects.open)
    throw SyntaxError{at.where,
                      "ObjectBegin within the ObjectBegin of " + objects.open_where.to_string()};
  if (const auto [found, fresh] =
          objects.names.emplace(name, static_cast<std::uint32_t>(scene.objects.size()));
      !fresh)
    to_.draft.diagnostics.error(at.where, "the object " + in_quotes(name) +
                                              " is defined twice (first at " +
                                              scene.objects[found->second].where.to_string() + ")");
  blocks_.begin(at, to_.state);
  objects.open = scene.objects.size();
  objects.open_where = at.where;
  scene.objects.push_back({name, {}, at.where});
}

void StateBuilder::object_end(const Statement& at) {
  to_.state = blocks_.end(at, "ObjectBegin");
  to_.draft.objects.open.reset();
}

void StateBuilder::object_instance(const Statement& at, const std::string& name) {
  ObjectDraft& objects = to_.draft.objects;
  if (objects.open)
    throw SyntaxError{at.where,
                      "ObjectInstance within the ObjectBegin of " + objects.open_where.to_string()};
  to_.check_place();
  const glm::dvec3 pivot =
      to_.renders_in_world ? glm::dvec3(0) : rendering_origin(to_.draft.scene.view.camera);
  objects.instances.push_back(
      {name, to_.state.transform.start.matrix(), at.where, to_.keys(), pivot});
}

void ObjectDraft::add_moving(Shape shape, TransformKeys motion, Scene& scene) {
  const auto object = static_cast<std::uint32_t>(scene.objects.size());
  const SourceLocation where = shape.where;
  const std::string name = shape.name;
  scene.objects.push_back({name, {}, where});
  scene.objects.back().shapes.push_back(std::move(shape));
  if (open)
    moving.push_back({static_cast<std::uint32_t>(*open), object, std::move(motion)});
  else
    scene.instances.push_back({object, motion.front().matrix, where, std::move(motion)});
}

void StateBuilder::world_begin(const Statement&) {
  to_.in_world = true;
  to_.state.transform = {};
  to_.coordinate_systems["world"] = {glm::dmat4(1), glm::dmat4(1)};
}

}  // namespace caplet::pbrt
