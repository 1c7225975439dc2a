// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The equal-area octahedral map (Clarberg 2008) unfolds an octahedron into a square, here a grid of
// texels. Valid as OpenCL C 1.2 and as C++.
#ifndef CAPLET_SHARED_OCTAHEDRON_H
#define CAPLET_SHARED_OCTAHEDRON_H

// Finds the texel that (x, y) stands for, each at most one image beyond: the other half of an edge
// continues beyond that edge.
static inline void fold_over_edges(int* x, int* y, int width, int height) {
  if (*x < 0 || *x >= width) {
    *x = *x < 0 ? -1 - *x : 2 * width - 1 - *x;
    *y = height - 1 - *y;
  }
  if (*y < 0 || *y >= height) {
    *y = *y < 0 ? -1 - *y : 2 * height - 1 - *y;
    *x = width - 1 - *x;
  }
}

#endif
