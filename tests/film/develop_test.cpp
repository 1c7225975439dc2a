// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Film sums to layers, against numbers worked out by hand.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "film/chromaticities.h"
#include "film/develop.h"
#include "film_sums.h"
#include "lower/spectrum.h"

namespace caplet {
namespace {

/// Width and height of a window at (3, 2) of an image of 10 x 6 pixels.
struct Size {
  int width, height;
};
Size window(int width, int height) { return {width, height}; }

/// Sums of one pixel.
struct Pixel {
  std::uint64_t samples = 0, first_samples = 0;  // of the first replicate
  double hits = 0;
  std::array<double, 3> xyz{}, first_xyz{}, albedo{}, normal{}, position{};
  double depth = 0;
  std::uint32_t object = CAPLET_NONE, primitive = CAPLET_NONE;
};

Film film_of(const std::vector<Pixel>& pixels, Size size) {
  FilmLayout layout;
  layout.width = 10;
  layout.height = 6;
  layout.window = {3, 2, size.width, size.height};
  layout.layers = Layers::all();
  Film film(layout);
  if (pixels.size() != layout.window.pixels()) throw std::logic_error("a pixel for each place");
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Pixel& p = pixels[i];
    film.words()[i * layout.words_per_pixel()] = p.first_samples << 32 | p.samples;
    test::set_sum(film, Layer::coverage, 0, i, p.hits);
    test::set_sum(film, Layer::depth, 0, i, p.depth);
    for (std::size_t c = 0; c < 3; ++c) {
      test::set_sum(film, Layer::color, c, i, p.xyz[c]);
      test::set_sum(film, Layer::variance, c, i, p.first_xyz[c]);
      test::set_sum(film, Layer::albedo, c, i, p.albedo[c]);
      test::set_sum(film, Layer::normal, c, i, p.normal[c]);
      test::set_sum(film, Layer::position, c, i, p.position[c]);
    }
    film.words()[i * layout.words_per_pixel() + layout.first_word(Layer::object)] =
        ~std::uint64_t{p.object};
    film.words()[i * layout.words_per_pixel() + layout.first_word(Layer::primitive)] =
        ~std::uint64_t{p.primitive};
  }
  return film;
}

LayeredImage develop(const std::vector<Pixel>& pixels, Size size, const Scene& scene,
                     Layers layers) {
  return caplet::develop(film_of(pixels, size), scene.view.film, layers);
}

Pixel nothing() { return {}; }

/// XYZ of linear sRGB as the stages make it.
std::array<double, 3> xyz_of_srgb(double r, double g, double b) {
  const std::array<double, 9> m = xyz_from_rgb(ColorSpace::srgb);
  return {m[0] * r + m[1] * g + m[2] * b, m[3] * r + m[4] * g + m[5] * b,
          m[6] * r + m[7] * g + m[8] * b};
}

Pixel with_samples(std::initializer_list<std::array<double, 3>> rgb_samples) {
  Pixel pixel;
  for (const auto& rgb : rgb_samples) {
    const auto v = xyz_of_srgb(rgb[0], rgb[1], rgb[2]);
    const bool first = pixel.samples++ % 2 == 0;
    if (first) ++pixel.first_samples;
    for (std::size_t c = 0; c < 3; ++c) {
      pixel.xyz[c] += v[c];
      if (first) pixel.first_xyz[c] += v[c];
    }
  }
  return pixel;
}

float value(const LayeredImage& image, const char* channel, std::size_t pixel = 0) {
  return image.find(channel)->floats.at(pixel);
}

// The result is rounded to float (6e-8) once, from sums kept to about 2^-48; values are up to 16.
constexpr double rounding = 1e-6;

TEST(Develop, MeansOfTheSamples) {
  const auto image = develop({with_samples({{1, 0.5, 0.25}, {3, 0.5, 0.75}})}, window(1, 1),
                             Scene{}, Layers::all());
  EXPECT_NEAR(value(image, "R"), 2, rounding);
  EXPECT_NEAR(value(image, "G"), 0.5, rounding);
  EXPECT_NEAR(value(image, "B"), 0.5, rounding);
}

TEST(Develop, VarianceOfTheMean) {
  // Red 1 and 3: of independent samples the variance of their mean is (3 - 1)^2 / 4. Blue 0.25,
  // 0.75: 0.0625. Green: none.
  const auto image = develop({with_samples({{1, 0.5, 0.25}, {3, 0.5, 0.75}})}, window(1, 1),
                             Scene{}, Layers::all());
  EXPECT_NEAR(value(image, "variance.R"), 1, rounding);
  EXPECT_NEAR(value(image, "variance.G"), 0, 1e-20);
  EXPECT_NEAR(value(image, "variance.B"), 0.0625, rounding);
  // 1 and 6 are one replicate, 2 the other: (3.5 - 2)^2 (1/2 + 1)^-1 2/3, as if each sample had
  // the variance that makes (a - b)^2 what it is, a third of which is that of the mean of three.
  const auto three = develop({with_samples({{1, 0, 0}, {2, 0, 0}, {6, 0, 0}})}, window(1, 1),
                             Scene{}, Layers::all());
  EXPECT_NEAR(value(three, "variance.R"), 1.5 * 1.5 / (0.5 + 1) / 3, rounding);
}

// The first replicate alone, or the second, says nothing; nor do pixels without samples.
TEST(Develop, VarianceNeedsBothReplicates) {
  Pixel first = with_samples({{1, 0, 0}}), second = first;
  first.samples = first.first_samples = 2;
  second.samples = 2, second.first_samples = 0, second.first_xyz = {};
  for (const Pixel& pixel : {first, second, nothing()})
    EXPECT_EQ(value(develop({pixel}, window(1, 1), Scene{}, Layers::all()), "variance.R"), 0);
}

/// A pixel whose replicates of one sample each differ by 2 sqrt(variance); each hits something.
Pixel with_variance(double variance) {
  const double d = std::sqrt(variance);
  Pixel out = with_samples({{1 + d, 1, 1}, {1 - d, 1, 1}});
  out.hits = 2;
  return out;
}

// Each pixel has the mean of the estimates of the 49 pixels around it, or of those that are there.
TEST(Develop, VariancesArePooledOverNeighbours) {
  constexpr int width = 10, height = 6;
  std::vector<Pixel> pixels(width * height, with_variance(0));
  pixels[2 * width + 4] = with_variance(49);
  const auto image = develop(pixels, window(width, height), Scene{}, Layers::all());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int columns = std::min(x, 3) + 1 + std::min(width - 1 - x, 3),
                rows = std::min(y, 3) + 1 + std::min(height - 1 - y, 3);
      const bool near = std::abs(x - 4) <= 3 && std::abs(y - 2) <= 3;
      EXPECT_NEAR(value(image, "variance.R", static_cast<std::size_t>(y * width + x)),
                  near ? 49.0 / (columns * rows) : 0, 49 * rounding)
          << x << ' ' << y;
    }
}

// A constant sky beside an object has no variance and takes none away; a sky that varies has.
TEST(Develop, VarianceIsNotThatOfAConstantSky) {
  const Pixel sky = with_samples({{0.3, 0.7, 0.1}, {0.3, 0.7, 0.1}, {0.3, 0.7, 0.1}});
  Pixel cloud = with_variance(4);
  cloud.hits = 0;
  const auto image = develop({sky, with_variance(1), sky, with_variance(3), cloud}, window(5, 1),
                             Scene{}, Layers::all());
  const double expected[5] = {0, (1 + 3 + 4) / 3.0, 0, (1 + 3 + 4) / 3.0, (1 + 3 + 4) / 3.0};
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(value(image, "variance.R", i), expected[i], 10 * rounding) << i;
}

// Rows in the margins are neighbours, and nothing else.
TEST(Develop, MarginsAreNeighboursAlone) {
  std::vector<Pixel> pixels;
  for (int i = 0; i < 10 * 6; ++i) pixels.push_back(with_variance(i * i % 17));
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].object = static_cast<std::uint32_t>(i);
  const Film film = film_of(pixels, window(10, 6));
  PictureFlaws all, some;
  const auto whole = caplet::develop(film, Scene{}.view.film, Layers::all(), all),
             part = caplet::develop(film, Scene{}.view.film, Layers::all(), some, {2, 3});
  EXPECT_EQ(part.data_height, 1);
  EXPECT_EQ(part.y, whole.y + 2);
  EXPECT_EQ(some.of, 10u);
  // Developed in two parts, with rows around them, the picture has the noise that it has as a
  // whole.
  PictureFlaws parts;
  caplet::develop(film.rows(0, 5), Scene{}.view.film, Layers::all(), parts, {0, 2});
  caplet::develop(film.rows(1, 5), Scene{}.view.film, Layers::all(), parts, {2, 0});
  ASSERT_TRUE(all.noise.in(NoiseSpace::relative));
  EXPECT_EQ(parts.noise.in(NoiseSpace::relative), all.noise.in(NoiseSpace::relative));
  for (const Channel& channel : part.channels) {
    const Channel& of_whole = *whole.find(channel.name.c_str());
    for (std::size_t x = 0; x < 10; ++x) {
      if (!channel.floats.empty()) {
        EXPECT_EQ(channel.floats.at(x), of_whole.floats.at(20 + x)) << channel.name;
      }
      if (!channel.uints.empty()) {
        EXPECT_EQ(channel.uints.at(x), of_whole.uints.at(20 + x)) << channel.name;
      }
    }
  }
}

TEST(Develop, VarianceOfOneSampleIsZeroAndOnRequest) {
  EXPECT_EQ(value(develop({with_samples({{1, 2, 3}})}, window(1, 1), Scene{}, Layers::all()),
                  "variance.R"),
            0);
  EXPECT_EQ(develop({with_samples({{1, 2, 3}})}, window(1, 1), Scene{}, Layers::usual())
                .find("variance.R"),
            nullptr);
}

TEST(Develop, SumsOfManySamplesLoseNothing) {
  // 2^24 samples of 1 and one of 2^-20: the mean of white is above 1 by what a float's sum would
  // have lost.
  Pixel pixel;
  pixel.samples = 1 << 24;
  const auto white = xyz_of_srgb(1, 1, 1);
  for (std::size_t c = 0; c < 3; ++c) pixel.xyz[c] = 3 * 16777216.0 * white[c];
  const auto image = develop({pixel}, window(1, 1), Scene{}, Layers::usual());
  EXPECT_NEAR(value(image, "G"), 3, rounding);
}

TEST(Develop, ExposureScalesColorAndVariance) {
  Scene scene;
  scene.view.film.exposure_time = 0.5;
  scene.view.film.iso = 400;
  const auto image =
      develop({with_samples({{1, 0, 0}, {3, 0, 0}})}, window(1, 1), scene, Layers::all());
  EXPECT_NEAR(value(image, "R"), 4, rounding);
  EXPECT_NEAR(value(image, "variance.R"), 4, rounding);
}

// Sunny 16: at f/16, ISO 100 and 1/100 s white paper in sunlight, 100,000 lux over pi, is white to
// 4 %. Twice the f-number is two stops.
TEST(Develop, AnFNumberExposesToASensorThatSaturates) {
  Scene scene;
  scene.view.film.exposure_time = 0.01;
  scene.view.film.f_number = 16;
  const double paper = 100000 / 3.14159265358979;
  const auto exposed = [&] {
    return value(develop({with_samples({{paper, paper, paper}, {paper, paper, paper}})},
                         window(1, 1), scene, Layers::usual()),
                 "G");
  };
  EXPECT_NEAR(exposed(), 1, 0.04);
  EXPECT_NEAR(exposed(), paper / (1.2 * 16 * 16 * 100), 1e-5);
  scene.view.film.f_number = 32;
  EXPECT_NEAR(exposed(), paper / (1.2 * 32 * 32 * 100), 1e-5);
}

/// A pixel of one sample of luminance 1 and these coordinates.
Pixel with_white(double x, double y) {
  Pixel pixel;
  pixel.samples = 1;
  pixel.xyz = {x / y, 1, (1 - x - y) / y};
  return pixel;
}

// The whites are tabulated (CIE 15:2018, tables 3 and T.2): D50 and D55 are daylight of 5003 and
// 5503 K, of 5000 and 5500 by the older constant, and A is a black body of 2856 K.
TEST(Develop, WhiteBalanceMakesDaylightWhite) {
  const auto balanced = [](double kelvin, double x, double y, ColorSpace space) {
    Scene scene;
    scene.view.film.white_balance = kelvin;
    scene.view.film.space = space;
    const auto image = develop({with_white(x, y)}, window(1, 1), scene, Layers::usual());
    for (const char* channel : {"R", "G", "B"})
      EXPECT_NEAR(value(image, channel), 1, 1e-3) << kelvin << channel;
  };
  balanced(5000, 0.34567, 0.35851, ColorSpace::srgb);
  balanced(5500, 0.33243, 0.34744, ColorSpace::srgb);
  balanced(7500, 0.29903, 0.31488, ColorSpace::srgb);
  balanced(2855.5, 0.44758, 0.40745, ColorSpace::srgb);
  balanced(5000, 0.34567, 0.35851, ColorSpace::aces2065_1);
}

// Lindbloom's matrix of Bradford's adaptation from D50 to D65, of a colour that is not white; sRGB
// from XYZ by IEC 61966-2-1.
TEST(Develop, WhiteBalanceIsBradfords) {
  Scene scene;
  scene.view.film.white_balance = 5000;
  const auto image = develop({with_white(0.45, 0.35)}, window(1, 1), scene, Layers::usual());
  const double x = 0.45 / 0.35, z = 0.2 / 0.35;
  const double ax = 0.9555766 * x - 0.0230393 + 0.0631636 * z,
               ay = -0.0282895 * x + 1.0099416 + 0.0210077 * z,
               az = 0.0122982 * x - 0.0204830 + 1.3299098 * z;
  EXPECT_NEAR(value(image, "R"), 3.2406 * ax - 1.5372 * ay - 0.4986 * az, 2e-3);
  EXPECT_NEAR(value(image, "G"), -0.9689 * ax + 1.8758 * ay + 0.0415 * az, 2e-3);
  EXPECT_NEAR(value(image, "B"), 0.0557 * ax - 0.2040 * ay + 1.0570 * az, 2e-3);
}

// The limit is of samples: what they add up to has none.
TEST(Develop, MaxComponentValueIsNotOfMeans) {
  Scene scene;
  scene.view.film.max_component_value = 1;
  const auto image = develop({with_samples({{4, 2, 1}})}, window(1, 1), scene, Layers::usual());
  EXPECT_NEAR(value(image, "R"), 4, rounding);
}

Pixel with_hits() {
  Pixel pixel;
  pixel.samples = 4;
  pixel.hits = 2;
  pixel.object = 7;
  pixel.primitive = 3000000000u;
  pixel.albedo = xyz_of_srgb(1, 1, 1);
  pixel.normal = {0, 0, 2};
  pixel.position = {6, 7, 8};
  pixel.depth = 5;
  return pixel;
}

/// What develop makes of a layer of with_hits(): each channel and its value.
using Expected = std::vector<std::pair<const char*, double>>;

/// By the options of layer_rows: a layer without an entry fails.
const std::map<std::string, Expected> expected_layers = {
    {"Z", {{"Z", 2.5}}},
    {"albedo", {{"albedo.R", 0.25}, {"albedo.G", 0.25}, {"albedo.B", 0.25}}},
    {"N", {{"N.X", 0}, {"N.Y", 0}, {"N.Z", 1}}},
    {"P", {{"P.X", 3}, {"P.Y", 3.5}, {"P.Z", 4}}},
    {"object", {{"object.id", 7}}},
    {"primitive", {{"primitive.id", 3000000000u}}},
    {"variance", {{"variance.R", 0}, {"variance.G", 0}, {"variance.B", 0}}}};  // all samples black

TEST(Develop, EveryLayerIsItsMeanOverHits) {
  std::size_t channels = 4;
  for (std::size_t i = 0; i < layer_rows.size(); ++i) {
    if (!*layer_rows[i].option) continue;                  // R G B A: below
    if (layer_rows[i].kind == LayerKind::slots) continue;  // mattes_test.cpp
    SCOPED_TRACE(layer_rows[i].option);
    const auto expected = expected_layers.find(layer_rows[i].option);
    ASSERT_NE(expected, expected_layers.end()) << "no expectation";
    const Layers alone = Layers::none().with(static_cast<Layer>(i));
    const auto image = develop({with_hits()}, window(1, 1), Scene{}, alone);
    ASSERT_EQ(image.channels.size(), 4 + expected->second.size());
    EXPECT_EQ(alone.channels(), image.channels.size());
    EXPECT_EQ(value(image, "A"), 0.5f);
    for (const auto& [name, wanted] : expected->second) {
      const Channel* channel = image.find(name);
      ASSERT_NE(channel, nullptr) << name;
      if (!channel->uints.empty()) {
        EXPECT_EQ(channel->uints.at(0), wanted) << name;
      } else {
        EXPECT_NEAR(double{channel->floats.at(0)}, wanted, rounding) << name;
      }
    }
    channels += expected->second.size();
  }
  EXPECT_EQ(develop({with_hits()}, window(1, 1), Scene{}, Layers::all()).channels.size(), channels);
  EXPECT_EQ(Layers::all().channels(), channels);
}

// One sample of many that hits tells what it hit.
TEST(Develop, OneHitTellsWhatItHit) {
  Pixel pixel = with_hits();
  pixel.hits = 1;
  pixel.normal = {0, 0, 1};
  const auto image = develop({pixel}, window(1, 1), Scene{}, Layers::all());
  EXPECT_EQ(value(image, "A"), 0.25f);
  EXPECT_NEAR(value(image, "Z"), 5, rounding);
  EXPECT_NEAR(value(image, "N.Z"), 1, rounding);
  EXPECT_NEAR(value(image, "P.Y"), 7, rounding);
  EXPECT_EQ(image.find("object.id")->uints.at(0), 7u);
}

TEST(Develop, NormalsAreAtMostOneLong) {
  // Rounded unit vectors that are all too long by up to 1e-7, and one that is not.
  for (int i = 0; i < 1000; ++i) {
    const double angle = 0.01 * i, height = std::sin(3.0 * i);
    const std::array<double, 3> n{std::sqrt(1 - height * height) * std::cos(angle),
                                  std::sqrt(1 - height * height) * std::sin(angle), height};
    Pixel record = with_hits();
    record.hits = 1;
    for (std::size_t c = 0; c < 3; ++c) record.normal[c] = n[c] * (i % 2 == 0 ? 1 + 1e-7 : 0.5);
    const auto image = develop({record}, window(1, 1), Scene{}, Layers::usual());
    const double length = std::hypot(value(image, "N.X"), value(image, "N.Y"), value(image, "N.Z"));
    EXPECT_LE(length, 1.0);
    // Three roundings to float, each towards 0 by up to 2^-23 of the component.
    EXPECT_NEAR(length, i % 2 == 0 ? 1 : 0.5, 2e-7);
  }
}

TEST(Develop, LayersAreThoseAskedFor) {
  const auto names = [](Layers layers) {
    std::vector<std::string> out;
    for (const Channel& channel : develop({with_hits()}, window(1, 1), Scene{}, layers).channels)
      out.push_back(channel.name);
    return out;
  };
  const auto with = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"R", "G", "B", "A"});
    return more;
  };
  EXPECT_EQ(names(Layers::none()), with({}));
  EXPECT_EQ(names(Layers::none().with(Layer::albedo)), with({"albedo.R", "albedo.G", "albedo.B"}));
  EXPECT_EQ(names(Layers::usual()), names(Layers::all().without(Layer::variance)));
  const auto image = develop({with_hits()}, window(1, 1), Scene{},
                             Layers::none().with(Layer::primitive).with(Layer::depth));
  EXPECT_EQ(value(image, "Z"), 2.5f);
  EXPECT_EQ(image.find("primitive.id")->uints.at(0), 3000000000u);
}

// Published matrices from XYZ: IEC 61966-2-1, Display P3 (SMPTE EG 432-1 with the D65 white), ITU-R
// BT.2020, SMPTE ST 2065-1.
struct Space {
  ColorSpace space;
  std::array<double, 9> from_xyz;
};
const Space spaces[] = {
    {ColorSpace::srgb,
     {3.2404542, -1.5371385, -0.4985314, -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259,
      1.0572252}},
    {ColorSpace::dci_p3,
     {2.4934969, -0.9313836, -0.4027108, -0.8294890, 1.7626641, 0.0236247, 0.0358458, -0.0761724,
      0.9568845}},
    {ColorSpace::rec2020,
     {1.7166512, -0.3556708, -0.2533663, -0.6666844, 1.6164812, 0.0157685, 0.0176399, -0.0427706,
      0.9421031}},
    {ColorSpace::aces2065_1,
     {1.0498110, 0, -0.0000975, -0.4959030, 1.3733130, 0.0982400, 0, 0, 0.9912520}},
};

TEST(Develop, ColorsAndAlbedoAreInTheFilmsSpace) {
  const std::array<double, 3> xyz{0.4, 0.3, 0.2};
  for (const auto& [space, m] : spaces) {
    Scene scene;
    scene.view.film.space = space;
    Pixel record = with_hits();
    record.samples = 1;
    record.hits = 1;
    record.xyz = record.albedo = xyz;
    const auto image = develop({record}, window(1, 1), scene, Layers::usual());
    EXPECT_EQ(image.space, space);
    for (std::size_t c = 0; c < 3; ++c) {
      const double expected = m[3 * c] * xyz[0] + m[3 * c + 1] * xyz[1] + m[3 * c + 2] * xyz[2];
      // Whites by a spectrum or as xy differ by up to 2e-4 in XYZ.
      EXPECT_NEAR(value(image, std::string(1, "RGB"[c]).c_str()), expected, 1e-3)
          << static_cast<int>(space) << ' ' << c;
      EXPECT_NEAR(value(image, (std::string("albedo.") + "RGB"[c]).c_str()), expected, 1e-3)
          << static_cast<int>(space) << ' ' << c;
    }
  }
}

TEST(Develop, VarianceIsInTheFilmsSpace) {
  // Two samples of half and of one and a half times the same colour c: the variance of the mean is
  // (c / 2)^2 in each component.
  const std::array<double, 3> xyz{0.4, 0.3, 0.2};
  for (const auto& [space, m] : spaces) {
    Scene scene;
    scene.view.film.space = space;
    Pixel record;
    record.samples = 2, record.first_samples = 1;
    std::array<double, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c) {
      rgb[c] = m[3 * c] * xyz[0] + m[3 * c + 1] * xyz[1] + m[3 * c + 2] * xyz[2];
      record.xyz[c] = 2 * xyz[c];
      record.first_xyz[c] = 0.5 * xyz[c];
    }
    const auto image = develop({record}, window(1, 1), scene, Layers::all());
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(value(image, (std::string("variance.") + "RGB"[c]).c_str()), rgb[c] * rgb[c] / 4,
                  2e-3)
          << static_cast<int>(space) << ' ' << c;
  }
}

// What is balanced is balanced in the spread of its samples, too.
TEST(Develop, VarianceHasTheWhiteBalance) {
  Scene scene;
  scene.view.film.white_balance = 3000;
  const auto image = develop({with_samples({{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}})}, window(1, 1),
                             scene, Layers::all());
  for (const char* name : {"R", "G", "B"}) {
    const float balanced = value(image, name);
    EXPECT_NEAR(value(image, (std::string("variance.") + name).c_str()), balanced * balanced / 4,
                rounding);
  }
  EXPECT_GT(std::abs(value(image, "B") / value(image, "R") - 1), 0.2);
}

TEST(Develop, NothingWrittenIsInfiniteOrNotANumber) {
  const float most = std::numeric_limits<float>::max();
  // Finite sums that the exposure takes beyond a float: of the color, or of the variance alone.
  const Pixel bright = with_samples({{1e9, 0, 0}, {1e9, 0, 0}}),
              spread = with_samples({{0.5, 0, 0}, {1.5, 0, 0}});
  const Pixel good = with_samples({{0.5, 0.25, 0.125}});
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  Scene scene;
  const auto image = develop({bright, spread, good}, window(3, 1), scene, Layers::all());
  scene.view.film.exposure_time = 1e30;
  const auto exposed = develop({good, bright, spread}, window(3, 1), scene, Layers::all());
  const std::string said =
      testing::internal::GetCapturedStderr() + testing::internal::GetCapturedStdout();
  for (const auto* picture : {&image, &exposed})
    for (const Channel& channel : picture->channels)
      for (const float v : channel.floats) EXPECT_TRUE(std::isfinite(v)) << channel.name;
  EXPECT_FLOAT_EQ(value(image, "R", 0), 1e9f);
  EXPECT_NEAR(value(image, "R", 2), 0.5, rounding);
  EXPECT_NEAR(value(image, "variance.R", 2), 0, rounding);
  EXPECT_FLOAT_EQ(value(exposed, "R", 0), 0.5e30f);
  EXPECT_EQ(value(exposed, "R", 1), 0);
  EXPECT_FLOAT_EQ(value(exposed, "R", 2), 1e30f);
  EXPECT_EQ(value(exposed, "variance.R", 2), most);
  EXPECT_EQ(said.find("of 3 pixels"), said.rfind("of 3 pixels")) << said;
  EXPECT_NE(said.find("2 of 3 pixels"), std::string::npos) << said;
  EXPECT_NE(said.find("the first: 4,2"), std::string::npos) << said;
}

TEST(Develop, EmptyPixelsAreFinite) {
  Pixel missed;
  missed.samples = 16;
  const auto image = develop({missed, nothing()}, window(2, 1), Scene{}, Layers::all());
  for (const Channel& channel : image.channels)
    for (const float v : channel.floats)
      EXPECT_EQ(v, channel.name == "Z" ? 1e10f : 0.0f) << channel.name;
  EXPECT_EQ(image.find("object.id")->uints.at(1), 0xffffffffu);
}

TEST(Develop, WindowsAndOrder) {
  const auto image =
      develop({with_samples({{1, 1, 1}}), with_samples({{2, 2, 2}}), with_samples({{3, 3, 3}})},
              window(1, 3), Scene{}, Layers::usual());
  EXPECT_EQ(image.width, 10);
  EXPECT_EQ(image.height, 6);
  EXPECT_EQ(image.x, 3);
  EXPECT_EQ(image.y, 2);
  EXPECT_EQ(image.data_width, 1);
  EXPECT_EQ(image.data_height, 3);
  EXPECT_NEAR(value(image, "R", 2), 3, rounding);
  EXPECT_THROW(develop({nothing()}, window(2, 1), Scene{}, Layers::usual()), std::logic_error);
}

TEST(Chromaticities, AgreeWithTheSpectralSide) {
  for (const ColorSpace space :
       {ColorSpace::srgb, ColorSpace::dci_p3, ColorSpace::rec2020, ColorSpace::aces2065_1}) {
    const auto round_trip = product(rgb_from_xyz(space), xyz_from_rgb(chromaticities_of(space)));
    // Whites taken from a spectrum or as xy differ by up to 2e-4 in XYZ.
    for (std::size_t i = 0; i < 9; ++i)
      EXPECT_NEAR(round_trip[i], i % 4 == 0 ? 1 : 0, 2e-3) << static_cast<int>(space) << " " << i;
  }
}

TEST(Chromaticities, SrgbMatrixIsTheStandards) {
  const auto m = xyz_from_rgb(chromaticities_of(ColorSpace::srgb));
  const std::array<double, 9> expected{0.4123908, 0.3575843, 0.1804808, 0.2126390, 0.7151687,
                                       0.0721923, 0.0193308, 0.1191948, 0.9505322};
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(m[i], expected[i], 1e-7) << i;
  const auto identity = product(m, inverse(m));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(identity[i], i % 4 == 0 ? 1 : 0, 1e-14);
}

}  // namespace
}  // namespace caplet
