// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes the layout of every record as this device has it (host/device/layout.cpp reads it). For
// each record its size, then for each field the offset of its address, the offset its value was
// loaded from, and its size. out[0] counts the values.
#include "shared/records.h"

// Word i of `words` holds 0x40000000 + 4 i: an ordinary float that tells its offset in bytes.
#define PUT(value)                     \
  {                                    \
    const uint value_ = (uint)(value); \
    if (n < capacity) out[n] = value_; \
    ++n;                               \
  }
#define PUT_FIELD(field, first)                                              \
  PUT((__global const uchar*)&record->field - (__global const uchar*)record) \
  PUT(as_uint(first) - 0x40000000u)                                          \
  PUT(sizeof(record->field))

__kernel void layout(__global uint* out, uint capacity, __global const uint* words) {
  uint n = 1;
#define RECORD_BEGIN(name)                                     \
  {                                                            \
    __global const name* record = (__global const name*)words; \
    PUT((__global const uchar*)(record + 1) - (__global const uchar*)record)
#define FIELD(type, name) PUT_FIELD(name, record->name)
#define ARRAY(type, name, count) PUT_FIELD(name, record->name[0])
#define RECORD_END(name, bytes) }
#include "shared/records.def"
#undef RECORD_BEGIN
#undef FIELD
#undef ARRAY
#undef RECORD_END
  out[0] = n;
}
