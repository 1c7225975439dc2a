// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The model of a scene, in double precision, as its file states it: what importers produce and everything else starts from.
// Lengths are in scene units, angles in radians, matrices map column vectors and are named destination_from_source.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/backdrop.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/medium.h"
#include "scene/shape.h"
#include "scene/spectrum.h"

namespace caplet {

// --- Objects and instances ---

struct Object {
  std::string name;
  std::vector<Shape> shapes;
  SourceLocation where;
};
struct Instance {
  std::uint32_t object = 0;  // index into Scene::objects
  glm::dmat4 world_from_object{1};
  SourceLocation where;
};

// --- Camera, film, sampler, integrator ---

struct Camera {
  glm::dmat4 world_from_camera{1};  // camera space: +x right, +y up, +z forward
  double fov = 1.5707963267948966;  // of the shorter image side, full angle; 0: orthographic, the screen window in scene units
  std::optional<double> frame_aspect_ratio;
  std::optional<std::array<double, 4>> screen_window;  // x min, x max, y min, y max
  double lens_radius = 0;
  double focal_distance = 1e6;
  std::optional<std::uint32_t> medium = {};  // where no solid holds the camera: index into Scene::media
};

struct PixelFilter {
  enum class Kind { box, triangle, gaussian, mitchell, sinc } kind = Kind::gaussian;
  double radius_x = 1.5, radius_y = 1.5;  // pixels
  double sigma = 0.5;                     // gaussian
  double b = 1.0 / 3, c = 1.0 / 3;        // mitchell
  double tau = 3;                         // sinc: cycles until the window's zero
};

struct FilmSettings {
  int width = 1280, height = 720;
  std::optional<std::array<int, 4>> crop;  // x0, x1, y0, y1 in pixels, half open
  std::string filename;                    // as the scene file states it
  double iso = 100, exposure_time = 1;     // film scale = exposure_time * iso / 100 (sensor-free rgb: 1 by default)
  double max_component_value = 0;          // of a sample's exposed XYZ; 0: none
  double white_balance = 0;                // kelvin: this daylight becomes the colour space's white; 0: nothing does
  ColorSpace space = ColorSpace::srgb;
  std::optional<Backdrop> backdrop = {};
  double least_width = 0;  // pixels: capsules and spheres are drawn no thinner (present/least_width.h); 0: as they are
};

struct SamplerSettings {
  int samples_per_pixel = 16;
  std::uint32_t seed = 0;
};

struct IntegratorSettings {
  int max_depth = 5;
};

/// How the automatic camera looks, where it is told.
struct Framing {
  std::optional<glm::dvec3> toward_viewer;  // world, of any length
  std::optional<glm::dvec3> up;             // world, unit; none: y
  bool is_orthographic = false;
};

/// What colours tell of numbers: those of a colour map, at even steps from `low` to `high`.
struct Legend {
  std::string title, unit;
  double low = 0, high = 1;
  std::vector<glm::dvec3> colors;  // linear sRGB, as displayed
};

struct Scene {
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Medium> media;
  std::vector<Shape> shapes;  // world
  std::vector<Object> objects;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  Camera camera;
  PixelFilter filter;
  FilmSettings film;
  SamplerSettings sampler;
  IntegratorSettings integrator;
  std::string source;             // the file it came from
  bool automatic_camera = false;  // the camera was framed to the shapes (present/present.h), for the film's size as it was
  bool has_no_up = false;         // no direction is up (a neuron): the automatic camera may turn the scene within the image
  Framing framing;                // of the automatic camera
  glm::dmat3 world_from_file{1};  // a rotation: its axes are those that the file names
  std::string unit;               // of lengths, as people write it ("µm"); empty: not known
  std::optional<Legend> legend;   // of its colours
};

/// The camera's screen window: its own, or that of its or the film's aspect ratio.
std::array<double, 4> screen_window_of(const Camera& camera, const FilmSettings& film);

/// Of all shapes where they lie, instances among them.
Bounds bounds_of(const Scene& scene);

/// Number of primitives per kind (the names of shapes as scene files know them; tapered capsules count as "capsule", patches of a
/// bilinear mesh as "bilinear_patch"), instances expanded.
std::map<std::string, std::uint64_t> count_primitives(const Scene& scene);

/// Reports everything that cannot be rendered: non-finite numbers, non-positive sizes, singular transforms, indices out of range,
/// an image larger than 2^28 pixels. Places are those of the statements.
void validate(const Scene& scene, Diagnostics& diagnostics);

}  // namespace caplet
