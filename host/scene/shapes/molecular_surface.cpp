// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The probe's centre may be anywhere outside the open balls that are larger by the probe's radius.
// Here these are "the balls", and such places are "free". On the boundary of the free places the
// probe touches one ball (the surface's piece is of that ball), two (it runs along an arc, and the
// piece is of a torus) or three (it rests at a vertex, and the piece is of the probe's sphere). The
// points of the surface are as far from the nearest free place as the probe's radius.
//
// Pieces of balls, and those of tori up to the axis, are never reached by other probes (Quan and
// Stamm, "Mathematical analysis and calculation of molecular surfaces", J. Comput. Phys. 322,
// 2016). The piece of a resting probe can be, beyond the triangle of its three centres. Then a
// probe at another vertex reaches there as well, so that planes halfway to vertices are all that
// cut it. To see this, let a ball grow from the vertex p towards a point x of the piece, such that
// p stays on its boundary, until it touches another free place q. If q were within an arc or a
// face, the ball would lie in the closed balls that meet at q, and would touch no free place but q;
// but it touches p. So q is a vertex, and it is inside the ball around x that reaches p.
#include "scene/shapes/molecular_surface.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <tuple>

#include "scene/detail/grown_balls.h"
#include "scene/detail/point_grid.h"
#include "scene/detail/sphere_region.h"

namespace caplet {

namespace {

using glm::dvec3;

constexpr double half_turn = std::numbers::pi;
constexpr double turn = 2 * std::numbers::pi;

/// Calls make(index, result) for all indices below count, in parallel, and take(result) in order.
/// Each result is that of some consecutive indices, whatever the number of threads, and few exist
/// at a time.
template <class Result, class Make, class Take>
void in_order(std::size_t count, const Make& make, const Take& take) {
  constexpr std::size_t size = 64, wave = 256 * size;
  for (std::size_t begin = 0; begin < count; begin += wave) {
    const std::size_t end = std::min(count, begin + wave);
    std::vector<Result> results((end - begin + size - 1) / size);
    tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t chunk) {
      const std::size_t from = begin + chunk * size;
      for (std::size_t i = from; i < std::min(end, from + size); ++i) make(i, results[chunk]);
    });
    for (const Result& result : results) take(result);
  }
}

template <class Value>
void append(std::vector<Value>& to, const std::vector<Value>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

void append(SurfacePatches& to, const SurfacePatches& from) {
  const auto shift = static_cast<std::uint32_t>(to.planes.size());
  append(to.planes, from.planes);
  append(to.tori, from.tori);
  for (SurfacePatches::BallPatch patch : from.balls) {
    patch.plane_begin += shift;
    to.balls.push_back(patch);
  }
}

/// Where the spheres of two balls meet, as seen from the first one's center.
struct CircleOfTwo {
  dvec3 center, axis, x, y;
  double radius;

  CircleOfTwo(double ball_radius, const NearBall& other)
      : center(other.height * other.unit),
        axis(other.unit),
        x(any_orthogonal(axis)),
        y(glm::cross(axis, x)),
        radius(std::sqrt((ball_radius - other.height) * (ball_radius + other.height))) {}

  double angle_of(const dvec3& p) const {
    return std::atan2(glm::dot(p - center, y), glm::dot(p - center, x));
  }
};

/// The part of a circle that a ball covers: where cos(angle - middle) > part / whole.
struct Shadow {
  double x, y;  // the direction of the middle
  double part, whole;
  double slack;  // more than the rounding of `part`

  Shadow(const CircleOfTwo& circle, const NearBall& ball) {
    const dvec3 m = ball.to - circle.center;
    const double square = glm::dot(m, m) + circle.radius * circle.radius;
    x = glm::dot(m, circle.x);
    y = glm::dot(m, circle.y);
    part = square - ball.radius * ball.radius;
    whole = 2 * circle.radius * std::sqrt(x * x + y * y);
    // A few roundings of 2^-53 stay below 2^-40, and the balls' growth is far above it.
    slack = 0x1p-40 * (square + ball.radius * ball.radius);
  }
  double middle() const { return std::atan2(y, x); }
};

/// The angles of a circle that no ball is known to cover.
class FreeAngles {
 public:
  void cover(double middle, double half) {
    const double from = wrapped(middle - half), to = from + 2 * half;
    cut(from, std::min(to, turn));
    if (to > turn) cut(0, to - turn);
  }
  bool none() const { return spans_.empty(); }
  bool all() const { return !cut_; }
  bool has(double angle) const {
    const double a = wrapped(angle);
    return std::any_of(spans_.begin(), spans_.end(),
                       [&](const auto& span) { return span[0] <= a && a <= span[1]; });
  }

 private:
  static double wrapped(double angle) {
    return std::clamp(angle - turn * std::floor(angle / turn), 0.0, turn);
  }
  void cut(double from, double to) {
    cut_ = true;
    for (std::size_t i = spans_.size(); i-- > 0;) {
      auto& [a, b] = spans_[i];
      if (from >= b || to <= a) continue;
      const double end = b;
      if (from > a) {
        b = from;
        if (to < end) spans_.push_back({to, end});
      } else if (to < b) {
        a = to;
      } else {
        spans_.erase(spans_.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }
  std::vector<std::array<double, 2>> spans_{{0, turn}};
  bool cut_ = false;
};

/// Where a probe touches three balls i < j < k. It is one of two such places: `above` is that to
/// which cross(j - i, k - i) points.
struct ProbeVertex {
  std::array<std::uint32_t, 3> balls;
  bool above;
  dvec3 at;  // from the first ball's center
};

/// Returns where a ball's sphere meets those of two others, above and below. The errors are a few
/// roundings of 2^-53 over the sine of the angle between these. The growth of 2^-28 stays above
/// them down to sines of 1e-7.
std::optional<std::array<dvec3, 2>> meeting(double radius, const NearBall& j, const NearBall& k) {
  const dvec3 across = glm::cross(j.unit, k.unit);
  const double sine = glm::length(across);
  if (sine == 0) return std::nullopt;
  const double y = (k.height - glm::dot(j.unit, k.unit) * j.height) / sine;
  const double z2 = (radius - j.height) * (radius + j.height) - y * y;
  if (!(z2 > 0)) return std::nullopt;
  const dvec3 up = across / sine;
  const dvec3 foot = j.height * j.unit + y * glm::cross(up, j.unit);
  const dvec3 step = std::sqrt(z2) * up;
  return std::array{foot + step, foot - step};
}

/// What is found from a ball: vertices whose first ball it is, circles with later balls that are
/// free unless they have vertices, and balls that meet none.
struct Found {
  std::vector<ProbeVertex> vertices;
  std::vector<std::array<std::uint32_t, 2>> circles;
  std::vector<std::uint32_t> alone;
};

/// Looks for what is free on one ball's sphere.
class BallSearch {
 public:
  BallSearch(const GrownBalls& balls, std::uint32_t ball, Found& found)
      : ball_(ball), radius_(balls.radius(ball)), near_(balls.around(ball)), found_(found) {}

  void run() {
    if (near_.empty()) found_.alone.push_back(ball_);
    for (std::size_t j = 0; j < near_.size(); ++j)
      if (near_[j].ball > ball_) search_circle(j);
  }

 private:
  /// Shadows are first taken as a little smaller than they are, which keeps all vertices.
  void search_circle(std::size_t j) {
    const CircleOfTwo circle(radius_, near_[j]);
    FreeAngles free;
    for (std::size_t k = 0; k < near_.size(); ++k) {
      if (k == j) continue;
      const Shadow shadow(circle, near_[k]);
      const double part = shadow.part + shadow.slack;
      if (part >= shadow.whole) continue;
      if (part <= -shadow.whole) return;
      free.cover(shadow.middle(), std::acos(part / shadow.whole));
      if (free.none()) return;
    }
    if (free.all()) found_.circles.push_back({ball_, near_[j].ball});
    for (std::size_t k = 0; k < near_.size(); ++k)
      if (near_[k].ball > near_[j].ball) search_ends(circle, free, j, k);
  }

  void search_ends(const CircleOfTwo& circle, const FreeAngles& free, std::size_t j,
                   std::size_t k) {
    const Shadow shadow(circle, near_[k]);
    if (!(std::abs(shadow.part) < shadow.whole)) return;
    const double half = std::acos(shadow.part / shadow.whole), middle = shadow.middle();
    if (!free.has(middle - half) && !free.has(middle + half)) return;
    const auto both = meeting(radius_, near_[j], near_[k]);
    if (!both) return;
    for (const bool above : {true, false}) {
      const dvec3& at = (*both)[above ? 0 : 1];
      if (is_free(at, j, k))
        found_.vertices.push_back({{ball_, near_[j].ball, near_[k].ball}, above, at});
    }
  }

  bool is_free(const dvec3& at, std::size_t j, std::size_t k) const {
    for (std::size_t i = 0; i < near_.size(); ++i)
      if (i != j && i != k && glm::dot(at, near_[i].unit) > near_[i].height) return false;
    return true;
  }

  std::uint32_t ball_;
  double radius_;
  std::vector<NearBall> near_;
  Found& found_;
};

/// An end of an arc of the circle of two balls a < b, as angles grow; or the circle as a whole.
struct ArcEnd {
  std::array<std::uint32_t, 2> balls;
  std::uint32_t vertex;
  bool begins;
};
constexpr std::uint32_t whole_circle = 0xffffffffu;

/// Returns the ends of all arcs, sorted by circles. At the upper vertex of balls i, j and k, angles
/// on the circle of i and j grow out of k, because det(j - i, k - i, at - i) is positive there. The
/// same holds for the other two circles in turn, but that of k and i is kept as that of i and k,
/// where angles grow the other way.
std::vector<ArcEnd> arc_ends(const std::vector<ProbeVertex>& vertices,
                             const std::vector<std::array<std::uint32_t, 2>>& circles) {
  std::vector<ArcEnd> ends;
  ends.reserve(3 * vertices.size() + circles.size());
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto& [balls, above, at] = vertices[v];
    const auto number = static_cast<std::uint32_t>(v);
    ends.push_back({{balls[0], balls[1]}, number, above});
    ends.push_back({{balls[1], balls[2]}, number, above});
    ends.push_back({{balls[0], balls[2]}, number, !above});
  }
  for (const auto& circle : circles) ends.push_back({circle, whole_circle, true});
  tbb::parallel_sort(ends.begin(), ends.end(), [](const ArcEnd& a, const ArcEnd& b) {
    return std::tie(a.balls, a.vertex) < std::tie(b.balls, b.vertex);
  });
  return ends;
}

/// Returns the greatest value of a cos(angle) + b sin(angle) for angles from `from` to `to`.
double greatest_wave(double a, double b, double from, double to) {
  const double peak = std::atan2(b, a);
  const double first = peak + turn * std::ceil((from - peak) / turn);
  if (first <= to) return std::sqrt(a * a + b * b);
  return std::max(a * std::cos(from) + b * std::sin(from), a * std::cos(to) + b * std::sin(to));
}

/// The distance from the axis is never negative, so that the best phi does not depend on theta.
Bounds bounds_of_torus(const SurfacePatches::TorusPatch& patch) {
  const dvec3 y = glm::cross(patch.axis, patch.start);
  Bounds box;
  for (int k = 0; k < 3; ++k) {
    const auto reach = [&](double sign) {
      const double out = greatest_wave(sign * patch.start[k], sign * y[k], 0, patch.phi_max);
      return patch.major * out + patch.minor * greatest_wave(out, sign * patch.axis[k],
                                                             patch.theta_min, patch.theta_max);
    };
    box.min[k] = patch.center[k] - reach(-1);
    box.max[k] = patch.center[k] + reach(1);
  }
  return box;
}

/// Makes the toroidal patches of a circle's free arcs.
class ArcPatches {
 public:
  /// What the arcs of a circle add.
  struct Result {
    SurfacePatches patches;
    std::vector<std::array<std::uint32_t, 2>> edges;  // {ball, other}, both ways
  };

  ArcPatches(const GrownBalls& balls, const std::vector<ProbeVertex>& vertices,
             std::span<const ArcEnd> ends, const NearBall& other, Result& result)
      : balls_(balls),
        vertices_(vertices),
        ends_(ends),
        first_(ends[0].balls[0]),
        other_(other),
        circle_(balls.radius(first_), other),
        result_(result) {}

  void run() {
    const std::size_t before = result_.patches.tori.size();
    if (ends_[0].vertex == whole_circle)
      add_arc(circle_.x, turn);
    else
      match_ends();
    if (result_.patches.tori.size() == before) return;
    result_.edges.push_back({first_, other_.ball});
    result_.edges.push_back({other_.ball, first_});
  }

 private:
  struct End {
    double angle;
    bool begins;
    dvec3 at;
  };

  /// Beginnings and ends alternate. Where roundings have it otherwise, which takes coincidences in
  /// spite of the growth, what has no partner is left out.
  void match_ends() {
    std::vector<End> sorted;
    for (const ArcEnd& end : ends_) {
      if (end.vertex == whole_circle) continue;
      const ProbeVertex& vertex = vertices_[end.vertex];
      const dvec3 at = vertex.at + (balls_.center(vertex.balls[0]) - balls_.center(first_));
      sorted.push_back({circle_.angle_of(at), end.begins, at});
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const End& a, const End& b) { return a.angle < b.angle; });
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const End& from = sorted[i];
      const End& to = sorted[(i + 1) % sorted.size()];
      if (!from.begins || to.begins) continue;
      const double along = to.angle - from.angle;
      const dvec3 off = from.at - circle_.center;
      add_arc(glm::normalize(off - glm::dot(off, circle_.axis) * circle_.axis),
              along > 0 ? along : along + turn);
    }
  }

  /// The tube's part between its two contacts, halved between the balls, without what lies beyond
  /// the axis.
  void add_arc(const dvec3& start, double phi_max) {
    const double rho = circle_.radius;
    const double distance = glm::dot(other_.to, other_.unit);
    const double at_first = half_turn + std::atan2(other_.height, rho);
    const double at_other = half_turn - std::atan2(distance - other_.height, rho);
    const double middle = (at_first + at_other) / 2;
    const double beyond = rho < balls_.probe() ? std::acos(rho / balls_.probe()) : 0;
    const SurfacePatches::TorusPatch whole{balls_.center(first_) + circle_.center,
                                           circle_.axis,
                                           start,
                                           rho,
                                           balls_.probe(),
                                           phi_max,
                                           at_other,
                                           at_first,
                                           0,
                                           {}};
    if (beyond == 0) {
      add_between(whole, at_other, middle, other_.ball);
      add_between(whole, middle, at_first, first_);
      return;
    }
    add_between(whole, at_other, std::min(middle, half_turn - beyond), other_.ball);
    add_between(whole, std::max(at_other, half_turn + beyond), middle, other_.ball);
    add_between(whole, middle, std::min(at_first, half_turn - beyond), first_);
    add_between(whole, std::max(middle, half_turn + beyond), at_first, first_);
  }

  /// Adds nothing where only the rounding of angles near pi, some 1e-15, is between the ends.
  void add_between(const SurfacePatches::TorusPatch& whole, double from, double to,
                   std::uint32_t ball) {
    if (!(to - from > 1e-14)) return;
    SurfacePatches::TorusPatch patch = whole;
    patch.theta_min = from;
    patch.theta_max = to;
    patch.ball = balls_.name(ball);
    patch.bounds = bounds_of_torus(patch);
    result_.patches.tori.push_back(patch);
  }

  const GrownBalls& balls_;
  const std::vector<ProbeVertex>& vertices_;
  std::span<const ArcEnd> ends_;
  std::uint32_t first_;
  const NearBall& other_;
  CircleOfTwo circle_;
  Result& result_;
};

/// Adds a part of a sphere, unless it is empty.
void add_region(SurfacePatches& to, SurfacePatches::BallPatch patch,
                std::span<const SpherePlane> planes, const SphereRegion& region) {
  if (region.bounds.empty()) return;
  patch.plane_begin = static_cast<std::uint32_t>(to.planes.size());
  patch.plane_count = static_cast<std::uint32_t>(region.planes.size());
  for (const std::uint32_t i : region.planes)
    to.planes.push_back({planes[i].normal, patch.radius * planes[i].offset});
  patch.bounds = {patch.center + patch.radius * region.bounds.min,
                  patch.center + patch.radius * region.bounds.max};
  to.balls.push_back(patch);
}

/// Adds the free part of a ball's sphere. `edges` names the balls with which it shares arcs.
void add_face(const GrownBalls& balls, std::uint32_t ball,
              std::span<const std::array<std::uint32_t, 2>> edges, SurfacePatches& to) {
  std::vector<SpherePlane> planes;
  std::vector<std::uint32_t> bounding;
  for (const NearBall& other : balls.around(ball)) {
    if (std::binary_search(edges.begin(), edges.end(), std::array{ball, other.ball}))
      bounding.push_back(static_cast<std::uint32_t>(planes.size()));
    planes.push_back({other.unit, other.height / balls.radius(ball)});
  }
  const SurfacePatches::BallPatch patch{
      balls.center(ball), balls.radius(ball) - balls.probe(), 0, balls.name(ball), 0, 0, {}};
  add_region(to, patch, planes, sphere_region(planes, bounding));
}

/// Makes the patches of probes at vertices.
class RestingProbes {
 public:
  RestingProbes(const GrownBalls& balls, const std::vector<ProbeVertex>& vertices)
      : balls_(balls), vertices_(vertices), grid_(places(), 2 * balls.probe()) {}

  void add(std::size_t vertex, SurfacePatches& to) const {
    const Corner corner(balls_, vertices_[vertex]);
    const std::vector<SpherePlane> cuts = cuts_of(vertex, corner);
    for (std::size_t part = 0; part < 3; ++part) {
      std::vector<SpherePlane> planes = cuts;
      for (const std::size_t other : {(part + 1) % 3, (part + 2) % 3})
        planes.push_back({glm::normalize(corner.to[other] - corner.to[part]), 0});
      for (const dvec3& side : corner.sides) planes.push_back({side, 0});
      const SurfacePatches::BallPatch patch{place(vertices_[vertex]),
                                            balls_.probe(),
                                            1,
                                            balls_.name(vertices_[vertex].balls[part]),
                                            0,
                                            0,
                                            {}};
      const std::vector<std::uint32_t> bounding = bounding_planes(planes);
      if (!bounding.empty()) add_region(to, patch, planes, sphere_region(planes, bounding));
    }
  }

 private:
  /// Directions to the three balls, and the outward normals of the cone's sides: sides[i] is that
  /// through the balls i and i + 1.
  struct Corner {
    std::array<dvec3, 3> to, sides;

    Corner(const GrownBalls& balls, const ProbeVertex& vertex) {
      const dvec3& origin = balls.center(vertex.balls[0]);
      for (std::size_t i = 0; i < 3; ++i)
        to[i] = glm::normalize((balls.center(vertex.balls[i]) - origin) - vertex.at);
      for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 normal = glm::normalize(glm::cross(to[i], to[(i + 1) % 3]));
        sides[i] = vertex.above ? normal : -normal;
      }
    }

    /// Returns the greatest scalar product of a unit vector and one in the cone.
    double greatest(const dvec3& n) const {
      const auto inside = [&](const dvec3& side) { return glm::dot(n, side) <= 0; };
      if (std::all_of(sides.begin(), sides.end(), inside)) return 1;
      double most = -1;
      for (std::size_t i = 0; i < 3; ++i) {
        const dvec3 &a = to[i], &b = to[(i + 1) % 3];
        most = std::max(most, glm::dot(n, a));
        const dvec3 flat = n - glm::dot(n, sides[i]) * sides[i];
        const dvec3 axis = glm::cross(a, b);
        if (glm::dot(glm::cross(a, flat), axis) > 0 && glm::dot(glm::cross(flat, b), axis) > 0)
          most = std::max(most, glm::length(flat));
      }
      return most;
    }
  };

  dvec3 place(const ProbeVertex& vertex) const {
    return balls_.center(vertex.balls[0]) + vertex.at;
  }

  std::vector<dvec3> places() const {
    std::vector<dvec3> all;
    for (const ProbeVertex& vertex : vertices_) all.push_back(place(vertex));
    return all;
  }

  /// The planes halfway to other vertices that cut into the cone.
  std::vector<SpherePlane> cuts_of(std::size_t vertex, const Corner& corner) const {
    const ProbeVertex& from = vertices_[vertex];
    std::vector<SpherePlane> cuts;
    grid_.near(place(from), [&](std::uint32_t number) {
      if (number == vertex) return;
      const ProbeVertex& other = vertices_[number];
      const dvec3 between =
          (other.at - from.at) + (balls_.center(other.balls[0]) - balls_.center(from.balls[0]));
      const double distance = glm::length(between);
      const double offset = distance / (2 * balls_.probe());
      if (!(distance > 0) || offset >= 1) return;
      if (corner.greatest(between / distance) > offset)
        cuts.push_back({between / distance, offset});
    });
    return cuts;
  }

  const GrownBalls& balls_;
  const std::vector<ProbeVertex>& vertices_;
  PointGrid grid_;
};

/// Returns where each run of equal keys begins, and the end.
template <class Value, class Key>
std::vector<std::size_t> runs_of(const std::vector<Value>& values, const Key& key) {
  std::vector<std::size_t> begins;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i == 0 || key(values[i]) != key(values[i - 1])) begins.push_back(i);
  begins.push_back(values.size());
  return begins;
}

Found search_all(const GrownBalls& balls) {
  Found all;
  in_order<Found>(
      balls.size(),
      [&](std::size_t i, Found& result) {
        BallSearch(balls, static_cast<std::uint32_t>(i), result).run();
      },
      [&](const Found& result) {
        append(all.vertices, result.vertices);
        append(all.circles, result.circles);
        append(all.alone, result.alone);
      });
  return all;
}

/// Adds the patches of tori, and returns the pairs of balls that share an arc, sorted.
std::vector<std::array<std::uint32_t, 2>> add_tori(const GrownBalls& balls, const Found& found,
                                                   SurfacePatches& to) {
  const std::vector<ArcEnd> ends = arc_ends(found.vertices, found.circles);
  const auto begins = runs_of(ends, [](const ArcEnd& end) { return end.balls; });
  std::vector<std::array<std::uint32_t, 2>> edges;
  in_order<ArcPatches::Result>(
      begins.size() - 1,
      [&](std::size_t i, ArcPatches::Result& result) {
        const std::span run(ends.data() + begins[i], begins[i + 1] - begins[i]);
        const auto other = balls.seen(run[0].balls[0], run[0].balls[1]);
        if (other) ArcPatches(balls, found.vertices, run, *other, result).run();
      },
      [&](const ArcPatches::Result& result) {
        append(to, result.patches);
        append(edges, result.edges);
      });
  tbb::parallel_sort(edges.begin(), edges.end());
  return edges;
}

void add_faces(const GrownBalls& balls, const Found& found,
               const std::vector<std::array<std::uint32_t, 2>>& edges, SurfacePatches& to) {
  for (const std::uint32_t ball : found.alone) add_face(balls, ball, {}, to);
  const auto begins = runs_of(edges, [](const auto& edge) { return edge[0]; });
  in_order<SurfacePatches>(
      begins.size() - 1,
      [&](std::size_t i, SurfacePatches& result) {
        const std::span run(edges.data() + begins[i], begins[i + 1] - begins[i]);
        add_face(balls, run[0][0], run, result);
      },
      [&](const SurfacePatches& result) { append(to, result); });
}

void add_probes(const GrownBalls& balls, const Found& found, SurfacePatches& to) {
  const RestingProbes probes(balls, found.vertices);
  in_order<SurfacePatches>(
      found.vertices.size(), [&](std::size_t i, SurfacePatches& result) { probes.add(i, result); },
      [&](const SurfacePatches& result) { append(to, result); });
}

}  // namespace

SurfacePatches molecular_surface(std::span<const glm::vec3> centers, std::span<const float> radii,
                                 double probe) {
  SurfacePatches patches;
  if (centers.empty()) return patches;
  const GrownBalls balls(centers, radii, probe);
  const Found found = search_all(balls);
  const auto edges = add_tori(balls, found, patches);
  add_faces(balls, found, edges, patches);
  add_probes(balls, found, patches);
  return patches;
}

}  // namespace caplet
