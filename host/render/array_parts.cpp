// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/array_parts.h"

#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"
#include "shared/kinds.h"

namespace caplet {

namespace {

// The least that may be asked for: its parts overlap by 100 kB. A polyhedron of 1,024 planes keeps
// 17 kB in one piece, and a row of an image's distribution has 4 bytes a column.
constexpr std::uint64_t least_bytes = std::uint64_t{1} << 20;

constexpr std::size_t page = 4096 / sizeof(float);  // parts begin at pages of a mapped file

/// Returns the floats of nodes as a device has them, of so many as the scene has them.
std::size_t node_floats(std::size_t floats, Encoding encoding) {
  if (encoding != Encoding::single) return floats;
  return floats / CAPLET_NODE_FLOATS * CAPLET_PACKED_NODE_FLOATS;
}

}  // namespace

std::uint64_t most_buffer_bytes(const Device& device) {
  const std::uint64_t out = device.info().max_allocation_bytes;
  const char* const variable = std::getenv("CAPLET_BUFFER_BYTES");
  if (variable == nullptr) return out;
  const std::string_view text = variable;
  std::uint64_t asked = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), asked);
  if (error != std::errc() || end != text.data() + text.size() || asked < least_bytes)
    throw InputError(SourceLocation{"CAPLET_BUFFER_BYTES"},
                     "'" + std::string(text) + "' is no number of bytes from 1048576 up");
  return std::min(out, asked);
}

std::size_t part_distance(std::uint64_t most_bytes, const SceneArrays& arrays, Encoding encoding) {
  std::size_t longest = 0;  // of the arrays
#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access)
#undef PARTS
#define PARTS(name, type)                                                      \
  static_assert(sizeof(type) == sizeof(float));                                \
  longest = std::max(longest, std::string_view(#name) == "nodes"               \
                                  ? node_floats(arrays.nodes.size(), encoding) \
                                  : arrays.name.size());
  SCENE_GROUPS
#undef GROUP_BEGIN
#undef GROUP_END
#undef BUFFER
#undef PARTS
#define PARTS(name, type)
  const auto most = static_cast<std::size_t>(most_bytes / sizeof(float));
  if (longest <= most) return 0;
  const std::size_t distance = most / 9 * 8 / page * page;
  return longest <= distance * (array_parts - 1) + distance + distance / 8 ? distance : 0;
}

}  // namespace caplet
