// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/world_query.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <utility>

#include "base/check.h"
#include "render/detail/array_parts.h"

namespace caplet {

namespace {

// On processors the rays and crossings of a launch should stay in the caches; others want all their
// units busy.
constexpr std::size_t cpu_batch_rays = std::size_t{1} << 17;
constexpr std::size_t gpu_batch_rays = std::size_t{1} << 21;

template <class T>
std::span<T> part_of(std::span<T> of, std::size_t first, std::size_t count) {
  return of.empty() ? of : of.subspan(first, count);
}

/// Calls each(begin, end) for parts of [0, count) side by side.
template <class Each>
void for_parts(std::size_t count, Each&& each) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, 4096),
      [&](const tbb::blocked_range<std::size_t>& range) { each(range.begin(), range.end()); });
}

}  // namespace

WorldHits WorldHits::part(std::size_t first, std::size_t count) const {
  return {part_of(t, first, count),           part_of(shape, first, count),
          part_of(instance, first, count),    part_of(primitive, first, count),
          part_of(material_id, first, count), part_of(normal, first, count),
          part_of(point, first, count)};
}

WorldQuery::WorldQuery(Worlds worlds, const Device& device, std::size_t batch_rays)
    : worlds_(std::move(worlds)), scene_(device, worlds_.flat()), batch_rays_(batch_rays) {
  worlds_.take_changes();
  if (batch_rays_ == 0)
    batch_rays_ = device.profile() == Profile::cpu ? cpu_batch_rays : gpu_batch_rays;
  batch_rays_ = std::min(batch_rays_,
                         static_cast<std::size_t>(most_buffer_bytes(device) / sizeof(PickRecord)));
  query_buffers_.query = Buffer<QueryRecord>(device, 1);
  query_buffers_.query_times = Buffer<float>(device, 1);
}

void WorldQuery::set_rays(std::span<const glm::dmat4> cameras,
                          std::span<const Vector3> directions) {
  const std::size_t each = directions.size();
  rays_.resize(cameras.size() * each);
  for_parts(rays_.size(), [&](std::size_t begin, std::size_t end) {
    while (begin < end) {
      const std::size_t camera = begin / each, stop = std::min(end, (camera + 1) * each);
      const glm::mat4x3 m(cameras[camera]);
      for (; begin < stop; ++begin) {
        const Vector3& d = directions[begin - camera * each];
        const glm::vec3 turned = m[0] * d[0] + m[1] * d[1] + m[2] * d[2];
        rays_[begin] = {m[3].x,   m[3].y,   m[3].z,   0,
                        turned.x, turned.y, turned.z, std::numeric_limits<float>::infinity()};
      }
    }
  });
}

void WorldQuery::launch(std::span<const uint> roots, std::span<const RayRecord> rays, bool points,
                        std::span<PickRecord> out) {
  const Device& device = scene_.device();
  if (rays.size() > query_buffers_.query_rays.size()) {
    query_buffers_.query_rays = Buffer<RayRecord>(device, rays.size());
    picks_buffers_.picks = Buffer<PickRecord>(device, rays.size());
  }
  if (roots.size() > worlds_buffers_.world_roots.size())
    worlds_buffers_.world_roots = Buffer<uint>(device, roots.size());
  QueryRecord record{};
  record.world_rays = narrow<uint>(rays.size() / roots.size());
  record.points = points ? 1 : 0;
  query_buffers_.query.write({&record, 1});
  query_buffers_.query_rays.write(rays);
  worlds_buffers_.world_roots.write(roots);
  Bindings bindings = scene_.bindings();
  bindings.query = &query_buffers_;
  bindings.worlds = &worlds_buffers_;
  bindings.picks = &picks_buffers_;
  scene_.kernels().run(Stage::pick_worlds, bindings, rays.size());
  picks_buffers_.picks.RawBuffer::read(out.data(), 0, out.size_bytes());
}

void WorldQuery::place(std::size_t worlds, std::span<const glm::dmat4> transforms,
                       std::span<const Capsule> ends, std::size_t first_world) {
  worlds_.place(worlds, transforms, ends, first_world);
  scene_.update(worlds_.flat(), worlds_.take_changes());
}

void WorldQuery::closest(std::span<const RayRecord> rays, bool points, std::span<PickRecord> out) {
  CHECK_EQ_(rays.size(), out.size());
  if (rays.empty()) return;
  const std::span<const uint> roots = worlds_.roots();
  CHECK_LT_(std::size_t{0}, roots.size());
  CHECK_EQ_(rays.size() % roots.size(), std::size_t{0});
  scene_.kernels().compile(std::array{Stage::pick_worlds});
  const std::size_t each = rays.size() / roots.size(),
                    at_once = std::max<std::size_t>(1, batch_rays_ / each);
  for (std::size_t w = 0; w < roots.size(); w += at_once) {
    const std::size_t now = std::min(at_once, roots.size() - w), all = now * each;
    // One world may have more rays than a launch.
    for (std::size_t first = 0; first < all; first += batch_rays_) {
      const std::size_t begin = w * each + first, count = std::min(batch_rays_, all - first);
      launch(roots.subspan(w, now), rays.subspan(begin, count), points, out.subspan(begin, count));
    }
  }
}

void WorldQuery::keep(const WorldHits& out) const {
  for_parts(picks_.size(), [&](std::size_t begin, std::size_t end) {
    const auto put = [&](const auto& to, const auto& of) {
      if (to.empty()) return;
      for (std::size_t i = begin; i < end; ++i) to[i] = of(picks_[i]);
    };
    const auto number = [&](std::span<std::uint32_t> to, const auto& of) {
      put(to, [&](const PickRecord& pick) -> std::uint32_t {
        return pick.object == CAPLET_NONE ? CAPLET_NONE : of(pick);
      });
    };
    put(out.t, [](const PickRecord& pick) { return pick.t; });
    number(out.shape, [&](const PickRecord& pick) { return worlds_.identity_of(pick).shape; });
    number(out.instance,
           [&](const PickRecord& pick) { return worlds_.identity_of(pick).instance; });
    number(out.primitive,
           [&](const PickRecord& pick) { return worlds_.identity_of(pick).primitive; });
    number(out.material_id, [](const PickRecord& pick) { return pick.material; });
    put(out.normal, [](const PickRecord& pick) { return std::to_array(pick.normal); });
    put(out.point, [](const PickRecord& pick) { return std::to_array(pick.point); });
  });
}

void WorldQuery::look(std::size_t worlds, std::span<const glm::dmat4> transforms,
                      std::span<const Capsule> ends, std::span<const glm::dmat4> cameras,
                      std::span<const Vector3> directions, const WorldHits& out) {
  if (worlds == 0 || cameras.empty() || directions.empty()) return;
  CHECK_EQ_(cameras.size() % worlds, std::size_t{0});
  const std::size_t moving = worlds_.moving(), views = cameras.size() / worlds;
  const std::size_t each = views * directions.size();
  const std::size_t at_once = std::max<std::size_t>(1, batch_rays_ / each);
  for (std::size_t w = 0; w < worlds; w += at_once) {
    const std::size_t now = std::min(at_once, worlds - w);
    place(now, transforms.subspan(w * moving, now * moving),
          ends.subspan(w * worlds_.ends(), now * worlds_.ends()), w);
    set_rays(cameras.subspan(w * views, now * views), directions);
    picks_.resize(rays_.size());
    closest(rays_, !out.normal.empty() || !out.point.empty(), picks_);
    keep(out.part(w * each, now * each));
  }
}

}  // namespace caplet
