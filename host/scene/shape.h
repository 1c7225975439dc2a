// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A shape: one of geometries.def, with its transform and material.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/bounds.h"
#include "scene/geometries.def"
#include "scene/light_image.h"
#include "scene/medium.h"
#include "scene/spectrum.h"
#include "scene/texture_operand.h"

namespace caplet {

template <class, class... Types>
using VariantBehind = std::variant<Types...>;
using Geometry = VariantBehind<void
#define GEOMETRY(Type, name) , Type
#include "scene/geometries.def"
                               >;

struct AreaEmission {
  Spectrum radiance = ConstantSpectrum{1};        // used without an image
  std::shared_ptr<const EnvironmentImage> image;  // mapped over uv, its bottom row at v = 0
  double scale =
      1;  // all scale factors of the file, multiplied ("scale", "power" resolved by lower when set)
  std::optional<double> power;  // watts over the whole shape; replaces the radiance's magnitude
  bool two_sided = false;
  std::vector<std::uint32_t> surfaces;  // the surfaces that emit; empty: all
};

struct Shape {
  Geometry geometry;
  glm::dmat4 world_from_object{1};       // in an object definition: object_from_shape
  std::uint32_t material = 0;            // index into Scene::materials
  std::vector<std::uint32_t> materials;  // empty, or one per surface
  std::optional<TextureOperand>
      alpha;  // opacity as a float: the chance that a ray is stopped, 0 to 1; none: 1
  bool is_backdrop =
      false;               // a floor: the automatic camera ignores it unless there is nothing else
  bool one_sided = false;  // hits from inside (open shapes: from behind) are not seen
  std::optional<AreaEmission> emission;
  bool reverse_orientation = false;
  MediumSides media = {};
  std::string name;
  SourceLocation where;
};

/// Returns the number of surfaces (material slots). Meshes and capsules have 1, however many
/// primitives they contain.
std::size_t surface_count(const Shape& shape);

/// Returns the times (seconds) of a shape whose points move; none where it rests.
const std::vector<double>& key_times(const Shape& shape);

/// Returns whether its points move or, of a csg shape, its operands.
bool moves(const Shape& shape);

/// Calls visit(time) for the times (seconds) of all keys of the shape and of its operands.
void visit_key_times(const Shape& shape, const std::function<void(double)>& visit);

/// Returns whether the shape has an inside, so that csg can combine it.
bool is_closed(const Shape& shape);

/// Returns the share of edges that belong to an odd number of faces: 0 for solids and for closed
/// meshes, 1 for other open shapes. Faces meet where their corners are the same points.
double open_edges(const Shape& shape);

/// Returns whether open_edges(shape) is 0, as it is for solids and closed meshes. Takes a few
/// nanoseconds per face. The chance that an open mesh passes for a closed one is 2^-64.
bool is_watertight(const Shape& shape);

/// Counts the solids in a csg shape, including nested ones; 1 for other shapes. Counting stops
/// above max_csg_operands.
std::size_t solid_count(const Shape& shape);

/// Returns tight bounds of the transformed shape itself, not of its transformed box (for
/// ellipsoids, capsules and parts of quadrics under affine maps too), by bounds_under of its
/// geometry.
Bounds bounds_of(const Shape& shape);
Bounds bounds_of(const Geometry& geometry, const glm::dmat4& world_from_object);

/// Returns the geometry's name in geometries.def ("capsule" for tapered ones too), and the number
/// of its primitives.
const char* geometry_name(const Shape& shape);
std::size_t primitive_count(const Shape& shape);

/// Reports why the geometry cannot be rendered, without regard to the rest of the scene.
void check_geometry(const Shape& shape, ShapeCheck& report);

}  // namespace caplet
