// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Legacy VTK files of POLYDATA with LINES, as text or big-endian.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "import/detail/fibres.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

class VtkReader {
 public:
  VtkReader(std::string_view text, const std::string& path) : text_(text), path_(path) {}

  Fibres read() {
    if (!line().starts_with("# vtk DataFile")) fail("is no legacy VTK file");
    line();
    const std::string_view kind = trimmed(line());
    if (kind != "ASCII" && kind != "BINARY") fail("expected ASCII or BINARY");
    binary_ = kind == "BINARY";
    if (word() != "DATASET" || word() != "POLYDATA") fail("only DATASET POLYDATA is read");
    while (skip()) {
      const std::string_view section = word();
      if (section == "POINTS")
        points();
      else if (section == "LINES")
        lines();
      else if (section == "POINT_DATA" || section == "CELL_DATA")
        break;  // numbers of points and lines are not drawn
      else if (section == "VERTICES" || section == "POLYGONS" || section == "TRIANGLE_STRIPS")
        cells([](const std::vector<std::int64_t>&) {});
      else if (section == "METADATA")
        while (!text_.empty() && !trimmed(line()).empty()) {
        }
      else
        fail(quoted(section) + " is no section that is read");
    }
    if (out_.ends.empty()) fail("holds no lines");
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError({path_, at_, 0}, message); }
  std::string_view line() {
    at_ = ++passed_;
    if (text_.empty()) fail("the file ends early");
    return take_line(text_);
  }
  static bool is_space(char c) { return is_blank(c) || c == '\n' || c == '\r'; }
  bool skip() {
    while (!text_.empty() && is_space(text_.front())) {
      passed_ += text_.front() == '\n';
      text_.remove_prefix(1);
    }
    return !text_.empty();
  }
  std::string_view word() {
    const bool more = skip();
    at_ = passed_ + 1;
    if (!more) fail("the file ends early");
    std::size_t end = 0;
    while (end < text_.size() && !is_space(text_[end])) ++end;
    const std::string_view out = text_.substr(0, end);
    text_.remove_prefix(end);
    return out;
  }
  std::int64_t whole() {
    const std::string_view text = word();
    std::int64_t value = 0;
    if (!parse_number(text, value) || value < 0) fail(quoted(text) + " is no count or index");
    return value;
  }
  template <class Number>
  Number raw() {
    if (text_.size() < sizeof(Number)) fail("the file ends before what it announces");
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), text_.data(), sizeof(Number));
    text_.remove_prefix(sizeof(Number));
    std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<Number>(bytes);
  }
  void begin_data() {
    if (binary_) line();
  }

  void points() {
    const std::int64_t count = whole();
    const std::string_view type = word();
    if (type != "float" && type != "double") fail(quoted(type) + " points are not read");
    const bool wide = type == "double";
    begin_data();
    for (std::int64_t i = 0; i < count; ++i) {
      glm::vec3 p;
      for (int k = 0; k < 3; ++k) {
        if (!binary_) {
          const std::string_view text = word();
          const NumberError error = parse_float(text, p[k]);
          if (error != NumberError::none) fail(describe(error, text));
        } else {
          p[k] = wide ? static_cast<float>(raw<double>()) : raw<float>();
          if (!(std::abs(p[k]) <= largest_number)) fail(fmt::format("point {} is not finite or out of range", i));
        }
      }
      points_.push_back(p);
    }
  }

  /// Calls work with the indices of each cell.
  template <class Work>
  void cells(const Work& work) {
    const std::int64_t count = whole(), size = whole();
    skip_blanks();
    begin_data();
    std::int64_t used = 0;
    std::vector<std::int64_t> indices;
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t corners = binary_ ? raw<std::int32_t>() : whole();
      if (corners < 0 || corners >= size - used) fail(fmt::format("cell {} has more points than are announced", i));
      used += corners + 1;
      indices.clear();
      for (std::int64_t k = 0; k < corners; ++k) indices.push_back(binary_ ? raw<std::int32_t>() : whole());
      work(indices);
    }
  }
  void skip_blanks() {
    while (!text_.empty() && is_blank(text_.front())) text_.remove_prefix(1);
  }

  void lines() {
    cells([this](const std::vector<std::int64_t>& indices) {
      for (const std::int64_t index : indices) {
        if (index < 0 || index >= std::ssize(points_)) fail(fmt::format("point {}: there are {}", index, points_.size()));
        out_.points.push_back(points_[static_cast<std::size_t>(index)]);
      }
      out_.ends.push_back(out_.points.size());
    });
  }

  std::string_view text_;
  const std::string& path_;
  int passed_ = 0, at_ = 0;  // lines that have ended, and the line of what was read last
  bool binary_ = false;
  std::vector<glm::vec3> points_;
  Fibres out_;
};

}  // namespace

Fibres read_vtk(std::string_view text, const std::string& path) { return VtkReader(text, path).read(); }

}  // namespace caplet
