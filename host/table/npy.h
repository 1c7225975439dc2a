// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// NumPy's array files (.npy, NEP 1): the parts that tables of numbers need. A file is never held in memory as a whole.
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
  std::string type;  // of an element, as NumPy writes it: "<f4"; of structured arrays the list's text: "[('t', '<f4')]"
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Reads arrays of floating-point rows: two-dimensional, C order, little-endian float32 or float64.
class NpyReader {
 public:
  /// Throws InputError with the file's name for what is missing, no .npy file, of another type, order or shape than rows of
  /// `columns`, and for files of another length than their header says.
  NpyReader(const std::filesystem::path& path, std::size_t columns);

  std::uint64_t rows() const { return rows_; }
  /// The next `out.size()` / columns rows, which must be there.
  void read(std::span<double> out);

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  std::uint64_t rows_ = 0;
  bool is_double_ = false;
  std::vector<float> singles_;
};

/// A column of a structured array: its name and NumPy's name of its type ("<f4", "|b1", "<U12").
struct NpyField {
  std::string name, type;
};

/// Writes a one-dimensional structured array row by row. Elements are little-endian and packed, in the order of the fields.
class NpyWriter {
 public:
  /// Creates the file. Throws RunError, as all members do, when it cannot be written. `name`: of the file, for messages.
  NpyWriter(const std::filesystem::path& path, std::vector<NpyField> fields, const std::filesystem::path& name);
  NpyWriter(const std::filesystem::path& path, std::vector<NpyField> fields) : NpyWriter(path, std::move(fields), path) {}
  /// Whole rows.
  void append(std::span<const char> bytes);
  /// Completes the header. What is not finished is no .npy file.
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

/// Appends `text` (UTF-8; bytes that are none become U+FFFD) as an element of type "<U" of `length` characters; a longer text is
/// cut.
void append_unicode(std::string& row, const std::string& text, std::size_t length);
/// Characters of `text` by the same count.
std::size_t unicode_length(const std::string& text);

}  // namespace caplet
