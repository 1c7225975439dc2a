// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any bytes as a mesh of MuJoCo's format.
#include "mesh_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::fuzz_robot_mesh(".msh", data, size);
}
