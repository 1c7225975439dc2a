// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the library shows of itself.
#pragma once

#define CAPLET_API __attribute__((visibility("default")))

/// Names of the library are caplet::Name. The namespace in between changes when programs must be compiled again, so that one that
/// was not fails to link in place of going wrong.
#ifdef CAPLET_INSIDE
// The library's own sources, which have other things of the same names: v0::Scene is the public one there.
#define CAPLET_BEGIN \
  namespace caplet { \
  namespace v0 {
#else
#define CAPLET_BEGIN \
  namespace caplet { \
  inline namespace v0 {
#endif
#define CAPLET_END \
  }                \
  }
