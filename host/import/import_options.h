// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The import options that a user sets beside the file: texts by name.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace caplet {

/// ImportOptionRow is what a user may set beside a file: --name on the command line. `values` holds
/// the alternatives between |; those without capitals are typed as they are
/// (host/cli/description.h). A test compares them with what importers accept.
struct ImportOptionRow {
  std::string name, values, help;
  /// format: of the importers that list it (importers.def; docs/formats says what it does).
  /// picture: of any file's picture (docs/pictures.md). reading: how files of any format are read;
  /// the command line has yes|no as --name alone, for yes.
  enum class Of { format, picture, reading } of = Of::format;
  bool is_list = false;  // several values may be given, as lines of one text
};

const std::vector<ImportOptionRow>& import_option_rows();

/// The quantity that a colour map shows, and its least and greatest value in the files that were
/// read.
struct ValueRange {
  std::string what;
  double low = 0, high = 0;
  bool is_there = false;
  bool is_length = false;  // in the file's unit
  void extend(double value);
};

class ImportOptions {
 public:
  ImportOptions() = default;
  ImportOptions(std::map<std::string, std::string> values) : values_(std::move(values)) {}

  const std::map<std::string, std::string>& values() const { return values_; }
  void set(const std::string& name, const std::string& value) { values_[name] = value; }

  std::optional<std::string> text(const std::string& name) const;
  /// Returns the option's index in `choices`; `otherwise` if it is not given. Throws InputError
  /// that names the option.
  std::size_t choice(const std::string& name, std::initializer_list<const char*> choices,
                     std::size_t otherwise) const;
  bool yes(const std::string& name, bool otherwise) const;
  /// Returns a whole number from 1 up. Throws InputError that names the option.
  std::uint32_t number(const std::string& name, std::uint32_t otherwise) const;

  /// Reads "LOW,HIGH". Throws InputError that names the option.
  std::optional<std::pair<double, double>> range(const std::string& name) const;

  // For several files in one picture: this file's number among them. `seen` receives the range of
  // its values.
  std::size_t file = 0, files = 1;
  std::shared_ptr<ValueRange> seen;
  bool are_of_scene = false;  // a statement of a scene sets them, not the user

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace caplet
