// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <charconv>
#include <optional>

#include "import/detail/ply.h"

namespace caplet::ply {

namespace {

constexpr std::size_t longest_header = 1 << 20;
constexpr std::size_t most_names = 1024;  // limits elements, and properties of each

std::optional<Type> type_of(std::string_view name) {
  static const std::vector<std::pair<std::string_view, Type>> names = {
      {"char", Type::int8},      {"int8", Type::int8},       {"uchar", Type::uint8},
      {"uint8", Type::uint8},    {"short", Type::int16},     {"int16", Type::int16},
      {"ushort", Type::uint16},  {"uint16", Type::uint16},   {"int", Type::int32},
      {"int32", Type::int32},    {"uint", Type::uint32},     {"uint32", Type::uint32},
      {"float", Type::float32},  {"float32", Type::float32}, {"double", Type::float64},
      {"float64", Type::float64}};
  for (const auto& [known, type] : names)
    if (known == name) return type;
  return std::nullopt;
}

/// Reads the header line by line.
class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  Header read() {
    if (next_line() != std::vector<std::string_view>{"ply"})
      fail("this is no PLY file (it does not start with \"ply\")");
    bool has_format = false;
    for (;;) {
      const auto words = next_line();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header" && words.size() == 1) break;
      if (words[0] == "format") {
        read_format(words);
        has_format = true;
      } else if (words[0] == "element") {
        read_element(words);
      } else if (words[0] == "property") {
        read_property(words);
      } else {
        fail("unknown PLY header line");
      }
    }
    if (!has_format) fail("the PLY header has no format line");
    header_.size = at_;
    header_.lines = line_;
    return header_;
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(SourceLocation{file_, line_}, message);
  }

 private:
  std::vector<std::string_view> next_line() {
    ++line_;
    const std::size_t end = bytes_.substr(0, longest_header).find('\n', at_);
    if (end == std::string_view::npos)
      fail(at_ == 0 ? "this is no PLY file (it does not start with \"ply\")"
                    : "the PLY header does not end (no end_header)");
    std::string_view line = bytes_.substr(at_, end - at_);
    at_ = end + 1;
    std::vector<std::string_view> words;
    constexpr std::string_view blanks = " \t\r";
    for (;;) {
      const std::size_t begin = line.find_first_not_of(blanks);
      if (begin == std::string_view::npos) return words;
      line.remove_prefix(begin);
      const std::size_t length = std::min(line.find_first_of(blanks), line.size());
      words.push_back(line.substr(0, length));
      line.remove_prefix(length);
    }
  }

  void read_format(const std::vector<std::string_view>& words) {
    if (words.size() != 3 || words[2] != "1.0")
      fail("the PLY format line must be \"format\", an encoding and \"1.0\"");
    if (words[1] == "ascii")
      header_.encoding = Encoding::ascii;
    else if (words[1] == "binary_little_endian")
      header_.encoding = Encoding::little;
    else if (words[1] == "binary_big_endian")
      header_.encoding = Encoding::big;
    else
      fail("unknown PLY encoding \"" + std::string(words[1].substr(0, 40)) + "\"");
  }

  void read_element(const std::vector<std::string_view>& words) {
    Element element;
    if (words.size() != 3) fail("a PLY element line must be \"element\", a name and a count");
    const auto [end, error] =
        std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
    if (error != std::errc() || end != words[2].data() + words[2].size())
      fail("\"" + std::string(words[2].substr(0, 40)) + "\" is no element count");
    element.name = words[1];
    for (const Element& other : header_.elements)
      if (other.name == element.name)
        fail("the element \"" + element.name.substr(0, 40) + "\" is declared twice");
    if (header_.elements.size() == most_names)
      fail("more than " + std::to_string(most_names) + " elements");
    header_.elements.push_back(element);
  }

  Type read_type(std::string_view word) const {
    const auto type = type_of(word);
    if (!type) fail("unknown PLY type \"" + std::string(word.substr(0, 40)) + "\"");
    return *type;
  }

  void read_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a PLY property before any element");
    Property property;
    property.is_list = words.size() > 1 && words[1] == "list";
    if (words.size() != (property.is_list ? 5u : 3u))
      fail("a PLY property line must be \"property\" [list type] type name");
    if (property.is_list) property.count_type = read_type(words[2]);
    property.type = read_type(words[words.size() - 2]);
    if (is_float(property.count_type) && property.is_list)
      fail("the length of a PLY list must be an integer");
    property.name = words.back();
    for (const Property& other : header_.elements.back().properties)
      if (other.name == property.name)
        fail("the property \"" + property.name.substr(0, 40) + "\" is declared twice");
    if (header_.elements.back().properties.size() == most_names)
      fail("more than " + std::to_string(most_names) + " properties");
    header_.elements.back().properties.push_back(property);
  }

  const std::string& file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  int line_ = 0;
  Header header_;
};

/// Returns the fewest bytes that an entry can take: two characters per value in ascii, and empty
/// lists.
std::uint64_t least_bytes(const Element& element, Encoding encoding) {
  std::uint64_t bytes = 0;
  for (const Property& property : element.properties)
    bytes += encoding == Encoding::ascii
                 ? 2
                 : size_of(property.is_list ? property.count_type : property.type);
  return bytes;
}

void check_counts(const std::string& file, const Header& header, std::size_t file_size) {
  // The last value of an ascii file may end without a blank.
  std::uint64_t left = file_size - header.size + (header.encoding == Encoding::ascii ? 1 : 0);
  for (const Element& element : header.elements) {
    const std::uint64_t each = least_bytes(element, header.encoding);
    if (each == 0 && element.count > 0)
      throw InputError({file}, "the PLY element \"" + element.name + "\" has no properties");
    if (each != 0 && element.count > left / each)
      throw InputError({file}, "the PLY file is truncated: its header promises " +
                                   std::to_string(element.count) + " of \"" +
                                   element.name.substr(0, 40) + "\", more than fit into its " +
                                   std::to_string(file_size) + " bytes");
    left -= each * element.count;
  }
}

}  // namespace

std::size_t size_of(Type type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

bool is_float(Type type) { return type == Type::float32 || type == Type::float64; }

bool is_index_list(const Property& property) {
  return property.is_list && !is_float(property.type) &&
         (property.name == "vertex_indices" || property.name == "vertex_index" ||
          property.name == "vert_indices");
}

Header parse_header(const std::string& file, std::string_view bytes) {
  Header header = HeaderReader(file, bytes).read();
  check_counts(file, header, bytes.size());
  const auto index_of = [&](const char* name) {
    const auto found = std::find_if(header.elements.begin(), header.elements.end(),
                                    [&](const Element& e) { return e.name == name; });
    if (found == header.elements.end() || found->count == 0)
      throw InputError({file}, "the PLY file has no " + std::string(name));
    return static_cast<std::size_t>(found - header.elements.begin());
  };
  header.vertex = index_of("vertex");
  header.face = index_of("face");
  if (header.elements[header.vertex].count > UINT32_MAX)
    throw InputError({file}, "the PLY file has more than 2^32 vertices");
  for (const char* axis : {"x", "y", "z"}) {
    const auto& properties = header.elements[header.vertex].properties;
    if (std::none_of(properties.begin(), properties.end(),
                     [&](const Property& p) { return p.name == axis && !p.is_list; }))
      throw InputError({file}, "the PLY file's vertices have no \"" + std::string(axis) + "\"");
  }
  const auto& properties = header.elements[header.face].properties;
  const auto list = std::find_if(properties.begin(), properties.end(), is_index_list);
  if (list == properties.end())
    throw InputError({file}, "the PLY file's faces have no list \"vertex_indices\"");
  header.indices = static_cast<std::size_t>(list - properties.begin());
  return header;
}

}  // namespace caplet::ply
