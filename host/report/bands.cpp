// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/bands.h"

namespace caplet::report {

BandedImage developed_in_bands(const DeviceFilm& film, const Scene& scene, Layers layers, NotFinite& not_finite) {
  BandedImage out;
  out.whole = image_of(film.layout);
  out.whole.space = scene.film.space;
  out.rows = band_rows(out.whole.data_width, layers.channels());
  out.band = [&film, &scene, &not_finite, layers](int first, int rows) {
    return develop(film.read(first, rows), scene, layers, not_finite);
  };
  return out;
}

}  // namespace caplet::report
