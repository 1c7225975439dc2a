// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Selections of atoms beside MDAnalysis, and the representations of --show.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <random>

#include "import/detail/molecule.h"
#include "import/detail/selection.h"
#include "import/import.h"
#include "peptide.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/log_of.h"

namespace caplet {
namespace selection_test {
namespace {

using test::complaint;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<Secondary>& no_secondary() {
  static const std::vector<Secondary> none;
  ADD_FAILURE() << "the selection does not ask for helices";
  return none;
}

std::vector<std::size_t> chosen(const Molecule& molecule, const std::string& text,
                                const std::vector<Secondary>& secondary = {}) {
  const std::vector<bool> marks =
      selected_atoms(molecule, text, [&]() -> const std::vector<Secondary>& {
        return secondary.empty() ? no_secondary() : secondary;
      });
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i]) out.push_back(i);
  return out;
}

struct Count {
  const char* selection;
  std::size_t atoms;
};

// MDAnalysis 2.11.0 counts these of 4hhb.pdb with periodic=False. Its words are chainID, "prop
// tempfactor" and "same residue as", and parentheses stand where "and" binds before "or".
TEST(Selection, HasTheAtomsThatMdanalysisFinds) {
  CAPLET_NEEDS_DATA();
  const std::filesystem::path path = test::data_folder() / "mol/pdb/4hhb.pdb";
  std::ifstream stream(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const Molecule molecule = read_pdb(text, path.string(), {});
  for (const auto& [selection, atoms] :
       std::initializer_list<Count>{{"all", 4779},
                                    {"none", 0},
                                    {"protein", 4384},
                                    {"polymer", 4384},
                                    {"nucleic", 0},
                                    {"ligand", 174},
                                    {"water", 221},
                                    {"solvent", 221},
                                    {"chain A", 1168},
                                    {"chain A B", 2392},
                                    {"chain A+B", 2392},
                                    {"chainid A,B", 2392},
                                    {"resname HEM", 172},
                                    {"resn hem", 172},
                                    {"resname H*", 775},
                                    {"resid 10:20", 320},
                                    {"resi 10-20", 320},
                                    {"resid 10:20 25", 336},
                                    {"resi 10-20+25", 336},
                                    {"name CA", 574},
                                    {"name C*", 2954},
                                    {"element N Fe", 784},
                                    {"protein and not name CA C N O", 2088},
                                    {"around 5 resname HEM", 362},
                                    {"within 5 of resname HEM", 534},
                                    {"byres around 5 resname HEM", 778},
                                    {"bfactor > 30", 1214},
                                    {"b <= 12.5", 464},
                                    {"chain B and resid 1:50 and (name CA or name CB)", 95},
                                    {"chain A or chain B and name CA", 1314},
                                    {"not chain A B C", 1216},
                                    {"NOT (Chain A B C)", 1216},
                                    {"around 20 (chain A and resid 1)", 1050},
                                    {"backbone", 2296}})
    EXPECT_EQ(chosen(molecule, selection).size(), atoms) << selection;
}

/// Two glycines, a nucleotide, a haem's iron and a water, each with a number of its own.
Molecule small_molecule() {
  const std::string text = test::pdb_line(1, "N", "GLY", 'A', -3, {0, 0, 0}, 10, ' ', "N") +
                           test::pdb_line(2, "CA", "GLY", 'A', -3, {1.5, 0, 0}, 20, ' ', "C") +
                           test::pdb_line(3, "H", "GLY", 'A', -3, {0, 1, 0}, 30, ' ', "H") +
                           test::pdb_line(4, "CA", "GLY", 'A', 7, {5, 0, 0}, 40, 'B', "C") +
                           test::pdb_line(5, "P", " DA", 'b', 8, {20, 0, 0}, 50, ' ', "P") +
                           test::pdb_line(6, "N9", " DA", 'b', 8, {22, 0, 0}, 60, ' ', "N") +
                           "TER\n" +
                           test::pdb_line(7, "FE", "HEM", 'C', 9, {30, 0, 0}, 70, ' ', "FE") +
                           test::pdb_line(8, "O", "HOH", 'C', 10, {33, 4, 0}, 80, ' ', "O");
  return read_pdb(text, "small.pdb", {});
}

TEST(Selection, OfEachWordIsItsAtoms) {
  const Molecule molecule = small_molecule();
  ASSERT_EQ(molecule.atoms.size(), 8U);
  ASSERT_EQ(molecule.residues.size(), 5U);
  const auto atoms = [&](const std::string& text) { return chosen(molecule, text); };
  EXPECT_THAT(atoms("protein"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(atoms("nucleic"), ElementsAre(4, 5));
  EXPECT_THAT(atoms("polymer"), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(atoms("organic"), ElementsAre(6));
  EXPECT_THAT(atoms("water"), ElementsAre(7));
  EXPECT_THAT(atoms("hydrogen"), ElementsAre(2));
  EXPECT_THAT(atoms("backbone"), ElementsAre(0, 1, 3, 4));
  EXPECT_THAT(atoms("chain b"), ElementsAre(4, 5));
  EXPECT_THAT(atoms("chain B"), ElementsAre());
  EXPECT_THAT(atoms("resid -3"), ElementsAre(0, 1, 2));
  EXPECT_THAT(atoms("resid -5--3"), ElementsAre(0, 1, 2));
  EXPECT_THAT(atoms("resid -5:7"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(atoms("resid 7B"), ElementsAre(3));
  EXPECT_THAT(atoms("resid 7C"), ElementsAre());
  EXPECT_THAT(atoms("elem fe"), ElementsAre(6));
  EXPECT_THAT(atoms("bfactor < 20"), ElementsAre(0));
  EXPECT_THAT(atoms("bfactor<=20"), ElementsAre(0, 1));
  EXPECT_THAT(atoms("bfactor = 20"), ElementsAre(1));
  EXPECT_THAT(atoms("bfactor == 20"), ElementsAre(1));
  EXPECT_THAT(atoms("bfactor != 20 and protein"), ElementsAre(0, 2, 3));
  EXPECT_THAT(atoms("b >= 70"), ElementsAre(6, 7));
  EXPECT_THAT(atoms("b>70"), ElementsAre(7));
  EXPECT_THAT(atoms("not not water"), ElementsAre(7));
  EXPECT_THAT(atoms("within 5 of ligand"), ElementsAre(6, 7));
  EXPECT_THAT(atoms("within 4.999 of ligand"), ElementsAre(6));
  EXPECT_THAT(atoms("around 5 ligand"), ElementsAre(7));
  EXPECT_THAT(atoms("within 0 of water"), ElementsAre(7));
  EXPECT_THAT(atoms("within 1e6 of water").size(), 8U);
  EXPECT_THAT(atoms("byres hydrogen"), ElementsAre(0, 1, 2));
  EXPECT_THAT(atoms("water or protein and hydrogen"), ElementsAre(2, 7));
  EXPECT_THAT(atoms("(water or protein) and hydrogen"), ElementsAre(2));
  std::string many = "water";
  for (int i = 0; i < 200; ++i) many += " or not protein and water";
  EXPECT_THAT(atoms(many), ElementsAre(7));
  const std::vector<Secondary> secondary = {Secondary::helix, Secondary::strand, Secondary::coil,
                                            Secondary::coil, Secondary::coil};
  EXPECT_THAT(chosen(molecule, "helix", secondary), ElementsAre(0, 1, 2));
  EXPECT_THAT(chosen(molecule, "strand", secondary), ElementsAre(3));
  EXPECT_THAT(chosen(molecule, "sheet", secondary), ElementsAre(3));
  EXPECT_THAT(chosen(molecule, "coil", secondary), ElementsAre());
}

TEST(Selection, WithinIsThatOfAllPairs) {
  Molecule molecule;
  molecule.chains = {"A"};
  molecule.residues.resize(1);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-20, 20);
  for (int i = 0; i < 1500; ++i) {
    Atom atom;
    atom.position = {place(random), place(random), place(random)};
    molecule.atoms.push_back(atom);
  }
  // Atoms beyond the cells of the search share its outermost ones.
  for (const float far : {1e8F, 1.0001e8F, -1e8F}) {
    Atom atom;
    atom.position = {far, 0, 0};
    molecule.atoms.push_back(atom);
  }
  std::vector<bool> marked(molecule.atoms.size(), false);
  for (std::size_t i = 0; i < 40; ++i) marked[i] = true;
  marked[1500] = true;
  for (const float distance : {0.0F, 0.4F, 3.0F, 11.0F, 30.0F, 20000.0F}) {
    const std::vector<bool> near = atoms_within(molecule, marked, distance);
    for (std::size_t i = 0; i < near.size(); ++i) {
      bool expected = false;
      for (std::size_t j = 0; j < near.size(); ++j) {
        const glm::vec3 d = molecule.atoms[i].position - molecule.atoms[j].position;
        expected |= marked[j] && glm::dot(d, d) <= distance * distance;
      }
      EXPECT_EQ(near[i], expected) << distance << ", atom " << i;
    }
  }
}

TEST(Selection, MistakesAreToldWithTheirColumn) {
  const Molecule molecule = small_molecule();
  const auto told = [&](const std::string& text) {
    return complaint([&] { chosen(molecule, text); });
  };
  EXPECT_THAT(told("protien"), AllOf(HasSubstr("--show"), HasSubstr("column 1 ('protien')"),
                                     HasSubstr("the nearest is 'protein'")));
  EXPECT_THAT(told("water and solvnt"),
              AllOf(HasSubstr("column 11 ('solvnt')"), HasSubstr("'solvent'")));
  EXPECT_THAT(told(""), HasSubstr("column 1: a selection is missing here"));
  EXPECT_THAT(told("water and"), HasSubstr("column 10: a selection is missing here"));
  EXPECT_THAT(told("(water"), HasSubstr("')' is missing"));
  EXPECT_THAT(told("water)"), HasSubstr("column 6 (')'): 'and', 'or' or the end"));
  EXPECT_THAT(told("water protein"), HasSubstr("column 7 ('protein'): 'and', 'or' or the end"));
  EXPECT_THAT(told("chain"), HasSubstr("values are missing"));
  EXPECT_THAT(told("resid ten"), HasSubstr("column 7 ('ten'): 'ten' is no number of a residue"));
  EXPECT_THAT(told("resid 10-"), HasSubstr("'10-' is no number of a residue"));
  EXPECT_THAT(told("element Xx"), HasSubstr("'Xx' is no element"));
  EXPECT_THAT(told("within of water"), HasSubstr("column 8 ('of'): a distance in angstroms"));
  EXPECT_THAT(told("within -1 of water"), HasSubstr("a distance in angstroms"));
  EXPECT_THAT(told("within nan of water"), HasSubstr("a distance in angstroms"));
  EXPECT_THAT(told("within 5 water"), HasSubstr("'of' and a selection are missing"));
  EXPECT_THAT(told("bfactor 5"), HasSubstr("one of < <= > >= = != is missing"));
  EXPECT_THAT(told("bfactor > high"), HasSubstr("a number is missing here"));
  EXPECT_THAT(told(std::string(1000, '(')), HasSubstr("more than 100 operations"));
  std::string deep;
  for (int i = 0; i < 101; ++i) deep += "not ";
  EXPECT_THAT(told(deep + "water"), HasSubstr("more than 100 operations"));
}

// --- Representations ---

Scene shown(const std::string& show, ImportOptions options = {}) {
  const std::vector<test::BackboneAtoms> backbone = test::backbone(12, -57, -47);
  std::string text = test::lines_of(backbone, 'A', 1);
  text +=
      "HETATM  900 FE   HEM B 200       9.000   4.000   9.000  1.00 20.00          FE\n"
      "HETATM  901  NA  HEM B 200      11.000   4.000   9.000  1.00 20.00           N\n";
  if (!show.empty()) options.set("show", show);
  return import_scene(test::write_file("shown.pdb", text), test::NoImages(), options);
}
std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const Shape& shape : scene.shapes) out.push_back(shape.name);
  return out;
}
std::size_t count_of(const Shape& shape) {
  return std::get<CapsulesShape>(shape.geometry).p0.size();
}

TEST(Representations, DrawEachPartInItsStyle) {
  const Scene scene = shown("polymer: trace; ligand: ball-and-stick by element");
  EXPECT_THAT(names_of(scene), ElementsAre("chain A trace", "chain B atoms", "chain B bonds"));
  const auto& balls = std::get<CapsulesShape>(scene.shapes[1].geometry);
  EXPECT_EQ(count_of(scene.shapes[1]), 2U);
  EXPECT_EQ(count_of(scene.shapes[2]), 2U);
  EXPECT_FLOAT_EQ(balls.radius0[0], 0.25F * van_der_waals_radius(26));
  EXPECT_EQ(scene.materials[balls.materials[0]].name, "Fe");
  const auto& trace = std::get<CapsulesShape>(scene.shapes[0].geometry);
  EXPECT_EQ(scene.materials[trace.materials[0]].name, "chain A");
  EXPECT_FALSE(scene.shapes[0].alpha);
}

TEST(Representations, MayDrawAnAtomSeveralTimes) {
  const Scene scene = shown("all: sticks\nligand: spheres opacity 0.25");
  ASSERT_EQ(scene.shapes.size(), 5U);
  EXPECT_EQ(scene.shapes[4].name, "chain B atoms");
  EXPECT_EQ(count_of(scene.shapes[4]), 2U);
  ASSERT_TRUE(scene.shapes[4].alpha);
  EXPECT_EQ(std::get<ConstantSpectrum>(scene.shapes[4].alpha->value).value, 0.25);
  EXPECT_FALSE(scene.shapes[2].alpha);
  // Both are by element, so they share their materials.
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[4].geometry).materials,
            std::get<CapsulesShape>(scene.shapes[2].geometry).materials);
}

TEST(Representations, LeaveOutWhatIsNotSelected) {
  const auto kept = [&](const std::string& show) {
    std::size_t out = 0;
    for (const Shape& shape : shown(show).shapes) out += count_of(shape);
    return out;
  };
  EXPECT_EQ(kept("name CA: spheres"), 12U);
  EXPECT_EQ(kept("name CA and resid 3-5: spheres; resid 7: spheres"), 3U + 4U);
  // Three atoms and two bonds; the third bond's other end is not selected.
  EXPECT_EQ(kept("resid 4 and name N CA C: sticks by chain"), 5U);
  // Six capsules from residue to residue.
  EXPECT_EQ(kept("resid 3-6: trace"), 18U);
  EXPECT_EQ(kept("name N: trace; resid 1-2: trace"), 6U);
}

TEST(Representations, OfCartoonsAreOfTheGuideAtomsSelected) {
  EXPECT_EQ(names_of(shown("resid 2-4: cartoon")),
            (std::vector<std::string>{"chain A ALA 2", "chain A ALA 3", "chain A ALA 4"}));
  EXPECT_EQ(names_of(shown("(resid 2-4 and name CA) or (resid 6 and name N): cartoon")),
            (std::vector<std::string>{"chain A ALA 2", "chain A ALA 3", "chain A ALA 4"}));
}

TEST(Representations, HaveTheColorAskedFor) {
  const auto material = [&](const std::string& show, ImportOptions options = {}) {
    const Scene scene = shown(show, std::move(options));
    const auto& capsules = std::get<CapsulesShape>(scene.shapes.at(0).geometry);
    return scene.materials[capsules.materials[0]];
  };
  EXPECT_EQ(material("ligand: spheres by chain").name, "chain B");
  EXPECT_EQ(material("ligand: spheres by residue").name, "HEM");
  EXPECT_EQ(material("ligand: spheres").name, "Fe");
  EXPECT_EQ(material("resid 6: spheres by secondary").name, "helix");
  EXPECT_EQ(material("ligand: spheres", {{{"color", "residue"}}}).name, "HEM");
  EXPECT_EQ(material("ligand: spheres by element", {{{"color", "residue"}}}).name, "Fe");
  // 255 is 1, 0 is 0 and 188 is 0.5029 in linear sRGB (IEC 61966-2-1).
  const Material fixed = material("ligand: spheres by #FF00bc opacity 1");
  const auto& color = std::get<RgbSpectrum>(std::get<DiffuseMaterial>(fixed.model).reflectance);
  EXPECT_NEAR(color.rgb.x, 1, 1e-6);
  EXPECT_NEAR(color.rgb.y, 0, 1e-6);
  EXPECT_NEAR(color.rgb.z, std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);
  const Scene two = shown("name FE: spheres by #ff0000; name NA: spheres by #00ff00");
  EXPECT_EQ(two.materials.size(), 2U);
}

TEST(Representations, HaveTheLegendOfTheFirstThatHasOne) {
  for (const std::string show : {"polymer: trace; ligand: spheres by bfactor",
                                 "ligand: spheres by bfactor; polymer: trace"}) {
    const Scene scene = shown(show);
    ASSERT_TRUE(scene.legend) << show;
    EXPECT_EQ(scene.legend->title, "B factor");
  }
}

TEST(Representations, ThatSelectNothingAreWarnedOf) {
  test::LogOf log;
  EXPECT_EQ(names_of(shown("all: spheres; water: sticks")).size(), 2U);
  EXPECT_THAT(log.text(), HasSubstr("--show 'water' selects no atoms"));
}

TEST(Representations, OfAllAreThePictureWithoutThem) {
  for (const std::string style : {"ball-and-stick", "spheres", "sticks", "trace", "cartoon"}) {
    const Scene by_show = shown("all: " + style), by_style = shown("", {{{"style", style}}});
    EXPECT_EQ(names_of(by_show), names_of(by_style)) << style;
    EXPECT_EQ(by_show.materials.size(), by_style.materials.size()) << style;
  }
}

TEST(Representations, MistakesAreTold) {
  const auto told = [](const std::string& show, ImportOptions options = {}) {
    return complaint([&] { shown(show, options); });
  };
  EXPECT_THAT(told("all: sticks;  watr : spheres"), HasSubstr("--show: 'watr', column 1 ('watr')"));
  EXPECT_THAT(told("polymer"), HasSubstr("':' and a style are missing"));
  EXPECT_THAT(told("polymer:"), HasSubstr("a style is missing"));
  EXPECT_THAT(told("polymer: carton"),
              AllOf(HasSubstr("--show"), HasSubstr("'carton' is not a style"),
                    HasSubstr("the nearest is 'cartoon'")));
  EXPECT_THAT(told("all: sticks by elemnt"), HasSubstr("the nearest is 'element'"));
  EXPECT_THAT(told("all: sticks by"), HasSubstr("what a color tells is missing"));
  EXPECT_THAT(told("all: sticks by #ff00"), HasSubstr("'#ff00' is no color (#RRGGBB)"));
  EXPECT_THAT(told("all: sticks by #ff00gg"), HasSubstr("'#ff00gg' is no color (#RRGGBB)"));
  EXPECT_THAT(told("all: sticks opacity"), HasSubstr("the opacity is missing"));
  for (const char* const opacity : {"1.5", "-0.1", "half", "nan"})
    EXPECT_THAT(told(fmt::format("all: sticks opacity {}", opacity)),
                HasSubstr(fmt::format("'{}' is no opacity from 0 to 1", opacity)));
  EXPECT_THAT(told("all: sticks red"), HasSubstr("'red' is neither 'by' nor 'opacity'"));
  EXPECT_THAT(told(" ; "), HasSubstr("has no representation"));
  EXPECT_THAT(told("water: spheres"), HasSubstr("selects none of the file's atoms"));
  EXPECT_THAT(told("all: sticks", {{{"style", "sticks"}}}),
              AllOf(HasSubstr("--style"), HasSubstr("--show states the style")));
}

}  // namespace
}  // namespace selection_test
}  // namespace caplet
