// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Glass chains: the union of touching or overlapping solids transmits like one.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "render_scene.h"
#include "support/data.h"

namespace caplet::test {
namespace {

std::string scene_text(const std::string& shapes) {
  // An uneven sky: a bright side, so that what is seen through the glass depends on how often and
  // where it is refracted.
  return "Integrator \"path\" \"integer maxdepth\" 100\nLookAt 0 -4 0.4  0 0 0  0 0 1\nCamera "
         "\"perspective\" \"float fov\" 42\n"
         "PixelFilter \"box\"\nFilm \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" "
         "32\nWorldBegin\n"
         "LightSource \"infinite\" \"rgb L\" [0.3 0.3 0.3]\n"
         "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [4 4 4] Shape \"disk\" \"float "
         "radius\" 3 \"float height\" -2 "
         "AttributeEnd\n"
         "Material \"dielectric\" \"float eta\" 1.5\n" +
         shapes;
}

std::string capsule(const std::string& p0, const std::string& p1, const std::string& radius) {
  return "Shape \"capsule\" \"point3 p0\" [" + p0 + "] \"point3 p1\" [" + p1 +
         "] \"float radius\" [" + radius + "]\n";
}

Picture picture(const std::string& shapes, int samples) {
  const auto file = temporary_folder() / "chain.pbrt";
  std::ofstream(file) << scene_text(shapes);
  return picture_of(render_file(file, samples).image);
}

// A capsule cut in three is the capsule again: same paths to rounding, and where they part (grazing
// rays) the same light on average.
TEST(GlassChain, StraightChainIsOneCapsule) {
  const Picture whole = picture(capsule("-1.5 0 0", "1.5 0 0", "0.5"), 256);
  const Picture chain =
      picture("ObjectBegin \"a\" " + capsule("-1.5 0 0", "-0.5 0 0", "0.5") +
                  "ObjectEnd ObjectBegin \"b\" " + capsule("-0.5 0 0", "0.5 0 0", "0.5") +
                  "ObjectEnd ObjectBegin \"c\" " + capsule("0.5 0 0", "1.5 0 0", "0.5") +
                  "ObjectEnd Shape \"csg\" \"string operation\" \"union\" \"string operands\" "
                  "[\"a\" \"b\" \"c\"]\n",
              256);
  const Figures figures = compare(chain, whole);
  // The noise of 2,048 pixels at 256 samples is about 0.1 % of the mean; a seam or an inner surface
  // takes 4 % a crossing.
  EXPECT_LT(std::abs(figures.mean), 3e-3);
  EXPECT_LT(figures.blocks, 1e-2);
}

// However a Y is put together, it is the same solid.
TEST(GlassChain, OrderOfTheBranchesDoesNotMatter) {
  const std::string parts =
      "ObjectBegin \"a\" " + capsule("-1.5 0 0", "0 0 0", "0.5") + "ObjectEnd ObjectBegin \"b\" " +
      capsule("0 0 0", "1.2 0.1 0.7", "0.5 0.3") + "ObjectEnd ObjectBegin \"c\" " +
      capsule("0 0 0", "1.2 0 -0.7", "0.5") + "ObjectEnd\n";
  const std::string csg = "Shape \"csg\" \"string operation\" \"union\" \"string operands\" ";
  const Picture flat = picture(parts + csg + "[\"a\" \"b\" \"c\"]\n", 256);
  const Picture nested = picture(
      parts + "ObjectBegin \"bc\" " + csg + "[\"c\" \"b\"] ObjectEnd\n" + csg + "[\"bc\" \"a\"]\n",
      256);
  const Figures figures = compare(nested, flat);
  EXPECT_LT(std::abs(figures.mean), 3e-3);
  EXPECT_LT(figures.blocks, 1e-2);
}

}  // namespace
}  // namespace caplet::test
