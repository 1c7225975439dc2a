// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files of fibres made of bytes.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet::test {

/// Bytes of numbers, one after the other.
class Writer {
 public:
  explicit Writer(bool swapped = false) : swapped_(swapped) {}
  template <class Number>
  Writer& put(Number value) {
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof value);
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    out_.append(bytes.data(), bytes.size());
    return *this;
  }
  template <class Number>
  Writer& put_at(std::size_t at, Number value) {
    const std::string before = out_.substr(at + sizeof value);
    out_.resize(at);
    put(value);
    out_ += before;
    return *this;
  }
  Writer& fill(std::size_t size) {
    out_.resize(size, '\0');
    return *this;
  }
  Writer& text(const std::string& text) {
    out_ += text;
    return *this;
  }
  const std::string& bytes() const { return out_; }

 private:
  bool swapped_;
  std::string out_;
};

inline Scene scene_of(const std::string& name, const std::string& bytes,
                      const ImportOptions& options = {}) {
  return import_scene(write_file(name, bytes), NoImages(), options);
}

inline std::string hair_file(std::uint32_t strands, std::uint32_t points, std::uint32_t flags,
                             const Writer& arrays) {
  Writer out;
  out.text("HAIR")
      .put(strands)
      .put(points)
      .put(flags)
      .put(std::uint32_t{1})
      .put(0.5F)
      .put(0.0F)
      .put(0.9F)
      .put(0.5F)
      .put(0.25F)
      .fill(128);
  return out.bytes() + arrays.bytes();
}

inline std::string trk_file(glm::vec3 p, const std::string& order,
                            const std::array<float, 16>& matrix, bool swapped) {
  Writer out(swapped);
  out.text("TRACK")
      .fill(6)
      .put(std::int16_t{10})
      .put(std::int16_t{20})
      .put(std::int16_t{30})
      .put(2.0F)
      .put(3.0F)
      .put(4.0F)
      .fill(36);
  out.put(std::int16_t{1}).fill(238).put(std::int16_t{2}).fill(440);
  for (const float value : matrix) out.put(value);
  out.fill(948).text(order).fill(992).put(std::int32_t{2}).put(std::int32_t{1000});
  for (int track = 0; track < 2; ++track) {
    out.put(std::int32_t{1 + track});
    for (int i = 0; i <= track; ++i) out.put(p.x).put(p.y).put(p.z).put(7.0F);
    out.put(1.0F).put(1.0F);
  }
  return out.bytes();
}

}  // namespace caplet::test
