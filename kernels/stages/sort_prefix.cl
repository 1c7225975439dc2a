// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Exclusive prefix sums of the sort bins, in place, by one work-item: a few thousand additions.

static void stage_item(const Stage* g, uint item) {
  const uint bins = 8u << (3u * g->batch.batch->sort_bits);
  uint sum = 0;
  for (uint i = item; i < bins; ++i) {
    const uint count = g->sort.sort_bins[i];
    g->sort.sort_bins[i] = sum;
    sum += count;
  }
}
