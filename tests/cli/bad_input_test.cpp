// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Wrong input and usage, one row each: exit code 2, one clear line with its place, nothing written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

using test::Result;
using testing::HasSubstr;

// Four lines; a fault on the next has line 5.
const std::string head =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\"\nFilm \"rgb\" \"integer xresolution\" 8 "
    "\"integer yresolution\" 8\n"
    "WorldBegin\n";
const std::string capsule =
    "Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 1 0] \"float radius\" 0.5\n";
const std::string garbage("\x7f\x45\x4c\x46\x00\x01\xff\xfe\x00\x00\x80\x81\x00\x13\x37\x00", 16);

struct BadInput {
  std::string name;
  std::vector<std::string> arguments;  // after the program's name
  std::string place;                   // how the message starts
  std::string mentions;                // somewhere after it, letter case ignored
  std::vector<std::pair<std::string, std::string>> files = {};
  std::map<std::string, std::string> environment = {};
};
void PrintTo(const BadInput& input, std::ostream* out) { *out << input.name; }

/// A scene text that is wrong.
BadInput scene(const std::string& name, const std::string& text, const std::string& place,
               const std::string& mentions,
               std::vector<std::pair<std::string, std::string>> more = {}) {
  more.emplace_back("scene.pbrt", text);
  return {name, {"render", "scene.pbrt", "-o", "out.exr"}, place, mentions, more};
}

/// An option that is wrong, the scene being right.
BadInput option(const std::string& name, std::vector<std::string> arguments,
                const std::string& place, const std::string& mentions) {
  arguments.insert(arguments.begin(), {"render", "scene.pbrt"});
  return {name, std::move(arguments), place, mentions, {{"scene.pbrt", head + capsule}}};
}

/// `pick` with arguments that are wrong, the scene being right.
BadInput pick(const std::string& name, std::vector<std::string> arguments, const std::string& place,
              const std::string& mentions,
              std::vector<std::pair<std::string, std::string>> files = {}) {
  arguments.insert(arguments.begin(), {"pick", "scene.pbrt"});
  files.emplace_back("scene.pbrt", head + capsule);
  return {name, std::move(arguments), place, mentions, files};
}

/// A list of rays that is wrong.
BadInput rays(const std::string& name, const std::string& path, const std::string& text,
              const std::string& place, const std::string& mentions) {
  return pick(name, {"--rays", path, "--out", "out.csv"}, place, mentions, {{path, text}});
}

BadInput file(const std::string& name, const std::string& path, const std::string& text,
              const std::string& place, const std::string& mentions) {
  return {name, {"render", path, "-o", "out.exr"}, place, mentions, {{path, text}}};
}

std::vector<BadInput> bad_inputs() {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\n";
  std::vector<BadInput> rows{
      // Scene files.
      {"missing_file", {"render", "none.pbrt", "-o", "out.exr"}, "none.pbrt", ""},
      {"scene_is_a_folder", {"render", ".", "-o", "out.exr"}, ".", ""},
      file("unknown_extension", "scene.xyz", "hello", "scene.xyz", ".xyz"),
      file("empty_file", "scene.pbrt", "", "scene.pbrt", ""),
      file("binary_pbrt", "scene.pbrt", garbage, "scene.pbrt:1:", ""),
      file("binary_swc", "cell.swc", garbage, "cell.swc", ""),
      file("binary_capsules", "axon.capsules", garbage, "axon.capsules", ""),
      file("swc_parent_missing", "cell.swc", "1 1 0 0 0 1 -1\n2 3 0 5 0 1 77\n", "cell.swc:2",
           "77"),
      file("swc_word", "cell.swc", "1 1 0 0 0 1 -1\n2 3 zero 5 0 1 1\n", "cell.swc:2", ""),
      file("capsules_unclosed", "axon.capsules", "<0, 0, 0> <1, 0, 0> 0.5\n<0, 0, 0> <1, 0 0.5\n",
           "axon.capsules:2", ""),
      file("capsules_negative_radius", "axon.capsules", "<0, 0, 0> <1, 0, 0> -0.5\n",
           "axon.capsules:1", "radius"),
      // Directives and parameters.
      scene("unknown_directive", head + "Shapes \"sphere\"\n" + capsule, "scene.pbrt:5:1",
            "Shapes"),
      scene("unknown_shape", head + "Shape \"potato\"\n" + capsule, "scene.pbrt:5:", "potato"),
      scene("unknown_active_transform", head + "ActiveTransform EndTim\n" + capsule,
            "scene.pbrt:5:17", "EndTime"),
      scene("motion_into_the_mirror", head + "ActiveTransform EndTime\nScale 1 -1 1\n" + capsule,
            "scene.pbrt:7:", "mirror"),
      scene(
          "cylinder_without_axis",
          head +
              "Shape \"cylinder\" \"point3 p0\" [1 2 3] \"point3 p1\" [1 2 3] \"float radius\" 1\n",
          "scene.pbrt:5:", "axis"),
      scene("polyhedron_without_bounds",
            head + "Shape \"polyhedron\" \"point3 P\" [0 0 0 0 0 1] \"normal N\" [0 0 -1 0 0 1]\n",
            "scene.pbrt:5:1", "bounds"),
      scene("materials_miscounted",
            head + "Shape \"box\" \"point3 p0\" [0 0 0] \"point3 p1\" [1 1 1] \"string materials\" "
                   "[\"a\"]\n",
            "scene.pbrt:5:", "materials"),
      scene("csg_of_an_open_surface",
            head + "ObjectBegin \"a\"\n" + capsule +
                "ObjectEnd\nObjectBegin \"b\"\nShape \"disk\"\nObjectEnd\n" +
                "Shape \"csg\" \"string operation\" \"union\" \"string operands\" [\"a\" \"b\"]\n",
            "scene.pbrt:11:", "open"),
      scene("csg_of_itself",
            head + "ObjectBegin \"a\"\nShape \"csg\" \"string operation\" \"union\" \"string "
                   "operands\" [\"a\" \"a\"]\nObjectEnd\n",
            "scene.pbrt:6:", "itself"),
      scene("sphere_too_large", head + "Shape \"sphere\" \"float radius\" 1e30\n",
            "scene.pbrt:5:", "large"),
      scene("unknown_parameter", head + "Shape \"sphere\" \"float radios\" 1\n",
            "scene.pbrt:5:", "radios"),
      scene("unknown_material", head + "Material \"velvet\"\n" + capsule,
            "scene.pbrt:5:", "velvet"),
      scene("undefined_named_material", head + "NamedMaterial \"gold\"\n" + capsule,
            "scene.pbrt:5:", "gold"),
      scene("undefined_texture",
            head + "Material \"diffuse\" \"texture reflectance\" \"wood\"\n" + capsule,
            "scene.pbrt:5:", "wood"),
      scene("wrong_type", head + "Shape \"sphere\" \"string radius\" \"big\"\n",
            "scene.pbrt:5:", "radius"),
      scene(
          "wrong_count",
          head +
              "Shape \"capsule\" \"point3 p0\" [0 0] \"point3 p1\" [0 1 0] \"float radius\" 0.5\n",
          "scene.pbrt:5:", "p0"),
      scene("not_a_number", head + "Shape \"sphere\" \"float radius\" nan\n", "scene.pbrt:5:", ""),
      scene("number_out_of_range", head + "Shape \"sphere\" \"float radius\" 1e999\n",
            "scene.pbrt:5:", ""),
      scene("negative_radius", head + "Shape \"sphere\" \"float radius\" -1\n",
            "scene.pbrt:5:", "radius"),
      scene("singular_transform", head + "Scale 1 0 1\n" + capsule, "scene.pbrt:", ""),
      scene("missing_parameter",
            head + "Shape \"capsule\" \"point3 p0\" [0 0 0] \"float radius\" 1\n",
            "scene.pbrt:5:", "p1"),
      scene("absurd_film",
            "Film \"rgb\" \"integer xresolution\" 1000000 \"integer yresolution\" "
            "1000000\nWorldBegin\n" +
                capsule,
            "scene.pbrt", ""),
      // Blocks and files.
      scene("unclosed_block", head + "AttributeBegin\n" + capsule, "scene.pbrt:", "AttributeBegin"),
      scene("unmatched_end", head + "AttributeEnd\n" + capsule, "scene.pbrt:5:", "AttributeEnd"),
      scene("unclosed_string", head + "Shape \"capsule\n" + capsule, "scene.pbrt:5:", ""),
      scene("unclosed_list", head + "Shape \"sphere\" \"float radius\" [ 1\n", "scene.pbrt:", ""),
      scene("recursive_include", head + "Include \"scene.pbrt\"\n" + capsule,
            "scene.pbrt:", "nclude"),
      scene("missing_include", head + "Include \"none.pbrt\"\n" + capsule,
            "scene.pbrt:5:", "none.pbrt"),
      scene("missing_texture",
            head + "LightSource \"infinite\" \"string filename\" \"none.exr\"\n" + capsule, "",
            "none.exr"),
      scene("broken_texture",
            head + "LightSource \"infinite\" \"string filename\" \"sky.exr\"\n" + capsule, "",
            "sky.exr", {{"sky.exr", garbage}}),
      // Options.
      option("size_zero", {"-o", "out.exr", "--size", "0x0"}, "--size", "0x0"),
      option("size_negative", {"-o", "out.exr", "--size=-4x4"}, "--size", "-4x4"),
      option("size_absurd", {"-o", "out.exr", "--size", "100000x100000"}, "--size", "2^28"),
      option("size_overflow", {"-o", "out.exr", "--size", "99999999999999999999x1"}, "--size",
             "99999999999999999999x1"),
      option("size_malformed", {"-o", "out.exr", "--size", "960"}, "--size", "960x540"),
      option("crop_outside", {"-o", "out.exr", "--crop", "0,0,9,8"}, "--crop", "8x8"),
      option("crop_empty", {"-o", "out.exr", "--crop", "4,4,4,8"}, "--crop", "empty"),
      option("crop_malformed", {"-o", "out.exr", "--crop", "1,2,3"}, "--crop", "x0,y0,x1,y1"),
      option("spp_zero", {"-o", "out.exr", "--spp", "0"}, "--spp", "0"),
      option("spp_word", {"-o", "out.exr", "--spp", "many"}, "", "many"),
      option("seed_negative", {"-o", "out.exr", "--seed=-1"}, "", "--seed"),
      option("time_negative", {"-o", "out.exr", "--time=-1"}, "--time", "-1"),
      option("time_nan", {"-o", "out.exr", "--time", "nan"}, "--time", "nan"),
      option("max_depth_negative", {"-o", "out.exr", "--max-depth=-1"}, "--max-depth", "-1"),
      option("unknown_option", {"-o", "out.exr", "--fast"}, "", "--fast"),
      option("output_of_no_format", {"-o", "out.dwg"}, "-o", ".dwg"),
      option("output_folder_missing", {"-o", "nowhere/out.exr"}, "-o", "nowhere"),
      option("preview_unknown_format", {"-o", "out.exr", "--preview", "out.xyz"}, "--preview", ""),
      option("preview_folder_missing", {"-o", "out.exr", "--preview", "nowhere/out.png"},
             "--preview", ""),
      option("stats_folder_missing", {"-o", "out.exr", "--stats", "nowhere/stats.json"}, "--stats",
             "nowhere"),
      option("device_unknown", {"-o", "out.exr", "--device", "abacus"}, "--device", "abacus"),
      option("device_out_of_range", {"-o", "out.exr", "--device", "9999"}, "--device", "9999"),
      // Picking.
      pick("pick_nothing", {}, "pick needs one of", "--rays"),
      pick("pick_two_things", {"--pixel", "1,1", "--ray", "0,0,5,0,0,-1"}, "pick needs one of",
           "--ray"),
      pick("pixel_outside", {"--pixel", "8,0"}, "--pixel", "8x8"),
      pick("pixel_outside_of_the_size", {"--pixel", "4,4", "--size", "4x4"}, "--pixel", "4x4"),
      pick("pixel_outside_of_the_crop", {"--pixel", "4,4", "--crop", "0,0,4,8"}, "--pixel",
           "crop 0,0,4,8"),
      pick("pixel_negative", {"--pixel=-1,0"}, "--pixel", "-1,0"),
      pick("pixel_malformed", {"--pixel", "4"}, "--pixel", "X,Y"),
      pick("pixel_fraction", {"--pixel", "4.5,4"}, "--pixel", "X,Y"),
      pick("pixel_overflow", {"--pixel", "99999999999999999999,1"}, "--pixel", "X,Y"),
      pick("ray_short", {"--ray", "0,0,5,0,0"}, "--ray", "ox,oy,oz,dx,dy,dz"),
      pick("ray_long", {"--ray", "0,0,5,0,0,-1,0"}, "--ray", "six"),
      pick("ray_word", {"--ray", "0,0,5,0,down,-1"}, "--ray", "'down'"),
      pick("ray_gap", {"--ray", "0,0,5,,0,-1"}, "--ray", "''"),
      pick("ray_nan", {"--ray", "0,0,nan,0,0,-1"}, "--ray", "finite"),
      pick("ray_infinite", {"--ray", "0,0,5,0,0,-inf"}, "--ray", "finite"),
      pick("ray_huge", {"--ray", "0,0,1e300,0,0,-1"}, "--ray", "range"),
      pick("ray_without_direction", {"--ray", "0,0,5,0,0,0"}, "--ray", "direction"),
      pick("pick_limit_zero", {"--pixel", "1,1", "--all", "--limit", "0"}, "--limit", "0"),
      pick("pick_limit_absurd", {"--pixel", "1,1", "--all", "--limit", "99999999"}, "--limit",
           "99999999"),
      pick("pick_limit_alone", {"--pixel", "1,1", "--limit", "9"}, "--limit", "--all"),
      pick("pick_crop_without_pixel", {"--ray", "0,0,5,0,0,-1", "--crop", "0,0,4,4"}, "--crop",
           "--pixel"),
      pick("pick_size_without_pixel", {"--ray", "0,0,5,0,0,-1", "--size", "4x4"}, "--size",
           "--pixel"),
      pick("pick_out_without_rays", {"--pixel", "1,1", "--out", "out.csv"}, "--out", "--rays"),
      pick("pick_device_unknown", {"--pixel", "1,1", "--device", "abacus"}, "--device", "abacus"),
      pick("rays_without_out", {"--rays", "rays.txt"}, "--rays", "--out",
           {{"rays.txt", "0 0 5 0 0 -1\n"}}),
      pick("rays_with_json", {"--rays", "rays.txt", "--out", "out.csv", "--json"}, "--json",
           "--rays", {{"rays.txt", "0 0 5 0 0 -1\n"}}),
      pick("rays_with_reference", {"--rays", "rays.txt", "--out", "out.csv", "--reference"},
           "--reference", "--rays", {{"rays.txt", "0 0 5 0 0 -1\n"}}),
      pick("rays_out_unknown", {"--rays", "rays.txt", "--out", "out.xls"}, "--out", ".npy",
           {{"rays.txt", "0 0 5 0 0 -1\n"}}),
      pick("rays_out_folder_missing", {"--rays", "rays.txt", "--out", "nowhere/out.csv"}, "--out",
           "nowhere", {{"rays.txt", "0 0 5 0 0 -1\n"}}),
      pick("rays_missing", {"--rays", "none.txt", "--out", "out.csv"}, "none.txt", "no such file"),
      pick("rays_missing_npy", {"--rays", "none.npy", "--out", "out.csv"}, "none.npy",
           "no such file"),
      pick("rays_folder", {"--rays", ".", "--out", "out.csv"}, ".", "folder"),
      rays("rays_word", "rays.txt", "0 0 5 0 0 -1\n0 0 5 0 x -1\n", "rays.txt:2:9", "'x'"),
      rays("rays_five", "rays.txt", "# two rays\n0 0 5 0 0\n", "rays.txt:2:10", "six"),
      rays("rays_nan", "rays.txt", "0 0 5 0 0 nan\n", "rays.txt:1:11", "finite"),
      rays("rays_without_direction", "rays.txt", "0 0 5 0 0 -1\n0 0 5  0 0 0\n", "rays.txt:2:8",
           "direction"),
      rays("rays_garbage", "rays.txt", garbage, "rays.txt:1:1", "not a number"),
      rays("rays_no_npy", "rays.npy", garbage, "rays.npy", ".npy"),
      {"pick_missing_scene", {"pick", "none.pbrt", "--pixel", "1,1"}, "none.pbrt", ""},
      {"no_scene", {"render"}, "", "SCENE"},
      {"no_command", {}, "", "subcommand"},
      {"unknown_command", {"rendr"}, "", "rendr"},
      {"info_missing_file", {"info", "none.swc"}, "none.swc", ""},
  };
  // Found when other rays have been answered: nothing is left behind all the same.
  std::string many;
  for (int i = 0; i < 300'000; ++i) many += "0 0 5 0 0 -1\n";
  rows.push_back(rays("rays_wrong_at_the_end", "rays.txt", many + "0 0 5 0 0 zero\n",
                      "rays.txt:300001:11", "'zero'"));
  const std::string mesh = "Shape \"plymesh\" \"string filename\" \"mesh.ply\"\n";
  rows.push_back(scene("ply_missing", head + mesh, "", "mesh.ply"));
  rows.push_back(scene(
      "ply_truncated", head + mesh, "", "mesh.ply",
      {{"mesh.ply",
        ply + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0"}}));
#ifdef CAPLET_WITH_OIIO
  rows.push_back(scene(
      "broken_png", head + "LightSource \"infinite\" \"string filename\" \"sky.png\"\n" + capsule,
      "", "sky.png", {{"sky.png", garbage}}));
#endif
  return rows;
}

class BadInputs : public testing::TestWithParam<BadInput> {};
INSTANTIATE_TEST_SUITE_P(All, BadInputs, testing::ValuesIn(bad_inputs()),
                         [](const auto& row) { return row.param.name; });

bool contains_ignoring_case(const std::string& text, const std::string& part) {
  const auto same = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

TEST_P(BadInputs, AreRefusedInOneLine) {
  const BadInput& input = GetParam();
  const auto folder = test::temporary_folder();
  for (const auto& [name, text] : input.files) test::write_file(folder / name, text);
  const auto before = test::names_in(folder);
  const Result result = test::run_program(input.arguments, folder, input.environment);

  EXPECT_EQ(result.code, 2) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(test::names_in(folder), before) << "something was written";
  const std::string start = "caplet: error: ";
  int errors = 0;
  for (const std::string& line : test::lines_of(result.err)) {
    EXPECT_THAT(line, testing::StartsWith("caplet: "));
    if (!line.starts_with(start)) continue;
    ++errors;
    const std::string message = line.substr(start.size());
    EXPECT_THAT(message, testing::StartsWith(input.place));
    EXPECT_TRUE(contains_ignoring_case(message, input.mentions))
        << message << "\nlacks: " << input.mentions;
    EXPECT_GT(message.size(), input.place.size() + 8) << "says too little: " << message;
  }
  EXPECT_EQ(errors, 1) << result.err;
}

TEST(BadInputs, SeveralErrorsAreReportedAtOnce) {
  const auto folder = test::temporary_folder();
  test::write_file(
      folder / "scene.pbrt",
      head + "Shape \"sphere\" \"float radios\" 1\nShape \"sphere\" \"float radias\" 1\n");
  const Result result = test::run_program({"info", "scene.pbrt"}, folder);
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("scene.pbrt:5:"));
  EXPECT_THAT(result.err, HasSubstr("scene.pbrt:6:"));
}

}  // namespace
}  // namespace caplet
