// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Secondary structure: by hydrogen bonds beside mkdssp, by the records of files, and what tells
// between them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "import/detail/secondary.h"
#include "import/import.h"
#include "peptide.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet {
namespace secondary_test {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

std::string text_of(const std::string& file) {
  std::ifstream stream(test::data_folder() / "mol/pdb" / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The states of the amino acids whose backbone is complete, which are those that mkdssp lists.
std::string states_of(const Molecule& molecule) {
  const std::string all = dssp_states(molecule, "a.pdb");
  std::string out;
  for (std::size_t r = 0; r < all.size(); ++r)
    if (molecule.residues[r].kind == ResidueKind::amino_acid &&
        backbone_of(molecule, molecule.residues[r]).complete())
      out += all[r] == ' ' ? '-' : all[r];
  return out;
}

/// h: helix, e: strand, by either method.
std::string parts_of(const Molecule& molecule, bool by_file) {
  const std::vector<Secondary> all = secondary_of(molecule, by_file, "a.pdb");
  std::string out;
  for (std::size_t r = 0; r < all.size(); ++r)
    if (molecule.residues[r].kind == ResidueKind::amino_acid)
      out += all[r] == Secondary::helix ? 'h' : all[r] == Secondary::strand ? 'e' : '-';
  return out;
}

std::size_t differing(const std::string& a, const std::string& b) {
  std::size_t out = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) out += a[i] != b[i] ? 1 : 0;
  return out;
}

// --- mkdssp 4.2.2 of Debian 12 ---
// mkdssp --output-format dssp FILE.pdb OUT, column 17 of its lines of residues, where P (helices of
// polyproline), S, T and blank, which the paper's hydrogen bonds do not make helices or strands,
// are
// '-'. Of 1l2y.pdb the lines up to the first ENDMDL.

struct Expected {
  const char* file;
  const char* states;
};
void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }
class Dssp : public testing::TestWithParam<Expected> {};

TEST_P(Dssp, FindsTheStatesOfMkdssp) {
  CAPLET_NEEDS_DATA();
  const Molecule molecule = read_pdb(text_of(GetParam().file), GetParam().file, {});
  const std::string expected = GetParam().states, found = states_of(molecule);
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(found, expected) << differing(found, expected) << " residues differ";
}

INSTANTIATE_TEST_SUITE_P(
    Data, Dssp,
    testing::Values(
        Expected{"1crn.pdb", "-EE---HHHHHHHHHHH-----HHHHHHHH--EE-------GGG--"},
        Expected{"1l2y.pdb", "-HHHHHHH--GGGG------"},
        Expected{"4hhb.pdb",
                 "---HHHHHHHHHHHHHH---HHHHHHHHHHHHHHH-GGGGGG----------HHHHHHHHHHHHHHHHHHH-GGGH"
                 "HHH-HHHHHIIIIII----HHHHHHHHHHHHHHHHH------HHHHHHHHHHHHHHHHHH---------HHHHHHH"
                 "HHHH----HHHHHHHHHHHHHHH-GGGGGG-GGG-----HHHHHH-HHHHHHHHHHHHHHHHHH--GGGHHHHHHH"
                 "HHHIIIIII----HHHHHHHHHHHHHHHHHHGGG--HHHHHHHHHHHHHHHHHHH-------HHHHHHHHHHHHHH"
                 "GGGHHHHHHHHHHHHHHH-GGGGGG----------HHHHHHHHHHHHHHHHHHH-GGGHHHH-HHHHHHIIIII--"
                 "--HHHHHHHHHHHHHHHHH------HHHHHHHHHHHHHHHHHHH--------HHHHHHHHHHH----HHHHHHHHH"
                 "HHHHHH-GGGGGG-GGG-----HHHHH--HHHHHHHHHHHHHHHHHH-----HHHHHHHHHHIIIII-----HHHH"
                 "HHHHHHHHHHHHHHGGG--HHHHHHHHHHHHHHHHHHH----"},
        Expected{"1M4X.pdb",
                 "------------EEEEEEE---B-------EEEEE------EEEEEEEEEEEE----------HHHHHEEEEEEEE"
                 "--EEEEEEEHHHHHHHHHHH--HHHHHHHHHHH----------EEEEEEE---HHHH-GGG-EEGGG-----EEEE"
                 "EEE----B---EE--EE-------EEEEEEEEEEE-HHHHHHHHH--EEEEEEEEEEEEEE----------EEEEE"
                 "-----EEEEEEEEEE--------------------------------GGG-----GGG----EEEEEE--EE----"
                 "EEHHIIIIIHHHH---------EEEEE-------------EEGGG---EEEEEE--EEEE----HHHH------EE"
                 "EGGGGG--EEEEEEEEEEEEEEE--EEEE----------------EEEEEEE---B-------EEEEE------EE"
                 "EEEEEEEEEE----------HHHHHEEEEEEEE--EEEEEEEHHHHHHHHHHH--HHHHHHHHHHH----------"
                 "EEEEEEE---HHHH-GGG-EEGGG-----EEEEEEE----B---EE--EE-------EEEEEEEEEEE-HHHHHHH"
                 "HH--EEEEEEEEEEEEEE----------EEEEE-----EEEEEEEEEE----------------------------"
                 "----GGG-----GGG----EEEEEE--EE----EEHHIIIIIHHHH---------EEEEE-------------EEG"
                 "GG---EEEEEE--EEEE----HHHH------EEEGGGGG--EEEEEEEEEEEEEEE--EEEE--------------"
                 "--EEEEEEE---B-------EEEEE------EEEEEEEEEEEE----------HHHHHEEEEEEEE--EEEEEEEH"
                 "HHHHHHHHHH--HHHHHHHHHHH----------EEEEEEE---HHHH-GGG-EEGGG-----EEEEEEE----B--"
                 "-EE--EE-------EEEEEEEEEEE-HHHHHHHHH--EEEEEEEEEEEEEE----------EEEEE-----EEEEE"
                 "EEEEE--------------------------------GGG-----GGG----EEEEEE--EE----EEHHIIIIIH"
                 "HHH---------EEEEE-------------EEGGG---EEEEEE--EEEE----HHHH------EEEGGGGG--EE"
                 "EEEEEEEEEEEEE--EEEE----"}),
    [](const auto& of) {
      return std::string(of.param.file).substr(0, std::string(of.param.file).find('.'));
    });

// The records are the depositors', by their programs and eyes: the ends of helices and strands
// differ most, and 4hhb.pdb goes on with helices where they become 3-10. The bounds are what
// differs.
struct Records {
  const char* file;
  std::size_t residues, most_that_differ;
};

TEST(SecondaryRecords, AreNearThoseOfHydrogenBonds) {
  CAPLET_NEEDS_DATA();
  for (const Records& of : {Records{"1crn.pdb", 46, 9}, Records{"1l2y.pdb", 20, 4},
                            Records{"4hhb.pdb", 574, 101}, Records{"1M4X.pdb", 1239, 66}}) {
    const Molecule molecule = read_pdb(text_of(of.file), of.file, {});
    const std::string stated = parts_of(molecule, true), found = parts_of(molecule, false);
    EXPECT_EQ(stated.size(), of.residues) << of.file;
    EXPECT_LE(differing(stated, found), of.most_that_differ) << of.file << "\n"
                                                             << stated << "\n"
                                                             << found;
  }
}

// HELIX and SHEET of 1crn.pdb: 7-19, 23-30; 1-4, 32-35. Its mmCIF file says the same.
TEST(SecondaryRecords, AreThoseOfTheFile) {
  CAPLET_NEEDS_DATA();
  const std::string expected = "eeee--hhhhhhhhhhhhh---hhhhhhhh-eeee-----------";
  EXPECT_EQ(parts_of(read_pdb(text_of("1crn.pdb"), "a.pdb", {}), true), expected);
  EXPECT_EQ(parts_of(read_mmcif(text_of("1CRN.cif"), "a.cif", {}), true), expected);
}

// --- Backbones with the torsion angles of textbooks ---

std::string pdb_states(const std::string& text) { return states_of(read_pdb(text, "a.pdb", {})); }

// A helix is two turns and more, whose first residue and last are outside: residues 2 to n - 1
// (Kabsch and Sander 1983, section "Helices").
TEST(DsspRules, FindTheHelicesOfTheirTorsionAngles) {
  const auto states = [](double phi, double psi) {
    return pdb_states(test::lines_of(test::backbone(12, phi, psi)));
  };
  EXPECT_EQ(states(-57, -47), "-HHHHHHHHHH-");
  EXPECT_EQ(states(-49, -26), "-GGGGGGGGGG-");
  EXPECT_EQ(states(-57, -70), "-IIIIIIIIII-");
  EXPECT_EQ(states(-139, 135), "------------");
}

TEST(DsspRules, NeedABackboneWithoutGaps) {
  const std::vector<test::BackboneAtoms> helix = test::backbone(16, -57, -47);
  EXPECT_EQ(pdb_states(test::lines_of(helix)), "-HHHHHHHHHHHHHH-");
  // Two halves whose C and N are further apart than 2.5, though their bonds are there.
  const std::vector<test::BackboneAtoms> first(helix.begin(), helix.begin() + 8),
      second(helix.begin() + 8, helix.end());
  EXPECT_EQ(pdb_states(test::lines_of(first) + test::lines_of(second, 'A', 9, "ALA", {0, 0, 40})),
            "-HHHHHH--HHHHHH-");
  // Where a residue of a pi helix is missing, its neighbours' bonds would make an alpha helix.
  const std::vector<test::BackboneAtoms> pi = test::backbone(16, -57, -70),
                                         before(pi.begin(), pi.begin() + 8),
                                         behind(pi.begin() + 9, pi.end());
  EXPECT_EQ(pdb_states(test::lines_of(before) + test::lines_of(behind, 'A', 10)),
            "-IIIIII--IIIII-");
  // Another chain, or a residue without its oxygen.
  EXPECT_EQ(pdb_states(test::lines_of(first) + test::lines_of(second, 'B', 9)), "-HHHHHH--HHHHHH-");
  std::string bare = test::lines_of(helix);
  const std::size_t oxygen = bare.find("ATOM     36");
  bare.erase(oxygen, bare.find('\n', oxygen) + 1 - oxygen);
  EXPECT_EQ(pdb_states(bare), "-HHHHHH--HHHHH-");
}

// A peptide bond is at most 2.5 long; the bonds across the longer one are still there.
TEST(DsspRules, PeptideBondsHaveALength) {
  const std::vector<test::BackboneAtoms> helix = test::backbone(16, -57, -47);
  const std::vector<test::BackboneAtoms> first(helix.begin(), helix.begin() + 8),
      second(helix.begin() + 8, helix.end());
  const auto states = [&](double length) {
    const glm::dvec3 bond = second[0].n - first[7].c;
    return pdb_states(
        test::lines_of(first) +
        test::lines_of(second, 'A', 9, "ALA", (length / glm::length(bond) - 1) * bond));
  };
  EXPECT_EQ(states(2.49), "-HHHHHHHHHHHHHH-");
  EXPECT_EQ(states(2.51), "-HHHHHH--HHHHHH-");
}

// Where mkdssp 4.2.2 decides by its rounding of energies, or joins two bridges that share a
// residue. The first are residues 35 to 38 and 42 to 45 of chain D of 1BD2, 43 a proline; the
// others are pieces of proteins whose atoms were moved at random.
TEST(DsspRules, AreThoseOfMkdsspAtTheirLimits) {
  using test::BackboneAtoms;
  // One bond of a strand has -0.50002, which is no bond to the thousandth.
  const std::vector<BackboneAtoms> strand = {
      {{-8.598, 37.838, 16.182},
       {-8.390, 38.522, 14.909},
       {-9.596, 38.257, 14.022},
       {-10.182, 37.171, 14.069}},
      {{-9.978, 39.269, 13.252},
       {-11.113, 39.211, 12.327},
       {-10.497, 39.356, 10.937},
       {-9.664, 40.238, 10.730}},
      {{-10.897, 38.518, 9.985},
       {-10.316, 38.579, 8.641},
       {-11.325, 38.766, 7.524},
       {-12.230, 37.947, 7.373}},
      {{-11.178, 39.829, 6.736},
       {-12.095, 40.058, 5.617},
       {-11.510, 39.400, 4.366},
       {-10.306, 39.165, 4.312}},
      {{-5.666, 41.100, 4.862},
       {-4.953, 40.450, 5.948},
       {-5.734, 40.504, 7.247},
       {-6.675, 41.298, 7.371}},
      {{-5.439, 39.609, 8.202},
       {-6.141, 39.598, 9.493},
       {-5.962, 40.908, 10.314},
       {-4.859, 41.483, 10.371}},
      {{-7.053, 41.360, 10.941},
       {-7.073, 42.574, 11.769},
       {-7.254, 42.210, 13.248},
       {-8.056, 41.323, 13.589}},
      {{-6.493, 42.886, 14.109},
       {-6.574, 42.682, 15.545},
       {-7.983, 43.094, 15.923},
       {-8.428, 44.177, 15.544}},
  };
  const auto part = [&](std::ptrdiff_t from, std::ptrdiff_t to, int first, const char* residue) {
    return test::lines_of({strand.begin() + from, strand.begin() + to}, 'D', first, residue);
  };
  EXPECT_EQ(pdb_states(part(0, 4, 35, "ALA") + part(4, 5, 42, "ALA") + part(5, 6, 43, "PRO") +
                       part(6, 8, 44, "ALA")),
            "-B----B-");
  // One of a helix has -0.5005.
  const std::vector<BackboneAtoms> helix = {
      {{-2.881, -56.788, 14.132},
       {-1.713, -57.108, 15.398},
       {-1.555, -58.706, 15.258},
       {-2.421, -59.096, 14.528}},
      {{-0.709, -59.030, 15.910},
       {-0.392, -60.882, 15.695},
       {-1.594, -61.660, 16.214},
       {-1.775, -62.684, 15.444}},
      {{-1.919, -61.134, 17.294},
       {-3.120, -61.693, 18.044},
       {-4.196, -61.908, 17.020},
       {-4.958, -62.834, 17.122}},
      {{-4.578, -61.122, 16.301},
       {-5.299, -61.032, 15.285},
       {-5.471, -61.835, 13.933},
       {-6.778, -62.017, 13.576}},
      {{-4.714, -61.945, 13.860},
       {-3.786, -62.659, 12.755},
       {-4.110, -64.401, 13.175},
       {-4.310, -65.054, 12.047}},
      {{-3.804, -64.617, 14.461},
       {-3.661, -66.177, 14.735},
       {-5.234, -66.398, 14.957},
       {-5.243, -67.559, 13.995}},
  };
  EXPECT_EQ(pdb_states(test::lines_of(helix)), "------");
  const std::vector<BackboneAtoms> bulge = {
      {{-16.793, 22.609, 19.634},
       {-15.781, 23.973, 16.128},
       {-15.809, 24.894, 14.945},
       {-14.871, 25.688, 19.227}},
      {{-15.199, 23.694, 16.519},
       {-14.849, 25.757, 15.309},
       {-14.168, 23.650, 14.404},
       {-11.456, 23.847, 14.962}},
      {{-12.561, 24.560, 15.035},
       {-11.610, 23.629, 15.850},
       {-11.413, 21.478, 15.198},
       {-11.648, 19.712, 14.750}},
      {{-9.486, 22.045, 14.435},
       {-9.205, 20.462, 15.173},
       {-9.770, 19.983, 15.149},
       {-9.002, 18.311, 16.122}},
      {{-12.578, 19.372, 9.776},
       {-13.000, 19.739, 12.247},
       {-14.035, 21.352, 13.134},
       {-16.232, 21.025, 11.850}},
      {{-13.615, 19.638, 13.250},
       {-15.364, 20.407, 13.718},
       {-15.456, 20.369, 12.995},
       {-16.930, 23.395, 13.924}},
      {{-17.172, 20.796, 11.607},
       {-19.790, 20.589, 13.066},
       {-19.536, 21.177, 13.406},
       {-20.367, 19.175, 12.897}},
  };
  EXPECT_EQ(pdb_states(test::lines_of({bulge.begin(), bulge.begin() + 4}, 'A', 45) +
                       test::lines_of({bulge.begin() + 4, bulge.end()}, 'A', 86)),
            "-EE--E-");
}

// gemmi does not list all modified amino acids: the backbone tells, and that it is bound.
TEST(DsspRules, KnowModifiedResidues) {
  const std::vector<test::BackboneAtoms> helix = test::backbone(12, -57, -47);
  const auto part = [&](std::ptrdiff_t from, std::ptrdiff_t to, const char* residue) {
    return test::lines_of({helix.begin() + from, helix.begin() + to}, 'A',
                          static_cast<int>(from) + 1, residue);
  };
  EXPECT_EQ(pdb_states(part(0, 5, "ALA") + part(5, 6, "28J") + part(6, 12, "ALA")), "-HHHHHHHHHH-");
  EXPECT_EQ(pdb_states(part(0, 11, "ALA") + part(11, 12, "28J")), "-HHHHHHHHHH-");
  EXPECT_EQ(pdb_states(part(0, 1, "28J") + part(1, 12, "ALA")), "-HHHHHHHHHH-");
  const Molecule apart =
      read_pdb(part(0, 4, "ALA") +
                   test::lines_of({helix.begin(), helix.begin() + 1}, 'A', 9, "28J", {9, 9, 9}),
               "a.pdb", {});
  EXPECT_EQ(apart.residues.back().kind, ResidueKind::other);
}

// Proline has no hydrogen to give.
TEST(DsspRules, ProlineGivesNoBond) {
  EXPECT_EQ(pdb_states(test::lines_of(test::backbone(12, -57, -47), 'A', 1, "PRO")),
            "------------");
}

TEST(DsspRules, OfAlphaCarbonsAlone) {
  std::string text;
  int serial = 1;
  for (const test::BackboneAtoms& atoms : test::backbone(12, -57, -47)) {
    text += test::pdb_line(serial, "CA", "ALA", 'A', serial, atoms.ca, 0, ' ', "C");
    ++serial;
  }
  const Molecule molecule = read_pdb(text, "a.pdb", {});
  EXPECT_EQ(parts_of(molecule, false), "------------");
}

// More than 256 alpha carbons in a cell of 9 angstroms are of another unit.
TEST(DsspRules, CrowdsHaveNoBonds) {
  const auto crowd = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += test::lines_of(test::backbone(1, -57, -47), 'A', i + 1);
    return parts_of(read_pdb(text, "crowd.pdb", {}), false);
  };
  test::LogOf log;
  crowd(256);
  EXPECT_EQ(log.text(), "");
  EXPECT_EQ(crowd(257), std::string(257, '-'));
  EXPECT_THAT(log.text(), HasSubstr("a.pdb: 257 alpha carbons within 9.0 angstroms of each "
                                    "other: no helices and strands are found"));
}

// --- Records ---

std::string helix_record(int cls, char chain, const std::string& from, const std::string& to) {
  return fmt::format("HELIX    1   1 ALA {} {:>5} ALA {} {:>5}{:2}{:30} {:5}\n", chain, from, chain,
                     to, cls, "", 4);
}
std::string sheet_record(char chain, const std::string& from, const std::string& to) {
  return fmt::format("SHEET    1   A 1 ALA {}{:>5} ALA {}{:>5} 0{:40}\n", chain, from, chain, to,
                     "");
}
std::string stated(const std::string& records, const std::string& atoms) {
  return parts_of(read_pdb(records + atoms, "a.pdb", {}), true);
}

// wwPDB's format, version 3.3: the insertion code follows the number. Class 10 is polyproline.
TEST(SecondaryRecords, OfPdbGoByNumbersAndCodes) {
  std::string atoms;
  int serial = 1;
  for (const std::string number : {"1 ", "2 ", "2B", "2A", "3 ", "4 ", "6 "}) {
    atoms += test::pdb_line(serial, "CA", "ALA", 'A', number[0] - '0', {3.8 * serial, 0, 0}, 0,
                            number[1], "C");
    ++serial;
  }
  EXPECT_EQ(stated(helix_record(1, 'A', "2 ", "4 "), atoms), "-hhhhh-");
  EXPECT_EQ(stated(helix_record(1, 'A', "2B", "3 "), atoms), "--hhh--");
  EXPECT_EQ(stated(helix_record(5, 'A', "1 ", "2B"), atoms), "hhh----");
  EXPECT_EQ(stated(helix_record(10, 'A', "1 ", "4 "), atoms), "-------");
  EXPECT_EQ(stated(helix_record(1, 'B', "1 ", "4 "), atoms), "-------");
  // Ends that no residue has, and an end before the beginning.
  EXPECT_EQ(stated(helix_record(1, 'A', "0 ", "5 "), atoms), "hhhhhh-");
  EXPECT_EQ(stated(helix_record(1, 'A', "4 ", "1 "), atoms), "-------");
  EXPECT_EQ(stated(sheet_record('A', "4 ", "9 "), atoms), "-----ee");
  // A helix counts before a strand; ranges may meet and overlap.
  EXPECT_EQ(stated(sheet_record('A', "1 ", "3 ") + sheet_record('A', "2 ", "4 ") +
                       helix_record(1, 'A', "4 ", "6 "),
                   atoms),
            "eeeeehh");
}

// AlphaFold's files say strands in _struct_conf. PP is polyproline.
TEST(SecondaryRecords, OfMmcifMayBeStrandsInStructConf) {
  std::string text =
      "data_x\nloop_\n_struct_conf.conf_type_id\n_struct_conf.beg_auth_asym_id\n"
      "_struct_conf.beg_auth_seq_id\n_struct_conf.end_auth_seq_id\n"
      "HELX_RH_AL_P A 1 2\nSTRN A 4 5\nHELX_LH_PP_P A 6 6\nTURN_TY1_P A 3 3\nHELX_RH_AL_P A x 7\n"
      "loop_\n_atom_site.id\n_atom_site.type_symbol\n_atom_site.label_atom_id\n"
      "_atom_site.label_comp_id\n_atom_site.auth_asym_id\n_atom_site.auth_seq_id\n"
      "_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
  for (int i = 1; i <= 7; ++i) text += fmt::format("{} C CA ALA A {} {} 0 0\n", i, i, 3.8 * i);
  EXPECT_EQ(parts_of(read_mmcif(text, "a.cif", {}), true), "hh-ee--");
}

TEST(SecondaryRecords, CanBeIgnored) {
  const std::string atoms = test::lines_of(test::backbone(12, -57, -47));
  const auto colors = [](const std::string& text, ImportOptions options) {
    options.set("style", "cartoon");
    options.set("color", "secondary");
    const Scene scene = import_scene(test::write_file("a.pdb", text), test::NoImages(), options);
    std::string out;
    for (const Shape& shape : scene.shapes) out += scene.materials[shape.material].name[0];
    return out;
  };
  const std::string whole = sheet_record('A', "3 ", "5 ") + atoms;
  EXPECT_EQ(colors(whole, {}), "ccsssccccccc");
  EXPECT_EQ(colors(whole, {{{"secondary", "file"}}}), "ccsssccccccc");
  EXPECT_EQ(colors(whole, {{{"secondary", "dssp"}}}), "chhhhhhhhhhc");
  EXPECT_EQ(colors(atoms, {}), "chhhhhhhhhhc");
  EXPECT_THAT(complaint([&] {
                colors(atoms, {{{"secondary", "file"}}});
              }),
              AllOf(HasSubstr("--secondary"), HasSubstr("no records of helices and strands")));
  EXPECT_THAT(complaint([&] {
                colors(atoms, {{{"secondary", "stride"}}});
              }),
              AllOf(HasSubstr("--secondary"), HasSubstr("'stride' is none of: file, dssp")));
}
}  // namespace
}  // namespace secondary_test
}  // namespace caplet
