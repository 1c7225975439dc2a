// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random primitives and rays.
#include "cases.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <ostream>

#include "faced.h"
#include "floats.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"
#include "reference/from_scene.h"
#include "shared/kinds.h"

namespace caplet::test {

namespace {

using glm::dvec3;

dvec3 any_perpendicular(const dvec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.7 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

}  // namespace

void CaseSet::renew_references() {
  for (std::size_t i = 0; i < primitives.size(); ++i)
    references[i] = reference_of(primitives[i], leaves);
}

dvec3 CaseMaker::direction() {
  const double z = uniform(-1, 1), phi = uniform(0, full_turn),
               r = std::sqrt(std::max(0.0, 1 - z * z));
  return {r * std::cos(phi), r * std::sin(phi), z};
}

// --- Primitives ---

CaseMaker::Frame CaseMaker::frame(bool hard) {
  Frame f;
  f.r = std::pow(10.0, hard ? uniform(-3, 3) : uniform(-1, 1));
  const double place = !hard || below(3) == 0 ? 3 * f.r : std::pow(10.0, uniform(0, 5));
  f.center = place * dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
  f.axis = direction();
  if (below(8) == 0) f.axis = dvec3(below(3) == 0, 0, 0) + dvec3(0, 0, 1) * double(f.axis.x < 0);
  f.axis = f.axis == dvec3(0) ? dvec3(0, 1, 0) : glm::normalize(f.axis);
  f.length = f.r * std::pow(10.0, hard ? uniform(-2, 4) : uniform(-1, 1.5));
  return f;
}

FlatPrimitive CaseMaker::basic(int shape, bool hard, const Frame& at) {
  const auto p0 = floats(at.center - 0.5 * at.length * at.axis),
             p1 = floats(at.center + 0.5 * at.length * at.axis);
  const auto radius = static_cast<float>(at.r);
  switch (shape) {
    case shape_sphere:
      return make_sphere(floats(at.center), radius);
    case shape_capsule:
      return make_capsule(p0, p1, radius);
    case shape_tapered_capsule: {
      const auto r1 = static_cast<float>(at.r * (below(6) == 0 ? 0.0 : uniform(0, 1)));
      return below(2) == 0 ? make_tapered(p0, p1, radius, r1) : make_tapered(p0, p1, r1, radius);
    }
    case shape_triangle: {
      const double thin = hard ? std::pow(10.0, uniform(-3, 0)) : 1;
      const dvec3 side = any_perpendicular(at.axis), c = at.center;
      return make_triangle(floats(c), floats(c + at.r * direction()),
                           floats(c + at.r * thin * (side + 0.3 * direction())));
    }
    default:
      return make_disk(floats(at.center), floats(at.axis), radius);
  }
}

FlatPrimitive CaseMaker::solid(int shape, bool, const Frame& at) {
  auto p0 = floats(at.center - 0.5 * at.length * at.axis),
       p1 = floats(at.center + 0.5 * at.length * at.axis);
  const auto radius = static_cast<float>(at.r);
  if (p0 == p1)
    p1[0] += std::max(radius, 1e-6f * std::abs(p1[0]));  // lost in rounding: an axis has to be
  const auto cap = [&] {
    return below(2) == 0 ? CAPLET_CAP_FLAT : below(2) == 0 ? CAPLET_CAP_ROUND : CAPLET_CAP_OPEN;
  };
  if (shape == shape_cylinder) return make_cylinder(p0, p1, radius, cap(), cap());
  const auto r1 = static_cast<float>(at.r * (below(5) == 0 ? 0.0 : uniform(0, 1)));
  return below(2) == 0 ? make_cone(p0, p1, radius, r1, cap(), cap())
                       : make_cone(p0, p1, r1, radius, cap(), cap());
}

namespace {

/// Fields for a place and size.
class FrameFields : public Fields {
 public:
  FrameFields(CaseMaker& random, bool hard, const CaseMaker::Frame& at)
      : random_(random), hard_(hard), at_(at) {}
  void corners(const char*, const char*, dvec3& p0, dvec3& p1) override {
    for (int k = 0; k < 3; ++k) {
      const double half = size();
      p0[k] = static_cast<float>(at_.center[k] - half);
      p1[k] = static_cast<float>(at_.center[k] + half);
      if (!(p0[k] < p1[k])) p1[k] = std::nextafter(static_cast<float>(p0[k]), HUGE_VALF);
    }
  }
  void positive(const char*, double& value) override { value = static_cast<float>(size()); }

 private:
  double size() {
    return at_.r * (hard_ ? std::pow(10.0, random_.uniform(-3, 0)) : random_.uniform(0.1, 1));
  }
  CaseMaker& random_;
  bool hard_;
  const CaseMaker::Frame& at_;
};

}  // namespace

FlatPrimitive CaseMaker::faced(int shape, bool hard, const Frame& at) {
  FlatPrimitive out;
  const auto make = [&]<class Type>(std::type_identity<Type>) {
    Type solid;
    FrameFields each(*this, hard, at);
    fields(solid, each);
    std::vector<float> none;
    out = flat_primitive(solid, glm::dmat4(1), none);
  };
  if (!for_faced(static_cast<std::uint32_t>(shape), make))
    throw std::logic_error("no random cases for shape " + std::to_string(shape));
  return out;
}

FlatPrimitive CaseMaker::open(int shape, bool hard, const Frame& at) {
  const auto radius = static_cast<float>(at.r);
  const auto phi_max = static_cast<float>(below(3) == 0 ? full_turn : uniform(0.1, full_turn));
  switch (shape) {
    case shape_partial_sphere: {
      double low = below(3) == 0 ? -1 : uniform(-1, 0.9),
             high = below(3) == 0 ? 1 : uniform(-0.9, 1);
      if (low > high) std::swap(low, high);
      return make_partial_sphere(radius, static_cast<float>(low * at.r),
                                 static_cast<float>(high * at.r), phi_max);
    }
    case shape_open_cylinder: {
      const double z = below(2) == 0 ? -0.5 * at.length : at.center.z;
      auto low = static_cast<float>(z), high = static_cast<float>(z + at.length);
      if (!(low < high)) high = std::nextafter(low, HUGE_VALF);
      return make_open_cylinder(radius, low, high, phi_max);
    }
    case shape_partial_disk: {
      const double inner = below(3) == 0 ? 0 : at.r * uniform(0.05, 0.95);
      return make_partial_disk(below(3) == 0 ? 0 : static_cast<float>(at.center.z), radius,
                               static_cast<float>(inner), phi_max);
    }
    default: {
      const double thin = hard ? std::pow(10.0, uniform(-2, 0)) : 1;
      const dvec3 u = at.r * direction(),
                  v = at.r * thin * (any_perpendicular(at.axis) + 0.3 * direction());
      dvec3 p11 = u + v;
      if (below(4) != 0) p11 += at.r * thin * uniform(0, 1) * direction();
      if (below(12) == 0) p11 = u;  // a triangle
      return make_bilinear(floats(at.center), floats(at.center + u), floats(at.center + v),
                           floats(at.center + p11));
    }
  }
}

FlatPrimitive CaseMaker::polyhedron(int planes, double stretch, const Frame& at,
                                    std::vector<float>& leaves) {
  for (;;) {
    PolyhedronShape shape;
    for (int i = 0; i < planes; ++i) {
      const dvec3 n = direction();
      const double along = glm::dot(n, at.axis);
      shape.points.push_back(at.center + at.r * (n + (stretch - 1) * along * at.axis));
      shape.normals.push_back(glm::normalize(n + (1 / stretch - 1) * along * at.axis));
    }
    if (polyhedron_corners(shape).empty()) continue;
    // Unbounded ones are left out: some direction sees no plane.
    const std::size_t before = leaves.size();
    const FlatPrimitive p = flat_primitive(shape, glm::dmat4(1), leaves);
    const auto reference = std::get<reference::Polyhedron>(reference_of(p, leaves));
    bool bounded =
        !reference.corners.empty() && reference.ball_radius < 30 * at.r * std::max(stretch, 1.0);
    for (int i = 0; i < 50 && bounded; ++i) {
      const dvec3 far = reference.ball_center + 1e3 * reference.ball_radius * direction();
      bounded = reference::value(reference, far) > 0;
    }
    for (const dvec3& corner : reference.corners)
      for (int i = 0; i < 4 && bounded; ++i)
        bounded = reference::value(
                      reference,
                      corner + 0.1 * at.r * glm::normalize(corner - reference.ball_center)) > 0;
    if (bounded) return p;
    leaves.resize(before);
  }
}

Shape CaseMaker::csg_shape(int depth) {
  CsgShape csg;
  csg.operation = static_cast<CsgShape::Operation>(below(3));
  const int count = 2 + below(3);
  for (int i = 0; i < count; ++i) {
    Shape operand;
    const double r = uniform(0.3, 1.5);
    switch (below(depth > 0 ? 8 : 7)) {
      case 0:
        operand.geometry = SphereShape{r};
        break;
      case 1:
        operand.geometry =
            CapsulesShape{{{0, 0, 0}}, {glm::vec3(direction())}, {static_cast<float>(r)}, {}, {}};
        break;
      case 2:
        operand.geometry = CapsulesShape{{{0, 0, 0}},
                                         {glm::vec3(direction())},
                                         {static_cast<float>(r)},
                                         {static_cast<float>(0.5 * r)},
                                         {}};
        break;
      case 3:
        operand.geometry = CylinderShape{-uniform(0.1, 1) * direction(),
                                         uniform(0.5, 2) * dvec3(0, 0, 1),
                                         r,
                                         {Cap::flat, Cap::flat}};
        break;
      case 4:
        operand.geometry = ConeShape{{0, 0, -r},
                                     {0, 0, r},
                                     {r, 0.5 * r},
                                     {Cap::flat, below(2) == 0 ? Cap::flat : Cap::round}};
        break;
      case 5:
        operand.geometry =
            PolyhedronShape{{dvec3(0), dvec3(0), dvec3(0), dvec3(r)},
                            {dvec3(-1, 0, 0), dvec3(0, -1, 0), dvec3(0, 0, -1), dvec3(1, 1, 1)}};
        break;
      case 6:
        operand.geometry =
            BoxShape{dvec3(-r), dvec3(uniform(0.2, 1), uniform(0.2, 1), uniform(0.2, 1))};
        break;
      default:
        operand = csg_shape(depth - 1);
    }
    glm::dmat4 m(1);
    if (below(3) != 0) m = glm::translate(m, 0.7 * direction());
    if (below(2) == 0) m = glm::rotate(m, uniform(0, full_turn), direction());
    if (below(2) == 0)
      m = glm::scale(m, dvec3(uniform(0.5, 1.5), uniform(0.5, 1.5),
                              uniform(0.5, 1.5) * (below(2) == 0 ? 1 : -1)));
    operand.world_from_object = m;
    csg.operands.push_back(std::make_shared<const Shape>(operand));
  }
  Shape out;
  out.geometry = csg;
  return out;
}

FlatPrimitive CaseMaker::primitive(int shape, bool hard) {
  const Frame at = frame(hard);
  switch (shape) {
    case shape_sphere:
    case shape_capsule:
    case shape_tapered_capsule:
    case shape_triangle:
    case shape_disk:
      return basic(shape, hard, at);
    case shape_cylinder:
    case shape_cone:
      return solid(shape, hard, at);
    case shape_partial_sphere:
    case shape_open_cylinder:
    case shape_partial_disk:
    case shape_bilinear:
      return open(shape, hard, at);
    default:
      return faced(shape, hard, at);
  }
}

CsgShape placed_csg(CsgShape csg, const glm::dmat4& m) {
  for (auto& operand : csg.operands) {
    Shape moved = *operand;
    moved.world_from_object = m * moved.world_from_object;
    operand = std::make_shared<const Shape>(moved);
  }
  return csg;
}

void CaseMaker::add_primitive(int shape, bool hard, CaseSet& out) {
  if (shape == shape_csg) {
    for (;;) {
      const Frame at = frame(hard);
      Shape csg = csg_shape(1);
      const auto m = glm::scale(glm::translate(glm::dmat4(1), at.center), dvec3(at.r));
      const CsgShape placed = placed_csg(std::get<CsgShape>(csg.geometry), m);
      csg.geometry = placed;
      const reference::Primitive reference = reference::primitives_of(csg).at(0);
      // Differences that leave nothing cannot be hit.
      const reference::Ball ball = reference::bounding_ball(reference);
      bool something = false;
      for (int i = 0; i < 30 && !something; ++i)
        something = !reference::crossings(
                         reference, {ball.center + 0.5 * ball.radius * direction(), direction()})
                         .empty();
      if (!something) continue;
      out.primitives.push_back(flat_primitive(placed, glm::dmat4(1), out.leaves));
      out.references.push_back(reference);
      return;
    }
  }
  if (shape == shape_molecular_patch) {
    out.primitives.push_back(molecular_patch(frame(hard), out.leaves));
  } else if (shape == shape_polyhedron) {
    const Frame at = frame(hard);
    const double stretch = hard ? std::pow(10.0, uniform(-1.5, 1.5)) : 1;
    out.primitives.push_back(polyhedron(4 + below(hard ? 12 : 6), stretch, at, out.leaves));
  } else {
    out.primitives.push_back(primitive(shape, hard));
  }
  out.references.push_back(reference_of(out.primitives.back(), out.leaves));
}

namespace {

double columns(const glm::dmat4& m) {
  return glm::length(dvec3(m[0])) + glm::length(dvec3(m[1])) + glm::length(dvec3(m[2]));
}

// docs/numerics.md, "CSG": 16 eps (R + 3 e) an operand, R and e at most what stands here. Where its
// data cannot hold its transform (boxes that are turned, affine maps) R and e are those of its own
// space, 8 eps R are added, and the result is taken to the space that the shape is stored in by the
// largest stretch.
double operands_bound(const reference::Csg& csg, const glm::dmat4& csg_from_outer,
                      const dvec3& center, double radius) {
  double out = 0;
  for (const reference::CsgOperand& operand : csg.body->operands) {
    const glm::dmat4 inward = operand.operand_from_csg * csg_from_outer;
    if (const auto* nested = std::get_if<reference::Csg>(&operand.primitive)) {
      out = std::max(out, operands_bound(*nested, inward, center, radius));
      continue;
    }
    const glm::dmat4 outward = glm::inverse(inward);
    const reference::Ball ball = reference::bounding_ball(operand.primitive);
    if (const double scale = similarity_scale(outward);
        scale > 0 && !std::holds_alternative<reference::Box>(operand.primitive)) {
      const dvec3 middle(outward * glm::dvec4(ball.center, 1));
      out = std::max(out, 16 * eps *
                              (radius + 3 * (glm::length(middle - center) +
                                             std::sqrt(3.0) * scale * ball.radius)));
      continue;
    }
    const double extent = glm::length(ball.center) + std::sqrt(3.0) * ball.radius;
    const double away = glm::length(center - dvec3(outward[3]));
    out = std::max(out,
                   24 * eps * columns(outward) * (columns(inward) * (radius + away) + 3 * extent));
  }
  return out;
}

}  // namespace

Extent extent_of(const FlatPrimitive& p, const reference::Primitive& reference) {
  const reference::Ball ball = reference::bounding_ball(reference);
  double reach = 2 * ball.radius;
  if (p.shape == shape_triangle)
    reach = glm::length(point(p.data + 3) - point(p.data)) +
            glm::length(point(p.data + 6) - point(p.data));
  return {ball.center, ball.radius, reach};
}

double surface_bound(const FlatPrimitive& p, const reference::Primitive& reference,
                     const RayRecord& ray) {
  const float* d = p.data;
  const dvec3 o(ray.ox, ray.oy, ray.oz);
  const auto from = [&](const dvec3& c) { return glm::length(o - c); };
  const double axis = glm::length(point(d + 3) - point(d));
  switch (p.shape) {
    case shape_sphere:
      return 16 * eps * (from(point(d)) + double(d[3]));
    case shape_capsule:
    case shape_cylinder:
      return 16 * eps * (from(point(d)) + axis + double(d[6]));
    case shape_tapered_capsule:
    case shape_cone:
      return 16 * eps * (from(point(d)) + axis + double(d[6]) + double(d[7]));
    case shape_triangle:
      return 16 * eps *
             (from(point(d)) + std::max({axis, glm::length(point(d + 6) - point(d)),
                                         glm::length(point(d + 6) - point(d + 3))}));
    case shape_disk:
      return 16 * eps * (from(point(d)) + double(d[6]));
    case shape_box:
      return 8 * eps * (from(0.5 * (point(d) + point(d + 3))) + axis);
    case shape_polyhedron: {
      const auto& polyhedron = std::get<reference::Polyhedron>(reference);
      double radius = 0;
      for (const dvec3& corner : polyhedron.corners)
        radius = std::max(radius, glm::length(corner - polyhedron.center));
      return 16 * eps * (from(polyhedron.center) + radius);
    }
    case shape_partial_sphere:
      return 16 * eps * (from(dvec3(0)) + double(d[0]));
    case shape_open_cylinder:
      return 16 * eps *
             (from({0, 0, 0.5 * (double(d[1]) + double(d[2]))}) + double(d[0]) + double(d[2]) -
              double(d[1]));
    case shape_partial_disk:
      return 16 * eps * (from({0, 0, d[0]}) + double(d[1]));
    case shape_bilinear: {
      double diameter = 0;
      for (int i = 0; i < 4; ++i)
        for (int k = 0; k < i; ++k)
          diameter = std::max(diameter, glm::length(point(d + 3 * i) - point(d + 3 * k)));
      return 24 * eps * (from(point(d)) + diameter);
    }
    case shape_molecular_patch: {
      const auto& patch = std::get<reference::MolecularPatch>(reference);
      return 16 * eps * (from(patch.center) + patch.major + patch.minor);
    }
    case shape_csg: {
      const reference::Ball ball = reference::bounding_ball(reference);
      return operands_bound(std::get<reference::Csg>(reference), glm::dmat4(1), ball.center,
                            ball.radius) +
             3 * eps * from(ball.center);
    }
    default: {
      const reference::Ball ball = reference::bounding_ball(reference);
      return 16 * eps * (from(ball.center) + 2 * ball.radius);
    }
  }
}

// --- Points on them ---

dvec3 CaseMaker::point_of(const reference::Frustum& s, dvec3* normal) {
  const dvec3 u = any_perpendicular(s.axis), v = glm::cross(s.axis, u);
  const double phi = uniform(0, full_turn);
  const dvec3 outward = std::cos(phi) * u + std::sin(phi) * v;
  const int kind = below(4);
  if (kind < 2 && s.side_count > 0) {
    // Where the plane of the side touches both ends, and between.
    const glm::dvec2 n = s.side_normals[0];
    const auto contact = [&](std::size_t end) {
      const dvec3 center = end == 0 ? s.p0 : s.p1;
      return s.ends[end].round ? center + s.ends[end].radius * (n.x * s.axis + n.y * outward)
                               : center + s.ends[end].radius * outward;
    };
    *normal = n.x * s.axis + n.y * outward;
    const double along = between(0, 1);
    return contact(0) + along * (contact(1) - contact(0));
  }
  const auto end = static_cast<std::size_t>(kind % 2);
  const dvec3 center = end == 0 ? s.p0 : s.p1, away = end == 0 ? -s.axis : s.axis;
  if (s.ends[end].round) {
    *normal = direction();
    if (glm::dot(*normal, away) < 0) *normal = -*normal;
    return center + s.ends[end].radius * *normal;
  }
  *normal = away;
  return center + s.ends[end].radius * between(0, 1) * outward;
}

dvec3 CaseMaker::box_point(const BoxShape& b, dvec3* normal) {
  dvec3 x;
  for (int k = 0; k < 3; ++k) x[k] = between(b.p0[k], b.p1[k]);
  const int k = below(3);
  const bool high = below(2) == 0;
  x[k] = high ? b.p1[k] : b.p0[k];
  *normal = dvec3(0);
  (*normal)[k] = high ? 1 : -1;
  return x;
}

template <class Model>
dvec3 CaseMaker::point_of(const reference::Solid<Model>& solid, dvec3* normal) {
  if constexpr (std::is_same_v<Model, BoxShape>)  // corners, and edges to the last bit
    if (below(2) == 0) return box_point(solid.shape, normal);
  const reference::Ball ball = reference::bounding_ball(solid);
  dvec3 inside = ball.center;
  for (int i = 0; i < 100 && !(reference::value(solid, inside) < 0); ++i)
    inside = ball.center + ball.radius * uniform(0, 1) * direction();
  int surface = 0, other = 0;
  const dvec3 a = ball.radius * direction(), b = ball.radius * direction();
  dvec3 x = surface_beyond(solid.shape, inside, a, &surface);
  surface_beyond(solid.shape, inside, b, &other);
  if (below(2) == 0 && other != surface) {  // the edge, or corner, between
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      int at = surface;
      x = surface_beyond(solid.shape, inside, a + middle * (b - a), &at);
      (at == surface ? low : high) = middle;
    }
  }
  *normal = normal_on(solid.shape, surface, x);
  return x;
}

dvec3 CaseMaker::point_of(const reference::Polyhedron& p, dvec3* normal) {
  // Corners of one plane span its face; two of them may be an edge.
  const auto corner = [&] {
    return p.corners[static_cast<std::size_t>(below(static_cast<int>(p.corners.size())))];
  };
  const auto plane = static_cast<std::size_t>(reference::surface_at(p, corner()).surface);
  std::vector<dvec3> face;
  for (const dvec3& c : p.corners)
    if (std::abs(glm::dot(p.normals[plane], c - p.center) - p.offsets[plane]) <
        1e-9 * p.ball_radius)
      face.push_back(c);
  const auto of_face = [&] {
    return face[static_cast<std::size_t>(below(static_cast<int>(face.size())))];
  };
  *normal = p.normals[plane];
  const dvec3 a = of_face(), b = of_face(), c = of_face();
  const dvec3 on_edge = a + between(0, 1) * (b - a);
  return on_edge + between(0, 1) * (c - on_edge);
}

namespace {

// An end of the range of angles, where there is one, or an angle within.
double angle_within(double phi_max, double choice, double u) {
  return phi_max >= full_turn || choice > 0.3 ? u * phi_max : choice > 0.15 ? 0 : phi_max;
}

}  // namespace

dvec3 CaseMaker::point_of(const reference::PartialSphere& s, dvec3* normal) {
  const double z = between(std::max(s.z_min, -s.radius), std::min(s.z_max, s.radius));
  const double phi = angle_within(s.phi_max, uniform(0, 1), uniform(0, 1)),
               r = std::sqrt(std::max(0.0, s.radius * s.radius - z * z));
  const dvec3 x{r * std::cos(phi), r * std::sin(phi), z};
  *normal = x / s.radius;
  return x;
}

dvec3 CaseMaker::point_of(const reference::OpenCylinder& c, dvec3* normal) {
  const double phi = angle_within(c.phi_max, uniform(0, 1), uniform(0, 1));
  *normal = {std::cos(phi), std::sin(phi), 0};
  return c.radius * *normal + between(c.z_min, c.z_max) * dvec3(0, 0, 1);
}

dvec3 CaseMaker::point_of(const reference::PartialDisk& d, dvec3* normal) {
  const double phi = angle_within(d.phi_max, uniform(0, 1), uniform(0, 1)),
               r = between(d.inner_radius, d.radius);
  *normal = {0, 0, 1};
  return {r * std::cos(phi), r * std::sin(phi), d.height};
}

dvec3 CaseMaker::point_of(const reference::Bilinear& b, dvec3* normal) {
  const double u = between(0, 1), v = between(0, 1);
  const dvec3 du = b.p10 - b.p00 + v * (b.p11 - b.p01 - b.p10 + b.p00),
              dv = b.p01 - b.p00 + u * (b.p11 - b.p01 - b.p10 + b.p00);
  const dvec3 n = glm::cross(du, dv);
  *normal = glm::length(n) > 0 ? glm::normalize(n) : dvec3(0, 0, 1);
  return b.p00 + u * (b.p10 - b.p00) + v * dv;
}

dvec3 CaseMaker::point_of(const reference::Csg& csg, dvec3* normal) {
  const reference::Primitive whole = csg;
  const reference::Ball ball = reference::bounding_ball(whole);
  for (int i = 0; i < 20; ++i) {
    const reference::Ray line{ball.center + ball.radius * uniform(0, 0.9) * direction(),
                              direction(), -HUGE_VAL, HUGE_VAL};
    const auto found = reference::crossings(whole, line);
    if (found.empty()) continue;
    const dvec3 x =
        line.origin +
        found[static_cast<std::size_t>(below(static_cast<int>(found.size())))].t * line.direction;
    *normal = reference::normal_at(whole, x, 1e-6 * ball.radius);
    if (std::isfinite(normal->x)) return x;
  }
  *normal = direction();
  return ball.center;
}

dvec3 CaseMaker::surface_point(const FlatPrimitive& p, const reference::Primitive& reference,
                               dvec3* normal) {
  const float* d = p.data;
  if (p.shape > shape_disk)
    return std::visit(
        [&](const auto& shape) {
          if constexpr (requires { point_of(shape, normal); })
            return point_of(shape, normal);
          else
            return dvec3(0);
        },
        reference);
  *normal = direction();
  switch (p.shape) {
    case shape_sphere:
      return point(d) + double(d[3]) * *normal;
    case shape_triangle: {
      double b1 = uniform(0, 1), b2 = uniform(0, 1);
      if (b1 + b2 > 1) b1 = 1 - b1, b2 = 1 - b2;
      if (below(4) == 0) b1 = 0;
      if (below(4) == 0) b2 = 1 - b1;
      const dvec3 e1 = point(d + 3) - point(d), e2 = point(d + 6) - point(d);
      *normal = glm::normalize(glm::cross(e1, e2));
      return point(d) + b1 * e1 + b2 * e2;
    }
    case shape_disk: {
      *normal = glm::normalize(point(d + 3));
      const dvec3 u = any_perpendicular(*normal), v = glm::cross(*normal, u);
      const double phi = uniform(0, full_turn),
                   r = double(d[6]) * (below(3) == 0 ? 1 : std::sqrt(uniform(0, 1)));
      return point(d) + r * (std::cos(phi) * u + std::sin(phi) * v);
    }
    default: {
      // A ball of the hull touches it where its normal has the tangent cone's angle; at the ends
      // anywhere beyond.
      const double r0 = d[6], r1 = p.shape == shape_capsule ? r0 : double(d[7]);
      const dvec3 axis = point(d + 3) - point(d);
      const double length = glm::length(axis), k = length > 0 ? (r0 - r1) / length : 2;
      if (std::abs(k) >= 1) return r0 > r1 ? point(d) + r0 * *normal : point(d + 3) + r1 * *normal;
      const dvec3 m = axis / length;
      const double along = glm::dot(*normal, m);
      double s = below(4) == 0 ? 0 : below(3) == 0 ? 1 : uniform(0, 1);
      if (s == 0 && along < k && below(2) == 0) return point(d) + r0 * *normal;
      if (s == 1 && along > k && below(2) == 0) return point(d + 3) + r1 * *normal;
      *normal = k * m + std::sqrt(1 - k * k) * glm::normalize(*normal - along * m);
      return point(d) + s * axis + (r0 + s * (r1 - r0)) * *normal;
    }
  }
}

dvec3 CaseMaker::own_axis(const FlatPrimitive& p, const reference::Primitive& reference) {
  const float* d = p.data;
  switch (p.shape) {
    case shape_capsule:
    case shape_tapered_capsule:
    case shape_triangle:
    case shape_cylinder:
    case shape_cone:
    case shape_bilinear:
      return point(d + 3) - point(d);
    case shape_disk:
      return point(d + 3);
    case shape_box:
      return {double(d[3]) - double(d[0]), 0, 0};
    case shape_molecular_patch:
      return std::get<reference::MolecularPatch>(reference).axis;
    case shape_polyhedron: {  // edges come as pairs of corners
      const auto& corners = std::get<reference::Polyhedron>(reference).corners;
      const auto i = static_cast<std::size_t>(below(static_cast<int>(corners.size()) / 2));
      const dvec3 edge = corners[2 * i + 1] - corners[2 * i];
      if (glm::length(edge) > 1e-6 * reference::bounding_ball(reference).radius) return edge;
      return std::get<reference::Polyhedron>(reference).normals[0];
    }
    default:
      return reference::bounding_ball(reference).radius * dvec3(0, 0, 1);
  }
}

RayRecord CaseMaker::ray(const FlatPrimitive& p, const reference::Primitive& reference) {
  const Extent extent = extent_of(p, reference);
  dvec3 n;
  const dvec3 on = surface_point(p, reference, &n);
  const double size = std::max(extent.radius, 1e-30);
  // Shapes are thin: aim near a surface point, within the local radius or so.
  const dvec3 aim =
      on + (below(2) == 0 ? 0.0 : std::pow(10.0, uniform(-6, 0))) * 0.3 * size * direction();
  dvec3 o, d;
  switch (below(9)) {
    case 0:  // from outside
      o = extent.center + size * uniform(1, 10) * direction();
      d = aim - o;
      break;
    case 1:  // far
      o = extent.center + size * std::pow(10.0, uniform(1, 4)) * direction();
      d = on - o;
      break;
    case 2:  // inside (above or below open shapes)
      o = on - size * std::pow(10.0, uniform(-4, 0)) * n;
      d = direction();
      break;
    case 3:  // the surface
      o = on;
      d = direction();
      break;
    case 4: {  // along a coordinate axis, with zeros of both signs
      d = dvec3(0);
      d[below(3)] = below(2) == 0 ? 1 : -1;
      if (below(2) == 0)
        for (int k = 0; k < 3; ++k) d[k] = d[k] == 0 ? -0.0 : d[k];
      o = aim - uniform(0, 4) * size * d;
      break;
    }
    case 5: {  // touching, or nearly
      const dvec3 across = glm::normalize(glm::cross(n, direction()));
      d = across;
      const double off =
          below(3) == 0 ? 0 : std::pow(10.0, uniform(-8, -1)) * (below(2) == 0 ? 1 : -1);
      o = on + off * size * n - uniform(0.1, 4) * size * across;
      break;
    }
    case 6:  // along the shape's own axis
      d = own_axis(p, reference);
      o = aim - uniform(0, 4) * d;
      break;
    case 7: {  // from surface to surface: through rims and edges
      dvec3 other_normal;
      const dvec3 other = surface_point(p, reference, &other_normal);
      d = on - other;
      o = other - uniform(-0.5, 3) * d;
      break;
    }
    default:  // any length of direction
      o = extent.center + size * uniform(0, 3) * direction();
      d = (aim - o) * std::pow(10.0, uniform(-3, 3));
  }
  if (glm::length(d) < 1e-12 * (size + glm::length(o))) d = dvec3(0, 1, 0);
  return make_ray(o, d);
}

CaseSet CaseMaker::set(int shape, bool hard, int primitives, int rays_each) {
  CaseSet out;
  for (int i = 0; i < primitives; ++i) {
    add_primitive(shape, hard, out);
    for (int j = 0; j < rays_each; ++j) {
      out.which.push_back(static_cast<std::uint32_t>(i));
      out.rays.push_back(ray(out.primitives.back(), out.references.back()));
    }
  }
  return out;
}

PlacedCases placed_cases(CaseSet cases, std::uint32_t seed) {
  PlacedCases out{std::move(cases), {}, {}};
  CaseMaker random(seed);
  for (const FlatPrimitive& p : out.cases.primitives) {
    glm::dmat4 m =
        glm::translate(glm::dmat4(1), std::pow(10.0, random.uniform(-1, 3)) * random.direction());
    m = glm::rotate(m, random.uniform(0, full_turn), random.direction());
    m = glm::scale(m, dvec3(random.uniform(0.2, 3), random.uniform(0.2, 3),
                            random.uniform(0.2, 3) * (random.uniform(0, 1) < 0.5 ? -1 : 1)));
    m = glm::rotate(m, random.uniform(0, full_turn), random.direction());
    const glm::dmat4 inverse = glm::inverse(m);
    PlacedPrimitive placed{p, true, {}, {}};
    glm::dmat4 rounded(1);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) {
        const auto at = static_cast<std::size_t>(4 * r + c);
        placed.world_from_object[at] = static_cast<float>(m[c][r]);
        placed.object_from_world[at] = static_cast<float>(inverse[c][r]);
        rounded[c][r] = placed.world_from_object[at];
      }
    out.placed.push_back(placed);
    out.world_from_object.push_back(rounded);
  }
  for (std::size_t i = 0; i < out.cases.rays.size(); ++i) {
    RayRecord& r = out.cases.rays[i];
    const glm::dmat4& m = out.world_from_object[out.cases.which[i]];
    r = make_ray(dvec3(m * glm::dvec4(r.ox, r.oy, r.oz, 1)),
                 dvec3(m * glm::dvec4(r.dx, r.dy, r.dz, 0)));
  }
  return out;
}

}  // namespace caplet::test
