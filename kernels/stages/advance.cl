// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// One work-item moves the counters on: the paths that go on become those of the next round.

static void stage_item(const Stage* g, uint item) {
  __global uint* counters = g->counters.counters;
  if (item > 0) return;
  counters[counter_bounces] += counters[counter_next];
  counters[counter_shadows] += counters[counter_shadow];
  counters[counter_queued] = counters[counter_next];
  counters[counter_next] = 0;
  counters[counter_shadow] = 0;
}
