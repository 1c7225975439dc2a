// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures without noise, by the library in place of Open Image Denoise that tests/support/oidn
// makes: colour becomes colour / 2 + twice the albedo / 4 + three times the normal / 8.
#include "view/detail/denoising.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <future>
#include <string>
#include <vector>

#include "base/error.h"
#include "guests.h"
#include "live_pictures.h"
#include "support/test_device.h"
#include "view/picture.h"
#include "view/viewer.h"

namespace caplet::view::denoising_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Denoised : public testing::Test {
 protected:
  Denoised() {
    ::setenv("CAPLET_OIDN", CAPLET_FAKE_OIDN, 1);
    ::setenv("FAKE_OIDN_QUALITY", "5", 1);
  }
  ~Denoised() override {
    ::unsetenv("CAPLET_OIDN");
    ::unsetenv("FAKE_OIDN_FAILS");
    ::unsetenv("FAKE_OIDN_QUALITY");
  }
};

NoisyImage image_of(float grey, std::uint32_t samples, std::size_t eye = 0) {
  NoisyImage out;
  out.image.width = out.image.data_width = 2;
  out.image.height = out.image.data_height = 1;
  for (const char* name : {"R", "G", "B"}) out.image.channels.push_back({name, {grey, grey}, {}});
  for (const char* name : {"albedo.R", "albedo.G", "albedo.B"})
    out.image.channels.push_back({name, {0.5f, 0.5f}, {}});
  for (const char* name : {"N.X", "N.Y", "N.Z"}) out.image.channels.push_back({name, {0, 1}, {}});
  out.samples = samples;
  out.eye = eye;
  return out;
}

Picture noisy_picture(int eye = 0) {
  Picture out;
  out.eye = eye;
  out.width = 2;
  out.height = 1;
  out.samples = 9;
  out.color.assign(6, to_half(1));
  return out;
}

/// Lets a test wait for the other thread.
struct Done {
  std::promise<void> promise;
  void wait() {
    ASSERT_EQ(promise.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
  }
};

TEST_F(Denoised, PicturesReplaceTheColoursOfTheirEye) {
  Done done;
  Denoising denoising([&] { done.promise.set_value(); });
  EXPECT_TRUE(denoising.is_on());
  EXPECT_TRUE(denoising.is_idle());
  EXPECT_FALSE(denoising.has_new());
  denoising.begin(image_of(0.25f, 8, 1));
  done.wait();
  EXPECT_FALSE(denoising.is_idle()) << "it waits to be taken";
  EXPECT_TRUE(denoising.has_new());
  EXPECT_FALSE(denoising.has_new());
  EXPECT_TRUE(denoising.is_idle());
  EXPECT_EQ(denoising.samples(0), 0u);
  EXPECT_EQ(denoising.samples(1), 8u);
  Picture left = noisy_picture(0), right = noisy_picture(1);
  denoising.improve(left);
  denoising.improve(right);
  EXPECT_EQ(left.color, std::vector<std::uint16_t>(6, to_half(1)));
  EXPECT_FALSE(left.is_denoised);
  const std::uint16_t a = to_half(0.125f + 0.25f), b = to_half(0.125f + 0.25f + 0.375f);
  EXPECT_EQ(right.color, (std::vector<std::uint16_t>{a, a, a, b, b, b}));
  EXPECT_TRUE(right.is_denoised);
  EXPECT_EQ(right.samples, 9u) << "of the picture itself";
  denoising.forget();
  right = noisy_picture(1);
  denoising.improve(right);
  EXPECT_FALSE(right.is_denoised);
}

// The page puts a colour under pictures itself.
TEST_F(Denoised, PicturesOverAColourAreThoseOfShapesAlone) {
  Done done;
  Denoising denoising([&] { done.promise.set_value(); });
  NoisyImage image = image_of(0.25f, 8);
  image.image.channels.push_back({"A", {0.5f, 0}, {}});
  image.backdrop = Backdrop{Backdrop::Kind::color, {1, 1, 1}, nullptr};
  denoising.begin(std::move(image));
  done.wait();
  EXPECT_TRUE(denoising.has_new());
  Picture picture = noisy_picture();
  denoising.improve(picture);
  const std::uint16_t a = to_half(0.125f + 0.25f), b = to_half(0.125f + 0.25f + 0.375f);
  EXPECT_EQ(picture.color, (std::vector<std::uint16_t>{a, a, a, b, b, b}));
}

// What is forgotten while it is made never appears.
TEST_F(Denoised, PicturesOfAnotherViewAreDropped) {
  Done done;
  Denoising denoising([&] { done.promise.set_value(); });
  denoising.begin(image_of(0.25f, 8));
  denoising.forget();
  if (denoising.is_idle()) return;  // it had not begun
  done.wait();
  EXPECT_FALSE(denoising.has_new());
  EXPECT_TRUE(denoising.is_idle());
  EXPECT_EQ(denoising.samples(0), 0u);
}

TEST_F(Denoised, FailuresTurnItOff) {
  ::setenv("FAKE_OIDN_FAILS", "1", 1);
  Done done;
  Denoising denoising([&] { done.promise.set_value(); });
  denoising.begin(image_of(0.25f, 8));
  done.wait();
  EXPECT_THAT([&] { denoising.has_new(); },
              testing::ThrowsMessage<RunError>(HasSubstr("as it was told to")));
  EXPECT_FALSE(denoising.is_on());
  EXPECT_TRUE(denoising.is_idle());
  EXPECT_FALSE(denoising.has_new());
}

ViewerOptions options_of(int samples) {
  ViewerOptions out = test::options_of(samples);
  out.denoises = true;
  return out;
}

// A finished picture is denoised at once, one in progress after a second; the key turns it off for
// all pages and on again.
TEST_F(Denoised, PicturesAreShownOfAViewThatRests) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(4));
  test::Guest guest(test::Place(viewer.address())), other(test::Place(viewer.address()));
  EXPECT_EQ(json::parse(guest.until("scene"))["denoise"], true);
  guest.look(scene);
  const test::Shown shown = guest.until_samples(4, 0, true);
  EXPECT_EQ(shown.samples, 4u);
  guest.say({{"type", "denoise"}, {"on", false}});
  EXPECT_EQ(json::parse(other.until("denoise"))["on"], false);
  EXPECT_EQ(guest.until_samples(4, 0, false).view, shown.view) << "the same picture, with noise";
  test::Guest late(test::Place(viewer.address()));
  EXPECT_EQ(json::parse(late.until("scene"))["denoise"], false);
  guest.look(scene, 0.5);
  const test::Shown moved = guest.until_samples(4, shown.view);
  EXPECT_FALSE(moved.is_denoised);
  guest.say({{"type", "denoise"}, {"on", true}});
  EXPECT_EQ(guest.until_samples(4, shown.view, true).view, moved.view);
}

TEST_F(Denoised, BothEyesAreAlike) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(4));
  test::Guest guest(test::Place(viewer.address()));
  guest.look(scene, 0, 0.2);
  const test::Shown one = guest.until_samples(4, 0, true);
  test::Shown two = guest.until_samples(4, 0, true);
  while (two.is_right == one.is_right) two = guest.until_samples(4, 0, true);
  EXPECT_EQ(two.view, one.view);
}

TEST_F(Denoised, FailuresAreToldAndLeaveThePicture) {
  ::setenv("FAKE_OIDN_FAILS", "1", 1);
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), options_of(4));
  test::Guest guest(test::Place(viewer.address()));
  guest.look(scene);
  EXPECT_EQ(json::parse(guest.until("denoise"))["on"], false);
  EXPECT_THAT(json::parse(guest.until("error"))["text"].get<std::string>(),
              HasSubstr("as it was told to"));
  EXPECT_FALSE(guest.until_samples(4).is_denoised);
}

TEST_F(Denoised, WithoutADenoiserNothingIs) {
  const Scene scene = test::some_scene();
  const Viewer viewer(LiveScene(Scene(scene)), test::test_device(), test::options_of(4));
  test::Guest guest(test::Place(viewer.address()));
  EXPECT_FALSE(json::parse(guest.until("scene")).contains("denoise"));
  guest.say({{"type", "denoise"}, {"on", true}});
  EXPECT_THAT(json::parse(guest.until("error"))["text"].get<std::string>(),
              HasSubstr("no Open Image Denoise"));
  guest.look(scene);
  EXPECT_FALSE(guest.until_samples(4).is_denoised);
}

}  // namespace
}  // namespace caplet::view::denoising_test
