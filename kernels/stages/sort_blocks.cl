// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the tree of sums over the sort bins: behind the bins lie the sums of blocks of
// BatchRecord.sort_fan bins, behind these the sums of blocks of as many sums, and so on until there
// is one. Items of sort_sums and sort_prefix are its blocks, the lowest first.
#ifndef CAPLET_STAGES_SORT_BLOCKS_CL
#define CAPLET_STAGES_SORT_BLOCKS_CL

#include "shared/records.h"

typedef struct {
  uint first, count;  // what it is the sum of
  uint place;         // of the sum
  int is_last;        // the sum of everything
} SortBlock;

static inline SortBlock sort_block(__global const BatchRecord* batch, uint item) {
  const uint fan = batch->sort_fan;
  uint begin = 0, size = 8u << (3u * batch->sort_bits);
  SortBlock block;
  block.place = size + item;
  uint above = (size - 1u) / fan + 1u;
  while (item >= above && above > 1u) {
    item -= above;
    begin += size;
    size = above;
    above = (size - 1u) / fan + 1u;
  }
  block.first = begin + item * fan;
  block.count = min(fan, size - item * fan);
  block.is_last = above == 1u;
  return block;
}

#endif
