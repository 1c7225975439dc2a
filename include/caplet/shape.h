// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Building blocks of scenes: shapes singly and in bulk, and the parameters of named types.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "caplet/export.h"
#include "caplet/material.h"

CAPLET_BEGIN

/// Three rows of four numbers that map a shape's or instance's space to the world (or the object).
using Transform = std::array<double, 12>;
inline constexpr Transform identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// The convex hull of two spheres, in the space of its shape; a sphere if the ends coincide.
struct Capsule {
  std::array<float, 3> p0{}, p1{};
  float radius0 = 0, radius1 = 0;
};

/// Arrays with one entry per capsule; spheres have p0 = p1. `radius1` is empty when none is
/// tapered; `materials`, by number, are empty where all have the shape's. `u` is empty, or u at p0
/// and at p1 of the capsules of a chain (docs/shapes.md, "Chains"). Capsules that move have
/// `times`, two or more that rise (seconds): points and radii are then those of all capsules at the
/// first time, then at the second one, and so on.
struct CapsuleArrays {
  std::vector<std::array<float, 3>> p0, p1;
  std::vector<float> radius0, radius1;
  std::vector<std::uint32_t> materials;
  std::vector<std::array<float, 2>> u = {};
  std::vector<double> times = {};
};

/// Balls of a molecular surface, with an entry each; `materials`, by number, are empty where all
/// have the shape's.
struct BallArrays {
  std::vector<std::array<float, 3>> centers;
  std::vector<float> radii;
  std::vector<std::uint32_t> materials;
};

/// Triangles by corner indices, counter-clockwise from outside. Normals (any length) and uvs: empty
/// or one per vertex. A mesh that moves has `times`, two or more that rise (seconds): positions and
/// normals are then those of all vertices at the first time, then at the second one, and so on.
struct MeshArrays {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<float, 2>> uvs;
  std::vector<double> times = {};
};

/// Properties of shapes beside their geometry.
struct ShapeOptions {
  std::string name = {};
  Transform transform = identity;
  std::vector<std::uint32_t> materials =
      {};  // numbers: none (a grey diffuse one), one, or one per surface
  std::optional<Parameters> emission = {};  // makes it a light: parameters of Statement::emission
  std::optional<std::uint32_t> inside = {}, outside = {};  // media by number
  bool reverse_orientation = false;
  std::string object = {};  // the object definition that it is added to; empty: the world
};

/// The kinds of statements that scene files define by a type and parameters.
enum class Statement {
  shape,
  light,
  emission,
  medium,
  camera,
  film,
  filter,
  sampler,
  integrator,
  material,
  texture
};

/// Lists the types in scene files (docs/formats/pbrt.md).
CAPLET_API std::vector<std::string> statement_types(Statement statement);

struct KnownParameter {
  std::string name;
  std::vector<std::string>
      types;  // pbrt's names: "float", "point3", "rgb", ...; none of what scene files lack
  std::string doc = {};       // description
  std::string fallback = {};  // the default as scene files would write it; empty: none
  // The range of numbers includes both ends, except `low` where above_low is set.
  double low = -std::numeric_limits<double>::infinity(),
         high = std::numeric_limits<double>::infinity();
  bool above_low = false;
  std::string unit = {};
  std::vector<std::string> choices = {};   // all allowed values; empty: any
  std::vector<std::string> excludes = {};  // parameters that it cannot be combined with
  bool has_effect = true;                  // false: it is read and ignored
};
/// Throws InputError for an unknown type.
CAPLET_API std::vector<KnownParameter> statement_parameters(Statement statement,
                                                            const std::string& type);

CAPLET_END
