// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `render` on several devices: PoCL offers the processor as often as POCL_DEVICES names it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "film/image.h"
#include "program.h"
#include "support/data.h"
#include "support/sanitized.h"
#include "support/test_device.h"

namespace caplet {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using Environment = std::map<std::string, std::string>;

const Environment two_devices{{"POCL_DEVICES", "pthread pthread"}};

test::Result render(const std::filesystem::path& folder, const std::string& device,
                    Environment environment, const std::string& patience = "60") {
  return test::run_program(
      {"render", (test::source_folder() / "scenes" / "gallery.pbrt").string(), "-o", "out.exr",
       "--stats", "stats.json", "--preview", "out.png", "--size", "96x54", "--spp", "64",
       "--device", device, "--patience", patience},
      folder, environment);
}

struct Picture {
  std::map<std::string, std::vector<float>> floats;
  std::map<std::string, std::vector<std::uint32_t>> uints;
  bool operator==(const Picture&) const = default;
};

Picture picture_in(const std::filesystem::path& folder) {
  Picture out;
  for (const Channel& channel : read_exr(folder / "out.exr").channels) {
    out.floats[channel.name] = channel.floats;
    out.uints[channel.name] = channel.uints;
  }
  return out;
}

const Picture& by_one() {
  static const Picture made = [] {
    const auto folder = test::temporary_folder();
    EXPECT_EQ(render(folder, "0", two_devices).code, 0);
    return picture_in(folder);
  }();
  return made;
}

TEST(SeveralDevices, MakeThePictureOfOne) {
  CAPLET_NEEDS_POCL();
  for (const char* choice : {"all", "1,0"}) {
    const auto folder = test::temporary_folder();
    const test::Result result = render(folder, choice, two_devices);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.err, HasSubstr("100 %, 64/64 samples"));
    EXPECT_TRUE(picture_in(folder) == by_one());
    const auto stats = nlohmann::json::parse(test::read_file(folder / "stats.json"));
    EXPECT_EQ(stats.at("samples_per_pixel"), 64);
    ASSERT_EQ(stats.at("devices").size(), 2u);
    double paths = 0;
    for (const auto& device : stats.at("devices")) {
      EXPECT_EQ(device.at("lost"), false);
      EXPECT_GT(device.at("paths"), 0);
      paths += device.at("paths").get<double>();
    }
    EXPECT_EQ(paths, 96.0 * 54 * 64);
    EXPECT_EQ(stats.at("rays").at("camera"), 96 * 54 * 64);
  }
}

TEST(SeveralDevices, AreRefusedByName) {
  CAPLET_NEEDS_POCL();
  const test::Result result = render(test::temporary_folder(), "0,1,1", two_devices);
  EXPECT_EQ(result.code, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("--device: "), HasSubstr("device 1 is named twice")));
}

// A library between the program and the driver makes launches of the second device fail, or never
// return.
TEST(SeveralDevices, OneThatFailsOrHangsCostsNothingOfThePicture) {
  CAPLET_NEEDS_POCL();
  if (test::sanitized) GTEST_SKIP() << "the sanitizer's library must come before any other";
  for (const std::string fault : {"fail", "hang"}) {
    const auto folder = test::temporary_folder();
    Environment environment = two_devices;
    environment["LD_PRELOAD"] = CAPLET_DRIVER_launches;
    environment["CAPLET_TEST_LAUNCHES"] = "1 60 " + fault;
    const test::Result result = render(folder, "all", environment, "2");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(
        result.err,
        AllOf(HasSubstr("warning: device 1 '"), HasSubstr("the others do its work again"),
              HasSubstr(fault == "fail" ? "CL_OUT_OF_RESOURCES" : "has given no answer for 2 s")));
    EXPECT_TRUE(picture_in(folder) == by_one()) << fault;
    const auto stats = nlohmann::json::parse(test::read_file(folder / "stats.json"));
    EXPECT_EQ(stats.at("devices").at(1).at("lost"), true);
    EXPECT_EQ(stats.at("devices").at(0).at("paths"), 96 * 54 * 64);
  }
}

TEST(SeveralDevices, SpeedsAreMeasured) {
  const test::Result result =
      test::run_program({"devices", "--measure", "--json"}, test::temporary_folder());
  ASSERT_EQ(result.code, 0) << result.err;
  for (const auto& device : nlohmann::json::parse(result.out))
    EXPECT_GT(device.at("rays_per_second"), 1000);
  EXPECT_THAT(test::run_program({"devices", "--measure"}, test::temporary_folder()).out,
              HasSubstr(" Mrays/s"));
}

}  // namespace
}  // namespace caplet
