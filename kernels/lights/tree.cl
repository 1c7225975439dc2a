// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The light tree serves scenes with many lights of which few matter at a point. A node has eight
// children, and one is chosen with a probability in proportion to a bound on its light: the least
// cosines at the light and at the receiver, over the squared distance (Conty Estevez and Kulla,
// "Importance sampling of many lights with adaptive tree splitting", 2018). Bounds are
// conservative, so that every light that can arrive has a probability above 0.
// host/lower/light_tree.cpp makes it.
//
// A node is seven rows of eight numbers, a child each: of x, of y and of z both ends on the grid
// (low in bits 0..15, high 16..31); the axis of a cone (normal_bits); in 65535ths of [-1, 1] the
// cosine of the cone that holds the normals (bits 0..15) and of how far from these light goes
// (16..31); intensity, a float; the child: a node, a light | CAPLET_LIGHT_LEAF, or CAPLET_NONE.
#ifndef CAPLET_LIGHTS_TREE_CL
#define CAPLET_LIGHTS_TREE_CL

#include "lights/light_types.cl"
#include "math/rng.cl"
#include "shapes/real.cl"

// Returns a direction in 32 bits by the octahedral map (Cigolle et al., "A survey of efficient
// representations for independent unit vectors", 2014). It is never CAPLET_NONE.
static inline uint normal_bits(float3 n) {
  const float scale = 1.0f / (fabs(n.x) + fabs(n.y) + fabs(n.z));
  float x = n.x * scale, y = n.y * scale;
  if (n.z < 0.0f) {
    const float fold = (1.0f - fabs(y)) * (x < 0.0f ? -1.0f : 1.0f);
    y = (1.0f - fabs(x)) * (y < 0.0f ? -1.0f : 1.0f);
    x = fold;
  }
  const uint low = (uint)(x * 32767.0f + 32767.5f), high = (uint)(y * 32767.0f + 32767.5f);
  return low | high << 16;
}

static inline float3 normal_of_bits(uint bits) {
  const float x = (float)(bits & 0xffffu) * (1.0f / 32767.0f) - 1.0f,
              y = (float)(bits >> 16) * (1.0f / 32767.0f) - 1.0f;
  const float z = 1.0f - fabs(x) - fabs(y), back = fmax(-z, 0.0f);
  return normalize((float3)(x + (x < 0.0f ? back : -back), y + (y < 0.0f ? back : -back), z));
}

// LightReceiver is where light arrives: a point of the world, and the normal_bits of the side that
// takes it, or CAPLET_NONE for all sides.
typedef struct {
  float3 p;
  uint normal;
} LightReceiver;

#ifdef CAPLET_LIGHT_TREE

#if CAPLET_REAL_WIDTH == 8
typedef uint8 real_uint;
static inline real_uint uint_load(__global const uint* row, uint lane) {
  (void)lane;
  return vload8(0, row);
}
static inline real real_of_uint(real_uint x) { return convert_float8(x); }
static inline real real_of_bits(real_uint x) { return as_float8(x); }
#else
typedef uint real_uint;
static inline real_uint uint_load(__global const uint* row, uint lane) { return row[lane]; }
static inline real real_of_uint(real_uint x) { return (float)x; }
static inline real real_of_bits(real_uint x) { return as_float(x); }
#endif

// Returns the cosine of the angle a - b, or 1 where a is the smaller one, of angles by their
// cosines and sines; in *sine its sine.
static inline real cosine_beyond(real cos_a, real sin_a, real cos_b, real sin_b, real* sine) {
  const real_mask beyond = cos_a < cos_b;
  *sine = beyond ? sin_a * cos_b - cos_a * sin_b : real_of(0.0f);
  return beyond ? cos_a * cos_b + sin_a * sin_b : real_of(1.0f);
}
static inline real sine_of(real cosine) {
  return sqrt(real_max(1.0f - cosine * cosine, real_of(0.0f)));
}

// Returns how much light the lanes' children may send; 0: none.
static inline real light_importance(const Lights* lights, __global const uint* node, uint lane,
                                    const LightReceiver* at) {
  const real zero = real_of(0.0f), one = real_of(1.0f);
  __global const LightingRecord* grid = lights->lighting;
  const real_uint x = uint_load(node, lane), y = uint_load(node + 8, lane),
                  z = uint_load(node + 16, lane);
  const float half_x = 0.5f * grid->tree_cell[0], half_y = 0.5f * grid->tree_cell[1],
              half_z = 0.5f * grid->tree_cell[2];
  const real low_x = real_of_uint(x & 0xffffu), low_y = real_of_uint(y & 0xffffu),
             low_z = real_of_uint(z & 0xffffu);
  const real high_x = real_of_uint(x >> 16u), high_y = real_of_uint(y >> 16u),
             high_z = real_of_uint(z >> 16u);
  // d goes from the receiver to the middle of the box; r is half its sides.
  const real dx = grid->tree_min[0] - at->p.x + half_x * (low_x + high_x),
             dy = grid->tree_min[1] - at->p.y + half_y * (low_y + high_y),
             dz = grid->tree_min[2] - at->p.z + half_z * (low_z + high_z);
  const real rx = half_x * (high_x - low_x), ry = half_y * (high_y - low_y),
             rz = half_z * (high_z - low_z);
  const real dd = real_max(real_dot(dx, dy, dz, dx, dy, dz), real_of(FLT_MIN)),
             rr = real_dot(rx, ry, rz, rx, ry, rz);
  const real inv = 1.0f / sqrt(dd);
  const real wx = dx * inv, wy = dy * inv, wz = dz * inv;
  // cos_box and sin_box are of the angle that the ball around the box fills.
  const real_mask within = dd <= rr;
  const real share = real_min(rr / dd, one);
  const real cos_box = within ? -one : sqrt(1.0f - share), sin_box = within ? zero : sqrt(share);

  const real_uint axis = uint_load(node + 24, lane), cones = uint_load(node + 32, lane);
  real ax = real_of_uint(axis & 0xffffu) * (1.0f / 32767.0f) - 1.0f,
       ay = real_of_uint(axis >> 16u) * (1.0f / 32767.0f) - 1.0f;
  const real az = 1.0f - fabs(ax) - fabs(ay), back = real_max(-az, zero);
  ax += ax < 0.0f ? back : -back;
  ay += ay < 0.0f ? back : -back;
  const real along = -real_dot(ax, ay, az, wx, wy, wz) / sqrt(real_dot(ax, ay, az, ax, ay, az));
  const real cos_axis = real_min(real_max(along, -one), one);
  const real cos_cone = real_of_uint(cones & 0xffffu) * (2.0f / 65535.0f) - 1.0f,
             cos_reach = real_of_uint(cones >> 16u) * (2.0f / 65535.0f) - 1.0f;
  real sine;
  const real cos_normal =
      cosine_beyond(cos_axis, sine_of(cos_axis), cos_cone, sine_of(cos_cone), &sine);
  const real cos_light = cosine_beyond(cos_normal, sine, cos_box, sin_box, &sine);

  // Near and within the box the importance is that at a squared distance of a third of rr, which
  // points of a box have in the mean.
  real importance = real_of_bits(uint_load(node + 40, lane)) * real_max(cos_light, zero) /
                    real_max(dd, rr * (1.0f / 3.0f));
  if (at->normal != CAPLET_NONE) {
    const float3 n = normal_of_bits(at->normal);
    const real cos_n = real_min(real_max(wx * n.x + wy * n.y + wz * n.z, -one), one);
    importance *= real_max(cosine_beyond(cos_n, sine_of(cos_n), cos_box, sin_box, &sine), zero);
  }
  return cos_light > cos_reach ? real_min(importance, real_of(0x1p100f)) : zero;
}

// Computes the probabilities of a node's children, whose sum is 1. Returns 0 if none of them can be
// seen. The root distributes a sixteenth evenly over the children it has, so that lights behind a
// wall do not take nearly all samples.
static inline int light_chances(const Lights* lights, uint number, const LightReceiver* at,
                                float* chances) {
  __global const uint* node = lights->light_nodes + (size_t)number * CAPLET_LIGHT_NODE;
  for (uint lane = 0; lane < CAPLET_WIDTH; lane += CAPLET_REAL_WIDTH)
    real_store(light_importance(lights, node, lane, at), chances + lane);
  float sum = 0.0f, seen = 0.0f;
  for (uint i = 0; i < CAPLET_WIDTH; i++) {
    sum += chances[i];
    seen += chances[i] > 0.0f ? 1.0f : 0.0f;
  }
  if (!(sum > 0.0f)) return 0;
  const float even = number == 0u ? 0.0625f : 0.0f;
  for (uint i = 0; i < CAPLET_WIDTH; i++)
    chances[i] = chances[i] > 0.0f ? chances[i] / sum * (1.0f - even) + even / seen : 0.0f;
  return 1;
}

// Returns a light of the tree by the random number u in [0, 1), and its probability. CAPLET_NONE:
// none can be seen. `bits`: more random bits, because u has too few to select each of a million
// lights.
static inline uint light_of_tree(const Lights* lights, const LightReceiver* at, float u, uint bits,
                                 float* chance) {
  float chances[CAPLET_WIDTH];
  *chance = 1.0f;
  for (uint number = 0;;) {
    if (!light_chances(lights, number, at, chances)) return CAPLET_NONE;
    uint slot = 0;
    float before = 0.0f, sum = 0.0f;
    for (uint i = 0; i < CAPLET_WIDTH; i++) {
      if (!(chances[i] > 0.0f)) continue;
      slot = i;
      before = sum;
      sum += chances[i];
      if (u < sum) break;
    }
    *chance *= chances[slot];
    bits = hash_mix(bits);
    u = fmin((u - before + (float)(bits >> 8) * 0x1p-48f) / chances[slot], 0x1.fffffep-1f);
    const uint child =
        lights->light_nodes[(size_t)number * CAPLET_LIGHT_NODE + CAPLET_LIGHT_NODE_CHILDREN + slot];
    if (child & CAPLET_LIGHT_LEAF) return child & ~CAPLET_LIGHT_LEAF;
    number = child;
  }
}

// Returns the probability of a light of the tree in light_of_tree.
static inline float light_tree_chance(const Lights* lights, uint light, const LightReceiver* at) {
  float chances[CAPLET_WIDTH], chance = 1.0f;
  for (uint place = lights->light_places[light]; place != CAPLET_NONE;) {
    const uint number = place / CAPLET_WIDTH;
    if (!light_chances(lights, number, at, chances)) return 0.0f;
    chance *= chances[place % CAPLET_WIDTH];
    place = lights->light_places[lights->lighting->light_count + number];
  }
  return chance;
}
#endif

#endif
