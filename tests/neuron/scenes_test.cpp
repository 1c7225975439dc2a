// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The example scenes of scenes/ load through the registry, with what they are meant to show.
#include <gtest/gtest.h>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using Counts = std::map<std::string, std::uint64_t>;

Scene example(const std::string& name) {
  return import_scene(test::source_folder() / "scenes" / name, test::NoImages());
}

TEST(ExampleScenes, Capsules) {
  const Scene scene = example("capsules.pbrt");
  EXPECT_EQ(count_primitives(scene), (Counts{{"capsule", 3}, {"sphere", 1}, {"disk", 2}}));
  EXPECT_FALSE(scene.automatic_camera);
}

TEST(ExampleScenes, Instances) {
  const Scene scene = example("instances.pbrt");
  EXPECT_EQ(scene.instances.size(), 5U);
  EXPECT_EQ(count_primitives(scene), (Counts{{"capsule", 25}, {"disk", 1}}));
}

TEST(ExampleScenes, GalleryShowsEveryShape) {
  const Scene scene = example("gallery.pbrt");
  Counts counts = count_primitives(scene);
  EXPECT_GT(counts["capsule"], 9U + 1U);  // the row, the tapered one, and the curve's chain
  counts.erase("capsule");
  EXPECT_EQ(counts, (Counts{{"sphere", 2},
                            {"cylinder", 4},
                            {"cone", 2},
                            {"box", 1},
                            {"polyhedron", 1},
                            {"csg", 3},
                            {"disk", 3},
                            {"bilinear_patch", 1},
                            {"triangle", 6}}));
}

// 64 nodes and 3 * 4 * 4 * 3 struts.
TEST(ExampleScenes, Lattice) {
  const Scene scene = example("lattice.capsules");
  EXPECT_EQ(count_primitives(scene), (Counts{{"capsule", 208}}));
  EXPECT_EQ(scene.materials.size(), 2U);
  EXPECT_TRUE(scene.automatic_camera);
}

TEST(ExampleScenes, Neuron) {
  const Scene scene = example("neuron.swc");
  EXPECT_EQ(count_primitives(scene), (Counts{{"capsule", 564}, {"sphere", 1}}));
  EXPECT_EQ(scene.materials.size(), 4U);
}

}  // namespace
}  // namespace caplet
