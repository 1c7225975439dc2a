// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts pbrt-v4's curves to chains of tapered capsules.
#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/log.h"
#include "import/detail/cubic_chain.h"
#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

using glm::dvec3;
using Cubic = std::array<dvec3, 4>;  // Bezier control points

/// Raises a quadratic curve to degree 3.
Cubic elevate(const dvec3& p0, const dvec3& p1, const dvec3& p2) {
  return {p0, (p0 + 2.0 * p1) / 3.0, (2.0 * p1 + p2) / 3.0, p2};
}

/// Converts segment `at` of a uniform B-spline to Bezier form (knot insertion at both ends of the
/// segment).
Cubic of_b_spline(const std::vector<glm::vec3>& points, std::size_t at, std::size_t degree) {
  const auto p = [&](std::size_t i) { return dvec3(points[at + i]); };
  if (degree == 2) return elevate((p(0) + p(1)) / 2.0, p(1), (p(1) + p(2)) / 2.0);
  return {(p(0) + 4.0 * p(1) + p(2)) / 6.0, (2.0 * p(1) + p(2)) / 3.0, (p(1) + 2.0 * p(2)) / 3.0,
          (p(1) + 4.0 * p(2) + p(3)) / 6.0};
}

Cubic of_bezier(const std::vector<glm::vec3>& points, std::size_t at, std::size_t degree) {
  const auto p = [&](std::size_t i) { return dvec3(points[degree * at + i]); };
  return degree == 2 ? elevate(p(0), p(1), p(2)) : Cubic{p(0), p(1), p(2), p(3)};
}

/// Adds radii that change linearly along the curve.
CubicTube tube_of(const Cubic& c, double radius0, double radius1) {
  const double step = (radius1 - radius0) / 3;
  return {glm::dvec4(c[0], radius0), glm::dvec4(c[1], radius0 + step),
          glm::dvec4(c[2], radius1 - step), glm::dvec4(c[3], radius1)};
}

/// Returns the number of segments of P; 0 when its count is wrong (reported).
std::size_t segments_of(Parameters& parameters, std::size_t points, std::size_t degree,
                        bool bezier) {
  if (points == 0) return 0;
  const std::string wrong = "has " + std::to_string(points) + " points; a " +
                            (bezier ? "Bezier curve" : "B-spline") + " of degree " +
                            std::to_string(degree) + " takes ";
  if (bezier && (points < degree + 1 || (points - 1) % degree != 0)) {
    parameters.error("P", wrong + "1 + n times " + std::to_string(degree));
    return 0;
  }
  if (points < degree + 1) {
    parameters.error("P", wrong + "at least " + std::to_string(degree + 1));
    return 0;
  }
  return bezier ? (points - 1) / degree : points - degree;
}

/// Reads one of two names; the first is the default.
bool is_second(Parameters& parameters, const char* name, const char* first, const char* second) {
  const std::string given = parameters.text(name, first);
  if (given != first && given != second)
    parameters.error(name, std::string("must be \"") + first + "\" or \"" + second + "\", not " +
                               in_quotes(given));
  return given == second;
}

void check_type_and_normals(Parameters& parameters, std::size_t segments) {
  const std::string type = parameters.text("type", "flat");
  if (type != "flat" && type != "cylinder" && type != "ribbon")
    parameters.error("type",
                     "must be \"flat\", \"cylinder\" or \"ribbon\", not " + in_quotes(type));
  const Parameter* normals = parameters.values("N", {"normal"});
  if (normals && type == "ribbon" && segments != 0 && normals->numbers.size() != 3 * (segments + 1))
    parameters.error("N", "has " + std::to_string(normals->numbers.size() / 3) +
                              " normals; a ribbon of " + std::to_string(segments) +
                              " segments takes " + std::to_string(segments + 1));
  else if (!normals && type == "ribbon" && !parameters.has("N"))
    parameters.error("\"normal N\" is missing (a ribbon takes one a segment's end)");
  else if (normals)
    log::info("{}: \"N\" has no effect: curves are round tubes", parameters.where("N").to_string());
}

}  // namespace

CapsulesShape make_curve(Parameters& parameters) {
  CapsulesShape chain;
  if (!parameters.has("P")) parameters.error("\"point3 P\" is missing");
  const std::vector<glm::vec3> points = vectors3(parameters, parameters.values("P", {"point3"}));
  const int degree = parameters.integer("degree", 3);
  if (degree != 2 && degree != 3)
    parameters.error("degree", "must be 2 or 3, not " + std::to_string(degree));
  const auto order = static_cast<std::size_t>(degree == 2 ? 2 : 3);
  const bool bezier = !is_second(parameters, "basis", "bezier", "bspline");
  const std::size_t segments = segments_of(parameters, points.size(), order, bezier);
  check_type_and_normals(parameters, segments);
  parameters.values("splitdepth", {"integer", "float"});
  const bool u_is_whole = is_second(parameters, "urange", "piece", "curve");
  const double width = length(parameters, "width", 1);
  const std::array<double, 2> widths{length(parameters, "width0", width),
                                     length(parameters, "width1", width)};
  const double widest = std::max(widths[0], widths[1]);
  if (std::min(widths[0], widths[1]) < 0 || !(static_cast<float>(widest) > 0)) {
    parameters.error(parameters.has("width1")   ? "width1"
                     : parameters.has("width0") ? "width0"
                                                : "width",
                     "must be positive (of two widths one may be 0)");
    return chain;
  }
  if (segments == 0) return chain;

  Bounds bounds;
  for (const glm::vec3& p : points) bounds.extend(dvec3(p));
  const double tolerance = std::max(1e-3 * widest, 1e-5 * glm::length(bounds.max - bounds.min));
  CubicChain out(chain);
  const auto radius = [&](std::size_t end) {
    return 0.5 *
           glm::mix(widths[0], widths[1], static_cast<double>(end) / static_cast<double>(segments));
  };
  for (std::size_t i = 0; i < segments; ++i) {
    const Cubic cubic = bezier ? of_bezier(points, i, order) : of_b_spline(points, i, order);
    const CubicTube tube = tube_of(cubic, radius(i), radius(i + 1));
    if (i == 0) out.start(tube[0]);
    const auto number = static_cast<double>(i), count = static_cast<double>(segments);
    if (u_is_whole)
      out.add(tube, tolerance, number / count, (number + 1) / count);
    else
      out.add(tube, tolerance, 0, 1);  // pbrt-v4 makes a curve of each cubic
  }
  if (widths[0] == widths[1]) chain.radius1.clear();
  return chain;
}

}  // namespace caplet::pbrt
