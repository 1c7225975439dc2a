// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Many worlds in arrays -> what their cameras' rays hit, in arrays.
#include <caplet/batch.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "session.h"

namespace caplet_python {

namespace {

using caplet::BatchHits;
using caplet::Capsule;
using caplet::Transform;

/// A batch, and whose turn it is.
struct HeldBatch {
  explicit HeldBatch(caplet::Batch of) : batch(std::move(of)) {}
  caplet::Batch batch;
  Lock lock;
};

using Numbers = nb::ndarray<nb::ro, nb::device::cpu, nb::c_contig, double, nb::shape<-1, 12>>;
using Directions = nb::ndarray<nb::ro, nb::device::cpu, nb::c_contig, float, nb::shape<-1, 3>>;
using Ends = nb::ndarray<nb::ro, nb::device::cpu, nb::c_contig, float, nb::shape<-1, 8>>;
template <class T>
using Room = std::optional<nb::ndarray<T, nb::device::cpu, nb::c_contig>>;

static_assert(sizeof(Transform) == 12 * sizeof(double));
static_assert(sizeof(Capsule) == 8 * sizeof(float));

std::span<const Transform> transforms_in(const Numbers& rows) {
  return {reinterpret_cast<const Transform*>(rows.data()), rows.shape(0)};
}

/// Worlds [first, first + count) of what a batch writes.
template <class To, class T>
std::span<To> part(const Room<T>& room, std::size_t first, std::size_t count) {
  if (!room) return {};
  return {reinterpret_cast<To*>(room->data()) + first, count};
}

void nearest(HeldBatch& held, std::size_t worlds, const Numbers& transforms, const Numbers& cameras,
             const Directions& directions, const Ends& capsules, const Room<float>& t,
             const Room<std::uint32_t>& shape, const Room<std::uint32_t>& instance,
             const Room<std::uint32_t>& primitive, const Room<std::uint32_t>& material_id,
             const Room<float>& normal, const Room<float>& point) {
  using Vector = std::array<float, 3>;
  const std::size_t rays = cameras.shape(0) * directions.shape(0);
  const auto check = [&](const auto& room, std::size_t numbers) {
    if (room && room->size() != numbers * rays) throw nb::value_error("room for other rays");
  };
  check(t, 1);
  check(shape, 1);
  check(instance, 1);
  check(primitive, 1);
  check(material_id, 1);
  check(normal, 3);
  check(point, 3);
  if (worlds == 0) return;
  if (cameras.shape(0) % worlds != 0 || transforms.shape(0) % worlds != 0 ||
      capsules.shape(0) % worlds != 0)
    throw nb::value_error("as many cameras, transforms and capsules for each world are needed");
  const std::size_t views = cameras.shape(0) / worlds, moving = transforms.shape(0) / worlds;
  const std::size_t each = views * directions.shape(0);
  const std::span<const Transform> places = transforms_in(transforms),
                                   eyes = transforms_in(cameras);
  const std::span<const Vector> ways{reinterpret_cast<const Vector*>(directions.data()),
                                     directions.shape(0)};
  const std::size_t deforming = capsules.shape(0) / worlds;
  const std::span<const Capsule> ends{reinterpret_cast<const Capsule*>(capsules.data()),
                                      capsules.shape(0)};
  Released released;
  const auto turn = turn_of(held);
  // Signals are heard between these parts.
  const std::size_t at_once =
      std::max<std::size_t>(1, (std::size_t{1} << 21) / std::max<std::size_t>(1, each));
  for (std::size_t w = 0; w < worlds; w += at_once) {
    if (w > 0) released.check_signals();
    const std::size_t now = std::min(at_once, worlds - w), first = w * each, count = now * each;
    held.batch.nearest(
        now, places.subspan(w * moving, now * moving), eyes.subspan(w * views, now * views), ways,
        {part<float>(t, first, count), part<std::uint32_t>(shape, first, count),
         part<std::uint32_t>(instance, first, count), part<std::uint32_t>(primitive, first, count),
         part<std::uint32_t>(material_id, first, count), part<Vector>(normal, first, count),
         part<Vector>(point, first, count)},
        ends.subspan(w * deforming, now * deforming));
  }
}

}  // namespace

void bind_batch(nb::module_& m) {
  nb::class_<HeldBatch>(m, "Batch")
      .def("__init__",
           [](HeldBatch* self, HeldScene& of, const std::vector<std::uint32_t>& moving,
              const caplet::Device& device, const std::vector<std::uint32_t>& deforming) {
             const caplet::Scene scene = of.now();
             std::optional<caplet::Batch> batch;
             run_interruptibly([&] { batch.emplace(scene, moving, device, deforming); }, [] {},
                               [] {});
             new (self) HeldBatch(*std::move(batch));
           })
      .def("nearest", &nearest, nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg(),
           nb::arg("t").none(), nb::arg("shape").none(), nb::arg("instance").none(),
           nb::arg("primitive").none(), nb::arg("material_id").none(), nb::arg("normal").none(),
           nb::arg("point").none());
}

}  // namespace caplet_python
