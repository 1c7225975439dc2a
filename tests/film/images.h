// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Small images and raw files for the film tests.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "film/image.h"

namespace caplet::test {

inline std::string file_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// 7 x 5 pixels from (2, 1) of a 16 x 9 picture; every value of every channel differs.
inline LayeredImage layered_image() {
  LayeredImage image;
  image.width = 16;
  image.height = 9;
  image.x = 2;
  image.y = 1;
  image.data_width = 7;
  image.data_height = 5;
  float value = -3.25f;
  for (const char* name :
       {"R", "G", "B", "A", "Z", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "P.X",
        "P.Y", "P.Z", "variance.R", "variance.G", "variance.B"}) {
    Channel channel{name, {}, {}};
    for (int i = 0; i < 35; ++i) channel.floats.push_back(value += 0.37f);
    image.channels.push_back(channel);
  }
  for (const char* name : {"object.id", "primitive.id"}) {
    Channel channel{name, {}, {}};
    for (std::uint32_t i = 0; i < 35; ++i) channel.uints.push_back(0xffffffffu - 97u * i);
    image.channels.push_back(channel);
  }
  return image;
}

/// `bytes` with the attribute's value (found by its name and type) replaced.
inline std::string with_attribute(std::string bytes, const std::string& name,
                                  const std::string& type, const std::string& value) {
  const std::string head = name + '\0' + type + '\0';
  const std::size_t at = bytes.find(head);
  if (at == std::string::npos) return {};
  return bytes.replace(at + head.size() + 4, value.size(), value);
}

template <class... Values>
std::string little_endian(Values... values) {
  std::string out;
  (out.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
  return out;
}

}  // namespace caplet::test
