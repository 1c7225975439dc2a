// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lenses as text: the names of their files.
#include <gmock/gmock.h>

#include <fstream>
#include <string>

#include "export/export.h"
#include "import/detail/pbrt/pbrt.h"
#include "random_scene.h"
#include "support/data.h"

namespace caplet::test::lens_test {
namespace {

using ::testing::HasSubstr;

Scene scene_of(const std::string& text) {
  return pbrt::import_text("scene.pbrt", text, NamedImages());
}

TEST(LensText, NamesTheFilesOfLensAndAperture) {
  const std::filesystem::path folder = temporary_folder();
  std::ofstream(folder / "lens.dat") << "30 4 1.5 20\n-30 40 1 22\n";
  const Scene scene =
      scene_of("Camera \"realistic\" \"string lensfile\" \"" + (folder / "lens.dat").string() +
               "\" \"string aperture\" \"pentagon\" \"float aperturediameter\" 3\n"
               "Film \"rgb\" \"float diagonal\" 24\nWorldBegin\nShape \"sphere\"\n");
  std::string text;
  write_pbrt(scene, folder, [&](std::string_view piece) { text += piece; });
  EXPECT_THAT(text, HasSubstr("\"string lensfile\" \"lens.dat\""));
  EXPECT_THAT(text, HasSubstr("\"string aperture\" \"pentagon\""));
  EXPECT_THAT(text, HasSubstr("\"float aperturediameter\" 3"));
  EXPECT_THAT(text, HasSubstr("\"float diagonal\" 24"));

  // A lens that was read from no file has no name to write.
  Scene made = scene;
  auto& camera = std::get<RealisticProjection>(made.view.camera.projection);
  camera.lens = std::make_shared<const Lens>(Lens{"", camera.lens->elements});
  EXPECT_THROW(write_pbrt(made, folder, [](std::string_view) {}), InputError);
}

}  // namespace
}  // namespace caplet::test::lens_test
