// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Directives that set how the scene is rendered.
#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/names.h"
#include "import/detail/pbrt/options.h"

namespace caplet::pbrt {

void OptionBuilder::accelerator(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own));
  if (to_.check_type(at, type)) check_accelerator(type, given);
}

void OptionBuilder::camera(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own));
  to_.has_camera = true;
  to_.check_place();
  const glm::dmat4 world_from_camera = to_.state.transform.start.inverse(),
                   at_end = to_.state.transform.end.inverse();
  to_.coordinate_systems["camera"] = {world_from_camera, at_end};
  if (to_.check_type(at, type))
    set_camera(type, given, world_from_camera, to_.draft.scene, &to_.draft.images);
  if (to_.state.transform.moves())
    to_.draft.scene.view.camera.motion = {{to_.transform_times[0], world_from_camera},
                                          {to_.transform_times[1], at_end}};
  to_.draft.scene.view.camera.medium = to_.state.media.outside;
}

void OptionBuilder::film(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own));
  if (to_.check_type(at, type))
    set_film(type, given, to_.state.space, to_.draft.scene, &to_.draft.images);
}

void OptionBuilder::integrator(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own));
  if (to_.check_type(at, type)) set_integrator(type, given, to_.draft.scene);
}

void OptionBuilder::pixel_filter(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own));
  if (to_.check_type(at, type)) set_filter(type, given, to_.draft.scene);
}

void OptionBuilder::sampler(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own));
  if (to_.check_type(at, type)) to_.sampler_seed = set_sampler(type, given, to_.draft.scene);
}

void OptionBuilder::option(const Statement& at, const std::string& name, const Token& value) {
  if (!to_.check_type(at, name)) return;
  if (const auto seed = set_option(name, value, at.where.file, to_.draft.diagnostics))
    to_.option_seed = seed;
  if (name == "rendercoordsys") to_.renders_in_world = value.text == "world";
}

}  // namespace caplet::pbrt
