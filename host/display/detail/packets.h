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

/// Makes a black picture of this name with the display window's size, and replaces an existing one.
std::string create_packet(const std::string& name, const LayeredImage& image);
/// Returns the values of a tile within the data window: all channels in turn, with ids as floats.
std::string update_packet(const std::string& name, const LayeredImage& image, const Tile& tile);
/// Returns the tiles of the data window in which `now` differs from `before`; all of them if
/// `before` has no channels.
std::vector<Tile> changed_tiles(const LayeredImage& before, const LayeredImage& now);

}  // namespace caplet::tev
