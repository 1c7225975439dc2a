// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Statements of pbrt-v4's own scenes that say more than the plainest ones: films of cameras,
// integrators, subdivision surfaces, transforms that flatten, colours by textures where there is
// one colour.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>

#include "import/statement.h"
#include "import_text.h"
#include "scene/media/homogeneous.h"
#include "support/data.h"
#include "support/log_of.h"

namespace caplet::test::statements_test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

constexpr const char* ball = "WorldBegin\nShape \"sphere\"\n";

std::string said_of(const std::string& text) {
  return complaint_of([&] { scene_of(text); });
}

TEST(Sensors, WhiteIsBalanced) {
  EXPECT_EQ(scene_of(ball).view.film.white_balance, 0);
  EXPECT_EQ(scene_of("Film \"rgb\" \"float whitebalance\" 5000 " + std::string(ball))
                .view.film.white_balance,
            5000);
  LogOf log;
  const Scene camera = scene_of("Film \"rgb\" \"string sensor\" \"nikon_d850\" \"float iso\" 90 " +
                                std::string(ball));
  EXPECT_EQ(camera.view.film.white_balance, 6500);
  EXPECT_EQ(camera.view.film.iso, 90);
  EXPECT_THAT(
      log.text(),
      HasSubstr("scene.pbrt:1:12: Film \"rgb\": the colours are those of the CIE 1931 observer"));
  EXPECT_EQ(
      scene_of("Film \"rgb\" \"string sensor\" \"canon_eos_5d_mkiv\" \"float whitebalance\" 4500 " +
               std::string(ball))
          .view.film.white_balance,
      4500);
}

TEST(Sensors, UnknownOnesAndWhites) {
  EXPECT_THAT(said_of("Film \"rgb\" \"string sensor\" \"nikon_d85\"\n" + std::string(ball)),
              HasSubstr("scene.pbrt:1:12: Film \"rgb\": \"sensor\" is \"nikon_d85\"; the nearest "
                        "known name is \"nikon_d850\""));
  EXPECT_THAT(
      said_of("Film \"rgb\" \"float whitebalance\" -1\n" + std::string(ball)),
      HasSubstr("scene.pbrt:1:12: Film \"rgb\": \"whitebalance\" must lie between 0 and 25000"));
  EXPECT_THAT(said_of("Film \"rgb\" \"float whitebalance\" 500\n" + std::string(ball)),
              HasSubstr("must lie between 1000"));
}

TEST(Films, OfLayersAndOfSpectraAreFilms) {
  LogOf log;
  const Scene layers = scene_of(
      "Film \"gbuffer\" \"integer xresolution\" 30 \"string coordinatesystem\" \"world\"\n" +
      std::string(ball));
  EXPECT_EQ(layers.view.film.width, 30);
  EXPECT_THAT(log.text(),
              HasSubstr("scene.pbrt:1:1: Film \"gbuffer\": the layers have names of our own"));
  const Scene spectral = scene_of(
      "Film \"spectral\" \"integer nbuckets\" 8 \"float lambdamin\" 400 \"float lambdamax\" 700 "
      "\"integer yresolution\" 20\n" +
      std::string(ball));
  EXPECT_EQ(spectral.view.film.height, 20);
  EXPECT_THAT(log.text(), HasSubstr("Film \"spectral\": red, green and blue are written"));
  EXPECT_THAT(said_of("Film \"rgb\" \"integer nbuckets\" 8\n" + std::string(ball)),
              HasSubstr("unknown parameter \"nbuckets\""));
}

// pbrt-v4's defaults.
TEST(Filters, SayWhatTheyAreUnlessAsked) {
  struct Usual {
    const char* type;
    PixelFilter::Kind kind;
    double radius;
  };
  for (const Usual& usual : {Usual{"box", PixelFilter::Kind::box, 0.5},
                             Usual{"triangle", PixelFilter::Kind::triangle, 2},
                             Usual{"gaussian", PixelFilter::Kind::gaussian, 1.5},
                             Usual{"mitchell", PixelFilter::Kind::mitchell, 2},
                             Usual{"sinc", PixelFilter::Kind::sinc, 4}}) {
    const PixelFilter filter =
        scene_of(std::string("PixelFilter \"") + usual.type + "\"\n" + ball).view.filter;
    EXPECT_EQ(filter.kind, usual.kind) << usual.type;
    EXPECT_EQ(filter.radius_x, usual.radius) << usual.type;
    EXPECT_EQ(filter.radius_y, usual.radius) << usual.type;
  }
  EXPECT_EQ(scene_of("PixelFilter \"gaussian\"\n" + std::string(ball)).view.filter.sigma, 0.5);
  const PixelFilter mitchell =
      scene_of("PixelFilter \"mitchell\"\n" + std::string(ball)).view.filter;
  EXPECT_EQ(mitchell.b, 1.0 / 3);
  EXPECT_EQ(mitchell.c, 1.0 / 3);
}

TEST(Filters, Sinc) {
  const PixelFilter plain = scene_of("PixelFilter \"sinc\"\n" + std::string(ball)).view.filter;
  EXPECT_EQ(plain.kind, PixelFilter::Kind::sinc);
  EXPECT_EQ(plain.radius_x, 4);
  EXPECT_EQ(plain.radius_y, 4);
  EXPECT_EQ(plain.tau, 3);
  EXPECT_EQ(
      scene_of("PixelFilter \"sinc\" \"float tau\" 2.5 \"float xradius\" 3\n" + std::string(ball))
          .view.filter.tau,
      2.5);
  EXPECT_THAT(said_of("PixelFilter \"sinc\" \"float tau\" 0\n" + std::string(ball)),
              HasSubstr("\"tau\" must be positive"));
}

TEST(Integrators, AllThatMakePicturesAreTaken) {
  const auto depth = [](const std::string& statement) {
    return scene_of(statement + "\n" + ball).view.integrator.max_depth;
  };
  LogOf log;
  EXPECT_EQ(depth("Integrator \"sppm\" \"integer maxdepth\" 7 \"float radius\" .02"), 7);
  EXPECT_EQ(depth("Integrator \"bdpt\" \"bool visualizestrategies\" true"), 5);
  EXPECT_EQ(depth("Integrator \"volpath\" \"float rrthreshold\" 0 \"integer maxdepth\" 256"), 256);
  EXPECT_EQ(depth("Integrator \"lightpath\" \"integer maxdepth\" 3"), 3);
  EXPECT_THAT(log.text(), HasSubstr("Integrator \"lightpath\": rendered by the path tracer, which "
                                    "converges to the same image"));
  EXPECT_EQ(depth("Integrator \"volpath\" \"bool regularize\" true"), 5);
  EXPECT_THAT(
      log.text(),
      HasSubstr("scene.pbrt:1:22: Integrator \"volpath\": nothing is made rougher than it is"));
}

TEST(Integrators, AreThoseThatAreNamed) {
  using Kind = IntegratorSettings::Kind;
  const auto of = [](const std::string& statement) {
    return scene_of(statement + "\n" + ball).view.integrator;
  };
  EXPECT_EQ(of("").kind, Kind::path);
  const IntegratorSettings usual = of("Integrator \"ambientocclusion\"");
  EXPECT_EQ(usual.kind, Kind::ambient_occlusion);
  EXPECT_TRUE(usual.cosine_sample);
  EXPECT_TRUE(std::isinf(usual.max_distance));
  const IntegratorSettings near =
      of("Integrator \"ambientocclusion\" \"bool cossample\" false \"float maxdistance\" 3");
  EXPECT_FALSE(near.cosine_sample);
  EXPECT_EQ(near.max_distance, 3);
  EXPECT_THAT(
      said_of("Integrator \"ambientocclusion\" \"float maxdistance\" 0\n" + std::string(ball)),
      HasSubstr("\"maxdistance\" must be positive"));
  const IntegratorSettings simple = of("Integrator \"simplepath\" \"integer maxdepth\" 4");
  EXPECT_EQ(simple.kind, Kind::simple_path);
  EXPECT_EQ(simple.max_depth, 4);
  EXPECT_TRUE(simple.sample_bsdf && simple.sample_lights);
  EXPECT_FALSE(of("Integrator \"simplepath\" \"bool samplebsdf\" false").sample_bsdf);
  EXPECT_FALSE(of("Integrator \"simplepath\" \"bool samplelights\" false").sample_lights);
  EXPECT_EQ(of("Integrator \"randomwalk\"").kind, Kind::random_walk);
}

TEST(Samplers, AreThoseThatAreNamed) {
  using Kind = SamplerSettings::Kind;
  const auto of = [](const std::string& statement) {
    return scene_of(statement + "\n" + ball).view.sampler;
  };
  EXPECT_EQ(of("").kind, Kind::sobol);
  EXPECT_EQ(of("").samples_per_pixel, 16);
  for (const auto& [name, kind] : {std::pair{"sobol", Kind::sobol},
                                   {"independent", Kind::independent},
                                   {"zsobol", Kind::zsobol},
                                   {"halton", Kind::sobol},
                                   {"paddedsobol", Kind::sobol},
                                   {"pmj02bn", Kind::sobol}}) {
    const SamplerSettings sampler =
        of(std::string("Sampler \"") + name + "\" \"integer pixelsamples\" 12 \"integer seed\" 5");
    EXPECT_EQ(sampler.kind, kind) << name;
    EXPECT_EQ(sampler.samples_per_pixel, 12) << name;
    EXPECT_EQ(sampler.seed, 5u) << name;
  }
  EXPECT_EQ(of("Sampler \"sobol\"").noise, 0);
  const SamplerSettings quiet = of("Sampler \"sobol\" \"float noise\" 0.02"),
                        few = of(
                            "Sampler \"sobol\" \"float noise\" 0.02 \"integer pixelsamples\" 99");
  EXPECT_EQ(quiet.noise, 0.02);
  EXPECT_EQ(quiet.samples_per_pixel, 16384);
  EXPECT_EQ(few.samples_per_pixel, 99);
  EXPECT_THAT(said_of("Sampler \"sobol\" \"float noise\" 2\n" + std::string(ball)),
              HasSubstr("scene.pbrt:1:17: Sampler \"sobol\": \"noise\" must lie between 0 and 1"));
  EXPECT_THAT(said_of("Sampler \"sobol\" \"float noise\" 1e-9\n" + std::string(ball)),
              HasSubstr("\"noise\" must be 0, or from 1e-5 to 1"));
  const SamplerSettings usual = of("Sampler \"stratified\"");
  EXPECT_EQ(usual.kind, Kind::stratified);
  EXPECT_EQ(usual.samples_per_pixel, 16);
  EXPECT_TRUE(usual.jitter);
  const SamplerSettings stratified = of(
      "Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 5 \"bool jitter\" false");
  EXPECT_EQ(stratified.x_strata, 3);
  EXPECT_EQ(stratified.y_strata, 5);
  EXPECT_EQ(stratified.samples_per_pixel, 15);
  EXPECT_FALSE(stratified.jitter);
  LogOf log;
  of("Sampler \"halton\"");
  EXPECT_THAT(
      log.text(),
      HasSubstr("Sampler \"halton\": rendered by the sampler \"sobol\", whose noise is another"));
}

// With a lens, pbrt-v4's orthographic camera is a perspective through its window at the focal
// distance.
TEST(Cameras, OrthographicWithALens) {
  const auto of = [](const std::string& more) {
    return scene_of(
        "Camera \"orthographic\" \"float screenwindow\" [-3 3 -2 2] \"float focaldistance\" 8" +
        more + "\n" + ball);
  };
  EXPECT_TRUE(is_orthographic(of("").view.camera));
  EXPECT_TRUE(
      is_orthographic(of(" \"float lensradius\" 0.1 \"bool parallellens\" true").view.camera));
  LogOf log;
  const Scene scene = of(" \"float lensradius\" 0.1");
  EXPECT_THAT(log.text(), HasSubstr("makes a perspective of it, as in pbrt-v4"));
  const std::array<double, 4> plane = image_plane_of(scene.view.camera, scene.view.film);
  EXPECT_NEAR(8 * plane[0], -3, 1e-12);
  EXPECT_NEAR(8 * plane[3], 2, 1e-12);
}

TEST(Cameras, Fisheye) {
  const auto of = [](const std::string& more) {
    return std::get<FisheyeProjection>(
        scene_of("Camera \"fisheye\"" + more + "\n" + ball).view.camera.projection);
  };
  EXPECT_EQ(of("").mapping_kind, FisheyeProjection::equidistant);
  EXPECT_EQ(of("").fov, 180);
  EXPECT_EQ(of(" \"string mapping\" \"equisolid\" \"float fov\" 220").mapping_kind,
            FisheyeProjection::equisolid);
  EXPECT_EQ(of(" \"string mapping\" \"equisolid\" \"float fov\" 220").fov, 220);
  EXPECT_THAT(said_of("Camera \"fisheye\" \"float fov\" 361\n" + std::string(ball)),
              HasSubstr("\"fov\" must be above 0 and at most 360"));
}

TEST(Cameras, Opencv) {
  const auto of = [](const std::string& more) {
    return std::get<OpencvProjection>(
        scene_of("Camera \"opencv\"" + more + "\n" + ball).view.camera.projection);
  };
  EXPECT_EQ(of("").fx, 0);
  EXPECT_EQ(of("").cx, -1);
  const OpencvProjection given =
      of(" \"float fx\" 600 \"float fy\" 610 \"float cx\" 320.5 \"float cy\" 241 \"float k1\" -0.2 "
         "\"float "
         "k6\" 0.1 \"float p2\" 0.003 \"float width\" 640 \"float height\" 480");
  EXPECT_EQ(given.fx, 600);
  EXPECT_EQ(given.fy, 610);
  EXPECT_EQ(given.cx, 320.5);
  EXPECT_EQ(given.cy, 241);
  EXPECT_EQ(given.width, 640);
  EXPECT_EQ(given.height, 480);
  EXPECT_EQ(given.distortion(), (std::array<double, 8>{-0.2, 0, 0, 0, 0, 0.1, 0, 0.003}));
  EXPECT_THAT(said_of("Camera \"opencv\" \"float fx\" -1\n" + std::string(ball)),
              HasSubstr("\"fx\" must"));
}

TEST(Cameras, Spherical) {
  const auto of = [](const std::string& more) {
    return std::get<SphericalProjection>(
               scene_of("Camera \"spherical\"" + more + "\n" + ball).view.camera.projection)
        .mapping_kind;
  };
  EXPECT_EQ(of(""), SphericalProjection::equal_area);
  EXPECT_EQ(of(" \"string mapping\" \"equalarea\" \"float lensradius\" 1"),
            SphericalProjection::equal_area);
  EXPECT_EQ(of(" \"string mapping\" \"equirectangular\""), SphericalProjection::equirectangular);
  EXPECT_THAT(said_of("Camera \"spherical\" \"string mapping\" \"mercator\"\n" + std::string(ball)),
              HasSubstr("\"mapping\" is \"mercator\"; the nearest known name is \"equalarea\""));
  EXPECT_THAT(said_of("Camera \"spherical\" \"float fov\" 40\n" + std::string(ball)),
              HasSubstr("unknown parameter \"fov\""));
}

// Edges of a crop are rounded up: 0.05, 0.55, 0.25 and 0.75 of 10 pixels.
TEST(Films, CropsAreRoundedUp) {
  const Scene scene = scene_of(
      "Film \"rgb\" \"integer xresolution\" 10 \"integer yresolution\" 10 \"float cropwindow\" "
      "[.05 .55 .25 .75]\n" +
      std::string(ball));
  EXPECT_THAT(scene.view.film.crop.value(), ElementsAre(1, 6, 3, 8));
}

TEST(Cameras, LensesHaveARadius) {
  EXPECT_THAT(
      said_of("Camera \"perspective\" \"float lensradius\" -.5\n" + std::string(ball)),
      HasSubstr(
          "scene.pbrt:1:22: Camera \"perspective\": \"lensradius\" must be finite and from 0 up"));
}

TEST(Cameras, HalfTheFieldOfView) {
  EXPECT_NEAR(fov_of(scene_of("Camera \"perspective\" \"float halffov\" 20 \"float fov\" 10\n" +
                              std::string(ball))
                         .view.camera),
              40 * 3.14159265358979 / 180, 1e-12);
  EXPECT_THAT(said_of("Camera \"perspective\" \"float halffov\" 90\n" + std::string(ball)),
              HasSubstr("scene.pbrt:1:22: Camera \"perspective\": \"halffov\" must be below 90"));
}

// As in pbrt-v4, a transform that flattens is wrong where something stands in it.
TEST(Transforms, MayFlattenWhereNothingStands) {
  const std::string flat = "ConcatTransform [0 0 0 0  0 1 0 0  0 0 -1 0  5 6 7 1]\n";
  EXPECT_THAT(complaints("WorldBegin\nShape \"sphere\"\nAttributeBegin\n" + flat +
                         "Translate 1 0 0\nAttributeEnd\nShape \"sphere\""),
              IsEmpty());
  EXPECT_THAT(complaints("WorldBegin\n" + flat + "Identity\nShape \"sphere\""), IsEmpty());
  EXPECT_THAT(complaints("WorldBegin\n" + flat + "CoordSysTransform \"world\"\nShape \"sphere\""),
              IsEmpty());
  const auto error = HasSubstr("scene.pbrt:2:1: ConcatTransform has no inverse");
  EXPECT_THAT(
      complaints("WorldBegin\n" + flat + "Translate 1 0 0\nShape \"sphere\"\nShape \"sphere\""),
      ElementsAre(error));
  EXPECT_THAT(
      complaints("WorldBegin\n" + flat + "LightSource \"point\"\nIdentity\nShape \"sphere\""),
      ElementsAre(error));
  EXPECT_THAT(
      complaints("WorldBegin\n" + flat + "CoordinateSystem \"a\"\nIdentity\nShape \"sphere\""),
      ElementsAre(error));
  EXPECT_THAT(
      complaints("WorldBegin\n" + flat +
                 "ObjectInstance \"o\"\nIdentity\nObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd"),
      ElementsAre(error));
  EXPECT_THAT(complaints("Scale 1 0 1\nCamera \"perspective\"\n" + std::string(ball)),
              ElementsAre(HasSubstr("scene.pbrt:1:1: Scale has no inverse")));
}

const TriangleMeshShape& mesh_of(const Scene& scene) {
  return std::get<TriangleMeshShape>(scene.shapes.at(0).geometry);
}

Scene loop_of(const std::string& parameters) {
  return world_of("Shape \"loopsubdiv\" " + parameters);
}

constexpr const char* octahedron =
    "\"point3 P\" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1] \"integer indices\" "
    "[0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5] ";

// By hand: beta(4) = 3/32, so the limit's weight of a neighbour is 1 / (4 + 4) = 1/8: the four
// neighbours of a corner v add to 0, and its limit is v / 2, whatever was refined before. An edge's
// middle comes to (3 + 3) / 8 of half the sum of its ends, as the opposite corners add to 0;
// beta(6) = 1/16 and a weight of 1/12.
TEST(LoopSubdivision, LimitOfAnOctahedron) {
  for (const int levels : {0, 1, 2, 4}) {
    const Scene scene = loop_of(octahedron + ("\"integer levels\" " + std::to_string(levels)));
    const TriangleMeshShape& mesh = mesh_of(scene);
    EXPECT_EQ(mesh.triangles.size(), std::size_t{8} << (2 * levels));
    EXPECT_EQ(mesh.positions.size(), (std::size_t{4} << (2 * levels)) + 2);  // Euler
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (std::size_t i = 0; i < 6; ++i) {
      const float sign = i % 2 ? -1.0f : 1.0f;
      glm::vec3 axis(0);
      axis[static_cast<int>(i / 2)] = sign;
      EXPECT_LT(glm::length(mesh.positions[i] - 0.5f * axis), 1e-6f) << levels << ' ' << i;
      EXPECT_LT(glm::length(mesh.normals[i] + axis), 1e-5f)
          << levels << ' ' << i;  // pbrt-v4's are on the other side
    }
    for (const auto& face : mesh.triangles) {
      const glm::vec3 a = mesh.positions[face[0]], b = mesh.positions[face[1]],
                      c = mesh.positions[face[2]];
      EXPECT_LT(glm::dot(glm::cross(b - a, c - a), a + b + c), 0);  // as the normals
    }
  }
  EXPECT_EQ(mesh_of(loop_of(octahedron)).triangles.size(),
            8u << 6);  // 3 levels where nothing is said
}

// By hand: beta(3) = 3/16, and the limit's weight of a neighbour 1 / (3 + 2) = 1/5. Of a regular
// tetrahedron around 0 the three neighbours of a corner v add to -v: its limit is (2/5 - 1/5) v,
// whatever was refined before.
TEST(LoopSubdivision, LimitOfATetrahedron) {
  for (const int levels : {0, 1, 3}) {
    const Scene scene = loop_of(
        "\"point3 P\" [1 1 1  1 -1 -1  -1 1 -1  -1 -1 1] \"integer indices\" [0 1 2  0 2 3  0 3 1  "
        "1 3 2] \"integer levels\" " +
        std::to_string(levels));
    EXPECT_LT(glm::length(mesh_of(scene).positions[1] - 0.2f * glm::vec3(1, -1, -1)), 1e-6f)
        << levels;
  }
}

// A plane stays one. At its border the rule knows the two neighbours along it alone, 1/8 of each,
// and the limit 1/5: the middle of a straight border stays, and a corner c between a and b goes to
// (3 c + a + b) / 5.
TEST(LoopSubdivision, Borders) {
  const Scene scene = loop_of(
      "\"point3 P\" [0 0 1  1 0 1  2 0 1  0 1 1  1 1 1  2 1 1  0 2 1  1 2 1  2 2 1] \"integer "
      "levels\" 0 \"integer indices\" "
      "[0 1 4  0 4 3  1 2 5  1 5 4  3 4 7  3 7 6  4 5 8  4 8 7]");
  const TriangleMeshShape& mesh = mesh_of(scene);
  EXPECT_LT(glm::length(mesh.positions[1] - glm::vec3(1, 0, 1)), 1e-6f);
  EXPECT_LT(glm::length(mesh.positions[0] - glm::vec3(0.2f, 0.2f, 1)), 1e-6f);
  EXPECT_LT(glm::length(mesh.positions[2] - glm::vec3(1.8f, 0.2f, 1)), 1e-6f);
  EXPECT_LT(glm::length(mesh.positions[4] - glm::vec3(1, 1, 1)), 1e-6f);
  for (const glm::vec3& normal : mesh.normals)
    EXPECT_LT(glm::length(normal - glm::vec3(0, 0, -1)), 1e-6f);
  // Once refined, the corner is at (6 c + a + b) / 8 and its neighbours in the middles: the limit
  // is (3 * 1/8 + 1/2) / 5.
  const Scene refined = loop_of(
      "\"point3 P\" [0 0 0  1 0 0  0 1 0] \"integer levels\" 1 \"integer indices\" [0 1 2]");
  const TriangleMeshShape& finer = mesh_of(refined);
  EXPECT_LT(glm::length(finer.positions[0] - glm::vec3(0.175f, 0.175f, 0)), 1e-6f);
}

// The points rise along x alone, regular and with one diagonal. By hand, as pbrt-v4 does it: points
// go to their limits (a half and 1/12 of six neighbours within, 3/5 and 1/5 of two at a border),
// and normals are across tangents of those, of a border's vertex of four neighbours r along r3 - r0
// and -r0 + 2 r1 + 2 r2 - r3 - 2 p.
TEST(LoopSubdivision, NormalsOfASheetAndOfItsBorders) {
  constexpr double height[] = {0, 1, -1, 2, 0.5};
  std::string points, indices;
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 5; ++x) points += fmt::format("{} {} {}  ", x, y, height[x]);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      const int a = 5 * y + x;
      indices += fmt::format("{} {} {}  {} {} {}  ", a, a + 1, a + 6, a, a + 6, a + 5);
    }
  const Scene scene = loop_of("\"point3 P\" [" + points +
                              "] \"integer levels\" 0 \"integer indices\" [" + indices + "]");
  const TriangleMeshShape& mesh = mesh_of(scene);
  const auto at = [&](std::size_t x) {
    return x == 0 || x == 4 ? glm::dvec3(height[x], 0, height[x])
                            : glm::dvec3(height[x - 1], height[x], height[x + 1]);
  };
  const auto within = [&](std::size_t x) {
    return x == 0 || x == 4 ? height[x] : (at(x).x + 4 * at(x).y + at(x).z) / 6;
  };
  const auto border = [&](std::size_t x) { return (at(x).x + 3 * at(x).y + at(x).z) / 5; };
  const auto expect = [&](std::size_t x, std::size_t y, const glm::dvec3& along,
                          const glm::dvec3& across, double z) {
    glm::dvec3 normal = glm::normalize(glm::cross(along, across));
    if (normal.z > 0) normal = -normal;  // pbrt-v4's side
    EXPECT_LT(glm::length(glm::dvec3(mesh.normals[5 * y + x]) - normal), 1e-5) << x << ' ' << y;
    EXPECT_NEAR(static_cast<double>(mesh.positions[5 * y + x].z), z, 1e-6) << x << ' ' << y;
  };
  for (std::size_t x = 1; x < 4; ++x)
    expect(x, 2, {2, 0, within(x + 1) - within(x - 1)}, {0, 1, 0}, within(x));
  const glm::dvec3 along(2, 0, border(3) - border(1));
  expect(2, 0, along, {2, 4, 2 * within(3) + 2 * within(2) - border(3) - border(1) - 2 * border(2)},
         border(2));
  expect(2, 4, along,
         {-2, -4, 2 * within(1) + 2 * within(2) - border(3) - border(1) - 2 * border(2)},
         border(2));
}

TEST(LoopSubdivision, WhatMakesNoSurface) {
  const auto said = [](const std::string& indices, const std::string& more = "") {
    return complaint_of([&] {
      loop_of("\"point3 P\" [0 0 0  1 0 0  0 1 0  0 0 1  1 1 1] \"integer indices\" [" + indices +
              "] " + more);
    });
  };
  EXPECT_THAT(said("0 1 2  1 0 3  0 1 4"),
              HasSubstr("has three triangles at the edge between the vertices 0 and 1"));
  EXPECT_THAT(said("0 1 2  0 1 3"),
              HasSubstr("turned differently at the edge between the vertices 0 and 1"));
  EXPECT_THAT(said("0 0 2"), HasSubstr("has a triangle with the vertex 0 twice"));
  EXPECT_THAT(said("0 1 2  0 3 4"), HasSubstr("more than one border at the vertex 0"));
  EXPECT_THAT(said("0 1 2", "\"integer levels\" -1"), HasSubstr("\"levels\" must not be negative"));
  EXPECT_THAT(said("0 1 2", "\"integer levels\" 13"), HasSubstr("more than 2^24 triangles"));
  EXPECT_THAT(said("0 1 2", "\"integer levels\" 100"), HasSubstr("more than 2^24 triangles"));
  EXPECT_THAT(said("0 1 9"), HasSubstr("but there are 5 vertices"));
}

TEST(ProgramStatements, TypesAreThoseThatValuesSuit) {
  const Scene scene = world_of(
      "Texture \"a\" \"float\" \"dots\" \"float inside\" 1\nTexture \"b\" \"float\" \"dots\" "
      "\"float inside\" .5\n"
      "Shape \"sphere\" \"texture alpha\" \"a\"\nShape \"sphere\" \"texture alpha\" \"b\"\n");
  const auto texture = scene.shapes.at(1).alpha->texture;
  const Shape shape = shape_of({"Shape",
                                "disk",
                                {{"alpha", "texture", {}, {std::to_string(texture.value())}},
                                 {"name", "", {}, {"lid"}},
                                 {"radius", "", {2}}}},
                               0, scene);
  EXPECT_EQ(shape.alpha.value().texture, texture);
  EXPECT_EQ(shape.name, "lid");
  EXPECT_EQ(std::get<DiskShape>(shape.geometry).radius, 2);
  const auto said = [&](const StatementParameter& one) {
    return complaint_of([&] { shape_of({"Shape", "disk", {one}}, 0, scene); });
  };
  EXPECT_THAT(said({"radius", "", {}, {"two"}}), HasSubstr("radius"));
  EXPECT_THAT(said({"name", "", {2}}), HasSubstr("name"));
}

TEST(Files, WhatIsImportedNamesItsOwnSystems) {
  const auto folder = temporary_folder();
  write_file(folder / "part.pbrt",
             "Translate 1 2 3\nCoordinateSystem \"inner\"\nShape \"sphere\"\n");
  write_file(folder / "scene.pbrt",
             "Camera \"perspective\"\nWorldBegin\nImport \"part.pbrt\"\nCoordSysTransform "
             "\"inner\"\nShape \"sphere\"\n");
  EXPECT_THAT(complaint_of([&] { import_scene(folder / "scene.pbrt", StubImages()); }),
              HasSubstr("scene.pbrt:4:19: unknown coordinate system \"inner\""));
}

/// A texture of constants worked out: of a checkerboard, tex1.
glm::dvec3 value_of(const Scene& scene, const TextureOperand& operand);
glm::dvec3 value_of(const Scene& scene, std::uint32_t texture) {
  const auto& model = scene.textures.at(texture).model;
  if (const auto* product = std::get_if<ScaleTexture>(&model))
    return value_of(scene, product->tex) * value_of(scene, product->scale);
  if (const auto* board = std::get_if<CheckerboardTexture>(&model))
    return value_of(scene, board->tex1);
  const auto& mix = std::get<MixTexture>(model);
  const glm::dvec3 amount = value_of(scene, mix.amount);
  return (1.0 - amount) * value_of(scene, mix.tex1) + amount * value_of(scene, mix.tex2);
}
glm::dvec3 value_of(const Scene& scene, const TextureOperand& operand) {
  if (operand.texture) return value_of(scene, *operand.texture);
  if (const auto* rgb = std::get_if<RgbSpectrum>(&operand.value)) return rgb->rgb;
  return glm::dvec3(std::get<ConstantSpectrum>(operand.value).value);
}

// d'Eon et al. 2011: 0.419, 0.697, 1.37 of eumelanin and 0.187, 0.4, 1.05 of pheomelanin.
TEST(HairColor, PigmentsMayBeTextures) {
  const auto absorbed = [](const std::string& parameters) {
    const Scene scene = world_of(
        "Texture \"t\" \"float\" \"checkerboard\" \"float tex1\" 2 \"float tex2\" 3\nMaterial "
        "\"hair\" " +
        parameters +
        " Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" .1");
    const Material& hair = scene.materials.at(scene.shapes.at(0).material);
    return value_of(scene, texture_of(hair, "sigma_a").value());
  };
  EXPECT_LT(
      glm::length(absorbed("\"texture eumelanin\" \"t\"") - 2.0 * glm::dvec3(.419, .697, 1.37)),
      1e-12);
  EXPECT_LT(glm::length(absorbed("\"texture pheomelanin\" \"t\" \"float eumelanin\" .5") -
                        (2.0 * glm::dvec3(.187, .4, 1.05) + .5 * glm::dvec3(.419, .697, 1.37))),
            1e-12);
}

glm::dvec3 absorption(const Scene& scene) {
  const auto& medium = std::get<HomogeneousMedium>(scene.media.at(0).model);
  return std::get<RgbSpectrum>(medium.scattering.sigma_a).rgb;
}

TEST(Subsurface, TexturesCountByTheirMeans) {
  const auto with = [](const std::string& reflectance) {
    const auto image = temporary_folder() / "map.png";
    write_file(image, "");
    return absorption(
        world_of("Texture \"b\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.2 .3 .4] \"rgb tex2\" "
                 "[.6 .5 .8]\n"
                 "Texture \"h\" \"spectrum\" \"scale\" \"texture tex\" \"b\" \"float scale\" .5\n"
                 "Texture \"m\" \"spectrum\" \"imagemap\" \"string encoding\" \"linear\" \"string "
                 "filename\" \"" +
                 image.string() +
                 "\"\nTexture \"v\" \"spectrum\" \"marble\"\n"
                 "Material \"subsurface\" \"rgb mfp\" [.1 .2 .3] " +
                 reflectance + "\nShape \"sphere\""));
  };
  const auto same = [&](const char* texture, const std::string& rgb) {
    LogOf log;
    EXPECT_LT(glm::length(with("\"texture reflectance\" \"" + std::string(texture) + "\"") -
                          with("\"rgb reflectance\" " + rgb)),
              1e-4)
        << texture;
    EXPECT_THAT(
        log.text(),
        HasSubstr("\"reflectance\" varies over the surface, and counts by its mean within"));
  };
  same("b", "[.4 .4 .6]");
  same("h", "[.2 .2 .3]");
  same("m", "[.3515625 .3671875 .3828125]");  // (3 k + c) / 64, k from 0 to 15
  EXPECT_THAT(complaint_of([&] { with("\"texture reflectance\" \"v\""); }),
              HasSubstr("\"reflectance\" varies over the surface: no medium can be made of it"));
}

// Every scattering within is one of the path's, where pbrt-v4 counts one for all of them.
// Statements as they stand in pbrt-v4's scenes, of shapes and files of our own.
TEST(Statements, OfTheCollection) {
  const char* const texts[] = {
      // A shape's material and medium before they are defined; a type that comes after the
      // coefficients.
      "WorldBegin\nAttributeBegin\nNamedMaterial \"light\"\nAreaLightSource \"diffuse\" \"float "
      "scale\" [10] \"blackbody L\" [ "
      "6500 ]\n"
      "Shape \"sphere\"\nAttributeEnd\nMaterial \"dielectric\" \"spectrum eta\" "
      "\"glass-F11\"\nMakeNamedMedium \"liquid\" \"rgb "
      "sigma_s\" "
      "[ 0.1 0.1 0.05 ] \"rgb sigma_a\" [ .1 .1 .1 ] \"float scale\" [ 0.5 ] \"string type\" [ "
      "\"homogeneous\" ]\n"
      "MediumInterface \"\" \"liquid\"\nReverseOrientation\nTranslate 3 0 0\nShape "
      "\"sphere\"\nMakeNamedMaterial \"light\" "
      "\"string type\" "
      "[ \"diffuse\" ] \"rgb reflectance\" [ 0 0 0 ]",
      // Blanks within the quotes of a declaration, and what hair takes.
      "WorldBegin\nMaterial \"hair\" \"float beta_m\" 0.5 \" float beta_n\" 0.5 \"rgb color\" [ "
      "0.5 0.5 0.5 ]\nShape \"curve\" "
      "\"point3 P\" "
      "[0 0 0  0 1 0  1 1 0  1 2 0] \"string type\" \"flat\" \"float width0\" .1 \"float width1\" "
      ".05",
      // Lights that are not seen, and a sky through a window.
      "WorldBegin\nLightSource \"infinite\" \"point3 portal\" [96 280 -523  96 280 -269   96 9 "
      "-269   96 9 -523 ] \"blackbody "
      "L\" 6500 "
      "\"float scale\" 7.5\nAreaLightSource \"diffuse\" \"rgb L\" [7 7 7]\nShape \"bilinearmesh\" "
      "\"point3 P\" [-1 -5 0 1 -5 0 "
      "-1 5 0 1 5 0] "
      "\"float alpha\" [ 0 ]",
      // What parts a volume from the air, under names of old and new.
      "MakeNamedMedium \"c\" \"string type\" \"cloud\" \"spectrum sigma_s\" [200 10 900 10] "
      "\"spectrum sigma_a\" [200 .01 900 "
      ".01] \"float "
      "density\" 2\nWorldBegin\nMediumInterface \"c\" \"\"\nMaterial \"\"\nTranslate .5 .5 "
      ".5\nShape \"sphere\" \"float radius\" "
      "1",
      "CoordinateSystem \"here\"\nCamera "
      "\"perspective\"\nWorldBegin\nAttributeBegin\nCoordSysTransform \"camera\"\nTranslate 0 "
      "2 25\nShape "
      "\"sphere\" \"float radius\" 3\nAttributeEnd\nCoordSysTransform \"here\"\nShape \"cylinder\" "
      "\"float radius\" 1 \"float "
      "phimax\" 90",
      // A bump of a bump's scale; a metal whose roughness is an image's; an object of nothing.
      "WorldBegin\nTexture \"s\" \"float\" \"constant\" \"float value\" [ 0.0002 ]\nTexture "
      "\"raw\" \"float\" "
      "\"wrinkled\"\nTexture \"bump\" "
      "\"float\" \"scale\" \"texture scale\" [ \"s\" ] \"texture tex\" [ \"raw\" ]\nMaterial "
      "\"coateddiffuse\" \"texture "
      "displacement\" [ "
      "\"bump\" ] \"float roughness\" [ 0.0003 ]\nShape \"sphere\"\nMaterial \"conductor\" "
      "\"texture roughness\" \"raw\" "
      "\"spectrum eta\" "
      "[ \"metal-Au-eta\" ] \"spectrum k\" [ \"metal-Au-k\" ]\nShape \"sphere\"\nObjectBegin "
      "\"nothing\"\nAttributeBegin\nAttributeEnd\n"
      "ObjectEnd\nObjectInstance \"nothing\"",
      "Option \"seed\" 3\nOption \"string rendercoordsys\" \"cameraworld\"\nOption \"pixelstats\" "
      "true\nTransformTimes 0 "
      "1\nAccelerator \"bvh\" "
      "\"string splitmethod\" \"hlbvh\"\nSampler \"pmj02bn\" \"integer pixelsamples\" "
      "4\nColorSpace "
      "\"rec2020\"\nWorldBegin\nActiveTransform "
      "All\nAttribute \"shape\" \"float radius\" 2\nAttribute \"material\" \"float roughness\" "
      ".1\nMaterial "
      "\"dielectric\"\nShape \"sphere\"",
      ("WorldBegin\nShape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"string "
       "emissionfilename\" \"nowhere.png\""),
  };
  for (const char* text : texts) EXPECT_THAT(complaints(text), IsEmpty()) << text;
}

TEST(Cameras, Realistic) {
  const std::string file = (temporary_folder() / "lens.dat").string();
  const auto with = [&](const std::string& lens, const std::string& more) {
    std::ofstream(file) << lens;
    return "Camera \"realistic\" \"string lensfile\" \"" + file + "\"" + more + "\n" + ball;
  };
  const std::string glass = "# two surfaces\n30 4 1.5 20\n0 2 0 10 -30 40 1 22\n";
  const auto camera = std::get<RealisticProjection>(
      scene_of(with(glass,
                    " \"float aperturediameter\" 6 \"float focusdistance\" 3 \"string "
                    "aperture\" \"star\""))
          .view.camera.projection);
  ASSERT_TRUE(camera.lens);
  EXPECT_EQ(camera.lens->file, file);
  ASSERT_EQ(camera.lens->elements.size(), 3u);
  EXPECT_EQ(camera.lens->elements[0].radius, 30);
  EXPECT_EQ(camera.lens->elements[0].thickness, 4);
  EXPECT_EQ(camera.lens->elements[0].eta, 1.5);
  EXPECT_EQ(camera.lens->elements[0].diameter, 20);
  EXPECT_EQ(camera.lens->elements[2].radius, -30);
  EXPECT_EQ(camera.aperture_diameter, 6);
  EXPECT_EQ(camera.focus_distance, 3);
  EXPECT_EQ(camera.aperture->name, "star");
  const auto plain = std::get<RealisticProjection>(
      scene_of("Camera \"realistic\"\n" + std::string(ball)).view.camera.projection);
  EXPECT_FALSE(plain.lens || plain.aperture);
  EXPECT_EQ(plain.aperture_diameter, 1);
  EXPECT_EQ(plain.focus_distance, 10);
  EXPECT_EQ(scene_of("Film \"rgb\" \"float diagonal\" 24\n" + std::string(ball)).view.film.diagonal,
            24);

  EXPECT_THAT(said_of(with("30 4 1.5 20\n-30 40 1", "")),
              HasSubstr("lens.dat:2:8: the last surface"));
  EXPECT_THAT(said_of(with("30 4 0.5 20", "")), HasSubstr("lens.dat:1:10: the index"));
  EXPECT_THAT(said_of(with("30 -4 1.5 20", "")), HasSubstr("lens.dat:1:11: the thickness"));
  EXPECT_THAT(said_of(with("30 4 1.5 0", "")), HasSubstr("lens.dat:1:10: the diameter"));
  EXPECT_THAT(said_of(with("30 4 glass 20", "")), HasSubstr("lens.dat:1:6"));
  EXPECT_THAT(said_of(with("", "")), HasSubstr("the lens file is empty"));
  EXPECT_THAT(said_of(with(glass, " \"float focusdistance\" 0.05")),
              HasSubstr("scene.pbrt:1:1: Camera \"realistic\": the lens cannot focus so near"));
  // The reader of these tests makes an image of any name.
  const auto masked = std::get<RealisticProjection>(
      scene_of(with(glass, " \"string aperture\" \"mask.png\"")).view.camera.projection);
  ASSERT_TRUE(masked.aperture);
  EXPECT_THAT(masked.aperture->name, HasSubstr("mask.png"));
  double sum = 0;
  for (const float value : masked.aperture->values) sum += static_cast<double>(value);
  EXPECT_NEAR(sum / static_cast<double>(masked.aperture->values.size()), 3.14159265 / 4, 1e-6);
  EXPECT_THAT(
      said_of("Camera \"realistic\" \"string lensfile\" \"nowhere.dat\"\n" + std::string(ball)),
      HasSubstr("nowhere.dat"));
}

// What is left has its place.
TEST(Statements, ThatAreRefused) {
  const auto said = [](const std::string& text) { return complaints(text); };
  EXPECT_THAT(
      said("WorldBegin\nMaterial \"measured\" \"string filename\" \"a.bsdf\"\nShape \"sphere\""),
      ElementsAre(HasSubstr("scene.pbrt:2:1: Material \"measured\" is not rendered yet")));
  EXPECT_THAT(said("WorldBegin\nTexture \"p\" \"spectrum\" \"ptex\" \"string filename\" "
                   "\"a.ptx\"\nMaterial \"diffuse\" \"texture "
                   "reflectance\" \"p\"\nShape \"sphere\""),
              ElementsAre(HasSubstr("scene.pbrt:3:20: Material \"diffuse\": \"reflectance\" uses "
                                    "Texture \"ptex\" (scene.pbrt:2:1)")));
  EXPECT_THAT(
      said("Integrator \"function\"\n" + std::string(ball)),
      ElementsAre(HasSubstr("scene.pbrt:1:1: Integrator \"function\" is not rendered yet")));
}

}  // namespace
}  // namespace caplet::test::statements_test
