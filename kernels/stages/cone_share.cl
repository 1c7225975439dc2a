// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Whether rays are cones, and how wide they are of a camera's.
#ifndef CAPLET_STAGES_CONE_SHARE_CL
#define CAPLET_STAGES_CONE_SHARE_CL

enum {
  has_cones = 0
#define TEXTURE(name) || 1
#include "rows/textures.def"
#undef TEXTURE
};

// The share of a pixel's width that a camera ray's cone has: that of pbrt-v4's differentials from 64 samples a pixel
// on. It does not depend on the number of samples, so that no picture does (decision 14).
#define CAPLET_CONE_SHARE 0.125f

#endif
