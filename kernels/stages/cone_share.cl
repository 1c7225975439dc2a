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

// Of a pixel's width: samples of a pixel overlap, so that their mean is smooth, and what is between them is not blurred twice.
#define CAPLET_CONE_SHARE 0.5f

#endif
