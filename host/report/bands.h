// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Develops a render's picture in bands of rows from the device's film, so that neither film nor
// picture is in memory as a whole.
#pragma once

#include <span>

#include "film/develop.h"
#include "film/image.h"
#include "render/renderer.h"
#include "scene/film.h"

namespace caplet::report {

/// Develops the layers (film/develop.h) of the film's sums, without metadata. Keeps references to
/// `film`, `settings`, `flaws`.
BandedImage developed_in_bands(const DeviceFilm& film, const FilmSettings& settings, Layers layers,
                               PictureFlaws& flaws);
/// Does the same for a film in memory, with a channel `samples` where pixels have different numbers
/// of them.
BandedImage developed_in_bands(const Film& film, const FilmSettings& settings, Layers layers,
                               PictureFlaws& flaws);

/// Sets the exposure of the previews. Where it is automatic, it is first chosen by all bands of all
/// `pictures`, which are made once for it; `flaws` does not count that. Returns the stops.
double fix_exposure(std::span<BandedImage> pictures, PictureFlaws& flaws);
/// Sets the exposure of the previews to these stops.
void set_exposure(std::span<BandedImage> pictures, double stops);

/// Makes all bands, and joins them.
LayeredImage whole_of(const BandedImage& picture);

}  // namespace caplet::report
