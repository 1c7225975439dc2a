// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes the picture of `caplet verify --heatmap`.
#pragma once

#include <filesystem>
#include <vector>

#include "verify/verify.h"

namespace caplet::report {

/// The number of channels that write_heatmap writes.
inline constexpr std::size_t heatmap_channels = 5 + verify::quantity_names.size();

/// Channels t, point, normal, uv: errors in units of the allowed ones; grazing and disagrees: 0 or
/// 1; R G B: the greatest of the four from black (0) over blue and yellow to white (1), red where
/// device and reference disagree, dark grey where nothing is hit. `pixels`: the window of the
/// scene's film. Throws RunError.
void write_heatmap(const std::filesystem::path& path, const Scene& scene,
                   const std::vector<verify::HeatPixel>& pixels);

}  // namespace caplet::report
