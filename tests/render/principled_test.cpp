// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <numbers>

#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

std::array<Mean, 3> disk_of(const std::string& material) {
  const Rendered seen = render_model(scene_of_text(R"(LookAt 0 0 50  0 0 0  0 1 0
Camera "perspective" "float fov" 1
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "principled" )" + material + "\nShape \"disk\" \"float radius\" 5\n"),
                                     256);
  return {mean_of(seen.image, "R"), mean_of(seen.image, "G"), mean_of(seen.image, "B")};
}

// Seen at a right angle under a sky of 1, a tinted interface of index 3 (which reflects a quarter)
// reflects a quarter of the base's hue: its colour over its luminance. A smooth one of this
// roughness sees all facets at right angles but for 2e-4 of Schlick's rise.
TEST(Principled, ATintIsTheHueOfTheBase) {
  const std::string base =
      R"("rgb base_color" [0.3 0.15 0.05] "float roughness" 0.1 "float eta" 3 )";
  const std::array<Mean, 3> plain = disk_of(base), tinted = disk_of(base + "\"float spec_tint\" 1");
  const double rgb[3] = {0.3, 0.15, 0.05},
               luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(tinted[c].value - plain[c].value, 0.25 * (rgb[c] / luminance - 1),
                5 * (tinted[c].error + plain[c].error) + 2e-3)
        << c;
}

/// f |cos| of a material for all three channels: a square in the plane z = 0, dp/du along x, seen
/// from wo in light from wi, over a white one in light from above, which is 1 / pi. Both have the
/// same random numbers, and so the same wavelengths.
std::array<double, 3> value_of(const std::string& material, const glm::dvec3& wo,
                               const glm::dvec3& wi) {
  const auto seen = [&](const std::string& name, const glm::dvec3& from) {
    const glm::dvec3 eye = 9.0 * glm::normalize(wo);
    Scene scene = scene_of_text(
        fmt::format("LookAt {} {} {} 0 0 0 {}\nCamera \"perspective\" \"float fov\" "
                    "0.001\nPixelFilter \"box\"\n"
                    "Film \"rgb\" \"integer xresolution\" 1 \"integer yresolution\" 1\nIntegrator "
                    "\"path\" \"integer maxdepth\" 1\n"
                    "WorldBegin\nLightSource \"distant\"\nMaterial {}\n"
                    "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]\n",
                    eye.x, eye.y, eye.z, std::abs(eye.y) > 1e-3 ? "1 0 0" : "0 1 0", name));
    std::get<DistantLight>(scene.lights.at(0).model).direction = -glm::normalize(from);
    const LayeredImage image = render_model(scene, 16).image;
    return std::array{mean_of(image, "R").value, mean_of(image, "G").value,
                      mean_of(image, "B").value};
  };
  std::array<double, 3> out = seen(material, wi);
  const std::array<double, 3> white = seen("\"diffuse\" \"rgb reflectance\" [1 1 1]", {0, 0, 1});
  for (std::size_t c = 0; c < 3; ++c) out.at(c) /= white.at(c) * std::numbers::pi;
  return out;
}

// All parameters that both have, in Mitsuba's numbers; a coat over black in those of its rough
// glass (mitsuba/principled.py). Facets that are masked in another way are worth 3e-4, and single
// floats of narrow lobes as much.
TEST(Principled, IsMitsubas) {
  std::ifstream file(source_folder() / "tests" / "render" / "mitsuba" / "principled.json");
  const nlohmann::json theirs = nlohmann::json::parse(file);
  ASSERT_GT(theirs.at("rows").size(), 60U);
  for (const nlohmann::json& row : theirs.at("rows")) {
    const auto direction = [&](const char* name) {
      return glm::dvec3(row.at(name).at(0), row.at(name).at(1), row.at(name).at(2));
    };
    const std::string parameters = row.at("parameters");
    const double value =
        value_of("\"principled\" " + parameters, direction("wo"), direction("wi"))[1];
    EXPECT_NEAR(value, row.at("value"), 1e-3 * row.at("value").get<double>())
        << row.at("name") << ": " << parameters << " " << row.at("wo") << row.at("wi");
  }
}

// A sheen of a tint is that without times 1 - tint + tint * hue, the colour over its luminance.
// Where the base leaves room for it, nothing else changes with it.
TEST(Principled, ASheensTintIsTheHueOfTheBase) {
  const glm::dvec3 rgb(0.12, 0.06, 0.02), wo(1, 0, 0.3), wi(-0.6, 0.9, 0.3);
  const auto sheen = [&](double amount, double tint) {
    return value_of(fmt::format("\"principled\" \"rgb base_color\" [{} {} {}] \"float roughness\" "
                                "0.6 \"float eta\" 1.2 \"float "
                                "sheen\" {} \"float sheen_tint\" {}",
                                rgb.x, rgb.y, rgb.z, amount, tint),
                    wo, wi);
  };
  const auto none = sheen(0, 0), white = sheen(1, 0), half = sheen(1, 0.5), tinted = sheen(1, 1);
  const double luminance = 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
  for (std::size_t c = 0; c < 3; ++c) {
    const double hue = rgb[static_cast<int>(c)] / luminance;
    EXPECT_GT(white[c] - none[c], 0.003);
    // Spectra of colours are smooth: channels of few wavelengths are good for some 2 %.
    EXPECT_NEAR((tinted[c] - none[c]) / (white[c] - none[c]), hue, 0.04 * hue + 0.02) << c;
    EXPECT_NEAR((half[c] - none[c]) / (white[c] - none[c]), 0.5 + 0.5 * hue, 0.03 * (1 + hue)) << c;
  }
}

// What is below a coat is missing what the coat reflects, of the way in or out that loses more, and
// is tinted by the coat's colour as far as there is a coat.
TEST(Principled, ACoatDimsAndTintsWhatIsBelow) {
  const glm::dvec3 wo(0.2, 0.1, 1), wi(1, -0.8, 1);
  const auto seen = [&](double base, double coat, double color) {
    return value_of(fmt::format("\"principled\" \"rgb base_color\" [{0} {0} {0}] \"float "
                                "roughness\" 0.6 \"float eta\" 1.001 \"float "
                                "coat\" {1} \"float coat_roughness\" 0 \"float coat_eta\" 1.8 "
                                "\"rgb coat_color\" [{2} {2} {2}]",
                                base, coat, color),
                    wo, wi)[1];
  };
  const auto fresnel = [](double cosine, double eta) {
    const double t = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
    const double s = (cosine - eta * t) / (cosine + eta * t),
                 p = (eta * cosine - t) / (eta * cosine + t);
    return 0.5 * (s * s + p * p);
  };
  const double bare = seen(0.4, 0, 1), lost = fresnel(glm::normalize(wi).z, 1.8);
  for (const double coat : {0.3, 1.0}) {
    // It is smooth: away from the mirror direction it adds nothing.
    EXPECT_NEAR(seen(0, coat, 1), 0, 1e-4);
    EXPECT_NEAR(seen(0.4, coat, 1) / bare, 1 - coat * lost, 2e-3) << coat;
    EXPECT_NEAR(seen(0.4, coat, 0.25) / seen(0.4, coat, 1), 1 - coat * 0.75, 2e-3) << coat;
  }
}

}  // namespace
}  // namespace caplet::test
