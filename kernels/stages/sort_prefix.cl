// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Exclusive prefix sums of the sort bins, in place, by one work-item: a few thousand additions.
#include "globals.cl"

#define STAGE_NAME sort_prefix
static void stage_item(const Globals* g, uint item) {
  const uint bins = 8u << (3u * g->params->sort_bits);
  uint sum = 0;
  for (uint i = item; i < bins; ++i) {
    const uint count = g->sort_bins[i];
    g->sort_bins[i] = sum;
    sum += count;
  }
}
#include "stages/kernel.cl"
