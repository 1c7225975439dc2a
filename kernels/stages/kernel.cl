// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The entry point of a stage: its groups' buffers are the arguments (arguments.cl). A work-item does one item, or its share of them.

// Work-items compute with float8 where eight primitives are tested at once: compilers that run work-items side by side must not do so
// on top of it. Without this hint Intel's of 2025 and later are slow, and wrong where functions are called (docs/drivers.md).
#if CAPLET_REAL_WIDTH == 8
__attribute__((vec_type_hint(float8)))
#endif
__kernel void STAGE_NAME(
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) access(type) name,
#define GROUP_END(Type)
    STAGE_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
    uint item_count) {
  const Stage stage = {
#define GROUP_BEGIN(Type, group) {
#define BUFFER(name, type, access) name,
#define GROUP_END(Type) },
      STAGE_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
  };
#include "stages/items.cl"
}
