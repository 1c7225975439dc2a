// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The model of a scene, in double precision, as its file states it: what importers produce and everything else starts from.
// Lengths are in scene units, angles in radians, matrices map column vectors and are named destination_from_source.
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/spectrum.h"

namespace caplet {

// --- Shapes (object space) ---

inline constexpr double full_turn = 6.283185307179586;
/// The greatest coordinate or size in a scene: squares of 1e18, and sums of some, are within a 32-bit float (3.4e38).
inline constexpr double largest_length = 1e18;

struct SphereShape {
  double radius = 1;  // centre at the origin
};

/// Capsules (p0, p1, one radius) and tapered capsules (two radii): the convex hull of two spheres each. Also the bulk form.
/// All vectors have one entry a capsule; `radius1` is empty when no capsule is tapered; `materials` is empty or holds an index
/// into Scene::materials a capsule (overriding Shape::material).
struct CapsulesShape {
  std::vector<glm::vec3> p0, p1;
  std::vector<float> radius0, radius1;
  std::vector<std::uint32_t> materials;
};

struct TriangleMeshShape {
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<glm::vec3> normals;  // empty or one a vertex
  std::vector<glm::vec2> uvs;      // empty or one a vertex
};

/// Disk of `radius` in the plane z = height, normal +z. Partial as pbrt's: without a hole of `inner_radius`, up to `phi_max`.
struct DiskShape {
  double height = 0;
  double radius = 1;
  double inner_radius = 0;
  double phi_max = full_turn;  // radians, from +x towards +y

  bool is_whole() const { return inner_radius == 0 && phi_max >= full_turn; }
};

/// How an end of a cylinder or cone is closed. The solid is the convex hull of its two ends: flat ones are disks across the axis,
/// round ones balls of the end's radius. An open end is a flat one that rays pass through: the shape is then no solid.
enum class Cap { flat, round, open };

/// Surfaces: 0 side, 1 the cap at p0, 2 the cap at p1.
struct CylinderShape {
  glm::dvec3 p0{0, 0, 0}, p1{0, 0, 1};
  double radius = 1;
  std::array<Cap, 2> caps{Cap::flat, Cap::flat};
};

/// A frustum where both caps are flat; one radius may be 0. Surfaces as the cylinder's.
struct ConeShape {
  glm::dvec3 p0{0, 0, 0}, p1{0, 0, 1};
  std::array<double, 2> radius{1, 0};
  std::array<Cap, 2> caps{Cap::flat, Cap::flat};
};

/// Between two opposite corners, along the axes. Surfaces: 0 and 1 at the least and greatest x, 2 and 3 y, 4 and 5 z.
struct BoxShape {
  glm::dvec3 p0{0}, p1{1};
};

inline constexpr std::size_t max_polyhedron_planes = 1024;  // 32 in a csg still have their surfaces numbered in 16 bits
/// The points x with normals[i] . (x - points[i]) <= 0 for all i: bounded, with an inside. Surface i lies in plane i.
struct PolyhedronShape {
  std::vector<glm::dvec3> points, normals;  // outward, of any length
};

/// Part of a sphere around the origin, as pbrt's: z_min <= z <= z_max, 0 <= phi <= phi_max. Open.
struct PartialSphereShape {
  double radius = 1, z_min = -1, z_max = 1, phi_max = full_turn;
};

/// pbrt's cylinder around the z axis: a tube, or part of one. Open.
struct OpenCylinderShape {
  double radius = 1, z_min = -1, z_max = 1, phi_max = full_turn;
};

/// Bilinear patches; a patch's corners are p00, p10, p01, p11 (pbrt's order). Open.
struct BilinearMeshShape {
  std::vector<glm::vec3> positions;
  std::vector<std::array<std::uint32_t, 4>> patches;
  std::vector<glm::vec3> normals;  // empty or one a vertex
  std::vector<glm::vec2> uvs;      // empty or one a vertex
};

struct Shape;

/// Closed solids combined. Difference: the first without all others. The operands' surfaces follow each other; what is subtracted
/// shows its inside.
struct CsgShape {
  enum class Operation { set_union, set_intersection, set_difference } operation = Operation::set_union;
  std::vector<std::shared_ptr<const Shape>> operands;  // two or more; their world_from_object is object_from_operand
};
inline constexpr std::size_t max_csg_operands = 32;  // solids in one csg shape, nested ones counted

struct AreaEmission {
  Spectrum radiance = ConstantSpectrum{1};
  double scale = 1;             // all scale factors of the file, multiplied ("scale", "power" resolved by lower when set)
  std::optional<double> power;  // watts over the whole shape; replaces the radiance's magnitude
  bool two_sided = false;
  std::vector<std::uint32_t> surfaces;  // that emit; empty: all
};

/// What a Shape may be: X(Type) for each.
#define CAPLET_GEOMETRIES(X) \
  X(SphereShape)             \
  X(CapsulesShape)           \
  X(TriangleMeshShape)       \
  X(DiskShape)               \
  X(CylinderShape)           \
  X(ConeShape)               \
  X(BoxShape)                \
  X(PolyhedronShape)         \
  X(PartialSphereShape)      \
  X(OpenCylinderShape)       \
  X(BilinearMeshShape)       \
  X(CsgShape)

template <class, class... Types>
using VariantBehind = std::variant<Types...>;
#define CAPLET_COMMA_TYPE(Type) , Type
using Geometry = VariantBehind<void CAPLET_GEOMETRIES(CAPLET_COMMA_TYPE)>;
#undef CAPLET_COMMA_TYPE

struct Shape {
  Geometry geometry;
  glm::dmat4 world_from_object{1};       // in an object definition: object_from_shape
  std::uint32_t material = 0;            // index into Scene::materials
  std::vector<std::uint32_t> materials;  // empty, or one a surface
  bool one_sided = false;                // hits from inside (open shapes: from behind) are not seen
  std::optional<AreaEmission> emission;
  bool reverse_orientation = false;
  std::string name;
  SourceLocation where;
};

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
  double fov = 1.5707963267948966;  // of the shorter image side, full angle
  std::optional<double> frame_aspect_ratio;
  std::optional<std::array<double, 4>> screen_window;  // x min, x max, y min, y max
  double lens_radius = 0;
  double focal_distance = 1e6;
};

struct PixelFilter {
  enum class Kind { box, triangle, gaussian, mitchell } kind = Kind::gaussian;
  double radius_x = 1.5, radius_y = 1.5;  // pixels
  double sigma = 0.5;                     // gaussian
  double b = 1.0 / 3, c = 1.0 / 3;        // mitchell
};

struct FilmSettings {
  int width = 1280, height = 720;
  std::optional<std::array<int, 4>> crop;  // x0, x1, y0, y1 in pixels, half open
  std::string filename;                    // as the scene file states it
  double iso = 100, exposure_time = 1;     // film scale = exposure_time * iso / 100 (sensor-free rgb: 1 by default)
  double max_component_value = 0;          // 0: none
  ColorSpace space = ColorSpace::srgb;
};

struct SamplerSettings {
  int samples_per_pixel = 16;
  std::uint32_t seed = 0;
};

struct IntegratorSettings {
  int max_depth = 5;
};

struct Scene {
  std::vector<Material> materials;
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
};

struct Bounds {
  glm::dvec3 min{1e300}, max{-1e300};
  bool empty() const { return !(min.x <= max.x); }
  void extend(const glm::dvec3& p);
  void extend(const Bounds& other);
};

/// How many surfaces a shape has: material slots. 1 for meshes and capsules however many primitives they hold.
std::size_t surface_count(const Shape& shape);

/// True for shapes with an inside: what csg can combine.
bool is_closed(const Shape& shape);

/// Solids in a csg shape, nested ones counted; 1 for other shapes. Counting stops above max_csg_operands.
std::size_t solid_count(const Shape& shape);

/// Exact bounds of the transformed shape itself (ellipsoids, capsules and parts of quadrics under affine maps included, not of
/// its transformed box). For csg: around the solid, and tight to about 1/64 of its size, at moderate cost (csg_bounds.h); empty
/// when it is found to be empty. For polyhedra: empty when polyhedron_corners is.
Bounds bounds_of(const Shape& shape);
Bounds bounds_of(const Scene& scene);

/// Corners of each face of a polyhedron in order around it (counter-clockwise from outside), object space; fewer than three for
/// planes that only touch the solid, stay clear of it or repeat an earlier one. Empty when the polyhedron is unbounded, further
/// across than a million times the spread of its points (unbounded, so to speak), has no inside, or is thinner than 1e-7 of that
/// spread. `bad_plane`: then the first plane to blame (a degenerate one, the one that leaves nothing inside the earlier ones, or
/// one whose face has no end). Time: square of the number of planes, milliseconds for some hundred.
std::vector<std::vector<glm::dvec3>> polyhedron_faces(const PolyhedronShape& polyhedron, std::size_t* bad_plane = nullptr);

/// Every corner once; the same otherwise.
std::vector<glm::dvec3> polyhedron_corners(const PolyhedronShape& polyhedron, std::size_t* bad_plane = nullptr);

/// Number of primitives per kind (the names of shapes as scene files know them; tapered capsules count as "capsule", patches of a
/// bilinear mesh as "bilinear_patch"), instances expanded.
std::map<std::string, std::uint64_t> count_primitives(const Scene& scene);

/// Reports everything that cannot be rendered: non-finite numbers, non-positive sizes, singular transforms, indices out of range,
/// an image larger than 2^28 pixels, an empty scene. Places are those of the statements.
void validate(const Scene& scene, Diagnostics& diagnostics);

}  // namespace caplet
