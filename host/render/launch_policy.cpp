// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/launch_policy.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/error.h"

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
                               .first_chunk = 0,
                               .rounds_unasked = 1};
// GPUs need whole wavefronts, and a query from the host stops all of them. A unit of a large GPU
// holds some 2,000 work-items; a batch is 16 times that for each unit, so that rounds with few
// paths left are few (docs/performance.md).
LaunchPolicy of_gpus(std::uint32_t compute_units) {
  const auto by_units = [&](std::size_t each, std::size_t least, std::size_t most) {
    return std::clamp(std::bit_floor(std::size_t{compute_units} * each), least, most);
  };
  return {.batch_paths = by_units(1u << 15, 1u << 20, 1u << 22),
          .local_size = 64,
          .counts_on_device = true,
          .by_sample = true,
          .layers_apart = true,
          .sort_fan = 64,
          .first_chunk = by_units(1u << 13, 1u << 16, 1u << 20),
          .rounds_unasked = 4};
}

constexpr std::size_t least_chunk = std::size_t{1} << 10, most_chunk = std::size_t{1} << 30;

/// Changes the number that one "name=value" of CAPLET_LAUNCH names.
void apply(std::string_view setting, LaunchPolicy& policy) {
  const std::size_t sign = setting.find('=');
  const std::string_view name = setting.substr(0, sign);
  const std::string_view digits = sign == setting.npos ? "" : setting.substr(sign + 1);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = error == std::errc() && end == digits.data() + digits.size();
  const auto within = [&](std::uint64_t least, std::uint64_t most) {
    return is_number && least <= value && value <= most;
  };
  if (name == "paths" && within(std::uint64_t{1} << 8, std::uint64_t{1} << 28))
    policy.batch_paths = value;
  else if (name == "local" && within(1, 1024))
    policy.local_size = value;
  else if (name == "chunk" && within(0, most_chunk))
    policy.first_chunk = value;
  else if (name == "rounds" && within(1, 64))
    policy.rounds_unasked = static_cast<int>(value);
  else
    throw InputError(SourceLocation{"CAPLET_LAUNCH"},
                     fmt::format("'{}' is not paths=256...2^28, local=1...1024, chunk=0...2^30 or "
                                 "rounds=1...64",
                                 setting));
}

}  // namespace

LaunchPolicy launch_policy_of(Profile profile, std::uint32_t compute_units) {
  LaunchPolicy policy = profile == Profile::gpu ? of_gpus(compute_units) : of_cpus;
  const char* const named = std::getenv("CAPLET_LAUNCH");
  for (std::string_view rest = named ? named : ""; !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    apply(rest.substr(0, comma), policy);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return policy;
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
