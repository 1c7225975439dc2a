// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/shapes/family.h"

namespace caplet {

/// An axis-aligned box between two corners. Surfaces: 0 and 1 at the least and greatest x, 2 and 3
/// y, 4 and 5 z.
struct BoxShape {
  glm::dvec3 p0{0}, p1{1};
};

inline std::size_t count_of(const BoxShape&) { return 1; }
inline std::size_t surfaces_of(const BoxShape&) { return 6; }
inline bool closed(const BoxShape&) { return true; }

inline void fields(BoxShape& box, Fields& each) { each.corners("p0", "p1", box.p0, box.p1); }

inline void check(const BoxShape& box, ShapeCheck& report) {
  if (!is_finite(box.p0) || !is_finite(box.p1))
    return report.error("the box's corners are not finite");
  for (int k = 0; k < 3; ++k)
    if (static_cast<float>(box.p0[k]) == static_cast<float>(box.p1[k]))
      return report.error("p1", std::string("has the same ") + "xyz"[k] +
                                    " as \"p0\" (as 32-bit floats): the box is flat");
}

inline Bounds bounds_under(const BoxShape& box, const glm::dmat4& m) {
  Bounds bounds;
  for (int i = 0; i < 8; ++i)
    bounds.extend(transformed(m, {i & 1 ? box.p1.x : box.p0.x, i & 2 ? box.p1.y : box.p0.y,
                                  i & 4 ? box.p1.z : box.p0.z}));
  return bounds;
}

inline double outside(const BoxShape& box, int surface, const glm::dvec3& p) {
  const int k = surface / 2;
  return surface % 2 == 0 ? std::min(box.p0[k], box.p1[k]) - p[k]
                          : p[k] - std::max(box.p0[k], box.p1[k]);
}

inline glm::dvec3 normal_on(const BoxShape&, int surface, const glm::dvec3&) {
  glm::dvec3 out{0};
  out[surface / 2] = surface % 2 == 0 ? -1 : 1;
  return out;
}

/// v runs along z (on the z faces along y), u to the right of it as seen from outside; each runs
/// from 0 to 1.
inline glm::dvec2 uv_on(const BoxShape& box, int surface, const glm::dvec3& p) {
  const glm::dvec3 low = glm::min(box.p0, box.p1), size = glm::max(box.p0, box.p1) - low,
                   w = p - low;
  const auto share = [](double x, double whole) {
    return whole != 0 ? std::clamp(x / whole, 0.0, 1.0) : 0.0;
  };
  const int across = surface / 2, up = across == 2 ? 1 : 2, along = 3 - across - up;
  glm::dvec3 outward{0}, upward{0};
  outward[across] = surface % 2 == 1 ? 1 : -1;
  upward[up] = 1;
  const glm::dvec3 right = glm::cross(upward, outward);
  const double part = share(w[along], size[along]);
  return {right[along] > 0 ? part : 1 - part, share(w[up], size[up])};
}

/// The planes stay parallel to the axes.
inline double tilt_of(const BoxShape&, double) { return 0; }

inline BoxShape drawn(std::type_identity<BoxShape>, Draws& draws) {
  const double r = draws.size;
  return BoxShape{-r * glm::dvec3(1, 0.5, draws.thin()), r * glm::dvec3(draws.thin(), 0.4, 0.6)};
}

}  // namespace caplet
