// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// That the kernels compiled for the host are the device's: the same rays, of every kind of shape,
// answered by both. What sanitizers and fuzzers see of them is then what devices compute.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <random>
#include <sstream>

#include "device/detail/flatten.h"
#include "device/device.h"
#include "host_kernels/host_kernels.h"
#include "host_kernels/model_maker.h"
#include "host_kernels/scene_arrays.h"
#include "render/buffers.h"
#include "support/data.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

// What is added to host_kernels.cl on the device.
const char* const entry_text = R"(
__kernel void answers(
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) access(type) name,
#define GROUP_END(Type)
    SCENE_GROUPS VIEW_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
    __global const HostQuestion* questions, __global HostAnswer* out, uint count) {
  const HostGroups groups = {
#define GROUP_BEGIN(Type, group) {
#define BUFFER(name, type, access) name,
#define GROUP_END(Type) },
      SCENE_GROUPS VIEW_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
      nodes
  };
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const HostQuestion question = questions[i];
  HOST(answer)(&groups, &question, out + i);
}
)";

std::optional<std::string> read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// host_kernels.cl for a device.
std::string device_text() {
  const std::filesystem::path here = source_folder() / "tests/host_kernels",
                              kernels = source_folder() / "kernels";
  const auto read = [&](const std::string& path) {
    return std::filesystem::exists(here / path) ? read_text(here / path)
                                                : read_text(kernels / path);
  };
  return flatten(*read("host_kernels.cl") + entry_text, "host_kernels", read);
}

Program device_program(int width) {
  return Program::from_source(test_device(), "host kernels", device_text(),
                              fmt::format("-DCAPLET_REAL_WIDTH={}", width));
}

std::vector<HostAnswer> ask_device(Program& program, int width, const LoweredModel& model,
                                   const std::vector<HostQuestion>& questions) {
  cl::Kernel kernel = program.kernel("answers");
  cl_uint index = 0;
  const SceneBuffers scene(test_device(), model.scene,
                           width == 1 ? Encoding::single : Encoding::wide);
  const SensorBuffers view(test_device(), model.view);
#define BUFFER(name, type, access) kernel.setArg(index++, buffers.name.handle());
#define GROUP_END(Type) }
#define GROUP_BEGIN(Type, group) \
  {                              \
    const auto& buffers = scene.group;
  SCENE_GROUPS
#undef GROUP_BEGIN
#define GROUP_BEGIN(Type, group) \
  {                              \
    const auto& buffers = view.group;
  VIEW_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
  const Buffer<HostQuestion> in(test_device(), std::span<const HostQuestion>(questions));
  Buffer<HostAnswer> out(test_device(), questions.size());
  kernel.setArg(index++, in.handle());
  kernel.setArg(index++, out.handle());
  kernel.setArg(index++, static_cast<cl_uint>(questions.size()));
  launch(test_device(), kernel, questions.size(), 16);
  return out.read();
}

class Tame : public NumberSource {
 public:
  explicit Tame(std::uint32_t seed) : random_(seed) {}
  unsigned below(unsigned n) override { return static_cast<unsigned>(random_() % n); }
  double coordinate() override { return between(-2, 2); }
  double length() override { return between(0.2, 1.5); }
  double fraction() override { return between(0.05, 1); }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 5) * 0x1p-27;
  }

 private:
  std::mt19937 random_;
};

std::optional<LoweredModel> tame_scene(unsigned kind, std::uint32_t seed, Bounds& bounds) {
  Tame numbers(seed);
  const Scene scene = ModelMaker(numbers).scene(kind, 3);
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  bounds = bounds_of(scene);
  if (bounds.empty()) return std::nullopt;
  ::setenv("CAPLET_ROWS", "all", 1);  // as host_kernels.cl is
  try {
    return LoweredModel{lower(scene), lower_view(scene)};
  } catch (const InputError&) {  // two image lights
    return std::nullopt;
  }
}

/// From around and within the scene to points within its box.
std::vector<HostQuestion> rays_into(const Bounds& bounds, std::uint32_t seed, std::size_t count) {
  Tame numbers(seed);
  const glm::dvec3 center = 0.5 * (bounds.min + bounds.max), half = 0.5 * (bounds.max - bounds.min);
  const auto point = [&](double reach) {
    const double x = numbers.between(-reach, reach), y = numbers.between(-reach, reach),
                 z = numbers.between(-reach, reach);
    return center + glm::dvec3(x, y, z) * half;
  };
  std::vector<HostQuestion> out(count);
  for (HostQuestion& q : out) {
    const glm::vec3 origin(point(3));
    const glm::vec3 direction(glm::normalize(point(0.8) - glm::dvec3(origin)));
    q.ray = {origin.x, origin.y, origin.z, 0, direction.x, direction.y, direction.z, HUGE_VALF};
    for (float& u : q.u) u = static_cast<float>(numbers.between(0, 0.999));
    for (float& lambda : q.lambda) lambda = static_cast<float>(numbers.between(370, 820));
    q.x = numbers.below(16);
    q.y = numbers.below(16);
  }
  return out;
}

/// Words of an answer side by side. Both sides round in their own way (one contracts products and
/// sums, and both have their own sine), so numbers may differ; by how much depends on how obliquely
/// surfaces are met. Derived bounds are the shape tests' business: here a word counts as the same
/// within 1e-3 of its size, 8,000 roundings, and the share of others is what is looked at.
struct Tally {
  std::size_t answers = 0, same_bits = 0, other_hits = 0, words = 0, other_words = 0, hits = 0,
              lit = 0, scattered = 0;
};

bool same_number(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         std::abs(a - b) <= 1e-3f * (1 + std::max(std::abs(a), std::abs(b)));
}

template <class T>
void compare_words(const T& a, const T& b, Tally& tally) {
  static_assert(sizeof(T) % 4 == 0);
  float left[sizeof(T) / 4], right[sizeof(T) / 4];
  std::memcpy(left, &a, sizeof(T));
  std::memcpy(right, &b, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 4; ++i) {
    ++tally.words;
    tally.other_words += !same_number(left[i], right[i]);
  }
}

void compare(const HostAnswer& host, const HostAnswer& there, Tally& tally) {
  ++tally.answers;
  tally.same_bits += std::memcmp(&host.closest, &there.closest, sizeof host.closest) == 0;
  tally.hits += host.found_surface != 0;
  tally.lit += host.found_light != 0;
  tally.scattered += host.found_scattered != 0;
  if (host.closest.slot != there.closest.slot || host.closest.instance != there.closest.instance ||
      host.closest.surface != there.closest.surface || host.any != there.any ||
      host.count != there.count || host.found_light != there.found_light ||
      host.found_area != there.found_area || host.found_scattered != there.found_scattered) {
    ++tally.other_hits;
    return;
  }
  compare_words(host.closest.t, there.closest.t, tally);
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(host.count, HOST_LIST_CAPACITY); ++i)
    compare_words(host.list[i], there.list[i], tally);
  if (host.found_surface) {
    compare_words(host.surface, there.surface, tally);
    compare_words(host.pick, there.pick, tally);
  }
  if (host.found_area) compare_words(host.area_pdf, there.area_pdf, tally);
  if (host.found_light) compare_words(host.light, there.light, tally);
  if (host.found_scattered) {
    compare_words(host.scattered, there.scattered, tally);
    compare_words(host.scattered_pdf, there.scattered_pdf, tally);
    compare_words(host.scattered_value, there.scattered_value, tally);
  }
  compare_words(host.sky, there.sky, tally);
  compare_words(host.albedo, there.albedo, tally);
  compare_words(host.emitted, there.emitted, tally);
  compare_words(host.camera_ray, there.camera_ray, tally);
  compare_words(host.camera, there.camera, tally);
}

class HostKernels : public testing::TestWithParam<unsigned> {};

TEST_P(HostKernels, SayWhatTheDeviceSays) {
  for (const int width : {8, 1}) {
    Program program = device_program(width);
    Tally tally;
    int scenes = 0;
    for (std::uint32_t seed = 1; scenes < 12 && seed < 200; ++seed) {
      Bounds bounds;
      const auto scene = tame_scene(GetParam(), seed, bounds);
      if (!scene) continue;
      ++scenes;
      const std::vector<HostQuestion> questions = rays_into(bounds, seed, 400);
      const std::vector<HostAnswer> there = ask_device(program, width, *scene, questions);
      const SceneArrays arrays(*scene);
      for (std::size_t i = 0; i < questions.size(); ++i) {
        HostAnswer host;
        host_kernels(width).answer(arrays.groups(), &questions[i], &host);
        compare(host, there[i], tally);
      }
    }
    std::printf(
        "%s, width %d: %zu rays, %zu hits, %zu lit, %zu scattered; %zu hits of the same bits, %zu "
        "others; %zu of %zu numbers "
        "differ\n",
        ModelMaker::kind_name(GetParam()), width, tally.answers, tally.hits, tally.lit,
        tally.scattered, tally.same_bits, tally.other_hits, tally.other_words, tally.words);
    EXPECT_EQ(scenes, 12);
    EXPECT_GT(tally.hits, tally.answers / 10);
    EXPECT_GT(tally.lit, tally.answers / 100);
    // Rays meet edges, silhouettes and the places where two samples part by chance alone.
    EXPECT_LT(tally.other_hits, tally.answers / 200);
    EXPECT_LT(tally.other_words, tally.words / 500);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, HostKernels, testing::Range(0u, ModelMaker::kinds),
                         [](const auto& info) {
                           return std::string(ModelMaker::kind_name(info.param));
                         });

// The same operations one lane at a time and eight at once, with nothing contracted: the same bits.
TEST(HostKernels, DoNotDependOnTheWidth) {
  std::size_t rays = 0;
  for (std::uint32_t seed = 1; seed <= 100; ++seed) {
    Bounds bounds;
    const auto scene = tame_scene(ModelMaker::any_kind, seed, bounds);
    if (!scene) continue;
    const SceneArrays arrays(*scene);
    for (const HostQuestion& question : rays_into(bounds, seed, 200)) {
      HostAnswer wide, scalar;
      host_kernels(8).answer(arrays.groups(), &question, &wide);
      host_kernels(1).answer(arrays.groups(), &question, &scalar);
      ++rays;
      ASSERT_EQ(std::memcmp(&wide.closest, &scalar.closest, sizeof wide.closest), 0)
          << "seed " << seed << ": t " << wide.closest.t << " and " << scalar.closest.t;
      ASSERT_EQ(wide.any, scalar.any);
      ASSERT_EQ(wide.count, scalar.count) << "seed " << seed;
      for (std::uint32_t i = 0; i < std::min<std::uint32_t>(wide.count, HOST_LIST_CAPACITY); ++i)
        ASSERT_EQ(std::memcmp(&wide.list[i], &scalar.list[i], sizeof wide.list[i]), 0)
            << "seed " << seed;
    }
  }
  EXPECT_GT(rays, 5000u);
}

}  // namespace
}  // namespace caplet::test
