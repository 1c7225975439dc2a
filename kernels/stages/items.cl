// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A work-item does one of `item_count` items of `stage`, or its share of them. Many items come as
// rows of work-items (launch_items of host/device/device.h). Stages that find their data at random
// places define STAGE_LOOKS_AHEAD to prefetch those of the next items, because CPUs do one
// work-item after the other.
const uint work_item = (uint)(get_global_id(1) * get_global_size(0) + get_global_id(0));
#ifdef STAGE_TAKES_SHARES
const uint share = (item_count - 1u) / (uint)(get_global_size(0) * get_global_size(1)) + 1u,
           first = work_item * share;
if (first < item_count) stage_share(&stage, first, min(item_count, first + share));
#else
#ifdef STAGE_LOOKS_AHEAD
stage_ahead(&stage, work_item, item_count);
#endif
if (work_item < item_count) stage_item(&stage, work_item);
#endif
