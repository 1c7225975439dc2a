// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The scenes rendered by Mitsuba 3 (reference/mitsuba of the shared data) and what agreement with them means.
#pragma once

#include <string>
#include <vector>

namespace caplet::test {

struct ReferenceScene {
  std::string name;
  bool spectral;  // compared by means and blocks alone
  double mean, blocks;
  int effort = 1;  // times the usual samples: caustics of a mirror ball and glossy plates converge slowly, in Mitsuba as here
};

/// Mitsuba at 1,024 samples against itself: z means -0.13, -0.24, 0.01, -0.04 for mis, glossy, capsules, cornell.
inline const std::vector<ReferenceScene>& reference_scenes() {
  static const std::vector<ReferenceScene> scenes = {
      {"mis-grey", false, 0.003, 0.02, 8},     {"glossy-grey", false, 0.003, 0.01, 1}, {"capsules-grey", false, 0.003, 0.01, 1},
      {"cornell-grey", false, 0.003, 0.01, 1}, {"cornell", true, 0.005, 0.01, 1},      {"environment", true, 0.005, 0.01, 32},
  };
  return scenes;
}
inline constexpr double allowed_z_mean = 0.3, allowed_beyond_3 = 0.03;

}  // namespace caplet::test
