// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// When paths see the scene. Programs for scenes in which nothing moves have no times.
#ifndef CAPLET_STAGES_TIMES_CL
#define CAPLET_STAGES_TIMES_CL

#ifdef CAPLET_MOTION
#define PATH_TIME(g, path) ((g)->times.path_time[path])
#define QUERY_TIME(g, ray) ((g)->query.query_times[ray])
// From here to the end of the function `g` is the stage with the tree at this time.
#define SEE_AT(when)            \
  Stage seen_then = *g;         \
  seen_then.tree.time = (when); \
  g = &seen_then
#else
#define PATH_TIME(g, path) 0.0f
#define QUERY_TIME(g, ray) 0.0f
#define SEE_AT(when) (void)0
#endif

#endif
