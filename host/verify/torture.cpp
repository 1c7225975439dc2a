// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "verify/torture.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>

#include "verify/random.h"

namespace caplet::verify {

namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

constexpr std::uint32_t material_count = 20;
constexpr int kind_count = 0
#define GEOMETRY(Type, name) +drawn_sorts<Type>
#include "scene/geometries.def"
    ;
// Instances scale once more: everything together stays within 1e5 sizes of the origin.
constexpr double most_sizes = 1e4;

class Maker {
 public:
  Maker(std::uint64_t seed, std::uint64_t round) : random_(seed, 1, round) {}

  Scene scene() {
    Scene out;
    for (std::uint32_t i = 0; i < material_count; ++i)
      out.materials.push_back({DiffuseMaterial{}, fmt::format("material {}", i), {}});
    for (int i = 0; i < 4 * kind_count; ++i) out.shapes.push_back(shape(i % kind_count));
    for (int i = 0; i < 3; ++i)
      for (Shape& neighbour : neighbours(i)) out.shapes.push_back(std::move(neighbour));
    for (std::uint32_t i = 0; i < 8; ++i) {
      Object object;
      object.name = fmt::format("object {}", i);
      for (int k = 0; k < 4; ++k)
        object.shapes.push_back(shape(static_cast<int>(4 * i) % kind_count + k));
      out.objects.push_back(object);
      for (std::size_t k = random_.below(2); k < 3; ++k)
        out.instances.push_back({i, placement(0.5), {}});
    }
    out.view.camera.world_from_camera =
        glm::inverse(glm::lookAtLH(dvec3(0, -30, 10), dvec3(0, 0, 0), dvec3(0, 0, 1)));
    out.view.film.width = 320;
    out.view.film.height = 180;
    return out;
  }

 private:
  /// Returns a random transform: a translation, a rotation and a scale of 10^-scales to 10^scales;
  /// one in three is stretched and half of those are mirrored.
  dmat4 placement(double scales) {
    const double size = random_.power(-scales, scales);
    const double away = std::min(random_.power(-1, 5), most_sizes * size);
    dmat4 m = glm::translate(dmat4(1), away * random_.direction());
    m = glm::rotate(m, random_.uniform(0, full_turn), random_.direction());
    if (random_.one_in(3))
      m = glm::scale(m, dvec3(random_.uniform(0.3, 3), random_.uniform(0.3, 3),
                              random_.uniform(0.3, 3) * random_.sign()));
    return glm::scale(m, dvec3(size));
  }

  std::uint32_t material() { return static_cast<std::uint32_t>(random_.below(material_count)); }

  Shape shape(int kind) {
    Shape out;
    out.geometry = geometry(kind % kind_count);
    out.world_from_object = placement(3);
    out.material = material();
    if (random_.one_in(2) && !std::holds_alternative<CsgShape>(out.geometry))
      for (std::size_t i = 0; i < surface_count(out); ++i) out.materials.push_back(material());
    out.one_sided = random_.one_in(4);
    out.reverse_orientation = random_.one_in(4);
    return out;
  }

  vec3 point() { return vec3(random_.direction()); }

  /// Draws a geometry's random numbers from those of this scene.
  class OwnDraws : public Draws {
   public:
    explicit OwnDraws(Random& random) : random_(random) {}
    double uniform(double low, double high) override { return random_.uniform(low, high); }
    double power(double low, double high) override { return random_.power(low, high); }
    std::size_t below(std::size_t n) override { return random_.below(n); }
    dvec3 direction() override { return random_.direction(); }

   private:
    Random& random_;
  };

  template <class Type>
  Geometry drawn_of(std::type_identity<Type> type, Draws& draws) {
    return drawn(type, draws);
  }
  Geometry drawn_of(std::type_identity<CsgShape>, Draws&) { return csg(random_.one_in(2) ? 1 : 2); }

  /// `kind` numbers the variants of all geometries, one geometry after the other.
  Geometry geometry(int kind) {
    OwnDraws draws(random_);
    draws.size = random_.uniform(0.2, 1);
    draws.angle = random_.uniform(0.5, 6.2);
    draws.sort = kind;
#define GEOMETRY(Type, name)                                                              \
  if (draws.sort < drawn_sorts<Type>) return drawn_of(std::type_identity<Type>{}, draws); \
  draws.sort -= drawn_sorts<Type>;
#include "scene/geometries.def"
    throw std::logic_error("no such kind of geometry");
  }

  template <class Type>
  Type drawn_one() {
    OwnDraws draws(random_);
    draws.size = random_.uniform(0.2, 1);
    draws.angle = random_.uniform(0.5, 6.2);
    return drawn(std::type_identity<Type>{}, draws);
  }

  CsgShape csg(int depth) {
    CsgShape out;
    out.operation = static_cast<CsgShape::Operation>(random_.below(3));
    const auto solid = [&](auto make) {
      auto one = std::make_shared<Shape>();
      one->geometry = make();
      one->world_from_object =
          glm::translate(dmat4(1), random_.uniform(0, 0.5) * random_.direction());
      if (random_.one_in(3))
        one->world_from_object =
            glm::scale(one->world_from_object, dvec3(random_.uniform(0.4, 2), 1, 1));
      one->material = material();
      out.operands.push_back(one);
    };
    solid([&] { return drawn_one<SphereShape>(); });
    solid([&]() -> Geometry {
      if (depth > 1) return csg(depth - 1);
      return drawn_one<BoxShape>();
    });
    solid([&] { return drawn_one<PolyhedronShape>(); });
    solid([&] {
      return CylinderShape{
          dvec3(point()), dvec3(0), random_.uniform(0.1, 0.6), {Cap::flat, Cap::round}};
    });
    return out;
  }

  /// Returns shapes that touch each other, in one place.
  std::vector<Shape> neighbours(int which) {
    std::vector<Shape> out;
    const dmat4 placed = placement(2);
    const auto add = [&](auto geometry) {
      Shape one;
      one.geometry = std::move(geometry);
      one.world_from_object = placed;
      one.material = material();
      out.push_back(std::move(one));
    };
    if (which == 0) {  // a chain
      CapsulesShape chain;
      vec3 at(0);
      for (int i = 0; i < 24; ++i) {
        chain.p0.push_back(at);
        at += 0.3f * point();
        chain.p1.push_back(at);
        chain.radius0.push_back(0.05f);
        chain.radius1.push_back(i % 3 == 0 ? 0.02f : 0.05f);
        chain.u.emplace_back(static_cast<float>(i) / 24, static_cast<float>(i + 1) / 24);
      }
      add(std::move(chain));
    } else if (which == 1) {  // a wall of boxes, and balls that rest on it
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
          add(BoxShape{dvec3(0.1 * i, 0.1 * k, 0), dvec3(0.1 * i + 0.1, 0.1 * k + 0.1, 0.1)});
      for (int i = 0; i < 3; ++i) {
        add(SphereShape{0.05});
        out.back().world_from_object = glm::translate(placed, dvec3(0.1 * i + 0.05, 0.05, 0.15));
      }
    } else {  // a wavy sheet
      TriangleMeshShape sheet;
      constexpr std::uint32_t n = 5;
      for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t k = 0; k < n; ++k)
          sheet.positions.emplace_back(0.2f * static_cast<float>(i), 0.2f * static_cast<float>(k),
                                       0.1 * random_.unit());
      for (std::uint32_t i = 0; i + 1 < n; ++i)
        for (std::uint32_t k = 0; k + 1 < n; ++k) {
          const std::uint32_t a = i * n + k;
          sheet.triangles.push_back({a, a + n, a + 1});
          sheet.triangles.push_back({a + 1, a + n, a + n + 1});
        }
      add(std::move(sheet));
    }
    return out;
  }

  Random random_;
};

}  // namespace

Scene torture_scene(std::uint64_t seed, std::uint64_t round) { return Maker(seed, round).scene(); }

}  // namespace caplet::verify
