// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What a user asks of an importer beside the file: options by name (import_options.def), as text.
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

struct ImportOptionRow {
  std::string name, values, help;
  enum class Of { format, picture, reading } of = Of::format;  // of some formats; of all: how it looks, how it is read
};

const std::vector<ImportOptionRow>& import_option_rows();

/// What colours tell by a colour map, and the least and greatest value of it in the files that were read.
struct ValueRange {
  std::string what;
  double low = 0, high = 0;
  bool is_there = false;
  void extend(double value);
};

class ImportOptions {
 public:
  ImportOptions() = default;
  ImportOptions(std::map<std::string, std::string> values) : values_(std::move(values)) {}

  const std::map<std::string, std::string>& values() const { return values_; }
  void set(const std::string& name, const std::string& value) { values_[name] = value; }

  std::optional<std::string> text(const std::string& name) const;
  /// Which of `choices` the option says; `otherwise` where it is not given. Throws InputError naming the option.
  std::size_t choice(const std::string& name, std::initializer_list<const char*> choices, std::size_t otherwise) const;
  bool yes(const std::string& name, bool otherwise) const;
  /// A whole number from 1. Throws InputError naming the option.
  std::uint32_t number(const std::string& name, std::uint32_t otherwise) const;

  /// "LOW,HIGH". Throws InputError naming the option.
  std::optional<std::pair<double, double>> range(const std::string& name) const;

  // Of several files for one picture: which of how many this is, and where what colours tell of it is added.
  std::size_t file = 0, files = 1;
  std::shared_ptr<ValueRange> seen;
  bool are_of_scene = false;  // a statement of a scene says them, not the user

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace caplet
