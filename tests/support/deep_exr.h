// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads deep pictures with the channels A and Z.
#pragma once

#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineInputFile.h>

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

namespace caplet::test {

/// Alpha and depth of the samples of each pixel of the data window, row by row.
inline std::vector<std::vector<std::pair<float, float>>> read_deep(
    const std::filesystem::path& path) {
  Imf::DeepScanLineInputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1),
             pixels = width * static_cast<std::size_t>(window.max.y - window.min.y + 1);
  std::vector<unsigned> counts(pixels);
  std::vector<float*> alphas(pixels), depths(pixels);
  const auto base = [&](auto& values) {  // where OpenEXR would look for pixel (0, 0)
    return reinterpret_cast<char*>(
        values.data() -
        (window.min.y * static_cast<std::ptrdiff_t>(width) + std::ptrdiff_t{window.min.x}));
  };
  Imf::DeepFrameBuffer frame;
  frame.insertSampleCountSlice(
      Imf::Slice(Imf::UINT, base(counts), sizeof(unsigned), width * sizeof(unsigned)));
  for (auto [name, samples] : {std::pair{"A", &alphas}, std::pair{"Z", &depths}})
    frame.insert(name, Imf::DeepSlice(Imf::FLOAT, base(*samples), sizeof(float*),
                                      width * sizeof(float*), sizeof(float)));
  file.setFrameBuffer(frame);
  file.readPixelSampleCounts(window.min.y, window.max.y);
  std::vector<std::vector<float>> alpha(pixels), depth(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    alpha[i].resize(counts[i]);
    depth[i].resize(counts[i]);
    alphas[i] = alpha[i].data();
    depths[i] = depth[i].data();
  }
  file.readPixels(window.min.y, window.max.y);
  std::vector<std::vector<std::pair<float, float>>> out(pixels);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t s = 0; s < counts[i]; ++s) out[i].emplace_back(alpha[i][s], depth[i][s]);
  return out;
}

}  // namespace caplet::test
