// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// First-hit layers of rendered pictures, pixel by pixel, against the reference along the same
// camera rays.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <ostream>
#include <set>

#include "film/develop.h"
#include "import/import.h"
#include "lower/camera.h"
#include "reference/scene_reference.h"
#include "scene_text.h"

namespace caplet::test {
namespace {

using glm::dvec3;
using reference::SceneHit;

reference::Ray ray_through(const Scene& scene, int x, int y) {
  const RayRecord ray = ray_of_pixel(scene, x, y);
  return {{ray.ox, ray.oy, ray.oz}, {ray.dx, ray.dy, ray.dz}};
}

bool same_place(const std::optional<SceneHit>& a, const std::optional<SceneHit>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->index == b->index && a->surface == b->surface && a->leaving == b->leaving;
}

/// Whether rays a little beside this one hit the same: no edge is near, where rounding may decide.
bool is_clear(const reference::SceneReference& reference, const reference::Ray& ray,
              const std::optional<SceneHit>& hit) {
  for (const dvec3 step : {dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)})
    for (const double sign : {-1e-4, 1e-4})
      if (!same_place(reference.closest({ray.origin, ray.direction + sign * step}), hit))
        return false;
  return true;
}

const Shape& shape_of(const Scene& scene, const SceneHit& hit) {
  return hit.instance == reference::no_instance ? scene.shapes[hit.shape]
                                                : scene.objects[hit.object].shapes[hit.shape];
}

bool has_smooth_normals(const Shape& shape) {
  const auto* triangles = std::get_if<TriangleMeshShape>(&shape.geometry);
  const auto* patches = std::get_if<BilinearMeshShape>(&shape.geometry);
  return (triangles && !triangles->normals.empty()) || (patches && !patches->normals.empty());
}

struct Case {
  const char* file;
  int samples, width, height;
  std::size_t primitives = 1;  // different numbers in the picture, at least
  friend std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.file << " at " << c.samples;
  }
};

class LayersOfScene : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Files, LayersOfScene,
                         testing::Values(Case{"scenes/gallery.pbrt", 1, 96, 54, 4},
                                         Case{"scenes/gallery.pbrt", 1024, 24, 14, 2},
                                         Case{"scenes/instances.pbrt", 1, 96, 54},
                                         Case{"scenes/instances.pbrt", 1024, 24, 14},
                                         Case{"tests/query/solids.pbrt", 1, 96, 54},
                                         Case{"tests/render/everything.pbrt", 1, 96, 72}));

TEST_P(LayersOfScene, AreTheReferences) {
  const int width = GetParam().width, height = GetParam().height;
  Scene scene;
  const Rendered rendered =
      render_file(source_folder() / GetParam().file, GetParam().samples, [&](Scene& s) {
        s.view.film.width = width;
        s.view.film.height = height;
        s.view.filter = point_filter();
        s.view.camera.lens_radius = 0;
        s.view.integrator.max_depth = 0;
        scene = s;
      });
  const LayeredImage& image = rendered.image;
  const reference::SceneReference reference(scene);
  int compared = 0, edges = 0, normals = 0;
  std::set<std::uint32_t> objects, primitives;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>(y * width + x);
      SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
      const reference::Ray ray = ray_through(scene, x, y);
      const std::optional<SceneHit> hit = reference.closest(ray);
      if (!is_clear(reference, ray, hit)) {
        ++edges;
        continue;
      }
      ++compared;
      const std::uint32_t object = channel(image, "object.id").uints[i],
                          primitive = channel(image, "primitive.id").uints[i];
      EXPECT_EQ(at(image, "A", i), hit ? 1 : 0);
      if (!hit) {
        EXPECT_EQ(object, CAPLET_NONE);
        EXPECT_EQ(primitive, CAPLET_NONE);
        EXPECT_EQ(at(image, "Z", i), double{depth_of_nothing});
        continue;
      }
      // Shapes of the world in the order of the file, then instances (docs/output.md).
      const bool placed = hit->instance != reference::no_instance;
      EXPECT_EQ(object, placed ? scene.shapes.size() + hit->instance : hit->shape);
      EXPECT_EQ(primitive, hit->primitive);
      objects.insert(object);
      primitives.insert(primitive);
      const dvec3 expected = ray.origin + hit->t * ray.direction, point = at3(image, "P", "XYZ", i),
                  n = at3(image, "N", "XYZ", i);
      dvec3 normal = reference.normal(*hit, expected);
      if (glm::dot(normal, ray.direction) > 0) normal = -normal;
      EXPECT_LE(glm::length(n), 1);
      EXPECT_GT(glm::length(n), 1 - 1e-6);
      EXPECT_LE(glm::dot(n, ray.direction), 1e-6);
      // The kernels' bounds are below 1e-6 of the scale (docs/numerics.md): ten times that, where
      // they are seen at an angle.
      const double cosine = std::abs(glm::dot(normal, ray.direction));
      const double bound = 1e-5 * (glm::length(ray.origin) + hit->t) / std::max(cosine, 0.05);
      EXPECT_NEAR(at(image, "Z", i), hit->t, bound);
      EXPECT_LE(glm::length(point - expected), bound);
      if (has_smooth_normals(shape_of(scene, *hit))) continue;
      ++normals;
      // The reference's normals are differences over 1e-6 of a primitive's size, of values in
      // double.
      EXPECT_LT(glm::length(n - normal), 2e-3);
    }
  EXPECT_LT(edges, 0.2 * width * height);
  EXPECT_GT(normals, 0.2 * compared);
  EXPECT_GT(objects.size(), 3u);
  EXPECT_GE(primitives.size(), GetParam().primitives);
}

}  // namespace
}  // namespace caplet::test
