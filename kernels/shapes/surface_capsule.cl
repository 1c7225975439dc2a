// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes points of capsules and tapered capsules: the convex hull of two spheres, which is the
// envelope of the spheres with centre and radius interpolated along the axis. A point is refined to
// the one of those spheres that touches the envelope nearest to it. uv: u around the axis p0 -> p1,
// v along the profile by arc length from p0's pole (0) to p1's pole (1). Chains: chain_uv.
#ifndef CAPLET_SHAPES_SURFACE_CAPSULE_CL
#define CAPLET_SHAPES_SURFACE_CAPSULE_CL

#include "shapes/surface_sphere.cl"

// Requires r0 > 0 or r1 > 0.
static inline LocalSurface round_cone_point(const SurfaceQuery* query, float3 p0, float3 p1,
                                            float r0, float r1) {
  const float3 axis = p1 - p0;
  const float3 unit_axis = unit_or(axis, own_z(query->space));
  const float axis_length = dot(axis, unit_axis);
  const float taper = r0 - r1;
  if (!(axis_length > fabs(taper))) {
    // Here one sphere holds the other (or the ends are equal).
    return taper >= 0.0f ? sphere_point(query, p0, r0, unit_axis, 0.0f)
                         : sphere_point(query, p1, r1, unit_axis, 1.0f);
  }
  // Normals of the tangent cone make a constant angle with the axis: `k` is the sine of its
  // complement.
  const float k = taper / axis_length;
  const float c = sqrt((1.0f - k) * (1.0f + k));

  // z and `radial` are cylinder coordinates of x; the second subtraction makes `radial`
  // perpendicular to the axis to rounding of its own length.
  const float3 x = query->x, v = x - p0;
  const float z = dot(v, unit_axis);
  float3 radial = v - z * unit_axis;
  radial -= dot(radial, unit_axis) * unit_axis;
  float3 unit_radial = unit_or(radial, perpendicular(unit_axis));
  // Where x is on the axis to rounding, the remainder may point along it.
  const float tilt = dot(unit_radial, unit_axis);
  unit_radial = fabs(tilt) < 0.5f ? unit_or(unit_radial - tilt * unit_axis, unit_radial)
                                  : perpendicular(unit_axis);
  const float along = (z - dot(radial, unit_radial) * k / c) / axis_length;
  const float s = fmin(fmax(along, 0.0f), 1.0f);

  const float3 q = p0 + s * axis;
  const float radius = s < 1.0f ? r0 - s * taper : r1;
  LocalSurface out;
  float arc;  // along the profile
  const float angle0 = acos(-k);
  const float side = axis_length * c;
  if (s > 0.0f && s < 1.0f) {
    out.ng = k * unit_axis + c * unit_radial;
    arc = r0 * angle0 + s * side;
  } else {
    const float3 rim = k * unit_axis + c * unit_radial;
    out.ng = unit_or(x - q, rim);
    // Near a pointed end x - q is rounding alone; a cap's normals still are those beyond the
    // cone's.
    if (s > 0.0f ? dot(out.ng, unit_axis) < k : dot(out.ng, unit_axis) > k) out.ng = rim;
    const float angle = angle_between(unit_axis, out.ng);
    arc = s > 0.0f ? r0 * angle0 + side + r1 * (CAPLET_PI - angle0 - angle)
                   : r0 * (CAPLET_PI - angle);
  }
  out.ns = out.ng;
  out.p = q + radius * out.ng;
  const Frame turn = turn_frame(query->space, unit_axis);
  out.uv.x = turn_around(&turn, unit_radial);
  const float profile = r0 * angle0 + side + r1 * (CAPLET_PI - angle0);
  out.uv.y = fmin(fmax(arc / profile, 0.0f), 1.0f);
  out.dpdv = profile * unit_or(unit_axis - dot(unit_axis, out.ng) * out.ng, (float3)(0.0f));
  out.dpdu = along_turn(&turn, radius * out.ng);
  out.error =
      CAPLET_EPS * (32.0f * fmax(r0, r1) + 12.0f * axis_length + 6.0f * (norm1(q) + radius));
  if (any_chain && query->chain_u) chain_uv(query, unit_axis, s, c, radius, side, &out);
  return out;
}

static inline LocalSurface surface_capsule(const SurfaceQuery* q) {
  return round_cone_point(q, capsule_p0(q->data), capsule_p1(q->data), capsule_r(q->data),
                          capsule_r(q->data));
}

#endif
