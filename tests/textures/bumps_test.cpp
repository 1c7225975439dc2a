// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Normals of displaced surfaces: of p + h n, whose derivatives are dp + dh n + h dn.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "render_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

using glm::dvec3;

// Heights in space: 0.4 + slope . p.
const dvec3 slope(0.2, -0.1, 0.3);
double height(const dvec3& p) { return 0.4 + glm::dot(slope, p); }

// Parallel rays through the middles of 24 x 24 pixels, from a side where every shape shows more
// than one of its parts.
std::string displaced(const std::string& shape,
                      const std::string& heights = "\"texture displacement\" \"h\"") {
  return "LookAt 2 3 4  0 0 0  0 1 0\nCamera \"orthographic\" \"float screenwindow\" [-1.6 1.6 "
         "-1.6 1.6]\n"
         "PixelFilter \"box\" \"float xradius\" 1e-4 \"float yradius\" 1e-4\n"
         "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\nIntegrator \"path\" "
         "\"integer maxdepth\" "
         "1\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
         "Texture \"h\" \"float\" \"bilerp\" \"float v00\" 0 \"float v10\" 1 \"float v01\" 1 "
         "\"float v11\" 2 \"string mapping\" "
         "\"planar\" \"vector3 v1\" [.2 -.1 0] \"vector3 v2\" [0 0 .3] \"float udelta\" .3 \"float "
         "vdelta\" .1\n"
         "Material \"diffuse\" " +
         heights + "\n" + shape;
}

/// Compares the layer N of every pixel with the normal that is expected at its P, where that is not
/// 0. Returns their number.
int compare(const std::string& text, const std::function<dvec3(const dvec3&)>& expected,
            double tolerance) {
  const LayeredImage image = render_model(scene_of_text(text), 1).image;
  const auto vector = [&](const char* layer, std::size_t i) {
    dvec3 out;
    for (int k = 0; k < 3; ++k)
      out[k] = static_cast<double>(channel(image, fmt::format("{}.{}", layer, "XYZ"[k])).floats[i]);
    return out;
  };
  const std::vector<float>& coverage = channel(image, "A").floats;
  int seen = 0;
  double worst = 0;
  const dvec3 toward = glm::normalize(dvec3(2, 3, 4));
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    if (coverage[i] == 0) continue;
    const dvec3 n = glm::normalize(vector("N", i));
    dvec3 wanted = expected(vector("P", i));
    if (wanted == dvec3(0)) continue;
    wanted = glm::normalize(wanted);
    if (glm::dot(wanted, toward) < 0)
      wanted = -wanted;  // the layer's normals are towards the camera
    if (std::abs(glm::dot(wanted, toward)) < 0.02) continue;
    worst = std::max(worst, glm::length(n - wanted));
    ++seen;
  }
  EXPECT_LT(worst, tolerance);
  return seen;
}

// The normal n - sum of (slope . t) / (1 + h c) t over the principal directions t, of curvature c.
dvec3 bent(const dvec3& n, const dvec3& p, const dvec3& along, double curvature_along,
           double curvature_across) {
  const dvec3 across = glm::cross(n, along);
  return n - glm::dot(slope, along) / (1 + height(p) * curvature_along) * along -
         glm::dot(slope, across) / (1 + height(p) * curvature_across) * across;
}
dvec3 some_tangent(const dvec3& n) {
  return glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
}

// Differences may be off by a thousandth of h dn/du, which here turns normals by 0.03 to 0.3: by
// 3e-4, and what N and P are rounded to.
constexpr double tolerance = 5e-4;

TEST(Displacements, OfSpheresGrowWithThem) {
  const auto ball = [](double radius) {
    return [radius](const dvec3& p) {
      const dvec3 n = p / glm::length(p);
      return bent(n, p, some_tangent(n), 1 / radius, 1 / radius);
    };
  };
  EXPECT_GT(compare(displaced("Shape \"sphere\" \"float radius\" 1.2\n"), ball(1.2), tolerance),
            150);
  // In an instance, where heights stay those of the world.
  EXPECT_GT(compare(displaced("ObjectBegin \"o\"\nShape \"sphere\" \"float radius\" "
                              "0.4\nObjectEnd\nScale 3 3 3\nObjectInstance \"o\"\n"),
                    ball(1.2), tolerance),
            150);
  // From a mirroring transform, and inside out: heights are along the other normal.
  EXPECT_GT(compare(displaced("Scale -1 1 1\nShape \"sphere\" \"float radius\" 1.2\n"), ball(1.2),
                    tolerance),
            150);
  EXPECT_GT(compare(
                displaced("ReverseOrientation\nShape \"sphere\" \"float radius\" 1.2\n"),
                [](const dvec3& p) {
                  const dvec3 n = -p / glm::length(p);
                  return bent(n, p, some_tangent(n), -1 / 1.2, -1 / 1.2);
                },
                tolerance),
            150);
}

TEST(Displacements, OfCapsulesGrowAroundThem) {
  constexpr double radius = 0.5;
  const auto capsule = [](const dvec3& p) {
    const double x = std::clamp(p.x, -0.8, 0.8);
    const dvec3 n = glm::normalize(p - dvec3(x, 0, 0));
    // Where the tube meets a cap the curvature along it jumps, and differences over 0.003 see both.
    if (std::abs(std::abs(p.x) - 0.8) < 5e-3) return dvec3(0);
    if (x != p.x) return bent(n, p, some_tangent(n), 1 / radius, 1 / radius);
    return bent(n, p, {1, 0, 0}, 0, 1 / radius);
  };
  EXPECT_GT(compare(displaced("Shape \"capsule\" \"point3 p0\" [-.8 0 0] \"point3 p1\" [.8 0 0] "
                              "\"float radius\" .5\n"),
                    capsule, tolerance),
            80);
  const auto tube = [](const dvec3& p) {
    return bent(glm::normalize(dvec3(p.x, p.y, 0)), p, {0, 0, 1}, 0, 1);
  };
  EXPECT_GT(
      compare(
          displaced("Shape \"cylinder\" \"float radius\" 1 \"float zmin\" -1 \"float zmax\" 1\n"),
          tube, tolerance),
      150);
}

// Flat ones: nothing but the slope counts.
TEST(Displacements, OfFlatSurfacesAreTheirSlopes) {
  const auto floor = [](const dvec3& p) { return bent({0, 0, 1}, p, {1, 0, 0}, 0, 0); };
  EXPECT_GT(
      compare(displaced("Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n"),
              floor, tolerance),
      80);
  EXPECT_GT(compare(displaced("Shape \"disk\" \"float radius\" 1\n"), floor, tolerance), 80);
}

// --- Meshes with normals at their vertices ---

// (x, y, z): about (0.5 x, 0.5 y, 1), as a dome has them.
constexpr const char* dome_normals = "\"normal N\" [-.5 -.5 1  .5 -.5 1  -.5 .5 1  .5 .5 1]";

/// The derivatives of the interpolated normal by x and y.
struct Interpolated {
  dvec3 n, dx, dy;
};
Interpolated dome(const dvec3& p, double bend = 0.5) {
  const dvec3 sum(bend * p.x, bend * p.y, 1);
  const double length = glm::length(sum);
  const dvec3 n = sum / length;
  const auto along = [&](const dvec3& change) {
    return (change - n * glm::dot(n, change)) / length;
  };
  return {n, along({bend, 0, 0}), along({0, bend, 0})};
}
dvec3 bent_dome(const dvec3& p, const dvec3& slope_there, double height_there, double bend = 0.5) {
  const Interpolated at = dome(p, bend);
  const auto across = [&](const dvec3& v) { return v - at.n * glm::dot(at.n, v); };
  const dvec3 x = across({1, 0, 0}), y = across({0, 1, 0});
  return glm::cross(x + glm::dot(slope_there, x) * at.n + height_there * at.dx,
                    y + glm::dot(slope_there, y) * at.n + height_there * at.dy);
}

// With these four corners the interpolation over a patch and over both of its triangles is the
// same.
TEST(Displacements, OfMeshesGrowWithTheirNormals) {
  const auto expected = [](const dvec3& p) { return bent_dome(p, slope, height(p)); };
  EXPECT_GT(compare(displaced(std::string("Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 "
                                          "2] \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0 "
                                          " 1 1 0] ") +
                              dome_normals + "\n"),
                    expected, tolerance),
            80);
  EXPECT_GT(
      compare(
          displaced(
              std::string("Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0] ") +
              dome_normals + "\n"),
          expected, tolerance),
      80);
  // By a uv that is stretched and runs the other way.
  EXPECT_GT(compare(displaced(std::string("Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 "
                                          "2] \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0 "
                                          " 1 1 0] \"point2 uv\" [3 0  3 5  0 0  0 5] ") +
                              dome_normals + "\n"),
                    expected, tolerance),
            80);
}

// Triangles hardly larger than the steps by which normals are differentiated: at most places a step
// leads over an edge. Heights of 0.6 tell slopes apart to 1e-2 over an eighth of a pixel, and h
// dn/du, which is 30, divides that. Without it normals turn by 0.3.
TEST(Displacements, OfTinyTrianglesAreThoseOfTheirNormals) {
  std::string text = displaced(
      "Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 2] \"point3 P\" [.999 -.001 0  1.001 "
      "-.001 0  .999 .001 0  1.001 "
      ".001 0] \"normal N\" [-.05 -.05 1  .05 -.05 1  -.05 .05 1  .05 .05 1]\n");
  const auto put = [&](const std::string& before, const std::string& after) {
    text.replace(text.find(before), before.size(), after);
  };
  put("LookAt 2 3 4  0 0 0", "LookAt 3 3 4  1 0 0");
  put("[-1.6 1.6 -1.6 1.6]", "[-1.6e-3 1.6e-3 -1.6e-3 1.6e-3]");
  const auto expected = [](const dvec3& p) {
    return bent_dome(p - dvec3(1, 0, 0), slope, height(p), 50);
  };
  EXPECT_GT(compare(text, expected, 3e-3), 80);
}

// The same height everywhere on a mesh leaves its interpolated normals: it does not become one of
// facets.
TEST(Displacements, OfOneHeightKeepTheNormalsOfMeshes) {
  const auto expected = [](const dvec3& p) { return dome(p).n; };
  const std::string mesh = std::string(
                               "Shape \"trianglemesh\" \"integer indices\" [0 1 3 0 3 2] \"point3 "
                               "P\" [-1 -1 0  1 -1 0  -1 1 0  1 "
                               "1 0] ") +
                           dome_normals + "\n";
  const std::string even =
      "Texture \"even\" \"float\" \"checkerboard\" \"float tex1\" 0 \"float tex2\" 0\n";
  std::string text = displaced(mesh, "\"texture displacement\" \"even\"");
  text.insert(text.find("Material"), even);
  EXPECT_GT(compare(text, expected, 1e-5), 80);
}

}  // namespace
}  // namespace caplet::test
