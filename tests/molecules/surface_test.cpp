// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The styles surface and accessible: which atoms they cover, by which radii and in which colours.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/detail/molecule.h"
#include "import/import.h"
#include "peptide.h"
#include "support/import_files.h"

namespace caplet {
namespace surface_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Scene drawn(const std::string& text, const ImportOptions& options) {
  return import_scene(test::write_file("s.pdb", text), test::NoImages(), options);
}

/// Two chains of one alanine each, a ligand of two atoms and a water.
std::string text() {
  return test::pdb_line(1, "CA", "ALA", 'A', 1, {0, 0, 0}, 10, ' ', "C") +
         test::pdb_line(2, "N", "ALA", 'A', 1, {1.5, 0, 0}, 20, ' ', "N") +
         test::pdb_line(3, "CA", "ALA", 'B', 2, {4, 0, 0}, 30, ' ', "C") +
         test::pdb_line(4, "C1", "LIG", 'A', 3, {9, 0, 0}, 40, ' ', "C") +
         test::pdb_line(5, "O1", "LIG", 'A', 3, {10.2, 0, 0}, 40, ' ', "O") +
         test::pdb_line(6, "O", "HOH", 'A', 4, {0, 5, 0}, 50, ' ', "O");
}

const MolecularSurfaceShape& surface_in(const Scene& scene) {
  for (const Shape& shape : scene.shapes)
    if (const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry))
      return *molecule;
  throw std::logic_error("no surface");
}
std::vector<float> places_of(const MolecularSurfaceShape& molecule) {
  std::vector<float> out;
  for (const glm::vec3& center : molecule.centers) out.push_back(center.x);
  return out;
}
std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const Shape& shape : scene.shapes) out.push_back(shape.name);
  return out;
}
std::vector<std::string> materials_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const std::uint32_t one : surface_in(scene).materials)
    out.push_back(scene.materials[one].name);
  return out;
}

TEST(Surfaces, CoverPolymersAndShowLigandsAsSticks) {
  const Scene scene = drawn(text(), {{{"style", "surface"}}});
  EXPECT_THAT(names_of(scene), ElementsAre("chain A atoms", "chain A bonds", "surface"));
  const MolecularSurfaceShape& surface = surface_in(scene);
  EXPECT_THAT(places_of(surface), ElementsAre(0, 1.5F, 4));
  EXPECT_THAT(surface.radii, ElementsAre(van_der_waals_radius(6), van_der_waals_radius(7),
                                         van_der_waals_radius(6)));
  EXPECT_FLOAT_EQ(static_cast<float>(surface.probe), 1.4F);
  EXPECT_GT(count_of(surface), 3u);
  EXPECT_THAT(materials_of(scene), ElementsAre("chain A", "chain A", "chain B"));
  const auto& sticks = std::get<CapsulesShape>(scene.shapes[0].geometry);
  EXPECT_EQ(sticks.p0.size(), 2u);
  EXPECT_EQ(scene.materials[sticks.materials[1]].name, "O");
}

TEST(Surfaces, CoverWhatThereIs) {
  const auto covered = [](const std::string& show) {
    return places_of(surface_in(drawn(text(), {{{"show", show}}})));
  };
  EXPECT_THAT(covered("ligand: surface"), ElementsAre(9, 10.2F));
  EXPECT_THAT(covered("water: surface"), ElementsAre(0));
  EXPECT_THAT(covered("ligand or water: surface"), ElementsAre(9, 10.2F));
  EXPECT_THAT(covered("chain B: surface"), ElementsAre(4));
}

TEST(Surfaces, HaveColorsProbeAndOpacity) {
  const Scene scene =
      drawn(text(), {{{"show", "polymer: surface by element opacity 0.5"}, {"probe", "0.7"}}});
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_FLOAT_EQ(static_cast<float>(surface_in(scene).probe), 0.7F);
  EXPECT_THAT(materials_of(scene), ElementsAre("C", "N", "C"));
  ASSERT_TRUE(scene.shapes[0].alpha.has_value());
  for (const char* wrong : {"0", "-1", "x", "1e9"})
    EXPECT_THAT(test::complaint([&] {
                  drawn(text(), {{{"style", "surface"}, {"probe", wrong}}});
                }),
                HasSubstr("--probe"))
        << wrong;
}

TEST(Surfaces, ThatSolventsReachAreBallsWithTheProbe) {
  const Scene scene = drawn(text(), {{{"style", "accessible"}, {"probe", "0.5"}}});
  std::vector<float> radii;
  for (const Shape& shape : scene.shapes)
    if (const auto& balls = std::get<CapsulesShape>(shape.geometry); shape.name.ends_with("atoms"))
      radii.insert(radii.end(), balls.radius0.begin(), balls.radius0.end());
  EXPECT_THAT(radii, ElementsAre(van_der_waals_radius(6) + 0.5F, van_der_waals_radius(7) + 0.5F,
                                 0.2F, 0.2F, van_der_waals_radius(6) + 0.5F));
}

}  // namespace
}  // namespace surface_test
}  // namespace caplet
