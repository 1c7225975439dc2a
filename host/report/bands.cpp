// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/bands.h"

#include <algorithm>
#include <utility>

#include "film/preview.h"
#include "film/replicates.h"

namespace caplet::report {

namespace {

/// Calls rows(first, count), which returns these rows of the film as a film.
template <class Rows>
BandedImage in_bands(const FilmLayout& layout, const FilmSettings& settings, Layers layers,
                     PictureFlaws& flaws, Rows rows) {
  BandedImage out;
  out.whole = image_of(layout);
  out.whole.space = settings.space;
  out.whole.exposure = settings.exposure;
  out.rows = band_rows(out.whole.data_width, layers.channels());
  out.band = [&settings, &flaws, layers, rows, height = layout.window.height](int first,
                                                                              int count) {
    RowMargins margins;
    if (layers.has(Layer::variance)) {
      margins.above = std::min(first, variance_radius);
      margins.below = std::min(height - first - count, variance_radius);
    }
    return develop(rows(first - margins.above, margins.above + count + margins.below), settings,
                   layers, flaws, margins);
  };
  return out;
}

}  // namespace

BandedImage developed_in_bands(const DeviceFilm& film, const FilmSettings& settings, Layers layers,
                               PictureFlaws& flaws) {
  return in_bands(film.layout, settings, layers, flaws,
                  [&film](int first, int count) { return film.read(first, count); });
}

BandedImage developed_in_bands(const Film& film, const FilmSettings& settings, Layers layers,
                               PictureFlaws& flaws) {
  BandedImage out = in_bands(film.layout(), settings, layers, flaws,
                             [&film](int first, int count) { return film.rows(first, count); });
  if (film.is_even()) return out;
  out.band = [&film, band = std::move(out.band)](int first, int count) {
    LayeredImage rows = band(first, count);
    Channel samples{"samples", {}, {}};
    const auto width = static_cast<std::size_t>(rows.data_width),
               begin = static_cast<std::size_t>(first) * width;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count) * width; ++i)
      samples.uints.push_back(film.samples(begin + i));
    rows.channels.push_back(std::move(samples));
    return rows;
  };
  return out;
}

double fix_exposure(std::span<BandedImage> pictures, PictureFlaws& flaws) {
  const PreviewExposure asked = pictures.front().whole.exposure;
  if (!asked.is_automatic) return asked.stops;
  const PictureFlaws before = flaws;
  ExposureMeter meter;
  for (const BandedImage& picture : pictures) {
    const int height = picture.whole.data_height;
    for (int first = 0; first < height; first += picture.rows)
      meter.add(picture.band(first, std::min(picture.rows, height - first)));
  }
  flaws = before;
  set_exposure(pictures, meter.stops());
  return meter.stops();
}

void set_exposure(std::span<BandedImage> pictures, double stops) {
  for (BandedImage& picture : pictures) {
    picture.whole.exposure = {stops, false};
    picture.band = [stops, band = std::move(picture.band)](int first, int rows) {
      LayeredImage out = band(first, rows);
      out.exposure = {stops, false};
      return out;
    };
  }
}

LayeredImage whole_of(const BandedImage& picture) {
  LayeredImage out = picture.whole;
  const int height = out.data_height;
  for (int first = 0; first < height; first += picture.rows) {
    LayeredImage band = picture.band(first, std::min(picture.rows, height - first));
    if (out.channels.empty()) {
      out.channels = std::move(band.channels);
      continue;
    }
    for (std::size_t i = 0; i < out.channels.size(); ++i) {
      Channel &to = out.channels[i], &from = band.channels[i];
      to.floats.insert(to.floats.end(), from.floats.begin(), from.floats.end());
      to.uints.insert(to.uints.end(), from.uints.begin(), from.uints.end());
    }
  }
  return out;
}

}  // namespace caplet::report
