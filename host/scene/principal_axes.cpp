// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/principal_axes.h"

#include <cmath>
#include <glm/matrix.hpp>
#include <utility>

namespace caplet {

PrincipalAxes principal_axes(glm::dmat3 a) {
  glm::dmat3 v(1);
  constexpr int kSweeps =
      60;  // quadratic convergence: 3x3 needs about 6, after which entries off the diagonal are 0
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const auto& [p, q] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
      if (a[q][p] == 0) continue;
      const double theta = (a[q][q] - a[p][p]) / (2 * a[q][p]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      glm::dmat3 rotation(1);
      rotation[p][p] = rotation[q][q] = c;
      rotation[q][p] = s;
      rotation[p][q] = -s;
      a = glm::transpose(rotation) * a * rotation;
      a[p][q] = a[q][p] = 0;
      v = v * rotation;
    }
  return {{a[0][0], a[1][1], a[2][2]}, v};
}

}  // namespace caplet
