// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/ribbon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "base/check.h"

namespace caplet {

namespace {

using glm::dvec3;

constexpr double kTransition = 0.6;  // of a residue: the length of the change from a coil
constexpr std::uint32_t kCapRings = 4;

/// A place of the curve with its axes: across the ribbon, out of its plane, and along it.
struct Station {
  double t = 0;
  dvec3 place{0}, across{0}, out{0}, along{0};
  RibbonSection section;
};

/// A ring of points around a station and the normals of its section.
struct Ring {
  std::vector<dvec3> points, normals;
};

double smooth_step(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * (3 - 2 * x);
}

RibbonSection mixed(const RibbonSection& a, const RibbonSection& b, double part) {
  return {std::lerp(a.half_width, b.half_width, part),
          std::lerp(a.half_height, b.half_height, part), std::lerp(a.corner, b.corner, part)};
}

/// Returns any unit vector across `along`.
dvec3 any_across(const dvec3& along) {
  const dvec3 axis = std::abs(along.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(glm::cross(along, axis));
}

class RibbonMesher {
 public:
  RibbonMesher(std::span<const RibbonGuide> guides, const RibbonDetail& detail)
      : guides_(guides),
        detail_(detail),
        places_(each_of(&RibbonGuide::place)),
        sides_(each_of(&RibbonGuide::side)) {
    for (std::uint32_t corner = 0; corner < 4; ++corner)
      for (std::uint32_t i = 0; i < detail.corner_points; ++i) {
        const double angle =
            std::numbers::pi / 2 *
            (corner + static_cast<double>(i) / static_cast<double>(detail.corner_points - 1));
        // At the ends of corners the sine or cosine is exactly 0, so that corners without a flat
        // between them share a point.
        const bool is_end = i == 0 || i + 1 == detail.corner_points;
        const double cosine = is_end ? std::round(std::cos(angle)) : std::cos(angle),
                     sine = is_end ? std::round(std::sin(angle)) : std::sin(angle);
        turns_.push_back(
            {cosine, sine, corner == 0 || corner == 3 ? 1.0 : -1.0, corner < 2 ? 1.0 : -1.0});
      }
  }

  std::vector<TriangleMeshShape> meshes() {
    make_stations();
    std::vector<TriangleMeshShape> out;
    out.reserve(guides_.size());
    for (std::size_t i = 0; i < guides_.size(); ++i) out.push_back(mesh_of(i));
    return out;
  }

 private:
  /// A point of a section: the direction from its corner's centre, and the corner's signs.
  struct Turn {
    double cosine, sine, sign_across, sign_out;
  };

  std::vector<dvec3> each_of(dvec3 RibbonGuide::*member) const {
    std::vector<dvec3> out;
    out.reserve(guides_.size());
    for (const RibbonGuide& guide : guides_) out.push_back(guide.*member);
    return out;
  }

  bool is_kind(std::size_t i, std::ptrdiff_t step, Secondary kind) const {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) + step;
    return at >= 0 && at < std::ssize(guides_) &&
           guides_[static_cast<std::size_t>(at)].kind == kind;
  }
  /// Returns whether guide i is the last of a strand.
  bool is_head(std::size_t i) const {
    return guides_[i].kind == Secondary::strand && !is_kind(i, 1, Secondary::strand);
  }
  double begin_of(std::size_t i) const { return i == 0 ? 0 : static_cast<double>(i) - 0.5; }
  double end_of(std::size_t i) const {
    return i + 1 == guides_.size() ? static_cast<double>(i) : static_cast<double>(i) + 0.5;
  }

  /// Returns the section of guide i at t, which is in its part of the curve.
  RibbonSection section(std::size_t i, double t) const {
    const Secondary kind = guides_[i].kind;
    if (kind == Secondary::coil) return coil_section;
    const RibbonSection& full = kind == Secondary::helix ? helix_section : strand_section;
    if (is_head(i))
      return mixed(arrow_section, coil_section, (t - begin_of(i)) / (end_of(i) - begin_of(i)));
    double part = 1;
    if (i > 0 && !is_kind(i, -1, kind)) part = smooth_step((t - begin_of(i)) / kTransition);
    if (i + 1 < guides_.size() && !is_kind(i, 1, kind))
      part = std::min(part, smooth_step((end_of(i) - t) / kTransition));
    return mixed(coil_section, full, part);
  }

  std::size_t pieces_of(std::size_t i) const {
    const bool is_half = i == 0 || i + 1 == guides_.size();
    return is_half ? std::max<std::size_t>(detail_.pieces / 2, 1) : detail_.pieces;
  }

  /// Makes the stations of all guides; first_[i] is the first one of guide i. Those on a border are
  /// made for both guides, with the same axes.
  void make_stations() {
    dvec3 last(0);
    for (std::size_t i = 0; i < guides_.size(); ++i) {
      first_.push_back(stations_.size());
      const std::size_t pieces = pieces_of(i);
      for (std::size_t k = 0; k <= pieces; ++k) {
        Station one;
        const double part = static_cast<double>(k) / static_cast<double>(pieces);
        one.t = std::lerp(begin_of(i), end_of(i), part);
        if (k == 0 && i > 0) {
          one = stations_.back();
        } else {
          one.place = places_.at(one.t);
          const dvec3 along = places_.derivative(one.t);
          const double speed = glm::length(along);
          one.along = speed > 0 ? along / speed : last == dvec3(0) ? dvec3(0, 0, 1) : last;
          const dvec3 side = sides_.at(one.t),
                      across = side - glm::dot(side, one.along) * one.along;
          const double size = glm::length(across);
          // A side that is nearly along the curve says nothing: the ribbon goes on without a turn.
          if (size > 1e-3 * glm::length(side)) {
            one.across = across / size;
          } else {
            const dvec3 before = stations_.empty() ? dvec3(0) : stations_.back().across;
            const dvec3 carried = before - glm::dot(before, one.along) * one.along;
            const double left = glm::length(carried);
            one.across = left > 1e-3 ? carried / left : any_across(one.along);
          }
          one.out = glm::cross(one.along, one.across);
          last = one.along;
        }
        one.section = section(i, one.t);
        stations_.push_back(one);
      }
    }
    first_.push_back(stations_.size());
  }

  Ring ring(const Station& at) const {
    Ring out;
    for (const Turn& turn : turns_) {
      const dvec3 normal = turn.cosine * at.across + turn.sine * at.out;
      const double corner = at.section.corner, flat_across = at.section.half_width - corner,
                   flat_out = at.section.half_height - corner;
      out.points.push_back(at.place + turn.sign_across * flat_across * at.across +
                           turn.sign_out * flat_out * at.out + corner * normal);
      out.normals.push_back(normal);
    }
    return out;
  }

  /// Returns whether the ribbon has a step between this station and the next: one of a border whose
  /// sections differ.
  bool is_step(std::size_t station) const {
    return station + 1 < stations_.size() && stations_[station].t == stations_[station + 1].t &&
           stations_[station].section.half_width != stations_[station + 1].section.half_width;
  }

  /// Returns a neighbour of a station with another t, on the same side of any step; itself if there
  /// is none.
  std::size_t neighbour(std::size_t station, std::ptrdiff_t step) const {
    std::size_t at = station;
    while (stations_[at].t == stations_[station].t) {
      const std::ptrdiff_t next = static_cast<std::ptrdiff_t>(at) + step;
      if (next < 0 || next >= std::ssize(stations_) ||
          is_step(static_cast<std::size_t>(step < 0 ? next : next - 1)))
        return station;
      at = static_cast<std::size_t>(next);
    }
    return at;
  }

  /// Adds the points of a station's ring with the normals of the surface there.
  void add_ring(std::size_t station, TriangleMeshShape& mesh) const {
    const Ring here = ring(stations_[station]);
    const Ring before = ring(stations_[neighbour(station, -1)]),
               behind = ring(stations_[neighbour(station, 1)]);
    const Station& at = stations_[station];
    for (std::size_t k = 0; k < turns_.size(); ++k) {
      const dvec3 flat = here.normals[k], tangent = glm::cross(at.along, flat),
                  along = behind.points[k] - before.points[k];
      dvec3 normal = glm::cross(tangent, along);
      const double size = glm::length(normal);
      // Where the inside of a bend folds, the surface runs backward: the section's normal is used.
      normal = size > 0 && glm::dot(normal, flat) > 0.1 * size ? normal / size : flat;
      add_point(here.points[k], normal, mesh);
    }
  }

  static void add_point(const dvec3& point, const dvec3& normal, TriangleMeshShape& mesh) {
    mesh.positions.emplace_back(point);
    mesh.normals.emplace_back(normal);
  }

  /// Joins the last two rings of the mesh. Triangles without an area are left out.
  void join_rings(TriangleMeshShape& mesh) const {
    const auto count = narrow<std::uint32_t>(turns_.size());
    const auto second = narrow<std::uint32_t>(mesh.positions.size()) - count;
    const std::uint32_t first = second - count;
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t next = (k + 1) % count;
      add_triangle({first + k, first + next, second + k}, mesh);
      add_triangle({first + next, second + next, second + k}, mesh);
    }
  }
  static void add_triangle(const std::array<std::uint32_t, 3>& corners, TriangleMeshShape& mesh) {
    const auto at = [&](std::size_t i) { return mesh.positions[corners.at(i)]; };
    if (at(0) != at(1) && at(1) != at(2) && at(2) != at(0)) mesh.triangles.push_back(corners);
  }

  /// Adds the face of a step: its rings have the normal of the face.
  void add_step(std::size_t station, TriangleMeshShape& mesh) const {
    for (const std::size_t s : {station, station + 1})
      for (const dvec3& point : ring(stations_[s]).points)
        add_point(point, -stations_[s].along, mesh);
    join_rings(mesh);
  }

  /// Adds a round end: rings that shrink to the middle of the section. `sign` is -1 at the
  /// beginning of the ribbon, whose rings come before the others, and 1 at its end.
  void add_cap(const Station& end, double sign, TriangleMeshShape& mesh) const {
    const double depth = std::min(end.section.half_width, end.section.half_height);
    for (std::uint32_t k = 0; k <= kCapRings; ++k) {
      const double part = static_cast<double>(sign < 0 ? kCapRings - k : k) / kCapRings,
                   angle = std::numbers::pi / 2 * part, less = depth * (1 - std::cos(angle));
      Station one = end;
      one.place += sign * depth * std::sin(angle) * end.along;
      one.section.half_width -= less;
      one.section.half_height -= less;
      // The innermost ring is a line, or a point.
      if (part == 1) {
        one.section.half_width = end.section.half_width - depth;
        one.section.half_height = end.section.half_height - depth;
      }
      one.section.corner = std::clamp(end.section.corner - less, 0.0,
                                      std::min(one.section.half_width, one.section.half_height));
      const Ring round = ring(one);
      for (std::size_t i = 0; i < turns_.size(); ++i)
        add_point(round.points[i],
                  std::cos(angle) * round.normals[i] + sign * std::sin(angle) * end.along, mesh);
      if (k > 0) join_rings(mesh);
    }
  }

  TriangleMeshShape mesh_of(std::size_t i) const {
    TriangleMeshShape mesh;
    if (i == 0) add_cap(stations_.front(), -1, mesh);
    if (i > 0 && is_step(first_[i] - 1)) add_step(first_[i] - 1, mesh);
    for (std::size_t s = first_[i]; s < first_[i + 1]; ++s) {
      add_ring(s, mesh);
      if (s > first_[i]) join_rings(mesh);
    }
    if (i + 1 == guides_.size()) add_cap(stations_.back(), 1, mesh);
    return mesh;
  }

  std::span<const RibbonGuide> guides_;
  RibbonDetail detail_;
  NaturalSpline places_, sides_;
  std::vector<Turn> turns_;
  std::vector<Station> stations_;
  std::vector<std::size_t> first_;
};

}  // namespace

NaturalSpline::NaturalSpline(std::vector<dvec3> points) : points_(std::move(points)) {
  // The second derivatives m solve m[i-1] + 4 m[i] + m[i+1] = 6 (p[i-1] - 2 p[i] + p[i+1]), with 0
  // at both ends: one sweep forward and one back.
  const std::size_t count = points_.size();
  seconds_.assign(count, dvec3(0));
  if (count < 3) return;
  std::vector<double> factor(count, 0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double pivot = 4 - factor[i - 1];
    factor[i] = 1 / pivot;
    seconds_[i] =
        (6.0 * (points_[i - 1] - 2.0 * points_[i] + points_[i + 1]) - seconds_[i - 1]) / pivot;
  }
  for (std::size_t i = count - 2; i > 0; --i) seconds_[i] -= factor[i] * seconds_[i + 1];
}

dvec3 NaturalSpline::at(double t) const {
  if (points_.size() == 1) return points_[0];
  const double last = static_cast<double>(points_.size() - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(t), 0.0, last));
  const double b = t - static_cast<double>(i), a = 1 - b;
  return a * points_[i] + b * points_[i + 1] +
         ((a * a * a - a) * seconds_[i] + (b * b * b - b) * seconds_[i + 1]) / 6.0;
}

dvec3 NaturalSpline::derivative(double t) const {
  if (points_.size() == 1) return dvec3(0);
  const double last = static_cast<double>(points_.size() - 2);
  const auto i = static_cast<std::size_t>(std::clamp(std::floor(t), 0.0, last));
  const double b = t - static_cast<double>(i), a = 1 - b;
  return points_[i + 1] - points_[i] +
         ((1 - 3 * a * a) * seconds_[i] + (3 * b * b - 1) * seconds_[i + 1]) / 6.0;
}

std::vector<TriangleMeshShape> ribbon_meshes(std::span<const RibbonGuide> guides,
                                             const RibbonDetail& detail) {
  CHECK_LE_(std::size_t{2}, guides.size());
  CHECK_LE_(2U, std::min(detail.pieces, detail.corner_points));
  return RibbonMesher(guides, detail).meshes();
}

}  // namespace caplet
