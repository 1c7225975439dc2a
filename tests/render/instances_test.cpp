// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Meshes in instances, mirrored, sheared and stretched, against the same meshes with every vertex
// and normal moved here.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <sstream>

#include "render_scene.h"

namespace caplet::test {
namespace {

using std::numbers::pi;

/// A placement as text and as a matrix.
struct Placement {
  std::string name, text;
  glm::dmat4 matrix;
  friend void PrintTo(const Placement& p, std::ostream* out) { *out << p.name; }
};

Placement placement(const std::string& name, const glm::dvec3& move, double degrees,
                    const glm::dvec3& axis, const glm::dvec3& scale) {
  std::ostringstream text;
  text << "Translate " << move.x << ' ' << move.y << ' ' << move.z << " Rotate " << degrees << ' '
       << axis.x << ' ' << axis.y << ' ' << axis.z << " Scale " << scale.x << ' ' << scale.y << ' '
       << scale.z << '\n';
  const glm::dmat4 m = glm::scale(
      glm::rotate(glm::translate(glm::dmat4(1), move), glm::radians(degrees), glm::normalize(axis)),
      scale);
  return {name, text.str(), m};
}

/// Vertices, normals, uvs and triangles.
struct Mesh {
  std::vector<glm::dvec3> points, normals;
  std::vector<glm::dvec2> uvs;
  std::vector<int> indices;

  std::string text() const {
    std::ostringstream out;
    out.precision(9);
    out << "Shape \"trianglemesh\" \"point3 P\" [";
    for (const glm::dvec3& p : points) out << p.x << ' ' << p.y << ' ' << p.z << "  ";
    if (!normals.empty()) out << "] \"normal N\" [";
    for (const glm::dvec3& n : normals) out << n.x << ' ' << n.y << ' ' << n.z << "  ";
    if (!uvs.empty()) out << "] \"point2 uv\" [";
    for (const glm::dvec2& uv : uvs) out << uv.x << ' ' << uv.y << "  ";
    out << "] \"integer indices\" [";
    for (const int i : indices) out << i << ' ';
    out << "]\n";
    return out.str();
  }

  /// A normal stays square to its surface, and on the side it was: the winding turns where the
  /// matrix mirrors.
  Mesh moved(const glm::dmat4& m) const {
    Mesh out = *this;
    const glm::dmat3 linear(m), of_normals = glm::transpose(glm::inverse(linear));
    for (glm::dvec3& p : out.points) p = glm::dvec3(m * glm::dvec4(p, 1));
    for (glm::dvec3& n : out.normals) n = glm::normalize(of_normals * n);
    if (glm::determinant(linear) < 0)
      for (std::size_t i = 0; i < indices.size(); i += 3)
        std::swap(out.indices[i + 1], out.indices[i + 2]);
    return out;
  }
};

std::string instance_of(const std::string& shape, const Placement& at) {
  return "ObjectBegin \"thing\"\n" + shape + "ObjectEnd\nAttributeBegin\n" + at.text +
         "ObjectInstance \"thing\"\nAttributeEnd\n";
}

const std::string grey = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n",
                  black = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";
const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [7 7 7]\n" + black;
const std::string ground =
    "Shape \"trianglemesh\" \"point3 P\" [-50 -50 0  50 -50 0  50 50 0  -50 50 0] \"integer "
    "indices\" [0 1 2  0 2 3]\n";

Scene scene_of(const std::string& view, const std::string& world, int size) {
  return scene_of_text("Integrator \"path\" \"integer maxdepth\" 4\n" + view +
                       "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" " +
                       std::to_string(size) + " \"integer yresolution\" " + std::to_string(size) +
                       "\nWorldBegin\n" + world);
}

class Placed : public testing::TestWithParam<Placement> {};

// The ground at the origin under a quad that shines down: E = L / 2 times the sum over edges of the
// angle subtended times the cosine of the edge plane's normal (Lambert 1760). The quad seen from
// behind gives nothing.
TEST_P(Placed, EmittingMeshesGiveLambertsIrradiance) {
  const Placement& at = GetParam();
  const std::string view = "LookAt 2 0 2  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" 0.2\n";
  Mesh quad{
      {{-0.5, -0.4, 0}, {0.6, -0.5, 0}, {0.4, 0.6, 0}, {-0.5, 0.5, 0}}, {}, {}, {0, 1, 2, 0, 2, 3}};
  const std::vector<glm::dvec3> corners = quad.moved(at.matrix).points;
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const glm::dvec3 a = glm::normalize(corners[i]), b = glm::normalize(corners[(i + 1) % 4]);
    sum += 0.5 * std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b)).z;
  }
  const double expected = 0.5 / pi * 7 * std::abs(sum);
  // The image of +z: does it point down, towards the origin?
  const bool down =
      glm::dot(glm::transpose(glm::inverse(glm::dmat3(at.matrix))) * glm::dvec3(0, 0, 1),
               corners[0]) < 0;
  for (const bool turned : {false, true}) {
    if (turned)
      std::swap(quad.indices[1], quad.indices[2]), std::swap(quad.indices[4], quad.indices[5]);
    for (const bool written_out : {false, true}) {
      const std::string shape =
          written_out ? lamp + quad.moved(at.matrix).text() : instance_of(lamp + quad.text(), at);
      const Mean mean = mean_of(
          render_model(
              scene_of(view, "AttributeBegin\n" + shape + "AttributeEnd\n" + grey + ground, 8),
              1024)
              .image,
          "G");
      if (down == turned) {
        EXPECT_EQ(mean.value, 0) << turned << written_out;
        continue;
      }
      // As in tests/closed_forms: over the view irradiance varies by 1e-4 of itself.
      EXPECT_NEAR(mean.value, expected, 4.5 * mean.error + 2e-4 * expected)
          << turned << written_out;
      EXPECT_LT(mean.error, 3e-3 * expected);
    }
  }
}

/// A bulging sheet of 8 x 8 vertices with normals that lean otherwise than its faces.
Mesh sheet() {
  constexpr int n = 8;
  Mesh mesh;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const double x = 2.0 * i / (n - 1) - 1, y = 2.0 * j / (n - 1) - 1;
      mesh.points.emplace_back(x, y, 0.5 * std::cos(1.5 * x) * std::cos(y));
      mesh.normals.push_back(
          glm::normalize(glm::dvec3(0.75 * std::sin(1.5 * x) + 0.3, 0.5 * std::sin(y) - 0.2, 1)));
      mesh.uvs.emplace_back(x, y);
      if (i + 1 < n && j + 1 < n)
        for (const int k : {0, 1, n + 1, 0, n + 1, n}) mesh.indices.push_back(j * n + i + k);
    }
  return mesh;
}

// Seen, lit by a lamp and by a distant light, and metal: the picture and its layers, pixel by
// pixel. Both renders take the same random numbers (uvs keep the tangents from turning with the
// winding), so that they differ where roundings turn a path; and where a stretched normal is not
// the mean of its stretched neighbours, by the square of the angle between these, 0.2, over 8.
TEST_P(Placed, MeshesWithNormalsLookAsTheyDoWrittenOut) {
  const Placement& at = GetParam();
  const Mesh mesh = sheet();
  const glm::dvec3 middle = glm::dvec3(at.matrix * glm::dvec4(0, 0, 0.3, 1));
  std::ostringstream view;
  view << "LookAt 3 -4 4  " << middle.x << ' ' << middle.y << ' ' << middle.z
       << "  0 0 1\nCamera \"perspective\" \"float fov\" 30\n";
  const std::string rest =
      "LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [1 -1 3] \"point3 to\" [0 0 "
      "0]\nAttributeBegin\n" +
      lamp + "Translate -1 -2 4 Shape \"sphere\" \"float radius\" 0.6\nAttributeEnd\n" + grey +
      ground;
  const std::string metal =
      "Material \"conductor\" \"bool remaproughness\" false \"float roughness\" 0.4\n";
  const auto picture = [&](const std::string& shape) {
    return render_model(scene_of(view.str(), metal + shape + rest, 48), 64).image;
  };
  const LayeredImage written = picture(mesh.moved(at.matrix).text());
  const LayeredImage pictures[] = {
      picture(instance_of(metal + mesh.text(), at)),
      picture("AttributeBegin\n" + at.text + mesh.text() + "AttributeEnd\n")};
  std::size_t on_it = 0;
  for (const float up : channel(written, "N.Z").floats) on_it += up < 0.999f;
  EXPECT_GT(on_it, written.channels[0].floats.size() / 10);
  for (const LayeredImage& image : pictures) {
    const Figures figures = compare(picture_of(image), picture_of(written));
    EXPECT_LT(std::abs(figures.mean), 2e-3);  // a thousandth of the paths at most is turned
    EXPECT_LT(figures.blocks, 1e-2);
    EXPECT_LT(figures.beyond_3, 3e-3);
    for (const char* name : {"N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "Z"}) {
      const std::vector<float>&a = channel(image, name).floats, &b = channel(written, name).floats;
      double worst = 0, sum = 0;
      for (std::size_t i = 0; i < a.size(); ++i) {
        const double difference = std::abs(double{a[i]} - double{b[i]});
        worst = std::max(worst, difference);
        sum += difference;
      }
      // Roundings of points and normals, 1e-6; at an edge one of 64 samples may fall on the other
      // side.
      EXPECT_LT(sum / static_cast<double>(a.size()), name[0] == 'N' ? 1e-3 : 1e-4) << name;
      EXPECT_LT(worst, 0.2) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Ways, Placed,
    testing::Values(placement("turned", {0.5, 0.3, 2}, 150, {1, 0.2, 0.1}, {1, 1, 1}),
                    placement("stretched", {-0.4, 0.2, 2}, 30, {0.3, 1, 0}, {1.5, 0.6, 0.8}),
                    placement("mirrored", {0.3, -0.2, 1.8}, 20, {1, 1, 0}, {1, 1, -1}),
                    placement("mirrored_across", {0.3, 0.2, 2}, 160, {0, 1, 0.2}, {-1, 1, 1}),
                    placement("mirrored_and_stretched", {-0.2, 0.4, 2.2}, 40, {1, 0, 0.5},
                              {0.7, -1.6, 0.9})),
    [](const testing::TestParamInfo<Placement>& row) { return row.param.name; });

}  // namespace
}  // namespace caplet::test
