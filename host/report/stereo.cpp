// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/stereo.h"

#include <algorithm>
#include <iterator>

#include "base/threads.h"
#include "film/preview.h"

namespace caplet::report {

std::vector<std::uint8_t> stereo_preview(StereoLayout layout, const std::vector<std::uint8_t>& left,
                                         const std::vector<std::uint8_t>& right, int& width,
                                         int& height) {
  std::vector<std::uint8_t> out;
  if (layout == StereoLayout::anaglyph) {
    out = right;
    for (std::size_t i = 0; i < out.size(); i += 3) out[i] = left[i];
    return out;
  }
  out.reserve(2 * left.size());
  if (layout == StereoLayout::over_under) {
    out = left;
    out.insert(out.end(), right.begin(), right.end());
    height *= 2;
    return out;
  }
  const auto row = static_cast<std::ptrdiff_t>(3) * width;
  for (std::ptrdiff_t y = 0; y < height; ++y)
    for (const auto* view : {&left, &right})
      out.insert(out.end(), view->begin() + y * row, view->begin() + (y + 1) * row);
  width *= 2;
  return out;
}

void write_stereo_pictures(const std::filesystem::path& picture,
                           const std::filesystem::path& preview, const BandedImage& left,
                           const BandedImage& right, StereoLayout layout, std::size_t channels,
                           double render_seconds) {
  std::array<std::vector<std::uint8_t>, 2> bytes;
  BandedImage both;
  both.whole = left.whole;
  both.whole.views = {"left", "right"};
  both.rows = std::min(left.rows, right.rows);
  both.band = [&](int first, int rows) {
    LayeredImage out;
    for (std::size_t view = 0; view < 2; ++view) {
      LayeredImage band = (view == 0 ? left : right).band(first, rows);
      if (!preview.empty()) {
        const std::vector<std::uint8_t> rgb = preview_rgb8(band);
        bytes[view].insert(bytes[view].end(), rgb.begin(), rgb.end());
      }
      for (Channel& channel : band.channels)
        channel.name = name_in_view(channel.name, both.whole.views, view);
      if (view == 0)
        out = std::move(band);
      else
        out.channels.insert(out.channels.end(), std::make_move_iterator(band.channels.begin()),
                            std::make_move_iterator(band.channels.end()));
    }
    return out;
  };
  int width = both.whole.data_width, height = both.whole.data_height;
  if (!picture.empty()) {
    const std::uint64_t size = 2 * static_cast<std::uint64_t>(width) *
                               static_cast<std::uint64_t>(height) * channels * sizeof(float);
    write_exr(picture, both, compression_for(size, render_seconds, usable_threads()));
  } else {
    for (int first = 0; first < height; first += both.rows)
      both.band(first, std::min(both.rows, height - first));
  }
  if (preview.empty()) return;
  const std::vector<std::uint8_t> shown = stereo_preview(layout, bytes[0], bytes[1], width, height);
  write_preview(preview, width, height, shown);
}

}  // namespace caplet::report
