// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene: shapes, materials, lights, camera, and how it is to be rendered. import.h makes one from a file.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "caplet/error.h"
#include "caplet/export.h"

CAPLET_BEGIN

/// Corners of a box along the axes, in scene units.
struct Bounds {
  std::array<double, 3> min{}, max{};
};

/// Copies are cheap until one of them is changed.
class CAPLET_API Scene {
 public:
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  // What it holds.
  /// Of all shapes. Min is above max where there are none.
  Bounds bounds() const;
  /// Number of primitives by the kind's name, like "capsule"; instances expanded.
  std::map<std::string, std::uint64_t> primitives() const;
  /// Names in the order that Hit::material_id counts in; empty where the file gives none.
  std::vector<std::string> materials() const;

  // The picture. Setters throw InputError for values that cannot be rendered.
  int width() const;
  int height() const;
  /// At most 2^28 pixels in all. A crop keeps its place; a camera that the file leaves open frames the scene anew.
  void set_size(int width, int height);
  /// Only these pixels are rendered: from (x0, y0), from the top left, to before (x1, y1).
  void set_crop(int x0, int y0, int x1, int y1);
  int samples_per_pixel() const;
  void set_samples_per_pixel(int samples);  // 1 to 2^24
  /// Most scattering events of a path.
  int max_depth() const;
  void set_max_depth(int events);  // 0 to 2^16
  /// Of the samples: the same seed makes the same picture, to the bit on one device.
  std::uint32_t seed() const;
  void set_seed(std::uint32_t seed);

 private:
  friend struct Inside;
  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  Data& changed();
  std::shared_ptr<Data> data_;
};

CAPLET_END
