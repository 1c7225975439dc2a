// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// MDL molfiles and SD files: connection tables of V2000 (fixed columns) and V3000 (free format), as
// in BIOVIA's "CTfile formats".
#include <fmt/format.h>

#include <cmath>
#include <unordered_map>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/molecule_lines.h"

namespace caplet {

namespace {

class SdfReader : MoleculeLines {
 public:
  SdfReader(std::string_view text, const std::string& path, const ImportOptions& options)
      : MoleculeLines(text, path, "the file ends before its connection table does"),
        options_(options) {}

  Molecule read() {
    const std::uint32_t wanted = options_.number("model", 1);
    skip_records(wanted);
    if (trimmed(text_).starts_with('<'))
      throw InputError({path_, 1, 0},
                       "is XML: simulators' SDFormat is not read, which has the same ending as "
                       "molecules' SD files");
    out_.name = std::string(trimmed(line()));
    line();  // skips program and date
    line();  // skips the comment
    const std::string_view counts = line();
    if (counts.find("V3000") != std::string_view::npos)
      read_v3000();
    else
      read_v2000(counts);
    if (out_.atoms.empty()) fail(0, "holds no atoms");
    close_residue();
    out_.bonds_are_complete = true;
    out_.frames = wanted + records_behind();
    return std::move(out_);
  }

 private:
  /// Empty lines behind the last record are none.
  static bool is_empty(std::string_view rest) {
    return rest.find_first_not_of(" \t\r\n") == std::string_view::npos;
  }

  void skip_records(std::uint32_t number) {
    for (std::uint32_t record = 1; record < number; ++record) {
      do {
        if (text_.empty())
          throw InputError({"--model"}, fmt::format("{}: the file has {} records", number, record));
      } while (line() != "$$$$");
      if (is_empty(text_))
        throw InputError({"--model"}, fmt::format("{}: the file has {} records", number, record));
    }
  }

  std::uint32_t records_behind() const {
    std::uint32_t records = 0;
    for (std::string_view rest = text_; !rest.empty();)
      if (take_line(rest) == "$$$$" && !is_empty(rest)) ++records;
    return records;
  }

  /// Reads a field of fixed columns, which count from 0.
  template <class Number>
  Number fixed(std::string_view text, std::size_t begin, std::size_t size, const char* what) const {
    const std::string_view field =
        text.size() > begin ? trimmed(text.substr(begin, size)) : std::string_view();
    Number value = 0;
    if (!parse_number(field, value))
      fail(begin + 1, fmt::format("{}: {} is no number", what, quoted(field)));
    return value;
  }

  void add_atom(glm::dvec3 p, std::string_view symbol, std::size_t column) {
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(p[axis]) <= static_cast<double>(largest_number)))
        fail(column, "the place is not finite or out of range");
    add(next_atom(glm::vec3(p), symbol));
  }

  void add_bond(std::uint32_t a, std::uint32_t b, std::size_t column) {
    const std::size_t count = out_.atoms.size();
    if (a < 1 || b < 1 || a > count || b > count || a == b)
      fail(column, fmt::format("a bond of atoms {} and {}: there are {}", a, b, count));
    out_.bonds.emplace_back(std::min(a, b) - 1, std::max(a, b) - 1);
  }

  void read_v2000(std::string_view counts) {
    const auto atoms = fixed<std::uint32_t>(counts, 0, 3, "number of atoms");
    const auto bonds = fixed<std::uint32_t>(counts, 3, 3, "number of bonds");
    for (std::uint32_t i = 0; i < atoms; ++i) {
      const std::string_view text = line();
      glm::dvec3 p(0);
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = fixed<double>(text, 10 * static_cast<std::size_t>(axis), 10, "coordinate");
      add_atom(p, text.size() > 31 ? trimmed(text.substr(31, 3)) : std::string_view(), 1);
      // Codes 1 to 7 mean charges of +3 to -3, but 4, a radical, none.
      if (text.size() <= 36 || trimmed(text.substr(36, 3)).empty()) continue;
      if (const int code = fixed<int>(text, 36, 3, "charge"); code >= 1 && code <= 7)
        set_charge(i + 1, 4 - code, 37);
    }
    for (std::uint32_t i = 0; i < bonds; ++i) {
      const std::string_view text = line();
      add_bond(fixed<std::uint32_t>(text, 0, 3, "first atom"),
               fixed<std::uint32_t>(text, 3, 3, "second atom"), 1);
    }
    read_properties();
  }

  /// Reads the charges of V2000's properties: "M  CHG", a count, and as often an atom and its
  /// charge, in four columns each. They replace the charges of the lines of atoms.
  void read_properties() {
    for (bool is_first = true; !text_.empty() && !text_.starts_with("$$$$");) {
      const std::string_view text = line();
      if (text.starts_with("M  END")) return;
      if (!text.starts_with("M  CHG")) continue;
      if (std::exchange(is_first, false))
        for (Atom& atom : out_.atoms) atom.charge = 0;
      const auto count = fixed<std::uint32_t>(text, 6, 3, "number of charges");
      for (std::size_t i = 0; i < count; ++i)
        set_charge(fixed<std::uint32_t>(text, 9 + 8 * i, 4, "atom"),
                   fixed<int>(text, 13 + 8 * i, 4, "charge"), 10 + 8 * i);
    }
  }

  void set_charge(std::uint32_t atom, int charge, std::size_t column) {
    if (atom < 1 || atom > out_.atoms.size())
      fail(column, fmt::format("a charge of atom {}: there are {}", atom, out_.atoms.size()));
    if (std::abs(charge) > 15) fail(column, fmt::format("a charge of {}: at most 15", charge));
    out_.atoms[atom - 1].charge = static_cast<float>(charge);
    out_.has_charges |= charge != 0;
  }

  /// Returns a line "M  V30 ..." without that prefix, joined with those that follow if it ends in
  /// "-".
  std::string v30() {
    std::string out;
    for (;;) {
      std::string_view text = trimmed(line());
      if (text == "M  END") return "END CTAB";
      if (!text.starts_with("M  V30")) fail(1, "expected 'M  V30'");
      text = trimmed(text.substr(6));
      const bool goes_on = text.ends_with('-');
      if (goes_on) text.remove_suffix(1);
      out += text;
      if (out.size() > 1U << 20) fail(0, "a statement of more than a million letters");
      if (!goes_on) return out;
    }
  }

  void read_v3000() {
    enum class Block { none, atoms, bonds } block = Block::none;
    std::unordered_map<std::uint32_t, std::uint32_t> by_number;
    for (;;) {
      const std::string text = v30();
      if (text == "END CTAB") return;
      if (text == "BEGIN ATOM") block = Block::atoms;
      if (text == "BEGIN BOND") block = Block::bonds;
      if (text.starts_with("END ")) block = Block::none;
      if (block == Block::none || text.starts_with("BEGIN ")) continue;
      const std::vector<std::string_view> words = words_of(text);
      if (block == Block::atoms) {
        if (words.size() < 5) fail(1, "an atom is number, symbol, x, y, z");
        by_number[number<std::uint32_t>(words[0])] = static_cast<std::uint32_t>(out_.atoms.size());
        add_atom({number<double>(words[2]), number<double>(words[3]), number<double>(words[4])},
                 words[1], 1);
        for (const std::string_view word : words)
          if (word.starts_with("CHG="))
            set_charge(narrow<std::uint32_t>(out_.atoms.size()), number<int>(word.substr(4)), 1);
      } else {
        if (words.size() < 4) fail(1, "a bond is number, type and two atoms");
        const auto a = by_number.find(number<std::uint32_t>(words[2])),
                   b = by_number.find(number<std::uint32_t>(words[3]));
        if (a == by_number.end() || b == by_number.end())
          fail(1, "a bond of an atom that there is not");
        add_bond(a->second + 1, b->second + 1, 1);
      }
    }
  }

  template <class Number>
  Number number(std::string_view word) const {
    Number value = 0;
    if (!parse_number(word, value)) fail(1, quoted(word) + " is no number");
    return value;
  }

  const ImportOptions& options_;
};

}  // namespace

Molecule read_sdf(std::string_view text, const std::string& path, const ImportOptions& options) {
  return SdfReader(text, path, options).read();
}

}  // namespace caplet
