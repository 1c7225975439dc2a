// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What Open Image Denoise is asked, told by a library in its place, and what is made of its
// answers.
#include "film/denoise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "support/data.h"

namespace caplet {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

LayeredImage image_of(const std::vector<std::string>& names) {
  LayeredImage image;
  image.width = image.data_width = 2;
  image.height = image.data_height = 1;
  float value = 1;
  for (const std::string& name : names) {
    image.channels.push_back({name, {value, 10 * value}, {}});
    value += 1;
  }
  return image;
}

class Denoise : public testing::Test {
 protected:
  Denoise() { ::setenv("CAPLET_OIDN", CAPLET_FAKE_OIDN, 1); }
  ~Denoise() override {
    ::unsetenv("CAPLET_OIDN");
    ::unsetenv("FAKE_OIDN_FAILS");
    ::unsetenv("FAKE_OIDN_QUALITY");
  }
};

TEST_F(Denoise, GuidesAreDenoisedBefore) {
  check_denoiser("--denoise");
  EXPECT_EQ(denoiser_name(), "Open Image Denoise 2.9.7");
  LayeredImage image =
      image_of({"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"});
  const LayeredImage before = image;
  denoise(image);
  // colour / 2 + 2 albedo / 4 + 3 normal / 8
  EXPECT_THAT(image.find("R")->floats, ElementsAre(0.5f + 2.5f + 3, 10 * (0.5f + 2.5f + 3)));
  EXPECT_THAT(image.find("G")->floats, ElementsAre(1 + 3 + 3.375f, 10 * (1 + 3 + 3.375f)));
  EXPECT_THAT(image.find("B")->floats,
              ElementsAre(1.5f + 3.5f + 3.75f, 10 * (1.5f + 3.5f + 3.75f)));
  for (const char* name : {"R", "G", "B"})
    EXPECT_EQ(image.find(std::string("noisy.") + name)->floats, before.find(name)->floats);
  for (const char* name : {"A", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z"})
    EXPECT_EQ(image.find(name)->floats, before.find(name)->floats) << name;
  EXPECT_EQ(image.channels.size(), 13u);
}

TEST_F(Denoise, WithoutBothGuidesColorsStandAlone) {
  for (const std::vector<std::string>& names : {std::vector<std::string>{"R", "G", "B"},
                                                {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"},
                                                {"R", "G", "B", "N.X", "N.Y", "N.Z"}}) {
    LayeredImage image = image_of(names);
    denoise(image);
    EXPECT_THAT(image.find("R")->floats, ElementsAre(0.5f, 5));
    EXPECT_THAT(image.find("B")->floats, ElementsAre(1.5f, 15));
  }
}

TEST_F(Denoise, AQuickPictureIsAskedForAsBalanced) {
  LayeredImage image = image_of({"R", "G", "B"});
  EXPECT_THROW(denoise(image, DenoiseQuality::quick), RunError);
  ::setenv("FAKE_OIDN_QUALITY", "5", 1);
  EXPECT_TRUE(denoise(image, DenoiseQuality::quick));
  EXPECT_THAT(image.find("R")->floats, ElementsAre(0.5f, 5));
}

TEST_F(Denoise, WhatFailsIsToldAndChangesNothing) {
  ::setenv("FAKE_OIDN_FAILS", "1", 1);
  LayeredImage image = image_of({"R", "G", "B"});
  EXPECT_THAT([&] { denoise(image); },
              ThrowsMessage<RunError>("Open Image Denoise: as it was told to"));
  EXPECT_EQ(image.channels.size(), 3u);
  EXPECT_THAT(image.find("R")->floats, ElementsAre(1, 10));
}

TEST_F(Denoise, AMissingLibraryIsAnErrorWithARemedy) {
  const auto folder = test::temporary_folder();
  std::ofstream(folder / "text.so") << "no library";
  for (const std::string& file :
       {(folder / "missing.so").string(), (folder / "text.so").string()}) {
    ::setenv("CAPLET_OIDN", file.c_str(), 1);
    EXPECT_THAT(
        [] { check_denoiser("--denoise"); },
        ThrowsMessage<RunError>(AllOf(HasSubstr("--denoise: Open Image Denoise cannot be loaded"),
                                      HasSubstr(file), HasSubstr("pip install pyoidn"))));
  }
}

TEST_F(Denoise, OneOfAnotherVersionIsAnError) {
  ::setenv("CAPLET_OIDN", "libm.so.6", 1);
  EXPECT_THAT([] { check_denoiser("--denoise"); },
              ThrowsMessage<RunError>(HasSubstr("has no oidnNewDevice: version 2 is needed")));
}

}  // namespace
}  // namespace caplet
