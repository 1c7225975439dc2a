// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Combines two pictures: multi-view EXR, and previews with both.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "film/image.h"

namespace caplet::report {

/// How a preview shows two views: side by side (left first), one above the other (left above), or
/// as an anaglyph with red of the left and green and blue of the right.
enum class StereoLayout { side_by_side, over_under, anaglyph };
/// These are the command line's names of StereoLayout.
inline constexpr std::array<const char*, 3> stereo_layout_names = {"sbs", "over-under", "anaglyph"};

/// Returns the bytes of both views, of equal size, 3 per pixel; `width` and `height` receive those
/// of the result.
std::vector<std::uint8_t> stereo_preview(StereoLayout layout, const std::vector<std::uint8_t>& left,
                                         const std::vector<std::uint8_t>& right, int& width,
                                         int& height);

/// Writes both views in one file, and the preview, developed once, in bands. An empty path is not
/// written. `channels`: those of a view, of 32 bits; `render_seconds` limits the time of
/// compression. Throws RunError.
void write_stereo_pictures(const std::filesystem::path& picture,
                           const std::filesystem::path& preview, const BandedImage& left,
                           const BandedImage& right, StereoLayout layout, std::size_t channels,
                           double render_seconds);

}  // namespace caplet::report
