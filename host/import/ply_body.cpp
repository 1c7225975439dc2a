// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads and checks the body of a PLY file, whatever its encoding and the order of its elements.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "import/detail/mesh_file.h"
#include "import/detail/ply.h"

namespace caplet::ply {

namespace {

static_assert(std::endian::native == std::endian::little,
              "values are put together in the host's byte order");

/// Reads one value after the other, from text or bytes.
class PlyValues {
 public:
  PlyValues(const std::string& file, std::string_view bytes, const Header& header)
      : file_(file),
        bytes_(bytes),
        at_(header.size),
        line_(header.lines + 1),
        encoding_(header.encoding) {}

  double number(Type type) {
    if (encoding_ == Encoding::ascii)
      return is_float(type) ? ascii_float() : static_cast<double>(ascii_integer(type));
    switch (type) {
      case Type::int8:
        return binary<std::int8_t>();
      case Type::uint8:
        return binary<std::uint8_t>();
      case Type::int16:
        return binary<std::int16_t>();
      case Type::uint16:
        return binary<std::uint16_t>();
      case Type::int32:
        return binary<std::int32_t>();
      case Type::uint32:
        return binary<std::uint32_t>();
      case Type::float32:
        return static_cast<double>(binary<float>());
      default:
        return binary<double>();
    }
  }

  /// Skips `count` values of a binary file at once; returns false for ascii.
  bool skip(Type type, std::uint64_t count) {
    if (encoding_ == Encoding::ascii) return false;
    if (count > (bytes_.size() - at_) / size_of(type)) truncated();
    at_ += count * size_of(type);
    return true;
  }

  bool fits(std::uint64_t count, Type type) const {
    return count <= (bytes_.size() - at_ + 1) / (encoding_ == Encoding::ascii ? 2 : size_of(type));
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(SourceLocation{file_, encoding_ == Encoding::ascii ? line_ : 0}, message);
  }
  [[noreturn]] void truncated() const {
    fail("the PLY file is truncated: it ends before all that its header promises");
  }

 private:
  template <class T>
  T binary() {
    if (bytes_.size() - at_ < sizeof(T)) truncated();
    std::array<char, sizeof(T)> raw;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      raw[encoding_ == Encoding::little ? i : sizeof(T) - 1 - i] = bytes_[at_ + i];
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }

  std::string_view token() {
    constexpr std::string_view blanks = " \t\r\n";
    while (at_ < bytes_.size() && blanks.find(bytes_[at_]) != std::string_view::npos)
      if (bytes_[at_++] == '\n') ++line_;
    if (at_ == bytes_.size()) truncated();
    const std::size_t end = std::min(bytes_.find_first_of(blanks, at_), bytes_.size());
    std::string_view out = bytes_.substr(at_, end - at_);
    at_ = end;
    if (out.size() > 1 && out[0] == '+' && out[1] != '-') out.remove_prefix(1);
    return out;
  }

  [[noreturn]] void bad(std::string_view word, const char* what) const {
    std::string shown;
    for (char c : word.substr(0, 40))
      shown += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
    fail("\"" + shown + "\" is no " + what);
  }

  double ascii_float() {
    const std::string_view word = token();
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::invalid_argument || end != word.data() + word.size())
      bad(word, "number");
    if (error == std::errc::result_out_of_range)
      value = std::strtod(std::string(word).c_str(), nullptr);
    return value;
  }

  std::int64_t ascii_integer(Type type) {
    const std::string_view word = token();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    const std::size_t bits = size_of(type) * 8;
    const bool is_signed = type == Type::int8 || type == Type::int16 || type == Type::int32;
    const std::int64_t low = is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
    const std::int64_t high = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
    if (error != std::errc() || end != word.data() + word.size() || value < low || value > high)
      bad(word, "integer of the declared type");
    return value;
  }

  const std::string& file_;
  std::string_view bytes_;
  std::size_t at_;
  int line_;
  Encoding encoding_;
};

/// Returns a property's place in x y z nx ny nz u v, or -1 where a mesh does not use it.
int part_of(const Property& property) {
  if (property.is_list) return -1;
  constexpr std::array<std::string_view, 8> names = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
  std::string_view name = property.name;
  if (name == "s" || name == "texture_u" || name == "texture_s") name = "u";
  if (name == "t" || name == "texture_v" || name == "texture_t") name = "v";
  const auto* const found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// Returns the colour component of a property: 0 to 2, or -1.
int color_component(const Property& property) {
  constexpr std::string_view names[3][4] = {{"red", "r", "diffuse_red", "Red"},
                                            {"green", "g", "diffuse_green", "Green"},
                                            {"blue", "b", "diffuse_blue", "Blue"}};
  if (property.is_list) return -1;
  for (int k = 0; k < 3; ++k)
    for (const std::string_view name : names[k])
      if (property.name == name) return k;
  return -1;
}

bool has_color(const Element& element) {
  unsigned there = 0;
  for (const Property& property : element.properties)
    if (const int k = color_component(property); k >= 0) there |= 1U << static_cast<unsigned>(k);
  return there == 7;
}

/// Returns the value of white: the greatest value of a small integer type; 1 for floats.
double white_of(Type type) { return is_float(type) ? 1 : size_of(type) == 2 ? 65535 : 255; }

class BodyReader {
 public:
  BodyReader(const std::string& file, std::string_view bytes, const Header& header,
             bool with_colors)
      : header_(header), values_(file, bytes, header) {
    const Element &vertex = header.elements[header.vertex], &face = header.elements[header.face];
    of_vertices_ = with_colors && has_color(vertex);
    of_faces_ = with_colors && !of_vertices_ && has_color(face);
    for (const Property& one : vertex.properties) parts_.push_back(part_of(one));
    has_normals_ = std::ranges::any_of(parts_, [](int part) { return part >= 3 && part < 6; });
    has_uvs_ = std::ranges::any_of(parts_, [](int part) { return part >= 6; });
    body_.positions.reserve(vertex.count);
    body_.lengths.reserve(face.count);
  }

  Body read() {
    for (std::size_t e = 0; e < header_.elements.size(); ++e) {
      with_color_ = (e == header_.vertex && of_vertices_) || (e == header_.face && of_faces_);
      for (std::uint64_t i = 0; i < header_.elements[e].count; ++i) {
        if (e == header_.vertex)
          vertex(header_.elements[e]);
        else
          for (std::size_t p = 0; p < header_.elements[e].properties.size(); ++p)
            property(header_.elements[e].properties[p], e == header_.face && p == header_.indices);
        if (with_color_)
          (e == header_.vertex ? body_.vertex_colors : body_.face_colors).push_back(color_);
      }
    }
    return std::move(body_);
  }

 private:
  void vertex(const Element& element) {
    std::array<float, 8> parts{};
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const Property& p = element.properties[i];
      if (parts_[i] < 0) {
        property(p, false);
        continue;
      }
      const double value = values_.number(p.type);
      if (parts_[i] < 3 && !(std::abs(value) <= 3.4028234663852886e38))
        values_.fail("a vertex position is not finite (\"" + p.name + "\")");
      parts[static_cast<std::size_t>(parts_[i])] = static_cast<float>(value);
    }
    body_.positions.emplace_back(parts[0], parts[1], parts[2]);
    if (has_normals_) body_.normals.emplace_back(parts[3], parts[4], parts[5]);
    if (has_uvs_) body_.uvs.emplace_back(parts[6], parts[7]);
  }

  void property(const Property& p, bool is_indices) {
    if (const int k = with_color_ ? color_component(p) : -1; k >= 0) {
      const double part = values_.number(p.type) / white_of(p.type);
      color_[k] = part >= 0 ? linear_of_srgb(static_cast<float>(std::min(part, 1.0))) : 0.0F;
      return;
    }
    if (!p.is_list) {
      if (!values_.skip(p.type, 1)) values_.number(p.type);
      return;
    }
    const double given = values_.number(p.count_type);
    if (given < 0) values_.fail("a PLY list has a negative length");
    const auto length = static_cast<std::uint64_t>(given);
    if (!values_.fits(length, p.type)) values_.truncated();
    if (!is_indices && values_.skip(p.type, length)) return;
    if (is_indices) body_.lengths.push_back(static_cast<std::uint32_t>(length));
    for (std::uint64_t i = 0; i < length; ++i) {
      const double value = values_.number(p.type);
      if (!is_indices) continue;
      if (value < 0 || value >= static_cast<double>(header_.elements[header_.vertex].count))
        values_.fail("a PLY face has the vertex index " +
                     std::to_string(static_cast<std::int64_t>(value)) + ", but there are " +
                     std::to_string(header_.elements[header_.vertex].count) + " vertices");
      body_.corners.push_back(static_cast<std::uint32_t>(value));
    }
  }

  const Header& header_;
  PlyValues values_;
  Body body_;
  std::vector<int> parts_;  // of each property of vertices
  bool has_normals_ = false, has_uvs_ = false;
  bool of_vertices_ = false, of_faces_ = false;  // which colours are read
  bool with_color_ = false;                      // of the element that is being read
  glm::vec3 color_{0};
};

}  // namespace

Body read_body(const std::string& file, std::string_view bytes, const Header& header,
               bool with_colors) {
  return BodyReader(file, bytes, header, with_colors).read();
}

}  // namespace caplet::ply
