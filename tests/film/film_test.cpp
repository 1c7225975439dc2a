// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Films as wholes: what is in them, adding them, files of them.
#include "film/film_file.h"

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
  // the first replicate's R G B of two words each.
  EXPECT_EQ(layout_of(1, 1, Layers::none()).words_per_pixel(), 8u);
  EXPECT_EQ(layout_of(1, 1, Layers::usual()).words_per_pixel(), 20u);
  EXPECT_EQ(layout_of(1, 1, Layers::all()).words_per_pixel(), 26u);
  EXPECT_EQ(layout_of(1, 1, Layers::none().with(Layer::normal)).first_word(Layer::normal), 8u);
  // A matte 16 slots of a word, a deep layer of two.
  EXPECT_EQ(layout_of(1, 1, Layers::mattes()).words_per_pixel(), 8u + 3 * 16);
  EXPECT_EQ(layout_of(1, 1, Layers::every()).words_per_pixel(), 26u + 3 * 16 + 32);
  EXPECT_EQ(layout_of(1, 1, Layers::none()).floats_per_path(), 1u);
  EXPECT_EQ(layout_of(1, 1, Layers::every()).floats_per_path(), 17u);
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
  // The second word of the first replicate's green counts 2^64 units of 2^(3 - 60).
  pixel[film.layout().first_word(Layer::variance) + 3] = 5;
  EXPECT_EQ(film.sum(Layer::variance, 1, 1), 5 * 0x1p7);
  // Samples, and those of the first replicate.
  pixel[0] = std::uint64_t{7} << 32 | 13;
  EXPECT_EQ(film.samples(1), 13u);
  EXPECT_EQ(film.first_replicate_samples(1), 7u);
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
    save_film(file, {film, "", "", 0, {}, {}});
    const Film again = load_film(file).film;
    EXPECT_TRUE(same(again, film));
    EXPECT_EQ(again.parts(), film.parts());
  }
}

SavedFilm saved_film(std::uint32_t begin, std::uint32_t samples) {
  SavedFilm out{random_film(layout_of(5, 4), 1, begin, samples), "s1", "v1", 16, {}, {}};
  out.settings.width = 20;
  out.settings.height = 10;
  return out;
}

TEST(SavedFilm, FilesHoldWhatPicturesAreDevelopedBy) {
  const auto folder = test::temporary_folder();
  LayeredImage sky;
  sky.width = sky.data_width = 3;
  sky.height = sky.data_height = 2;
  for (const char* name : {"R", "G", "B"})
    sky.channels.push_back({name, {0.1f, 0.7f, 1.f / 3, 0, 1, 0.25f}, {}});
  write_exr(folder / "sky.exr", sky);
  std::vector<std::optional<Backdrop>> backdrops(4);
  backdrops[1] = Backdrop{Backdrop::Kind::transparent, {}, nullptr};
  backdrops[2] = Backdrop{Backdrop::Kind::color, {0.1, 1. / 3, 1}, nullptr};
  backdrops[3] =
      Backdrop{Backdrop::Kind::image,
               {},
               std::make_shared<EnvironmentImage>(FileImageReader().read_rgb(folder / "sky.exr"))};
  for (const std::optional<Backdrop>& backdrop : backdrops) {
    SavedFilm film = saved_film(4, 8);
    film.settings.iso = 1. / 3;
    film.settings.exposure_time = 0.1;
    film.settings.f_number = 5.6;
    film.settings.white_balance = 3456.7;
    film.settings.space = ColorSpace::aces2065_1;
    film.settings.backdrop = backdrop;
    film.settings.exposure = {-1. / 3, false};
    if (backdrop) film.settings.exposure = {0, true};
    film.notes = {{"caplet.device", "A"}, {"software", "Caplet 1"}, {"caplet.seed", "7"}};
    save_film(folder / "a.film", film);
    const SavedFilm again = load_film(folder / "a.film");
    EXPECT_TRUE(same(again.film, film.film));
    EXPECT_EQ(again.notes, film.notes);
    EXPECT_EQ(again.scene, "s1");
    EXPECT_EQ(again.view, "v1");
    EXPECT_EQ(again.samples_wanted, 16u);
    EXPECT_EQ(again.settings.iso, film.settings.iso);
    EXPECT_EQ(again.settings.exposure_time, film.settings.exposure_time);
    EXPECT_EQ(again.settings.f_number, film.settings.f_number);
    EXPECT_EQ(again.settings.white_balance, film.settings.white_balance);
    EXPECT_EQ(again.settings.space, film.settings.space);
    EXPECT_EQ(again.settings.exposure, film.settings.exposure);
    EXPECT_EQ(again.settings.width, 20);
    EXPECT_EQ(again.settings.height, 10);
    ASSERT_EQ(again.settings.backdrop.has_value(), backdrop.has_value());
    if (!backdrop) continue;
    EXPECT_EQ(again.settings.backdrop->kind, backdrop->kind);
    EXPECT_EQ(again.settings.backdrop->color, backdrop->color);
    if (backdrop->image) {
      EXPECT_EQ(again.settings.backdrop->image->rgb, backdrop->image->rgb);
    }
  }
  std::filesystem::remove(folder / "sky.exr");
  EXPECT_THAT([&] { load_film(folder / "a.film"); },
              ThrowsMessage<InputError>(HasSubstr("sky.exr")));
}

TEST(SavedFilm, OfTheSamePictureAreAdded) {
  SavedFilm sum = saved_film(0, 8);
  sum.notes = {{"caplet.device", "A"}, {"caplet.render_seconds", "1.5"}, {"caplet.driver", "x"}};
  SavedFilm more = saved_film(8, 4);
  more.notes = {
      {"caplet.device", "B, A"}, {"caplet.render_seconds", "2.250"}, {"caplet.driver", "x"}};
  more.samples_wanted = 20;
  add(sum, more);
  EXPECT_EQ(sum.samples_wanted, 20u);
  EXPECT_EQ(sum.film.samples(0), 12u);
  EXPECT_EQ(sum.notes.at("caplet.device"), "A, B");
  EXPECT_EQ(sum.notes.at("caplet.driver"), "x");
  EXPECT_EQ(sum.notes.at("caplet.render_seconds"), "3.750");
  EXPECT_EQ(sum.notes.at("caplet.samples_per_pixel"), "12");
  EXPECT_EQ(text_of(samples_of(sum.film)), "0:12");
  const auto refused = [&](auto change, const char* why) {
    SavedFilm other = saved_film(12, 4);
    change(other);
    const SavedFilm before = sum;
    EXPECT_THAT([&] { add(sum, other); }, ThrowsMessage<InputError>(HasSubstr(why)));
    EXPECT_TRUE(same(sum.film, before.film)) << why;
    EXPECT_EQ(sum.notes, before.notes);
  };
  const auto with = [](auto member, auto value) {
    return [member, value](SavedFilm& film) {
      FilmLayout layout = film.film.layout();
      layout.*member = value;
      film.film = random_film(layout, 1, 12, 4);
    };
  };
  refused(with(&FilmLayout::width, 21), "its size is 21 x 10, not 20 x 10");
  refused(with(&FilmLayout::height, 11), "its size is 20 x 11, not 20 x 10");
  refused(with(&FilmLayout::window, Window{4, 3, 5, 5}), "its crop is 4,3,9,8, not 4,3,9,7");
  refused(with(&FilmLayout::layers, Layers::none()), "its layers are none, not Z");
  refused(with(&FilmLayout::color_exponent, 4), "it is of another scene");
  refused([](SavedFilm& film) { film.scene = "s2"; }, "it is of another scene");
  refused([](SavedFilm& film) { film.view = "v2"; }, "its camera, pixel filter");
  refused([](SavedFilm& film) { film.film = random_film(layout_of(5, 4), 1, 11, 4); },
          "samples 11 to 12");
  EXPECT_EQ(made_on({{"caplet.device", "A, A"}, {"caplet.driver", "1, 1"}, {"software", "C"}}),
            made_on({{"caplet.device", "A"}, {"caplet.driver", "1"}, {"software", "C"}}));
  EXPECT_EQ(made_on({{"caplet.device", "A, B"}}), "'A, B' (unknown) by unknown");
  // What is unknown is no reason.
  SavedFilm unknown = saved_film(12, 4);
  unknown.scene = unknown.view = "";
  add(unknown, sum);
  EXPECT_EQ(unknown.scene, "s1");
  EXPECT_EQ(unknown.view, "v1");
  EXPECT_EQ(unknown.film.samples(0), 16u);
}

TEST(SavedFilm, SamplesThatAreMissingAreTold) {
  const std::vector<SampleSpan> there{{2, 4}, {6, 7}};
  EXPECT_THAT(missing(there, 9), ElementsAre(SampleSpan{0, 2}, SampleSpan{4, 6}, SampleSpan{7, 9}));
  EXPECT_THAT(missing(there, 7), ElementsAre(SampleSpan{0, 2}, SampleSpan{4, 6}));
  EXPECT_THAT(missing(there, 0), ElementsAre(SampleSpan{0, 2}, SampleSpan{4, 6}));
  EXPECT_THAT(missing({}, 3), ElementsAre(SampleSpan{0, 3}));
  EXPECT_THAT(missing({{0, 9}}, 9), ElementsAre());
  EXPECT_EQ(text_of(there), "2:4, 6:7");
  EXPECT_EQ(text_of(std::vector<SampleSpan>{}), "none");
  // Of smaller windows they are not those of every pixel.
  const FilmLayout layout = layout_of(5, 4);
  const Film film(layout, std::vector<std::uint64_t>(20 * layout.words_per_pixel()),
                  {{layout.window, 9, 1}, {{4, 3, 2, 2}, 0, 5}, {layout.window, 5, 2}});
  EXPECT_EQ(text_of(samples_of(film)), "5:7, 9:10");
}

TEST(Film, FilesThatAreNoneAreRefused) {
  const auto folder = test::temporary_folder();
  EXPECT_THROW(load_film(folder / "missing.exr"), InputError);
  std::ofstream(folder / "text.exr") << "no picture";
  EXPECT_THROW(load_film(folder / "text.exr"), InputError);
  LayeredImage picture;
  picture.width = picture.height = picture.data_width = picture.data_height = 2;
  picture.channels.push_back({"R", std::vector<float>(4), {}});
  write_exr(folder / "picture.exr", picture);
  EXPECT_THAT([&] { load_film(folder / "picture.exr"); },
              ThrowsMessage<InputError>(HasSubstr("picture.exr: this is no film")));
  const Film film = random_film(layout_of(5, 4), 1, 4, 8);
  save_film(folder / "film.exr", {film, "", "", 0, {}, {}});
  int number = 0;
  for (const auto& [name, wrong] : std::vector<std::pair<std::string, std::string>>{
           {"caplet.film", "2"},
           {"caplet.film.layers", "1000000"},
           {"caplet.film.layers", "7x"},
           {"caplet.film.color_exponent", "x"},
           {"caplet.film.length_exponent", "61"},
           {"caplet.film.space", "srgb2"},
           {"caplet.film.iso", "1x"},
           {"caplet.film.exposure_time", ""},
           {"caplet.film.fnumber", "x"},
           {"caplet.film.white_balance", "inf"},
           {"caplet.film.exposure", "some"},
           {"caplet.film.backdrop", "0.1 0.2"},
           {"caplet.film.backdrop", "0.1 0.2 0.3 0.4"},
           {"caplet.film.backdrop", "file missing.png"},
           {"caplet.film.samples_wanted", "-1"},
           {"caplet.film.samples", "4 3 5 4 4"},
           {"caplet.film.samples", "0 0 20 10 4 8"},
           {"caplet.film.samples", "4 3 5 4 4 8,4 3 1 1 6 1"}}) {
    LayeredImage image = read_exr(folder / "film.exr");
    std::erase_if(image.metadata,
                  [](const auto& entry) { return !entry.first.starts_with("caplet."); });
    image.metadata[name] = wrong;
    const auto file = folder / (std::to_string(number++) + ".exr");
    write_exr(file, image);
    EXPECT_THROW(load_film(file), InputError) << name << ' ' << wrong;
  }
  // Half of a word as floats.
  for (const char* name : {"word01.low", "word01.high"}) {
    LayeredImage halves = read_exr(folder / "film.exr");
    std::erase_if(halves.metadata,
                  [](const auto& entry) { return !entry.first.starts_with("caplet."); });
    const auto half = std::ranges::find(halves.channels, name, &Channel::name);
    half->floats.assign(half->uints.size(), 1);
    half->uints.clear();
    const auto file = folder / (std::string(name) + ".exr");
    write_exr(file, halves);
    EXPECT_THAT([&] { load_film(file); }, ThrowsMessage<InputError>(HasSubstr("word 1 is missing")))
        << name;
  }
  LayeredImage image = read_exr(folder / "film.exr");
  std::erase_if(image.metadata,
                [](const auto& entry) { return !entry.first.starts_with("caplet."); });
  image.channels.pop_back();
  write_exr(folder / "broken.exr", image);
  EXPECT_THAT([&] { load_film(folder / "broken.exr"); },
              ThrowsMessage<InputError>(HasSubstr("is missing")));
}

}  // namespace
}  // namespace caplet
