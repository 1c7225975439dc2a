// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Compares crossings primitive by primitive: whether a displacement of the primitive by at most its
// bound explains a difference does not depend on other primitives.
#include "verify/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <limits>

namespace caplet::verify {

namespace {

using glm::dmat3;
using glm::dvec2;
using glm::dvec3;
using reference::SceneHit;

dvec3 to_dvec3(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

double ulp_of(double x) {
  const float at = std::abs(static_cast<float>(x));
  return static_cast<double>(std::nextafter(at, HUGE_VALF)) - static_cast<double>(at);
}

/// Recognises open shapes: only their normal, which ReverseOrientation turns, distinguishes
/// entering from leaving.
bool is_sheet(const reference::Primitive& primitive) {
  return !reference::is_solid(primitive) && !std::holds_alternative<reference::Frustum>(primitive);
}

bool begins_at(const LocalRay& local) { return std::abs(local.value(0)) <= local.bound; }

/// Collects t of all crossings of the solids of a csg shape.
void collect_crossings(const reference::Csg& csg, const reference::Ray& ray,
                       std::vector<double>& out) {
  for (const reference::CsgOperand& operand : csg.body->operands) {
    const glm::dmat4& m = operand.operand_from_csg;
    const reference::Ray local{dvec3(m * glm::dvec4(ray.origin, 1)),
                               dvec3(m * glm::dvec4(ray.direction, 0)), 0, HUGE_VAL};
    if (const auto* nested = std::get_if<reference::Csg>(&operand.primitive))
      collect_crossings(*nested, local, out);
    else
      for (const reference::Crossing& crossing : reference::crossings(operand.primitive, local))
        out.push_back(crossing.t);
  }
}

/// Csg shapes treat walls and gaps thinner than the bounds of both sides as closed, and may see one
/// where solids just touch.
bool has_thin_wall(const reference::Csg& csg, const LocalRay& local) {
  std::vector<double> events;
  collect_crossings(csg, local.ray, events);
  std::ranges::sort(events);
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    double deepest = 0;
    for (int k = 0; k <= 16; ++k)
      deepest = std::max(deepest,
                         std::abs(local.value(events[i] + (events[i + 1] - events[i]) * k / 16)));
    if (deepest <= 2 * local.bound) return true;
  }
  return false;
}

/// Patches reach beyond their borders by up to the bound, so beyond a corner of the angle a by the
/// bound over sin(a / 2). Returns the greatest of these factors, at least 1; corners that another
/// border cuts off by less than the bound count too. Borders of tori meet at right angles.
double reach_of_corners(const reference::MolecularPatch& patch, double bound) {
  double least_sine = 1;
  const auto& planes = patch.planes;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const dvec3 &a = planes[i].normal, &b = planes[j].normal, across = glm::cross(a, b);
      const double cosine = glm::dot(a, b), squared = glm::dot(across, across);
      if (!(squared > 0)) continue;
      const dvec3 foot = ((planes[i].offset - cosine * planes[j].offset) * a +
                          (planes[j].offset - cosine * planes[i].offset) * b) /
                         squared;
      const double room = (patch.minor * patch.minor - glm::dot(foot, foot)) / squared;
      for (const double side : {-1.0, 1.0}) {
        if (!(room >= 0)) continue;
        const dvec3 corner = foot + side * std::sqrt(room) * across;
        const bool is_of_patch =
            std::ranges::all_of(planes, [&](const reference::MolecularPatch::Plane& plane) {
              return glm::dot(plane.normal, corner) <= plane.offset + bound;
            });
        if (!is_of_patch) continue;
        const dvec3 up = glm::normalize(corner), along_a = glm::cross(up, a),
                    along_b = glm::cross(up, b);
        const double cosine_of_normals =
            glm::dot(along_a, along_b) / (glm::length(along_a) * glm::length(along_b));
        least_sine = std::min(least_sine, std::sqrt(std::max(0.0, 0.5 * (1 + cosine_of_normals))));
      }
    }
  return 1 / std::max(1e-6, least_sine);
}

/// Returns whether both answers are right: the ray begins at the surface, the line touches it or
/// passes a rim, all within the bound. For csg shapes, it is enough that this holds for one of
/// their solids.
bool is_grazing(const LocalRay& local) {
  if (begins_at(local)) return true;
  if (const auto* patch = std::get_if<reference::MolecularPatch>(local.primitive))
    return reference::comes_within(*local.primitive, local.ray,
                                   local.bound * reach_of_corners(*patch, local.bound));
  const auto* csg = std::get_if<reference::Csg>(local.primitive);
  if (!csg) return reference::comes_within(*local.primitive, local.ray, local.bound);
  for (const reference::CsgOperand& operand : csg->body->operands) {
    const glm::dmat4& m = operand.operand_from_csg;
    const reference::Ray ray{dvec3(m * glm::dvec4(local.ray.origin, 1)),
                             dvec3(m * glm::dvec4(local.ray.direction, 0)), 0, HUGE_VAL};
    if (is_grazing({&operand.primitive, ray, local.bound * operand.stretch})) return true;
  }
  return has_thin_wall(*csg, local) ||
         reference::comes_within(*local.primitive, local.ray, local.bound);
}

/// Returns the greatest distance of the ray from the surface between two parameters of one
/// crossing, in bounds. The ray may pass the hole or the gap of a partial disk there; its distance
/// from the disk's plane is greatest at an end.
double apart(const LocalRay& local, double t, double other) {
  const double at_end = std::abs(local.value(t));
  if (std::holds_alternative<reference::PartialDisk>(*local.primitive)) return at_end / local.bound;
  return std::max(at_end, std::abs(local.value(0.5 * (t + other)))) / local.bound;
}

/// Returns the least and greatest of `f` at x and the corners of an octahedron that contains the
/// ball of radius `reach` around x.
template <class T, class F>
std::pair<T, T> range_around(const dvec3& x, double reach, const F& f) {
  T low = f(x), high = low;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.7320508075688772, 1.7320508075688772}) {
      dvec3 moved = x;
      moved[axis] += side * reach;
      const T here = f(moved);
      low = glm::min(low, here);
      high = glm::max(high, here);
    }
  return {low, high};
}

/// The solid that a surface belongs to; for csg shapes, this is the operand.
struct Solid {
  const reference::Primitive* primitive;
  glm::dmat4 object_from_world;
  double stretch;  // from the primitive's space to the solid's
  int surface;     // of the solid
};
Solid solid_of(const reference::SceneReference::PlacedPrimitive& placed, std::uint32_t surface) {
  Solid out{&placed.primitive, placed.object_from_world, 1, static_cast<int>(surface)};
  while (const auto* csg = std::get_if<reference::Csg>(out.primitive)) {
    const auto& operands = csg->body->operands;
    const auto after = std::ranges::find_if(
        operands, [&](const auto& operand) { return operand.surface_begin > out.surface; });
    const reference::CsgOperand& operand = *std::prev(after);
    out = {&operand.primitive, operand.operand_from_csg * out.object_from_world,
           out.stretch * operand.stretch, out.surface - operand.surface_begin};
  }
  return out;
}

/// Bounds the error of v of a chain whose axis and ray are off by `angle` (radians): both define
/// the direction across, which is undefined where they are parallel.
double turn_of_v(const reference::Primitive& primitive, const dvec3& direction, double angle) {
  const auto* capsule = std::get_if<reference::Capsule>(&primitive);
  if (!capsule || !capsule->u) return 0;
  const double length = glm::length(capsule->p1 - capsule->p0),
               growth = std::abs(capsule->radius1 - capsule->radius0);
  const dvec3 axis = length > 0 ? (capsule->p1 - capsule->p0) / length : dvec3(0, 0, 1);
  const double sine = glm::length(glm::cross(direction, axis)) / glm::length(direction);
  const double cosine =
      length > growth ? std::sqrt((length - growth) * (length + growth)) / length : 1;
  return std::min(1.0, angle / std::max(sine * cosine, 1e-300));
}

}  // namespace

struct Comparison::Pair {
  std::size_t primitive;
  std::vector<const SceneHit*> expected;
  std::vector<const PickRecord*> found;
};

Comparison::Comparison(const Scene& scene, const reference::SceneReference& reference,
                       bool is_moving)
    : scene_(scene), reference_(reference), bounds_(reference, is_moving) {}

Expected Comparison::expected(const RayRecord& r) const {
  Expected out;
  out.ray = {{r.ox, r.oy, r.oz}, {r.dx, r.dy, r.dz}, r.t_min, r.t_max};
  out.hits = reference_.all(out.ray, out.near);
  return out;
}

/// Returns the reference's index of the device's primitive; no_primitive where the scene has no
/// such primitive.
std::size_t Comparison::primitive_of(const PickRecord& pick) const {
  const std::size_t in_world = scene_.shapes.size();
  std::optional<std::size_t> index;
  if (pick.object < in_world) {
    if (pick.shape == pick.object)
      index = reference_.index_of(reference::no_instance, pick.shape, pick.primitive);
  } else if (pick.shape >= in_world) {
    // The numbers of an object's shapes continue those of the world's (lower/identity.h).
    index = reference_.index_of(static_cast<std::uint32_t>(pick.object - in_world),
                                static_cast<std::uint32_t>(pick.shape - in_world), pick.primitive);
  }
  return index.value_or(no_primitive);
}

/// Returns the name for messages: "capsule 7 of shape 2 of instance 3: ".
std::string Comparison::name_of(std::size_t primitive) const {
  const auto placed = reference_.placed(primitive);
  const SceneHit& id = placed.identity;
  std::string out =
      fmt::format("{} {} of shape {}", reference::kind_names[reference::kind_of(placed.primitive)],
                  id.primitive, id.shape);
  if (id.instance != reference::no_instance) out += fmt::format(" of instance {}", id.instance);
  return out + ": ";
}

Match Comparison::measure(const LocalRay& local, const SceneHit& hit, const PickRecord& pick,
                          const reference::Ray& ray) const {
  const Solid solid = solid_of(reference_.placed(hit.index), pick.surface);
  const reference::Primitive& primitive = *solid.primitive;
  const double t = pick.t;
  Match out{hit.index, {}};
  const auto set = [&](Quantity q, double off, double allowed, double ulp) {
    // NaN counts as an infinite deviation.
    out.deviations[static_cast<std::size_t>(q)] =
        std::isfinite(off) ? Deviation{off / allowed, off / ulp} : Deviation{HUGE_VAL, HUGE_VAL};
  };
  set(Quantity::t, apart(local, t, hit.t), 1, 1);
  out.deviations[0].in_ulps = std::abs(t - hit.t) / ulp_of(hit.t);

  const dvec3 point = to_dvec3(pick.point), x(solid.object_from_world * glm::dvec4(point, 1));
  // A point of the surface lies within this distance of x, and the normal may be that of any point
  // as close.
  const double error = static_cast<double>(pick.error) + bounds_.rounding(hit.index);
  const double reach = error * bounds_.stretch(hit.index) * solid.stretch;
  const dmat3 normal_matrix = glm::transpose(dmat3(solid.object_from_world));
  const glm::dmat4 world_from_object = glm::inverse(solid.object_from_world);
  const auto world_normal = [&](const dvec3& there) {
    return glm::normalize(normal_matrix *
                          reference::normal_of_surface(primitive, there, solid.surface, reach));
  };
  // The gradient of the value in the world is the transposed matrix's image of its gradient here.
  const double largest = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
  // Molecular patches reach beyond their borders by what depends on the ray.
  const double off_surface = std::holds_alternative<reference::MolecularPatch>(primitive)
                                 ? reference::distance_from_surface(primitive, x, solid.surface)
                                 : std::abs(reference::value(primitive, x));
  set(Quantity::point,
      off_surface / glm::length(normal_matrix * reference::normal_at(primitive, x, reach)), error,
      ulp_of(largest));

  const dvec3 own = to_dvec3(pick.normal), unit = world_normal(x);
  // The device's arithmetic contributes: a unit vector by a square root and quotients (16 eps), the
  // sine and cosine of a cone (16), then a matrix and normalisation.
  double allowed = bounds_.tilt(hit.index) + (32 + 8 * bounds_.condition(hit.index)) * eps;
  double off = std::min(glm::length(own - unit), glm::length(own + unit));
  if (!(off <= 0.25 * allowed)) {
    // On a curved surface, the normal may also change within the point's error.
    const auto [low, high] = range_around<dvec3>(x, reach, world_normal);
    allowed += glm::length(high - low);
  }
  // The normal must point against the ray.
  off = std::max(off, glm::dot(own, ray.direction) / glm::length(ray.direction));
  set(Quantity::normal, off, allowed, 0x1p-23);

  const auto uv_there = [&](const dvec3& there) {
    return reference_.uv({.surface = pick.surface, .index = hit.index},
                         dvec3(world_from_object * glm::dvec4(there, 1)), ray.direction);
  };
  const dvec2 own_uv{pick.u, pick.v}, uv = uv_there(x);
  const auto apart_by = [](const dvec2& a, const dvec2& b) {
    return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
  };
  // A uv takes half a dozen operations on numbers of its size, including an arc tangent (6 ulp);
  // the frame of the angles, with a quotient that makes the rounding of an axis (4 eps) up to ten
  // times larger; and 1 / 2 pi of that.
  double allowed_uv =
      64 * eps * std::max({1.0, std::abs(uv.x), std::abs(uv.y)}) + bounds_.tilt(hit.index) +
      turn_of_v(primitive, dmat3(solid.object_from_world) * ray.direction,
                bounds_.tilt(hit.index) + (32 + 8 * bounds_.condition(hit.index)) * eps);
  if (!(apart_by(own_uv, uv) <= 0.25 * allowed_uv)) {
    const auto [least, most] = range_around<dvec2>(x, reach, uv_there);
    // At poles, centres and seams u may take any value of its range.
    allowed_uv += most.x - least.x > 0.24 ? std::max(1.0, most.x - least.x) : apart_by(least, most);
  }
  set(Quantity::uv, apart_by(own_uv, uv), allowed_uv, 0x1p-23);
  return out;
}

void Comparison::compare_primitive(const Expected& expected, Pair& pair, Outcome& out) const {
  const LocalRay local = bounds_.local(pair.primitive, expected.ray);
  const bool sheet = is_sheet(*local.primitive),
             turned = sheet && reference_.is_reversed(pair.primitive);
  const auto disagree = [&](Fault fault, const std::string& text) {
    out.disagreements.push_back({fault, pair.primitive, name_of(pair.primitive) + text});
  };

  // Rounding may decide which crossings exist, but not the properties reported for each.
  std::string different;
  Fault fault = Fault::hit;
  if (pair.expected.size() != pair.found.size()) {
    different = "crossings at";
    for (const PickRecord* pick : pair.found) different += fmt::format(" {}", pick->t);
    different += pair.found.empty() ? " no t; the reference says" : "; the reference says";
    for (const SceneHit* hit : pair.expected) different += fmt::format(" {}", hit->t);
    if (pair.expected.empty()) different += " none";
  }
  const auto is_leaving = [&](const SceneHit* hit) { return hit->leaving != turned; };
  for (std::size_t k = 0; different.empty() && k < pair.found.size(); ++k) {
    const bool leaving = pair.found[k]->leaving != 0;
    // Where a sheet is folded closer than the bound, either of its sides may come first.
    if (sheet && is_leaving(pair.expected[k]) != leaving) {
      const auto other =
          std::find_if(pair.expected.begin() + static_cast<std::ptrdiff_t>(k), pair.expected.end(),
                       [&](const SceneHit* hit) { return is_leaving(hit) == leaving; });
      if (other != pair.expected.end() && apart(local, pair.found[k]->t, (*other)->t) <= 1)
        std::swap(pair.expected[k], *other);
    }
    const double t = pair.found[k]->t, by_reference = pair.expected[k]->t,
                 off = apart(local, t, by_reference);
    if (!(off <= 1)) {
      fault = Fault::t;
      different = fmt::format(
          "the crossing at {}, at {} by the reference, is off by {:.3g} of what is allowed", t,
          by_reference, off);
    } else if (leaving != is_leaving(pair.expected[k])) {
      fault = Fault::side;
      different = fmt::format("the crossing at {} is {}, the reference says otherwise", t,
                              leaving ? "leaving" : "entering");
    }
  }
  const bool matched = different.empty();
  if (!matched) {
    if (std::ranges::count(out.grazed, pair.primitive) == 0 && !is_grazing(local)) {
      disagree(fault, fmt::format("{}; margin {:.3g}, bound {:.3g}", different,
                                  reference::margin(*local.primitive, local.ray), local.bound));
      return;
    }
    out.grazed.push_back(pair.primitive);
  }

  for (std::size_t k = 0; k < pair.found.size(); ++k) {
    const PickRecord& pick = *pair.found[k];
    const double t = pick.t;
    SceneHit hit = matched ? *pair.expected[k] : reference_.placed(pair.primitive).identity;
    if (!matched) hit.t = t;
    if (!matched || pick.surface != hit.surface) {
      const double away = reference::distance_from_surface(
          *local.primitive, local.ray.origin + t * local.ray.direction,
          static_cast<int>(pick.surface));
      // A ray along an open surface may hit it beside its edge.
      if (!(away <= 2 * local.bound) && !(sheet && !matched && pick.surface == 0))
        disagree(Fault::surface,
                 fmt::format("surface {} at {} is {} away (bound {}), the reference says {}",
                             pick.surface, t, away, local.bound,
                             matched ? std::to_string(hit.surface) : "otherwise"));
    }
    if (const std::uint32_t material = reference_.material(pair.primitive, pick.surface);
        pick.material != material)
      disagree(Fault::material,
               fmt::format("material {} of surface {} at {}, the reference says {}", pick.material,
                           pick.surface, t, material));
    Match& match = out.matches.emplace_back(measure(local, hit, pick, expected.ray));
    if (!matched && sheet) match.deviations[0] = {};
    constexpr std::array faults = {Fault::t, Fault::point, Fault::normal, Fault::uv};
    for (std::size_t q = 0; q < quantity_names.size(); ++q)
      if (!(match.deviations[q].in_bounds <= 1))
        disagree(faults[q], fmt::format("{} at t {} is off by {:.3g} of what is allowed",
                                        quantity_names[q], t, match.deviations[q].in_bounds));
  }
}

/// The nearest crossing must lie where its primitive has one, and earlier crossings of the
/// reference must be within the bounds.
void Comparison::compare_nearest(const Expected& expected, const PickRecord& nearest,
                                 Outcome& out) const {
  const bool hit = nearest.object != CAPLET_NONE;
  const std::size_t own = hit ? primitive_of(nearest) : no_primitive;
  const double t = hit ? static_cast<double>(nearest.t) : HUGE_VAL;
  if (hit && own == no_primitive) {
    out.disagreements.push_back(
        {Fault::id, no_primitive,
         fmt::format("the nearest hit is on object {} shape {} primitive {}: there is none",
                     nearest.object, nearest.shape, nearest.primitive)});
    return;
  }
  const auto excuse = [&](std::size_t primitive) {
    const bool grazing = is_grazing(bounds_.local(primitive, expected.ray));
    if (grazing) out.grazed.push_back(primitive);
    return grazing;
  };
  if (hit) {
    const LocalRay local = bounds_.local(own, expected.ray);
    double least = HUGE_VAL;
    for (const SceneHit& other : expected.hits)
      if (other.index == own) least = std::min(least, apart(local, t, other.t));
    if (!(t > 0) || !(least <= 1)) {
      if (!excuse(own)) {
        out.disagreements.push_back(
            {Fault::hit, own,
             name_of(own) +
                 fmt::format("the nearest hit is at {}, where the reference has no crossing of it",
                             t)});
        return;
      }
    }
  }
  for (const SceneHit& other : expected.hits) {
    if (!(other.t < t)) break;
    if (other.index == own && hit && apart(bounds_.local(own, expected.ray), t, other.t) <= 1)
      continue;
    if (hit && apart(bounds_.local(other.index, expected.ray), t, other.t) <= 1) continue;
    if (excuse(other.index)) continue;
    const std::string text =
        hit ? fmt::format("the nearest hit is at {}", t) : std::string("the ray misses");
    out.disagreements.push_back(
        {hit ? Fault::order : Fault::hit, other.index,
         name_of(other.index) + text +
             fmt::format("; the reference has a crossing of it at {}", other.t)});
    return;
  }
}

Outcome Comparison::compare(const Expected& expected, const Found& found) const {
  Outcome out;
  compare_nearest(expected, found.nearest, out);
  std::vector<Pair> pairs;
  const auto pair_of = [&](std::size_t primitive) -> Pair& {
    const auto it = std::ranges::find(pairs, primitive, &Pair::primitive);
    return it != pairs.end() ? *it : pairs.emplace_back(Pair{primitive, {}, {}});
  };
  for (const SceneHit& hit : expected.hits) pair_of(hit.index).expected.push_back(&hit);
  double last = 0;
  for (const PickRecord& pick : found.list) {
    const double t = pick.t;
    if (!(t > 0 && t >= last && t < HUGE_VAL))
      out.disagreements.push_back({Fault::order, no_primitive,
                                   fmt::format("a crossing at {} comes after one at {}", t, last)});
    last = t;
    const std::size_t primitive = primitive_of(pick);
    if (primitive == no_primitive)
      out.disagreements.push_back(
          {Fault::id, no_primitive,
           fmt::format("a crossing at {} is on object {} shape {} primitive {}: there is none", t,
                       pick.object, pick.shape, pick.primitive)});
    else
      pair_of(primitive).found.push_back(&pick);
  }
  for (Pair& pair : pairs) compare_primitive(expected, pair, out);
  std::ranges::sort(out.grazed);
  out.grazed.erase(std::unique(out.grazed.begin(), out.grazed.end()), out.grazed.end());
  return out;
}

}  // namespace caplet::verify
