// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A lowered scene in memory of exactly its size, so that AddressSanitizer sees the first access beyond an array.
#pragma once

#include "host_kernels/host_kernels.h"
#include "lower/lower.h"

namespace caplet::test {

/// Keeps its own copy of the arrays.
class SceneArrays {
 public:
  explicit SceneArrays(const FlatScene& scene);
  SceneArrays(const SceneArrays&) = delete;
  SceneArrays& operator=(const SceneArrays&) = delete;
  const Globals* globals() const { return &globals_; }

 private:
  FlatScene scene_;
  Globals globals_;
};

}  // namespace caplet::test
