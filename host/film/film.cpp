// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/error.h"
#include "film/slots.h"

namespace caplet {

namespace {

std::size_t words_of(std::size_t layer) {
  return static_cast<std::size_t>(layer_rows[layer].count) *
         static_cast<std::size_t>(layer_rows[layer].words);
}

bool in_common(const Window& a, const Window& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

bool in_common(const FilmPart& a, const FilmPart& b) {
  return in_common(a.window, b.window) &&
         a.sample_begin < std::uint64_t{b.sample_begin} + b.sample_count &&
         b.sample_begin < std::uint64_t{a.sample_begin} + a.sample_count;
}

/// Extends `a` by `b` when they are next to each other; returns whether they are.
bool join(FilmPart& a, const FilmPart& b) {
  if (a.window == b.window) {
    if (std::uint64_t{a.sample_begin} + a.sample_count == b.sample_begin) {
      a.sample_count += b.sample_count;
      return true;
    }
    if (std::uint64_t{b.sample_begin} + b.sample_count == a.sample_begin) {
      a.sample_begin = b.sample_begin;
      a.sample_count += b.sample_count;
      return true;
    }
  }
  if (a.sample_begin != b.sample_begin || a.sample_count != b.sample_count) return false;
  if (a.window.x == b.window.x && a.window.width == b.window.width) {
    if (a.window.y + a.window.height != b.window.y && b.window.y + b.window.height != a.window.y)
      return false;
    a.window.y = std::min(a.window.y, b.window.y);
    a.window.height += b.window.height;
    return true;
  }
  if (a.window.y == b.window.y && a.window.height == b.window.height) {
    if (a.window.x + a.window.width != b.window.x && b.window.x + b.window.width != a.window.x)
      return false;
    a.window.x = std::min(a.window.x, b.window.x);
    a.window.width += b.window.width;
    return true;
  }
  return false;
}

}  // namespace

bool Window::holds(const Window& other) const {
  return x <= other.x && y <= other.y && other.x + other.width <= x + width &&
         other.y + other.height <= y + height;
}

std::size_t FilmLayout::words_per_pixel() const {
  std::size_t words = 1;
  for (std::size_t i = 0; i < layer_rows.size(); ++i)
    words += layers.has(static_cast<Layer>(i)) ? words_of(i) : 0;
  return words;
}

std::size_t FilmLayout::first_word(Layer layer) const {
  CHECK_EQ_(layers.has(layer), true);
  std::size_t word = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(layer); ++i)
    word += layers.has(static_cast<Layer>(i)) ? words_of(i) : 0;
  return word;
}

std::size_t FilmLayout::floats_per_path() const {
  std::size_t floats = 0;
  for (std::size_t i = 0; i < layer_rows.size(); ++i)
    if (layers.has(static_cast<Layer>(i)) && layer_rows[i].kind != LayerKind::radiance)
      floats += static_cast<std::size_t>(layer_rows[i].count);
  return floats;
}

void add_words(std::uint64_t* sum, const std::uint64_t* more, int words) {
  std::uint64_t carry = 0;
  for (int w = 0; w < words; ++w) {
    const std::uint64_t partial = sum[w] + more[w], total = partial + carry;
    carry = (partial < more[w] ? 1u : 0u) + (total < partial ? 1u : 0u);
    sum[w] = total;
  }
}

double value_of_words(const std::uint64_t* sum, int words, double unit) {
  const bool negative = sum[words - 1] >> 63 != 0;
  double value = 0;
  std::uint64_t carry = negative ? 1 : 0;
  for (int w = 0; w < words; ++w) {
    // The magnitude is summed from its least word on: each addition rounds by half a unit in the
    // last place at most.
    const std::uint64_t flipped = negative ? ~sum[w] : sum[w], word = flipped + carry;
    carry = word < flipped ? 1 : 0;
    value += static_cast<double>(word) * unit;
    unit *= 0x1p64;
  }
  return negative ? -value : value;
}

Film::Film(const FilmLayout& layout)
    : Film(layout, std::vector<std::uint64_t>(layout.window.pixels() * layout.words_per_pixel()),
           {}) {}

Film::Film(const FilmLayout& layout, std::vector<std::uint64_t> words, std::vector<FilmPart> parts)
    : layout_(layout),
      words_per_pixel_(layout.words_per_pixel()),
      words_(std::move(words)),
      parts_(std::move(parts)) {
  CHECK_EQ_(words_.size(), layout.window.pixels() * words_per_pixel_);
  for (std::size_t i = 0; i < layer_rows.size(); ++i) {
    if (!layout.layers.has(static_cast<Layer>(i))) continue;
    first_words_[i] = layout.first_word(static_cast<Layer>(i));
    if (layer_rows[i].unit)
      units_[i] =
          std::ldexp(1.0, layer_rows[i].unit(layout.color_exponent, layout.length_exponent));
  }
}

bool Film::is_even() const {
  for (std::size_t pixel = 1; pixel < layout_.window.pixels(); ++pixel)
    if (samples(pixel) != samples(0)) return false;
  return true;
}

double Film::mean_samples() const {
  const std::size_t pixels = layout_.window.pixels();
  double sum = 0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) sum += samples(pixel);
  return pixels > 0 ? sum / static_cast<double>(pixels) : 0;
}

double Film::sum(Layer layer, std::size_t c, std::size_t pixel) const {
  const auto row = static_cast<std::size_t>(layer);
  CHECK_LT_(0u, first_words_[row]);
  const int words = layer_rows[row].words;
  return value_of_words(
      &words_[pixel * words_per_pixel_ + first_words_[row] + c * static_cast<std::size_t>(words)],
      words, units_[row]);
}

std::uint32_t Film::number(Layer layer, std::size_t pixel) const {
  const std::size_t first = first_words_[static_cast<std::size_t>(layer)];
  CHECK_LT_(0u, first);
  return static_cast<std::uint32_t>(~words_[pixel * words_per_pixel_ + first]);
}

std::vector<Slot> Film::slots(Layer layer, std::size_t pixel) const {
  const auto row = static_cast<std::size_t>(layer);
  CHECK_LT_(0u, first_words_[row]);
  return slots_at(&words_[pixel * words_per_pixel_ + first_words_[row]],
                  layer_rows[row].words / CAPLET_SLOTS, units_[row]);
}

Film Film::with_parts(std::vector<FilmPart> parts) && {
  return Film(layout_, std::move(words_), std::move(parts));
}

Film Film::rows(int first, int count) const {
  FilmLayout part = layout_;
  part.window.y += first;
  part.window.height = count;
  const std::size_t row_words = static_cast<std::size_t>(part.window.width) * words_per_pixel_;
  const auto begin =
      words_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(first) * row_words);
  const auto end = begin + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(count) * row_words);
  return Film(part, {begin, end}, {});
}

void Film::add(const Film& other) {
  if (!(layout_ == other.layout_))
    throw InputError("films of different pictures, layers or scenes cannot be added");
  std::vector<FilmPart> parts = parts_;
  for (const FilmPart& part : other.parts_) add_part(parts, part);
  for (std::size_t pixel = 0; pixel < words_.size(); pixel += words_per_pixel_) {
    std::uint64_t* to = &words_[pixel];
    const std::uint64_t* from = &other.words_[pixel];
    *to++ += *from++;
    for (std::size_t i = 0; i < layer_rows.size(); ++i) {
      const LayerRow& row = layer_rows[i];
      if (!layout_.layers.has(static_cast<Layer>(i))) continue;
      for (int c = 0; c < row.count; ++c, to += row.words, from += row.words) {
        if (row.kind == LayerKind::id)
          *to = std::max(*to, *from);
        else if (row.kind == LayerKind::slots)
          add_slots(to, from, row.words / CAPLET_SLOTS);
        else
          add_words(to, from, row.words);
      }
    }
  }
  parts_ = std::move(parts);
}

void add_part(std::vector<FilmPart>& parts, const FilmPart& part) {
  for (const FilmPart& there : parts)
    if (in_common(there, part))
      throw InputError(fmt::format("samples {} to {} of pixel {},{} would be in the film twice",
                                   std::max(there.sample_begin, part.sample_begin),
                                   std::min(std::uint64_t{there.sample_begin} + there.sample_count,
                                            std::uint64_t{part.sample_begin} + part.sample_count),
                                   std::max(there.window.x, part.window.x),
                                   std::max(there.window.y, part.window.y)));
  FilmPart joined = part;
  for (std::size_t i = 0; i < parts.size();) {
    if (join(joined, parts[i])) {
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(i));
      i = 0;
    } else {
      ++i;
    }
  }
  parts.push_back(joined);
}

LayeredImage image_of(const FilmLayout& layout) {
  LayeredImage image;
  image.width = layout.width;
  image.height = layout.height;
  image.x = layout.window.x;
  image.y = layout.window.y;
  image.data_width = layout.window.width;
  image.data_height = layout.window.height;
  return image;
}

}  // namespace caplet
