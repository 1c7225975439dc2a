// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Legacy VTK files of POLYDATA with LINES, in ascii or big-endian binary.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/error.h"
#include "import/detail/fibres.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

class VtkReader {
 public:
  VtkReader(std::string_view text, const std::string& path, FibreScalars* scalars)
      : text_(text), path_(path), scalars_(scalars) {}

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
      else if (section == "VERTICES" || section == "POLYGONS" || section == "TRIANGLE_STRIPS")
        cells([this, &section](const std::vector<std::int64_t>&) {
          ++(section == "VERTICES" ? before_lines_ : after_lines_);
        });
      else if (section == "FIELD")
        field(nullptr);
      else if (section == "METADATA")
        metadata();
      else if (section != "POINT_DATA" && section != "CELL_DATA")
        fail(quoted(section) + " is no section that is read");
      else if (out_.ends.empty() || !scalars_)
        break;
      else if (attributes(section == "POINT_DATA"))
        break;
    }
    if (out_.ends.empty()) fail("holds no lines");
    if (scalars_) place_values();
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({path_, at_, 0}, message);
  }
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
          if (!(std::abs(p[k]) <= largest_number))
            fail(fmt::format("point {} is not finite or out of range", i));
        }
      }
      points_.push_back(p);
    }
  }

  /// Returns whether the next section has this name, without taking it.
  bool next_is(std::string_view name) {
    return skip() && text_.starts_with(name) &&
           (text_.size() == name.size() || is_space(text_[name.size()]));
  }
  /// Skips what follows the word, up to an empty line.
  void metadata() {
    if (!text_.empty()) line();
    while (!text_.empty() && !trimmed(line()).empty()) {
    }
  }

  /// Calls work with the indices of each cell.
  template <class Work>
  void cells(const Work& work) {
    const std::int64_t count = whole(), size = whole();
    skip_blanks();
    const std::string_view rest = text_;
    const int passed = passed_;
    if (next_is("OFFSETS")) return cells_by_offsets(count, size, work);
    text_ = rest;
    passed_ = passed;
    begin_data();
    std::int64_t used = 0;
    std::vector<std::int64_t> indices;
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t corners = binary_ ? raw<std::int32_t>() : whole();
      if (corners < 0 || corners >= size - used)
        fail(fmt::format("cell {} has more points than are announced", i));
      used += corners + 1;
      indices.clear();
      for (std::int64_t k = 0; k < corners; ++k)
        indices.push_back(binary_ ? raw<std::int32_t>() : whole());
      work(indices);
    }
  }
  /// From version 5 on, offsets give the beginning of each cell in the list of indices, and the end
  /// of the last one.
  template <class Work>
  void cells_by_offsets(std::int64_t count, std::int64_t size, const Work& work) {
    word();
    const std::vector<std::int64_t> offsets = whole_numbers(count);
    if (word() != "CONNECTIVITY") fail("expected CONNECTIVITY");
    const std::vector<std::int64_t> connectivity = whole_numbers(size);
    std::vector<std::int64_t> indices;
    for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
      if (offsets[i] < 0 || offsets[i] > offsets[i + 1] || offsets[i + 1] > size)
        fail(fmt::format("cell {} is from {} to {} of {} indices", i, offsets[i], offsets[i + 1],
                         size));
      indices.assign(connectivity.begin() + offsets[i], connectivity.begin() + offsets[i + 1]);
      work(indices);
    }
  }
  std::vector<std::int64_t> whole_numbers(std::int64_t count) {
    const Type type = type_of(word());
    begin_data();
    std::vector<std::int64_t> out;
    for (std::int64_t i = 0; i < count; ++i)
      out.push_back(!binary_         ? whole()
                    : type.size == 8 ? raw<std::int64_t>()
                                     : raw<std::int32_t>());
    return out;
  }

  // --- Scalars of points and cells ---

  struct Type {
    std::string_view name;
    std::size_t size;  // bytes; 0: bits
    float (*read)(VtkReader&);
  };
  template <class Number>
  static float as_float(VtkReader& reader) {
    return static_cast<float>(reader.raw<Number>());
  }
  Type type_of(std::string_view name) const {
    static constexpr Type types[] = {{"float", 4, as_float<float>},
                                     {"double", 8, as_float<double>},
                                     {"char", 1, as_float<std::int8_t>},
                                     {"signed_char", 1, as_float<std::int8_t>},
                                     {"unsigned_char", 1, as_float<std::uint8_t>},
                                     {"short", 2, as_float<std::int16_t>},
                                     {"unsigned_short", 2, as_float<std::uint16_t>},
                                     {"int", 4, as_float<std::int32_t>},
                                     {"unsigned_int", 4, as_float<std::uint32_t>},
                                     {"vtkIdType", 4, as_float<std::int32_t>},
                                     {"long", 8, as_float<std::int64_t>},
                                     {"unsigned_long", 8, as_float<std::uint64_t>},
                                     {"vtktypeint64", 8, as_float<std::int64_t>},
                                     {"vtktypeuint64", 8, as_float<std::uint64_t>},
                                     {"bit", 0, nullptr}};
    for (const Type& type : types)
      if (type.name == name) return type;
    fail(quoted(name) + " is no type of numbers that is read");
  }

  /// Decodes names, which are written with %20 for a blank.
  static std::string plain(std::string_view name) {
    std::string out;
    for (std::size_t i = 0; i < name.size(); ++i) {
      unsigned code = 0;
      const bool coded = name[i] == '%' && i + 2 < name.size() &&
                         std::from_chars(name.data() + i + 1, name.data() + i + 3, code, 16).ptr ==
                             name.data() + i + 3;
      out += coded && code >= 0x20 ? static_cast<char>(code) : name[i];
      if (coded && code >= 0x20) i += 2;
    }
    return out;
  }

  /// Reads `count` rows of `components` numbers and keeps component `taken`; -1: none.
  void numbers(std::int64_t count, std::int64_t components, std::string_view type_name, int taken) {
    const Type type = type_of(type_name);
    begin_data();
    if (components < 1 || components > 10000) fail(fmt::format("{} components", components));
    if (count > std::numeric_limits<std::int64_t>::max() / components)
      fail(fmt::format("{} rows are announced", count));
    if (binary_ && (taken < 0 || type.size == 0)) {
      const auto all = static_cast<std::uint64_t>(count * components);
      const std::uint64_t size = type.size == 0 ? all / 8 + (all % 8 != 0 ? 1 : 0) : all;
      if (size > text_.size() / std::max<std::size_t>(type.size, 1))
        fail("the file ends before what it announces");
      if (taken >= 0)
        for (std::uint64_t i = static_cast<std::uint64_t>(taken); i < all;
             i += static_cast<std::uint64_t>(components))
          scalars_->values.push_back(
              (static_cast<unsigned char>(text_[i / 8]) >> (7 - i % 8) & 1) != 0 ? 1.0F : 0.0F);
      text_.remove_prefix(size * std::max<std::size_t>(type.size, 1));
      return;
    }
    for (std::int64_t i = 0; i < count; ++i)
      for (std::int64_t k = 0; k < components; ++k) {
        const float value = binary_ ? type.read(*this) : any_number();
        if (k == taken) scalars_->values.push_back(value);
      }
  }
  float any_number() {
    const std::string_view text = word();
    double value = 0;
    if (!parse_number(text.starts_with('+') ? text.substr(1) : text, value))
      fail(quoted(text) + " is not a number");
    return static_cast<float>(value);
  }

  int take(std::string_view name, std::int64_t components, bool of_points) {
    return components < 1
               ? -1
               : scalars_->take(plain(name),
                                static_cast<std::size_t>(std::min<std::int64_t>(components, 10000)),
                                of_points);
  }

  /// Reads "NAME COUNT" and that many arrays. One may be taken if they are of points or cells.
  void field(const bool* of_points) {
    word();
    const std::int64_t arrays = whole();
    for (std::int64_t i = 0; i < arrays; ++i) {
      const std::string_view name = word();
      const std::int64_t components = whole(), rows = whole();
      const std::string_view type = word();
      if (type == "string" || type == "utf8_string" || type == "variant")
        fail(quoted(type) + " fields are not read");
      const int taken = of_points ? take(name, components, *of_points) : -1;
      if (taken >= 0 && rows != rows_)
        fail(fmt::format("{} has {} rows; there are {} {}", quoted(name), rows, rows_,
                         *of_points ? "points" : "cells"));
      numbers(rows, components, type, taken);
      if (taken >= 0) return;
      if (next_is("METADATA")) {
        word();
        metadata();
      }
    }
  }

  /// Reads the attributes of points or of cells to their end, or to the requested one; returns
  /// whether it was found.
  bool attributes(bool of_points) {
    rows_ = whole();
    const std::size_t there =
        of_points ? points_.size() : before_lines_ + out_.ends.size() + after_lines_;
    if (rows_ != static_cast<std::int64_t>(there))
      fail(fmt::format("numbers of {} {}: there are {}", rows_, of_points ? "points" : "cells",
                       there));
    while (skip() && !next_is("POINT_DATA") && !next_is("CELL_DATA")) {
      const std::string_view what = word();
      if (what == "METADATA") {
        metadata();
        continue;
      }
      if (what == "FIELD") {
        field(&of_points);
      } else {
        const std::string_view name = word();
        if (what == "SCALARS") {
          const std::string_view type = word();
          skip_blanks();
          std::int64_t components = 1;
          if (!text_.empty() && text_.front() >= '0' && text_.front() <= '9') components = whole();
          const int taken = take(name, components, of_points);
          if (next_is("LOOKUP_TABLE")) {
            word();
            word();
          } else if (binary_) {
            fail("expected LOOKUP_TABLE");
          }
          numbers(rows_, components, type, taken);
        } else if (what == "COLOR_SCALARS") {
          numbers(rows_, whole(), binary_ ? "unsigned_char" : "float", -1);
        } else if (what == "LOOKUP_TABLE") {
          numbers(whole(), 4, binary_ ? "unsigned_char" : "float", -1);
        } else if (what == "TEXTURE_COORDINATES") {
          const std::int64_t dimension = whole();
          numbers(rows_, dimension, word(), -1);
        } else {
          const bool is_vector = what == "VECTORS" || what == "NORMALS";
          const std::int64_t components = is_vector            ? 3
                                          : what == "TENSORS"  ? 9
                                          : what == "TENSORS6" ? 6
                                                               : 1;
          if (components == 1 && what != "GLOBAL_IDS" && what != "PEDIGREE_IDS" &&
              what != "EDGE_FLAGS")
            fail(quoted(what) + " is no section that is read");
          const std::string_view type = word();
          numbers(rows_, components, type, is_vector ? take(name, components, of_points) : -1);
        }
      }
      if (!scalars_->name.empty()) return true;
    }
    return false;
  }

  /// Reorders values of points to the fibres' points, and keeps those values of cells that belong
  /// to lines.
  void place_values() {
    if (scalars_->name.empty()) return;
    std::vector<float> out;
    if (scalars_->of_points) {
      for (const std::int64_t index : indices_)
        out.push_back(scalars_->values[static_cast<std::size_t>(index)]);
    } else {
      const auto begin = scalars_->values.begin() + static_cast<std::ptrdiff_t>(before_lines_);
      out.assign(begin, begin + std::ssize(out_.ends));
    }
    scalars_->values = std::move(out);
  }

  void skip_blanks() {
    while (!text_.empty() && is_blank(text_.front())) text_.remove_prefix(1);
  }

  void lines() {
    cells([this](const std::vector<std::int64_t>& indices) {
      for (const std::int64_t index : indices) {
        if (index < 0 || index >= std::ssize(points_))
          fail(fmt::format("point {}: there are {}", index, points_.size()));
        out_.points.push_back(points_[static_cast<std::size_t>(index)]);
        if (scalars_) indices_.push_back(index);
      }
      out_.ends.push_back(out_.points.size());
    });
  }

  std::string_view text_;
  const std::string& path_;
  int passed_ = 0, at_ = 0;  // lines that have ended, and the line of the last token
  bool binary_ = false;
  std::vector<glm::vec3> points_;
  FibreScalars* scalars_;
  std::vector<std::int64_t> indices_;               // of the fibres' points in the file's list
  std::size_t before_lines_ = 0, after_lines_ = 0;  // cells; VERTICES come first
  std::int64_t rows_ = 0;                           // rows of the current section
  Fibres out_;
};

}  // namespace

Fibres read_vtk(std::string_view text, const std::string& path, FibreScalars* scalars) {
  return VtkReader(text, path, scalars).read();
}

}  // namespace caplet
