// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures for the page: what it shows, and whole files.
#pragma once

#include <string>

#include "film/image.h"
#include "view/picture.h"

namespace caplet::view {

/// Colours in linear sRGB, ids where they are asked for, and the noise by the image's variance.
Picture shown_of(const LayeredImage& image, bool ids);

/// The image as an EXR file. Throws RunError.
std::string exr_bytes(const LayeredImage& image);

}  // namespace caplet::view
