// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/mattes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace caplet {

std::vector<MatteRank> matte_ranks(const Film& film, Layer layer, std::size_t pixel) {
  std::vector<Slot> slots = film.slots(layer, pixel);
  std::ranges::stable_sort(slots, std::ranges::greater(), &Slot::samples);
  std::vector<MatteRank> out;
  for (const Slot& slot : slots)
    out.push_back({std::bit_cast<float>(slot.key),
                   static_cast<float>(slot.samples / static_cast<double>(film.samples(pixel)))});
  return out;
}

std::string matte_channel(const std::string& matte, int channel) {
  return fmt::format("{}{:02}.{}", matte, channel / 4, "RGBA"[channel % 4]);
}

bool lacks_slots(const Film& film, Layer layer, std::size_t pixel) {
  double in_slots = 0;
  for (const Slot& slot : film.slots(layer, pixel)) in_slots += slot.samples;
  return in_slots < film.sum(Layer::coverage, 0, pixel);
}

}  // namespace caplet
