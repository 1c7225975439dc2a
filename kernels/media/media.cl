// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds all media and the only switches over kinds of media.
//
// A medium of media.def has a file in this folder with its name, which defines
//   MediumPoint NAME_medium_at(view)  uniform: its values everywhere
//   MediumBox NAME_medium_box(view)  varying: its cells, outside which it has no density
//   MediumPoint NAME_medium_at(view, p, q)
//       varying: its values at the point p of the world, which is q in [0, 1]^3 of its box
#ifndef CAPLET_MEDIA_MEDIA_CL
#define CAPLET_MEDIA_MEDIA_CL

#include "media/majorants.cl"
#include "media/media_types.cl"
#include "media/{media}.cl"

enum {
  any_uniform_medium = 0
#define MEDIUM_IS_uniform || 1
#define MEDIUM_IS_varying
#define MEDIUM(name, way) MEDIUM_IS_##way
#include "rows/media.def"
#undef MEDIUM
};
enum {
  any_varying_medium = 0
#undef MEDIUM_IS_uniform
#undef MEDIUM_IS_varying
#define MEDIUM_IS_uniform
#define MEDIUM_IS_varying || 1
#define MEDIUM(name, way) MEDIUM_IS_##way
#include "rows/media.def"
#undef MEDIUM
};

static inline MediumView medium_view(const Media* media, const Spectra* spectra, uint medium,
                                     float4 lambda) {
  const MediumView view = {spectra, media->media_data + media->mediums[medium].data,
                           media_grids_of(media), lambda};
  return view;
}

static inline int medium_is_uniform(uint kind) {
  switch (kind) {
#define MEDIUM_IS_SO_uniform 1
#define MEDIUM_IS_SO_varying 0
#define MEDIUM(name, way) \
  case medium_##name:     \
    return MEDIUM_IS_SO_##way;
#include "rows/media.def"
#undef MEDIUM
    default: return 1;
  }
}

// Returns the mean cosine of a scattering.
static inline float medium_g(uint kind, __global const float* data) {
  switch (kind) {
#define MEDIUM(name, way) \
  case medium_##name:     \
    return name##_medium_g(data);
#include "rows/media.def"
#undef MEDIUM
    default: return 0.0f;
  }
}

// Returns the values of a uniform medium.
static inline MediumPoint medium_everywhere(uint kind, const MediumView* view) {
  switch (kind) {
#define MEDIUM_EVERYWHERE_uniform(name) \
  case medium_##name:                   \
    return name##_medium_at(view);
#define MEDIUM_EVERYWHERE_varying(name)
#define MEDIUM(name, way) MEDIUM_EVERYWHERE_##way(name)
#include "rows/media.def"
#undef MEDIUM
    default: {
      const MediumPoint nothing = {(float4)(0.0f), (float4)(0.0f), (float4)(0.0f)};
      return nothing;
    }
  }
}

// Returns the box of a medium that varies.
static inline MediumBox medium_box(uint kind, const MediumView* view) {
  switch (kind) {
#define MEDIUM_BOX_uniform(name)
#define MEDIUM_BOX_varying(name) \
  case medium_##name:            \
    return name##_medium_box(view);
#define MEDIUM(name, way) MEDIUM_BOX_##way(name)
#include "rows/media.def"
#undef MEDIUM
    default: {
      const MediumBox nothing = {view->data, view->grids, 1, (float4)(0.0f)};
      return nothing;
    }
  }
}
static inline MediumPoint medium_at(uint kind, const MediumView* view, __global const float* place,
                                    float3 p) {
  const float3 q = transform_point(place, p);
  switch (kind) {
#define MEDIUM_AT_uniform(name)
#define MEDIUM_AT_varying(name) \
  case medium_##name:           \
    return name##_medium_at(view, p, q);
#define MEDIUM(name, way) MEDIUM_AT_##way(name)
#include "rows/media.def"
#undef MEDIUM
    default: {
      const MediumPoint nothing = {(float4)(0.0f), (float4)(0.0f), (float4)(0.0f)};
      return nothing;
    }
  }
}

#endif
