// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file finds surfaces that light passes through unchanged.
#ifndef CAPLET_MEDIA_PASSING_CL
#define CAPLET_MEDIA_PASSING_CL

#include "groups.cl"
#include "slots.cl"

static inline int material_passes(const Materials* materials, uint material) {
  switch (materials->materials[material].kind) {
#define MATERIAL(name, traits) \
  case material_##name:        \
    return ((traits)&trait_passes) != 0;
#define CHOICE(name, traits)
#include "rows/materials.def"
#undef MATERIAL
    default: return 0;
  }
}

// Returns whether the surface of a hit lets light pass.
static inline int surface_passes(const Tree* tree, const Surfaces* surfaces,
                                 const Materials* materials, const HitRecord* hit) {
  const uint primitive = primitive_at(tree, hit->slot);
  __global const GeometryRecord* geometry = surfaces->geometries + geometry_of(surfaces, primitive);
  uint material = geometry->material;
  if (geometry->surface_begin != CAPLET_NONE)
    material =
        surfaces
            ->surface_materials[geometry->surface_begin + (hit->surface & CAPLET_SURFACE_MASK)] &
        ~CAPLET_SURFACE_DARK;
  return material_passes(materials, material);
}

#endif
