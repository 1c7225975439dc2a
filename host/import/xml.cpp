// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "import/detail/gzip_file.h"
#include "import/detail/text_file.h"

namespace caplet {

XmlFile::XmlFile(const std::filesystem::path& path, const SourceLocation& named_at)
    : XmlFile(path, read_file(path, named_at)) {}

XmlFile::XmlFile(const std::filesystem::path& path, std::string text)
    : path_(path), text_(std::move(text)) {
  while (!text_.empty() && text_.back() == '\0') text_.pop_back();
  check_text(text_, path_.string());
  for (std::size_t i = 0; i < text_.size(); ++i)
    if (text_[i] == '\n') line_begins_.push_back(i + 1);
  const pugi::xml_parse_result result =
      document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result)
    throw InputError(place(result.offset), std::string("no XML: ") + result.description());
}

SourceLocation XmlFile::place(std::ptrdiff_t offset) const {
  const std::size_t at =
      std::min(static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)), text_.size());
  const auto line = std::ranges::upper_bound(line_begins_, at) - 1;
  return {path_.string(), static_cast<int>(line - line_begins_.begin()) + 1,
          static_cast<int>(at - *line) + 1};
}

std::vector<double> numbers_of(std::string_view text, std::size_t least, std::size_t most,
                               const SourceLocation& where, const std::string& what) {
  std::vector<double> out;
  each_word(text, [&](std::string_view word) {
    double value = 0;
    if (!parse_number(word, value))
      throw InputError(where, what + ": " + quoted(word) + " is not a number");
    if (!(std::abs(value) <= static_cast<double>(largest_number)))
      throw InputError(where, what + ": " + quoted(word) + " is not finite or out of range");
    out.push_back(value);
  });
  if (out.size() < least || out.size() > most)
    throw InputError(
        where, least == most
                   ? fmt::format("{}: {} numbers, not {}", what, least, out.size())
                   : fmt::format("{}: {} to {} numbers, not {}", what, least, most, out.size()));
  return out;
}

}  // namespace caplet
