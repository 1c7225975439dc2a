// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Replaces operator new by one that counts. A file of its own: where it is inlined, GCC takes new
// and free for a mismatch.
#include "counted_new.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::uint64_t> allocated{0};
}

std::uint64_t caplet::test::allocated_bytes() { return allocated; }

void* operator new(std::size_t size) {
  allocated += size;
  if (void* p = std::malloc(size > 0 ? size : 1)) return p;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return operator new(size); }
void operator delete(void* p) noexcept { std::free(p); }
void operator delete[](void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete[](void* p, std::size_t) noexcept { std::free(p); }
