// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A work-item does one of `item_count` items of `stage`, or its share of them. Stages that find
// their data at random places define STAGE_LOOKS_AHEAD to prefetch those of the next items, because
// CPUs do one work-item after the other.
#ifdef STAGE_TAKES_SHARES
const uint share = (item_count - 1u) / (uint)get_global_size(0) + 1u,
           first = (uint)get_global_id(0) * share;
if (first < item_count) stage_share(&stage, first, min(item_count, first + share));
#else
const uint item = (uint)get_global_id(0);
#ifdef STAGE_LOOKS_AHEAD
stage_ahead(&stage, item, item_count);
#endif
if (item < item_count) stage_item(&stage, item);
#endif
