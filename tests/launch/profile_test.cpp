// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The way of GPUs, on any device: large batches, counters that stay on the device, sums of sort
// bins in parallel, a work-item a layer, launches in chunks. On PoCL its pictures are those of the
// way of processors, to the bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>
#include <random>
#include <string>

#include "base/error.h"
#include "import/import.h"
#include "lower/lower.h"
#include "render/detail/launch_policy.h"
#include "render/device_scene.h"
#include "render/render.h"
#include "render_scene.h"
#include "support/data.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

// Few other tests compile for this profile: kernels of a scene alone are quicker to build.
const bool rows_are_the_scenes = ::setenv("CAPLET_ROWS", "scene", 1) == 0;

Device device_of(const char* profile, Encoding encoding = Encoding::automatic) {
  ::setenv("CAPLET_PROFILE", profile, 1);
  Device device = test_device(encoding);
  ::unsetenv("CAPLET_PROFILE");
  return device;
}

Scene scene_named(const std::string& name, int width, int height, int depth) {
  Scene scene = import_scene(source_folder() / name, FileImageReader());
  scene.view.film.width = width;
  scene.view.film.height = height;
  scene.view.integrator.max_depth = depth;
  return scene;
}

struct Made {
  Film film;
  RayCounts rays;
};

Made made(const Scene& scene, const Device& device, std::uint32_t samples, std::size_t batch = 0) {
  const FlatScene flat = lower(scene);
  DeviceScene on_device(device, flat);
  Renderer renderer(on_device, lower_view(scene),
                    {.layers = Layers::every(), .batch_paths = batch});
  renderer.pass(renderer.layout().window, 0, 1);  // onto an empty film, and
  renderer.pass(renderer.layout().window, 1, samples - 1);
  return {renderer.film().read(), renderer.rays()};
}

void expect_same(const Made& a, const Made& b, const std::string& of) {
  EXPECT_EQ(a.rays.camera, b.rays.camera) << of;
  if (!test_device().is_pocl()) return;  // compilers round otherwise for other encodings
  EXPECT_EQ(a.rays.bounce, b.rays.bounce) << of;
  EXPECT_EQ(a.rays.shadow, b.rays.shadow) << of;
  EXPECT_TRUE(std::ranges::equal(a.film.words(), b.film.words())) << of;
}

TEST(Profile, IsTheDevicesOrTheVariables) {
  EXPECT_EQ(device_of("gpu").profile(), Profile::gpu);
  EXPECT_EQ(device_of("gpu").encoding(), Encoding::single);
  EXPECT_EQ(device_of("gpu", Encoding::wide).encoding(), Encoding::wide);
  EXPECT_EQ(device_of("cpu").profile(), Profile::cpu);
  EXPECT_EQ(device_of("").profile(), test_device().is_cpu() ? Profile::cpu : Profile::gpu);
  EXPECT_THROW(device_of("tpu"), RunError);
  ::unsetenv("CAPLET_PROFILE");
}

TEST(Profile, OfGpusMakesThePicturesOfProcessors) {
  const Device gpu = device_of("gpu"), cpu = device_of("cpu");
  const Scene scene = scene_named("tests/render/everything.pbrt", 40, 30, 8);
  const Made expected = made(scene, cpu, 9);
  expect_same(made(scene, gpu, 9), expected, "whole");
  expect_same(made(scene, gpu, 9, 700), expected, "small batches");
  expect_same(made(scene, device_of("gpu", Encoding::wide), 9), expected, "wide");
}

// A chunk is launched with a few work-items more, in groups of 64 and, by PoCL, in rows.
TEST(Profile, ChunksOfAnySizeHoldEachPathOnce) {
  const Device gpu = device_of("gpu");
  const Scene scene = scene_named("scenes/capsules.pbrt", 40, 30, 3);
  const Made expected = made(scene, gpu, 9);
  ::setenv("CAPLET_LAUNCH", "chunk=1037", 1);
  const Made in_chunks = made(scene, gpu, 9);
  ::unsetenv("CAPLET_LAUNCH");
  expect_same(in_chunks, expected, "chunks of 1037 paths");
}

Made made_for(const char* rows, const Scene& scene) {
  ::setenv("CAPLET_ROWS", rows, 1);
  const Made out = made(scene, device_of("cpu"), 3);
  ::setenv("CAPLET_ROWS", "scene", 1);
  return out;
}

// As tests share kernels, and as users have them.
TEST(Rows, OfAllKindsMakeThePicturesOfTheScenesOwn) {
  for (const char* const name : {"scenes/capsules.pbrt", "scenes/smoke.pbrt"}) {
    const Scene scene = scene_named(name, 24, 16, 6);
    expect_same(made_for("all", scene), made_for("scene", scene), name);
  }
}

TEST(Rows, AreOfAllKindsOrTheScenesOwn) {
  const FlatScene flat = lower(scene_named("scenes/capsules.pbrt", 8, 8, 2));
  const Device device = test_device();
  const auto materials = [&](const char* rows) {
    ::setenv("CAPLET_ROWS", rows, 1);
    return stage_options(flat, device).rows.at("materials");
  };
  EXPECT_EQ(materials("scene"), flat.material_kinds());
  EXPECT_EQ(materials(""), flat.material_kinds());
  EXPECT_EQ(materials("all"), ~std::uint64_t{0});
  EXPECT_THROW(materials("some"), InputError);
  ::setenv("CAPLET_ROWS", "scene", 1);
}

TEST(Profile, OfGpusMakesThePicturesOfProcessorsAmongMedia) {
  const Scene scene = scene_named("scenes/smoke.pbrt", 24, 16, 8);
  ASSERT_FALSE(lower(scene).mediums.empty());
  expect_same(made(scene, device_of("gpu"), 4), made(scene, device_of("cpu"), 4), "media");
}

// A batch of 2^20 paths, and so 2^18 sort bins in three levels of sums; launches begin with 2^16
// work-items.
TEST(Profile, OfGpusSortsAndLaunchesInChunks) {
  Scene scene = scene_named("scenes/capsules.pbrt", 256, 256, 2);
  add_cloud(scene);
  ASSERT_GE(lower(scene).bvh_nodes, 1024u);
  const Device gpu = device_of("gpu");
  expect_same(made(scene, gpu, 4), made(scene, device_of("cpu"), 4), "sorted");
}

// Sums of blocks, level by level, against sums one after the other.
TEST(Profile, PrefixSumsAreThoseOfALoop) {
  const Device gpu = device_of("gpu");
  Kernels kernels(gpu, {"-DCAPLET_REAL_WIDTH=1", {}});
  kernels.compile(std::array{Stage::sort_sums, Stage::sort_prefix});
  std::mt19937 random(3);
  for (const std::uint32_t fan : {64u, 8u, 5u, 1u << 31})
    for (const std::uint32_t bits : {0u, 1u, 4u, 5u}) {
      const std::size_t bins = std::size_t{8} << (3 * bits);
      PathBuffers buffers(gpu, 1, sort_places(bins, fan), PathNeeds{.layers = Layers::none()});
      BatchRecord record{};
      record.sort_bits = bits;
      record.sort_fan = fan;
      buffers.batch.batch.write({&record, 1});
      std::vector<uint> counts(bins);
      for (uint& count : counts) count = static_cast<uint>(random() % 5);
      buffers.sort.sort_bins.write(counts);
      Bindings bindings;
      buffers.bind(bindings);
      const std::vector<SortLevel> levels = sort_levels(bins, fan);
      for (std::size_t i = 0; i + 1 < levels.size(); ++i)
        kernels.run(Stage::sort_sums, bindings, levels[i].count, levels[i].first);
      for (std::size_t i = levels.size(); i-- > 0;)
        kernels.run(Stage::sort_prefix, bindings, levels[i].count, levels[i].first);
      std::vector<uint> expected(bins);
      std::exclusive_scan(counts.begin(), counts.end(), expected.begin(), 0u);
      std::vector<uint> found = buffers.sort.sort_bins.read();
      found.resize(bins);
      EXPECT_EQ(found, expected) << fan << " " << bits;
    }
}

// Each chunk does its own items, and none of them twice.
TEST(Profile, ChunksAreParts) {
  const Device gpu = device_of("gpu");
  Kernels kernels(gpu, {"-DCAPLET_REAL_WIDTH=1", {}});
  kernels.compile(std::array{Stage::sort_scatter});
  constexpr std::size_t paths = 5000;
  PathBuffers buffers(gpu, paths, 2, PathNeeds{.layers = Layers::none()});
  std::vector<uint> queue(paths);
  std::iota(queue.begin(), queue.end(), 0u);
  buffers.queues.queue_next.write(queue);
  buffers.sort.sort_keys.clear();
  Bindings bindings;
  buffers.bind(bindings);
  for (const std::size_t chunk :
       {std::size_t{0}, std::size_t{64}, std::size_t{1024}, std::size_t{8192}})
    for (const uint counted : {~0u, 0u, 1u, 1023u, 4999u, 6000u}) {
      buffers.queues.queue.write(std::vector<uint>(paths, 7777u));
      buffers.sort.sort_bins.clear();
      std::array<uint, counter_count> counters{};
      counters[counter_next] = counted;
      buffers.counters.counters.write(counters);
      kernels.set_chunk(chunk);
      kernels.run(Stage::sort_scatter, bindings, paths, 0,
                  counted == ~0u ? CAPLET_NONE : uint{counter_next});
      const std::size_t count = std::min<std::size_t>(counted, paths);
      EXPECT_EQ(buffers.sort.sort_bins.read()[0], count) << chunk << " " << counted;
      std::vector<uint> found = buffers.queues.queue.read();
      std::ranges::sort(found);
      std::vector<uint> expected(queue.begin(), queue.begin() + static_cast<std::ptrdiff_t>(count));
      expected.resize(paths, 7777u);
      EXPECT_EQ(found, expected) << chunk << " " << counted;
    }
}

}  // namespace
}  // namespace caplet::test
