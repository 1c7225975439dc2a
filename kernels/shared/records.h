// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This file defines the records of records.def as plain structs, and asserts their sizes. Valid as
// OpenCL C 1.2 and as C++.
#ifndef CAPLET_SHARED_RECORDS_H
#define CAPLET_SHARED_RECORDS_H

#include "shared/kinds.h"

#ifdef __cplusplus
#include <cstdint>
namespace caplet {
using uint = std::uint32_t;
using ulong = std::uint64_t;
struct float2 {
  float x, y;
};
struct float4 {
  float x, y, z, w;
};
struct uint4 {
  uint x, y, z, w;
};
#define CAPLET_SIZE_ASSERT(name, bytes) static_assert(sizeof(name) == (bytes) && (bytes) % 16 == 0, #name);
#else
#define CAPLET_SIZE_ASSERT(name, bytes) typedef char name##_size_assert[(sizeof(name) == (bytes) && (bytes) % 16 == 0) ? 1 : -1];
#endif

#define RECORD_BEGIN(name) typedef struct name {
#define FIELD(type, name) type name;
#define ARRAY(type, name, count) type name[count];
#define RECORD_END(name, bytes) \
  }                             \
  name;                         \
  CAPLET_SIZE_ASSERT(name, bytes)
#include "shared/records.def"
#undef RECORD_BEGIN
#undef FIELD
#undef ARRAY
#undef RECORD_END

#ifdef __cplusplus
}
#endif
#endif
