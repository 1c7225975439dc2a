// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Renders every scene of expected.json and holds it against what its picture must be.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "render_scene.h"
#include "support/data.h"
#include "support/environment.h"
#include "support/thorough.h"

namespace caplet::test {
namespace {

struct Expectation {
  std::string scene, kind, reference;
  int max_depth = 0, samples = 0;
  double value = 0, relative_tolerance = 0, standard_errors = 0, tolerance = 0, mean_tolerance = 0;
};

std::vector<Expectation> expectations() {
  std::ifstream file(source_folder() / "tests" / "closed_forms" / "expected.json");
  const nlohmann::json json = nlohmann::json::parse(file);
  std::vector<Expectation> out;
  for (const nlohmann::json& row : json.at("scenes"))
    out.push_back({row.at("scene"), row.at("kind"), row.value("reference", ""), row.at("max_depth"),
                   row.at("spp"), row.value("value", 0.0), row.value("relative_tolerance", 0.0),
                   row.value("standard_errors", 0.0), row.value("tolerance", 0.0),
                   row.value("mean_tolerance", 0.0)});
  return out;
}

class ClosedForms : public testing::TestWithParam<Expectation> {};

TEST_P(ClosedForms, Agrees) {
  // Kernels for all rows know alpha, and so other stages trace their rays than most pictures have.
  const ScopedVariable rows("CAPLET_ROWS", "scene");
  const Expectation& expected = GetParam();
  if (!expected.reference.empty()) CAPLET_NEEDS_DATA();
  // The error of a picture is that of its samples: a quarter of them has four times as much.
  const int fewer = expected.kind == "image" && expected.samples > 64 && !thorough() ? 4 : 1;
  const int samples = expected.samples / fewer;
  const Rendered rendered =
      render_file(source_folder() / expected.scene, samples,
                  [&](Scene& scene) { scene.view.integrator.max_depth = expected.max_depth; });
  const Picture ours = picture_of(rendered.image);
  const double pixels = static_cast<double>(ours.rgb.size()) / 3;
  if (expected.kind == "image") {
    const Picture theirs = picture_of(read_exr(data_folder() / expected.reference));
    const double error = clipped_relative_squared_error(ours, theirs);
    RecordProperty("error", std::to_string(error));
    EXPECT_LT(error, fewer * expected.tolerance);
    // The sum over the picture, which an error everywhere moves and noise hardly does.
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0, their_sum = 0, variance = 0;
      for (std::size_t i = c; i < ours.rgb.size(); i += 3) {
        sum += ours.rgb[i];
        their_sum += theirs.rgb[i];
        variance += ours.variance[i];
      }
      // Theirs has 4,096 samples of about our variance.
      const double noise = std::sqrt(variance * (1 + samples / 4096.0)) / their_sum;
      RecordProperty(std::string("mean_") + "RGB"[c], std::to_string(sum / their_sum - 1));
      RecordProperty(std::string("noise_") + "RGB"[c], std::to_string(noise));
      EXPECT_NEAR(sum / their_sum, 1, 4.5 * noise + expected.mean_tolerance) << "RGB"[c];
    }
    return;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    double mean = 0, variance = 0;
    for (std::size_t i = c; i < ours.rgb.size(); i += 3) {
      mean += ours.rgb[i] / pixels;
      variance += ours.variance[i] / (pixels * pixels);
    }
    RecordProperty(std::string("mean_") + "RGB"[c], std::to_string(mean));
    EXPECT_NEAR(mean, expected.value, expected.relative_tolerance * expected.value) << "RGB"[c];
    // 2e-4: whites as a spectrum's XYZ and as the colour space's xy differ by up to this.
    EXPECT_NEAR(mean, expected.value,
                expected.standard_errors * std::sqrt(variance) + 2e-4 * expected.value)
        << "RGB"[c];
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClosedForms, testing::ValuesIn(expectations()),
                         [](const auto& parameter) {
                           std::string name =
                               std::filesystem::path(parameter.param.scene).stem().string();
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(ClosedForms, EverySceneOfTheFolderIsExpected) {
  std::size_t scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(source_folder() / "scenes" / "reference"))
    scenes += entry.path().extension() == ".pbrt";
  EXPECT_EQ(scenes, expectations().size());
}

}  // namespace
}  // namespace caplet::test
