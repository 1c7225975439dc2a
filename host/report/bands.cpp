// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/bands.h"

#include "base/check.h"

namespace caplet::report {

BandedImage developed_in_bands(const Buffer<FilmRecord>& film, const ParamsRecord& params, const Scene& scene, Layers layers,
                               NotFinite& not_finite) {
  BandedImage out;
  out.whole.width = narrow<int>(params.width);
  out.whole.height = narrow<int>(params.height);
  out.whole.x = narrow<int>(params.crop_x);
  out.whole.y = narrow<int>(params.crop_y);
  out.whole.data_width = narrow<int>(params.crop_width);
  out.whole.data_height = narrow<int>(params.crop_height);
  out.whole.space = scene.film.space;
  out.rows = band_rows(out.whole.data_width, layers.channels());
  out.band = [&film, &params, &scene, &not_finite, layers](int first, int rows) {
    const std::size_t width = params.crop_width;
    std::vector<FilmRecord> sums(static_cast<std::size_t>(rows) * width);
    film.RawBuffer::read(sums.data(), static_cast<std::size_t>(first) * width * sizeof(FilmRecord),
                         sums.size() * sizeof(FilmRecord));
    ParamsRecord window = params;
    window.crop_y += narrow<cl_uint>(first);
    window.crop_height = narrow<cl_uint>(rows);
    return develop(sums, window, scene, layers, not_finite);
  };
  return out;
}

}  // namespace caplet::report
