// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Light sampling and scattering, weighted against each other, against scattering alone: the same
// light in every scene, for a scene whose lights have no chance of selection is rendered by paths
// that meet them. That estimate uses no density of a light.
#include <gtest/gtest.h>

#include <cmath>

#include "film/develop.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "support/thorough.h"

namespace caplet::test::strategies_test {
namespace {

const char* const at_the_shape = "LookAt 1.5 -4 1.2  0 0 0  0 0 1\n";
const char* const beside_it = "LookAt 1 -3 3  2 0 -1  0 0 1\n";  // at the floor

Scene scene_of(const std::string& world, const std::string& view) {
  return scene_of_text(
      "Integrator \"path\" \"integer maxdepth\" 8\n" + view +
      "Camera \"perspective\" \"float fov\" 40\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\n" +
      world);
}

/// Returns the mean of the green of a render. `sampled`: with light sampling, of all lights alike.
Mean light_of(const Scene& scene, int samples, bool sampled) {
  FlatScene flat = lower(scene);
  const FlatView view = lower_view(scene);
  // Csg shapes, whose area nobody knows, are sampled too. Lights of a tree are not in the table.
  const auto count = static_cast<uint>(flat.light_alias.size());
  for (uint i = 0; i < count; ++i) flat.light_alias[i] = {1, i, 1 / static_cast<float>(count), 0};
  flat.lighting.sampled_light_count = sampled ? flat.lighting.light_count : 0;
  RenderOptions options;
  options.samples_per_pixel = samples;
  const RenderResult result = render(flat, view, test_device(), options, {});
  return mean_of(develop(result.film, scene.view.film, Layers::all()), "G");
}

struct Case {
  std::string name, world;
  const char* view = at_the_shape;
  int samples = 1024;
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
};

const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n",
                  turned = lamp + "ReverseOrientation\n";
const std::string lamp_both =
    "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n";
const std::string box =
    "Shape \"box\" \"point3 p0\" [-0.7 -0.5 -0.6] \"point3 p1\" [0.6 0.8 0.5]\n";
const std::string sphere = "Shape \"sphere\" \"float radius\" 0.9\n";
const std::string capsule =
    "Shape \"capsule\" \"point3 p0\" [-0.5 0 -0.2] \"point3 p1\" [0.5 0.1 0.2] \"float radius\" "
    "0.6\n";
const std::string tube =
    "Shape \"cylinder\" \"point3 p0\" [-0.5 0 -0.2] \"point3 p1\" [0.5 0.1 0.2] \"float radius\" "
    "0.7\n";

const std::string pipe =
    "Shape \"cylinder\" \"float radius\" 0.5 \"float zmin\" -0.5 \"float zmax\" 0.7\n";
const std::string open_tube =
    "Shape \"cylinder\" \"point3 p0\" [-0.5 0 -0.2] \"point3 p1\" [0.5 0.1 0.2] \"float radius\" "
    "0.4 \"string caps\" \"open\"\n";
const std::string disk = "Shape \"disk\" \"float radius\" 0.8\n";
const std::string triangles =
    "Shape \"trianglemesh\" \"point3 P\" [-0.7 -0.8 0  0.8 -0.6 0.2  0.7 0.8 0  -0.8 0.8 0.5] "
    "\"integer indices\" [0 1 2  0 2 "
    "3]\n";
const std::string leaning =
    "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1] \"integer indices\" "
    "[0 1 2  0 2 3]\n"
    "\"normal N\" [1.5 0 1  1.5 0 1  1 0.7 1  1 -0.7 1]\n";
const std::string octahedron =
    "Shape \"trianglemesh\" \"point3 P\" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1] \"normal "
    "N\" [1 0 0  -1 0 0  0 1 0  0 -1 "
    "0  0 0 1  0 0 -1]\n\"integer indices\" [0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 "
    "5]\n";
const std::string bumps =
    "Texture \"f\" \"float\" \"fbm\"\nTexture \"b\" \"float\" \"scale\" \"texture tex\" \"f\" "
    "\"float scale\" 0.5\n"
    "Material \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7] \"texture displacement\" \"b\"\n";
const std::string unseen = " \"bool onesided\" true\n";
const std::string floor =
    "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\n"
    "Shape \"trianglemesh\" \"point3 P\" [-9 -9 -1  9 -9 -1  9 9 -1  -9 9 -1] \"integer indices\" "
    "[0 1 2  0 2 3]\n";

/// A shape's statement with more parameters.
std::string with(std::string shape, const std::string& parameters) {
  shape.pop_back();
  return shape + parameters;
}

/// Twelve squares of two triangles in a plane, which look up, or down where they are turned: enough
/// for a light tree.
std::string panels(double z) {
  std::string points, indices;
  for (int i = 0; i < 12; ++i) {
    const double x = -2 + 1.1 * (i % 4), y = -1.5 + 1.2 * (i / 4);
    for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {0.6, 0.0}, {0.6, 0.5}, {0.0, 0.5}})
      points += std::to_string(x + dx) + " " + std::to_string(y + dy) + " " +
                std::to_string(z + 0.2 * dx) + " ";
    for (const int corner : {0, 1, 2, 0, 2, 3}) indices += std::to_string(4 * i + corner) + " ";
  }
  return "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"integer indices\" [" + indices +
         "]\n";
}
/// Twenty small lamps of other shapes, round about.
std::string round_lamps() {
  std::string out;
  for (int i = 0; i < 20; ++i) {
    const double a = 0.7 * i, r = 1 + 0.1 * i;
    const std::string at = "Translate " + std::to_string(r * std::cos(a)) + " " +
                           std::to_string(r * std::sin(a)) + " " + std::to_string(0.05 * i) + "\n";
    const char* const shapes[] = {
        "Shape \"sphere\" \"float radius\" 0.08\n",
        "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0.2 0.1 0] \"float radius\" 0.04\n",
        "ReverseOrientation\nShape \"disk\" \"float radius\" 0.2\n",
        "Shape \"cone\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 .2] \"float radius\" [.1 .02]\n"};
    out += "AttributeBegin\n" + at + shapes[i % 4] + "AttributeEnd\n";
  }
  return out;
}

/// One capsule over the floor, in so many pieces along a gentle bend.
std::string chain(int pieces, const std::string& parameters = "") {
  std::string out;
  const auto corner = [&](int i) {
    const double t = double(i) / pieces;
    return "[" + std::to_string(1 + 2 * t) + " " + std::to_string(0.3 * t * t) + " 0] ";
  };
  for (int i = 0; i < pieces; ++i)
    out += "Shape \"capsule\" \"point3 p0\" " + corner(i) + "\"point3 p1\" " + corner(i + 1) +
           "\"float radius\" 0.15" + parameters + "\n";
  return out;
}

std::string glass(double alpha) {
  return "Material \"dielectric\" \"float eta\" 1.5 \"bool remaproughness\" false \"float "
         "roughness\" " +
         std::to_string(alpha) + "\n";
}

std::vector<Case> cases() {
  const std::string hollow = glass(0.4) + "ObjectBegin \"block\"\n" + box +
                             "ObjectEnd\nObjectBegin \"hole\"\nTranslate 0.1 0.2 0\nShape "
                             "\"sphere\" \"float radius\" 0.4\n"
                             "ObjectEnd\n";
  const std::string difference =
      "Shape \"csg\" \"string operation\" \"difference\" \"string operands\" [\"block\" "
      "\"hole\"]\n";
  return {
      {"box_turned", glass(0.6) + turned + box},
      {"box_both_sides", glass(0.6) + lamp_both + box},
      {"box_of_one_lit_face",
       glass(0.4) +
           "AreaLightSource \"diffuse\" \"rgb L\" [5 5 5] \"integer surfaces\" "
           "[3]\nReverseOrientation\n" +
           box,
       at_the_shape, 2048},
      {"sphere_turned", glass(0.6) + turned + sphere},
      {"sphere_both_sides", glass(0.4) + lamp_both + sphere},
      {"ellipsoid_turned", glass(0.4) + turned + "Scale 1 0.7 0.5\n" + sphere},
      {"capsule_turned", glass(0.4) + turned + capsule},
      {"cylinder_turned", glass(0.4) + turned + tube},
      {"cylinder_both_sides", glass(0.4) + lamp_both + tube},
      {"hollow_box_turned", hollow + turned + difference},
      {"hollow_box_both_sides", hollow + lamp_both + difference},
      {"onesided_hollow_box_both_sides", hollow + lamp_both + with(difference, unseen)},
      {"triangles_both_sides", glass(0.4) + lamp_both +
                                   "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0.2  1 1 0  "
                                   "-1 1 0.5] \"integer indices\" [0 1 2  0 2 3]\n"},
      {"sphere_within_sphere", glass(0.4) + sphere + "Material \"diffuse\"\n" + lamp +
                                   "Shape \"sphere\" \"float radius\" 0.3\n"},
      {"glass_lamp_within_glass",
       glass(0.4) + sphere + glass(0.3) + turned + "Shape \"sphere\" \"float radius\" 0.5\n"},
      {"sphere_within_box", glass(0.4) + box + "Material \"diffuse\"\n" + lamp +
                                "Shape \"sphere\" \"float radius\" 0.3\n"},
      {"onesided_pipe_turned", floor + turned + "Scale 1 1 0.5\n" + with(pipe, unseen), beside_it,
       2048},
      {"onesided_pipe_both_sides", floor + lamp_both + with(pipe, unseen), beside_it},
      {"onesided_tube_both_sides", floor + lamp_both + with(tube, unseen), beside_it},
      {"open_tube_both_sides", floor + lamp_both + open_tube, beside_it},
      {"onesided_open_tube_turned", floor + turned + with(open_tube, unseen), beside_it, 2048},
      {"onesided_open_tube_both_sides", floor + lamp_both + with(open_tube, unseen), beside_it,
       2048},
      {"onesided_capsule_both_sides", floor + lamp_both + with(capsule, unseen), beside_it},
      {"onesided_disk_both_sides", floor + lamp_both + "Rotate 30 0 1 0\n" + with(disk, unseen),
       beside_it},
      {"onesided_disk_turned", floor + turned + with(disk, unseen), beside_it},
      {"onesided_triangles_both_sides", floor + lamp_both + with(triangles, unseen), beside_it},
      {"onesided_triangles_turned", floor + turned + with(triangles, unseen), beside_it},
      {"onesided_triangles_mirrored",
       floor + "ObjectBegin \"lamp\"\n" + lamp + with(triangles, unseen) +
           "ObjectEnd\nScale 1 1 -1\nObjectInstance \"lamp\"\n",
       beside_it},
      {"many_panels", floor + turned + panels(0.5), beside_it},
      {"many_panels_mirrored",
       floor + "ObjectBegin \"lamp\"\n" + lamp + panels(-0.5) +
           "ObjectEnd\nScale 1 1 -1\nObjectInstance \"lamp\"\n",
       beside_it},
      {"many_panels_over_glass",
       glass(0.4) + box + "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n" + turned +
           panels(1.5),
       at_the_shape, 4096},
      {"many_round_lamps", floor + lamp + round_lamps(), beside_it, 2048},
      {"chain", floor + lamp + chain(200), beside_it, 1024},
      {"chain_that_lets_rays_through", floor + lamp + chain(50, " \"float alpha\" 0.7"), beside_it,
       1024},
      {"chain_in_haze",
       "MakeNamedMedium \"haze\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0.02 0.02 0.02] "
       "\"rgb sigma_s\" [0.05 0.05 "
       "0.05]\n"
       "MediumInterface \"haze\" \"\"\nMaterial \"interface\"\nShape \"box\" \"point3 p0\" [-12 "
       "-12 -0.999] \"point3 p1\" [12 12 "
       "12]\n"
       "MediumInterface \"\" \"\"\n" +
           floor + lamp + chain(60),
       beside_it, 512},
      {"boxes_with_faces_in_common",
       floor + lamp + "Translate 2 0 0\n" + box + "Translate 0.4 0 0\n" + box +
           "Translate 0 1.3 0\n" + box + "Translate 0 -0.4 0\n" + box,
       beside_it, 2048},
      {"csg_beside_a_box",
       "ObjectBegin \"block\"\n" + box + "ObjectEnd\nObjectBegin \"hole\"\nTranslate 0.3 0 0\n" +
           box + "ObjectEnd\n" + floor + lamp + difference + "Translate 0.1 0 0\n" + box,
       beside_it, 2048},
      {"leaning_triangles_above_and_beneath",
       leaning + lamp_both + "Translate 0 0 -1\n" + panels(-0.4) + panels(1.2), beside_it},
      {"leaning_metal_above_and_beneath",
       leaning.substr(leaning.find("Shape"))
               .insert(0, "Material \"conductor\" \"float roughness\" 0.3\n") +
           lamp_both + "Translate 0 0 -2.2\n" + triangles + "Translate 0 0 2.6\n" + triangles,
       beside_it},
      {"glass_octahedron_both_sides", glass(0.4) + lamp_both + octahedron},
      {"closed_octahedron_under_a_lamp",
       "Material \"diffuse\" \"rgb reflectance\" [0.8 0.8 0.8]\n" + octahedron +
           "Translate 0 0 2\nScale 4 4 1\n" + turned + triangles},
      {"bumped_sphere_both_sides", bumps + lamp_both + sphere},
      {"box_within_box_lamp", glass(0.4) + box +
                                  "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n" + turned +
                                  "Scale 8 8 8\n" + box},
  };
}

/// Solids turned inside out around floor and camera, whose insides no ray sees.
std::vector<Case> dark_cases() {
  const std::string whole =
      "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"block\" \"block\"]\n";
  return {
      {"box", floor + turned + "Scale 9 9 9\n" + with(box, unseen)},
      {"sphere", floor + turned + "Scale 9 9 9\n" + with(sphere, unseen)},
      {"csg", "ObjectBegin \"block\"\n" + box + "ObjectEnd\n" + floor + turned + "Scale 9 9 9\n" +
                  with(whole, unseen)},
      {"capsule", floor + turned + "Scale 12 12 12\n" + with(capsule, unseen)},
      {"cylinder", floor + turned + "Scale 12 12 12\n" + with(tube, unseen)},
  };
}

class Strategies : public testing::TestWithParam<Case> {};

TEST_P(Strategies, LightSamplingAgreesWithScatteringAlone) {
  const Scene scene = scene_of(GetParam().world, GetParam().view);
  const int samples = GetParam().samples / (thorough() ? 1 : 2);
  const Mean both = light_of(scene, samples, true), alone = light_of(scene, samples, false);
  RecordProperty("both", std::to_string(both.value));
  RecordProperty("alone", std::to_string(alone.value));
  const double error = std::hypot(both.error, alone.error);
  EXPECT_NEAR(both.value, alone.value, 4.5 * error);
  EXPECT_LT(error, (thorough() ? 7e-3 : 1e-2) * alone.value) << "too few samples to tell";
}

class DarkSides : public testing::TestWithParam<Case> {};

TEST_P(DarkSides, GiveNoLight) {
  const Scene scene = scene_of(GetParam().world, GetParam().view);
  EXPECT_EQ(light_of(scene, 64, true).value, 0);
}

INSTANTIATE_TEST_SUITE_P(Cases, DarkSides, testing::ValuesIn(dark_cases()),
                         [](const testing::TestParamInfo<Case>& row) { return row.param.name; });

INSTANTIATE_TEST_SUITE_P(Cases, Strategies, testing::ValuesIn(cases()),
                         [](const testing::TestParamInfo<Case>& row) { return row.param.name; });

}  // namespace
}  // namespace caplet::test::strategies_test
