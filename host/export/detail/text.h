// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Writes pbrt text: numbers that are read back exactly, strings, and their output.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <string_view>

#include "base/error.h"

namespace caplet::pbrt_text {

/// Throws InputError for a scene that pbrt text cannot express.
[[noreturn]] inline void refuse(const SourceLocation& where, const std::string& what) {
  throw InputError(where, what + ": it cannot be written");
}

/// Collects text and passes it on in pieces of about 64 KiB.
class Text {
 public:
  using Sink = std::function<void(std::string_view)>;
  explicit Text(Sink sink) : sink_(std::move(sink)) {}

  Text& operator<<(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() >= most) flush();
    return *this;
  }
  /// Writes the shortest digits that are read back as the same number.
  Text& operator<<(double value);
  Text& operator<<(float value);
  Text& operator<<(std::int64_t value);
  void flush();

 private:
  static constexpr std::size_t most = std::size_t{1} << 16;
  Sink sink_;
  std::string buffer_;
};

/// Returns the text that `write` writes.
template <class Write>
std::string text_of(Write&& write) {
  std::string out;
  Text text([&](std::string_view piece) { out += piece; });
  write(text);
  text.flush();
  return out;
}
inline std::string number_text(double value) {
  return text_of([&](Text& text) { text << value; });
}

/// Quotes and escapes text. Throws InputError at `where` for control characters that no text may
/// have.
std::string quoted(std::string_view text, const SourceLocation& where);

/// Returns `[ 16 numbers ]`, column by column.
std::string matrix_text(const glm::dmat4& matrix);

/// Returns degrees that readers convert to these radians, with as few digits as possible. Where
/// there are none, it returns the nearest, which is off by a unit in the last place.
double degrees_of(double radians);

/// Returns the number that readers subtract from `degrees` to get these radians, in the same way.
double degrees_below(double degrees, double radians);

/// Returns a transform whose inverse, as readers compute it, is `inverse`: a statement with the end
/// of its line.
std::string inverse_text(const glm::dmat4& inverse);

}  // namespace caplet::pbrt_text
