// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lists of what a pixel's samples met, against maps.
#include "film/slots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <vector>

#include "shared/limits.h"

namespace caplet::slots_test {
namespace {

using testing::ElementsAre;

/// What was met: samples and the sum of their values, by key.
using Met = std::map<std::uint32_t, std::pair<std::uint32_t, std::uint64_t>>;

/// The list of the smallest keys.
std::vector<std::uint64_t> list_of(const Met& met, int words) {
  std::vector<std::uint64_t> out(static_cast<std::size_t>(words) * CAPLET_SLOTS);
  std::size_t at = 0;
  for (const auto& [key, what] : met) {
    if (at == out.size()) break;
    out[at] = std::uint64_t{key} << 32 | what.first;
    if (words == 2) out[at + 1] = what.second;
    at += static_cast<std::size_t>(words);
  }
  return out;
}

Met random_met(std::mt19937& random, unsigned most) {
  Met out;
  const auto below = [&](unsigned n) { return static_cast<std::uint32_t>(random()) % n; };
  for (unsigned i = below(most + 1); i > 0; --i) out[below(30)] = {1 + below(100), random()};
  if (below(4) == 0) out[0xffffffffU] = {1, 7};
  return out;
}

TEST(Slots, OfManyFilmsAreThoseOfAllSamplesInAnyOrder) {
  std::mt19937 random(5);
  unsigned full = 0;
  for (int round = 0; round < 2000; ++round) {
    const int words = 1 + round % 2;
    Met all;
    std::vector<Met> parts;
    for (int i = 0; i < 5; ++i) {
      parts.push_back(random_met(random, i % 2 == 0 ? 6 : 20));
      for (const auto& [key, what] : parts.back()) {
        all[key].first += what.first;
        all[key].second += what.second;
      }
    }
    full += all.size() > CAPLET_SLOTS ? 1 : 0;
    std::ranges::shuffle(parts, random);
    // The first two, and the three others, by themselves.
    std::vector<std::uint64_t> a = list_of(parts[0], words), b = list_of(parts[2], words);
    add_slots(a.data(), list_of(parts[1], words).data(), words);
    add_slots(b.data(), list_of(parts[3], words).data(), words);
    add_slots(b.data(), list_of(parts[4], words).data(), words);
    add_slots(b.data(), a.data(), words);
    ASSERT_EQ(b, list_of(all, words)) << round;
  }
  EXPECT_GT(full, 500u);
  EXPECT_LT(full, 1500u);
}

TEST(Slots, AreReadUpToTheFirstEmptyOne) {
  std::vector<std::uint64_t> two(2 * CAPLET_SLOTS);
  two[0] = std::uint64_t{7} << 32 | 3;
  two[1] = 5;
  two[2] = std::uint64_t{9} << 32 | 1;
  EXPECT_THAT(slots_at(two.data(), 2, 0.5), ElementsAre(Slot{7, 3, 2.5}, Slot{9, 1, 0}));
  std::vector<std::uint64_t> full(CAPLET_SLOTS);
  for (std::uint64_t i = 0; i < CAPLET_SLOTS; ++i) full[i] = i << 32 | 1;
  EXPECT_EQ(slots_at(full.data(), 1, 1).size(), std::size_t{CAPLET_SLOTS});
  EXPECT_EQ(slots_at(full.data(), 1, 1).back(), (Slot{CAPLET_SLOTS - 1, 1, 0}));
}

}  // namespace
}  // namespace caplet::slots_test
