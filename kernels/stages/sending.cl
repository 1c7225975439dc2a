// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the work-item of a stage that fills queues; the including file defines sending_item(g,
// out, item).
#ifdef STAGE_TAKES_SHARES
static void stage_share(const Stage* g, uint begin, uint end) {
  Outbox out;
  outbox_open(&out);
  for (uint item = begin; item < end; item++) {
#ifdef STAGE_LOOKS_AHEAD
    stage_ahead(g, item, end);
#endif
    sending_item(g, &out, item);
  }
  outbox_send(g, &out);
}
#else
static void stage_item(const Stage* g, uint item) {
  Outbox none;
  sending_item(g, &none, item);
}
#endif
