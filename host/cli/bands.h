// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A render's picture, developed a few rows at a time from the device's film: neither film nor picture is in memory as a whole.
#pragma once

#include "device/device.h"
#include "film/image.h"
#include "scene/scene.h"
#include "shared/records.h"

namespace caplet::cli {

/// The most 32-bit layers that develop makes.
inline constexpr std::size_t most_channels = 19;

/// develop's layers (film/develop.h) of the film's sums, without metadata. Keeps references to `film`, `params` and `scene`.
BandedImage developed_in_bands(const Buffer<FilmRecord>& film, const ParamsRecord& params, const Scene& scene,
                               bool with_variance);

}  // namespace caplet::cli
