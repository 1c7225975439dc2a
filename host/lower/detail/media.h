// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts media of the model to records and their data, and finds which geometries separate them.
#pragma once

#include "lower/detail/subtrees.h"
#include "lower/flat_scene.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// Fills mediums, media_data and media_grids.
void lower_media(const Scene& scene, SpectrumTable& spectra, FlatScene& out);

/// Fills boundaries and geometry_boundary, for scenes with media; `geometry`: of the same scene,
/// lowered into `out`. Boundaries are numbered by the surface of their shapes' bounds, large ones
/// first (for an object: the smallest that its instances make). In that order, shapes that follow
/// each other with the same media on both sides share one. Open surfaces have one for the same
/// media. Throws InputError for more than CAPLET_MOST_BOUNDARIES.
void lower_boundaries(const Scene& scene, const LoweredGeometry& geometry, FlatScene& out);

}  // namespace caplet
