// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The entry point of a stage, included at the end of its file after
//   #define STAGE_NAME extend
//   static void stage_item(const Globals* g, uint item) { ... }
__kernel void STAGE_NAME(
#define BUFFER(name, type, access) access(type) name,
#include "shared/buffers.def"
#undef BUFFER
    uint item_count) {
  const Globals globals = {
#define BUFFER(name, type, access) name,
#include "shared/buffers.def"
#undef BUFFER
      0};
  const uint item = (uint)get_global_id(0);
  if (item < item_count) stage_item(&globals, item);
}
