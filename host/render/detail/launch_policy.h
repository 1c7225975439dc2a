// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These settings keep devices of a kind busy: the sizes of batches and launches, and the work that
// is left to the device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "device/device.h"
#include "shared/records.h"

namespace caplet {

struct LaunchPolicy {
  std::size_t batch_paths;  // under way at a time
  std::size_t local_size;   // of kernels that take one item a work-item
  bool counts_on_device;    // rounds are launched for as many paths as there may be, and several of
                            // them before the host asks
  bool by_sample;  // path = sample * pixels + pixel, so that neighbours in a launch are neighbours
                   // in memory
  bool layers_apart;        // a work-item a layer of a pixel, not a pixel, adds samples to the film
  std::uint32_t sort_fan;   // sort bins that a work-item adds up
  std::size_t first_chunk;  // work-items of a launch in the beginning; 0: any number
  int rounds_unasked;       // rounds of a batch between two queries for the number of paths left,
                            // if they are counted on the device
};

/// Returns the policy for a device of `compute_units` units. The variable CAPLET_LAUNCH replaces
/// numbers: "paths=N,local=N,chunk=N,rounds=N" or some of these. `paths` is 2^8 to 2^28, `local` 1
/// to 1024, `chunk` 0 to 2^30, `rounds` 1 to 64. Throws InputError if it says anything else.
LaunchPolicy launch_policy_of(Profile profile, std::uint32_t compute_units);
inline LaunchPolicy launch_policy_of(const Device& device) {
  return launch_policy_of(device.profile(), device.info().compute_units);
}

/// No batch is made smaller than this to fit a device.
inline constexpr std::size_t least_batch_paths = std::size_t{1} << 12;

/// Returns `wanted` paths, or half of them as many times as needed for their state to fit: `bytes`
/// a path in all and `largest_bytes` in one buffer, with `left` bytes left in all and `most` in one
/// buffer. It is not below least_batch_paths (or `wanted`).
std::size_t fitting_batch(std::size_t wanted, std::uint64_t bytes, std::uint64_t largest_bytes,
                          std::uint64_t left, std::uint64_t most);

/// Display drivers end kernels that run for seconds. The work-items of one launch are doubled after
/// rounds which show that these would take at most least_chunk_seconds, and halved after rounds
/// which may have had a launch of most_chunk_seconds: `launched` work-items of one stage in a round
/// took at most `seconds` with all the other stages.
inline constexpr double least_chunk_seconds = 0.1, most_chunk_seconds = 0.5;
std::size_t next_chunk(std::size_t chunk, std::size_t launched, double seconds);

/// The levels are blocks of `fan` sort bins, blocks of `fan` of their sums, and so on until there
/// is one: items [first, first + count) of sort_sums and sort_prefix, level by level.
struct SortLevel {
  std::size_t first = 0, count = 0;
};
std::vector<SortLevel> sort_levels(std::size_t bins, std::size_t fan);
/// Returns the places that the bins and the sums of blocks need together.
std::size_t sort_places(std::size_t bins, std::size_t fan);

}  // namespace caplet
