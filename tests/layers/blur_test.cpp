// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What lenses and pixel filters make of a small ball and of an edge, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "scene_text.h"
#include "support/filters.h"

namespace caplet::test {
namespace {

struct Moments {
  double mean_x = 0, mean_y = 0;
  double second = 0, fourth = 0;  // of the distance from the middle of the picture, pixels
  double farthest = 0;            // corner of a pixel that holds anything
};

Moments moments_of(const LayeredImage& image) {
  const Channel& coverage = *image.find("A");
  Moments out;
  double total = 0;
  for (int y = 0; y < image.data_height; ++y)
    for (int x = 0; x < image.data_width; ++x) {
      const double a = double{coverage.floats[static_cast<std::size_t>(y * image.data_width + x)]};
      const double dx = x + 0.5 - image.data_width / 2.0, dy = y + 0.5 - image.data_height / 2.0,
                   r2 = dx * dx + dy * dy;
      total += a;
      out.mean_x += a * dx;
      out.mean_y += a * dy;
      out.second += a * r2;
      out.fourth += a * r2 * r2;
      if (a > 0)
        out.farthest = std::max(out.farthest, std::hypot(std::abs(dx) + 0.5, std::abs(dy) + 0.5));
    }
  out.mean_x /= total;
  out.mean_y /= total;
  out.second /= total;
  out.fourth /= total;
  return out;
}

/// A ball whose image is a disk of 4 pixels' radius, at distance 10 of a lens of radius 0.1 that is
/// sharp at `focus`, in the middle of 88 x 88 pixels of 1/1600 at distance 1. A thin lens blurs it
/// by a disk of radius 0.1 |1/focus - 1/10| there: the lens as seen from the ball, in the plane of
/// focus.
Moments blurred_ball(double focus, double filter_radius, int samples) {
  return moments_of(
      render_text(
          "Integrator \"path\" \"integer maxdepth\" 0\nLookAt 0 0 0  0 0 1  0 1 0\n"
          "Camera \"perspective\" \"float fov\" " +
              std::to_string(2 * std::atan(44.0 / 1600) * 180 / std::acos(-1)) +
              " \"float lensradius\" 0.1 \"float focaldistance\" " + std::to_string(focus) +
              "\nPixelFilter \"box\" \"float xradius\" " + std::to_string(filter_radius) +
              " \"float yradius\" " + std::to_string(filter_radius) +
              "\nFilm \"rgb\" \"integer xresolution\" 88 \"integer yresolution\" 88\nWorldBegin\n"
              "Translate 0 0 10\nShape \"sphere\" \"float radius\" 0.025\n",
          samples)
          .image);
}

/// Moments of the sum of independent centred vectors, each even in x and y: E|a + b|^2 = E a^2 + E
/// b^2, and for one that is isotropic E|a + b|^4 = E a^4 + E b^4 + 4 E a^2 E b^2.
struct Spread {
  double second, fourth;
  Spread operator+(const Spread& other) const {
    return {second + other.second, fourth + other.fourth + 4 * second * other.second};
  }
};
Spread disk(double radius) { return {radius * radius / 2, std::pow(radius, 4) / 3}; }
Spread box(double half) { return {2 * half * half / 3, std::pow(half, 4) * (2.0 / 5 + 2.0 / 9)}; }

void expect_spread(const Moments& moments, const Spread& expected) {
  // Some 40,000 rays or more hit the ball: standard errors of 0.3 % and 0.5 % of the second and
  // fourth moments of disks. The box's part of the fourth is not isotropic, less than 0.5 % of the
  // sum. Five of them.
  EXPECT_NEAR(moments.second, expected.second, 0.015 * expected.second);
  EXPECT_NEAR(moments.fourth, expected.fourth, 0.03 * expected.fourth);
  EXPECT_NEAR(moments.mean_x, 0, 5 * std::sqrt(expected.second / 2 / 40000));
  EXPECT_NEAR(moments.mean_y, 0, 5 * std::sqrt(expected.second / 2 / 40000));
}

TEST(Lens, BlursByTheCircleOfConfusion) {
  // 1600 * 0.1 * (1/5 - 1/10) = 16 pixels; behind the focus 1600 * 0.1 * (1/10 - 1/20) = 8.
  const Moments in_front = blurred_ball(5, 0.5, 768), behind = blurred_ball(20, 0.5, 768);
  expect_spread(in_front, disk(16) + disk(4) + box(0.5));
  expect_spread(behind, disk(8) + disk(4) + box(0.5));
  // A lens has no corners: nothing beyond the circle, the ball and the corner of a pixel (and
  // perspective, below 1e-3).
  EXPECT_LT(in_front.farthest, 16.02 + 4 + std::sqrt(2));
  EXPECT_LT(behind.farthest, 8.02 + 4 + std::sqrt(2));
  EXPECT_GT(in_front.farthest, 16 + 4 - 1.0);
}

TEST(Lens, IsSharpAtItsFocus) { expect_spread(blurred_ball(10, 0.5, 768), disk(4) + box(0.5)); }

// Places on the lens have nothing to do with places in the filter: the spreads add up, to either
// side of the focus.
TEST(Lens, IsIndependentOfTheFilter) {
  expect_spread(blurred_ball(5, 14, 768), disk(16) + disk(4) + box(14));
  expect_spread(blurred_ball(20, 14, 768), disk(8) + disk(4) + box(14));
}

// An edge along the middle of a pixel's row or column: what a pixel holds is the part of the filter
// that lies on the bright side.
TEST(FilterOfPbrt, EdgesAreTheFiltersIntegral) {
  constexpr int length = 24, rows = 80, samples = 256;
  std::vector<PixelFilter> filters = {{.kind = PixelFilter::Kind::box},
                                      {.kind = PixelFilter::Kind::triangle},
                                      {.kind = PixelFilter::Kind::gaussian, .sigma = 0.5},
                                      {.kind = PixelFilter::Kind::gaussian, .sigma = 3},
                                      {.kind = PixelFilter::Kind::mitchell},
                                      {.kind = PixelFilter::Kind::mitchell, .b = 0, .c = 1},
                                      {.kind = PixelFilter::Kind::sinc}};
  for (PixelFilter& filter : filters)
    for (const bool upright : {true, false}) {
      filter.radius_x = upright ? 5 : 2.5;
      filter.radius_y = upright ? 2.5 : 4;
      const double radius = upright ? filter.radius_x : filter.radius_y;
      // Pixels are 1/100 wide at distance 1; the bright half plane ends at 0.3 pixels beyond the
      // middle of the picture.
      const int width = upright ? length : rows, height = upright ? rows : length;
      const std::string corners = upright ? "-10 -10 1  0.003 -10 1  0.003 10 1  -10 10 1"
                                          : "-10 -0.003 1  10 -0.003 1  10 10 1  -10 10 1";
      const LayeredImage image =
          render_text(
              "Integrator \"path\" \"integer maxdepth\" 0\nLookAt 0 0 0  0 0 1  0 1 0\nCamera "
              "\"perspective\" \"float fov\" " +
                  std::to_string(2 * std::atan(length / 200.0) * 180 / std::acos(-1)) +
                  "\nFilm \"rgb\" \"integer xresolution\" " + std::to_string(width) +
                  " \"integer yresolution\" " + std::to_string(height) +
                  "\nWorldBegin\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" "
                  "true\n"
                  "Shape \"trianglemesh\" \"point3 P\" [" +
                  corners + "] \"integer indices\" [0 1 2  0 2 3]\n",
              samples, [&](Scene& scene) { scene.view.filter = filter; })
              .image;
      for (int k = 0; k < length; ++k) {
        double sum = 0, squares = 0;
        for (int row = 0; row < rows; ++row) {
          const double v =
              at(image, "G", static_cast<std::size_t>(upright ? row * length + k : k * rows + row));
          sum += v / rows;
          squares += v * v / rows;
        }
        const double expected = filter_share(filter, length / 2.0 + 0.3 - (k + 0.5), radius);
        // Rows are independent: five standard errors by their spread, and the table's linear
        // interpolation.
        const double slack = 5 * std::sqrt(std::max(squares - sum * sum, 0.0) / rows) + 1e-3;
        EXPECT_NEAR(sum, expected, slack)
            << static_cast<int>(filter.kind) << ' ' << filter.b << ' ' << upright << ' ' << k;
        EXPECT_LT(slack, 0.035);
      }
    }
}

}  // namespace
}  // namespace caplet::test
