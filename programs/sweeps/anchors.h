// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Settings in which other ray tracers are known to be inexact, as their trackers describe them: our
// kernels in them and, where Embree 3 is installed, Embree on the same rays.
#pragma once

#include <string>

#include "device/device.h"

namespace caplet::test {

struct Anchors {
  std::string text;  // Markdown, a section an anchor
  bool held = true;  // ours within the bound, with no hit lost and none invented
};
Anchors anchors(const Device& device, int rays);

}  // namespace caplet::test
