// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Ray queries to a scene on a device, with the results that the public classes return.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "caplet/pick.h"
#include "device/device.h"
#include "render/query.h"
#include "scene/scene.h"

namespace caplet::v0 {

struct Questions {
  Query& query;
  const caplet::Scene& scene;  // of the query
  std::uint64_t shapes;        // FlatScene::shapes
  const caplet::Device& device;

  std::optional<Hit> pixel(int x, int y) const;
  std::vector<std::optional<Hit>> nearest(std::span<const Ray> rays) const;
  std::vector<std::vector<Hit>> all(std::span<const Ray> rays, std::size_t most) const;
  void nearest(std::span<const Ray> rays, std::span<Crossing> out) const;
  std::vector<Crossing> crossings(std::span<const Ray> rays, std::size_t most) const;

 private:
  /// Calls take(number of the ray, crossing) for each crossing, in order.
  template <class Take>
  void for_lists(std::span<const Ray> rays, std::size_t most, Take&& take) const;
};

}  // namespace caplet::v0
