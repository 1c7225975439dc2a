// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once
#include <caplet/render.h>

#include <cstdlib>

/// CAPLET_TEST_DEVICE as `--device` has it, else the default device.
inline caplet::Device test_device() {
  const char* named = std::getenv("CAPLET_TEST_DEVICE");
  return caplet::choose_device(named ? named : "");
}
