// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes whose model names its fields are read without a reader of their own.
#include <gmock/gmock.h>

#include "import/detail/pbrt/geometry.h"

namespace caplet::test {

struct Slab {
  glm::dvec3 low{0}, high{1};
  double radius = 2;
};
void fields(Slab& slab, Fields& each) {
  each.corners("p0", "p1", slab.low, slab.high);
  each.positive("radius", slab.radius);
}
void check(const Slab& slab, ShapeCheck& report) {
  if (slab.radius > 5) report.error("radius", "is above 5");
  if (slab.high.z > 100) report.error("the slab is too high");
}

namespace {

using glm::dvec3;
using testing::ElementsAre;

pbrt::Parameter numbers(const std::string& type, const std::string& name,
                        std::vector<double> values) {
  pbrt::Parameter out;
  out.type = type;
  out.name = name;
  out.where = {"scene.pbrt", 3, 4};
  out.numbers = std::move(values);
  return out;
}

struct Read {
  Slab slab;
  std::vector<std::string> complaints;
};
Read read(std::vector<pbrt::Parameter> own) {
  Diagnostics diagnostics;
  const std::string file = "scene.pbrt";
  pbrt::Parameters parameters(std::move(own), {}, "Shape \"slab\"", {"scene.pbrt", 3, 1}, file,
                              ColorSpace::srgb, diagnostics);
  Read out{pbrt::read_fields<Slab>(parameters), {}};
  parameters.finish();
  try {
    diagnostics.finish();
  } catch (const InputError& error) {
    out.complaints = error.messages();
  }
  return out;
}

const pbrt::Parameter p0 = numbers("point3", "p0", {4, -2, 3}),
                      p1 = numbers("point3", "p1", {-4, 2, -3});

TEST(FieldsOfShapes, CornersComeInOrderAndNumbersAsGiven) {
  const Read given = read({p0, p1, numbers("float", "radius", {0.5})});
  EXPECT_THAT(given.complaints, ElementsAre());
  EXPECT_EQ(given.slab.low, dvec3(-4, -2, -3));
  EXPECT_EQ(given.slab.high, dvec3(4, 2, 3));
  EXPECT_EQ(given.slab.radius, 0.5);
  EXPECT_EQ(read({p0, p1}).slab.radius, 2);
}

TEST(FieldsOfShapes, WhatIsWrongIsAtItsParameter) {
  EXPECT_THAT(read({p0}).complaints,
              ElementsAre("scene.pbrt:3:1: Shape \"slab\": \"point3 p1\" is missing"));
  EXPECT_THAT(read({p0, p1, numbers("float", "radius", {-1})}).complaints,
              ElementsAre("scene.pbrt:3:4: Shape \"slab\": \"radius\" must be positive"));
  EXPECT_THAT(
      read({p0, p1, numbers("float", "radius", {1e-60})}).complaints,
      ElementsAre("scene.pbrt:3:4: Shape \"slab\": \"radius\" is too small for a 32-bit float"));
  const Read wide = read({p0, p1, numbers("float", "radius", {7})});
  EXPECT_THAT(wide.complaints,
              ElementsAre("scene.pbrt:3:4: Shape \"slab\": \"radius\" is above 5"));
  EXPECT_EQ(wide.slab.radius, 2);  // something harmless
  EXPECT_THAT(read({p0, numbers("point3", "p1", {0, 0, 101})}).complaints,
              ElementsAre("scene.pbrt:3:1: Shape \"slab\": the slab is too high"));
}

}  // namespace
}  // namespace caplet::test
