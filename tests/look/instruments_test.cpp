// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scale bar, axes and colour bar as they are read off a picture: its letters are found and told
// from others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "film/transfer.h"
#include "post/detail/canvas.h"
#include "post/detail/parts.h"
#include "post/overlay.h"
#include "support/import_files.h"

namespace caplet::post {
namespace {

using test::complaint;
using testing::HasSubstr;

Shown white(int width, int height) {
  return {width,
          height,
          std::vector<std::array<float, 3>>(static_cast<std::size_t>(width * height), {1, 1, 1}),
          {}};
}

std::array<float, 3> color_at(const Shown& picture, int x, int y) {
  return picture.rgb.at(static_cast<std::size_t>(y * picture.width + x));
}

/// How much of a pixel is covered by black letters on white; sRGB, in which they are mixed. What is
/// coloured is none.
double ink_at(const Shown& picture, int x, int y) {
  const auto& color = color_at(picture, x, y);
  const float most = std::max({color[0], color[1], color[2]}),
              least = std::min({color[0], color[1], color[2]});
  return most - least > 1e-4F ? 0 : 1 - double{srgb_from_linear(most)};
}

struct Box {
  double x0, y0, x1, y1;
};

/// How unlike what is written in a box is to a text of that size there, wherever it stands: 0 is
/// the same, 1 nothing in common.
double difference(const Shown& picture, const Box& box, const std::string& what, double size) {
  const int x0 = std::max(0, static_cast<int>(box.x0)), y0 = std::max(0, static_cast<int>(box.y0));
  const int x1 = std::min(picture.width, static_cast<int>(box.x1)),
            y1 = std::min(picture.height, static_cast<int>(box.y1));
  // The middle of the ink, with which that of the text is put in the same place.
  const auto middle = [&](auto ink, double& sum) {
    glm::dvec2 out(0);
    sum = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        sum += ink(x, y);
        out += ink(x, y) * glm::dvec2(x, y);
      }
    return out / std::max(sum, 1e-9);
  };
  double there = 0, drawn = 0;
  const glm::dvec2 seen = middle([&](int x, int y) { return ink_at(picture, x, y); }, there);
  glm::dvec2 at(0.5 * (box.x0 + box.x1 - text_width(what, size)), 0.5 * (box.y0 + box.y1 + size));
  double best = 1;
  for (int round = 0; round < 3; ++round) {  // drawn anew where the last was off
    Mask mask(picture.width, picture.height);
    text(mask, at, what, size);
    at += seen - middle([&](int x, int y) { return double{mask.at(x, y)}; }, drawn);
    double apart = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        apart += std::abs(ink_at(picture, x, y) - double{mask.at(x, y)});
    best = std::min(best, apart / (there + drawn));
  }
  return best;
}

/// Returns the one of these texts that a box says; empty where none of them is near.
std::string read(const Shown& picture, const Box& box, const std::vector<std::string>& texts,
                 double size) {
  std::string out;
  double least = 0.05;
  for (const std::string& one : texts)
    if (const double apart = difference(picture, box, one, size); apart < least)
      least = apart, out = one;
  return out;
}

// --- Scale bars ---

/// A ball of radius 5 at the origin, 100 units of a width of 400 pixels: 4 pixels a unit.
Scene ball(int width = 400, int height = 200) {
  Scene scene;
  Shape shape;
  shape.geometry = SphereShape{5};
  scene.shapes.push_back(shape);
  scene.view.film.width = width;
  scene.view.film.height = height;
  scene.unit = "nm";
  scene.view.camera.projection = OrthographicProjection{};
  scene.view.camera.world_from_camera[3] = glm::dvec4(0, 0, -80, 1);
  scene.view.camera.screen_window = {-50, 50, -25, 25};
  return scene;
}

// A crop's pixels are those of the whole, of which it has fewer in one direction or both.
TEST(ScaleBar, OfACropIsThatOfTheWhole) {
  Scene scene = ball();
  const BarOnPicture whole = bar_of({25, ""}, scene, "--scale-bar");
  EXPECT_DOUBLE_EQ(whole.pixels, 100);
  for (const std::array<int, 4>& crop :
       {std::array{0, 400, 10, 20}, {7, 107, 0, 200}, {300, 400, 199, 200}}) {
    scene.view.film.crop = crop;
    const BarOnPicture bar = bar_of({25, ""}, scene, "--scale-bar");
    EXPECT_DOUBLE_EQ(bar.pixels, 100);
    EXPECT_EQ(bar.label, whole.label);
  }
  scene.view.film.crop = {{7, 106, 0, 200}};
  EXPECT_THAT(complaint([&] {
                bar_of({25, ""}, scene, "--scale-bar");
              }),
              HasSubstr("100 pixels, more than the picture's 99"));
}

// On a picture that is hardly wider it is as long, without a margin.
TEST(ScaleBar, IsDrawnWhole) {
  for (const double pixels : {80.0, 390.0, 399.5, 400.0}) {
    Shown picture = white(400, 200);
    draw_scale_bar(picture, {pixels, "20", {}}, {0, 0, 0});
    const int y = 200 - static_cast<int>(margin(picture)) - 1;
    double length = 0;
    for (int x = 0; x < 400; ++x) length += ink_at(picture, x, y);
    EXPECT_NEAR(length, pixels, 0.05);
  }
}

TEST(ScaleBar, SaysItsLength) {
  Shown picture = white(400, 200);
  draw_scale_bar(picture, {80, "20 \u00b5m", {}}, {0, 0, 0});
  const double size = text_size(picture), bottom = 200 - margin(picture) - 0.3 * size;
  const Box label{200, bottom - 2.5 * size, 400, bottom};
  EXPECT_EQ(
      read(picture, label, {"20 nm", "20 \u00b5m", "20 mm", "2 \u00b5m", "20", "50 \u00b5m"}, size),
      "20 \u00b5m");
}

// --- Colour bars ---

struct BarBox {
  int x0 = 1 << 20, y0 = 1 << 20, x1 = 0, y1 = 0;
};
BarBox bar_box(const Shown& picture) {  // of blue 0.25
  BarBox box;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      if (color_at(picture, x, y)[2] == 0.25F)
        box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1),
               std::max(box.y1, y + 1)};
  return box;
}

// A square of each colour stands before its name, from the top in the legend's order.
TEST(ColorBar, OfNamesListsThem) {
  const std::vector<std::string> names = {"axon", "soma", "basal dendrite", "and 9 more",
                                          "and 8 more"};
  Legend legend{"Type", "", 0, 1, {{0.5, 0, 0.25}, {0, 0.5, 0.25}}};
  legend.names = {"soma", "basal dendrite"};
  Shown picture = white(600, 500);
  draw_names(picture, legend, {0, 0, 0});
  const double size = text_size(picture);
  std::array<Box, 2> squares{Box{600, 500, 0, 0}, Box{600, 500, 0, 0}};
  for (int y = 0; y < 500; ++y)
    for (int x = 0; x < 600; ++x) {
      const auto color = color_at(picture, x, y);
      if (std::abs(color[2] - 0.25F) > 1e-4F) continue;
      Box& box = squares.at(color[0] > 0.4F ? 0 : 1);
      box = {std::min<double>(box.x0, x), std::min<double>(box.y0, y),
             std::max<double>(box.x1, x + 1), std::max<double>(box.y1, y + 1)};
    }
  for (std::size_t i = 0; i < 2; ++i) {
    const Box& square = squares.at(i);
    ASSERT_LT(square.x0, square.x1) << i;
    EXPECT_NEAR(square.x1 - square.x0, 0.9 * size, 1.5);
    EXPECT_NEAR(square.y1 - square.y0, 0.9 * size, 1.5);
    EXPECT_EQ(read(picture, {square.x1 + 1, square.y0 - 0.3 * size, 600, square.y1 + 0.4 * size},
                   names, size),
              legend.names[i]);
  }
  EXPECT_LT(squares[0].y1, squares[1].y0);
  EXPECT_EQ(read(picture, {300, 0, 600, squares[0].y0 - 0.3 * size}, {"Type", "File"}, size),
            "Type");
  // What does not find room above the scale bar is counted: of 20 rows the last tells of the rest.
  legend.colors.assign(30, glm::dvec3(0.5, 0, 0.25));
  legend.names.assign(30, "soma");
  picture = white(600, 500);
  draw_names(picture, legend, {0, 0, 0});
  const double edge = margin(picture), step = std::round(1.6 * size);
  const int rows = static_cast<int>((500 - edge - 2 * size - edge - 3 * size) / step);
  ASSERT_EQ(rows, 21);
  const double last = edge + 2 * size + (rows - 1) * step;
  EXPECT_EQ(read(picture, {300, last - 0.3 * size, 600, last + 1.3 * size},
                 {"and 9 more", "and 10 more", "and 8 more", "soma"}, size),
            "and 10 more");
}

TEST(ColorBar, SaysItsEndsAndUnit) {
  const std::vector<std::string> numbers = {"-1.25", "1.25", "4e+04", "40000", "-4e+04", "0"};
  const std::vector<std::string> titles = {"B factor", "B factor (\u00c5\u00b2)", "B factor (nm)",
                                           "(\u00c5\u00b2)", "\u00c5\u00b2"};
  for (const char* unit : {"", "\u00c5\u00b2"}) {
    Shown picture = white(600, 500);
    draw_color_bar(picture, {"B factor", unit, -1.25, 40000, {{0, 0, 0.25}, {0.5, 0, 0.25}}},
                   {0, 0, 0});
    const double size = text_size(picture);
    const BarBox bar = bar_box(picture);
    ASSERT_LT(bar.x0, bar.x1);
    const double right = bar.x1 + 1, middle = 0.5 * (bar.y0 + bar.y1);
    // Beside the upper end the greatest, beside the lower the least: four digits of them.
    EXPECT_EQ(read(picture, {right, 0.0 + bar.y0 - 0.9 * size, 600, middle}, numbers, size),
              "4e+04");
    EXPECT_EQ(read(picture, {right, middle, 600, 0.0 + bar.y1 + 1.5 * size}, numbers, size),
              "-1.25");
    EXPECT_EQ(read(picture, {300, 0, 600, 0.0 + bar.y0 - 0.9 * size}, titles, size),
              *unit ? "B factor (\u00c5\u00b2)" : "B factor");
    // The ends' middles are at the height of the ends, and all of it is within the picture.
    double sums[2] = {0, 0}, heights[2] = {0, 0};
    for (int y = bar.y0 - static_cast<int>(0.9 * size); y < bar.y1 + 2 * size; ++y)
      for (int x = bar.x1 + 1; x < 600; ++x) {
        const int end = y < middle ? 0 : 1;
        sums[end] += ink_at(picture, x, y);
        heights[end] += y * ink_at(picture, x, y);
      }
    EXPECT_NEAR(heights[0] / sums[0], bar.y0, 0.3 * size);
    EXPECT_NEAR(heights[1] / sums[1], bar.y1, 0.3 * size);
    for (int y = 0; y < 500; ++y) EXPECT_LT(ink_at(picture, 599, y), 1e-6) << y;
  }
}

// --- Axes ---

struct AxesPicture {
  Shown picture = white(500, 500);
  glm::dvec2 origin{0};
  double size = 0;
};

/// Seen from +z, x to the right and y up, where the file's axes are these.
AxesPicture axes_of(const glm::dmat3& world_from_file) {
  AxesPicture out;
  Scene scene = ball();
  scene.view.camera.world_from_camera =
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, -1, 0),
                 glm::dvec4(0, 0, 80, 1));
  scene.world_from_file = world_from_file;
  draw_axes(out.picture, scene, {0, 0, 0});
  out.size = text_size(out.picture);
  const double edge =
      margin(out.picture) + 4.2 * out.size;  // three for the arrow, 1.2 for its letter
  out.origin = {edge, 500 - edge};
  return out;
}

constexpr std::array<std::array<float, 3>, 3> srgb = {
    {{0.86F, 0.16F, 0.16F}, {0.13F, 0.60F, 0.20F}, {0.16F, 0.38F, 0.90F}}};

/// Returns the one of the three axes whose colour a pixel has; none.
std::optional<int> axis_at(const Shown& picture, const glm::dvec2& at) {
  const auto color = color_at(picture, static_cast<int>(at.x), static_cast<int>(at.y));
  for (int axis = 0; axis < 3; ++axis) {
    bool is_it = true;
    for (std::size_t c = 0; c < 3; ++c)
      is_it &=
          std::abs(srgb_from_linear(color[c]) - srgb.at(static_cast<std::size_t>(axis))[c]) < 0.02F;
    if (is_it) return axis;
  }
  return std::nullopt;
}

TEST(Axes, HaveTheirColoursAndLetters) {
  // In turn each of the file's axes is to the right, up, and to the viewer's lower left.
  const glm::dvec3 right(1, 0, 0), up(0, 1, 0),
      toward = glm::normalize(glm::dvec3(-0.6, -0.5, 0.3));
  for (int first = 0; first < 3; ++first) {
    glm::dmat3 file;
    file[first] = right;
    file[(first + 1) % 3] = up;
    file[(first + 2) % 3] = toward;
    const AxesPicture on = axes_of(file);
    for (int axis = 0; axis < 3; ++axis) {
      const glm::dvec2 way(file[axis].x, -file[axis].y);
      EXPECT_EQ(axis_at(on.picture, on.origin + 1.5 * on.size * way), axis) << first;
      EXPECT_EQ(axis_at(on.picture, on.origin + 2.9 * on.size * way), axis) << first;
      EXPECT_EQ(axis_at(on.picture, on.origin - 1.0 * on.size * way), std::nullopt) << first;
      // The letter stands beyond the tip.
      const glm::dvec2 letter =
          on.origin + 3.0 * on.size * way + 0.85 * on.size * glm::normalize(way);
      const double half = 0.7 * on.size;
      EXPECT_EQ(
          read(on.picture, {letter.x - half, letter.y - half, letter.x + half, letter.y + half},
               {"x", "y", "z"}, 0.85 * on.size),
          std::string(1, static_cast<char>('x' + axis)))
          << first;
    }
  }
}

// Two arrows one behind the other: what points toward who looks is before what points away.
TEST(Axes, WhatIsNearerIsDrawnOver) {
  const glm::dvec3 near = glm::normalize(glm::dvec3(0.8, 0, 0.6)),
                   far = glm::normalize(glm::dvec3(0.8, 0, -0.6)), up(0, 1, 0);
  for (int nearer = 0; nearer < 3; ++nearer)
    for (const int other : {(nearer + 1) % 3, (nearer + 2) % 3}) {
      glm::dmat3 file;
      file[nearer] = near;
      file[other] = far;
      file[3 - nearer - other] = up;
      const AxesPicture on = axes_of(file);
      EXPECT_EQ(axis_at(on.picture, on.origin + glm::dvec2(1.5 * on.size, 0)), nearer)
          << nearer << other;
    }
}

}  // namespace
}  // namespace caplet::post
