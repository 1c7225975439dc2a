// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes without shapes: pictures of their sky, in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>

#include "film/develop.h"
#include "lower/lower.h"
#include "render/query.h"
#include "render_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

constexpr const char* camera =
    "LookAt 0 0 0  1 2 0.5  0 0 1\nCamera \"perspective\" \"float fov\" 80\n"
    "PixelFilter \"box\" \"float xradius\" 1e-4 \"float yradius\" 1e-4\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n";

LayeredImage picture(const Scene& scene, int samples, Encoding encoding) {
  const FlatScene flat = lower(scene);
  RenderOptions options;
  options.samples_per_pixel = samples;
  return develop(render(flat, lower_view(scene), test_device(encoding), options, {}).film,
                 scene.view.film, Layers::all());
}

// Its own radiance in every pixel, by both encodings of the tree, and nothing in front of it.
TEST(Skies, OfOneRadianceAreThatEverywhere) {
  const Scene scene =
      scene_of_text(std::string(camera) +
                    "WorldBegin\nLightSource \"infinite\" \"rgb L\" [.5 2 4] \"float scale\" 3\n");
  EXPECT_TRUE(scene.shapes.empty());
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    const LayeredImage image = picture(scene, 256, encoding);
    for (const auto& [name, radiance] :
         {std::pair("R", 1.5), std::pair("G", 6.0), std::pair("B", 12.0)}) {
      const Mean mean = mean_of(image, name);
      EXPECT_NEAR(mean.value, radiance, 4 * mean.error + 2e-3 * radiance)
          << name;  // the uplift is within 2e-3 (spectrum tests)
      EXPECT_LT(mean.error, 0.01 * radiance);
    }
    for (const char* name : {"A", "albedo.G", "N.X", "P.Y"})
      for (const float value : channel(image, name).floats) EXPECT_EQ(value, 0) << name;
    for (const float value : channel(image, "Z").floats) EXPECT_EQ(value, 1e10f);
    for (const std::uint32_t value : channel(image, "object.id").uints)
      EXPECT_EQ(value, CAPLET_NONE);
  }
}

// An image of 1 + z/2 in grey, z the sine of the height, which does not depend on shapes; and the
// same times a power.
TEST(Skies, OfAnImageAreItsTexels) {
  auto image = std::make_shared<EnvironmentImage>();
  image->width = 512;
  image->height = 256;
  for (int y = 0; y < image->height; ++y)
    for (int x = 0; x < image->width; ++x)
      image->rgb.insert(
          image->rgb.end(), 3,
          static_cast<float>(1 + 0.5 * std::cos(std::numbers::pi * (y + 0.5) / image->height)));
  Scene scene = scene_of_text(std::string(camera) + "WorldBegin\n");
  Light light;
  InfiniteLight sky;
  sky.image = image;
  light.model = sky;
  scene.lights.push_back(light);
  const auto check = [&](double factor) {
    const LayeredImage rendered = picture(scene, 512, Encoding::automatic);
    const std::vector<float>& green = channel(rendered, "G").floats;
    // The camera's axes by hand: x to the right, z up, as the picture shows them.
    const glm::dvec3 forward = glm::normalize(glm::dvec3(1, 2, 0.5)),
                     side = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), forward)),
                     up = glm::cross(forward, side);
    const double half = std::tan(40 * std::numbers::pi / 180);
    double worst = 0, mean = 0;
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 24; ++x) {
        // z is the same for the mirrored picture.
        const glm::dvec3 d =
            glm::normalize(forward + half * ((x - 11.5) / 8 * side + (7.5 - y) / 8 * up));
        const double expected = factor * (1 + 0.5 * d.z),
                     found = static_cast<double>(green[static_cast<std::size_t>(24 * y + x)]);
        worst = std::max(worst, std::abs(found / expected - 1));
        mean += (found / expected - 1) / (16 * 24);
      }
    // 512 samples of four wavelengths each: 0.7 % (one standard deviation, of white light); the
    // mean of 384 such.
    EXPECT_LT(worst, 0.04);
    EXPECT_LT(std::abs(mean), 2e-3);
  };
  check(1);
  // As strong as that an upright plane's illuminance, the integral of (1 + z/2) z over the upper
  // half, pi (1 + 1/3), is 2.
  scene.lights[0].illuminance = 2;
  check(2 / (std::numbers::pi * 4 / 3));
}

TEST(Skies, AreFilledWithTheMediumOfTheCamera) {
  // An endless glow that absorbs: its own radiance, and nothing of the sky behind it.
  const Scene scene = scene_of_text(
      "LookAt 0 0 0  0 0 1  0 1 0\nMakeNamedMedium \"glow\" \"string type\" \"homogeneous\" \"rgb "
      "sigma_a\" [2 2 2] \"rgb "
      "sigma_s\" [0 "
      "0 0] \"rgb Le\" [3 3 3]\nMediumInterface \"\" \"glow\"\nCamera \"perspective\"\n"
      "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\nLightSource "
      "\"infinite\" \"rgb L\" [50 50 "
      "50]\n");
  const Mean mean = mean_of(picture(scene, 256, Encoding::automatic), "G");
  EXPECT_NEAR(mean.value, 3, 4 * mean.error + 6e-3);
}

TEST(Skies, OfNothingAreBlack) {
  const Scene scene =
      scene_of_text(std::string(camera) + "WorldBegin\nLightSource \"point\" \"rgb I\" [5 5 5]\n");
  const LayeredImage image = picture(scene, 4, Encoding::automatic);
  for (const char* name : {"R", "G", "B", "A"})
    for (const float value : channel(image, name).floats) EXPECT_EQ(value, 0) << name;
}

// Queries miss, one by one and as lists, in both encodings.
TEST(Skies, HoldNothingToPick) {
  const Scene scene = scene_of_text(std::string(camera) + "WorldBegin\nLightSource \"infinite\"\n");
  const FlatScene flat = lower(scene);
  EXPECT_EQ(flat.bvh_nodes, 1u);
  EXPECT_EQ(flat.primitive_count, 0u);
  EXPECT_EQ(flat.world.radius, 1);
  std::vector<RayRecord> rays;
  for (int i = 0; i < 1000; ++i) {
    RayRecord ray{};
    ray.ox = static_cast<float>(i % 10) - 4;
    ray.dx = static_cast<float>(i % 7) - 3;
    ray.dy = static_cast<float>(i % 11) - 5;
    ray.dz = static_cast<float>(i % 13) - 6.5f;
    ray.t_max = INFINITY;
    rays.push_back(ray);
  }
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    Query query(flat, test_device(encoding));
    for (const PickRecord& pick : query.closest(rays)) EXPECT_EQ(pick.object, CAPLET_NONE);
    EXPECT_TRUE(query.all(rays, 8).crossings.empty());
  }
}

// The unit ball stands for what is not there.
TEST(Skies, HaveACameraThatIsFramedToTheUnitBall) {
  const std::string sky =
      "Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\nWorldBegin\nLightSource "
      "\"infinite\"\n";
  const Scene bare = scene_of_text(sky), ball = scene_of_text(sky + "Shape \"sphere\"\n");
  EXPECT_TRUE(bare.automatic_camera);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      EXPECT_EQ(bare.view.camera.world_from_camera[c][r], ball.view.camera.world_from_camera[c][r]);
}

}  // namespace
}  // namespace caplet::test
