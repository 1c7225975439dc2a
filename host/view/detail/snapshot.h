// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures for the page: those that it shows, and whole files.
#pragma once

#include <string>

#include "film/image.h"
#include "view/picture.h"

namespace caplet::view {

/// Returns colours in linear sRGB, ids if asked for, and the noise from the image's variance.
Picture shown_of(const LayeredImage& image, bool ids);

/// Returns the image as an EXR file. Throws RunError.
std::string exr_bytes(const LayeredImage& image);

}  // namespace caplet::view
