// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/vec3.hpp>
#include <limits>

#include "shared/records.h"

namespace caplet::test {

/// The ray from `o` along `d`, rounded to float, over all of its positive half.
inline RayRecord make_ray(const glm::dvec3& o, const glm::dvec3& d) {
  return {static_cast<float>(o.x), static_cast<float>(o.y),
          static_cast<float>(o.z), 0,
          static_cast<float>(d.x), static_cast<float>(d.y),
          static_cast<float>(d.z), std::numeric_limits<float>::infinity()};
}

}  // namespace caplet::test
