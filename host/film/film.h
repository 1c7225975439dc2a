// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A film holds the sums of samples, before it is a picture. Its sums are exact
// (kernels/math/exact.cl), so that samples may come in any order, from any number of devices and
// runs, and the same samples always make the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "film/image.h"
#include "film/layers.h"
#include "film/slots.h"

namespace caplet {

/// Window is pixels [x, x + width) times [y, y + height) of an image.
struct Window {
  int x = 0, y = 0, width = 0, height = 0;
  std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  /// Returns whether all of `other` lies within.
  bool holds(const Window& other) const;
  bool operator==(const Window&) const = default;
};

/// Exponents of a film are within plus and minus this, so that sums keep their range
/// (kernels/math/exact.cl).
inline constexpr int largest_film_exponent = 60;

/// FilmLayout says what the words of a film mean. Films with the same layout may be added.
struct FilmLayout {
  int width = 0, height = 0;  // of the full image
  Window window;              // that there are sums of
  Layers layers;
  int color_exponent = 0;   // 2^this is about the radiance of the brightest light
  int length_exponent = 0;  // and the extent of the scene, its camera included

  /// Returns the 64-bit words of a pixel: its samples, those of the first replicate in the upper
  /// half, then each layer's in the order of layers.def.
  std::size_t words_per_pixel() const;
  /// Returns the first of these words that belongs to a layer that the film has.
  std::size_t first_word(Layer layer) const;
  /// Returns the floats of a path in path_layers (groups.h).
  std::size_t floats_per_path() const;
  bool operator==(const FilmLayout&) const = default;
};

/// FilmPart is samples [sample_begin, sample_begin + sample_count) of each pixel of a window.
struct FilmPart {
  Window window;
  std::uint32_t sample_begin = 0, sample_count = 0;
  bool operator==(const FilmPart&) const = default;
};

/// Adds a sum of `words` words, two's complement, least significant first.
void add_words(std::uint64_t* sum, const std::uint64_t* more, int words);
/// Returns the sum's value as a double, times `unit`, a power of two.
double value_of_words(const std::uint64_t* sum, int words, double unit);

class Film {
 public:
  Film() = default;
  /// Makes a film without samples.
  explicit Film(const FilmLayout& layout);
  /// Makes a film of words that a device made: layout.window.pixels() times
  /// layout.words_per_pixel(), row-major.
  Film(const FilmLayout& layout, std::vector<std::uint64_t> words, std::vector<FilmPart> parts);

  const FilmLayout& layout() const { return layout_; }
  /// Returns the samples that are in it.
  const std::vector<FilmPart>& parts() const { return parts_; }
  std::span<const std::uint64_t> words() const { return words_; }
  std::span<std::uint64_t> words() { return words_; }

  /// Returns the samples of a pixel, counted row by row in the window.
  std::uint32_t samples(std::size_t pixel) const {
    return static_cast<std::uint32_t>(words_[pixel * words_per_pixel_]);
  }
  /// Returns whether all pixels have as many.
  bool is_even() const;
  /// Returns their mean over the pixels; 0 without pixels.
  double mean_samples() const;
  /// Returns how many of them are of the first replicate: those of even number.
  std::uint32_t first_replicate_samples(std::size_t pixel) const {
    return static_cast<std::uint32_t>(words_[pixel * words_per_pixel_] >> 32);
  }
  /// Returns the sum of component `c` of a layer that the film has (not of numbers).
  double sum(Layer layer, std::size_t c, std::size_t pixel) const;
  /// Returns the number of a layer of numbers: that of the sample with the lowest sample number;
  /// CAPLET_NONE: that sample hit nothing, or there is none.
  std::uint32_t number(Layer layer, std::size_t pixel) const;
  /// Returns the slots of a layer of slots, in the order of their keys.
  std::vector<Slot> slots(Layer layer, std::size_t pixel) const;

  /// Returns the film with the list of its samples replaced.
  Film with_parts(std::vector<FilmPart> parts) &&;
  /// Returns `count` of its rows from `first` on, without the list of samples.
  Film rows(int first, int count) const;

  /// Adds the samples of another film. Throws InputError, and changes nothing, when the two are not
  /// of one layout or have samples in common.
  void add(const Film& other);

 private:
  FilmLayout layout_;
  std::size_t words_per_pixel_ = 0;
  // These are by layer: its first word of a pixel, 0 where the film does not have it, and its sums'
  // unit.
  std::array<std::size_t, layer_count> first_words_{};
  std::array<double, layer_count> units_{};
  std::vector<std::uint64_t> words_;
  std::vector<FilmPart> parts_;
};

/// Returns an image with the windows of a film, and no channels.
LayeredImage image_of(const FilmLayout& layout);

/// Adds a part to a list of parts without common samples, and joins parts where possible. Throws
/// InputError when they have samples in common with it.
void add_part(std::vector<FilmPart>& parts, const FilmPart& part);

}  // namespace caplet
