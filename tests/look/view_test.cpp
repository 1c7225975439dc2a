// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Views, ups and projections: where known points come to lie. Axes of the views are those of a
// drawing by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "import/picture_options.h"
#include "lower/camera.h"
#include "present/film_window.h"
#include "present/lights.h"
#include "present/picture_options.h"
#include "present/present.h"
#include "scene/camera.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

/// Balls of radius 1 on all three axes.
Scene three_balls(int width = 200, int height = 100) {
  Scene scene;
  scene.materials.push_back({DiffuseMaterial{}, "m", {}});
  CapsulesShape capsules;
  for (const glm::vec3& p : {glm::vec3(10, 0, 0), glm::vec3(-10, 0, 0), glm::vec3(0, 4, 0),
                             glm::vec3(0, -4, 0), glm::vec3(0, 0, 2)}) {
    capsules.p0.push_back(p);
    capsules.p1.push_back(p);
    capsules.radius0.push_back(1);
  }
  Shape shape;
  shape.geometry = capsules;
  scene.shapes.push_back(shape);
  scene.view.film.width = width;
  scene.view.film.height = height;
  add_presentation(scene);
  return scene;
}

void look(Scene& scene, std::map<std::string, std::string> options, bool is_turned = false) {
  apply_picture_options(scene, test::NoImages(), ImportOptions(std::move(options)), is_turned);
}

glm::dvec3 axis_of(const Scene& scene, int column) {
  return glm::dvec3(scene.view.camera.world_from_camera[column]);
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-12)
      << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

TEST(View, NamesAreSidesAsDrawn) {
  struct Row {
    const char *view, *up;
    glm::dvec3 right, above, forward;
  };
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const Row& row :
       {Row{"front", "y", x, y, -z}, Row{"back", "y", -x, y, z}, Row{"right", "y", -z, y, -x},
        Row{"left", "y", z, y, x}, Row{"top", "y", x, -z, -y}, Row{"bottom", "y", x, z, y},
        Row{"front", "z", x, z, y}, Row{"top", "z", x, y, -z}, Row{"right", "z", y, z, -x},
        Row{"front", "x", -y, x, -z}, Row{"front", "-y", x, -y, z}, Row{"front", "-z", x, -z, -y},
        Row{"0,0,5", "y", x, y, -z}, Row{"0,-2,0", "z", x, z, y}}) {
    SCOPED_TRACE(std::string(row.view) + " " + row.up);
    Scene scene = three_balls();
    look(scene, {{"view", row.view}, {"up", row.up}});
    expect_near(axis_of(scene, 0), row.right);
    expect_near(axis_of(scene, 1), row.above);
    expect_near(axis_of(scene, 2), row.forward);
    EXPECT_TRUE(scene.automatic_camera);
  }
}

TEST(View, IsoSeesThreeSidesAlike) {
  Scene scene = three_balls();
  look(scene, {{"view", "iso"}});
  expect_near(axis_of(scene, 2), glm::dvec3(-1 / std::sqrt(3.0)));
  EXPECT_NEAR(axis_of(scene, 0).y, 0, 1e-12);
  EXPECT_GT(axis_of(scene, 1).y, 0.8);
}

TEST(View, WithoutUpAskedTheWorldTurnsToIt) {
  // Automatic directions too: a scene that is turned with its up looks the same.
  Scene upright = three_balls(), lying = three_balls();
  for (glm::vec3& p : std::get<CapsulesShape>(lying.shapes[0].geometry).p0)
    p = {p.x, -p.z, p.y};  // y goes to z
  for (glm::vec3& p : std::get<CapsulesShape>(lying.shapes[0].geometry).p1) p = {p.x, -p.z, p.y};
  look(lying, {{"up", "z"}});
  for (const int column : {0, 1, 2, 3}) {
    const glm::dvec3 a = axis_of(upright, column), b = axis_of(lying, column);
    EXPECT_LT(glm::length(glm::dvec3(a.x, -a.z, a.y) - b), 1e-9) << column;
  }
}

TEST(View, UpTurnsAreRotationsThatTakeItToY) {
  for (const glm::dvec3& up :
       {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0),
        glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1), glm::normalize(glm::dvec3(1, 2, 3)),
        glm::normalize(glm::dvec3(-3, -2, 0.1))}) {
    const glm::dmat3 turn = turned_up(up);
    expect_near(turn * up, {0, 1, 0});
    EXPECT_NEAR(glm::determinant(turn), 1, 1e-12);
    expect_near(turn[0], glm::transpose(glm::inverse(turn))[0]);
  }
}

/// The pixel that an orthographic camera has in the middle of its picture at a point, by hand: x to
/// the right, y down.
glm::dvec2 pixel_of(const Scene& scene, const glm::dvec3& p) {
  const glm::dvec3 local(glm::inverse(scene.view.camera.world_from_camera) * glm::dvec4(p, 1));
  const auto& w = scene.view.camera.screen_window.value();
  return {(local.x - w[0]) / (w[1] - w[0]) * scene.view.film.width,
          (w[3] - local.y) / (w[3] - w[2]) * scene.view.film.height};
}

TEST(Orthographic, PointsLieWhereTheyAreDrawn) {
  Scene scene = three_balls(200, 100);
  look(scene, {{"view", "front"}, {"projection", "orthographic"}});
  EXPECT_EQ(fov_of(scene.view.camera), 0);
  // 22 wide and 10 high with a margin of 5 % of the half image on each side: 22 / (0.95 * 200) is
  // more than 10 / (0.95 * 100).
  const double per_pixel = 22 / (0.95 * 200);
  EXPECT_NEAR(pixel_of(scene, {10, 0, 0}).x, 100 + 10 / per_pixel, 1e-9);
  EXPECT_NEAR(pixel_of(scene, {0, 4, 0}).y, 50 - 4 / per_pixel, 1e-9);
  // As the device has it: the ray of the pixel that the ball's middle lies in.
  const auto x = static_cast<int>(100 + 10 / per_pixel);
  const RayRecord ray = ray_of_pixel(scene, x, 50);
  EXPECT_NEAR(ray.ox, (x + 0.5 - 100) * per_pixel, 1e-5);
  EXPECT_NEAR(ray.oy, -0.5 * per_pixel, 1e-5);
  EXPECT_NEAR(ray.dz, -1, 1e-7);
  EXPECT_GT(ray.oz, 3) << "before all of it";
  // A higher film: the width binds still.
  set_film_size(scene, 200, 400);
  EXPECT_NEAR(pixel_of(scene, {10, 0, 0}).x, 100 + 10 / per_pixel, 1e-9);
  EXPECT_NEAR(pixel_of(scene, {0, 4, 0}).y, 200 - 4 / per_pixel, 1e-9);
  expect_near(axis_of(scene, 2), {0, 0, -1});
}

TEST(Orthographic, SidesOfOneLengthAtAllDepths) {
  Scene scene = three_balls();
  look(scene, {{"view", "iso"}, {"projection", "orthographic"}});
  const double near = glm::length(pixel_of(scene, {1, 0, 2}) - pixel_of(scene, {0, 0, 2}));
  EXPECT_NEAR(near, glm::length(pixel_of(scene, {1, 0, -200}) - pixel_of(scene, {0, 0, -200})),
              1e-9);
  // An axis of the three is sqrt(2/3) of its length.
  const auto& w = scene.view.camera.screen_window.value();
  EXPECT_NEAR(near, std::sqrt(2.0 / 3) * scene.view.film.width / (w[1] - w[0]), 1e-9);
}

TEST(Perspective, EverythingFitsFromEverySide) {
  for (const char* view : {"front", "back", "left", "right", "top", "bottom", "iso", "1,-2,0.3"})
    for (const char* up : {"y", "z", "-x"}) {
      SCOPED_TRACE(std::string(view) + " " + up);
      Scene scene = three_balls(300, 200);
      look(scene, {{"view", view}, {"up", up}});
      const glm::dmat4 camera_from_world = glm::inverse(scene.view.camera.world_from_camera);
      const double tangent = std::tan(fov_of(scene.view.camera) / 2);
      double most = 0;
      for (const glm::vec3& p : test::capsules_of(scene).p0)
        for (int i = 0; i < 2000; ++i) {
          // Points all over the ball, by the golden spiral.
          const double h = 1 - (2 * i + 1) / 2000.0, phi = i * 2.399963229728653,
                       r = std::sqrt(1 - h * h);
          const glm::dvec4 q =
              camera_from_world *
              glm::dvec4(glm::dvec3(p) + glm::dvec3(r * std::cos(phi), h, r * std::sin(phi)), 1);
          ASSERT_GT(q.z, 0);
          most = std::max(
              {most, std::abs(q.x / q.z) / (1.5 * tangent), std::abs(q.y / q.z) / tangent});
        }
      EXPECT_LE(most, 0.9501);
      EXPECT_GE(most, 0.94);
    }
}

TEST(Look, AFilesOwnCameraIsReplacedByAViewAlone) {
  Scene scene = three_balls();
  scene.automatic_camera = false;
  const Camera before = scene.view.camera;
  EXPECT_THAT(complaint([&] {
                look(scene, {{"up", "z"}});
              }),
              AllOf(HasSubstr("--up"), HasSubstr("--view")));
  look(scene, {{"light", "flat"}, {"background", "white"}});
  EXPECT_EQ(scene.view.camera.world_from_camera, before.world_from_camera);
  look(scene, {{"view", "top"}});
  expect_near(axis_of(scene, 2), {0, -1, 0});
}

/// A file's camera, turned, moved and scaled, that sees the three balls' middle 5 units away.
Camera own_camera() {
  Camera camera;
  camera.world_from_camera = glm::dmat4(0, 0, -2, 0, 0, 2, 0, 0, 2, 0, 0, 0, -10, 0.5, 0.25, 1);
  camera.projection = PerspectiveProjection{1.2};
  camera.lens_radius = 0.125;
  camera.focal_distance = 4;
  return camera;
}

/// Where a point of the world lies in the picture.
glm::dvec2 place_of(const glm::dvec3& p, const Camera& camera, int width, int height) {
  FilmSettings film;
  film.width = width;
  film.height = height;
  const auto place =
      project(camera, film, glm::inverse(camera.world_from_camera) * glm::dvec4(p, 1));
  return place.value_or(glm::dvec2(-1e9));
}

TEST(Projection, OfAFilesCameraKeepsTheDepthOfTheMiddle) {
  Scene scene = three_balls();
  scene.automatic_camera = false;
  scene.view.camera = own_camera();
  // The middle of the scene's bounds is (0, 0, 1).
  const std::vector<glm::dvec3> points{{0, 0, 1}, {0, 3, -2}, {0, -4.5, 2.75}};
  const Camera before = scene.view.camera;
  look(scene, {{"projection", "perspective"}});
  EXPECT_EQ(scene.view.camera.world_from_camera, before.world_from_camera);
  look(scene, {{"projection", "orthographic"}});
  const Camera parallel = scene.view.camera;
  ASSERT_TRUE(is_orthographic(parallel));
  look(scene, {{"projection", "perspective"}});
  const Camera after = scene.view.camera;
  EXPECT_NEAR(fov_of(after), glm::radians(35.0), 1e-15);
  for (const auto& [width, height] : {std::pair(200, 100), std::pair(90, 150)})
    for (const glm::dvec3& p : points)
      for (const Camera& camera : {parallel, after}) {
        const glm::dvec2 is = place_of(p, camera, width, height),
                         was = place_of(p, before, width, height);
        EXPECT_LT(glm::distance(is, was), 1e-10) << is.x << " " << is.y << ", " << was.x;
      }
  // What is behind the middle is no smaller.
  EXPECT_NEAR(place_of({7, 3, 1}, parallel, 200, 100).y, place_of({0, 3, 1}, before, 200, 100).y,
              1e-10);
  // What is sharp is at the same depth, and the lens is as large.
  for (const Camera& camera : {parallel, after}) {
    const glm::dvec4 sharp = camera.world_from_camera * glm::dvec4(0, 0, camera.focal_distance, 1);
    EXPECT_NEAR(sharp.x, -2, 1e-12);
    EXPECT_NEAR(camera.lens_radius * glm::length(glm::dvec3(camera.world_from_camera[0])), 0.25,
                1e-15);
  }
}

TEST(Projection, OfACameraThatMovesIsThatOfItsKeys) {
  Scene scene = three_balls();
  scene.automatic_camera = false;
  scene.view.camera = own_camera();
  const glm::dmat4 first = scene.view.camera.world_from_camera;
  const glm::dmat4 second = glm::translate(glm::dmat4(1), glm::dvec3(0, 2, 0)) * first;
  scene.view.camera.motion = {{0, first}, {1, second}};
  look(scene, {{"projection", "orthographic"}});
  const Camera& camera = scene.view.camera;
  ASSERT_EQ(camera.motion.size(), 2U);
  EXPECT_EQ(camera.motion[0].matrix, camera.world_from_camera);
  EXPECT_EQ(camera.motion[1].matrix[3], second[3]);
  EXPECT_EQ(glm::dmat3(camera.motion[1].matrix), glm::dmat3(camera.world_from_camera));
}

TEST(Projection, OthersAreRefused) {
  Scene scene = three_balls();
  scene.automatic_camera = false;
  scene.view.camera = own_camera();
  scene.view.camera.world_from_camera[3].x = 3;
  const auto refused = [&] {
    return complaint([&] { look(scene, {{"projection", "orthographic"}}); });
  };
  EXPECT_THAT(refused(), AllOf(HasSubstr("--projection"), HasSubstr("lies behind its camera")));
  scene.view.camera.projection = SphericalProjection{};
  EXPECT_THAT(refused(), HasSubstr("a camera \"spherical\" has neither projection"));
}

TEST(Look, SetsTheExposureOfPreviews) {
  Scene scene = three_balls();
  look(scene, {{"exposure", "-1.5"}});
  EXPECT_EQ(scene.view.film.exposure, (PreviewExposure{-1.5, false}));
  look(scene, {{"exposure", "auto"}});
  EXPECT_EQ(scene.view.film.exposure, (PreviewExposure{0, true}));
  look(scene, {});
  EXPECT_EQ(scene.view.film.exposure, (PreviewExposure{0, true}));
}

TEST(Look, WordsThatAreWrongNameTheirOption) {
  Scene scene = three_balls();
  struct Row {
    const char *name, *value, *says;
  };
  for (const Row& row : {Row{"view", "fornt", "'front'"},
                         Row{"view", "0,0,0", "no direction"},
                         Row{"view", "1,2", "no view"},
                         Row{"view", "1,2,x", "no view"},
                         Row{"view", "1,2,3,4", "no view"},
                         Row{"view", "nan,0,0", "no view"},
                         Row{"up", "w", "x, y, z"},
                         Row{"up", "-", "x, y, z"},
                         Row{"projection", "flat", "orthographic"},
                         Row{"light", "sun", "studio, flat, dramatic"},
                         Row{"background", "whiet", "'white'"},
                         Row{"background", "#12345", "no file"},
                         Row{"background", "1,2,0", "from 0 to 1"},
                         Row{"background", "none.png", "no file"},
                         Row{"least-width", "-1", "0 to 64"},
                         Row{"least-width", "wide", "wide"},
                         Row{"least-width", "65", "0 to 64"},
                         Row{"exposure", "bright", "neither auto"},
                         Row{"exposure", "33", "-32 to 32"},
                         Row{"exposure", "nan", "-32 to 32"},
                         Row{"exposure", "1x", "1x"},
                         Row{"exposure", "", "neither auto"}})
    EXPECT_THAT(complaint([&] {
                  look(scene, {{row.name, row.value}});
                }),
                AllOf(HasSubstr(std::string("--") + row.name), HasSubstr(row.says)))
        << row.name << " " << row.value;
}

TEST(Light, SetUpsStandAroundTheCamera) {
  Scene scene = three_balls();
  look(scene, {{"view", "right"}});
  const glm::dmat3 studio = std::get<InfiniteLight>(scene.lights.at(0).model).world_from_light;
  // z of a light is up, x toward the viewer (here world x), y to the viewer's right (world -z).
  expect_near(studio[0], {1, 0, 0});
  expect_near(studio[1], {0, 0, -1});
  expect_near(studio[2], {0, 1, 0});

  look(scene, {{"light", "dramatic"}});
  ASSERT_EQ(scene.lights.size(), 1U);
  const auto& hard = std::get<InfiniteLight>(scene.lights[0].model);
  EXPECT_EQ(hard.world_from_light, studio);
  // Its brightest texel is at the upper left of who looks.
  const EnvironmentImage& image = *hard.image;
  std::size_t brightest = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3)
    if (image.rgb[i] > image.rgb[brightest]) brightest = i;
  const auto texel = static_cast<int>(brightest / 3);
  const double theta = std::numbers::pi * (texel / image.width + 0.5) / image.height;
  const double phi = 2 * std::numbers::pi * (texel % image.width + 0.5) / image.width;
  const glm::dvec3 from =
      hard.world_from_light *
      glm::dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  EXPECT_LT(glm::dot(from, axis_of(scene, 0)), -0.5);
  EXPECT_GT(glm::dot(from, axis_of(scene, 1)), 0.4);

  look(scene, {{"light", "flat"}});
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_EQ(std::get<InfiniteLight>(scene.lights[0].model).image, nullptr);
}

TEST(Background, ColoursAreWhatTheyAreCalled) {
  const auto color = [](const char* text) {
    return parse_backdrop(text, test::NoImages(), "--background").color;
  };
  EXPECT_EQ(color("white"), glm::dvec3(1));
  EXPECT_EQ(color("#ffffff"), glm::dvec3(1));
  EXPECT_EQ(color("black"), glm::dvec3(0));
  // 128 / 255 in sRGB is 0.2158605 (IEC 61966-2-1).
  EXPECT_NEAR(color("#808080").x, 0.2158605, 1e-6);
  EXPECT_NEAR(color("grey").y, 0.2158605, 1e-6);
  EXPECT_EQ(color("#ff0000"), glm::dvec3(1, 0, 0));
  EXPECT_NEAR(color("0,0.5,1").y, 0.2140411, 1e-6);
  EXPECT_EQ(parse_backdrop("transparent", test::NoImages(), "").kind, Backdrop::Kind::transparent);
}

}  // namespace
}  // namespace caplet
