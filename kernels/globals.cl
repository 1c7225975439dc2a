// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Every stage has the arguments of buffers.def (stages/kernel.cl); a stage's functions get them as one private struct.
#ifndef CAPLET_GLOBALS_CL
#define CAPLET_GLOBALS_CL

#include "shared/records.h"

#define IN(type) __global const type* restrict
#define STATE(type) __global type* restrict

typedef struct {
#define BUFFER(name, type, access) access(type) name;
#include "shared/buffers.def"
#undef BUFFER
  int end;
} Globals;

#endif
