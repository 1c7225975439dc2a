// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes the sum of a block of sort bins, or of sums: level by level, from the bins on.
#include "stages/sort_blocks.cl"

static void stage_item(const Stage* g, uint item) {
  const SortBlock block = sort_block(g->batch.batch, item);
  uint sum = 0;
  for (uint i = 0; i < block.count; ++i) sum += g->sort.sort_bins[block.first + i];
  g->sort.sort_bins[block.place] = sum;
}
