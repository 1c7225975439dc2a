// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The style cartoon: what is drawn of a file, where, by which names and in which colours.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "import/detail/cartoon.h"
#include "import/detail/ribbon.h"
#include "import/import.h"
#include "npy_text.h"
#include "peptide.h"
#include "support/data.h"
#include "support/import_files.h"
#include "surfaces.h"

namespace caplet {
namespace cartoon_test {
namespace {

using glm::dvec3;
using test::complaint;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

Scene drawn(const std::filesystem::path& path, ImportOptions options = {}) {
  options.set("style", "cartoon");
  return import_scene(path, test::NoImages(), options);
}
Scene drawn_text(const std::string& text, const ImportOptions& options = {}) {
  return drawn(test::write_file("c.pdb", text), options);
}
std::vector<std::string> names_of(const std::vector<Shape>& shapes) {
  std::vector<std::string> out;
  for (const Shape& shape : shapes) out.push_back(shape.name);
  return out;
}
std::vector<std::string> materials_of(const Scene& scene) {
  std::vector<std::string> out;
  for (const Shape& shape : scene.shapes) out.push_back(scene.materials[shape.material].name);
  return out;
}
std::vector<TriangleMeshShape> meshes_of(const Scene& scene) {
  std::vector<TriangleMeshShape> out;
  for (const Shape& shape : scene.shapes)
    if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry)) out.push_back(*mesh);
  return out;
}

/// Alpha carbons along x, numbered by their chain's residues.
std::string calphas(const std::vector<std::pair<char, double>>& places) {
  std::string out;
  int number = 0;
  for (const auto& [chain, x] : places) {
    ++number;
    out += test::pdb_line(number, "CA", "GLY", chain, number, {x, 0, 0}, 10.0 * number, ' ', "C");
  }
  return out;
}

// --- Where it is ---

double to_triangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
  const auto to_edge = [&](const dvec3& from, const dvec3& to) {
    const dvec3 along = to - from;
    const double part = std::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::length(p - from - part * along);
  };
  const dvec3 normal = glm::cross(b - a, c - a);
  const auto inside = [&](const dvec3& from, const dvec3& to) {
    return glm::dot(glm::cross(to - from, p - from), normal) >= 0;
  };
  if (glm::length(normal) > 0 && inside(a, b) && inside(b, c) && inside(c, a))
    return std::abs(glm::dot(p - a, normal)) / glm::length(normal);
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}
double to_surface(const dvec3& p, const TriangleMeshShape& mesh) {
  double out = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    out = std::min(out, to_triangle(p, dvec3(mesh.positions[a]), dvec3(mesh.positions[b]),
                                    dvec3(mesh.positions[c])));
  return out;
}

// The alpha carbons of helices and coils lie on the curve, so the surface is at most the half
// height of the section, 0.28, away from them. In strands the curve goes through (a + 2 b + c) / 4,
// which is |a - 2 b + c| / 4 from b: with bonds of 3.8 that make an angle of 80 degrees or more, as
// those of proteins do, at most 2 * 3.8 cos(40) / 4 = 1.46. 0.01 covers the chords of rings.
TEST(Cartoons, PassByEveryAlphaCarbon) {
  CAPLET_NEEDS_DATA();
  for (const char* file : {"1crn.pdb", "4hhb.pdb", "1M4X.pdb", "1l2y.pdb"}) {
    const std::filesystem::path path = test::data_folder() / "mol/pdb" / file;
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const Molecule molecule = read_pdb(text, path.string(), {});
    const Scene scene = drawn(path);
    std::map<std::string, const TriangleMeshShape*> by_name;
    for (const Shape& shape : scene.shapes)
      if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry))
        by_name[shape.name] = mesh;
    std::size_t count = 0;
    for (const Residue& residue : molecule.residues) {
      if (residue.kind != ResidueKind::amino_acid || residue.trace_atom < 0) continue;
      const std::string name = fmt::format("chain {} {} {}", molecule.chains[residue.chain],
                                           residue.name, residue.number);
      ASSERT_TRUE(by_name.contains(name)) << name;
      const dvec3 at(molecule.atoms[static_cast<std::size_t>(residue.trace_atom)].position);
      EXPECT_LE(to_surface(at, *by_name.at(name)),
                residue.stated == Secondary::strand ? 1.46 : 0.29)
          << file << " " << name;
      ++count;
    }
    EXPECT_EQ(count, by_name.size());
    EXPECT_EQ(test::open_edges_of(meshes_of(scene)), 0U) << file;
    EXPECT_GT(test::volume(meshes_of(scene)), 0) << file;
  }
}

// Neighbouring rings are at most 1/12 of a residue apart. The ribbon of a helix turns with the
// chain, 100 degrees a residue or 8.4 a piece, and that of a strand by less; 30 leaves room for
// their ends. A side that is not turned around would make 180 degrees in 12 pieces, most of them in
// the middle ones.
TEST(Cartoons, AreNotTwisted) {
  CAPLET_NEEDS_DATA();
  for (const char* file : {"1crn.pdb", "4hhb.pdb"}) {
    const Scene scene = drawn(test::data_folder() / "mol/pdb" / file, {{{"color", "secondary"}}});
    for (const Shape& shape : scene.shapes) {
      const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry);
      if (!mesh || scene.materials[shape.material].name == "coil") continue;
      dvec3 last(0);
      for (std::size_t at = 0; at + 24 <= mesh->positions.size(); at += 24) {
        // From one side of the section to the other: points 0 and 12.
        const dvec3 across =
            glm::normalize(dvec3(mesh->positions[at]) - dvec3(mesh->positions[at + 12]));
        if (last != dvec3(0)) {
          EXPECT_GT(glm::dot(across, last), std::cos(glm::radians(30.0))) << file << shape.name;
        }
        last = across;
      }
    }
  }
}

/// The direction of the ribbon's width in the middle of a mesh: points 23 and 0 are at one end of
/// the section, 11 and 12 at the other.
dvec3 width_of(const TriangleMeshShape& mesh) {
  const std::size_t at = mesh.positions.size() / 24 / 2 * 24;
  return glm::normalize(dvec3(mesh.positions[at]) + dvec3(mesh.positions[at + 23]) -
                        dvec3(mesh.positions[at + 11]) - dvec3(mesh.positions[at + 12]));
}

// The width of an alpha helix lies along its axis, as its carbonyls do (Carson and Bugg 1986). It
// is across the curve, which rises by atan(5.4 / (2 pi 2.3)) = 20.5 degrees (5.4 a turn of
// radius 2.3); 30 leaves room for the ends. The axis is the way over whole turns: 18 residues
// are 5.
TEST(Cartoons, OfAHelixStandAlongItsAxis) {
  const std::vector<test::BackboneAtoms> atoms = test::backbone(24, -57, -47);
  const dvec3 axis = glm::normalize(atoms[21].ca - atoms[3].ca);
  for (const bool is_whole : {true, false}) {
    std::string text =
        "HELIX    1   1 ALA A    1  ALA A   24  1" + std::string(31, ' ') + "   24\n";
    if (is_whole)
      text += test::lines_of(atoms);
    else
      for (int i = 0; i < 24; ++i)
        text += test::pdb_line(i + 1, "CA", "ALA", 'A', i + 1,
                               atoms[static_cast<std::size_t>(i)].ca, 0, ' ', "C");
    const auto meshes = meshes_of(drawn_text(text));
    ASSERT_EQ(meshes.size(), 24U);
    for (std::size_t i = 2; i < 22; ++i)
      EXPECT_GT(std::abs(glm::dot(width_of(meshes[i]), axis)), std::cos(glm::radians(30.0)))
          << i << (is_whole ? "" : " by alpha carbons alone");
  }
}

// Along a straight chain, which has no bend, the oxygens alone say where the width lies.
TEST(Cartoons, TurnToTheCarbonyls) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    text += test::pdb_line(2 * i + 1, "CA", "ALA", 'A', i + 1, {3.8 * i, 0, 0}, 0, ' ', "C");
    text += test::pdb_line(2 * i + 2, "O", "ALA", 'A', i + 1, {3.8 * i + 1.9, 1, 1});
  }
  for (const TriangleMeshShape& mesh : meshes_of(drawn_text(text)))
    EXPECT_GT(std::abs(glm::dot(width_of(mesh), dvec3(0, std::sqrt(0.5), std::sqrt(0.5)))), 0.9999);
}

// One carbonyl of a strand that is turned by 60 degrees turns the widths of its two residues by 30,
// and two means of weights 1, 2, 1 leave (0 + 22.5) / 4 + 22.5 / 2 + 7.5 / 4 = 18.75. Means of unit
// vectors that differ by up to 30 degrees are those of their angles within 0.7.
TEST(Cartoons, StrandsAreSmooth) {
  std::string text = "SHEET    1   A 1 ALA A   1  ALA A  10  0" + std::string(40, ' ') + "\n";
  for (int i = 0; i < 10; ++i) {
    const double turn = glm::radians(i == 4 ? 60.0 : 0.0);
    text += test::pdb_line(2 * i + 1, "CA", "ALA", 'A', i + 1, {3.4 * i, 0, 0}, 0, ' ', "C");
    text += test::pdb_line(2 * i + 2, "O", "ALA", 'A', i + 1,
                           {3.4 * i + 1.9, 1.5 * std::cos(turn), 1.5 * std::sin(turn)});
  }
  const auto meshes = meshes_of(drawn_text(text));
  ASSERT_EQ(meshes.size(), 10U);
  for (const std::size_t i : {4U, 5U})
    EXPECT_NEAR(glm::degrees(std::acos(std::abs(width_of(meshes[i]).y))), 18.75, 0.7) << i;
}

// In a strand carbonyls alternate; the ribbon does not, and lies in their plane.
TEST(Cartoons, OfAStrandLieInThePlaneOfItsCarbonyls) {
  const std::vector<test::BackboneAtoms> atoms = test::backbone(10, -120, 120);
  const auto meshes = meshes_of(drawn_text("SHEET    1   A 1 ALA A   1  ALA A  10  0" +
                                           std::string(40, ' ') + "\n" + test::lines_of(atoms)));
  ASSERT_EQ(meshes.size(), 10U);
  for (std::size_t i = 2; i + 2 < meshes.size(); ++i) {
    EXPECT_GT(glm::dot(width_of(meshes[i]), width_of(meshes[i + 1])), 0.8) << i;
    const dvec3 along = glm::normalize(atoms[i + 1].ca - atoms[i - 1].ca),
                carbonyl = atoms[i].o - atoms[i].c,
                across = glm::normalize(carbonyl - glm::dot(carbonyl, along) * along);
    EXPECT_GT(std::abs(glm::dot(width_of(meshes[i]), across)), 0.8) << i;
    // The pleats are gone: the ring's middle is nearer the mean of its neighbours than the atom is.
    const std::size_t at = meshes[i].positions.size() / 24 / 2 * 24;
    const dvec3 middle =
        0.5 * (dvec3(meshes[i].positions[at]) + dvec3(meshes[i].positions[at + 12]));
    EXPECT_LT(glm::length(middle - 0.25 * (atoms[i - 1].ca + 2.0 * atoms[i].ca + atoms[i + 1].ca)),
              0.2)
        << i;
  }
}

// --- What is drawn ---

// Neighbours are joined up to 4.6 angstroms in one chain; one alone is a ball of the coil's radius.
TEST(Cartoons, AreParted) {
  const Scene scene =
      drawn_text(calphas({{'A', 0}, {'A', 4.5}, {'A', 9}, {'A', 13.7}, {'B', 17.5}, {'B', 21.3}}));
  EXPECT_THAT(names_of(scene.shapes),
              ElementsAre("chain A GLY 1", "chain A GLY 2", "chain A GLY 3", "chain A GLY 4",
                          "chain B GLY 5", "chain B GLY 6"));
  const auto& ball = std::get<CapsulesShape>(scene.shapes[3].geometry);
  ASSERT_EQ(ball.p0.size(), 1U);
  EXPECT_EQ(ball.p0[0], glm::vec3(13.7F, 0, 0));
  EXPECT_EQ(ball.p1[0], ball.p0[0]);
  EXPECT_EQ(ball.radius0[0], 0.28F);
  EXPECT_EQ(meshes_of(scene).size(), 5U);
  // Each run is closed by itself: it reaches 0.28 beyond its last alpha carbons.
  EXPECT_NEAR(bounds_of(scene.shapes[2]).max.x, 9.28, 1e-6);
  EXPECT_NEAR(bounds_of(scene.shapes[4]).min.x, 17.22, 2e-6);
  EXPECT_NEAR(bounds_of(scene.shapes[1]).max.x, 6.75, 1e-6);  // halfway to the next
  EXPECT_EQ(test::open_edges_of(meshes_of(scene)), 0U);
}

// An amino acid and a nucleotide beside it in a chain are no run.
TEST(Cartoons, OfBothKindsInOneChain) {
  const Scene scene = drawn_text(calphas({{'A', 0}}) +
                                 test::pdb_line(2, "P", "DA", 'A', 2, {4, 0, 0}, 0, ' ', "P"));
  ASSERT_EQ(scene.shapes.size(), 2U);
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[0].geometry).radius0.at(0), 0.28F);
  EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[1].geometry).radius0.at(0), 0.6F);
}

TEST(Cartoons, LigandsAreSticksByElement) {
  const std::string text = calphas({{'A', 0}, {'A', 3.8}}) +
                           "HETATM    3  C1  LIG A   7      20.000   0.000   0.000  1.00  1.00"
                           "           C\n"
                           "HETATM    4  O1  LIG A   7      21.200   0.000   0.000  1.00  1.00"
                           "           O\n"
                           "HETATM    5  O   HOH A   8      40.000   0.000   0.000  1.00  1.00"
                           "           O\n";
  const std::filesystem::path file = test::write_file("l.pdb", text);
  const Scene scene = drawn(file),
              trace = import_scene(file, test::NoImages(), {{{"style", "trace"}}});
  EXPECT_THAT(names_of(scene.shapes),
              ElementsAre("chain A atoms", "chain A bonds", "chain A GLY 1", "chain A GLY 2"));
  for (const std::size_t i : {0U, 1U}) {
    const auto &one = std::get<CapsulesShape>(scene.shapes[i].geometry),
               &other = std::get<CapsulesShape>(trace.shapes[i].geometry);
    EXPECT_EQ(one.p0, other.p0);
    EXPECT_EQ(one.radius0, other.radius0);
    ASSERT_EQ(one.materials.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_EQ(scene.materials[one.materials[k]].name, trace.materials[other.materials[k]].name);
  }
}

TEST(Cartoons, HaveTheirColors) {
  const std::string text = calphas({{'A', 0}, {'A', 3.8}, {'B', 7}, {'B', 10.8}}) +
                           "SHEET    1   A 1 GLY A   1  GLY A   1  0" + std::string(40, ' ') + "\n";
  const auto of = [&](const char* by) { return materials_of(drawn_text(text, {{{"color", by}}})); };
  EXPECT_THAT(materials_of(drawn_text(text)),
              ElementsAre("chain A", "chain A", "chain B", "chain B"));
  EXPECT_THAT(of("residue"), ElementsAre("GLY", "GLY", "GLY", "GLY"));
  EXPECT_THAT(of("element"), ElementsAre("C", "C", "C", "C"));
  EXPECT_THAT(of("bfactor"), ElementsAre("bfactor 10", "bfactor 20", "bfactor 30", "bfactor 40"));
  EXPECT_THAT(of("secondary"), ElementsAre("strand", "coil", "coil", "coil"));
  // RasMol's yellow of strands, (255, 200, 0) of 255: linear by sRGB's curve, ((200 / 255 + 0.055)
  // / 1.055)^2.4.
  const Scene scene = drawn_text(text, {{{"color", "secondary"}}});
  const auto& yellow = std::get<DiffuseMaterial>(scene.materials[scene.shapes[0].material].model);
  const glm::dvec3 rgb = std::get<RgbSpectrum>(yellow.reflectance).rgb;
  EXPECT_NEAR(rgb.x, 1, 1e-6);
  EXPECT_NEAR(rgb.y, std::pow((200 / 255.0 + 0.055) / 1.055, 2.4), 1e-6);
  EXPECT_NEAR(rgb.z, 0, 1e-6);
  ASSERT_TRUE(scene.legend);
  EXPECT_THAT(scene.legend->names, ElementsAre("strand", "coil"));
  EXPECT_EQ(scene.legend->colors.at(0), rgb);
  // Other styles have these colours too.
  const Scene balls = import_scene(test::write_file("c.pdb", text), test::NoImages(),
                                   {{{"style", "spheres"}, {"color", "secondary"}}});
  const auto& atoms = std::get<CapsulesShape>(balls.shapes[0].geometry);
  EXPECT_EQ(balls.materials[atoms.materials.at(0)].name, "strand");
  EXPECT_EQ(balls.materials[atoms.materials.at(1)].name, "coil");
}

// Ten residues of one chain, but not nine and nine of two.
TEST(Cartoons, AreTheDefaultOfPolymers) {
  const auto first = [](const std::string& text, const ImportOptions& options = {}) {
    return import_scene(test::write_file("p.pdb", text), test::NoImages(), options)
        .shapes.at(0)
        .name;
  };
  const auto chain = [](char name, int count, double y) {
    return test::lines_of(test::backbone(count, -57, -47), name, 1, "ALA", {0, y, 0});
  };
  EXPECT_EQ(first(chain('A', 10, 0)), "chain A ALA 1");
  EXPECT_EQ(first(chain('A', 9, 0) + chain('B', 10, 50)), "chain A ALA 1");
  EXPECT_EQ(first(chain('A', 9, 0) + chain('B', 9, 50)), "chain A atoms");
  std::string rna;
  for (int i = 1; i <= 10; ++i)
    rna += test::pdb_line(i, "P", "A", 'R', i, {6.0 * i, 0, 0}, 0, ' ', "P");
  EXPECT_EQ(first(rna), "chain R A 1");
  for (const char* by : {"chain", "residue", "secondary", "distance from name N"})
    EXPECT_EQ(first(chain('A', 10, 0), {{{"color", by}}}), "chain A ALA 1") << by;
  std::vector<std::pair<char, double>> places;
  for (int i = 0; i < 10; ++i) places.emplace_back('A', 3.8 * i);
  EXPECT_EQ(first(calphas(places), {{{"color", "bfactor"}}}), "chain A GLY 1");
  // These colours tell atoms apart.
  EXPECT_EQ(first(chain('A', 10, 0), {{{"color", "element"}}}), "chain A atoms");
  EXPECT_EQ(first(chain('A', 10, 0), {{{"select", "//A/2-11"}}}), "chain A atoms");
  const std::string pqr = "ATOM 1 CA ALA 1 0 0 0 0.5 1.7\n";
  EXPECT_EQ(import_scene(test::write_file("p.pqr", pqr), test::NoImages(), {}).shapes.at(0).name,
            "molecule atoms");
}

TEST(Cartoons, NeedAPolymer) {
  const std::string ion =
      "HETATM    1 ZN    ZN A   1       0.000   0.000   0.000  1.00  1.00          ZN\n";
  EXPECT_THAT(complaint([&] { drawn_text(ion); }),
              AllOf(HasSubstr("--style"), HasSubstr("cartoon: the file has no backbone")));
  EXPECT_THAT(complaint([&] { drawn(test::write_file("a.xyz", "1\n\nC 0 0 0\n")); }),
              HasSubstr("cartoon: the file has no backbone"));
  EXPECT_THAT(complaint([&] {
                import_scene(test::write_file("a.xyz", "1\n\nC 0 0 0\n"), test::NoImages(),
                             {{{"color", "secondary"}}});
              }),
              AllOf(HasSubstr("--color"), HasSubstr("secondary: the file has no polymer")));
}

// --- Assemblies, parts and frames ---

TEST(Cartoons, OfAssembliesAreInstances) {
  std::string text = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: B\n";
  for (const char* row :
       {"1   1  1.0 0.0 0.0  5.0", "2   1  0.0 1.0 0.0  0.0", "3   1  0.0 0.0 1.0  0.0"})
    text += fmt::format("REMARK 350   BIOMT{}\n", row);
  const Scene scene = drawn_text(text + calphas({{'A', 0}, {'A', 3.8}, {'B', 20}, {'B', 23.8}}),
                                 {{{"assembly", "1"}}});
  EXPECT_EQ(scene.shapes.size(), 0U);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_THAT(names_of(scene.objects[0].shapes), ElementsAre("chain B GLY 3", "chain B GLY 4"));
  ASSERT_EQ(scene.instances.size(), 1U);
  EXPECT_EQ(scene.instances[0].world_from_object[3][0], 5);
}

TEST(Cartoons, OfAPart) {
  const std::string helix = test::lines_of(test::backbone(12, -57, -47));
  EXPECT_THAT(names_of(drawn_text(helix, {{{"select", "//A/3-4"}}}).shapes),
              ElementsAre("chain A ALA 3", "chain A ALA 4"));
}

// Hydrogen bonds are those of the frame: of the same atoms, in a helix first and stretched then.
TEST(Cartoons, OfFramesOfAnArray) {
  std::vector<double> places;
  for (const auto& [phi, psi] : {std::pair{-57.0, -47.0}, {-139.0, 135.0}})
    for (const test::BackboneAtoms& of : test::backbone(12, phi, psi))
      for (const dvec3& p : {of.n, of.ca, of.c, of.o})
        for (int axis = 0; axis < 3; ++axis) places.push_back(p[axis] + 100);
  const std::string array = test::write_file("c.npy", test::npy("2, 48, 3", places)).string(),
                    text = test::lines_of(test::backbone(12, -57, -47));
  const auto frame = [&](const char* number) {
    return drawn_text(text, {{{"positions", array}, {"model", number}, {"color", "secondary"}}});
  };
  const Scene first = frame("1"), second = frame("2");
  EXPECT_EQ(materials_of(first).at(5), "helix");
  EXPECT_EQ(materials_of(second).at(5), "coil");
  EXPECT_GT(bounds_of(first).min.y, 80);
  EXPECT_GT(bounds_of(second).max.x - bounds_of(second).min.x +
                (bounds_of(second).max.y - bounds_of(second).min.y),
            25);
}

TEST(Cartoons, OfModels) {
  const std::string text = "MODEL        1\n" + calphas({{'A', 0}, {'A', 3.8}}) +
                           "ENDMDL\nMODEL        2\n" + calphas({{'A', 50}, {'A', 53.8}}) +
                           "ENDMDL\n";
  EXPECT_NEAR(bounds_of(drawn_text(text, {{{"model", "2"}}}).shapes[0]).min.x, 49.72, 1e-5);
}

// --- Nucleic acids ---

/// A strand of `count` adenosines whose phosphorus atoms lie along x, 6 apart; the first has none.
/// Its bases are regular hexagons of radius 1.4 in planes of x and y, 5 above it, and its sugars'
/// C1' are below them.
std::string nucleotides(int count) {
  std::string out;
  int serial = 1;
  const auto add = [&](const char* name, int number, const dvec3& at, const char* element) {
    out += test::pdb_line(serial++, name, "DA", 'A', number, at, 0, ' ', element);
  };
  for (int i = 0; i < count; ++i) {
    const double x = 6.0 * i;
    if (i > 0) add("P", i + 1, {x, 0, 0}, "P");
    add("O5'", i + 1, {x + 1, 0, 0}, "O");
    add("C1'", i + 1, {x + 3, 2, 0}, "C");
    add("O3'", i + 1, {x + 5, 0, 0}, "O");
    const std::array<const char*, 6> ring = {"N1", "C2", "N3", "C4", "C5", "C6"};
    for (std::size_t k = 0; k < 6; ++k) {
      const double turn = glm::radians(60.0 * static_cast<double>(k) - 90);
      add(ring.at(k), i + 1, {x + 3 + 1.4 * std::cos(turn), 5 + 1.4 * std::sin(turn), 0},
          k % 2 == 0 ? "N" : "C");
    }
  }
  return out;
}

TEST(Cartoons, OfNucleicAcidsAreTubesRodsAndSlabs) {
  const Scene scene = drawn_text(nucleotides(3), {{{"color", "secondary"}}});
  EXPECT_THAT(names_of(scene.shapes), ElementsAre("chain A DA 1", "chain A DA 2", "chain A DA 3",
                                                  "chain A DA 1", "chain A DA 2", "chain A DA 3"));
  EXPECT_EQ(materials_of(scene).at(0), "nucleic acid");
  std::vector<glm::vec3> ends;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& tube = std::get<CapsulesShape>(scene.shapes[i].geometry);
    ASSERT_EQ(tube.p0.size(), 14U);  // two rods and twelve of the tube
    ends.push_back(tube.p0[2]);
    for (std::size_t k = 2; k < 14; ++k) {
      EXPECT_EQ(tube.radius0[k], 0.6F);
      if (k > 2) {
        EXPECT_EQ(tube.p0[k], tube.p1[k - 1]);
      }
    }
    if (i == 2) ends.push_back(tube.p1[13]);
    const float x = 6.0F * static_cast<float>(i);
    // The rods go from the tube over C1' to the ring's nearest atom, here N1.
    EXPECT_LT(std::abs(tube.p0[0].y) + std::abs(tube.p0[0].z), 1e-5F);  // on the tube
    EXPECT_NEAR(tube.p0[0].x, x + 3, 0.5F);
    EXPECT_EQ(tube.p1[0], glm::vec3(x + 3, 2, 0));
    EXPECT_EQ(tube.p0[1], tube.p1[0]);
    EXPECT_LT(glm::length(tube.p1[1] - glm::vec3(x + 3, 3.6F, 0)), 1e-3F);
    EXPECT_EQ(tube.radius0[0], 0.25F);
  }
  // From the first O5' over the phosphorus atoms to the last O3'.
  EXPECT_EQ(ends, (std::vector<glm::vec3>{{1, 0, 0}, {6, 0, 0}, {12, 0, 0}, {17, 0, 0}}));
}

// The box of a slab holds the ring's atoms and 0.4 more, and is 0.5 high.
TEST(Cartoons, SlabsHoldTheirRings) {
  const Scene scene = drawn_text(nucleotides(2));
  const Shape& slab = scene.shapes[3];
  const auto& box = std::get<BoxShape>(slab.geometry);
  const dvec3 size = box.p1 - box.p0;
  // A hexagon is 2 r long from corner to corner, along the way to C1', and sqrt(3) r wide. Places
  // of the file are rounded to 0.001, four of which count.
  EXPECT_NEAR(size.x, 2 * 1.4 + 0.8, 0.004);
  EXPECT_NEAR(size.y, std::sqrt(3) * 1.4 + 0.8, 0.004);
  EXPECT_NEAR(size.z, 0.5, 1e-12);
  const Bounds bounds = bounds_of(slab);
  EXPECT_NEAR(bounds.min.y, 5 - 1.8, 0.004);
  EXPECT_NEAR(bounds.max.y, 5 + 1.8, 0.004);
  EXPECT_NEAR(bounds.max.z, 0.25, 0.004);
  EXPECT_NEAR(bounds.min.x + bounds.max.x, 2 * 9, 0.008);
}

TEST(Cartoons, OfPhosphorusAlone) {
  std::string text;
  for (int i = 0; i < 4; ++i)
    text +=
        test::pdb_line(i + 1, "P", "DA", 'A', i + 1, {i < 3 ? 6.0 * i : 21.1, 0, 0}, 0, ' ', "P");
  const Scene scene = drawn_text(text);
  ASSERT_EQ(scene.shapes.size(), 4U);
  const auto of = [&](std::size_t i) -> const CapsulesShape& {
    return std::get<CapsulesShape>(scene.shapes[i].geometry);
  };
  EXPECT_EQ(of(0).p0.front(), glm::vec3(0, 0, 0));
  EXPECT_EQ(of(1).p0.front(), glm::vec3(3, 0, 0));
  EXPECT_EQ(of(2).p1.back(), glm::vec3(12, 0, 0));
  // 9.1 further on is a gap: a ball.
  EXPECT_EQ(of(3).p0, (std::vector<glm::vec3>{{21.1F, 0, 0}}));
  EXPECT_EQ(of(3).p1, of(3).p0);
}

// Old files write * in place of '. Without a sugar the rod begins at the ring.
TEST(Cartoons, NamesOfOldFiles) {
  std::string text = nucleotides(1);
  std::ranges::replace(text, '\'', '*');
  EXPECT_EQ(std::get<CapsulesShape>(drawn_text(text).shapes[0].geometry).p0.size(), 14U);
}

// Copies count as residues: of 1,501 in two places curves are as coarse as of 3,002.
TEST(Cartoons, OfManyCopiesAreCoarse) {
  std::string text = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
  for (const char* row :
       {"1   1  1.0 0.0 0.0  0.0", "2   1  0.0 1.0 0.0  0.0", "3   1  0.0 0.0 1.0  0.0",
        "1   2  1.0 0.0 0.0  0.0", "2   2  0.0 1.0 0.0  0.0", "3   2  0.0 0.0 1.0 50.0"})
    text += fmt::format("REMARK 350   BIOMT{}\n", row);
  for (int i = 0; i < 1501; ++i)
    text += test::pdb_line(i + 1, "CA", "GLY", 'A', i + 1, {3.8 * (i % 200), 5.0 * (i / 200), 0}, 0,
                           ' ', "C");
  const Scene scene = drawn_text(text, {{{"assembly", "1"}}});
  ASSERT_EQ(scene.instances.size(), 2U);
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.objects.at(0).shapes.at(5).geometry).triangles.size(),
            8U * 2 * 12);
}

// Of more residues the curves are coarser: at most 576, 256 or 96 triangles each, beside the ends.
TEST(Cartoons, OfManyResiduesAreCoarse) {
  const auto triangles = [](int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text +=
          test::pdb_line(i + 1, "CA", "GLY", static_cast<char>('A' + i / 5000), i % 5000 + 1,
                         {3.8 * (i % 200), 5.0 * (i / 200 % 100), 20.0 * (i / 20000)}, 0, ' ', "C");
    const std::vector<TriangleMeshShape> meshes = meshes_of(drawn_text(text));
    std::size_t most = 0;
    for (std::size_t i = 1; i + 1 < 100; ++i) most = std::max(most, meshes[i].triangles.size());
    return most;
  };
  EXPECT_EQ(triangles(3000), 12U * 2 * 20);
  EXPECT_EQ(triangles(3001), 8U * 2 * 12);
  EXPECT_EQ(triangles(20001), 4U * 2 * 8);
}

}  // namespace
}  // namespace cartoon_test
}  // namespace caplet
