// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The same samples make the same film, however they are divided.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>
#include <string>

#include "film/develop.h"
#include "film/film_file.h"
#include "film/image.h"
#include "import/import.h"
#include "lower/lower.h"
#include "render/render.h"
#include "render/renderer.h"
#include "render/session.h"
#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

constexpr std::uint32_t samples = 64;

const LoweredScene& model() {
  static const LoweredScene made = lowered_everything(24, 18);
  return made;
}

bool same(const Film& a, const Film& b) {
  return a.layout() == b.layout() && a.parts() == b.parts() &&
         std::ranges::equal(a.words(), b.words());
}

/// All samples in one pass over the whole window.
const Film& whole() {
  static const Film film = [] {
    DeviceScene scene(test_device(), model().flat);
    Renderer renderer(scene, model().view, {.layers = Layers::every()});
    renderer.pass(renderer.film().layout.window, 0, samples);
    return renderer.film().read();
  }();
  return film;
}

/// Cuts of `range`, `pieces` of them.
std::vector<std::pair<int, int>> cuts(int range, int pieces, std::mt19937& random) {
  std::vector<int> at{0, range};
  while (static_cast<int>(at.size()) <= pieces) {
    at.push_back(1 + static_cast<int>(random() % static_cast<unsigned>(range - 1)));
    std::ranges::sort(at);
    at.erase(std::unique(at.begin(), at.end()), at.end());
  }
  std::vector<std::pair<int, int>> out;
  for (std::size_t i = 1; i < at.size(); ++i) out.emplace_back(at[i - 1], at[i] - at[i - 1]);
  return out;
}

std::vector<FilmPart> random_parts(std::mt19937& random) {
  const Window window = whole().layout().window;
  std::vector<FilmPart> parts;
  for (const auto& [x, width] : cuts(window.width, 1 + static_cast<int>(random() % 3), random))
    for (const auto& [y, height] : cuts(window.height, 1 + static_cast<int>(random() % 3), random))
      for (const auto& [begin, count] : cuts(samples, 1 + static_cast<int>(random() % 4), random))
        parts.push_back({{x, y, width, height},
                         static_cast<std::uint32_t>(begin),
                         static_cast<std::uint32_t>(count)});
  std::ranges::shuffle(parts, random);
  return parts;
}

TEST(FilmSplit, WindowsAndSamplesInAnyOrder) {
  DeviceScene scene(test_device(), model().flat);
  Renderer renderer(scene, model().view, {.layers = Layers::every(), .batch_paths = 3000});
  std::mt19937 random(1);
  for (int i = 0; i < 6; ++i) {
    renderer.reset(model().view);
    for (const FilmPart& part : random_parts(random))
      renderer.pass(part.window, part.sample_begin, part.sample_count);
    EXPECT_TRUE(std::ranges::equal(renderer.film().read().words(), whole().words())) << i;
  }
}

// Samples of listed pixels, in batches that hold a few of them or a part of one's samples, are
// those of the window.
TEST(FilmSplit, ListedPixelsInAnyOrder) {
  const Window window = whole().layout().window;
  for (const std::size_t batch_paths : {3000UL, 7UL}) {
    DeviceScene scene(test_device(), model().flat);
    Renderer renderer(scene, model().view, {.layers = Layers::every(), .batch_paths = batch_paths});
    std::mt19937 random(3);
    for (int i = 0; i < (batch_paths > 100 ? 4 : 1); ++i) {
      renderer.reset(model().view);
      std::map<std::uint32_t, std::vector<PixelRecord>> next;  // by the number of samples they get
      for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < window.width; ++x)
          next[1 + random() % samples].push_back(
              {static_cast<uint>(window.x + x), static_cast<uint>(window.y + y), 0, 0});
      for (auto& [count, pixels] : next) {
        std::ranges::shuffle(pixels, random);
        std::size_t done = 0;
        renderer.pass(pixels, count, [&](std::size_t now) {
          EXPECT_GT(now, done);
          done = now;
        });
        EXPECT_EQ(done, pixels.size());
        if (count == samples) continue;
        for (PixelRecord& pixel : pixels) pixel.sample_begin = count;
        renderer.pass(pixels, samples - count);
      }
      const Film film = renderer.film().read();
      EXPECT_TRUE(std::ranges::equal(film.words(), whole().words())) << batch_paths << " " << i;
      EXPECT_TRUE(film.parts().empty());
    }
  }
}

TEST(FilmSplit, NumbersAreThoseOfTheFirstSample) {
  DeviceScene scene(test_device(), model().flat);
  Renderer renderer(scene, model().view, {.layers = Layers::every()});
  renderer.pass(whole().layout().window, 0, 1);
  const Film first = renderer.film().read();
  std::size_t seen = 0;
  for (std::size_t pixel = 0; pixel < first.layout().window.pixels(); ++pixel) {
    EXPECT_EQ(whole().number(Layer::object, pixel), first.number(Layer::object, pixel)) << pixel;
    EXPECT_EQ(whole().number(Layer::primitive, pixel), first.number(Layer::primitive, pixel))
        << pixel;
    seen += first.number(Layer::object, pixel) != CAPLET_NONE ? 1 : 0;
  }
  EXPECT_GT(seen, 0u);
}

TEST(FilmSplit, FilmsAddedInAnyOrder) {
  DeviceScene scene(test_device(), model().flat);
  std::mt19937 random(2);
  std::vector<Film> films;
  Renderer renderer(scene, model().view, {.layers = Layers::every()});
  for (std::uint32_t begin = 0; begin < samples; begin += 16) {
    renderer.reset(model().view);
    renderer.pass(whole().layout().window, begin, 16);
    films.push_back(renderer.film().read());
  }
  const auto folder = temporary_folder();
  int number = 0;
  for (int i = 0; i < 4; ++i) {
    std::ranges::shuffle(films, random);
    Film sum(whole().layout());
    for (const Film& film : films) {
      const auto file = folder / (std::to_string(number++) + ".exr");
      save_film(file, {film, "", "", 0, {}, {}});
      sum.add(load_film(file).film);
    }
    EXPECT_TRUE(same(sum, whole())) << i;
  }
}

TEST(FilmSplit, PassesOfTheSameSamplesAreRefused) {
  DeviceScene scene(test_device(), model().flat);
  Renderer renderer(scene, model().view, {.layers = Layers::none()});
  renderer.pass({0, 0, 12, 18}, 0, 8);
  renderer.pass({12, 0, 12, 18}, 0, 8);
  EXPECT_THROW(renderer.pass({11, 3, 2, 2}, 7, 2), InputError);
  EXPECT_THAT(renderer.film().parts, testing::ElementsAre(FilmPart{{0, 0, 24, 18}, 0, 8}));
}

TEST(FilmSplit, DevicesShareTheSamples) {
  const std::size_t units = test_device().info().compute_units;
  if (!test_device().is_pocl() || units < 2)
    GTEST_SKIP() << "needs PoCL on two or more processors, to be divided";
  for (std::size_t parts = 1; parts <= std::min<std::size_t>(units, 4); ++parts) {
    std::vector<Device> devices;
    try {
      devices = test_device().split(parts);
    } catch (const DriverError& refusal) {  // PoCL 7.1 with two processors
      GTEST_SKIP() << refusal.what();
    }
    ASSERT_EQ(devices.size(), parts);
    Session session(model().flat, model().view, devices,
                    {.layers = Layers::every(), .pass_samples = 5});
    for (const std::uint32_t count : {samples / 4, samples - samples / 4}) {
      std::uint32_t told = 0;
      double fraction = 0;
      EXPECT_EQ(session.render(count,
                               [&](const SessionProgress& progress) {
                                 EXPECT_LE(told, progress.samples_done);
                                 EXPECT_LE(fraction, progress.fraction);
                                 told = progress.samples_done;
                                 fraction = progress.fraction;
                               }),
                count);
      EXPECT_EQ(told, count);
      EXPECT_EQ(fraction, 1);
    }
    EXPECT_TRUE(same(session.film(), whole())) << parts;
  }
  EXPECT_THROW(test_device().split(units + 1), RunError);
}

TEST(FilmSplit, SessionsMayTakeTheTreesOfAScene) {
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    const Device device = test_device(encoding);
    const SessionOptions options{.layers = Layers::every()};
    FlatScene spent = model().flat;
    Session session(std::move(spent), model().view, {device}, options);
    EXPECT_TRUE(spent.nodes.empty());  // NOLINT(bugprone-use-after-move): as documented
    EXPECT_TRUE(spent.leaves.empty());
    EXPECT_EQ(spent.geometries.size(), model().flat.geometries.size());
    EXPECT_EQ(session.render(samples), samples);
    Session other(model().flat, model().view, {device}, options);
    EXPECT_EQ(other.render(samples), samples);
    EXPECT_TRUE(same(session.film(), other.film()));
  }
  // Each of several devices has them.
  FlatScene spent = model().flat;
  Session session(std::move(spent), model().view, {test_device(), test_device()},
                  {.layers = Layers::every(), .pass_samples = 5});
  EXPECT_EQ(session.render(samples), samples);
  EXPECT_TRUE(same(session.film(), whole()));
}

TEST(FilmSplit, CancelledSessionsKeepWhatIsFinished) {
  Session session(model().flat, model().view, {test_device()},
                  {.layers = Layers::every(), .pass_samples = 4});
  const auto cancel_at_8 = [&](const SessionProgress& progress) {
    if (progress.samples_done >= 8) session.cancel();
  };
  EXPECT_EQ(session.render(samples, cancel_at_8), 8u);
  const Film film = session.film();
  EXPECT_THAT(film.parts(), testing::ElementsAre(FilmPart{film.layout().window, 0, 8}));
  // Before a render begins it is the next one that ends.
  session.cancel();
  EXPECT_EQ(session.render(4), 0u);
  // It goes on after them; so does another one that is given the film.
  EXPECT_EQ(session.render(samples - 8), samples - 8);
  EXPECT_TRUE(same(session.film(), whole()));
  Session other(model().flat, model().view, {test_device()}, {.layers = Layers::every()});
  other.resume(film);
  EXPECT_EQ(other.render(samples - 8), samples - 8);
  EXPECT_TRUE(same(other.film(), whole()));
  Session bare(model().flat, model().view, {test_device()}, {.layers = Layers::none()});
  EXPECT_THROW(bare.resume(film), InputError);
}

TEST(FilmSplit, WhatProgressThrowsEndsTheRenderAfterABatch) {
  Session session(model().flat, model().view, {test_device()},
                  {.layers = Layers::every(), .batch_paths = 1u << 8});
  int told = 0;
  EXPECT_THROW(session.render(samples,
                              [&](const SessionProgress&) {
                                ++told;
                                throw std::range_error("enough");
                              }),
               std::range_error);
  EXPECT_EQ(told, 1);
  EXPECT_LT(session.rays().camera, 2u << 8);
  EXPECT_TRUE(session.film().parts().empty());
  EXPECT_EQ(session.render(1), 1u);
}

TEST(FilmSplit, SessionsEndAtTheirTimeLimitAfterOnePass) {
  Session session(model().flat, model().view, {test_device()},
                  {.layers = Layers::none(), .pass_samples = 4});
  EXPECT_EQ(session.render(samples, {}, 1e-9), 4u);
  EXPECT_THAT(session.film().parts(),
              testing::ElementsAre(FilmPart{session.film().layout().window, 0, 4}));
}

// A layer that is not asked for takes no room, and changes nothing of the others. The variance
// alone has other samples.
TEST(FilmSplit, LayersDoNotSeeEachOther) {
  DeviceScene scene(test_device(), model().flat);
  const auto film_with = [&](Layers layers) {
    Renderer renderer(scene, model().view, {.layers = layers});
    renderer.pass(whole().layout().window, 0, samples);
    return renderer.film().read();
  };
  const LayeredImage with_variance = develop(whole(), model().scene.view.film, Layers::every()),
                     usual = develop(film_with(Layers::usual()), model().scene.view.film,
                                     Layers::usual());
  EXPECT_NE(channel(with_variance, "R").floats, channel(usual, "R").floats);
  for (const Layers layers : {Layers::none(), Layers::none().with(Layer::normal),
                              Layers::none().with(Layer::variance).with(Layer::object),
                              Layers::mattes().with(Layer::variance)}) {
    const LayeredImage& all = layers.has(Layer::variance) ? with_variance : usual;
    const Film film = film_with(layers);
    EXPECT_EQ(film.words().size(), film.layout().window.pixels() * film.layout().words_per_pixel());
    const LayeredImage image = develop(film, model().scene.view.film, layers);
    EXPECT_EQ(image.channels.size(), layers.channels());
    for (const Channel& found : image.channels) {
      EXPECT_EQ(found.floats, channel(all, found.name).floats) << found.name;
      EXPECT_EQ(found.uints, channel(all, found.name).uints) << found.name;
    }
  }
}

}  // namespace
}  // namespace caplet::test
