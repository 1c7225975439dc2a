// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file holds ids of everything that has kinds, expanded from the .def lists. Valid as OpenCL C
// 1.2 and as C++.
#ifndef CAPLET_SHARED_KINDS_H
#define CAPLET_SHARED_KINDS_H

#include "shared/limits.h"

#ifdef __cplusplus
namespace caplet {
#endif

enum {
#define SHAPE(name, traits) shape_##name,
#include "shared/shapes.def"
#undef SHAPE
  shape_count
};

// Traits of shapes (shapes.def).
enum {
  trait_solid = 1,     // closed and convex: a line is in it once or not at all; may be an operand of csg
  trait_sheet = 2,     // open: its two sides are told apart by a normal alone
  trait_compound = 4,  // made of other shapes
  trait_own_light = 8,    // as a light sampled by itself (lights/area.cl)
  trait_ball_light = 16,  // as a light sampled by a ball around it (lights/shapes/ball.cl)
  trait_kept_box = 32,    // its data do not tell its box: the host keeps it behind them
  trait_stands_straight = 64,  // its data do not hold a rotation: turned it is placed by an instance
  trait_rare = 128,  // its test takes many registers: done apart where rays are traced one at a time
                     // (trace/single.cl)
  trait_moves = 256,  // its data change with time: programs for scenes at rest have no code of it
  trait_linked = 512  // its leaf blocks hold points that neighbours share (shapes.h); never a light
};

enum {
#define MATERIAL(name, traits) material_##name,
#include "shared/materials.def"
#undef MATERIAL
  material_count
};

// Traits of materials (materials.def).
enum {
  trait_dispersive = 1,  // directions depend on its `index`: where that varies with wavelength, CAPLET_MATERIAL_DISPERSIVE
  trait_opaque = 2,      // it scatters light on the side alone that it comes from
  trait_stochastic = 4,  // its values are estimates, by random numbers of its own (Bsdf.random), and its densities approximate
  trait_metal_base = 8,  // a coat over a metal (layered.cl)
  trait_passes = 16,     // light goes on as if there were nothing: it may bound a medium
  trait_sheer = 32       // opaque where its transmittance (Bsdf) is 0
};

enum {
#define CAMERA(name, Type) camera_##name,
#include "shared/cameras.def"
#undef CAMERA
  camera_count
};

enum {
#define SAMPLER(name) sampler_##name,
#include "shared/samplers.def"
#undef SAMPLER
  sampler_count
};

enum {
#define TEXTURE(name) texture_##name,
#include "shared/textures.def"
#undef TEXTURE
  texture_count
};

enum {
#define LIGHT(name, way) light_##name,
#include "shared/lights.def"
#undef LIGHT
  light_count
};

enum {
#define MEDIUM(name, way) medium_##name,
#include "shared/media.def"
#undef MEDIUM
  medium_count
};

enum {
#define SPECTRUM(name) spectrum_##name,
#include "shared/spectra.def"
#undef SPECTRUM
  spectrum_count
};

enum {
#define RADIANCE_LAYER(name, option, channels, how, count, words, unit, value) layer_##name,
#define HIT_LAYER(name, option, channels, how, count, words, unit, value) layer_##name,
#define ID_LAYER(name, option, channel, value) layer_##name,
#define SLOT_LAYER(name, option, channels, how, words, unit, value) layer_##name,
#include "shared/layers.def"
#undef RADIANCE_LAYER
#undef HIT_LAYER
#undef ID_LAYER
#undef SLOT_LAYER
  layer_count
};

// CAPLET_NONE is "none" for any index: instance of a world-space primitive, geometry without light,
// mesh without normals.
#define CAPLET_NONE 0xffffffffu

// A child reference of a wide node is a node if >= 0. If < 0 it is a leaf block: bit 31 set, then
// the shape kind in CAPLET_LEAF_KIND_BITS bits, then the block's first row in `leaves` (a row is 8
// floats). An empty child has an empty box (low +inf, high -inf) and is never entered. Scenes
// without kinds of high numbers keep more bits for rows: the option of this name tells programs the
// number of bits.
#ifndef CAPLET_LEAF_KIND_BITS
#define CAPLET_LEAF_KIND_BITS (shape_count <= 16 ? 4 : shape_count <= 32 ? 5 : 6)
#endif
#define CAPLET_LEAF_ROW_BITS (31 - CAPLET_LEAF_KIND_BITS)
#define CAPLET_LEAF_KIND(reference) ((uint)(reference) >> CAPLET_LEAF_ROW_BITS & ((1u << CAPLET_LEAF_KIND_BITS) - 1u))
#define CAPLET_LEAF_ROW(reference) ((uint)(reference) & ((1u << CAPLET_LEAF_ROW_BITS) - 1u))

// GeometryRecord.flags
#define CAPLET_GEOMETRY_FLIP_NORMAL 1u     // ReverseOrientation, for meshes xor a mirroring transform
#define CAPLET_GEOMETRY_EMIT_BOTH_SIDES 2u // AreaLightSource "bool twosided"
#define CAPLET_GEOMETRY_CHAIN 4u           // capsules with u at their ends
#define CAPLET_GEOMETRY_OPEN 8u            // a sheet that encloses nothing
#define CAPLET_GEOMETRY_NORMALS 16u        // a mesh with normals at its vertices
// LightRecord.flags
#define CAPLET_LIGHT_BOTH_SIDES 1u
#define CAPLET_LIGHT_UNSEEN 2u             // of a shape with the number 0 for alpha: rays never meet it
// This is the first bit of eight for each end of a capsule: how many 255ths of its cap, by height
// from the top down, are not sampled (host/lower/detail/covered_ends.h).
#define CAPLET_LIGHT_COVER_0 16
#define CAPLET_LIGHT_COVER_1 24
// InstanceRecord.flags
#define CAPLET_INSTANCE_MIRRORED 1u        // negative determinant
#define CAPLET_INSTANCE_NO_LEAVING 2u      // leaving hits within are not seen ("onesided")
#define CAPLET_INSTANCE_NO_ENTERING 4u     // entering ones (open shapes of reversed orientation)
// HitRecord.surface
#define CAPLET_LEAVING 0x10000             // seen from inside; open shapes: along the normal
#define CAPLET_CLIPPED 0x20000             // on the face that the clipping plane makes, not on the surface
#define CAPLET_CLIPPED_REVERSED 0x40000    // and the normals of its solid point inward
#define CAPLET_SURFACE_MASK 0xffffu
// surface_materials
#define CAPLET_SURFACE_DARK 0x80000000u    // this surface of an emitting shape does not emit
// Ends of cylinders and cones, as floats in their rows
#define CAPLET_CAP_FLAT 0.0f
#define CAPLET_CAP_ROUND 1.0f
#define CAPLET_CAP_OPEN 2.0f
// A csg program holds these codes; numbers below them are operands.
#define CAPLET_CSG_UNION 0x100u
#define CAPLET_CSG_INTERSECTION 0x101u
#define CAPLET_CSG_DIFFERENCE 0x102u
#define CAPLET_CSG_SUBTRACTED 0x80000000u  // with an operand's first surface: its normals flip
// These limit GGX roughness (as in pbrt-v4). A surface whose roughness is below the first in both
// directions is a perfect mirror or a clear interface, because its lobe is narrower than the
// rounding of a normal in binary32 can resolve; otherwise each direction has at least the second.
#define CAPLET_ALPHA_SMOOTH 1e-3f
#define CAPLET_ALPHA_MIN 1e-4f
// MaterialRecord.flags
#define CAPLET_MATERIAL_DISPERSIVE 1u      // eta varies with wavelength: refraction keeps only the hero wavelength
#define CAPLET_MATERIAL_MULTISCATTER 2u    // what one scattering loses is made up for (bsdf/multiscatter.cl)

// HitRecord.slot has this value for a path that has ended, or was scattered, before what it hit.
#define CAPLET_SCATTERED 0xfffffffeu
// Texels of a level are floats, bytes, or 16-bit halves of words that index the table's values.
#define CAPLET_TEXELS_FLOATS 0u
#define CAPLET_TEXELS_BYTES 1u
#define CAPLET_TEXELS_NUMBERS 2u
// MediumRecord.flags
#define CAPLET_MEDIUM_SUBSURFACE 1u  // what scatters within counts as one with the boundary
// BoundaryRecord.flags
#define CAPLET_BOUNDARY_SHEET 1u   // surfaces without an inside of their own: their normals say which side is in
#define CAPLET_BOUNDARY_CLOSED 2u  // solids, and sheets that are closed: the crossings of a ray tell whether a point is within
// These limit the boundaries that are told apart at a point, and the numbers of boundaries in a
// scene.
#define CAPLET_MEDIUM_STACK_SIZE 4
#define CAPLET_MOST_BOUNDARIES 0xfffffeu
// path_near is one of these: the surface is alone; other surfaces are at the same place; the same,
// plus the number of the largest boundary that is left there; the boundaries that contain the ray
// must be counted.
#define CAPLET_ALONE 0u
#define CAPLET_NEAR 1u
#define CAPLET_NEAR_LEFT 2u
#define CAPLET_RECOUNT 0xffffffffu

// Fields of textures (textures.def) use this to say how colours of an image become spectra.
#define CAPLET_USE_ALBEDO 0u     // from 0 to 1
#define CAPLET_USE_UNBOUNDED 1u  // from 0 up
#define CAPLET_USE_NUMBER 2u     // floats
// These say what lies beyond an image.
#define CAPLET_WRAP_REPEAT 0u
#define CAPLET_WRAP_BLACK 1u
#define CAPLET_WRAP_CLAMP 2u
#define CAPLET_WRAP_OCTAHEDRAL 3u
#define CAPLET_FILTER_POINT 0u
#define CAPLET_FILTER_BILINEAR 1u
#define CAPLET_FILTER_TRILINEAR 2u
#define CAPLET_FILTER_EWA 3u
// These say which coordinates a texture has; the last one uses those of space.
#define CAPLET_MAPPING_UV 0u
#define CAPLET_MAPPING_SPHERICAL 1u
#define CAPLET_MAPPING_CYLINDRICAL 2u
#define CAPLET_MAPPING_PLANAR 3u
#define CAPLET_MAPPING_SOLID 4u

#ifdef __cplusplus
}
#endif
// ViewRecord::strategy says which directions a path takes, and how it finds lights.
#define CAPLET_STRATEGY_NO_MIS 1u         // light samples and scattered rays are not weighted against each other
#define CAPLET_STRATEGY_NO_LIGHTS 2u      // lights are not sampled
#define CAPLET_STRATEGY_UNIFORM 4u        // directions are uniform, not those of the BSDF
#define CAPLET_STRATEGY_SPHERE 8u         // uniform over the whole sphere, even of opaque surfaces
#define CAPLET_STRATEGY_OCCLUSION 16u     // ambient occlusion
#define CAPLET_STRATEGY_UNJITTERED 32u    // stratified samples lie in the middles of their strata
#define CAPLET_STRATEGY_REPLICATES 64u    // samples of even and of odd number are independent

#endif
