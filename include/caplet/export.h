// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The symbols that the library exports.
#pragma once

#define CAPLET_API __attribute__((visibility("default")))

/// Names of the library are caplet::Name. The inner namespace changes when programs must be
/// recompiled, so that an old program fails to link instead of misbehaving.
#ifdef CAPLET_INSIDE
// The library's own sources use the same names for other classes, so there the public one is
// v0::Scene.
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
