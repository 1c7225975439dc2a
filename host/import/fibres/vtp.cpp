// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// VTK XML files of PolyData, whose lines are fibres: numbers as text, base64 or appended bytes,
// plain or compressed by zlib.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "base/error.h"
#include "import/detail/base64.h"
#include "import/detail/fibres.h"
#include "import/detail/text_file.h"
#include "import/detail/xml.h"

namespace caplet {

namespace {

constexpr std::string_view kAppended = "<AppendedData";

/// Returns where the appended bytes begin, after the '>' of their element; npos: there are none.
std::size_t end_of_xml(std::string_view bytes) {
  const std::size_t begin = bytes.find(kAppended);
  return begin == std::string_view::npos ? begin : bytes.find('>', begin);
}
/// Returns the file without its appended bytes, which may not be text.
std::string xml_of(std::string_view bytes) {
  const std::size_t end = end_of_xml(bytes);
  if (end == std::string_view::npos) return std::string(bytes);
  return std::string(bytes.substr(0, end + 1)) +
         (bytes[end - 1] == '/' ? "</VTKFile>" : "</AppendedData></VTKFile>");
}

struct Type {
  std::string_view name;
  std::size_t size;
  double (*read)(const char*);
};
template <class Number>
double as_double(const char* bytes) {
  Number value{};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}
constexpr Type kTypes[] = {
    {"Int8", 1, as_double<std::int8_t>},   {"UInt8", 1, as_double<std::uint8_t>},
    {"Int16", 2, as_double<std::int16_t>}, {"UInt16", 2, as_double<std::uint16_t>},
    {"Int32", 4, as_double<std::int32_t>}, {"UInt32", 4, as_double<std::uint32_t>},
    {"Int64", 8, as_double<std::int64_t>}, {"UInt64", 8, as_double<std::uint64_t>},
    {"Float32", 4, as_double<float>},      {"Float64", 8, as_double<double>}};

class VtpReader {
 public:
  VtpReader(std::string_view bytes, const std::string& path, FibreScalars* scalars)
      : file_(path, xml_of(bytes)), scalars_(scalars) {
    const std::size_t end = end_of_xml(bytes),
                      begin = end == std::string_view::npos ? end : bytes.find('_', end);
    if (begin != std::string_view::npos) appended_ = bytes.substr(begin + 1);
  }

  Fibres read() {
    const pugi::xml_node root = file_.root();
    if (std::string_view(root.name()) != "VTKFile") fail(root, "is no XML file of VTK");
    const std::string_view type = root.attribute("type").value(),
                           order = root.attribute("byte_order").value(),
                           header = root.attribute("header_type").value(),
                           compressor = root.attribute("compressor").value();
    if (type != "PolyData") fail(root, "only PolyData is read, not " + caplet::quoted(type));
    if (order != "" && order != "LittleEndian" && order != "BigEndian")
      fail(root, caplet::quoted(order) + " is no order of bytes");
    is_swapped_ = order == "BigEndian";
    if (header != "" && header != "UInt32" && header != "UInt64")
      fail(root, caplet::quoted(header) + " is no type of headers");
    header_ = header == "UInt64" ? 8 : 4;
    if (compressor != "" && compressor != "vtkZLibDataCompressor")
      fail(root, "what " + caplet::quoted(compressor) + " packed is not read");
    is_packed_ = compressor != "";
    is_raw_ = std::string_view(root.child("AppendedData").attribute("encoding").value()) == "raw";
    if (!is_raw_) appended_ = appended_.substr(0, appended_.find('<'));
    for (const pugi::xml_node piece : root.child("PolyData").children("Piece")) read_piece(piece);
    if (out_.ends.empty()) throw InputError({file_.path().string(), 0, 0}, "holds no lines");
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(file_.place(node), message);
  }

  std::uint64_t count_in(pugi::xml_node node, const char* name, std::uint64_t usual) const {
    std::uint64_t value = usual;
    const pugi::xml_attribute attribute = node.attribute(name);
    if (attribute && !parse_number(trimmed(attribute.value()), value))
      fail(node, fmt::format("{}=\"{}\" is no count", name, attribute.value()));
    return value;
  }

  // --- Arrays ---

  /// Returns a number of a header.
  std::uint64_t header_number(std::string_view bytes, std::size_t index) const {
    char at[8];
    std::memcpy(at, bytes.data() + index * header_, header_);
    if (is_swapped_) std::reverse(at, at + header_);
    std::uint64_t wide = 0;
    if (header_ != 8) return as_u32(at);
    std::memcpy(&wide, at, sizeof wide);
    return wide;
  }
  static std::uint64_t as_u32(const char* bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  /// Returns the bytes of an array that is not text, in the byte order of the file.
  std::string bytes_of(pugi::xml_node array) const {
    const bool is_appended = std::string_view(array.attribute("format").value()) == "appended";
    const bool is_raw = is_appended && is_raw_;
    std::string_view from = trimmed_all(array.child_value());
    if (is_appended) {
      const std::uint64_t offset = count_in(array, "offset", 0);
      if (offset > appended_.size())
        fail(array, fmt::format("begins at byte {} of {}", offset, appended_.size()));
      from = appended_.substr(offset);
    }
    // `begin`: the offset, in letters of base64 or in bytes.
    const auto take = [&](std::size_t begin, std::uint64_t size) {
      const std::string_view rest = from.substr(std::min(begin, from.size()));
      if (size > rest.size())
        fail(array, fmt::format("{} bytes are announced, and {} are there", size, rest.size()));
      std::optional<std::string> out =
          is_raw ? std::string(rest.substr(0, size)) : bytes_of_base64(rest, size);
      if (!out) fail(array, "holds a letter that is none of base64");
      if (out->size() < size)
        fail(array, fmt::format("{} bytes are announced, and {} are there", size, out->size()));
      return std::move(*out);
    };
    if (!is_packed_) {
      const std::uint64_t size = header_number(take(0, header_), 0);
      if (size > from.size())
        fail(array, fmt::format("{} bytes are announced, and {} are there", size, from.size()));
      return take(0, header_ + size).substr(header_);
    }
    const std::uint64_t blocks = header_number(take(0, header_), 0);
    if (blocks == 0) return {};
    if (blocks > from.size())
      fail(array,
           fmt::format("{} blocks are announced, and {} bytes are there", blocks, from.size()));
    const std::size_t header_size = (3 + blocks) * header_;
    const std::string header = take(0, header_size);
    std::uint64_t packed = 0;
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const std::uint64_t size = header_number(header, 3 + i);
      if (size > from.size() - packed)
        fail(array, fmt::format("block {} of {} bytes is longer than the file", i + 1, size));
      packed += size;
    }
    // The header is encoded as a base64 text of its own.
    const std::string data = take(is_raw ? header_size : (header_size + 2) / 3 * 4, packed);
    std::string out;
    const char* at = data.data();
    for (std::uint64_t i = 0; i < blocks; ++i) {
      const std::uint64_t size = header_number(header, 3 + i), last = header_number(header, 2);
      const std::uint64_t plain = i + 1 == blocks && last != 0 ? last : header_number(header, 1);
      // Deflate compresses at best 1032 to 1.
      if (plain > 1032 * size + 64)
        fail(array, fmt::format("{} bytes cannot be packed into {}", plain, size));
      const std::size_t begin = out.size();
      out.resize(begin + plain);
      auto length = static_cast<uLongf>(plain);
      if (::uncompress(reinterpret_cast<Bytef*>(out.data() + begin), &length,
                       reinterpret_cast<const Bytef*>(at), static_cast<uLong>(size)) != Z_OK ||
          length != plain)
        fail(array, fmt::format("block {} is broken", i + 1));
      at += size;
    }
    return out;
  }
  static std::string_view trimmed_all(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
    return text.substr(begin);
  }

  std::vector<double> numbers(pugi::xml_node array) const {
    const std::string_view format = array.attribute("format").value(),
                           type_name = array.attribute("type").value();
    std::vector<double> out;
    if (format == "ascii") {
      each_word(std::string_view(array.child_value()), [&](std::string_view word) {
        double value = 0;
        if (!parse_number(word, value)) fail(array, caplet::quoted(word) + " is not a number");
        out.push_back(value);
      });
      return out;
    }
    if (format != "binary" && format != "appended")
      fail(array, caplet::quoted(format) + " is no format of numbers");
    const auto* type = std::ranges::find(kTypes, type_name, &Type::name);
    if (type == std::end(kTypes)) fail(array, caplet::quoted(type_name) + " is no type of numbers");
    std::string bytes = bytes_of(array);
    if (bytes.size() % type->size != 0)
      fail(array, fmt::format("{} bytes are no numbers of {}", bytes.size(), type->size));
    out.reserve(bytes.size() / type->size);
    for (std::size_t i = 0; i < bytes.size(); i += type->size) {
      if (is_swapped_) std::reverse(bytes.data() + i, bytes.data() + i + type->size);
      out.push_back(type->read(bytes.data() + i));
    }
    return out;
  }
  std::vector<double> numbers(pugi::xml_node of, const char* name) const {
    const pugi::xml_node array = of.find_child_by_attribute("DataArray", "Name", name);
    if (!array) fail(of, fmt::format("<{}> without an array of the name '{}'", of.name(), name));
    return numbers(array);
  }

  // --- Pieces ---

  void read_piece(pugi::xml_node piece) {
    const std::uint64_t lines = count_in(piece, "NumberOfLines", 0),
                        points = count_in(piece, "NumberOfPoints", 0);
    if (lines == 0) return;
    const pugi::xml_node array = piece.child("Points").child("DataArray");
    if (!array) fail(piece, "<Piece> without points");
    const std::vector<double> places = numbers(array);
    if (places.size() % 3 != 0 || places.size() / 3 != points)
      fail(array, fmt::format("{} numbers are no {} points", places.size(), points));
    for (std::size_t i = 0; i < places.size(); ++i)
      if (!(std::abs(places[i]) <= static_cast<double>(largest_number)))
        fail(array, fmt::format("point {} is not finite or out of range", i / 3));
    const pugi::xml_node of = piece.child("Lines");
    const std::vector<double> connectivity = numbers(of, "connectivity"),
                              offsets = numbers(of, "offsets");
    if (offsets.size() != lines)
      fail(of, fmt::format("{} offsets of {} lines", offsets.size(), lines));
    indices_.clear();
    double begin = 0;
    for (const double end : offsets) {
      if (!(end >= begin && end <= static_cast<double>(connectivity.size())))
        fail(of,
             fmt::format("a line is from {} to {} of {} indices", begin, end, connectivity.size()));
      for (auto k = static_cast<std::size_t>(begin); k < static_cast<std::size_t>(end); ++k) {
        if (!(connectivity[k] >= 0 && connectivity[k] < static_cast<double>(points)))
          fail(of, fmt::format("point {}: there are {}", connectivity[k], points));
        const auto index = static_cast<std::size_t>(connectivity[k]);
        out_.points.emplace_back(places[3 * index], places[3 * index + 1], places[3 * index + 2]);
        if (scalars_) indices_.push_back(index);
      }
      begin = end;
      out_.ends.push_back(out_.points.size());
    }
    if (scalars_) read_scalars(piece, points, count_in(piece, "NumberOfVerts", 0), lines);
  }

  /// Reads the requested scalars: in the first piece by FibreScalars, in others by the same name.
  void read_scalars(pugi::xml_node piece, std::uint64_t points, std::uint64_t before,
                    std::uint64_t lines) {
    const bool is_first = !looked_;
    looked_ = true;
    if (!is_first && scalars_->name.empty()) return;
    for (const pugi::xml_node section : piece.children()) {
      const bool of_points = std::string_view(section.name()) == "PointData";
      if (!of_points && std::string_view(section.name()) != "CellData") continue;
      for (const pugi::xml_node array : section.children("DataArray")) {
        const std::uint64_t components =
            std::clamp<std::uint64_t>(count_in(array, "NumberOfComponents", 1), 1, 10000);
        const std::string name = array.attribute("Name").value();
        if (is_first) {
          component_ = scalars_->take(name, components, of_points);
          array_ = name;
          if (component_ < 0) continue;
        } else if (name != array_ || of_points != scalars_->of_points) {
          continue;
        }
        const std::vector<double> all = numbers(array);
        const auto taken = static_cast<std::uint64_t>(component_);
        const std::uint64_t rows = all.size() / components;
        if (taken >= components || all.size() % components != 0 ||
            rows < (of_points ? points : before + lines))
          fail(array, fmt::format("{} rows of {} numbers are too few", rows, components));
        const auto add = [&](std::uint64_t row) {
          scalars_->values.push_back(static_cast<float>(all[row * components + taken]));
        };
        if (of_points)
          for (const std::size_t index : indices_) add(index);
        else
          for (std::uint64_t line = 0; line < lines; ++line) add(before + line);
        return;
      }
    }
    if (!is_first)
      fail(piece,
           "<Piece> without the numbers " + caplet::quoted(array_) + " that the first one has");
  }

  XmlFile file_;
  std::string_view appended_;
  FibreScalars* scalars_;
  bool is_swapped_ = false, is_packed_ = false, is_raw_ = false, looked_ = false;
  std::size_t header_ = 4;            // bytes of its numbers
  std::vector<std::size_t> indices_;  // of the fibres' points in the piece's list
  std::string array_;                 // the array that is taken
  int component_ = -1;
  Fibres out_;
};

}  // namespace

Fibres read_vtp(std::string_view bytes, const std::string& path, FibreScalars* scalars) {
  return VtpReader(bytes, path, scalars).read();
}

}  // namespace caplet
