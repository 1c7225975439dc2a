// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A render's picture, developed a few rows at a time from the device's film: neither film nor picture is in memory as a whole.
#pragma once

#include "film/develop.h"
#include "film/image.h"
#include "render/renderer.h"
#include "scene/scene.h"

namespace caplet::report {

/// develop's layers (film/develop.h) of the film's sums, without metadata. Keeps references to `film`, `scene` and `not_finite`.
BandedImage developed_in_bands(const DeviceFilm& film, const Scene& scene, Layers layers, NotFinite& not_finite);
/// The same of a film in memory.
BandedImage developed_in_bands(const Film& film, const Scene& scene, Layers layers, NotFinite& not_finite);

}  // namespace caplet::report
