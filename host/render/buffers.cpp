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
#include "render/detail/array_parts.h"

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

/// Returns the floats of packed nodes that these changes of nodes change.
ChangedRanges packed_ranges(const ChangedRanges& changed) {
  constexpr std::size_t from_each = CAPLET_NODE_FLOATS, to_each = CAPLET_PACKED_NODE_FLOATS;
  ChangedRanges out;
  for (const ChangedRange& range : changed.joined(0)) {
    const std::size_t first = range.begin / from_each,
                      end = (range.end + from_each - 1) / from_each;
    out.add(first * to_each, (end - first) * to_each);
  }
  return out;
}

/// Does as `send` for an array that may lie in parts, the first of which is `to`.
template <class T>
std::uint64_t send_parts(const Device& device, std::span<const T> now, const ChangedRanges& changed,
                         bool all, std::size_t distance, Buffer<T>& to,
                         std::array<Buffer<T>, array_parts - 1>& to_others) {
  if (distance == 0) {
    to_others = {};
    return send<T>(device, now, changed, all, to);
  }
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < array_parts; ++i) {
    const std::span<const T> part = array_part(now, distance, i);
    Buffer<T>& buffer = i == 0 ? to : to_others[i - 1];
    const std::size_t begin = i * distance;
    ChangedRanges own;
    for (const ChangedRange& range : changed.joined(0)) {
      const std::size_t from = std::max(range.begin, begin),
                        end = std::min(range.end, begin + part.size());
      if (from < end) own.add(from - begin, end - from);
    }
    if (all || part.size() > buffer.size()) {
      buffer = {};  // the old one makes room first
      buffer = Buffer<T>(device, part);
      bytes += part.size_bytes();
    } else {
      bytes += send<T>(device, part, own, false, buffer);
    }
  }
  return bytes;
}

/// Returns whether an array may lie in parts.
constexpr bool has_parts(std::string_view array) {
  bool out = false;
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access)
#undef PARTS
#define PARTS(name, type) out |= array == #name;
  SCENE_GROUPS
#undef BUFFER
#undef PARTS
#define PARTS(name, type)
#undef GROUP_BEGIN
#undef GROUP_END
  return out;
}

/// The arrays that a device is sent: with nodes as it walks them, and divided as it allows.
struct SentArrays {
  SceneArrays arrays, in_file;  // all of them, and those that lie in a file
  std::vector<float> packed;    // nodes, where they are sent packed
  std::size_t distance = 0;     // of parts

  /// Throws RunError when they do not fit.
  SentArrays(const Device& device, const FlatScene& flat, Encoding encoding)
      : arrays(flat.arrays()), in_file(flat.in_file ? *flat.in_file : SceneArrays{}) {
    const std::uint64_t most_bytes = most_buffer_bytes(device);
    distance = caplet::part_distance(most_bytes, arrays, encoding);
    if (encoding == Encoding::single) {
      packed = packed_nodes(arrays.nodes);
      arrays.nodes = packed;
    }
    require_fit(device, most_bytes);
  }

  /// Sends part `i` of an array, or all of one without parts as the first. One that lies in a file
  /// stays there where the device is a CPU.
  template <class T>
  Buffer<T> sent(const Device& device, const FlatScene& flat, const char* name,
                 std::span<const T> array, std::span<const T> stays, std::size_t i) const {
    const std::span<const T> part = array_part(array, distance_of(name), i);
    if (device.is_cpu() && !part.empty() && array.data() == stays.data())
      return {device, part, flat.in_file};
    return {device, part};
  }

 private:
  std::size_t distance_of(const char* name) const { return has_parts(name) ? distance : 0; }
  /// Throws RunError that names the buffer that is too large. Arrays that stay in a file take none
  /// of the device's memory.
  void require_fit(const Device& device, std::uint64_t most_bytes) const {
    const DeviceInfo& info = device.info();
    constexpr double megabytes = 1e-6;
    const char* largest = "";
    std::uint64_t largest_bytes = 0, all_bytes = 0;
    const auto add = [&]<class T>(const char* name, std::span<const T> array,
                                  std::span<const T> stays) {
      const std::uint64_t bytes = array.size_bytes();
      if (!device.is_cpu() || array.data() != stays.data()) all_bytes += bytes;
      const std::uint64_t in_one = array_part(array, distance_of(name), 0).size_bytes();
      if (in_one <= largest_bytes) return;
      largest = name;
      largest_bytes = in_one;
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
    if (all_bytes <= left && largest_bytes <= most_bytes) return;
    throw RunError(fmt::format(
        "the scene takes {:.0f} MB on a device, and {:.0f} MB in one buffer ({}); device '{}' "
        "has {:.0f} MB left, and allows "
        "{:.0f} MB in one buffer",
        static_cast<double>(all_bytes) * megabytes, static_cast<double>(largest_bytes) * megabytes,
        largest, info.name, static_cast<double>(left) * megabytes,
        static_cast<double>(most_bytes) * megabytes));
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
  if (!is_sent(#name))             \
    buffers.name = all.sent<type>(device, flat, #name, all.arrays.name, all.in_file.name, 0);
#undef PARTS
#define PARTS(name, type)                         \
  if (part_distance_ > 0)                         \
    for (std::size_t i = 1; i < array_parts; ++i) \
      buffers.name##_parts[i - 1] =               \
          all.sent<type>(device, flat, #name, all.arrays.name, all.in_file.name, i);
#define GROUP_END(Type) }
SceneBuffers::SceneBuffers(const Device& device, const FlatScene& flat, Encoding encoding)
    : encoding_(encoding == Encoding::automatic ? device.encoding() : encoding) {
  const SentArrays all(device, flat, encoding_);
  part_distance_ = all.distance;
  const auto is_sent = [](std::string_view) { return false; };
  SCENE_GROUPS
}
SceneBuffers::SceneBuffers(const Device& device, FlatScene&& flat) : encoding_(device.encoding()) {
  SentArrays all(device, flat, encoding_);
  part_distance_ = all.distance;
  if (!all.packed.empty()) flat.nodes = {};
  // Parts overlap, and are sent before their memory is given back.
  const bool gives_back = !flat.in_file, sends_first = gives_back && part_distance_ == 0;
  if (sends_first) {
    tree.nodes = sent_in_parts(device, all.packed.empty() ? flat.nodes : all.packed);
    tree.leaves = sent_in_parts(device, flat.leaves);
  }
  const auto is_sent = [=](std::string_view array) {
    return sends_first && (array == "nodes" || array == "leaves");
  };
  SCENE_GROUPS
  if (gives_back) flat.nodes = flat.leaves = {};
}
#undef PARTS
#define PARTS(name, type)
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
  const std::size_t distance =
      caplet::part_distance(most_buffer_bytes(device), flat.arrays(), encoding_);
  const bool all = changes.all || distance != part_distance_;
  part_distance_ = distance;
  std::uint64_t bytes = 0;
  const bool packs = encoding_ == Encoding::single;
  if (packs && distance == 0) {
    tree.nodes_parts = {};
    bytes += send_packed(device, flat.nodes, changes.nodes, all, tree.nodes);
  } else if (packs) {
    bytes += send_parts<float>(device, packed_nodes(flat.nodes), packed_ranges(changes.nodes), all,
                               distance, tree.nodes, tree.nodes_parts);
  }
#define BUFFER(name, type, access) \
  if (!has_parts(#name))           \
    bytes += send<type>(device, contents(flat.name), changes.name, all, buffers.name);
#undef PARTS
#define PARTS(name, type)                                                               \
  if (!packs || std::string_view(#name) != "nodes")                                     \
    bytes += send_parts<type>(device, contents(flat.name), changes.name, all, distance, \
                              buffers.name, buffers.name##_parts);
  SCENE_GROUPS
#undef BUFFER
#undef PARTS
#define PARTS(name, type)
  return bytes;
}
#undef GROUP_BEGIN
#undef GROUP_END

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
