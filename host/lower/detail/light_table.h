// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes the table that lights are chosen by (kernels/lights/lights.cl: light_select).
#pragma once

#include <cstdint>
#include <vector>

#include "shared/records.h"

namespace caplet {

/// LightShare is a light for the choice among lights. `group`: lights of one statement share it
/// (the primitives of a shape).
struct LightShare {
  double power = 0;  // >= 0; 0: never chosen
  std::uint32_t group = 0;
};

/// Half of the samples go by power, half evenly to the groups and within each by power, so that a
/// light beside a brighter one that is occluded still gets samples: the variance is at most twice
/// that of either rule alone. Every light with power has a chance.
///
/// The table is exact: of the 2^32 random numbers of light_select, exactly `probability` x 2^32
/// choose the light, and up to 65,536 lights that product is a multiple of 2^8, so that the float
/// holds it without rounding (beyond, chances above 2^-8 are rounded to floats). Walker 1977; Vose,
/// "A linear algorithm for generating random numbers with a given distribution", 1991.
std::vector<AliasRecord> light_table(const std::vector<LightShare>& lights);

}  // namespace caplet
