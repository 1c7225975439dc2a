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
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "caplet/error.h"
#include "caplet/export.h"
#include "caplet/material.h"
#include "caplet/shape.h"

CAPLET_BEGIN

/// Corners of a box along the axes, in scene units.
struct Bounds {
  std::array<double, 3> min{}, max{};
};

/// Copies are cheap until one of them is changed.
class CAPLET_API Scene {
 public:
  /// Of nothing yet; what of camera and light is left open present() gives it.
  Scene();
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

  /// Of lengths, as people write it: "um"; empty where it is not known. Scale bars tell it.
  std::string unit() const;
  void set_unit(const std::string& unit);
  /// What its colours tell, of a scene that is coloured by color_map: `low` and `high` are the values at 0 and 1. A colour bar
  /// shows it. Throws InputError for what is not finite and where low is above high.
  void set_color_bar(const std::string& title, const std::string& unit, double low, double high);

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
  /// The camera stays where it is put: it is not framed anew any more. The picture of a right-handed world is no mirror image,
  /// unless that of the camera before was, as of LookAt in pbrt's text.
  void look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target, const std::array<double, 3>& up);
  double fov() const;  // degrees, of the picture's shorter side
  void set_fov(double degrees);

  // Building: what it consists of becomes more. These throw InputError, and then change nothing, for what cannot be rendered and
  // for names that there are none of. A Session takes the scene as a whole afterwards.
  /// A shape of one of statement_types(Statement::shape), with their parameters. Returns its number, as do all of these.
  std::uint32_t add_shape(const std::string& type, const Parameters& parameters, const ShapeOptions& options = {});
  /// `count` shapes of one type: `each` has the values of all of them one behind the other, as many for one as for another;
  /// `transforms` and `materials`, where there are any, one for each. Returns the first's number; the others follow.
  std::uint32_t add_shapes(const std::string& type, std::size_t count, const Parameters& shared, const Parameters& each,
                           std::span<const Transform> transforms, std::span<const std::uint32_t> materials = {},
                           const ShapeOptions& options = {});
  /// One shape of many capsules.
  std::uint32_t add_capsules(const CapsuleArrays& capsules, const ShapeOptions& options = {});
  /// One shape of many triangles.
  std::uint32_t add_mesh(const MeshArrays& mesh, const ShapeOptions& options = {});
  /// Capsules of a shape, all of them. set_capsules takes another number of them as well.
  CapsuleArrays capsule_arrays(std::uint32_t shape) const;
  void set_capsules(std::uint32_t shape, const CapsuleArrays& capsules);
  /// The number of the `index`-th shape of an object definition; of the world where `object` is empty.
  std::uint32_t shape_in(const std::string& object, std::size_t index) const;
  /// The other way round.
  std::pair<std::string, std::size_t> place(std::uint32_t shape) const;
  /// Materials of a shape's surfaces: of all, or one a surface.
  void set_shape_materials(std::uint32_t shape, const std::vector<std::uint32_t>& materials);
  std::vector<std::string> objects() const;
  /// Places an object definition; returns the first instance's number.
  std::uint32_t add_instances(const std::string& object, std::span<const Transform> transforms);
  /// A light of one of statement_types(Statement::light), in the space of `transform`.
  std::uint32_t add_light(const std::string& type, const Parameters& parameters, const Transform& transform = identity);
  /// All lights but emissive shapes.
  void remove_lights();
  std::uint32_t add_medium(const std::string& name, const std::string& type, const Parameters& parameters,
                           const Transform& transform = identity);
  std::vector<std::string> media() const;
  /// `transform`: world space from the camera's, whose +x is right, +y up, +z forward.
  void set_camera(const std::string& type, const Parameters& parameters, const Transform& transform);
  Transform camera() const;
  /// The medium that the camera is in where no solid holds it.
  void set_camera_medium(std::optional<std::uint32_t> medium);
  /// Film, filter, sampler or integrator; what `parameters` leaves out is as a file that leaves it out has it.
  void set_option(Statement statement, const std::string& type, const Parameters& parameters);
  /// What no one has given: a camera that frames the shapes, and studio light. They follow when shapes are added and this is
  /// called again, and go where a camera or light is given. Throws InputError for what cannot be rendered, and for a scene that
  /// has no shape, no light and no camera.
  void present();
  /// Makes capsules and spheres as wide as the film's "leastwidth" says, in pixels of its size and camera, as render() does with
  /// a copy. Of a scene without one: nothing.
  void widen_to_least();

 private:
  friend struct Inside;
  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  Data& changed();
  std::shared_ptr<Data> data_;
};

CAPLET_END
