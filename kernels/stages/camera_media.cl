// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the boundaries that contain the camera: for the first path, or for each one if their rays
// begin at different points.
#include "stages/crossings.cl"
#include "stages/times.cl"

static void stage_item(const Stage* g, uint item) {
  SEE_AT(PATH_TIME(g, item));
  RayRecord ray = g->rays.path_ray[item];
  // With a clipping plane rays may begin there.
  if (ray.t_min > 0.0f && ray.t_min < INFINITY) {
    ray.ox += ray.t_min * ray.dx;
    ray.oy += ray.t_min * ray.dy;
    ray.oz += ray.t_min * ray.dz;
  }
  ray.t_min = 0.0f;
  ray.dx = 0.371391f;
  ray.dy = 0.557086f;
  ray.dz = 0.742781f;  // any direction that scenes do not prefer
  const MediumStack nothing = {(uint4)(0u), g->camera.camera->medium};
  const MediumStack stack = medium_stack_counted(&g->tree, &g->surfaces, &g->media, ray, nothing);
  g->medium_stacks.path_inside[item] = stack.inside;
  g->medium_stacks.path_around[item] = stack.around;
}
