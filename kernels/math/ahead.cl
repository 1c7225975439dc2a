// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Prefetches on CPUs what is read soon. GPUs have other work while they wait, and compilers without
// the builtin are not asked. NVIDIA's has it, for pointers of an address space that OpenCL C 1.2
// cannot name.
#ifndef CAPLET_MATH_AHEAD_CL
#define CAPLET_MATH_AHEAD_CL

#if CAPLET_REAL_WIDTH == 8 && defined(__has_builtin) && !defined(CAPLET_PORTABLE) && \
    !defined(__NV_CL_C_VERSION)
#if __has_builtin(__builtin_prefetch)
#define CAPLET_PREFETCH 1
#endif
#endif

// AHEAD prefetches one cache line, 64 bytes.
#ifdef CAPLET_PREFETCH
#define AHEAD(at) __builtin_prefetch((const void*)(size_t)(at), 0, 3)
#else
#define AHEAD(at) (void)(at)
#endif

// Prefetches four cache lines.
static inline void fetch_ahead(__global const float* at) {
  AHEAD(at);
  AHEAD(at + 16);
  AHEAD(at + 32);
  AHEAD(at + 48);
}

#endif
