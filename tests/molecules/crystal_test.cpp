// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Crystals: atoms at fractions of a cell, and the whole of it, from the geometry of known
// structures; bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "import/detail/molecule.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using test::complaint;
using testing::HasSubstr;

Molecule crystal(const std::string& text, const ImportOptions& options = {}) {
  return read_mmcif(text, "crystal.cif", options);
}

/// Positions are sums of three products of doubles, rounded to floats of up to 20: half a unit in
/// the last place.
constexpr double kRounded = 20 * 0x1p-23;

// Silicon carbide of Braekken 1930 (Z. Kristallogr. 75, 572): zinc blende, a = 4.348 angstroms.
const std::string kCarborundum = R"(data_SiC
_symmetry_space_group_name_H-M 'F -4 3 m'
_cell_length_a 4.348(5)
_cell_length_b 4.348(5)
_cell_length_c 4.348(5)
_cell_angle_alpha 90
_cell_angle_beta 90
_cell_angle_gamma 90
loop_
_atom_site_label
_atom_site_type_symbol
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
_atom_site_U_iso_or_equiv
Si1 Si4+ 0 0 0 0.01
C1 C4- 0.25 0.25 0.25(2) ?
)";

TEST(Crystal, FractionsAreOfTheCell) {
  const Molecule molecule = crystal(kCarborundum);
  ASSERT_EQ(molecule.atoms.size(), 2U);
  EXPECT_EQ(molecule.name, "SiC");
  EXPECT_EQ(molecule.atoms[0].element, 14);
  EXPECT_EQ(molecule.atoms[1].element, 6);
  EXPECT_EQ(molecule.atom_names[0], "Si1");
  EXPECT_NEAR(molecule.atoms[0].b_factor, 8 * M_PI * M_PI * 0.01, 1e-6);
  EXPECT_EQ(molecule.atoms[1].b_factor, 0);
  EXPECT_NEAR(glm::length(molecule.atoms[1].position - molecule.atoms[0].position),
              4.348 * std::sqrt(3.0) / 4, kRounded);
}

// International Tables A, no. 216: 4a at (0 0 0) and 4c at (1/4 1/4 1/4), each with the face
// centring.
TEST(Crystal, TheCellOfZincBlendeHasEightAtoms) {
  const Molecule molecule = crystal(kCarborundum, {{{"assembly", "cell"}}});
  std::vector<std::array<int, 4>> found;
  for (const Atom& atom : molecule.atoms) {
    std::array<int, 4> at{atom.element};
    for (int axis = 0; axis < 3; ++axis) {
      const double fraction = static_cast<double>(atom.position[axis]) / 4.348;
      EXPECT_NEAR(4 * fraction, std::round(4 * fraction), 1e-5);
      at.at(static_cast<std::size_t>(axis) + 1) =
          (static_cast<int>(std::lround(4 * fraction)) % 4 + 4) % 4;
    }
    found.push_back(at);
  }
  EXPECT_THAT(found, testing::UnorderedElementsAreArray({std::array{14, 0, 0, 0},
                                                         {14, 0, 2, 2},
                                                         {14, 2, 0, 2},
                                                         {14, 2, 2, 0},
                                                         {6, 1, 1, 1},
                                                         {6, 1, 3, 3},
                                                         {6, 3, 1, 3},
                                                         {6, 3, 3, 1}}));
  EXPECT_EQ(molecule.residues.at(0).atom_count, 8U);
  EXPECT_THAT(molecule.atom_names, testing::Contains("C1").Times(4));
}

const std::string kTriclinic = R"(data_t
_cell_length_a 3
_cell_length_b 5
_cell_length_c 7
_cell_angle_alpha 70
_cell_angle_beta 80
_cell_angle_gamma 100
loop_
_symmetry_equiv_pos_as_xyz
x,y,z
-x,-y,-z
loop_
_atom_site_label
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
)";

// The cell's edges have its lengths and angles, and the atoms' places as far from each other as the
// metric tensor says.
TEST(Crystal, AnObliqueCellHasItsLengthsAndAngles) {
  const Molecule molecule =
      crystal(kTriclinic + "C0 0 0 0\nC1 1 0 0\nC2 0 1 0\nC3 0 0 1\nO4 -2 1 0.5\n");
  ASSERT_EQ(molecule.atoms.size(), 5U);
  const std::array<double, 3> length{3, 5, 7};
  const std::array<double, 3> angle{70, 80, 100};  // of b and c, c and a, a and b
  std::array<glm::dvec3, 3> edge{};
  for (std::size_t k = 0; k < 3; ++k) {
    edge.at(k) = glm::dvec3(molecule.atoms[k + 1].position - molecule.atoms[0].position);
    EXPECT_NEAR(glm::length(edge.at(k)), length.at(k), kRounded);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    EXPECT_NEAR(glm::dot(edge.at(i), edge.at(j)),
                length.at(i) * length.at(j) * std::cos(angle.at(k) * M_PI / 180), 10 * kRounded);
  }
  EXPECT_GT(glm::dot(edge[0], glm::cross(edge[1], edge[2])), 0);
  EXPECT_LT(glm::length(glm::dvec3(molecule.atoms[4].position) -
                        (-2.0 * edge[0] + edge[1] + 0.5 * edge[2])),
            10 * kRounded);
  EXPECT_EQ(molecule.atoms[4].element, 8);  // of the label, where there is no type
}

// Two carbon atoms 1.5 angstroms apart across a face of the cell, and a lone one: inverted, the
// pair stays together.
TEST(Crystal, WhatIsBoundIsMovedAsAWhole) {
  const Molecule molecule = crystal(
      kTriclinic + "C1 0.8 0.1 0.1\nC2 1.3 0.1 0.1\nNa1 0.5 0.5 0.5\n", {{{"assembly", "cell"}}});
  ASSERT_EQ(molecule.atoms.size(), 5U);  // the lone one lies on a centre of inversion
  EXPECT_EQ(molecule.atoms[4].element, 11);
  for (const std::size_t i : {0U, 2U})
    EXPECT_NEAR(glm::length(molecule.atoms[i].position - molecule.atoms[i + 1].position), 1.5,
                kRounded);
  // The middle of the first pair, (1.05 0.1 0.1), goes to (0.05 0.1 0.1); that of its copy to (0.95
  // 0.9 0.9).
  const glm::vec3 sum = molecule.atoms[0].position + molecule.atoms[1].position +
                        molecule.atoms[2].position + molecule.atoms[3].position;
  const Molecule corner = crystal(kTriclinic + "C1 1 1 1\n");
  EXPECT_LT(glm::length(sum / 2.0F - corner.atoms[0].position), 4 * kRounded);
  EXPECT_EQ(all_bonds(molecule, "").size(), 2U);
}

// Carbon on a centre of inversion, bound to oxygen that is not: the pair's copy has its carbon in
// the next cell.
TEST(Crystal, AnAtomOnACentreIsDrawnOnce) {
  const Molecule molecule =
      crystal(kTriclinic + "C1 0 0 0\nO1 0.4 0 0\n", {{{"assembly", "cell"}}});
  EXPECT_THAT(molecule.atom_names, testing::ElementsAre("C1", "O1", "O1"));
  EXPECT_LT(glm::length(molecule.atoms.back().position - glm::vec3(1.8F, 0, 0)), kRounded);
}

TEST(Crystal, DisorderHydrogenAndAtomsWithoutAPlace) {
  const std::string text = R"(data_d
_cell_length_a 10
_cell_length_b 10
_cell_length_c 10
loop_
_atom_site_label
_atom_site_fract_x
_atom_site_fract_y
_atom_site_fract_z
_atom_site_B_iso_or_equiv
_atom_site_disorder_group
_atom_site_calc_flag
CL1 0.1 0.1 0.1 2.5 . d
H1 0.2 0.1 0.1 . . calc
O1A .3 .1 .1 . 1 d
O1B .3 .2 .1 . 2 d
N1 ? ? ? . . d
X1 0 0 0 . . dum
)";
  const auto names = [&](const ImportOptions& options) {
    return crystal(text, options).atom_names;
  };
  EXPECT_THAT(names({}), testing::ElementsAre("CL1", "H1", "O1A"));
  EXPECT_THAT(names({{{"altloc", "2"}}}), testing::ElementsAre("CL1", "H1", "O1B"));
  EXPECT_THAT(names({{{"altloc", "all"}, {"hydrogens", "no"}}}),
              testing::ElementsAre("CL1", "O1A", "O1B"));
  // Places that shut each other out are not bound, however near (1 angstrom).
  for (const auto& [a, b] : all_bonds(crystal(text, {{{"altloc", "all"}}}), ""))
    EXPECT_FALSE(a == 2 && b == 3);
  const Molecule molecule = crystal(text);
  EXPECT_EQ(molecule.chains.size(), 1U);
  EXPECT_EQ(molecule.atoms[0].element, 17);
  EXPECT_FLOAT_EQ(molecule.atoms[0].b_factor, 2.5F);
  EXPECT_TRUE(molecule.has_b_factors);
  EXPECT_EQ(molecule.frames, 1U);
}

TEST(Crystal, OneOfSeveralStructures) {
  const std::string two =
      kCarborundum + "data_empty\n_cell_length_a 1\n" + kTriclinic + "O1 0 0 0\n";
  EXPECT_EQ(crystal(two).name, "SiC");
  EXPECT_EQ(crystal(two).frames, 2U);
  EXPECT_EQ(crystal(two, {{{"model", "2"}}}).name, "t");
  EXPECT_THAT(complaint([&] {
                crystal(two, {{{"model", "3"}}});
              }),
              HasSubstr("--model: 3: the file has 2 structures"));
}

TEST(Crystal, OperatorsAreThoseOfTheText) {
  const std::string site =
      "loop_\n_atom_site_label\n_atom_site_fract_x\n_atom_site_fract_y\n_atom_site_fract_z\nC1 0.1 "
      "0.2 0.4\n";
  const std::string cell = "data_o\n_cell_length_a 10\n_cell_length_b 10\n_cell_length_c 10\n";
  const auto copy = [&](const std::string& op) {
    const Molecule m =
        crystal(cell + "loop_\n_space_group_symop_operation_xyz\n" + op + "\n" + site,
                {{{"assembly", "cell"}}});
    EXPECT_EQ(m.atoms.size(), 1U);
    return m.atoms.at(0).position;
  };
  const auto near = [](const glm::vec3& found, const glm::vec3& expected) {
    EXPECT_LT(glm::length(found - expected), kRounded)
        << found.x << ' ' << found.y << ' ' << found.z;
  };
  near(copy("x,y,z"), {1, 2, 4});
  near(copy("'y, z, x'"), {2, 4, 1});
  near(copy("'1/2 - X, y+1/4, -z'"), {4, 4.5F, 6});
  near(copy("x-y,-y,0.5+z"), {9, 8, 9});
  near(copy("'x+1.5,1/3+z,y'"), {6, 7.3333333F, 2});
  for (const char* bad :
       {"x,y", "x,y,z,x", "'x,y,q'", "x,y,y", "x,y,z+1/0", "2x,y,z", "'x,y,1.2.3'"})
    EXPECT_THAT(complaint([&] { copy(bad); }), HasSubstr("operator")) << bad;
  std::string many;
  for (int i = 0; i < 193; ++i) many += "x,y,z\n";
  EXPECT_THAT(complaint([&] { copy(many); }), HasSubstr("more than 192 operators"));
  EXPECT_THAT(complaint([&] {
                crystal(cell + site, {{{"assembly", "cell"}}});
              }),
              HasSubstr("neither operators nor the name"));
}

TEST(Crystal, BadInput) {
  const auto with = [](const std::string& from, const std::string& to,
                       const ImportOptions& options = {}) {
    std::string text = kCarborundum;
    text.replace(text.find(from), from.size(), to);
    return complaint([&] { crystal(text, options); });
  };
  EXPECT_THAT(with("_cell_length_a 4.348(5)\n", ""),
              HasSubstr("_cell_length_a is missing, and the atoms are fractions"));
  EXPECT_THAT(with("_cell_length_a 4.348(5)", "_cell_length_a ?"),
              HasSubstr("_cell_length_a is '?'"));
  EXPECT_THAT(with("_cell_length_c 4.348(5)", "_cell_length_c -1"),
              HasSubstr("_cell_length_c is '-1'"));
  EXPECT_THAT(with("_cell_angle_beta 90", "_cell_angle_beta 180"),
              HasSubstr("_cell_angle_beta is '180'"));
  EXPECT_THAT(with("_cell_angle_beta 90", "_cell_angle_beta 0.001"),
              HasSubstr("angles of the cell"));
  EXPECT_THAT(with("Si1 Si4+ 0 0 0", "Si1 Si4+ 0 1e60 0"), HasSubstr("'Si1' has no finite place"));
  EXPECT_THAT(with("Si1 Si4+ 0 0 0 0.01\nC1 C4- 0.25", "Si1 Si4+ ? 0 0 0.01\nC1 C4- ?"),
              HasSubstr("holds no atoms whose place is known"));
  EXPECT_THAT(with("data", "data", {{{"select", "//A"}}}),
              HasSubstr("--select: says nothing to a crystal"));
}

}  // namespace
}  // namespace caplet
