// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a mesh of the format COLLADA.
#include "mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::fuzz_robot_mesh(".dae", data, size);
}
