// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes of every kind of shape but csg, and rays through them.
#include "scene_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::fuzz_scene(data, size, false);
}
