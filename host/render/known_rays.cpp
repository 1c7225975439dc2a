// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/detail/known_rays.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <optional>
#include <random>
#include <string_view>
#include <utility>

#include "shared/shapes.h"

namespace caplet {

namespace {

using glm::dmat4;
using glm::dvec2;
using glm::dvec3;
using Side = KnownCrossing::Side;

constexpr int copies = 12;
constexpr int cells_a_side = 7, middle_cell = cells_a_side / 2;
// Shapes reach 1.3 from the middle of their cell before they are scaled by 1.5 at most; rays, at
// most three times a shape's width long, reach 8.
constexpr double cell_width = 24;

class Random {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 8) * 0x1p-24);
  }
  bool coin() { return (engine_() & 256u) != 0; }
  dvec3 direction() {
    const double z = uniform(-1, 1), phi = uniform(0, full_turn), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  /// Returns a unit vector across `axis`.
  dvec3 across(const dvec3& axis) {
    for (;;) {
      const dvec3 tried = direction(),
                  out = tried - axis * (glm::dot(tried, axis) / glm::dot(axis, axis));
      if (glm::length(out) > 0.1) return glm::normalize(out);
    }
  }

 private:
  std::mt19937 engine_{11};
};

/// SurfacePoint is a point of a surface, the outward unit normal there, and whether the surface is
/// there: open shapes miss parts.
struct SurfacePoint {
  dvec3 p, n;
  bool present = true;
};
using Sampler = std::function<SurfacePoint(Random&)>;

double dot_of(const SurfacePoint& point, const dvec3& direction) {
  return glm::dot(point.n, direction) / glm::length(direction);
}

class Maker {
 public:
  /// `stretches`: there may be instances; every shape that is stretched or one-sided becomes one.
  explicit Maker(bool stretches) : stretches_(stretches) {}

  /// Adds a convex solid for which `sample` draws points of the surface, under `sized`.
  void solid(int kind, const Geometry& geometry, const Sampler& sample,
             const dmat4& sized = dmat4(1)) {
    keep_first(
        geometry, [=, this] { rays_of_solid(sample, false); }, sized);
    for (int copy = 0; copy < copies; ++copy) {
      const bool one_sided = stretches_ && copy % 4 == 3;
      begin(kind, geometry, copy, one_sided, sized);
      rays_of_solid(sample, one_sided);
    }
  }

  /// Adds the part of a convex surface that is there. Points are at least a little away from its
  /// rims.
  void open(int kind, const Geometry& geometry, const Sampler& sample) {
    keep_first(geometry, [=, this] { rays_of_open(sample); });
    for (int copy = 0; copy < copies; ++copy) {
      begin(kind, geometry, copy, false);
      rays_of_open(sample);
    }
  }

  /// Adds a sheet over the plane z = 0 that is nowhere steeper than 1/2. `sample`: points on it, or
  /// beside it.
  void sheet(int kind, const Geometry& geometry, const Sampler& sample) {
    keep_first(geometry, [=, this] { rays_of_sheet(sample); });
    for (int copy = 0; copy < copies; ++copy) {
      begin(kind, geometry, copy, false);
      rays_of_sheet(sample);
    }
  }

  /// Adds the box [-1, 1]^3 and a ball of radius 0.6 around (0, 0, 1), combined, along lines that
  /// are parallel to z.
  void csg() {
    const auto box = std::make_shared<Shape>(), ball = std::make_shared<Shape>();
    box->geometry = BoxShape{dvec3(-1), dvec3(1)};
    ball->geometry = SphereShape{0.6};
    ball->world_from_object = glm::translate(dmat4(1), dvec3(0, 0, 1));
    for (int copy = 0; copy < copies; ++copy) {
      const auto operation = static_cast<CsgShape::Operation>(copy % 3);
      begin(shape_csg, CsgShape{operation, {box, ball}}, copy, false);
      for (int i = 0; i < 8; ++i) {
        const double rho = random_.uniform(0, 0.5), phi = random_.uniform(0, full_turn),
                     half = std::sqrt(0.36 - rho * rho);
        // Distances are from z = 3 downwards: the ball's ends, the box's.
        double enter = 2, leave = 4;
        if (operation == CsgShape::Operation::set_union) enter = 2 - half;
        if (operation == CsgShape::Operation::set_intersection) leave = 2 + half;
        if (operation == CsgShape::Operation::set_difference) enter = 2 + half;
        add({rho * std::cos(phi), rho * std::sin(phi), 3}, {0, 0, -1},
            {{enter, Side::entering}, {leave, Side::leaving}}, 5);
        add({1.2 + rho, std::cos(phi), 3}, {0, 0, -1}, {}, 5);
      }
    }
  }

  /// Adds placed objects of one shape: the innermost kind does not matter, and is the first.
  void instances() {
    Object object;
    Shape shape;
    shape.geometry = first_.value();
    shape.world_from_object = first_sized_;
    object.shapes.push_back(shape);
    out_.scene.objects.push_back(object);
    instances_begin_ = out_.rays.size();
    for (int copy = 0; copy < copies; ++copy) {
      matrix_ = placement(copy);
      kind_ = shape_instance;
      object_ = static_cast<std::uint32_t>(
          out_.scene.instances.size());  // counted behind the shapes, of which there may come more
      out_.scene.instances.push_back({0, matrix_, {}});
      rays_of_first_();
    }
    instances_end_ = out_.rays.size();
  }

  KnownScene take() {
    out_.scene.materials.push_back({DiffuseMaterial{}, "grey", {}});
    for (std::size_t i = instances_begin_; i < instances_end_; ++i)
      out_.rays[i].object += static_cast<std::uint32_t>(out_.scene.shapes.size());
    return std::move(out_);
  }

 private:
  void keep_first(const Geometry& geometry, const std::function<void()>& rays,
                  const dmat4& sized = dmat4(1)) {
    if (first_) return;
    first_ = geometry;
    first_sized_ = sized;
    rays_of_first_ = rays;
  }

  /// Every second placement is a similarity; the others may be stretched, and half of these
  /// mirrored.
  dmat4 placement(int copy) {
    const int cell = cell_++;
    const dvec3 place(cell % cells_a_side, cell / cells_a_side % cells_a_side,
                      cell / (cells_a_side * cells_a_side));
    dmat4 m = glm::translate(dmat4(1), cell_width * (place - dvec3(middle_cell)));
    m = glm::rotate(m, random_.uniform(0, full_turn), random_.direction());
    const double size = random_.uniform(0.7, 1.5);
    if (!stretches_ || copy % 2 == 0) return glm::scale(m, dvec3(size));
    const double mirrored = copy % 4 == 1 ? -1 : 1;
    return glm::scale(m, dvec3(random_.uniform(0.7, 1.5), random_.uniform(0.7, 1.5),
                               mirrored * random_.uniform(0.7, 1.5)));
  }

  void begin(int kind, const Geometry& geometry, int copy, bool one_sided,
             const dmat4& sized = dmat4(1)) {
    matrix_ = placement(copy);
    kind_ = kind;
    object_ = static_cast<std::uint32_t>(out_.scene.shapes.size());
    Shape shape;
    shape.geometry = geometry;
    shape.world_from_object = matrix_ * sized;
    shape.one_sided = one_sided;
    out_.scene.shapes.push_back(shape);
  }

  /// Returns two points of a convex surface whose connection goes through the inside, at 17 degrees
  /// or more to the surface at both.
  std::pair<SurfacePoint, SurfacePoint> chord(const Sampler& sample) {
    for (;;) {
      const SurfacePoint a = sample(random_), b = sample(random_);
      const dvec3 d = b.p - a.p;
      if (glm::length(d) > 0.3 && dot_of(a, d) < -0.3 && dot_of(b, d) > 0.3) return {a, b};
    }
  }

  void rays_of_solid(const Sampler& sample, bool one_sided) {
    for (int i = 0; i < 5; ++i) {
      const auto [a, b] = chord(sample);
      const dvec3 d = b.p - a.p;
      std::vector<KnownCrossing> outside{{1, Side::entering}, {2, Side::leaving}},
          inside{{1, Side::leaving}};
      if (one_sided) {
        outside.pop_back();
        inside.clear();
      }
      add(a.p - d, d, outside, 2.5);
      add((a.p + b.p) * 0.5, d * 0.5, inside, 1.5);
    }
    for (int i = 0; i < 2; ++i) {
      const SurfacePoint a = sample(random_);
      const dvec3 along = random_.across(a.n);
      add(a.p + 0.2 * a.n - 2.0 * along, 2.0 * along, {}, 2);
    }
  }

  void rays_of_open(const Sampler& sample) {
    for (int i = 0; i < 8; ++i) {
      const auto [a, b] = chord(sample);
      const dvec3 d = b.p - a.p;
      std::vector<KnownCrossing> crossings;
      if (a.present) crossings.push_back({1, Side::either});
      if (b.present) crossings.push_back({2, Side::either});
      add(a.p - d, d, crossings, 2.5);
    }
  }

  void rays_of_sheet(const Sampler& sample) {
    for (int i = 0; i < 8; ++i) {
      const SurfacePoint to = sample(random_);
      const double slope = random_.uniform(0, 0.9), phi = random_.uniform(0, full_turn);
      const dvec3 d =
          dvec3(slope * std::cos(phi), slope * std::sin(phi), 1) * (random_.coin() ? 1.0 : -1.0);
      add(to.p - d, d,
          to.present ? std::vector<KnownCrossing>{{1, Side::either}} : std::vector<KnownCrossing>{},
          2);
    }
  }

  /// Adds a ray in the shape's own space; nothing is known of it beyond `t_end`.
  void add(const dvec3& origin, const dvec3& direction, std::vector<KnownCrossing> crossings,
           double t_end) {
    const dvec3 o(matrix_ * glm::dvec4(origin, 1)), d(matrix_ * glm::dvec4(direction, 0));
    const auto f = [](double x) { return static_cast<float>(x); };
    out_.rays.push_back({kind_, object_,
                         RayRecord{f(o.x), f(o.y), f(o.z), 0, f(d.x), f(d.y), f(d.z), f(t_end)},
                         std::move(crossings)});
  }

  bool stretches_;
  std::optional<Geometry> first_;
  dmat4 first_sized_{1};
  std::function<void()> rays_of_first_;
  Random random_;
  KnownScene out_;
  int cell_ = 0, kind_ = 0;
  std::uint32_t object_ = 0;
  dmat4 matrix_{1};
  std::size_t instances_begin_ = 0, instances_end_ = 0;
};

dvec3 lerp(const dvec3& a, const dvec3& b, double s) { return a + s * (b - a); }

// --- Surfaces ---

/// Samples the hull of two balls: its ends, and its side, along which the normal leans by the
/// difference of the radii.
Sampler hull_of_balls(const dvec3& p0, const dvec3& p1, double r0, double r1) {
  return [=](Random& random) {
    const dvec3 axis = p1 - p0;
    const double sine = (r0 - r1) / glm::length(axis);
    if (random.coin()) {
      const dvec3 n =
          std::sqrt(1 - sine * sine) * random.across(axis) + sine * glm::normalize(axis);
      return SurfacePoint{lerp(p0 + r0 * n, p1 + r1 * n, random.uniform(0.05, 0.95)), n};
    }
    const dvec3 n = random.direction();
    return SurfacePoint{glm::dot(p0, n) + r0 > glm::dot(p1, n) + r1 ? p0 + r0 * n : p1 + r1 * n, n};
  };
}

/// Samples a frustum; `round`: a ball of radius r0 around p0 as well (r0 = r1).
Sampler frustum(const dvec3& p0, const dvec3& p1, double r0, double r1, bool round) {
  return [=](Random& random) {
    const dvec3 axis = p1 - p0, unit = glm::normalize(axis), out = random.across(axis);
    const double which = random.uniform(0, 3), rho = random.uniform(0, 0.95);
    if (which < 1) return SurfacePoint{p1 + rho * r1 * out, unit};
    if (which < 2 && round) {
      dvec3 n = random.direction();
      if (glm::dot(n, unit) > 0) n = -n;
      return SurfacePoint{p0 + r0 * n, n};
    }
    if (which < 2) return SurfacePoint{p0 + rho * r0 * out, -unit};
    const dvec3 n = glm::normalize(glm::length(axis) * out + (r0 - r1) * unit);
    return SurfacePoint{lerp(p0 + r0 * out, p1 + r1 * out, random.uniform(0.05, 0.95)), n};
  };
}

/// Returns the matrix that takes the ball around a solid's bounds to the unit ball.
template <FacedSolid Solid>
dmat4 to_unit_size(const Solid& solid) {
  const Bounds box = bounds_under(solid, dmat4(1));
  const double radius = 0.5 * glm::length(box.max - box.min);
  return glm::translate(glm::scale(dmat4(1), dvec3(1 / radius)), -0.5 * (box.min + box.max));
}

/// Returns the deepest of a lattice of points.
template <FacedSolid Solid>
dvec3 point_inside(const Solid& solid) {
  const Bounds box = bounds_under(solid, dmat4(1));
  constexpr int n = 12;
  dvec3 best = box.min;
  for (int i = 1; i < n; ++i)
    for (int k = 1; k < n; ++k)
      for (int j = 1; j < n; ++j)
        if (const dvec3 p = box.min + (box.max - box.min) * (dvec3(i, k, j) / double(n));
            beyond(solid, p).most < beyond(solid, best).most)
          best = p;
  return best;
}

/// Samples along rays from the inside, where only one surface is met: the others are still a little
/// away.
template <FacedSolid Solid>
Sampler surface_of(const Solid& solid) {
  const dmat4 sized = to_unit_size(solid), own = glm::inverse(sized);
  const dvec3 inside = point_inside(solid);
  return [=](Random& random) {
    for (;;) {
      const dvec3 along = glm::dmat3(own) * random.direction();
      double low = 0, high = 2;
      for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        (beyond(solid, inside + middle * along).most > 0 ? high : low) = middle;
      }
      const dvec3 p = inside + low * along;
      int surface = 0;
      double next = -HUGE_VAL, most = -HUGE_VAL;
      for (std::size_t i = 0; i < surfaces_of(solid); ++i) {
        const double value = outside(solid, static_cast<int>(i), p);
        if (value > most) surface = static_cast<int>(i);
        next = std::max(next, std::min(value, most));
        most = std::max(most, value);
      }
      if (next > -0.02 * glm::length(glm::dmat3(own)[0])) continue;
      return SurfacePoint{dvec3(sized * glm::dvec4(p, 1)), normal_on(solid, surface, p)};
    }
  };
}

Geometry capsule(const dvec3& p0, const dvec3& p1, double r0, double r1) {
  CapsulesShape out;
  out.p0 = {glm::vec3(p0)};
  out.p1 = {glm::vec3(p1)};
  out.radius0 = {static_cast<float>(r0)};
  if (r1 != r0) out.radius1 = {static_cast<float>(r1)};
  return out;
}

/// Returns whether x is not within `margin` of either end of [low, high].
bool clear_of(double x, double low, double high, double margin) {
  return std::abs(x - low) > margin && std::abs(x - high) > margin;
}

double angle_of(const dvec3& p) {
  const double phi = std::atan2(p.y, p.x);
  return phi < 0 ? phi + full_turn : phi;
}

// --- The kinds: `known` for each row of shapes.def ---

#define SHAPE(row, traits)                         \
  struct row##_kind {                              \
    static constexpr int kind = shape_##row;       \
    static constexpr std::string_view name = #row; \
  };
#include "shared/shapes.def"
#undef SHAPE

template <class Type, bool is_it>
void known_if(int kind, Maker& make) {
  if constexpr (FacedSolid<Type> && is_it) {
    const Type solid;
    make.solid(kind, solid, surface_of(solid), to_unit_size(solid));
  }
}

/// Tests convex solids that the model describes by their surfaces, by their files alone.
template <class Kind>
void known(Kind, Maker& make) {
  constexpr bool is_told = false
#define GEOMETRY(Type, row) || (FacedSolid<Type> && Kind::name == #row)
#include "scene/geometries.def"
      ;
  static_assert(is_told, "rays with known answers are missing for this kind of shape");
#define GEOMETRY(Type, row) known_if<Type, Kind::name == #row>(Kind::kind, make);
#include "scene/geometries.def"
}

const dvec3 end0(-0.5, 0.25, -0.5),
    end1(0.5, -0.25, 0.375);  // with radii that are sums of powers of two: exact as floats
constexpr double phi_max = 4, z_min = -0.6, z_max = 0.7;

void known(sphere_kind, Maker& make) {
  make.solid(shape_sphere, SphereShape{0.9}, [](Random& random) {
    const dvec3 n = random.direction();
    return SurfacePoint{0.9 * n, n};
  });
}

void known(capsule_kind, Maker& make) {
  make.solid(shape_capsule, capsule(end0, end1, 0.375, 0.375),
             hull_of_balls(end0, end1, 0.375, 0.375));
}

void known(tapered_capsule_kind, Maker& make) {
  make.solid(shape_tapered_capsule, capsule(end0, end1, 0.5, 0.125),
             hull_of_balls(end0, end1, 0.5, 0.125));
}

/// Its thin end tells it from the tapered capsule, which is not linked (links_of_known).
constexpr float linked_thin_end = 0.25f;

void known(linked_capsule_kind, Maker& make) {
  make.solid(shape_linked_capsule, capsule(end0, end1, 0.5, linked_thin_end),
             hull_of_balls(end0, end1, 0.5, linked_thin_end));
}

/// When the shutter opens, where all known rays are seen, it is the tapered capsule.
void known(moving_capsule_kind, Maker& make) {
  CapsulesShape moving;
  moving.p0 = {end0, end1};
  moving.p1 = {end1, end0};
  moving.radius0 = {0.5f, 0.25f};
  moving.radius1 = {0.125f, 0.5f};
  moving.times = {0, 1};
  make.solid(shape_moving_capsule, moving, hull_of_balls(end0, end1, 0.5, 0.125));
}

constexpr glm::vec3 corners[] = {{-1, -0.75f, 0}, {1, -0.5f, 0}, {0.25f, 1, 0}};

/// Returns a point of the triangle of these corners or beside it.
SurfacePoint point_of_triangle(Random& random) {
  // Barycentric coordinates are all positive on it, and the last one is negative beside it.
  const bool on = random.uniform(0, 1) < 0.7;
  const double w = on ? random.uniform(0.05, 0.9) : random.uniform(-0.5, -0.05),
               v = random.uniform(0.05, 0.95) * (1 - w);
  const double u = 1 - w - v;
  return {u * dvec3(corners[0]) + v * dvec3(corners[1]) + w * dvec3(corners[2]), {0, 0, 1}, on};
}

void known(triangle_kind, Maker& make) {
  make.sheet(shape_triangle,
             TriangleMeshShape{{corners[0], corners[1], corners[2]}, {{0, 1, 2}}, {}, {}},
             point_of_triangle);
}

/// When the shutter opens, where all known rays are seen, it is the same triangle.
void known(moving_triangle_kind, Maker& make) {
  TriangleMeshShape moving{{corners[0], corners[1], corners[2]}, {{0, 1, 2}}, {}, {}};
  moving.positions.insert(moving.positions.end(), {corners[2], corners[0], corners[1]});
  moving.times = {0, 1};
  make.sheet(shape_moving_triangle, moving, point_of_triangle);
}

void known(disk_kind, Maker& make) {
  make.sheet(shape_disk, DiskShape{0.25, 0.9, 0, full_turn}, [](Random& random) {
    const double r = random.coin() ? random.uniform(0, 0.85) : random.uniform(0.95, 1.3),
                 phi = random.uniform(0, full_turn);
    return SurfacePoint{{r * std::cos(phi), r * std::sin(phi), 0.25}, {0, 0, 1}, r < 0.9};
  });
}

void known(cylinder_kind, Maker& make) {
  make.solid(shape_cylinder, CylinderShape{end0, end1, 0.5, {Cap::flat, Cap::flat}},
             frustum(end0, end1, 0.5, 0.5, false));
  make.solid(shape_cylinder, CylinderShape{end0, end1, 0.5, {Cap::round, Cap::flat}},
             frustum(end0, end1, 0.5, 0.5, true));
}

void known(cone_kind, Maker& make) {
  make.solid(shape_cone, ConeShape{end0, end1, {0.75, 0.25}, {Cap::flat, Cap::flat}},
             frustum(end0, end1, 0.75, 0.25, false));
}

void known(polyhedron_kind, Maker& make) {
  // This is the octahedron with corners at 1 on the axes: a face is the hull of three of them.
  PolyhedronShape octahedron;
  for (int i = 0; i < 8; ++i) {
    octahedron.points.emplace_back(i & 1 ? 1 : -1, 0, 0);
    octahedron.normals.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  make.solid(shape_polyhedron, octahedron, [](Random& random) {
    const dvec3 sign(random.coin() ? 1 : -1, random.coin() ? 1 : -1, random.coin() ? 1 : -1);
    const double u = random.uniform(0.02, 0.9), v = random.uniform(0.05, 0.95) * (1 - u);
    return SurfacePoint{sign * dvec3(u, v, 1 - u - v), sign / std::sqrt(3.0)};
  });
}

void known(partial_sphere_kind, Maker& make) {
  make.open(shape_partial_sphere, PartialSphereShape{0.9, z_min, z_max, phi_max},
            [](Random& random) {
              for (;;) {
                const dvec3 n = random.direction(), p = 0.9 * n;
                const double phi = angle_of(p);
                if (!clear_of(p.z, z_min, z_max, 0.03) || !clear_of(phi, 0, phi_max, 0.1) ||
                    phi > full_turn - 0.1)
                  continue;
                return SurfacePoint{p, n, p.z > z_min && p.z < z_max && phi < phi_max};
              }
            });
}

void known(open_cylinder_kind, Maker& make) {
  make.open(shape_open_cylinder, OpenCylinderShape{0.7, z_min, z_max, phi_max}, [](Random& random) {
    for (;;) {
      const double phi = random.uniform(0.1, full_turn - 0.1),
                   z = random.uniform(z_min - 0.3, z_max + 0.3);
      if (!clear_of(z, z_min, z_max, 0.03) || !clear_of(phi, 0, phi_max, 0.1)) continue;
      const dvec3 n(std::cos(phi), std::sin(phi), 0);
      return SurfacePoint{0.7 * n + dvec3(0, 0, z), n, z > z_min && z < z_max && phi < phi_max};
    }
  });
}

void known(partial_disk_kind, Maker& make) {
  make.sheet(shape_partial_disk, DiskShape{-0.25, 1, 0.4, phi_max}, [](Random& random) {
    for (;;) {
      const double r = random.uniform(0.1, 1.2), phi = random.uniform(0.1, full_turn - 0.1);
      if (!clear_of(r, 0.4, 1, 0.03) || !clear_of(phi, 0, phi_max, 0.1)) continue;
      return SurfacePoint{{r * std::cos(phi), r * std::sin(phi), -0.25},
                          {0, 0, 1},
                          r > 0.4 && r < 1 && phi < phi_max};
    }
  });
}

void known(bilinear_kind, Maker& make) {
  // The patch lies over the square [-1, 1]^2, with slopes of at most 0.25 along x and along y: 0.36
  // in all.
  const std::vector<glm::vec3> corners{
      {-1, -1, 0.125f}, {1, -1, -0.125f}, {-1, 1, -0.25f}, {1, 1, 0.25f}};
  make.sheet(shape_bilinear, BilinearMeshShape{corners, {{0, 1, 2, 3}}, {}, {}},
             [=](Random& random) {
               const auto at = [&](double u, double v) {
                 return lerp(lerp(dvec3(corners[0]), dvec3(corners[1]), u),
                             lerp(dvec3(corners[2]), dvec3(corners[3]), u), v);
               };
               if (random.uniform(0, 1) < 0.7)
                 return SurfacePoint{at(random.uniform(0.03, 0.97), random.uniform(0.03, 0.97)),
                                     {0, 0, 1}};
               // Above the plane z = 0 a line moves sideways by 0.9 of the height at most, which is
               // 0.25 on the patch.
               return SurfacePoint{
                   {random.uniform(1.3, 1.6) * (random.coin() ? 1 : -1), random.uniform(-1, 1), 0},
                   {0, 0, 1},
                   false};
             });
}

/// Two balls of radius 0.8 and a probe of radius 4: their surface has a neck whose normals lean by
/// 3 degrees at most, so that a line at 17 degrees to it leaves the inside once.
void known(molecular_patch_kind, Maker& make) {
  constexpr double half = 0.25, r = 0.8, probe = 4;
  const double major = std::sqrt((r + probe) * (r + probe) - half * half),
               contact = half * probe / (r + probe);
  make.solid(
      shape_molecular_patch, make_molecule({{0, 0, -0.25f}, {0, 0, 0.25f}}, {0.8f, 0.8f}, probe),
      [=](Random& random) {
        const double z = random.uniform(-half - r, half + r), phi = random.uniform(0, full_turn);
        const dvec3 out(std::cos(phi), std::sin(phi), 0), up(0, 0, 1);
        if (std::abs(z) < contact) {
          const double from_probe = std::sqrt(probe * probe - z * z);
          return SurfacePoint{(major - from_probe) * out + z * up,
                              (from_probe * out - z * up) / probe};
        }
        const double above = z - std::copysign(half, z);
        const dvec3 n = (std::sqrt(r * r - above * above) * out + above * up) / r;
        return SurfacePoint{std::copysign(half, z) * up + r * n, n};
      });
}

void known(csg_kind, Maker& make) { make.csg(); }

void known(instance_kind, Maker& make) { make.instances(); }

}  // namespace

std::uint64_t shapes_on_trial(std::uint64_t shapes) {
  std::uint64_t out = shapes & (~std::uint64_t{0} >> (64 - shape_count));
  if (out & shape_bit(shape_csg)) out |= shape_bit(shape_box) | shape_bit(shape_sphere);
  for (std::uint32_t shape = 0; shape < shape_count; ++shape)
    if ((out & shape_bit(shape)) && shape_has(shape, trait_stands_straight))
      out |= shape_bit(shape_instance);
  return out;
}

KnownScene known_scene(std::uint64_t shapes) {
  const std::uint64_t asked = shapes_on_trial(shapes);
  Maker make((asked & shape_bit(shape_instance)) != 0);
#define SHAPE(name, traits) \
  if (asked & shape_bit(shape_##name)) known(name##_kind{}, make);
#include "shared/shapes.def"
#undef SHAPE
  return make.take();
}

Linking links_of_known() {
  return {0, 1, [](const Shape& shape) {
            const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
            return capsules && capsules->radius1 == std::vector{linked_thin_end};
          }};
}

const char* shape_name(int kind) {
  static constexpr const char* names[] = {
#define SHAPE(name, traits) #name,
#include "shared/shapes.def"
#undef SHAPE
  };
  return names[kind];
}

}  // namespace caplet
