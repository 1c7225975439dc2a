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

TEST(Messages, CutAway) {
  EXPECT_FALSE(std::get<ShowView>(parse_message(look("clip", "null"))).clip);
  const auto clip =
      std::get<ShowView>(parse_message(look("clip", R"({"normal":[0,-2,0],"offset":3.5})"))).clip;
  ASSERT_TRUE(clip);
  EXPECT_EQ(clip->normal, glm::dvec3(0, -1, 0));
  EXPECT_EQ(clip->offset, 3.5);
  EXPECT_EQ(refusal(look("clip", "7")), "clip: is no object");
  EXPECT_EQ(refusal(look("clip", R"({"normal":[0,0,0],"offset":1})")), "normal: has no direction");
  EXPECT_EQ(refusal(look("clip", R"({"normal":[0,0,1]})")), "offset: is missing");
}

TEST(Messages, DrawFilesAnew) {
  const Message said = parse_message(
      R"({"type":"edit","what":"redraw","options":{"style":"cartoon","show":""},"goes_on":false})");
  const auto& redraw = std::get<Redraw>(std::get<Edit>(said).change);
  EXPECT_EQ(redraw.options, (FileOptions{{"show", ""}, {"style", "cartoon"}}));
  EXPECT_EQ(refusal(R"({"type":"edit","what":"redraw","options":[],"goes_on":false})"),
            "options: is no object of at most 64 texts");
  EXPECT_EQ(refusal(R"({"type":"edit","what":"redraw","options":{"style":1},"goes_on":false})"),
            "style: is no text");
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

std::string figure(const std::string& rest) {
  std::string out = look("separation", "1");
  out.replace(out.find("look"), 4, "figure");
  out.back() = ',';
  return out + R"("number":5,"denoise":true)" + rest + "}";
}

TEST(Messages, AskForFigures) {
  const MakeFigure asked = std::get<MakeFigure>(parse_message(
      figure(R"(,"samples":32,"background":"white","drawn":{"axes":"","scale-bar":"5 um"})")));
  EXPECT_EQ(asked.number, 5);
  EXPECT_EQ(asked.look.width, 640);
  EXPECT_EQ(asked.look.separation, 0);
  EXPECT_EQ(asked.samples, 32);
  EXPECT_TRUE(asked.denoise);
  EXPECT_EQ(asked.background, "white");
  EXPECT_EQ(asked.drawn, (std::vector<std::pair<std::string, std::string>>{{"axes", ""},
                                                                           {"scale-bar", "5 um"}}));
  EXPECT_EQ(
      std::get<MakeFigure>(parse_message(figure(R"(,"samples":1,"background":null,"drawn":{})")))
          .background,
      std::nullopt);
  EXPECT_TRUE(std::holds_alternative<EndFigure>(parse_message(R"({"type":"end_figure"})")));
  std::string many;
  for (int i = 0; i < 17; ++i) many += fmt::format(R"({}"{}":"")", i ? "," : "", i);
  for (const auto& [rest, field] :
       {std::pair<std::string, std::string>(R"("samples":0,"background":null,"drawn":{})",
                                            "samples"),
        {R"("samples":16385,"background":null,"drawn":{})", "samples"},
        {R"("samples":1,"background":5,"drawn":{})", "background"},
        {fmt::format(R"("samples":1,"background":"{:x>101}","drawn":{{}})", ""), "background"},
        {R"("samples":1,"background":null,"drawn":[])", "drawn"},
        {R"("samples":1,"background":null,"drawn":{"axes":true})", "axes"},
        {fmt::format(R"("samples":1,"background":null,"drawn":{{{}}})", many), "drawn"},
        {R"("samples":1,"drawn":{})", "background"}})
    EXPECT_EQ(refusal(figure("," + rest)).substr(0, field.size() + 1), field + ":") << rest;
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
