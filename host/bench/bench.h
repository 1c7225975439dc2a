// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Camera and bounce rays through the traversal kernels and through Embree, alternating, the same rays in the same order: medians
// of Mrays/s. "any" asks of the bounce rays whether they hit at all, as shadow rays do.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace caplet::bench {

struct Options {
  std::string kind;             // of kinds()
  std::string device = "cpu";   // as Device::choose takes it
  std::size_t count = 1000000;  // primitives; of kinds other than capsules and triangles at most 100000
  double seconds = 5;           // for each kind of ray
  int size = 1024;              // camera rays a side
  int width = 0;                // 8: eight primitives at a time, 1: one; 0: by device
  bool alone = false;           // without Embree, which takes more memory than ours
  int builders = 0;             // instead of rays: trees of capsules or triangles by 1 to so many threads
  bool sorted = false;          // also bounce rays sorted by origin and octant, for ours alone
};

/// What can be measured: capsules, triangles, another shape, or "shapes": all others; "lights": what emissive capsules take to
/// lower, in processor seconds and bytes, without rays.
std::vector<std::string> kinds();

using Say = std::function<void(const std::string& line)>;

/// Says one JSON object a line: name, ours, embree, ratio (null without Embree), unit and more. Throws InputError, RunError,
/// std::runtime_error.
void run(const Options& options, const Say& line);

}  // namespace caplet::bench
