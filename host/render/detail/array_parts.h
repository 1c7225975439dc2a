// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How the arrays of a scene are divided among buffers (kernels/math/floats.cl).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "device/device.h"
#include "lower/flat_scene.h"

namespace caplet {

/// Returns the most bytes of one buffer: as the device has it, or as the environment variable
/// CAPLET_BUFFER_BYTES says where that is less. Throws InputError when that is no number of at
/// least 1048576.
std::uint64_t most_buffer_bytes(const Device& device);

/// Returns the elements, of four bytes, by which parts of arrays begin one after the other where
/// some array of groups.h's PARTS has more than `most_bytes`. 0: none has, or one does not fit into
/// four parts either. `encoding`: the device's nodes (wide or single).
std::size_t part_distance(std::uint64_t most_bytes, const SceneArrays& arrays, Encoding encoding);

// An array has so many parts.
inline constexpr std::size_t array_parts = 4;

/// Returns part `i` of an array; the first is all of it where `distance` is 0. A part goes on
/// beyond the begin of the next one by an eighth, the most that what begins in it may take.
template <class T>
std::span<const T> array_part(std::span<const T> array, std::size_t distance, std::size_t i) {
  if (distance == 0) return i == 0 ? array : std::span<const T>();
  const std::size_t begin = std::min(i * distance, array.size());
  return array.subspan(begin, std::min(distance + distance / 8, array.size() - begin));
}

}  // namespace caplet
