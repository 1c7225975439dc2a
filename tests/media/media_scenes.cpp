// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "media_scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace caplet::test {

std::string parallel_view(double half, int max_depth) {
  constexpr double far = 1000;
  return fmt::format(
      "Integrator \"volpath\" \"integer maxdepth\" {}\nLookAt 0 0 -{} 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" "
      "{}\nPixelFilter \"box\" "
      "\"float xradius\" 0.5 \"float yradius\" 0.5\nFilm \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16\n",
      max_depth, far, 2 * std::atan(half / far) * 180 / std::numbers::pi);
}

std::string white_sky() { return "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"; }

std::string white_walls() {
  return "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\nMaterial \"diffuse\" \"rgb "
         "reflectance\" [0 0 0]\n"
         "Shape \"sphere\" \"float radius\" 3000\nAttributeEnd\n";
}

std::array<Mean, 3> colors_seen(const std::string& text, int samples, int size) {
  Scene scene = scene_of_text(text);
  scene.film.width = scene.film.height = size;
  const Rendered rendered = render_model(scene, samples);
  return {mean_of(rendered.image, "R"), mean_of(rendered.image, "G"), mean_of(rendered.image, "B")};
}

Mean seen(const Scene& scene, int samples) { return mean_of(render_model(scene, samples).image, "G"); }

Mean seen(const std::string& text, int samples, int size) { return colors_seen(text, samples, size)[1]; }

testing::AssertionResult agrees(const Mean& mean, double expected, double tolerance) {
  const double apart = std::abs(mean.value - expected);
  if (apart <= 4 * mean.error + 1e-4 * expected && apart <= tolerance * expected) return testing::AssertionSuccess();
  return testing::AssertionFailure() << mean.value << " +- " << mean.error << ", not " << expected;
}

double sphere_transmittance(double sigma, double radius) {
  const double x = 2 * sigma * radius;
  return 2 * (1 - (1 + x) * std::exp(-x)) / (x * x);
}

}  // namespace caplet::test
