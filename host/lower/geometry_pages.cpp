// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/geometry_pages.h"

#include <algorithm>

#include "base/check.h"
#include "shared/shapes.h"

namespace caplet {

std::vector<std::uint32_t> geometry_pages(std::span<const std::uint32_t> geometries) {
  constexpr std::size_t page = CAPLET_PAGE_PRIMITIVES;
  const std::size_t count = (geometries.size() + page - 1) / page;
  std::vector<std::uint32_t> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto own = geometries.subspan(i * page, std::min(page, geometries.size() - i * page));
    const bool mixed = std::ranges::any_of(own, [&](std::uint32_t one) { return one != own[0]; });
    const auto entry = mixed ? narrow<std::uint32_t>(out.size()) : own[0];
    CHECK_LT_(entry, std::uint32_t{1} << 31);
    out[i] = entry << 1 | (mixed ? 1u : 0u);
    if (mixed) out.insert(out.end(), own.begin(), own.end());
  }
  return out;
}

}  // namespace caplet
