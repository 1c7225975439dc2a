// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The origin of a ray that leaves a surface, as the device moves it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "device/device.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

const char* const kernel_text = R"(
#include "shapes/surface.cl"
__kernel void offsets(__global const float* in, __global float* out, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count) return;
  __global const float* v = in + 10 * i;
  vstore3(offset_origin(vload3(0, v), vload3(0, v + 3), v[6], vload3(0, v + 7)), i, out);
}
)";

// Every component is as far from p as error * n is, or further, on the side of the direction; and
// no more than a few roundings further.
TEST(OffsetOrigin, NeverLandsShort) {
  const Device& device = test_device();
  const Program program =
      Program::from_source(device, "offset_test", flatten_kernels(kernel_text), "");
  constexpr std::uint32_t count = 20000;
  std::mt19937 engine(9);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-30, 30);
  std::vector<float> in;
  for (std::uint32_t i = 0; i < count; ++i) {
    double n[3] = {normal(engine), normal(engine), normal(engine)};
    if (i % 7 == 0) n[i % 3] = 0;
    const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    const double scale = std::exp2(uniform(engine));
    for (unsigned k = 0; k < 3; ++k)
      in.push_back(i % 11 == k ? 0.0f : static_cast<float>(scale * normal(engine)));
    for (const double x : n) in.push_back(static_cast<float>(x / length));
    // From far below the last place of the point to much more.
    in.push_back(static_cast<float>(scale * std::exp2(uniform(engine) - 10)));
    for (int k = 0; k < 3; ++k) in.push_back(static_cast<float>(normal(engine)));
  }
  const Buffer<float> inputs(device, std::span<const float>(in));
  Buffer<float> outputs(device, 3 * count);
  cl::Kernel kernel = program.kernel("offsets");
  set_arguments(device, kernel, inputs, outputs, count);
  launch(device, kernel, count, 64);
  const std::vector<float> out = outputs.read();
  for (std::uint32_t i = 0; i < count; ++i) {
    const float *p = &in[10 * i], *n = p + 3, *d = p + 7;
    const double side = double(d[0]) * n[0] + double(d[1]) * n[1] + double(d[2]) * n[2];
    if (std::abs(side) < 1e-6) continue;  // the device's scalar product may have either sign
    for (int k = 0; k < 3; ++k) {
      // The step is a product of floats, rounded.
      const float step = (side < 0 ? -p[6] : p[6]) * n[k];
      const double moved = double(out[3 * i + std::uint32_t(k)]) - double(p[k]);
      if (step == 0) {
        ASSERT_EQ(moved, 0) << i;
        continue;
      }
      ASSERT_GE(step > 0 ? moved : -moved, std::abs(double(step))) << i << " " << k;
      // Rounded to nearest, then once further: 3/2 units of the last place, each 2 eps at most;
      // FLT_MIN where the sum is zero.
      const double largest =
          std::max(std::abs(double(p[k])), std::abs(double(out[3 * i + std::uint32_t(k)])));
      ASSERT_LE(std::abs(moved), std::abs(double(step)) + 4 * 0x1p-24 * largest + 0x1p-126)
          << i << " " << k;
    }
  }
}

}  // namespace
}  // namespace caplet::test
