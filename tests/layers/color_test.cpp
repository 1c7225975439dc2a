// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Colour, albedo and variance of rendered pictures in every colour space of a film, and samples
// that leave the range of a float.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <string>

#include "film/develop.h"
#include "lower/color.h"
#include "lower/lower.h"
#include "scene_text.h"

namespace caplet::test::color_test {
namespace {

using glm::dvec3;
using Matrix = std::array<double, 9>;

dvec3 times(const Matrix& m, const dvec3& v) {
  return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
          m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

struct Space {
  const char* name;
  ColorSpace space;
  Matrix from_srgb;  // linear
};

// Published: Display P3 and ITU-R BT.2020 (BT.2087) from BT.709; ACES 2065-1 from XYZ (SMPTE ST
// 2065-1) times XYZ from BT.709 (IEC 61966-2-1), for pbrt does not adapt whites.
const Space spaces[] = {
    {"srgb", ColorSpace::srgb, {1, 0, 0, 0, 1, 0, 0, 0, 1}},
    {"dci-p3", ColorSpace::dci_p3, {0.8225, 0.1774, 0, 0.0332, 0.9669, 0, 0.0171, 0.0724, 0.9108}},
    {"rec2020",
     ColorSpace::rec2020,
     {0.6274, 0.3293, 0.0433, 0.0691, 0.9195, 0.0114, 0.0164, 0.0880, 0.8956}},
    {"aces2065-1",
     ColorSpace::aces2065_1,
     {0.4329, 0.3754, 0.1894, 0.0894, 0.8165, 0.1034, 0.0192, 0.1181, 0.9419}},
};

std::string film_of(const std::string& space, int side) {
  return "ColorSpace \"" + space +
         "\"\nIntegrator \"path\" \"integer maxdepth\" 0\nPixelFilter \"box\"\n" +
         "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\"\nFilm \"rgb\" \"integer "
         "xresolution\" " +
         std::to_string(side) + " \"integer yresolution\" " + std::to_string(side) +
         "\nWorldBegin\n";
}

std::string numbers(const dvec3& v) {
  return "[" + std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "]\n";
}

/// A plane that fills the view, with this radiance in a space of its own.
std::string glowing_plane(const std::string& space, const dvec3& radiance) {
  return "ColorSpace \"" + space +
         "\"\nAreaLightSource \"diffuse\" \"bool twosided\" true \"rgb L\" " + numbers(radiance) +
         "Translate 0 0 2\nShape \"disk\" \"float radius\" 1000\n";
}

std::string reflecting_plane(const std::string& space, const dvec3& reflectance) {
  return "ColorSpace \"" + space + "\"\nMaterial \"diffuse\" \"rgb reflectance\" " +
         numbers(reflectance) + "Translate 0 0 2\nShape \"disk\" \"float radius\" 1000\n";
}

dvec3 mean_rgb(const LayeredImage& image, const std::string& prefix) {
  return {mean(channel(image, prefix + "R")), mean(channel(image, prefix + "G")),
          mean(channel(image, prefix + "B"))};
}

// 4 x 4 pixels of 4,096 stratified wavelengths each: the noise is below 1e-4, the uplift's error
// 2e-5 of the greatest component, and the matrices are rounded to four digits. Spectra of colours
// in one space are not exactly the colour under another's white: 2e-3.
constexpr int many = 4096;
constexpr double close_enough = 2e-3;

TEST(ColorOfFilm, EmittedColorsAreThoseOfTheFile) {
  const dvec3 color(0.9, 0.4, 0.15);
  for (const Space& film : spaces) {
    const dvec3 own = mean_rgb(
        render_text(film_of(film.name, 4) + glowing_plane(film.name, color), many).image, "");
    EXPECT_LT(glm::length(own - color), close_enough) << film.name;
    const Rendered rendered =
        render_text(film_of(film.name, 4) + glowing_plane("srgb", color), many);
    EXPECT_EQ(rendered.image.space, film.space);
    EXPECT_LT(glm::length(mean_rgb(rendered.image, "") - times(film.from_srgb, color)),
              close_enough)
        << film.name;
  }
}

// A white surface is 1 1 1 in every space and under every light: also under an image whose texels
// are in another space, with another white, and of another brightness.
TEST(ColorOfFilm, AlbedoIsScaleFreeInTheFilmsSpace) {
  const dvec3 white(1, 1, 1), color(0.7, 0.35, 0.1);
  for (const Space& film : spaces)
    for (const Space& light : spaces) {
      const auto image_light = [&](Scene& scene) {
        auto image = std::make_shared<EnvironmentImage>();
        image->width = 4;
        image->height = 2;
        image->space = light.space;
        image->rgb.assign(24, 3.5f);
        Light sky;
        sky.model = InfiniteLight{.radiance = ConstantSpectrum{1}, .image = image};
        scene.lights.push_back(sky);
      };
      const auto albedo_of = [&](const std::string& plane) {
        return mean_rgb(render_text(film_of(film.name, 4) + plane, many, image_light).image,
                        "albedo.");
      };
      EXPECT_LT(glm::length(albedo_of(reflecting_plane(film.name, white)) - white), close_enough)
          << film.name << light.name;
      if (&light != &spaces[3]) continue;
      EXPECT_LT(glm::length(albedo_of(reflecting_plane(film.name, color)) - color), close_enough)
          << film.name;
    }
}

/// Spread is what pixels of the same mean show of their variance, beside what the layer states.
struct Spread {
  double true_variance = 0, stated = 0, within = 0;  // share of the 95 % intervals with the mean
};

Spread spread_of(const LayeredImage& image, const std::string& name) {
  const std::vector<float>&values = channel(image, name).floats,
        &variances = channel(image, "variance." + name).floats;
  const double center = mean(channel(image, name)), pixels = static_cast<double>(values.size());
  Spread out;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double d = double{values[i]} - center;
    out.true_variance += d * d / pixels;
    out.stated += double{variances[i]} / pixels;
    out.within += (std::abs(d) <= 1.96 * std::sqrt(double{variances[i]}) ? 1 : 0) / pixels;
  }
  return out;
}

// All pixels have the same mean, and their variance shows in their spread. Of 128 x 128 pixels of
// normal errors, that spread and the mean of as many estimates of one degree of freedom are each
// within sqrt(2) / 128 = 1.1 % (standard deviation) of the variance.
constexpr double five_sigma = 5 * 1.6e-2;

TEST(ColorOfFilm, VarianceIsThatOfTheMeansInTheFilmsSpace) {
  const dvec3 color(0.9, 0.4, 0.15);
  for (const Space& film : spaces) {
    const LayeredImage image =
        render_text(film_of(film.name, 128) + glowing_plane(film.name, color), 64).image;
    for (const char* name : {"R", "G", "B"}) {
      const Spread spread = spread_of(image, name);
      EXPECT_NEAR(spread.stated / spread.true_variance, 1, five_sigma) << film.name << ' ' << name;
    }
  }
}

// Whatever the sampler makes of the samples: 16 or, so that one replicate is larger, 9.
TEST(ColorOfFilm, VarianceIsThatOfEverySampler) {
  using Kind = SamplerSettings::Kind;
  const std::string text = film_of("srgb", 128) + glowing_plane("srgb", dvec3(0.9, 0.4, 0.15));
  for (const Kind kind : {Kind::sobol, Kind::independent, Kind::zsobol, Kind::stratified})
    for (const int samples : {9, 16}) {
      const LayeredImage image = render_text(text, samples, [&](Scene& scene) {
                                   scene.view.sampler.kind = kind;
                                   scene.view.sampler.samples_per_pixel = samples;
                                 }).image;
      const Spread spread = spread_of(image, "G");
      const double ratio = spread.stated / spread.true_variance;
      if (kind == Kind::stratified) {  // both replicates share its strata: an upper bound
        EXPECT_GT(ratio, 1 + five_sigma) << samples;
        continue;
      }
      EXPECT_NEAR(ratio, 1, five_sigma) << static_cast<int>(kind) << ' ' << samples;
      // 49 estimates make intervals of Student's t with 49 degrees of freedom: 94.4 % lie within
      // 1.96. Neighbours share estimates: some 128 x 128 / 49 intervals are independent.
      EXPECT_NEAR(spread.within, 0.944, 5 * std::sqrt(0.944 * 0.056 * 49) / 128)
          << static_cast<int>(kind) << ' ' << samples;
    }
}

// Without the layer, all samples are one net of the sampler: their means spread less.
TEST(ColorOfFilm, WithoutVarianceSamplesAreOneNet) {
  const std::string text = film_of("srgb", 64) + glowing_plane("srgb", dvec3(0.9, 0.4, 0.15));
  const auto spread = [&](Layers layers) {
    const Scene scene = scene_of_text(text);
    RenderOptions options;
    options.samples_per_pixel = 16;
    options.layers = layers;
    const RenderResult result = render(lower(scene), lower_view(scene), test_device(), options, {});
    const LayeredImage image = develop(result.film, scene.view.film, layers);
    const double center = mean(channel(image, "G"));
    double squares = 0;
    for (const float v : channel(image, "G").floats) squares += std::pow(double{v} - center, 2);
    return squares;
  };
  // The ratio of two spreads of 64 x 64 pixels is within 3.1 % (standard deviation).
  EXPECT_GT(spread(Layers::none().with(Layer::variance)) / spread(Layers::none()), 1 + 5 * 3.1e-2);
}

/// What a scene's rendering says, and the picture.
std::pair<std::string, LayeredImage> rendered_aloud(const std::string& radiance, double iso) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  LayeredImage image =
      render_text(film_of("srgb", 2) +
                      "AreaLightSource \"diffuse\" \"bool twosided\" true \"rgb L\" [" + radiance +
                      "]\nTranslate 0 0 2\nShape \"disk\" \"float radius\" 1000\n",
                  64, [&](Scene& scene) { scene.view.film.iso = iso; })
          .image;
  const std::string said = testing::internal::GetCapturedStderr();
  return {said + testing::internal::GetCapturedStdout(), std::move(image)};
}

TEST(ColorOfFilm, WhatIsBeyondAFloatIsSaidAndBlack) {
  // 1e38 is a float; divided by the densities of wavelengths, below 1e-2, it is not.
  const auto [too_bright, black] = rendered_aloud("1e38 1e38 1e38", 100);
  EXPECT_NE(too_bright.find("256 samples were not finite"), std::string::npos) << too_bright;
  // The film's exposure takes what is a float beyond it.
  const auto [exposed, also_black] = rendered_aloud("1e30 1e30 1e30", 1e12);
  EXPECT_NE(exposed.find("4 of 4 pixels are beyond the range of a float"), std::string::npos)
      << exposed;
  for (const LayeredImage* image : {&black, &also_black})
    for (const Channel& channel : image->channels)
      for (const float v : channel.floats) EXPECT_TRUE(std::isfinite(v)) << channel.name;
  EXPECT_EQ(at(also_black, "R", 0), 0);
  // Only the squares are too great: the colour stands, its variance is unknown.
  const auto [unsure, bright] = rendered_aloud("1e30 1e30 1e30", 100);
  EXPECT_NE(unsure.find("4 of 4 pixels are beyond the range of a float"), std::string::npos)
      << unsure;
  EXPECT_NEAR(at(bright, "G", 0), 1e30, 5e28);
  EXPECT_EQ(at(bright, "variance.G", 0), double{std::numeric_limits<float>::max()});
  const auto [nothing, plain] = rendered_aloud("1 1 1", 100);
  EXPECT_EQ(nothing.find("finite"), std::string::npos);
  EXPECT_EQ(nothing.find("beyond"), std::string::npos);
}

// What is far above the limit in every sample is scaled as a whole.
TEST(ColorOfFilm, LimitedSamplesKeepTheirHue) {
  const auto rendered = [](const std::string& film) {
    return render_text(
               "Integrator \"path\" \"integer maxdepth\" 0\nCamera \"perspective\"\nFilm \"rgb\" "
               "\"integer xresolution\" 4 "
               "\"integer yresolution\" 4 " +
                   film +
                   "\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [40 10 20]\nTranslate 0 0 -5 "
                   "Shape \"sphere\"\n",
               1)
        .image;
  };
  const LayeredImage free = rendered(""), limited = rendered("\"float maxcomponentvalue\" .5");
  for (std::size_t i = 0; i < 16; ++i) {
    const dvec3 a = at3(free, "", "RGB", i), b = at3(limited, "", "RGB", i);
    EXPECT_LT(glm::length(b / glm::length(b) - a / glm::length(a)), 1e-5) << i;
  }
}

// As pbrt-v4: the greatest component of a sample's exposed XYZ.
TEST(Limit, IsOfEachSampleAsItIsExposed) {
  const auto rendered = [](double radiance, const std::string& film, int samples) {
    return render_text(
               "Integrator \"path\" \"integer maxdepth\" 0\nPixelFilter \"box\"\nCamera "
               "\"perspective\"\nFilm \"rgb\" "
               "\"integer xresolution\" 8 \"integer yresolution\" 8 " +
                   film + "\nWorldBegin\nLightSource \"infinite\" \"rgb L\" " +
                   numbers(dvec3(radiance)) + "Translate 0 0 -5 Shape \"sphere\"\n",
               samples)
        .image;
  };
  const auto peak_of = [](const LayeredImage& image, std::size_t pixel) {
    const dvec3 xyz = times(xyz_from_rgb(ColorSpace::srgb), at3(image, "", "RGB", pixel));
    return std::max({xyz.x, xyz.y, xyz.z});
  };
  // One bright sample a pixel: its greatest component is the limit, whatever its wavelengths.
  for (const char* film :
       {"\"float maxcomponentvalue\" 2", "\"float maxcomponentvalue\" 2 \"float iso\" 400"}) {
    const LayeredImage image = rendered(1e4, film, 1);
    for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(peak_of(image, i), 2, 1e-5) << film << i;
  }
  // A pixel of which a part is bright has that part of the limit: it is not of means. A light of
  // one spectrum has the same component greatest in every sample.
  const LayeredImage part = render_text(
                                "Integrator \"path\" \"integer maxdepth\" 0\nPixelFilter "
                                "\"box\"\nCamera \"perspective\"\nFilm \"rgb\" "
                                "\"integer xresolution\" 8 \"integer yresolution\" 8 \"float "
                                "maxcomponentvalue\" 2\nWorldBegin\n"
                                "AreaLightSource \"diffuse\" \"bool twosided\" true \"rgb L\" [1e4 "
                                "1e4 1e4]\nTranslate 0 0 2\nShape "
                                "\"disk\" \"float radius\" 1.3\n",
                                64)
                                .image;
  int partly = 0;
  for (std::size_t i = 0; i < 64; ++i) {
    const double share = at(part, "A", i);
    partly += share > 0.1 && share < 0.9;
    EXPECT_NEAR(peak_of(part, i), 2 * share, 1e-4) << i;
  }
  EXPECT_GE(partly, 8);
  // Dim samples are not changed.
  const LayeredImage dim = rendered(0.1, "\"float maxcomponentvalue\" 50", 4),
                     free = rendered(0.1, "", 4);
  for (const char* name : {"R", "G", "B"})
    EXPECT_EQ(channel(dim, name).floats, channel(free, name).floats) << name;
}

}  // namespace
}  // namespace caplet::test::color_test
