// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Ribbons of a protein's backbone: Carson and Bugg 1986, "Algorithm for ribbon models of proteins",
// doi:10.1016/0263-7855(86)80007-7. Lengths are in angstroms.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "import/detail/molecule.h"
#include "scene/shape.h"

namespace caplet {

/// A cross section: a rectangle with rounded corners. `half_width` lies along the guide's side.
struct RibbonSection {
  double half_width = 0.28, half_height = 0.28, corner = 0.28;
};
inline constexpr RibbonSection coil_section{0.28, 0.28, 0.28};
inline constexpr RibbonSection helix_section{1.25, 0.25, 0.25};
inline constexpr RibbonSection strand_section{1.15, 0.25, 0.08};
/// Where the head of a strand begins: it is the widest and highest, so that its back is all around
/// what comes before it.
inline constexpr RibbonSection arrow_section{1.9, 0.29, 0.08};

/// A residue of a ribbon: a place that the curve goes through and the direction of its width.
struct RibbonGuide {
  glm::dvec3 place{0}, side{1, 0, 0};  // side: of any length but 0
  Secondary kind = Secondary::coil;
};

/// How finely a ribbon is cut: an even number of pieces a residue, points of each corner.
struct RibbonDetail {
  std::uint32_t pieces = 8, corner_points = 5;
};

/// A curve through points that lie at whole numbers 0, 1, 2...: a natural cubic spline, whose
/// curvature is continuous and 0 at the ends.
class NaturalSpline {
 public:
  explicit NaturalSpline(std::vector<glm::dvec3> points);
  glm::dvec3 at(double t) const;
  glm::dvec3 derivative(double t) const;

 private:
  std::vector<glm::dvec3> points_, seconds_;  // second derivatives at the points
};

/// Returns the surface of a ribbon, a mesh for each of the two or more guides: from halfway behind
/// the guide before to halfway before the guide behind. Meshes of neighbours share the points of
/// their border, and all of them are one closed surface, whose normals look outward. Strands end in
/// arrow heads, which are as long as their last residue. Ends of the ribbon are round. Takes time
/// and memory in proportion to the guides.
std::vector<TriangleMeshShape> ribbon_meshes(std::span<const RibbonGuide> guides,
                                             const RibbonDetail& detail);

}  // namespace caplet
