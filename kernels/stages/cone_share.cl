// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file says whether rays are cones, and how wide the cones of camera rays are.
#ifndef CAPLET_STAGES_CONE_SHARE_CL
#define CAPLET_STAGES_CONE_SHARE_CL

enum {
  has_cones = 0
#define TEXTURE(name) || 1
#include "rows/textures.def"
#undef TEXTURE
};

// A camera ray's cone has this share of a pixel's width: that of pbrt-v4's differentials from 64
// samples a pixel on. It does not depend on the number of samples, so that no picture does
// (decision 14).
#define CAPLET_CONE_SHARE 0.125f

#endif
