// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes records, boxes and lights of trees as placed.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "lower/detail/area.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/floats.h"
#include "lower/detail/subtrees.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;
using glm::dvec3;

/// Returns the box of a subtree in its space, from one time to another.
Bounds subtree_bounds(const EncodedTree& tree, float begin, float end) {
  Bounds out;
  const auto extend = [&](const float* min, const float* max) {
    out.extend({{min[0], min[1], min[2]}, {max[0], max[1], max[2]}});
  };
  const auto of_interval = [&](std::size_t i) {
    return static_cast<float>(i) / static_cast<float>(tree.boxes.size());
  };
  for (std::size_t i = 0; i < tree.boxes.size(); ++i)
    if (of_interval(i) < end && begin < of_interval(i + 1))
      extend(tree.boxes[i].min, tree.boxes[i].max);
  if (tree.boxes.empty()) extend(tree.min, tree.max);
  return out;
}

/// Returns the bounds of the transformed shapes themselves while they are few; for large objects
/// those of the tree's transformed box.
Bounds placed_bounds(const Subtree& subtree, const Matrix& world_from_subtree,
                     const MotionPath* motion, float begin, float end) {
  const Bounds own = subtree_bounds(subtree.tree, begin, end);
  if (motion) return motion->swept(own, begin, end);
  Bounds box;
  if (subtree.size() <= 256 && subtree.tree.boxes.empty()) {
    // A subtree with its own transform holds its shapes in their object space.
    const bool baked = subtree.placed == Matrix(1);
    for (const Shape* shape : subtree.shapes)
      box.extend(bounds_of(shape->geometry, baked ? world_from_subtree * shape->world_from_object
                                                  : world_from_subtree));
    return box;
  }
  for (int corner = 0; corner < 8; ++corner) {
    dvec3 p;
    for (int k = 0; k < 3; ++k) p[k] = (corner >> k) & 1 ? own.max[k] : own.min[k];
    box.extend(apply_point(world_from_subtree, p));
  }
  return box;
}

/// Placement is shared by lights that are placed together.
struct Placement {
  explicit Placement(const Matrix& m, const MotionPath* path)
      : world_from_subtree(m),
        motion(path),
        stays(m == Matrix(1)),
        normals(glm::transpose(glm::inverse(glm::dmat3(m)))) {}
  Matrix world_from_subtree;
  const MotionPath* motion;  // null: it rests
  bool stays;
  glm::dmat3 normals;
};

/// Sets the box of the primitive's image, and the emitting side of a flat one.
void set_reach(const FlatPrimitive& p, const Placement& to, bool flipped, Emitter& emitter) {
  double low[3], high[3];
  primitive_box(p, low, high);
  Bounds box{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  if (to.motion) {
    box = to.motion->swept(box);
  } else if (!to.stays) {
    box = {};
    for (int corner = 0; corner < 8; ++corner) {
      dvec3 x;
      for (int k = 0; k < 3; ++k) x[k] = (corner >> k) & 1 ? high[k] : low[k];
      box.extend(apply_point(to.world_from_subtree, x));
    }
  }
  dvec3 normal(0);
  double length = 0;
  if (p.shape == shape_triangle) {
    const auto corner = [&](int at) { return dvec3(p.data[at], p.data[at + 1], p.data[at + 2]); };
    const dvec3 v0 = corner(triangle_at_v0);
    normal = to.normals * glm::cross(corner(triangle_at_v1) - v0, corner(triangle_at_v2) - v0);
    length = glm::length(normal);
  } else if (p.shape == shape_disk) {
    normal = to.normals * dvec3(p.data[disk_at_n], p.data[disk_at_n + 1], p.data[disk_at_n + 2]);
    length = glm::length(normal);
  }
  // A lamp that moves may also turn.
  const bool one_way = !to.motion && !emitter.two_sided && std::isfinite(length) && length > 0;
  for (int k = 0; k < 3; ++k) {
    emitter.min[k] = box.min[k];
    emitter.max[k] = box.max[k];
    emitter.axis[k] = one_way ? normal[k] / (flipped ? -length : length) : 0;
  }
}

/// Sets the ball around the image of the primitive's box, for kinds that are sampled by it.
void set_ball(const FlatPrimitive& p, const Placement& to, Emitter& emitter) {
  const bool has_round_end =
      p.shape == shape_cylinder &&
      (cylinder_cap0(p.data) == CAPLET_CAP_ROUND || cylinder_cap1(p.data) == CAPLET_CAP_ROUND);
  emitter.by_ball = !shape_has(p.shape, trait_own_light) || has_round_end;
  if (!emitter.by_ball) return;
  double low[3], high[3];
  primitive_box(p, low, high);
  const dvec3 a(low[0], low[1], low[2]), b(high[0], high[1], high[2]);
  dvec3 center = apply_point(to.world_from_subtree, 0.5 * (a + b));
  double radius = 0;
  if (to.motion) {
    // The ball holds the primitive at all times.
    const Bounds box = to.motion->swept({a, b});
    center = 0.5 * (box.min + box.max);
    radius = 0.5 * glm::length(box.max - box.min);
  } else {
    for (int corner = 0; corner < 8; ++corner) {
      const dvec3 x(corner & 1 ? b.x : a.x, corner & 2 ? b.y : a.y, corner & 4 ? b.z : a.z);
      radius = std::max(radius, glm::length(apply_point(to.world_from_subtree, x) - center));
    }
  }
  for (int k = 0; k < 3; ++k) emitter.ball[k] = center[k];
  // The centre is rounded to floats.
  emitter.ball[3] = radius + 0x1p-23 * glm::length(center);
}

/// Returns whether the alpha is the number 0: then in pbrt-v4 rays pass everywhere, and the shape
/// emits light nevertheless.
bool is_unseen(const Shape& shape) {
  if (!shape.alpha || shape.alpha->texture) return false;
  const auto* number = std::get_if<ConstantSpectrum>(&shape.alpha->value);
  return number && !(number->value > 0);
}

}  // namespace

InstanceRecord instance_record(const Subtree& subtree, const Matrix& world_from_subtree,
                               std::uint32_t object) {
  InstanceRecord record{};
  const Matrix subtree_from_world = glm::inverse(world_from_subtree);
  write_matrix(record.object_from_world, subtree_from_world);
  write_matrix(record.world_from_object, world_from_subtree);
  record.root = subtree.tree.root;
  record.intervals = subtree.tree.intervals;
  record.roots = subtree.tree.roots_begin;
  record.light_base = CAPLET_NONE;
  record.object = object;
  record.flags = subtree.flags;
  if (glm::determinant(glm::dmat3(world_from_subtree)) < 0)
    record.flags |= CAPLET_INSTANCE_MIRRORED;
  return record;
}

void set_instance_box(const Subtree& subtree, const Matrix& world_from_subtree,
                      const MotionPath* motion, FlatPrimitive& instance, float begin, float end) {
  const Bounds box = placed_bounds(subtree, world_from_subtree, motion, begin, end);
  double largest = 0;
  for (int k = 0; k < 3; ++k)
    largest = std::max({largest, std::abs(box.min[k]), std::abs(box.max[k])});
  // Moving a ray into the object and a hit back costs a few roundings of the largest coordinate on
  // either side, and the matrices of a motion a few more: 32 units are ample, and 64.
  const double slack = (motion ? 64 : 32) * 0x1p-24 * largest;
  for (int k = 0; k < 3; ++k) {
    instance.kept_box()[k] = std::nextafter(static_cast<float>(box.min[k] - slack), -INFINITY);
    instance.kept_box()[3 + k] = std::nextafter(static_cast<float>(box.max[k] + slack), INFINITY);
  }
}

void set_emitters(const Subtree& subtree, const Subtree::Emissive& emissive, std::uint32_t instance,
                  const Matrix& world_from_subtree, const MotionPath* motion, std::uint32_t group,
                  SpectrumTable& spectra, const FlatScene& flat, Emitter* out) {
  const AreaEmission& emission = *emissive.shape->emission;
  const AreaMap area_map(world_from_subtree);
  std::vector<double> areas(emissive.count);
  const auto each = [&](const auto& of) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, emissive.count, 1024),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i < range.end(); ++i) of(i);
                      });
  };
  each([&](std::size_t i) {
    areas[i] = placed_area(subtree.primitives[emissive.first + i], flat.leaves, area_map,
                           emission.surfaces);
  });
  double total_area = 0;
  for (const double area : areas) total_area += area;
  Emitter emitter{};
  emitter.group = group;
  emitter.instance = instance;
  emitter.two_sided = emission.two_sided;
  const Spectrum color =
      emission.image ? RgbSpectrum{dvec3(1), emission.image->space} : emission.radiance;
  emitter.spectrum = spectra.add_illuminant(color);
  emitter.of_image = emission.image ? &emission : nullptr;
  emitter.unseen = is_unseen(*emissive.shape);
  // This is the luminance of an image's white.
  const double luminance = spectra.illuminant_luminance(color);
  emitter.scale = emission.scale;
  if (emission.power) {
    // In pbrt-v4 the power is that of a light of radiance 1, whatever the colour.
    const double sides = emission.two_sided ? 2 : 1;
    emitter.scale = total_area > 0
                        ? emission.scale * *emission.power / (total_area * std::numbers::pi * sides)
                        : 0;
  }
  emitter.luminance = luminance * emitter.scale;
  const Placement placement(world_from_subtree, motion);
  each([&](std::size_t i) {
    const std::size_t at = emissive.first + i;
    const FlatPrimitive& p = subtree.primitives[at];
    Emitter& to = out[i];
    to = emitter;
    to.slot = subtree.tree.slots[at];
    to.geometry = geometry_of(flat.primitive_geometry, p.id);
    to.area = areas[i];
    set_ball(p, placement, to);
    set_reach(p, placement, (flat.geometries[to.geometry].flags & CAPLET_GEOMETRY_FLIP_NORMAL) != 0,
              to);
    // This guess affects only the choice among lights: half of the ball's area, however little of
    // it the solid fills.
    if (p.shape == shape_csg) to.area = 2 * std::numbers::pi * to.ball[3] * to.ball[3];
  });
}

void set_world_bounds(const EncodedTree& tree, WorldRecord& world) {
  if (!(tree.min[0] <= tree.max[0])) {
    world.center_x = world.center_y = world.center_z = 0;
    world.radius = 1;
    return;
  }
  dvec3 low(tree.min[0], tree.min[1], tree.min[2]), high(tree.max[0], tree.max[1], tree.max[2]);
  const dvec3 center = (low + high) * 0.5;
  world.center_x = static_cast<float>(center.x);
  world.center_y = static_cast<float>(center.y);
  world.center_z = static_cast<float>(center.z);
  world.radius = static_cast<float>(glm::length(high - low) * 0.5);
}

}  // namespace caplet
