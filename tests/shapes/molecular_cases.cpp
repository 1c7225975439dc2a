// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random patches of molecular surfaces, and points on them.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "cases.h"
#include "lower/detail/shapes.h"

namespace caplet::test {

using glm::dvec3;

FlatPrimitive CaseMaker::molecular_patch(const Frame& at, std::vector<float>& leaves) {
  std::vector<glm::vec3> centers;
  std::vector<float> radii;
  for (int i = 0, count = 2 + below(4); i < count; ++i) {
    const double r = at.r * uniform(0.2, 1);
    centers.emplace_back(at.center + at.r * uniform(0, 1.5) * direction());
    radii.push_back(static_cast<float>(r));
  }
  const MolecularSurfaceShape molecule = make_molecule(centers, radii, at.r * uniform(0.1, 2));
  const std::vector<FlatPrimitive> patches = flat_patches(molecule, glm::dmat4(1), leaves);
  // Half of them are tori, where there are any.
  const int balls = static_cast<int>(molecule.patches->balls.size()),
            all = static_cast<int>(patches.size());
  const int chosen =
      below(2) == 0 && balls < all ? balls + below(all - balls) : below(std::max(1, balls));
  return patches.at(static_cast<std::size_t>(chosen));
}

dvec3 CaseMaker::point_of(const reference::MolecularPatch& patch, dvec3* normal) {
  const auto at = [&](double phi, double theta) {
    const dvec3 spoke =
        std::cos(phi) * patch.start + std::sin(phi) * glm::cross(patch.axis, patch.start);
    *normal = -(std::cos(theta) * spoke + std::sin(theta) * patch.axis);
    return patch.center + patch.major * spoke - patch.minor * *normal;
  };
  if (patch.major > 0)
    return at(between(0, patch.phi_max), between(patch.theta_min, patch.theta_max));
  const std::vector<reference::Curve> border = reference::boundary(patch);
  dvec3 x = patch.center + patch.minor * direction();
  if (!border.empty() && below(3) == 0)
    x = border[static_cast<std::size_t>(below(static_cast<int>(border.size())))].at(uniform(0, 1));
  else
    for (int i = 0; i < 200 && !reference::keeps(patch, x, 0); ++i)
      x = patch.center +
          patch.minor * glm::normalize(patch.ball_center - patch.center +
                                       patch.ball_radius * uniform(0, 1) * direction());
  *normal = (patch.of_probe ? -1.0 : 1.0) * glm::normalize(x - patch.center);
  return x;
}

}  // namespace caplet::test
