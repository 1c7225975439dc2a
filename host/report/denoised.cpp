// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/denoised.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "film/denoise.h"
#include "report/bands.h"

namespace caplet::report {

namespace {

LayeredImage rows_of(const LayeredImage& image, int first, int rows) {
  LayeredImage out = image;
  out.channels.clear();
  out.y += first;
  out.data_height = rows;
  const auto begin = static_cast<std::ptrdiff_t>(first) * image.data_width,
             end = begin + static_cast<std::ptrdiff_t>(rows) * image.data_width;
  for (const Channel& channel : image.channels) {
    out.channels.push_back({channel.name, {}, {}});
    if (channel.uints.empty())
      out.channels.back().floats.assign(channel.floats.begin() + begin,
                                        channel.floats.begin() + end);
    else
      out.channels.back().uints.assign(channel.uints.begin() + begin, channel.uints.begin() + end);
  }
  return out;
}

template <class AnyFilm>
BandedImage developed_of(const AnyFilm& film, const FilmLayout& layout,
                         const FilmSettings& settings, Layers layers, PictureFlaws& flaws) {
  if (!settings.denoise) return developed_in_bands(film, settings, layers, flaws);
  const Layers needed =
      layout.layers.has_all(denoising_layers()) ? denoising_layers() : Layers::none();
  FilmSettings alone = settings;
  alone.backdrop.reset();
  const auto image = std::make_shared<LayeredImage>(whole_of(
      developed_in_bands(film, alone, Layers::of_bits(layers.bits() | needed.bits()), flaws)));
  denoise(*image);
  std::erase_if(image->channels, [&](const Channel& channel) {
    return !layers.has(Layer::albedo) && channel.name.starts_with("albedo.");
  });
  std::erase_if(image->channels, [&](const Channel& channel) {
    return !layers.has(Layer::normal) && channel.name.starts_with("N.");
  });
  put_under(*image, settings.backdrop, "noisy.");
  put_under(*image, settings.backdrop);
  BandedImage out;
  out.whole = *image;
  out.whole.channels.clear();
  out.rows = band_rows(image->data_width, image->channels.size());
  out.band = [image](int first, int rows) { return rows_of(*image, first, rows); };
  return out;
}

}  // namespace

Layers denoising_layers() { return Layers::none().with(Layer::albedo).with(Layer::normal); }

BandedImage developed(const DeviceFilm& film, const FilmSettings& settings, Layers layers,
                      PictureFlaws& flaws) {
  return developed_of(film, film.layout, settings, layers, flaws);
}

BandedImage developed(const Film& film, const FilmSettings& settings, Layers layers,
                      PictureFlaws& flaws) {
  return developed_of(film, film.layout(), settings, layers, flaws);
}

}  // namespace caplet::report
