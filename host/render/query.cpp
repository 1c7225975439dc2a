// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/query.h"

#include <algorithm>
#include <bit>

#include "base/check.h"

namespace caplet {

namespace {

// PoCL compiles a kernel a second time for 65536 work-items or more: a single question should not wait for that.
constexpr std::size_t cpu_batch_rays = 65536 - 64;
constexpr std::size_t gpu_batch_rays = std::size_t{1} << 20;
constexpr std::size_t batch_hits = std::size_t{1} << 22;  // 64 MB

std::size_t chosen(std::size_t wanted, std::size_t otherwise) { return wanted ? wanted : otherwise; }

}  // namespace

Query::Query(const FlatScene& scene, const Device& device, const QueryOptions& options)
    : params_(scene.params),
      batch_rays_(chosen(options.batch_rays, device.is_cpu() ? cpu_batch_rays : gpu_batch_rays)),
      batch_hits_(chosen(options.batch_hits, batch_hits)),
      stages_(device, scene, {}, stage_options(scene, device)) {}

std::vector<PickRecord> Query::closest(std::span<const RayRecord> rays) {
  const std::size_t batch = std::min(batch_rays_, rays.size());
  stages_.compile(std::array{Stage::pick}, batch_rays_);
  stages_.reserve_query(batch, 0, batch);
  stages_.set_params(params_);
  std::vector<PickRecord> out(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    stages_.set_query_rays(rays.subspan(first, count));
    stages_.run(Stage::pick, count);
    stages_.read_picks(std::span(out).subspan(first, count));
  }
  return out;
}

HitLists Query::all(std::span<const RayRecord> rays, std::size_t capacity) {
  CHECK_LE_(std::size_t{1}, capacity);
  CHECK_LE_(capacity, max_query_capacity);
  const std::size_t batch = std::min(std::clamp<std::size_t>(batch_hits_ / capacity, 1, batch_rays_), rays.size());
  stages_.compile(std::array{Stage::pick_all, Stage::pick_list}, batch_rays_);
  params_.query_capacity = narrow<uint>(capacity);
  stages_.set_params(params_);
  HitLists out;
  out.begin.push_back(0);
  std::vector<uint> counts(batch), begin(batch);
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    stages_.reserve_query(batch, batch * capacity, 0);
    stages_.set_query_rays(rays.subspan(first, count));
    stages_.run(Stage::pick_all, count);
    stages_.read_query_counts(std::span(counts).first(count));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      begin[i] = narrow<uint>(kept);
      kept += std::min<std::size_t>(counts[i], capacity);
      if (counts[i] > capacity) out.overflowed.push_back(first + i);
      out.begin.push_back(out.crossings.size() + kept);
    }
    if (kept == 0) continue;
    stages_.reserve_query(batch, batch * capacity, std::bit_ceil(kept));
    stages_.set_query_begin(std::span(begin).first(count));
    stages_.run(Stage::pick_list, count);
    out.crossings.resize(out.crossings.size() + kept);
    stages_.read_picks(std::span(out.crossings).last(kept));
  }
  return out;
}

}  // namespace caplet
