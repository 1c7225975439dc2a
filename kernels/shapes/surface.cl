// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the surface where a ray hit, once, from the small record that traversal leaves. Bounds:
// docs/numerics.md, "Surface points".
#ifndef CAPLET_SHAPES_SURFACE_CL
#define CAPLET_SHAPES_SURFACE_CL

#include "groups.cl"
#include "slots.cl"
#include "shapes/surface_csg.cl"
#include "shapes/surface_shapes.cl"

// Surface is in world space. p lies on the surface within `error`: p +- ng * error is on the
// intended side. ng points outward of solids, and by winding / +z for open shapes, and
// ReverseOrientation turns it; ns is on the same side. light: index into `lights` or CAPLET_NONE;
// primitive_light: that of the whole primitive, of which this surface may be dark. flags:
// GeometryRecord's.
typedef struct {
  float3 p, ng, ns, dpdu, dpdv;
  float2 uv;
  float error;
  uint geometry, primitive, surface, material, light, primitive_light, flags;
  int leaving;
  int along_u;  // LocalSurface
} Surface;

static inline LocalSurface surface_of_shape(uint shape, const SurfaceQuery* q) {
  LocalSurface s = surface_shape(shape, q);
  s.along_u = any_chain && q->chain_u != 0;
  return s;
}
static inline LocalSurface surface_local(const SurfaceQuery* q) {
  if (!CAPLET_HAS_SHAPE(shape_csg)) return surface_of_shape(q->geometry->shape, q);
  uint shape = q->geometry->shape;
  SurfaceQuery own = *q;
  CsgOperand operand;
  const int csg = shape == shape_csg;
  if (csg) shape = csg_operand(q, &operand, &own);
  const LocalSurface s = surface_of_shape(shape, &own);
  return csg ? csg_surface(&operand, s) : s;
}

// Returns the surface at a hit of `ray` (hit->slot is not CAPLET_NONE).
static inline Surface surface_at(const Tree* tree, const Surfaces* surfaces, const RayRecord* ray,
                                 const HitRecord* hit) {
  float3 o = (float3)(ray->ox, ray->oy, ray->oz);
  float3 d = (float3)(ray->dx, ray->dy, ray->dz);
  const int placed = CAPLET_HAS_SHAPE(shape_instance) && hit->instance != CAPLET_NONE;
  if (placed) {
    const Affine to_object = object_from_world(tree, hit->instance);
    o = affine_point(&to_object, o);
    d = affine_vector(&to_object, d);
  }
  const uint primitive = primitive_at(tree, hit->slot);
  const uint index = geometry_of(surfaces, primitive);
  const GeometryRecord geometry = surfaces->geometries[index];
  const int leaving = (hit->surface & CAPLET_LEAVING) != 0;
  const float3 backward = unit_or(leaving ? d : -d, (float3)(0.0f, 0.0f, 1.0f));
  const uint surface = hit->surface & CAPLET_SURFACE_MASK;
  // chain_u is u at both ends of a capsule of a chain.
  __global const float* chain_u = 0;
  if (any_chain && (geometry.flags & CAPLET_GEOMETRY_CHAIN))
    chain_u = kind_is_linked(geometry.shape) ? linked_u(tree, hit->slot)
                                             : surfaces->mesh_uvs + geometry.uv_begin +
                                                   2u * (primitive - geometry.primitive_begin);
  const SurfaceQuery query = {
      surfaces,
      leaves_of(tree),
      &geometry,
      primitive,
      surface,
      slot_data(tree, hit->slot),
      o + hit->t * d,
      backward,
      geometry.uv_space != CAPLET_NONE ? floats_at(leaves_of(tree), geometry.uv_space) : 0,
      d,
      chain_u,
      time_of(tree)};
  LocalSurface found = surface_local(&query);
  if (geometry.flags & CAPLET_GEOMETRY_FLIP_NORMAL) {
    found.ng = -found.ng;
    found.ns = -found.ns;
  }
  if (placed) {
    const Affine to_world = world_from_object(tree, hit->instance),
                 to_object = object_from_world(tree, hit->instance);
    found = surface_transformed(&to_world, &to_object, found);
  }

  Surface s;
  s.p = found.p;
  s.ng = found.ng;
  s.ns = found.ns;
  s.dpdu = found.dpdu;
  s.dpdv = found.dpdv;
  s.uv = found.uv;
  s.error = found.error;
  s.geometry = index;
  s.flags = geometry.flags;
  s.primitive = primitive;
  s.surface = surface;
  s.leaving = leaving;
  s.along_u = found.along_u;
  uint base = 0u;
  if (placed) base = tree->instances[hit->instance].light_base;
  s.light = s.primitive_light =
      geometry.light_offset == CAPLET_NONE || base == CAPLET_NONE
          ? CAPLET_NONE
          : base + geometry.light_offset + (primitive - geometry.primitive_begin);
  s.material = geometry.material;
  if (geometry.surface_begin != CAPLET_NONE) {
    const uint entry = surfaces->surface_materials[geometry.surface_begin + surface];
    s.material = entry & ~CAPLET_SURFACE_DARK;
    if (entry & CAPLET_SURFACE_DARK) s.light = CAPLET_NONE;
  }
  return s;
}

// Returns the next float in the direction of `step`: up when it is > 0, down when < 0, x itself
// when 0.
static inline float round_along(float x, float step) {
  if (step == 0.0f || !isfinite(x)) return x;
  if (x == 0.0f) return step > 0.0f ? FLT_MIN : -FLT_MIN;
  return as_float(as_int(x) + ((x > 0.0f) == (step > 0.0f) ? 1 : -1));
}

// Returns the origin for a ray that leaves p towards `direction`: moved by `error` to that side of
// the surface with normal ng, each component rounded further out, so that it is never too near
// (after Woo, Pearce and Ouellette 1996; Pharr, Jakob and Humphreys 2016, 3.9.5).
static inline float3 offset_origin(float3 p, float3 ng, float error, float3 direction) {
  const float3 step = (dot(direction, ng) < 0.0f ? -error : error) * ng;
  const float3 moved = p + step;
  return (float3)(round_along(moved.x, step.x), round_along(moved.y, step.y),
                  round_along(moved.z, step.z));
}

#endif
