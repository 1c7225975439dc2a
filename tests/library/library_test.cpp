// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The public classes, by nothing but their headers.
#include <caplet/import.h>
#include <caplet/log.h>
#include <caplet/pick.h>
#include <caplet/render.h>
#include <caplet/verify.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

caplet::Device test_device() {
  const char* named = std::getenv("CAPLET_TEST_DEVICE");
  return caplet::choose_device(named ? named : "");
}

class Library : public testing::Test {
 protected:
  Library() : folder_(fs::temp_directory_path() / ("caplet-library-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "ball.pbrt") << R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 12 "integer yresolution" 8
Sampler "independent" "integer pixelsamples" 4
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
MakeNamedMaterial "white" "string type" "diffuse"
NamedMaterial "white"
Shape "sphere" "float radius" 1 "string name" "ball"
)";
  }
  ~Library() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(Library, ASceneTellsWhatItHolds) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  EXPECT_EQ(scene.width(), 12);
  EXPECT_EQ(scene.height(), 8);
  EXPECT_EQ(scene.samples_per_pixel(), 4);
  EXPECT_EQ(scene.primitives(), (std::map<std::string, std::uint64_t>{{"sphere", 1}}));
  EXPECT_THAT(scene.materials(), testing::Contains("white"));
  EXPECT_EQ(scene.bounds().min, (std::array<double, 3>{-1, -1, -1}));
  EXPECT_EQ(scene.bounds().max, (std::array<double, 3>{1, 1, 1}));
}

TEST_F(Library, AChangedCopyLeavesTheFirstAsItWas) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::Scene copy = scene;
  copy.set_size(24, 16);
  copy.set_seed(7);
  EXPECT_EQ(scene.width(), 12);
  EXPECT_EQ(scene.seed(), 0u);
  EXPECT_EQ(copy.width(), 24);
  EXPECT_EQ(copy.seed(), 7u);
}

TEST_F(Library, WrongInputIsAnInputErrorWithItsPlace) {
  std::ofstream(folder_ / "wrong.pbrt") << "WorldBegin\nShape \"spehre\"\n";
  try {
    caplet::import_scene(folder_ / "wrong.pbrt");
    FAIL();
  } catch (const caplet::InputError& error) {
    EXPECT_THAT(error.messages().at(0), AllOf(HasSubstr("wrong.pbrt:2:"), HasSubstr("sphere")));
  }
  EXPECT_THROW(caplet::import_scene(folder_ / "none.pbrt"), caplet::InputError);
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  EXPECT_THROW(scene.set_size(0, 8), caplet::InputError);
  EXPECT_THROW(scene.set_size(1 << 15, 1 << 14), caplet::InputError);
  EXPECT_THROW(scene.set_crop(0, 0, 13, 8), caplet::InputError);
  EXPECT_THROW(scene.set_crop(3, 3, 3, 4), caplet::InputError);
  EXPECT_THROW(scene.set_samples_per_pixel(0), caplet::InputError);
  EXPECT_THROW(scene.set_max_depth(-1), caplet::InputError);
}

TEST_F(Library, ErrorsDoNotSpeakOfTheCommandLine) {
  try {
    caplet::choose_device("no such device");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), Not(HasSubstr("--")));
  }
}

// A white ball in a white sky of radiance 1: nothing but the sky's light can leave it, so a pixel is at most 1; beside it, 1.
TEST_F(Library, AFilmHasThePicture) {
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  scene.set_crop(2, 1, 12, 7);
  double last = -1;
  caplet::RenderOptions options;
  options.progress = [&](const caplet::RenderProgress& progress) { last = progress.fraction; };
  const caplet::Film film = caplet::render(scene, test_device(), options);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(film.width(), 10);
  EXPECT_EQ(film.height(), 6);
  EXPECT_EQ(film.x(), 2);
  EXPECT_EQ(film.y(), 1);
  EXPECT_EQ(film.samples_per_pixel(), 4);
  EXPECT_THAT(film.channels(), testing::IsSupersetOf({"R", "G", "B", "A", "Z", "N.X", "albedo.R", "variance.G", "object.id"}));
  const std::vector<float> green = film.values("G"), cover = film.values("A");
  const std::vector<std::uint32_t> ids = film.ids("object.id");
  ASSERT_EQ(green.size(), 60u);
  ASSERT_EQ(ids.size(), 60u);
  // The middle of the 12 x 8 picture is between pixels 5 and 6, 3 and 4.
  const std::size_t middle = (4 - 1) * 10 + (6 - 2);
  EXPECT_EQ(cover[middle], 1);
  EXPECT_EQ(ids[middle], 0u);
  EXPECT_GT(green[middle], 0.1f);
  EXPECT_LT(green[middle], 1.0f);
  // The last pixel of the row looks 5.5 / 4 tan(15 deg) = 20 degrees aside; the ball ends at asin(1 / 5) = 11.5.
  EXPECT_EQ(cover[39], 0);
  EXPECT_EQ(ids[39], 0xffffffffu);
  // Four samples of four wavelengths: within six of the standard errors that the film states, and more than none.
  EXPECT_LT(std::abs(green[39] - 1), 6 * std::sqrt(film.values("variance.G")[39]) + 1e-6f);
  EXPECT_NEAR(green[39], 1, 0.05);
  EXPECT_THROW(film.values("object.id"), caplet::InputError);
  EXPECT_THROW(film.ids("R"), caplet::InputError);
  EXPECT_THROW(film.values("Gr"), caplet::InputError);
  film.write_exr(folder_ / "out.exr");
  EXPECT_GT(fs::file_size(folder_ / "out.exr"), 100u);
  EXPECT_THROW(film.write_preview(folder_ / "out.nothing"), caplet::InputError);
}

TEST_F(Library, TheTimeLimitEndsARender) {
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  scene.set_size(320, 240);
  scene.set_samples_per_pixel(1 << 20);  // hours
  caplet::RenderOptions options;
  options.time_limit = 1e-9;
  const int samples = caplet::render(scene, test_device(), options).samples_per_pixel();
  EXPECT_GT(samples, 0);
  EXPECT_LT(samples, 1 << 10);
}

TEST_F(Library, PicksTellWhatAPixelShowsAndRaysHit) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::Picker picker(scene, test_device());
  const caplet::Ray ray{{0, 0, 5}, {0, 0, -2}}, beside{{0, 3, 5}, {0, 0, -1}};
  const auto hit = picker.nearest(ray);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->t, 2, 1e-6);  // in lengths of the direction
  EXPECT_NEAR(hit->point[2], 1, 1e-6);
  EXPECT_NEAR(hit->normal[2], 1, 1e-6);
  EXPECT_EQ(hit->object, "ball");
  EXPECT_EQ(hit->material, "white");
  EXPECT_EQ(scene.materials().at(hit->material_id), "white");
  EXPECT_TRUE(hit->entering);
  EXPECT_FALSE(hit->instance.has_value());
  EXPECT_FALSE(picker.nearest(beside).has_value());
  const auto lists = picker.all(std::array{ray, beside});
  ASSERT_EQ(lists.size(), 2u);
  ASSERT_EQ(lists[0].size(), 2u);
  EXPECT_NEAR(lists[0][1].t, 3, 1e-6);
  EXPECT_FALSE(lists[0][1].entering);
  EXPECT_TRUE(lists[1].empty());
  EXPECT_THROW(picker.all(std::array{ray}, 1), caplet::RunError);
  ASSERT_TRUE(picker.pixel(6, 4).has_value());
  EXPECT_EQ(picker.pixel(6, 4)->object, "ball");
  EXPECT_FALSE(picker.pixel(0, 0).has_value());
  EXPECT_THROW(picker.pixel(12, 0), caplet::InputError);
  EXPECT_THROW(picker.pixel(-1, 0), caplet::InputError);
}

TEST_F(Library, VerifyCounts) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::VerifyOptions options;
  options.rays = 2000;
  const caplet::Device device = test_device();
  const caplet::VerifyReport report = caplet::verify(scene, std::span(&device, 1), options);
  ASSERT_EQ(report.devices.size(), 1u);
  EXPECT_EQ(report.devices[0].rays, 2000u);
  EXPECT_EQ(report.devices[0].device.name, device.info().name);
  EXPECT_GT(report.devices[0].hits, 100u);
  EXPECT_TRUE(report.agrees()) << report.text;
  EXPECT_LE(report.devices[0].worst, 1);
  EXPECT_THAT(report.json, HasSubstr("\"verdict\": \"agrees\""));
}

TEST_F(Library, MessagesGoWhereTheyAreWanted) {
  std::ofstream(folder_ / "dark.pbrt") << "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n";
  std::vector<std::pair<caplet::LogLevel, std::string>> said;
  caplet::set_log_sink([&](caplet::LogLevel level, std::string_view message) { said.emplace_back(level, message); });
  caplet::import_scene(folder_ / "dark.pbrt");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].first, caplet::LogLevel::warning);
  EXPECT_THAT(said[0].second, HasSubstr("the scene has no light"));
  caplet::set_log_level(caplet::LogLevel::error);
  caplet::import_scene(folder_ / "dark.pbrt");
  EXPECT_EQ(said.size(), 1u);
  caplet::set_log_level(caplet::LogLevel::warning);
  caplet::set_log_sink({});
}

}  // namespace
