// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A lowered scene in memory of exactly its size, so that AddressSanitizer sees the first access
// beyond an array.
#pragma once

#include "host_kernels/host_kernels.h"
#include "lower/lower.h"

namespace caplet::test {

struct LoweredModel {
  FlatScene scene;
  FlatView view;
};

/// Keeps its own copy of the arrays.
class SceneArrays {
 public:
  explicit SceneArrays(const LoweredModel& model);
  SceneArrays(const SceneArrays&) = delete;
  SceneArrays& operator=(const SceneArrays&) = delete;
  const HostGroups* groups() const { return &groups_; }

 private:
  LoweredModel model_;
  std::vector<float> packed_nodes_;
  HostGroups groups_;
};

}  // namespace caplet::test
