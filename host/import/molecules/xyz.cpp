// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// XYZ: frames of a count, a comment, and one line per atom. The comment of extended XYZ describes
// the columns
// ("Properties=...").
#include <fmt/format.h>

#include <optional>

#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/molecule_lines.h"

namespace caplet {

namespace {

struct Columns {
  std::size_t species = 0, position = 1;
  std::optional<std::size_t> charge;
};

/// Parses "Properties=species:S:1:pos:R:3:...": a name, a kind and a number of columns each.
Columns columns_of(std::string_view comment) {
  Columns columns;
  const std::string_view key = "Properties=";
  const std::size_t at = comment.find(key);
  if (at == std::string_view::npos) return columns;
  std::string_view rest = comment.substr(at + key.size());
  rest = rest.substr(0, rest.find_first_of(" \t"));
  std::vector<std::string_view> fields;
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    fields.push_back(rest.substr(0, colon));
    rest.remove_prefix(std::min(rest.size(), colon + 1));
  }
  std::size_t column = 0;
  for (std::size_t i = 0; i + 2 < fields.size(); i += 3) {
    if (fields[i] == "species") columns.species = column;
    if (fields[i] == "pos") columns.position = column;
    for (const char* name : {"charge", "charges", "initial_charges"})
      if (fields[i] == name) columns.charge = column;
    std::size_t count = 0;
    (void)parse_number(fields[i + 2], count);
    column += std::min<std::size_t>(count, 1000);
  }
  return columns;
}

class XyzReader : MoleculeLines {
 public:
  XyzReader(std::string_view text, const std::string& path, const ImportOptions& options)
      : MoleculeLines(text, path, "the file ends where a line of it is missing"),
        options_(options) {}

  Molecule read() {
    const std::uint32_t wanted = options_.number("model", 1);
    for (std::uint32_t frame = 1;; ++frame) {
      while (!text_.empty() && words_of(next_line_peeked()).empty()) line();
      if (text_.empty() && frame > 1)
        throw InputError({"--model"}, fmt::format("{}: the file has {} frames", wanted, frame - 1));
      const std::uint64_t count = count_of(line());
      const Columns columns = columns_of(line());
      for (std::uint64_t i = 0; i < count; ++i) {
        const std::string_view text = line();
        if (frame == wanted) add_atom(text, columns);
      }
      if (frame == wanted) break;
    }
    out_.frames = wanted + frames_behind();
    if (out_.atoms.empty())
      throw InputError({path_, line_, 0}, "holds no atoms that are asked for");
    close_residue();
    return std::move(out_);
  }

 private:
  std::string_view next_line_peeked() const {
    std::string_view rest = text_;
    return take_line(rest);
  }

  /// Counts the complete frames after the one that was read.
  std::uint32_t frames_behind() const {
    std::uint32_t frames = 0;
    for (std::string_view rest = text_; !rest.empty();) {
      const std::vector<std::string_view> words = words_of(take_line(rest));
      if (words.empty()) continue;
      std::uint64_t lines = 0;
      if (words.size() != 1 || !parse_number(words[0], lines)) break;
      for (++lines; lines > 0 && !rest.empty(); --lines) take_line(rest);
      if (lines > 0) break;
      ++frames;
    }
    return frames;
  }

  std::uint64_t count_of(std::string_view text) const {
    const std::vector<std::string_view> words = words_of(text);
    std::uint64_t count = 0;
    if (words.empty()) fail(0, "the number of atoms is missing");
    if (words.size() != 1 || !parse_number(words[0], count))
      fail(0, quoted(words[0]) + " is no number of atoms");
    return count;
  }

  void add_atom(std::string_view text, const Columns& columns) {
    const std::vector<std::string_view> words = words_of(text);
    if (words.size() < columns.position + 3 || words.size() <= columns.species)
      fail(0, fmt::format("{} columns: an atom is a symbol and three coordinates", words.size()));
    glm::vec3 position(0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words[columns.position + static_cast<std::size_t>(axis)];
      const NumberError error = parse_float(word, position[axis]);
      if (error != NumberError::none) fail(0, describe(error, word));
    }
    Atom atom = next_atom(position, words[columns.species]);
    if (columns.charge) {
      if (words.size() <= *columns.charge) fail(0, "the charge is missing");
      const NumberError error = parse_float(words[*columns.charge], atom.charge);
      if (error != NumberError::none) fail(0, describe(error, words[*columns.charge]));
      out_.has_charges = true;
    }
    if (atom.hydrogen() && !options_.yes("hydrogens", true)) return;
    add(atom);
  }

  const ImportOptions& options_;
};

}  // namespace

Molecule read_xyz(std::string_view text, const std::string& path, const ImportOptions& options) {
  return XyzReader(text, path, options).read();
}

}  // namespace caplet
