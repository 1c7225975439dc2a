// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// When the picture that pages look at is finished.
#include "view/detail/eye_films.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "guests.h"
#include "live_pictures.h"
#include "present/least_width.h"
#include "render/query.h"
#include "support/test_device.h"
#include "view/detail/shown_view.h"

namespace caplet::view {
namespace {

/// The last two full pictures of each eye, of those until the films have no more.
struct Ended {
  std::vector<Picture> before = std::vector<Picture>(2), last = std::vector<Picture>(2);
};

Ended ended(const ViewerOptions& options, double separation = 0, Scene scene = test::some_scene()) {
  LiveScene live(std::move(scene));
  const Editor editor(live);
  EyeFilms films(live, editor, test::test_device(), options, false);
  ShowView look = look_of_scene(live.scene());
  look.width = test::width;
  look.height = test::height;
  look.separation = separation;
  films.begin(look);
  Ended out;
  while (films.has_more()) {
    films.step([](bool) {});
    Picture picture = films.picture();
    if (picture.scale != 1) continue;
    const auto eye = static_cast<std::size_t>(picture.eye);
    out.before[eye] = std::exchange(out.last[eye], std::move(picture));
  }
  return out;
}

/// The picture of all pixels and samples.
Picture full_picture(EyeFilms& films, const ShowView& look) {
  films.begin(look);
  while (films.has_more()) films.step([](bool) {});
  return films.picture();
}

ViewerOptions options_to(double noise, int most = 4096) {
  ViewerOptions out = test::options_of(most);
  out.noise = noise;
  out.step_seconds = 0.02;
  return out;
}

// The first picture of a view is as coarse as its time demands, a finer one follows, then that of
// all pixels. Where there is time enough it is of all pixels at once.
TEST(EyeFilms, BeginCoarse) {
  for (const auto& [seconds, first] : {std::pair(1e-9, 16), std::pair(1e9, 1)}) {
    ViewerOptions options = test::options_of(1);
    options.coarse_seconds = seconds;
    LiveScene live(test::some_scene());
    const Editor editor(live);
    EyeFilms films(live, editor, test::test_device(), options, false);
    ShowView look = look_of_scene(live.scene());
    look.width = 70;
    look.height = 50;
    films.begin(look);
    std::vector<int> scales;
    while (films.has_more()) {
      const bool is_coarse = first > 1 && scales.empty();
      films.step([&](bool is_first) { EXPECT_EQ(is_first, is_coarse); });
      const Picture picture = films.picture();
      scales.push_back(picture.scale);
      EXPECT_EQ(static_cast<int>(picture.width), (70 - 1) / picture.scale + 1);
    }
    EXPECT_EQ(scales, first == 1 ? std::vector({1}) : std::vector({16, 8, 1}));
  }
}

// The noise is the first that is asked for. Of two eyes, both have it, and equal samples.
TEST(EyeFilms, EndWithTheNoiseThatIsAskedFor) {
  const Ended one = ended(options_to(0.04));
  EXPECT_LE(one.last[0].noise, 0.04);
  EXPECT_GT(one.before[0].noise, 0.04);
  EXPECT_GE(one.last[0].samples, 16u);
  EXPECT_LT(one.last[0].samples, 4096u);
  const Ended two = ended(options_to(0.04), 0.2);
  for (const Picture& last : two.last) EXPECT_LE(last.noise, 0.04);
  EXPECT_EQ(two.last[0].samples, two.last[1].samples);
  EXPECT_LT(two.last[1].samples, 4096u);
}

// The page puts the backdrop under the light of shapes, which no white is in.
TEST(EyeFilms, PicturesOverAColourHaveCoverageInItsPlace) {
  Scene scene = test::some_scene();
  EXPECT_TRUE(ended(options_to(0, 2), 0, scene).last[0].alpha.empty());
  scene.view.film.backdrop = Backdrop{};
  const Picture clear = ended(options_to(0, 2), 0, scene).last[0];
  scene.view.film.backdrop = Backdrop{Backdrop::Kind::color, {1, 1, 1}, nullptr};
  const Picture white = ended(options_to(0, 2), 0, scene).last[0];
  EXPECT_EQ(white.color, clear.color);
  EXPECT_EQ(white.alpha, clear.alpha);
  ASSERT_EQ(white.alpha.size(), white.objects.size());
  const auto bare =
      static_cast<std::size_t>(std::ranges::find(white.alpha, 0) - white.alpha.begin());
  ASSERT_LT(bare, white.alpha.size());
  EXPECT_EQ(white.color[3 * bare], 0);
}

// The picture is that of the scene that is widened for its camera, also from elsewhere and after an
// edit, while queries see the scene as it is.
TEST(EyeFilms, LinesHaveTheLeastWidthOfTheFilm) {
  Scene scene = test::thin_scene();
  const auto expected = [&](const ShowView& look) {
    Scene wide = scene;
    wide.view = shown_view(scene.view, look, 1, look.separation > 0 ? 1 : 0);
    EXPECT_EQ(widen_to_least(wide), 6u);
    wide.view = scene.view;
    wide.view.film.least_width = 0;
    LiveScene live(std::move(wide));
    const Editor editor(live);
    EyeFilms films(live, editor, test::test_device(), options_to(0, 4), false);
    return full_picture(films, look);
  };
  LiveScene live(scene);
  Editor editor(live);
  EyeFilms films(live, editor, test::test_device(), options_to(0, 4), false);
  const auto expect_widened = [&](const ShowView& look) {
    const Picture seen = full_picture(films, look), wanted = expected(look);
    EXPECT_EQ(seen.objects, wanted.objects);
    EXPECT_EQ(seen.color, wanted.color);
    return std::ranges::count(seen.objects, 1u);
  };
  ShowView look = look_of_scene(scene);
  look.width = test::width;
  look.height = test::height;
  // Each of the three is 35 pixels long and 4 wide.
  EXPECT_GT(expect_widened(look), 3 * 35 * 3);
  look.world_from_camera[3].y *= 1.5;
  EXPECT_GT(expect_widened(look), 3 * 23 * 3);

  // A ray beside the line, within what is drawn.
  const RayRecord ray{0.1f, -5, 0.05f, 0, 0, 1, 0, INFINITY};
  const auto object = [&](DeviceScene& of) {
    return Query(of).closest(std::span(&ray, 1))[0].object;
  };
  EXPECT_EQ(object(films.drawn_scene()), 1u);
  EXPECT_EQ(object(films.device_scene()), 0u);

  editor.make(Reshape{1, 1, {-1, 0, 0.3}, {1, 0, 0.3}, 1e-4, 1e-4});
  apply_edit(scene, CapsuleEdit{{{}, 1}, 1, {{-1, 0, 0.3f}, {1, 0, 0.3f}, 1e-4f, 1e-4f}});
  expect_widened(look);
  EXPECT_EQ(object(films.drawn_scene()), 0u) << "it has moved away";

  scene.view.film.least_width = 6;
  live.edit(scene.view);
  expect_widened(look);
  look.separation = 0.5;  // the last picture is the right eye's
  expect_widened(look);

  scene.view.film.least_width = 0;
  live.edit(scene.view);
  full_picture(films, look);
  EXPECT_EQ(&films.drawn_scene(), &films.device_scene());
}

// A number of samples is taken in the place of the noise that the scene asks for.
TEST(EyeFilms, EndWithTheNoiseOfTheScene) {
  Scene scene = test::some_scene();
  scene.view.sampler.noise = 0.04;
  scene.view.sampler.samples_per_pixel = 4096;
  const Ended quiet = ended(options_to(0, 0), 0, scene);
  EXPECT_LE(quiet.last[0].noise, 0.04);
  EXPECT_GT(quiet.before[0].noise, 0.04);
  EXPECT_LT(quiet.last[0].samples, 4096u);
  scene.view.sampler.noise = 1;  // which 16 samples have
  EXPECT_EQ(ended(options_to(0, 20), 0, scene).last[0].samples, 20u);
}

TEST(EyeFilms, EndWithTheMostSamplesWhateverTheNoise) {
  const Ended few = ended(options_to(1e-4, 20));
  EXPECT_EQ(few.last[0].samples, 20u);
  EXPECT_GT(few.last[0].noise, 1e-4);
  EXPECT_EQ(ended(options_to(0, 20)).last[0].samples, 20u);
  EXPECT_GE(ended(options_to(1, 4096)).last[0].samples, 16u) << "few samples say little";
}

}  // namespace
}  // namespace caplet::view
