// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// TRX tractograms: zip archives of header.json and of arrays whose names state their content
// ("positions.3.float16").
#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "import/detail/fibres.h"
#include "import/detail/text_file.h"
#include "import/detail/zip_file.h"

namespace caplet {

namespace {

/// Converts IEEE 754's binary16 to a float, which is exact.
float from_half(std::uint16_t half) {
  constexpr std::uint32_t exponent_mask = 0x7c00, mantissa_mask = 0x03ff;
  const std::uint32_t sign = (half & 0x8000U) << 16U;
  const std::uint32_t exponent = half & exponent_mask, mantissa = half & mantissa_mask;
  if (exponent == 0) {
    const float small = std::ldexp(static_cast<float>(mantissa), -24);
    return sign != 0 ? -small : small;
  }
  if (exponent == exponent_mask)
    return std::bit_cast<float>(sign | 0x7f800000U | (mantissa << 13U));
  return std::bit_cast<float>(sign | ((exponent + 0x1c000U) << 13U) | (mantissa << 13U));
}

class TrxReader {
 public:
  explicit TrxReader(const std::filesystem::path& path) : zip_(path) {}

  Fibres read(FibreScalars* scalars) {
    const auto header = zip_.find("header.json");
    if (!header) fail("is no TRX file: the archive has no header.json");
    const std::uint64_t points = header_count(*header, "NB_VERTICES"),
                        tracks = header_count(*header, "NB_STREAMLINES");
    Fibres out;
    positions(points, out);
    offsets(points, tracks, out);
    if (scalars) {
      data("dpv/", points, true, *scalars);
      data("dps/", tracks, false, *scalars);
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({zip_.path().string(), 0, 0}, message);
  }

  std::uint64_t header_count(const std::string& file, const char* name) {
    if (!parsed_) {
      const std::string text = zip_.read(file);
      // Deep nesting would overflow the stack when it is freed.
      const auto callback = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
        return depth < 16;
      };
      try {
        header_ = nlohmann::json::parse(text, callback);
      } catch (const nlohmann::json::parse_error& error) {
        fail(fmt::format("{}: byte {}: is no JSON here", file, error.byte));
      } catch (const nlohmann::json::out_of_range&) {
        fail(file + ": a number is out of range");
      }
      parsed_ = true;
    }
    if (!header_.is_object() || !header_.contains(name) || !header_[name].is_number_unsigned())
      fail(fmt::format("{}: {} is missing or no count", file, name));
    return header_[name].get<std::uint64_t>();
  }

  /// Returns the file "WHAT.TYPE" or "WHAT.COLUMNS.TYPE", and its type.
  std::pair<std::string, std::string> array(const std::string& what,
                                            const std::string& columns) const {
    for (const std::string& name : zip_.names()) {
      if (!name.starts_with(what + ".")) continue;
      const std::string rest = name.substr(what.size() + 1);
      if (!rest.starts_with(columns))
        fail(name + ": " + what + " have " + columns.substr(0, columns.size() - 1) + " columns");
      return {name, rest.substr(columns.size())};
    }
    fail("the archive has no " + what);
  }

  std::string bytes(const std::string& name, std::uint64_t count, std::size_t size) {
    std::string out = zip_.read(name);
    if (out.size() % size != 0 || out.size() / size != count)
      fail(fmt::format("{}: {} values of {} bytes are announced; the array has {} bytes", name,
                       count, size, out.size()));
    return out;
  }
  template <class Number>
  static Number at(const std::string& bytes, std::size_t i) {
    Number value;
    std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
    return value;
  }

  void positions(std::uint64_t points, Fibres& out) {
    const auto [name, type] = array("positions", "3.");
    const std::size_t size = type == "float16"   ? 2
                             : type == "float32" ? 4
                             : type == "float64" ? 8
                                                 : 0;
    if (size == 0) fail(name + ": positions are float16, float32 or float64");
    if (points > std::uint64_t{1} << 40) fail(fmt::format("{} points are announced", points));
    const std::string raw = bytes(name, 3 * points, size);
    out.points.resize(points);
    for (std::size_t i = 0; i < points; ++i)
      for (int k = 0; k < 3; ++k) {
        const std::size_t place = 3 * i + static_cast<std::size_t>(k);
        const double value = size == 2
                                 ? static_cast<double>(from_half(at<std::uint16_t>(raw, place)))
                             : size == 4 ? static_cast<double>(at<float>(raw, place))
                                         : at<double>(raw, place);
        if (!(std::abs(value) <= static_cast<double>(largest_number)))
          fail(fmt::format("{}: point {} is not finite or out of range", name, i));
        out.points[i][k] = static_cast<float>(value);
      }
  }

  /// Reads where each streamline begins; newer files also have the end of the last one.
  void offsets(std::uint64_t points, std::uint64_t tracks, Fibres& out) {
    const auto [name, type] = array("offsets", "");
    const std::size_t size = type == "uint32" || type == "int32"   ? 4
                             : type == "uint64" || type == "int64" ? 8
                                                                   : 0;
    if (size == 0) fail(name + ": offsets are uint32 or uint64");
    const std::string raw = zip_.read(name);
    const std::uint64_t count = raw.size() / size;
    if (raw.size() % size != 0 || count < tracks || count - tracks > 1)
      fail(fmt::format("{}: {} streamlines are announced; the array has {} bytes", name, tracks,
                       raw.size()));
    const auto offset = [&](std::uint64_t i) -> std::uint64_t {
      if (i >= count) return points;
      return size == 4 ? at<std::uint32_t>(raw, i) : at<std::uint64_t>(raw, i);
    };
    if (tracks > 0 && offset(0) != 0)
      fail(name + ": the first streamline does not begin at the first point");
    out.ends.reserve(tracks);
    for (std::uint64_t i = 0; i < tracks; ++i) {
      if (offset(i + 1) < offset(i) || offset(i + 1) > points)
        fail(fmt::format(
            "{}: streamline {} ends at point {}, before it begins or beyond the {} points", name, i,
            offset(i + 1), points));
      out.ends.push_back(offset(i + 1));
    }
    if (tracks > 0 && out.ends.back() != points)
      fail(fmt::format("{}: the last streamline ends at point {} of {}", name, out.ends.back(),
                       points));
  }

  /// Takes requested scalars from the arrays "FOLDER/NAME.TYPE" and "FOLDER/NAME.COLUMNS.TYPE", of
  /// `count` rows each.
  void data(const std::string& folder, std::uint64_t count, bool of_points, FibreScalars& scalars) {
    for (const std::string& file : zip_.names()) {
      if (!file.starts_with(folder) || file.ends_with('/')) continue;
      std::string name = file.substr(folder.size());
      const std::size_t dot = name.rfind('.');
      if (dot == std::string::npos || dot == 0) continue;
      const std::string type = name.substr(dot + 1);
      name.resize(dot);
      std::size_t columns = 1;
      const std::size_t before = name.rfind('.');
      if (before != std::string::npos && before > 0 &&
          parse_number(std::string_view(name).substr(before + 1), columns)) {
        if (columns == 0 || columns > 10000) fail(fmt::format("{}: {} columns", file, columns));
        name.resize(before);
      } else {
        columns = 1;
      }
      const int column = scalars.take(name, columns, of_points);
      if (column < 0) continue;
      values(file, type, count, columns, static_cast<std::size_t>(column), scalars.values);
      return;
    }
  }

  void values(const std::string& file, const std::string& type, std::uint64_t count,
              std::size_t columns, std::size_t column, std::vector<float>& out) {
    using Read = float (*)(const std::string&, std::size_t);
    struct Type {
      const char* name;
      std::size_t size;
      Read read;
    };
    static constexpr Type types[] = {{"float16", 2,
                                      [](const std::string& raw, std::size_t i) {
                                        return from_half(at<std::uint16_t>(raw, i));
                                      }},
                                     {"float32", 4, as_float<float>},
                                     {"float64", 8, as_float<double>},
                                     {"int8", 1, as_float<std::int8_t>},
                                     {"uint8", 1, as_float<std::uint8_t>},
                                     {"int16", 2, as_float<std::int16_t>},
                                     {"uint16", 2, as_float<std::uint16_t>},
                                     {"int32", 4, as_float<std::int32_t>},
                                     {"uint32", 4, as_float<std::uint32_t>},
                                     {"int64", 8, as_float<std::int64_t>},
                                     {"uint64", 8, as_float<std::uint64_t>}};
    const Type* found = nullptr;
    for (const Type& one : types)
      if (type == one.name) found = &one;
    if (!found) fail(file + ": " + caplet::quoted(type) + " is no type of numbers that is read");
    const std::string raw = bytes(file, count * columns, found->size);
    for (std::uint64_t i = 0; i < count; ++i) out.push_back(found->read(raw, i * columns + column));
  }
  template <class Number>
  static float as_float(const std::string& raw, std::size_t i) {
    return static_cast<float>(at<Number>(raw, i));
  }

  ZipFile zip_;
  nlohmann::json header_;
  bool parsed_ = false;
};

}  // namespace

Fibres read_trx(const std::filesystem::path& path, FibreScalars* scalars) {
  return TrxReader(path).read(scalars);
}

}  // namespace caplet
