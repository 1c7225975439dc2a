// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// queue_next into queue, in the order of the sort keys. The order within a bin is free: paths do not see each other.
#include "globals.cl"

#define STAGE_NAME sort_scatter
static void stage_item(const Globals* g, uint item) {
  g->queue[atomic_inc(&g->sort_bins[g->sort_keys[item]])] = g->queue_next[item];
}
#include "stages/kernel.cl"
