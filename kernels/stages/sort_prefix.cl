// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Computes exclusive prefix sums of the sort bins, in place: each block begins where the one above
// it says, from the last level down to the bins. With all bins in one block one work-item adds up a
// few thousand numbers.
#include "stages/sort_blocks.cl"

static void stage_item(const Stage* g, uint item) {
  const SortBlock block = sort_block(g->batch.batch, item);
  uint sum = block.is_last ? 0u : g->sort.sort_bins[block.place];
  for (uint i = 0; i < block.count; ++i) {
    const uint count = g->sort.sort_bins[block.first + i];
    g->sort.sort_bins[block.first + i] = sum;
    sum += count;
  }
}
