// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "table/npy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

#include "base/check.h"
#include "base/utf8.h"

namespace caplet {

static_assert(std::endian::native == std::endian::little,
              "elements are written as they lie in memory");

namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t preamble = 10;  // of version 1.0: magic, version, length of the header
constexpr std::size_t alignment = 64;
constexpr std::size_t longest_header = 1 << 16;

[[noreturn]] void refuse(const fs::path& path, const std::string& message) {
  throw InputError(SourceLocation{path.string()}, message);
}

/// Parses the header: a Python dictionary of strings, booleans, tuples of integers and, in types,
/// lists.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view text) : text_(text) {}

  std::optional<NpyHeader> parse() {
    NpyHeader header;
    bool has_type = false, has_order = false, has_shape = false;
    if (!take('{')) return std::nullopt;
    while (!take('}')) {
      const auto key = string();
      if (!key || !take(':')) return std::nullopt;
      if (*key == "descr") {
        const auto type = descr();
        if (!type) return std::nullopt;
        header.type = *type;
        has_type = true;
      } else if (*key == "fortran_order") {
        const auto order = boolean();
        if (!order) return std::nullopt;
        header.fortran_order = *order;
        has_order = true;
      } else if (*key == "shape") {
        auto shape = tuple();
        if (!shape) return std::nullopt;
        header.shape = std::move(*shape);
        has_shape = true;
      } else {
        return std::nullopt;
      }
      if (!take(',') && peek() != '}') return std::nullopt;
    }
    skip_blanks();
    if (!text_.empty() || !has_type || !has_order || !has_shape) return std::nullopt;
    return header;
  }

 private:
  void skip_blanks() {
    while (!text_.empty() &&
           (text_.front() == ' ' || text_.front() == '\n' || text_.front() == '\t'))
      text_.remove_prefix(1);
  }
  char peek() {
    skip_blanks();
    return text_.empty() ? '\0' : text_.front();
  }
  bool take(char c) {
    if (peek() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  bool take_word(std::string_view word) {
    skip_blanks();
    if (!text_.starts_with(word)) return false;
    text_.remove_prefix(word.size());
    return true;
  }
  std::optional<std::string> string() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') return std::nullopt;
    const std::size_t end = text_.find(quote, 1);
    if (end == std::string_view::npos) return std::nullopt;
    std::string out(text_.substr(1, end - 1));
    text_.remove_prefix(end + 1);
    return out;
  }
  std::optional<bool> boolean() {
    if (take_word("True")) return true;
    if (take_word("False")) return false;
    return std::nullopt;
  }
  std::optional<std::vector<std::uint64_t>> tuple() {
    std::vector<std::uint64_t> out;
    if (!take('(')) return std::nullopt;
    while (!take(')')) {
      skip_blanks();
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
      if (error != std::errc()) return std::nullopt;
      text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
      take('L');  // Python 2 wrote long integers as 123L
      out.push_back(value);
      if (!take(',') && peek() != ')') return std::nullopt;
    }
    return out;
  }
  std::optional<std::string> descr() {
    if (peek() != '[') return string();
    // Brackets in quoted names do not count.
    int depth = 0;
    char quote = '\0';
    for (std::size_t i = 0; i < text_.size(); ++i) {
      const char c = text_[i];
      if (quote != '\0') {
        if (c == quote) quote = '\0';
      } else if (c == '\'' || c == '"') {
        quote = c;
      } else if (c == '[' || c == '(') {
        ++depth;
      } else if ((c == ']' || c == ')') && --depth == 0) {
        std::string out(text_.substr(0, i + 1));
        text_.remove_prefix(i + 1);
        return out;
      }
    }
    return std::nullopt;
  }

  std::string_view text_;
};

/// Reads up to the start of the data.
NpyHeader read_header(std::ifstream& file, const fs::path& path) {
  const auto bytes = [&](std::size_t count) {
    std::string out(count, '\0');
    file.read(out.data(), static_cast<std::streamsize>(count));
    if (static_cast<std::size_t>(file.gcount()) != count)
      refuse(path, "the file ends within its .npy header");
    return out;
  };
  std::string start(magic.size(), '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (file.gcount() != static_cast<std::streamsize>(start.size()) || start != magic)
    refuse(path, "this is no .npy file");
  const std::string version = bytes(2);
  if (version[0] < 1 || version[0] > 3)
    refuse(path, fmt::format(".npy version {} is not known",
                             static_cast<int>(static_cast<unsigned char>(version[0]))));
  std::size_t length = 0;
  const std::string stored = bytes(version[0] == 1 ? 2 : 4);
  for (std::size_t i = stored.size(); i-- > 0;)
    length = length << 8 | static_cast<unsigned char>(stored[i]);
  if (length > longest_header) refuse(path, fmt::format("the .npy header claims {} bytes", length));
  const auto header = HeaderParser(bytes(length)).parse();
  if (!header) refuse(path, "the .npy header is malformed");
  return *header;
}

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  return fmt::format("({}{})", fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
}

/// Calls receive with each character of UTF-8 text (base/utf8.h).
template <class Receive>
void for_each_character(std::string_view text, const Receive& receive) {
  while (!text.empty()) receive(static_cast<std::uint32_t>(take_character(text)));
}

/// Converts IEEE 754 binary16.
double of_half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const double fraction = bits & 1023, sign = bits & 0x8000 ? -1 : 1;
  if (exponent == 31)
    return fraction > 0 ? std::numeric_limits<double>::quiet_NaN()
                        : sign * std::numeric_limits<double>::infinity();
  return exponent == 0 ? sign * std::ldexp(fraction, -24)
                       : sign * std::ldexp(fraction + 1024, exponent - 25);
}

/// Returns the bytes of an element from the number in its type, which for text counts characters of
/// four bytes.
std::size_t bytes_of(const std::string& type) {
  return std::stoul(type.substr(2)) * (type[1] == 'U' ? 4 : 1);
}

}  // namespace

NpyReader::NpyReader(const fs::path& path, std::vector<std::size_t> columns, std::size_t dimensions)
    : path_(path) {
  std::error_code error;
  if (const fs::file_status status = fs::status(path, error); !fs::is_regular_file(status))
    refuse(path, fs::is_directory(status) ? "cannot read: it is a folder"
                 : fs::exists(status)     ? "cannot read: it is not a regular file"
                                          : "cannot read: there is no such file");
  file_.open(path, std::ios::binary);
  if (!file_) refuse(path, "cannot read");
  const NpyHeader header = read_header(file_, path);
  static constexpr std::string_view known[] = {"f2", "f4", "f8", "i1", "i2", "i4",
                                               "i8", "u1", "u2", "u4", "u8"};
  const std::string& type = header.type;
  if (type.size() != 3 || std::string_view("<>|=").find(type[0]) == std::string_view::npos ||
      std::ranges::find(known, std::string_view(type).substr(1)) == std::end(known))
    refuse(
        path,
        fmt::format(
            "the array's type is {}; floats or whole numbers are needed, such as '<f4' (float32)",
            type.starts_with('[') ? "structured" : "'" + type.substr(0, 32) + "'"));
  kind_ = type[1];
  size_ = static_cast<std::size_t>(type[2] - '0');
  is_swapped_ = type[0] == '>';
  shape_ = header.shape;
  if (shape_.size() != dimensions || std::ranges::find(columns, shape_.back()) == columns.end())
    refuse(path, fmt::format("the array's shape is {}; ({}{}) is needed", shape_text(shape_),
                             dimensions == 2 ? "N, " : "T, N, ", fmt::join(columns, " or ")));
  columns_ = static_cast<std::size_t>(shape_.back());
  by_columns_ = header.fortran_order;
  if (by_columns_ && dimensions > 2)
    refuse(path, "the array is in Fortran order; C order is needed (numpy.ascontiguousarray)");
  rows_ = 1;
  for (std::size_t i = 0; i + 1 < shape_.size(); ++i) {
    if (shape_[i] != 0 && rows_ > UINT64_MAX / shape_[i])
      refuse(path, "the file is cut off: its shape is far too large");
    rows_ *= shape_[i];
  }
  const std::uint64_t row_bytes = columns_ * size_;
  data_ = static_cast<std::uint64_t>(file_.tellg());
  const auto size = static_cast<std::uint64_t>(fs::file_size(path, error));
  if (rows_ > (size - data_) / row_bytes)
    refuse(path, fmt::format("the file is cut off: {} rows are {} bytes, {} are there", rows_,
                             rows_ > UINT64_MAX / row_bytes ? "far too many"
                                                            : std::to_string(rows_ * row_bytes),
                             size - data_));
  if (rows_ * row_bytes != size - data_)
    refuse(path, fmt::format("{} bytes follow the array's {} rows",
                             size - data_ - rows_ * row_bytes, rows_));
}

void NpyReader::read(std::span<double> out) {
  const std::size_t count = out.size() / columns_;
  if (count == 0) return;
  if (by_columns_)
    for (std::size_t c = 0; c < columns_; ++c)
      read_elements(c * rows_ + next_, count, columns_, out.data() + c);
  else
    read_elements(next_ * columns_, count * columns_, 1, out.data());
  next_ += count;
}

void NpyReader::read_elements(std::uint64_t first, std::size_t count, std::size_t stride,
                              double* out) {
  bytes_.resize(count * size_);
  file_.seekg(static_cast<std::streamoff>(data_ + first * size_));
  file_.read(reinterpret_cast<char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
  if (!file_) throw RunError(fmt::format("{}: cannot be read any further", path_.string()));
  const auto as_they_lie = [&](auto one) {
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(&one, bytes_.data() + i * sizeof one, sizeof one);
      out[i * stride] = static_cast<double>(one);
    }
  };
  if (kind_ == 'f' && size_ == 8 && !is_swapped_) return as_they_lie(double{});
  if (kind_ == 'f' && size_ == 4 && !is_swapped_) return as_they_lie(float{});
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t bits = 0;
    const unsigned char* from = bytes_.data() + i * size_;
    for (std::size_t k = 0; k < size_; ++k)
      bits |= std::uint64_t{from[is_swapped_ ? size_ - 1 - k : k]} << (8 * k);
    double& to = out[i * stride];
    if (kind_ == 'u') {
      to = static_cast<double>(bits);
    } else if (kind_ == 'i') {
      const unsigned unused = 64 - 8 * static_cast<unsigned>(size_);
      to = static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
    } else if (size_ == 8) {
      to = std::bit_cast<double>(bits);
    } else if (size_ == 4) {
      to = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    } else {
      to = of_half(static_cast<std::uint16_t>(bits));
    }
  }
}

NpyWriter::NpyWriter(const fs::path& path, std::vector<NpyField> fields, const fs::path& name)
    : path_(name), fields_(std::move(fields)), file_(path, std::ios::binary) {
  for (const NpyField& field : fields_) row_bytes_ += bytes_of(field.type);
  write_header(0);
}

void NpyWriter::write_header(std::uint64_t rows) {
  std::string text = "{'descr': [";
  for (const NpyField& field : fields_)
    text += fmt::format("('{}', '{}'), ", field.name, field.type);
  text.resize(text.size() - 2);
  text += "], 'fortran_order': False, 'shape': (";
  // The header has the same length for every count of rows, so that it can be overwritten.
  const std::size_t least = preamble + text.size() + std::to_string(UINT64_MAX).size() +
                            std::string_view(",), }\n").size();
  const std::size_t length = (least + alignment - 1) / alignment * alignment - preamble;
  text += fmt::format("{},), }}", rows);
  text.resize(length - 1, ' ');
  text += '\n';
  std::string start(magic);
  start += {'\1', '\0', static_cast<char>(length & 0xff), static_cast<char>(length >> 8 & 0xff)};
  file_ << start << text;
  check();
}

void NpyWriter::append(std::span<const char> bytes) {
  CHECK_EQ_(bytes.size() % row_bytes_, std::size_t{0});
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  rows_ += bytes.size() / row_bytes_;
  check();
}

void NpyWriter::finish() {
  file_.seekp(0);
  write_header(rows_);
  file_.close();
  check();
}

void NpyWriter::check() const {
  if (!file_) throw RunError(fmt::format("{}: cannot be written", path_.string()));
}

void append_unicode(std::string& row, const std::string& text, std::size_t length) {
  std::size_t count = 0;
  for_each_character(text, [&](std::uint32_t character) {
    if (count++ >= length) return;
    for (int shift = 0; shift < 32; shift += 8) row += static_cast<char>(character >> shift & 0xff);
  });
  if (count < length) row.append((length - count) * 4, '\0');
}

std::size_t unicode_length(const std::string& text) {
  std::size_t count = 0;
  for_each_character(text, [&](std::uint32_t) { ++count; });
  return count;
}

}  // namespace caplet
