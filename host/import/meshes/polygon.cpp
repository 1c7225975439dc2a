// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Triangulation of polygons.
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <numeric>

#include "import/detail/mesh_file.h"

namespace caplet {

namespace {

constexpr std::size_t kMostEars =
    2000;  // corners of a polygon that is cut by ears; the time grows with their square

/// Returns twice the area; it is positive where a, b, c are in counter-clockwise order.
double area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const glm::vec3> corners) {
  const auto count = static_cast<std::uint32_t>(corners.size());
  std::vector<std::array<std::uint32_t, 3>> out;
  const auto fan = [&] {
    out.clear();
    for (std::uint32_t i = 2; i < count; ++i) out.push_back({0, i - 1, i});
    return out;
  };
  if (count < 4 || count > kMostEars) return fan();
  // Newell's normal. The polygon is projected along its greatest axis so that it is
  // counter-clockwise.
  glm::dvec3 normal(0);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 a(corners[i] - corners[0]), b(corners[(i + 1) % count] - corners[0]);
    normal += glm::cross(a, b);
  }
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  if (!(size[axis] > 0)) return fan();
  std::vector<glm::dvec2> flat;
  for (const glm::vec3& corner : corners) {
    const glm::dvec2 p(corner[(axis + 1) % 3], corner[(axis + 2) % 3]);
    flat.push_back(normal[axis] > 0 ? p : glm::dvec2(p.y, p.x));
  }
  bool convex = true;
  for (std::uint32_t i = 0; i < count && convex; ++i)
    convex = area(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) >= 0;
  if (convex) return fan();
  std::vector<std::uint32_t> left(count);
  std::iota(left.begin(), left.end(), 0U);
  while (left.size() > 3) {
    bool cut = false;
    for (std::size_t i = 0; i < left.size() && !cut; ++i) {
      const std::size_t n = left.size();
      const std::uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
      if (!(area(flat[a], flat[b], flat[c]) > 0)) continue;
      bool empty = true;
      for (const std::uint32_t k : left) {
        if (k == a || k == b || k == c || flat[k] == flat[a] || flat[k] == flat[b] ||
            flat[k] == flat[c])
          continue;
        empty = empty &&
                !(area(flat[a], flat[b], flat[k]) >= 0 && area(flat[b], flat[c], flat[k]) >= 0 &&
                  area(flat[c], flat[a], flat[k]) >= 0);
      }
      if (!empty) continue;
      out.push_back({a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
      cut = true;
    }
    if (!cut) return fan();  // it intersects itself
  }
  out.push_back({left[0], left[1], left[2]});
  return out;
}

}  // namespace caplet
