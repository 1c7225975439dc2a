// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Two pictures as one: multi-view EXR, and previews with both.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/image.h"

namespace caplet::report {

/// How a preview shows two views: beside each other (left first), one over the other (left above), or red of the left and the
/// rest of the right.
enum class StereoLayout { side_by_side, over_under, anaglyph };
/// By the names of StereoLayout on the command line.
inline constexpr std::array<const char*, 3> stereo_layout_names = {"sbs", "over-under", "anaglyph"};

/// Bytes of both views, of the same size, 3 a pixel; `width` and `height` become those of the whole.
std::vector<std::uint8_t> stereo_preview(StereoLayout layout, const std::vector<std::uint8_t>& left,
                                         const std::vector<std::uint8_t>& right, int& width, int& height);

/// Both views in one file, and the preview, each developed once, band by band. An empty path: not written. `channels`: 32-bit
/// ones of a view; `render_seconds` weighs how long packing may take. Throws RunError.
void write_stereo_pictures(const std::filesystem::path& picture, const std::filesystem::path& preview, const BandedImage& left,
                           const BandedImage& right, StereoLayout layout, std::size_t channels, double render_seconds);

}  // namespace caplet::report
