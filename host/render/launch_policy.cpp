// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/launch_policy.h"

#include <algorithm>

namespace caplet {

namespace {

// 2^18 paths are enough rays for sorting to find neighbours, and few launches of nearly empty
// rounds; they take 60 MB of state (decision 26). One work-item at a time suits PoCL's tracing; a
// CPU adds up its bins one after the other.
constexpr LaunchPolicy of_cpus{.batch_paths = std::size_t{1} << 18,
                               .local_size = 64,
                               .counts_on_device = false,
                               .by_sample = false,
                               .layers_apart = false,
                               .sort_fan = 1u << 31,
                               .first_chunk = 0};
// GPUs need whole wavefronts, and a query from the host stops all of them.
constexpr LaunchPolicy of_gpus{.batch_paths = std::size_t{1} << 20,
                               .local_size = 64,
                               .counts_on_device = true,
                               .by_sample = true,
                               .layers_apart = true,
                               .sort_fan = 64,
                               .first_chunk = std::size_t{1} << 16};

constexpr std::size_t least_chunk = std::size_t{1} << 10, most_chunk = std::size_t{1} << 30;

}  // namespace

const LaunchPolicy& launch_policy_of(Profile profile) {
  return profile == Profile::gpu ? of_gpus : of_cpus;
}

std::size_t fitting_batch(std::size_t wanted, std::uint64_t bytes, std::uint64_t largest_bytes,
                          std::uint64_t left, std::uint64_t most) {
  std::size_t paths = wanted;
  while (paths > least_batch_paths && (paths * bytes > left || paths * largest_bytes > most))
    paths = (paths + 1) / 2;
  return std::max(paths, std::min(wanted, least_batch_paths));
}

std::size_t next_chunk(std::size_t chunk, std::size_t launched, double seconds) {
  const double at_once = launched > chunk
                             ? seconds * static_cast<double>(chunk) / static_cast<double>(launched)
                             : seconds;
  if (at_once > most_chunk_seconds) return std::max(chunk / 2, least_chunk);
  return 2 * at_once < least_chunk_seconds && launched > chunk / 2 ? std::min(2 * chunk, most_chunk)
                                                                   : chunk;
}

std::vector<SortLevel> sort_levels(std::size_t bins, std::size_t fan) {
  std::vector<SortLevel> out;
  std::size_t first = 0;
  do {
    bins = (bins - 1) / fan + 1;
    out.push_back({first, bins});
    first += bins;
  } while (bins > 1);
  return out;
}

std::size_t sort_places(std::size_t bins, std::size_t fan) {
  const SortLevel top = sort_levels(bins, fan).back();
  return bins + top.first + top.count;
}

}  // namespace caplet
