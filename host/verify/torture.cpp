// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "verify/torture.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "verify/random.h"

namespace caplet::verify {

namespace {

using glm::dmat4;
using glm::dvec3;
using glm::vec3;

constexpr std::uint32_t material_count = 20;
constexpr int kind_count = 13;
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
      for (int k = 0; k < 4; ++k) object.shapes.push_back(shape(static_cast<int>(4 * i) % kind_count + k));
      out.objects.push_back(object);
      for (std::size_t k = random_.below(2); k < 3; ++k) out.instances.push_back({i, placement(0.5), {}});
    }
    out.camera.world_from_camera = glm::inverse(glm::lookAtLH(dvec3(0, -30, 10), dvec3(0, 0, 0), dvec3(0, 0, 1)));
    out.film.width = 320;
    out.film.height = 180;
    return out;
  }

 private:
  /// A random transform: moved, turned, and scaled by 10^-scales to 10^scales; every third one stretched and half of those
  /// mirrored.
  dmat4 placement(double scales) {
    const double size = random_.power(-scales, scales);
    const double away = std::min(random_.power(-1, 5), most_sizes * size);
    dmat4 m = glm::translate(dmat4(1), away * random_.direction());
    m = glm::rotate(m, random_.uniform(0, full_turn), random_.direction());
    if (random_.one_in(3))
      m = glm::scale(m, dvec3(random_.uniform(0.3, 3), random_.uniform(0.3, 3), random_.uniform(0.3, 3) * random_.sign()));
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

  Cap cap() { return random_.one_in(2) ? Cap::flat : random_.one_in(2) ? Cap::round : Cap::open; }
  /// 1, or up to a ten thousandth.
  double thin() { return random_.one_in(2) ? random_.uniform(0.1, 1) : random_.power(-4, 0); }
  vec3 point() { return vec3(random_.direction()); }

  decltype(Shape::geometry) geometry(int kind) {
    const double r = random_.uniform(0.2, 1), phi = random_.uniform(0.5, 6.2);
    switch (kind) {
      case 0:
        return SphereShape{r};
      case 1: {
        CapsulesShape out;
        for (int i = 0; i < 6; ++i) {
          out.p0.push_back(point());
          out.p1.push_back(random_.one_in(6) ? out.p0.back() : point());
          out.radius0.push_back(static_cast<float>(thin()));
          out.radius1.push_back(random_.one_in(2) ? out.radius0.back() : static_cast<float>(thin()));
        }
        return out;
      }
      case 2: {
        TriangleMeshShape out{{point(), point(), point(), point()}, {{0, 1, 2}, {1, 2, 3}}, {}, {}};
        if (random_.one_in(2)) out.positions[3] = out.positions[0] + static_cast<float>(thin()) * point();
        return out;
      }
      case 3:
        return DiskShape{random_.uniform(-1, 1), r, 0, full_turn};
      case 4:
        return DiskShape{random_.uniform(-1, 1), r, (1 - thin()) * r, phi};
      case 5:
        return CylinderShape{dvec3(point()), dvec3(0), thin(), {cap(), cap()}};
      case 6:
        return ConeShape{dvec3(point()), dvec3(0), {thin(), random_.one_in(3) ? 0 : thin()}, {cap(), cap()}};
      case 7:
        return BoxShape{-r * dvec3(1, 0.5, thin()), r * dvec3(thin(), 0.4, 0.6)};
      case 8:
        return PolyhedronShape{{dvec3(-r), dvec3(-r), dvec3(-r), dvec3(0.3 * r), dvec3(0, 0, 0.5 * r)},
                               {{-1, 0, 0}, {0, -2, 0}, {0, 0, -1}, {1, 1, 1}, {0.1, 0.2, random_.uniform(0.5, 3)}}};
      case 9: {
        const double z = random_.uniform(-0.9, 0.5);
        return PartialSphereShape{r, z * r, random_.uniform(z + 0.1, 1) * r, phi};
      }
      case 10:
        return OpenCylinderShape{thin(), -r, 0.7 * r, phi};
      case 11:
        return BilinearMeshShape{{point(), point(), point(), point(), point(), point()}, {{0, 1, 2, 3}, {2, 3, 4, 5}}, {}, {}};
      default:
        return csg(random_.one_in(2) ? 1 : 2);
    }
  }

  CsgShape csg(int depth) {
    CsgShape out;
    out.operation = static_cast<CsgShape::Operation>(random_.below(3));
    for (const int solid : {0, 7, 8, 5}) {
      auto one = std::make_shared<Shape>();
      if (solid == 7 && depth > 1)
        one->geometry = csg(depth - 1);
      else if (solid == 5)
        one->geometry = CylinderShape{dvec3(point()), dvec3(0), random_.uniform(0.1, 0.6), {Cap::flat, Cap::round}};
      else
        one->geometry = geometry(solid);
      one->world_from_object = glm::translate(dmat4(1), random_.uniform(0, 0.5) * random_.direction());
      if (random_.one_in(3)) one->world_from_object = glm::scale(one->world_from_object, dvec3(random_.uniform(0.4, 2), 1, 1));
      one->material = material();
      out.operands.push_back(one);
    }
    return out;
  }

  /// Shapes that touch, in one place.
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
      }
      add(std::move(chain));
    } else if (which == 1) {  // a wall of boxes, and balls that rest on it
      for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) add(BoxShape{dvec3(0.1 * i, 0.1 * k, 0), dvec3(0.1 * i + 0.1, 0.1 * k + 0.1, 0.1)});
      for (int i = 0; i < 3; ++i) {
        add(SphereShape{0.05});
        out.back().world_from_object = glm::translate(placed, dvec3(0.1 * i + 0.05, 0.05, 0.15));
      }
    } else {  // a wavy sheet
      TriangleMeshShape sheet;
      constexpr std::uint32_t n = 5;
      for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t k = 0; k < n; ++k)
          sheet.positions.emplace_back(0.2f * static_cast<float>(i), 0.2f * static_cast<float>(k), 0.1 * random_.unit());
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
