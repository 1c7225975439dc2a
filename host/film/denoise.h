// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Removes noise by Open Image Denoise (https://www.openimagedenoise.org), a library that is loaded
// when it is asked for.
#pragma once

#include <functional>
#include <string>

#include "film/image.h"

namespace caplet {

/// Throws RunError, which names `flag` and how to get it, where the library cannot be loaded.
void check_denoiser(const std::string& flag);
/// Returns whether it can be loaded.
bool has_denoiser();
/// Returns its name and version, for metadata. Throws RunError.
std::string denoiser_name();

/// `full` takes 1.6 times as long as `quick`, which viewers use, and its FLIP is 3 to 15 % less
/// (decision 36).
enum class DenoiseQuality { full, quick };

/// Replaces R G B, scene-linear, by a picture without noise, and keeps what they were as noisy.R
/// noisy.G noisy.B. albedo.R/G/B and N.X/Y/Z guide it where both are there; they are denoised
/// themselves before. The picture is that of shapes and sky, before a backdrop is put under it.
/// Where `goes_on` is given, it is asked again and again, and false ends the work. Returns whether
/// it is complete; else the image is as it was. Throws RunError.
bool denoise(LayeredImage& image, DenoiseQuality quality = DenoiseQuality::full,
             const std::function<bool()>& goes_on = {});

}  // namespace caplet
