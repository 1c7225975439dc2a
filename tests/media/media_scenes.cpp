// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "media_scenes.h"

#include <fmt/format.h>

#include <cmath>

namespace caplet::test {

std::string parallel_view(double half, int max_depth) {
  return fmt::format(
      "Integrator \"volpath\" \"integer maxdepth\" {0}\nLookAt 0 0 -1000 0 0 0 0 1 0\nCamera "
      "\"orthographic\" \"float screenwindow\" [-{1} {1} -{1} {1}]\nPixelFilter \"box\" "
      "\"float xradius\" 0.5 \"float yradius\" 0.5\nFilm \"rgb\" \"integer xresolution\" 16 "
      "\"integer yresolution\" 16\n",
      max_depth, half);
}

std::string white_sky() { return "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"; }

std::string white_walls() {
  return "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" "
         "true\nMaterial \"diffuse\" \"rgb "
         "reflectance\" [0 0 0]\n"
         "Shape \"sphere\" \"float radius\" 3000\nAttributeEnd\n";
}

std::array<Mean, 3> colors_seen(const std::string& text, int samples, int size) {
  Scene scene = scene_of_text(text);
  scene.view.film.width = scene.view.film.height = size;
  const Rendered rendered = render_model(scene, samples);
  return {mean_of(rendered.image, "R"), mean_of(rendered.image, "G"), mean_of(rendered.image, "B")};
}

Mean seen(const Scene& scene, int samples) {
  return mean_of(render_model(scene, samples).image, "G");
}

Mean seen(const std::string& text, int samples, int size) {
  return colors_seen(text, samples, size)[1];
}

testing::AssertionResult agrees(const Mean& mean, double expected, double tolerance) {
  const double apart = std::abs(mean.value - expected);
  if (apart <= 4 * mean.error + 1e-4 * expected && apart <= tolerance * expected)
    return testing::AssertionSuccess();
  return testing::AssertionFailure() << mean.value << " +- " << mean.error << ", not " << expected;
}

std::string three_media() {
  std::string out;
  for (const auto& [name, sigma] : {std::pair{"a", 0.3}, {"b", 0.5}, {"c", 0.9}})
    out += fmt::format(
        "MakeNamedMedium \"{0}\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [{1} {1} {1}] "
        "\"rgb sigma_s\" [0 0 0]\n",
        name, sigma);
  return out;
}

double lost(double z, const std::string& shapes, const std::string& before,
            const std::string& lens) {
  const std::string text = three_media() + before +
                           "Integrator \"volpath\" \"integer maxdepth\" 100\nTranslate 0 0 " +
                           std::to_string(-z) + "\nCamera \"perspective\" \"float fov\" 0.01 " +
                           lens + "\nWorldBegin\n" + white_sky() +
                           "MediumInterface \"\" \"\"\nMaterial \"interface\"\n" + shapes;
  // Over what is seen without the solids: white is 1 but for the noise of wavelengths.
  const std::string empty =
      text.substr(text.find("Integrator"),
                  text.find("MediumInterface \"\" \"\"\n") - text.find("Integrator")) +
      "Translate 0 0 -99 Shape \"sphere\" \"float radius\" 0.1\n";
  return std::log(seen(empty, 4, 4).value / seen(text, 4, 4).value);
}

std::string sphere(double z, double r, const std::string& inside, const std::string& outside) {
  return fmt::format(
      "AttributeBegin MediumInterface \"{}\" \"{}\" Translate 0 0 {} Material \"interface\" Shape "
      "\"sphere\" \"float radius\" {} "
      "AttributeEnd\n",
      inside, outside, z, r);
}

std::string box(double z0, double z1, const std::string& inside, const std::string& outside,
                double half) {
  return fmt::format(
      "AttributeBegin MediumInterface \"{0}\" \"{1}\" Material \"interface\" Shape \"box\" "
      "\"point3 p0\" [-{2} -{2} {3}] "
      "\"point3 "
      "p1\" [{2} {2} {4}] AttributeEnd\n",
      inside, outside, half, z0, z1);
}

double sphere_transmittance(double sigma, double radius) {
  const double x = 2 * sigma * radius;
  return 2 * (1 - (1 + x) * std::exp(-x)) / (x * x);
}

}  // namespace caplet::test
