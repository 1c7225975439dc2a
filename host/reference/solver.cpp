// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Solves for crossings. Only open surfaces have code for single shapes.
#include "reference/solver.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "reference/detail/parts.h"

namespace caplet::reference {

namespace {

using glm::dvec2;
using glm::dvec3;

bool usable(const Ray& ray) {
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(ray.origin[i]) || !std::isfinite(ray.direction[i])) return false;
  return ray.direction != dvec3(0);
}

// Line is the ray's line, measured in lengths from its point nearest to the shape's ball.
struct Line {
  dvec3 foot, unit;
  double t_foot, speed, reach;  // the shape lies within [-reach, reach] of the foot
  double miss_distance;         // between the line and the ball; <= 0: it goes through
};

Line line_near(const Primitive& primitive, const Ray& ray) {
  const Ball ball = bounding_ball(primitive);
  Line line;
  // The direction is scaled first, so that no direction's square overflows or vanishes.
  const double largest =
      std::max({std::abs(ray.direction.x), std::abs(ray.direction.y), std::abs(ray.direction.z)});
  const dvec3 scaled = ray.direction / largest;
  line.unit = scaled / glm::length(scaled);
  line.speed = glm::length(scaled) * largest;
  double along = glm::dot(ball.center - ray.origin, line.unit);
  line.foot = ray.origin + along * line.unit;
  along += glm::dot(ball.center - line.foot, line.unit);
  line.foot = ray.origin + along * line.unit;
  line.t_foot = along / line.speed;
  line.reach =
      ball.radius * (1 + 1e-9) + 1e-12 * (std::abs(along) + glm::length(ball.center)) + 1e-300;
  line.miss_distance = glm::length(line.foot - ball.center) - line.reach;
  return line;
}

// Halves the bracket around the least value until that is <= `enough`, cannot be (the Lipschitz
// bound), or the bracket cannot be narrowed. Returns the place and the value there.
std::pair<double, double> descend(const Primitive& primitive, const Line& line, double enough,
                                  double low, double high) {
  const auto f = [&](double s) { return value(primitive, line.foot + s * line.unit); };
  double middle = 0.5 * (low + high), at_middle = f(middle);
  while (at_middle > enough) {
    if (at_middle - std::max(high - middle, middle - low) > enough && enough > -HUGE_VAL) break;
    const double left = 0.5 * (low + middle), right = 0.5 * (middle + high);
    if (left <= low || left >= middle || right <= middle || right >= high) break;
    const double at_left = f(left), at_right = f(right);
    if (at_left < at_middle && at_left <= at_right) {
      high = std::exchange(middle, left);
      at_middle = at_left;
    } else if (at_right < at_middle) {
      low = std::exchange(middle, right);
      at_middle = at_right;
    } else {
      low = left;
      high = right;
    }
  }
  return {middle, at_middle};
}

// Returns the least value along the line.
double least_on(const Primitive& primitive, const Line& line) {
  return descend(primitive, line, -HUGE_VAL, -line.reach, line.reach).second;
}

// Returns where the value changes sign between `outside` (> 0) and `inside` (<= 0), to 2^-52 of the
// reach: bisection, helped by the Illinois form of regula falsi in two steps of three.
double bisect(const Primitive& primitive, const Line& line, double outside, double inside) {
  const auto f = [&](double s) { return value(primitive, line.foot + s * line.unit); };
  double at_outside = f(outside), at_inside = f(inside);
  for (int i = 1; std::abs(outside - inside) > 0x1p-52 * line.reach; ++i) {
    double s = inside - at_inside * (outside - inside) / (at_outside - at_inside);
    const bool between = (s > inside && s < outside) || (s < inside && s > outside);
    if (i % 3 == 0 || !between) s = 0.5 * (outside + inside);
    if (s == outside || s == inside) break;
    const double here = f(s);
    if (here > 0) {
      outside = s, at_outside = here, at_inside *= 0.5;
    } else {
      inside = s, at_inside = here, at_outside *= 0.5;
    }
  }
  return inside;
}

std::vector<Crossing> solid_crossings(const Primitive& primitive, const Ray& ray) {
  const Line line = line_near(primitive, ray);
  if (line.miss_distance > 0) return {};
  // By the Lipschitz bound no crossing is nearer to a point outside than the value there, so both
  // ends move inward by it first.
  double low = -line.reach, high = line.reach;
  const auto f = [&](double s) { return value(primitive, line.foot + s * line.unit); };
  for (int i = 0; i < 4; ++i) {
    const double at_low = f(low), at_high = f(high);
    if (at_low > 0) low += at_low * (1 - 0x1p-40);
    if (at_high > 0) high -= at_high * (1 - 0x1p-40);
    if (low > high) return {};
  }
  const auto [inside, least] = descend(primitive, line, 0, low, high);
  if (least > 0) return {};
  std::vector<Crossing> out;
  for (const bool leaving : {false, true}) {
    double end = leaving ? high : low;
    // Rounding may have moved an end onto the surface.
    if (!(f(end) > 0)) end = leaving ? line.reach : -line.reach;
    const double s = bisect(primitive, line, end, inside);
    const SurfaceAt at = surface_at(primitive, line.foot + s * line.unit);
    out.push_back({line.t_foot + s / line.speed, leaving, at.surface, at.margin});
  }
  return out;
}

// Returns the crossings of open shapes that are part of a solid's boundary.
std::vector<Crossing> clipped_crossings(const Primitive& primitive, const Ray& ray) {
  const Primitive carrier = carrier_of(primitive);
  std::vector<Crossing> out;
  const Line line = line_near(primitive, ray);
  for (const Crossing& c : solid_crossings(carrier, ray))
    // The point is computed from the foot, since the ray's origin may be far.
    if (keeps(primitive, line.foot + (c.t - line.t_foot) * line.speed * line.unit, c.surface))
      out.push_back(c);
  if (!std::holds_alternative<Frustum>(primitive))
    for (Crossing& c : out) c.surface = 0, c.surface_margin = HUGE_VAL;
  return out;
}

// Returns six times the signed volume of the tetrahedron a b c and the origin.
double volume(const dvec3& a, const dvec3& b, const dvec3& c) {
  return glm::dot(a, glm::cross(b, c));
}

std::vector<Crossing> triangle_crossings(const Triangle& triangle, const Ray& ray) {
  const Line line = line_near(triangle, ray);
  if (line.miss_distance > 0) return {};
  const dvec3 a = triangle.v0 - line.foot, b = triangle.v1 - line.foot, c = triangle.v2 - line.foot;
  const double edge[3] = {volume(line.unit, a, b), volume(line.unit, b, c),
                          volume(line.unit, c, a)};
  const bool positive = edge[0] >= 0 && edge[1] >= 0 && edge[2] >= 0;
  const bool negative = edge[0] <= 0 && edge[1] <= 0 && edge[2] <= 0;
  const double sum = edge[0] + edge[1] + edge[2];
  // The triangle is seen edge-on as far as doubles can tell (each volume is a sum of six products
  // of three rounded factors): there is no crossing.
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  if (!(positive || negative) || std::abs(sum) <= 0x1p-49 * (la * lb + lb * lc + lc * la))
    return {};
  return {{line.t_foot + volume(a, b, c) / sum / line.speed,
           glm::dot(glm::cross(b - a, c - a), line.unit) > 0, 0, HUGE_VAL}};
}

std::vector<Crossing> disk_crossings(const Disk& disk, const Ray& ray) {
  const Line line = line_near(disk, ray);
  const double slope = glm::dot(disk.normal, line.unit);
  if (line.miss_distance > 0 || slope == 0) return {};
  const double s = glm::dot(disk.normal, disk.center - line.foot) / slope;
  if (!(glm::length(line.foot + s * line.unit - disk.center) <= disk.radius)) return {};
  return {{line.t_foot + s / line.speed, slope > 0, 0, HUGE_VAL}};
}

std::vector<Crossing> partial_disk_crossings(const PartialDisk& disk, const Ray& ray) {
  const Line line = line_near(disk, ray);
  if (line.miss_distance > 0 || line.unit.z == 0) return {};
  const double s = (disk.height - line.foot.z) / line.unit.z;
  if (!keeps(disk, line.foot + s * line.unit, 0)) return {};
  return {{line.t_foot + s / line.speed, line.unit.z > 0, 0, HUGE_VAL}};
}

// --- Csg ---

// Collects where the line crosses the boundaries of the solids of a csg shape, in lengths from
// line.foot; `inner` is the same line in the space of `csg`.
void collect_events(const Csg& csg, const Ray& inner, const Line& line,
                    std::vector<double>& events) {
  for (const CsgOperand& operand : csg.body->operands) {
    const glm::dmat4& m = operand.operand_from_csg;
    const Ray local{dvec3(m * glm::dvec4(inner.origin, 1)),
                    dvec3(m * glm::dvec4(inner.direction, 0)), -HUGE_VAL, HUGE_VAL};
    if (const auto* nested = std::get_if<Csg>(&operand.primitive)) {
      collect_events(*nested, local, line, events);
      continue;
    }
    for (const Crossing& c : solid_crossings(operand.primitive, local)) events.push_back(c.t);
  }
}

std::vector<Crossing> csg_crossings(const Csg& csg, const Ray& ray) {
  const Line line = line_near(csg, ray);
  if (line.miss_distance > 0) return {};
  // Events are in lengths from the foot.
  std::vector<double> events;
  collect_events(csg, {line.foot, line.unit}, line, events);
  std::sort(events.begin(), events.end());
  const auto at = [&](double s) { return line.foot + s * line.unit; };
  const double together = 1e-10 * line.reach;
  std::vector<Crossing> out;
  bool inside = false;
  for (std::size_t i = 0; i < events.size();) {
    std::size_t next = i + 1;
    while (next < events.size() && events[next] - events[next - 1] <= together) ++next;
    const bool after =
        next < events.size() && value(csg, at(0.5 * (events[next - 1] + events[next]))) <= 0;
    if (after != inside) {
      const SurfaceAt here = surface_at(csg, at(events[i]));
      out.push_back({line.t_foot + events[i] / line.speed, inside, here.surface, here.margin});
    }
    inside = after;
    i = next;
  }
  return out;
}

// --- Bilinear patches, seen along the line: a bilinear map of the unit square to the plane, with
// the line as origin ---

struct Seen {
  dvec2 p00, p10, p01, p11;
  dvec2 at(double u, double v) const {
    return (1 - u) * ((1 - v) * p00 + v * p01) + u * ((1 - v) * p10 + v * p11);
  }
  // This is the Jacobian determinant: an affine function of u and v.
  double turn(double u, double v) const {
    return cross((1 - v) * (p10 - p00) + v * (p11 - p01), (1 - u) * (p01 - p00) + u * (p11 - p10));
  }
  static double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }
};

Seen seen_along(const Line& line, const Bilinear& b) {
  const dvec3 e = any_perpendicular(line.unit), f = glm::cross(line.unit, e);
  const auto flat = [&](const dvec3& p) {
    return dvec2(glm::dot(e, p - line.foot), glm::dot(f, p - line.foot));
  };
  return {flat(b.p00), flat(b.p10), flat(b.p01), flat(b.p11)};
}

// Returns false only when all four lie strictly on one side of a line through the origin.
bool hull_has_origin(const dvec2 (&p)[4]) {
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) {
      const double here = -Seen::cross(p[j] - p[i], p[i]);
      double low = 0, high = 0;
      for (int k = 0; k < 4; ++k) {
        const double side = Seen::cross(p[j] - p[i], p[k] - p[i]);
        low = std::min(low, side);
        high = std::max(high, side);
      }
      if (here < low || here > high) return false;
    }
  return true;
}

// Returns the point of an unfolded cell that is seen at the origin: lines of constant u, and of
// constant v, stay lines.
dvec2 locate(const Seen& seen, double u0, double u1, double v0, double v1) {
  const auto bisect_lines = [](double low, double high, const auto& side) {
    // The origin is between both ends' lines; where rounding contradicts that it is at the line of
    // the smaller value (which is noise where that line is a point).
    const double at_low = side(low), at_high = side(high);
    const bool rises = std::abs(at_high) >= std::abs(at_low) ? at_high > 0 : at_low < 0;
    for (;;) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) return middle;
      ((side(middle) > 0) == rises ? high : low) = middle;
    }
  };
  const auto from_line = [](const dvec2& a, const dvec2& b) { return -Seen::cross(b - a, a); };
  const double u =
      bisect_lines(u0, u1, [&](double at) { return from_line(seen.at(at, v0), seen.at(at, v1)); });
  const double v =
      bisect_lines(v0, v1, [&](double at) { return from_line(seen.at(u0, at), seen.at(u1, at)); });
  // On the cell's edges, and where one of them is a point, rounding or a vanishing line may have
  // misled either search.
  dvec2 best{u, v};
  for (const double a : {u, u0, u1})
    for (const double b : {v, v0, v1})
      if (glm::length(seen.at(a, b)) < glm::length(seen.at(best.x, best.y))) best = {a, b};
  return best;
}

std::vector<Crossing> bilinear_crossings(const Bilinear& patch, const Ray& ray) {
  const Line line = line_near(patch, ray);
  if (line.miss_distance > 0) return {};
  const Seen seen = seen_along(line, patch);
  struct Cell {
    double u0, u1, v0, v1;
  };
  std::vector<Cell> cells = {{0, 1, 0, 1}};
  std::vector<dvec2> found;
  // A patch that is seen edge-on has only folded cells: no crossing is reported then.
  for (int work = 0; !cells.empty() && work < 20000; ++work) {
    const Cell c = cells.back();
    cells.pop_back();
    const dvec2 corners[4] = {seen.at(c.u0, c.v0), seen.at(c.u1, c.v0), seen.at(c.u1, c.v1),
                              seen.at(c.u0, c.v1)};
    if (!hull_has_origin(corners)) continue;
    const double turns[4] = {seen.turn(c.u0, c.v0), seen.turn(c.u1, c.v0), seen.turn(c.u1, c.v1),
                             seen.turn(c.u0, c.v1)};
    const double least = *std::min_element(turns, turns + 4),
                 greatest = *std::max_element(turns, turns + 4);
    if ((least >= 0 && greatest > 0) || (greatest <= 0 && least < 0)) {
      found.push_back(locate(seen, c.u0, c.u1, c.v0, c.v1));
      continue;
    }
    if (c.u1 - c.u0 < 0x1p-30) continue;
    const double u = 0.5 * (c.u0 + c.u1), v = 0.5 * (c.v0 + c.v1);
    cells.insert(cells.end(),
                 {{c.u0, u, c.v0, v}, {u, c.u1, c.v0, v}, {c.u0, u, v, c.v1}, {u, c.u1, v, c.v1}});
  }
  std::vector<Crossing> out;
  std::vector<dvec2> kept;
  for (const dvec2& uv : found) {
    bool again = false;
    for (const dvec2& other : kept) again = again || glm::length(uv - other) < 1e-9;
    if (again) continue;
    kept.push_back(uv);
    const dvec3 x = (1 - uv.x) * ((1 - uv.y) * patch.p00 + uv.y * patch.p01) +
                    uv.x * ((1 - uv.y) * patch.p10 + uv.y * patch.p11);
    out.push_back({line.t_foot + glm::dot(x - line.foot, line.unit) / line.speed,
                   seen.turn(uv.x, uv.y) > 0, 0, HUGE_VAL});
  }
  std::sort(out.begin(), out.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
  return out;
}

// --- Molecular patches ---

// Finds the sign changes of a 1-Lipschitz function between two places. Halves are left out where
// the function is further from 0 than their ends; what is so short that samples rise or fall
// throughout has one sign change or none. Pairs closer than 2^-24 of the line are not seen.
class SignChanges {
 public:
  SignChanges(std::function<double(double)> f, double shortest)
      : f_(std::move(f)), shortest_(shortest) {}

  // Searches between neighbouring places, which are in order.
  std::vector<double> between(const std::vector<double>& places) {
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      search({places[i], f_(places[i])}, {places[i + 1], f_(places[i + 1])}, 0);
    return std::move(found_);
  }

 private:
  struct Sample {
    double s, value;
    bool inside() const { return value <= 0; }
  };

  void search(const Sample& low, const Sample& high, int level) {
    const double s = 0.5 * (low.s + high.s);
    const Sample middle{s, f_(s)};
    const double half = 0.5 * (high.s - low.s);
    if (std::abs(middle.value) > half * (1 + 1e-12)) return;
    const bool is_short = 2 * half <= shortest_;
    if (is_short || (level >= 8 && goes_one_way(low, high))) {
      if (low.inside() != high.inside()) found_.push_back(refined(low, high));
      return;
    }
    search(low, middle, level + 1);
    search(middle, high, level + 1);
  }

  bool goes_one_way(const Sample& low, const Sample& high) const {
    constexpr int samples = 8;
    const double sign = high.value >= low.value ? 1 : -1;
    double before = low.value;
    for (int i = 1; i <= samples; ++i) {
      const double here = i == samples ? high.value : f_(low.s + (high.s - low.s) * i / samples);
      if (!(sign * (here - before) > 0)) return false;
      before = here;
    }
    return true;
  }

  // The Illinois form of regula falsi, and halving in one step of three.
  double refined(Sample low, Sample high) const {
    double from = low.value, to = high.value;
    for (int i = 1;; ++i) {
      double s = high.s - to * (high.s - low.s) / (to - from);
      if (i % 3 == 0 || !(s > low.s && s < high.s)) s = 0.5 * (low.s + high.s);
      if (!(s > low.s && s < high.s)) return low.s;
      const double here = f_(s);
      if ((here <= 0) == low.inside()) {
        low.s = s, from = here, to *= 0.5;
      } else {
        high.s = s, to = here, from *= 0.5;
      }
    }
  }

  std::function<double(double)> f_;
  double shortest_;
  std::vector<double> found_;
};

// Returns places that cut the line: both ends of its part near the patch, and ever shorter steps
// towards the axis of a torus, where the carrier's value changes its course within a length like
// the line's distance from the axis.
std::vector<double> places_towards_axis(const Line& line, const MolecularPatch& patch) {
  std::vector<double> out = {-line.reach, line.reach};
  const dvec3 across = line.unit - glm::dot(line.unit, patch.axis) * patch.axis;
  const double cross2 = glm::dot(across, across);
  if (cross2 > 0) {
    const double nearest = glm::dot(patch.center - line.foot, across) / cross2;
    constexpr int halvings = 40;
    for (int k = 0; k < halvings; ++k)
      for (const double away : {-1.0, 1.0})
        if (const double s = nearest + away * std::ldexp(line.reach, -k); std::abs(s) < line.reach)
          out.push_back(s);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<Crossing> molecular_crossings(const MolecularPatch& patch, const Ray& ray) {
  const Line line = line_near(patch, ray);
  if (line.miss_distance > 0) return {};
  const auto at = [&](double s) { return line.foot + s * line.unit; };
  std::vector<Crossing> out;
  if (patch.major == 0) {
    for (const Crossing& c : solid_crossings(Sphere{patch.center, patch.minor}, ray))
      if (keeps(patch, at((c.t - line.t_foot) * line.speed), 0))
        out.push_back({c.t, c.leaving != patch.of_probe, 0, HUGE_VAL});
    return out;
  }
  const auto f = [&](double s) { return carrier_value(patch, at(s)); };
  for (const double s :
       SignChanges(f, 0x1p-24 * line.reach).between(places_towards_axis(line, patch)))
    if (keeps(patch, at(s), 0)) {
      const double step = 0x1p-26 * line.reach;
      out.push_back({line.t_foot + s / line.speed, f(s + step) > f(s - step), 0, HUGE_VAL});
    }
  return out;
}

// Returns the distance between the patch and the places where a small shift of the line makes or
// removes two crossings: where the carrier's value has a least or a greatest value on the line.
double distance_to_touch(const Line& line, const MolecularPatch& patch) {
  constexpr int samples = 512, more_samples = 64;
  const auto at = [&](double s) { return line.foot + s * line.unit; };
  const auto f = [&](double s) { return carrier_value(patch, at(s)); };
  double least = HUGE_VAL;
  const auto refine = [&](double s, double here, double sign, double step) {
    for (double width = 0.25 * step; width > 1e-9 * step; width *= 0.5)
      for (const double there : {s - width, s + width})
        if (const double value_there = f(there); sign * value_there < sign * here)
          s = there, here = value_there;
    least = std::min(least, value(patch, at(s)));
  };
  const auto search = [&](const auto& self, const std::vector<double>& places, bool again) -> void {
    std::vector<double> values;
    for (const double s : places) values.push_back(f(s));
    const auto slope = [&](std::size_t i) {
      return i > 0 && i + 1 < places.size()
                 ? std::abs((values[i + 1] - values[i - 1]) / (places[i + 1] - places[i - 1]))
                 : HUGE_VAL;
    };
    for (std::size_t i = 1; i + 1 < places.size(); ++i) {
      const double here = values[i], before = values[i - 1], after = values[i + 1],
                   step = places[i + 1] - places[i - 1];
      if (here <= before && here <= after)
        refine(places[i], here, 1, step);
      else if (here >= before && here >= after)
        refine(places[i], here, -1, step);
      // Where a line nearly follows the surface, a least and a greatest value may both lie between
      // samples: the slope is small there.
      if (!again || slope(i) > slope(i - 1) || slope(i) > slope(i + 1)) continue;
      std::vector<double> between;
      for (int k = 0; k <= more_samples; ++k)
        between.push_back(places[i - 1] + k * step / more_samples);
      self(self, between, false);
    }
  };
  std::vector<double> places = places_towards_axis(line, patch);
  for (int i = 1; i < samples; ++i) places.push_back((2.0 * i / samples - 1) * line.reach);
  std::sort(places.begin(), places.end());
  search(search, places, true);
  return least;
}

// --- Margins ---

constexpr double no_limit = -HUGE_VAL;

// Returns the least of f over [0, 1], where f(x) - f(y) <= steepness |x - y|. Cells that this shows
// to hold nothing less than the known least are left out; each level splits the others in eight,
// and the last ones are searched by halving around samples below their neighbours. With a limit, it
// is enough to know whether the least is above it.
template <class Function>
double least_over(int levels, double steepness, double limit, const Function& f) {
  constexpr int split = 8;
  struct Cell {
    int index;
    double at_begin, at_end;
  };
  std::vector<Cell> cells{{0, f(0.0), f(1.0)}}, parts;
  double least = std::min(cells[0].at_begin, cells[0].at_end), width = 1;
  for (int level = 0; level < levels && least > limit; ++level) {
    width /= split;
    parts.clear();
    for (const Cell& cell : cells) {
      double before = cell.at_begin;
      for (int i = 0; i < split; ++i) {
        const int index = split * cell.index + i;
        const double after = i + 1 < split ? f((index + 1) * width) : cell.at_end;
        least = std::min(least, after);
        parts.push_back({index, before, after});
        before = after;
      }
    }
    const double enough = limit >= 0 ? std::min(least, limit) : least;
    std::erase_if(parts, [&](const Cell& cell) {
      return 0.5 * (cell.at_begin + cell.at_end - steepness * width) > enough;
    });
    cells.swap(parts);
  }
  for (std::size_t i = 0; i < cells.size() && least > limit; ++i) {
    const Cell& cell = cells[i];
    const bool is_begin = cell.at_begin <= cell.at_end;
    if (is_begin ? i > 0 && cells[i - 1].index == cell.index - 1 &&
                       cells[i - 1].at_begin <= cell.at_begin
                 : i + 1 < cells.size() && cells[i + 1].index == cell.index + 1 &&
                       cells[i + 1].at_end <= cell.at_end)
      continue;
    double best = (cell.index + (is_begin ? 0 : 1)) * width,
           value_there = std::min(cell.at_begin, cell.at_end);
    for (double step = 0.5 * width; step > 1e-16; step *= 0.5)
      for (const double x : {best - step, best + step}) {
        if (x < 0 || x > 1) continue;
        const double there = f(x);
        if (there < value_there) value_there = there, best = x;
      }
    least = std::min(least, value_there);
  }
  return least;
}

double distance_line_to_point(const Line& line, const dvec3& p) {
  const dvec3 w = p - line.foot;
  return glm::length(w - glm::dot(w, line.unit) * line.unit);
}

double distance_line_to_curve(const Line& line, const Curve& curve, double limit) {
  if (curve.kind == Curve::Kind::segment) {
    // Seen along the line, the segment is one in the plane and the line is its origin.
    const dvec3 a = curve.p - line.foot, b = curve.q - line.foot;
    return distance_to_segment(dvec3(0), a - glm::dot(a, line.unit) * line.unit,
                               b - glm::dot(b, line.unit) * line.unit);
  }
  return least_over(5, curve.radius * std::abs(curve.to - curve.from), limit,
                    [&](double s) { return distance_line_to_point(line, curve.at(s)); });
}

// Returns the distance between the line and the places where it would touch the patch: where the
// patch, seen along the line, folds.
double distance_to_fold(const Line& line, const Bilinear& patch, double limit) {
  const Seen seen = seen_along(line, patch);
  // The ends are where the zero line of an affine function enters and leaves the unit square.
  std::vector<dvec2> ends;
  const dvec2 corners[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int i = 0; i < 4; ++i) {
    const dvec2 a = corners[i], b = corners[(i + 1) % 4];
    const double fa = seen.turn(a.x, a.y), fb = seen.turn(b.x, b.y);
    if (fa == 0) ends.push_back(a);
    if ((fa < 0 && fb > 0) || (fa > 0 && fb < 0)) ends.push_back(a + fa / (fa - fb) * (b - a));
  }
  double least = HUGE_VAL;
  const double sides =
      std::max(glm::length(seen.p10 - seen.p00), glm::length(seen.p11 - seen.p01)) +
      std::max(glm::length(seen.p01 - seen.p00), glm::length(seen.p11 - seen.p10));
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    least = std::min(
        least, least_over(5, sides * glm::length(ends[i + 1] - ends[i]), limit, [&](double s) {
          const dvec2 uv = ends[i] + s * (ends[i + 1] - ends[i]);
          return glm::length(seen.at(uv.x, uv.y));
        }));
  return least;
}

double least_along(const Primitive& primitive, const Line& line) {
  return least_over(6, 2 * line.reach, no_limit, [&](double s) {
    return value(primitive, line.foot + (2 * s - 1) * line.reach * line.unit);
  });
}

}  // namespace

std::vector<Crossing> crossings(const Primitive& primitive, const Ray& ray) {
  if (!usable(ray)) return {};
  if (const auto* triangle = std::get_if<Triangle>(&primitive))
    return triangle_crossings(*triangle, ray);
  if (const auto* disk = std::get_if<Disk>(&primitive)) return disk_crossings(*disk, ray);
  if (const auto* disk = std::get_if<PartialDisk>(&primitive))
    return partial_disk_crossings(*disk, ray);
  if (const auto* patch = std::get_if<Bilinear>(&primitive)) return bilinear_crossings(*patch, ray);
  if (const auto* patch = std::get_if<MolecularPatch>(&primitive))
    return molecular_crossings(*patch, ray);
  if (const auto* csg = std::get_if<Csg>(&primitive)) return csg_crossings(*csg, ray);
  return is_solid(primitive) ? solid_crossings(primitive, ray) : clipped_crossings(primitive, ray);
}

std::optional<Crossing> closest(const Primitive& primitive, const Ray& ray) {
  for (const Crossing& crossing : crossings(primitive, ray))
    if (crossing.t > ray.t_min && crossing.t < ray.t_max) return crossing;
  return std::nullopt;
}

namespace {

// Returns, for open surfaces, how far the line is from where its number of crossings changes.
// Beyond `limit` any number above it will do.
double change_distance(const Primitive& primitive, const Ray& ray, double limit) {
  const Line line = line_near(primitive, ray);
  double distance = HUGE_VAL;
  const auto* molecular = std::get_if<MolecularPatch>(&primitive);
  for (const Curve& curve : boundary(primitive)) {
    // A plane that is moved moves its circle by as much over the sine of its angle to the sphere.
    const double sine = molecular && molecular->major == 0 ? curve.radius / molecular->minor : 1;
    distance = std::min(distance, sine * distance_line_to_curve(line, curve, limit / sine));
  }
  if (const auto* patch = std::get_if<Bilinear>(&primitive)) {
    distance = std::min(distance, distance_to_fold(line, *patch, limit));
  } else if (molecular) {
    distance = std::min(distance, distance_to_touch(line, *molecular));
  } else if (const Primitive carrier = carrier_of(primitive);
             carrier.index() != primitive.index() || std::holds_alternative<Frustum>(primitive)) {
    distance = std::min(distance, std::abs(least_on(carrier, line_near(carrier, ray))));
  }
  return distance;
}

}  // namespace

double margin(const Primitive& primitive, const Ray& ray) {
  const Line line = line_near(primitive, ray);
  if (std::holds_alternative<Csg>(primitive)) return -least_along(primitive, line);
  if (is_solid(primitive)) return -least_on(primitive, line);
  const double distance = change_distance(primitive, ray, no_limit);
  return crossings(primitive, ray).empty() ? -distance : distance;
}

bool comes_within(const Primitive& primitive, const Ray& ray, double tolerance) {
  return !(is_solid(primitive) ? std::abs(margin(primitive, ray)) > tolerance
                               : change_distance(primitive, ray, tolerance) > tolerance);
}

Verdict referee(const Primitive& primitive, const Ray& ray, double tolerance) {
  if (!usable(ray)) return Verdict::miss;
  if (!is_solid(primitive)) {
    const double m = margin(primitive, ray);
    return m > tolerance ? Verdict::hit : m < -tolerance ? Verdict::miss : Verdict::tangent;
  }
  const Line line = line_near(primitive, ray);
  // Samples are everywhere first, then ever closer around the least one.
  double least = HUGE_VAL, where = 0, low = -line.reach, high = line.reach;
  for (const int samples : {2048, 64, 64, 64, 64, 64}) {
    const double step = (high - low) / samples;
    for (int i = 0; i <= samples; ++i) {
      const double s = low + i * step, f = value(primitive, line.foot + s * line.unit);
      if (f < least) least = f, where = s;
    }
    low = where - 2 * step;
    high = where + 2 * step;
  }
  return least < -tolerance ? Verdict::hit : least > tolerance ? Verdict::miss : Verdict::tangent;
}

}  // namespace caplet::reference
