// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Normals that displacements and normal maps bend, as pictures of one pixel have them in the layer
// N: closed forms, and Mitsuba's (mitsuba/bumps.py).
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
  /// Returns the normal of the same raised along its normal by heights that grow by hu and hv over
  /// u and v: across both a + hu n and b + hv n.
  glm::dvec3 normal_raised(double hu, double hv) const {
    return glm::normalize(glm::cross(a + hu * normal(), b + hv * normal()));
  }
};

const Parallelogram tilted{{0.5, -0.25, 1}, {2, 0.5, 0.25}, {-0.75, 1.5, 0.5}};

std::string triple(const glm::dvec3& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v.x, v.y, v.z);
}

struct View {
  double u = 0.5, v = 0.5, width = 4e-3;  // of what the pixel sees, in lengths
  glm::dvec3 from = {0, 0, 0};            // beside the normal, twice of which the camera is away
  bool behind = false;
  bool is_flipped = false;  // v runs down; u and v here do not
};

/// The shape with one material, seen by a pixel.
Scene scene_of(const Parallelogram& shape, const View& view, const std::string& textures = "",
               const std::string& material = "", const std::string& more = "") {
  const glm::dvec3 target = shape.at(view.u, view.v);
  const glm::dvec3 eye = target + (view.behind ? -2.0 : 2.0) * shape.normal() + view.from;
  const double fov =
      2 * std::atan(0.5 * view.width / glm::length(eye - target)) * 180 / std::acos(-1.0);
  return scene_of_text(fmt::format(
      "LookAt {} {} {}\nCamera \"perspective\" \"float fov\" {:.17g}\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nIntegrator \"path\" "
      "\"integer maxdepth\" 1\nWorldBegin\n"
      "LightSource \"infinite\"\n{}\nMaterial {}\nShape \"trianglemesh\" \"integer indices\" [0 1 "
      "2 0 2 3] \"point3 "
      "P\" "
      "[{} {} {} {}] \"point2 uv\" [{}] {}\n",
      triple(eye), triple(target), triple(shape.a), fov, textures,
      material.empty() ? "\"diffuse\"" : material, triple(shape.origin), triple(shape.at(1, 0)),
      triple(shape.at(1, 1)), triple(shape.at(0, 1)),
      view.is_flipped ? "0 1 1 1 1 0 0 0" : "0 0 1 0 1 1 0 1", more));
}

double value_of(const Rendered& of, const std::string& name) {
  return double{channel(of.image, name).floats.at(0)};
}
glm::dvec3 normal_of(const Rendered& of) {
  return {value_of(of, "N.X"), value_of(of, "N.Y"), value_of(of, "N.Z")};
}

/// A picture whose one sample lies at (view.u, view.v) to a hundredth of the pixel: the shape is
/// moved until it does, for samples lie anywhere within their pixel, and in the same place each
/// time. `make`: the scene of a view.
template <class Make>
Rendered aimed(const Parallelogram& shape, const View& view, Make make) {
  View aim = view;
  Rendered out;
  for (int round = 0; round < 2; ++round) {
    out = render_model(make(aim), 1);
    const glm::dvec3 off =
        shape.at(view.u, view.v) -
        glm::dvec3(value_of(out, "P.X"), value_of(out, "P.Y"), value_of(out, "P.Z"));
    if (round == 1) {
      EXPECT_LT(glm::length(off), 0.01 * view.width + 2e-7 * glm::length(shape.at(view.u, view.v)));
    }
    // off = du a + dv b
    const double aa = glm::dot(shape.a, shape.a), ab = glm::dot(shape.a, shape.b),
                 bb = glm::dot(shape.b, shape.b);
    const double oa = glm::dot(off, shape.a), ob = glm::dot(off, shape.b),
                 determinant = aa * bb - ab * ab;
    aim.u += (oa * bb - ob * ab) / determinant;
    aim.v += (ob * aa - oa * ab) / determinant;
  }
  return out;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance,
                 const std::string& what = "") {
  EXPECT_LT(glm::length(a - b), tolerance) << what << ": " << triple(a) << " is not " << triple(b);
}

// Heights of up to 1 are looked at some 1e-4 of uv further on: floats hold both to 3e-8, and slopes
// of up to 3 are good for 1e-3.
constexpr double kDifferences = 1e-3;

std::string bilerp(double v00, double v01, double v10, double v11, const std::string& more = "") {
  return fmt::format(
      "Texture \"h\" \"float\" \"bilerp\" \"float v00\" {} \"float v01\" {} \"float v10\" {} "
      "\"float v11\" {} {}\n",
      v00, v01, v10, v11, more);
}
const std::string kRaised = "\"diffuse\" \"texture displacement\" \"h\"";

// Heights of uv: (1 - v) (1 - u) v00 + (1 - v) u v10 + v (1 - u) v01 + v u v11.
TEST(Bumps, OfHeightsOfUvAreThoseOfTheRaisedSurface) {
  struct Row {
    double v00, v01, v10, v11, u, v;
  };
  for (const Row& h : {Row{0, 0, 0.7, 0.7, 0.3, 0.6}, Row{0, 0.4, 0, 0.4, 0.3, 0.6},
                       Row{0.1, -0.3, 0.5, 0.9, 0.25, 0.125}, Row{0, 1, 2, -1, 0.7, 0.4},
                       Row{3, 0, 0, 0, 0.1, 0.9}})
    for (const double turned : {1.0, -1.0})
      for (const bool behind : {false, true}) {
        // With b on the other side of a, uv is left-handed where it was right-handed. The second
        // faces (1, 1, 1).
        Parallelogram shape =
            h.v00 == 0 ? tilted : Parallelogram{{0, 1, 2}, {1, -1, 0}, {1, 1, -2}};
        shape.b *= turned;
        const double hu = (1 - h.v) * (h.v10 - h.v00) + h.v * (h.v11 - h.v01);
        const double hv = (1 - h.u) * (h.v01 - h.v00) + h.u * (h.v11 - h.v10);
        View view{h.u, h.v};
        view.behind = behind;
        const glm::dvec3 expected = shape.normal_raised(hu, hv);
        const glm::dvec3 n = normal_of(aimed(shape, view, [&](const View& aim) {
          return scene_of(shape, aim, bilerp(h.v00, h.v01, h.v10, h.v11), kRaised);
        }));
        // From behind the normal is turned to the camera.
        expect_near(n, behind ? -expected : expected, kDifferences,
                    fmt::format("{} {} {} {}, {} {}", h.v00, h.v01, h.v10, h.v11, turned, behind));
      }
}

// Heights of places: h grows by g over the lengths of space, along the surface by what of g lies in
// it.
TEST(Bumps, OfHeightsOfPlacesAreThoseOfTheRaisedSurface) {
  const glm::dvec3 g(0.3, -0.5, 0.4);
  // s = v1 . p and t = v2 . p, and v10 s + v01 t.
  const std::string texture =
      bilerp(0, 0.5, 2, 2.5,
             "\"string mapping\" \"planar\" \"vector3 v1\" [0.15 0 0.2] \"vector3 v2\" [0 -1 0]");
  for (const double turned : {1.0, -1.0}) {
    Parallelogram shape = tilted;
    shape.b *= turned;
    const glm::dvec3 n = shape.normal(), expected = glm::normalize(n - (g - n * glm::dot(n, g)));
    expect_near(normal_of(render_model(scene_of(shape, {0.3, 0.8}, texture, kRaised), 1)), expected,
                kDifferences);
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

// Texels that go up and down every 1 / 512: a step of a small pixel stays where the slope is that.
TEST(Bumps, ChangesAreThoseOfLittle) {
  std::vector<float> zigzag;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 512; ++x) zigzag.push_back(x % 2 == 0 ? 0 : 0.002F);
  // From the middle of texel 100 to that of 101, at a quarter of the way: 0.002 higher over 1 /
  // 512.
  Scene scene = scene_of(tilted, {(100.5 + 0.25) / 512, 0.5, 2e-4});
  set_heights(scene, image(512, 2, 1, zigzag));
  // Places of 0.2 are good for 2^-27, of steps of 1e-5.
  expect_near(normal_of(render_model(scene, 1)), tilted.normal_raised(0.002 * 512, 0), 4e-3);
}

// However near one looks, slopes are as they are: steps do not become so small that floats of
// places and heights do not tell them apart. Heights of up to 1 are good for 3e-8, over the least
// step of 2^-18 of 0.4 for 0.02 of a slope.
TEST(Bumps, CloseUpsAreSmooth) {
  const glm::dvec3 expected = tilted.normal_raised(0.6, -0.3);
  for (const double width : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7})
    for (const auto& [u, v] : {std::pair{0.7, 0.9}, {0.3, 0.4}, {0.97, 0.13}}) {
      const Rendered seen =
          render_model(scene_of(tilted, {u, v, width}, bilerp(0, -0.3, 0.6, 0.3), kRaised), 1);
      expect_near(normal_of(seen), expected, 0.02, fmt::format("{} {} {}", width, u, v));
    }
}

// Heights that begin to rise at a line, just before which one looks: of a step that goes beyond it,
// the part beyond rises. So the normal tells how long steps are: the same part of a pixel along u
// and v and for pixels of all sizes, and no more than half of one.
TEST(Bumps, StepsGoWithWhatIsSeen) {
  const Parallelogram square{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}};
  // 16 texels: 0 up to the middle of texel 7, from where on they rise by 0.2 a texel.
  const double line = 7.5 / 16, slope = 0.2 * 16;
  std::vector<float> along_v, along_u;
  for (int i = 0; i < 16; ++i) {
    along_v.insert(along_v.end(), 2,
                   i < 8 ? 0.2F * static_cast<float>(8 - i) : 0);  // rows from the top
    along_u.push_back(i > 7 ? 0.2F * static_cast<float>(i - 7) : 0);
  }
  std::vector<double> parts;  // of a pixel, that steps are
  for (const double width : {0.0025, 0.01, 0.04})
    for (const bool is_v : {true, false}) {
      // The pixel's one sample lies where it does; the shape is moved until that is 0.03 of a pixel
      // before the line.
      double middle = line, at = 0;
      LayeredImage image_seen;
      for (int round = 0; round < 2; ++round) {
        Scene scene = scene_of(square, {is_v ? 0.3 : middle, is_v ? middle : 0.3, width});
        set_heights(scene, is_v ? image(2, 16, 1, along_v) : image(16, 1, 1, along_u));
        image_seen = render_model(scene, 1).image;
        at = (double{channel(image_seen, is_v ? "P.Y" : "P.X").floats.at(0)} + 1) / 2;
        middle += line - 0.03 * width / 2 - at;
      }
      ASSERT_NEAR(line - at, 0.03 * width / 2, 1e-3 * width);
      const auto value = [&](const char* name) {
        return double{channel(image_seen, name).floats.at(0)};
      };
      const double rise = -2 * value(is_v ? "N.Y" : "N.X") / value("N.Z");
      parts.push_back((line - at) / (1 - rise / slope) / (width / 2));
    }
  for (const double part : parts) {
    EXPECT_NEAR(part, parts[0], 0.02 * parts[0]);
    EXPECT_GT(part, 0.05);
    EXPECT_LE(part, 0.5);
  }
}

// Light along the bent normal is reflected as by a plane across it, whichever way its uv runs.
TEST(Bumps, FaceTheSideThatIsSeen) {
  for (const double turned : {1.0, -1.0})
    for (const bool behind : {false, true}) {
      Parallelogram shape = tilted;
      shape.b *= turned;
      View view{0.4, 0.3};
      view.behind = behind;
      const glm::dvec3 bent = (behind ? -1.0 : 1.0) * shape.normal_raised(0.6, -0.3);
      const auto seen = [&](const std::string& material, const glm::dvec3& from) {
        Scene scene = scene_of(shape, view, bilerp(0, -0.3, 0.6, 0.3), material);
        DistantLight light;
        light.direction = -from;
        scene.lights = {{light, 1, {}, {}, {}}};
        return mean_of(render_model(scene, 4).image, "G").value;
      };
      const double straight = seen("", (behind ? -1.0 : 1.0) * shape.normal());
      EXPECT_GT(straight, 0.1);
      EXPECT_NEAR(seen(kRaised, bent) / straight, 1, 1e-3) << turned << " " << behind;
      const glm::dvec3 beside = glm::normalize(bent + 0.5 * glm::normalize(shape.a));
      EXPECT_NEAR(seen(kRaised, beside) / straight, glm::dot(beside, bent), 3e-3)
          << turned << " " << behind;
      EXPECT_EQ(seen(kRaised, -bent), 0) << turned << " " << behind;
    }
}

// Glass is outside where its geometric normal is, whichever way its uv runs: with v the other way
// around the same heights bend alike.
TEST(Bumps, OfGlassAreOutside) {
  const auto seen = [&](bool is_flipped) {
    View view{0.4, 0.3};
    view.is_flipped = is_flipped;
    const std::string heights = is_flipped ? bilerp(-0.3, 0, 0.3, 0.6) : bilerp(0, -0.3, 0.6, 0.3);
    Scene scene = scene_of(tilted, view, heights,
                           "\"dielectric\" \"float roughness\" 0.6 \"texture displacement\" \"h\"");
    DistantLight light;
    light.direction = -glm::normalize(tilted.normal() + 0.8 * glm::normalize(tilted.a));
    scene.lights = {{light, 1, {}, {}, {}}};
    return mean_of(render_model(scene, 4).image, "G").value;
  };
  EXPECT_GT(seen(false), 1e-3);
  EXPECT_NEAR(seen(true) / seen(false), 1, 1e-3);
}

TEST(Bumps, OfImagesAreThoseOfMitsuba) {
  std::ifstream file(source_folder() / "tests" / "textures" / "mitsuba" / "bumps.json");
  const Json theirs = Json::parse(file);
  const auto vector = [](const Json& of) { return glm::dvec3(of.at(0), of.at(1), of.at(2)); };
  const Parallelogram shape{vector(theirs.at("origin")), vector(theirs.at("a")),
                            vector(theirs.at("b"))};
  std::vector<float> heights, map;
  for (const Json& row : theirs.at("heights"))
    for (const Json& height : row) heights.push_back(height);
  for (const Json& row : theirs.at("map"))
    for (const Json& texel : row)
      for (const Json& value : texel) map.push_back(value);
  std::string normals = "\"normal N\" [";
  for (const Json& n : theirs.at("normals")) normals += triple(vector(n)) + " ";
  normals += "]";
  const auto add_map = [&](Material& to, Scene& scene) {
    scene.textures.push_back({NormalmapTexture{image(4, 3, 3, map).image}, false, "map", {}});
    to.normalmap = static_cast<std::uint32_t>(scene.textures.size() - 1);
    to.displacement.reset();
  };
  for (const Json& row : theirs.at("bumps")) {
    const Rendered seen =
        aimed(shape, {row.at("uv").at(0), row.at("uv").at(1), 1e-3}, [&](const View& aim) {
          Scene scene = scene_of(shape, aim);
          set_heights(scene, image(4, 4, 1, heights));
          add_map(scene.materials.emplace_back(scene.materials[0]), scene);  // of another surface
          return scene;
        });
    expect_near(normal_of(seen), vector(row.at("n")), kDifferences, row.at("uv").dump());
  }
  for (const Json& row : theirs.at("normal maps")) {
    Scene scene = scene_of(shape, {row.at("uv").at(0), row.at("uv").at(1), 1e-5}, "", "", normals);
    add_map(scene.materials[0], scene);
    expect_near(normal_of(render_model(scene, 1)), vector(row.at("n")), 2e-4, row.at("uv").dump());
  }
}

}  // namespace
}  // namespace caplet::test
