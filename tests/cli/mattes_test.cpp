// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `render --cryptomatte` and `--deep`, and `merge` with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "film/image.h"
#include "pictures.h"
#include "program.h"
#include "support/deep_exr.h"

namespace caplet::mattes_test {
namespace {

namespace fs = std::filesystem;
using test::folder_with_scene;
using test::render;
using test::Result;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A red ball before a plane without a name.
constexpr const char* scene =
    "LookAt 0 0 5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\n"
    "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 16\n"
    "Sampler \"independent\" \"integer pixelsamples\" 8\nWorldBegin\nLightSource \"infinite\"\n"
    "MakeNamedMaterial \"red paint\" \"string type\" \"diffuse\"\nNamedMaterial \"red paint\"\n"
    "Shape \"sphere\" \"float radius\" 0.6 \"string name\" \"a \\\"ball\\\"\"\n"
    "Material \"conductor\"\nTranslate 0 0 -3\nShape \"disk\" \"float radius\" 1.3\n";

void expect_done(const Result& result) { ASSERT_EQ(result.code, 0) << result.err; }

std::vector<std::string> channels_of(const LayeredImage& image) {
  std::vector<std::string> out;
  for (const Channel& channel : image.channels) out.push_back(channel.name);
  return out;
}

/// The hashes of the things of the first rank.
std::set<std::uint32_t> first_of(const LayeredImage& image, const std::string& matte) {
  std::set<std::uint32_t> out;
  const Channel* id = image.find(matte + "00.R");
  const Channel* coverage = image.find(matte + "00.G");
  for (std::size_t i = 0; i < id->floats.size(); ++i)
    if (coverage->floats[i] > 0) out.insert(std::bit_cast<std::uint32_t>(id->floats[i]));
  return out;
}

TEST(Mattes, HaveTheNamesOfWhatIsInThem) {
  const fs::path folder = folder_with_scene(scene);
  expect_done(render(folder, {"--cryptomatte", "-o", "out.exr"}));
  const LayeredImage image = read_exr(folder / "out.exr");
  int mattes = 0;
  for (const auto& [key, matte] : image.metadata) {
    if (!key.starts_with("cryptomatte/") || !key.ends_with("/name")) continue;
    ++mattes;
    const std::string prefix = key.substr(0, key.size() - 4);
    EXPECT_EQ(prefix.size(), std::string("cryptomatte/1234567/").size());
    EXPECT_EQ(image.metadata.at(prefix + "hash"), "MurmurHash3_32");
    EXPECT_EQ(image.metadata.at(prefix + "conversion"), "uint32_to_float32");
    const auto manifest = nlohmann::json::parse(image.metadata.at(prefix + "manifest"));
    std::set<std::string> names;
    std::set<std::uint32_t> hashes;
    for (const auto& [name, hash] : manifest.items()) {
      names.insert(name);
      hashes.insert(static_cast<std::uint32_t>(std::stoul(hash.get<std::string>(), nullptr, 16)));
    }
    if (matte == "CryptoObject") {
      EXPECT_THAT(names, ElementsAre("a \"ball\"", "disk 1"));
    }
    if (matte == "CryptoMaterial") {
      EXPECT_THAT(names, Contains("red paint"));
    }
    if (matte == "CryptoAsset") {
      EXPECT_THAT(names, ElementsAre("scene"));
    }
    for (const std::uint32_t hash : first_of(image, matte)) EXPECT_THAT(hashes, Contains(hash));
    EXPECT_EQ(first_of(image, matte).size(), matte == "CryptoAsset" ? 1u : 2u) << matte;
  }
  EXPECT_EQ(mattes, 3);
}

TEST(Mattes, AreThoseOfTheLayers) {
  const fs::path folder = folder_with_scene(scene);
  expect_done(
      render(folder, {"--layers", "crypto_material", "--matte-levels", "3", "-o", "a.exr"}));
  const LayeredImage image = read_exr(folder / "a.exr");
  EXPECT_EQ(image.channels.size(), 4u + 8u);
  EXPECT_THAT(channels_of(image), Contains("CryptoMaterial01.A"));
  std::vector<std::string> names;
  for (const auto& [key, matte] : image.metadata)
    if (key.ends_with("/name")) names.push_back(matte);
  EXPECT_THAT(names, ElementsAre("CryptoMaterial"));
  expect_done(render(folder, {"-o", "b.exr"}));
  for (const auto& [key, text] : read_exr(folder / "b.exr").metadata)
    EXPECT_THAT(key, Not(StartsWith("cryptomatte")));
  const Result result = render(folder, {"--matte-levels", "17", "-o", "c.exr"});
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, HasSubstr("--matte-levels"));
}

TEST(Deep, CompositesToThePicture) {
  const fs::path folder = folder_with_scene(scene);
  expect_done(render(folder, {"--deep", "deep.exr", "--layers", "none", "-o", "out.exr"}));
  expect_done(render(folder, {"--layers", "Z", "-o", "z.exr"}));
  const LayeredImage image = read_exr(folder / "out.exr"), with_z = read_exr(folder / "z.exr");
  EXPECT_THAT(channels_of(image), ElementsAre("A", "B", "G", "R"));
  const auto deep = test::read_deep(folder / "deep.exr");
  ASSERT_EQ(deep.size(), 24u * 16u);
  std::size_t apart = 0;
  for (std::size_t i = 0; i < deep.size(); ++i) {
    float through = 1, distance = 0;
    for (const auto& [alpha, depth] : deep[i]) {
      distance += through * alpha * depth;
      through *= 1 - alpha;
    }
    const float covered = image.find("A")->floats[i];
    // 8 samples: their shares are floats; 16 roundings of values below 8 at most.
    EXPECT_NEAR(1 - through, covered, 1e-6) << i;
    if (covered > 0) {
      EXPECT_NEAR(distance / covered, with_z.find("Z")->floats[i], 16 * 8 * 1.2e-7) << i;
    }
    apart += deep[i].size() > 1 && deep[i].back().second > deep[i].front().second + 2 ? 1 : 0;
  }
  EXPECT_GT(apart, 5u);
}

TEST(Deep, IsTheOnlyFileWhereNoOtherIsAskedFor) {
  const fs::path folder = folder_with_scene(scene);
  expect_done(render(folder, {"--deep", "deep.exr"}));
  EXPECT_THAT(test::names_in(folder), ElementsAre("deep.exr", "scene.pbrt"));
  expect_done(render(folder, {"--deep", "d.####.exr", "-o", "f.####.exr", "--turntable", "2"}));
  EXPECT_THAT(test::names_in(folder), ElementsAre("d.0001.exr", "d.0002.exr", "deep.exr",
                                                  "f.0001.exr", "f.0002.exr", "scene.pbrt"));
  EXPECT_EQ(test::read_deep(folder / "d.0002.exr").size(), 24u * 16u);
  for (const auto& [arguments, wrong] :
       {std::pair{std::vector<std::string>{"--deep", "a.exr", "-o", "b.exr", "--stereo", "1"},
                  "--deep: does not go with --stereo"},
        {{"--deep", "a.exr", "-o", "b.####.exr", "--turntable", "2"}, "--deep: 'a.exr'"},
        {{"--deep", "a.png", "-o", "b.exr"}, "--deep: 'a.png': deep pictures are written as .exr"},
        {{"--deep", "a.exr", "-o", "a.exr"}, "a.exr"}}) {
    const Result result = render(folder, arguments);
    EXPECT_EQ(result.code, 2) << wrong;
    EXPECT_THAT(result.err, HasSubstr(wrong));
  }
}

TEST(Mattes, OfFilmsThatAreMergedAreThoseOfOneRender) {
  const fs::path folder = folder_with_scene(scene);
  expect_done(render(folder, {"--cryptomatte", "--deep", "deep.exr", "-o", "whole.exr"}));
  for (const char* share : {"1", "2", "3"})
    expect_done(render(
        folder, {"--layers", "all,crypto_object,crypto_material,crypto_asset,deep", "--samples",
                 std::string(share) + "/3", "--film", std::string(share) + ".film"}));
  const auto merge = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "merge");
    return test::run_program(arguments, folder);
  };
  expect_done(merge({"3.film", "1.film", "2.film", "--cryptomatte", "-o", "sum.exr", "--deep",
                     "sum_deep.exr", "--layers", "Z,albedo,N,P,object,primitive"}));
  EXPECT_EQ(test::read_deep(folder / "sum_deep.exr"), test::read_deep(folder / "deep.exr"));
  const LayeredImage sum = read_exr(folder / "sum.exr"), whole = read_exr(folder / "whole.exr");
  for (const char* matte : {"CryptoObject", "CryptoMaterial", "CryptoAsset"})
    for (const char* channel : {"00.R", "00.G", "00.B", "00.A", "01.R", "02.A"})
      EXPECT_EQ(sum.find(matte + std::string(channel))->floats,
                whole.find(matte + std::string(channel))->floats)
          << matte << channel;
  for (const auto& [key, text] : whole.metadata)
    if (key.starts_with("cryptomatte/")) {
      EXPECT_EQ(sum.metadata.at(key), text);
    }
  expect_done(merge({"1.film", "--layers", "Z", "-o", "z.exr"}));
  for (const auto& [key, text] : read_exr(folder / "z.exr").metadata)
    EXPECT_THAT(key, Not(StartsWith("cryptomatte")));

  expect_done(render(folder, {"--film", "plain.film", "-o", "none"}));
  for (const auto& [flag, more, wrong] :
       {std::tuple{"--cryptomatte", "-q", "the films do not have all mattes"},
        {"--deep", "d.exr", "the films do not have what it takes"}}) {
    const Result result = merge({"plain.film", "-o", "x.exr", flag, more});
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.err, HasSubstr(std::string(flag) + ": " + wrong));
    EXPECT_FALSE(fs::exists(folder / "x.exr"));
  }
}

}  // namespace
}  // namespace caplet::mattes_test
