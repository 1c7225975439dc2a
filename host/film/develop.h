// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Turns the film's sums into picture layers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "film/film.h"
#include "film/image.h"
#include "film/layers.h"
#include "film/noise.h"
#include "scene/film.h"

namespace caplet {

/// This is Z of pixels whose camera rays all missed: Blender's value. Infinity would spoil filters
/// and normalising nodes.
inline constexpr float depth_of_nothing = 1e10f;

/// PictureFlaws is the noise of a developed picture, and counts its pixels that lack something.
struct PictureFlaws {
  std::size_t count = 0, of = 0;  // beyond the range of a float; `of`: how many were developed
  std::size_t x = 0, y = 0;       // the first one
  std::size_t crowded = 0;        // with more things in one matte than CAPLET_SLOTS
  PictureNoise noise;             // where the layer variance is developed

  /// Logs a warning when there are any.
  void warn() const;
};

/// RowMargins are the rows of a film that do not become rows of the picture.
struct RowMargins {
  int above = 0, below = 0;
};

/// Returns R G B A and the requested layers (docs/output.md) that the film has, for all its pixels,
/// times the exposure of `settings`:
/// R G B     mean of the samples, linear in the settings' colour space, with their white balance;
///           over their backdrop, by A
/// A         coverage: share of the camera rays that hit something
/// albedo    mean over all samples (0 where nothing is hit), linear in the film's colour space: 1 1
/// 1
///           is white in any light
/// N, P, Z   mean over the samples that hit: shading normal (a mean of unit vectors, at most 1
/// long),
///           world position, distance; 0, 0 and depth_of_nothing without hits
/// object.id, primitive.id   of the first sample; 2^32 - 1: nothing hit
/// variance  variance of R G B's mean, as the two replicates of the film and of the neighbours say
///           (docs/output.md); 0 for fewer than two samples
/// CryptoObject00.R, ...   mattes (film/mattes.h) with settings.matte_levels things a pixel
/// All values are finite: where the exposure goes beyond a float, R G B are black and the variance
/// is the greatest float (other layers: 0), and `flaws` counts those
/// pixels.
/// The rows in the margins are not developed; they are there as neighbours.
LayeredImage develop(const Film& film, const FilmSettings& settings, Layers layers,
                     PictureFlaws& flaws, RowMargins margins = {});

/// Does the same and warns.
LayeredImage develop(const Film& film, const FilmSettings& settings, Layers layers);

/// Puts a backdrop under R G B, or the channels of these names behind a prefix, by A, and notes
/// that it is there. R G B already have coverage's share of the shapes' light; the backdrop fills
/// the rest.
void put_under(LayeredImage& image, const std::optional<Backdrop>& backdrop,
               const std::string& prefix = "");

}  // namespace caplet
