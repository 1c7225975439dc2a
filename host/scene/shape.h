// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A shape of the model: one of geometries.def, with where it lies and what it is made of.
#pragma once

#include <cstdint>
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
#include "scene/light_image.h"
                               >;

struct AreaEmission {
  Spectrum radiance = ConstantSpectrum{1};        // without an image
  std::shared_ptr<const EnvironmentImage> image;  // over uv, its bottom row at v = 0
  double scale = 1;             // all scale factors of the file, multiplied ("scale", "power" resolved by lower when set)
  std::optional<double> power;  // watts over the whole shape; replaces the radiance's magnitude
  bool two_sided = false;
  std::vector<std::uint32_t> surfaces;  // that emit; empty: all
};

struct Shape {
  Geometry geometry;
  glm::dmat4 world_from_object{1};       // in an object definition: object_from_shape
  std::uint32_t material = 0;            // index into Scene::materials
  std::vector<std::uint32_t> materials;  // empty, or one a surface
  std::optional<TextureOperand> alpha;   // of floats: the chance that a ray is stopped, 0 to 1; none: 1
  bool is_backdrop = false;              // a floor: an automatic camera is framed to what else there is
  bool one_sided = false;                // hits from inside (open shapes: from behind) are not seen
  std::optional<AreaEmission> emission;
  bool reverse_orientation = false;
  MediumSides media = {};
  std::string name;
  SourceLocation where;
};

/// How many surfaces a shape has: material slots. 1 for meshes and capsules however many primitives they hold.
std::size_t surface_count(const Shape& shape);

/// True for shapes with an inside: what csg can combine.
bool is_closed(const Shape& shape);

/// Of the edges of a shape the share that an odd number of its faces have: 0 of solids and of meshes that enclose what is in
/// them, 1 of other open shapes. Faces meet where their corners are the same points.
double open_edges(const Shape& shape);

/// Whether open_edges(shape) is 0: solids, and meshes that enclose what is in them. Takes a few nanoseconds a face. A mesh that
/// is open passes for a closed one with a chance of 2^-64.
bool is_watertight(const Shape& shape);

/// Solids in a csg shape, nested ones counted; 1 for other shapes. Counting stops above max_csg_operands.
std::size_t solid_count(const Shape& shape);

/// Exact bounds of the transformed shape itself (ellipsoids, capsules and parts of quadrics under affine maps included, not of
/// its transformed box), as bounds_under of its geometry has them.
Bounds bounds_of(const Shape& shape);
Bounds bounds_of(const Geometry& geometry, const glm::dmat4& world_from_object);

/// The geometry's name in geometries.def ("capsule" for tapered ones too), and how many primitives it holds.
const char* geometry_name(const Shape& shape);
std::size_t primitive_count(const Shape& shape);

/// Reports what of the geometry alone cannot be rendered.
void check_geometry(const Shape& shape, ShapeCheck& report);

}  // namespace caplet
