// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders to a noise: the picture has it, and no pixel's mean is biased by how many samples it got.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "film/develop.h"
#include "film/noise.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "support/thorough.h"

namespace caplet::test::to_noise_test {
namespace {

/// A ball on a floor under a lamp, before nothing: half of the pixels are empty.
const char* const ball_and_lamp = R"(
LookAt 0 -6 2  0 0 1  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [20 20 20]
Translate 2 -1 5 Shape "sphere" "float radius" 0.5
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "disk" "float radius" 2
Translate 0 0 1
Material "conductor" "float roughness" 0.3
Shape "sphere" "float radius" 1
)";

/// A floor whose lamp is found by chance alone: most samples are black, and few are bright.
const char* const found_by_chance = R"(
Integrator "simplepath" "bool samplelights" false "integer maxdepth" 2
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 16 "integer yresolution" 12
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [50 50 50]
Translate 3 0 1.5 Shape "sphere" "float radius" 0.4
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
Shape "disk" "float radius" 20
)";

/// Renders a scene again and again with other seeds.
class Seeds {
 public:
  explicit Seeds(const char* text)
      : scene_(scene_of_text(text)),
        flat_(lower(scene_)),
        view_(lower_view(scene_)),
        session_(flat_, view_, {test_device()}, {.layers = Layers::none().with(Layer::variance)}) {}

  RenderResult rendered(std::uint32_t seed, const RenderOptions& options) {
    view_.view.seed = seed;
    session_.update(flat_, {}, view_);
    return render(session_, {}, options, {});
  }
  LayeredImage image(const Film& film) const {
    return develop(film, scene_.view.film, Layers::none().with(Layer::variance));
  }

 private:
  Scene scene_;
  FlatScene flat_;
  FlatView view_;
  Session session_;
};

RenderOptions to(double noise, std::uint32_t least = 16, std::uint32_t most = 1u << 14) {
  RenderOptions out;
  out.noise = NoiseTarget{noise, least, most};
  return out;
}

// The variance of 24 pictures is that of their target: 24 of 1,000 pixels say it to 1 %. Counts
// are rounded up, by a tenth of a noise at most.
TEST(ToNoise, PicturesHaveTheNoiseThatIsAskedFor) {
  constexpr double noise = 0.025;
  constexpr std::size_t count = 24;
  Seeds seeds(ball_and_lamp);
  std::vector<double> sums, squares;
  double samples = 0, reached = 0;
  LayeredImage mean;
  for (std::uint32_t seed = 0; seed < count; ++seed) {
    const RenderResult result = seeds.rendered(seed, to(noise));
    EXPECT_LE(result.reached->noise, noise);
    reached += result.reached->noise / count;
    samples += result.reached->mean_samples / count;
    EXPECT_EQ(result.samples_per_pixel, std::lround(result.reached->mean_samples));
    const LayeredImage image = seeds.image(result.film);
    const std::vector<float>& g = channel(image, "G").floats;
    sums.resize(g.size());
    squares.resize(g.size());
    for (std::size_t i = 0; i < g.size(); ++i) {
      sums[i] += double{g[i]} / count;
      squares[i] += double{g[i]} * double{g[i]} / count;
    }
    mean = image;
  }
  std::vector<NoisePixel> pixels;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double variance = std::max(0.0, squares[i] - sums[i] * sums[i]) * count / (count - 1);
    pixels.push_back({static_cast<float>(sums[i]), static_cast<float>(variance),
                      channel(mean, "A").floats[i] > 0});
  }
  const double is = noise_of(pixels, mean.data_width).value();
  // What is reached is one standard error above, 3 to 5 % here.
  EXPECT_LT(is, 1.02 * reached);
  EXPECT_GT(is, 0.9 * reached);
  EXPECT_GT(reached, 0.9 * noise);
  // Uniform sampling needs as many as the mean variance says, this one as the square of the mean
  // root: less than 0.7 of it here.
  RenderOptions uniform;
  uniform.samples_per_pixel = 64;
  const Film other = seeds.rendered(1, uniform).film;
  PictureNoise at_64;
  at_64.add(other, 0, other.layout().window.height);
  const double needed = 64 * std::pow(at_64.in(NoiseSpace::relative).value() / noise, 2);
  EXPECT_LT(samples, 0.7 * needed);
}

// The mean of pictures to a noise is that of uniform ones, though bright samples are rare and
// decide how many follow: those of a pixel itself must not. (If they alone decide, the mean is 0.44
// of what it should be.)
TEST(ToNoise, MeansAreNotBiased) {
  const double count = thorough() ? 100 : 40;
  Seeds seeds(found_by_chance);
  const auto mean_of_seeds = [&](const RenderOptions& options, double& error) {
    double sum = 0, square = 0;
    for (std::uint32_t seed = 0; seed < count; ++seed) {
      const LayeredImage image = seeds.image(seeds.rendered(seed + 1000, options).film);
      const std::vector<float>& g = channel(image, "G").floats;
      const double one = std::accumulate(g.begin(), g.end(), 0.0) / static_cast<double>(g.size());
      sum += one / count;
      square += one * one / count;
    }
    error = std::sqrt((square - sum * sum) / (count - 1));
    return sum;
  };
  double error = 0, uniform_error = 0;
  const double adaptive = mean_of_seeds(to(0.25, 16, 512), error);
  RenderOptions uniform;
  uniform.samples_per_pixel = 256;
  const double even = mean_of_seeds(uniform, uniform_error);
  EXPECT_NEAR(adaptive, even, 3 * std::hypot(error, uniform_error));
  EXPECT_LT(std::hypot(error, uniform_error), (thorough() ? 0.01 : 0.02) * even)
      << "too coarse to see a bias";
}

}  // namespace
}  // namespace caplet::test::to_noise_test
