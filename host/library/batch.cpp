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

void check_numbers(const char* name, const caplet::Scene& scene,
                   std::span<const std::uint32_t> shapes) {
  std::set<std::uint32_t> seen;
  for (const std::uint32_t shape : shapes) {
    if (shape >= scene.shapes.size())
      throw InputError(
          fmt::format("{}: there is no shape {} in the world, which has {} (shapes of objects "
                      "do not move by themselves)",
                      name, shape, scene.shapes.size()));
    if (!seen.insert(shape).second)
      throw InputError(fmt::format("{}: shape {} is there twice", name, shape));
  }
}

Worlds worlds_of(const caplet::Scene& scene, std::span<const std::uint32_t> moving,
                 std::span<const std::uint32_t> deforming) {
  check_numbers("moving", scene, moving);
  check_numbers("deforming", scene, deforming);
  return {scene, moving, deforming};
}

std::vector<caplet::Capsule> to_models(std::span<const Capsule> from) {
  const auto point = [](const std::array<float, 3>& p) { return glm::vec3(p[0], p[1], p[2]); };
  std::vector<caplet::Capsule> out;
  out.reserve(from.size());
  for (const Capsule& c : from) out.push_back({point(c.p0), point(c.p1), c.radius0, c.radius1});
  return out;
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
  Data(const caplet::Scene& scene, std::span<const std::uint32_t> moving,
       std::span<const std::uint32_t> deforming, const caplet::Device& on)
      : query(worlds_of(scene, moving, deforming), on) {
    try_device(on, {.shapes = query.worlds().flat().shapes, .nearest = true});
  }

  WorldQuery query;
};

Batch::Batch(const Scene& scene, std::span<const std::uint32_t> moving, const Device& device,
             std::span<const std::uint32_t> deforming)
    : data_(std::make_unique<Data>(*Inside::model(scene), moving, deforming,
                                   Inside::device(device))) {}
Batch::Batch(Batch&&) noexcept = default;
Batch& Batch::operator=(Batch&&) noexcept = default;
Batch::~Batch() = default;

void Batch::nearest(std::size_t worlds, std::span<const Transform> transforms,
                    std::span<const Transform> cameras,
                    std::span<const std::array<float, 3>> directions, const BatchHits& out,
                    std::span<const Capsule> ends) {
  Data& data = *data_;
  const std::size_t moving = data.query.worlds().moving();
  if (transforms.size() != worlds * moving)
    throw InputError(fmt::format("{} worlds of {} moving shapes, and {} transforms", worlds, moving,
                                 transforms.size()));
  const std::size_t capsules = data.query.worlds().ends();
  if (ends.size() != worlds * capsules)
    throw InputError(fmt::format("{} worlds of {} capsules that change, and ends of {}", worlds,
                                 capsules, ends.size()));
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
      worlds, to_models(transforms), to_models(ends), to_models(cameras), directions,
      {out.t, out.shape, out.instance, out.primitive, out.material_id, out.normal, out.point});
}

}  // namespace caplet::v0
