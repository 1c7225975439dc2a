// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Mattes and deep pictures of films by hand.
#include "film/mattes.h"

#include <ImfDeepScanLineInputFile.h>
#include <ImfStringAttribute.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "film/deep.h"
#include "film/develop.h"
#include "film/film_file.h"
#include "film_sums.h"
#include "scene/matte_names.h"
#include "support/data.h"
#include "support/deep_exr.h"

namespace caplet::mattes_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

FilmLayout layout_of(int width, int height, Layers layers) {
  FilmLayout layout;
  layout.width = 8;
  layout.height = 6;
  layout.window = {2, 1, width, height};
  layout.layers = layers;
  return layout;
}

struct Thing {
  std::uint32_t key;
  std::uint64_t samples;
  double sum = 0;
};

/// Gives a pixel so many samples, and a layer of slots these things.
void set(Film& film, Layer layer, std::size_t pixel, std::uint32_t samples,
         const std::vector<Thing>& things) {
  const FilmLayout& layout = film.layout();
  std::uint64_t* words = &film.words()[pixel * layout.words_per_pixel()];
  words[0] = samples;
  std::uint64_t* slot = words + layout.first_word(layer);
  for (const Thing& thing : things) {
    *slot++ = std::uint64_t{thing.key} << 32 | thing.samples;
    if (layer == Layer::deep)
      *slot++ = static_cast<std::uint64_t>(
          std::ldexp(thing.sum, -row_of(layer).unit(0, layout.length_exponent)));
  }
}

// MurmurHash3's values, x86 of 32 bits, seed 0, as its implementations' tests state them; with bit
// 23 turned over where the exponent would be 0 or 255 (Cryptomatte 1.2.0).
TEST(MatteHash, IsMurmurHash3) {
  EXPECT_EQ(matte_hash("hello"), 0x248bfa47u);
  EXPECT_EQ(matte_hash("hello, world"), 0x149bbb7fu);
  EXPECT_EQ(matte_hash("19 Jan 2038 at 3:14:07 AM"), 0xe31e8a70u);
  EXPECT_EQ(matte_hash("The quick brown fox jumps over the lazy dog."), 0xd5c48bfcu);
  EXPECT_EQ(matte_hash("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
  EXPECT_EQ(matte_hash("capsule 12"), 0xd70bf6bfu);  // by PyPI's mmh3
  EXPECT_EQ(matte_hash(""), 0x00800000u);            // of 0
  // "CryptoObject" is the name of Blender's layer, whose attributes it begins 3ae39a5.
  EXPECT_EQ(matte_hash("CryptoObject") >> 4, 0x3ae39a5u);
}

TEST(MatteHash, IsTheBitsOfANormalNumber) {
  int turned = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::uint32_t hash = matte_hash(std::to_string(i));
    ASSERT_TRUE(std::isnormal(std::bit_cast<float>(hash))) << i;
    turned += (hash >> 23 & 255) == 1 || (hash >> 23 & 255) == 254 ? 1 : 0;
  }
  // Exponents 1 and 254 come twice as often as the others: 4 in 256.
  EXPECT_NEAR(turned, 20000 * 4 / 256, 4 * std::sqrt(20000 * 4 / 256.0));
}

TEST(Mattes, AreInTheOrderOfTheirCoverage) {
  Film film(layout_of(2, 1, Layers::mattes()));
  set(film, Layer::crypto_object, 1, 8, {{100, 1}, {200, 4}, {300, 1}, {400, 2}});
  const auto ranks = matte_ranks(film, Layer::crypto_object, 1);
  std::vector<std::pair<std::uint32_t, float>> found;
  for (const MatteRank& rank : ranks)
    found.emplace_back(std::bit_cast<std::uint32_t>(rank.id), rank.coverage);
  EXPECT_THAT(found, ElementsAre(std::pair{200u, 0.5f}, std::pair{400u, 0.25f},
                                 std::pair{100u, 0.125f}, std::pair{300u, 0.125f}));
  EXPECT_TRUE(matte_ranks(film, Layer::crypto_object, 0).empty());
  EXPECT_TRUE(matte_ranks(film, Layer::crypto_asset, 1).empty());
}

TEST(Mattes, BecomeAsManyChannelsAsTheyHaveLevels) {
  Film film(layout_of(2, 1, Layers::mattes()));
  set(film, Layer::crypto_asset, 1, 4, {{0x3f800000, 1}, {0x40000000, 2}, {0x40400000, 1}});
  const Layers asset = Layers::none().with(Layer::crypto_asset);
  const auto names = [&](int levels) {
    FilmSettings settings;
    settings.matte_levels = levels;
    std::vector<std::string> out;
    const LayeredImage image = develop(film, settings, asset);
    for (const Channel& channel : image.channels)
      if (channel.name.size() > 1) out.push_back(channel.name);
    EXPECT_EQ(image.channels.size(), asset.channels(levels));
    return out;
  };
  EXPECT_THAT(names(1), ElementsAre("CryptoAsset00.R", "CryptoAsset00.G", "CryptoAsset00.B",
                                    "CryptoAsset00.A"));
  EXPECT_EQ(names(2), names(1));
  EXPECT_EQ(names(3).size(), 8u);
  EXPECT_EQ(names(3).back(), "CryptoAsset01.A");
  EXPECT_EQ(names(6).back(), "CryptoAsset02.A");
  EXPECT_EQ(names(16).back(), "CryptoAsset07.A");

  const LayeredImage image = develop(film, FilmSettings{}, asset);
  const auto value = [&](const char* name) { return image.find(name)->floats.at(1); };
  EXPECT_EQ(value("CryptoAsset00.R"), 2);
  EXPECT_EQ(value("CryptoAsset00.G"), 0.5);
  EXPECT_EQ(value("CryptoAsset00.B"), 1);
  EXPECT_EQ(value("CryptoAsset00.A"), 0.25);
  EXPECT_EQ(value("CryptoAsset01.R"), 3);
  EXPECT_EQ(value("CryptoAsset01.G"), 0.25);
  EXPECT_EQ(value("CryptoAsset01.B"), 0);
  EXPECT_EQ(image.find("CryptoAsset00.R")->floats.at(0), 0);
}

TEST(Mattes, WarnOfPixelsWithMoreThingsThanSlots) {
  Film film(layout_of(3, 1, Layers::mattes()));
  std::vector<Thing> many;
  for (std::uint32_t i = 0; i < CAPLET_SLOTS; ++i) many.push_back({1000 + i, 2});
  for (const std::size_t pixel : {0U, 1U}) {
    set(film, Layer::crypto_object, pixel, 40, many);
    test::set_sum(film, Layer::coverage, 0, pixel, pixel == 0 ? 32 : 33);
  }
  PictureFlaws flaws;
  develop(film, FilmSettings{}, Layers::mattes(), flaws);
  EXPECT_EQ(flaws.crowded, 1u);
  testing::internal::CaptureStderr();
  flaws.warn();
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("1 of 3 pixels show more than 16 things: their mattes lack some"));
}

TEST(Deep, SamplesCompositeToAlphaAndTheMeanDistance) {
  Film film(layout_of(2, 1, deep_layers()));
  set(film, Layer::deep, 1, 8, {{10, 2, 6}, {20, 1, 4}, {30, 4, 40}});
  test::set_sum(film, Layer::coverage, 0, 1, 7);
  test::set_sum(film, Layer::depth, 0, 1, 50);
  const std::vector<DeepSample> samples = deep_samples(film, 1);
  ASSERT_EQ(samples.size(), 3u);
  // 2 of 8, 1 of the 6 that are left, 4 of the 5.
  EXPECT_EQ(samples[0].alpha, 0.25f);
  EXPECT_EQ(samples[0].depth, 3);
  EXPECT_EQ(samples[1].alpha, 1 / 6.0f);
  EXPECT_EQ(samples[1].depth, 4);
  EXPECT_EQ(samples[2].alpha, 0.8f);
  EXPECT_EQ(samples[2].depth, 10);
  EXPECT_TRUE(deep_samples(film, 0).empty());
}

// What found no slot is one sample behind the others.
TEST(Deep, WhatIsBeyondTheSlotsIsOneSample) {
  Film film(layout_of(1, 1, deep_layers()));
  std::vector<Thing> many;
  for (std::uint32_t i = 0; i < CAPLET_SLOTS; ++i) many.push_back({10 + i, 1, 1.0 + i});
  set(film, Layer::deep, 0, 20, many);
  test::set_sum(film, Layer::coverage, 0, 0, 20);
  test::set_sum(film, Layer::depth, 0, 0, 16 * 17 / 2 + 4 * 30);
  const std::vector<DeepSample> samples = deep_samples(film, 0);
  ASSERT_EQ(samples.size(), CAPLET_SLOTS + std::size_t{1});
  EXPECT_EQ(samples[15].alpha, 1 / 5.0f);
  EXPECT_EQ(samples[16].alpha, 1);
  EXPECT_EQ(samples[16].depth, 30);
}

TEST(Deep, FilesHoldTheSamplesOfEachPixel) {
  const auto path = test::temporary_folder() / "deep.exr";
  Film film(layout_of(3, 2, deep_layers()));
  for (std::size_t pixel = 0; pixel < 6; ++pixel) {
    std::vector<Thing> things;
    double sum = 0;
    for (std::uint32_t i = 0; i < pixel; ++i) {
      things.push_back({i + 1, 1, 2.0 + i});
      sum += 2.0 + i;
    }
    set(film, Layer::deep, pixel, 8, things);
    test::set_sum(film, Layer::coverage, 0, pixel, static_cast<double>(pixel));
    test::set_sum(film, Layer::depth, 0, pixel, sum);
  }
  write_deep_exr(path, film.layout(), [&](int first, int count) { return film.rows(first, count); },
                 {{"software", "a test"}, {"cryptomatte/1234567/name", "CryptoObject"}});

  Imf::DeepScanLineInputFile file(path.c_str());
  const Imath::Box2i window = file.header().dataWindow();
  EXPECT_EQ(window, Imath::Box2i({2, 1}, {4, 2}));
  EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {7, 5}));
  EXPECT_EQ(file.header().typedAttribute<Imf::StringAttribute>("software").value(), "a test");
  EXPECT_EQ(file.header().findTypedAttribute<Imf::StringAttribute>("cryptomatte/1234567/name"),
            nullptr);
  const auto samples = test::read_deep(path);
  ASSERT_EQ(samples.size(), 6u);
  for (std::size_t pixel = 0; pixel < 6; ++pixel) {
    ASSERT_EQ(samples[pixel].size(), pixel);
    for (std::size_t i = 0; i < pixel; ++i)
      EXPECT_EQ(samples[pixel][i],
                std::pair(1 / (8.0f - static_cast<float>(i)), 2 + static_cast<float>(i)));
  }
}

TEST(Deep, AFileThatCannotBeWrittenIsAnError) {
  const Film film(layout_of(1, 1, deep_layers()));
  const auto rows = [&](int first, int count) { return film.rows(first, count); };
  EXPECT_THROW(
      write_deep_exr(test::temporary_folder() / "none" / "deep.exr", film.layout(), rows, {}),
      RunError);
}

TEST(Mattes, LevelsAndNamesAreInFilmFiles) {
  const auto path = test::temporary_folder() / "mattes.film";
  SavedFilm saved;
  saved.film = Film(layout_of(2, 1, Layers::every()));
  saved.film.add(Film(saved.film.layout(), std::vector<std::uint64_t>(saved.film.words().size()),
                      {{saved.film.layout().window, 0, 8}}));
  set(saved.film, Layer::crypto_object, 1, 8, {{100, 1}, {200, 4}});
  saved.settings.matte_levels = 3;
  saved.notes["cryptomatte/1234567/name"] = "CryptoObject";
  save_film(path, saved);
  const SavedFilm loaded = load_film(path);
  EXPECT_EQ(loaded.settings.matte_levels, 3);
  EXPECT_EQ(loaded.notes, saved.notes);
  EXPECT_EQ(loaded.film.slots(Layer::crypto_object, 1),
            (std::vector<Slot>{{100, 1, 0}, {200, 4, 0}}));
}

}  // namespace
}  // namespace caplet::mattes_test
