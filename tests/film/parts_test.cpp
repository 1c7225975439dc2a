// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which samples of which pixels are in a film, against sets of them.
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <vector>

#include "base/error.h"
#include "film/film.h"

namespace caplet {
namespace {

using Samples = std::set<std::array<std::uint32_t, 3>>;  // x, y, sample

Samples samples_of(const FilmPart& part) {
  Samples out;
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(part.window.height); ++y)
    for (std::uint32_t x = 0; x < static_cast<std::uint32_t>(part.window.width); ++x)
      for (std::uint32_t i = 0; i < part.sample_count; ++i)
        out.insert({static_cast<std::uint32_t>(part.window.x) + x,
                    static_cast<std::uint32_t>(part.window.y) + y, part.sample_begin + i});
  return out;
}

// Small parts at random places, many of which touch: one is refused where a sample would be in the
// film twice, and else all that were added are there, once.
TEST(FilmParts, HoldEachSampleOnce) {
  std::mt19937 random(1);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  unsigned refused = 0, joined = 0;
  for (int round = 0; round < 400; ++round) {
    std::vector<FilmPart> parts;
    Samples all;
    std::size_t added = 0;
    for (int i = 0; i < 12; ++i) {
      const FilmPart part{{below(4), below(4), 1 + below(3), 1 + below(3)},
                          static_cast<std::uint32_t>(below(5)),
                          static_cast<std::uint32_t>(1 + below(3))};
      const Samples its = samples_of(part);
      bool is_there = false;
      for (const auto& sample : its) is_there |= all.contains(sample);
      const std::vector<FilmPart> before = parts;
      if (is_there) {
        EXPECT_THROW(add_part(parts, part), InputError);
        EXPECT_EQ(parts, before);
        ++refused;
        continue;
      }
      ASSERT_NO_THROW(add_part(parts, part))
          << part.window.x << " " << part.window.y << " " << part.sample_begin;
      all.insert(its.begin(), its.end());
      ++added;
      Samples held;
      std::size_t count = 0;
      for (const FilmPart& one : parts) {
        const Samples of = samples_of(one);
        count += of.size();
        held.insert(of.begin(), of.end());
      }
      ASSERT_EQ(held, all);
      ASSERT_EQ(count, all.size()) << "one is in two parts";
    }
    joined += static_cast<unsigned>(added - parts.size());
  }
  EXPECT_GT(refused, 500U);
  EXPECT_GT(joined, 20U);
}

// Beside each other in x, y and samples, on either side: no sample is in both, and two such are one
// part.
TEST(FilmParts, ThatTouchAreApart) {
  const FilmPart middle{{10, 20, 3, 2}, 4, 5};
  for (const FilmPart& beside : {FilmPart{{13, 20, 3, 2}, 4, 5}, FilmPart{{7, 20, 3, 2}, 4, 5},
                                 FilmPart{{10, 22, 3, 2}, 4, 5}, FilmPart{{10, 18, 3, 2}, 4, 5},
                                 FilmPart{{10, 20, 3, 2}, 9, 5}, FilmPart{{10, 20, 3, 2}, 0, 4}}) {
    std::vector<FilmPart> parts = {middle};
    EXPECT_NO_THROW(add_part(parts, beside));
    EXPECT_EQ(parts.size(), 1U);
    // One pixel or sample nearer they have some in common.
    FilmPart nearer = beside;
    nearer.window.x += (beside.window.x < 10) - (beside.window.x > 10);
    nearer.window.y += (beside.window.y < 20) - (beside.window.y > 20);
    nearer.sample_begin +=
        static_cast<std::uint32_t>((beside.sample_begin < 4) - (beside.sample_begin > 4));
    parts = {middle};
    EXPECT_THROW(add_part(parts, nearer), InputError);
  }
}

}  // namespace
}  // namespace caplet
