// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Copies queue_next into queue, in the order of the sort keys. The order within a bin is free:
// paths do not depend on each other.

static void stage_item(const Stage* g, uint item) {
  g->queues.queue[atomic_inc(&g->sort.sort_bins[g->sort.sort_keys[item]])] =
      g->queues.queue_next[item];
}
