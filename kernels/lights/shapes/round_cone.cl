// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Samples points on the hull of two spheres (capsule, tapered capsule; one sphere as the special
// case), only on the side that faces a point q. The derivation is in docs/lights.md.
#ifndef CAPLET_LIGHTS_SHAPES_ROUND_CONE_CL
#define CAPLET_LIGHTS_SHAPES_ROUND_CONE_CL

#include "math/filter.cl"
#include "math/vector.cl"

// RoundCone has the axis p0 + z d. The tangent cone's normals have n . d = s; it touches the
// spheres at z0 and z1. `single`: it is one sphere alone, at p0. On the caps, normals with low <= n
// . d <= high are sampled.
typedef struct {
  float3 p0, d;
  float r0, r1, length, s, c, z0, z1, low, high;
  int single;
} RoundCone;

// RoundConeView is how q sees it: unit vectors e (from the axis to q) and f across the axis, q's
// coordinates along (a) and off (rho) the axis, the probability of each part, and the ranges of n .
// d on the caps.
typedef struct {
  float3 e, f;
  float a, rho;
  float height,
      angle;  // of q over the axis, for sampling by angle, and the angle that z0 .. z1 fill
  float cone, cap0, cap1;  // probabilities; all 0: nothing faces q
  float low0, high0, low1, high1;
  int inside;
} RoundConeView;

static inline RoundCone round_cone_of_sphere(float3 center, float radius) {
  RoundCone k;
  k.p0 = center;
  k.d = (float3)(0.0f, 0.0f, 1.0f);
  k.r0 = k.r1 = radius;
  k.length = k.s = k.z0 = k.z1 = 0.0f;
  k.c = 1.0f;
  k.low = -1.0f;
  k.high = 1.0f;
  k.single = 1;
  return k;
}

static inline RoundCone round_cone_make(float3 p0, float3 p1, float r0, float r1) {
  const float3 axis = p1 - p0;
  const float length = sqrt(dot(axis, axis));
  if (!(length > fabs(r0 - r1)))
    return r0 >= r1 ? round_cone_of_sphere(p0, r0) : round_cone_of_sphere(p1, r1);
  RoundCone k;
  k.p0 = p0;
  k.d = axis / length;
  k.r0 = r0;
  k.r1 = r1;
  k.length = length;
  k.s = (r0 - r1) / length;
  k.c = sqrt(fmax(0.0f, (1.0f - k.s) * (1.0f + k.s)));
  k.z0 = r0 * k.s;
  k.z1 = length + r1 * k.s;
  k.low = -1.0f;
  k.high = 1.0f;
  k.single = 0;
  return k;
}

// Leaves out the parts that other solids cover: `cover0` and `cover1` of 255 parts of the caps'
// heights, from their tops.
static inline void round_cone_cover(RoundCone* k, uint cover0, uint cover1) {
  if (k->single) return;
  k->low = k->s - (1.0f + k->s) * ((float)(255u - cover0) / 255.0f);
  k->high = k->s + (1.0f - k->s) * ((float)(255u - cover1) / 255.0f);
}

// Returns half the width of the arc |psi| in which the normal h d + sqrt(1 - h^2) (cos psi e + sin
// psi f) faces q: across = rho sqrt(1 - h^2), along = r - a h (r the distance of the tangent plane
// from the point that a and rho are measured from).
static inline float facing_arc(float across, float along) {
  if (across <= along) return 0.0f;
  if (across <= -along) return CAPLET_PI;
  return atan2(sqrt((across - along) * (across + along)), along);
}

static inline float cap_arc(const RoundConeView* v, float a, float r, float h) {
  if (v->inside) return CAPLET_PI;
  return facing_arc(v->rho * sqrt(fmax(0.0f, (1.0f - h) * (1.0f + h))), r - a * h);
}

static inline float cone_arc(const RoundCone* k, const RoundConeView* v) {
  if (v->inside) return CAPLET_PI;
  return facing_arc(v->rho * k->c, k->r0 - v->a * k->s);
}

// Computes the part of [*low, *high] of n . d on a sphere of radius r that q faces anywhere. With
// the polar angle B of q and the half angle T (cos T = r / D) of the cap that q sees, it is cos(B +
// T) .. cos(B - T).
static inline void cap_range(float a, float rho, float r, float* low, float* high) {
  const float distance = sqrt(a * a + rho * rho);
  if (!(distance > r)) {
    *high = *low;
    return;
  }
  const float cos_b = a / distance, sin_b = rho / distance, cos_t = r / distance;
  const float sin_t = sqrt((distance - r) * (distance + r)) / distance;
  if (sin_b * cos_t + cos_b * sin_t > 0.0f) *low = fmax(*low, cos_b * cos_t - sin_b * sin_t);
  if (sin_b * cos_t - cos_b * sin_t > 0.0f) *high = fmin(*high, cos_b * cos_t + sin_b * sin_t);
  *high = fmax(*high, *low);
}

static inline float cone_radius(const RoundCone* k, float z) {
  return fmax(k->c * k->r0 - (z - k->z0) * (k->s / k->c), 0.0f);
}

// Along a cone that is long as seen from q, points are sampled by equal angles about q's foot on
// the axis (Kulla and Fajardo, "Importance sampling techniques for path tracing in participating
// media", 2012); else in proportion to the radius.
static inline int cone_is_long(const RoundCone* k, const RoundConeView* v) {
  return !v->inside && k->z1 - k->z0 > v->rho;
}

static inline RoundConeView round_cone_view(const RoundCone* k, float3 q) {
  RoundConeView v;
  const float3 to_q = q - k->p0;
  v.a = dot(to_q, k->d);
  const float3 across = to_q - k->d * v.a;
  v.rho = sqrt(dot(across, across));
  v.e = v.rho > 1e-6f * fabs(v.a) && v.rho > 0.0f ? across / v.rho : frame_from_normal(k->d).s;
  v.f = cross(k->d, v.e);
  // `outside` is the signed distance: to the cone between the planes through the tangent circles
  // that are square to it, else to a sphere.
  const float a1 = v.a - k->length;
  const float along = v.a * k->c - v.rho * k->s;
  const float d0 = sqrt(dot(to_q, to_q)), d1 = sqrt(a1 * a1 + v.rho * v.rho);
  float outside = v.a * k->s + v.rho * k->c - k->r0;
  if (k->single || along < 0.0f)
    outside = d0 - k->r0;
  else if (along > k->length * k->c)
    outside = d1 - k->r1;
  v.inside = !(outside > 0.0f);
  v.low0 = k->low;
  v.high0 = k->single ? 1.0f : k->s;
  v.low1 = k->s;
  v.high1 = k->single ? k->s : k->high;
  v.cone = 0.0f;
  // Any height is correct as long as it stays the same; near the axis, where rho is of no use, it
  // is small.
  const float extent = k->z1 - k->z0;
  v.height = fmax(v.rho, 1e-4f * extent);
  v.angle = atan2(v.height * extent, sqr(v.height) + (k->z0 - v.a) * (k->z1 - v.a));
  if (v.inside) {
    // All of it faces a point within, so the parts are chosen in proportion to area.
    v.cap0 = k->r0 * k->r0 * (v.high0 - v.low0);
    v.cap1 = k->r1 * k->r1 * (v.high1 - v.low1);
    if (!k->single) v.cone = 0.5f * (k->r0 + k->r1) * (k->z1 - k->z0);
  } else {
    // The parts are chosen by area over squared distance, roughly; only the variance depends on how
    // roughly.
    cap_range(v.a, v.rho, k->r0, &v.low0, &v.high0);
    cap_range(a1, v.rho, k->r1, &v.low1, &v.high1);
    v.cap0 =
        sqr(k->r0 / d0) * (v.high0 - v.low0) * cap_arc(&v, v.a, k->r0, 0.5f * (v.low0 + v.high0));
    v.cap1 = k->single ? 0.0f
                       : sqr(k->r1 / d1) * (v.high1 - v.low1) *
                             cap_arc(&v, a1, k->r1, 0.5f * (v.low1 + v.high1));
    const float arc = k->single ? 0.0f : cone_arc(k, &v);
    if (arc > 0.0f) {
      // The radius is between the one nearest to q and the mean one: never 0, even at a tip.
      const float mean = 0.5f * k->c * (k->r0 + k->r1);
      const float radius =
          cone_is_long(k, &v) ? 0.5f * (mean + cone_radius(k, clamp(v.a, k->z0, k->z1))) : mean;
      v.cone = arc * radius * v.angle / (k->c * v.height);
    }
  }
  const float sum = v.cone + v.cap0 + v.cap1;
  const float scale = sum > 0.0f ? 1.0f / sum : 0.0f;
  v.cone *= scale;
  v.cap0 *= scale;
  v.cap1 *= scale;
  return v;
}

// Returns the density per area at height z of the cone, including the probability of this part.
static inline float cone_density(const RoundCone* k, const RoundConeView* v, float z) {
  const float arc = cone_arc(k, v), begin = k->c * k->r0, end = k->c * k->r1;
  if (!(arc > 0.0f)) return 0.0f;
  // The density is per unit of z and of arc length across: dA = R(z) dpsi dz / c.
  if (!cone_is_long(k, v))
    return v->cone * k->c * 2.0f / ((begin + end) * (k->z1 - k->z0) * 2.0f * arc);
  const float per_z = v->height / (v->angle * (sqr(v->height) + sqr(z - v->a)));
  return v->cone * k->c * per_z / (2.0f * arc * cone_radius(k, z));
}

static inline float cap_density(const RoundConeView* v, float a, float r, float h, float low,
                                float high, float chance) {
  const float arc = cap_arc(v, a, r, h);
  // At the silhouette rounding may leave no arc: such a point is never sampled.
  return arc > 0.0f && high > low ? chance / (r * r * (high - low) * 2.0f * arc) : 0.0f;
}

// Samples a point *x and its outward unit normal *n; returns the density per area, 0: nothing.
static inline float round_cone_sample(const RoundCone* k, const RoundConeView* v, float2 u,
                                      float3* x, float3* n) {
  if (u.x < v->cone) {
    const float t = u.x / v->cone, arc = cone_arc(k, v);
    float z;
    if (cone_is_long(k, v)) {
      // z is height * tan(angle of z0 + t * angle), by the addition theorem: no digits are lost
      // where both are near a right angle.
      const float begin = k->z0 - v->a, sine = sin(t * v->angle), cosine = cos(t * v->angle);
      z = v->a +
          v->height * (begin * cosine + v->height * sine) / (v->height * cosine - begin * sine);
      z = clamp(z, k->z0, k->z1);
    } else {
      z = mix(k->z0, k->z1, sample_linear(t, k->r0, k->r1));
    }
    const float psi = (2.0f * u.y - 1.0f) * arc;
    const float3 across = v->e * cos(psi) + v->f * sin(psi);
    *n = k->d * k->s + across * k->c;
    *x = k->p0 + k->d * z + across * cone_radius(k, z);
    return cone_density(k, v, z);
  }
  const int first = u.x < v->cone + v->cap0 || !(v->cap1 > 0.0f);
  const float chance = first ? v->cap0 : v->cap1;
  if (!(chance > 0.0f)) return 0.0f;
  const float t = clamp((u.x - v->cone - (first ? 0.0f : v->cap0)) / chance, 0.0f, 1.0f);
  const float low = first ? v->low0 : v->low1, high = first ? v->high0 : v->high1;
  const float r = first ? k->r0 : k->r1, offset = first ? 0.0f : k->length;
  const float h = mix(low, high, t);
  const float psi = (2.0f * u.y - 1.0f) * cap_arc(v, v->a - offset, r, h);
  const float across = sqrt(fmax(0.0f, (1.0f - h) * (1.0f + h)));
  *n = k->d * h + (v->e * cos(psi) + v->f * sin(psi)) * across;
  *x = k->p0 + k->d * offset + *n * r;
  return cap_density(v, v->a - offset, r, h, low, high, chance);
}

// Returns the density of round_cone_sample at x, a point of the surface that faces q.
static inline float round_cone_density(const RoundCone* k, const RoundConeView* v, float3 x) {
  const float3 y = x - k->p0;
  const float a = dot(y, k->d);
  const float3 off = y - k->d * a;
  const float rho = sqrt(dot(off, off));
  const float along = a * k->c - rho * k->s;
  if (!k->single && along >= 0.0f && along <= k->length * k->c)
    return v->cone > 0.0f ? cone_density(k, v, clamp(a, k->z0, k->z1)) : 0.0f;
  const int first = k->single || along < 0.0f;
  const float offset = first ? 0.0f : k->length;
  const float chance = first ? v->cap0 : v->cap1;
  if (!(chance > 0.0f)) return 0.0f;
  const float h = clamp((a - offset) / sqrt(sqr(a - offset) + rho * rho), -1.0f, 1.0f);
  if (h < k->low || h > k->high) return 0.0f;
  return first ? cap_density(v, v->a, k->r0, h, v->low0, v->high0, chance)
               : cap_density(v, v->a - offset, k->r1, h, v->low1, v->high1, chance);
}

#endif
