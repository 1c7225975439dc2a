// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// 3MF: the conventions of docs/formats/3mf.md, a file that lib3mf wrote, and bad input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "import/import.h"
#include "support/data.h"
#include "support/import_files.h"
#include "support/log_of.h"
#include "support/zip_text.h"

namespace caplet {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

Scene scene_of(const std::string& bytes, const ImportOptions& options = {}) {
  return import_scene(test::write_file("a.3mf", bytes), test::NoImages(), options);
}

const std::string head =
    "<?xml version=\"1.0\"?>\n<model unit=\"millimeter\" "
    "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
    "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\">\n";

/// A model of one object: four vertices, and a lattice with these attributes and elements.
std::string lattice_model(const std::string& attributes, const std::string& inside) {
  return head +
         "<resources><object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex "
         "x=\"4\" y=\"0\" z=\"0\"/>"
         "<vertex x=\"0\" y=\"3\" z=\"0\"/><vertex x=\"0\" y=\"0\" "
         "z=\"2\"/></vertices>\n<b:beamlattice " +
         attributes + ">\n" + inside +
         "</b:beamlattice></mesh></object></resources><build><item "
         "objectid=\"1\"/></build></model>";
}
Scene lattice(const std::string& attributes, const std::string& inside) {
  return scene_of(test::package_3mf(lattice_model(attributes, inside)), {{{"up", "y"}}});
}

glm::dvec3 color_of(const Scene& scene, std::uint32_t material) {
  return std::get<RgbSpectrum>(
             std::get<DiffuseMaterial>(scene.materials.at(material).model).reflectance)
      .rgb;
}

TEST(Lattice, RoundBeamsOfOneRadiusAreCapsules) {
  const Scene scene = lattice("radius=\"0.5\"",
                              "<b:beams><b:beam v1=\"0\" v2=\"1\"/><b:beam v1=\"2\" v2=\"0\" "
                              "r1=\"0.25\" cap2=\"hemisphere\"/>"
                              "</b:beams>");
  ASSERT_EQ(scene.shapes.size(), 1u);
  const CapsulesShape capsules = test::capsules_of(scene);
  ASSERT_EQ(capsules.p0.size(), 2u);
  EXPECT_EQ(capsules.p1[0], glm::vec3(4, 0, 0));
  EXPECT_EQ(capsules.p0[1], glm::vec3(0, 3, 0));
  EXPECT_EQ(capsules.radius0, (std::vector<float>{0.5F, 0.25F}));
  EXPECT_TRUE(capsules.radius1.empty());
}

TEST(Lattice, FlatEndsMakeCylinders) {
  const Scene scene = lattice(
      "radius=\"0.5\" cap=\"butt\"",
      "<b:beams><b:beam v1=\"0\" v2=\"1\"/><b:beam v1=\"0\" v2=\"2\" cap2=\"sphere\"/></b:beams>");
  ASSERT_EQ(scene.shapes.size(), 2u);
  const auto& both = std::get<CylinderShape>(scene.shapes[0].geometry);
  EXPECT_EQ(both.caps, (std::array<Cap, 2>{Cap::flat, Cap::flat}));
  EXPECT_EQ(both.p1, glm::dvec3(4, 0, 0));
  EXPECT_EQ(both.radius, 0.5);
  EXPECT_EQ(std::get<CylinderShape>(scene.shapes[1].geometry).caps,
            (std::array<Cap, 2>{Cap::flat, Cap::round}));
}

// A frustum between disks, not the hull of two balls: with radii 2 and 1 and the length 4 the side
// meets the disk at 2 exactly.
TEST(Lattice, TaperedBeamsAreFrustaWithBallsOrHalfBalls) {
  const Scene scene = lattice("radius=\"1\"",
                              "<b:beams><b:beam v1=\"0\" v2=\"1\" r1=\"2\" r2=\"1\" "
                              "cap1=\"hemisphere\" cap2=\"sphere\"/></b:beams>");
  ASSERT_EQ(scene.shapes.size(), 3u);
  const auto& cone = std::get<ConeShape>(scene.shapes[0].geometry);
  EXPECT_EQ(cone.radius, (std::array<double, 2>{2, 1}));
  EXPECT_EQ(cone.caps, (std::array<Cap, 2>{Cap::flat, Cap::flat}));
  const auto& half = std::get<PartialSphereShape>(scene.shapes[1].geometry);
  EXPECT_EQ(half.radius, 2);
  EXPECT_EQ(half.z_min, 0);
  // It lies before x = 0, and nowhere beyond.
  const Bounds bounds = bounds_of(scene.shapes[1]);
  EXPECT_NEAR(bounds.min.x, -2, 1e-9);
  EXPECT_NEAR(bounds.max.x, 0, 1e-9);
  EXPECT_NEAR(bounds.max.y, 2, 1e-9);
  const CapsulesShape ball = test::capsules_of(scene);
  ASSERT_EQ(ball.p0.size(), 1u);
  EXPECT_EQ(ball.p0[0], glm::vec3(4, 0, 0));
  EXPECT_EQ(ball.p1[0], ball.p0[0]);
  EXPECT_EQ(ball.radius0[0], 1);
}

TEST(Lattice, BallsStandWhereTheModeSays) {
  const std::string beams =
      "<b:beams><b:beam v1=\"0\" v2=\"1\"/><b:beam v1=\"0\" v2=\"2\"/></b:beams>";
  const std::string ball = "<b:balls><b:ball vindex=\"0\" r=\"2\"/></b:balls>";
  const auto radii = [&](const std::string& attributes) {
    return test::capsules_of(lattice("radius=\"0.5\" " + attributes, beams + ball)).radius0;
  };
  EXPECT_EQ(radii(""), (std::vector<float>{0.5F, 0.5F}));
  EXPECT_EQ(radii("ballmode=\"mixed\" ballradius=\"1\""), (std::vector<float>{0.5F, 0.5F, 2}));
  // Vertex 3 has no beam.
  EXPECT_EQ(radii("ballmode=\"all\" ballradius=\"1\""), (std::vector<float>{0.5F, 0.5F, 2, 1, 1}));
}

/// As `lattice`, with the last vertex where the first is.
Scene folded_lattice(const std::string& attributes, const std::string& inside) {
  std::string text = lattice_model(attributes, inside);
  text.replace(text.find("z=\"2\""), 5, "z=\"0\"");
  return scene_of(test::package_3mf(text), {{{"up", "y"}}});
}

TEST(Lattice, BeamsWithoutLengthAreBallsOrNothing) {
  const std::string beams =
      "<b:beams><b:beam v1=\"0\" v2=\"1\"/><b:beam v1=\"0\" v2=\"3\" r1=\"0.25\" "
      "r2=\"0.75\" cap1=\"hemisphere\"/></b:beams>";
  const CapsulesShape round = test::capsules_of(folded_lattice("radius=\"0.5\"", beams));
  EXPECT_EQ(round.p0, (std::vector<glm::vec3>{{0, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(round.p1, (std::vector<glm::vec3>{{4, 0, 0}, {0, 0, 0}}));
  EXPECT_EQ(round.radius0, (std::vector<float>{0.5F, 0.75F}));
  test::LogOf log;
  const Scene flat = folded_lattice("radius=\"0.5\" cap=\"butt\"", beams);
  EXPECT_EQ(flat.shapes.size(), 1U);
  EXPECT_TRUE(std::holds_alternative<CylinderShape>(flat.shapes[0].geometry));
  EXPECT_THAT(log.text(), HasSubstr("a.3mf/3D/a.model:4:2: 1 beams without length and without "
                                    "round ends are left out"));
}

TEST(Lattice, ClippingIsToldOf) {
  test::LogOf log;
  const std::string beam = "<b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams>";
  EXPECT_EQ(lattice("radius=\"1\" clippingmode=\"none\"", beam).shapes.size(), 1U);
  EXPECT_EQ(log.text(), "");
  EXPECT_EQ(lattice("radius=\"1\" clippingmode=\"inside\"", beam).shapes.size(), 1U);
  EXPECT_THAT(log.text(), HasSubstr("a.3mf/3D/a.model:4:2: the lattice is not clipped: "
                                    "clippingmode 'inside' is not read"));
}

TEST(Model3mf, UnitsTransformsAndColours) {
  const auto model = [](const std::string& unit) {
    return "<model unit=\"" + unit +
           "\"><resources><m:colorgroup xmlns:m=\"x\" id=\"7\"><m:color "
           "color=\"#FF0000\"/><m:color color=\"#0000FF80\"/>"
           "</m:colorgroup><object id=\"1\" pid=\"7\" pindex=\"0\" "
           "name=\"part\"><mesh><vertices><vertex x=\"0\" y=\"0\" "
           "z=\"0\"/>"
           "<vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" "
           "y=\"0\" "
           "z=\"1\"/></vertices><triangles>"
           "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\" "
           "p1=\"1\"/></triangles></mesh></object></resources>"
           "<build><item objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 5 6 7\"/></build></model>";
  };
  const Scene scene = scene_of(test::package_3mf(model("inch")), {{{"up", "y"}}});
  ASSERT_EQ(scene.shapes.size(), 2u);
  EXPECT_EQ(scene.shapes[0].name, "part");
  // Rows of the file are where x, y and z go to.
  const auto at = [&](const glm::dvec3& p) {
    return glm::dvec3(scene.shapes[0].world_from_object * glm::dvec4(p, 1));
  };
  EXPECT_LT(glm::length(at({1, 0, 0}) - 25.4 * glm::dvec3(5, 7, 7)), 1e-9);
  EXPECT_LT(glm::length(at({0, 1, 0}) - 25.4 * glm::dvec3(4, 6, 7)), 1e-9);
  EXPECT_EQ(color_of(scene, scene.shapes[0].material), glm::dvec3(1, 0, 0));
  EXPECT_EQ(color_of(scene, scene.shapes[1].material), glm::dvec3(0, 0, 1));
  EXPECT_FALSE(scene.shapes[0].alpha);
  EXPECT_TRUE(scene.shapes[1].alpha);
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.shapes[1].geometry).positions.size(), 3u);
  // z is up unless asked: it becomes y.
  const Scene up = scene_of(test::package_3mf(model("meter")));
  EXPECT_LT(glm::length(glm::dvec3(up.shapes[0].world_from_object * glm::dvec4(0, 0, 0, 1)) -
                        1000.0 * glm::dvec3(5, 7, -6)),
            1e-9);
}

// docs/formats/3mf.md: what has different colours at its corners has their mean, in steps of 1/31.
TEST(Model3mf, CornersOfColoursHaveTheirMean) {
  const Scene scene = scene_of(test::package_3mf(
      "<model><resources><m:colorgroup xmlns:m=\"x\" id=\"7\"><m:color color=\"#FF0000\"/><m:color "
      "color=\"#00FF00\"/>"
      "<m:color color=\"#00FFFF\"/></m:colorgroup><object id=\"1\"><mesh><vertices><vertex x=\"0\" "
      "y=\"0\" z=\"0\"/>"
      "<vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>"
      "<triangle v1=\"0\" v2=\"1\" v3=\"2\" pid=\"7\" p1=\"0\" p2=\"1\" "
      "p3=\"2\"/></triangles></mesh></object></resources>"
      "<build><item objectid=\"1\"/></build></model>"));
  EXPECT_LT(glm::length(color_of(scene, scene.shapes.at(0).material) - glm::dvec3(1, 2, 1) / 3.0),
            0.02);
}

// XML's comments stand anywhere between elements, and say nothing; nor do elements of names that
// are no part of the format.
TEST(Model3mf, CommentsAreNoElements) {
  const std::string c = "<!-- a comment --><other:thing xmlns:other=\"urn:o\"/>\n";
  const std::string text =
      "<model>" + c + "<resources>" + c + "<basematerials id=\"2\">" + c +
      "<base name=\"a\" displaycolor=\"#FF0000\"/>" + c +
      "</basematerials><object id=\"1\" pid=\"2\" pindex=\"0\">" + c + "<mesh>" + c + "<vertices>" +
      c + "<vertex x=\"0\" y=\"0\" z=\"0\"/>" + c +
      "<vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>" +
      c + "<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>" + c +
      "</triangles></mesh></object><object id=\"3\">" + c + "<components>" + c +
      "<component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 7 8 9\"/>" + c +
      "</components></object></resources><build>" + c + "<item objectid=\"3\"/>" + c +
      "</build></model>";
  const Scene scene = scene_of(test::package_3mf(text), {{{"up", "y"}}});
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.shapes[0].geometry).positions.size(), 3U);
  EXPECT_EQ(glm::dvec3(scene.shapes[0].world_from_object[3]), glm::dvec3(7, 8, 9));
  EXPECT_EQ(color_of(scene, scene.shapes[0].material), glm::dvec3(1, 0, 0));
}

// Numbers of what files/make.py gave to lib3mf 2.5.
TEST(Model3mf, AFileOfLib3mf) {
  const Scene scene =
      import_scene(test::source_folder() / "tests/lattices/files/lib3mf.3mf", test::NoImages());
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "frame");
  EXPECT_EQ(scene.instances.size(), 4u);
  // A lattice: 2 round beams, 4 ends of balls and a ball; 2 cylinders; 4 frusta, each with half a
  // ball. Twice.
  EXPECT_EQ(count_primitives(scene),
            (std::map<std::string, std::uint64_t>{
                {"capsule", 14}, {"cylinder", 4}, {"cone", 8}, {"sphere", 8}, {"triangle", 8}}));
  // Centimetres. The corner (0, 0, 0) has half a ball of 1 cm that looks outwards, the one at x =
  // 30 cm as well; the ball on top reaches 9.5 cm, the plate -5 cm.
  const Bounds bounds = bounds_of(scene);
  EXPECT_NEAR(bounds.min.x, -10, 1e-4);
  EXPECT_NEAR(bounds.max.x, 310, 1e-4);
  EXPECT_NEAR(bounds.max.y, 95, 1e-4);
  EXPECT_NEAR(bounds.min.y, -50, 1e-4);
  EXPECT_EQ(color_of(scene, scene.objects[1].shapes[0].material), glm::dvec3(1, 0, 0));
}

// 8 x 4 x 4 cells of 8 beams, each of two radii and with two balls at its ends, and a ball in their
// middles; two plates.
TEST(Model3mf, TheExampleIsWhatItsScriptWrites) {
  const Scene scene = import_scene(test::source_folder() / "scenes/lattice.3mf", test::NoImages());
  EXPECT_EQ(count_primitives(scene),
            (std::map<std::string, std::uint64_t>{
                {"capsule", 2 * 1024 + 128}, {"cone", 1024}, {"triangle", 24}}));
  EXPECT_EQ(scene.shapes.size(), 1025u);
  EXPECT_EQ(scene.instances.size(), 2u);
}

std::string refusal(const std::string& bytes) {
  return complaint([&] { scene_of(bytes); });
}

TEST(Bad3mf, LatticesAreRefusedWithTheirPlace) {
  const auto said = [](const std::string& attributes, const std::string& inside) {
    return refusal(test::package_3mf(lattice_model(attributes, inside)));
  };
  const auto beam = [&](const std::string& attributes) {
    return said("radius=\"1\"", "<b:beams>\n<b:beam " + attributes + "/></b:beams>");
  };
  EXPECT_THAT(beam("v1=\"0\" v2=\"9\""),
              AllOf(HasSubstr("a.3mf/3D/a.model:6:"), HasSubstr("v2 is vertex 9: there are 4")));
  EXPECT_THAT(beam("v1=\"1\" v2=\"1\""), HasSubstr("same vertex"));
  EXPECT_THAT(beam("v1=\"0\""), HasSubstr("needs v2"));
  EXPECT_THAT(beam("v1=\"0\" v2=\"1\" r2=\"1\""), HasSubstr("r2 without r1"));
  EXPECT_THAT(beam("v1=\"0\" v2=\"1\" r1=\"0\""), HasSubstr("not positive"));
  EXPECT_THAT(beam("v1=\"0\" v2=\"1\" r1=\"nan\""), HasSubstr("not finite"));
  EXPECT_THAT(beam("v1=\"0\" v2=\"1\" r1=\"thick\""), HasSubstr("'thick' is not a number"));
  EXPECT_THAT(beam("v1=\"0\" v2=\"1\" cap1=\"point\""), HasSubstr("cap1 is 'point'"));
  EXPECT_THAT(beam("v1=\"0\" v2=\"1\" pid=\"3\""), HasSubstr("no property group 3"));
  EXPECT_THAT(said("minlength=\"1\"", ""), HasSubstr("needs a radius"));
  EXPECT_THAT(said("radius=\"1\" ballmode=\"some\"", ""), HasSubstr("ballmode is 'some'"));
  EXPECT_THAT(said("radius=\"1\" ballmode=\"mixed\"", "<b:balls><b:ball vindex=\"0\"/></b:balls>"),
              HasSubstr("without a radius"));
  EXPECT_THAT(said("radius=\"1\"", ""), HasSubstr("nothing to draw"));
}

/// Two triangles of three vertices with these attributes, after a group of two colours (7) and one
/// of textures (9).
std::string triangles_model(const std::string& first, const std::string& second = "") {
  const auto triangle = [](const std::string& with) {
    return "<triangle " +
           (with.find("v3") == std::string::npos ? "v1=\"0\" v2=\"1\" v3=\"2\" " + with : with) +
           "/>\n";
  };
  return test::package_3mf(
      "<model><resources><m:colorgroup xmlns:m=\"x\" id=\"7\"><m:color color=\"#FF0000\"/>"
      "<m:color color=\"#00FF00\"/></m:colorgroup><m:texture2dgroup xmlns:m=\"x\" id=\"9\"/>"
      "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" "
      "z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices><triangles>\n" +
      triangle(first) + triangle(second) +
      "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>");
}

TEST(Model3mf, OtherPropertiesAreGrey) {
  test::LogOf log;
  const Scene scene = scene_of(triangles_model("pid=\"9\" p1=\"3\"", "pid=\"9\" p1=\"4\""));
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(scene.materials.at(scene.shapes[0].material).name, "default");
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.shapes[0].geometry).triangles.size(), 2U);
  const std::string said =
      "a.3mf/3D/a.model:2:2: properties of texture2dgroup are not read: what has them is grey";
  EXPECT_THAT(log.text(), HasSubstr(said));
  EXPECT_EQ(log.text().find("texture2dgroup"), log.text().rfind("texture2dgroup"));  // once
}

TEST(Bad3mf, TrianglesAreRefusedWithTheirPlace) {
  const auto said = [](const std::string& second) {
    return refusal(triangles_model("pid=\"7\" p1=\"1\"", second));
  };
  EXPECT_EQ(said(""), "");
  const std::string at = "a.3mf/3D/a.model:3:2: ";
  EXPECT_THAT(said("pid=\"7\" p1=\"2\""), HasSubstr(at + "property 2 of group 7: it has 2"));
  EXPECT_THAT(said("pid=\"red\""), HasSubstr(at + "pid: 'red' is no index"));
  EXPECT_THAT(said("pid=\"-7\""), HasSubstr(at + "pid: '-7' is no index"));
  EXPECT_THAT(said("pid=\"8\""), HasSubstr(at + "there is no property group 8"));
  EXPECT_THAT(said("v1=\"0\" v2=\"1\" v3=\"3\""), HasSubstr(at + "v3 is vertex 3: there are 3"));
}

// Each object holds the one before twice: the 21st is two million of the first.
TEST(Bad3mf, ObjectsWithoutEndAreRefused) {
  std::string text = "<model><resources><object id=\"1\"/>\n";
  for (int i = 2; i <= 22; ++i) {
    const std::string component = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    text += "<object id=\"" + std::to_string(i) + "\"><components>" + component + component +
            "</components></object>\n";
  }
  EXPECT_THAT(
      refusal(test::package_3mf(text + "</resources><build><item objectid=\"22\"/></build>"
                                       "</model>")),
      AllOf(HasSubstr("a.3mf/3D/a.model:"), HasSubstr("more than 2000000 objects are placed")));
}

// 64 bytes an element: 3 GiB hold 50,331,648.
TEST(Bad3mf, PartsOfTooManyElementsAreRefused) {
  const auto said = [](std::size_t elements) {
    return refusal(test::zip_of({{"_rels/.rels", std::string(elements, '<')}}, true));
  };
  EXPECT_THAT(said(50'331'648), HasSubstr("no XML"));
  EXPECT_THAT(said(50'331'649),
              HasSubstr("a.3mf: _rels/.rels: has more elements than 3 GiB of memory hold"));
}

TEST(Bad3mf, PackagesAreRefused) {
  EXPECT_THAT(refusal("no zip"), HasSubstr("no zip archive"));
  EXPECT_THAT(refusal(test::zip_of({{"a", "b"}})), HasSubstr("no _rels/.rels"));
  EXPECT_THAT(refusal(test::zip_of({{"_rels/.rels", "<Relationships/>"}})),
              HasSubstr("no relationship names"));
  const std::string good = test::package_3mf(
      lattice_model("radius=\"1\"", "<b:beams><b:beam v1=\"0\" v2=\"1\"/></b:beams>"));
  EXPECT_EQ(refusal(good), "");
  std::string broken = good;
  broken[good.find("vertex x")] = 'w';
  EXPECT_THAT(refusal(broken), HasSubstr("checksum"));
  for (const std::size_t size :
       {good.size() - 1, good.size() - 30, good.size() / 2, std::size_t{10}})
    EXPECT_THAT(refusal(good.substr(0, size)), HasSubstr("a.3mf")) << size;
  EXPECT_THAT(refusal(test::package_3mf(head + "<resources>")),
              AllOf(HasSubstr("a.model:3"), HasSubstr("no XML")));
  EXPECT_THAT(refusal(test::package_3mf("<model unit=\"mile\"/>")), HasSubstr("'mile' is no unit"));
  EXPECT_THAT(refusal(test::package_3mf("<model requiredextensions=\"q\" xmlns:q=\"urn:q\"/>")),
              HasSubstr("urn:q"));
  EXPECT_THAT(refusal(test::package_3mf("<model><build><item objectid=\"4\"/></build></model>")),
              HasSubstr("no object 4"));
  EXPECT_THAT(
      refusal(test::package_3mf("<model><resources><object id=\"1\"><components><component "
                                "objectid=\"1\"/></components></object>"
                                "</resources><build><item objectid=\"1\"/></build></model>")),
      HasSubstr("cycles"));
  EXPECT_THAT(
      refusal(test::package_3mf("<model><resources><basematerials id=\"2\"><base "
                                "displaycolor=\"red\"/></basematerials></resources></model>")),
      HasSubstr("'red' is no color"));
}

TEST(Bad3mf, ArchivesThatUnpackToTooMuchAreRefused) {
  const std::string bomb =
      test::zip_of({{"_rels/.rels", std::string(std::size_t{100} << 20, ' ')}}, true);
  ASSERT_LT(bomb.size(), std::size_t{1} << 20);
  EXPECT_THAT(refusal(bomb), HasSubstr("unpacks to more than"));
  // 64 MiB may be unpacked of small archives (most_unpacked), to the last byte.
  const std::string most =
      test::zip_of({{"_rels/.rels", std::string(std::size_t{64} << 20, ' ')}}, true);
  EXPECT_THAT(refusal(most), HasSubstr("no XML"));
  // One that lies about its size.
  std::string liar = bomb;
  for (std::size_t at = liar.find(std::string("\0\0\x40\x06", 4)); at != std::string::npos;
       at = liar.find(std::string("\0\0\x40\x06", 4)))
    liar.replace(at, 4, std::string("\1\0\0\0", 4));
  EXPECT_THAT(refusal(liar), HasSubstr("a.3mf"));
}

}  // namespace
}  // namespace caplet
