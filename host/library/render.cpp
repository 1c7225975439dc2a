// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/render.h"

#include "film/develop.h"
#include "library/detail/inside.h"
#include "lower/lower.h"
#include "render/known_answers.h"
#include "render/render.h"
#include "report/picture.h"

namespace caplet::v0 {

Film render(const Scene& scene, const Device& device, const RenderOptions& options) {
  const caplet::Scene& model = *Inside::model(scene);
  const caplet::Device& on = Inside::device(device);
  const FlatScene flat = lower(model);
  const FlatView view = lower_view(model);
  try_device(on, {.shapes = flat.shapes, .render = true});
  caplet::RenderOptions inner;
  inner.samples_per_pixel = model.sampler.samples_per_pixel;
  inner.time_limit = options.time_limit;
  const RenderResult result = caplet::render(flat, view, on, inner, [&](const Progress& progress) {
    if (options.progress) options.progress({progress.fraction, progress.samples_per_second});
  });
  LayeredImage image = develop(result.film, model, Layers::all());
  image.metadata = report::picture_metadata(model, model.source, "libcaplet", on, result);
  return Inside::film(std::move(image), result.samples_per_pixel, result.render_seconds);
}

}  // namespace caplet::v0
