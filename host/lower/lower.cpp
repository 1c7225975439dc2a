// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/lower.h"

#include <algorithm>
#include <chrono>

#include "base/check.h"
#include "lower/camera.h"
#include "lower/detail/filter.h"
#include "lower/detail/images.h"
#include "lower/detail/lowering.h"
#include "lower/detail/materials.h"
#include "lower/detail/media.h"

namespace caplet {

Lowering::Lowering(const Scene& scene) : images(image_numbers(scene.textures)), spectra(flat, scene.film.space) {
  const auto start = std::chrono::steady_clock::now();
  flat.sky_is_unseen = scene.film.backdrop.has_value();
  lower_images(scene, images, flat);
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    flat.materials.push_back(lower_material(scene, narrow<uint>(i), images, spectra, flat));
  lower_media(scene, spectra, flat);
  geometry = lower_geometry(scene, images, spectra, flat);
  lower_boundaries(scene, geometry, flat);
  lower_lights(scene, geometry.emitters, spectra, light_images, flat);
  flat.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

FlatScene lower(const Scene& scene) { return std::move(Lowering(scene).flat); }

FlatView lower_view(const Scene& scene) {
  FlatView out;
  lower_camera(scene, out);
  lower_filter(scene.filter, out);
  out.view.seed = scene.sampler.seed;
  out.view.max_depth = narrow<uint>(scene.integrator.max_depth);
  if (scene.film.max_component_value > 0)
    out.view.sample_limit =
        static_cast<float>(scene.film.max_component_value / (scene.film.exposure_time * scene.film.iso / 100));
  std::ranges::transform(picture_from_xyz(scene.film), out.view.rgb_from_xyz, [](double v) { return static_cast<float>(v); });
  return out;
}

}  // namespace caplet
