// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Queries of what a pixel shows and what rays hit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "caplet/device.h"
#include "caplet/scene.h"

CAPLET_BEGIN

struct Ray {
  std::array<float, 3> origin{};
  std::array<float, 3> direction{0, 0, 1};  // of any length, which is the unit of t
  float t_min = 0, t_max = std::numeric_limits<float>::infinity();  // hits are strictly between
  double time = 0;  // seconds, for scenes that move; before the shutter opens and after it closes
                    // they stand still
};

/// An intersection of a ray with a surface.
struct Hit {
  float t = 0;
  std::array<float, 3> point{};   // within `error` of the surface, in world space
  std::array<float, 3> normal{};  // unit, outward
  std::array<float, 2> uv{};
  float error = 0;                           // scene units
  bool entering = false;                     // the ray enters the solid
  std::string object, material;              // names; empty where the scene gives none
  std::uint32_t object_id = 0;               // as in the film's channel "object.id"
  std::uint32_t material_id = 0;             // index into Scene::materials()
  std::uint32_t primitive = 0, surface = 0;  // within the object
  std::optional<std::uint32_t> instance;     // the instance's number, for shapes of an instance
};

/// The same as plain numbers without padding, for arrays.
struct Crossing {
  static constexpr std::uint32_t none = 0xffffffff;

  float t = std::numeric_limits<float>::infinity();  // infinite where the ray misses
  float error = 0;
  std::array<float, 2> uv{};
  std::uint32_t object_id = none, material_id = none, primitive = none, surface = none;
  std::uint32_t shape = none;     // number of the shape (Scene::shapes)
  std::uint32_t instance = none;  // for shapes of an instance
  std::uint32_t leaving = 0;      // 1: the ray leaves the solid
  std::uint32_t ray = 0;          // index of the ray in the query
  std::array<float, 3> point{}, normal{};
};

/// Holds a copy of a scene on a device. Members throw RunError.
class CAPLET_API Picker {
 public:
  /// Throws InputError when the scene exceeds a limit.
  Picker(const Scene& scene, const Device& device);
  Picker(Picker&&) noexcept;
  Picker& operator=(Picker&&) noexcept;
  ~Picker();

  /// Queries the centre of a pixel of the whole picture, counted from the top left. Throws
  /// InputError when the pixel is outside the picture or its crop.
  std::optional<Hit> pixel(int x, int y);
  std::optional<Hit> nearest(const Ray& ray);
  std::vector<std::optional<Hit>> nearest(std::span<const Ray> rays);
  /// Returns every hit in order. Throws RunError when a ray has more than `most` (1 to 2^20).
  std::vector<std::vector<Hit>> all(std::span<const Ray> rays, std::size_t most = 256);
  /// Writes the nearest hit of each ray to `out`, which has the same size.
  void nearest(std::span<const Ray> rays, std::span<Crossing> out);
  /// Returns every hit, by ray and in order along it.
  std::vector<Crossing> crossings(std::span<const Ray> rays, std::size_t most = 256);
  /// Moves points (x y z) of surfaces that were hit at the time `from` to where they are at `to`
  /// (seconds; nothing moves before the shutter opens and after it closes). Points of a triangle
  /// keep their barycentric coordinates, those of a capsule their share of its axis and, turned and
  /// stretched with it, their offset from it. Points of misses stay. Throws InputError for other
  /// numbers of points than hits, and for times that are not finite.
  void carry(std::span<const Crossing> hits, double from, double to,
             std::span<std::array<double, 3>> points) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

CAPLET_END
