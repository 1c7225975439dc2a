// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Mattes of Cryptomatte 1.2.0: which things a pixel shows, and how much of it each covers.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "film/film.h"

namespace caplet {

struct MatteRank {
  float id = 0;        // the bits are matte_hash of the name
  float coverage = 0;  // share of the pixel's camera rays
};

/// Returns the things that a pixel shows, in the order of their coverage, the greatest first; those
/// of the same coverage in the order of their hashes.
std::vector<MatteRank> matte_ranks(const Film& film, Layer layer, std::size_t pixel);

/// Returns the name of channel `channel` of a matte: "CryptoObject00.R" of "CryptoObject" and 0.
std::string matte_channel(const std::string& matte, int channel);

/// Returns whether some samples of the pixel that hit something have no slot in the layer: it shows
/// more than CAPLET_SLOTS things.
bool lacks_slots(const Film& film, Layer layer, std::size_t pixel);

}  // namespace caplet
