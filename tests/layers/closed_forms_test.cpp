// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// First-hit layers of rendered pictures against closed forms, at 1, 1,024 and a million samples a
// pixel.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <map>
#include <string>
#include <vector>

#include "film/deep.h"
#include "film/develop.h"
#include "film/layers.h"
#include "scene/matte_names.h"
#include "scene_text.h"

namespace caplet::test {
namespace {

using glm::dvec3;

const std::string head = "Integrator \"path\" \"integer maxdepth\" 0\nPixelFilter \"box\"\n";

class LayersAtSamples : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Counts, LayersAtSamples, testing::Values(1, 1024, 1 << 20));

/// What a pixel sees of a plane: a point, the plane's normal and the distance to it.
struct PlanePixel {
  const LayeredImage* image;
  const Film* film;
  std::size_t pixel;
  dvec3 p, n;
  double distance, slack;
  int samples;
};

void expect_point(const PlanePixel& seen, const char* layer, const dvec3& expected, double slack) {
  const dvec3 found = at3(*seen.image, layer, "XYZ", seen.pixel);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], slack);
}

/// The plane covers its pixels, and all of them is it.
void expect_matte(const PlanePixel& seen, const std::string& matte, const char* name) {
  EXPECT_EQ(std::bit_cast<std::uint32_t>(channel(*seen.image, matte + "00.R").floats[seen.pixel]),
            matte_hash(name));
  EXPECT_EQ(at(*seen.image, matte + "00.G", seen.pixel), 1);
  for (const char* rest : {"00.B", "00.A", "01.R", "02.A"})
    EXPECT_EQ(at(*seen.image, matte + rest, seen.pixel), 0) << rest;
}

/// By the options of layer_rows: a layer without an entry fails.
const std::map<std::string, std::function<void(const PlanePixel&)>> layers_of_a_plane = {
    {"Z",
     [](const PlanePixel& seen) {
       EXPECT_NEAR(at(*seen.image, "Z", seen.pixel), seen.distance, seen.slack);
     }},
    {"N", [](const PlanePixel& seen) { expect_point(seen, "N", seen.n, 0); }},
    {"P", [](const PlanePixel& seen) { expect_point(seen, "P", seen.p, seen.slack); }},
    {"object",
     [](const PlanePixel& seen) {
       EXPECT_EQ(channel(*seen.image, "object.id").uints[seen.pixel], 0u);
     }},
    {"primitive",
     [](const PlanePixel& seen) {
       EXPECT_EQ(channel(*seen.image, "primitive.id").uints[seen.pixel], 0u);
     }},
    {"variance",  // no light at all
     [](const PlanePixel& seen) {
       for (const char* name : {"variance.R", "variance.G", "variance.B"})
         EXPECT_EQ(at(*seen.image, name, seen.pixel), 0) << name;
     }},
    {"crypto_object", [](const PlanePixel& seen) { expect_matte(seen, "CryptoObject", "disk 0"); }},
    {"crypto_material",
     [](const PlanePixel& seen) { expect_matte(seen, "CryptoMaterial", "material 0"); }},
    {"crypto_asset", [](const PlanePixel& seen) { expect_matte(seen, "CryptoAsset", "scene"); }},
    {"deep",  // one sample at the plane
     [](const PlanePixel& seen) {
       const std::vector<DeepSample> samples = deep_samples(*seen.film, seen.pixel);
       ASSERT_EQ(samples.size(), 1u);
       EXPECT_EQ(samples[0].alpha, 1);
       EXPECT_NEAR(double{samples[0].depth}, seen.distance, seen.slack);
     }},
    {"albedo", [](const PlanePixel& seen) {
       if (seen.samples == 1) return;  // four wavelengths
       // Wavelengths are stratified, of a spread below 1; the million's mean is as good as the
       // floats it is made of.
       for (const char* name : {"albedo.R", "albedo.G", "albedo.B"})
         EXPECT_NEAR(at(*seen.image, name, seen.pixel), 0.6,
                     seen.samples == 1024 ? 1 / std::sqrt(1024) : 2e-5)
             << name;
     }}};

// At the origin and far from it; no coordinate is a dyadic fraction: sums that lose anything show
// it.
TEST_P(LayersAtSamples, OfAPlaneAreThoseOfThePixelsMiddle) {
  for (const double place : {0.1, 1000.1}) {
    const std::string text = std::to_string(place);
    const Rendered rendered = render_text(
        head + "LookAt " + text + " 0 0  " + text +
            " 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 90\n" +
            "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64 \"integer "
            "pixelbounds\" [40 42 10 12]\n"
            "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\nTranslate " +
            text +
            " 0 1.1\n"
            "Shape \"disk\" \"float radius\" 10\n",
        GetParam(), [](Scene& scene) { scene.view.filter = point_filter(); }, every_layer());
    // Every sample hits the same place, to the rounding of a hit.
    const double slack = 8 * 0x1p-24 * (place + 3);
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = 1.1 * (40.5 + static_cast<double>(i % 2) - 32) / 32,
                   y = 1.1 * (32 - 10.5 - static_cast<double>(i / 2)) / 32;
      const PlanePixel seen{&rendered.image, &rendered.result.film, i,     {place + x, y, 1.1},
                            {0, 0, -1},      std::hypot(x, y, 1.1), slack, GetParam()};
      EXPECT_EQ(at(rendered.image, "A", i), 1);
      for (const LayerRow& row : layer_rows) {
        const std::string name = row.option;
        if (name.empty()) continue;  // R G B A
        SCOPED_TRACE(name);
        ASSERT_TRUE(layers_of_a_plane.contains(name)) << "no closed form";
        layers_of_a_plane.at(name)(seen);
      }
    }
  }
}

// Its normal is no dyadic fraction either: (sin 40, 0, -cos 40) degrees, whichever way a disk
// turned about y faces.
TEST_P(LayersAtSamples, NormalOfATiltedPlane) {
  const Rendered rendered =
      render_text(head +
                      "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 40\nFilm "
                      "\"rgb\" \"integer xresolution\" 2 "
                      "\"integer yresolution\" 2\nWorldBegin\nTranslate 0 0 3\nRotate -40 0 1 "
                      "0\nShape \"disk\" \"float radius\" 9\n",
                  GetParam());
  const double angle = 40 * std::acos(-1) / 180;
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 n = at3(rendered.image, "N", "XYZ", i);
    EXPECT_LT(glm::length(n - dvec3(std::sin(angle), 0, -std::cos(angle))), 4 * 0x1p-24);
    EXPECT_LE(glm::length(n), 1);
  }
}

struct PixelMeans {
  double coverage = 0, depth = 0;
  dvec3 position{0}, normal{0};
};

/// Integrates over the unit sphere at (0, 0, 4) seen from the origin along +z through x0..x0+size,
/// y0..y0+size of the plane z = 1.
PixelMeans integrate_sphere(double x0, double y0, double size) {
  constexpr int steps = 1500;
  PixelMeans out;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      const dvec3 d =
          glm::normalize(dvec3(x0 + size * (i + 0.5) / steps, y0 + size * (j + 0.5) / steps, 1));
      const double along = 4 * d.z, rest = along * along - 15;
      if (rest < 0) continue;
      const double t = along - std::sqrt(rest);
      out.coverage += 1;
      out.depth += t;
      out.position += t * d;
      out.normal += t * d - dvec3(0, 0, 4);
    }
  out.depth /= out.coverage;
  out.position /= out.coverage;
  out.normal /= out.coverage;
  out.coverage /= steps * steps;
  return out;
}

TEST_P(LayersAtSamples, OfASphereAreItsIntegrals) {
  // 8 x 8 pixels, of which three lie across the sphere's edge.
  const Rendered rendered = render_text(
      head +
          "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 36.86989764584402\n"
          "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8 \"integer "
          "pixelbounds\" [5 7 1 3]\nWorldBegin\n"
          "Material \"diffuse\" \"rgb reflectance\" [0.8 0.4 0.2]\nTranslate 0 0 4\nShape "
          "\"sphere\"\n",
      GetParam());
  const double size = 2.0 / 3 / 8;
  int partial = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const dvec3 p = at3(rendered.image, "P", "XYZ", i), n = at3(rendered.image, "N", "XYZ", i);
    const double coverage = at(rendered.image, "A", i), depth = at(rendered.image, "Z", i);
    EXPECT_LE(glm::length(n), 1);
    if (GetParam() == 1) {
      if (coverage == 0) continue;
      EXPECT_EQ(coverage, 1);
      EXPECT_NEAR(glm::length(p - dvec3(0, 0, 4)), 1, 1e-6);
      EXPECT_LT(glm::length(n - (p - dvec3(0, 0, 4))), 1e-5);
      EXPECT_NEAR(depth, glm::length(p), 1e-5);
      EXPECT_LT(n.z, 0);
      continue;
    }
    const PixelMeans expected =
        integrate_sphere(-1.0 / 3 + size * (5 + static_cast<double>(i % 2)),
                         1.0 / 3 - size * (2 + static_cast<double>(i / 2)), size);
    if (expected.coverage > 0.01 && expected.coverage < 0.99) ++partial;
    // Nets of n points err by about n^-3/4 on areas with an edge; positions, normals and depths
    // differ by less than 1 within the pixel. 2e-4: the integral's own grid.
    const double slack = 2 * std::pow(GetParam(), -0.75) + 2e-4;
    EXPECT_NEAR(coverage, expected.coverage, slack);
    EXPECT_LT(glm::length(p - expected.position), slack / expected.coverage);
    EXPECT_LT(glm::length(n - expected.normal), slack / expected.coverage);
    EXPECT_NEAR(depth, expected.depth, slack / expected.coverage);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(at(rendered.image, std::string("albedo.") + "RGB"[c], i),
                  expected.coverage * (c == 0   ? 0.8
                                       : c == 1 ? 0.4
                                                : 0.2),
                  1 / std::sqrt(GetParam()));
  }
  if (GetParam() > 1) {
    EXPECT_GT(partial, 0);
  }
}

// One triangle with normals at its corners, seen from in front and from behind, as it stands,
// mirrored, and as a stretched and mirrored instance: interpolated, by the inverse transpose of the
// matrix, turned to the camera.
TEST(Layers, NormalsAreThoseOfShading) {
  const std::array<dvec3, 3> corners{dvec3(-4, -3, 0), dvec3(4, -3, 0), dvec3(0, 5, 0)};
  const std::array<dvec3, 3> normals{glm::normalize(dvec3(-0.5, -0.3, -1)),
                                     glm::normalize(dvec3(0.6, -0.2, -1)),
                                     glm::normalize(dvec3(0.1, 0.7, -1))};
  std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [";
  for (const dvec3& p : corners)
    mesh += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + " ";
  mesh += "] \"normal N\" [";
  for (const dvec3& n : normals)
    mesh += std::to_string(n.x) + " " + std::to_string(n.y) + " " + std::to_string(n.z) + " ";
  mesh += "] \"integer indices\" [0 1 2]\n";
  struct Placing {
    std::string text;
    dvec3 scale;
  };
  for (const Placing& placing :
       {Placing{mesh, {1, 1, 1}}, Placing{"Scale 1.5 -1.5 1.5\n" + mesh, {1.5, -1.5, 1.5}},
        Placing{
            "ObjectBegin \"a\"\n" + mesh + "ObjectEnd\nScale 1.5 -0.7 2\nObjectInstance \"a\"\n",
            {1.5, -0.7, 2}}})
    for (const double side : {-1.0, 1.0}) {
      const Rendered rendered = render_text(
          head + "LookAt 0 0 " + std::to_string(6 * side) +
              "  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 20\n"
              "Film \"rgb\" \"integer xresolution\" 6 \"integer yresolution\" 6\nWorldBegin\n" +
              placing.text,
          1, [](Scene& scene) { scene.view.filter = point_filter(); });
      for (std::size_t i = 0; i < 36; ++i) {
        ASSERT_EQ(at(rendered.image, "A", i), 1);
        const dvec3 p = at3(rendered.image, "P", "XYZ", i);
        // p / scale = sum of b_k corners_k, with the b_k summing up to 1.
        glm::dmat3 m;
        for (int k = 0; k < 3; ++k)
          m[k] = dvec3(corners[static_cast<std::size_t>(k)].x,
                       corners[static_cast<std::size_t>(k)].y, 1);
        const dvec3 b = glm::inverse(m) * dvec3(p.x / placing.scale.x, p.y / placing.scale.y, 1);
        dvec3 n = glm::normalize((b.x * normals[0] + b.y * normals[1] + b.z * normals[2]) /
                                 placing.scale);
        if (glm::dot(n, dvec3(0, 0, 6 * side) - p) < 0) n = -n;
        // Corners and normals are written with six digits.
        EXPECT_LT(glm::length(at3(rendered.image, "N", "XYZ", i) - n), 1e-5)
            << placing.text << side;
      }
    }
}

/// Unpolarised reflectance of a metal: the Fresnel equations as in Born and Wolf, Principles of
/// Optics, 14.2.
double fresnel(double cosine, double eta, double k) {
  const double sine2 = 1 - cosine * cosine, t = eta * eta - k * k - sine2;
  const double a2b2 = std::sqrt(t * t + 4 * eta * eta * k * k), a = std::sqrt((a2b2 + t) / 2);
  const double s =
      (a2b2 + cosine * cosine - 2 * a * cosine) / (a2b2 + cosine * cosine + 2 * a * cosine);
  const double q = cosine * cosine * a2b2 + sine2 * sine2, r = 2 * a * cosine * sine2;
  return (s + s * (q - r) / (q + r)) / 2;
}

TEST(Layers, AlbedoOfAMetalIsItsReflectance) {
  const Rendered rendered = render_text(
      head +
          "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" \"float fov\" 110\n"
          "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
          "Material \"conductor\" \"spectrum eta\" [300 0.8 900 0.8] \"spectrum k\" [300 2 900 "
          "2]\nTranslate 0 0 2\nShape \"disk\" \"float radius\" 100\n",
      4096, [](Scene& scene) { scene.view.filter = point_filter(); });
  for (std::size_t i = 0; i < 64; ++i) {
    const double expected = fresnel(2 / at(rendered.image, "Z", i), 0.8, 2);
    for (const char* name : {"albedo.R", "albedo.G", "albedo.B"})
      EXPECT_NEAR(at(rendered.image, name, i), expected, 2e-3) << name;
  }
}

// --- Camera and film, by where and how bright things are ---

/// Positions on the plane z = 2 in front of a camera at the origin.
LayeredImage plane_in_front(const std::string& camera, const std::string& film) {
  return render_text(head + "LookAt 0 0 0  0 0 1  0 1 0\nCamera \"perspective\" " + camera +
                         "\nFilm \"rgb\" " + film +
                         "\nWorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool "
                         "twosided\" true\n"
                         "Translate 0 0 2\nShape \"disk\" \"float radius\" 1000\n",
                     4, [](Scene& scene) { scene.view.filter = point_filter(); })
      .image;
}

TEST(CameraOfPbrt, FrameAspectRatioAndScreenWindow) {
  const std::string film = "\"integer xresolution\" 10 \"integer yresolution\" 10";
  const double unit = 2 * std::tan(std::acos(-1) / 6);  // of fov 60, on the plane
  const auto corner = [&](const std::string& camera) {
    return at3(plane_in_front(camera, film), "P", "XYZ", 0);
  };
  // Pixel (0, 0) has its middle a twentieth of the screen within it.
  const dvec3 plain = corner("\"float fov\" 60"),
              wide = corner("\"float fov\" 60 \"float frameaspectratio\" 2.5"),
              tall = corner("\"float fov\" 60 \"float frameaspectratio\" 0.5"),
              window = corner("\"float fov\" 60 \"float screenwindow\" [-1 3 -2 0.5]");
  EXPECT_NEAR(plain.x, -0.9 * unit, 1e-5);
  EXPECT_NEAR(plain.y, 0.9 * unit, 1e-5);
  EXPECT_NEAR(wide.x, -2.5 * 0.9 * unit, 1e-5);
  EXPECT_NEAR(wide.y, 0.9 * unit, 1e-5);
  EXPECT_NEAR(tall.x, -0.9 * unit, 1e-5);
  EXPECT_NEAR(tall.y, 2 * 0.9 * unit, 1e-5);
  EXPECT_NEAR(window.x, (-1 + 0.05 * 4) * unit, 1e-5);
  EXPECT_NEAR(window.y, (0.5 - 0.05 * 2.5) * unit, 1e-5);
}

TEST(FilmOfPbrt, ShutterAndIsoExpose) {
  const std::string film = "\"integer xresolution\" 4 \"integer yresolution\" 4";
  // pbrt-v4: imaging ratio = (shutterclose - shutteropen) * iso / 100. The mean over 16 pixels of
  // four stratified wavelengths each is within a few percent; the shutters differ by factors.
  EXPECT_NEAR(mean(channel(plane_in_front("", film), "G")), 1, 0.05);
  EXPECT_NEAR(mean(channel(plane_in_front("\"float shutteropen\" 0.75", film), "G")), 0.25, 0.0125);
  EXPECT_NEAR(mean(channel(plane_in_front("\"float shutteropen\" 0.5 \"float shutterclose\" 3",
                                          film + " \"float iso\" 400"),
                           "G")),
              10, 0.5);
  EXPECT_NEAR(mean(channel(plane_in_front("", film + " \"float fnumber\" 0.5"), "G")), 1 / 0.3,
              0.17);
  // A limit of samples is one of what is exposed: 2, of the largest of X, Y and Z.
  EXPECT_NEAR(
      mean(channel(
          plane_in_front("", film + " \"float fnumber\" 0.5 \"float maxcomponentvalue\" 2"), "G")),
      1.8, 0.2);
}

// pbrt-v4 (film.cpp, FilmBaseParameters): each edge is ceil(resolution * fraction), in 32-bit
// floats: 0.07 of 100 is 7 there, and 7.000000000000001 in double.
TEST(FilmOfPbrt, CropWindowIsRoundedUp) {
  const auto crop = [](const std::string& window) {
    const LayeredImage image = plane_in_front(
        "\"float fov\" 60", "\"integer xresolution\" 100 \"integer yresolution\" 40 " + window);
    return std::array<int, 4>{image.x, image.x + image.data_width, image.y,
                              image.y + image.data_height};
  };
  EXPECT_EQ(crop("\"float cropwindow\" [0.07 0.29 0.026 0.999]"),
            (std::array<int, 4>{7, 29, 2, 40}));
  EXPECT_EQ(crop("\"float cropwindow\" [0.101 0.1101 0.5 0.501]"),
            (std::array<int, 4>{11, 12, 20, 21}));
  EXPECT_EQ(crop("\"float cropwindow\" [0 1 0 1]"), (std::array<int, 4>{0, 100, 0, 40}));
}

}  // namespace
}  // namespace caplet::test
