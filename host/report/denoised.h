// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures without noise, from films.
#pragma once

#include "film/develop.h"
#include "film/image.h"
#include "render/renderer.h"
#include "scene/film.h"

namespace caplet::report {

/// Returns the layers of a film that denoising needs.
Layers denoising_layers();
/// Returns the channels that it adds.
inline constexpr std::size_t denoising_channels = 3;

/// Develops these layers of a film as developed_in_bands does, with R G B denoised and noisy.R/G/B
/// added, if the settings ask for it. The picture is then in memory as a whole. Keeps references as
/// developed_in_bands does. Throws RunError.
BandedImage developed(const DeviceFilm& film, const FilmSettings& settings, Layers layers,
                      PictureFlaws& flaws);
BandedImage developed(const Film& film, const FilmSettings& settings, Layers layers,
                      PictureFlaws& flaws);

}  // namespace caplet::report
