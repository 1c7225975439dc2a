// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The entry point of a stage, included at the end of its file after
//   #define STAGE_NAME extend
//   static void stage_item(const Globals* g, uint item) { ... }

// Work-items compute with float8 where eight primitives are tested at once: compilers that run work-items side by side must not do so
// on top of it. Without this hint Intel's of 2025 and later are slow, and wrong where functions are called (docs/drivers.md).
#if CAPLET_REAL_WIDTH == 8
__attribute__((vec_type_hint(float8)))
#endif
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
