// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/material.h"

#include <cmath>

namespace caplet {

std::string must_lie_within(double low, double high) {
  if (std::isinf(high)) return "must be finite and from " + std::to_string(low) + " up";
  return "must lie between " + std::to_string(low) + " and " + std::to_string(high);
}

}  // namespace caplet
