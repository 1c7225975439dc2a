// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pieces of pbrt text: numbers that are read again to the bit, strings, and where they go.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <string>
#include <string_view>

#include "base/error.h"

namespace caplet::pbrt_text {

/// Throws the InputError of what pbrt text cannot say.
[[noreturn]] inline void refuse(const SourceLocation& where, const std::string& what) {
  throw InputError(where, what + ": it cannot be written");
}

/// Collects text and hands it on in pieces of some 64 KiB.
class Text {
 public:
  using Sink = std::function<void(std::string_view)>;
  explicit Text(Sink sink) : sink_(std::move(sink)) {}

  Text& operator<<(std::string_view text) {
    buffer_ += text;
    if (buffer_.size() >= most) flush();
    return *this;
  }
  /// The shortest digits that are read as the same number.
  Text& operator<<(double value);
  Text& operator<<(float value);
  Text& operator<<(std::int64_t value);
  void flush();

 private:
  static constexpr std::size_t most = std::size_t{1} << 16;
  Sink sink_;
  std::string buffer_;
};

/// What `write` writes.
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

/// In quotes, with escapes. Throws InputError at `where` for control characters that no text may have.
std::string quoted(std::string_view text, const SourceLocation& where);

/// `[ 16 numbers ]`, column by column.
std::string matrix_text(const glm::dmat4& matrix);

/// Degrees that readers turn into these radians, of as few digits as may be. Where no number of degrees does, those that come
/// nearest, which is off by a unit in the last place.
double degrees_of(double radians);

/// What readers take from `degrees` to get these radians, likewise.
double degrees_below(double degrees, double radians);

/// A transform that readers turn around to get `inverse`, as a statement with its line's end.
std::string inverse_text(const glm::dmat4& inverse);

}  // namespace caplet::pbrt_text
