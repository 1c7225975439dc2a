// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What media are at a point, on a device: closed forms, and a cloud of cloud.py.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "device/device.h"
#include "lower/lower.h"
#include "media_scenes.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

using Four = std::array<float, 4>;
constexpr std::array<double, 4> wavelengths = {450, 500, 550, 600};

const char* const kernel_text = R"CL(
#include "media/media.cl"

// The first medium at points of the world: sigma_a, sigma_s, le, the greatest that its cell's extinction may be.
__kernel void media_points(__global const MediumRecord* mediums, __global const float* data, __global const float* grids,
                           __global const SpectrumRecord* spectra, __global const float* tables, __global const float* points, __global float* out,
                           uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  const Spectra values = {spectra, tables};
  const MediumView view = {&values, data + mediums[0].data, grids, (float4)(450.0f, 500.0f, 550.0f, 600.0f)};
  const MediumBox box = medium_box(mediums[0].kind, &view);
  const float3 p = vload3(i, points);
  const MediumPoint at = medium_at(mediums[0].kind, &view, box.place, p);
  vstore4(at.sigma_a, 4 * i, out);
  vstore4(at.sigma_s, 4 * i + 1, out);
  vstore4(at.le, 4 * i + 2, out);
  // The cell that walks along rays would be in.
  MajorantWalk walk;
  float t0, t1, majorant = -1.0f;
  if (majorants_begin(&box, p, (float3)(0.0f, 0.0f, 1.0f), 0.0f, 1.0f, &walk) != 0) majorants_next(&walk, &t0, &t1, &majorant);
  vstore4(majorant * box.extinction, 4 * i + 3, out);
}
)CL";

struct MediumPoints {
  std::vector<Four> sigma_a, sigma_s, le, most;
};

MediumPoints look(const Scene& scene, const std::vector<glm::vec3>& points) {
  static const Program program =
      Program::from_source(test_device(), "media_points",
                           flatten_kernels(kernel_text, {{"media", ~std::uint64_t{0}}}), "");
  const Device& device = test_device();
  FlatScene flat = lower(scene);
  flat.spectrum_tables.push_back(0);  // never empty
  flat.media_grids.push_back(0);
  std::vector<float> at;
  for (const glm::vec3& p : points) at.insert(at.end(), {p.x, p.y, p.z});
  const Buffer<MediumRecord> mediums(device, std::span<const MediumRecord>(flat.mediums));
  const Buffer<float> data(device, std::span<const float>(flat.media_data)),
      grids(device, std::span<const float>(flat.media_grids));
  const Buffer<SpectrumRecord> spectra(device, std::span<const SpectrumRecord>(flat.spectra));
  const Buffer<float> tables(device, std::span<const float>(flat.spectrum_tables)),
      places(device, std::span<const float>(at));
  Buffer<float> out(device, 16 * points.size());
  cl::Kernel kernel = program.kernel("media_points");
  set_arguments(device, kernel, mediums, data, grids, spectra, tables, places, out,
                cl_uint{static_cast<cl_uint>(points.size())});
  launch(device, kernel, points.size(), 1);
  const std::vector<float> values = out.read();
  MediumPoints looked;
  std::vector<Four>* const rows[] = {&looked.sigma_a, &looked.sigma_s, &looked.le, &looked.most};
  for (std::size_t i = 0; i < 4 * points.size(); ++i) {
    Four four;
    std::copy_n(&values[4 * i], 4, four.begin());
    rows[i % 4]->push_back(four);
  }
  return looked;
}

/// A scene of one medium, which a ball is full of.
Scene scene_of(const std::string& medium) {
  return scene_of_text("WorldBegin\n" + white_sky() + medium +
                       "\nMaterial \"interface\"\nMediumInterface \"m\" \"\"\nShape \"sphere\"\n");
}
Scene scene_of(decltype(Medium::model) model) {
  Scene scene = scene_of("MakeNamedMedium \"m\" \"string type\" \"homogeneous\"");
  scene.media.at(0).model = std::move(model);
  return scene;
}

/// Points of the box from p0 to p1.
std::vector<glm::vec3> points_within(const glm::dvec3& p0, const glm::dvec3& p1,
                                     const glm::dmat4& world, std::size_t count) {
  std::mt19937 random(5);
  std::vector<glm::vec3> out(count);
  for (glm::vec3& p : out) {
    glm::dvec3 part;
    for (int k = 0; k < 3; ++k) part[k] = (static_cast<double>(random()) + 0.5) / 4294967296.0;
    p = glm::vec3(glm::dvec3(world * glm::dvec4(p0 + part * (p1 - p0), 1)));
  }
  return out;
}

std::vector<float> numbers(std::size_t count, unsigned seed, float least = 0) {
  std::mt19937 random(seed);
  std::vector<float> out(count);
  for (float& value : out) value = least + static_cast<float>(random() >> 8) * 0x1p-24f;
  return out;
}
FloatGrid grid(std::vector<float> values) {
  return std::make_shared<const std::vector<float>>(std::move(values));
}

/// A grid of values at the centres of a box' cells, 0 outside, linear between them.
double between(const std::vector<float>& values, const GridCounts& counts, const glm::dvec3& part,
               std::size_t stride = 1, std::size_t c = 0) {
  double sum = 0;
  for (int z = 0; z < counts[2]; ++z)
    for (int y = 0; y < counts[1]; ++y)
      for (int x = 0; x < counts[0]; ++x) {
        const auto hat = [](double at, int n, int cell) {
          return std::max(0.0, 1 - std::abs(at * n - 0.5 - cell));
        };
        sum +=
            hat(part.x, counts[0], x) * hat(part.y, counts[1], y) * hat(part.z, counts[2], z) *
            double{
                values[stride * static_cast<std::size_t>((z * counts[1] + y) * counts[0] + x) + c]};
      }
  return sum;
}

/// Planck's law, of any scale.
double planck(double kelvin, double nm) {
  return 1 / (std::pow(nm / 500, 5) * (std::exp(1.438776877e7 / (nm * kelvin)) - 1));
}
/// Over its greatest value of all wavelengths, by Wien's law.
double planck_part(double kelvin, double nm) {
  return planck(kelvin, nm) / planck(kelvin, 2.897771955e6 / kelvin);
}

const ScatteringProperties stuff{ConstantSpectrum{0.75}, ConstantSpectrum{1.5}, 2, 0.25};
// A box of three sides, turned and moved.
const glm::dvec3 corner(-1, 2, 0.5), other(1.5, 3, 4);
const glm::dmat4 placed =
    glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(3, -1, 2)), 0.7, glm::dvec3(0, 0.6, 0.8));
const GridCounts counts = {5, 3, 4};

glm::dvec3 part_of(const glm::vec3& p) {
  const glm::dvec3 local(glm::inverse(placed) * glm::dvec4(glm::dvec3(p), 1));
  return (local - corner) / (other - corner);
}

// Rounding: the part of the box is good for some 2^-22, which slopes of up to 5 cells and 1 a cell
// make 5 times as much of.
constexpr double grid_error = 2e-5;

UniformGridMedium uniform_grid() {
  UniformGridMedium medium;
  medium.scattering = stuff;
  medium.bounds = {corner, other, placed};
  medium.counts = counts;
  medium.density = grid(numbers(60, 1));
  return medium;
}

void expect_below_its_majorant(const MediumPoints& looked) {
  for (std::size_t i = 0; i < looked.most.size(); ++i)
    for (std::size_t l = 0; l < 4; ++l)
      EXPECT_LE(looked.sigma_a[i][l] + looked.sigma_s[i][l], looked.most[i][l] * 1.00001f) << i;
}

TEST(MediaPoints, AUniformGridIsLinearBetweenItsCells) {
  UniformGridMedium medium = uniform_grid();
  const std::vector<glm::vec3> points = points_within(corner, other, placed, 400);
  const MediumPoints dark = look(scene_of(medium), points);
  medium.radiance = ConstantSpectrum{3};
  const MediumPoints plain = look(scene_of(medium), points);
  medium.radiance_scale = grid(numbers(60, 2));
  const MediumPoints scaled = look(scene_of(medium), points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 part = part_of(points[i]);
    const double density = 2 * between(*medium.density, counts, part),
                 glow = between(*medium.radiance_scale, counts, part);
    for (std::size_t l = 0; l < 4; ++l) {
      EXPECT_NEAR(dark.sigma_a[i][l], 0.75 * density, grid_error);
      EXPECT_NEAR(dark.sigma_s[i][l], 1.5 * density, 2 * grid_error);
      EXPECT_EQ(dark.le[i][l], 0);
      EXPECT_GT(plain.le[i][l], 0);
      EXPECT_NEAR(scaled.le[i][l] / plain.le[i][l], glow, grid_error);
    }
  }
  expect_below_its_majorant(dark);
}

TEST(MediaPoints, AHotGridGlowsByPlancksLaw) {
  UniformGridMedium medium = uniform_grid();
  std::vector<float> heat = numbers(60, 3);
  for (float& value : heat) value = 1000 + 4000 * value;
  medium.temperature = grid(heat);
  medium.temperature_offset = 150;
  medium.temperature_scale = 0.875;
  const std::vector<glm::vec3> points = points_within(corner, other, placed, 200);
  const MediumPoints plain = look(scene_of(medium), points);
  medium.radiance_scale = grid(numbers(60, 2, 0.5F));
  const MediumPoints scaled = look(scene_of(medium), points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 part = part_of(points[i]);
    const double kelvin = (between(heat, counts, part) - 150) * 0.875;
    for (std::size_t l = 0; l < 4; ++l) {
      // A radiance of 1 gives a picture of 1 if the integral of the CIE's y over wavelengths is
      // divided by 106.856895.
      const double expected = kelvin > 100 ? 106.856895 * planck_part(kelvin, wavelengths[l]) : 0;
      // At 500 K a change of kelvin by 2e-6 of itself is one of 60 times that. Below, kernels hold
      // the exponent to 80.
      EXPECT_NEAR(plain.le[i][l], expected, 2e-4 * expected + 1e-20) << kelvin;
      EXPECT_NEAR(scaled.le[i][l], expected * between(*medium.radiance_scale, counts, part),
                  3e-4 * expected + 1e-20)
          << kelvin;
    }
  }
}

TEST(MediaPoints, AGridOfColoursInterpolatesSpectra) {
  RgbGridMedium medium;
  medium.scale = 3;
  medium.bounds = {corner, other, placed};
  medium.counts = counts;
  medium.sigma_a.rgb = grid(numbers(180, 4));
  medium.radiance.rgb = grid(numbers(180, 6));
  medium.radiance_scale = 0.5;
  const std::vector<glm::vec3> points = points_within(corner, other, placed, 200);
  const MediumPoints looked = look(scene_of(medium), points);
  // Polynomials of single floats here, of double there: seen are 4e-5.
  constexpr double color_error = 1e-4;
  // The spectra of its cells, one after the other, are those that a homogeneous medium of the
  // colour has, and a light.
  std::vector<Four> absorbed(60), shone(60);
  for (std::size_t cell = 0; cell < 60; ++cell) {
    const auto color = [&](const ColorGrid& of) {
      return RgbSpectrum{{(*of.rgb)[3 * cell], (*of.rgb)[3 * cell + 1], (*of.rgb)[3 * cell + 2]},
                         ColorSpace::srgb};
    };
    UniformGridMedium one = uniform_grid();
    one.scattering = {color(medium.sigma_a), ConstantSpectrum{0}, 1, 0};
    one.counts = {1, 1, 1};
    one.density = grid({1});
    one.radiance = color(medium.radiance);
    const MediumPoints of_one = look(
        scene_of(one), {glm::vec3(glm::dvec3(placed * glm::dvec4(0.5 * (corner + other), 1)))});
    absorbed[cell] = of_one.sigma_a[0];
    shone[cell] = of_one.le[0];
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t l = 0; l < 4; ++l) {
      std::vector<float> a(60), s(60);
      for (std::size_t cell = 0; cell < 60; ++cell)
        a[cell] = absorbed[cell][l], s[cell] = shone[cell][l];
      EXPECT_NEAR(looked.sigma_a[i][l], 3 * between(a, counts, part_of(points[i])),
                  3 * color_error);
      EXPECT_EQ(looked.sigma_s[i][l], 3) << "1 where nothing is said of it";
      // pbrt-v4's colours that are no lights' are times an illuminant whose integral with the CIE's
      // y is 106.856895, not 1.
      const double expected = 106.856895 * 0.5 * between(s, counts, part_of(points[i]));
      EXPECT_NEAR(looked.le[i][l], expected, 2 * color_error * 106.856895);
    }
  expect_below_its_majorant(looked);
  std::swap(medium.sigma_a, medium.sigma_s);
  medium.radiance.rgb.reset();
  const MediumPoints swapped = look(scene_of(medium), points);
  EXPECT_EQ(swapped.sigma_s, looked.sigma_a);
  EXPECT_EQ(swapped.sigma_a, looked.sigma_s);
  for (const Four& le : swapped.le) EXPECT_EQ(le, Four{});
  expect_below_its_majorant(swapped);
}

// Bricks on both sides of 0, one of them missing, by the definition.
TEST(MediaPoints, ANanovdbGridIsLinearBetweenItsVoxels) {
  const auto voxel = [](glm::ivec3 p, int salt) {
    if (p.x < -8 || p.x > 7 || p.y < -8 || p.y > -1 || p.z < 0 || p.z > 15 || (p.x < 0 && p.z > 7))
      return 0.0;
    const unsigned h =
        (static_cast<unsigned>(p.x + 8) * 73U + static_cast<unsigned>(p.y + 8) * 179U +
         static_cast<unsigned>(p.z) * 283U + static_cast<unsigned>(salt)) %
        101U;
    return h / 100.0;
  };
  // Voxels are 0.25 wide.
  const glm::dmat4 medium_from_voxels =
      glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(1, 2, -3)), glm::dvec3(0.25));
  const auto grid_of = [&](int salt, double low, double range) {
    auto out = std::make_shared<SparseGrid>();
    out->bricks = {{0, -1, 1}, {-1, -1, 0}, {0, -1, 0}};
    for (const auto& brick : out->bricks)
      for (int i = 0; i < 512; ++i)
        out->values.push_back(
            static_cast<float>(low + range * voxel(8 * glm::ivec3(brick[0], brick[1], brick[2]) +
                                                       glm::ivec3(i % 8, i / 8 % 8, i / 64),
                                                   salt)));
    out->medium_from_voxels = medium_from_voxels;
    out->box.min = glm::dvec3(medium_from_voxels * glm::dvec4(-8.5, -8.5, -0.5, 1));
    out->box.max = glm::dvec3(medium_from_voxels * glm::dvec4(7.5, -0.5, 15.5, 1));
    return out;
  };
  NanovdbMedium medium;
  medium.scattering = stuff;
  medium.density = grid_of(0, 0, 1);
  medium.temperature = grid_of(17, 800, 3000);
  medium.world_from_medium = placed;
  medium.temperature_scale = 1.5;
  medium.temperature_offset = 250;
  medium.radiance_scale = 0.75;
  const std::vector<glm::vec3> points =
      points_within(medium.density->box.min, medium.density->box.max, placed, 400);
  const MediumPoints looked = look(scene_of(medium), points);
  const glm::dmat4 voxels_from_world = glm::inverse(placed * medium_from_voxels);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::dvec3 at(voxels_from_world * glm::dvec4(glm::dvec3(points[i]), 1)),
        low = glm::floor(at);
    double density = 0, heat = 0;
    for (int c = 0; c < 8; ++c) {
      const glm::ivec3 step(c & 1, c >> 1 & 1, c >> 2), p = glm::ivec3(low) + step;
      double weight = 1;
      for (int k = 0; k < 3; ++k) weight *= step[k] == 1 ? at[k] - low[k] : 1 - at[k] + low[k];
      const bool is_there = p.x >= -8 && p.x <= 7 && p.y >= -8 && p.y <= -1 && p.z >= 0 &&
                            p.z <= 15 && (p.x >= 0 || p.z <= 7);
      density += weight * voxel(p, 0);
      heat += is_there ? weight * (800 + 3000 * voxel(p, 17)) : 0;
    }
    const double kelvin = (heat - 250) * 1.5;
    for (std::size_t l = 0; l < 4; ++l) {
      // Places in voxels are good for 16 times 2^-23, and the density changes by 1 from one to the
      // next.
      EXPECT_NEAR(looked.sigma_a[i][l], 2 * 0.75 * density, 1e-4) << i;
      EXPECT_NEAR(looked.sigma_s[i][l], 2 * 1.5 * density, 1e-4) << i;
      if (std::abs(kelvin - 100) < 1) continue;
      const double expected =
          kelvin > 100 ? 0.75 * 106.856895 * planck_part(kelvin, wavelengths[l]) : 0;
      EXPECT_NEAR(looked.le[i][l], expected, (1e-3 + 2 / std::max(kelvin, 1.0)) * expected + 1e-20)
          << kelvin;
    }
  }
  expect_below_its_majorant(looked);
}

struct CloudRow {
  double density, wispiness, frequency;
  glm::vec3 p;
  double value;
};

// By cloud.py: 24 points in clouds of four kinds.
TEST(MediaPoints, ACloudIsThatOfItsNoise) {
  const std::vector<CloudRow> rows = {
      {1, 0, 5, {-0.099F, 0.355F, 3.241F}, 0.362490},
      {1, 0, 5, {-0.979F, 0.798F, 2.782F}, 0.106695},
      {1, 0, 5, {0.019F, 0.478F, 1.027F}, 0.319444},
      {1, 0, 5, {2.669F, 0.635F, 1.085F}, 0.583968},
      {1, 0, 5, {0.987F, 0.310F, -1.929F}, 0.626171},
      {1, 0, 5, {1.967F, 0.178F, 1.247F}, 0.873220},
      {0.6, 1, 5, {0.518F, 0.932F, 1.540F}, 0.021618},
      {0.6, 1, 5, {1.420F, 0.642F, 2.059F}, 0.023672},
      {0.6, 1, 5, {1.279F, 0.224F, -0.845F}, 0.785062},
      {0.6, 1, 5, {2.536F, 0.645F, 1.418F}, 0.153804},
      {0.6, 1, 5, {0.505F, 0.449F, -0.563F}, 0.474443},
      {0.6, 1, 5, {-0.899F, 0.416F, -1.818F}, 0.590378},
      {1.5, 3, 2, {0.713F, 0.545F, 3.237F}, 0.409038},
      {1.5, 3, 2, {0.377F, 0.602F, 2.102F}, 0.209770},
      {1.5, 3, 2, {-0.206F, 0.409F, -0.924F}, 0.709252},
      {1.5, 3, 2, {0.720F, 0.542F, 3.706F}, 0.469484},
      {1.5, 3, 2, {0.004F, 0.785F, 2.059F}, 0.055090},
      {1.5, 3, 2, {0.331F, 0.439F, -0.783F}, 0.709728},
      {0.4, 1, 9, {-0.797F, 0.281F, 3.493F}, 0.921767},
      {0.4, 1, 9, {2.361F, 0.196F, 1.623F}, 0.735570},
      {0.4, 1, 9, {0.355F, 0.370F, -1.324F}, 0.527711},
      {0.4, 1, 9, {1.506F, 0.778F, -0.118F}, 0.031030},
      {0.4, 1, 9, {1.888F, 0.837F, 3.358F}, 0.071500},
      {0.4, 1, 9, {0.517F, 0.315F, 0.739F}, 0.474689},
  };
  for (const CloudRow& row : rows) {
    CloudMedium medium;
    medium.scattering = stuff;
    medium.bounds = {glm::dvec3(-2, -1, -3), glm::dvec3(4, 2, 5), placed};
    medium.density = row.density;
    medium.wispiness = row.wispiness;
    medium.frequency = row.frequency;
    const MediumPoints looked =
        look(scene_of(medium), {glm::vec3(glm::dvec3(placed * glm::dvec4(glm::dvec3(row.p), 1)))});
    // The place is good for 8 times 2^-24 of 4; the finest octave has 16 times the frequency, its
    // slope is some 2 / 32, and wisps are by slopes that differences over 0.01 are taken of: 2^-23
    // of noise over 0.01, by 0.05 times the wispiness.
    const double error = 3e-4 * (1 + row.wispiness);
    EXPECT_NEAR(looked.sigma_a[0][2], 1.5 * row.value, error)
        << row.p.x << " " << row.p.y << " " << row.p.z << " " << row.wispiness;
    EXPECT_NEAR(looked.sigma_s[0][1], 3 * row.value, 2 * error);
    EXPECT_EQ(looked.le[0], Four{});
    expect_below_its_majorant(looked);
  }
}

}  // namespace
}  // namespace caplet::test
