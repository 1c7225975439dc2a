// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Several files as one scene, and what the colours of neurons tell. Expectations by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>

#include "import/detail/swc.h"
#include "import/detail/swc_color.h"
#include "import/import.h"
#include "present/present.h"
#include "support/import_files.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using test::complaint;
using test::write_file;
using testing::ElementsAre;
using testing::HasSubstr;

using Paths = std::vector<fs::path>;

Scene several(const Paths& paths, const ImportOptions& options = {}) {
  return import_scenes(paths, test::NoImages(), options);
}

std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const Shape& shape : scene.shapes) out.push_back(shape.name);
  return out;
}
std::vector<std::string> materials_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const Material& material : scene.materials) out.push_back(material.name);
  return out;
}

glm::dvec3 first_vertex(const Scene& scene, std::size_t shape) {
  const Shape& of = scene.shapes.at(shape);
  const auto& mesh = std::get<TriangleMeshShape>(of.geometry);
  return glm::dvec3(of.world_from_object * glm::dvec4(mesh.positions.at(1), 1));
}

/// A soma and a dendrite of two segments, `x` to the right.
std::string neuron(int x) {
  const std::string at = std::to_string(x);
  return "1 1 " + at + " 0 0 2 -1\n2 3 " + at + " 3 0 1 1\n3 3 " + at + " 6 0 0.5 2\n";
}

constexpr const char* triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr const char* pbrt_with_camera =
    "LookAt 0 0 9  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\n"
    "Film \"rgb\" \"integer xresolution\" 33 \"integer yresolution\" 22\nWorldBegin\n"
    "LightSource \"point\"\nTexture \"a\" \"float\" \"constant\" \"float value\" .5\n"
    "Texture \"b\" \"float\" \"scale\" \"texture tex\" \"a\" \"float scale\" .5\n"
    "Texture \"dots\" \"float\" \"dots\" \"float inside\" 1 \"float outside\" 0\n"
    "Texture \"both\" \"float\" \"mix\" \"texture tex1\" \"dots\" \"float tex2\" 1\n"
    "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [.5 0 0]\n"
    "MakeNamedMaterial \"blue\" \"string type\" \"diffuse\" \"rgb reflectance\" [0 0 .5]\n"
    "MakeNamedMaterial \"mixed\" \"string type\" \"mix\" \"string materials\" [\"red\" \"blue\"]\n"
    "NamedMaterial \"mixed\"\nShape \"sphere\" \"string name\" \"ball\" \"texture alpha\" "
    "\"both\"\n"
    "ObjectBegin \"thing\"\nNamedMaterial \"blue\"\nShape \"capsule\" \"point3 p0\" [0 0 0] "
    "\"point3 p1\" [1 0 0] \"float "
    "radius\" 1\nObjectEnd\n"
    "Translate 0 0 3\nObjectInstance \"thing\"\n";

TEST(SeveralFiles, AreOneSceneWithNamesOfTheirOwn) {
  const Scene scene = several({write_file("one.swc", neuron(0)), write_file("two.swc", neuron(20)),
                               write_file("tri.off", triangle)});
  EXPECT_THAT(names_of(scene), ElementsAre("one: sample 1", "one", "two: sample 1", "two", "tri"));
  // Colours of types are of both neurons.
  EXPECT_THAT(materials_of(scene), ElementsAre("soma", "basal dendrite", "default"));
  EXPECT_EQ(scene.shapes[1].material, scene.shapes[3].material);
  EXPECT_EQ(scene.lights.size(), 1U);
  EXPECT_TRUE(scene.automatic_camera);
  EXPECT_FALSE(scene.has_no_up);  // the mesh has one
  const Bounds bounds = bounds_of(scene);
  EXPECT_EQ(bounds.min.x, -2);
  EXPECT_EQ(bounds.max.x, 22);
}

// The camera is that of one scene of all the shapes.
TEST(SeveralFiles, AreFramedTogether) {
  const Scene scene =
      several({write_file("one.swc", neuron(0)), write_file("two.swc", neuron(20))});
  EXPECT_TRUE(scene.has_no_up);
  Scene again;
  again.shapes = scene.shapes;
  again.materials = scene.materials;
  again.has_no_up = true;
  add_presentation(again);
  EXPECT_EQ(again.view.camera.world_from_camera, scene.view.camera.world_from_camera);
  EXPECT_EQ(std::get<InfiniteLight>(again.lights[0].model).world_from_light,
            std::get<InfiniteLight>(scene.lights[0].model).world_from_light);
}

// The second corner of the triangle is (1, 0, 0).
TEST(SeveralFiles, AreMovedStepByStep) {
  const fs::path a = write_file("a.swc", neuron(0)), b = write_file("b.off", triangle);
  const auto corner = [&](const std::string& steps) {
    const Scene scene = several({a, fs::path(b.string() + steps)});
    EXPECT_THAT(scene.shapes.back().name, HasSubstr("b"));
    return first_vertex(scene, scene.shapes.size() - 1);
  };
  const auto expect_near = [](const glm::dvec3& is, const glm::dvec3& wanted) {
    EXPECT_LT(glm::distance(is, wanted), 1e-12) << is.x << ' ' << is.y << ' ' << is.z;
  };
  expect_near(corner(""), {1, 0, 0});
  expect_near(corner("@translate=1,2,-3.5"), {2, 2, -3.5});
  expect_near(corner("@scale=2"), {2, 0, 0});
  expect_near(corner("@scale=-2,3,4"), {-2, 0, 0});
  expect_near(corner("@rotate=90,0,0,2"), {0, 1, 0});
  expect_near(corner("@scale=2@translate=1,0,0@rotate=90,0,0,1"), {0, 3, 0});
  expect_near(corner("@rotate=90,0,0,1@translate=1,0,0@scale=2"), {2, 2, 0});
  // Neurons are moved whole, and the camera frames what is where.
  const Scene moved = several({a, fs::path(a.string() + "@translate=1000,0,0")});
  EXPECT_EQ(
      moved.shapes.back().world_from_object[3].x - moved.shapes.front().world_from_object[3].x,
      1000);
  EXPECT_GT(glm::distance(glm::dvec3(moved.view.camera.world_from_camera[3]), glm::dvec3(0)), 500);
  const Scene alone = several({fs::path(b.string() + "@translate=0,0,50")});
  expect_near(first_vertex(alone, 0), {1, 0, 50});
  EXPECT_TRUE(alone.automatic_camera);
}

TEST(SeveralFiles, AreMovedWithTheirInstances) {
  const fs::path a = write_file(
      "a.pbrt",
      "WorldBegin\nObjectBegin \"o\"\nShape \"sphere\"\nObjectEnd\nTranslate 1 0 0\n"
      "ObjectInstance \"o\"\nActiveTransform EndTime\nTranslate 0 2 0\nActiveTransform All\n"
      "ObjectInstance \"o\"\n");
  const Scene scene = several({fs::path(a.string() + "@translate=10,0,0")});
  ASSERT_EQ(scene.instances.size(), 2u);
  for (const Instance& instance : scene.instances)
    EXPECT_EQ(glm::dvec3(instance.world_from_object[3]), glm::dvec3(11, 0, 0));
  const TransformKeys& keys = scene.instances[1].motion;
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(glm::dvec3(keys[0].matrix[3]), glm::dvec3(11, 0, 0));
  EXPECT_EQ(glm::dvec3(keys[1].matrix[3]), glm::dvec3(11, 2, 0));
}

TEST(SeveralFiles, AreFramedWhereTheyWereMovedTo) {
  const fs::path a = write_file("a.pbrt",
                                "LookAt 0 0 9  0 0 0  0 1 0\nCamera \"perspective\" \"bool "
                                "automatic\" true\nWorldBegin\nShape \"sphere\"\n");
  const Scene scene = several({fs::path(a.string() + "@translate=1000,0,0")});
  EXPECT_GT(scene.view.camera.world_from_camera[3].x, 900);
}

TEST(SeveralFiles, WhatMovesThemIsSaidIfItIsWrong) {
  const std::string b = write_file("b.off", triangle).string();
  for (const auto& [steps, why] :
       {std::pair("@translate=1,2", "'@translate=1,2': wants three numbers"),
        {"@translate=1,2,x", "wants three numbers, such as @translate=10,0,0"},
        {"@translate=1,2,inf", "wants three numbers"},
        {"@rotate=90,0,0,0", "wants degrees and an axis"},
        {"@rotate=90", "wants degrees and an axis"},
        {"@scale=0", "wants a factor or three, none of them 0"},
        {"@scale=1,0,1", "none of them 0"},
        {"@scale=1,1,0", "none of them 0"},
        {"@scale=1,1", "wants a factor or three"},
        {"@scale", "wants a factor or three"},
        {"@tranlate=1,2,3", "'@tranlate=1,2,3': is no step; the nearest is '@translate='"},
        {"@translate=1,2,3@", "'@': is no step"}}) {
    const std::string file = b + steps, said = complaint([&] { several({fs::path(file)}); });
    EXPECT_THAT(said, HasSubstr(why)) << steps;
    EXPECT_THAT(said, HasSubstr(b + steps)) << steps;
  }
  // Names may have the sign.
  const fs::path odd = write_file("c@scale=2.off", triangle);
  EXPECT_EQ(first_vertex(several({odd}), 0), glm::dvec3(1, 0, 0));
  EXPECT_THAT(complaint([&] { several({odd.parent_path() / "d@e" / "no.off"}); }),
              HasSubstr("no.off"));
}

TEST(SeveralFiles, OfOneNameAreNumbered) {
  const Scene scene = several({write_file("one.swc", neuron(0)),
                               write_file("one.swc", neuron(20))});  // in folders of their own
  EXPECT_THAT(names_of(scene), ElementsAre("one 1: sample 1", "one 1", "one 2: sample 1", "one 2"));
}

// The media of the file with the camera stand behind those of the one before it, whichever comes
// first.
TEST(SeveralFiles, TheCameraIsWithinItsOwnFilesMedium) {
  const auto scene_in = [](const std::string& name, const std::string& medium, bool has_camera) {
    const std::string made = "MakeNamedMedium \"" + medium + "\" \"string type\" \"homogeneous\"\n";
    return write_file(
        name, made +
                  (has_camera ? "MediumInterface \"\" \"" + medium + "\"\nCamera \"perspective\"\n"
                              : "") +
                  "WorldBegin\nMediumInterface \"" + medium +
                  "\" \"\"\nMaterial \"interface\"\nShape \"sphere\"\n");
  };
  const fs::path fog = scene_in("fog.pbrt", "fog", true),
                 smoke = scene_in("smoke.pbrt", "smoke", false);
  for (const Paths& paths : {Paths{smoke, fog}, Paths{fog, smoke}}) {
    const Scene scene = several(paths);
    ASSERT_EQ(scene.media.size(), 2U);
    ASSERT_TRUE(scene.view.camera.medium);
    EXPECT_THAT(scene.media.at(*scene.view.camera.medium).name, testing::EndsWith("fog"))
        << paths[0];
  }
}

TEST(SeveralFiles, AScenesCameraAndLightsCountForAll) {
  const Scene scene =
      several({write_file("one.swc", neuron(0)), write_file("scene.pbrt", pbrt_with_camera)});
  EXPECT_FALSE(scene.automatic_camera);
  EXPECT_EQ(scene.view.film.width, 33);
  EXPECT_EQ(scene.view.camera.world_from_camera[3], glm::dvec4(0, 0, 9, 1));
  ASSERT_EQ(scene.lights.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<PointLight>(scene.lights[0].model));
}

// What a format asks for its thin branches does not depend on the order of files; what a scene says
// does not change.
TEST(SeveralFiles, AreDrawnAsTheMostDemandingOfThemAsks) {
  const fs::path neuron_file = write_file("one.swc", neuron(0)),
                 mesh = write_file("tri.off", triangle);
  for (const Paths& paths : {Paths{neuron_file, mesh}, Paths{mesh, neuron_file}}) {
    const Scene scene = several(paths);
    EXPECT_EQ(scene.view.film.least_width, 1.5) << paths[0];
    EXPECT_EQ(scene.view.sampler.noise, 0.05) << paths[0];
    EXPECT_EQ(scene.view.sampler.samples_per_pixel, 16384) << paths[0];
  }
  const Scene scene = several({neuron_file, write_file("scene.pbrt", pbrt_with_camera)});
  EXPECT_EQ(scene.view.film.least_width, 0);
  EXPECT_EQ(scene.view.sampler.noise, 0);
  EXPECT_EQ(scene.view.sampler.samples_per_pixel, 16);
}

// Everything that names something by its number names the same as before.
TEST(SeveralFiles, KeepWhatTheirThingsReferTo) {
  const fs::path path = write_file("scene.pbrt", pbrt_with_camera);
  const Scene alone = several({path});
  std::string open = pbrt_with_camera;  // the same, without the camera
  open = open.substr(open.find("WorldBegin"));
  const Scene scene = several({path, write_file("open.pbrt", open)});
  ASSERT_EQ(scene.shapes.size(), 2U);
  ASSERT_EQ(scene.textures.size(), 2 * alone.textures.size());
  const auto texture_of_alpha = [&](const Shape& shape) {
    return scene.textures.at(*shape.alpha->texture);
  };
  const Texture &first = texture_of_alpha(scene.shapes[0]),
                &second = texture_of_alpha(scene.shapes[1]);
  EXPECT_EQ(first.name, "both");
  EXPECT_EQ(second.name, "both");
  const std::uint32_t dots = *std::get<MixTexture>(second.model).tex1.texture;
  EXPECT_GE(dots, alone.textures.size());
  EXPECT_TRUE(std::holds_alternative<DotsTexture>(scene.textures.at(dots).model));
  const Material& mixed = scene.materials.at(scene.shapes[1].material);
  const auto& parts = std::get<MixMaterial>(mixed.model).materials;
  EXPECT_EQ(scene.materials.at(parts[0]).name, "red");
  EXPECT_EQ(scene.materials.at(parts[1]).name, "blue");
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(scene.instances[1].object, 1U);
  EXPECT_EQ(scene.objects[1].name, "open: thing");
  EXPECT_EQ(scene.materials.at(scene.objects[1].shapes[0].material).name, "blue");
}

TEST(SeveralFiles, BringOneCameraAtMost) {
  const fs::path one = write_file("scene.pbrt", pbrt_with_camera),
                 two = write_file("again.pbrt", pbrt_with_camera);
  EXPECT_THAT(
      complaint([&] {
        several({one, two});
      }),
      testing::AllOf(HasSubstr("again.pbrt: brings a camera"), HasSubstr("scene.pbrt does")));
}

// A camera that was framed to a scene by itself is framed again.
TEST(SeveralFiles, AnAutomaticCameraIsNone) {
  const std::string automatic =
      "LookAt 0 0 9  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 35 \"bool automatic\" "
      "true\nWorldBegin\n"
      "LightSource \"infinite\" \"string preset\" \"studio\"\nShape \"sphere\"\n";
  const Scene scene =
      several({write_file("automatic.pbrt", automatic), write_file("one.swc", neuron(20))});
  EXPECT_TRUE(scene.automatic_camera);
  EXPECT_NE(scene.view.camera.world_from_camera[3], glm::dvec4(0, 0, 9, 1));
  EXPECT_EQ(scene.lights.size(), 1U);
}

TEST(SeveralFiles, OptionsGoToThoseThatKnowThem) {
  const Paths paths{write_file("one.swc", neuron(0)), write_file("tri.off", triangle)};
  EXPECT_THAT(materials_of(several(paths, {{{"color", "order"}}})),
              ElementsAre("order 0", "default"));
  EXPECT_THAT(complaint([&] {
                several(paths, {{{"style", "sticks"}}});
              }),
              testing::AllOf(HasSubstr("--style"), HasSubstr("swc, off")));
}

TEST(SeveralFiles, OfFormatsThatAreNotReadSayWhatHelps) {
  using Row = std::pair<const char*, const char*>;
  for (const Row& row :
       {Row{"cell.nml", "caplet.from_neuroml"}, Row{"cell.nml", "as SWC"},
        Row{"cells.h5", "caplet.from_sonata"}, Row{"cells.h5", "caplet.from_morphio"},
        Row{"cells.h5", "as SWC"}, Row{"cell.asc", "caplet.from_morphio"},
        Row{"cell.asc", "as SWC"}, Row{"circuit_config.json", "caplet.from_sonata"}})
    EXPECT_THAT(complaint([&] { several({write_file(row.first, "x")}); }),
                testing::AllOf(HasSubstr("not read"), HasSubstr(row.second)));
}

// --- Colours of neurons ---

constexpr const char* tree =  // a soma, a dendrite that forks twice, and an axon
    "1 1 0 0 0 2 -1\n"
    "2 3 0 3 0 1 1\n"
    "3 3 0 6 0 1 2\n"     // fork
    "4 3 3 10 0 .5 3\n"   // 5 further
    "5 3 -3 10 0 .5 3\n"  // fork
    "6 3 -3 12 0 .5 5\n"
    "7 3 -6 10 0 .5 5\n"
    "8 2 0 -4 0 1 1\n"
    "9 2 0 -5 0 1 8\n";

ImportOptions color(const std::string& by) { return {{{"color", by}}}; }

TEST(SwcColors, OrdersCountForks) {
  EXPECT_THAT(branch_orders(parse_swc(tree, "tree")), ElementsAre(0, 0, 0, 1, 1, 2, 2, 0, 0));
}

TEST(SwcColors, DepthsAreWaysAlongTheBranches) {
  EXPECT_THAT(path_depths(parse_swc(tree, "tree")), ElementsAre(0, 3, 6, 11, 11, 13, 14, 4, 5));
}

// Children before their parents.
TEST(SwcColors, TheOrderOfLinesDoesNotMatter) {
  const auto samples = parse_swc("3 3 0 6 0 1 2\n2 3 0 3 0 1 1\n1 1 0 0 0 2 -1\n", "turned");
  EXPECT_THAT(path_depths(samples), ElementsAre(6, 3, 0));
}

/// The colour of the segment to the sample, by the number of the segment.
glm::dvec3 color_of_segment(const Scene& scene, std::size_t segment) {
  const std::uint32_t material = test::capsules_of(scene).materials.at(segment);
  return std::get<RgbSpectrum>(
             std::get<DiffuseMaterial>(scene.materials.at(material).model).reflectance)
      .rgb;
}

/// sRGB bytes of matplotlib's viridis, linear.
glm::dvec3 linear(int r, int g, int b) {
  const auto one = [](int byte) {
    const double v = byte / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  };
  return {one(r), one(g), one(b)};
}

TEST(SwcColors, GoAlongTheMap) {
  const Scene scene = several({write_file("tree.swc", tree)}, color("order"));
  EXPECT_THAT(materials_of(scene), ElementsAre("order 0", "order 1", "order 2"));
  EXPECT_LT(glm::length(color_of_segment(scene, 0) - linear(68, 1, 84)), 0.01);     // of sample 2
  EXPECT_LT(glm::length(color_of_segment(scene, 2) - linear(33, 145, 140)), 0.01);  // 4
  EXPECT_LT(glm::length(color_of_segment(scene, 4) - linear(253, 231, 37)), 0.01);  // 6
}

// One value is neither the least nor the greatest: the middle of the map, (33, 145, 140) of
// matplotlib's, but for half a step of 63.
TEST(SwcColors, OneValueHasTheMiddleOfTheMap) {
  const Paths bare{write_file("bare.swc", "1 1 0 0 0 2 -1\n2 3 0 3 0 1 1\n3 3 0 6 0 1 2\n")};
  const glm::dvec3 middle = linear(33, 145, 140);
  const Scene order = several(bare, color("order"));
  EXPECT_THAT(materials_of(order), ElementsAre("order 0"));
  EXPECT_LT(glm::length(color_of_segment(order, 0) - middle), 0.01);
  const Scene fives = several(bare, color(write_file("fives.txt", "5\n5\n5\n").string()));
  EXPECT_THAT(materials_of(fives), ElementsAre("fives.txt 5"));
  EXPECT_LT(glm::length(color_of_segment(fives, 1) - middle), 0.01);
}

TEST(SwcColors, OfFilesAreTheirs) {
  const Paths paths{write_file("one.swc", neuron(0)), write_file("two.swc", neuron(20))};
  const Scene scene = several(paths, color("file"));
  EXPECT_THAT(materials_of(scene), ElementsAre("one", "two"));
  EXPECT_EQ(color_of_segment(scene, 0), palette_color(0));
  EXPECT_EQ(
      std::get<RgbSpectrum>(std::get<DiffuseMaterial>(scene.materials[1].model).reflectance).rgb,
      palette_color(1));
}

TEST(SwcColors, OfValuesByOrderIdAndFile) {
  const Paths paths{write_file("tree.swc", tree)};
  const auto last = linear(253, 231, 37), first = linear(68, 1, 84);
  const fs::path by_order = write_file(
      "order.txt", "# potential (mV)\n# of a model\n0\n10\n# spiking\n0\n0\n0\n0\n0\n0\n0\n");
  Scene scene = several(paths, color(by_order.string()));
  EXPECT_LT(glm::length(color_of_segment(scene, 0) - last), 0.01);
  EXPECT_LT(glm::length(color_of_segment(scene, 1) - first), 0.01);
  EXPECT_THAT(materials_of(scene), testing::Contains("potential (mV) 10"));

  const fs::path by_id = write_file("id.csv", "9, 7\n2\t3\n");
  scene = several(paths, color(by_id.string()));
  EXPECT_LT(glm::length(color_of_segment(scene, 0) - first), 0.01);
  EXPECT_LT(glm::length(color_of_segment(scene, 7) - last), 0.01);
  EXPECT_THAT(materials_of(scene), testing::Contains("id.csv unknown"));

  const Paths two{write_file("one.swc", neuron(0)), write_file("two.swc", neuron(20))};
  for (const char* text : {"1\n5\n", "two 5\none 1\n"}) {
    scene = several(two, color(write_file("files.txt", text).string()));
    EXPECT_THAT(materials_of(scene), ElementsAre("files.txt 1", "files.txt 5")) << text;
  }
}

// One scale for all files, and that of --range where it is asked for.
TEST(SwcColors, HaveOneScale) {
  const Paths two{write_file("one.swc", neuron(0)),
                  write_file("two.swc", "1 1 50 0 0 2 -1\n2 3 50 12 0 1 1\n")};
  const Scene scene = several(two, color("depth"));  // to 6, and to 12
  EXPECT_LT(glm::length(color_of_segment(scene, 1) - linear(33, 145, 140)), 0.02);
  ASSERT_TRUE(scene.legend);
  EXPECT_EQ(scene.legend->low, 0);
  EXPECT_EQ(scene.legend->high, 12);
  EXPECT_LT(glm::length(scene.legend->colors.front() - linear(68, 1, 84)), 0.01);
  EXPECT_LT(glm::length(scene.legend->colors.back() - linear(253, 231, 37)), 0.01);
  ImportOptions options = color("depth");
  options.set("range", "0,3");
  const Scene asked = several(two, options);
  EXPECT_LT(glm::length(color_of_segment(asked, 1) - linear(253, 231, 37)), 0.01);
  ASSERT_TRUE(asked.legend);
  EXPECT_EQ(asked.legend->high, 3);
  EXPECT_EQ(scene.legend->title, "Path length from the soma");
  EXPECT_EQ(scene.legend->unit, "\u00b5m");
  const Scene order = several({write_file("tree.swc", tree)}, color("order"));
  EXPECT_EQ(order.legend.value().title, "Branch order");
  EXPECT_EQ(order.legend->unit, "");
}

// Names of several files are together in one legend, each once, with the material's colour.
TEST(SwcColors, HaveALegendOfNames) {
  const Paths two{write_file("one.swc", "1 1 0 0 0 2 -1\n2 2 3 0 0 1 1\n3 3 0 6 0 1 1\n"),
                  write_file("two.swc", "1 1 50 0 0 2 -1\n2 7 50 12 0 1 1\n3 3 50 0 9 1 1\n")};
  const Scene types = several(two, {});
  ASSERT_TRUE(types.legend);
  EXPECT_EQ(types.legend->title, "Type");
  EXPECT_THAT(types.legend->names,
              testing::ElementsAre("soma", "axon", "basal dendrite", "type 7"));
  ASSERT_EQ(types.legend->colors.size(), 4U);
  EXPECT_EQ(types.legend->colors[1], glm::dvec3(0.20, 0.62, 0.95));
  const Scene files = several(two, color("file"));
  ASSERT_TRUE(files.legend);
  EXPECT_EQ(files.legend->title, "File");
  EXPECT_THAT(files.legend->names, testing::ElementsAre("one", "two"));
  EXPECT_NE(files.legend->colors.at(0), files.legend->colors.at(1));
  EXPECT_TRUE(several({two[0]}, color("order")).legend->names.empty());
}

// A file without a unit leaves that of the other; two units are none.
TEST(SeveralFiles, HaveTheUnitOfThoseThatHaveOne) {
  const fs::path neuron_file = write_file("one.swc", neuron(0)),
                 mesh = write_file("two.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
                 molecule = write_file("three.xyz", "1\n\nC 0 0 0\n");
  EXPECT_EQ(several({neuron_file, mesh}, {}).unit, "\u00b5m");
  EXPECT_EQ(several({mesh, neuron_file}, {}).unit, "\u00b5m");
  EXPECT_EQ(several({neuron_file, molecule}, {}).unit, "");
  EXPECT_EQ(several({mesh, molecule, mesh, neuron_file}, {}).unit, "");
}

TEST(SwcColors, OfAFileForEachNeuron) {
  const fs::path folder = write_file("one.values", "0\n0\n4\n").parent_path();
  std::ofstream(folder / "two.values") << "0\n8\n8\n";
  const Paths two{write_file("one.swc", neuron(0)), write_file("two.swc", neuron(20))};
  const Scene scene = several(two, color((folder / "{}.values").string()));
  EXPECT_LT(glm::length(color_of_segment(scene, 1) - linear(33, 145, 140)), 0.02);  // 4 of 8
}

TEST(SwcColors, SayWhatIsWrong) {
  const Paths paths{write_file("tree.swc", tree)};
  const auto said = [&](const ImportOptions& options) {
    return complaint([&] { several(paths, options); });
  };
  const auto of_text = [&](const std::string& text) {
    return said(color(write_file("values.txt", text).string()));
  };
  EXPECT_THAT(said(color("chain")),
              testing::AllOf(HasSubstr("--color"), HasSubstr("type, file, order and depth")));
  EXPECT_THAT(of_text("1\n2\n"), HasSubstr("2 values: tree.swc has 9 samples"));
  EXPECT_THAT(of_text("1\nx\n"), HasSubstr("values.txt:2:1: 'x' is not a number"));
  EXPECT_THAT(of_text("1 1\n 2  y\n"), HasSubstr("'y' is not a number"));
  EXPECT_THAT(of_text("1 1\n77 1\n"), HasSubstr("values.txt:2:1: '77' is no sample"));
  EXPECT_THAT(of_text("1 1\n1 2\n"), HasSubstr("values.txt:2:1: '1' has a value already"));
  EXPECT_THAT(of_text("1 1\n2\n"), HasSubstr("mixed"));
  EXPECT_THAT(of_text("wood 1\n"), HasSubstr("no line for 'tree'"));
  EXPECT_THAT(of_text("# nothing\n"), HasSubstr("holds no values"));
  EXPECT_THAT(of_text("1 nan\n"), HasSubstr("there is no value for tree.swc"));
  for (const char* range : {"1", "1,1", "2,1", "a,b", "0,inf", "0,1,2"}) {
    ImportOptions options = color("depth");
    options.set("range", range);
    EXPECT_THAT(said(options), testing::AllOf(HasSubstr("--range"), HasSubstr("LOW,HIGH")))
        << range;
  }
  ImportOptions options;
  options.set("range", "0,1");
  EXPECT_THAT(said(options), HasSubstr("goes with --color"));
}

}  // namespace
}  // namespace caplet
