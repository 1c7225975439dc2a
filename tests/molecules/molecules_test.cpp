// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Molecules: the conventions of docs/formats/molecules.md, the shared files with counts by other
// programs, and bad input.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <set>

#include "import/detail/importers.h"
#include "import/detail/molecule.h"
#include "import/import.h"
#include "npy_text.h"
#include "support/data.h"
#include "support/import_files.h"

namespace caplet {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

Scene scene_of(const std::filesystem::path& path, const ImportOptions& options = {}) {
  return import_scene(path, test::NoImages(), options);
}
Scene scene_of_text(const std::string& name, const std::string& text,
                    const ImportOptions& options = {}) {
  return scene_of(test::write_file(name, text), options);
}

/// Capsules of no length, and all others, of the shapes and objects.
struct Counts {
  std::size_t balls = 0, rods = 0;
};
Counts counts_of(const std::vector<Shape>& shapes) {
  Counts out;
  for (const Shape& shape : shapes) {
    const auto& capsules = std::get<CapsulesShape>(shape.geometry);
    for (std::size_t i = 0; i < capsules.p0.size(); ++i)
      ++(capsules.p0[i] == capsules.p1[i] ? out.balls : out.rods);
  }
  return out;
}

// --- The shared files ---

struct FileCounts {
  const char* file;
  Molecule (*read)(std::string_view, const std::string&, const ImportOptions&);
  std::size_t atoms, bonds, chains;
};
void PrintTo(const FileCounts& counts, std::ostream* out) { *out << counts.file; }

class MoleculeFile : public testing::TestWithParam<FileCounts> {};

TEST_P(MoleculeFile, HasTheAtomsAndBondsThatOthersCount) {
  CAPLET_NEEDS_DATA();
  const FileCounts& expected = GetParam();
  const std::filesystem::path path = test::data_folder() / "mol" / expected.file;
  const Molecule molecule = expected.read(bytes_of(path), path.string(), {});
  EXPECT_EQ(molecule.atoms.size(), expected.atoms);
  EXPECT_EQ(all_bonds(molecule, path.string()).size(), expected.bonds);
  EXPECT_EQ(molecule.chains.size(), expected.chains);
  const Counts counts = counts_of(scene_of(path, {{{"style", "ball-and-stick"}}}).shapes);
  EXPECT_EQ(counts.balls, expected.atoms);
  EXPECT_GE(counts.rods, expected.bonds);
  EXPECT_LE(counts.rods, 2 * expected.bonds);
  EXPECT_EQ(counts_of(scene_of(path, {{{"style", "spheres"}}}).shapes).balls, expected.atoms);
}

// Atoms: gemmi's Python package and the files' own count lines. Bonds: of PDB and XYZ by an
// independent script that compares all pairs by the rule of the page (RDKit's own rule finds the
// same 337 and 310, and 25 of caffeine.xyz); of 4hhb.pdb five more by CONECT records, as RDKit
// counts; of SD files and components the files' own.
INSTANTIATE_TEST_SUITE_P(Data, MoleculeFile,
                         testing::Values(FileCounts{"pdb/1crn.pdb", read_pdb, 327, 337, 1},
                                         FileCounts{"pdb/1CRN.cif", read_mmcif, 327, 337, 1},
                                         FileCounts{"pdb/1l2y.pdb", read_pdb, 304, 310, 1},
                                         FileCounts{"pdb/4hhb.cif", read_mmcif, 4779, 4631, 4},
                                         FileCounts{"pdb/4hhb.pdb", read_pdb, 4779, 4636, 4},
                                         FileCounts{"sdf/aspirin.sdf", read_sdf, 21, 21, 1},
                                         FileCounts{"sdf/caffeine.sdf", read_sdf, 24, 25, 1},
                                         FileCounts{"xyz/caffeine.xyz", read_xyz, 24, 25, 1},
                                         FileCounts{"xyz/extended.xyz", read_xyz, 192, 177, 1},
                                         FileCounts{"xyz/helium.xyz", read_xyz, 125, 0, 1},
                                         FileCounts{"ccd/ATP.cif", read_mmcif, 47, 49, 1},
                                         FileCounts{"ccd/HEM.cif", read_mmcif, 75, 82, 1},
                                         FileCounts{"ccd/TRP.cif", read_mmcif, 27, 28, 1}),
                         [](const auto& of) {
                           std::string name = of.param.file;
                           for (char& c : name)
                             if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
                           return name;
                         });

// Counts of the wwPDB's pages on 4HHB: four chains, four haems, two phosphates; 221 water
// molecules.
TEST(Contents, AreCounted) {
  using testing::ElementsAre, testing::Pair;
  EXPECT_THAT(scene_of_text("c.xyz", "1\n\nC 0 0 0\n1\n\nC 0 0 1\n").contents,
              ElementsAre(Pair("atoms", 1), Pair("models", 2)));
  CAPLET_NEEDS_DATA();
  EXPECT_THAT(scene_of(test::data_folder() / "mol/pdb/4hhb.pdb").contents,
              ElementsAre(Pair("atoms", 4779), Pair("residues", 574 + 6 + 221), Pair("chains", 4),
                          Pair("ligands", 6), Pair("models", 1)));
  const std::vector<std::filesystem::path> two{test::data_folder() / "mol/pdb/1crn.pdb",
                                               test::data_folder() / "mol/pdb/1l2y.pdb"};
  EXPECT_THAT(import_scenes(two, test::NoImages()).contents,
              ElementsAre(Pair("atoms", 327 + 304), Pair("residues", 66), Pair("chains", 2),
                          Pair("ligands", 0), Pair("models", 39)));
}

TEST(Assemblies, AreInstancesOfTheirChains) {
  CAPLET_NEEDS_DATA();
  const Scene scene = scene_of(test::data_folder() / "mol/pdb/1M4X.pdb",
                               {{{"assembly", "1"}, {"style", "spheres"}}});
  EXPECT_EQ(scene.shapes.size(), 0u);
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(counts_of(scene.objects[0].shapes).balls, 9693u);
  ASSERT_EQ(scene.instances.size(), 1680u);
  // The last line of its kind in the file, whose columns have moved: BIOMT1 1680 -0.384039
  // -0.917901 -0.099862 -11.99060.
  const glm::dmat4& last = scene.instances.back().world_from_object;
  EXPECT_EQ(last[0][0], -0.384039);
  EXPECT_EQ(last[1][0], -0.917901);
  EXPECT_EQ(last[2][0], -0.099862);
  EXPECT_EQ(last[3][0], -11.99060);
  EXPECT_EQ(last[2][2], 0.789130);
  EXPECT_THAT(complaint([&] {
                scene_of(test::data_folder() / "mol/pdb/1crn.pdb", {{{"assembly", "7"}}});
              }),
              AllOf(HasSubstr("--assembly"), HasSubstr("(1)")));
}

/// A line of a PDB file, by its columns.
std::string atom_line(int serial, char chain, double x) {
  return fmt::format(
      "ATOM  {:5}  CA  ALA {}{:4}    {:8.3f}{:8.3f}{:8.3f}{:6.2f}{:6.2f}          {:>2}\n", serial,
      chain, 1, x, 0.0, 0.0, 1.0, 0.0, "C");
}

// REMARK 350 of wwPDB's format, version 3.3: operators stand in three rows of a turn and a place;
// chains go on in lines of "AND CHAINS:". What is none of it is passed over.
TEST(Assemblies, OfRemarksByTheirWords) {
  const std::string remark = "REMARK 350 ";
  const auto row = [&](int i, int n, const std::string& numbers) {
    return remark + "  BIOMT" + std::to_string(i) + "   " + std::to_string(n) + " " + numbers +
           "\n";
  };
  const std::string text =
      remark + "APPLY THE FOLLOWING TO CHAINS: A\n" +
      row(1, 1, "9 0 0 9") +  // before there is a molecule
      remark + "BIOMOLECULE: 1\n" + remark + "APPLY THE FOLLOWING TO\n" + remark +
      "APPLY THE FOLLOWING TO CHAINS: A,\n" + remark + "                   AND CHAINS: B\n" +
      row(1, 1, "1 0 0 5") + row(4, 1, "7 7 7 7") + row(2, 1, "0 1 0 6") + row(0, 1, "8 8 8 8") +
      row(3, 1, "0 0 1 7") + row(1, 2, "0 -1 0 1") + row(2, 2, "1 0 0 2") + row(3, 2, "0 0 1 3") +
      remark + "BIOMOLECULE: 2\n" + remark + "APPLY THE FOLLOWING TO CHAINS: C\n" +
      row(1, 1, "1 0 0 -4") + row(2, 1, "0 1 0 0") + row(3, 1, "0 0 1 0") + atom_line(1, 'A', 0) +
      atom_line(2, 'B', 10) + atom_line(3, 'C', 20) + "END\n";
  const auto scene = [&](const std::string& name) {
    return scene_of_text("a.pdb", text, {{{"assembly", name}, {"style", "spheres"}}});
  };
  const Scene first = scene("1");
  ASSERT_EQ(first.objects.size(), 1U);
  EXPECT_EQ(counts_of(first.objects[0].shapes).balls, 2U);
  ASSERT_EQ(first.instances.size(), 2U);
  EXPECT_EQ(first.instances[0].world_from_object,
            glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {5, 6, 7, 1}));
  EXPECT_EQ(first.instances[1].world_from_object,
            glm::dmat4({0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {1, 2, 3, 1}));
  const Scene second = scene("2");
  const Bounds bounds = bounds_of(second);
  EXPECT_NEAR((bounds.min.x + bounds.max.x) / 2, 16, 1e-5);
}

TEST(Traces, GoThroughTheAlphaCarbons) {
  CAPLET_NEEDS_DATA();
  const Scene scene = scene_of(test::data_folder() / "mol/pdb/1crn.pdb", {{{"style", "trace"}}});
  ASSERT_EQ(scene.shapes.size(), 1u);  // no ligands
  const auto& tube = std::get<CapsulesShape>(scene.shapes[0].geometry);
  // 46 residues, six capsules between two.
  ASSERT_EQ(tube.p0.size(), 45u * 6);
  // ATOM 2 CA THR A 1 and ATOM 324 CA ASN A 46 of the file.
  EXPECT_EQ(tube.p0.front(), glm::vec3(16.967F, 12.784F, 4.338F));
  for (std::size_t i = 1; i < tube.p0.size(); ++i) EXPECT_EQ(tube.p0[i], tube.p1[i - 1]);
  // u is the same from residue to residue.
  ASSERT_EQ(tube.u.size(), tube.p0.size());
  for (std::size_t i = 0; i < tube.u.size(); ++i) {
    EXPECT_FLOAT_EQ(tube.u[i].y, static_cast<float>(i + 1) / (6 * 45));
    EXPECT_EQ(tube.u[i].x, i == 0 ? 0 : tube.u[i - 1].y);
  }
  EXPECT_EQ(tube.u.back().y, 1);
  const Molecule molecule =
      read_pdb(bytes_of(test::data_folder() / "mol/pdb/1crn.pdb"), "1crn.pdb", {});
  const auto alpha = [&](std::size_t r) {
    return molecule.atoms[static_cast<std::size_t>(molecule.residues[r].trace_atom)].position;
  };
  for (std::size_t r = 1; r < 44; ++r) {  // the spline of Catmull and Rom half way
    const glm::vec3 half = (9.0F * (alpha(r) + alpha(r + 1)) - alpha(r - 1) - alpha(r + 2)) / 16.0F;
    EXPECT_LT(glm::length(tube.p1[6 * r + 2] - half), 1e-4F) << r;
  }
  for (std::size_t r = 0; r < 46; ++r) {
    const glm::vec3 at = alpha(r);
    const glm::vec3 on = r < 45 ? tube.p0[6 * r] : tube.p1.back();
    EXPECT_LT(glm::length(at - on), 1e-4F) << r;
  }
}

// --- Conventions, on texts by hand ---

std::string atom_line(int serial, const char* name, char altloc, const char* residue, char chain,
                      int number, double x, double y, double z, double b, const char* element,
                      const char* record = "ATOM") {
  char line[96];
  std::snprintf(line, sizeof line,
                "%-6s%5d %-4s%c%3s %c%4d    %8.3f%8.3f%8.3f%6.2f%6.2f          %2s\n", record,
                serial, name, altloc, residue, chain, number, x, y, z, 1.0, b, element);
  return line;
}

TEST(Pdb, BlankElementsComeFromTheNames) {
  const std::string text = atom_line(1, " CA ", ' ', "ALA", 'A', 1, 0, 0, 0, 1, "  ") +
                           atom_line(2, "CA  ", ' ', " CA", 'A', 2, 9, 0, 0, 1, "  ", "HETATM");
  const Molecule m = read_pdb(text, "two.pdb", {});
  ASSERT_EQ(m.atoms.size(), 2u);
  EXPECT_EQ(m.atoms[0].element, 6);   // the alpha carbon
  EXPECT_EQ(m.atoms[1].element, 20);  // calcium
}

// gemmi 0.5 reads the distance of columns 74 to 78 beyond the end of a line that ends there, which
// AddressSanitizer sees.
TEST(Pdb, LinesMayEndWithinTheDistance) {
  for (const std::size_t columns : {73U, 74U, 76U, 78U}) {
    std::string link = "SSBOND   1 CYS A    1    CYS A    2";
    link.resize(73, ' ');
    link = (link + " 2.03").substr(0, columns);
    const std::string text = atom_line(1, " SG ", ' ', "CYS", 'A', 1, 0, 0, 0, 1, " S") +
                             atom_line(2, " SG ", ' ', "CYS", 'A', 2, 9, 0, 0, 1, " S") + link;
    for (const char* end : {"", "\n", "\r\n"})
      EXPECT_EQ(read_pdb(text + end, "x.pdb", {}).bonds, (std::vector<Bond>{{0, 1}}));
  }
}

// A serial number beyond integers, which no bond needs, and b factors whose range no float holds.
TEST(Mmcif, NumbersBeyondTheirRangeAreNone) {
  std::string text = "data_x\nloop_\n";
  for (const char* column :
       {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id",
        "label_asym_id", "label_entity_id", "label_seq_id", "Cartn_x", "Cartn_y", "Cartn_z",
        "occupancy", "B_iso_or_equiv", "auth_seq_id", "auth_asym_id", "pdbx_PDB_model_num"})
    text += "_atom_site." + std::string(column) + "\n";
  text +=
      "ATOM 18446744073709551616 C CA . ALA A 1 1 0 0 0 1 3e38 1 A 1\n"
      "ATOM 2 C CA . ALA A 1 2 0 0 9 1 -3e38 99999999999 A 1\n";
  const Molecule m = read_mmcif(text, "x.cif", {});
  ASSERT_EQ(m.atoms.size(), 2u);
  EXPECT_EQ(m.atoms[0].element, 6);
  EXPECT_EQ(m.atoms[1].serial, 2);
  EXPECT_FALSE(m.has_b_factors);
}

// As PyMOL and others write it: columns that hold nothing new are not there.
TEST(Mmcif, ColumnsMayBeMissing) {
  const auto text_of = [](const std::vector<std::string>& columns, const std::string& rows) {
    std::string text = "data_x\nloop_\n";
    for (const std::string& column : columns) text += "_atom_site." + column + "\n";
    return text + rows;
  };
  const Molecule few =
      read_mmcif(text_of({"label_atom_id", "label_comp_id", "label_seq_id", "Cartn_x", "Cartn_y",
                          "Cartn_z", "auth_asym_id"},
                         "CA ALA 7 0 0 0 B\nCB ALA 7 1.5 0 0 B\nCA ALA 8 3 0 0 B\n"),
                 "x.cif", {});
  ASSERT_EQ(few.atoms.size(), 3u);
  EXPECT_EQ(few.chains, (std::vector<std::string>{"B"}));
  ASSERT_EQ(few.residues.size(), 2u);
  EXPECT_EQ(few.residues[0].atom_count, 2u);
  EXPECT_EQ(few.residues[0].part, "B");
  EXPECT_EQ(few.residues[1].atom_count, 1u);
  EXPECT_EQ(few.atoms[1].position, glm::vec3(1.5F, 0, 0));
  EXPECT_EQ(few.atoms[2].altloc, '\0');
  EXPECT_FALSE(few.has_b_factors);
  // Residues of one number are apart by the chain alone; the author's numbers count where both are
  // there.
  const Molecule both =
      read_mmcif(text_of({"id", "type_symbol", "label_atom_id", "label_alt_id", "label_comp_id",
                          "label_asym_id", "label_seq_id", "Cartn_x", "Cartn_y", "Cartn_z",
                          "B_iso_or_equiv", "auth_seq_id"},
                         "5 C CA A ALA X 1 0 0 0 12.5 40\n6 C CA . ALA X 1 0 0 9 1 41\n"),
                 "x.cif", {});
  ASSERT_EQ(both.residues.size(), 2u);
  EXPECT_EQ(both.atoms[0].serial, 5);
  EXPECT_EQ(both.atoms[0].altloc, 'A');
  EXPECT_EQ(both.atoms[0].b_factor, 12.5F);
}

// Charges that no byte holds, which UndefinedBehaviorSanitizer sees.
TEST(Mmcif, ComponentsMayHaveNoCharge) {
  for (const char* charge : {"?", ".", "1e9", "-1"}) {
    std::string text = "data_X\n_chem_comp.id X\nloop_\n";
    for (const char* column : {"comp_id", "atom_id", "type_symbol", "charge", "model_Cartn_x",
                               "model_Cartn_y", "model_Cartn_z"})
      text += "_chem_comp_atom." + std::string(column) + "\n";
    text += "X C1 C " + std::string(charge) + " 1 2 3\n";
    const Molecule m = read_mmcif(text, "x.cif", {});
    ASSERT_EQ(m.atoms.size(), 1u);
    EXPECT_EQ(m.atoms[0].position, glm::vec3(1, 2, 3));
  }
}

TEST(Pdb, OnlyTheFirstAlternativePlaceIsDrawn) {
  const std::string text = atom_line(1, " CA ", ' ', "SER", 'A', 1, 0, 0, 0, 1, " C") +
                           atom_line(2, " CB ", 'A', "SER", 'A', 1, 1.5, 0, 0, 1, " C") +
                           atom_line(3, " CB ", 'B', "SER", 'A', 1, 1, 1.2, 0, 1,
                                     " C");  // within a bond's reach of both
  EXPECT_EQ(read_pdb(text, "a.pdb", {}).atoms.size(), 2u);
  const Molecule all = read_pdb(text, "a.pdb", {{{"altloc", "all"}}});
  EXPECT_EQ(all.atoms.size(), 3u);
  EXPECT_EQ(all_bonds(all, "a.pdb"), (std::vector<Bond>{{0, 1}, {0, 2}}));
  const Molecule b = read_pdb(text, "a.pdb", {{{"altloc", "B"}}});
  ASSERT_EQ(b.atoms.size(), 2u);
  EXPECT_EQ(b.atoms[1].position, glm::vec3(1, 1.2F, 0));
}

TEST(Pdb, WaterAndHydrogensAndSelections) {
  const std::string text = atom_line(1, " CA ", ' ', "ALA", 'A', 1, 0, 0, 0, 1, " C") +
                           atom_line(2, " HA ", ' ', "ALA", 'A', 1, 1, 0, 0, 1, " H") +
                           atom_line(3, " O  ", ' ', "HOH", 'B', 9, 6, 0, 0, 1, " O", "HETATM");
  EXPECT_EQ(read_pdb(text, "w.pdb", {}).atoms.size(), 3u);
  EXPECT_EQ(read_pdb(text, "w.pdb", {{{"water", "no"}}}).atoms.size(), 2u);
  EXPECT_EQ(read_pdb(text, "w.pdb", {{{"hydrogens", "no"}}}).atoms.size(), 2u);
  EXPECT_EQ(read_pdb(text, "w.pdb", {{{"select", "//B"}}}).atoms.size(), 1u);
  EXPECT_THAT(complaint([&] {
                read_pdb(text, "w.pdb", {{{"select", "//C"}}});
              }),
              HasSubstr("no atoms"));
  EXPECT_THAT(complaint([&] {
                read_pdb(text, "w.pdb", {{{"water", "maybe"}}});
              }),
              AllOf(HasSubstr("--water"), HasSubstr("no, yes")));
}

TEST(Pdb, ConectAddsWhatDistanceDoesNot) {
  const std::string text = atom_line(1, "FE  ", ' ', "HEM", 'A', 1, 0, 0, 0, 1, "FE", "HETATM") +
                           atom_line(2, " O  ", ' ', "OXY", 'A', 2, 3.5, 0, 0, 1, " O", "HETATM") +
                           "CONECT    1    2    2\nCONECT    2    1\nCONECT    2   77\n";
  EXPECT_EQ(all_bonds(read_pdb(text, "c.pdb", {}), "c.pdb"), (std::vector<Bond>{{0, 1}}));
}

TEST(Pdb, LinksAreBondsWithinTheUnit) {
  const auto bonds = [](const char* other) {
    const std::string text =
        std::string("LINK         O   GLY A   1                ZN    ZN A   2     1555   ") +
        other + "  5.00\n" + atom_line(1, " O  ", ' ', "GLY", 'A', 1, 0, 0, 0, 1, " O") +
        atom_line(2, "ZN  ", ' ', " ZN", 'A', 2, 5, 0, 0, 1, "ZN", "HETATM");
    return all_bonds(read_pdb(text, "l.pdb", {}), "l.pdb");
  };
  EXPECT_EQ(bonds("1555"), (std::vector<Bond>{{0, 1}}));
  EXPECT_EQ(bonds("2555"), std::vector<Bond>());  // to a copy by symmetry
}

TEST(Components, AreTheBondsOfTheirResidues) {
  // By distance the three would make a ring; the component has two bonds.
  std::string text =
      "data_x\nloop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond.atom_id_"
      "2\nLIG A1 A2\nLIG A2 A3\n";
  const std::string pdb = atom_line(1, " A1 ", ' ', "LIG", 'A', 1, 0, 0, 0, 1, " C") +
                          atom_line(2, " A2 ", ' ', "LIG", 'A', 1, 1.4, 0, 0, 1, " C") +
                          atom_line(3, " A3 ", ' ', "LIG", 'A', 1, 0.7, 1.2, 0, 1, " C");
  Molecule m = read_pdb(pdb, "l.pdb", {});
  EXPECT_EQ(all_bonds(m, "l.pdb").size(), 3u);
  m.components = component_bonds_of(text, "l.cif");
  EXPECT_EQ(all_bonds(m, "l.pdb"), (std::vector<Bond>{{0, 1}, {1, 2}}));
}

// As programs write what they have refined: the bonds of each component in a block of its own,
// behind the model's.
TEST(Components, MayHaveBlocksOfTheirOwn) {
  std::string text = "data_model\nloop_\n";
  for (const char* column : {"group_PDB", "id", "type_symbol", "label_atom_id", "label_alt_id",
                             "label_comp_id", "label_asym_id", "label_seq_id", "Cartn_x", "Cartn_y",
                             "Cartn_z", "occupancy", "B_iso_or_equiv", "auth_seq_id"})
    text += "_atom_site." + std::string(column) + "\n";
  text +=
      "ATOM 1 C A1 . LIG A 1 0 0 0 1 1 1\nATOM 2 C A2 . LIG A 1 1.4 0 0 1 1 1\nATOM 3 C A3 . LIG A "
      "1 0.7 1.2 0 1 1 1\n";
  EXPECT_EQ(all_bonds(read_mmcif(text, "m.cif", {}), "m.cif").size(), 3u);  // by distance
  text +=
      "data_comp_LIG\nloop_\n_chem_comp_bond.comp_id\n_chem_comp_bond.atom_id_1\n_chem_comp_bond."
      "atom_id_2\nLIG A1 A2\n"
      "LIG A2 A3\n";
  EXPECT_EQ(all_bonds(read_mmcif(text, "m.cif", {}), "m.cif"), (std::vector<Bond>{{0, 1}, {1, 2}}));
}

// The rule, against all pairs, for a crowd of any elements in any places, far outliers among them.
TEST(Bonds, AreThoseOfAllPairs) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    Molecule m;
    m.chains = {""};
    m.residues.resize(1);
    std::uniform_real_distribution<float> place(-12, 12);
    const std::uint8_t elements[] = {1, 6, 7, 8, 16, 26, 55};
    for (int i = 0; i < 700; ++i) {
      Atom atom;
      atom.position = {place(random), place(random), place(random)};
      if (i % 50 == 0) atom.position.x += 1e7F;
      atom.element = elements[random() % (round < 10 ? 6 : 7)];
      m.atoms.push_back(atom);
    }
    std::set<Bond> expected;
    for (std::uint32_t i = 0; i < m.atoms.size(); ++i)
      for (std::uint32_t j = i + 1; j < m.atoms.size(); ++j) {
        const glm::vec3 d = m.atoms[i].position - m.atoms[j].position;
        const float square = d.x * d.x + d.y * d.y + d.z * d.z;
        const float reach =
            covalent_radius(m.atoms[i].element) + covalent_radius(m.atoms[j].element) + 0.45F;
        if (square < reach * reach && square > 0.16F &&
            !(m.atoms[i].hydrogen() && m.atoms[j].hydrogen()))
          expected.insert({i, j});
      }
    ASSERT_GT(expected.size(), 100u);
    EXPECT_EQ(all_bonds(m, "crowd"), std::vector<Bond>(expected.begin(), expected.end())) << round;
  }
}

TEST(Elements, HaveRadiiAndColoursOfTheirTables) {
  EXPECT_EQ(element_of("FE"), 26);
  EXPECT_EQ(element_of("26"), 26);
  EXPECT_EQ(element_of("C12"), 6);
  EXPECT_EQ(element_of("D"), 1);
  EXPECT_EQ(element_of("Xx"), 0);
  EXPECT_EQ(element_of(""), 0);
  EXPECT_FLOAT_EQ(covalent_radius(6), 0.76F);
  EXPECT_FLOAT_EQ(covalent_radius(26), 1.32F);
  EXPECT_FLOAT_EQ(van_der_waals_radius(7), 1.55F);
  // Jmol's oxygen is ff0d0d: 13/255 is 0.0040 in linear light (IEC 61966-2-1).
  EXPECT_NEAR(element_color(8).x, 1, 1e-12);
  EXPECT_NEAR(element_color(8).y, 0.0040247, 1e-6);
}

TEST(Drawing, BondsAreHalvedByTheColoursOfTheirAtoms) {
  const Scene scene = scene_of_text("co.xyz", "2\n\nC 0 0 0\nO 1.2 0 0\n");
  ASSERT_EQ(scene.shapes.size(), 2u);
  const auto& atoms = std::get<CapsulesShape>(scene.shapes[0].geometry);
  const auto& bonds = std::get<CapsulesShape>(scene.shapes[1].geometry);
  ASSERT_EQ(atoms.p0.size(), 2u);
  ASSERT_EQ(bonds.p0.size(), 2u);
  EXPECT_FLOAT_EQ(atoms.radius0[0], 0.25F * 1.7F);
  EXPECT_EQ(bonds.p1[0], glm::vec3(0.6F, 0, 0));
  EXPECT_EQ(bonds.p0[1], glm::vec3(0.6F, 0, 0));
  EXPECT_EQ(bonds.materials, atoms.materials);
  EXPECT_EQ(scene.materials[atoms.materials[0]].name, "C");
  EXPECT_EQ(scene.materials[atoms.materials[1]].name, "O");
}

// Bondi's radius of magnesium is 1.73 angstroms; Shannon's of its ion 0.86.
TEST(Drawing, IonsAreBallsBesideSticksAndCartoons) {
  const std::string text =
      atom_line(1, "MG  ", ' ', " MG", 'A', 1, 0, 0, 0, 1, "MG", "HETATM") +
      atom_line(2, " C1 ", ' ', "LIG", 'B', 2, 9, 0, 0, 1, " C", "HETATM") +
      atom_line(3, " O1 ", ' ', "LIG", 'B', 2, 10.2F, 0, 0, 1, " O", "HETATM") +
      atom_line(4, " O  ", ' ', "HOH", 'C', 3, 20, 0, 0, 1, " O", "HETATM") +
      atom_line(5, " CA ", ' ', "ALA", 'D', 4, 30, 0, 0, 1, " C") +
      atom_line(6, " CA ", ' ', "ALA", 'D', 5, 33, 0, 0, 1, " C");
  for (const char* style : {"sticks", "cartoon", "trace"}) {
    const Scene scene = scene_of_text("ion.pdb", text, {{{"style", style}}});
    std::vector<float> radii;
    for (const Shape& shape : scene.shapes)
      if (shape.name.ends_with(" atoms"))
        for (const float r : std::get<CapsulesShape>(shape.geometry).radius0) radii.push_back(r);
    std::vector<float> expected{0.5F * 1.73F, 0.2F, 0.2F};
    if (style == std::string("sticks")) expected.resize(6, 0.2F);  // with water and the chain
    EXPECT_EQ(radii, expected) << style;
  }
}

TEST(Drawing, ColoursTellBFactors) {
  const std::string text = atom_line(1, " CA ", ' ', "ALA", 'A', 1, 0, 0, 0, 5, " C") +
                           atom_line(2, " CA ", ' ', "ALA", 'A', 2, 3.8, 0, 0, 50, " C");
  const Scene scene = scene_of_text("b.pdb", text, {{{"color", "bfactor"}, {"style", "trace"}}});
  const auto& tube = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  EXPECT_EQ(scene.materials[tube.materials.front()].name, "bfactor 5");
  EXPECT_EQ(scene.materials[tube.materials.back()].name, "bfactor 50");
  ASSERT_FALSE(tube.radius1.empty());
  EXPECT_LT(tube.radius0.front(), tube.radius1.back());
  ASSERT_TRUE(scene.legend);
  EXPECT_EQ(scene.legend->title, "B factor");
  EXPECT_EQ(scene.legend->low, 5);
  EXPECT_EQ(scene.legend->high, 50);
}

// Where all are the same each has the middle of the map, (33, 145, 140) of matplotlib's, but for
// half a step of 63; the tube has the width between the thinnest and the widest.
TEST(Drawing, OneBFactorHasTheMiddleOfTheMap) {
  const auto tube_of = [](double b0, double b1, Scene& scene) {
    scene = scene_of_text("b.pdb",
                          atom_line(1, " CA ", ' ', "ALA", 'A', 1, 0, 0, 0, b0, " C") +
                              atom_line(2, " CA ", ' ', "ALA", 'A', 2, 3.8, 0, 0, b1, " C"),
                          {{{"color", "bfactor"}, {"style", "trace"}}});
    return std::get<CapsulesShape>(scene.shapes.at(0).geometry);
  };
  Scene scene;
  const CapsulesShape both = tube_of(5, 50, scene), one = tube_of(20, 20, scene);
  ASSERT_FALSE(one.materials.empty());
  const Material& material = scene.materials.at(one.materials.front());
  EXPECT_EQ(material.name, "bfactor 20");
  const glm::dvec3 color =
      std::get<RgbSpectrum>(std::get<DiffuseMaterial>(material.model).reflectance).rgb;
  const double srgb[3] = {33 / 255.0, 145 / 255.0, 140 / 255.0};
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(color[k], std::pow((srgb[k] + 0.055) / 1.055, 2.4), 0.01) << k;
  EXPECT_NEAR(one.radius0.front(), 0.5F * (both.radius0.front() + both.radius1.back()), 1e-6F);
}

TEST(Xyz, FramesAndColumns) {
  const std::string text =
      "1\nfirst\nHe 0 0 0\n2\nProperties=id:I:1:species:S:1:pos:R:3\n1 C 1 2 3\n2 O 1 2 4.2\n";
  EXPECT_EQ(read_xyz(text, "f.xyz", {}).atoms.size(), 1u);
  const Molecule second = read_xyz(text, "f.xyz", {{{"model", "2"}}});
  ASSERT_EQ(second.atoms.size(), 2u);
  EXPECT_EQ(second.atoms[0].element, 6);
  EXPECT_EQ(second.atoms[1].position, glm::vec3(1, 2, 4.2F));
  EXPECT_THAT(complaint([&] {
                read_xyz(text, "f.xyz", {{{"model", "3"}}});
              }),
              AllOf(HasSubstr("--model"), HasSubstr("2 frames")));
  // All frames of the file, whichever is read, but for a last one that is cut off.
  for (const char* model : {"1", "2"})
    EXPECT_EQ(read_xyz(text, "f.xyz", {{{"model", model}}}).frames, 2U) << model;
  EXPECT_EQ(read_xyz(text + "\n1\nthird\nHe 0 0 0\n", "f.xyz", {}).frames, 3U);
  EXPECT_EQ(read_xyz(text + "2\nthird\nHe 0 0 0\n", "f.xyz", {}).frames, 2U);
  EXPECT_EQ(read_xyz(text + "and more\n", "f.xyz", {}).frames, 2U);
}

TEST(Molecules, AtomsAreWhereAnArrayHasThem) {
  const std::filesystem::path path = test::write_file("m.xyz", "2\n\nC 0 0 0\nO 1.2 0 0\n");
  const auto centres = [&](const std::vector<double>& places, const std::string& model,
                           const std::string& shape = "2, 2, 3") {
    const std::filesystem::path array = test::write_file("m.npy", test::npy(shape, places));
    ImportOptions options{{{"positions", array.string()}, {"style", "spheres"}}};
    if (!model.empty()) options.set("model", model);
    std::vector<glm::vec3> out;
    for (const Shape& shape_of_one : scene_of(path, options).shapes)
      for (const glm::vec3& p : std::get<CapsulesShape>(shape_of_one.geometry).p0) out.push_back(p);
    return out;
  };
  const std::vector<double> two{1, 2, 3, 4, 5, 6, -1, -2, -3, -4, -5, -6};
  EXPECT_THAT(centres(two, ""),
              testing::UnorderedElementsAre(glm::vec3(1, 2, 3), glm::vec3(4, 5, 6)));
  EXPECT_THAT(centres(two, "2"),
              testing::UnorderedElementsAre(glm::vec3(-1, -2, -3), glm::vec3(-4, -5, -6)));
  const auto said = [&](const std::vector<double>& places, const std::string& model,
                        const std::string& shape) {
    return complaint([&] { centres(places, model, shape); });
  };
  EXPECT_THAT(said(two, "3", "2, 2, 3"), HasSubstr("3: the array has 2 frames"));
  EXPECT_THAT(said(two, "", "4, 1, 3"), HasSubstr("has places of 1 atoms, and 2 are drawn"));
  for (const double bad : {std::nan(""), 1e39, -1e39, static_cast<double>(INFINITY)})
    EXPECT_THAT(said({1, 2, 3, 4, bad, 6}, "", "1, 2, 3"),
                HasSubstr("frame 1, atom 2: the place is not finite"))
        << bad;
}

TEST(Sdf, V2000BondsNameTheLastAtom) {
  const auto molfile = [](const std::string& bond) {
    return "n\n\n\n  2  1  0  0  0  0  0  0  0  0999 V2000\n    1.0000    2.0000    3.0000 C   0  "
           "0\n"
           "    1.0000    2.0000    4.2000 O   0  0\n" +
           bond + "  2  0\nM  END\n";
  };
  using Bonds = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  for (const char* bond : {"  1  2", "  2  1"})
    EXPECT_EQ(read_sdf(molfile(bond), "f.sdf", {}).bonds, (Bonds{{0, 1}})) << bond;
  for (const char* bond : {"  3  1", "  1  3", "  0  1", "  1  0", "  1  1"})
    EXPECT_THAT(complaint([&] { read_sdf(molfile(bond), "f.sdf", {}); }), HasSubstr("there are 2"))
        << bond;
}

TEST(Sdf, V3000) {
  const std::string text =
      "name\n\n\n  0  0  0     0  0            999 V3000\nM  V30 BEGIN CTAB\nM  V30 COUNTS 3 2 0 0 "
      "0\nM  V30 BEGIN ATOM\n"
      "M  V30 1 O 0 0 0 0\nM  V30 7 H 0.9 -\nM  V30 0.1 0 0\nM  V30 3 H -0.3 0.9 0 0\nM  V30 END "
      "ATOM\nM  V30 BEGIN BOND\n"
      "M  V30 1 1 1 7\nM  V30 2 1 1 3\nM  V30 END BOND\nM  V30 END CTAB\nM  END\n$$$$\n";
  const Molecule m = read_sdf(text, "v.sdf", {});
  ASSERT_EQ(m.atoms.size(), 3u);
  EXPECT_EQ(m.atoms[1].position, glm::vec3(0.9F, 0.1F, 0));
  EXPECT_EQ(all_bonds(m, "v.sdf"), (std::vector<Bond>{{0, 1}, {0, 2}}));
  EXPECT_THAT(complaint([&] {
                read_sdf(text, "v.sdf", {{{"model", "2"}}});
              }),
              HasSubstr("--model"));
  for (const auto& [good, bad] :
       {std::pair("1 O 0 0", "x O 0 0"), std::pair("1 O 0 0", "1 O a 0"),
        std::pair("2 1 1 3", "2 1 x 3"), std::pair("2 1 1 3", "2 1 1 3x")}) {
    std::string broken = text;
    broken.replace(broken.find(good), std::string(good).size(), bad);
    EXPECT_THAT(complaint([&] { read_sdf(broken, "v.sdf", {}); }),
                AllOf(HasSubstr("v.sdf:"), HasSubstr("is no number")))
        << bad;
  }
}

// --- Bad input ---

struct Bad {
  const char *name, *text, *says;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.says; }
class BadMolecule : public testing::TestWithParam<Bad> {};
TEST_P(BadMolecule, IsRefusedAtItsPlace) {
  const Bad& bad = GetParam();
  EXPECT_THAT(complaint([&] { scene_of_text(bad.name, bad.text); }),
              AllOf(HasSubstr(bad.name), HasSubstr(bad.says)));
}
INSTANTIATE_TEST_SUITE_P(
    All, BadMolecule,
    testing::Values(Bad{"g.sdf", "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\"/>\n", ":1: is XML"},
                    Bad{"a.xyz", "1000000000\n\nC 0 0 0\n", ":4:"}, Bad{"b.xyz", "two\n\n", ":1:"},
                    Bad{"c.xyz", "1\n\nC 0 0\n", ":3:"}, Bad{"d.xyz", "1\n\nC 0 nan 0\n", ":3:"},
                    Bad{"e.xyz", "0\n\n", "no atoms"},
                    Bad{"a.sdf", "x\n\n\n  2  1\n    0.0       0.0       0.0    C\n", ":6:"},
                    Bad{"b.sdf", "x\n\n\n  1  1\n    0.0       0.0       0.0    C\n  1  2  1\n",
                        ":6:1: a bond of atoms 1 and 2: there are 1"},
                    Bad{"c.sdf", "x\n\n\nabc  1\n", ":4:1: number of atoms"},
                    Bad{"d.sdf", "x\n", ":2:"},
                    Bad{"a.pdb", "HEADER    nothing here\nEND\n", "no atoms"},
                    Bad{"b.pdb", "ATOM      1  CA  ALA A   1\n", ":1:"},
                    Bad{"a.cif", "data_x\nloop_\n_atom_site.id\n_atom_site.Cartn_x\n1\n", "a.cif"},
                    Bad{"b.cif", "this is no cif file\n", ":1:"},
                    Bad{"c.cif", "data_x\n_cell.length_a 3\n", "no atoms"}),
    [](const auto& of) {
      std::string name = of.param.name;
      name[1] = '_';
      return name;
    });

TEST(Options, SayWhatTheyDoNotFit) {
  EXPECT_THAT(complaint([] {
                scene_of(test::source_folder() / "scenes/neuron.swc", {{{"style", "sticks"}}});
              }),
              AllOf(HasSubstr("--style"), HasSubstr("swc"), HasSubstr("pdb")));
  EXPECT_THAT(complaint([] {
                scene_of_text("x.xyz", "1\n\nC 0 0 0\n", {{{"style", "round"}}});
              }),
              AllOf(HasSubstr("--style"), HasSubstr("ball-and-stick")));
  EXPECT_THAT(complaint([] {
                scene_of_text("x.xyz", "1\n\nC 0 0 0\n", {{{"style", "trace"}}});
              }),
              HasSubstr("--style"));
  EXPECT_THAT(complaint([] {
                scene_of_text("x.xyz", "1\n\nC 0 0 0\n", {{{"color", "bfactor"}}});
              }),
              HasSubstr("--color"));
  EXPECT_THAT(complaint([] {
                scene_of_text("x.xyz", "1\n\nC 0 0 0\n", {{{"model", "0"}}});
              }),
              HasSubstr("--model"));
}

}  // namespace
}  // namespace caplet
