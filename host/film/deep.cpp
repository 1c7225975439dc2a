// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/deep.h"

namespace caplet {

std::vector<DeepSample> deep_samples(const Film& film, std::size_t pixel) {
  std::vector<Slot> slots = film.slots(Layer::deep, pixel);
  double hits = film.sum(Layer::coverage, 0, pixel), distances = film.sum(Layer::depth, 0, pixel);
  for (const Slot& slot : slots) {
    hits -= slot.samples;
    distances -= slot.sum;
  }
  if (hits > 0) slots.push_back({0, static_cast<std::uint32_t>(hits), distances});
  std::vector<DeepSample> out;
  double left = film.samples(pixel);  // samples that nothing has stopped yet
  for (const Slot& slot : slots) {
    out.push_back(
        {static_cast<float>(slot.sum / slot.samples), static_cast<float>(slot.samples / left)});
    left -= slot.samples;
  }
  return out;
}

}  // namespace caplet
