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
