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
  /// 32-bit channels of a picture with these layers, R G B A among them.
  std::size_t channels() const {
    constexpr std::array<std::size_t, layer_names.size()> of_layer{1, 3, 3, 3, 1, 1, 3};  // in the order of Layer
    std::size_t count = 4;
    for (std::size_t i = 0; i < of_layer.size(); ++i) count += bits_[i] ? of_layer[i] : 0;
    return count;
  }
  bool operator==(const Layers&) const = default;

 private:
  static std::size_t index(Layer layer) { return static_cast<std::size_t>(layer); }
  std::bitset<layer_names.size()> bits_;
};

}  // namespace caplet
