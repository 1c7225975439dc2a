// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/covered_ends.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "base/check.h"
#include "shared/shapes.h"

namespace caplet {

namespace {

using glm::dvec3;

// Covers are stated in this many parts of a cap's heights.
constexpr int steps = 255;
// Only this many capsules that begin at one point are considered, the thickest first.
constexpr std::size_t most_at_a_point = 32;

/// CoveredCapsule is a tapered capsule of which no end holds the other. Its surface is a cap where
/// n . d
/// <= s, a cone, and a cap where n . d >= s.
struct CoveredCapsule {
  std::array<dvec3, 2> p;
  std::array<double, 2> r;
  dvec3 d;
  double length, s;
};

/// End is one end of a capsule, or a sphere. `into`: along the axis, into the capsule. The end's
/// cap has the normals with n . into <= s.
struct End {
  std::array<std::uint32_t, 3> key;
  float radius;
  std::array<float, 3> into;
  float s;  // a sphere: above 1
  std::uint32_t emitter, which;

  /// Ends are ordered by place, and at one place the thickest comes first.
  friend bool operator<(const End& a, const End& b) {
    if (a.key != b.key) return a.key < b.key;
    if (a.radius != b.radius) return a.radius > b.radius;
    return std::tie(a.emitter, a.which) < std::tie(b.emitter, b.which);
  }
};

class Primitive {
 public:
  Primitive(const Emitter& emitter, const FlatScene& flat)
      : leaves_(flat.leaves),
        slot_(emitter.slot),
        shape_(flat.geometries[emitter.geometry].shape) {}

  bool is_sphere() const { return shape_ == shape_sphere; }
  dvec3 center() const { return vector(sphere_at_c); }
  double radius() const { return datum(sphere_at_r); }

  std::optional<CoveredCapsule> capsule() const {
    CoveredCapsule out;
    if (shape_ == shape_capsule)
      out = {{vector(capsule_at_p0), vector(capsule_at_p1)},
             {datum(capsule_at_r), datum(capsule_at_r)},
             {},
             0,
             0};
    else if (shape_ == shape_tapered_capsule)
      out = {{vector(tapered_capsule_at_p0), vector(tapered_capsule_at_p1)},
             {datum(tapered_capsule_at_r0), datum(tapered_capsule_at_r1)},
             {},
             0,
             0};
    else
      return {};
    out.length = glm::length(out.p[1] - out.p[0]);
    if (!(out.length > std::abs(out.r[0] - out.r[1]))) return {};
    out.d = (out.p[1] - out.p[0]) / out.length;
    out.s = (out.r[0] - out.r[1]) / out.length;
    return out;
  }

 private:
  double datum(std::uint32_t field) const { return leaves_[slot_ + 8 * (std::size_t{field} + 1)]; }
  dvec3 vector(std::uint32_t field) const {
    return {datum(field), datum(field + 1), datum(field + 2)};
  }

  const std::vector<float>& leaves_;
  const std::size_t slot_;
  const std::uint32_t shape_;
};

std::array<std::uint32_t, 3> key_of(const dvec3& p) {
  std::array<std::uint32_t, 3> out;
  // 0 has two forms.
  for (int k = 0; k < 3; ++k)
    out[static_cast<std::size_t>(k)] =
        std::bit_cast<std::uint32_t>(static_cast<float>(p[k]) + 0.0f);
  return out;
}

/// Returns whether scattered rays find everything that light samples leave out, and all is seen
/// from outside.
bool may_be_covered(const Emitter& emitter, const FlatScene& flat) {
  const GeometryRecord& geometry = flat.geometries[emitter.geometry];
  return !emitter.two_sided && !emitter.unseen && !emitter.by_ball &&
         geometry.alpha == CAPLET_NONE && (geometry.flags & CAPLET_GEOMETRY_FLIP_NORMAL) == 0;
}

/// EndCover is the part of an end that another capsule covers.
struct EndCover {
  double angle = 0;   // between its axis into the other capsule and the end's outward axis
  double s = -1;      // the other's End::s; -1: it covers nothing
  double deeper = 0;  // by how much the other's radius is greater
};
using EndCovers = std::vector<std::array<EndCover, 2>>;  // by emitter

/// Returns the share of an end's heights that stays uncovered. The other covers normals at less
/// than acos(s) from its axis. Rays still find what it covers by less than `rounding`, the error of
/// hits: on an end of radius r this is the last sqrt(2 rounding / r) of the angle, at which a
/// sphere has left its tangent cone by r angle^2 / 2.
double open_share(const EndCover& cover, double s, double radius, double rounding) {
  if (cover.s <= -1) return 1;
  if (cover.deeper > rounding) return 0;
  const double covered =
      std::acos(std::clamp(cover.s, -1.0, 1.0)) - std::sqrt(2 * rounding / radius);
  const double highest = std::cos(std::max(0.0, covered - cover.angle));
  return std::clamp((highest + s) / (1 + s), 0.0, 1.0);
}

/// Returns the cover by that one of the other ends at the same point (the thickest first) which
/// covers most of `end`.
EndCover best_cover(const End& end, std::span<const End> others) {
  EndCover best;
  double least = 2;
  for (const End& other : others) {
    if (other.radius < end.radius) break;
    if (other.emitter == end.emitter) continue;
    double cosine = 0;
    for (std::size_t k = 0; k < 3; ++k)
      cosine -= static_cast<double>(end.into[k]) * static_cast<double>(other.into[k]);
    const EndCover cover{std::acos(std::clamp(cosine, -1.0, 1.0)), static_cast<double>(other.s),
                         static_cast<double>(other.radius) - static_cast<double>(end.radius)};
    // A sphere of the same radius covers nothing.
    if (other.s > 1 && !(cover.deeper > 0)) continue;
    const double open =
        open_share(cover, static_cast<double>(end.s), static_cast<double>(end.radius), 0);
    if (open < least) {
      least = open;
      best = cover;
    }
  }
  return best;
}

EndCovers covers_of_part(std::span<const Emitter> emitters, const FlatScene& flat) {
  EndCovers out(emitters.size());
  std::vector<End> ends;
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    if (!may_be_covered(emitters[i], flat)) continue;
    const Primitive primitive(emitters[i], flat);
    const auto index = narrow<std::uint32_t>(i);
    if (primitive.is_sphere()) {
      ends.push_back(
          {key_of(primitive.center()), static_cast<float>(primitive.radius()), {}, 2, index, 0});
    } else if (const std::optional<CoveredCapsule> c = primitive.capsule()) {
      for (const std::uint32_t which : {0u, 1u}) {
        const double sign = which == 0 ? 1 : -1;
        const dvec3 into = sign * c->d;
        ends.push_back(
            {key_of(c->p[which]),
             static_cast<float>(c->r[which]),
             {static_cast<float>(into.x), static_cast<float>(into.y), static_cast<float>(into.z)},
             static_cast<float>(sign * c->s),
             index,
             which});
      }
    }
  }
  tbb::parallel_sort(ends.begin(), ends.end());
  for (auto first = ends.begin(); first != ends.end();) {
    const auto last =
        std::find_if(first, ends.end(), [&](const End& end) { return end.key != first->key; });
    const std::span others(
        first, static_cast<std::size_t>(std::min<std::ptrdiff_t>(last - first, most_at_a_point)));
    for (auto end = first; end != last; ++end)
      if (end->s <= 1) out[end->emitter][end->which] = best_cover(*end, others);
    first = last;
  }
  return out;
}

/// Returns the cover, rounded up by a step or less.
LightCover cover_of(const CoveredCapsule& c, const std::array<EndCover, 2>& ends, double rounding) {
  // These are areas over 2 pi: a cap has r^2 times its heights, the cone the mean circumference of
  // its ends times its slant.
  const double cone = 0.5 * (c.r[0] + c.r[1]) * (1 - c.s * c.s) * c.length;
  double whole = cone, left = cone;
  LightCover out;
  for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
    const double s = which == 0 ? c.s : -c.s;
    const int open = std::min(
        steps, static_cast<int>(open_share(ends[which], s, c.r[which], rounding) * steps) + 1);
    const double cap = c.r[which] * c.r[which] * (1 + s);
    whole += cap;
    left += cap * open / steps;
    out.flags |= static_cast<std::uint32_t>(steps - open)
                 << (which == 0 ? CAPLET_LIGHT_COVER_0 : CAPLET_LIGHT_COVER_1);
  }
  out.share = left / whole;
  return out;
}

/// Returns about how far apart, in the space of an emitter's instance, a ray across the scene may
/// find surfaces that are at one place: four roundings of the largest coordinate and of the ray's
/// length. The bound matters for noise alone.
double rounding_in(std::uint32_t instance, const FlatScene& flat) {
  const WorldRecord& world = flat.world;
  const double reach = std::abs(double{world.center_x}) + std::abs(double{world.center_y}) +
                       std::abs(double{world.center_z}) + 2 * double{world.radius};
  double scale = 1;
  if (instance != CAPLET_NONE) {
    scale = 0;
    const float* m = flat.instances[instance].object_from_world;
    for (std::size_t row = 0; row < 12; row += 4)
      scale = std::max(scale, double{std::abs(m[row])} + double{std::abs(m[row + 1])} +
                                  double{std::abs(m[row + 2])});
  }
  return 4 * 0x1p-24 * reach * scale;
}

}  // namespace

std::vector<LightCover> covered_ends(const std::vector<Emitter>& emitters, const FlatScene& flat) {
  std::vector<LightCover> out(emitters.size());
  // The emitters of a part follow each other, in the same order wherever it is placed.
  std::map<std::uint32_t, EndCovers> of_parts;  // by the first one's slot
  for (std::size_t begin = 0; begin < emitters.size();) {
    const std::uint32_t instance = emitters[begin].instance;
    std::size_t end = begin;
    while (end < emitters.size() && emitters[end].instance == instance) ++end;
    EndCovers& covers = of_parts[emitters[begin].slot];
    if (covers.size() != end - begin)
      covers = covers_of_part(std::span(emitters).subspan(begin, end - begin), flat);
    const double rounding = rounding_in(instance, flat);
    for (std::size_t i = begin; i < end; ++i) {
      const std::array<EndCover, 2>& ends = covers[i - begin];
      if (ends[0].s > -1 || ends[1].s > -1)
        out[i] = cover_of(*Primitive(emitters[i], flat).capsule(), ends, rounding);
    }
    begin = end;
  }
  return out;
}

}  // namespace caplet
