// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A work-item appends paths to queues through an outbox. One that does a share of the items takes a
// block of places at once: if every path took its own place, the cores of a CPU would pass the
// counter's cache line around (decision 26).
#ifndef CAPLET_STAGES_OUTBOX_CL
#define CAPLET_STAGES_OUTBOX_CL

#if CAPLET_REAL_WIDTH == 8
#define STAGE_TAKES_SHARES
#define CAPLET_OUTBOX_PATHS 64u
typedef struct {
  uint next_count, shadow_count;
  uint next[CAPLET_OUTBOX_PATHS], keys[CAPLET_OUTBOX_PATHS], shadow[CAPLET_OUTBOX_PATHS];
} Outbox;

static inline void send_next(const Stage* g, Outbox* box) {
  const uint count = box->next_count;
  if (count == 0) return;
  box->next_count = 0;
  const uint begin = atomic_add(&g->counters.counters[counter_next], count);
  for (uint i = 0; i < count; i++) g->queues.queue_next[begin + i] = box->next[i];
  if (g->batch.batch->sort_bits == CAPLET_NONE) return;
  for (uint i = 0; i < count; i++) {
    g->sort.sort_keys[begin + i] = box->keys[i];
    atomic_inc(&g->sort.sort_bins[box->keys[i]]);
  }
}

static inline void send_shadow(const Stage* g, Outbox* box) {
  const uint count = box->shadow_count;
  if (count == 0) return;
  box->shadow_count = 0;
  const uint begin = atomic_add(&g->counters.counters[counter_shadow], count);
  for (uint i = 0; i < count; i++) g->shadows.queue_shadow[begin + i] = box->shadow[i];
}

// Appends a path that goes on, with its sort key, where there is one.
static inline void append_next(const Stage* g, Outbox* box, uint path, uint key) {
  if (box->next_count == CAPLET_OUTBOX_PATHS) send_next(g, box);
  box->next[box->next_count] = path;
  box->keys[box->next_count++] = key;
}

// Appends a path's shadow ray to those to be traced.
static inline void append_shadow(const Stage* g, Outbox* box, uint path) {
  if (box->shadow_count == CAPLET_OUTBOX_PATHS) send_shadow(g, box);
  box->shadow[box->shadow_count++] = path;
}

static inline void outbox_open(Outbox* box) { box->next_count = box->shadow_count = 0; }

static inline void outbox_send(const Stage* g, Outbox* box) {
  send_next(g, box);
  send_shadow(g, box);
}
#else
typedef struct {
  uint none;
} Outbox;

static inline void append_next(const Stage* g, Outbox* box, uint path, uint key) {
  (void)box;
  const uint position = atomic_inc(&g->counters.counters[counter_next]);
  g->queues.queue_next[position] = path;
  if (g->batch.batch->sort_bits == CAPLET_NONE) return;
  g->sort.sort_keys[position] = key;
  atomic_inc(&g->sort.sort_bins[key]);
}

static inline void append_shadow(const Stage* g, Outbox* box, uint path) {
  (void)box;
  g->shadows.queue_shadow[atomic_inc(&g->counters.counters[counter_shadow])] = path;
}
#endif

#endif
