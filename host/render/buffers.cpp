// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/buffers.h"

namespace caplet {

namespace {

std::size_t floats_per_path(Layers layers) {
  FilmLayout layout;
  layout.layers = layers;
  return layout.floats_per_path();
}

template <class T>
std::span<const T> contents(const std::vector<T>& values) {
  return values;
}
template <class T>
std::span<const T> contents(const T& record) {
  return {&record, 1};
}

}  // namespace

#define GROUP_BEGIN(Type, group) \
  {                              \
    auto& buffers = this->group;
#define BUFFER(name, type, access) buffers.name = Buffer<type>(device, contents(flat.name));
#define GROUP_END(Type) }
SceneBuffers::SceneBuffers(const Device& device, const FlatScene& flat){
    SCENE_GROUPS} SensorBuffers::SensorBuffers(const Device& device, const FlatView& flat) {
  VIEW_GROUPS
}
#undef BUFFER

// Every buffer of the paths has a place for each, but for these.
PathBuffers::PathBuffers(const Device& device, std::size_t paths, std::size_t sort_bins, Layers of_film) {
#define BUFFER(name, type, access) buffers.name = Buffer<type>(device, std::size_t{count_##access});
  constexpr std::size_t count_ONE = 1;
  const std::size_t count_STATE = paths;
  PATH_GROUPS
#undef BUFFER
  layers.path_layers = Buffer<float>(device, paths * floats_per_path(of_film));
  sort.sort_bins = Buffer<uint>(device, sort_bins);
  counters.counters = Buffer<uint>(device, std::size_t{counter_count});
}
#undef GROUP_BEGIN
#undef GROUP_END

#define GROUP_BEGIN(Type, group) bindings.group = &this->group;
#define BUFFER(name, type, access)
#define GROUP_END(Type)
void SceneBuffers::bind(Bindings& bindings) const { SCENE_GROUPS }
void SensorBuffers::bind(Bindings& bindings) const { VIEW_GROUPS }
void PathBuffers::bind(Bindings& bindings) const {PATH_GROUPS}
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END

std::uint64_t PathBuffers::bytes_per_path(Layers of_film) {
  std::uint64_t bytes = (floats_per_path(of_film) - 1) * sizeof(float);
#define GROUP_BEGIN(Type, group)
#define BUFFER(name, type, access) bytes += bytes_##access * sizeof(type);
#define GROUP_END(Type)
  constexpr std::uint64_t bytes_ONE = 0, bytes_STATE = 1;
  PATH_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
  return bytes;
}

}  // namespace caplet
