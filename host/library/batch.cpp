// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/batch.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "library/detail/inside.h"
#include "library/detail/places.h"
#include "render/known_answers.h"
#include "render/world_query.h"

namespace caplet::v0 {

namespace {

Worlds worlds_of(const caplet::Scene& scene, std::span<const std::uint32_t> moving) {
  std::set<std::uint32_t> seen;
  for (const std::uint32_t shape : moving) {
    if (shape >= scene.shapes.size())
      throw InputError(
          fmt::format("moving: there is no shape {} in the world, which has {} (shapes of objects "
                      "do not move by themselves)",
                      shape, scene.shapes.size()));
    if (!seen.insert(shape).second)
      throw InputError(fmt::format("moving: shape {} is there twice", shape));
  }
  return {scene, moving};
}

std::vector<glm::dmat4> to_models(std::span<const Transform> from) {
  std::vector<glm::dmat4> out(from.size());
  std::ranges::transform(from, out.begin(), [](const Transform& rows) { return to_model(rows); });
  return out;
}

void check_room(const char* name, std::size_t room, std::size_t rays) {
  if (room != 0 && room != rays)
    throw InputError(fmt::format("{}: {} rays and room for {} hits", name, rays, room));
}

}  // namespace

struct Batch::Data {
  Data(const caplet::Scene& scene, std::span<const std::uint32_t> moving, const caplet::Device& on)
      : query(worlds_of(scene, moving), on) {
    try_device(on, {.shapes = query.worlds().flat().shapes, .nearest = true});
  }

  WorldQuery query;
};

Batch::Batch(const Scene& scene, std::span<const std::uint32_t> moving, const Device& device)
    : data_(std::make_unique<Data>(*Inside::model(scene), moving, Inside::device(device))) {}
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;
Batch::~Batch() = default;

void Batch::nearest(std::size_t worlds, std::span<const Transform> transforms,
                    std::span<const Transform> cameras,
                    std::span<const std::array<float, 3>> directions, const BatchHits& out) {
  Data& data = *data_;
  const std::size_t moving = data.query.worlds().moving();
  if (transforms.size() != worlds * moving)
    throw InputError(fmt::format("{} worlds of {} moving shapes, and {} transforms", worlds, moving,
                                 transforms.size()));
  if (worlds == 0) return;
  if (cameras.empty() || cameras.size() % worlds != 0)
    throw InputError(
        fmt::format("{} worlds and {} cameras, not equally many for each", worlds, cameras.size()));
  const std::size_t views = cameras.size() / worlds, each = views * directions.size();
  const std::size_t all = worlds * each;
  check_room("t", out.t.size(), all);
  check_room("shape", out.shape.size(), all);
  check_room("instance", out.instance.size(), all);
  check_room("primitive", out.primitive.size(), all);
  check_room("material_id", out.material_id.size(), all);
  check_room("normal", out.normal.size(), all);
  check_room("point", out.point.size(), all);
  data.query.look(
      worlds, to_models(transforms), to_models(cameras), directions,
      {out.t, out.shape, out.instance, out.primitive, out.material_id, out.normal, out.point});
}

}  // namespace caplet::v0
