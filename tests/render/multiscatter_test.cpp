// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// "multiscatter" of rough metals and glass in pictures.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lower/lower.h"
#include "render/kernels.h"
#include "render_scene.h"
#include "support/environment.h"

namespace caplet::test {
namespace {

Scene ball_under_a_sky(const std::string& material) {
  return scene_of_text(
      "Integrator \"path\" \"integer maxdepth\" 200\nLookAt 0 0 5  0 0 0  0 1 0\nCamera "
      "\"orthographic\" \"float screenwindow\" "
      "[-0.7 0.7 -0.7 0.7]\nPixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" 32 \"integer "
      "yresolution\" "
      "32\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial " +
      material + " \"bool remaproughness\" false\nShape \"sphere\" \"float radius\" 1\n");
}

// Under a sky of 1 a metal of reflectance 1 - 4e-4 is 1 at roughness 0.1 to 1, and so is glass that
// light goes through several times; by one scattering it is less.
TEST(Multiscatter, FurnacesOfMetalAndGlass) {
  const std::string white =
      "\"conductor\" \"spectrum eta\" [300 1 900 1] \"spectrum k\" [300 100 900 100] ";
  for (const double alpha : {0.1, 0.3, 0.6, 1.0})
    for (const std::string& material : {white, std::string("\"dielectric\" \"float eta\" 1.5 ")}) {
      const std::string rough = fmt::format("{} \"float roughness\" {}", material, alpha);
      const auto green = [&](const std::string& of) {
        return mean_of(render_model(ball_under_a_sky(of), 256).image, "G");
      };
      const Mean on = green(rough + " \"bool multiscatter\" true");
      EXPECT_NEAR(on.value, 1, 0.01 + 4 * on.error) << rough;
      EXPECT_LT(on.error, 2e-3) << rough;
      if (alpha == 0.6) {
        EXPECT_LT(green(rough).value, 0.8) << rough;
      }
    }
}

// Kernels of a scene know of it only where a material has it.
TEST(Multiscatter, CostsNothingWhereItIsOff) {
  // Without the end of this scope all later tests would compile kernels of their own.
  const ScopedVariable rows("CAPLET_ROWS", "scene");
  const auto knows = [](const std::string& material) {
    const FlatScene flat = lower(ball_under_a_sky(material));
    return stage_options(flat, test_device()).compiler.find("CAPLET_MULTISCATTER") !=
           std::string::npos;
  };
  for (const std::string material :
       {"\"conductor\" \"float roughness\" 0.3", "\"dielectric\" \"float roughness\" 0.3"}) {
    EXPECT_FALSE(knows(material));
    EXPECT_FALSE(knows(material + " \"bool multiscatter\" false"));
    EXPECT_TRUE(knows(material + " \"bool multiscatter\" true"));
  }
}

}  // namespace
}  // namespace caplet::test
