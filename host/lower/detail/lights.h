// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes light records, the selection table and the environment's distribution.
#pragma once

#include <vector>

#include "lower/detail/emitter.h"
#include "lower/detail/light_images.h"
#include "lower/flat_scene.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// Fills lights, light_data, light_alias, light_nodes, light_places, light_texels, light_cdf and
/// the record `lighting`. Light i is emitter i for i < emitters.size(); the scene's lights follow,
/// infinite ones last. They are selected by light_table.h, and CAPLET_LIGHT_TREE_FROM and more of
/// those that have a place by light_tree.h; constant infinite lights are never selected, since BSDF
/// sampling finds them as well. `world` and `geometries` must be set. `images`: the pictures that
/// `out` has already, and afterwards those that it then has.
void lower_lights(const Scene& scene, const std::vector<Emitter>& emitters, SpectrumTable& spectra,
                  LightImages& images, FlatScene& out);

}  // namespace caplet
