// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds sizes that host and kernels share. Valid as OpenCL C 1.2 and as C++.
#ifndef CAPLET_SHARED_LIMITS_H
#define CAPLET_SHARED_LIMITS_H

// Every spectral table has these wavelengths, in nanometres: 1 nm steps, both ends included.
#define CAPLET_LAMBDA_MIN 360.0f
#define CAPLET_LAMBDA_MAX 830.0f
#define CAPLET_LAMBDA_COUNT 471
// The table that wavelengths are sampled by has this many steps.
#define CAPLET_WAVELENGTH_CELLS 1024

// The table of sigmoids by colour (math/uplift.cl) has these sizes: which channel is the largest,
// its value, and the two others as parts of it.
#define CAPLET_UPLIFT_VALUES 24
#define CAPLET_UPLIFT_RATIOS 32
#define CAPLET_UPLIFT_FLOATS \
  (3 * CAPLET_UPLIFT_VALUES * CAPLET_UPLIFT_RATIOS * CAPLET_UPLIFT_RATIOS * 3)

// These are sizes of the tree.
#define CAPLET_WIDTH 8
#define CAPLET_NODE_FLOATS \
  56  // six rows of eight bounds (lox loy loz hix hiy hiz), one row of eight child references
#define CAPLET_NODE_CHILDREN 48  // the first child reference of a node
#define CAPLET_PACKED_NODE_FLOATS \
  24  // the same in bytes, for rays that are traced one at a time (kernels/trace/packed.cl)
#define CAPLET_TREE_DEPTH_MAX \
  40  // nodes on the longest path of one tree, of which bvh makes all but one (host/lower/encode.cpp);
      // the traversal's stack relies on it

// These are sizes of the light tree (kernels/lights/tree.cl).
#define CAPLET_LIGHT_NODE 56           // numbers a node
#define CAPLET_LIGHT_NODE_CHILDREN 48  // the first child reference of these
#define CAPLET_LIGHT_LEAF 0x80000000u  // of a child: a light
#define CAPLET_MOTION_FLOATS 48    // of a matrix that moves, by segment of time (math/motion.cl)
#define CAPLET_LIGHT_TREE_FROM 16  // lights: fewer are chosen by the table alone

#define CAPLET_SPARSE_MAJORANT_CELLS 64
#define CAPLET_MAJORANT_CELLS \
  16  // along each side of a medium that varies (kernels/media/majorants.cl)

#define CAPLET_SLOTS 16  // of a pixel in a SLOT_LAYER (layers.def)
#define CAPLET_DEEP_SHIFT \
  17  // a deep sample holds distances whose bits are the same without so many

#define CAPLET_CSG_MAX_OPERANDS 32
#define CAPLET_TEXTURE_MAX_STEPS \
  32  // of a texture: itself, and the textures and constants that it is made of

#ifdef __cplusplus
namespace caplet {
#endif

// Stages count these (Counters.counters).
enum {
  counter_queued,      // paths of this round
  counter_next,        // those that go on
  counter_shadow,      // shadow rays
  counter_not_finite,  // samples dropped because their radiance was not a number
  counter_bounces,     // paths that went on and shadow rays, of rounds that the host did not ask
                       // about, modulo 2^32
  counter_shadows,
  counter_count
};

#ifdef __cplusplus
}
#endif

#endif
