// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Things that are hidden.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace caplet::view {

/// Things and their indices among all things, in ascending order.
template <class T>
using HiddenList = std::vector<std::pair<std::size_t, std::shared_ptr<const T>>>;
/// The things that are left out of the picture.
struct Hidden {
  HiddenList<Shape> shapes;
  HiddenList<Instance> instances;
  bool empty() const { return shapes.empty() && instances.empty(); }
};
using HiddenPointer = std::shared_ptr<const Hidden>;

}  // namespace caplet::view
