// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Devices that fail or hang while they render one picture with others: nothing is lost, and the
// bits are those of one device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "driver_stub.h"
#include "render/render.h"
#include "render/session.h"
#include "render_scene.h"
#include "support/logged_errors.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

using testing::HasSubstr;

constexpr std::uint32_t samples = 48;

const LoweredScene& model() {
  static const LoweredScene made = lowered_everything(40, 30);
  return made;
}

const Film& by_one() {
  static const Film film = [] {
    Session session(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
    session.render(samples);
    return session.film();
  }();
  return film;
}

bool same(const Film& a, const Film& b) {
  return a.layout() == b.layout() && a.parts() == b.parts() &&
         std::ranges::equal(a.words(), b.words());
}

constexpr SessionOptions options{.layers = Layers::all(), .pass_samples = 3, .patience = 0.5};

class LostDevices : public testing::Test {
 protected:
  void SetUp() override {
    if (!test_device().is_pocl() || test_device().info().compute_units < 2)
      GTEST_SKIP() << "needs PoCL on two or more processors, to be divided";
    devices = test_device().split(2);
    session.emplace(model().flat, model().view, devices, options);
  }
  /// Threads that were given up have come back.
  static void wait_for_all() {
    for (int i = 0; i < 500 && any_thread_given_up(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(any_thread_given_up());
  }
  std::vector<Device> devices;
  std::optional<Session> session;
};

TEST_F(LostDevices, WhatTheyHadRenderedIsRenderedAgain) {
  for (const int launches : {0, 1, 7, 40, 90}) {
    session.emplace(model().flat, model().view, devices, options);
    EXPECT_EQ(session->render(5), 5u);  // the lost film has samples of an earlier render as well
    int calls = 0;
    {
      const BrokenDriver broken(devices[1], Fault::launch_fails, launches);
      EXPECT_EQ(session->render(samples - 5), samples - 5);
      calls = broken.calls();
    }
    EXPECT_EQ(session->device_count(), calls > launches ? 1u : 2u);
    EXPECT_TRUE(launches > 40 || calls > launches) << "not enough launches: " << calls;
    EXPECT_TRUE(same(session->film(), by_one())) << launches;
    if (session->device_count() == 2) continue;
    const std::vector<DeviceWork> work = session->work();
    ASSERT_EQ(work.size(), 2u);
    EXPECT_FALSE(work[0].lost);
    EXPECT_EQ(work[0].paths, 40.0 * 30 * samples);
    EXPECT_TRUE(work[1].lost);
    EXPECT_EQ(work[1].paths, 0);
    // It goes on without it.
    EXPECT_EQ(session->render(3), 3u);
    EXPECT_EQ(session->film().samples(0), samples + 3);
  }
}

TEST_F(LostDevices, WhoHangsIsLeftBehind) {
  {
    const BrokenDriver broken(devices[0], Fault::launch_hangs, 20);
    EXPECT_EQ(session->render(samples), samples);
    EXPECT_EQ(session->device_count(), 1u);
    EXPECT_TRUE(any_thread_given_up());
    EXPECT_TRUE(same(session->film(), by_one()));
    session.reset();
  }
  wait_for_all();
}

TEST_F(LostDevices, FilmsThatCannotBeReadAreRenderedAgain) {
  EXPECT_EQ(session->render(samples), samples);
  {
    const BrokenDriver broken(devices[0], Fault::read_fails, 0);
    EXPECT_TRUE(same(session->film(), by_one()));
  }
  EXPECT_EQ(session->device_count(), 1u);
  session.emplace(model().flat, model().view, devices, options);
  EXPECT_EQ(session->render(samples), samples);
  {
    const BrokenDriver broken(devices[1], Fault::read_hangs, 0);
    EXPECT_TRUE(same(session->film(), by_one()));
    session.reset();
  }
  wait_for_all();
}

/// All pixels of the film in two lists: every third one from its sample 20 on to 30, the others
/// from 20 to 24.
std::vector<PixelSamples> two_lists(const Window& window) {
  std::vector<PixelSamples> out{{4, {}}, {10, {}}};
  for (int y = 0; y < window.height; ++y)
    for (int x = 0; x < window.width; ++x)
      out[(x + y) % 3 == 0 ? 1 : 0].pixels.push_back(
          {static_cast<uint>(window.x + x), static_cast<uint>(window.y + y), 20, 0});
  return out;
}

// The lists of a lost device are rendered again, those of an earlier call too.
TEST_F(LostDevices, ListsAreThoseOfOneDevice) {
  const auto rendered = [](Session& by, const std::function<void()>& between) {
    EXPECT_EQ(by.render(20), 20u);
    std::vector<PixelSamples> lists = two_lists(by.layout().window);
    EXPECT_TRUE(by.render(lists));
    between();
    for (PixelRecord& pixel : lists[1].pixels) pixel.sample_begin = 30;
    double last = 0;
    EXPECT_TRUE(by.render({{18, lists[1].pixels}}, [&last](const SessionProgress& now) {
      EXPECT_LE(now.fraction, 1);
      last = now.fraction;
    }));
    EXPECT_EQ(last, 1);
    EXPECT_EQ(by.samples(), 48u);
    EXPECT_FALSE(by.film_on_device());
    return by.film();
  };
  Session one(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
  const Film film = rendered(one, [] {});
  ASSERT_EQ(film.parts().size(), 1u);
  EXPECT_EQ(film.parts()[0], (FilmPart{film.layout().window, 0, 48}));
  EXPECT_EQ(film.samples(0), 48u);
  EXPECT_EQ(film.samples(1), 24u);
  // Every third pixel is that of all samples, as a render of windows makes them.
  const std::size_t words = film.layout().words_per_pixel();
  for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); pixel += 3) {
    const auto width = static_cast<std::size_t>(film.layout().window.width);
    if ((pixel % width + pixel / width) % 3 != 0) continue;
    EXPECT_TRUE(std::ranges::equal(film.words().subspan(pixel * words, words),
                                   by_one().words().subspan(pixel * words, words)))
        << pixel;
  }
  EXPECT_TRUE(same(rendered(*session, [] {}), film));
  SessionOptions small = options;  // batches, so that each device has some of a list
  small.batch_paths = 200;
  for (const int launches : {0, 3, 12}) {
    session.emplace(model().flat, model().view, devices, small);
    std::optional<BrokenDriver> broken;
    EXPECT_TRUE(
        same(rendered(*session, [&] { broken.emplace(devices[1], Fault::launch_fails, launches); }),
             film))
        << launches;
    EXPECT_EQ(session->device_count(), 1u) << launches;
  }
}

// A pixel with several records has the samples of all of them, in one batch or in many.
TEST_F(LostDevices, RecordsOfAPixelAreItsSamples) {
  Session straight(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
  EXPECT_EQ(straight.render(36), 36u);
  const Window window = straight.layout().window;
  const auto records = [&](bool are_first) {
    PixelSamples out{4, {}};
    for (int y = 0; y < window.height; ++y)
      for (int x = 0; x < window.width; ++x)
        for (int record = 0; record < 4; ++record)
          if ((record <= (x + y) % 4) == are_first)
            out.pixels.push_back({static_cast<uint>(window.x + x), static_cast<uint>(window.y + y),
                                  static_cast<uint>(20 + 4 * record), 0});
    return out;
  };
  for (const std::size_t batch : {0U, 200U, 3U}) {
    SessionOptions small = options;
    small.batch_paths = batch;
    session.emplace(model().flat, model().view, devices, small);
    EXPECT_EQ(session->render(20), 20u);
    EXPECT_TRUE(session->render({records(true)}));
    EXPECT_EQ(session->film().samples(3), 20u + 16);
    EXPECT_EQ(session->film().samples(0), 20u + 4);
    EXPECT_TRUE(session->render({records(false)}));
    EXPECT_TRUE(same(session->film(), straight.film())) << batch;
  }
}

TEST_F(LostDevices, RowsAreThoseOfTheFilm) {
  SessionOptions few = options;  // three rows at a time
  few.look_bytes = 3 * session->layout().words_per_pixel() * sizeof(std::uint64_t) *
                   static_cast<std::size_t>(session->layout().window.width);
  Session one(model().flat, model().view, {test_device()}, few);
  EXPECT_EQ(one.render(5), 5u);
  EXPECT_EQ(session->render(5), 5u);
  for (Session* const by : {&one, &*session}) {
    const Film film = by->film();
    std::vector<std::uint64_t> words(film.words().size());
    const std::size_t row_words =
        film.layout().words_per_pixel() * static_cast<std::size_t>(film.layout().window.width);
    int looks = 0;
    by->look_at_film([&](const Film& rows) {
      ++looks;
      const auto first = static_cast<std::size_t>(rows.layout().window.y - film.layout().window.y);
      std::ranges::copy(rows.words(),
                        words.begin() + static_cast<std::ptrdiff_t>(first * row_words));
    });
    EXPECT_TRUE(std::ranges::equal(words, film.words()));
    EXPECT_EQ(looks, by == &one ? (film.layout().window.height + 2) / 3 : 1);
    EXPECT_EQ(by->parts(), film.parts());
  }
  const BrokenDriver broken(devices[0], Fault::read_fails, 0);
  EXPECT_EQ(session->device_count(), 2u);
  session->look_at_film([](const Film&) {});
  EXPECT_EQ(session->device_count(), 1u);
}

// A film of lists is gone on with where it was, and what it had stays.
TEST_F(LostDevices, ListsGoOnWithAFilm) {
  Session one(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
  EXPECT_EQ(one.render(20), 20u);
  EXPECT_TRUE(one.render(two_lists(one.layout().window)));
  Session other(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
  other.resume(one.film());
  EXPECT_EQ(other.samples(), 30u);
  std::vector<PixelSamples> lists = two_lists(one.layout().window);
  for (PixelRecord& pixel : lists[0].pixels) pixel.sample_begin = 24;
  EXPECT_TRUE(other.render({{6, lists[0].pixels}}));
  Session straight(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
  EXPECT_EQ(straight.render(30), 30u);
  EXPECT_TRUE(same(other.film(), straight.film()));
}

// The next samples of every pixel are those after its own last one.
TEST_F(LostDevices, ListsAreFollowedByTheNextOfEachPixel) {
  Session one(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
  EXPECT_EQ(one.render(20), 20u);
  EXPECT_TRUE(one.is_even());
  EXPECT_TRUE(one.render(two_lists(one.layout().window)));
  EXPECT_FALSE(one.is_even());
  EXPECT_EQ(one.render(5), 5u);
  EXPECT_EQ(one.samples(), 35u);
  const Film film = one.film();
  const std::size_t words = film.layout().words_per_pixel();
  const auto width = static_cast<std::size_t>(film.layout().window.width);
  for (const std::uint32_t n : {29U, 35U}) {
    Session straight(model().flat, model().view, {test_device()}, {.layers = Layers::all()});
    EXPECT_EQ(straight.render(n), n);
    const Film other = straight.film();
    for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); ++pixel)
      EXPECT_TRUE(((pixel % width + pixel / width) % 3 == 0) != (n == 35) ||
                  std::ranges::equal(film.words().subspan(pixel * words, words),
                                     other.words().subspan(pixel * words, words)))
          << pixel;
  }
}

// A cancelled one has whole pixels, and says that it is not complete.
TEST_F(LostDevices, CancelledListsEndBetweenParts) {
  Session one(model().flat, model().view, {test_device()},
              {.layers = Layers::all(), .batch_paths = 1000});
  EXPECT_EQ(one.render(20), 20u);
  EXPECT_FALSE(
      one.render(two_lists(one.layout().window), [&](const SessionProgress&) { one.cancel(); }));
  const Film film = one.film();
  std::size_t done = 0;
  for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); ++pixel) {
    const std::uint32_t n = film.samples(pixel);
    EXPECT_TRUE(n == 20 || n == 24 || n == 30) << n;
    done += n > 20 ? 1 : 0;
  }
  EXPECT_GT(done, 0u);
  EXPECT_LT(done, film.layout().window.pixels());
}

TEST_F(LostDevices, TheLastOnesFailureIsTheSessions) {
  Session alone(model().flat, model().view, {devices[0]}, options);
  {
    const BrokenDriver broken(devices[0], Fault::launch_fails, 30);
    EXPECT_THROW(alone.render(samples), DriverError);
  }
  // The film is empty, and the device may be asked again.
  EXPECT_EQ(alone.render(samples), samples);
  EXPECT_TRUE(same(alone.film(), by_one()));
}

TEST_F(LostDevices, ProgressThatThrowsEndsTheRender) {
  EXPECT_THROW(session->render(samples, [](const SessionProgress&) { throw InputError("enough"); }),
               InputError);
  EXPECT_EQ(session->device_count(), 2u);
  EXPECT_EQ(session->render(samples), samples);
  EXPECT_TRUE(same(session->film(), by_one()));
}

TEST_F(LostDevices, CancelledRendersFinishWhatIsBegunForEveryPixel) {
  const auto cancel = [&](const SessionProgress& progress) {
    if (progress.fraction > 0.3) session->cancel();
  };
  const std::uint32_t done = session->render(samples, cancel);
  EXPECT_LT(done, samples);
  EXPECT_GT(done, 0u);
  const Film film = session->film();
  EXPECT_THAT(film.parts(), testing::ElementsAre(FilmPart{film.layout().window, 0, done}));
  for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); ++pixel)
    ASSERT_EQ(film.samples(pixel), done);
  EXPECT_EQ(session->render(samples - done), samples - done);
  EXPECT_TRUE(same(session->film(), by_one()));
}

// render() is a session.
TEST_F(LostDevices, RendersOfSeveralDevicesAreThoseOfOne) {
  RenderOptions of_render;
  of_render.samples_per_pixel = samples;
  of_render.film_on_device = true;
  const BrokenDriver broken(devices[1], Fault::launch_fails, 60);
  const RenderResult result = render(model().flat, model().view, devices, of_render, {});
  EXPECT_TRUE(same(result.device_film ? result.device_film->read() : result.film, by_one()));
}

}  // namespace
}  // namespace caplet::test
