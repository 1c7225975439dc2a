// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "export/detail/text.h"
#include "scene/edit.h"

namespace caplet::text_test {
namespace {

using namespace pbrt_text;
using testing::StartsWith;

std::string text(float value) {
  return text_of([&](Text& to) { to << value; });
}

TEST(ExportText, NumbersHaveTheFewestDigits) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(text(0.1f), "0.1");
  EXPECT_EQ(text(1.0f / 3), "0.33333334");
  EXPECT_EQ(text_of([](Text& to) { to << std::int64_t{100000000}; }), "100000000");
}

TEST(ExportText, NumbersAreReadAgain) {
  std::mt19937 random(5);
  for (int i = 0; i < 200'000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    float value = 0;
    std::memcpy(&value, &bits, 4);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(static_cast<float>(std::strtod(text(value).c_str(), nullptr)), value);
    const double wide = value * 1.0000000001;
    EXPECT_EQ(std::strtod(number_text(wide).c_str(), nullptr), wide);
  }
  for (const float value :
       {std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max(), 16777216.f})
    EXPECT_EQ(static_cast<float>(std::strtod(text(value).c_str(), nullptr)), value);
}

TEST(ExportText, DegreesAreThoseOfTheFile) {
  for (const double degrees :
       {45.0, 90.0, 30.0, 0.1, 33.3, 359.999, 1e-3, 57.29577951308232, 77.123456789012})
    EXPECT_EQ(degrees_of(degrees * std::numbers::pi / 180) * std::numbers::pi / 180,
              degrees * std::numbers::pi / 180);
  EXPECT_EQ(degrees_of(std::numbers::pi / 4), 45);
  // Not all radians are some degrees': then the nearest are.
  std::mt19937 random(6);
  for (int i = 0; i < 10'000; ++i) {
    const double radians = std::uniform_real_distribution<>(1e-3, 6.28)(random);
    const double read = degrees_of(radians) * std::numbers::pi / 180;
    EXPECT_LE(std::abs(read - radians), 2 * std::numeric_limits<double>::epsilon() * radians);
    EXPECT_EQ(degrees_of(read), degrees_of(radians));
  }
}

TEST(ExportText, TransformsAreTurnedAroundToTheBit) {
  EXPECT_EQ(inverse_text(glm::inverse(glm::dmat4(1))),
            "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]\n");
  EXPECT_THAT(inverse_text(glm::inverse(glm::translate(glm::dmat4(1), {1, 2, 3}))),
              StartsWith("Transform ["));
  // A file's own matrix has an inverse of few digits.
  const glm::dmat4 stated =
      glm::dmat4(0.5, 0.25, 0, 0, -0.125, 2, 0, 0, 0, 0.375, 1.1, 0, 3.7, -2.1, 0.3, 1);
  EXPECT_THAT(inverse_text(glm::inverse(stated)), StartsWith("Transform [0.5 0.25 0 0 -0.125 2 "));
  // Others mostly have none.
  const auto looking = camera_looking({1, 2, 3}, {-0.3, 0.7, 0.1}, {0, 1, 0.3});
  EXPECT_THAT(inverse_text(*looking), StartsWith("InverseTransform ["));
}

TEST(ExportText, StringsAreEscaped) {
  EXPECT_EQ(pbrt_text::quoted("a \"b\"\\\n\t", {}), R"("a \"b\"\\\n\t")");
  EXPECT_THROW(pbrt_text::quoted(std::string("a\x01"), {}), InputError);
  EXPECT_THROW(pbrt_text::quoted(std::string_view("a\0b", 3), {}), InputError);
}

}  // namespace
}  // namespace caplet::text_test
