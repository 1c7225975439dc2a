// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The pure folders of kernels/ as functions of the host: compiled from the same text
// (host_kernels.cl), for both widths. Valid as OpenCL C and as C++.
#ifndef CAPLET_TESTS_HOST_KERNELS_H
#define CAPLET_TESTS_HOST_KERNELS_H

#include "shared/groups.h"
#include "shared/records.h"

#ifdef __cplusplus
namespace caplet::test {
#define __global
// The arrays of the groups of a scene and a view, by their names.
#define ONE(type) const type*
#define IN(type) const type*
#define GROUP_BEGIN(Type, group) struct Type##Arrays {
#define BUFFER(name, type, access) access(type) name = nullptr;
#define GROUP_END(Type) \
  }                     \
  ;
SCENE_GROUPS VIEW_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
#undef ONE
#undef IN
    struct HostGroups {
#define GROUP_BEGIN(Type, group) Type##Arrays group;
#define BUFFER(name, type, access)
#define GROUP_END(Type)
  SCENE_GROUPS VIEW_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
      const float* packed_nodes = nullptr;  // of the tree, for width 1
};
extern "C" {
#endif

// `Surface`, of scalars.
typedef struct {
  float p[3], ng[3], ns[3], dpdu[3], dpdv[3], uv[2], error;
  uint geometry, primitive, surface, material, light;
  int leaving;
} HostSurface;

typedef struct {
  float wi[3], target[3], radiance[4], pdf;
  int infinite, delta;
} HostLightSample;

typedef struct {
  float wi[3], weight[4], pdf, eta_scale;
  int specular, transmitted;
} HostBsdfSample;

typedef struct {
  float filter_weight, lambda[4], lambda_pdf[4];
} HostCameraSample;

// One ray and what is asked of it, and all that the kernels say. `found` fields tell which others
// have a meaning.
#define HOST_LIST_CAPACITY 8
typedef struct {
  RayRecord ray;
  float u[8], lambda[4];
  uint x, y;
} HostQuestion;

typedef struct {
  HitRecord closest, list[HOST_LIST_CAPACITY];
  uint count;
  int any, found_surface, found_light, found_area, found_scattered;
  HostSurface surface;
  PickRecord pick;
  HostLightSample light;
  float emitted[4], area_pdf, sky[4];
  HostBsdfSample scattered;
  float scattered_value[4], scattered_pdf, albedo[4];
  RayRecord camera_ray;
  HostCameraSample camera;
} HostAnswer;

#define HOST_KERNEL(result, name, arguments) \
  result host_##name##_8 arguments;          \
  result host_##name##_1 arguments;
#include "host_kernels.def"
#undef HOST_KERNEL

#ifdef __cplusplus
}  // extern "C"
#undef __global

// All of them, of one width.
struct HostKernels {
#define __global
#define HOST_KERNEL(result, name, arguments) result(*name) arguments;
#include "host_kernels.def"
#undef HOST_KERNEL
#undef __global
};

inline const HostKernels& host_kernels(int width) {
  static const HostKernels wide = {
#define HOST_KERNEL(result, name, arguments) host_##name##_8,
#include "host_kernels.def"
#undef HOST_KERNEL
  };
  static const HostKernels scalar = {
#define HOST_KERNEL(result, name, arguments) host_##name##_1,
#include "host_kernels.def"
#undef HOST_KERNEL
  };
  return width == 8 ? wide : scalar;
}

}  // namespace caplet::test
#endif
#endif
