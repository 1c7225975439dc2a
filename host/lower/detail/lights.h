// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Light records, the selection table and the environment's distribution.
#pragma once

#include <vector>

#include "lower/detail/light_images.h"
#include "lower/flat_scene.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// One emissive primitive as placed in the world.
struct Emitter {
  std::uint32_t slot, instance, geometry;
  std::uint32_t group;  // the same for the primitives of one shape as placed
  double area;          // world, of the surfaces that emit
  std::uint32_t spectrum;
  double scale;      // multiplies the spectrum
  double luminance;  // of the radiance, scale included
  bool two_sided;
  bool unseen;                   // by rays: CAPLET_LIGHT_UNSEEN
  const AreaEmission* of_image;  // where it has an image, whose mean luminance is not in `luminance`; or null
  bool by_ball;                  // sampled by the bounding ball (kernels/lights/ball.cl)
  double ball[4];                // centre and radius, world
  // What the light tree knows of it: the box in the world; the direction that it shines to, or 0 for all.
  double min[3], max[3], axis[3];
};

/// Fills lights, light_data, light_alias, light_nodes, light_places, light_texels, light_cdf and the record `lighting`. Light i
/// is emitter i for i < emitters.size(); the scene's lights follow, infinite ones last. They are selected by light_table.h, and
/// CAPLET_LIGHT_TREE_FROM and more of those that are somewhere by light_tree.h; constant infinite lights are never selected,
/// since BSDF sampling finds them as well. `world` and `geometries` must be set. `images`: what `out` holds already, and then
/// what it holds.
void lower_lights(const Scene& scene, const std::vector<Emitter>& emitters, SpectrumTable& spectra, LightImages& images,
                  FlatScene& out);

}  // namespace caplet
