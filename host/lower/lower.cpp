// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/lower.h"

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "lower/camera.h"
#include "lower/detail/filter.h"
#include "lower/detail/geometry.h"
#include "lower/detail/lights.h"
#include "lower/detail/materials.h"
#include "lower/spectrum.h"

namespace caplet {

FlatScene lower(const Scene& scene) {
  const auto start = std::chrono::steady_clock::now();
  FlatScene out;
  SpectrumTable spectra(out, scene.film.space);
  for (const Material& material : scene.materials)
    out.materials.push_back(lower_material(material, narrow<uint>(out.materials.size()), spectra, out));
  const std::vector<Emitter> emitters = lower_geometry(scene, spectra, out);
  lower_lights(scene, emitters, spectra, out);
  out.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

FlatView lower_view(const Scene& scene) {
  FlatView out;
  lower_camera(scene, out);
  lower_filter(scene.filter, out);
  out.view.seed = scene.sampler.seed;
  out.view.max_depth = narrow<uint>(scene.integrator.max_depth);
  std::ranges::transform(rgb_from_xyz(scene.film.space), out.view.rgb_from_xyz, [](double v) { return static_cast<float>(v); });
  return out;
}

}  // namespace caplet
