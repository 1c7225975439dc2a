// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples are addressed, not streamed: batches, passes and crops cannot change a bit; both
// traversals find the same things.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <utility>

#include "film/develop.h"
#include "import/import.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

std::filesystem::path scene_file() {
  return source_folder() / "tests" / "render" / "everything.pbrt";
}

/// Compute units and film hash of render_digest under an environment setting.
std::pair<int, std::string> digest(const std::string& environment) {
  const std::string command = environment + " " RENDER_DIGEST " " + scene_file().string() + " 4";
  FILE* pipe = ::popen(command.c_str(), "r");
  int units = 0;
  char hash[64] = "", line[1024] = "";
  // The last line is the digest; a slow compiler is told of before it.
  while (pipe != nullptr && std::fgets(line, sizeof line, pipe) != nullptr) continue;
  if (pipe == nullptr || std::sscanf(line, "%d %63s", &units, hash) != 2)
    ADD_FAILURE() << "no digest from: " << command;
  EXPECT_EQ(::pclose(pipe), 0) << command;
  return {units, hash};
}

bool same_bits(const Film& a, const Film& b) {
  return a.layout() == b.layout() && std::ranges::equal(a.words(), b.words());
}

TEST(Determinism, BatchSizesDoNotChangeBits) {
  const Rendered one = render_file(scene_file(), 8);
  for (const std::size_t batch : {977u, 5000u, 1u << 20}) {
    RenderOptions options;
    options.batch_paths = batch;
    EXPECT_TRUE(same_bits(one.result.film, render_file(scene_file(), 8, {}, options).result.film))
        << batch;
  }
}

TEST(Determinism, ThreadsDoNotChangeBits) {
  CAPLET_NEEDS_POCL();
  if (test_device().info().compute_units < 2)
    GTEST_SKIP() << "needs two or more processors; " << test_device().info().name << " has one";
  const auto [one_unit, one] = digest("POCL_MAX_PTHREAD_COUNT=1");
  const auto [two_units, two] = digest("POCL_MAX_PTHREAD_COUNT=2");
  EXPECT_EQ(one_unit, 1);
  EXPECT_EQ(two_units, 2);
  EXPECT_EQ(one, two);
}

TEST(Determinism, SeedsDiffer) {
  const Rendered one = render_file(scene_file(), 4);
  const Rendered other =
      render_file(scene_file(), 4, [](Scene& scene) { scene.view.sampler.seed = 1; });
  EXPECT_FALSE(same_bits(one.result.film, other.result.film));
}

TEST(Determinism, CropIsPartOfTheWhole) {
  const Rendered whole = render_file(scene_file(), 4);
  const Rendered crop = render_file(scene_file(), 4, [](Scene& scene) {
    scene.view.film.crop = {{10, 40, 5, 25}};
  });
  ASSERT_EQ(crop.image.data_width, 30);
  ASSERT_EQ(crop.image.data_height, 20);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 30; ++x)
      ASSERT_EQ(channel(crop.image, "R").floats[static_cast<std::size_t>(y * 30 + x)],
                channel(whole.image, "R")
                    .floats[static_cast<std::size_t>((y + 5) * whole.image.width + x + 10)])
          << x << " " << y;
}

TEST(Encodings, CpuAndGpuTraversalsRenderTheSame) {
  Scene scene = import_scene(scene_file(), FileImageReader());
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  RenderOptions options;
  options.samples_per_pixel = 4;
  const RenderResult a = render(flat, view, test_device(Encoding::wide), options, {});
  const RenderResult b = render(flat, view, test_device(Encoding::single), options, {});
  std::size_t different = 0;
  const std::size_t pixels = a.film.layout().window.pixels();
  for (std::size_t i = 0; i < pixels; ++i)
    different += a.film.number(Layer::object, i) != b.film.number(Layer::object, i) ||
                 a.film.number(Layer::primitive, i) != b.film.number(Layer::primitive, i);
  // A ray within rounding of a silhouette may fall on either side: at most one pixel in a thousand.
  EXPECT_LE(different, pixels / 1000);
  const Figures figures = compare(picture_of(develop(a.film, scene.view.film, Layers::all())),
                                  picture_of(develop(b.film, scene.view.film, Layers::all())));
  EXPECT_LT(std::abs(figures.mean), 2e-3);
  // PoCL's compiler rounds every operation of both as it is written.
  if (test_device().is_pocl()) {
    EXPECT_TRUE(same_bits(a.film, b.film));
  }
}

TEST(Encodings, AllThatGpusDoDifferentlyRendersTheSame) {
  // What a GPU takes: one box at a time, a batch of 2^20 paths and so 2^18 sort bins (of a tree
  // that is sorted for).
  Scene scene = import_scene(source_folder() / "scenes" / "capsules.pbrt", FileImageReader());
  add_cloud(scene);
  scene.view.film.width = 512;
  scene.view.film.height = 512;
  scene.view.integrator.max_depth = 1;
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  ASSERT_GE(flat.bvh_nodes, 1024u);
  RenderOptions options;
  options.samples_per_pixel = 4;
  const RenderResult a = render(flat, view, test_device(Encoding::wide), options, {});
  options.batch_paths = std::size_t{1} << 20;
  const RenderResult b = render(flat, view, test_device(Encoding::single), options, {});
  const Picture wide = picture_of(develop(a.film, scene.view.film, Layers::all())),
                single = picture_of(develop(b.film, scene.view.film, Layers::all()));
  EXPECT_LT(std::abs(compare(wide, single).mean), 2e-3);
  if (test_device().is_pocl()) {
    EXPECT_TRUE(same_bits(a.film, b.film));
  }
}

// Lamps of every shape, turned and mirrored ones in an instance: each has a way of its own to be
// sampled.
TEST(Encodings, LampsOfEveryShapeLightTheSame) {
  const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] \"bool twosided\" true\n";
  const char* const shapes[] = {
      R"(Shape "sphere" "float radius" .3)",
      R"(Shape "sphere" "float radius" .3 "float zmax" .1)",
      R"(Shape "capsule" "point3 p0" [0 0 -.2] "point3 p1" [0 .1 .2] "float radius" .2)",
      R"(Shape "capsule" "point3 p0" [0 0 -.2] "point3 p1" [0 .1 .2] "float radius" [.2 .1])",
      R"(Shape "cylinder" "point3 p0" [0 0 -.2] "point3 p1" [0 .1 .2] "float radius" .2)",
      R"(Shape "cylinder" "float radius" .2 "float zmin" -.2 "float zmax" .2)",
      R"(Shape "cone" "point3 p0" [0 0 -.2] "point3 p1" [0 .1 .2] "float radius" [.3 .1])",
      R"(Shape "box" "point3 p0" [-.2 -.2 -.2] "point3 p1" [.2 .2 .2])",
      R"(Shape "disk" "float radius" .3)",
      R"(Shape "polyhedron" "point3 P" [.2 0 0 -.2 0 0 0 .2 0 0 -.2 0 0 0 .2 0 0 -.2] "normal N" [1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1])",
      R"(Shape "trianglemesh" "point3 P" [-.3 -.3 0 .3 -.3 0 0 .3 .1] "integer indices" [0 1 2])",
      R"(Shape "bilinearmesh" "point3 P" [-.3 -.3 0 .3 -.3 0 -.3 .3 .1 .3 .3 0])",
      R"(Shape "csg" "string operation" "difference" "string operands" ["block" "hole"])",
  };
  std::string world =
      "ObjectBegin \"block\" Shape \"box\" \"point3 p0\" [-.2 -.2 -.2] \"point3 p1\" [.2 .2 .2] "
      "ObjectEnd\n"
      "ObjectBegin \"hole\" Translate .1 .1 0 Shape \"sphere\" \"float radius\" .2 ObjectEnd\n"
      "Material \"diffuse\"\nAttributeBegin\nTranslate 0 0 -1\nShape \"disk\" \"float radius\" "
      "9\nAttributeEnd\n";
  for (std::size_t i = 0; i < std::size(shapes); ++i)
    world +=
        fmt::format("AttributeBegin\nTranslate {} {} {}\nRotate {} 1 2 3\n{}{}\nAttributeEnd\n",
                    1.5 * static_cast<double>(i % 4) - 2, 1.5 * static_cast<double>(i / 4) - 2,
                    0.1 * static_cast<double>(i), 20 * i, lamp, shapes[i]);
  const Scene scene = scene_of_text(
      "Integrator \"path\" \"integer maxdepth\" 2\nLookAt 0 -6 4  0 0 0  0 0 1\nCamera "
      "\"perspective\" \"float fov\" 50\n"
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\n" +
      world);
  RenderOptions options;
  options.samples_per_pixel = 64;
  const FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  const RenderResult a = render(flat, view, test_device(Encoding::wide), options, {});
  const RenderResult b = render(flat, view, test_device(Encoding::single), options, {});
  const Mean wide = mean_of(develop(a.film, scene.view.film, Layers::all()), "G"),
             single = mean_of(develop(b.film, scene.view.film, Layers::all()), "G");
  EXPECT_NEAR(wide.value, single.value, 1e-3 * wide.value);
  if (test_device().is_pocl()) {
    EXPECT_TRUE(same_bits(a.film, b.film));
  }
}

TEST(Film, HasNoNonFiniteSample) {
  const Rendered one = render_file(scene_file(), 16);
  for (const Channel& c : one.image.channels)
    for (const float value : c.floats) ASSERT_TRUE(std::isfinite(value)) << c.name;
}

}  // namespace
}  // namespace caplet::test
