// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures that the page shows.
#pragma once

#include <optional>

#include "film/image.h"
#include "scene/backdrop.h"
#include "view/picture.h"

namespace caplet::view {

/// Returns whether the page puts the backdrop under pictures, by their alpha: one colour, or none.
/// Others are in the pictures' colours.
bool is_put_under_by_page(const std::optional<Backdrop>& backdrop);

/// Returns colours in linear sRGB, and coverage and ids if asked for.
Picture shown_of(const LayeredImage& image, bool ids, bool has_alpha);

}  // namespace caplet::view
