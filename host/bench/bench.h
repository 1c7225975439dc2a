// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Traces camera and bounce rays with the traversal kernels and with Embree in turn, the same rays
// in the same order, and reports medians of Mrays/s. "any" asks whether bounce rays hit anything,
// as shadow rays do.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace caplet::bench {

struct Options {
  std::string kind;            // one of kinds()
  std::string device = "cpu";  // as for Device::choose
  std::size_t count =
      1000000;         // primitives; at most 100000 for kinds other than capsules and triangles
  double seconds = 5;  // per kind of ray
  int size = 1024;     // camera rays per side
  int width = 0;       // 8: eight primitives at a time, 1: one; 0: the device's own
  bool alone = false;  // without Embree, which needs more memory than our kernels
  int builders =
      0;  // measures builds of capsule or triangle trees on 1 to this many threads instead of rays
  bool sorted = false;  // also measures our kernels with bounce rays sorted by origin and octant
};

/// Lists what can be measured: capsules, triangles, another shape, or "shapes": all others;
/// "lights": the cost of lowering emissive capsules, in processor seconds and bytes, without rays.
std::vector<std::string> kinds();

using Say = std::function<void(const std::string& line)>;

/// Writes one JSON object per line: name, ours, embree, ratio (null without Embree), unit and more.
/// Throws InputError, RunError, std::runtime_error.
void run(const Options& options, const Say& line);

}  // namespace caplet::bench
