// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Charges and radii of PQR and other formats, and colours that show numbers of atoms.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "import/detail/molecule.h"
#include "import/import.h"
#include "peptide.h"
#include "support/import_files.h"

namespace caplet::values_test {

using test::complaint;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Scene scene_of(const std::string& name, const std::string& text, const ImportOptions& options) {
  return import_scene(test::write_file(name, text), test::NoImages(), options);
}

/// The names of the materials of a shape's balls.
std::vector<std::string> materials_of(const Scene& scene, std::size_t shape = 0) {
  std::vector<std::string> out;
  for (const std::uint32_t m : std::get<CapsulesShape>(scene.shapes.at(shape).geometry).materials)
    out.push_back(scene.materials.at(m).name);
  return out;
}

glm::dvec3 color_of(const Scene& scene, const std::string& material) {
  for (const Material& m : scene.materials)
    if (m.name == material)
      return std::get<RgbSpectrum>(std::get<DiffuseMaterial>(m.model).reflectance).rgb;
  ADD_FAILURE() << "no material " << material;
  return {};
}

/// Three atoms of a residue, and an ion of another chain.
const std::string pqr =
    "REMARK   1 ATOM lines begin below\n"
    "ATOM      1  N   THR A   1      17.047  14.099   3.625 -0.3200 2.0000\n"
    "ATOM      2  CA  THR A   1      16.967  12.784   4.338  0.1600 1.7000\n"
    "ATOM      3 1HB  THR A   1      15.685  12.755   5.133  0.0000 0.0000\n"
    "TER\n"
    "HETATM    4  CA   CA B  33A      1.5    -2.25    3e0     0.64   1.25\n"
    "END\n";

TEST(Pqr, HasAtomsWithChargesAndRadii) {
  const Molecule molecule = read_pqr(pqr, "a.pqr", {});
  ASSERT_EQ(molecule.atoms.size(), 4U);
  EXPECT_EQ(molecule.atoms[0].position, glm::vec3(17.047F, 14.099F, 3.625F));
  EXPECT_EQ(molecule.atoms[3].position, glm::vec3(1.5F, -2.25F, 3));
  const auto field = [&](auto Atom::*of) {
    std::vector<double> out;
    for (const Atom& atom : molecule.atoms) out.push_back(static_cast<double>(atom.*of));
    return out;
  };
  EXPECT_THAT(field(&Atom::element), ElementsAre(7, 6, 1, 20));
  EXPECT_THAT(field(&Atom::charge), ElementsAre(-0.32F, 0.16F, 0, 0.64F));
  EXPECT_THAT(field(&Atom::radius), ElementsAre(2, 1.7F, 0, 1.25));
  EXPECT_TRUE(molecule.has_charges);
  ASSERT_EQ(molecule.residues.size(), 2U);
  EXPECT_EQ(molecule.residues[0].name, "THR");
  EXPECT_EQ(molecule.residues[0].number, "1");
  EXPECT_EQ(molecule.residues[1].number, "33A");
  EXPECT_THAT(molecule.chains, ElementsAre("A", "B"));
  EXPECT_EQ(molecule.atom_names, (std::vector<std::string>{"N", "CA", "1HB", "CA"}));
}

// An atom that is left out does not move the values of those after it.
TEST(Pqr, KeepsValuesByAtom) {
  const Molecule molecule = read_pqr(pqr, "a.pqr", {{{"hydrogens", "no"}, {"select", "//B"}}});
  ASSERT_EQ(molecule.atoms.size(), 1U);
  EXPECT_EQ(molecule.atoms[0].charge, 0.64F);
  EXPECT_EQ(molecule.atoms[0].radius, 1.25F);
}

TEST(Pqr, NeedsNoChains) {
  const Molecule molecule =
      read_pqr("ATOM 7 CL LIG 5 1 2 3 -1 1.75\nATOM 9 C1 LIG 5 4 5 6 1 1.7\n", "a.pqr", {});
  ASSERT_EQ(molecule.atoms.size(), 2U);
  EXPECT_THAT(molecule.chains, ElementsAre(""));
  EXPECT_EQ(molecule.residues.size(), 1U);
  EXPECT_EQ(molecule.residues[0].number, "5");
  EXPECT_EQ(molecule.atoms[0].element, 17);
  EXPECT_EQ(molecule.atoms[1].element, 6);
}

TEST(Pqr, DrawsBallsOfItsRadii) {
  const auto radii = [](const std::string& style, std::size_t shape) {
    return std::get<CapsulesShape>(
               scene_of("a.pqr", pqr, {{{"style", style}}}).shapes.at(shape).geometry)
        .radius0;
  };
  EXPECT_THAT(radii("spheres", 0), ElementsAre(2, 1.7F));
  EXPECT_THAT(radii("spheres", 1), ElementsAre(1.25F));
  EXPECT_THAT(radii("accessible", 0), ElementsAre(3.4F, 3.1F, 1.4F));
  const Scene surface = scene_of("a.pqr", pqr, {{{"style", "surface"}}});
  for (const Shape& shape : surface.shapes)
    if (const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry)) {
      EXPECT_EQ(molecule->radii, (std::vector<float>{2, 1.7F}));
      return;
    }
  ADD_FAILURE() << "no surface";
}

TEST(Pqr, MistakesAreToldWithTheirLine) {
  const auto told = [](const std::string& line) {
    return complaint(
        [&] { read_pqr("ATOM 1 N THR A 1 1 2 3 -0.3 2\n" + line + "\n", "a.pqr", {}); });
  };
  EXPECT_THAT(told("ATOM 1 N THR A 1 17.0 14.0 3.6 -0.3"),
              HasSubstr("a.pqr:2: 'A' is no number of a residue"));
  EXPECT_THAT(told("ATOM 1 N THR 1 17.0 14.0 3.6 -0.3"),
              AllOf(HasSubstr("a.pqr:2"), HasSubstr("9 fields")));
  EXPECT_THAT(told("ATOM 1 N THR A 1 17.0 14.0 3.6 -0.3 2 N"), HasSubstr("12 fields"));
  EXPECT_THAT(told("ATOM 1 N THR A 1 17.0 14.0 3.6 -0.3x 2"), HasSubstr("'-0.3x'"));
  EXPECT_THAT(told("ATOM 1 N THR A 1 17.0 nan 3.6 -0.3 2"), HasSubstr("'nan'"));
  EXPECT_THAT(told("ATOM 1 N THR A 1 17.0 14.0 3.6 -0.3 -2"),
              HasSubstr("a.pqr:2: the radius is negative"));
  EXPECT_THAT(complaint([] { read_pqr("REMARK\n", "a.pqr", {}); }), HasSubstr("holds no atoms"));
  // Nothing of a file that is no PQR is shown.
  EXPECT_THAT(complaint([] { read_pqr("ATOM 1 N THR A secret 1 2 3 4 5\n", "a.pqr", {}); }),
              HasSubstr("a.pqr:1: '...' is no number"));
}

// Of atom blocks: 1 to 3 are +3 to +1, 4 is a radical, 5 to 7 are -1 to -3 (CTfile formats). A
// line "M  CHG" replaces them all.
TEST(Charges, OfSdf) {
  const auto charges = [](const std::string& text) {
    const Molecule molecule = read_sdf(text, "a.sdf", {});
    std::vector<float> out;
    for (const Atom& atom : molecule.atoms) out.push_back(atom.charge);
    return std::pair(out, molecule.has_charges);
  };
  std::string atoms;
  for (const int code : {0, 1, 2, 3, 4, 5, 6, 7})
    atoms += fmt::format("{:10.4f}{:10.4f}{:10.4f} C   0{:3}  0\n", 1.0 * code, 0.0, 0.0, code);
  const std::string head = "name\n\n\n  8  0  0  0  0  0  0  0  0  0999 V2000\n";
  using Charges = std::vector<float>;
  EXPECT_EQ(charges(head + atoms + "M  END\n"),
            std::pair(Charges({0, 3, 2, 1, 0, -1, -2, -3}), true));
  EXPECT_EQ(charges(head + atoms + "M  CHG  2   1   1   8  -2\nM  CHG  1   3   4\nM  END\n"),
            std::pair(Charges({1, 0, 4, 0, 0, 0, 0, -2}), true));
  const std::string neutral =
      "name\n\n\n  1  0  0  0  0  0  0  0  0  0999 V2000\n    0.0000    0.0000    0.0000 C\nM  "
      "END\n";
  EXPECT_EQ(charges(neutral), std::pair(Charges({0}), false));
  EXPECT_EQ(charges("name\n\n\n  0  0  0  0  0  0  0  0  0  0999 V3000\nM  V30 BEGIN CTAB\n"
                    "M  V30 COUNTS 2 0 0 0 0\nM  V30 BEGIN ATOM\nM  V30 1 C 0 0 0 0\n"
                    "M  V30 2 N 0 0 1 0 CHG=-1\nM  V30 END ATOM\nM  V30 END CTAB\nM  END\n"),
            std::pair(Charges({0, -1}), true));
  EXPECT_THAT(complaint([&] { charges(head + atoms + "M  CHG  1   9   1\nM  END\n"); }),
              HasSubstr("a.sdf:13:10: a charge of atom 9: there are 8"));
  EXPECT_THAT(complaint([&] { charges(head + atoms + "M  CHG  1   1  16\nM  END\n"); }),
              HasSubstr("a charge of 16: at most 15"));
}

// Records whose table has no "M  END" are counted as before.
TEST(Charges, OfSdfDoNotHideRecords) {
  const std::string record =
      "name\n\n\n  1  0  0  0  0  0  0  0  0  0999 V2000\n    0.0000    0.0000    0.0000 C\n$$$$\n";
  EXPECT_EQ(read_sdf(record + record + record, "a.sdf", {}).frames, 3U);
}

TEST(Charges, OfExtendedXyz) {
  const auto charge = [](const std::string& name) {
    return read_xyz(
        "2\nProperties=species:S:1:" + name + ":R:1:pos:R:3\nC 0.25 1 2 3\nO -0.5 1 2 4\n", "a.xyz",
        {});
  };
  for (const std::string name : {"charge", "charges", "initial_charges"}) {
    const Molecule molecule = charge(name);
    EXPECT_EQ(molecule.atoms.at(0).charge, 0.25F) << name;
    EXPECT_EQ(molecule.atoms.at(1).charge, -0.5F) << name;
    EXPECT_EQ(molecule.atoms.at(1).position, glm::vec3(1, 2, 4)) << name;
    EXPECT_TRUE(molecule.has_charges) << name;
  }
  EXPECT_FALSE(charge("mass").has_charges);
  EXPECT_THAT(complaint([] {
                read_xyz("1\nProperties=species:S:1:pos:R:3:charge:R:1\nC 0 0 0\n", "a.xyz", {});
              }),
              HasSubstr("a.xyz:3: the charge is missing"));
  EXPECT_THAT(complaint([] {
                read_xyz("2\nProperties=species:S:1:pos:R:3:charge:R:1\nC 0 0 0 1\nC 0 0 1 x\n",
                         "a.xyz", {});
              }),
              HasSubstr("'x'"));
}

// Columns 79 and 80 of PDB hold formal charges.
TEST(Charges, OfPdb) {
  std::string line = test::pdb_line(1, "ZN", "ZN", 'A', 1, {0, 0, 0}, 0, ' ', "ZN");
  line.insert(line.find('\n'), "2+");
  const Molecule molecule = read_pdb(line, "a.pdb", {});
  EXPECT_EQ(molecule.atoms.at(0).charge, 2);
  EXPECT_TRUE(molecule.has_charges);
  EXPECT_FALSE(read_pdb(test::pdb_line(1, "N", "ALA", 'A', 1, {0, 0, 0}), "a.pdb", {}).has_charges);
}

// Half of the way to white or blue on a screen is 0.5, which is 0.2140 in linear sRGB (IEC
// 61966-2-1); a step of the map's 63 is 0.032 of it.
TEST(ValueColours, OfChargesAreRedWhiteAndBlue) {
  const Scene scene = scene_of("a.pqr",
                               "ATOM 1 N THR 1 0 0 0 -0.4 2\nATOM 2 C THR 1 9 0 0 0.2 2\n"
                               "ATOM 3 C THR 1 18 0 0 0 2\nATOM 4 C THR 1 27 0 0 0.3 2\n",
                               {{{"style", "spheres"}, {"color", "charge"}}});
  const std::vector<std::string> names = materials_of(scene);
  ASSERT_EQ(names.size(), 4U);
  EXPECT_EQ(names[0], "charge -0.4");
  EXPECT_EQ(names[3], "charge 0.3");
  const auto near = [](const glm::dvec3& color, const glm::dvec3& expected) {
    return glm::length(color - expected) < 0.05;
  };
  EXPECT_EQ(color_of(scene, names[0]), glm::dvec3(1, 0, 0));
  // A quarter of the way to white on a screen is 0.0509.
  EXPECT_TRUE(near(color_of(scene, names[3]), {0.0509, 0.0509, 1}));
  EXPECT_TRUE(near(color_of(scene, names[1]), {0.214, 0.214, 1})) << names[1];
  EXPECT_EQ(names[2], "charge 0");
  EXPECT_EQ(color_of(scene, names[2]), glm::dvec3(1, 1, 1));
  ASSERT_TRUE(scene.legend);
  EXPECT_EQ(scene.legend->title, "Charge");
  EXPECT_EQ(scene.legend->unit, "e");
  EXPECT_EQ(scene.legend->low, -0.4F);
  EXPECT_EQ(scene.legend->high, 0.4F);
  EXPECT_EQ(scene.legend->colors.front(), glm::dvec3(1, 0, 0));
  EXPECT_EQ(scene.legend->colors.back(), glm::dvec3(0, 0, 1));
}

TEST(ValueColours, HaveTheRangeThatIsAskedFor) {
  const auto names = [](const std::string& range) {
    const Scene scene = scene_of("a.pqr", "ATOM 1 N THR 1 0 0 0 -4 2\nATOM 2 C THR 1 9 0 0 0.2 2\n",
                                 {{{"style", "spheres"}, {"color", "charge"}, {"range", range}}});
    return std::pair(materials_of(scene), std::pair(scene.legend->low, scene.legend->high));
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("-1,0.2"), std::pair(Names({"charge -1", "charge 0.2"}), std::pair(-1.0, 0.2)));
  const std::string file = "ATOM 1 N THR 1 0 0 0 -4 2\n";
  EXPECT_THAT(complaint([&] {
                scene_of("a.pqr", file, {{{"range", "0,1"}}});
              }),
              HasSubstr("--range: goes with colours by bfactor, charge or distance"));
  EXPECT_THAT(complaint([&] {
                scene_of("a.xyz", "1\n\nC 0 0 0\n", {{{"color", "charge"}}});
              }),
              HasSubstr("--color: the file has no charges"));
}

// Distances to the nearest chosen atom, against all pairs; ties along every axis included.
TEST(ValueColours, OfDistancesAreThoseToTheNearestAtom) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> at(-8, 8);
  std::string text = "400\n\n";
  std::vector<glm::dvec3> places;
  for (int i = 0; i < 400; ++i) {
    places.emplace_back(at(random), at(random), 4 * at(random));
    text += fmt::format("{} {} {} {}\n", i % 16 == 0 ? "O" : "C", places.back().x, places.back().y,
                        places.back().z);
  }
  const Scene scene =
      scene_of("a.xyz", text,
               {{{"style", "spheres"}, {"color", "distance from element O"}, {"range", "0,63"}}});
  const std::vector<std::string> names = materials_of(scene);
  ASSERT_EQ(names.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < places.size(); k += 16)
      least = std::min(least, glm::length(places[i] - places[k]));
    EXPECT_EQ(names[i], fmt::format("distance {}", std::floor(least + 0.5))) << least;
  }
  EXPECT_EQ(scene.legend->title, "Distance");
}

TEST(ValueColours, OfDistancesMayBeShown) {
  const std::string text = test::pdb_line(1, "CA", "ALA", 'A', 1, {0, 0, 0}) +
                           test::pdb_line(2, "CA", "ALA", 'B', 1, {0, 3, 0}) +
                           test::pdb_line(3, "CA", "ALA", 'B', 2, {0, 7, 0});
  const auto shown = [&](const std::string& show, ImportOptions options = {}) {
    options.set("show", show);
    return scene_of("a.pdb", text, options);
  };
  const Scene scene = shown("chain B: spheres by distance from chain A opacity 0.5");
  EXPECT_THAT(materials_of(scene), ElementsAre("distance 3", "distance 7"));
  EXPECT_EQ(scene.legend->low, 0);
  EXPECT_EQ(scene.legend->high, 7);
  EXPECT_TRUE(scene.shapes.at(0).alpha);
  const Scene two =
      shown("chain A: spheres by distance from chain B; chain B: spheres by distance from chain A");
  EXPECT_THAT(materials_of(two, 0), ElementsAre("distance 3"));
  EXPECT_THAT(materials_of(two, 1), ElementsAre("distance 3", "distance 7"));
  EXPECT_THAT(materials_of(shown("chain B: spheres", {{{"color", "distance from chain A"}}})),
              ElementsAre("distance 3", "distance 7"));
  const auto told = [&](const std::string& show) { return complaint([&] { shown(show); }); };
  EXPECT_THAT(told("all: spheres by distance"), HasSubstr("'from' is missing after distance"));
  EXPECT_THAT(told("all: spheres by distance to chain A"), HasSubstr("'from' is missing"));
  EXPECT_THAT(told("all: spheres by distance from opacity 1"),
              HasSubstr("atoms are missing after 'distance from'"));
  EXPECT_THAT(told("all: spheres by distance from chain C"),
              HasSubstr("distance from 'chain C': it selects no atoms"));
  EXPECT_THAT(complaint([&] {
                scene_of("a.pdb", text, {{{"color", "distance"}}});
              }),
              HasSubstr("--color: 'distance from' and a selection of atoms are needed"));
}

// Names stand in the order in which they are first drawn, with the colours of the materials.
TEST(NameLegends, TellWhatIsDrawn) {
  const std::string text = test::pdb_line(1, "CA", "ALA", 'B', 1, {0, 0, 0}) +
                           test::pdb_line(2, "N", "GLY", 'A', 1, {0, 9, 0}) +
                           test::pdb_line(3, "CB", "ALA", 'A', 2, {0, 7, 0});
  const auto legend = [&](ImportOptions options) {
    return scene_of("a.pdb", text, options).legend;
  };
  const auto by = [&](const std::string& color) {
    const auto found = legend({{{"style", "spheres"}, {"color", color}}});
    return std::pair(found->title, found->names);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(by("element"), std::pair(std::string("Element"), Names({"C", "N"})));
  EXPECT_EQ(by("chain"), std::pair(std::string(), Names({"chain B", "chain A"})));
  EXPECT_EQ(by("residue"), std::pair(std::string("Residue"), Names({"ALA", "GLY"})));
  EXPECT_EQ(by("secondary"), std::pair(std::string("Secondary structure"), Names({"coil"})));
  // Jmol's carbon is 144 of 255, which is 0.2789 in linear sRGB (IEC 61966-2-1).
  EXPECT_NEAR(legend({{{"style", "spheres"}}})->colors.at(0).x, 0.2789, 1e-3);
  const auto two = legend({{{"show", "chain A: spheres by element; chain B: spheres by chain"}}});
  EXPECT_EQ(two->title, "");
  EXPECT_THAT(two->names, testing::UnorderedElementsAre("C", "N", "chain B"));
  EXPECT_FALSE(legend({{{"show", "all: spheres by #ff0000"}}}));
  // What selects nothing has no names.
  const auto one = legend({{{"show", "chain C: spheres by chain; chain A: spheres by element"}}});
  EXPECT_EQ(one->title, "Element");
  EXPECT_THAT(one->names, testing::ElementsAre("N", "C"));
  // Numbers come before names.
  EXPECT_EQ(
      legend({{{"show", "chain A: spheres; chain B: spheres by distance from chain A"}}})->title,
      "Distance");
}

}  // namespace caplet::values_test
