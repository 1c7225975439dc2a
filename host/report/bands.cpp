// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/bands.h"

#include <utility>

namespace caplet::report {

namespace {

/// Calls rows(first, count), which returns these rows of the film as a film.
template <class Rows>
BandedImage in_bands(const FilmLayout& layout, const FilmSettings& settings, Layers layers,
                     NotFinite& not_finite, Rows rows) {
  BandedImage out;
  out.whole = image_of(layout);
  out.whole.space = settings.space;
  out.rows = band_rows(out.whole.data_width, layers.channels());
  out.band = [&settings, &not_finite, layers, rows](int first, int count) {
    return develop(rows(first, count), settings, layers, not_finite);
  };
  return out;
}

}  // namespace

BandedImage developed_in_bands(const DeviceFilm& film, const FilmSettings& settings, Layers layers,
                               NotFinite& not_finite) {
  return in_bands(film.layout, settings, layers, not_finite,
                  [&film](int first, int count) { return film.read(first, count); });
}

BandedImage developed_in_bands(const Film& film, const FilmSettings& settings, Layers layers,
                               NotFinite& not_finite) {
  return in_bands(film.layout(), settings, layers, not_finite,
                  [&film](int first, int count) { return film.rows(first, count); });
}

}  // namespace caplet::report
