// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/slots.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/check.h"

namespace caplet {

namespace {

constexpr int most_words = 2;

std::uint32_t key_of(const std::uint64_t* slot) { return static_cast<std::uint32_t>(*slot >> 32); }
std::uint32_t samples_of(const std::uint64_t* slot) { return static_cast<std::uint32_t>(*slot); }

}  // namespace

std::vector<Slot> slots_at(const std::uint64_t* words_of_pixel, int words, double unit) {
  CHECK_LE_(words, most_words);
  std::vector<Slot> out;
  const std::uint64_t* const end =
      words_of_pixel + static_cast<std::ptrdiff_t>(words) * CAPLET_SLOTS;
  for (const std::uint64_t* slot = words_of_pixel; slot != end && samples_of(slot) != 0;
       slot += words)
    out.push_back(
        {key_of(slot), samples_of(slot), words == 2 ? static_cast<double>(slot[1]) * unit : 0});
  return out;
}

void add_slots(std::uint64_t* to, const std::uint64_t* from, int words) {
  CHECK_LE_(words, most_words);
  if (samples_of(from) == 0) return;
  const auto size = static_cast<std::ptrdiff_t>(words) * CAPLET_SLOTS;
  std::array<std::uint64_t, most_words * CAPLET_SLOTS> sum{};
  const std::uint64_t *a = to, *b = from, *const a_end = to + size, *const b_end = from + size;
  const auto has_more = [](const std::uint64_t* slot, const std::uint64_t* end) {
    return slot != end && samples_of(slot) != 0;
  };
  std::uint64_t* slot = sum.data();
  for (const std::uint64_t* const end = slot + size; slot != end; slot += words) {
    const bool in_a = has_more(a, a_end), in_b = has_more(b, b_end);
    if (!in_a && !in_b) break;
    const bool takes_a = in_a && (!in_b || key_of(a) <= key_of(b)),
               takes_b = in_b && (!in_a || key_of(b) <= key_of(a));
    slot[0] = std::uint64_t{key_of(takes_a ? a : b)} << 32;
    for (auto [takes, at] : {std::pair{takes_a, &a}, std::pair{takes_b, &b}}) {
      if (!takes) continue;
      slot[0] += samples_of(*at);
      if (words == 2) slot[1] += (*at)[1];
      *at += words;
    }
  }
  std::copy_n(sum.data(), size, to);
}

}  // namespace caplet
