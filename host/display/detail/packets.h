// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string>
#include <vector>

#include "film/image.h"

namespace caplet::tev {

/// A rectangle of the display window.
struct Tile {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Makes a picture of this name, black and of the display window's size, in place of one that there is.
std::string create_packet(const std::string& name, const LayeredImage& image);
/// The values of a tile within the data window: all channels, one after the other; ids as floats.
std::string update_packet(const std::string& name, const LayeredImage& image, const Tile& tile);
/// The tiles of the data window in which `now` differs from `before`; all of them where that has no channels.
std::vector<Tile> changed_tiles(const LayeredImage& before, const LayeredImage& now);

}  // namespace caplet::tev
