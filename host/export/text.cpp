// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <optional>

#include "export/detail/text.h"
#include "scene/transform.h"

namespace caplet::pbrt_text {

namespace {

constexpr std::size_t longest_number = 32;

template <class Number>
std::string_view shortest(Number value, std::array<char, longest_number>& digits) {
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return {digits.data(), static_cast<std::size_t>(end - digits.data())};
}

double rounded_to(double value, int digits) {
  std::array<char, longest_number> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value,
                                          std::chars_format::scientific, digits - 1);
  double out = 0;
  std::from_chars(text.data(), end, out);
  return out;
}

double radians_of(double degrees) { return degrees * std::numbers::pi / 180; }

/// Returns a number near `near`, with as few digits as possible, that `read` converts to `wanted`.
template <class Read>
std::optional<double> exactly(double near, double wanted, Read&& read) {
  for (int digits = 1; digits <= 17; ++digits)
    if (const double degrees = rounded_to(near, digits); read(degrees) == wanted) return degrees;
  double below = near, above = near;
  for (int i = 0; i < 8; ++i) {
    below = std::nextafter(below, 0.0);
    above = std::nextafter(above, std::numeric_limits<double>::infinity());
    for (const double degrees : {below, above})
      if (read(degrees) == wanted) return degrees;
  }
  return std::nullopt;
}

/// If there is none, it returns one that `read` converts to the same value as `near`.
template <class Read>
double about(double near, double wanted, Read&& read) {
  if (const auto exact = exactly(near, wanted, read)) return *exact;
  return exactly(near, read(near), read).value_or(near);
}

}  // namespace

Text& Text::operator<<(double value) {
  std::array<char, longest_number> digits;
  return *this << shortest(value, digits);
}

Text& Text::operator<<(float value) {
  // Readers convert to a 64-bit number and round that. Where the digits lie so close to the middle
  // between two floats that this gives the wrong one, more digits are needed.
  std::array<char, longest_number> digits;
  const std::string_view text = shortest(value, digits);
  double read = 0;
  std::from_chars(text.data(), text.data() + text.size(), read);
  return static_cast<float>(read) == value ? *this << text : *this << static_cast<double>(value);
}

Text& Text::operator<<(std::int64_t value) {
  std::array<char, longest_number> digits;
  return *this << shortest(value, digits);
}

void Text::flush() {
  if (!buffer_.empty()) sink_(buffer_);
  buffer_.clear();
}

std::string quoted(std::string_view text, const SourceLocation& where) {
  constexpr std::string_view plain = "\n\r\t\b\f\\\"", letters = "nrtbf\\\"";
  std::string out = "\"";
  for (const char c : text) {
    if (const std::size_t at = plain.find(c); at != std::string_view::npos) {
      out += '\\';
      out += letters[at];
    } else if (static_cast<unsigned char>(c) < 32) {
      throw InputError(where, "the name holds a control character, which no text may have");
    } else {
      out += c;
    }
  }
  return out + '"';
}

std::string matrix_text(const glm::dmat4& matrix) {
  return text_of([&](Text& text) {
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row)
        text << (column + row == 0 ? "[" : " ") << matrix[column][row];
    text << "]";
  });
}

double degrees_of(double radians) {
  const double near = radians * 180 / std::numbers::pi;
  const auto read = [](double degrees) { return radians_of(degrees); };
  const double degrees = about(near, radians, read);
  // The second pass starts from the value that will be read, so that writing it again gives the
  // same text.
  return about(read(degrees) * 180 / std::numbers::pi, read(degrees), read);
}

double degrees_below(double degrees, double radians) {
  const auto read = [degrees](double less) { return radians_of(degrees - less); };
  const auto near = [degrees](double of) {
    return std::max(0.0, degrees - of * 180 / std::numbers::pi);
  };
  const double less = about(near(radians), radians, read);
  return about(near(read(less)), read(less), read);
}

/// Compares matrices including the signs of zeros.
bool is_same(const glm::dmat4& a, const glm::dmat4& b) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (std::bit_cast<std::uint64_t>(a[column][row]) !=
          std::bit_cast<std::uint64_t>(b[column][row]))
        return false;
  return true;
}

std::string inverse_text(const glm::dmat4& inverse) {
  const glm::dmat4 matrix = glm::inverse(inverse);
  const auto is_it = [&](const glm::dmat4& candidate) {
    const glm::dmat4 turned = glm::inverse(candidate);
    return is_affine(candidate) && has_inverse(candidate) && is_same(turned, inverse);
  };
  for (int digits = 6; digits <= 17; ++digits)
    for (const bool keeps_signs : {false, true}) {  // whether the signs of zeros are kept
      glm::dmat4 candidate;
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
          const double value = rounded_to(matrix[column][row], digits);
          candidate[column][row] = keeps_signs ? value : value + 0.0;
        }
      if (is_it(candidate)) return "Transform " + matrix_text(candidate) + "\n";
    }
  return "InverseTransform " + matrix_text(inverse) + "\n";
}

}  // namespace caplet::pbrt_text
