// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// NumPy's array files (.npy, NEP 1), as far as tables of numbers need them. No file is held in
// memory as a whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

namespace caplet {

struct NpyHeader {
  std::string type;  // of an element, as NumPy writes it: "<f4"; of structured arrays the list's
                     // text: "[('t', '<f4')]"
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Reads arrays of rows of numbers: halves, floats and integers of 1 to 8 bytes, of either byte
/// order; two-dimensional ones in C or Fortran order, those of more dimensions (all but the last
/// count rows) in C order.
class NpyReader {
 public:
  /// `columns`: the allowed numbers of columns. Throws InputError with the file's name for a
  /// missing file, one that is no .npy file, another type, order or shape, and a length that
  /// differs from the header's.
  NpyReader(const std::filesystem::path& path, std::vector<std::size_t> columns,
            std::size_t dimensions = 2);

  std::uint64_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  const std::vector<std::uint64_t>& shape() const { return shape_; }
  /// Sets the next row to read, at most rows().
  void go_to(std::uint64_t row) { next_ = row; }
  /// Reads the next `out.size()` / columns() rows, which must exist.
  void read(std::span<double> out);

 private:
  void read_elements(std::uint64_t first, std::size_t count, std::size_t stride, double* out);

  std::filesystem::path path_;
  std::ifstream file_;
  std::vector<std::uint64_t> shape_;
  std::uint64_t rows_ = 0, next_ = 0, data_ = 0;
  std::size_t columns_ = 0, size_ = 0;  // size_: bytes of an element
  char kind_ = 'f';                     // f, i or u
  bool is_swapped_ = false, by_columns_ = false;
  std::vector<unsigned char> bytes_;
};

/// A column of a structured array: its name and NumPy's name of its type ("<f4", "|b1", "<U12").
struct NpyField {
  std::string name, type;
};

/// Writes a one-dimensional structured array row by row. Elements are little-endian and packed, in
/// the order of the fields.
class NpyWriter {
 public:
  /// Creates the file. All members throw RunError when it cannot be written. `name`: the file's
  /// name in messages.
  NpyWriter(const std::filesystem::path& path, std::vector<NpyField> fields,
            const std::filesystem::path& name);
  NpyWriter(const std::filesystem::path& path, std::vector<NpyField> fields)
      : NpyWriter(path, std::move(fields), path) {}
  /// Appends complete rows.
  void append(std::span<const char> bytes);
  /// Completes the header. Without it the file is not valid.
  void finish();

 private:
  void write_header(std::uint64_t rows);
  void check() const;

  std::filesystem::path path_;
  std::vector<NpyField> fields_;
  std::ofstream file_;
  std::size_t row_bytes_ = 0;
  std::uint64_t rows_ = 0;
};

/// Appends `text` (UTF-8; invalid bytes become U+FFFD) as an element of type "<U" of `length`
/// characters; a longer text is cut.
void append_unicode(std::string& row, const std::string& text, std::size_t length);
/// Counts the characters of `text` in the same way.
std::size_t unicode_length(const std::string& text);

}  // namespace caplet
