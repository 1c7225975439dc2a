// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the entry point of a stage: its groups' buffers are the arguments (arguments.cl). A
// work-item does one item, or its share of them: of `item_count`, or of as many as a counter says
// (CAPLET_NONE: no counter), for stages that have the counters. Launches may begin at a later item.

// Work-items compute with float8 where eight primitives are tested at once, and their control flow
// diverges where primitives are tested one by one: compilers must not put several of them into one
// vector. Without this hint Intel's compilers of 2025 and later do, which is slow in both
// encodings, and wrong where functions are called (docs/drivers.md).
__attribute__((vec_type_hint(float8))) __kernel void STAGE_NAME(
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) access(type) name,
#define GROUP_END(Type)
    STAGE_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
        uint item_count,
    uint counter) {
  const Stage stage = {
#define GROUP_BEGIN(Type, group) {
#define BUFFER(name, type, access) name,
#define GROUP_END(Type) \
  }                     \
  ,
      STAGE_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
  };
#ifdef STAGE_IS_COUNTED
  // The launch is for as many items as there may be. Without any the buffers may be null
  // (Program::prepare).
  if (item_count > 0 && counter != CAPLET_NONE)
    item_count = min(item_count, stage.counters.counters[counter]);
#endif
#include "stages/items.cl"
}
