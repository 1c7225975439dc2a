// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures that the page shows.
#pragma once

#include "film/image.h"
#include "view/picture.h"

namespace caplet::view {

/// Returns colours in linear sRGB, and ids if asked for.
Picture shown_of(const LayeredImage& image, bool ids);

}  // namespace caplet::view
