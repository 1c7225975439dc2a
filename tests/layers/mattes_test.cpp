// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Mattes and deep pictures of rendered scenes, against pictures of their objects alone and against
// the reference's hits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "film/deep.h"
#include "film/develop.h"
#include "film/mattes.h"
#include "lower/lower.h"
#include "render/renderer.h"
#include "scene/matte_names.h"
#include "scene_text.h"

namespace caplet::test::mattes_test {
namespace {

const std::string head =
    "Integrator \"path\" \"integer maxdepth\" 0\nSampler \"sobol\"\nLookAt 0 0 -10  0 0 0  0 1 "
    "0\nCamera \"perspective\" \"float fov\" 30\nFilm \"rgb\" \"integer xresolution\" 64 "
    "\"integer yresolution\" 48\n";

/// Each covers other pixels than the others, or parts of them: name of its object and its text.
const std::map<std::string, std::string> apart = {
    {"red ball",
     "AttributeBegin\nTranslate -1.2 0.8 0\nShape \"sphere\" \"float radius\" 0.6 \"string name\" "
     "\"red ball\"\nAttributeEnd\n"},
    {"rod",
     "Shape \"capsule\" \"point3 p0\" [-2 -1.2 0] \"point3 p1\" [2 -1.6 1] \"float radius\" 0.03 "
     "\"string name\" \"rod\"\n"},
    {"twig",
     "ObjectBegin \"twig\"\nShape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 1 0] "
     "\"float radius\" 0.05\nShape \"sphere\" \"float radius\" 0.2\nObjectEnd\n"
     "AttributeBegin\nTranslate 1.5 0 0\nObjectInstance \"twig\"\nAttributeEnd\n"},
    {"disk",
     "AttributeBegin\nTranslate 0.4 0 2\nShape \"disk\" \"float radius\" 0.5 \"string "
     "name\" \"disk\"\nAttributeEnd\n"}};

std::vector<double> coverage_of(const Film& film, Layer layer, const std::string& name) {
  std::vector<double> out;
  for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); ++pixel) {
    out.push_back(0);
    for (const MatteRank& rank : matte_ranks(film, layer, pixel))
      if (std::bit_cast<std::uint32_t>(rank.id) == matte_hash(name))
        out.back() = double{rank.coverage};
  }
  return out;
}

// The camera's rays are the same, whatever they meet.
TEST(MattesOfScenes, AreTheAlphaOfEachObjectAlone) {
  std::string all = head + "WorldBegin\n";
  for (const auto& [name, text] : apart) all += text;
  const Rendered together = render_text(all, 64, {}, every_layer());
  for (const auto& [name, text] : apart) {
    SCOPED_TRACE(name);
    const Rendered alone = render_text(head + "WorldBegin\n" + text, 64);
    const std::vector<double> coverage =
        coverage_of(together.result.film, Layer::crypto_object, name);
    double sum = 0;
    for (std::size_t i = 0; i < coverage.size(); ++i) {
      ASSERT_EQ(coverage[i], at(alone.image, "A", i)) << i;
      sum += coverage[i];
    }
    EXPECT_GT(sum, 10);
  }
}

// An opaque ball hides a part of the one behind it; each has a material of its own, and both are in
// the file: coverage adds up to alpha whatever is told apart.
TEST(MattesOfScenes, AddUpToAlpha) {
  const Rendered rendered = render_text(
      head +
          "WorldBegin\nMakeNamedMaterial \"paint\" \"string type\" \"diffuse\"\nMakeNamedMaterial "
          "\"gold\" \"string type\" \"conductor\"\nNamedMaterial \"paint\"\nShape \"sphere\" "
          "\"string "
          "name\" \"near\"\nNamedMaterial \"gold\"\nTranslate 0.7 0 3\nShape \"sphere\" \"string "
          "name\" "
          "\"far\"\n",
      64, {}, every_layer());
  const Film& film = rendered.result.film;
  const auto object = [&](const char* name) {
    return coverage_of(film, Layer::crypto_object, name);
  };
  EXPECT_EQ(object("near"), coverage_of(film, Layer::crypto_material, "paint"));
  EXPECT_EQ(object("far"), coverage_of(film, Layer::crypto_material, "gold"));
  const std::vector<double> near = object("near"), far = object("far"),
                            all = coverage_of(film, Layer::crypto_asset, "scene");
  std::size_t both = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    EXPECT_EQ(near[i] + far[i], at(rendered.image, "A", i));
    EXPECT_EQ(all[i], at(rendered.image, "A", i));
    both += near[i] > 0 && far[i] > 0 ? 1 : 0;
  }
  EXPECT_GT(both, 10u);
}

// Each surface of a cube with a material of its own.
TEST(MattesOfScenes, TellTheMaterialOfEachSurface) {
  Scene scene = scene_of_text(head +
                              "WorldBegin\nRotate 40 1 1 0\nShape \"box\" \"point3 p0\" [-1 -1 -1] "
                              "\"point3 p1\" [1 1 1]\n");
  scene.materials.clear();
  for (int i = 0; i < 6; ++i) scene.materials.push_back({DiffuseMaterial{}, std::to_string(i), {}});
  scene.shapes[0].material = 0;
  scene.shapes[0].materials = {0, 1, 2, 3, 4, 5};
  const Rendered rendered = render_model(scene, 16, every_layer());
  std::vector<double> sum(rendered.result.film.layout().window.pixels());
  int seen = 0;
  for (int i = 0; i < 6; ++i) {
    const std::vector<double> one =
        coverage_of(rendered.result.film, Layer::crypto_material, std::to_string(i));
    double all = 0;
    for (std::size_t pixel = 0; pixel < one.size(); ++pixel) {
      sum[pixel] += one[pixel];
      all += one[pixel];
    }
    seen += all > 0 ? 1 : 0;
  }
  EXPECT_EQ(seen, 3);
  for (std::size_t pixel = 0; pixel < sum.size(); ++pixel)
    EXPECT_EQ(sum[pixel], at(rendered.image, "A", pixel));
}

/// One pixel of 40 rods side by side, each at a distance of its own.
Scene comb() {
  std::string text =
      "Integrator \"path\" \"integer maxdepth\" 0\nSampler \"sobol\"\nPixelFilter \"box\"\nLookAt "
      "0 0 "
      "0  0 0 1  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [0 40 0 1]\nFilm \"rgb\" "
      "\"integer xresolution\" 1 \"integer yresolution\" 1\nWorldBegin\n";
  for (int i = 0; i < 40; ++i)
    text += "Shape \"bilinearmesh\" \"point3 P\" [" + std::to_string(i) + " 0 " +
            std::to_string(10 + 3 * i) + " " + std::to_string(i + 1) + " 0 " +
            std::to_string(10 + 3 * i) + " " + std::to_string(i) + " 1 " +
            std::to_string(10 + 3 * i) + " " + std::to_string(i + 1) + " 1 " +
            std::to_string(10 + 3 * i) + "] \"string name\" \"rod " + std::to_string(i) + "\"\n";
  return scene_of_text(text);
}

// 1,024 samples of the first dimension are in 40 strips of even width, some 25.6 each. The least
// hashes, and the nearest distances, have slots, with all their samples; passes of a few samples
// make the same list.
TEST(MattesOfScenes, KeepTheLeastKeysOfManyThings) {
  constexpr std::uint32_t samples = 1024;
  const Scene scene = comb();
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  DeviceScene on_device(test_device(), flat);
  Renderer renderer(on_device, view, {.layers = Layers::every()});
  renderer.pass(renderer.layout().window, 0, samples);
  const Film film = renderer.film().read();
  ASSERT_EQ(film.sum(Layer::coverage, 0, 0), samples);

  std::map<std::uint32_t, std::string> by_hash;
  for (int i = 0; i < 40; ++i) {
    const std::string name = "rod " + std::to_string(i);
    by_hash[matte_hash(name)] = name;
  }
  const std::vector<Slot> mattes = film.slots(Layer::crypto_object, 0);
  ASSERT_EQ(mattes.size(), std::size_t{CAPLET_SLOTS});
  auto expected = by_hash.begin();
  for (const Slot& slot : mattes) {
    EXPECT_EQ(slot.key, (expected++)->first);
    EXPECT_NEAR(slot.samples, samples / 40.0, 3);
  }
  EXPECT_TRUE(lacks_slots(film, Layer::crypto_object, 0));
  EXPECT_FALSE(lacks_slots(film, Layer::crypto_asset, 0));

  const std::vector<DeepSample> deep = deep_samples(film, 0);
  ASSERT_EQ(deep.size(), CAPLET_SLOTS + std::size_t{1});
  double left = 1, rest = 0;
  for (std::size_t i = 0; i < CAPLET_SLOTS; ++i) {
    EXPECT_EQ(deep[i].depth, 10 + 3 * static_cast<float>(i));
    EXPECT_NEAR(double{deep[i].alpha} * left, 1 / 40.0, 3.0 / samples);
    left *= 1 - double{deep[i].alpha};
  }
  for (int i = CAPLET_SLOTS; i < 40; ++i) rest += (10 + 3 * i) / 24.0;
  EXPECT_EQ(deep.back().alpha, 1);
  EXPECT_NEAR(double{deep.back().depth}, rest, 1);

  for (const std::uint32_t step : {1U, 7U, 100U}) {
    renderer.reset(view);
    for (std::uint32_t end = samples; end > 0; end -= std::min(end, step))
      renderer.pass(renderer.layout().window, end - std::min(end, step), std::min(end, step));
    EXPECT_TRUE(std::ranges::equal(renderer.film().read().words(), film.words())) << step;
    Film sum(film.layout());
    for (std::uint32_t begin = 0; begin < samples; begin += 256) {
      renderer.reset(view);
      renderer.pass(renderer.layout().window, begin, 256);
      sum.add(renderer.film().read());
    }
    EXPECT_TRUE(std::ranges::equal(sum.words(), film.words()));
  }
}

// Samples of a deep picture tell distances apart that differ by more than 1/64.
TEST(DeepScenes, TellSurfacesApart) {
  const Rendered rendered =
      render_text(head +
                      "WorldBegin\nShape \"sphere\" \"float radius\" 0.5\nTranslate 0 0 "
                      "5\nShape \"disk\" \"float radius\" 3\n",
                  64, {}, every_layer());
  const Film& film = rendered.result.film;
  std::size_t with_both = 0;
  for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); ++pixel) {
    double through = 1, distance = 0;
    const std::vector<DeepSample> samples = deep_samples(film, pixel);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      distance += through * double{samples[i].alpha} * double{samples[i].depth};
      through *= 1 - double{samples[i].alpha};
      if (i > 0) {
        EXPECT_GT(samples[i].depth, samples[i - 1].depth);
      }
    }
    const double alpha = at(rendered.image, "A", pixel);
    // Floats of alpha, a few of them after each other.
    EXPECT_NEAR(1 - through, alpha, 4 * 0x1p-23);
    if (alpha > 0) {
      EXPECT_NEAR(distance / alpha, at(rendered.image, "Z", pixel), 16 * 8 * 0x1p-23);
    }
    if (samples.size() > 1 && samples.back().depth > 14 && samples.front().depth < 11) ++with_both;
  }
  EXPECT_GT(with_both, 10u);
}

}  // namespace
}  // namespace caplet::test::mattes_test
