// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds the layers of a film and of a picture: shared/layers.def.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "shared/kinds.h"
#include "shared/limits.h"

namespace caplet {

enum class Layer {
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value) name,
#define HIT_LAYER(name, option, channels, how, count, words, unit, value) name,
#define ID_LAYER(name, option, channel, value) name,
#define SLOT_LAYER(name, option, channels, how, words, unit, value) name,
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER
};

/// LayerKind says what a layer's values are, in the film.
enum class LayerKind { radiance, hit, id, slots };

/// LayerHow says how they become channels (develop.cpp).
enum class LayerHow {
  picture,
  share,
  distance,
  reflectance,
  direction,
  mean,
  variance,
  number,
  matte,
  deep
};

/// LayerRow is a row of layers.def.
struct LayerRow {
  LayerKind kind;
  const char* option;    // as the command line calls it; "": every picture has it
  const char* channels;  // their names, between commas; of a matte that of the whole layer
  LayerHow how;
  int count;                           // of values of a sample
  int words;                           // 64-bit words of each one's sum, or of all slots
  int (*unit)(int color, int length);  // sums are whole numbers of 2^unit; numbers have none
};

inline constexpr std::array<LayerRow, layer_count> layer_rows{{
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value) \
  {LayerKind::radiance,                                                        \
   option,                                                                     \
   channels,                                                                   \
   LayerHow::how,                                                              \
   count,                                                                      \
   words,                                                                      \
   []([[maybe_unused]] int color, [[maybe_unused]] int length) { return unit; }},
#define HIT_LAYER(name, option, channels, how, count, words, unit, value) \
  {LayerKind::hit,                                                        \
   option,                                                                \
   channels,                                                              \
   LayerHow::how,                                                         \
   count,                                                                 \
   words,                                                                 \
   []([[maybe_unused]] int color, [[maybe_unused]] int length) { return unit; }},
#define ID_LAYER(name, option, channel, value) \
  {LayerKind::id, option, channel, LayerHow::number, 1, 1, nullptr},
#define SLOT_LAYER(name, option, channels, how, words, unit, value) \
  {LayerKind::slots,                                                \
   option,                                                          \
   channels,                                                        \
   LayerHow::how,                                                   \
   1,                                                               \
   CAPLET_SLOTS * (words),                                          \
   []([[maybe_unused]] int color, [[maybe_unused]] int length) { return unit; }},
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER
}};

constexpr const LayerRow& row_of(Layer layer) {
  return layer_rows[static_cast<std::size_t>(layer)];
}

/// Returns the channels of a picture that a layer becomes. `matte_levels`: FilmSettings.
constexpr int channels_of(const LayerRow& row, int matte_levels) {
  if (row.how == LayerHow::matte) return 4 * ((matte_levels + 1) / 2);
  return row.how == LayerHow::deep ? 0 : row.count;
}

inline constexpr std::array matte_layers = {Layer::crypto_object, Layer::crypto_material,
                                            Layer::crypto_asset};

/// Layers is a set of layers; R G B A (color and coverage) are always among them.
class Layers {
 public:
  /// Returns R G B A alone.
  static constexpr Layers none() { return {}; }
  /// Returns all but those of slots, which take much memory.
  static constexpr Layers all() {
    Layers layers = every();
    for (std::size_t i = 0; i < layer_rows.size(); ++i)
      if (layer_rows[i].kind == LayerKind::slots) layers = layers.without(static_cast<Layer>(i));
    return layers;
  }
  static constexpr Layers every() {
    Layers layers;
    layers.bits_ = (1u << layer_count) - 1;
    return layers;
  }
  /// Returns R G B A and the mattes.
  static constexpr Layers mattes() {
    Layers layers;
    for (const Layer layer : matte_layers) layers = layers.with(layer);
    return layers;
  }
  /// Returns all but the variance.
  static constexpr Layers usual() { return all().without(Layer::variance); }
  /// Returns the layers of bits 1 << layer_color, ...
  static constexpr Layers of_bits(std::uint32_t bits) {
    Layers layers = every();
    layers.bits_ &= bits | none().bits_;
    return layers;
  }

  constexpr std::uint32_t bits() const { return bits_; }
  constexpr bool has(Layer layer) const { return (bits_ & bit(layer)) != 0; }
  constexpr Layers with(Layer layer) const {
    Layers out = *this;
    out.bits_ |= bit(layer);
    return out;
  }
  constexpr Layers without(Layer layer) const {
    Layers out = *this;
    out.bits_ &= ~bit(layer) | none().bits_;
    return out;
  }
  /// Returns whether all of `others` are among these.
  constexpr bool has_all(Layers others) const { return (others.bits_ & ~bits_) == 0; }
  /// Returns the number of 32-bit channels of a picture with these layers.
  constexpr std::size_t channels(int matte_levels = 6) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < layer_rows.size(); ++i)
      if (bits_ >> i & 1u)
        count += static_cast<std::size_t>(channels_of(layer_rows[i], matte_levels));
    return count;
  }
  bool operator==(const Layers&) const = default;

 private:
  static constexpr std::uint32_t bit(Layer layer) { return 1u << static_cast<unsigned>(layer); }
  std::uint32_t bits_ = 1u << layer_color | 1u << layer_coverage;
};

}  // namespace caplet
