// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include "base/check.h"
#include "base/memory.h"
#include "lower/packed_nodes.h"
#include "render/detail/leaf_parts.h"

namespace caplet {

namespace {

std::size_t floats_per_path(Layers layers) {
  FilmLayout layout;
  layout.layers = layers;
  return layout.floats_per_path();
}

/// PathPlaces counts the elements of a path's buffers that each path has, by their access
/// (groups.h).
struct PathPlaces {
  explicit PathPlaces(const PathNeeds& needs)
      : of_STATE_LAYERS(floats_per_path(needs.layers)),
        of_STATE_CONES(needs.cones ? 1 : 0),
        of_STATE_SIDES(needs.sides ? 1 : 0),
        of_STATE_MEDIA(needs.media ? 1 : 0),
        of_STATE_TIMES(needs.times ? 1 : 0) {}
  std::size_t of_ONE = 0, of_STATE = 1, of_STATE_LAYERS, of_STATE_CONES, of_STATE_SIDES,
              of_STATE_MEDIA, of_STATE_TIMES;
};

template <class T>
std::span<const T> contents(const std::vector<T>& values) {
  return values;
}
template <class T>
std::span<const T> contents(const T& record) {
  return {&record, 1};
}

/// Sends an array. One that lies in a file stays there where the device is a CPU.
template <class T>
Buffer<T> sent(const Device& device, std::span<const T> array, std::span<const T> in_file,
               const std::shared_ptr<const SceneArrays>& file) {
  if (device.is_cpu() && !array.empty() && array.data() == in_file.data())
    return {device, array, file};
  return {device, array};
}

// Changes nearer to each other than this are sent as one: a call costs more than so many bytes.
constexpr std::size_t joined_bytes = 256;
// A grown buffer has this much beyond its contents at most, else a quarter of them.
constexpr std::size_t most_spare_bytes = std::size_t{1} << 20;

/// Sends what changed; returns the bytes sent.
template <class T>
std::uint64_t send(const Device& device, std::span<const T> now, const ChangedRanges& changed,
                   bool all, Buffer<T>& to) {
  if (now.size() > to.size()) {
    const std::size_t spare = std::min(now.size() / 4, most_spare_bytes / sizeof(T));
    to = {};  // the old one makes room first
    to = Buffer<T>(device, now.size() + spare);
    all = true;
  }
  if (all) {
    to.write(now);
    return now.size_bytes();
  }
  std::uint64_t bytes = 0;
  for (ChangedRange range : changed.joined(joined_bytes / sizeof(T))) {
    range.end = std::min(range.end, now.size());
    if (range.begin >= range.end) continue;
    to.RawBuffer::write(&now[range.begin], range.begin * sizeof(T),
                        (range.end - range.begin) * sizeof(T));
    bytes += (range.end - range.begin) * sizeof(T);
  }
  return bytes;
}

/// Sends values and empties them. Their memory is given back part by part.
Buffer<float> sent_in_parts(const Device& device, std::vector<float>& values) {
  constexpr std::size_t part = std::size_t{1} << 21;
  Buffer<float> out(device, values.size());
  for (std::size_t begin = 0; begin < values.size(); begin += part) {
    const std::span<float> own =
        std::span(values).subspan(begin, std::min(part, values.size() - begin));
    out.RawBuffer::write(own.data(), begin * sizeof(float), own.size_bytes());
    release_pages(own.data(), own.size_bytes());
  }
  values = {};
  return out;
}

/// Does as `send` for nodes that are sent packed.
std::uint64_t send_packed(const Device& device, std::span<const float> nodes,
                          const ChangedRanges& changed, bool all, Buffer<float>& to) {
  constexpr std::size_t from_each = CAPLET_NODE_FLOATS, to_each = CAPLET_PACKED_NODE_FLOATS;
  if (all || nodes.size() / from_each * to_each > to.size())
    return send<float>(device, packed_nodes(nodes), {}, true, to);
  std::uint64_t bytes = 0;
  for (const ChangedRange& range : changed.joined(joined_bytes / sizeof(float))) {
    const std::size_t first = range.begin / from_each,
                      end = (range.end + from_each - 1) / from_each;
    const std::vector<float> packed =
        packed_nodes(nodes.subspan(first * from_each, (end - first) * from_each));
    to.RawBuffer::write(packed.data(), first * to_each * sizeof(float),
                        packed.size() * sizeof(float));
    bytes += packed.size() * sizeof(float);
  }
  return bytes;
}

/// Throws RunError that names the buffer that is too large. Arrays that stay in a file take none of
/// the device's memory.
void require_fit(const Device& device, const SceneArrays& arrays, const SceneArrays& in_file) {
  const DeviceInfo& info = device.info();
  constexpr double megabytes = 1e-6;
  const char* largest = "";
  std::uint64_t largest_bytes = 0, all_bytes = 0;
  const auto add = [&]<class T>(const char* name, std::span<const T> array,
                                std::span<const T> stays) {
    const std::uint64_t bytes = array.size_bytes();
    if (!device.is_cpu() || array.data() != stays.data()) all_bytes += bytes;
    if (bytes <= largest_bytes) return;
    largest = name;
    largest_bytes = bytes;
  };
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) add(#name, arrays.name, in_file.name);
  SCENE_GROUPS
#undef GROUP_BEGIN
#undef GROUP_END
#undef BUFFER
  const std::uint64_t left =
      info.global_bytes - std::min(info.global_bytes, device.bytes_allocated());
  if (all_bytes <= left && largest_bytes <= info.max_allocation_bytes) return;
  throw RunError(fmt::format(
      "the scene takes {:.0f} MB on a device, and {:.0f} MB in one buffer ({}); device '{}' "
      "has {:.0f} MB left, and allows "
      "{:.0f} MB in one buffer",
      static_cast<double>(all_bytes) * megabytes, static_cast<double>(largest_bytes) * megabytes,
      largest, info.name, static_cast<double>(left) * megabytes,
      static_cast<double>(info.max_allocation_bytes) * megabytes));
}

/// The arrays that a device is sent: with nodes as it walks them, and leaves divided as it allows.
struct SentArrays {
  SceneArrays arrays, in_file;  // all of them, and those that lie in a file
  std::vector<float> packed;    // nodes, where they are sent packed
  std::size_t leaf_distance = 0;

  /// Throws RunError when they do not fit.
  SentArrays(const Device& device, const FlatScene& flat, Encoding encoding)
      : arrays(flat.arrays()), in_file(flat.in_file ? *flat.in_file : SceneArrays{}) {
    for (SceneArrays* of : {&in_file, &arrays}) {
      const LeafParts divided = leaf_parts(device, of->leaves);
      of->leaves = divided.parts[0];
      of->leaves_1 = divided.parts[1];
      of->leaves_2 = divided.parts[2];
      of->leaves_3 = divided.parts[3];
      leaf_distance = divided.distance;
    }
    if (encoding == Encoding::single) {
      packed = packed_nodes(arrays.nodes);
      arrays.nodes = packed;
    }
    require_fit(device, arrays, in_file);
  }
};

/// Returns the bytes of one path in each buffer of the paths; ONE: nothing.
std::vector<std::uint64_t> bytes_of_path(const PathNeeds& needs) {
  std::vector<std::uint64_t> out;
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) out.push_back(PathPlaces(needs).of_##access * sizeof(type));
  PATH_GROUPS
#undef GROUP_BEGIN
#undef GROUP_END
#undef BUFFER
  return out;
}

}  // namespace

#define GROUP_BEGIN(Type, group) \
  {                              \
    auto& buffers = this->group;
#define BUFFER(name, type, access) \
  buffers.name = sent<type>(device, all.arrays.name, all.in_file.name, flat.in_file);
#define GROUP_END(Type) }
SceneBuffers::SceneBuffers(const Device& device, const FlatScene& flat, Encoding encoding)
    : encoding_(encoding == Encoding::automatic ? device.encoding() : encoding) {
  const SentArrays all(device, flat, encoding_);
  leaf_distance_ = all.leaf_distance;
  SCENE_GROUPS
}
#undef BUFFER
#define BUFFER(name, type, access) \
  if (!is_sent(#name))             \
    buffers.name = sent<type>(device, all.arrays.name, all.in_file.name, flat.in_file);
SceneBuffers::SceneBuffers(const Device& device, FlatScene&& flat) : encoding_(device.encoding()) {
  SentArrays all(device, flat, encoding_);
  leaf_distance_ = all.leaf_distance;
  if (!all.packed.empty()) flat.nodes = {};
  // Parts of leaves overlap, and are sent before their memory is given back.
  const bool sends_nodes = !flat.in_file, sends_leaves = sends_nodes && leaf_distance_ == 0;
  if (sends_nodes) tree.nodes = sent_in_parts(device, all.packed.empty() ? flat.nodes : all.packed);
  if (sends_leaves) tree.leaves = sent_in_parts(device, flat.leaves);
  const auto is_sent = [=](std::string_view array) {
    return array == "nodes" ? sends_nodes : array == "leaves" && sends_leaves;
  };
  SCENE_GROUPS
  if (sends_nodes) flat.leaves = {};
}
#undef BUFFER
#define BUFFER(name, type, access) buffers.name = Buffer<type>(device, contents(flat.name));
SensorBuffers::SensorBuffers(const Device& device, const FlatView& flat){VIEW_GROUPS}
#undef BUFFER

PathBuffers::PathBuffers(const Device& device, std::size_t paths, std::size_t sort_bins,
                         const PathNeeds& needs) {
  sort.sort_bins = Buffer<uint>(device, sort_bins);
  counters.counters = Buffer<uint>(device, std::size_t{counter_count});
  provide(device, paths, needs);
}

std::uint64_t SceneBuffers::update(const Device& device, const FlatScene& flat,
                                   const SceneChanges& changes) {
  std::uint64_t bytes = 0;
  const bool packs = encoding_ == Encoding::single;
  if (packs) bytes += send_packed(device, flat.nodes, changes.nodes, changes.all, tree.nodes);
  bytes += update_leaves(device, flat, changes.leaves, changes.all);
  const auto is_done = [packs](std::string_view array) {
    return array.starts_with("leaves") || (packs && array == "nodes");
  };
#define BUFFER(name, type, access) \
  if (!is_done(#name))             \
    bytes += send<type>(device, contents(flat.name), changes.name, changes.all, buffers.name);
  SCENE_GROUPS
#undef BUFFER
  return bytes;
}
#undef GROUP_BEGIN
#undef GROUP_END

std::uint64_t SceneBuffers::update_leaves(const Device& device, const FlatScene& flat,
                                          const ChangedRanges& changed, bool all) {
  const LeafParts divided = leaf_parts(device, flat.leaves);
  all |= divided.distance != leaf_distance_;
  leaf_distance_ = divided.distance;
  std::array<Buffer<float>*, 4> buffers{&tree.leaves, &tree.leaves_1, &tree.leaves_2,
                                        &tree.leaves_3};
  if (divided.distance == 0) {
    if (all)
      for (Buffer<float>* part : std::span(buffers).subspan(1))
        *part = Buffer<float>(device, std::size_t{0});
    return send<float>(device, flat.leaves, changed, all, tree.leaves);
  }
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    const std::span<const float> part = divided.parts[i];
    const std::size_t begin = i * divided.distance;
    ChangedRanges own;
    for (const ChangedRange& range : changed.joined(0)) {
      const std::size_t from = std::max(range.begin, begin),
                        to = std::min(range.end, begin + part.size());
      if (from < to) own.add(from - begin, to - from);
    }
    const bool is_new = all || part.size() > buffers[i]->size();
    if (is_new)
      *buffers[i] = Buffer<float>(device, part);  // of this length, which is the longest
    else
      bytes += send<float>(device, part, own, false, *buffers[i]);
    if (is_new) bytes += part.size_bytes();
  }
  return bytes;
}

void PathBuffers::provide(const Device& device, std::size_t paths, const PathNeeds& needs) {
  const PathPlaces places(needs);
  const auto grow = [&device]<class T>(Buffer<T>& buffer, std::size_t elements) {
    elements = std::max<std::size_t>(elements, 1);
    if (buffer.size() < elements) buffer = Buffer<T>(device, elements);
  };
#define GROUP_BEGIN(Type, group) \
  {                              \
    Type##Buffers& buffers = group;
#define BUFFER(name, type, access) grow(buffers.name, paths* places.of_##access);
#define GROUP_END(Type) }
  PATH_GROUPS
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END
}

#define GROUP_BEGIN(Type, group) bindings.group = &this->group;
#define BUFFER(name, type, access)
#define GROUP_END(Type)
void SceneBuffers::bind(Bindings& bindings) const { SCENE_GROUPS }
void SensorBuffers::bind(Bindings& bindings) const { VIEW_GROUPS }
void PathBuffers::bind(Bindings& bindings) const {PATH_GROUPS}
#undef GROUP_BEGIN
#undef BUFFER
#undef GROUP_END

std::uint64_t PathBuffers::largest_bytes_per_path(const PathNeeds& needs) {
  std::uint64_t largest = 0;
  for (const std::uint64_t bytes : bytes_of_path(needs)) largest = std::max(largest, bytes);
  return largest;
}

std::uint64_t PathBuffers::bytes_per_path(const PathNeeds& needs) {
  std::uint64_t all = 0;
  for (const std::uint64_t bytes : bytes_of_path(needs)) all += bytes;
  return all;
}

}  // namespace caplet
