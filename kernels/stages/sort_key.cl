// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Rays that start in the same cell and go into the same octant visit the same nodes.
#ifndef CAPLET_STAGES_SORT_KEY_CL
#define CAPLET_STAGES_SORT_KEY_CL

static inline uint spread_bits_3(uint x) {
  x = (x | (x << 16)) & 0x030000ffu;
  x = (x | (x << 8)) & 0x0300f00fu;
  x = (x | (x << 4)) & 0x030c30c3u;
  x = (x | (x << 2)) & 0x09249249u;
  return x;
}

static inline uint sort_cell(float x, float center, float radius, float cells) {
  return (uint)clamp((x - center + radius) * (0.5f * cells / radius), 0.0f, cells - 1.0f);
}

// Returns the octant above the Morton code of the origin's cell: 2^(3 sort_bits + 3) keys.
static inline uint sort_key(__global const WorldRecord* world, uint sort_bits, float3 origin,
                            float3 direction) {
  const float cells = (float)(1u << sort_bits), radius = fmax(world->radius, 1e-30f);
  const uint x = sort_cell(origin.x, world->center_x, radius, cells);
  const uint y = sort_cell(origin.y, world->center_y, radius, cells);
  const uint z = sort_cell(origin.z, world->center_z, radius, cells);
  const uint morton = spread_bits_3(x) | (spread_bits_3(y) << 1) | (spread_bits_3(z) << 2);
  const uint octant = (direction.x < 0.0f ? 1u : 0u) | (direction.y < 0.0f ? 2u : 0u) |
                      (direction.z < 0.0f ? 4u : 0u);
  return (morton << 3) | octant;
}

#endif
