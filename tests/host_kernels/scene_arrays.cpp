// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "host_kernels/scene_arrays.h"

namespace caplet::test {

namespace {

template <class T>
const T* first(const std::vector<T>& values) {
  return values.data();
}
template <class T>
const T* first(const T& value) {
  return &value;
}

}  // namespace

// A copied vector has no room to spare.
SceneArrays::SceneArrays(const FlatScene& scene) : scene_(scene) {
#define IN(name) globals_.name = first(scene_.name);
#define STATE(name)
#define BUFFER(name, type, access) access(name)
#include "shared/buffers.def"
#undef BUFFER
#undef STATE
#undef IN
}

}  // namespace caplet::test
