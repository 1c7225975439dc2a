// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene: shapes, materials, lights, camera and render settings. import.h reads one from a file.
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

/// The corners of an axis-aligned box, in scene units.
struct Bounds {
  std::array<double, 3> min{}, max{};
};

/// A render to a noise gives each pixel as many samples as it needs for it. The noise is the root
/// of the mean, over the pixels that show something, of the variance of the mean of a pixel's
/// samples over the square of the luminance around it, with a quarter of the picture's mean
/// luminance added; with `in_display`, of that variance times the square of the slope of previews'
/// tone curve at this luminance.
struct NoiseTarget {
  double noise = 0.05;                           // 1e-5 to 1
  int least_samples = 16, most_samples = 16384;  // of a pixel
  bool in_display = false;
  double exposure = 0;  // for in_display: of the preview, stops
};

/// Copies are cheap until one of them is changed.
class CAPLET_API Scene {
 public:
  /// Makes an empty scene. present() adds a camera and light if they are missing.
  Scene();
  Scene(const Scene&);
  Scene(Scene&&) noexcept;
  Scene& operator=(const Scene&);
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  // The content of the scene.
  /// Returns the bounds of all shapes. Min is above max where there are none.
  Bounds bounds() const;
  /// Counts primitives by the name of their kind, like "capsule", with instances expanded.
  std::map<std::string, std::uint64_t> primitives() const;
  /// Returns names, indexed by Hit::material_id; empty where the file gives none.
  std::vector<std::string> materials() const;

  // The picture. Setters throw InputError for values that cannot be rendered.
  int width() const;
  int height() const;
  /// Sets at most 2^28 pixels in all. A crop keeps its place, and an automatic camera frames the
  /// scene again.
  void set_size(int width, int height);
  /// Restricts rendering to the pixels from (x0, y0), counted from the top left, to before (x1,
  /// y1).
  void set_crop(int x0, int y0, int x1, int y1);
  /// Samples of each pixel, or where the picture is rendered to a noise the most of one.
  int samples_per_pixel() const;
  void set_samples_per_pixel(int samples);  // 1 to 2^24, and no noise
  /// The noise that the picture is rendered to (Session::render_to), which its file asks for, or
  /// files that say nothing of samples have; 0: none.
  double noise() const;
  /// Returns what a picture is rendered to, if it is a noise.
  std::optional<NoiseTarget> noise_target() const;
  /// The most scattering events of a path.
  int max_depth() const;
  void set_max_depth(int events);  // 0 to 2^16
  /// The seed of the samples. The same seed gives the same picture, bit for bit on one device.
  std::uint32_t seed() const;
  void set_seed(std::uint32_t seed);

  /// The unit of lengths, as people write it: "um"; empty: unknown. Scale bars show it.
  std::string unit() const;
  void set_unit(const std::string& unit);
  /// Sets the colour bar of a scene that is coloured by color_map: `low` and `high` are the values
  /// at 0 and 1. Throws InputError when a number is not finite or low is above high.
  void set_color_bar(const std::string& title, const std::string& unit, double low, double high);

  // Edits change the scene's parts but not their number. They throw InputError, and change nothing,
  // for numbers that do not exist and for values that cannot be rendered. A Session that shows the
  // scene applies them in place.
  /// Returns names by shape number: first the shapes of the world, then those of each object
  /// definition. A name is empty where the file gives none.
  std::vector<std::string> shapes() const;
  /// Returns the number of the shape with this name, which must be unique.
  std::uint32_t shape(const std::string& name) const;
  /// Returns the number of capsules; 0 for other shapes.
  std::size_t capsules(std::uint32_t shape) const;
  Capsule capsule(std::uint32_t shape, std::size_t capsule) const;
  void set_capsule(std::uint32_t shape, std::size_t capsule, const Capsule& to);
  Transform transform(std::uint32_t shape) const;
  void set_transform(std::uint32_t shape, const Transform& to);
  std::size_t instances() const;
  Transform instance(std::uint32_t instance) const;
  /// Puts an instance elsewhere; its motion goes along.
  void set_instance(std::uint32_t instance, const Transform& to);
  /// Moves an operand of a csg shape while the shutter of the camera is open: `transforms` at
  /// `times` (seconds, rising), two or more, map its space to that of the csg; between them it
  /// moves as an instance does, about its origin. Without times it rests where it is.
  void set_operand_motion(std::uint32_t shape, std::size_t operand,
                          const std::vector<double>& times, std::span<const Transform> transforms);
  /// Moves an instance while the shutter of the camera is open: it is at `transforms` at `times`
  /// (seconds, rising), two or more; between them it shifts, turns and stretches evenly, as pbrt's
  /// do, and `pivot`, a point of the object, goes straight on. Without times it rests.
  void set_instance_motion(std::uint32_t instance, const std::vector<double>& times,
                           std::span<const Transform> transforms,
                           const std::array<double, 3>& pivot = {});
  void set_material(std::uint32_t material, const Material& to);
  /// Add one and return its number; a texture may use only earlier ones. A session then takes the
  /// whole scene again.
  std::uint32_t add_material(const std::string& name, const Material& material);
  TextureNumber add_texture(const NamedTexture& texture);
  /// Counts lights other than emissive shapes.
  std::size_t lights() const;
  double light_scale(std::uint32_t light) const;
  void set_light(std::uint32_t light, const Spectrum& color, double scale);
  /// Sets the emission of a shape that emits.
  void set_emission(std::uint32_t shape, const Spectrum& radiance, double scale);
  /// Sets the camera, which is then no longer automatic. A right-handed world is not mirrored in
  /// the picture, unless the former camera mirrored it, as pbrt's LookAt does.
  void look_at(const std::array<double, 3>& eye, const std::array<double, 3>& target,
               const std::array<double, 3>& up);
  /// Moves the camera likewise: `transforms` map its space (x right, y up, z forward) to the world.
  void set_camera_motion(const std::vector<double>& times, std::span<const Transform> transforms);
  /// Opens the shutter from one time to another (seconds). Pictures stay as bright as they are.
  void set_shutter(double open, double close);
  double fov() const;  // degrees, of the picture's shorter side
  void set_fov(double degrees);

  // Building adds to the scene. These throw InputError, and change nothing, for what cannot be
  // rendered and for unknown names. A Session takes the whole scene again afterwards.
  /// Adds a shape of one of statement_types(Statement::shape). Returns its number, as all of these
  /// do.
  std::uint32_t add_shape(const std::string& type, const Parameters& parameters,
                          const ShapeOptions& options = {});
  /// Adds `count` shapes of one type. `each` has the values of all of them concatenated, equally
  /// many per shape; `transforms` and `materials`, if not empty, have one each. Returns the first's
  /// number; the others follow.
  std::uint32_t add_shapes(const std::string& type, std::size_t count, const Parameters& shared,
                           const Parameters& each, std::span<const Transform> transforms,
                           std::span<const std::uint32_t> materials = {},
                           const ShapeOptions& options = {});
  /// Adds one shape of many capsules.
  std::uint32_t add_capsules(const CapsuleArrays& capsules, const ShapeOptions& options = {});
  /// Adds the solvent-excluded surface of balls for a probe of this radius (docs/shapes.md,
  /// "Molecular surface").
  std::uint32_t add_molecular_surface(const BallArrays& balls, double probe,
                                      const ShapeOptions& options = {});
  /// Adds one shape of many triangles.
  std::uint32_t add_mesh(const MeshArrays& mesh, const ShapeOptions& options = {});
  /// Get and set all capsules of a shape; set_capsules may change their number.
  CapsuleArrays capsule_arrays(std::uint32_t shape) const;
  void set_capsules(std::uint32_t shape, const CapsuleArrays& capsules);
  /// Get and set all triangles of a shape that is a mesh.
  MeshArrays mesh_arrays(std::uint32_t shape) const;
  void set_mesh(std::uint32_t shape, const MeshArrays& mesh);
  /// Returns the number of shape `index` of an object definition, or of the world where `object` is
  /// empty.
  std::uint32_t shape_in(const std::string& object, std::size_t index) const;
  /// Does the inverse of shape_in.
  std::pair<std::string, std::size_t> place(std::uint32_t shape) const;
  /// Sets the materials of a shape's surfaces: one for all, or one per surface.
  void set_shape_materials(std::uint32_t shape, const std::vector<std::uint32_t>& materials);
  std::vector<std::string> objects() const;
  /// Places an object definition, and returns the first instance's number.
  std::uint32_t add_instances(const std::string& object, std::span<const Transform> transforms);
  /// Adds a light of one of statement_types(Statement::light), in the space of `transform`.
  std::uint32_t add_light(const std::string& type, const Parameters& parameters,
                          const Transform& transform = identity);
  /// Removes all lights but emissive shapes.
  void remove_lights();
  std::uint32_t add_medium(const std::string& name, const std::string& type,
                           const Parameters& parameters, const Transform& transform = identity);
  std::vector<std::string> media() const;
  /// `transform` maps camera space (+x right, +y up, +z forward) to world space.
  void set_camera(const std::string& type, const Parameters& parameters,
                  const Transform& transform);
  Transform camera() const;
  /// Sets the medium at a camera that is outside all solids.
  void set_camera_medium(std::optional<std::uint32_t> medium);
  /// Sets film, filter, sampler or integrator; missing parameters have the defaults of scene files.
  void set_option(Statement statement, const std::string& type, const Parameters& parameters);
  /// Adds what is missing: a camera that frames the shapes, and studio light. They are updated when
  /// this is called again after shapes were added, and removed when a camera or light is given.
  /// Throws InputError for what cannot be rendered, and for a scene without shapes, lights and
  /// camera.
  void present();
  /// Widens capsules and spheres to the film's "leastwidth", in pixels of its size and camera, as
  /// render() does with a copy. Does nothing for a scene without one.
  void widen_to_least();

 private:
  friend struct Inside;
  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  Data& changed();
  std::shared_ptr<Data> data_;
};

CAPLET_END
