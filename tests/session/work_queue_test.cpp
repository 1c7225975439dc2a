// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Who renders what, without devices: every path once, by speed, done at the same time, and again
// where a worker is lost.
#include "render/detail/work_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <tuple>

namespace caplet::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Window picture{10, 20, 100, 60};

WorkQueue::Worker worker(std::size_t batch_paths = 1 << 12) { return {{}, batch_paths, 1 << 12}; }

/// How often each pixel's samples were rendered.
class Count {
 public:
  void add(const FilmPart& part, int times = 1) {
    for (int y = part.window.y; y < part.window.y + part.window.height; ++y)
      for (std::uint32_t s = part.sample_begin; s < part.sample_begin + part.sample_count; ++s) {
        EXPECT_EQ(part.window.x, picture.x);
        EXPECT_EQ(part.window.width, picture.width);
        rows_[{y, s}] += times;
      }
  }
  void expect_once(std::uint32_t begin, std::uint32_t end) const {
    std::size_t found = 0;
    for (const auto& [at, times] : rows_) {
      if (times == 0) continue;
      EXPECT_EQ(times, 1) << at.first << " " << at.second;
      EXPECT_TRUE(at.first >= picture.y && at.first < picture.y + picture.height) << at.first;
      EXPECT_TRUE(at.second >= begin && at.second < end) << at.second;
      ++found;
    }
    EXPECT_EQ(found, std::size_t{picture.height} * (end - begin));
  }

 private:
  std::map<std::pair<int, std::uint32_t>, int> rows_;
};

/// Workers of given speeds in a time of their own.
class Simulation {
 public:
  Simulation(WorkQueue& shares, std::vector<double> speeds)
      : shares_(shares), speeds_(std::move(speeds)), busy_(speeds_.size()) {
    films_.resize(speeds_.size());
    lost_.resize(speeds_.size());
  }

  /// Until all is done; the worker `loses` is lost at time `at`. Returns when the first and the
  /// last one ran out of work.
  std::pair<double, double> run(std::size_t loses = SIZE_MAX, double at = 0) {
    double time = 0, idle_since = 0;
    while (true) {
      bool any_idle = false;
      for (std::size_t i = 0; i < speeds_.size(); ++i) {
        if (lost_[i] || busy_[i].part) continue;
        busy_[i].part = shares_.take(i);
        if (!busy_[i].part) {
          any_idle = true;
          continue;
        }
        ++parts;
        busy_[i].seconds = busy_[i].part->paths() / speeds_[i];
        busy_[i].until = time + busy_[i].seconds;
      }
      if (!any_idle) idle_since = 1e30;
      if (any_idle && idle_since == 1e30) idle_since = time;
      std::size_t next = SIZE_MAX;
      for (std::size_t i = 0; i < busy_.size(); ++i)
        if (!lost_[i] && busy_[i].part && (next == SIZE_MAX || busy_[i].until < busy_[next].until))
          next = i;
      if (loses < lost_.size() && !lost_[loses] && (next == SIZE_MAX || busy_[next].until >= at)) {
        time = at;
        lost_[loses] = true;
        shares_.lose(loses, films_[loses]);
        for (const Work& work : films_[loses]) count.add(work.part, -1);
        continue;
      }
      if (next == SIZE_MAX) return {idle_since, time};
      time = busy_[next].until;
      shares_.done(next, busy_[next].seconds);
      count.add(busy_[next].part->part);
      films_[next].push_back(*busy_[next].part);
      done[next] += busy_[next].part->paths();
      busy_[next].part.reset();
    }
  }

  Count count;
  std::map<std::size_t, double> done;
  int parts = 0;

 private:
  struct Busy {
    std::optional<Work> part;
    double seconds = 0, until = 0;
  };
  WorkQueue& shares_;
  std::vector<double> speeds_;
  std::vector<Busy> busy_;
  std::vector<std::vector<Work>> films_;
  std::vector<bool> lost_;
};

TEST(WorkQueue, PartsAreCutInSamplesOrRowsOfTiles) {
  const FilmPart all{{0, 0, 100, 60}, 4, 10};
  std::vector<FilmPart> rest;
  EXPECT_EQ(cut_part(all, 18500, 100, rest), (FilmPart{{0, 0, 100, 60}, 4, 3}));
  EXPECT_THAT(rest, ElementsAre(FilmPart{{0, 0, 100, 60}, 7, 7}));
  rest.clear();
  EXPECT_EQ(cut_part(all, 1e9, 4, rest),
            (FilmPart{{0, 0, 100, 60}, 4, 4}));  // no more samples than a batch takes
  rest.clear();
  EXPECT_EQ(cut_part(all, 1e9, 100, rest), all);
  EXPECT_THAT(rest, IsEmpty());
  EXPECT_EQ(cut_part(all, 1950, 100, rest),
            (FilmPart{{0, 0, 100, 16}, 4, 1}));  // 19 rows: two rows of tiles
  EXPECT_THAT(rest, ElementsAre(FilmPart{{0, 16, 100, 44}, 4, 1}, FilmPart{{0, 0, 100, 60}, 5, 9}));
  rest.clear();
  EXPECT_EQ(cut_part(all, 350, 100, rest), (FilmPart{{0, 0, 100, 3}, 4, 1}));
  rest.clear();
  EXPECT_EQ(cut_part(all, 1, 100, rest), (FilmPart{{0, 0, 100, 1}, 4, 1}));
  rest.clear();
  EXPECT_EQ(cut_part({{0, 56, 100, 4}, 9, 1}, 399, 100, rest), (FilmPart{{0, 56, 100, 3}, 9, 1}));
  EXPECT_THAT(rest, ElementsAre(FilmPart{{0, 59, 100, 1}, 9, 1}));
}

// Half of what a worker's speed makes its share, within bounds in seconds.
TEST(WorkQueue, SizesAreHalfOfWhatIsLeftBySpeed) {
  EXPECT_DOUBLE_EQ(part_paths(1000, 300, 1000), 150);
  EXPECT_DOUBLE_EQ(part_paths(1000, 300, 600), 250);
  EXPECT_DOUBLE_EQ(part_paths(1e6, 300, 600), 300);  // a second
  EXPECT_DOUBLE_EQ(part_paths(1, 300, 600), 6);      // a fiftieth
}

TEST(WorkQueue, SpeedsForgetWhatWas) {
  Speed speed;
  EXPECT_EQ(speed.paths_a_second(), 0);
  speed.measured(1000, 1);
  EXPECT_DOUBLE_EQ(speed.paths_a_second(), 1000);
  speed.measured(1000, 4);
  EXPECT_DOUBLE_EQ(speed.paths_a_second(), 1500 / 4.5);
  for (int i = 0; i < 20; ++i) speed.measured(10, 1);
  EXPECT_NEAR(speed.paths_a_second(), 10, 1e-2);
}

TEST(WorkQueue, AWorkerAloneTakesWholePasses) {
  WorkQueue shares(picture, 5, 10, {}, {{{}, 1 << 17, 4}});
  EXPECT_EQ(shares.take(0)->part, (FilmPart{picture, 5, 4}));
  EXPECT_FALSE(shares.complete());
  shares.done(0, 1);
  EXPECT_EQ(shares.paths_done(), 4.0 * picture.width * picture.height);
  EXPECT_EQ(shares.take(0)->part, (FilmPart{picture, 9, 4}));
  shares.done(0, 1);
  EXPECT_EQ(shares.take(0)->part, (FilmPart{picture, 13, 2}));
  shares.done(0, 1);
  EXPECT_FALSE(shares.take(0).has_value());
  EXPECT_TRUE(shares.complete());
  EXPECT_EQ(shares.samples(), 10u);
}

// Workers of any speeds finish together, and each has done what its speed makes of the whole.
TEST(WorkQueue, AreBySpeedAndEndTogether) {
  for (const std::vector<double>& speeds : std::vector<std::vector<double>>{{1e5, 1e5},
                                                                            {1e5, 3e5},
                                                                            {2e4, 1e6},
                                                                            {1e5, 1e5, 1e5, 1e5},
                                                                            {3e5, 1e5, 2e5},
                                                                            {1e3, 1e6, 2e6}}) {
    constexpr std::uint32_t samples = 4000;
    WorkQueue shares(picture, 3, samples, {},
                     std::vector<WorkQueue::Worker>(speeds.size(), worker()));
    Simulation simulation(shares, speeds);
    const auto [first, last] = simulation.run();
    EXPECT_TRUE(shares.complete());
    simulation.count.expect_once(3, 3 + samples);
    double all = 0;
    for (const double speed : speeds) all += speed;
    const double whole = static_cast<double>(picture.pixels()) * samples;
    // A worker may begin its last part, of a fiftieth of a second or a row, just before the others
    // have none; and the first parts, before speeds are known, are a batch.
    const double slowest = *std::ranges::min_element(speeds);
    EXPECT_LT(last - first, std::max(0.02, picture.width / slowest) + 1e-9)
        << testing::PrintToString(speeds);
    EXPECT_LT(last, whole / all * 1.02 + 0.05) << testing::PrintToString(speeds);
    EXPECT_LT(simulation.parts,
              40 * static_cast<int>(speeds.size()) + 2 * last * static_cast<double>(speeds.size()));
  }
}

TEST(WorkQueue, WhatALostWorkerHadIsDoneAgain) {
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto draw = [&](unsigned most) { return static_cast<double>(1 + random() % most); };
    const std::vector<double> speeds{1e5 * draw(5), 1e5 * draw(5), 1e5};
    constexpr std::uint32_t samples = 300;
    WorkQueue shares(picture, 7, samples, {}, std::vector<WorkQueue::Worker>(3, worker()));
    Simulation simulation(shares, speeds);
    simulation.run(random() % 3, 0.01 * draw(400));
    EXPECT_TRUE(shares.complete());
    EXPECT_EQ(shares.workers_there(), 2u);
    simulation.count.expect_once(7, 7 + samples);
    EXPECT_DOUBLE_EQ(shares.paths_done(), static_cast<double>(picture.pixels()) * samples);
    EXPECT_EQ(shares.samples(), samples);
  }
}

// Samples of earlier renders, which a lost worker's film had, come back as well; they do not count
// as this render's.
TEST(WorkQueue, WhatIsToBeDoneAgainComesFirst) {
  WorkQueue shares(picture, 20, 1, {{{picture, 3, 2}, nullptr}}, {worker(), worker()});
  Simulation simulation(shares, {1e5, 1e5});
  simulation.run();
  EXPECT_DOUBLE_EQ(shares.paths_done(), static_cast<double>(picture.pixels()));
  Count again;
  WorkQueue others(picture, 20, 0, {{{picture, 3, 2}, nullptr}}, {worker()});
  while (const auto part = others.take(0)) {
    again.add(part->part);
    others.done(0, 1);
  }
  again.expect_once(3, 5);
  EXPECT_EQ(others.samples(), 0u);
  EXPECT_EQ(others.paths_done(), 0);
}

// What is begun is finished for every pixel, and nothing else.
TEST(WorkQueue, ClosedOnesFinishWhatIsBegun) {
  WorkQueue shares(picture, 7, 100, {}, {worker(1000), worker(1000)});
  EXPECT_FALSE(shares.begun());
  const FilmPart first = shares.take(0)->part;
  EXPECT_TRUE(shares.begun());
  EXPECT_EQ(first.sample_count, 1u);
  EXPECT_LT(first.window.height, picture.height);
  shares.close();
  EXPECT_EQ(shares.samples(), 1u);
  Count count;
  count.add(first);
  shares.done(0, 0.1);
  while (const auto part = shares.take(0)) {
    count.add(part->part);
    shares.done(0, 0.1);
  }
  EXPECT_TRUE(shares.complete());
  count.expect_once(7, 8);
  WorkQueue none(picture, 7, 100, {}, {worker()});
  none.close();
  EXPECT_FALSE(none.take(0).has_value());
  EXPECT_EQ(none.samples(), 0u);
}

/// A list of `pixels` pixels, numbered by x, of `count` samples each.
PixelSamples list_of(std::uint32_t pixels, std::uint32_t count) {
  PixelSamples out{count, {}};
  for (std::uint32_t x = 0; x < pixels; ++x) out.pixels.push_back({x, count, 0, 0});
  return out;
}

/// How often each pixel of each list was rendered, by the list's count.
using Rendered = std::map<std::pair<std::uint32_t, std::uint32_t>, int>;

void add(Rendered& to, const Work& work, int times) {
  for (std::size_t i = work.first; i < work.first + work.count; ++i)
    to[{work.samples->count, work.samples->pixels.at(i).x}] += times;
}

// Workers of different speeds take lists to their ends; what a lost one had of them is done again.
TEST(WorkQueue, ListedPixelsAreRenderedOnceWhoeverIsLost) {
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    WorkQueue shares({list_of(5000, 8), list_of(300, 96), list_of(1, 4)}, {},
                     {worker(700), worker(700), worker(700)});
    Rendered rendered;
    std::vector<std::vector<Work>> had(3);
    std::vector<bool> lost(3);
    std::size_t parts = 0;
    while (!shares.complete()) {
      const std::size_t i = random() % 3;
      if (lost[i]) continue;
      const std::optional<Work> work = shares.take(i);
      if (!work) continue;
      ASSERT_LT(++parts, 1000u);
      if (random() % 20 == 0 && shares.workers_there() > 1) {  // before it is done
        shares.lose(i, had[i]);
        lost[i] = true;
        for (const Work& each : had[i]) add(rendered, each, -1);
        continue;
      }
      shares.done(i, work->paths() / (1e5 * static_cast<double>(i + 1)));
      add(rendered, *work, 1);
      had[i].push_back(*work);
    }
    EXPECT_EQ(rendered.size(), 5301u);
    for (const auto& [pixel, times] : rendered)
      EXPECT_EQ(times, 1) << pixel.first << " " << pixel.second;
    EXPECT_EQ(shares.paths_done(), 5000 * 8 + 300 * 96 + 4);
    EXPECT_EQ(shares.samples(), 0u);
  }
}

// What a lost worker had of a list is done again even then; what was not begun is not.
TEST(WorkQueue, ClosedListsEndWithWhatIsBegun) {
  WorkQueue shares({list_of(5000, 8)}, {}, {worker(800), worker(800)});
  EXPECT_FALSE(shares.begun());
  const Work first = *shares.take(0);
  EXPECT_TRUE(shares.begun());
  EXPECT_EQ(first.count, 100u);
  shares.done(0, 0.01);
  EXPECT_TRUE(shares.take(1).has_value());
  shares.lose(0, std::vector{first});
  shares.close();
  EXPECT_FALSE(shares.complete());
  shares.done(1, 0.01);
  const std::optional<Work> again = shares.take(1);
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->first, first.first);
  EXPECT_EQ(again->count, first.count);
  shares.done(1, 0.01);
  EXPECT_FALSE(shares.take(1).has_value());
  EXPECT_TRUE(shares.complete());
  EXPECT_EQ(shares.paths_done(), 1600);
}

// Records of a pixel stay together, so that a pixel that is begun has all of its samples.
TEST(WorkQueue, RecordsOfAPixelAreInOnePart) {
  PixelSamples list{8, {}};
  for (std::uint32_t x = 0; x < 400; ++x)
    for (std::uint32_t record = 0; record < 1 + x % 6; ++record)
      list.pixels.push_back({x, 1, 8 * record, 0});
  WorkQueue shares({list}, {}, {worker(700), worker(100)});
  std::size_t next = 0, parts = 0;
  for (std::size_t i = 0; const std::optional<Work> work = shares.take(i % 2); ++i) {
    EXPECT_EQ(work->first, next);
    next += work->count;
    ++parts;
    if (next < list.pixels.size()) {
      EXPECT_FALSE(is_same_pixel(list.pixels[next - 1], list.pixels[next])) << next;
    }
    shares.done(i % 2, 0.01);
  }
  EXPECT_EQ(next, list.pixels.size());
  EXPECT_GT(parts, 5u);
}

// Lists of earlier renders, which a lost worker's film had, do not count as this render's.
TEST(WorkQueue, EarlierListsComeFirstAndDoNotCount) {
  const auto earlier = std::make_shared<const PixelSamples>(list_of(10, 8));
  WorkQueue shares({list_of(20, 4)}, {{{}, earlier, 2, 5}, {{picture, 3, 2}, nullptr}},
                   {worker(1 << 20)});
  const Work first = *shares.take(0);
  EXPECT_EQ(first.samples, earlier);
  EXPECT_EQ(first.first, 2u);
  EXPECT_EQ(first.count, 5u);
  shares.done(0, 1);
  EXPECT_FALSE(shares.begun());
  EXPECT_EQ(shares.take(0)->part, (FilmPart{picture, 3, 2}));
  shares.done(0, 1);
  EXPECT_EQ(shares.paths_done(), 0);
  EXPECT_EQ(shares.take(0)->count, 20u);
  shares.done(0, 1);
  EXPECT_TRUE(shares.complete());
  EXPECT_EQ(shares.paths_done(), 80);
}

// One that needs longer for a row than the others for everything leaves it to them, until they are
// lost.
TEST(WorkQueue, TheSlowLeaveTheEndToOthers) {
  WorkQueue::Worker slow = worker(), fast = worker();
  slow.speed.measured(10, 1);
  fast.speed.measured(1e6, 1);
  WorkQueue shares(picture, 0, 2, {}, {slow, fast});
  EXPECT_FALSE(shares.take(0).has_value());
  EXPECT_FALSE(shares.complete());
  EXPECT_TRUE(shares.take(1).has_value());
  shares.lose(1, {});
  EXPECT_TRUE(shares.take(0).has_value());
}

}  // namespace
}  // namespace caplet::test
