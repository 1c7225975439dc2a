// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file lists every device buffer, in groups that live and are used together. Kernel
// signatures, the structs that kernel functions take, allocation, byte counts and argument binding
// on the host all expand from these lists. The including file defines
//   GROUP_BEGIN(Type, group)
//       Tree, tree: the struct of its buffers and the name that stages use for it
//   BUFFER(name, type, access)
//       access: ONE (a record, read only), IN (an array, read only) or STATE; path buffers that
//       only some renders have: STATE_LAYERS (BatchRecord.layer_floats a path), STATE_CONES,
//       STATE_SIDES, STATE_MEDIA, STATE_TIMES
//   GROUP_END(Type)
// and writes GROUP_TREE, or ALL_GROUPS. Arrays of scenes that may lie in parts (math/floats.cl) are
// rows BUFFER and PARTS(name, type); PARTS is nothing unless the including file defines it anew.
// Valid as OpenCL C 1.2 and as C++.
#ifndef CAPLET_SHARED_GROUPS_H
#define CAPLET_SHARED_GROUPS_H

#define PARTS(name, type)
#define BUFFER_IN_PARTS(name, type) BUFFER(name, type, IN) PARTS(name, type)

// --- The scene ---

// Rays are traced through these buffers. Kernels for scenes in which something moves know the
// time that a Tree is of (groups.cl).
#define TREE_TIME
#define GROUP_TREE                                               \
  GROUP_BEGIN(Tree, tree)                                        \
  BUFFER(world, WorldRecord, ONE)                                 \
  BUFFER_IN_PARTS(nodes, float)  /* CAPLET_NODE_FLOATS a node */ \
  BUFFER_IN_PARTS(leaves, float) /* blocks of rows, shapes.def */ \
  BUFFER(instances, InstanceRecord, IN)                          \
  TREE_TIME                                                      \
  GROUP_END(Tree)

// These buffers tell about a hit after it is found.
#define GROUP_SURFACES                                                                             \
  GROUP_BEGIN(Surfaces, surfaces)                                                                  \
  BUFFER(geometries, GeometryRecord, IN)                                                           \
  /* which geometry a primitive is of (geometry_of, shapes.h): pages, then tables of mixed ones */ \
  BUFFER(primitive_geometry, uint, IN)                                                             \
  /* by GeometryRecord.surface_begin + surface: a material, and CAPLET_SURFACE_DARK */             \
  BUFFER(surface_materials, uint, IN)                                                              \
  BUFFER(mesh_indices, uint, IN) /* vertex numbers within the mesh */                              \
  BUFFER(mesh_normals, float, IN)                                                                  \
  BUFFER(mesh_uvs, float, IN)                                                                      \
  GROUP_END(Surfaces)

#define GROUP_SPECTRA                                                  \
  GROUP_BEGIN(Spectra, spectra)                                        \
  BUFFER(spectra, SpectrumRecord, IN)                                  \
  BUFFER(spectrum_tables, float, IN) /* CAPLET_LAMBDA_COUNT a table, or CAPLET_UPLIFT_FLOATS */ \
  GROUP_END(Spectra)

#define GROUP_MATERIALS             \
  GROUP_BEGIN(Materials, materials) \
  BUFFER(materials, MaterialRecord, IN) \
  BUFFER(material_data, float, IN)  /* materials.def */ \
  BUFFER(textures, TextureRecord, IN) \
  BUFFER(texture_data, float, IN)  /* textures.def */ \
  BUFFER(images, ImageRecord, IN) \
  BUFFER_IN_PARTS(texels, uint)  /* by ImageRecord */ \
  GROUP_END(Materials)

#define GROUP_LIGHTS                                                                                            \
  GROUP_BEGIN(Lights, lights)                                                                                   \
  BUFFER(lighting, LightingRecord, ONE)                                                                          \
  BUFFER(lights, LightRecord, IN)                                                                               \
  BUFFER(light_data, float, IN) /* lights.def */                                                                \
  BUFFER(light_alias, AliasRecord, IN)                                                                          \
  BUFFER(light_nodes, uint, IN)  /* of the light tree, CAPLET_LIGHT_NODE each (lights/tree.cl) */               \
  BUFFER(light_places, uint, IN) /* of each light and, behind them, of each of its nodes: where it stands in a node, or CAPLET_NONE */ \
  /* of the lights' pictures (lights.def). In colour: 4 a texel, sigmoid c0 c1 c2, scale (times the */          \
  /* illuminant) */                                                                                             \
  BUFFER_IN_PARTS(light_texels, float)                                                                          \
  BUFFER_IN_PARTS(light_cdf, float)    /* what they are sampled by (environment.cl, portal.cl) */ \
  GROUP_END(Lights)

#define GROUP_MEDIA                                                                     \
  GROUP_BEGIN(Media, media)                                                             \
  BUFFER(mediums, MediumRecord, IN)                                                     \
  BUFFER(media_data, float, IN)       /* media.def */                                   \
  BUFFER_IN_PARTS(media_grids, float) /* by MediumRecords' data */                      \
  BUFFER(boundaries, BoundaryRecord, IN)                                                \
  BUFFER(geometry_boundary, uint, IN) /* by number of the geometry; CAPLET_NONE: none */ \
  GROUP_END(Media)

// These tables are the same for every scene.
#define GROUP_OBSERVER                                                                                                    \
  GROUP_BEGIN(Observer, observer)                                                                                         \
  BUFFER(observer, float, IN)         /* CAPLET_LAMBDA_COUNT times x y z of the CIE 1931 observer over the integral of y, and 0 */ \
  BUFFER(wavelength_table, float, IN) /* wavelength at u = i / CAPLET_WAVELENGTH_CELLS (inverse of the sampling CDF, linear between) */ \
  GROUP_END(Observer)

// --- A view of the scene ---

#define GROUP_VIEW             \
  GROUP_BEGIN(View, view)      \
  BUFFER(view, ViewRecord, ONE) \
  GROUP_END(View)

#define GROUP_CAMERA                                                                                             \
  GROUP_BEGIN(Camera, camera)                                                                                    \
  BUFFER(camera, CameraRecord, ONE)                                                                               \
  /* an axis after the other: positions (n + 1), cdf of |f| (n + 1), values (n + 1), integral of |f| over that of f */ \
  BUFFER(filter_table, float, IN)                                                                                \
  /* the motion of world_from_camera (math/motion.cl), then the lens (camera/realistic.cl) */                     \
  BUFFER(camera_table, float, IN)                                                                                \
  GROUP_END(Camera)

// --- Paths under way ---

#define GROUP_BATCH              \
  GROUP_BEGIN(Batch, batch)      \
  BUFFER(batch, BatchRecord, ONE) /* and the PixelRecords of a listed batch */ \
  GROUP_END(Batch)

#define GROUP_RAYS                   \
  GROUP_BEGIN(Rays, rays)            \
  BUFFER(path_ray, RayRecord, STATE) \
  BUFFER(path_hit, HitRecord, STATE) \
  GROUP_END(Rays)

// Scenes in which something moves have these: when a path sees the scene, in [0, 1) from the
// opening of the shutter to its closing.
#define GROUP_TIMES                      \
  GROUP_BEGIN(Times, times)              \
  BUFFER(path_time, float, STATE_TIMES)  \
  GROUP_END(Times)

#define GROUP_RADIANCE                   \
  GROUP_BEGIN(Radiance, radiance)        \
  BUFFER(path_radiance, float4, STATE)   \
  GROUP_END(Radiance)

// A path carries these from one scattering to the next.
#define GROUP_CARRIED                                                                                           \
  GROUP_BEGIN(Carried, carried)                                                                                 \
  BUFFER(path_throughput, float4, STATE)       /* at the four wavelengths */                                    \
  BUFFER(path_wavelengths, float4, STATE)      /* nm */                                                         \
  BUFFER(path_wavelength_pdfs, float4, STATE)  /* 1/nm; 0: wavelength dropped */                                \
  /* pdf of the last direction (solid angle), product of eta scales, bits of the light of the primitive that it */ \
  /* refracted through (or CAPLET_NONE), unused */                                                              \
  BUFFER(path_scatter, float4, STATE)                                                                           \
  BUFFER(path_normal, uint, STATE_SIDES) /* with a light tree: normal_bits of the last scattering, or CAPLET_NONE */ \
  BUFFER(path_flags, uint, STATE) /* PATH_... of stages/path.cl; bits 8..31: depth */                              \
  GROUP_END(Carried)

// Textured scenes have these: the width of a path's ray where it begins (world), and its growth
// with each unit of length.
#define GROUP_CONES                     \
  GROUP_BEGIN(Cones, cones)             \
  BUFFER(path_cone, float2, STATE_CONES)      \
  GROUP_END(Cones)

#define GROUP_LAYERS                                                                            \
  GROUP_BEGIN(Layers, layers)                                                                   \
  BUFFER(path_layers, float, STATE_LAYERS) /* BatchRecord.layer_floats a path: the HIT_ and ID_LAYERs of layers.def */ \
  GROUP_END(Layers)

#define GROUP_SHADOWS                                                                               \
  GROUP_BEGIN(Shadows, shadows)                                                                     \
  BUFFER(path_shadow, RayRecord, STATE)                                                             \
  BUFFER(path_shadow_target, ShadowTarget, STATE)                                                   \
  BUFFER(path_shadow_radiance, float4, STATE) /* added to path_radiance when the shadow ray is free */ \
  BUFFER(queue_shadow, uint, STATE)           /* paths with a shadow ray */                         \
  GROUP_END(Shadows)

// Scenes with media have these.
#define GROUP_MEDIUM_STACKS                                                                                     \
  GROUP_BEGIN(MediumStacks, medium_stacks)                                                                         \
  BUFFER(path_inside, uint4, STATE_MEDIA) /* solids that hold the ray, and the medium around them (media/medium_stack.cl) */ \
  BUFFER(path_around, uint, STATE_MEDIA)                                                                    \
  BUFFER(path_within, uint, STATE_MEDIA) /* scatterings that do not count: within subsurfaces (stages/within.cl) */ \
  BUFFER(path_near, uint, STATE_MEDIA) /* whether other surfaces are where it comes to: CAPLET_ALONE, ... (kinds.h) */ \
  /* densities with which scattering, and a light sample, would have made the path at each wavelength, over the mean of the first (media/sample_distance.cl) */ \
  BUFFER(path_ratio, float4, STATE_MEDIA)                                                                   \
  BUFFER(path_light_ratio, float4, STATE_MEDIA)                                                             \
  BUFFER(shadow_inside, uint4, STATE_MEDIA)                                                                 \
  BUFFER(shadow_around, uint, STATE_MEDIA)                                                                  \
  BUFFER(shadow_near, uint, STATE_MEDIA)                                                                    \
  BUFFER(shadow_pdfs, float2, STATE_MEDIA) /* of the light sample, and of scattering into its direction (0: a delta light) */ \
  GROUP_END(MediumStacks)

#define GROUP_QUEUES                                                        \
  GROUP_BEGIN(Queues, queues)                                               \
  BUFFER(queue, uint, STATE)      /* paths whose ray is to be extended */   \
  BUFFER(queue_next, uint, STATE) /* those of the round after */            \
  GROUP_END(Queues)

#define GROUP_SORT                                                  \
  GROUP_BEGIN(Sort, sort)                                           \
  BUFFER(sort_keys, uint, STATE) /* by position in queue_next */    \
  BUFFER(sort_bins, uint, STATE)                                    \
  GROUP_END(Sort)

#define GROUP_COUNTERS                                            \
  GROUP_BEGIN(Counters, counters)                                 \
  BUFFER(counters, uint, STATE) /* counter_next, ... (limits.h) */ \
  GROUP_END(Counters)

// --- The film ---

#define GROUP_FILM               \
  GROUP_BEGIN(Film, film)        \
  /* BatchRecord.film_words a pixel, from pixel film_begin on: samples, then the sums of layers.def */ \
  BUFFER(film, ulong, STATE)                                                  \
  GROUP_END(Film)

// --- Queries ---

#define GROUP_QUERY                    \
  GROUP_BEGIN(Query, query)            \
  BUFFER(query, QueryRecord, ONE)       \
  BUFFER(query_rays, RayRecord, STATE) \
  BUFFER(query_times, float, STATE) /* as path_time; one number where nothing moves */ \
  GROUP_END(Query)

#define GROUP_CROSSINGS                                                                              \
  GROUP_BEGIN(Crossings, crossings)                                                                  \
  BUFFER(query_hits, HitRecord, STATE) /* QueryRecord.capacity a ray */                              \
  BUFFER(query_counts, uint, STATE)    /* hits of each ray; capacity + 1: more than were kept */     \
  BUFFER(query_begin, uint, STATE)     /* first of each ray's records in `picks` */                  \
  GROUP_END(Crossings)

// Queries of many worlds have these: a tree of its own places the instances of each.
#define GROUP_WORLDS                 \
  GROUP_BEGIN(Worlds, worlds)        \
  BUFFER(world_roots, uint, STATE) /* by world: the first node of its tree */ \
  GROUP_END(Worlds)

#define GROUP_PICKS                 \
  GROUP_BEGIN(Picks, picks)         \
  BUFFER(picks, PickRecord, STATE)  \
  GROUP_END(Picks)

// All shading takes these groups.
#define SHADING_GROUPS GROUP_TREE GROUP_SURFACES GROUP_SPECTRA GROUP_MATERIALS GROUP_LIGHTS GROUP_OBSERVER
#define SCENE_GROUPS SHADING_GROUPS GROUP_MEDIA
#define VIEW_GROUPS GROUP_VIEW GROUP_CAMERA
#define PATH_GROUPS \
  GROUP_BATCH GROUP_RAYS GROUP_TIMES GROUP_RADIANCE GROUP_CARRIED GROUP_CONES GROUP_LAYERS GROUP_SHADOWS GROUP_MEDIUM_STACKS GROUP_QUEUES GROUP_SORT GROUP_COUNTERS
#define QUERY_GROUPS GROUP_QUERY GROUP_CROSSINGS GROUP_WORLDS GROUP_PICKS
#define ALL_GROUPS SCENE_GROUPS VIEW_GROUPS PATH_GROUPS GROUP_FILM QUERY_GROUPS

#endif
