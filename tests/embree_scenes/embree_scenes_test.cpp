// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's XML scenes: the conventions of docs/formats/embree.md, the shared files, and bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet::embree_scenes_test {
namespace {

using glm::dvec3;
using glm::dvec4;
using test::complaint;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

/// All in one folder, so that they find each other.
std::filesystem::path write_file(const std::string& name, const std::string& text) {
  static const std::filesystem::path folder = test::temporary_folder();
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

Scene scene_of(const std::string& inside, const std::string& name = "e.xml",
               const ImportOptions& options = {}) {
  return import_scene(
      write_file(name, "<?xml version=\"1.0\"?>\n<scene>\n" + inside + "</scene>\n"),
      test::NoImages(), options);
}
std::string said(const std::string& inside) {
  return complaint([&] { scene_of(inside); });
}

CapsulesShape capsules(const std::string& inside) { return test::capsules_of(scene_of(inside)); }

const std::string kTriangle =
    "<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 "
    "2</triangles></TriangleMesh>\n";

TEST(EmbreeCurves, LinearOnesAreCapsules) {
  for (const char* element :
       {"RoundLineSegments", "LineSegments", "Curves type=\"round\" basis=\"linear\""}) {
    const std::string name(element);
    const CapsulesShape all =
        capsules("<" + name +
                 "><positions>0 0 0 1  <!-- a comment -->0 4 0 2  9 9 9 0 5 5 5 .5</positions>" +
                 "<indices>0 2</indices></" + name.substr(0, name.find(' ')) + ">");
    EXPECT_EQ(all.p0, (std::vector<glm::vec3>{{0, 0, 0}, {9, 9, 9}})) << element;
    EXPECT_EQ(all.p1, (std::vector<glm::vec3>{{0, 4, 0}, {5, 5, 5}})) << element;
    EXPECT_EQ(all.radius0, (std::vector<float>{1, 0})) << element;
    EXPECT_EQ(all.radius1, (std::vector<float>{2, 0.5F})) << element;
  }
}

using Curve = std::function<dvec4(double)>;

/// How far a point and its radius are from the chords' nearest balls at most, and chords' ends from
/// the curve's balls: the distance of centres and the difference of radii.
double apart(const Curve& curve, const CapsulesShape& chords) {
  const int steps = 2000;
  double worst = 0;
  for (int i = 0; i <= steps; ++i) {
    const dvec4 c = curve(static_cast<double>(i) / steps);
    double best = 1e30;
    for (std::size_t k = 0; k < chords.p0.size(); ++k) {
      const dvec3 a(chords.p0[k]), d = dvec3(chords.p1[k]) - a;
      const double along = std::clamp(glm::dot(dvec3(c) - a, d) / glm::dot(d, d), 0.0, 1.0);
      const double r0 = static_cast<double>(chords.radius0[k]);
      const double r =
          chords.radius1.empty() ? r0 : r0 + along * (static_cast<double>(chords.radius1[k]) - r0);
      best = std::min(best, glm::length(dvec3(c) - a - along * d) + std::abs(c.w - r));
    }
    worst = std::max(worst, best);
  }
  return worst;
}

const dvec4 P[] = {{0, 0, 0, 0.2}, {1, 2, 0, 0.1}, {2, -1, 1, 0.3}, {3, 0, 0, 0.05}};
const std::string kPoints = "<positions>0 0 0 .2 1 2 0 .1 2 -1 1 .3 3 0 0 .05</positions>";

// The bases by the formulas of Embree's manual, at parameters; the chords are within 2e-3 of the
// greatest radius of control points (0.3 of all of these bases, 0.3 of Bezier points of the others
// at most), plus rounding to floats.
TEST(EmbreeCurves, CubicOnesAreWithinTheirBound) {
  constexpr double bound = 2e-3 * 0.3 + 1e-6;
  const Curve bezier = [](double t) {
    const double s = 1 - t;
    return s * s * s * P[0] + 3 * s * s * t * P[1] + 3 * s * t * t * P[2] + t * t * t * P[3];
  };
  const Curve bspline = [](double t) {
    const double s = 1 - t;
    return (s * s * s * P[0] + (3 * t * t * t - 6 * t * t + 4) * P[1] +
            (3 * s * s * s - 6 * s * s + 4) * P[2] + t * t * t * P[3]) /
           6.0;
  };
  const Curve catmull_rom = [](double t) {
    return 0.5 * ((2.0 * P[1]) + t * (P[2] - P[0]) +
                  t * t * (2.0 * P[0] - 5.0 * P[1] + 4.0 * P[2] - P[3]) +
                  t * t * t * (-P[0] + 3.0 * P[1] - 3.0 * P[2] + P[3]));
  };
  const dvec4 tangents[] = {{1, 1, 0, 0.1}, {0, -2, 1, 0}};
  const Curve hermite = [&](double t) {
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * P[0] + (t3 - 2 * t2 + t) * tangents[0] +
           (3 * t2 - 2 * t3) * P[1] + (t3 - t2) * tangents[1];
  };
  const auto read = [](const std::string& basis, const std::string& more = "") {
    return capsules("<Curves type=\"round\" basis=\"" + basis + "\">" + kPoints +
                    "<indices>0</indices>" + more + "</Curves>");
  };
  EXPECT_LT(apart(bezier, read("bezier")), bound);
  EXPECT_LT(apart(bspline, read("bspline")), bound);
  EXPECT_LT(apart(catmull_rom, read("catmull_rom")), bound);
  EXPECT_LT(
      apart(hermite,
            capsules(
                "<Curves type=\"round\" basis=\"hermite\"><positions>0 0 0 .2 1 2 0 .1</positions>"
                "<tangents>1 1 0 .1 0 -2 1 0</tangents><indices>0</indices></Curves>")),
      bound);
  // No better than it need be: a chord fewer would not do by far.
  EXPECT_LT(read("bezier").p0.size(), 129u);
  // The older names; hair has the number of the hair beside each index.
  const auto same = [&](const std::string& text, const CapsulesShape& other) {
    const CapsulesShape all = capsules(text);
    EXPECT_EQ(all.p0, other.p0) << text;
    EXPECT_EQ(all.radius1, other.radius1) << text;
  };
  for (const std::string name : {"Hair", "BezierHair", "BezierCurves"})
    same("<" + name + ">" + kPoints + "<indices>0 7</indices></" + name + ">", read("bezier"));
  for (const std::string name : {"BSplineHair", "BSplineCurves"})
    same("<" + name + ">" + kPoints + "<indices>0</indices></" + name + ">", read("bspline"));
}

// Curves that go on where the one before ends are one strand: u runs over all of them, the same
// from curve to curve.
TEST(EmbreeCurves, UGoesOverStrands) {
  const auto of = [](const std::string& basis, const std::string& indices) {
    std::string points;
    for (int i = 0; i < 9; ++i) points += std::to_string(i) + (i % 2 ? " 0.5 0 .1 " : " 0 0 .1 ");
    return capsules("<Curves type=\"round\" basis=\"" + basis + "\"><positions>" + points +
                    "</positions><indices>" + indices + "</indices></Curves>");
  };
  const CapsulesShape lines = of("linear", "0 1 2 4");
  ASSERT_EQ(lines.u.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_FLOAT_EQ(lines.u[i].x, static_cast<float>(i) / 3);
    EXPECT_FLOAT_EQ(lines.u[i].y, static_cast<float>(i + 1) / 3);
  }
  EXPECT_EQ(lines.u[3], glm::vec2(0, 1));
  // Two strands of two and one curves, by the points at which the curves of each basis go on.
  for (const auto& [basis, indices] : {std::pair("bezier", "0 3 5"), std::pair("bspline", "0 1 5"),
                                       std::pair("catmull_rom", "0 1 5")}) {
    const CapsulesShape all = of(basis, indices);
    ASSERT_EQ(all.u.size(), all.p0.size());
    std::vector<float> begins;
    int halves = 0;
    for (std::size_t i = 0; i < all.u.size(); ++i) {
      EXPECT_LT(all.u[i].x, all.u[i].y);
      const float before = i == 0 ? 1 : all.u[i - 1].y;
      if (all.u[i].x == 0)
        begins.push_back(before);
      else
        EXPECT_EQ(all.u[i].x, before) << basis << i;
      halves += all.u[i].y == 0.5F;
    }
    EXPECT_EQ(begins, (std::vector<float>{1, 1})) << basis;
    EXPECT_EQ(all.u.back().y, 1);
    EXPECT_EQ(halves, 2)
        << basis;  // where the first strand's curves meet, and half way along the second
  }
}

TEST(EmbreeCurves, EndsOfSplinesAreWhereThePointIsNan) {
  // 2 p1 - p2 in place of p0: the curve begins at p1.
  const std::string file = "e.xml";
  std::string numbers(64, '\0');
  const float values[16] = {NAN, NAN, NAN, NAN, 1, 0, 0, 0.1F, 2, 1, 0, 0.1F, 3, 1, 0, 0.1F};
  std::memcpy(numbers.data(), values, sizeof values);
  write_file("e.bin", numbers);
  const CapsulesShape all = capsules(
      "<Curves type=\"round\" basis=\"bspline\"><positions ofs=\"0\" "
      "size=\"4\"/><indices>0</indices></Curves>");
  EXPECT_LT(glm::length(all.p0.front() - glm::vec3(1, 0, 0)), 1e-6F);
  EXPECT_THAT(said("<Curves type=\"round\" basis=\"bezier\"><positions ofs=\"0\" "
                   "size=\"4\"/><indices>0</indices></Curves>"),
              HasSubstr("number 1 is not finite"));
}

TEST(EmbreeCurves, ConesHaveCapsWhereTheyHaveNoNeighbour) {
  const Scene scene = scene_of(
      "<ConeSegments><positions>0 0 0 1 0 4 0 2 0 5 0 2</positions><indices>0 1</indices><flags>2 "
      "1</flags></ConeSegments>");
  ASSERT_EQ(scene.shapes.size(), 2u);
  const auto& cone = std::get<ConeShape>(scene.shapes[0].geometry);
  EXPECT_EQ(cone.radius, (std::array<double, 2>{1, 2}));
  EXPECT_EQ(cone.caps, (std::array<Cap, 2>{Cap::flat, Cap::open}));
  const auto& cylinder = std::get<CylinderShape>(scene.shapes[1].geometry);
  EXPECT_EQ(cylinder.p1, dvec3(0, 5, 0));
  EXPECT_EQ(cylinder.caps, (std::array<Cap, 2>{Cap::open, Cap::flat}));
}

TEST(EmbreeCurves, PointsAreBalls) {
  const std::string positions = "<positions>1 2 3 .5 4 5 6 .25</positions></Points>";
  const auto balls = capsules("<Points type=\"sphere\">" + positions);
  EXPECT_EQ(balls.p0, (std::vector<glm::vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(balls.p1, balls.p0);
  EXPECT_EQ(balls.radius0, (std::vector<float>{0.5F, 0.25F}));
  EXPECT_THAT(said("<Points type=\"cube\">" + positions),
              AllOf(HasSubstr("e.xml:3:"), HasSubstr("\"cube\" is none")));
}

TEST(EmbreeScenes, CompanionsOfNumbers) {
  std::string numbers(3, '#');  // what is not read
  const float points[8] = {0, 0, 0, 1, 0, 4, 0, 2};
  const std::uint32_t index = 0;
  numbers.append(reinterpret_cast<const char*>(points), sizeof points)
      .append(reinterpret_cast<const char*>(&index), sizeof index);
  const std::string text =
      "<RoundLineSegments><positions ofs=\"3\" size=\"2\"/><indices ofs=\"35\" "
      "size=\"1\"/></RoundLineSegments>";
  for (const char* companion : {"c.bin", "d.xml.bin"}) {
    write_file(companion, numbers);
    const Scene scene = scene_of(text, std::string(companion, 1) + ".xml");
    EXPECT_EQ(test::capsules_of(scene).radius1, (std::vector<float>{2}));
  }
  const auto refused = [&](const std::string& more) {
    return complaint([&] {
      scene_of(
          "<RoundLineSegments><positions " + more + "/><indices>0</indices></RoundLineSegments>",
          "c.xml");
    });
  };
  EXPECT_THAT(refused("ofs=\"3\" size=\"3\""), AllOf(HasSubstr("c.xml:3:"), HasSubstr("39 bytes")));
  EXPECT_THAT(refused("ofs=\"40\" size=\"0\""), HasSubstr("39 bytes"));
  EXPECT_THAT(refused("ofs=\"3\" size=\"1152921504606846977\""),
              HasSubstr("39 bytes"));  // times 16 is 16
  EXPECT_THAT(refused("ofs=\"-1\" size=\"1\""), HasSubstr("is no count"));
  EXPECT_THAT(refused("ofs=\"3\""), HasSubstr("is no count"));
  EXPECT_THAT(complaint([&] { scene_of(text, "none.xml"); }),
              AllOf(HasSubstr("none.bin"), HasSubstr("none.xml.bin")));
}

TEST(EmbreeScenes, MeshesGroupsAndTransforms) {
  const Scene scene =
      scene_of("<Transform><AffineSpace>0 -1 0 5  1 0 0 6  0 0 1 7</AffineSpace>" + kTriangle +
               "</Transform>"
               "<Transform><AffineSpace rotate_z=\"90\"/><Group><Transform><AffineSpace "
               "translate=\"1 0 0\"/>" +
               kTriangle +
               "</Transform></Group></Transform>"
               "<QuadMesh><positions>0 0 0 1 0 0 1 1 0 0 1 0</positions><indices>0 1 2 "
               "3</indices></QuadMesh>"
               "<GridMesh><positions>0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0</positions><grids>0 3 3 "
               "2</grids></GridMesh>");
  ASSERT_EQ(scene.shapes.size(), 4u);
  const auto world = [&](std::size_t i, dvec3 p) {
    return dvec3(scene.shapes[i].world_from_object * dvec4(p, 1));
  };
  EXPECT_LT(glm::length(world(0, {1, 0, 0}) - dvec3(5, 7, 7)), 1e-12);
  EXPECT_LT(glm::length(world(1, {0, 0, 0}) - dvec3(0, 1, 0)),
            1e-12);  // first along x, then turned
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.shapes[2].geometry).triangles,
            (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 3}, {2, 3, 1}}));
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.shapes[3].geometry).triangles.size(), 4u);
  const Scene about =
      scene_of("<Transform><AffineSpace angle=\"180\" axis=\"0 0 1\" point=\"1 1 0\"/>" +
               kTriangle + "</Transform>");
  EXPECT_LT(glm::length(dvec3(about.shapes[0].world_from_object[3]) - dvec3(2, 2, 0)), 1e-12);
  // A quarter turn about (3 0 0) takes the origin to (3 -3 0).
  const Scene quarter =
      scene_of("<Transform><AffineSpace angle=\"90\" axis=\"0 0 1\" point=\"3 0 0\"/>" + kTriangle +
               "</Transform>");
  EXPECT_LT(glm::length(dvec3(quarter.shapes[0].world_from_object[3]) - dvec3(3, -3, 0)), 1e-12);
}

TEST(EmbreeScenes, WhatIsNamedIsPlacedAgain) {
  const Scene scene = scene_of("<assign type=\"scene\" id=\"a\">" + kTriangle +
                               "</assign><Group id=\"b\"><ref id=\"a\"/></Group>"
                               "<MultiTransform><AffineSpaceArray><AffineSpace translate=\"1 0 "
                               "0\"/><AffineSpace translate=\"2 0 0\"/>"
                               "</AffineSpaceArray><ref id=\"b\"/></MultiTransform>");
  EXPECT_TRUE(scene.shapes.empty());
  ASSERT_EQ(scene.objects.size(), 1u);
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(dvec3(scene.instances[2].world_from_object[3]), dvec3(2, 0, 0));
}

// Columns of the turn, then the place: a quarter turn around z, then a stretch along x.
TEST(EmbreeScenes, PlacesMayBeInTheCompanion) {
  const float places[] = {0, 1, 0, -1, 0, 0, 0, 0, 1, 1, 2, 3, 5, 0, 0, 0, 1, 0, 0, 0, 1, 4, 5, 6};
  write_file("p.bin", std::string(reinterpret_cast<const char*>(places), sizeof places));
  const Scene scene = scene_of(
      "<MultiTransform><AffineSpaceArray ofs=\"0\" size=\"2\"/>" + kTriangle + "</MultiTransform>",
      "p.xml");
  ASSERT_EQ(scene.instances.size(), 2u);
  const auto image = [&](std::size_t i, const dvec3& p) {
    return dvec3(scene.instances[i].world_from_object * glm::dvec4(p, 1));
  };
  EXPECT_EQ(image(0, {1, 0, 0}), dvec3(1, 3, 3));
  EXPECT_EQ(image(0, {0, 1, 1}), dvec3(0, 2, 4));
  EXPECT_EQ(image(1, {1, 1, 1}), dvec3(9, 6, 7));
}

TEST(EmbreeScenes, MaterialsLightsAndCamera) {
  const Scene scene = scene_of(
      "<assign type=\"material\" id=\"red\"><material><code>\"OBJ\"</code><parameters><float3 "
      "name=\"Kd\">1 0 0</float3>"
      "</parameters></material></assign>"
      "<RoundLineSegments><positions>0 0 0 1 0 4 0 2</positions><indices>0</indices><material "
      "id=\"red\"/></RoundLineSegments>"
      "<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 "
      "2</triangles><material><code>Dielectric</code><parameters>"
      "<param name=\"etaInside\" type=\"float\">1.5</param></parameters></material></TriangleMesh>"
      "<PointLight><AffineSpace translate=\"1 2 3\"/><I>4 4 4</I></PointLight>"
      "<DistantLight><AffineSpace rotate_x=\"90\"/><L>1 1 "
      "1</L><halfAngle>30</halfAngle></DistantLight>"
      "<QuadLight><AffineSpace scale=\"2 2 2\"/><L>3 2 1</L></QuadLight>"
      "<PerspectiveCamera from=\"0 0 -5\" to=\"0 0 0\" up=\"0 1 0\" fov=\"60\"/>");
  EXPECT_EQ(
      std::get<RgbSpectrum>(
          std::get<DiffuseMaterial>(scene.materials.at(scene.shapes[0].material).model).reflectance)
          .rgb,
      dvec3(1, 0, 0));
  EXPECT_EQ(
      std::get<ConstantSpectrum>(
          std::get<DielectricMaterial>(scene.materials.at(scene.shapes[1].material).model).eta)
          .value,
      1.5);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].model).position, dvec3(1, 2, 3));
  // z turned by 90 degrees about x is -y; a disk of 30 degrees sends a quarter of pi.
  EXPECT_LT(glm::length(std::get<DistantLight>(scene.lights[1].model).direction - dvec3(0, -1, 0)),
            1e-12);
  EXPECT_NEAR(scene.lights[1].scale, std::acos(-1.0) / 4, 1e-12);
  ASSERT_TRUE(scene.shapes.back().emission);
  EXPECT_EQ(bounds_of(scene.shapes.back()).max, dvec3(2, 2, 0));
  EXPECT_EQ(dvec3(scene.view.camera.world_from_camera[3]), dvec3(0, 0, -5));
  EXPECT_NEAR(fov_of(scene.view.camera), std::acos(-1.0) / 3,
              1e-12);  // over the height, which is the shorter side
  EXPECT_LT(glm::length(dvec3(scene.view.camera.world_from_camera[0]) - dvec3(-1, 0, 0)),
            1e-12);  // right of what looks along z, y up
}

// By the names of Embree's tutorials, and Fresnel's reflectance of a metal at right angles.
TEST(EmbreeScenes, MaterialsByTheirCode) {
  const auto material = [](const std::string& code, const std::string& parameters) {
    const Scene scene = scene_of(
        "<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 "
        "2</triangles><material><code>\"" +
        code + "\"</code><parameters>" + parameters + "</parameters></material></TriangleMesh>");
    return scene.materials.at(scene.shapes.at(0).material).model;
  };
  const auto rgb = [](const Spectrum& spectrum) { return std::get<RgbSpectrum>(spectrum).rgb; };
  const std::string colored = "<float3 name=\"reflectance\">.9 .5 .1</float3>";
  for (const char* code : {"Matte", "Velvet"})
    EXPECT_EQ(rgb(std::get<DiffuseMaterial>(material(code, colored)).reflectance),
              dvec3(0.9, 0.5, 0.1))
        << code;
  const auto mirror = std::get<ConductorMaterial>(material("Mirror", colored));
  EXPECT_EQ(rgb(mirror.reflectance.value()), dvec3(0.9, 0.5, 0.1));
  EXPECT_EQ(mirror.alpha_u, 0);
  const auto metal = std::get<ConductorMaterial>(material(
      "Metal",
      "<float3 name=\"eta\">1.5 .5 1</float3><float3 name=\"k\">2 3 0</float3>"
      "<float3 name=\"reflectance\">1 .5 1</float3><float name=\"roughness\">.02</float>"));
  EXPECT_LT(
      glm::length(rgb(metal.reflectance.value()) - dvec3(4.25 / 10.25, 0.5 * 9.25 / 11.25, 0)),
      1e-12);
  // Half of the microfacets of a power cosine lie within cos^(n + 2) = 1/2, of Beckmann's within
  // tan^2 = alpha^2 ln 2.
  EXPECT_NEAR(1 + metal.alpha_u * metal.alpha_u * std::log(2.0), std::pow(2, 2 / (50.0 + 2)), 1e-3);
  EXPECT_EQ(metal.alpha_u, metal.alpha_v);
  for (const char* code : {"ThinDielectric", "ThinGlass"})
    EXPECT_EQ(
        std::get<ConstantSpectrum>(
            std::get<ThinDielectricMaterial>(material(code, "<float name=\"eta\">1.3</float>")).eta)
            .value,
        1.3)
        << code;
  const auto hair = std::get<HairMaterial>(material(
      "Hair", "<float3 name=\"Kr\">.2 .3 .8</float3><float3 name=\"Kt\">.1 .2 .4</float3>"));
  EXPECT_LT(glm::length(rgb(hair.reflectance.value()) - dvec3(0.3, 0.5, 1)), 1e-12);
  for (const auto& [code, color] :
       {std::pair("Plastic", "pigmentColor"), std::pair("MetallicPaint", "shadeColor")}) {
    const auto paint = std::get<PrincipledMaterial>(
        material(code, "<float3 name=\"" + std::string(color) +
                           "\">.9 .5 .1</float3><float name=\"eta\">1.6</float>" +
                           "<float name=\"roughness\">.02</float>"));
    EXPECT_EQ(rgb(paint.base_color), dvec3(0.9, 0.5, 0.1)) << code;
    EXPECT_EQ(paint.eta, 1.6) << code;
    EXPECT_NEAR(paint.roughness * paint.roughness, metal.alpha_u, 1e-12)
        << code;  // whose alpha is the roughness squared
  }
}

TEST(EmbreeScenes, WhatIsLeftOutIsToldWithItsPlace) {
  test::LogOf log;
  const Scene scene = scene_of(
      kTriangle +
      "<TriangleMesh><positions>0 0 0 1 0 0 0 1 0</positions><triangles>0 1 2</triangles>\n" +
      "<material><code>Glitter</code><parameters/></material></TriangleMesh>\n" +
      "<Curves type=\"flat\" basis=\"linear\">\n<positions>0 0 0 1 0 4 0 2</positions>" +
      "<indices>0</indices></Curves>\n");
  EXPECT_EQ(scene.shapes.size(), 3u);
  EXPECT_THAT(log.text(), AllOf(ContainsRegex("e\\.xml:5:[0-9]+: .*Glitter.* grey"),
                                ContainsRegex("e\\.xml:6:[0-9]+: .*round ones")));
}

TEST(EmbreeScenes, TheViewersOptions) {
  write_file("v.xml", "<scene>" + kTriangle + "</scene>");
  const auto options = [](const std::string& text) {
    return import_scene(write_file("v.ecs", text), test::NoImages());
  };
  const Scene scene = options(
      "# a comment\n-i v.xml\n--vp 0 0 -5 --vi 0 0 0\n-vu 0 1 0 -fov 90 --lefthanded --size 256 "
      "512 --shader uv\n-ambientlight 1 "
      "1 1\n");
  EXPECT_EQ(dvec3(scene.view.camera.world_from_camera[3]), dvec3(0, 0, -5));
  EXPECT_LT(glm::length(dvec3(scene.view.camera.world_from_camera[0]) - dvec3(1, 0, 0)), 1e-12);
  EXPECT_EQ(scene.view.film.height, 512);
  EXPECT_NEAR(std::tan(fov_of(scene.view.camera) / 2), 0.5,
              1e-12);  // 90 degrees over the height, half as wide
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_TRUE(options("-i v.xml\n").automatic_camera);
  const auto refused = [&](const std::string& text) { return complaint([&] { options(text); }); };
  EXPECT_THAT(refused("-i v.xml -vp 1 2\n"), HasSubstr("v.ecs:1:10"));
  EXPECT_THAT(refused("-i v.xml -vp 1 2 x\n"), HasSubstr("v.ecs:1:18"));
  EXPECT_THAT(refused("-vp 0 0 1\n"), HasSubstr("names no scene"));
  EXPECT_THAT(refused("-i nothing.xml\n"), AllOf(HasSubstr("v.ecs:1:4"), HasSubstr("nothing.xml")));
  EXPECT_THAT(refused("-i v.xml -vp 0 0 0 -vi 0 0 0\n"), HasSubstr("looks nowhere"));
  EXPECT_THAT(refused("-i v.ecs\n"), HasSubstr("no XML"));
}

TEST(EmbreeScenes, AreToldFromMjcf) {
  const auto format = [](const std::string& text) {
    return format_of(write_file("f.xml", text)).name;
  };
  EXPECT_EQ(format("<?xml version=\"1.0\"?>\n<!-- <mujoco> -->\n<scene>"), "embree");
  EXPECT_EQ(format("<mujoco model=\"scene\"><scene/></mujoco>"), "mjcf");
  EXPECT_EQ(format("nothing"), "mjcf");
  EXPECT_EQ(format_of("nowhere.ecs").name, "embree");
}

TEST(EmbreeScenes, OtherFiles) {
  write_file("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write_file("two.xml",
             "<scene><assign type=\"scene\" id=\"t\">" + kTriangle + "</assign></scene>");
  const Scene scene =
      scene_of("<obj src=\"one.obj\"/><xml src=\"two.xml\"/><xml src=\"two.xml\"/><ref id=\"t\"/>");
  EXPECT_EQ(scene.shapes.size(), 2u);
  EXPECT_THAT(said("<xml src=\"e.xml\"/>"),
              AllOf(HasSubstr("e.xml:3:"), HasSubstr("names itself")));
  EXPECT_THAT(said("<xml src=\"gone.xml\"/>"), AllOf(HasSubstr("e.xml:3:"), HasSubstr("gone.xml")));
}

TEST(BadEmbreeScenes, AreRefused) {
  const std::string good = "<positions>0 0 0 1 0 4 0 2</positions>";
  const auto lines = [&](const std::string& inside) {
    return said("<RoundLineSegments>" + inside + "</RoundLineSegments>");
  };
  EXPECT_THAT(lines(good + "<indices>1</indices>"),
              AllOf(HasSubstr("e.xml:3:"), HasSubstr("takes 2 points; there are 2")));
  EXPECT_THAT(lines(good + "<indices>4294967295</indices>"), HasSubstr("there are 2"));
  EXPECT_THAT(lines(good + "<indices>-1</indices>"), HasSubstr("'-1' is no index"));
  EXPECT_THAT(lines("<positions>0 0 0 1 0 4 0</positions>"),
              HasSubstr("7 numbers are no rows of 4"));
  EXPECT_THAT(lines("<positions>0 0 0 1 0 4 0 x</positions>"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(lines("<positions>0 0 0 1 0 4 0 1e30</positions>"), HasSubstr("out of range"));
  EXPECT_THAT(lines("<positions>0 0 0 1 0 4 0 -1</positions><indices>0</indices>"),
              HasSubstr("negative"));
  EXPECT_THAT(lines(good), HasSubstr("no geometry"));
  EXPECT_THAT(said("<Curves type=\"round\" basis=\"nurbs\"/>"),
              HasSubstr("basis=\"nurbs\" is none"));
  EXPECT_THAT(said("<Curves type=\"square\" basis=\"bezier\"/>"),
              HasSubstr("type=\"square\" is none"));
  EXPECT_THAT(said("<Curves type=\"round\" basis=\"hermite\">" + good +
                   "<tangents>1 0 0 0</tangents><indices>0</indices></Curves>"),
              AllOf(HasSubstr("e.xml:3:"), HasSubstr("1 tangents of 2 points")));
  EXPECT_THAT(said("<Sphere/>"), HasSubstr("<Sphere> is no element"));
  EXPECT_THAT(said("<Group id=\"g\"><ref id=\"g\"/></Group>"),
              HasSubstr("nothing of the id 'g' before it"));
  EXPECT_THAT(said("<Transform>" + kTriangle + "</Transform>"),
              HasSubstr("without an AffineSpace"));
  EXPECT_THAT(said("<Transform><AffineSpace>1 2 3</AffineSpace></Transform>"),
              HasSubstr("12 numbers, not 3"));
  EXPECT_THAT(said("<Transform><AffineSpace angle=\"1\" axis=\"0 0 0\"/></Transform>"),
              HasSubstr("no length"));
  EXPECT_THAT(
      said("<TriangleMesh><positions>0 0 0</positions><triangles>0 0 1</triangles></TriangleMesh>"),
      HasSubstr("point 1: there are 1"));
  EXPECT_THAT(said("<GridMesh><positions>0 0 0</positions><grids>0 4294967295 4294967295 "
                   "4294967295</grids></GridMesh>"),
              HasSubstr("goes on beyond the 1 points"));
  EXPECT_THAT(said("<RoundLineSegments><positions>0 0 0 1"), HasSubstr("no XML"));
  // Each level holds the one before twice: 2^40 triangles.
  std::string doubled = "<assign type=\"scene\" id=\"0\">" + kTriangle + "</assign>\n";
  for (int i = 1; i <= 40; ++i)
    doubled += "<assign type=\"scene\" id=\"" + std::to_string(i) + "\"><Group><ref id=\"" +
               std::to_string(i - 1) + "\"/><ref id=\"" + std::to_string(i - 1) +
               "\"/></Group></assign>\n";
  EXPECT_THAT(said(doubled + "<ref id=\"40\"/>"), HasSubstr("more than"));
  const auto nested = [](int groups) {
    std::string text;
    for (int i = 0; i < groups; ++i) text += "<Group>";
    text += kTriangle;
    for (int i = 0; i < groups; ++i) text += "</Group>";
    return text;
  };
  EXPECT_EQ(scene_of(nested(499)).shapes.size(), 1U);
  EXPECT_THAT(said(nested(500)), HasSubstr("lies within 500 others"));
  std::string chain = "<Group id=\"0\"/>";
  for (int i = 1; i < 6000; ++i)
    chain += "<Group id=\"" + std::to_string(i) + "\"><ref id=\"" + std::to_string(i - 1) +
             "\"/></Group>";
  EXPECT_THAT(said(chain), HasSubstr("elements lie within each other"));
}

// Counts by hand from the files: their positions and indices are a few lines each.
TEST(SharedEmbreeScenes, AreRead) {
  CAPLET_NEEDS_DATA();
  const std::filesystem::path folder = test::data_folder() / "fibres/embree_curves";
  const auto read = [&](const std::string& name) {
    return import_scene(folder / name, test::NoImages());
  };
  EXPECT_EQ(test::capsules_of(read("round_line_segments_0.xml")).radius1, (std::vector<float>{2}));
  EXPECT_EQ(test::capsules_of(read("round_line_segments_1.ecs")).p0.size(), 4u);
  for (const char* name :
       {"round_line_segments_2.ecs", "round_line_segments_3.ecs", "round_line_segments_4.ecs"})
    EXPECT_FALSE(read(name).automatic_camera) << name;
  EXPECT_EQ(std::get<ConeShape>(read("cone_line_segments_0.ecs").shapes.at(0).geometry).caps,
            (std::array<Cap, 2>{Cap::flat, Cap::flat}));
  EXPECT_EQ(std::get<ConeShape>(read("cone_line_segments_1.ecs").shapes.at(0).geometry).caps,
            (std::array<Cap, 2>{Cap::flat, Cap::open}));
}

}  // namespace
}  // namespace caplet::embree_scenes_test
