// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene: shapes, materials, lights, camera, and how it is to be rendered. import.h makes one from a file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "caplet/error.h"
#include "caplet/export.h"
#include "caplet/material.h"

CAPLET_BEGIN

/// Corners of a box along the axes, in scene units.
struct Bounds {
  std::array<double, 3> min{}, max{};
};

/// The convex hull of two spheres; of one where the ends are the same. In the space of its shape.
struct Capsule {
  std::array<float, 3> p0{}, p1{};
  float radius0 = 0, radius1 = 0;
};

/// Three rows of four numbers: world (or object) space from that of a shape or instance.
using Transform = std::array<double, 12>;

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

  // Edits: what it consists of stays, what that is changes. They throw InputError, and then change nothing, for numbers that
  // there are none of and for values that cannot be rendered. A Session that shows the scene follows them in place.
  /// Names by the shapes' numbers: first those of the world, then those of each object definition. Empty where the file gives
  /// none.
  std::vector<std::string> shapes() const;
  /// The number of the one shape of this name.
  std::uint32_t shape(const std::string& name) const;
  /// 0 of shapes that are none of capsules.
  std::size_t capsules(std::uint32_t shape) const;
  Capsule capsule(std::uint32_t shape, std::size_t capsule) const;
  void set_capsule(std::uint32_t shape, std::size_t capsule, const Capsule& to);
  Transform transform(std::uint32_t shape) const;
  void set_transform(std::uint32_t shape, const Transform& to);
  std::size_t instances() const;
  Transform instance(std::uint32_t instance) const;
  void set_instance(std::uint32_t instance, const Transform& to);
  void set_material(std::uint32_t material, const Material& to);
  /// One more of each, by its number; textures are made of those before them. A session then takes the scene as a whole.
  std::uint32_t add_material(const std::string& name, const Material& material);
  TextureNumber add_texture(const NamedTexture& texture);
  /// Lights other than emissive shapes.
  std::size_t lights() const;
  double light_scale(std::uint32_t light) const;
  void set_light(std::uint32_t light, const Spectrum& color, double scale);
  /// Of a shape that emits.
  void set_emission(std::uint32_t shape, const Spectrum& radiance, double scale);
  /// The camera stays where it is put: it is not framed anew any more.
  void look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target, const std::array<double, 3>& up);
  double fov() const;  // degrees, of the picture's shorter side
  void set_fov(double degrees);

 private:
  friend struct Inside;
  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  Data& changed();
  std::shared_ptr<Data> data_;
};

CAPLET_END
