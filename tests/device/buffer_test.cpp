// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Buffers: round trips, accounting, limits.
#include <gtest/gtest.h>

#include <numeric>

#include "device/device.h"

namespace caplet {
namespace {

TEST(Buffer, GivesBackWhatItWasMadeFrom) {
  const Device device = Device::choose("");
  std::vector<float> values(1000);
  std::iota(values.begin(), values.end(), -3.0f);
  EXPECT_EQ(Buffer<float>(device, std::span<const float>(values)).read(), values);
}

TEST(Program, RunsAKernel) {
  const Device device = Device::choose("");
  const Program program =
      Program::from_source(device, "twice",
                           flatten_kernels("#include \"math/vector.cl\"\n__kernel void twice(__global float* x, uint n) { const "
                                           "uint i = get_global_id(0); if (i < n) x[i] = sqr(x[i]); }"),
                           "");
  Buffer<float> buffer(device, 5);
  buffer.write(std::vector<float>{1, 2, 3, 4, 5});
  cl::Kernel kernel = program.kernel("twice");
  kernel.setArg(0, buffer.handle());
  kernel.setArg(1, cl_uint{3});
  launch(device, kernel, 3, 4);
  EXPECT_EQ(buffer.read(), (std::vector<float>{1, 4, 9, 4, 5}));
}

}  // namespace
}  // namespace caplet
