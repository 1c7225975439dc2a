// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Images, grids and films in parts against the same in one buffer: pictures are the same to the
// bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <random>

#include "base/check.h"
#include "film/sample_plan.h"
#include "import/import.h"
#include "lower/lower.h"
#include "parts_of.h"
#include "render/detail/array_parts.h"
#include "render/device_scene.h"
#include "render_scene.h"
#include "scene/image_reader.h"
#include "support/data.h"

namespace caplet::test {
namespace {

std::vector<float> random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> out(count);
  for (float& one : out) one = static_cast<float>(random() >> 8) * 0x1p-24f;
  return out;
}

/// Images of noise, by their names: "bytes" and "floats" for textures; others for lights.
class NoiseImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    EnvironmentImage image;
    image.equal_area = true;
    image.width = image.height = path.stem() == "window" ? 420 : 450;
    const auto texels = static_cast<std::size_t>(image.width) * std::size_t(image.height);
    image.rgb = random_numbers(3 * texels, 1);
    return image;
  }
  TextureImage read_texture(const std::filesystem::path& path,
                            const ImageEncoding& encoding) const override {
    TextureImage image;
    image.encoding = encoding;
    image.channels = 3;
    image.width = image.height = path.stem() == "bytes" ? 450 : 200;
    const std::vector<float> numbers = random_numbers(image.values(), 2);
    if (path.stem() == "floats") image.floats = numbers;
    for (std::size_t i = 0; i < image.decoded.size(); ++i)
      image.decoded.at(i) = static_cast<float>(i) / 255.0F;
    for (const float one : numbers)
      if (path.stem() == "bytes") image.bytes.push_back(static_cast<std::uint8_t>(one * 255));
    return image;
  }
};

/// Returns a scene of NoiseImages. The files that it names have to exist.
Scene noise_scene(const std::string& text) {
  const std::filesystem::path folder = temporary_folder();
  for (const char* const name : {"sky.exr", "window.exr", "bytes.png", "floats.exr"})
    std::ofstream(folder / name) << "noise";
  return read_pbrt_text(folder / "scene.pbrt", text, NoiseImages());
}

const char* const scene_text = R"(
LookAt 0 -6 2.5  0 0 0.4  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "string filename" "sky.exr"
Texture "bytes" "spectrum" "imagemap" "string filename" "bytes.png" "string filter" "trilinear"
Texture "floats" "spectrum" "imagemap" "string filename" "floats.exr"
Material "diffuse" "texture reflectance" "bytes"
Shape "bilinearmesh" "point3 P" [-4 -4 0 4 -4 0 -4 4 0 4 4 0] "integer indices" [0 1 2 3]
Material "conductor" "texture reflectance" "floats" "float roughness" 0.2
Shape "capsule" "point3 p0" [-1.2 0 0.5] "point3 p1" [-1.2 0 1.5] "float radius" 0.5
Material "interface"
AttributeBegin
  MakeNamedMedium "cells" "string type" "uniformgrid" "float density" [1]
    "rgb sigma_s" [3 3 3] "rgb sigma_a" [0.2 0.3 0.5]
AttributeEnd
AttributeBegin
  MediumInterface "cells" ""
  Translate 0.5 0.5 0.5
  Shape "sphere" "float radius" 0.7
AttributeEnd
AttributeBegin
  MakeNamedMedium "bricks" "string type" "homogeneous"
  MediumInterface "bricks" ""
  Shape "capsule" "point3 p0" [1.8 0 0.6] "point3 p1" [1.8 0 1.4] "float radius" 0.6
AttributeEnd
)";

/// Returns a medium of 6 x 6 x 6 bricks around the second solid that has one.
NanovdbMedium bricks() {
  auto grid = std::make_shared<SparseGrid>();
  constexpr int side = 6;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        if ((x + y + z) % 5 != 0) grid->bricks.push_back({x, y, z});
  grid->values = random_numbers(grid->bricks.size() * 512, 3);
  const double scale = 2.6 / (8 * side);  // from voxels to lengths
  for (int axis = 0; axis < 3; ++axis) grid->medium_from_voxels[axis][axis] = scale;
  grid->medium_from_voxels[3] = glm::dvec4(0.5, -1.3, 0, 1);
  grid->box.min = glm::dvec3(0.5, -1.3, 0);
  grid->box.max = glm::dvec3(3.1, 1.3, 2.6);
  NanovdbMedium out;
  out.density = grid;
  return out;
}

/// A scene whose images, distributions and grids are larger than a part.
Scene scene_of_arrays() {
  Scene out = noise_scene(scene_text);
  out.view.film.width = 120;
  out.view.film.height = 100;
  for (Medium& medium : out.media) {
    if (auto* const cells = std::get_if<UniformGridMedium>(&medium.model)) {
      cells->counts = {70, 60, 64};
      cells->density =
          std::make_shared<std::vector<float>>(random_numbers(cells_of(cells->counts), 4));
    } else {
      const ScatteringProperties scattering = std::get<HomogeneousMedium>(medium.model).scattering;
      NanovdbMedium own = bricks();
      own.scattering = scattering;
      medium.model = own;
    }
  }
  return out;
}

void expect_same(const Film& a, const Film& b) {
  ASSERT_EQ(a.words().size(), b.words().size());
  EXPECT_TRUE(std::ranges::equal(a.words(), b.words()));
}

// Each place of an array that fills four parts, their common ends and the last one's end.
TEST(Floats, AreWhereTheyAreInOneBuffer) {
  constexpr std::size_t distance = 1024, count = 4 * distance + distance / 8;
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::uint32_t>(0x01020304 * i);
  const Device& device = test_device();
  const Program program = Program::from_source(device, "floats", flatten_kernels(R"(
#include "math/floats.cl"
__kernel void floats(__global const float* a, __global const float* b, __global const float* c,
                     __global const float* d, __global uint* out, uint count) {
  const size_t i = get_global_id(0);
  if (i >= count) return;
  const Floats all = {a, b, c, d, 0};
  out[3 * i] = as_uint(*floats_at(all, i));
  out[3 * i + 1] = as_uint(*floats_at(floats_from(floats_from(all, i / 2), i / 4), i - i / 2 - i / 4));
  out[3 * i + 2] = *bytes_at(all, i / 3, 4 * (i - i / 3) + i % 4);
}
)"),
                                               "-DCAPLET_PART=1024UL");
  std::array<Buffer<uint>, array_parts> parts;
  for (std::size_t i = 0; i < array_parts; ++i)
    parts.at(i) = Buffer<uint>(device, array_part(std::span<const uint>(numbers), distance, i));
  Buffer<uint> out(device, 3 * count);
  cl::Kernel kernel = program.kernel("floats");
  set_arguments(device, kernel, parts[0], parts[1], parts[2], parts[3], out, narrow<uint>(count));
  launch(device, kernel, count, 1);
  const std::vector<uint> found = out.read();
  for (std::size_t i = 0; i < count; ++i) {
    ASSERT_EQ(found[3 * i], numbers[i]) << i;
    ASSERT_EQ(found[3 * i + 1], numbers[i]) << i;
    ASSERT_EQ(found[3 * i + 2], (numbers[i] >> (8 * (i % 4)) & 255u)) << i;
  }
}

TEST(ArraysInParts, AreSeenAlike) {
  const Scene scene = scene_of_arrays();
  const FlatScene flat = lower(scene);
  constexpr std::size_t part_floats = part_bytes / sizeof(float);
  EXPECT_GT(flat.texels.size(), part_floats);
  EXPECT_GT(flat.light_texels.size(), 2 * part_floats);
  EXPECT_GT(flat.media_grids.size(), part_floats);
  const Rendered whole = render_model(scene, 4);
  const PartsOf limit(part_bytes);
  expect_same(render_model(scene, 4).result.film, whole.result.film);
}

// The distribution of an image seen through a window has two floats a texel.
TEST(ArraysInParts, SumsOfAWindowAreSeenAlike) {
  Scene scene = noise_scene(R"(
LookAt 0 -4 1  0 0 0  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
LightSource "infinite" "string filename" "window.exr"
  "point3 portal" [-1 2 2  1 2 2  1 2 0  -1 2 0]
Material "diffuse"
Shape "capsule" "point3 p0" [-1 0 0] "point3 p1" [1 0 0] "float radius" 0.5
)");
  scene.view.film.width = 60;
  scene.view.film.height = 40;
  EXPECT_GT(lower(scene).light_cdf.size(), part_bytes / sizeof(float));
  const Rendered whole = render_model(scene, 8);
  const PartsOf limit(part_bytes);
  expect_same(render_model(scene, 8).result.film, whole.result.film);
}

TEST(FilmsInParts, HaveTheSameWords) {
  Scene scene = lowered_everything(170, 150).scene;
  const auto noisy = [&](const std::vector<Look>& looks) {
    RenderOptions options;
    options.noise = NoiseTarget{0.1, 4, 64, {}};
    options.looks = looks;
    return render_model(scene, 16, options).result.film;
  };
  const Film even = render_model(scene, 4).result.film, to_noise = noisy({});
  EXPECT_FALSE(to_noise.is_even());
  EXPECT_GT(even.words().size_bytes(), 2 * part_bytes);
  const PartsOf limit(part_bytes);
  expect_same(render_model(scene, 4).result.film, even);
  expect_same(noisy({}), to_noise);
}

// Rows are read from several buffers, also from the middle of one to that of the next one.
TEST(FilmsInParts, AreReadByRows) {
  LoweredScene scene = lowered_everything(170, 150);
  const Device device = test_device(Encoding::automatic);
  const PartsOf limit(part_bytes);
  DeviceScene on_device(device, scene.flat);
  Renderer renderer(on_device, scene.view, {Layers::all()});
  renderer.pass(renderer.layout().window, 0, 2);
  const DeviceFilm& film = renderer.film();
  ASSERT_GT(film.words.size(), 2U);
  EXPECT_EQ(film.rows_of_buffer % 8, 0) << "tiles of pixels lie in one buffer";
  for (const Buffer<ulong>& part : film.words) EXPECT_LE(part.bytes(), part_bytes);
  const Film whole = film.read();
  const int first = film.rows_of_buffer - 3, rows = film.rows_of_buffer + 6;
  expect_same(film.read(first, rows), whole.rows(first, rows));
  expect_same(film.read(0, 1), whole.rows(0, 1));
  expect_same(film.read(149, 1), whole.rows(149, 1));
  for (std::size_t i = 0; i < 170 * 150; ++i) ASSERT_EQ(whole.samples(i), 2U) << i;
}

// A pass of a part of the picture, which begins and ends in the middle of buffers.
TEST(FilmsInParts, TakeWindows) {
  LoweredScene scene = lowered_everything(170, 150);
  const Device device = test_device(Encoding::automatic);
  const auto film_of = [&] {
    DeviceScene on_device(device, scene.flat);
    Renderer renderer(on_device, scene.view, {Layers::all()});
    renderer.pass({30, 11, 100, 107}, 0, 2);
    renderer.pass({0, 60, 170, 90}, 2, 1);
    return renderer.film().read();
  };
  const Film whole = film_of();
  const PartsOf limit(part_bytes);
  expect_same(film_of(), whole);
  EXPECT_EQ(whole.samples(60 * 170 + 40), 3U);
  EXPECT_EQ(whole.samples(0), 0U);
}

}  // namespace
}  // namespace caplet::test
