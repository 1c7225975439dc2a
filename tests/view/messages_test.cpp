// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/messages.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace caplet::view {
namespace {

std::string look(const std::string& name, const std::string& value) {
  std::string out =
      R"({"type":"look","width":640,"height":480,"world_from_camera":[1,2,3,4,5,6,7,8,9,10,11,12,0,0,0,1],)"
      R"("fov":0.5,"lens_radius":0.25,"focal_distance":3)";
  return out + (name.empty() ? "" : fmt::format(R"(,"{}":{})", name, value)) +
         "}";  // of two fields of a name the last one counts
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_message(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Messages, SayHowOneLooks) {
  const ShowView said = std::get<ShowView>(parse_message(look("", "")));
  EXPECT_EQ(said.width, 640);
  EXPECT_EQ(said.height, 480);
  EXPECT_EQ(said.fov, 0.5);
  EXPECT_EQ(said.lens_radius, 0.25);
  EXPECT_EQ(said.focal_distance, 3);
  EXPECT_EQ(said.world_from_camera[3], glm::dvec4(4, 8, 12, 1));  // columns
  EXPECT_EQ(said.world_from_camera[0], glm::dvec4(1, 5, 9, 0));
}

TEST(Messages, AskAndSee) {
  const Ask asked = std::get<Ask>(
      parse_message(R"({"type":"ask","number":17,"x":3,"y":4,"all":true,"reference":false})"));
  EXPECT_EQ(asked.number, 17);
  EXPECT_EQ(asked.x, 3);
  EXPECT_EQ(asked.y, 4);
  EXPECT_TRUE(asked.all);
  EXPECT_FALSE(asked.reference);
  EXPECT_FALSE(std::get<Seen>(parse_message(R"({"type":"seen","seen":false})")).seen);
  EXPECT_TRUE(std::holds_alternative<Snapshot>(parse_message(R"({"type":"snapshot"})")));
}

TEST(Messages, NameTheFieldThatIsWrong) {
  for (const auto& [name, value] : {std::pair("width", "0"),
                                    {"width", "4097"},
                                    {"width", "1.5"},
                                    {"width", "\"a\""},
                                    {"height", "-1"},
                                    {"height", "1e400"},
                                    {"fov", "0"},
                                    {"fov", "3.2"},
                                    {"fov", "null"},
                                    {"lens_radius", "-1"},
                                    {"focal_distance", "0"},
                                    {"world_from_camera", "[1,2]"},
                                    {"world_from_camera", "3"}})
    EXPECT_NE(refusal(look(name, value)), "") << name << value;
  EXPECT_NE(refusal(look("world_from_camera", "[1,2,3,4,5,6,7,8,9,10,11,1e13,0,0,0,1]"))
                .find("world_from_camera[11]"),
            std::string::npos);
  EXPECT_NE(refusal(look("fov", "true")).find("fov"), std::string::npos);
  EXPECT_NE(
      refusal(R"({"type":"ask","number":1,"x":0,"y":0,"all":1,"reference":false})").find("all"),
      std::string::npos);
  EXPECT_NE(refusal(R"({"type":"seen"})").find("seen: is missing"), std::string::npos);
}

TEST(Messages, AreRefusedWhateverTheyAre) {
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("3"), std::string("{}"),
        std::string(R"({"type":"other"})"), std::string(R"({"type":["look"]})"),
        std::string("\xff\xfe{}"), std::string(30000, '['), R"({"type":)" + std::string(30000, '{'),
        std::string("{\"type\":\"look\"}\0x", 18)})
    EXPECT_NE(refusal(text), "") << text.substr(0, 40);
}

}  // namespace
}  // namespace caplet::view
