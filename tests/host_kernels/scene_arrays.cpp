// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "host_kernels/scene_arrays.h"

#include <memory>

#include "lower/packed_nodes.h"

namespace caplet::test {

namespace {

/// An empty array gives a place of no bytes, as devices have one too, since kernels add an offset
/// of 0 to it.
template <class T>
const T* first(const std::vector<T>& values) {
  static const auto nothing = std::make_unique<T[]>(0);
  return values.empty() ? nothing.get() : values.data();
}
template <class T>
const T* first(const T& value) {
  return &value;
}

}  // namespace

// A copied vector has no room to spare.
SceneArrays::SceneArrays(const LoweredModel& model)
    : model_(model), packed_nodes_(packed_nodes(model.scene.nodes)) {
  groups_.packed_nodes = packed_nodes_.data();
#define GROUP_BEGIN(Type, group) \
  {                              \
    auto& arrays = groups_.group;
#define BUFFER(name, type, access) arrays.name = first(flat.name);
#define GROUP_END(Type) }
  {
    const FlatScene& flat = model_.scene;
    SCENE_GROUPS
  }
  {
    const FlatView& flat = model_.view;
    VIEW_GROUPS
  }
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
}

}  // namespace caplet::test
