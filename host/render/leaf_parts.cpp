// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/leaf_parts.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace caplet {

namespace {

// The smallest part that may be asked for: it overlaps the next one by 100 kB. A polyhedron of
// 1,024 planes keeps 17 kB in one piece; only a motion of some hundred keys takes more.
constexpr std::uint64_t least_part = std::uint64_t{1} << 20;

/// Returns the most bytes of a part.
std::uint64_t most_bytes(const Device& device) {
  std::uint64_t out = device.info().max_allocation_bytes;
  if (const char* const variable = std::getenv("CAPLET_LEAF_PART")) {
    const std::string_view text = variable;
    std::uint64_t asked = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), asked);
    if (error != std::errc() || end != text.data() + text.size() || asked < least_part)
      throw InputError(SourceLocation{"CAPLET_LEAF_PART"},
                       "'" + std::string(text) + "' is no number of bytes from 1048576 up");
    out = std::min(out, asked);
  }
  return out;
}

}  // namespace

LeafParts leaf_parts(const Device& device, std::span<const float> leaves) {
  constexpr std::size_t page = 4096 / sizeof(float);  // parts begin at pages of a mapped file
  LeafParts out;
  out.parts[0] = leaves;
  const std::uint64_t most = most_bytes(device);
  if (leaves.size_bytes() <= most) return out;
  const std::size_t longest = static_cast<std::size_t>(most / sizeof(float)),
                    distance = longest / 9 * 8 / page * page;
  if (distance == 0 || leaves.size() > distance * (out.parts.size() - 1) + longest) return out;
  out.distance = distance;
  for (std::size_t i = 0; i < out.parts.size(); ++i) {
    const std::size_t begin = std::min(i * distance, leaves.size());
    out.parts[i] = leaves.subspan(begin, std::min(longest, leaves.size() - begin));
  }
  return out;
}

}  // namespace caplet
