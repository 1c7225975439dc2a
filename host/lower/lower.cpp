// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/lower.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>

#include "base/check.h"
#include "lower/camera.h"
#include "lower/detail/filter.h"
#include "lower/detail/images.h"
#include "lower/detail/lowering.h"
#include "lower/detail/materials.h"
#include "lower/detail/media.h"

namespace caplet {

Lowering::Lowering(const Scene& scene, const Linking& linking)
    : images(image_numbers(scene.textures)), spectra(flat, scene.view.film.space) {
  const auto start = std::chrono::steady_clock::now();
  flat.sky_is_unseen = scene.view.film.backdrop.has_value();
  lower_images(scene, images, flat);
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    flat.materials.push_back(lower_material(scene, narrow<uint>(i), images, spectra, flat));
  lower_media(scene, spectra, flat);
  geometry = lower_geometry(scene, images, spectra, linking, flat);
  lower_boundaries(scene, geometry, flat);
  lower_lights(scene, geometry.emitters, spectra, light_images, flat);
  flat.build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

namespace {

void lower_sampler(const SamplerSettings& sampler, ViewRecord& out) {
  out.seed = sampler.seed;
  out.sampler = static_cast<uint>(sampler.kind);  // both are rows of samplers.def
  if (sampler.kind == SamplerSettings::Kind::stratified) {
    const std::array<int, 2> strata = strata_of(sampler);
    out.sampler_x = narrow<uint>(strata[0]);
    out.sampler_y = narrow<uint>(strata[1]);
    if (!sampler.jitter) out.strategy |= CAPLET_STRATEGY_UNJITTERED;
  } else if (sampler.kind == SamplerSettings::Kind::zsobol) {
    out.sampler_x = narrow<uint>(std::bit_width(narrow<uint>(sampler.samples_per_pixel) - 1));
  }
}

void lower_integrator(const IntegratorSettings& integrator, ViewRecord& out) {
  out.strategy |= integrator.strategy();
  out.max_depth = narrow<uint>(integrator.max_depth);
  if (integrator.kind == IntegratorSettings::Kind::ambient_occlusion) {
    out.max_distance = static_cast<float>(integrator.max_distance);
    out.max_depth = 1;
  }
}

}  // namespace

FlatScene lower(const Scene& scene, const Linking& linking) {
  return std::move(Lowering(scene, linking).flat);
}

FlatScene lower_and_release(Scene& scene, Linking linking) {
  linking.release = true;
  Lowering lowering(scene, linking);
  if (lowering.flat.has_media()) return std::move(lowering.flat);
  const auto empty = [](std::vector<Shape>& shapes, const LoweredShapes& lowered) {
    for (std::size_t i = 0; i < shapes.size(); ++i)
      if (lowered.extents[i].has_linked) shapes[i].geometry = CapsulesShape{};
  };
  empty(scene.shapes, lowering.geometry.world);
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    empty(scene.objects[i].shapes, lowering.geometry.objects[i]);
  return std::move(lowering.flat);
}

FlatView lower_view(const Scene& scene) {
  FlatView out;
  lower_camera(scene, out);
  lower_filter(scene.view.filter, out);
  lower_sampler(scene.view.sampler, out.view);
  lower_integrator(scene.view.integrator, out.view);
  if (scene.view.film.max_component_value > 0)
    out.view.sample_limit =
        static_cast<float>(scene.view.film.max_component_value / scene.view.film.exposure_factor());
  return out;
}

}  // namespace caplet
