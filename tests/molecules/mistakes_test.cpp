// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Molecules: what is refused and what is told, and the rarer ways to draw them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import/detail/molecule.h"
#include "import/import.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

/// A line of a PDB file, by its columns.
std::string atom(int serial, const std::string& name, const std::string& residue, char chain,
                 int number, double x, double b = 0) {
  return fmt::format(
      "ATOM  {:5} {:4} {:3} {}{:4}    {:8.3f}{:8.3f}{:8.3f}{:6.2f}{:6.2f}          {:>2}\n", serial,
      name, residue, chain, number, x, 0.0, 0.0, 1.0, b, "C");
}

/// The capsules of all shapes, by the shape's name.
std::map<std::string, CapsulesShape> drawn(const std::string& name, const std::string& text,
                                           const ImportOptions& options) {
  std::map<std::string, CapsulesShape> out;
  for (const Shape& shape :
       import_scene(test::write_file(name, text), test::NoImages(), options).shapes)
    out[shape.name] = std::get<CapsulesShape>(shape.geometry);
  return out;
}

// Alpha carbons of neighbours are 3.8 angstroms apart; what lies further apart than 4.6, or is of
// another chain, is not joined, and one alone is a ball of the tube's radius.
TEST(Traces, AreParted) {
  const std::string text =
      atom(1, " CA ", "ALA", 'A', 1, 0, 10) + atom(2, " CA ", "ALA", 'A', 2, 3.8, 20) +
      atom(3, " CA ", "ALA", 'A', 5, 8.5, 30) + atom(4, " CA ", "ALA", 'B', 1, 12, 20) + "END\n";
  const auto by_chain = drawn("t.pdb", text, {{{"style", "trace"}}});
  ASSERT_EQ(by_chain.size(), 2U);
  const CapsulesShape& a = by_chain.at("chain A trace");
  ASSERT_EQ(a.p0.size(), 7U);  // six between two, and the one behind the gap of 4.7
  EXPECT_EQ(a.p1[5], glm::vec3(3.8F, 0, 0));
  EXPECT_EQ(a.p0[6], glm::vec3(8.5F, 0, 0));
  EXPECT_EQ(a.p1[6], a.p0[6]);
  EXPECT_EQ(a.radius0[6], 0.45F);
  EXPECT_EQ(a.u.at(6), glm::vec2(0));
  const CapsulesShape& b = by_chain.at("chain B trace");
  EXPECT_EQ(b.p0, (std::vector<glm::vec3>{{12, 0, 0}}));
  EXPECT_EQ(b.p1, b.p0);
  // From 0.25 at the least b factor to 1.1 at the greatest.
  const auto by_factor = drawn("t.pdb", text, {{{"style", "trace"}, {"color", "bfactor"}}});
  const CapsulesShape& thick = by_factor.at("chain A trace");
  EXPECT_EQ(thick.radius0.at(0), 0.25F);
  EXPECT_FLOAT_EQ(thick.radius1.at(5), 0.675F);
  EXPECT_FLOAT_EQ(thick.radius0.at(6), 1.1F);
  EXPECT_FLOAT_EQ(by_factor.at("chain B trace").radius0.at(0), 0.675F);
}

TEST(Traces, OfOneDistanceApart) {
  const auto count = [](double x) {
    return drawn("t.pdb",
                 atom(1, " CA ", "ALA", 'A', 1, 0) + atom(2, " CA ", "ALA", 'A', 2, x) + "END\n",
                 {{{"style", "trace"}}})
        .at("chain A trace")
        .p0.size();
  };
  EXPECT_EQ(count(4.5), 6U);
  EXPECT_EQ(count(4.7), 2U);
}

// By distance the three would make a ring; the component of the file beside has two bonds.
TEST(Components, MayBeInAFileOfTheirOwn) {
  const std::string pdb = atom(1, " A1 ", "LIG", 'A', 1, 0) + atom(2, " A2 ", "LIG", 'A', 1, 0.9) +
                          atom(3, " A3 ", "LIG", 'A', 1, 1.8) + "END\n";
  const std::filesystem::path file =
      test::write_file("l.cif",
                       "data_x\nloop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n"
                       "_chem_comp_bond.atom_id_2\nLIG A1 A2\nLIG A2 A3\n");
  const ImportOptions sticks{{{"style", "sticks"}}},
      named{{{"style", "sticks"}, {"components", file.string()}}};
  EXPECT_EQ(drawn("l.pdb", pdb, sticks).at("chain A bonds").p0.size(), 3U);
  EXPECT_EQ(drawn("l.pdb", pdb, named).at("chain A bonds").p0.size(), 2U);
  EXPECT_THAT(complaint([&] {
                drawn("l.pdb", pdb, {{{"components", file.string() + "x"}}});
              }),
              HasSubstr("--components: "));
}

// Carbon's radius is 0.76 angstroms (Cordero et al. 2008): bonds are shorter than 2 * 0.76 + 0.45.
TEST(Bonds, OfCrowdsAreNotSought) {
  const auto bonds = [](int atoms) {
    std::string text = fmt::format("{}\n\nC 1 0 0\n", atoms);
    for (int i = 1; i < atoms; ++i) text += "C 0 0 0\n";
    return all_bonds(read_xyz(text, "crowd.xyz", {}), "crowd.xyz").size();
  };
  test::LogOf log;
  EXPECT_EQ(bonds(256), 255U);
  EXPECT_EQ(log.text(), "");
  EXPECT_EQ(bonds(257), 0U);
  EXPECT_THAT(log.text(), HasSubstr("crowd.xyz: 257 atoms within 2.0 angstroms of each other: no "
                                    "bonds are found by distance"));
}

TEST(Crystal, LettersMayBeNoElement) {
  const auto element = [](const std::string& label, const std::string& type) {
    return static_cast<int>(
        read_mmcif("data_x\n_cell_length_a 5\n_cell_length_b 5\n_cell_length_c 5\n"
                   "_cell_angle_alpha 90\n_cell_angle_beta 90\n_cell_angle_gamma 90\nloop_\n"
                   "_atom_site_label\n_atom_site_type_symbol\n_atom_site_fract_x\n"
                   "_atom_site_fract_y\n_atom_site_fract_z\n" +
                       label + " " + type + " 0 0 0\n",
                   "x.cif", {})
            .atoms.at(0)
            .element);
  };
  EXPECT_EQ(element("Q1", "Q"), 0);
  EXPECT_EQ(element("Fe1", "Q"), 26);  // by its label
  EXPECT_EQ(element("Q1", "FE2+"), 26);
  EXPECT_EQ(element("Cq1", "?"), 6);
}

TEST(Molecules, OptionsAreRefused) {
  const std::string pdb = atom(1, " CA ", "ALA", 'A', 1, 0) + "END\n";
  const auto said = [](const std::string& text, const ImportOptions& options) {
    return complaint([&] { drawn("o.pdb", text, options); });
  };
  EXPECT_THAT(said(pdb, {{{"altloc", "AB"}}}),
              HasSubstr("--altloc: 'AB' is neither first nor all nor one letter"));
  EXPECT_THAT(said(pdb, {{{"altloc", ""}}}),
              HasSubstr("--altloc: '' is neither first nor all nor one letter"));
  EXPECT_THAT(said(pdb, {{{"model", "2"}}}), HasSubstr("--model: 2: the file has 1 models"));
  EXPECT_THAT(said(pdb, {{{"select", "/1/A/x-"}}}), HasSubstr("--select: '/1/A/x-': "));
  const std::string assembly =
      "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: Z\n"
      "REMARK 350   BIOMT1   1  1 0 0 0\nREMARK 350   BIOMT2   1  0 1 0 0\n"
      "REMARK 350   BIOMT3   1  0 0 1 0\n";
  EXPECT_THAT(said(assembly + pdb, {{{"assembly", "1"}}}),
              HasSubstr("--assembly: '1' holds none of the atoms"));
  EXPECT_THAT(said(assembly + pdb, {{{"assembly", "2"}}}),
              HasSubstr("--assembly: '2' is none of the file (1)"));
  std::string odd = assembly;
  odd.replace(odd.find("0 1 0 0"), 7, "0 i 0 0");
  EXPECT_THAT(said(odd + pdb, {}), HasSubstr("o.pdb:4: 'i' is no number of an operator"));
  odd.replace(odd.find("0 i 0 0"), 7, "0 0 0 nan");
  EXPECT_THAT(said(odd + pdb, {}), HasSubstr("o.pdb:4: 'nan' is no number of an operator"));
}

// Places are below 1e16.
TEST(Molecules, PlacesAreFinite) {
  std::string cif = "data_x\nloop_\n";
  for (const char* column : {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id",
                             "label_comp_id", "label_asym_id", "label_seq_id", "Cartn_x", "Cartn_y",
                             "Cartn_z", "occupancy", "B_iso_or_equiv", "auth_seq_id"})
    cif += "_atom_site." + std::string(column) + "\n";
  for (const char* far : {"1e17", "-1e17", "1e300"})
    EXPECT_THAT(complaint([&] {
                  read_mmcif(cif + "ATOM 7 C A1 . LIG A 1 0 " + far + " 0 1 1 5\n", "f.cif", {});
                }),
                HasSubstr("f.cif: atom 7 (A1 of LIG 5) has no finite place"))
        << far;
  EXPECT_THAT(
      complaint([] { read_sdf("x\n\n\n  1  0\n    0.0       1e17      0.0    C\n", "f.sdf", {}); }),
      HasSubstr("f.sdf:5:1: the place is not finite or out of range"));
}

TEST(Sdf, RecordsEndAtTheirMark) {
  const std::string one = "x\n\n\n  1  0\n    0.0       0.0       0.0    C\nM  END\n";
  const auto said = [](const std::string& text, const std::string& model) {
    return complaint([&] { read_sdf(text, "r.sdf", {{{"model", model}}}); });
  };
  EXPECT_THAT(said(one, "2"), HasSubstr("--model: 2: the file has 1 records"));
  EXPECT_THAT(said(one + "$$$$\n" + one, "3"), HasSubstr("--model: 3: the file has 2 records"));
  EXPECT_THAT(said(one + "$$$$\n\n", "2"), HasSubstr("--model: 2: the file has 1 records"));
  EXPECT_EQ(said(one + "$$$$\n" + one, "2"), "");
  EXPECT_EQ(read_sdf(one + "$$$$\n\n", "r.sdf", {}).frames, 1U);
  EXPECT_EQ(read_sdf(one + "$$$$\n" + one + "$$$$\r\n \n", "r.sdf", {}).frames, 2U);
}

TEST(Molecules, BondsAreOfAtomsThatThereAre) {
  const auto said = [](const std::string& bond) {
    return complaint([&] {
      read_sdf(
          "x\n\n\n  0  0  0     0  0            999 V3000\nM  V30 BEGIN CTAB\n"
          "M  V30 BEGIN ATOM\nM  V30 4 C 0 0 0 0\nM  V30 5 C 1 0 0 0\nM  V30 END ATOM\n"
          "M  V30 BEGIN BOND\nM  V30 1 1 " +
              bond + "\nM  V30 END BOND\nM  V30 END CTAB\nM  END\n",
          "b.sdf", {});
    });
  };
  EXPECT_EQ(said("4 5"), "");
  EXPECT_THAT(said("4 1"), HasSubstr("b.sdf:11:1: a bond of an atom that there is not"));
  EXPECT_THAT(said("6 5"), HasSubstr("b.sdf:11:1: a bond of an atom that there is not"));
}

}  // namespace
}  // namespace caplet
