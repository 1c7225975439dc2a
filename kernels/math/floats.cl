// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// An array of the scene, which lies in one buffer, or in four parts where the device allows no
// buffer of the size of one of them (host/render/detail/array_parts.h). Only programs for the
// latter are built with CAPLET_PART, the floats by which parts begin one after the other. A part
// goes on beyond the next one's begin, so that what begins in a part can be read from it.
#ifndef CAPLET_MATH_FLOATS_CL
#define CAPLET_MATH_FLOATS_CL

#ifdef CAPLET_PART
typedef struct {
  __global const float* part0;
  __global const float* part1;
  __global const float* part2;
  __global const float* part3;
  size_t begin;
} Floats;

// Returns where float `place` lies.
static inline __global const float* floats_at(Floats floats, size_t place) {
  place += floats.begin;
  const size_t part = min(place / CAPLET_PART, (size_t)3);  // the last one goes on to the end
  __global const float* const begin = part == 0   ? floats.part0
                                      : part == 1 ? floats.part1
                                      : part == 2 ? floats.part2
                                                  : floats.part3;
  return begin + (place - part * CAPLET_PART);
}

// Returns the array from float `begin` on.
static inline Floats floats_from(Floats floats, size_t begin) {
  floats.begin += begin;
  return floats;
}

// Returns where byte number `byte` behind float `place` lies. Numbers of two and of four bytes
// whose place is a multiple of their size can be read from there.
static inline __global const uchar* bytes_at(Floats floats, size_t place, size_t byte) {
  return (__global const uchar*)floats_at(floats, place + byte / 4u) + byte % 4u;
}
#else
typedef __global const float* Floats;

static inline __global const float* floats_at(Floats floats, size_t place) {
  return floats + place;
}

static inline Floats floats_from(Floats floats, size_t begin) { return floats + begin; }

static inline __global const uchar* bytes_at(Floats floats, size_t place, size_t byte) {
  return (__global const uchar*)(floats + place) + byte;
}
#endif

#endif
