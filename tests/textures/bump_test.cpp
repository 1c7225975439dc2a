// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Normals that displacements and normal maps bend, as pictures of one pixel have them in the layer N: closed forms, and Mitsuba's
// (mitsuba/bumps.py).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

using Json = nlohmann::json;

/// origin + u a + v b, u and v from 0 to 1.
struct Parallelogram {
  glm::dvec3 origin, a, b;

  glm::dvec3 at(double u, double v) const { return origin + u * a + v * b; }
  glm::dvec3 normal() const { return glm::normalize(glm::cross(a, b)); }
  /// Of the same raised along its normal by heights that grow by hu and hv over u and v: across both a + hu n and b + hv n.
  glm::dvec3 normal_raised(double hu, double hv) const {
    return glm::normalize(glm::cross(a + hu * normal(), b + hv * normal()));
  }
};

const Parallelogram tilted{{0.5, -0.25, 1}, {2, 0.5, 0.25}, {-0.75, 1.5, 0.5}};

std::string triple(const glm::dvec3& v) { return fmt::format("{:.17g} {:.17g} {:.17g}", v.x, v.y, v.z); }

struct View {
  double u = 0.5, v = 0.5, width = 2e-4;  // of what the pixel sees, in lengths
  glm::dvec3 from = {0, 0, 0};            // beside the normal, twice of which the camera is away
  bool behind = false;
};

/// The shape with one material, seen by a pixel.
Scene scene_of(const Parallelogram& shape, const View& view, const std::string& textures = "", const std::string& material = "",
               const std::string& more = "") {
  const glm::dvec3 target = shape.at(view.u, view.v);
  const glm::dvec3 eye = target + (view.behind ? -2.0 : 2.0) * shape.normal() + view.from;
  const double fov = 2 * std::atan(0.5 * view.width / glm::length(eye - target)) * 180 / std::acos(-1.0);
  return scene_of_text(fmt::format(
      "LookAt {} {} {}\nCamera \"perspective\" \"float fov\" {:.17g}\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nIntegrator \"path\" \"integer maxdepth\" 1\nWorldBegin\n"
      "LightSource \"infinite\"\n{}\nMaterial \"diffuse\" {}\nShape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 "
      "P\" "
      "[{} {} {} {}] \"point2 uv\" [0 0 1 0 1 1 0 1] {}\n",
      triple(eye), triple(target), triple(shape.a), fov, textures, material, triple(shape.origin), triple(shape.at(1, 0)),
      triple(shape.at(1, 1)), triple(shape.at(0, 1)), more));
}

glm::dvec3 normal_of(const Scene& scene) {
  const Rendered rendered = render_model(scene, 1);
  const auto part = [&](const char* name) { return double{channel(rendered.image, name).floats.at(0)}; };
  return {part("N.X"), part("N.Y"), part("N.Z")};
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance, const std::string& what = "") {
  EXPECT_LT(glm::length(a - b), tolerance) << what << ": " << triple(a) << " is not " << triple(b);
}

// Heights are looked at half a pixel, 5e-5 of uv, further on, which floats of up to 1 hold to 3e-8: slopes of up to 3 are good for
// 2e-3. What is seen lies within 5e-5 of the middle of the pixel, where slopes are others by up to 2e-4.
constexpr double kDifferences = 2e-3;

std::string bilerp(double v00, double v01, double v10, double v11, const std::string& more = "") {
  return fmt::format(
      "Texture \"h\" \"float\" \"bilerp\" \"float v00\" {} \"float v01\" {} \"float v10\" {} \"float v11\" {} {}\n", v00, v01,
      v10, v11, more);
}
const std::string kRaised = "\"texture displacement\" \"h\"";

// Heights of uv: (1 - v) (1 - u) v00 + (1 - v) u v10 + v (1 - u) v01 + v u v11.
TEST(Bumps, OfHeightsOfUvAreThoseOfTheRaisedSurface) {
  struct Row {
    double v00, v01, v10, v11, u, v;
  };
  for (const Row& h : {Row{0, 0, 0.7, 0.7, 0.3, 0.6}, Row{0, 0.4, 0, 0.4, 0.3, 0.6}, Row{0.1, -0.3, 0.5, 0.9, 0.25, 0.125},
                       Row{0, 1, 2, -1, 0.7, 0.4}, Row{3, 0, 0, 0, 0.1, 0.9}})
    for (const double turned : {1.0, -1.0})
      for (const bool behind : {false, true}) {
        // With b on the other side of a, uv is left-handed where it was right-handed.
        Parallelogram shape = tilted;
        shape.b *= turned;
        const double hu = (1 - h.v) * (h.v10 - h.v00) + h.v * (h.v11 - h.v01);
        const double hv = (1 - h.u) * (h.v01 - h.v00) + h.u * (h.v11 - h.v10);
        View view{h.u, h.v};
        view.behind = behind;
        const glm::dvec3 expected = shape.normal_raised(hu, hv);
        const glm::dvec3 n = normal_of(scene_of(shape, view, bilerp(h.v00, h.v01, h.v10, h.v11), kRaised));
        // From behind the normal is turned to the camera.
        expect_near(n, behind ? -expected : expected, kDifferences,
                    fmt::format("{} {} {} {}, {} {}", h.v00, h.v01, h.v10, h.v11, turned, behind));
      }
}

// Heights of places: h grows by g over the lengths of space, along the surface by what of g lies in it.
TEST(Bumps, OfHeightsOfPlacesAreThoseOfTheRaisedSurface) {
  const glm::dvec3 g(0.3, -0.5, 0.4);
  // s = v1 . p and t = v2 . p, and v10 s + v01 t.
  const std::string texture =
      bilerp(0, 0.5, 2, 2.5, "\"string mapping\" \"planar\" \"vector3 v1\" [0.15 0 0.2] \"vector3 v2\" [0 -1 0]");
  for (const double turned : {1.0, -1.0}) {
    Parallelogram shape = tilted;
    shape.b *= turned;
    const glm::dvec3 n = shape.normal(), expected = glm::normalize(n - (g - n * glm::dot(n, g)));
    expect_near(normal_of(scene_of(shape, {0.3, 0.8}, texture, kRaised)), expected, kDifferences);
  }
}

ImagemapTexture image(int width, int height, int channels, std::vector<float> values) {
  auto texels = std::make_shared<TextureImage>();
  texels->width = width;
  texels->height = height;
  texels->channels = channels;
  texels->floats = std::move(values);
  texels->encoding = {ImageEncoding::Kind::linear, 1};
  ImagemapTexture out;
  out.image = texels;
  return out;
}

void set_heights(Scene& scene, ImagemapTexture heights) {
  scene.textures.push_back({std::move(heights), true, "heights", {}});
  scene.materials.at(0).displacement = static_cast<std::uint32_t>(scene.textures.size() - 1);
}

// Of 512 texels that go up and down no two have a slope in common: heights are looked at 5e-4 further on where nothing is known
// of what is seen, or half a pixel: within one texel's half here.
TEST(Bumps, ChangesAreThoseOfLittle) {
  std::vector<float> zigzag;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 512; ++x) zigzag.push_back(x % 2 == 0 ? 0 : 0.002F);
  // From the middle of texel 100 to that of 101, at a quarter of the way: 0.002 higher over 1 / 512.
  Scene scene = scene_of(tilted, {(100.5 + 0.25) / 512, 0.5});
  set_heights(scene, image(512, 2, 1, zigzag));
  // The heights are good for 1e-7 of 0.002 beside a place of 2^-24: over 1e-6 or 5e-4 of uv.
  expect_near(normal_of(scene), tilted.normal_raised(0.002 * 512, 0), 0.02);
}

// Heights of v alone, and pixels that are wider along v than u or the other way around: a step of half a pixel along v.
TEST(Bumps, StepsAreHalfOfWhatIsSeen) {
  const Parallelogram square{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}};
  // 16 texels: level but for one rise of 0.2 from the middle of texel 8 to that of 9.
  std::vector<float> rise;
  for (int y = 0; y < 16; ++y) rise.insert(rise.end(), 2, y < 8 ? 0.2F : 0);  // rows from the top
  const auto seen = [&](const glm::dvec3& from, double width) {
    Scene scene = scene_of(square, {0.5, 7.75 / 16, width, from});
    set_heights(scene, image(2, 16, 1, rise));
    return normal_of(scene);
  };
  // At 1/4 of a texel after the middle of the last low one, straight on: 0.02 of a texel further is as steep.
  expect_near(seen({}, 0.002), square.normal_raised(0, 0.2 * 16), 2e-2);
}

TEST(Bumps, OfImagesAreThoseOfMitsuba) {
  std::ifstream file(source_folder() / "tests" / "textures" / "mitsuba" / "bumps.json");
  const Json theirs = Json::parse(file);
  const auto vector = [](const Json& of) { return glm::dvec3(of.at(0), of.at(1), of.at(2)); };
  const Parallelogram shape{vector(theirs.at("origin")), vector(theirs.at("a")), vector(theirs.at("b"))};
  std::vector<float> heights, map;
  for (const Json& row : theirs.at("heights"))
    for (const Json& height : row) heights.push_back(height);
  for (const Json& row : theirs.at("map"))
    for (const Json& texel : row)
      for (const Json& value : texel) map.push_back(value);
  std::string normals = "\"normal N\" [";
  for (const Json& n : theirs.at("normals")) normals += triple(vector(n)) + " ";
  normals += "]";
  for (const Json& row : theirs.at("bumps")) {
    Scene scene = scene_of(shape, {row.at("uv").at(0), row.at("uv").at(1)});
    set_heights(scene, image(4, 4, 1, heights));
    expect_near(normal_of(scene), vector(row.at("n")), kDifferences, row.at("uv").dump());
  }
  for (const Json& row : theirs.at("normal maps")) {
    Scene scene = scene_of(shape, {row.at("uv").at(0), row.at("uv").at(1)}, "", "", normals);
    scene.textures.push_back({NormalmapTexture{image(4, 3, 3, map).image}, false, "map", {}});
    scene.materials.at(0).normalmap = static_cast<std::uint32_t>(scene.textures.size() - 1);
    expect_near(normal_of(scene), vector(row.at("n")), 2e-4, row.at("uv").dump());
  }
}

}  // namespace
}  // namespace caplet::test
