// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The scene model in double precision, as its file states it. Importers produce it, and all other
// parts read it. Lengths are in scene units, angles in radians; matrices map column vectors and are
// named destination_from_source.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/camera.h"
#include "scene/field.h"
#include "scene/film.h"
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

// --- Sampler, integrator ---

struct SamplerSettings {
  enum class Kind {
#define SAMPLER(name) name,
#include "shared/samplers.def"
#undef SAMPLER
  } kind = Kind::sobol;
  int samples_per_pixel = 16;
  std::uint32_t seed = 0;
  int x_strata = 4,
      y_strata =
          4;  // stratified, where their product is samples_per_pixel; else strata_of divides it
  bool jitter = true;  // stratified

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    if (self.kind == Kind::stratified) {
      visit.integer({"xsamples", "strata along x", 1, 1 << 24}, self.x_strata);
      visit.integer({"ysamples", "strata along y", 1, 1 << 24}, self.y_strata);
      visit.flag({"jitter", "samples lie at random in their strata, else in the middle"},
                 self.jitter);
    } else {
      visit.integer({"pixelsamples", "samples of each pixel", 1, most_integer},
                    self.samples_per_pixel);
    }
    visit.seed({"seed", "another one gives other noise"}, self.seed);
  }
};

/// Lists the names in scene files, in the order of SamplerSettings::Kind.
inline constexpr std::array sampler_names = {
#define SAMPLER(name) #name,
#include "shared/samplers.def"
#undef SAMPLER
};

/// Returns strata along x and y whose product is samples_per_pixel: the sampler's own, or else
/// those nearest to a square.
std::array<int, 2> strata_of(const SamplerSettings& sampler);

struct IntegratorSettings {
  enum class Kind { path, ambient_occlusion, simple_path, random_walk } kind = Kind::path;
  int max_depth = 5;                                              // scattering events
  double max_distance = std::numeric_limits<double>::infinity();  // ambient occlusion, scene units
  bool cosine_sample = true;                      // ambient occlusion: else directions are uniform
  bool sample_bsdf = true, sample_lights = true;  // simple path

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    if (self.kind == Kind::ambient_occlusion) {
      visit.flag({"cossample", "directions by the cosine, else uniform"}, self.cosine_sample);
      visit.number(
          {"maxdistance", "how far what occludes may be", 0, no_limit, "scene units", true},
          self.max_distance);
      return;
    }
    visit.integer({"maxdepth", "most scattering events of a path", 0, most_integer},
                  self.max_depth);
    if (self.kind != Kind::simple_path) return;
    visit.flag({"samplebsdf", "directions by the BSDF, else uniform"}, self.sample_bsdf);
    visit.flag({"samplelights", "lights are sampled at each hit"}, self.sample_lights);
  }
};

/// Lists the names in scene files, in the order of IntegratorSettings::Kind.
inline constexpr std::array integrator_names = {"path", "ambientocclusion", "simplepath",
                                                "randomwalk"};

/// Settings of the automatic camera.
struct Framing {
  std::optional<glm::dvec3> toward_viewer;  // world, of any length
  std::optional<glm::dvec3> up;             // world, unit; none: y
  bool is_orthographic = false;
};

/// The legend of a colour map: its colours at even steps from `low` to `high`.
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
  bool automatic_camera = false;  // the camera was framed to the shapes (present/present.h), for
                                  // the film's size as it was
  bool has_no_up = false;  // no direction is up (a neuron): the automatic camera may turn the scene
                           // within the image
  Framing framing;         // settings of the automatic camera
  glm::dmat3 world_from_file{1};  // a rotation: its axes are those of the file
  std::string unit;               // the unit of lengths, as people write it ("µm"); empty: unknown
  std::optional<Legend> legend;   // the legend of its colours
};

/// Returns the bounds of all shapes in the world, including instances.
Bounds bounds_of(const Scene& scene);

/// Counts primitives by kind, with instances expanded. Kinds are the names of shapes in scene
/// files; tapered capsules count as "capsule", patches of a bilinear mesh as "bilinear_patch".
std::map<std::string, std::uint64_t> count_primitives(const Scene& scene);

/// Reports everything that cannot be rendered: non-finite numbers, non-positive sizes, singular
/// transforms, indices out of range, an image larger than 2^28 pixels. Errors name the places of
/// the statements.
void validate(const Scene& scene, Diagnostics& diagnostics);

}  // namespace caplet
