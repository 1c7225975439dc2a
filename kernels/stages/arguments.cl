// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file makes the groups of one stage a struct. A stage's program is the text
//   #define STAGE_NAME extend
//   #define STAGE_IS_COUNTED   (if GROUP_COUNTERS is one of its groups)
//   #define STAGE_GROUPS GROUP_TREE GROUP_RAYS   (its row of shared/stages.def or queries.def)
//   #include "stages/arguments.cl"
//   #include "stages/extend.cl"                  (defines stage_item)
//   #include "stages/kernel.cl"
#include "groups.cl"

#define GROUP_BEGIN(Type, group) Type group;
#define BUFFER(name, type, access)
#define GROUP_END(Type)
typedef struct {
  STAGE_GROUPS
} Stage;
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
