// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/picture_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/text_file.h"
#include "present/clip.h"
#include "present/picture_options.h"
#include "present/present.h"
#include "present/projection.h"

namespace caplet {

namespace {

double width_of(const std::string& text) {
  float value = 0;
  const NumberError error = parse_float(text, value);
  if (error != NumberError::none) throw InputError({"--least-width"}, describe(error, text));
  if (!(value >= 0 && value <= widest_least_width))
    throw InputError({"--least-width"},
                     fmt::format("'{}' is not from 0 to {} pixels", text, widest_least_width));
  return value;
}

/// The importer of neurons has set the direction of the apical dendrite.
void set_up(Framing& framing, const std::string& up) {
  if (up == "apical") {
    if (!framing.up)
      throw InputError({"--up"}, "apical is for one file of a neuron with an apical dendrite");
    return;
  }
  const std::vector<std::string> known{"x", "y", "z", "-x", "-y", "-z", "apical"};
  if (std::ranges::find(known, up.substr(up.starts_with('+') ? 1 : 0)) == known.end())
    throw InputError({"--up"}, none_of(up, known));
  framing.up = parse_axis(up, "--up");
}

void look_from(Scene& scene, const ImportOptions& options, bool is_turned) {
  const auto view = options.text("view"), up = is_turned ? std::nullopt : options.text("up");
  const bool projects = options.text("projection").has_value();
  if (!view && !up && !projects) return;
  const bool is_orthographic =
      projects && options.choice("projection", {"perspective", "orthographic"}, 0) == 1;
  if (!view && !scene.automatic_camera) {
    if (up)
      throw InputError({"--up"},
                       "the scene has a camera of its own: with --view it is framed anew");
    const Bounds bounds = bounds_or_unit_of(scene);
    return change_projection(scene.view.camera, is_orthographic, 0.5 * (bounds.min + bounds.max),
                             "--projection");
  }
  Framing& framing = scene.framing;
  if (up) set_up(framing, *up);
  if (view)
    framing.toward_viewer = parse_view(*view, framing.up.value_or(glm::dvec3(0, 1, 0)), "--view");
  if (projects) framing.is_orthographic = is_orthographic;
  if (!can_be_framed(scene)) return;
  const auto medium = scene.view.camera.medium;
  frame_camera(scene);
  scene.view.camera.medium = medium;
  turn_lights_to_camera(scene);
}

}  // namespace

void apply_picture_options(Scene& scene, const ImageReader& images, const ImportOptions& options,
                           bool is_turned) {
  look_from(scene, options, is_turned);
  if (const auto light = options.text("light")) set_light(scene, *light, "--light");
  if (const auto backdrop = options.text("background"))
    scene.view.film.backdrop = parse_backdrop(*backdrop, images, "--background");
  if (const auto width = options.text("least-width"))
    scene.view.film.least_width = width_of(*width);
  if (const auto clip = options.text("clip"))
    scene.view.clip =
        *clip == "none" ? std::nullopt : std::optional(parse_clip(*clip, scene, "--clip"));
  if (const auto exposure = options.text("exposure"))
    scene.view.film.exposure = parse_exposure(*exposure, "--exposure");
}

}  // namespace caplet
