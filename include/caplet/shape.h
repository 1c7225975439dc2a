// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What scenes are built of: shapes one by one and in bulk, and what there is by a type's name.
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

/// Three rows of four numbers: world (or object) space from that of a shape or instance.
using Transform = std::array<double, 12>;
inline constexpr Transform identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/// The convex hull of two spheres; of one where the ends are the same. In the space of its shape.
struct Capsule {
  std::array<float, 3> p0{}, p1{};
  float radius0 = 0, radius1 = 0;
};

/// Many of them, one entry each; spheres have p0 = p1. `radius1` is empty when none is tapered; `materials`, by number, are empty
/// where all have the shape's. `u` is empty, or u at p0 and at p1 of the capsules of a chain (docs/shapes.md, "Chains").
struct CapsuleArrays {
  std::vector<std::array<float, 3>> p0, p1;
  std::vector<float> radius0, radius1;
  std::vector<std::uint32_t> materials;
  std::vector<std::array<float, 2>> u = {};
};

/// Triangles: corners by their numbers, counter-clockwise from outside. Normals (any length) and uvs: empty or one a vertex.
struct MeshArrays {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<float, 2>> uvs;
};

/// What shapes have beside their geometry.
struct ShapeOptions {
  std::string name = {};
  Transform transform = identity;
  std::vector<std::uint32_t> materials = {};               // by number: none (a grey diffuse one), one, or one a surface
  std::optional<Parameters> emission = {};                 // makes it a light: those of Statement::emission
  std::optional<std::uint32_t> inside = {}, outside = {};  // media by number
  bool reverse_orientation = false;
  std::string object = {};  // the object definition that it becomes part of; empty: the world
};

/// What scene files know by a type and parameters.
enum class Statement { shape, light, emission, medium, camera, film, filter, sampler, integrator, material, texture };

/// As scene files name them (docs/formats/pbrt.md).
CAPLET_API std::vector<std::string> statement_types(Statement statement);

struct KnownParameter {
  std::string name;
  std::vector<std::string> types;  // pbrt's names: "float", "point3", "rgb", ...; none of what scene files have not
  std::string doc = {};            // what it is
  std::string fallback = {};       // what it is where it is left out, as scene files would have it; empty: nothing
  // The range of numbers: both ends are in it, but for `low` where above_low.
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool above_low = false;
  std::string unit = {};
  std::vector<std::string> choices = {};   // all that there are; empty: any
  std::vector<std::string> excludes = {};  // not together with these
  bool has_effect = true;                  // else it is read and ignored
};
/// Throws InputError for an unknown type.
CAPLET_API std::vector<KnownParameter> statement_parameters(Statement statement, const std::string& type);

CAPLET_END
