// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Numbers of any kind from a fuzzer's bytes: round ones, special ones, any bits.
#pragma once

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

#include "host_kernels/model_maker.h"

namespace caplet::test {

/// Zeros once the bytes have run out.
class FuzzNumbers : public NumberSource {
 public:
  FuzzNumbers(const std::uint8_t* data, std::size_t size) : bytes_(data, size) {}
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t first = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return first;
  }
  bool ended() const { return bytes_.empty(); }
  unsigned below(unsigned n) override { return byte() % n; }
  double coordinate() override { return number(); }
  /// Half of them small and positive.
  double length() override {
    const std::uint8_t first = byte();
    return first < 128 ? (first + 1) / 32.0 : number();
  }
  double fraction() override { return byte() / 255.0; }

  /// Any float.
  float number() {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    static constexpr float specials[] = {0.0f,
                                         -0.0f,
                                         1.0f,
                                         -1.0f,
                                         infinity,
                                         -infinity,
                                         std::numeric_limits<float>::quiet_NaN(),
                                         FLT_MIN,
                                         -FLT_MIN,
                                         0x1p-149f,
                                         -0x1p-149f,
                                         0x1p-126f,
                                         FLT_MAX,
                                         -FLT_MAX,
                                         0x1p-60f,
                                         1e18f,
                                         -1e18f,
                                         1e9f,
                                         1e-9f,
                                         1e-18f,
                                         0x1p-24f,
                                         0x1p24f,
                                         0x1.000002p0f,
                                         1e15f};
    const std::uint8_t first = byte();
    if (first < 160) return static_cast<float>(first - 80) / 8;
    if (first < 160 + std::size(specials)) return specials[first - 160];
    if (first < 200) {  // near a round one
      const float near = static_cast<float>(byte() - 128) / 16;
      return std::nextafter(near, first & 1 ? infinity : -infinity);
    }
    std::uint8_t word[4];
    for (std::uint8_t& part : word) part = byte();
    float any;
    std::memcpy(&any, word, sizeof any);
    if (first < 228)
      any = std::ldexp(std::fmod(any, 1.0f), first - 214);  // of a scale that scenes have
    return any;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

}  // namespace caplet::test
