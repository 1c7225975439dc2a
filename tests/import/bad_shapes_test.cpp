// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Wrong shapes: one clear line each, with the exact place; and what the model refuses when no
// importer has.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "import_text.h"

namespace caplet::test::bad_shapes_test {
namespace {

struct Bad {
  std::string name;
  std::string text;  // after a line "WorldBegin"; ' stands for "
  std::string complaint;
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

std::string quotes(std::string text) {
  std::replace(text.begin(), text.end(), '\'', '"');
  return text;
}

const std::string ends = "'point3 p0' [0 0 0] 'point3 p1' [0 0 1] ";
const std::string ball = "ObjectBegin 'ball' Shape 'sphere' ObjectEnd\n";
const std::string box_object =
    "ObjectBegin 'box' Shape 'box' 'point3 p0' [0 0 0] 'point3 p1' [1 1 1] ObjectEnd\n";
const std::string both = "'string operation' 'union' 'string operands' ['ball' 'box']";

std::vector<Bad> bad_shapes() {
  std::vector<Bad> rows = {
      // Cylinders.
      {"CylinderWithoutRadius", "Shape 'cylinder' 'point3 p0' [0 0 0] 'point3 p1' [0 0 1]",
       "scene.pbrt:2:1: Shape 'cylinder': 'float radius' is missing"},
      {"CylinderWithoutEnd", "Shape 'cylinder' 'point3 p0' [0 0 0] 'float radius' 1",
       "scene.pbrt:2:1: Shape 'cylinder': 'point3 p1' is missing"},
      {"CylinderOfZeroRadius", "Shape 'cylinder' " + ends + "'float radius' 0",
       "scene.pbrt:2:58: Shape 'cylinder': 'radius' must be positive"},
      {"CylinderOfNegativeRadius", "Shape 'cylinder' " + ends + "'float radius' -2",
       "scene.pbrt:2:58: Shape 'cylinder': 'radius' must be positive"},
      {"CylinderOfTinyRadius", "Shape 'cylinder' " + ends + "'float radius' 1e-60",
       "scene.pbrt:2:58: Shape 'cylinder': 'radius' is too small for a 32-bit float"},
      {"CylinderOfHugeRadius", "Shape 'cylinder' " + ends + "'float radius' 1e19",
       "scene.pbrt:2:58: Shape 'cylinder': 'radius' is too large a number (above 1e18)"},
      {"CylinderOfNan", "Shape 'cylinder' " + ends + "'float radius' nan",
       "scene.pbrt:2:73: 'float radius': the number 'nan' is not finite"},
      {"CylinderWithEqualEnds",
       "Shape 'cylinder' 'point3 p0' [1 2 3] 'point3 p1' [1 2 3] 'float radius' 1",
       "scene.pbrt:2:38: Shape 'cylinder': 'p1' is the same point as 'p0' (as 32-bit floats): the "
       "solid has no axis"},
      {"CylinderWithEndsEqualAsFloats",
       "Shape 'cylinder' 'point3 p0' [1 2 3] 'point3 p1' [1 2 3.00000001] 'float radius' 1",
       "scene.pbrt:2:38: Shape 'cylinder': 'p1' is the same point as 'p0' (as 32-bit floats): the "
       "solid has no axis"},
      {"CylinderFarAway",
       "Shape 'cylinder' 'point3 p0' [0 1e30 0] 'point3 p1' [0 0 1] 'float radius' 1",
       "scene.pbrt:2:18: Shape 'cylinder': 'p0' is too large a number (above 1e18)"},
      {"UnknownCap", "Shape 'cylinder' " + ends + "'float radius' 1 'string caps' 'pointed'",
       "scene.pbrt:2:75: Shape 'cylinder': 'caps' must be 'flat', 'round' or 'open', not "
       "'pointed'"},
      {"ThreeCaps",
       "Shape 'cylinder' " + ends + "'float radius' 1 'string caps' ['flat' 'flat' 'flat']",
       "scene.pbrt:2:75: Shape 'cylinder': 'caps' takes 1 or 2 values, not 3"},
      {"CylinderOfBothForms", "Shape 'cylinder' " + ends + "'float radius' 1 'float zmin' 0",
       "scene.pbrt:2:75: Shape 'cylinder': unknown parameter 'zmin'; the nearest known name is "
       "'name'"},
      {"FlatOpenCylinder", "Shape 'cylinder' 'float zmin' 2 'float zmax' 2",
       "scene.pbrt:2:18: Shape 'cylinder': 'zmin' leaves nothing of the cylinder: it ends where it "
       "begins"},
      {"CapsOfAnOpenCylinder", "Shape 'cylinder' 'string caps' 'flat'",
       "scene.pbrt:2:18: Shape 'cylinder': unknown parameter 'caps'; the nearest known name is "
       "'name'"},
      // Cones.
      {"ConeOfZeroRadii", "Shape 'cone' " + ends + "'float radius' [0 0]",
       "scene.pbrt:2:54: Shape 'cone': 'radius' must be positive (of two radii one may be 0)"},
      {"ConeOfANegativeRadius", "Shape 'cone' " + ends + "'float radius' [1 -1]",
       "scene.pbrt:2:54: Shape 'cone': 'radius' must be positive (of two radii one may be 0)"},
      {"ConeOfThreeRadii", "Shape 'cone' " + ends + "'float radius' [1 1 1]",
       "scene.pbrt:2:54: Shape 'cone': 'radius' takes 1 or 2 values, not 3"},
      {"ConeWithEqualEnds",
       "Shape 'cone' 'point3 p0' [0 0 0] 'point3 p1' [0 0 0] 'float radius' [1 0]",
       "scene.pbrt:2:34: Shape 'cone': 'p1' is the same point as 'p0' (as 32-bit floats): the "
       "solid has no axis"},
      // Boxes and polyhedra.
      {"FlatBox", "Shape 'box' 'point3 p0' [0 0 0] 'point3 p1' [1 0 1]",
       "scene.pbrt:2:33: Shape 'box': 'p1' has the same y as 'p0' (as 32-bit floats): the box is "
       "flat"},
      {"BoxWithoutCorner", "Shape 'box' 'point3 p1' [1 0 1]",
       "scene.pbrt:2:1: Shape 'box': 'point3 p0' is missing"},
      {"PolyhedronWithoutNormals", "Shape 'polyhedron' 'point3 P' [0 0 0]",
       "scene.pbrt:2:1: Shape 'polyhedron': 'normal N' is missing"},
      {"PolyhedronOfUnequalLists", "Shape 'polyhedron' 'point3 P' [0 0 0 1 1 1] 'normal N' [0 0 1]",
       "scene.pbrt:2:45: Shape 'polyhedron': 'N' has 1 entries for 2 points"},
      {"PolyhedronWithAZeroNormal",
       "Shape 'polyhedron' 'point3 P' [0 0 0 1 1 1] 'normal N' [0 0 1 0 0 0]",
       "scene.pbrt:2:45: Shape 'polyhedron': 'N' has no direction for plane 1: it is zero"},
      // Parts of quadrics.
      {"PhiMaxOfZero", "Shape 'sphere' 'float phimax' 0",
       "scene.pbrt:2:16: Shape 'sphere': 'phimax' must be above 0 degrees"},
      {"NegativePhiMax", "Shape 'cylinder' 'float phimax' -90",
       "scene.pbrt:2:18: Shape 'cylinder': 'phimax' must be above 0 degrees"},
      {"SphereOutsideOfItself", "Shape 'sphere' 'float zmin' 2",
       "scene.pbrt:2:16: Shape 'sphere': 'zmin' leaves nothing of the sphere: it ends where it "
       "begins"},
      {"HoleAsLargeAsTheDisk", "Shape 'disk' 'float radius' 2 'float innerradius' 2",
       "scene.pbrt:2:31: Shape 'disk': 'innerradius' must be from 0 up and below the radius"},
      {"NegativeHole", "Shape 'disk' 'float innerradius' -1",
       "scene.pbrt:2:14: Shape 'disk': 'innerradius' must be from 0 up and below the radius"},
      // Meshes that move.
      {"PointsNotAsManyAtEachTime",
       "Shape 'trianglemesh' 'float times' [0 1] 'point3 P' [0 0 0 1 0 0 0 1 0] 'integer indices' "
       "[0 1 2]",
       "scene.pbrt:2:42: Shape 'trianglemesh': 'P' has 3 points, which are not as many at each of "
       "2 times"},
      {"TimesThatDoNotRise",
       "Shape 'trianglemesh' 'float times' [1 1] 'point3 P' [0 0 0 1 0 0 0 1 0]",
       "scene.pbrt:2:22: Shape 'trianglemesh': 'times' must rise"},
      {"OneTime", "Shape 'trianglemesh' 'float times' [1] 'point3 P' [0 0 0 1 0 0 0 1 0]",
       "scene.pbrt:2:22: Shape 'trianglemesh': 'times' takes two times or more"},
      {"NormalsOfSomeTimes",
       "Shape 'trianglemesh' 'float times' [1 2] 'point3 P' [0 0 0 1 0 0 0 1 0 0 0 0 1 0 0 0 1 1] "
       "'normal N' [0 0 1 0 0 1]",
       "scene.pbrt:2:91: Shape 'trianglemesh': 'N' has 2 entries for 3 vertices"},
      {"IndexOfALaterTime",
       "Shape 'trianglemesh' 'float times' [1 2] 'point3 P' [0 0 0 1 0 0 0 1 0 0 0 0 1 0 0 0 1 1] "
       "'integer indices' [0 1 3]",
       "scene.pbrt:2:91: Shape 'trianglemesh': 'indices' has the index 3 (entry 2), but there are "
       "3 vertices"},
      {"FilesWithoutTimes", "Shape 'plymesh' 'string filename' ['a.ply' 'b.ply']",
       "scene.pbrt:2:17: Shape 'plymesh': 'filename' takes one file a time of 'times', not 2 for "
       "0"},
      {"FilesOfOtherTimes",
       "Shape 'plymesh' 'string filename' ['a.ply' 'b.ply'] 'float times' [0 1 2]",
       "scene.pbrt:2:17: Shape 'plymesh': 'filename' takes one file a time of 'times', not 2 for "
       "3"},
      // Bilinear meshes.
      {"PatchIndexOutOfRange",
       "Shape 'bilinearmesh' 'point3 P' [0 0 0 1 0 0 0 1 0 1 1 0] 'integer indices' [0 1 2 4]",
       "scene.pbrt:2:59: Shape 'bilinearmesh': 'indices' has the index 4 (entry 3), but there are "
       "4 vertices"},
      {"PatchIndicesNotInFours",
       "Shape 'bilinearmesh' 'point3 P' [0 0 0 1 0 0 0 1 0 1 1 0] 'integer indices' [0 1 2]",
       "scene.pbrt:2:59: Shape 'bilinearmesh': 'indices' takes a multiple of 4 values, not 3"},
      {"PatchesWithoutIndices", "Shape 'bilinearmesh' 'point3 P' [0 0 0 1 0 0 0 1 0]",
       "scene.pbrt:2:1: Shape 'bilinearmesh': 'integer indices' is missing (only a mesh of 4 "
       "vertices needs none)"},
      // Curves.
      {"CurveOfWrongCount", "Shape 'curve' 'point3 P' [0 0 0 1 0 0 2 0 0]",
       "scene.pbrt:2:15: Shape 'curve': 'P' has 3 points; a Bezier curve of degree 3 takes 1 + n "
       "times 3"},
      {"SplineOfTooFew", "Shape 'curve' 'string basis' 'bspline' 'point3 P' [0 0 0 1 0 0 2 0 0]",
       "scene.pbrt:2:40: Shape 'curve': 'P' has 3 points; a B-spline of degree 3 takes at least 4"},
      {"CurveOfNoWidth", "Shape 'curve' 'point3 P' [0 0 0 1 0 0 2 0 0 3 0 0] 'float width' 0",
       "scene.pbrt:2:52: Shape 'curve': 'width' must be positive (of two widths one may be 0)"},
      {"CurveOfUnknownType",
       "Shape 'curve' 'point3 P' [0 0 0 1 0 0 2 0 0 3 0 0] 'string type' 'tube'",
       "scene.pbrt:2:52: Shape 'curve': 'type' must be 'flat', 'cylinder' or 'ribbon', not 'tube'"},
      {"CurveOfDegreeFour", "Shape 'curve' 'point3 P' [0 0 0 1 0 0 2 0 0 3 0 0] 'integer degree' 4",
       "scene.pbrt:2:52: Shape 'curve': 'degree' must be 2 or 3, not 4"},
      {"RibbonOfOneNormal",
       "Shape 'curve' 'point3 P' [0 0 0 1 0 0 2 0 0 3 0 0] 'string type' 'ribbon' 'normal N' [0 0 "
       "1]",
       "scene.pbrt:2:75: Shape 'curve': 'N' has 1 normals; a ribbon of 1 segments takes 2"},
      // CSG.
      {"CsgOfUnknownOperation",
       ball + box_object + "Shape 'csg' 'string operation' 'xor' 'string operands' ['ball' 'box']",
       "scene.pbrt:4:13: Shape 'csg': 'operation' must be 'union', 'intersection' or 'difference', "
       "not 'xor'"},
      {"CsgWithoutOperands", "Shape 'csg' 'string operation' 'union'",
       "scene.pbrt:2:1: Shape 'csg': 'string operands' is missing"},
      {"CsgOfUnknownOperand",
       ball + "Shape 'csg' 'string operation' 'union' 'string operands' ['ball' 'bal']",
       "scene.pbrt:3:40: Shape 'csg': 'operands' names the object 'bal', which is not defined "
       "before this; the nearest known "
       "name "
       "is 'ball'"},
      {"CsgOfOne", ball + "Shape 'csg' 'string operation' 'union' 'string operands' ['ball']",
       "scene.pbrt:3:40: Shape 'csg': 'operands' takes two names or more, not 1"},
      {"CsgOfItself",
       ball + "ObjectBegin 'a'\nShape 'csg' 'string operation' 'union' 'string operands' ['ball' "
              "'a']\nObjectEnd",
       "scene.pbrt:4:40: Shape 'csg': 'operands' names the object 'a', which is being defined "
       "(scene.pbrt:3:1): a csg cannot "
       "hold "
       "itself"},
      {"CsgOfACycle",
       ball +
           "ObjectBegin 'a'\nShape 'csg' 'string operation' 'union' 'string operands' ['ball' "
           "'other']\nObjectEnd\n" +
           "ObjectBegin 'other'\nShape 'csg' 'string operation' 'union' 'string operands' ['ball' "
           "'a']\nObjectEnd",
       "scene.pbrt:4:40: Shape 'csg': 'operands' names the object 'other', which is not defined "
       "before this; the nearest known "
       "name is 'a'"},
      {"CsgOfADisk", ball + "ObjectBegin 'box' Shape 'disk' ObjectEnd\nShape 'csg' " + both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:19), which is an open "
       "surface; operands are closed "
       "solids"},
      {"CsgOfAnOpenCylinder",
       ball + "ObjectBegin 'box' Shape 'cylinder' " + ends +
           "'float radius' 1 'string caps' ['flat' 'open'] ObjectEnd\n" + "Shape 'csg' " + both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:19), which is an open "
       "surface; operands are closed "
       "solids"},
      {"CsgOfTwoShapes",
       ball + "ObjectBegin 'box' Shape 'sphere' Shape 'sphere' ObjectEnd\nShape 'csg' " + both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:1), which holds 2 "
       "shapes; an operand is one closed "
       "shape"},
      {"CsgOfNoShape", ball + "ObjectBegin 'box' ObjectEnd\nShape 'csg' " + both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:1), which holds 0 "
       "shapes; an operand is one closed "
       "shape"},
      {"CsgOfACurve",
       ball +
           "ObjectBegin 'box' Shape 'curve' 'point3 P' [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 5 0 0 6 0 0] "
           "ObjectEnd\n" +
           "Shape 'csg' " + both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:19), which holds 2 "
       "capsules in one shape; an operand "
       "is "
       "one closed shape"},
      {"CsgOfALight",
       ball + "ObjectBegin 'box' AreaLightSource 'diffuse' Shape 'sphere' ObjectEnd\nShape 'csg' " +
           both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:45), which is an area "
       "light; only the csg itself may "
       "be "
       "one"},
      {"CsgOfAReversedSolid",
       ball + "ObjectBegin 'box' ReverseOrientation Shape 'sphere' ObjectEnd\nShape 'csg' " + both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:38), which is turned by "
       "ReverseOrientation; only the "
       "csg "
       "itself may be"},
      {"CsgOfAOneSidedSolid",
       ball + "ObjectBegin 'box' Shape 'sphere' 'bool onesided' true ObjectEnd\nShape 'csg' " +
           both,
       "scene.pbrt:4:40: Shape 'csg': 'operands' names 'box' (scene.pbrt:3:19), which is "
       "'onesided'; only the csg itself may be"},
      {"CsgOfGivenPower",
       ball + box_object + "AreaLightSource 'diffuse' 'float power' 60\nShape 'csg' " + both,
       "scene.pbrt:5:1: a csg cannot be a light of a given 'power', as its area is not known; give "
       "it an 'L'"},
      // Surfaces.
      {"OneMaterialForABox",
       "Shape 'box' 'point3 p0' [0 0 0] 'point3 p1' [1 1 1] 'string materials' 'red'",
       "scene.pbrt:2:53: Shape 'box': 'materials' takes 6 names, one a surface, not 1"},
      {"TwoMaterialsForASphere", "Shape 'sphere' 'string materials' ['red' 'red']",
       "scene.pbrt:2:16: Shape 'sphere': 'materials' takes 1 name, one a surface, not 2"},
      {"SixMaterialsForACsg",
       ball + box_object + "Shape 'csg' " + both + " 'string materials' ['a' 'a' 'a' 'a' 'a' 'a']",
       "scene.pbrt:4:73: Shape 'csg': 'materials' takes 7 names, one a surface, not 6"},
      {"UndefinedSurfaceMaterial",
       "Shape 'cylinder' " + ends +
           "'float radius' 1 'string materials' ['red' 'red' 'green']\n"
           "MakeNamedMaterial 'red' 'string type' 'diffuse'",
       "scene.pbrt:2:75: the material 'green' is not defined; the nearest known name is 'red'"},
      {"LightOnAMissingSurface",
       "AttributeBegin AreaLightSource 'diffuse' 'integer surfaces' [0 3]\nShape 'cone' " + ends +
           "'float radius' 1 AttributeEnd",
       "scene.pbrt:3:1: the light is on surface 3, but the surfaces are numbered from 0 to 2"},
      {"LightOnANegativeSurface", "AreaLightSource 'diffuse' 'integer surfaces' -1\nShape 'sphere'",
       "scene.pbrt:2:27: AreaLightSource 'diffuse': 'surfaces' are numbered from 0 up"},
      // Places.
      {"ScaledOutOfReach",
       "Scale 1e15 1e15 1e15\nShape 'box' 'point3 p0' [0 0 0] 'point3 p1' [1 1 1e4]",
       "scene.pbrt:3:1: the shape reaches further than 1e18 from the origin, where 32-bit floats "
       "end"},
      {"InstanceOutOfReach",
       ball + "AttributeBegin Scale 1e19 1e19 1e19\nObjectInstance 'ball' AttributeEnd",
       "scene.pbrt:4:1: the shape reaches further than 1e18 from the origin, where 32-bit floats "
       "end"},
  };
  const auto polyhedron = [&](const std::string& name, const std::string& planes,
                              const std::string& what, int plane) {
    rows.push_back({name, "Shape 'polyhedron' " + planes,
                    "scene.pbrt:2:1: the polyhedron " + what + ": look at plane " +
                        std::to_string(plane) + " (counted from 0)"});
  };
  polyhedron("Slab", "'point3 P' [0 0 0 0 0 1] 'normal N' [0 0 -1 0 0 1]", "has no bounds", 0);
  polyhedron("Octant", "'point3 P' [5 5 5 5 5 5 5 5 5] 'normal N' [1 0 0 0 1 0 0 0 1]",
             "has no bounds", 0);
  // A tube of square section, closed at its lower end: planes 1 to 4 go on for ever.
  polyhedron(
      "Shaft",
      "'point3 P' [0 0 0 -1 0 0 1 0 0 0 -1 0 0 1 0] 'normal N' [0 0 -1 -1 0 0 1 0 0 0 -1 0 0 1 0]",
      "has no bounds", 1);
  // A cube whose last plane leaves nothing of it, or only one of its sides.
  const std::string cube_normals = "'normal N' [-1 0 0 1 0 0 0 -1 0 0 1 0 0 0 -1 0 0 1 0 0 1]";
  polyhedron("NoInside", "'point3 P' [0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 -2] " + cube_normals,
             "has no inside", 6);
  polyhedron("NoThickness",
             "'point3 P' [0 0 0 1 0 0 0 0 0 0 1 0 0 0 0 0 0 1 0 0 0] " + cube_normals,
             "has no inside", 6);
  // 33 solids.
  std::string names;
  for (int i = 0; i < 33; ++i) names += " 'ball'";
  rows.push_back({"CsgOfTooMany",
                  ball + "Shape 'csg' 'string operation' 'union' 'string operands' [" + names + "]",
                  "scene.pbrt:3:40: Shape 'csg': 'operands' come to 33 solids, nested ones "
                  "counted; a csg shape holds at most 32"});
  std::string doubled = ball;
  for (int i = 0; i < 6; ++i) {
    const std::string of = i == 0 ? "ball" : "o" + std::to_string(i - 1);
    doubled += "ObjectBegin 'o" + std::to_string(i) +
               "'\nShape 'csg' 'string operation' 'union' 'string operands' ['" + of + "' '" + of +
               "']\nObjectEnd\n";
  }
  rows.push_back({"CsgOfTooManyNested", doubled,
                  "scene.pbrt:19:40: Shape 'csg': 'operands' come to 64 solids, nested ones "
                  "counted; a csg shape holds at most 32"});
  for (Bad& row : rows) {
    row.text = "WorldBegin\n" + quotes(row.text) + "\nShape \"sphere\"";
    row.complaint = quotes(row.complaint);
  }
  return rows;
}

class BadShape : public testing::TestWithParam<Bad> {};
TEST_P(BadShape, IsRefusedWithItsPlace) {
  EXPECT_THAT(complaints(GetParam().text), testing::ElementsAre(GetParam().complaint));
}
INSTANTIATE_TEST_SUITE_P(Import, BadShape, testing::ValuesIn(bad_shapes()),
                         [](const auto& row) { return row.param.name; });

// --- The model ---

std::vector<std::string> complaints_about(Shape shape) {
  Scene scene;
  scene.source = "model";
  scene.materials.emplace_back();
  shape.where = {"here", 1, 2};
  scene.shapes.push_back(std::move(shape));
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  try {
    diagnostics.finish();
  } catch (const InputError& error) {
    return error.messages();
  }
  return {};
}

template <class Geometry>
void expect_refused(const Geometry& geometry, const std::string& what) {
  Shape shape;
  shape.geometry = geometry;
  EXPECT_THAT(complaints_about(shape),
              testing::ElementsAre(
                  testing::AllOf(testing::StartsWith("here:1:2: "), testing::HasSubstr(what))));
}

const double bad_sizes[] = {0, -1, 1e-50, std::nan(""), INFINITY, -INFINITY};

TEST(Model, BadSizes) {
  for (const double bad : bad_sizes) {
    SCOPED_TRACE(bad);
    CylinderShape cylinder;
    cylinder.radius = bad;
    expect_refused(cylinder, "the cylinder's radius");
    ConeShape cone;
    cone.radius = {bad, 0};
    expect_refused(cone, "radii");
    expect_refused(PartialSphereShape{bad, -.5, .5, 1}, "the sphere's radius");
    expect_refused(OpenCylinderShape{bad, 0, 1, 1}, "the cylinder's radius");
    expect_refused(DiskShape{0, bad, 0, 1}, "the disk's radius");
    if (!(bad > 0) || bad == INFINITY) {
      expect_refused(PartialSphereShape{1, -.5, .5, bad}, "phi");
      expect_refused(OpenCylinderShape{1, 0, bad == 0 ? 0 : NAN, 1}, "greater z");
    }
    if (!(bad == 0 || bad == 1e-50)) expect_refused(DiskShape{0, 1, bad, 1}, "inner radius");
  }
}

TEST(Model, BadPlaces) {
  for (const double bad : {std::nan(""), double{INFINITY}, 1e200, -1e19}) {
    SCOPED_TRACE(bad);
    const std::string what = std::isfinite(bad) ? "1e18" : "not finite";
    expect_refused(CylinderShape{{0, 0, bad}, {0, 0, 1}, 1, {}}, what);
    expect_refused(ConeShape{{0, 0, 0}, {0, bad, 1}, {1, 2}, {}}, what);
    expect_refused(BoxShape{{0, 0, 0}, {bad, 1, 1}}, what);
    if (!std::isfinite(bad)) expect_refused(PolyhedronShape{{{bad, 0, 0}}, {{1, 0, 0}}}, "plane 0");
  }
  expect_refused(CylinderShape{{5, 5, 5}, {5, 5, 5}, 1, {}}, "no axis");
  expect_refused(ConeShape{{5, 5, 5}, {5, 5, 5}, {1, 2}, {}}, "no axis");
  expect_refused(BoxShape{{0, 0, 0}, {1, 1, 0}}, "the same z");
  expect_refused(PolyhedronShape{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}}}, "another number of normals");
  expect_refused(PolyhedronShape{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 0}}}, "plane 1");
  expect_refused(
      PolyhedronShape{std::vector(1025, glm::dvec3(0)), std::vector(1025, glm::dvec3(1))},
      "1025 planes");
  expect_refused(BilinearMeshShape{{{0, 0, 0}}, {{0, 0, 0, 1}}, {}, {}}, "vertex index 1");
  expect_refused(BilinearMeshShape{{{0, 0, NAN}}, {{0, 0, 0, 0}}, {}, {}}, "vertex 0");
  expect_refused(BilinearMeshShape{{{0, 0, 0}}, {{0, 0, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}, {}},
                 "another number of normals");
}

std::shared_ptr<Shape> solid() {
  auto shape = std::make_shared<Shape>();
  shape->geometry = SphereShape{1};
  return shape;
}

TEST(Model, BadCsg) {
  using enum CsgShape::Operation;
  expect_refused(CsgShape{set_union, {solid()}}, "fewer than two");
  auto open = solid();
  open->geometry = DiskShape{};
  expect_refused(CsgShape{set_union, {solid(), open}}, "open surface");
  auto two = solid();
  two->geometry = CapsulesShape{{{0, 0, 0}, {0, 0, 0}}, {{1, 0, 0}, {1, 0, 0}}, {1, 1}, {}, {}};
  expect_refused(CsgShape{set_union, {solid(), two}}, "one capsule");
  auto odd = CsgShape{set_union, {solid(), solid()}};
  odd.motions.resize(3);
  expect_refused(odd, "motions of 3 operands, but 2 operands");
  odd.operands[0] = odd.operands[1] = [] {
    auto here = std::make_shared<Shape>(*solid());
    here->where = {"here", 1, 2};
    return here;
  }();
  odd.motions = {{{0, glm::dmat4(1)}}, {}};
  expect_refused(odd, "a motion has two keys or more");
  odd.motions = {{{0, glm::dmat4(1)}, {1, glm::dmat4(-1)}}, {}};
  expect_refused(odd, "mirror image");
  auto light = solid();
  light->emission = AreaEmission{};
  expect_refused(CsgShape{set_union, {solid(), light}}, "area light");
  // 2^40 solids, were they counted.
  auto deep = solid();
  for (int i = 0; i < 40; ++i) {
    auto next = solid();
    next->geometry = CsgShape{set_union, {deep, deep}};
    deep = next;
  }
  expect_refused(std::get<CsgShape>(deep->geometry), "more than 32 solids");
  auto flat = solid();
  flat->world_from_object[1][1] = 0;
  flat->where = {"here", 1, 2};
  expect_refused(CsgShape{set_union, {solid(), flat}}, "singular");
  auto painted = solid();
  painted->material = 7;
  painted->where = {"here", 1, 2};
  expect_refused(CsgShape{set_union, {solid(), painted}}, "a material that does not exist");
}

TEST(Model, BadMaterials) {
  Shape shape;
  shape.geometry = BoxShape{};
  shape.materials = {0, 0, 0};
  EXPECT_THAT(complaints_about(shape),
              testing::ElementsAre("here:1:2: the shape has 6 surfaces, but materials for 3"));
  shape.materials = {0, 0, 0, 1, 0, 0};
  EXPECT_THAT(
      complaints_about(shape),
      testing::ElementsAre("here:1:2: a surface of the shape has a material that does not exist"));
}

}  // namespace
}  // namespace caplet::test::bad_shapes_test
