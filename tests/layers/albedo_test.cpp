// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The albedo layer of coats: what a clear interface over a diffuse base reflects in all, in closed
// form.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "scene_text.h"

namespace caplet::test {
namespace {

double fresnel(double cosine, double eta) {
  const double sine2 = (1 - cosine * cosine) / (eta * eta);
  if (sine2 >= 1) return 1;
  const double t = std::sqrt(1 - sine2);
  const double s = (cosine - eta * t) / (cosine + eta * t),
               p = (eta * cosine - t) / (eta * cosine + t);
  return 0.5 * (s * s + p * p);
}

/// What an interface reflects of diffuse light from within.
double within(double eta) {
  double sum = 0;
  constexpr int steps = 20'000;
  for (int i = 0; i < steps; ++i) {
    const double cosine = (i + 0.5) / steps;
    sum += 2 * cosine * fresnel(cosine, 1 / eta) / steps;
  }
  return sum;
}

// F + (1 - F) r (1 - Ri) / (1 - r Ri): what goes through is scattered by the base and comes out in
// all orders. Egan and Hilgeman's fit of Ri is good for 0.004 at these indices, which counts by
// less than itself.
TEST(Albedo, OfACoatIsThatOfAllOrders) {
  for (const double eta : {1.3, 1.5, 1.8})
    for (const double r : {0.2, 0.5, 0.9}) {
      const std::string text =
          "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 0.1\nPixelFilter "
          "\"box\"\n"
          "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" "
          "4\nWorldBegin\nLightSource \"infinite\"\n"
          "Material \"coateddiffuse\" \"rgb reflectance\" [" +
          std::to_string(r) + " " + std::to_string(r) + " " + std::to_string(r) +
          "] \"float eta\" " + std::to_string(eta) +
          " \"float roughness\" 0\nTranslate 0 0 2\nShape \"disk\" \"float radius\" 9\n";
      const double f = fresnel(1, eta), inner = within(eta);
      const double expected = f + (1 - f) * r * (1 - inner) / (1 - r * inner);
      EXPECT_NEAR(mean(channel(render_text(text, 64).image, "albedo.G")), expected, 0.006)
          << eta << " " << r;
    }
}

}  // namespace
}  // namespace caplet::test
