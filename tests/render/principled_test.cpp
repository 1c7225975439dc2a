// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <gtest/gtest.h>

#include <array>

#include "render_scene.h"

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

// Seen at a right angle under a sky of 1, a tinted interface of index 3 (which reflects a quarter) reflects a quarter of the
// base's hue: its colour over its luminance. A smooth one of this roughness sees all facets at right angles but for 2e-4 of
// Schlick's rise.
TEST(Principled, ATintIsTheHueOfTheBase) {
  const std::string base = R"("rgb base_color" [0.3 0.15 0.05] "float roughness" 0.1 "float eta" 3 )";
  const std::array<Mean, 3> plain = disk_of(base), tinted = disk_of(base + "\"float spec_tint\" 1");
  const double rgb[3] = {0.3, 0.15, 0.05}, luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(tinted[c].value - plain[c].value, 0.25 * (rgb[c] / luminance - 1), 5 * (tinted[c].error + plain[c].error) + 2e-3)
        << c;
}

}  // namespace
}  // namespace caplet::test
