// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// XML with the places of its elements, and lists of numbers in attributes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace caplet {

/// An XML file in memory, and the places of its elements.
class XmlFile {
 public:
  /// Throws InputError with line and column for invalid XML. NUL bytes at the end are ignored.
  explicit XmlFile(const std::filesystem::path& path, const SourceLocation& named_at = {});
  /// Parses text from elsewhere, which messages call `path`.
  XmlFile(const std::filesystem::path& path, std::string text);
  pugi::xml_node root() const { return document_.document_element(); }
  SourceLocation place(pugi::xml_node node) const { return place(node.offset_debug()); }
  const std::filesystem::path& path() const { return path_; }

 private:
  SourceLocation place(std::ptrdiff_t offset) const;
  std::filesystem::path path_;
  std::string text_;
  std::vector<std::size_t> line_begins_{0};
  pugi::xml_document document_;
};

/// Calls work with each blank-separated word, without a leading '+'.
template <class Work>
void each_word(std::string_view text, const Work& work) {
  constexpr std::string_view kBlanks = " \t\r\n";
  for (;;) {
    const std::size_t begin = text.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return;
    text.remove_prefix(begin);
    const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
    text.remove_prefix(word.size());
    work(word.size() > 1 && word.front() == '+' ? word.substr(1) : word);
  }
}

/// Reads blank-separated finite numbers, at least `least` and at most `most`. Throws InputError.
std::vector<double> numbers_of(std::string_view text, std::size_t least, std::size_t most,
                               const SourceLocation& where, const std::string& what);

}  // namespace caplet
