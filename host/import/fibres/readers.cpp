// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads cyHair's .hair, TressFX's .tfx, TrackVis' .trk and MRtrix' .tck.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <glm/mat4x4.hpp>

#include "base/error.h"
#include "import/detail/fibres.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

/// Reads numbers of either byte order.
class FileBytes {
 public:
  FileBytes(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path) {}
  void set_swapped(bool swapped) { swapped_ = swapped; }
  std::size_t left(std::size_t at) const { return at < bytes_.size() ? bytes_.size() - at : 0; }

  template <class Number>
  Number at(std::size_t offset) const {
    if (left(offset) < sizeof(Number)) fail(offset, "the file ends before what it announces");
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(Number));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<Number>(raw);
  }
  float coordinate(std::size_t offset) const {
    const auto value = at<float>(offset);
    if (!(std::abs(value) <= largest_number))
      fail(offset, "a number is not finite or out of range");
    return value;
  }
  glm::vec3 point(std::size_t offset) const {
    return {coordinate(offset), coordinate(offset + 4), coordinate(offset + 8)};
  }
  /// Checks that the file contains `count` records of `size` bytes.
  void need(std::size_t offset, std::uint64_t count, std::uint64_t size) const {
    if (count > left(offset) / size)
      fail(offset, fmt::format("{} records of {} bytes are announced; {} bytes are left", count,
                               size, left(offset)));
  }
  [[noreturn]] void fail(std::size_t offset, const std::string& message) const {
    throw InputError({path_, 0, 0}, fmt::format("byte {}: {}", offset, message));
  }

 private:
  std::string_view bytes_;
  const std::string& path_;
  bool swapped_ = false;
};

}  // namespace

Fibres read_hair(std::string_view text, const std::string& path) {
  const FileBytes bytes(text, path);
  if (!text.starts_with("HAIR"))
    throw InputError({path, 0, 0}, "is no hair file: it does not begin with 'HAIR'");
  constexpr std::size_t header = 128;
  constexpr std::uint32_t has_segments = 1, has_points = 2, has_thickness = 4, has_transparency = 8,
                          has_colors = 16;
  const auto strands = bytes.at<std::uint32_t>(4), points = bytes.at<std::uint32_t>(8),
             flags = bytes.at<std::uint32_t>(12), usual_segments = bytes.at<std::uint32_t>(16);
  if ((flags & has_points) == 0) throw InputError({path, 0, 0}, "the file has no points");
  std::size_t at = header;
  Fibres out;
  const auto part = [&](std::uint32_t flag, std::uint64_t count, std::uint64_t size) {
    const std::size_t begin = at;
    if ((flags & flag) != 0) {
      bytes.need(at, count, size);
      at += count * size;
    }
    return begin;
  };
  const std::size_t segments_at = part(has_segments, strands, 2),
                    points_at = part(has_points, points, 12),
                    thickness_at = part(has_thickness, points, 4);
  part(has_transparency, points, 4);
  const std::size_t colors_at = part(has_colors, points, 12);
  std::uint64_t end = 0;
  for (std::uint64_t i = 0; i < strands; ++i) {
    end += ((flags & has_segments) != 0 ? bytes.at<std::uint16_t>(segments_at + 2 * i)
                                        : usual_segments) +
           std::uint64_t{1};
    if (end > points)
      bytes.fail(segments_at, fmt::format("strand {} goes on beyond the {} points", i + 1, points));
    out.ends.push_back(end);
  }
  const auto color = [&](std::size_t offset) {
    const glm::vec3 c = bytes.point(offset);
    return glm::min(glm::max(c, glm::vec3(0)), glm::vec3(1));
  };
  out.points.reserve(end);
  if ((flags & has_thickness) != 0) out.radii.reserve(end);
  if ((flags & has_colors) != 0) out.colors.reserve(end);
  for (std::uint64_t i = 0; i < end; ++i) {
    out.points.push_back(bytes.point(points_at + 12 * i));
    if ((flags & has_thickness) != 0)
      out.radii.push_back(0.5F * bytes.coordinate(thickness_at + 4 * i));
    if ((flags & has_colors) != 0) out.colors.push_back(color(colors_at + 12 * i));
  }
  if ((flags & has_thickness) == 0) out.radii = {0.5F * bytes.coordinate(20)};
  if ((flags & has_colors) == 0) out.colors = {color(28)};
  return out;
}

Fibres read_tressfx(std::string_view text, const std::string& path) {
  const FileBytes bytes(text, path);
  const auto version = bytes.at<float>(0);
  if (!(version >= 4 && version < 5))
    throw InputError({path, 0, 0},
                     fmt::format("is no TressFX file of version 4 (its version is {})", version));
  const auto strands = bytes.at<std::uint32_t>(4), vertices = bytes.at<std::uint32_t>(8),
             positions = bytes.at<std::uint32_t>(12);
  if (vertices < 2) bytes.fail(8, fmt::format("{} vertices a strand", vertices));
  bytes.need(positions, std::uint64_t{strands} * vertices, 16);
  Fibres out;
  out.points.reserve(std::size_t{strands} * vertices);
  for (std::uint64_t i = 0; i < strands; ++i) {
    for (std::uint64_t k = 0; k < vertices; ++k)
      out.points.push_back(bytes.point(positions + 16 * (i * vertices + k)));
    out.ends.push_back(out.points.size());
  }
  return out;
}

namespace {

/// TrackVis measures points in millimetres from the corner of the first voxel, along the axes of
/// voxel_order. The matrix maps voxel indices, which count from voxel centres, along its own axes,
/// to RAS+.
glm::dmat4 ras_from_trk(const FileBytes& bytes, std::string_view text) {
  glm::dmat4 ras_from_voxel(1);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      ras_from_voxel[column][row] = static_cast<double>(
          bytes.at<float>(440 + static_cast<std::size_t>(4 * (4 * row + column))));
  glm::dvec3 size;
  glm::ivec3 dimension;
  for (int k = 0; k < 3; ++k) {
    size[k] = static_cast<double>(bytes.at<float>(12 + static_cast<std::size_t>(4 * k)));
    dimension[k] = bytes.at<std::int16_t>(6 + static_cast<std::size_t>(2 * k));
  }
  if (ras_from_voxel[3][3] == 0) return glm::dmat4(1);  // the file has no matrix
  for (std::size_t i = 0; i < 16; ++i)
    if (!std::isfinite(bytes.at<float>(440 + 4 * i)))
      bytes.fail(440 + 4 * i, "a number of the matrix is not finite");
  for (int k = 0; k < 3; ++k)
    if (!(size[k] > 0)) bytes.fail(12, "a voxel's size is not positive");
  // This finds the world axis that each voxel axis runs along, and whether it runs against it.
  std::array<int, 3> axis{};
  std::array<bool, 3> against{};
  std::array<bool, 3> taken{};
  for (int round = 0; round < 3; ++round) {  // the largest components first
    int best_column = -1, best_row = -1;
    double best = -1;
    for (int column = 0; column < 3; ++column)
      for (int row = 0; row < 3; ++row) {
        const double length = glm::length(glm::dvec3(ras_from_voxel[column]));
        const double part = length > 0 ? std::abs(ras_from_voxel[column][row]) / length : 0;
        if (!taken.at(static_cast<std::size_t>(row)) &&
            axis.at(static_cast<std::size_t>(column)) == 0 && part > best) {
          best = part;
          best_column = column;
          best_row = row;
        }
      }
    axis.at(static_cast<std::size_t>(best_column)) = best_row + 1;
    against.at(static_cast<std::size_t>(best_column)) = ras_from_voxel[best_column][best_row] < 0;
    taken.at(static_cast<std::size_t>(best_row)) = true;
  }
  // The letters of voxel_order give the axes of points.
  std::string_view letters = text.substr(948, 3);
  const std::string_view names = "RASLPI";
  glm::dmat4 voxel_from_point(0);
  for (int k = 0; k < 3; ++k) {
    const std::size_t letter = names.find(letters[static_cast<std::size_t>(k)]);
    const int world = letter == std::string_view::npos ? axis.at(static_cast<std::size_t>(k))
                                                       : static_cast<int>(letter % 3) + 1;
    const bool backwards =
        letter == std::string_view::npos ? against.at(static_cast<std::size_t>(k)) : letter >= 3;
    int column = 0;
    while (column < 2 && axis.at(static_cast<std::size_t>(column)) != world) ++column;
    const bool flipped = backwards != against.at(static_cast<std::size_t>(column));
    voxel_from_point[k][column] = (flipped ? -1 : 1) / size[k];
    voxel_from_point[3][column] = flipped ? dimension[k] - 1 + 0.5 : -0.5;
  }
  voxel_from_point[3][3] = 1;
  return ras_from_voxel * voxel_from_point;
}

/// One of TrackVis' ten names of 20 bytes, as nibabel writes them: the name, a NUL, and the number
/// of columns where there are several.
struct TrkArray {
  std::string name;
  std::size_t columns = 0;  // 0: no name
};

TrkArray trk_array(std::string_view field) {
  TrkArray out;
  const std::size_t end = std::min(field.find('\0'), field.size());
  out.name = field.substr(0, end);
  if (out.name.empty()) return out;
  out.columns = 1;
  std::string_view rest = field.substr(std::min(end + 1, field.size()));
  rest = rest.substr(0, rest.find('\0'));
  std::size_t columns = 0;
  if (parse_number(rest, columns) && columns > 0 && columns < 32768) out.columns = columns;
  return out;
}

/// Returns which of the `count` columns whose names stand at `at` is requested, or -1. Columns
/// without a name are called `otherwise` and a number.
int trk_column(std::string_view text, std::size_t at, int count, const char* otherwise,
               bool of_points, FibreScalars& scalars) {
  int begin = 0, found = -1;
  for (std::size_t i = 0; i < 10 && begin < count; ++i) {
    const TrkArray array = trk_array(text.substr(at + 20 * i, 20));
    if (array.columns == 0) continue;
    const std::size_t columns = std::min(array.columns, static_cast<std::size_t>(count - begin));
    if (const int one = scalars.take(array.name, columns, of_points); one >= 0) found = begin + one;
    begin += static_cast<int>(columns);
  }
  for (; begin < count; ++begin)
    if (scalars.take(fmt::format("{} {}", otherwise, begin + 1), 1, of_points) == 0) found = begin;
  return found;
}

}  // namespace

int FibreScalars::take(const std::string& array, std::size_t components, bool are_of_points) {
  for (std::size_t i = 0; i < components && name.empty(); ++i) {
    names.push_back(components == 1 ? array : fmt::format("{}[{}]", array, i));
    if (!wanted.empty() && names.back() != wanted) continue;
    name = names.back();
    of_points = are_of_points;
    return static_cast<int>(i);
  }
  return -1;
}

Fibres read_trk(std::string_view text, const std::string& path, FibreScalars* scalars_wanted) {
  FileBytes bytes(text, path);
  constexpr std::size_t header = 1000;
  if (!text.starts_with("TRACK"))
    throw InputError({path, 0, 0}, "is no TrackVis file: it does not begin with 'TRACK'");
  bytes.set_swapped(bytes.at<std::int32_t>(996) != static_cast<std::int32_t>(header));
  if (bytes.at<std::int32_t>(996) != static_cast<std::int32_t>(header))
    bytes.fail(996, "the header's size is not 1000");
  const auto scalars = bytes.at<std::int16_t>(36), properties = bytes.at<std::int16_t>(238);
  if (scalars < 0 || properties < 0) bytes.fail(36, "a number of scalars is negative");
  const glm::dmat4 ras = ras_from_trk(bytes, text);
  const std::size_t stride = 4 * (3 + static_cast<std::size_t>(scalars));
  int scalar = -1, property = -1;
  if (scalars_wanted) {
    scalar = trk_column(text, 38, scalars, "scalar", true, *scalars_wanted);
    property = trk_column(text, 240, properties, "property", false, *scalars_wanted);
  }
  Fibres out;
  out.points.reserve(bytes.left(header) / stride);
  for (std::size_t at = header; bytes.left(at) > 0;) {
    const auto count = bytes.at<std::int32_t>(at);
    if (count < 0) bytes.fail(at, fmt::format("a track of {} points", count));
    bytes.need(at + 4, static_cast<std::uint64_t>(count), stride);
    at += 4;
    for (std::int32_t i = 0; i < count; ++i, at += stride) {
      const glm::dvec3 p(ras * glm::dvec4(glm::dvec3(bytes.point(at)), 1));
      for (int k = 0; k < 3; ++k)
        if (!(std::abs(p[k]) <= static_cast<double>(largest_number)))
          bytes.fail(at, "the point is out of range in the world");
      out.points.emplace_back(p);
      if (scalar >= 0)
        scalars_wanted->values.push_back(
            bytes.at<float>(at + 12 + 4 * static_cast<std::size_t>(scalar)));
    }
    bytes.need(at, static_cast<std::uint64_t>(properties), 4);
    if (property >= 0)
      scalars_wanted->values.push_back(
          bytes.at<float>(at + 4 * static_cast<std::size_t>(property)));
    at += 4 * static_cast<std::size_t>(properties);
    out.ends.push_back(out.points.size());
  }
  return out;
}

Fibres read_tck(std::string_view text, const std::string& path) {
  if (!text.starts_with("mrtrix tracks"))
    throw InputError({path, 1, 1}, "is no track file: it does not begin with 'mrtrix tracks'");
  FileBytes bytes(text, path);
  std::string_view rest = text;
  std::size_t offset = 0;
  bool wide = false;
  for (int line = 1;; ++line) {
    if (rest.empty()) throw InputError({path, line, 0}, "the header does not end");
    const std::string_view one = take_line(rest);
    if (one == "END") break;
    const std::size_t colon = one.find(':');
    if (colon == std::string_view::npos) continue;
    std::string_view value = one.substr(colon + 1);
    while (!value.empty() && is_blank(value.front())) value.remove_prefix(1);
    if (one.substr(0, colon) == "datatype") {
      if (value == "Float32BE" || value == "Float64BE")
        bytes.set_swapped(true);
      else if (value != "Float32LE" && value != "Float64LE")
        throw InputError(
            {path, line, 0},
            quoted(value) + " is no type of data that is read (Float32 or Float64, LE or BE)");
      wide = value.starts_with("Float64");
    } else if (one.substr(0, colon) == "file") {
      if (!value.starts_with(". "))
        throw InputError({path, line, 0}, "data in another file are not read");
      const auto [end, error] =
          std::from_chars(value.data() + 2, value.data() + value.size(), offset);
      if (error != std::errc())
        throw InputError({path, line, 0}, quoted(value) + " is no place in the file");
    }
  }
  if (offset == 0) offset = static_cast<std::size_t>(rest.data() - text.data());
  const std::size_t size = wide ? 8 : 4;
  Fibres out;
  out.points.reserve(bytes.left(offset) / (3 * size));
  for (std::size_t at = offset;; at += 3 * size) {
    if (bytes.left(at) < 3 * size)
      throw InputError({path, 0, 0}, "the file ends without the infinite point that ends tracks");
    std::array<double, 3> p{};
    for (std::size_t k = 0; k < 3; ++k)
      p.at(k) =
          wide ? bytes.at<double>(at + 8 * k) : static_cast<double>(bytes.at<float>(at + 4 * k));
    if (std::isnan(p[0]) || std::isinf(p[0])) {
      if (out.points.size() > (out.ends.empty() ? 0 : out.ends.back()))
        out.ends.push_back(out.points.size());
      if (std::isinf(p[0])) return out;
      continue;
    }
    for (const double value : p)
      if (!(std::abs(value) <= static_cast<double>(largest_number)))
        bytes.fail(at, "a number is not finite or out of range");
    out.points.emplace_back(glm::dvec3(p[0], p[1], p[2]));
  }
}

}  // namespace caplet
