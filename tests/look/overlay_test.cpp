// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is drawn on pictures: lengths, places and colours by hand, outlines against the circle that
// they run around.
#include "post/overlay.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <map>
#include <random>
#include <set>
#include <span>

#include "import/import.h"
#include "post/detail/canvas.h"
#include "post/detail/joined.h"
#include "post/detail/parts.h"
#include "post/overlay_options.h"
#include "support/import_files.h"

namespace caplet::post::overlay_test {
namespace {

using test::complaint;
using testing::AllOf;
using testing::HasSubstr;

/// A ball of radius 5 at the origin, 100 units of a width of 400 pixels: 4 pixels a unit.
Scene ball(double fov = 0) {
  Scene scene;
  Shape shape;
  shape.geometry = SphereShape{5};
  scene.shapes.push_back(shape);
  scene.view.film.width = 400;
  scene.view.film.height = 200;
  scene.unit = "\u00b5m";
  if (fov > 0)
    scene.view.camera.projection = PerspectiveProjection{fov};
  else
    scene.view.camera.projection = OrthographicProjection{};
  scene.view.camera.world_from_camera = glm::dmat4(1);
  scene.view.camera.world_from_camera[3] = glm::dvec4(0, 0, -80, 1);
  if (fov == 0) scene.view.camera.screen_window = {-50, 50, -25, 25};
  return scene;
}

/// A picture of one colour, of which shapes cover `share(x, y)`, at `depth(x, y)`.
struct Canvas {
  Shown picture;
  LayeredImage layers;
};
template <class Share, class Depth>
Canvas canvas(int width, int height, std::array<float, 3> color, Share share, Depth depth) {
  Canvas out;
  out.picture.width = out.layers.width = out.layers.data_width = width;
  out.picture.height = out.layers.height = out.layers.data_height = height;
  Channel a{"A", {}, {}}, z{"Z", {}, {}}, ids{"object.id", {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      out.picture.rgb.push_back(color);
      a.floats.push_back(share(x, y));
      z.floats.push_back(depth(x, y));
      ids.uints.push_back(share(x, y) > 0 ? 0 : 0xffffffffu);
    }
  out.layers.channels = {a, z, ids};
  return out;
}
Canvas empty_canvas(int width, int height) {
  return canvas(
      width, height, {1, 1, 1}, [](int, int) { return 0.0f; }, [](int, int) { return 1e10f; });
}
float& red(Shown& picture, int x, int y) {
  return picture.rgb[static_cast<std::size_t>(y * picture.width + x)][0];
}

TEST(ScaleBar, IsAsLongAsItSays) {
  const BarOnPicture bar = bar_of({20, ""}, ball(), "--scale-bar");
  EXPECT_DOUBLE_EQ(bar.pixels, 80);
  EXPECT_EQ(bar.label, "20 \u00b5m");
  EXPECT_FALSE(bar.distance);
  // Other units of length are turned into the scene's.
  EXPECT_DOUBLE_EQ(bar_of(parse_scale_bar("0.05 mm", ""), ball(), "").pixels, 200);
  EXPECT_EQ(bar_of(parse_scale_bar("0.05mm", ""), ball(), "").label, "0.05 mm");
  EXPECT_EQ(bar_of(parse_scale_bar("7 um", ""), ball(), "").label, "7 \u00b5m");
  // What is asked for in no unit is in the scene's; a scene of none takes any.
  Scene unknown = ball();
  unknown.unit.clear();
  EXPECT_EQ(bar_of(parse_scale_bar("3", ""), unknown, "").label, "3");
  EXPECT_EQ(bar_of(parse_scale_bar("3 cells", ""), unknown, "").label, "3 cells");
  EXPECT_DOUBLE_EQ(bar_of(parse_scale_bar("3 cells", ""), unknown, "").pixels, 12);
}

// Ten micrometres, 40 pixels, as each unit says them.
TEST(ScaleBar, UnitsAreWhatTheirNamesSay) {
  for (const char* text :
       {"1e7 pm", "1e5 A", "1e5 \u00c5", "1e5 angstrom", "1e4 nm", "10 um", "10 \u00b5m",
        "10 \u03bcm", "10 micron", "0.01 mm", "0.001 cm", "1e-5 m", "1e-8 km"})
    EXPECT_NEAR(bar_of(parse_scale_bar(text, ""), ball(), "").pixels, 40, 1e-9) << text;
  EXPECT_DOUBLE_EQ(bar_of({100, ""}, ball(), "").pixels,
                   400);  // as wide as the picture, and no wider
}

TEST(ScaleBar, IsRoundWhereNoOneAsks) {
  // A quarter of the width is 25: 20 is the longest of 1, 2, 5.
  EXPECT_EQ(bar_of({}, ball(), "").label, "20 \u00b5m");
  Scene wide = ball();
  wide.view.camera.screen_window = {-102, 102, -51, 51};
  EXPECT_EQ(bar_of({}, wide, "").label, "50 \u00b5m");
  wide.view.camera.screen_window = {-0.02, 0.02, -0.01, 0.01};
  EXPECT_EQ(bar_of({}, wide, "").label, "0.01 \u00b5m");
}

TEST(ScaleBar, InPerspectiveItIsThatOfTheMiddle) {
  // 90 degrees over 200 rows: 160 high at 80, 0.8 a pixel.
  const BarOnPicture bar = bar_of({20, ""}, ball(std::acos(-1.0) / 2), "");
  EXPECT_NEAR(bar.pixels, 25, 1e-9);
  EXPECT_NEAR(bar.distance.value(), 80, 1e-9);
}

TEST(ScaleBar, WrongOnesAreRefused) {
  for (const char* text : {"long", "-3 um", "0", "nan", "um"})
    EXPECT_THAT(complaint([&] { parse_scale_bar(text, "--scale-bar"); }), HasSubstr("--scale-bar"))
        << text;
  EXPECT_THAT(complaint([&] { bar_of(parse_scale_bar("3 cells", ""), ball(), "--scale-bar"); }),
              AllOf(HasSubstr("--scale-bar"), HasSubstr("'cells'")));
  EXPECT_THAT(complaint([&] { bar_of(parse_scale_bar("1 mm", ""), ball(), "--scale-bar"); }),
              HasSubstr("4000 pixels"));
  Scene behind = ball(1);
  behind.view.camera.world_from_camera[3] = glm::dvec4(0, 0, 80, 1);
  EXPECT_THAT(complaint([&] { bar_of({}, behind, "--scale-bar"); }),
              AllOf(HasSubstr("--scale-bar"), HasSubstr("lies behind the camera")));
  Scene around = ball();
  around.view.camera.projection = SphericalProjection{};
  EXPECT_THAT(complaint([&] { bar_of({}, around, "--scale-bar"); }),
              HasSubstr("the picture of a spherical camera has no scale"));
  around.view.camera.projection = FisheyeProjection{};
  EXPECT_THAT(complaint([&] { bar_of({}, around, "--scale-bar"); }),
              HasSubstr("the picture of a fisheye camera has no scale"));
  Overlays overlays;
  overlays.color_bar = true;
  EXPECT_THAT(complaint([&] { check(overlays, ball(), "--"); }), HasSubstr("--color-bar"));
}

TEST(OverlayOptions, EachRowIsAskedForByItsName) {
  for (const OverlayRow& row : overlay_rows()) {
    Overlays overlays;
    set_overlay(overlays, row.name, row.is_list ? "0,0,0 here" : "", "--" + row.name);
    EXPECT_TRUE(overlays.any()) << row.name;
    EXPECT_FALSE(row.help.empty());
    EXPECT_THAT(complaint([&] { set_overlay(overlays, row.name, "much", "--" + row.name); }),
                HasSubstr("--" + row.name));
  }
  EXPECT_THAT(complaint([] {
                Overlays overlays;
                set_overlay(overlays, "outlines", "", "");
              }),
              HasSubstr("'outline'"));
}

TEST(OverlayOptions, ValuesAreWithinTheirRange) {
  const auto outline = [](const std::string& text) {
    Overlays overlays;
    set_overlay(overlays, "outline", text, "--outline");
    return overlays.outline.value();
  };
  EXPECT_EQ(outline(""), 1.5);
  EXPECT_EQ(outline("0.1"), 0.1);
  EXPECT_EQ(outline("64"), 64);
  for (const char* wrong : {"0.09", "64.1", "nan", "inf", "2 ", "-1"})
    EXPECT_THAT(complaint([&] { outline(wrong); }),
                AllOf(HasSubstr("--outline"), HasSubstr("from 0.1 to 64")))
        << wrong;
  Overlays overlays;
  set_overlay(overlays, "depth-cue", "", "");
  EXPECT_EQ(overlays.depth_cue, 0.6);
  set_overlay(overlays, "scale-bar", "auto", "");
  EXPECT_EQ(overlays.scale_bar->length, 0);
  set_overlay(overlays, "scale-bar", "3 mm", "");
  EXPECT_EQ(overlays.scale_bar->length, 3);
}

TEST(ScaleBar, IsDrawnAsLong) {
  Canvas on = empty_canvas(400, 200);
  draw_scale_bar(on.picture, {80.25, "20", {}}, {0, 0, 0});
  // Along the row of the bar: what is black, in pixels. Painted in sRGB: 1 - value there.
  const int y = on.picture.height - static_cast<int>(margin(on.picture)) - 1;
  double length = 0;
  for (int x = 0; x < 400; ++x) length += 1 - std::pow(double{red(on.picture, x, y)}, 1 / 2.2);
  EXPECT_NEAR(length, 80.25, 0.05);
  // There is a text above, and nothing else in the picture's upper half.
  double above = 0, far = 0;
  for (int row = 0; row < y - 4; ++row)
    for (int x = 0; x < 400; ++x) (row < 100 ? far : above) += double{1 - red(on.picture, x, row)};
  EXPECT_GT(above, 5);
  EXPECT_EQ(far, 0);
  // The text stands over the bar's middle, but for the room about its letters.
  int first = 400, last = 0;
  for (int row = 100; row < y - 4; ++row)
    for (int x = 0; x < 400; ++x)
      if (red(on.picture, x, row) < 0.9F) first = std::min(first, x), last = std::max(last, x);
  EXPECT_NEAR(0.5 * (first + last + 1), 400 - margin(on.picture) - 0.5 * 80.25, 2);
}

TEST(Outline, RunsAroundADisk) {
  const double radius = 31.7;
  const glm::dvec2 middle(50.3, 49.6);
  const auto share = [&](int x, int y) {
    int inside = 0;
    for (int i = 0; i < 256; ++i)
      inside += glm::length(glm::dvec2(x + (i % 16 + 0.5) / 16, y + (i / 16 + 0.5) / 16) - middle) <
                        radius
                    ? 1
                    : 0;
    return static_cast<float>(inside) / 256;
  };
  for (const double width : {1.5, 4.0}) {
    Canvas on = canvas(100, 100, {1, 1, 1}, share, [](int, int) { return 7.0f; });
    draw_outline(on.picture, on.layers, width);
    double area = 0;
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x) {
        const double off = std::abs(glm::length(glm::dvec2(x + 0.5, y + 0.5) - middle) - radius);
        const float value = red(on.picture, x, y);
        if (off > 0.5 * width + 0.7) {
          EXPECT_EQ(value, 1) << x << " " << y;
        }
        if (off < 0.5 * width - 0.7) {
          EXPECT_LT(value, 0.01) << x << " " << y;
        }
        area += 1 - std::pow(double{value}, 1 / 2.2);
      }
    EXPECT_NEAR(area, 2 * std::acos(-1.0) * radius * width,
                0.06 * 2 * std::acos(-1.0) * radius * width);
  }
}

TEST(Outline, StepsOfDepthHaveOneAndSlopesNone) {
  const auto all = [](int, int) { return 1.0f; };
  Canvas step = canvas(40, 20, {1, 1, 1}, all, [](int x, int) { return x < 20 ? 10.0f : 12.0f; });
  draw_outline(step.picture, step.layers, 2);
  EXPECT_LT(red(step.picture, 19, 10), 0.01);
  EXPECT_LT(red(step.picture, 20, 10), 0.01);
  EXPECT_EQ(red(step.picture, 16, 10), 1);
  EXPECT_EQ(red(step.picture, 23, 10), 1);
  Canvas slope =
      canvas(20, 20, {1, 1, 1}, all, [](int x, int) { return 10.0f + static_cast<float>(x); });
  draw_outline(slope.picture, slope.layers, 2);
  for (int x = 0; x < 20; ++x) EXPECT_EQ(red(slope.picture, x, 10), 1) << x;
  // Objects that touch.
  for (int i = 0; i < 400; ++i)
    if (i % 20 >= 10) slope.layers.channels[2].uints[static_cast<std::size_t>(i)] = 1;
  draw_outline(slope.picture, slope.layers, 2);
  EXPECT_LT(red(slope.picture, 9, 10), 0.01);
  EXPECT_EQ(red(slope.picture, 6, 10), 1);
}

TEST(Outline, DoNotPartWhatGoesOn) {
  for (const bool is_joined : {true, false}) {
    Canvas on = canvas(
        20, 20, {1, 1, 1}, [](int, int) { return 1.0f; }, [](int, int) { return 10.0f; });
    for (int i = 0; i < 400; ++i)
      if (i % 20 >= 10) on.layers.channels[2].uints[static_cast<std::size_t>(i)] = 1;
    const std::vector<std::uint32_t> joined = {0, 0};
    draw_outline(on.picture, on.layers, 2, std::span(joined).first(is_joined ? 2 : 1));
    if (is_joined) {
      EXPECT_EQ(red(on.picture, 9, 10), 1);
    } else {
      EXPECT_LT(red(on.picture, 9, 10), 0.01);
    }
  }
}

TEST(Outline, GroupsAreWhatGoesOn) {
  const auto mesh = [](float x, const glm::vec3& normal) {
    Shape out;
    out.geometry = TriangleMeshShape{
        {{x, 0, 0}, {x, 1, 0}, {x + 1, 0, 0}}, {{0, 1, 2}}, {normal, normal, normal}, {}};
    return out;
  };
  const auto tube = [](float x, float radius, float length = 1) {
    Shape out;
    out.geometry =
        CapsulesShape{{{x, 5, 0}, {x, 0, 0}}, {{x, 9, 0}, {x + length, 0, 0}}, {1, radius}, {}, {}};
    return out;
  };
  const glm::vec3 z(0, 0, 1), y(0, 1, 0);
  using testing::ElementsAre;
  // A third goes on in the second; a crease, a gap and another transform part.
  EXPECT_THAT(joined_objects({mesh(0, z), mesh(1, z), mesh(2, z), mesh(3, y), mesh(5, y)}),
              ElementsAre(0, 0, 0, 3, 4));
  Shape moved = mesh(1, z);
  moved.world_from_object[3][0] = 1;
  EXPECT_THAT(joined_objects({mesh(0, z), moved}), ElementsAre(0, 1));
  EXPECT_THAT(joined_objects({tube(0, 1), tube(1, 1), tube(2, 2), tube(4, 2)}),
              ElementsAre(0, 0, 2, 3));
  EXPECT_THAT(joined_objects({tube(0, 1), tube(1, 1, 0)}), ElementsAre(0, 1));  // a ball
  EXPECT_THAT(joined_objects({mesh(0, z), tube(1, 1)}), ElementsAre(0, 1));
  EXPECT_THAT(joined_objects({}), testing::IsEmpty());
}

// Residues of a cartoon are shapes of their own, without lines between them.
TEST(Outline, DoesNotPartResidues) {
  for (const std::string atom : {"CA  GLY", "P    DA"}) {
    std::string text;
    for (int i = 0; i < 4; ++i)
      text += fmt::format("ATOM  {:5}  {} A{:4}    {:8.3f}{:8.3f}{:8.3f}  1.00  1.00\n", i + 1,
                          atom, i + 1, 3.8 * i, i % 2 == 0 ? 0.0 : 1.0, 0.0);
    const Scene scene =
        import_scene(test::write_file("c.pdb", text), test::NoImages(), {{{"style", "cartoon"}}});
    EXPECT_THAT(joined_objects(scene.shapes), testing::ElementsAre(0, 0, 0, 0)) << atom;
  }
}

// A step is what three pixels differ by: more than 3 of a depth of 100 and twice what the pixels
// beside it differ by.
TEST(Outline, StepsAreSteeperThanWhatIsBesideThem) {
  struct Row {
    std::array<float, 6> depths;  // before them the first goes on, and behind them the last
    bool has_line;                // between the third and the fourth
  };
  for (const Row& row :
       {Row{{10, 10, 10, 13.5, 13.5, 13.5}, true}, Row{{10, 10, 10, 12.5, 12.5, 12.5}, false},
        Row{{10, 10, 11, 13, 13.5, 13.5}, true}, Row{{10, 10, 10, 13.5, 13.5, 16}, false},
        Row{{10, 10, 10, 13.5, 13.5, 14.5}, true}, Row{{7.5, 10, 10, 13.5, 13.5, 13.5}, false},
        Row{{9, 10, 10, 13.5, 13.5, 13.5}, true}, Row{{9, 10, 10, 13.5, 13.5, 14.5}, false}})
    for (const bool is_turned : {false, true})
      for (const bool is_upright : {false, true}) {
        const auto along = [&](int x, int y) { return is_upright ? y : x; };
        // Two pixels by themselves have the nearest and the farthest depth.
        const auto apart = [&](int x, int y) { return is_upright ? x : y; };
        const auto share = [&](int x, int y) {
          return along(x, y) < 30 || (along(x, y) == 35 && (apart(x, y) == 5 || apart(x, y) == 15))
                     ? 1.0f
                     : 0.0f;
        };
        const auto depth = [&](int x, int y) {
          if (along(x, y) >= 30) return apart(x, y) == 5 ? 7.0f : 107.0f;
          const int place = std::clamp(along(x, y) - 12, 0, 5);
          return row.depths.at(static_cast<std::size_t>(is_turned ? 5 - place : place));
        };
        Canvas on = canvas(40, 40, {1, 1, 1}, share, depth);
        draw_outline(on.picture, on.layers, 2);
        for (int i = 2; i < 28; ++i) {
          const float value = is_upright ? red(on.picture, 20, i) : red(on.picture, i, 20);
          // Two pixels wide about the line between pixels 14 and 15.
          const bool is_black = row.has_line && (i == 14 || i == 15);
          EXPECT_EQ(value < 0.5F, is_black)
              << testing::PrintToString(row.depths) << is_turned << is_upright << " " << i;
        }
      }
}

// One pixel that shows what is behind tells its colour.
TEST(DepthCue, FadesToWhatIsBehind) {
  Canvas on = canvas(
      3, 1, {0.2f, 0.2f, 0.2f}, [](int x, int) { return x < 2 ? 1.0f : 0.0f; },
      [](int x, int) { return 5.0f + static_cast<float>(x); });
  on.picture.rgb[2] = {1, 0.5f, 0};
  draw_depth_cue(on.picture, on.layers, 1);
  EXPECT_FLOAT_EQ(on.picture.rgb[0][0], 0.2f);
  EXPECT_EQ(on.picture.rgb[1], (std::array<float, 3>{1, 0.5f, 0}));
  EXPECT_EQ(on.picture.rgb[2], (std::array<float, 3>{1, 0.5f, 0}));
}

TEST(DepthCue, TheFarthestFadesByItsShare) {
  // Shapes of 0.2 on white: the nearest stay, the farthest go 0.5 of the way to white, in light.
  Canvas on = canvas(
      11, 2, {0.2f, 0.2f, 0.2f}, [](int, int y) { return y == 0 ? 1.0f : 0.0f; },
      [](int x, int y) { return y == 0 ? 30.0f + static_cast<float>(x) : 1e10f; });
  for (int x = 0; x < 11; ++x) on.picture.rgb[static_cast<std::size_t>(11 + x)] = {1, 1, 1};
  draw_depth_cue(on.picture, on.layers, 0.5);
  EXPECT_FLOAT_EQ(red(on.picture, 0, 0), 0.2f);
  EXPECT_NEAR(red(on.picture, 5, 0), 0.2 + 0.25 * 0.8, 1e-6);
  EXPECT_NEAR(red(on.picture, 10, 0), 0.2 + 0.5 * 0.8, 1e-6);
  EXPECT_EQ(red(on.picture, 10, 1), 1);
}

// There is nothing behind: what is far lets more of the paper through, and keeps its colour.
TEST(DepthCue, OfTransparentPicturesIsTheirAlpha) {
  Canvas on = canvas(
      5, 1, {0.2f, 0.2f, 0.2f}, [](int x, int) { return x < 4 ? 1.0f : 0.0f; },
      [](int x, int) { return x < 4 ? 10.0f + static_cast<float>(x) : 1e10f; });
  on.picture.alpha = {1, 1, 0.5f, 1, 0};
  draw_depth_cue(on.picture, on.layers, 0.6);
  const std::array<double, 5> left = {1, 1 - 0.2, 0.5 * (1 - 0.4), 1 - 0.6, 0};
  for (std::size_t x = 0; x < 5; ++x) {
    EXPECT_NEAR(on.picture.alpha[x], left[x], 1e-6) << x;
    EXPECT_EQ(on.picture.rgb[x][0], 0.2f) << x;
  }
}

// Where three objects meet, their lines end in one point; where four do, they cross in it.
TEST(Outline, LinesOfSeveralObjectsMeet) {
  const auto all = [](int, int) { return 1.0f; };
  const auto near = [](int, int) { return 10.0f; };
  for (const bool is_four : {false, true}) {
    Canvas on = canvas(20, 20, {1, 1, 1}, all, near);
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x)
        on.layers.channels[2].uints[static_cast<std::size_t>(20 * y + x)] =
            y < 10 ? (x < 10 ? 1 : 2) : (is_four && x >= 10 ? 4 : 3);
    draw_outline(on.picture, on.layers, 2);
    EXPECT_LT(red(on.picture, 9, 9), 0.05) << is_four;
    EXPECT_LT(red(on.picture, 10, 10), 0.05) << is_four;
    EXPECT_LT(red(on.picture, 9, 4), 0.01) << is_four;    // between 1 and 2
    EXPECT_LT(red(on.picture, 3, 10), 0.01) << is_four;   // between 1 and 3
    EXPECT_LT(red(on.picture, 16, 10), 0.01) << is_four;  // between 2 and 3, or 4
    EXPECT_EQ(red(on.picture, 9, 15) < 0.5f, is_four);    // between 3 and 4
    EXPECT_EQ(red(on.picture, 3, 3), 1) << is_four;
  }
}

// A leaning edge between two objects, with the number of one random sample in each pixel: the line
// stays where the edge is.
TEST(Outline, RunsWhereDepthsTellThatItDoes) {
  const auto edge = [](double y) { return 20 + 0.3 * y; };
  // What the nearer object fills of a pixel; close, for the edge leans little.
  const auto part = [&](int x, int y) { return std::clamp(edge(y + 0.5) - x, 0.0, 1.0); };
  Canvas on = canvas(
      60, 40, {1, 1, 1}, [](int, int) { return 1.0f; },
      [&](int x, int y) { return static_cast<float>(10 * part(x, y) + 20 * (1 - part(x, y))); });
  std::mt19937 random(3);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      on.layers.channels[2].uints[static_cast<std::size_t>(60 * y + x)] =
          static_cast<double>(random() >> 8) * 0x1p-24 < part(x, y) ? 1 : 2;
  draw_outline(on.picture, on.layers, 2);
  for (int y = 2; y < 38; ++y) {
    double dark = 0, place = 0;
    for (int x = 0; x < 60; ++x) {
      const double value = 1 - std::pow(double{red(on.picture, x, y)}, 1 / 2.2);
      dark += value;
      place += value * (x + 0.5);
    }
    EXPECT_NEAR(place / dark, edge(y + 0.5), 0.2) << y;  // with steps of whole pixels up to 0.5
    EXPECT_NEAR(dark, 2 * std::hypot(1, 0.3), 0.25) << y;
  }
}

// A column of pixels between two objects, of which the nearer one fills nine tenths.
TEST(Outline, ColumnsOnAnEdgeAreOfTheNearerDepth) {
  for (const std::uint32_t number : {1U, 2U, 3U, 0xffffffffU}) {
    SCOPED_TRACE(number);
    const bool is_third = number == 3;  // an object of its own, a pixel wide
    Canvas on = canvas(
        40, 20, {1, 1, 1}, [](int, int) { return 1.0f; },
        [](int x, int) { return x < 20   ? 10.0f
                                : x > 20 ? 20.0f
                                         : 11.0f; });
    for (int i = 0; i < 800; ++i)
      on.layers.channels[2].uints[static_cast<std::size_t>(i)] = i % 40 < 20   ? 1
                                                                 : i % 40 > 20 ? 2
                                                                               : number;
    draw_outline(on.picture, on.layers, 1);
    double dark = 0, place = 0;
    for (int x = 0; x < 40; ++x) {
      const double value = 1 - std::pow(double{red(on.picture, x, 10)}, 1 / 2.2);
      dark += value;
      place += value * (x + 0.5);
    }
    if (is_third) {
      EXPECT_GT(dark, 1.2) << "both of its sides have a line";
    } else {
      EXPECT_NEAR(place / dark, 20.9, 0.1);
      EXPECT_NEAR(dark, 1, 0.1);
    }
  }
}

// The sample that gives a covered pixel its number may have hit nothing, or what is behind it.
TEST(Outline, NumbersOfSinglePixelsAreTheirNeighbours) {
  Canvas on = canvas(
      40, 20, {1, 1, 1}, [](int, int) { return 1.0f; }, [](int, int) { return 10.0f; });
  auto& numbers = on.layers.channels[2].uints;
  numbers[5 * 40 + 10] = 0xffffffffu;
  numbers[12 * 40 + 20] = 3;
  draw_outline(on.picture, on.layers, 2);
  for (int i = 0; i < 800; ++i) EXPECT_EQ(red(on.picture, i % 40, i / 40), 1) << i;
  // What is a pixel wide is no single pixel.
  for (int x = 0; x < 40; ++x) numbers[static_cast<std::size_t>(10 * 40 + x)] = 5;
  draw_outline(on.picture, on.layers, 1);
  for (int x = 2; x < 38; ++x) EXPECT_LT(red(on.picture, x, 9), 0.5) << x;
}

TEST(Axes, PointWhereTheyPoint) {
  Canvas on = empty_canvas(400, 400);
  Scene scene = ball();
  scene.view.camera.world_from_camera =
      glm::dmat4(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0), glm::dvec4(0, 0, -1, 0),
                 glm::dvec4(0, 0, 80, 1));
  draw_axes(on.picture, scene, {0, 0, 0});
  const double size = text_size(on.picture), reach = 3 * size + 1.2 * size;
  const int x = static_cast<int>(margin(on.picture) + reach),
            y = static_cast<int>(400 - margin(on.picture) - reach);
  const auto color = [&](int px, int py) {
    return on.picture.rgb[static_cast<std::size_t>(py * 400 + px)];
  };
  const int part = static_cast<int>(1.5 * size);
  EXPECT_GT(color(x + part, y)[0], 0.5);
  EXPECT_LT(color(x + part, y)[1], 0.1);
  EXPECT_GT(color(x, y - part)[1], 0.2);
  EXPECT_LT(color(x, y - part)[0], 0.1);
  EXPECT_EQ(color(x - part, y)[0], 1);
  EXPECT_EQ(color(x, y + part)[0], 1);
  // z of a file that was turned from z to y is up: the blue one.
  Canvas turned = empty_canvas(400, 400);
  scene.world_from_file = {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0)};
  draw_axes(turned.picture, scene, {0, 0, 0});
  EXPECT_GT(turned.picture.rgb[static_cast<std::size_t>((y - part) * 400 + x)][2], 0.5);
  EXPECT_LT(turned.picture.rgb[static_cast<std::size_t>((y - part) * 400 + x)][0], 0.1);
}

TEST(ColorBar, HasTheMapsEndsAtItsEnds) {
  Canvas on = empty_canvas(400, 300);
  Legend legend{"B factor", "", 2, 40, {}};
  for (int i = 0; i < 64; ++i) legend.colors.push_back({i / 63.0, 0, 0.25});
  draw_color_bar(on.picture, legend, {0, 0, 0});
  // Pixels of the bar are those of blue 0.25; the upper have more red.
  int top = -1, bottom = -1;
  float red_of_top = 0, red_of_bottom = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 400; ++x)
      if (const auto& color = on.picture.rgb[static_cast<std::size_t>(y * 400 + x)];
          color[2] == 0.25f) {
        if (top < 0) top = y, red_of_top = color[0];
        bottom = y, red_of_bottom = color[0];
      }
  ASSERT_GE(top, 0);
  EXPECT_GT(bottom - top, 60);
  EXPECT_GT(red_of_top, 0.98);
  EXPECT_LT(red_of_bottom, 0.02);
  // With two colours each has half of the rows.
  Canvas two = empty_canvas(400, 300);
  draw_color_bar(two.picture, {"B", "", 0, 1, {{0, 0, 0.25}, {0.5, 0, 0.25}}}, {0, 0, 0});
  int difference = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 400; ++x)
      if (const auto& color = two.picture.rgb[static_cast<std::size_t>(y * 400 + x)];
          color[2] == 0.25f) {
        difference += color[0] == 0 ? 1 : -1;
        break;
      }
  EXPECT_LE(std::abs(difference), 1);
}

// Seen along -z with y up, the ball's right is x, red, its top is y, green, and its middle z, blue.
TEST(ColorBar, OfDirectionsIsABall) {
  Scene scene = ball();
  scene.legend = Legend{"Direction", "", 0, 1, {}};
  scene.legend->of_directions = true;
  const auto drawn = [&] {
    Canvas on = empty_canvas(400, 400);
    Overlays overlays;
    overlays.color_bar = true;
    draw(on.picture, on.layers, Sight(scene), overlays);
    return on.picture;
  };
  const auto at = [](const Shown& picture, double x, double y) {
    const double size = text_size(picture), radius = 3 * size, edge = margin(picture);
    const int column = static_cast<int>(400 - edge - radius + x * radius),
              row = static_cast<int>(edge + 2 * size + radius - y * radius);
    const auto& c = picture.rgb[static_cast<std::size_t>(row * 400 + column)];
    return glm::dvec3(c[0], c[1], c[2]);
  };
  const auto expected = [](double x, double y) {
    return 0.05 + 0.8 * glm::dvec3(std::abs(x), std::abs(y), std::sqrt(1 - x * x - y * y));
  };
  Shown picture = drawn();
  // A pixel is 1/29 of the radius, along which a colour changes by 1/20 here at most.
  for (const glm::dvec2 p : {glm::dvec2(0.5, 0), {-0.5, 0.1}, {0.1, 0.5}, {0.3, -0.6}, {0.2, 0.2}})
    EXPECT_LT(glm::length(at(picture, p.x, p.y) - expected(p.x, p.y)), 0.06) << p.x << " " << p.y;
  // A camera that is turned by 45 degrees around its view sees y along the diagonal.
  const double half = std::sqrt(0.5);
  scene.view.camera.world_from_camera[0] = {half, half, 0, 0};
  scene.view.camera.world_from_camera[1] = {-half, half, 0, 0};
  const Shown slanted = drawn();
  EXPECT_LT(glm::length(at(slanted, 0.35, 0.35) - expected(0, 0.35 / half)), 0.06);
  EXPECT_LT(glm::length(at(slanted, -0.35, 0.35) - expected(0.35 / half, 0)), 0.06);
  scene.view.camera.world_from_camera = ball().view.camera.world_from_camera;
  EXPECT_EQ(at(picture, 1.1, 0), glm::dvec3(1));
  EXPECT_EQ(at(picture, 0, 1.1), glm::dvec3(1));
  // A file's x, y and z are turned to y, z and x.
  scene.world_from_file = {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)};
  picture = drawn();
  const glm::dvec3 up = at(picture, 0.1, 0.5), turned = expected(0.1, 0.5);
  EXPECT_LT(glm::length(up - glm::dvec3(turned.y, turned.z, turned.x)), 0.06);
}

TEST(Ink, IsSeenOnWhatIsBehind) {
  Canvas light = empty_canvas(8, 8), dark = canvas(
                                         8, 8, {0.02f, 0.02f, 0.03f}, [](int, int) { return 0.0f; },
                                         [](int, int) { return 1.0f; });
  EXPECT_EQ(ink_for(light.picture, light.layers)[0], 0);
  EXPECT_EQ(ink_for(dark.picture, dark.layers)[0], 1);
  // A transparent picture is taken to lie on white paper, whatever its colours are.
  dark.picture.alpha.assign(64, 0);
  EXPECT_EQ(ink_for(dark.picture, dark.layers)[0], 0);
  dark.picture.alpha.clear();
  // What covers the picture does not count: a light body before darkness has white ink.
  Canvas body = canvas(
      8, 8, {0.02f, 0.02f, 0.03f}, [](int x, int) { return x < 6 ? 1.0f : 0.0f; },
      [](int, int) { return 1.0f; });
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 6; ++x)
      body.picture.rgb[static_cast<std::size_t>(8 * y + x)] = {0.9f, 0.9f, 0.9f};
  EXPECT_EQ(ink_for(body.picture, body.layers)[0], 1);
  // On one pixel just above the luminance between, 0.179, the ink is black.
  Canvas grey = canvas(
      1, 1, {0.2f, 0.2f, 0.2f}, [](int, int) { return 0.0f; }, [](int, int) { return 1.0f; });
  EXPECT_EQ(ink_for(grey.picture, grey.layers)[0], 0);
}

double ink_of(const Mask& mask) {
  double ink = 0;
  for (const float share : mask.shares()) ink += double{share};
  return ink;
}

TEST(Letters, EachIsThereAndNoTwoAreAlike) {
  std::map<std::vector<float>, char> seen;
  for (const char letter :
       std::string("0123456789.,:-+=/_()[]%ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz")) {
    Mask mask(60, 60);
    text(mask, {10, 40}, std::string(1, letter), 24);
    EXPECT_GT(ink_of(mask), 3) << letter;
    const auto [other, fresh] = seen.try_emplace(mask.shares(), letter);
    EXPECT_TRUE(fresh) << letter << " is drawn as " << other->second;
  }
  EXPECT_GT(text_width("\u00b5m", 12), text_width("m", 12));
  // Capitals are as high as they are asked for. DejaVu Sans's I is a stem of 202 by 1493 units, as
  // high as an H, from 201 on; its advance is 604.
  Mask mask(60, 60);
  text(mask, {10.25, 40.5}, "I", 24);
  const double unit = 24.0 / 1493;
  EXPECT_NEAR(ink_of(mask), 24 * 202 * unit, 0.3);
  double x = 0, y = 0;
  for (int row = 0; row < 60; ++row)
    for (int column = 0; column < 60; ++column) {
      x += (column + 0.5) * double{mask.at(column, row)} / ink_of(mask);
      y += (row + 0.5) * double{mask.at(column, row)} / ink_of(mask);
    }
  EXPECT_NEAR(x, 10.25 + (201 + 101) * unit, 0.02);
  EXPECT_NEAR(y, 40.5 - 12, 0.02);
  EXPECT_NEAR(text_width("I", 24), 604 * unit, 1e-9);
  EXPECT_NEAR(text_width("III", 24), 3 * 604 * unit, 1e-9);
  EXPECT_LT(text_width("AV", 24), text_width("A", 24) + text_width("V", 24)) << "kerning";
}

// Letters of other scripts, and what the font lacks, which is the same box for all.
TEST(Letters, AreOfAnyScript) {
  const auto drawn = [](const char* letter) {
    Mask mask(60, 60);
    text(mask, {10, 40}, letter, 24);
    return mask.shares();
  };
  std::set<std::vector<float>> seen = {drawn("\uE000")};
  for (const char* letter :
       {"\u03b1", "\u0416", "\u00e9", "\u20ac", "\u2192", "\u00c5", "\u00b2", "\u2206", "\u05d0"})
    EXPECT_TRUE(seen.insert(drawn(letter)).second) << letter;
  EXPECT_EQ(drawn("\uE000"), drawn("\U00020000"));
  // At a picture's edges letters are cut: it has what a wider one has there.
  Mask mask(20, 20), wide(60, 60);
  text(mask, {-8, 4}, "MMMM", 24);
  text(mask, {1e6, -1e6}, "M", 24);
  text(wide, {12, 24}, "MMMM", 24);
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) ASSERT_EQ(mask.at(x, y), wide.at(x + 20, y + 20)) << x << ' ' << y;
  EXPECT_GT(ink_of(mask), 10);
}

TEST(Labels, AreParsed) {
  const std::vector<Label> labels =
      parse_labels("1,-2.5,3e1 the soma; 0,0,0  a tip \n4,5,6 \u00b5", "--label");
  ASSERT_EQ(labels.size(), 3u);
  EXPECT_EQ(labels[0].at, glm::dvec3(1, -2.5, 30));
  EXPECT_EQ(labels[0].words, "the soma");
  EXPECT_EQ(labels[1].words, "a tip");
  EXPECT_EQ(labels[2].words, "\u00b5");
  for (const char* wrong : {"", ";", "1,2,3", "1,2,3 ", "1,2 tip", "1,2,3,4 tip", "a,b,c tip",
                            "1,2,nan tip", "1 2 3 tip", "1,2,3 tip; x"})
    EXPECT_THAT(complaint([&] { parse_labels(wrong, "--label"); }),
                AllOf(HasSubstr("--label"), HasSubstr("is not X,Y,Z WORDS")))
        << wrong;
}

// 4 pixels a unit, the origin in the middle of 400 x 200 pixels: the dot is at the point, the box
// to its upper right, or to the other sides where there is no room.
TEST(Labels, StandAtTheirPoints) {
  const Scene scene = ball();
  struct Row {
    glm::dvec3 at;
    int x, y, across, down;  // of the point; where its box is
  };
  for (const Row& row : {Row{{10, 5, 7}, 240, 80, 1, -1}, Row{{-45, -20, 0}, 20, 180, 1, -1},
                         Row{{48, 0, 0}, 392, 100, -1, -1}, Row{{0, 24, 0}, 200, 4, 1, 1}}) {
    SCOPED_TRACE(row.x);
    Canvas made = empty_canvas(400, 200);
    for (auto& pixel : made.picture.rgb) pixel = {0.5f, 0.5f, 0.5f};
    Overlays overlays;
    overlays.labels = {{row.at, "tip"}};
    EXPECT_TRUE(overlays.any());
    draw(made.picture, made.layers, Sight(scene), overlays);
    EXPECT_EQ(red(made.picture, row.x, row.y), 0) << "the dot";
    int white = 0, other = 0;
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 400; ++x) {
        if (red(made.picture, x, y) < 0.99f) continue;
        const bool is_there = (x - row.x) * row.across > 0 && (y - row.y) * row.down > 0 &&
                              std::abs(x - row.x) < 60 && std::abs(y - row.y) < 40;
        (is_there ? white : other)++;
      }
    EXPECT_GT(white, 100);
    EXPECT_EQ(other, 0);
  }
}

TEST(Labels, OutsideThePictureAreNotDrawn) {
  Canvas made = empty_canvas(400, 200);
  Overlays overlays;
  overlays.labels = {{{60, 0, 0}, "beside"}, {{0, 0, -90}, "behind"}};
  draw(made.picture, made.layers, Sight(ball(0.7)), overlays);
  for (const auto& pixel : made.picture.rgb) ASSERT_EQ(pixel[0], 1);
}

// In a crop the point keeps its place in the scene.
TEST(Labels, KnowCrops) {
  Canvas made = empty_canvas(100, 100);
  made.layers.width = 400;
  made.layers.height = 200;
  made.layers.x = 200;
  made.layers.y = 50;
  Overlays overlays;
  overlays.labels = {{{10, 5, 7}, "tip"}};
  draw(made.picture, made.layers, Sight(ball()), overlays);
  EXPECT_EQ(red(made.picture, 40, 30), 0);
}

}  // namespace
}  // namespace caplet::post::overlay_test
