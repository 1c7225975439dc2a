// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Films as wholes: what is in them, adding them, files of them.
#include "film/film.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "film/image.h"
#include "film_sums.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

FilmLayout layout_of(int width, int height, Layers layers = Layers::all()) {
  FilmLayout layout;
  layout.width = 20;
  layout.height = 10;
  layout.window = {4, 3, width, height};
  layout.layers = layers;
  layout.color_exponent = 3;
  layout.length_exponent = -2;
  return layout;
}

/// Whole numbers that a double holds, of either sign, as the sums of every layer; numbers of sample
/// `begin`.
Film random_film(const FilmLayout& layout, std::uint32_t seed, std::uint32_t begin,
                 std::uint32_t samples) {
  std::mt19937 random(seed);
  Film film(layout, std::vector<std::uint64_t>(layout.window.pixels() * layout.words_per_pixel()),
            {{layout.window, begin, samples}});
  for (std::size_t i = 0; i < layout.window.pixels(); ++i) {
    film.words()[i * layout.words_per_pixel()] = samples;
    for (std::size_t l = 0; l < layer_rows.size(); ++l) {
      const auto layer = static_cast<Layer>(l);
      if (!layout.layers.has(layer)) continue;
      if (layer_rows[l].kind == LayerKind::id) {
        film.words()[i * layout.words_per_pixel() + layout.first_word(layer)] =
            ~((std::uint64_t{begin} << 32) | random());
        continue;
      }
      for (std::size_t c = 0; c < static_cast<std::size_t>(layer_rows[l].count); ++c)
        test::set_sum(
            film, layer, c, i,
            std::ldexp(static_cast<int>(random() % 2001) - 1000, layer_rows[l].unit(3, -2) + 20));
    }
  }
  return film;
}

bool same(const Film& a, const Film& b) {
  return a.layout() == b.layout() && std::ranges::equal(a.words(), b.words());
}

TEST(Film, WordsOfAPixelAreThoseOfItsLayers) {
  // Samples 1, R G B of two words each, A 1; Z 1, albedo, N and P 3 each, the two numbers 1 each;
  // the variance of three words each.
  EXPECT_EQ(layout_of(1, 1, Layers::none()).words_per_pixel(), 8u);
  EXPECT_EQ(layout_of(1, 1, Layers::usual()).words_per_pixel(), 20u);
  EXPECT_EQ(layout_of(1, 1, Layers::all()).words_per_pixel(), 29u);
  EXPECT_EQ(layout_of(1, 1, Layers::none().with(Layer::normal)).first_word(Layer::normal), 8u);
  EXPECT_EQ(layout_of(1, 1, Layers::none()).floats_per_path(), 1u);
  EXPECT_EQ(layout_of(1, 1, Layers::all()).floats_per_path(), 13u);
}

TEST(Film, SumsHaveTheirUnits) {
  Film film(layout_of(2, 1));
  // By hand: R of -2.5 units of 2^(3 - 60) is -2 units: ...fffe in two words, all others zero. Z of
  // 3 units of 2^(-2 - 36).
  std::uint64_t* pixel = &film.words()[film.layout().words_per_pixel()];
  pixel[1] = ~std::uint64_t{1};
  pixel[2] = ~std::uint64_t{0};
  EXPECT_EQ(film.sum(Layer::color, 0, 1), -2 * 0x1p-57);
  pixel[film.layout().first_word(Layer::depth)] = 3;
  EXPECT_EQ(film.sum(Layer::depth, 0, 1), 3 * 0x1p-38);
  EXPECT_EQ(film.sum(Layer::depth, 0, 0), 0);
  // The variance's third word counts 2^128 units of 2^(2 * 3 - 100).
  pixel[film.layout().first_word(Layer::variance) + 2] = 5;
  EXPECT_EQ(film.sum(Layer::variance, 0, 1), 5 * 0x1p34);
  EXPECT_EQ(film.number(Layer::object, 1), CAPLET_NONE);
}

TEST(Film, AddingIsTheSameInAnyOrder) {
  const FilmLayout layout = layout_of(5, 4);
  std::vector<Film> films;
  for (std::uint32_t i = 0; i < 6; ++i) films.push_back(random_film(layout, i, 10 * i, 10));
  Film in_order(layout);
  for (const Film& film : films) in_order.add(film);
  EXPECT_THAT(in_order.parts(), ElementsAre(FilmPart{layout.window, 0, 60}));
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) {
    std::ranges::shuffle(films, random);
    Film halves[2] = {Film(layout), Film(layout)};
    for (std::size_t k = 0; k < films.size(); ++k) halves[k % 2].add(films[k]);
    halves[0].add(halves[1]);
    EXPECT_TRUE(same(halves[0], in_order));
    EXPECT_EQ(halves[0].parts(), in_order.parts());
  }
  // What was added: doubles that hold these sums exactly.
  for (std::size_t pixel = 0; pixel < layout.window.pixels(); ++pixel) {
    EXPECT_EQ(in_order.samples(pixel), 60u);
    double color = 0, variance = 0;
    for (const Film& film : films)
      color += film.sum(Layer::color, 2, pixel), variance += film.sum(Layer::variance, 1, pixel);
    EXPECT_EQ(in_order.sum(Layer::color, 2, pixel), color);
    EXPECT_EQ(in_order.sum(Layer::variance, 1, pixel), variance);
    const auto first = std::ranges::find_if(
        films, [](const Film& film) { return film.parts()[0].sample_begin == 0; });
    EXPECT_EQ(in_order.number(Layer::object, pixel), first->number(Layer::object, pixel));
  }
}

TEST(Film, SamplesAreInItOnce) {
  const FilmLayout layout = layout_of(5, 4);
  Film film = random_film(layout, 1, 4, 8);
  const Film before = film;
  EXPECT_THAT([&] { film.add(random_film(layout, 2, 11, 3)); },
              ThrowsMessage<InputError>(
                  HasSubstr("samples 11 to 12 of pixel 4,3 would be in the film twice")));
  EXPECT_TRUE(same(film, before));
  EXPECT_EQ(film.parts(), before.parts());
  EXPECT_THROW(film.add(random_film(layout_of(5, 3), 2, 20, 3)), InputError);
  EXPECT_THROW(film.add(random_film(layout_of(5, 4, Layers::usual()), 2, 20, 3)), InputError);
  film.add(random_film(layout, 2, 12, 3));
  EXPECT_THAT(film.parts(), ElementsAre(FilmPart{layout.window, 4, 11}));
}

TEST(Film, PartsThatFitTogetherAreOne) {
  std::vector<FilmPart> pieces;
  for (const int x : {0, 3})
    for (const int y : {0, 4})
      for (const std::uint32_t begin : {0u, 5u}) pieces.push_back({{x, y, 3, 4}, begin, 5});
  std::vector<std::size_t> order(pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<FilmPart> parts;
  for (const std::size_t i : order) add_part(parts, pieces[i]);
  EXPECT_THAT(parts, ElementsAre(FilmPart{{0, 0, 6, 8}, 0, 10}));
  EXPECT_THROW(add_part(parts, {{5, 7, 1, 1}, 9, 1}), InputError);
  add_part(parts, {{6, 0, 1, 1}, 9, 1});
  EXPECT_EQ(parts.size(), 2u);
}

TEST(Film, FilesHoldAllOfIt) {
  const auto folder = test::temporary_folder();
  for (const Layers layers : {Layers::none(), Layers::all()}) {
    const Film film = random_film(layout_of(5, 4, layers), 1, 4, 8);
    const auto file = folder / (std::to_string(layers.channels()) + ".exr");
    film.save(file);
    const Film again = Film::load(file);
    EXPECT_TRUE(same(again, film));
    EXPECT_EQ(again.parts(), film.parts());
  }
}

TEST(Film, FilesThatAreNoneAreRefused) {
  const auto folder = test::temporary_folder();
  EXPECT_THROW(Film::load(folder / "missing.exr"), InputError);
  std::ofstream(folder / "text.exr") << "no picture";
  EXPECT_THROW(Film::load(folder / "text.exr"), InputError);
  LayeredImage picture;
  picture.width = picture.height = picture.data_width = picture.data_height = 2;
  picture.channels.push_back({"R", std::vector<float>(4), {}});
  write_exr(folder / "picture.exr", picture);
  EXPECT_THAT([&] { Film::load(folder / "picture.exr"); },
              ThrowsMessage<InputError>(HasSubstr("picture.exr: this is no film")));
  const Film film = random_film(layout_of(5, 4), 1, 4, 8);
  film.save(folder / "film.exr");
  int number = 0;
  for (const auto& [name, wrong] : std::vector<std::pair<std::string, std::string>>{
           {"caplet.film", "2"},
           {"caplet.film.layers", "1000000"},
           {"caplet.film.layers", "7x"},
           {"caplet.film.color_exponent", "x"},
           {"caplet.film.length_exponent", "61"},
           {"caplet.film.samples", "4 3 5 4 4"},
           {"caplet.film.samples", "0 0 20 10 4 8"},
           {"caplet.film.samples", "4 3 5 4 4 8,4 3 1 1 6 1"}}) {
    LayeredImage image = read_exr(folder / "film.exr");
    std::erase_if(image.metadata,
                  [](const auto& entry) { return !entry.first.starts_with("caplet."); });
    image.metadata[name] = wrong;
    const auto file = folder / (std::to_string(number++) + ".exr");
    write_exr(file, image);
    EXPECT_THROW(Film::load(file), InputError) << name << ' ' << wrong;
  }
  LayeredImage image = read_exr(folder / "film.exr");
  std::erase_if(image.metadata,
                [](const auto& entry) { return !entry.first.starts_with("caplet."); });
  image.channels.pop_back();
  write_exr(folder / "broken.exr", image);
  EXPECT_THAT([&] { Film::load(folder / "broken.exr"); },
              ThrowsMessage<InputError>(HasSubstr("is missing")));
}

}  // namespace
}  // namespace caplet
