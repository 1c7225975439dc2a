// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The layers of a picture beside R G B A, which every picture has.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>

namespace caplet {

enum class Layer { depth, albedo, normal, position, object, primitive, variance };

/// As the command line calls them, in the order of Layer (docs/output.md).
inline constexpr std::array<const char*, 7> layer_names{"Z", "albedo", "N", "P", "object", "primitive", "variance"};

/// A set of layers.
class Layers {
 public:
  static Layers none() { return {}; }
  static Layers all() {
    Layers layers;
    layers.bits_.set();
    return layers;
  }
  /// All but the variance.
  static Layers usual() { return all().without(Layer::variance); }

  bool has(Layer layer) const { return bits_[index(layer)]; }
  Layers with(Layer layer) const {
    Layers out = *this;
    out.bits_.set(index(layer));
    return out;
  }
  Layers without(Layer layer) const {
    Layers out = *this;
    out.bits_.reset(index(layer));
    return out;
  }
  bool operator==(const Layers&) const = default;

 private:
  static std::size_t index(Layer layer) { return static_cast<std::size_t>(layer); }
  std::bitset<layer_names.size()> bits_;
};

}  // namespace caplet
