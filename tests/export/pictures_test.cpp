// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The pictures of scenes that are written and read again: the same films, word for word.
#include <gtest/gtest.h>

#include <cstring>

#include "export/export.h"
#include "render_scene.h"
#include "scene_files.h"

namespace caplet {
namespace {

using namespace test;
namespace fs = std::filesystem;

std::vector<std::uint64_t> film_of(Scene scene) {
  scene.view.film.width = 48;
  scene.view.film.height = 32;
  scene.view.film.crop.reset();
  scene.view.integrator.max_depth = std::min(scene.view.integrator.max_depth, 6);
  const RenderResult result = render_model(scene, 2).result;
  return {result.film.words().begin(), result.film.words().end()};
}

void expect_same_pictures(const fs::path& folder) {
  each_written_again(folder, [](const Scene& scene, const Scene& read, const fs::path&) {
    EXPECT_TRUE(film_of(scene) == film_of(read));
  });
}

TEST(WrittenPictures, OfExampleScenes) { expect_same_pictures(source_folder() / "scenes"); }

TEST(WrittenPictures, OfReferenceScenes) {
  CAPLET_NEEDS_DATA();
  expect_same_pictures(data_folder() / "reference");
}

TEST(WrittenPictures, OfOtherSharedScenes) {
  CAPLET_NEEDS_DATA();
  for (const char* folder : {"scenes_pbrt", "swc"}) expect_same_pictures(data_folder() / folder);
}

}  // namespace
}  // namespace caplet
