// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Which medium a point is in where solids touch, share faces or lie within each other with faces at
// the same place (docs/media.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "media_scenes.h"

namespace caplet::test::touching_test {
namespace {

constexpr double near = 2e-4;

TEST(Touching, BoxesThatShareAFace) {
  for (const double half :
       {1.0, 0.3, 2.0}) {  // of the second one: the larger one in front, or the smaller one
    const std::string first = box(-1, 0, "a"), second = box(0, 0.5, "c", "", half);
    EXPECT_NEAR(lost(-9, first + second), 0.3 + 0.45, near) << half;
    EXPECT_NEAR(lost(-9, second + first), 0.3 + 0.45, near) << half;
  }
  EXPECT_NEAR(lost(-9, box(-0.5, 0, "c") + box(0, 1, "a")), 0.3 + 0.45, near);
  EXPECT_NEAR(lost(-9, box(-2, -1, "a") + box(-1, 0, "c") + box(0, 1, "a") + box(1, 2, "c", "", 5)),
              2 * (0.3 + 0.9), near);
  EXPECT_NEAR(lost(-9, box(-2, -1, "b") + box(-1, 0, "b") + box(0.5, 1, "b")), 0.5 * 2.5, near);
}

TEST(Touching, TheCameraMayBeInEither) {
  const std::string both = box(-1, 0, "a") + box(0, 0.5, "c");
  EXPECT_NEAR(lost(-0.5, both), 0.15 + 0.45, near);
  EXPECT_NEAR(lost(0.25, both), 0.225, near);
  EXPECT_NEAR(lost(0, both), 0.45, near);
  EXPECT_NEAR(lost(0.75, both), 0, near);
}

TEST(Touching, RoundSolidsInAPoint) {
  EXPECT_NEAR(lost(-9, sphere(-1, 1, "a") + sphere(0.5, 0.5, "c")), 0.6 + 0.9, near);
  EXPECT_NEAR(lost(-9, sphere(-0.5, 0.5, "a") + sphere(1, 1, "c")), 0.3 + 1.8, near);
  // From within, at the far side: then there is nothing.
  EXPECT_NEAR(lost(-9, sphere(0, 1, "a") + sphere(0.5, 0.5, "c", "a")), 0.3 + 0.9, near);
  EXPECT_NEAR(lost(-9, sphere(0, 1, "a") + sphere(-0.5, 0.5, "c", "a")), 0.3 + 0.9, near);
}

TEST(Touching, InnerSolidsWithAFaceOfTheOuterOne) {
  for (const double z : {-1.0, 0.0})
    for (const double half : {0.5, 1.0}) {
      const std::string outer = box(-1, 1, "a"), inner = box(z, z + 1, "c", "a", half);
      EXPECT_NEAR(lost(-9, outer + inner), 0.3 + 0.9, near) << z;
      EXPECT_NEAR(lost(-9, inner + outer), 0.3 + 0.9, near) << z;
    }
  // A capsule within one, with the same radius and an end of it.
  const auto capsule = [](const std::string& in, const std::string& out, double z0, double z1) {
    return "MediumInterface \"" + in + "\" \"" + out + "\" Shape \"capsule\" \"point3 p0\" [0 0 " +
           std::to_string(z0) + "] \"point3 p1\" [0 0 " + std::to_string(z1) +
           "] \"float radius\" 0.5\n";
  };
  EXPECT_NEAR(lost(-9, capsule("a", "", -1, 1) + capsule("c", "a", -1, 0)), 2 * 0.9 + 0.3, near);
  EXPECT_NEAR(lost(-9, capsule("a", "", -1, 1) + capsule("c", "a", 0, 1)), 2 * 0.9 + 0.3, near);
}

TEST(Touching, CsgShapesAndMeshes) {
  const std::string difference =
      "ObjectBegin \"s\" Shape \"box\" \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1] ObjectEnd "
      "ObjectBegin \"t\" Shape \"box\" "
      "\"point3 p0\" [-0.3 "
      "-0.3 -1] \"point3 p1\" [0.3 0.3 0] ObjectEnd MediumInterface \"a\" \"\" Shape \"csg\" "
      "\"string operands\" [\"s\" \"t\"] "
      "\"string operation\" "
      "\"difference\"\n";
  EXPECT_NEAR(lost(-9, difference), 0.3, near);
  EXPECT_NEAR(lost(-9, difference + box(-1, 0, "c", "", 0.3)), 0.3 + 0.9, near);
  const std::string mesh =
      "MediumInterface \"b\" \"\" Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 "
      "1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 "
      "1] "
      "\"integer indices\" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 "
      "7]\n";
  for (const double half : {0.5, 1.0, 3.0}) {
    EXPECT_NEAR(lost(-9, mesh + box(1, 2, "c", "", half)), 1 + 0.9, near) << half;
    EXPECT_NEAR(lost(-9, mesh + box(-2, -1, "c", "", half)), 1 + 0.9, near) << half;
    EXPECT_NEAR(lost(0, mesh + box(-2, -1, "c", "", half)), 0.5, near) << half;
  }
  EXPECT_NEAR(lost(-9, mesh + box(0, 1, "c", "b", 0.5)), 0.5 + 0.9, near);
}

// An interface at the same place does not hide what stops light.
TEST(Touching, WallsBehindInterfaces) {
  const std::string view = parallel_view(0.2) + "WorldBegin\n" + white_sky() + three_media();
  const std::string lit =
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 2 2]  Material \"diffuse\" \"rgb "
      "reflectance\" "
      "[0 0 0] MediumInterface \"\" \"\" Shape \"box\" \"point3 p0\" [-2 -2 0] \"point3 p1\" [2 2 "
      "1] AttributeEnd\n";
  EXPECT_TRUE(agrees(seen(view + lit + box(-1, 0, "a"), 16), 2 * std::exp(-0.3)));
  EXPECT_TRUE(agrees(seen(view + box(-1, 0, "a") + lit, 16), 2 * std::exp(-0.3)));
  // The same with a wall that a distant light shines on: there and back.
  const std::string shone = parallel_view(0.2) +
                            "WorldBegin\nLightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 "
                            "to\" [0 0 0] \"rgb L\" [1 1 1]\n" +
                            three_media() +
                            "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"box\" "
                            "\"point3 p0\" [-9 -9 0] \"point3 p1\" [9 9 1]\n";
  for (const std::string& order :
       {box(-1, 0, "a") + box(-2, -1, "c", "", 5), box(-2, -1, "c") + box(-1, 0, "a", "", 5)})
    EXPECT_TRUE(agrees(seen(shone + order, 16), 0.5 / std::numbers::pi * std::exp(-2 * 1.2), 1e-3));
}

// What is left last says what is around, whichever of the surfaces at one place comes first.
TEST(Touching, ShadowRaysLeaveSolidsWithOneFace) {
  const std::string shone = parallel_view(0.2) +
                            "WorldBegin\nLightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 "
                            "to\" [0 0 0] \"rgb L\" [1 1 1]\n" +
                            three_media() +
                            "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"box\" "
                            "\"point3 p0\" [-9 -9 0] \"point3 p1\" [9 9 1]\n";
  const std::string outer = box(-2, -1, "a"), inner = box(-2, -1.5, "c", "a", 0.5);
  for (const std::string& order : {outer + inner, inner + outer})
    EXPECT_TRUE(agrees(seen(shone + order, 16),
                       0.5 / std::numbers::pi * std::exp(-2 * (0.45 + 0.15)), 1e-3));
}

// Faces of a mesh that meet in the way of a ray are gone through once. So far out that a coordinate
// in four, as floats are, is that of an edge.
TEST(Touching, EdgesOfMeshes) {
  constexpr int n = 16;
  const double at = 16384, cell = std::ldexp(1, -7), half = n * cell / 2;
  std::string points, indices;
  const auto corner = [&](double x, double y, double z) {
    points += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " ";
  };
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) corner(at + x * cell, y * cell, -1);
  const int top = (n + 1) * (n + 1);
  corner(at + half, half, -2);
  const auto triangle = [&](int a, int b, int c) {
    indices += std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + " ";
  };
  const auto number = [&](int x, int y) { return y * (n + 1) + x; };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      triangle(number(x, y), number(x + 1, y), number(x + 1, y + 1));
      triangle(number(x, y), number(x + 1, y + 1), number(x, y + 1));
    }
  for (int i = 0; i < n; ++i) {
    triangle(number(i + 1, 0), number(i, 0), top);
    triangle(number(i, n), number(i + 1, n), top);
    triangle(number(0, i), number(0, i + 1), top);
    triangle(number(n, i + 1), number(n, i), top);
  }
  const std::string scene =
      "Integrator \"volpath\" \"integer maxdepth\" 5\nLookAt " + std::to_string(at + half) + " " +
      std::to_string(half) + " -0.5 " + std::to_string(at + half) + " " + std::to_string(half) +
      " 0 0 1 0\nCamera \"perspective\" \"float fov\" 4\nWorldBegin\nLightSource \"distant\" "
      "\"point3 from\" [0 0 -1] \"point3 "
      "to\" [0 0 0] \"rgb L\" [1 1 1]\n" +
      three_media() +
      "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\nShape \"bilinearmesh\" \"point3 P\" "
      "[16380 -4 0 " +
      "16390 -4 0 16380 4 0 16390 4 0]\nMaterial \"interface\" ";
  const std::string mesh = "MediumInterface \"a\" \"\" Shape \"trianglemesh\" \"point3 P\" [" +
                           points + "] \"integer indices\" [" + indices + "]\n";
  const std::string behind =
      "MediumInterface \"b\" \"\" Shape \"box\" \"point3 p0\" [16380 -4 -4] \"point3 p1\" [16390 4 "
      "-3]\n";
  const Mean alone = seen(scene + behind, 64), both = seen(scene + behind + mesh, 64);
  EXPECT_NEAR(alone.value, 0.5 / std::numbers::pi * std::exp(-0.5), 1e-3);
  // Lengths within the pyramid fall from 1 at its middle to the border.
  const double seen_half = 0.5 * std::tan(2 * std::numbers::pi / 180);
  double expected = 0;
  for (int i = 0; i < 1000; ++i)
    expected += 2 * (i + 0.5) / 1e6 * std::exp(-0.3 * (1 - seen_half / half * (i + 0.5) / 1000));
  EXPECT_NEAR(both.value / alone.value, expected, 0.01);
}

// A pane of glass that stands on a box: what is seen is the light between its faces, which comes
// back a geometric series of times.
TEST(Touching, GlassOnABox) {
  const double r = std::pow(0.5 / 2.5, 2), through = std::exp(-0.45),
               round = r * r * through * through;
  const double passed = (1 - r) * (1 - r) * through / (1 - round),
               mirrored = r + (1 - r) * (1 - r) * r * through * through / (1 - round);
  const double a = std::exp(-0.3), before = a * (passed + mirrored * a),
               behind = passed * a + mirrored;
  const std::string view = parallel_view(0.2) + "WorldBegin\n" + white_sky() + three_media();
  const auto glass = [](double half) {
    return "AttributeBegin Material \"dielectric\" \"float eta\" 1.5 MediumInterface \"c\" \"\" "
           "Shape \"box\" \"point3 p0\" [-" +
           std::to_string(half) + " -" + std::to_string(half) + " 0] \"point3 p1\" [" +
           std::to_string(half) + " " + std::to_string(half) + " 0.5] AttributeEnd\n";
  };
  for (const double half : {0.9, 1.0, 4.0}) {
    EXPECT_TRUE(agrees(seen(view + box(-1, 0, "a") + glass(half), 512), before)) << half;
    EXPECT_TRUE(agrees(seen(view + box(0.5, 1.5, "a") + glass(half), 512), behind)) << half;
  }
}

// --- Boxes with corners at whole numbers, against what each stretch of length 1 is in ---

struct GridBox {
  std::array<int, 3> low, high;
  int medium;
  double size() const {
    const double x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
    return x * y + y * z + z * x;
  }
  bool holds(int x, int y, int z) const {
    const std::array at{x, y, z};
    for (std::size_t k = 0; k < 3; ++k)
      if (at[k] < low[k] || at[k] >= high[k]) return false;
    return true;
  }
};

constexpr int side = 12;
constexpr std::array sigmas{0.3, 0.5, 0.9};

/// Boxes in a cube of `side`, at most four over each cell, whose smallest one there is plain.
std::vector<GridBox> grid_boxes(unsigned seed, int wanted) {
  std::mt19937 random(seed);
  const auto upto = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<GridBox> out;
  std::vector<std::vector<std::size_t>> over(side * side * side);
  for (int tries = 0; tries < 100 * wanted && static_cast<int>(out.size()) < wanted; ++tries) {
    GridBox one{};
    for (std::size_t k = 0; k < 3; ++k) {
      one.low[k] = upto(side);
      one.high[k] = std::min(side, one.low[k] + 1 + upto(4));
    }
    one.medium = upto(3);
    bool fits = true;
    const auto cells = [&](const auto& visit) {
      for (int z = one.low[2]; z < one.high[2]; ++z)
        for (int y = one.low[1]; y < one.high[1]; ++y)
          for (int x = one.low[0]; x < one.high[0]; ++x)
            visit(over[static_cast<std::size_t>((z * side + y) * side + x)]);
    };
    cells([&](const std::vector<std::size_t>& here) {
      fits = fits && here.size() < 4;
      for (const std::size_t i : here)
        fits = fits && (out[i].size() != one.size() || out[i].medium == one.medium);
    });
    if (!fits) continue;
    cells([&](std::vector<std::size_t>& here) { here.push_back(out.size()); });
    out.push_back(one);
  }
  return out;
}

/// What is lost along +z through the cells at x, y from z on.
double lost_in(const std::vector<GridBox>& boxes, int x, int y, double from) {
  double sum = 0;
  for (int z = 0; z < side; ++z) {
    const GridBox* smallest = nullptr;
    for (const GridBox& one : boxes)
      if (one.holds(x, y, z) && (!smallest || one.size() < smallest->size())) smallest = &one;
    if (smallest)
      sum +=
          std::clamp(z + 1 - from, 0.0, 1.0) * sigmas[static_cast<std::size_t>(smallest->medium)];
  }
  return sum;
}

/// Each with a transform of its own, whose rounding puts faces of the same place apart, or without.
std::string text_of(const std::vector<GridBox>& boxes, bool placed, bool glass) {
  std::string out = "Scale 0.1 0.1 0.1\n";
  std::array<bool, side * side> glazed{};
  for (const GridBox& one : boxes) {
    out += "AttributeBegin MediumInterface \"" +
           std::string(1, static_cast<char>('a' + one.medium)) + "\" \"\" Material ";
    // No ray is scattered more than twice, so that none is ended by chance.
    bool clear = glass;
    const auto columns = [&](const auto& visit) {
      for (int y = one.low[1]; y < one.high[1]; ++y)
        for (int x = one.low[0]; x < one.high[0]; ++x)
          visit(glazed[static_cast<std::size_t>(y * side + x)]);
    };
    columns([&](bool here) { clear = clear && !here; });
    if (clear) columns([](bool& here) { here = true; });
    out += clear ? "\"dielectric\" \"float eta\" 1\n" : "\"interface\"\n";
    std::array<int, 3> d{};
    for (std::size_t k = 0; k < 3; ++k) d[k] = one.high[k] - one.low[k];
    const auto three = [](const std::array<int, 3>& v) {
      return " " + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) +
             " ";
    };
    if (placed)
      out += "Translate" + three(one.low) + "Scale" + three(d) +
             "Scale 0.7 0.7 0.7 Shape \"box\" \"point3 p0\" [0 0 0] \"point3 p1\" "
             "[1.4285714285714286 1.4285714285714286 1.4285714285714286]";
    else
      out += "Shape \"box\" \"point3 p0\" [" + three(one.low) + "] \"point3 p1\" [" +
             three(one.high) + "]";
    out += " AttributeEnd\n";
  }
  return out;
}

/// One pixel of three a cell along each axis counts, whose rays keep to the cell.
void compare_columns(const std::vector<GridBox>& boxes, const std::string& light,
                     const std::string& wall, const std::string& shapes, double times) {
  const std::string view =
      "Integrator \"volpath\" \"integer maxdepth\" 1000\nTranslate -0.6 -0.6 999\nCamera "
      "\"perspective\" \"float fov\" " +
      std::to_string(2 * std::atan(0.6e-3) * 180 / std::numbers::pi) +
      "\nPixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\nWorldBegin\n" + light;
  const auto picture = [&](const std::string& text) {
    Scene scene = scene_of_text(text);
    scene.view.film.width = scene.view.film.height = 3 * side;
    return render_model(scene, 4).image;
  };
  const std::string away = "AttributeBegin Translate 500 0 0 Shape \"sphere\" AttributeEnd\n";
  const LayeredImage empty = picture(view + three_media() + away + wall);
  const LayeredImage image = picture(view + three_media() + wall + shapes);
  const Channel dark = channel(image, "G"), bright = channel(empty, "G");
  int wrong = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      // Rows go down.
      const auto at = static_cast<std::size_t>((3 * (side - 1 - y) + 1) * 3 * side + 3 * x + 1);
      const double seen_here = std::log(bright.floats[at] / dark.floats[at]),
                   expected = times * 0.1 * lost_in(boxes, x, y, 0);
      wrong += std::abs(seen_here - expected) > 1e-3;
      if (wrong == 1 && std::abs(seen_here - expected) > 1e-3)
        ADD_FAILURE() << x << " " << y << ": " << seen_here << ", not " << expected;
    }
  EXPECT_EQ(wrong, 0);
}

TEST(Touching, BoxesOnAGrid) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const std::vector<GridBox> boxes = grid_boxes(seed, 300);
    ASSERT_GT(boxes.size(), 150u);
    for (const bool placed : {false, true})
      for (const bool glass : {false, true}) {
        SCOPED_TRACE(testing::Message()
                     << seed << (placed ? " placed" : "") << (glass ? " glass" : ""));
        compare_columns(boxes, white_sky(), "", text_of(boxes, placed, glass), 1);
      }
  }
}

TEST(Touching, BoxesOnAGridWeakenShadowRays) {
  const std::string light =
      "LightSource \"distant\" \"point3 from\" [0 0 -1] \"point3 to\" [0 0 0] \"rgb L\" [1 1 1]\n";
  const std::string wall =
      "AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape "
      "\"bilinearmesh\" \"point3 P\" [-50 -50 1.2 50 "
      "-50 1.2 -50 50 1.2 50 50 "
      "1.2] AttributeEnd\n";
  for (const unsigned seed : {4u, 5u}) {
    const std::vector<GridBox> boxes = grid_boxes(seed, 300);
    for (const bool placed : {false, true}) {
      SCOPED_TRACE(testing::Message() << seed << (placed ? " placed" : ""));
      compare_columns(boxes, light, wall, text_of(boxes, placed, false), 2);
    }
  }
}

TEST(Touching, TheCameraAmongBoxesOnAGrid) {
  std::mt19937 random(6);
  for (const unsigned seed : {7u, 8u}) {
    const std::vector<GridBox> boxes = grid_boxes(seed, 300);
    for (int i = 0; i < 12; ++i) {
      const int x = static_cast<int>(random() % side), y = static_cast<int>(random() % side);
      const double z = 0.25 * static_cast<double>(random() % (4 * side));  // on faces too
      const std::string moved = "Translate " + std::to_string(-0.1 * (x + 0.4)) + " " +
                                std::to_string(-0.1 * (y + 0.3)) + " 0\n";
      EXPECT_NEAR(lost(0.1 * z, moved + text_of(boxes, i % 2 == 1, i % 3 == 1)),
                  0.1 * lost_in(boxes, x, y, z), 1e-3)
          << x << " " << y << " " << z;
    }
  }
}

}  // namespace
}  // namespace caplet::test::touching_test
