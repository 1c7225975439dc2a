// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes gradient noise (Perlin, "Improving noise", SIGGRAPH 2002, with the permutation published
// there) and sums of its octaves (Pharr, Jakob and Humphreys 2023, 10.6, as pbrt-v4 has them).
#ifndef CAPLET_TEXTURES_NOISE_CL
#define CAPLET_TEXTURES_NOISE_CL

#include "textures/mapping.cl"

__constant uchar noise_permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

// Returns the product of v with one of twelve directions to the edges of a cube, chosen by the
// whole coordinates of a corner.
static inline float noise_gradient(int3 corner, float3 v) {
  const uint a = (uint)noise_permutation[corner.x & 255] + (uint)corner.y;
  const uint b = (uint)noise_permutation[a & 255u] + (uint)corner.z;
  const uint h = noise_permutation[b & 255u] & 15u;
  const int diagonal = h == 12u || h == 13u;
  const float first = h < 8u || diagonal ? v.x : v.y, second = h < 4u || diagonal ? v.y : v.z;
  return ((h & 1u) != 0u ? -first : first) + ((h & 2u) != 0u ? -second : second);
}

static inline float noise_between(int3 corner, float3 v, float weight) {
  const float low = noise_gradient(corner, v),
              high = noise_gradient(corner + (int3)(1, 0, 0), v - (float3)(1.0f, 0.0f, 0.0f));
  return low + weight * (high - low);
}

// Returns noise in (-1, 1), 0 at whole points. It is 0 beyond 2^24, where all floats are whole, and
// for NaN.
static inline float noise_at(float3 p) {
  if (!(max3(fabs(p)) < 16777216.0f)) return 0.0f;
  const float3 whole = floor(p), v = p - whole;
  // The corners' numbers count modulo 256.
  const int3 corner = (int3)((int)whole.x & 255, (int)whole.y & 255, (int)whole.z & 255);
  const float3 w = v * v * v * (v * (v * 6.0f - 15.0f) + 10.0f);
  const int3 y = (int3)(0, 1, 0), z = (int3)(0, 0, 1);
  const float3 fy = (float3)(0.0f, 1.0f, 0.0f), fz = (float3)(0.0f, 0.0f, 1.0f);
  const float x00 = noise_between(corner, v, w.x), x10 = noise_between(corner + y, v - fy, w.x);
  const float x01 = noise_between(corner + z, v - fz, w.x),
              x11 = noise_between(corner + y + z, v - fy - fz, w.x);
  const float y0 = x00 + w.y * (x10 - x00), y1 = x01 + w.y * (x11 - x01);
  return y0 + w.z * (y1 - y0);
}

// Returns how many octaves, up to `octaves`, a footprint resolves: those whose cells are twice as
// large.
static inline float noise_octaves(TextureXYZ at, uint octaves) {
  const float widest = fmax(dot(at.dx, at.dx), dot(at.dy, at.dy));
  return clamp(-1.0f - 0.5f * log2(fmax(widest, 1e-37f)), 0.0f, (float)octaves);
}

static inline float noise_fade(float x) {
  const float t = clamp((x - 0.3f) / 0.4f, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

// Sums octaves of noise, each 1.99 times as fine as the last and `roughness` times as high; the
// last fades out.
static inline float noise_fbm(TextureXYZ at, float roughness, uint octaves) {
  const float seen = noise_octaves(at, octaves);
  const int whole = (int)seen;
  float sum = 0.0f, fine = 1.0f, high = 1.0f;
  for (int i = 0; i <= whole; ++i) {
    const float weight = i < whole ? 1.0f : noise_fade(seen - (float)whole);
    if (weight > 0.0f) sum += weight * high * noise_at(fine * at.p);
    fine *= 1.99f;
    high *= roughness;
  }
  return sum;
}

// Sums octaves of the magnitude of noise; its mean of 0.2 stands for octaves that are not resolved.
static inline float noise_turbulence(TextureXYZ at, float roughness, uint octaves) {
  const float seen = noise_octaves(at, octaves);
  const int whole = (int)seen;
  float sum = 0.0f, fine = 1.0f, high = 1.0f;
  for (int i = 0; i <= whole; ++i) {
    const float weight = i < whole ? 1.0f : noise_fade(seen - (float)whole);
    sum += high * (0.2f + weight * (fabs(noise_at(fine * at.p)) - 0.2f));
    // pbrt-v4 counts the mean of the octave that fades a second time, where there are more.
    if (i == whole)
      for (int rest = whole; rest < (int)octaves; ++rest, high *= roughness) sum += high * 0.2f;
    fine *= 1.99f;
    high *= roughness;
  }
  return sum;
}

#endif
