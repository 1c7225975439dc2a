// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/query.h"

#include <algorithm>
#include <bit>

#include "base/check.h"
#include "render/detail/array_parts.h"

namespace caplet {

namespace {

// PoCL compiles a kernel a second time for 65536 work-items or more: a single query should not wait
// for that.
constexpr std::size_t cpu_query_rays = 65536 - 64;
constexpr std::size_t gpu_query_rays = std::size_t{1} << 20;
constexpr std::size_t batch_hits = std::size_t{1} << 22;  // 64 MB

std::size_t chosen(std::size_t wanted, std::size_t otherwise, std::size_t most) {
  return std::min(wanted ? wanted : otherwise, most);
}

/// Returns the records of a buffer at most, a power of two.
std::size_t most_picks(const Device& device) {
  return std::bit_floor(static_cast<std::size_t>(most_buffer_bytes(device) / sizeof(PickRecord)));
}

}  // namespace

Query::Query(std::shared_ptr<DeviceScene> scene, const QueryOptions& options)
    : scene_(std::move(scene)),
      batch_rays_(
          chosen(options.batch_rays,
                 scene_->device().profile() == Profile::cpu ? cpu_query_rays : gpu_query_rays,
                 most_picks(scene_->device()))),
      batch_hits_(chosen(options.batch_hits, batch_hits, most_picks(scene_->device()))) {
  query_.query = Buffer<QueryRecord>(scene_->device(), 1);
}

Query::Query(DeviceScene& scene, const QueryOptions& options)
    : Query(std::shared_ptr<DeviceScene>(std::shared_ptr<void>(), &scene), options) {}

Query::Query(const FlatScene& scene, const Device& device, const QueryOptions& options)
    : Query(std::make_shared<DeviceScene>(device, scene), options) {}

void Query::reserve(std::size_t rays, std::size_t hits, std::size_t picks) {
  const Device& device = scene_->device();
  if (rays > query_.query_rays.size()) query_.query_rays = Buffer<RayRecord>(device, rays);
  const std::size_t times = scene_->moves() ? rays : 1;
  if (times > query_.query_times.size()) query_.query_times = Buffer<float>(device, times);
  if (hits > crossings_.query_hits.size()) crossings_.query_hits = Buffer<HitRecord>(device, hits);
  if (hits > 0 && rays > crossings_.query_counts.size()) {
    crossings_.query_counts = Buffer<uint>(device, rays);
    crossings_.query_begin = Buffer<uint>(device, rays);
  }
  if (picks > picks_.picks.size()) picks_.picks = Buffer<PickRecord>(device, picks);
}

void Query::send(std::span<const RayRecord> rays, std::span<const float> times) {
  query_.query_rays.write(rays);
  if (!scene_->moves()) return;
  const std::vector<float> opening(times.empty() ? rays.size() : 0);
  query_.query_times.write(times.empty() ? std::span<const float>(opening) : times);
}

Bindings Query::bindings() const {
  Bindings out = scene_->bindings();
  out.query = &query_;
  out.crossings = &crossings_;
  out.picks = &picks_;
  return out;
}

std::vector<PickRecord> Query::closest(std::span<const RayRecord> rays,
                                       std::span<const float> times) {
  if (!times.empty()) CHECK_EQ_(times.size(), rays.size());
  const std::size_t batch = std::min(batch_rays_, rays.size());
  scene_->kernels().compile(std::array{Stage::pick});
  reserve(batch, 0, batch);
  std::vector<PickRecord> out(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    send(rays.subspan(first, count), times.empty() ? times : times.subspan(first, count));
    scene_->kernels().run(Stage::pick, bindings(), count);
    picks_.picks.RawBuffer::read(&out[first], 0, count * sizeof(PickRecord));
  }
  return out;
}

HitLists Query::all(std::span<const RayRecord> rays, std::size_t capacity,
                    std::span<const float> times) {
  if (!times.empty()) CHECK_EQ_(times.size(), rays.size());
  CHECK_LE_(std::size_t{1}, capacity);
  CHECK_LE_(capacity, max_query_capacity);
  const std::size_t batch =
      std::min(std::clamp<std::size_t>(batch_hits_ / capacity, 1, batch_rays_), rays.size());
  scene_->kernels().compile(std::array{Stage::pick_all, Stage::pick_list});
  QueryRecord record{};
  record.capacity = narrow<uint>(capacity);
  query_.query.write({&record, 1});
  HitLists out;
  out.begin.push_back(0);
  std::vector<uint> counts(batch), begin(batch);
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::size_t count = std::min(batch, rays.size() - first);
    reserve(batch, batch * capacity, 0);
    send(rays.subspan(first, count), times.empty() ? times : times.subspan(first, count));
    scene_->kernels().run(Stage::pick_all, bindings(), count);
    crossings_.query_counts.RawBuffer::read(counts.data(), 0, count * sizeof(uint));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
      begin[i] = narrow<uint>(kept);
      kept += std::min<std::size_t>(counts[i], capacity);
      if (counts[i] > capacity) out.overflowed.push_back(first + i);
      out.begin.push_back(out.crossings.size() + kept);
    }
    if (kept == 0) continue;
    reserve(batch, batch * capacity, std::bit_ceil(kept));
    crossings_.query_begin.write(std::span(begin).first(count));
    scene_->kernels().run(Stage::pick_list, bindings(), count);
    out.crossings.resize(out.crossings.size() + kept);
    picks_.picks.RawBuffer::read(&out.crossings[out.crossings.size() - kept], 0,
                                 kept * sizeof(PickRecord));
  }
  return out;
}

}  // namespace caplet
