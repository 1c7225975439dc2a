// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tells which geometry each primitive is of, in little memory where many in a row are of one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace caplet {

/// Returns the buffer primitive_geometry (shared/groups.h) for these geometries, by primitive id.
std::vector<std::uint32_t> geometry_pages(std::span<const std::uint32_t> geometries);

}  // namespace caplet
