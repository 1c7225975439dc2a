// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Alpha of images: what is seen of a wall is where its texels say.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "render_scene.h"

namespace caplet::test {
namespace {

// A wall of eight columns, one in three there: rays have no width, and each is stopped by the texel
// that it meets, whatever the filter. Bilinear looks are those of a texel in its middle alone.
TEST(Alpha, OfAnImageIsThatOfTheTexelsThatRaysMeet) {
  auto texels = std::make_shared<TextureImage>();
  texels->width = 8;
  texels->height = 2;
  texels->channels = 1;
  for (int i = 0; i < 16; ++i) texels->floats.push_back(i % 8 % 3 == 0 ? 1 : 0);
  texels->encoding = {ImageEncoding::Kind::linear, 1};
  for (int filter = 0; filter < 4; ++filter) {
    Scene scene = scene_of_text(
        "LookAt 0 0 4  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" "
        "28.072486935852957\nPixelFilter \"box\"\n"
        "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" "
        "64\nWorldBegin\nLightSource \"infinite\"\n"
        "Material \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [1 -1 0  -1 -1 0  1 1 0  -1 1 "
        "0]\n");
    ImagemapTexture map;
    map.image = texels;
    map.filter = filter;
    scene.textures.push_back({map, true, "t", {}});
    scene.shapes.at(0).alpha = TextureOperand(1);
    scene.shapes[0].alpha->texture = static_cast<std::uint32_t>(scene.textures.size() - 1);
    const LayeredImage image = render_model(scene, 4).image;
    // The middle two of the eight pixels of a column: within 1 / 8 of its texel's middle. Seen from
    // +z, LookAt has +x on the left, as has u.
    for (int column = 0; column < 8; ++column) {
      double covered = 0;
      for (int y = 0; y < 64; ++y)
        for (const int x : {8 * column + 3, 8 * column + 4})
          covered += double{channel(image, "A").floats[static_cast<std::size_t>(64 * y + x)]} / 128;
      const bool is_there = column % 3 == 0;
      EXPECT_NEAR(covered, is_there ? 1 : 0, filter == 0 ? 1e-6 : 0.13) << filter << " " << column;
    }
  }
}

}  // namespace
}  // namespace caplet::test
