// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/render.h"

#include "library/detail/inside.h"
#include "library/detail/sessions.h"
#include "lower/lower.h"
#include "render/known_answers.h"

namespace caplet::v0 {

Film render(const Scene& scene, const Device& device, const RenderOptions& options,
            const ExtraLayers& layers) {
  Scene drawn = scene;
  drawn.widen_to_least();
  const caplet::Scene& model = *Inside::model(drawn);
  const std::optional<NoiseTarget> noise = options.noise ? options.noise : drawn.noise_target();
  if (noise) check_noise(*noise, model.view.sampler);
  const caplet::Device& on = Inside::device(device);
  const FlatScene flat = lower(model);
  try_device(on, {.shapes = flat.shapes, .render = true});
  const auto samples = static_cast<std::uint32_t>(model.view.sampler.samples_per_pixel);
  const FlatView view = lower_view(model);
  caplet::Session session(flat, view, {on},
                          {.layers = layers_with(layers), .most_samples = noise ? 0 : samples});
  SessionRuns runs;
  if (noise)
    runs.render_to(session, *noise, options);
  else
    runs.render(session, samples, options);
  SceneFingerprint fingerprint;
  return runs.film(session, model, flat, view, fingerprint);
}

}  // namespace caplet::v0
