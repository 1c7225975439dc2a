// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Names that are no UTF-8, of files and in them: all JSON is JSON, and EXR headers are UTF-8.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/utf8.h"
#include "film/image.h"
#include "program.h"
#include "support/data.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Result;
using testing::HasSubstr;

constexpr const char* name = "K\xfcgel.pbrt";

fs::path folder_with_names() {
  const fs::path folder = test::temporary_folder();
  std::string text = test::small_scene;
  text.insert(text.find("Shape"),
              "MakeNamedMaterial \"m\x80\" \"string type\" \"diffuse\"\nNamedMaterial \"m\x80\"\n");
  text.insert(text.size() - 1, " \"string name\" \"\xed\xa0\x80\"");
  test::write_file(folder / name, text);
  return folder;
}

TEST(Names, AreUtf8InAllJson) {
  const fs::path folder = folder_with_names();
  const json info = json::parse(test::run_program({"info", name, "--json"}, folder).out);
  EXPECT_EQ(info.at("scene"), "K\xef\xbf\xbdgel.pbrt");
  const json pick = json::parse(
      test::run_program({"pick", name, "-q", "--json", "--all", "--reference", "--pixel", "12,8"},
                        folder)
          .out);
  EXPECT_EQ(pick.at("scene"), "K\xef\xbf\xbdgel.pbrt");
  for (const char* list : {"crossings", "reference"}) {
    ASSERT_FALSE(pick.at(list).empty());
    EXPECT_EQ(pick.at(list).at(0).at("object"), "\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd");
    EXPECT_EQ(pick.at(list).at(0).at("material"), "m\xef\xbf\xbd");
  }
  const Result verified =
      test::run_program({"verify", name, "-q", "--json", "--rays", "1000"}, folder);
  EXPECT_EQ(verified.code, 0) << verified.err;
  EXPECT_THAT(json::parse(verified.out).dump(), HasSubstr("K\xef\xbf\xbdgel"));
}

TEST(Names, AreUtf8InPicturesAndStatistics) {
  const fs::path folder = folder_with_names();
  const Result result = test::run_program(
      {"render", name, "-q", "-o", "out\xff.exr", "--stats", "stats.json"}, folder);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_TRUE(json::parse(test::read_file(folder / "stats.json")).contains("device"));
  const LayeredImage image = read_exr(folder / "out\xff.exr");
  EXPECT_EQ(image.metadata.at("caplet.scene"), "K\xef\xbf\xbdgel.pbrt");
  EXPECT_THAT(image.metadata.at("caplet.command"), HasSubstr("out\xef\xbf\xbd.exr"));
  for (const auto& [key, value] : image.metadata) EXPECT_EQ(valid_utf8(value), value) << key;
  const Result missing = test::run_program({"info", "\x1b[2J\xff.pbrt"}, folder);
  EXPECT_EQ(missing.err, "caplet: error:  [2J\xef\xbf\xbd.pbrt: no such file\n");
}

}  // namespace
}  // namespace caplet
