// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>

#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

using Atoms = std::vector<bool>;  // for each atom, whether it is chosen

struct SelectionWord {
  std::string text;
  std::size_t column = 0;  // from 1
};

/// Splits into words, parentheses and comparisons.
std::vector<SelectionWord> selection_words(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n", marks = "()<>=!";
  std::vector<SelectionWord> out;
  for (std::size_t at = 0; at < text.size();) {
    if (blanks.find(text[at]) != blanks.npos) {
      ++at;
      continue;
    }
    std::size_t end = at + 1;
    if (marks.find(text[at]) == marks.npos)
      end = std::min(text.find_first_of(" \t\r\n()<>=!", at), text.size());
    else if (text[at] != '(' && text[at] != ')' && end < text.size() && text[end] == '=')
      ++end;
    out.push_back({std::string(text.substr(at, end - at)), at + 1});
    at = end;
  }
  return out;
}

/// Returns the number that the whole text is, if it is one.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number out{};
  return parse_number(text, out) ? std::optional(out) : std::nullopt;
}

struct ResidueRange {
  int low = 0, high = 0;
};

/// Reads "10", "-3", "10-20" or "10:20".
std::optional<ResidueRange> residue_range(std::string_view text) {
  const std::size_t sign = text.find_first_of(":-", 1);
  const std::optional<int> low = number_in<int>(text.substr(0, sign));
  if (!low) return std::nullopt;
  if (sign == text.npos) return ResidueRange{*low, *low};
  const std::optional<int> high = number_in<int>(text.substr(sign + 1));
  return high ? std::optional(ResidueRange{*low, *high}) : std::nullopt;
}

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// Compares without case; a `*` at the end of `pattern` stands for any text.
bool is_like(std::string_view text, std::string_view pattern) {
  const bool any_end = pattern.ends_with('*');
  if (any_end) pattern.remove_suffix(1);
  return (any_end ? text.size() >= pattern.size() : text.size() == pattern.size()) &&
         lower_case(std::string(text.substr(0, pattern.size()))) ==
             lower_case(std::string(pattern));
}

/// A word that tells residues.
struct ResidueWord {
  const char* names;  // between blanks
  bool (*holds)(const Residue& residue);
};
constexpr ResidueWord residue_words[] = {
    {"polymer",
     [](const Residue& r) {
       return r.kind == ResidueKind::amino_acid || r.kind == ResidueKind::nucleotide;
     }},
    {"protein", [](const Residue& r) { return r.kind == ResidueKind::amino_acid; }},
    {"nucleic", [](const Residue& r) { return r.kind == ResidueKind::nucleotide; }},
    {"ligand organic", [](const Residue& r) { return r.kind == ResidueKind::other; }},
    {"water solvent", [](const Residue& r) { return r.kind == ResidueKind::water; }},
};
/// All other words, for suggestions.
constexpr const char* other_words[] = {
    "all",     "none",   "hydrogen", "backbone", "helix", "strand", "sheet",   "coil", "chain",
    "chainid", "resid",  "resi",     "resname",  "resn",  "name",   "element", "elem", "bfactor",
    "b",       "within", "around",   "byres",    "and",   "or",     "not"};

class Selection {
 public:
  Selection(const Molecule& molecule, std::string_view text,
            const std::function<const std::vector<Secondary>&()>& secondary)
      : molecule_(molecule), text_(text), words_(selection_words(text)), secondary_(secondary) {}

  Atoms atoms() {
    Atoms out = any();
    if (at_ < words_.size()) fail("'and', 'or' or the end is missing before this");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    const bool is_end = at_ >= words_.size();
    throw InputError(
        {"--show"},
        fmt::format("{}, column {}{}: {}", caplet::quoted(text_),
                    is_end ? text_.size() + 1 : words_[at_].column,
                    is_end ? "" : " (" + caplet::quoted(words_[at_].text) + ")", message));
  }
  bool is(std::string_view word) const {
    return at_ < words_.size() && lower_case(words_[at_].text) == word;
  }
  bool take(std::string_view word) {
    if (!is(word)) return false;
    ++at_;
    return true;
  }

  Atoms any() { return joined("or", &Selection::every, std::logical_or<>()); }
  Atoms every() { return joined("and", &Selection::one, std::logical_and<>()); }

  /// Reads operands with `word` between them.
  template <class Join>
  Atoms joined(std::string_view word, Atoms (Selection::*operand)(), const Join& join) {
    Atoms out = (this->*operand)();
    while (take(word)) {
      const Atoms other = (this->*operand)();
      std::transform(out.begin(), out.end(), other.begin(), out.begin(), join);
    }
    return out;
  }

  Atoms one() {
    constexpr std::size_t deepest = 100;
    if (++depth_ > deepest) fail(fmt::format("more than {} operations in each other", deepest));
    Atoms out = operand();
    --depth_;
    return out;
  }
  Atoms operand() {
    if (take("not")) {
      Atoms out = one();
      out.flip();
      return out;
    }
    if (take("byres")) return whole_residues(one());
    if (take("within")) {
      const float distance = length();
      if (!take("of")) fail("'of' and a selection are missing after the distance");
      return atoms_within(molecule_, one(), distance);
    }
    if (take("around")) {
      const float distance = length();
      const Atoms center = one();
      Atoms out = atoms_within(molecule_, center, distance);
      std::transform(out.begin(), out.end(), center.begin(), out.begin(),
                     [](bool near, bool is_center) { return near && !is_center; });
      return out;
    }
    if (take("(")) {
      Atoms out = any();
      if (!take(")")) fail("')' is missing");
      return out;
    }
    return primary();
  }

  float length() {
    const std::optional<float> out =
        at_ < words_.size() ? number_in<float>(words_[at_].text) : std::nullopt;
    // Larger distances than any molecule's would only overflow.
    if (!out || !(*out >= 0 && *out <= 1e6F)) fail("a distance in angstroms is missing");
    ++at_;
    return *out;
  }

  Atoms whole_residues(const Atoms& atoms) const {
    std::vector<bool> marked(molecule_.residues.size(), false);
    for (std::size_t i = 0; i < atoms.size(); ++i)
      if (atoms[i]) marked[molecule_.atoms[i].residue] = true;
    return by_atom([&](const Atom& atom, std::size_t) { return marked[atom.residue]; });
  }

  template <class Holds>
  Atoms by_atom(const Holds& holds) const {
    Atoms out(molecule_.atoms.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = holds(molecule_.atoms[i], i);
    return out;
  }
  template <class Holds>
  Atoms by_residue(const Holds& holds) const {
    std::vector<bool> held(molecule_.residues.size());
    for (std::size_t r = 0; r < held.size(); ++r) held[r] = holds(molecule_.residues[r], r);
    return by_atom([&](const Atom& atom, std::size_t) { return held[atom.residue]; });
  }

  Atoms primary() {
    for (const ResidueWord& row : residue_words)
      for (const std::string_view name : words_of(row.names))
        if (take(name))
          return by_residue([&](const Residue& r, std::size_t) { return row.holds(r); });
    if (take("all")) return Atoms(molecule_.atoms.size(), true);
    if (take("none")) return Atoms(molecule_.atoms.size(), false);
    if (take("hydrogen"))
      return by_atom([](const Atom& atom, std::size_t) { return atom.hydrogen(); });
    if (take("backbone")) return backbone();
    if (take("helix")) return of_secondary(Secondary::helix);
    if (take("strand") || take("sheet")) return of_secondary(Secondary::strand);
    if (take("coil")) return of_secondary(Secondary::coil);
    if (take("chain") || take("chainid")) {
      const std::vector<std::string> names = values();
      return by_residue([&](const Residue& r, std::size_t) {
        return std::ranges::find(names, molecule_.chains[r.chain]) != names.end();
      });
    }
    if (take("resname") || take("resn")) {
      const std::vector<std::string> names = values();
      return by_residue([&](const Residue& r, std::size_t) {
        return std::ranges::any_of(names, [&](const std::string& n) { return is_like(r.name, n); });
      });
    }
    if (take("resid") || take("resi")) return numbered();
    if (take("name")) {
      const std::vector<std::string> names = values();
      return by_atom([&](const Atom&, std::size_t i) {
        return !molecule_.atom_names.empty() &&
               std::ranges::any_of(names, [&](const std::string& n) {
                 return is_like(molecule_.atom_names[i], n);
               });
      });
    }
    if (take("element") || take("elem")) return of_elements();
    if (take("bfactor") || take("b")) return by_b_factor();
    fail_at_word();
  }

  [[noreturn]] void fail_at_word() const {
    if (at_ >= words_.size()) fail("a selection is missing here");
    std::vector<std::string> known(std::begin(other_words), std::end(other_words));
    for (const ResidueWord& row : residue_words)
      for (const std::string_view name : words_of(row.names)) known.emplace_back(name);
    fail(fmt::format("no word of a selection; the nearest is '{}'",
                     nearest_name(lower_case(words_[at_].text), known)));
  }

  /// Takes "A B", "A+B" or "A,B" up to an operator.
  std::vector<std::string> values() {
    std::vector<std::string> out;
    for (; at_ < words_.size() && !is("and") && !is("or") && !is(")"); ++at_) {
      std::string_view rest = words_[at_].text;
      while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_of("+,"), rest.size());
        if (end > 0) out.emplace_back(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
      }
    }
    if (out.empty()) fail("values are missing here");
    return out;
  }

  Atoms numbered() {
    const std::size_t first = at_;
    const std::vector<std::string> asked = values();
    std::vector<ResidueRange> ranges;
    std::vector<std::string> exact;  // with insertion codes: "33A"
    for (const std::string& text : asked) {
      if (const std::optional<ResidueRange> range = residue_range(text)) {
        ranges.push_back(*range);
      } else if (is_letter(text.back()) &&
                 number_in<int>(std::string_view(text).substr(0, text.size() - 1))) {
        exact.push_back(text);
      } else {
        at_ = first;
        fail(fmt::format("{} is no number of a residue nor a range, such as 10-20 or 33A",
                         caplet::quoted(text)));
      }
    }
    return by_residue([&](const Residue& residue, std::size_t) {
      if (std::ranges::find(exact, residue.number) != exact.end()) return true;
      int number = 0;
      const char* const begin = residue.number.data();
      if (std::from_chars(begin, begin + residue.number.size(), number).ec != std::errc())
        return false;
      return std::ranges::any_of(
          ranges, [&](const ResidueRange& r) { return r.low <= number && number <= r.high; });
    });
  }

  Atoms of_elements() {
    const std::size_t first = at_;
    std::array<bool, 256> asked{};
    for (const std::string& symbol : values()) {
      const std::uint8_t element = element_of(symbol);
      if (element == 0) {
        at_ = first;
        fail(caplet::quoted(symbol) + " is no element");
      }
      asked.at(element) = true;
    }
    return by_atom([&](const Atom& atom, std::size_t) { return asked.at(atom.element); });
  }

  Atoms backbone() const {
    constexpr const char* of_protein[] = {"N", "CA", "C", "O"};
    constexpr const char* of_nucleic[] = {"P", "OP1", "OP2", "O5'", "C5'", "C3'", "O3'"};
    return by_atom([&](const Atom& atom, std::size_t i) {
      if (molecule_.atom_names.empty()) return false;
      const auto is_in = [&](const auto& names) {
        return std::ranges::find(names, molecule_.atom_names[i]) != std::end(names);
      };
      const ResidueKind kind = molecule_.residues[atom.residue].kind;
      return kind == ResidueKind::amino_acid   ? is_in(of_protein)
             : kind == ResidueKind::nucleotide ? is_in(of_nucleic)
                                               : false;
    });
  }

  Atoms of_secondary(Secondary asked) const {
    const std::vector<Secondary>& secondary = secondary_();
    return by_residue([&](const Residue& residue, std::size_t r) {
      return residue.kind == ResidueKind::amino_acid && secondary[r] == asked;
    });
  }

  Atoms by_b_factor() {
    constexpr const char* signs[] = {"<", "<=", ">", ">=", "=", "==", "!="};
    const auto* const sign = std::ranges::find_if(signs, [this](const char* s) { return is(s); });
    if (sign == std::end(signs)) fail("one of < <= > >= = != is missing here");
    ++at_;
    const std::optional<float> limit =
        at_ < words_.size() ? number_in<float>(words_[at_].text) : std::nullopt;
    if (!limit) fail("a number is missing here");
    ++at_;
    const std::string_view is_sign = *sign;
    return by_atom([&](const Atom& atom, std::size_t) {
      const float b = atom.b_factor;
      return is_sign == "<"    ? b < *limit
             : is_sign == "<=" ? b <= *limit
             : is_sign == ">"  ? b > *limit
             : is_sign == ">=" ? b >= *limit
             : is_sign == "!=" ? b != *limit
                               : b == *limit;
    });
  }

  const Molecule& molecule_;
  std::string_view text_;
  std::vector<SelectionWord> words_;
  const std::function<const std::vector<Secondary>&()>& secondary_;
  std::size_t at_ = 0, depth_ = 0;
};

float square_length(const glm::vec3& v) { return glm::dot(v, v); }

/// Marked atoms in one cell of a grid whose cells are as wide as the distance.
struct MarkedCell {
  std::vector<std::uint32_t> atoms;
  glm::vec3 low{std::numeric_limits<float>::infinity()},
      high{-std::numeric_limits<float>::infinity()};
};

}  // namespace

std::vector<bool> selected_atoms(const Molecule& molecule, std::string_view text,
                                 const std::function<const std::vector<Secondary>&()>& secondary) {
  return Selection(molecule, text, secondary).atoms();
}

std::vector<bool> atoms_within(const Molecule& molecule, const std::vector<bool>& marked,
                               float distance) {
  // A thousandth more than the distance, so that rounding moves no atom two cells away; cells below
  // an angstrom would hold an atom each.
  const float width = std::max(1.001F * distance, 1.0F);
  constexpr int bits = 21, most = (1 << (bits - 1)) - 2;
  const auto cell_of = [&](const glm::vec3& p) {
    return glm::ivec3(glm::clamp(glm::floor(p / width), glm::vec3(-most), glm::vec3(most)));
  };
  const auto key_of = [&](const glm::ivec3& c) {
    const auto bits_of = [](int x) { return static_cast<std::uint64_t>(x + (1 << (bits - 1))); };
    return bits_of(c.x) << 2 * bits | bits_of(c.y) << bits | bits_of(c.z);
  };
  std::unordered_map<std::uint64_t, MarkedCell> cells;
  for (std::uint32_t i = 0; i < molecule.atoms.size(); ++i) {
    if (!marked[i]) continue;
    const glm::vec3& p = molecule.atoms[i].position;
    MarkedCell& cell = cells[key_of(cell_of(p))];
    cell.atoms.push_back(i);
    cell.low = glm::min(cell.low, p);
    cell.high = glm::max(cell.high, p);
  }
  const float square = distance * distance;
  const auto is_near = [&](const glm::vec3& p, const MarkedCell& cell) {
    const glm::vec3 nearest = glm::clamp(p, cell.low, cell.high) - p;
    if (square_length(nearest) > square) return false;
    return std::ranges::any_of(cell.atoms, [&](std::uint32_t i) {
      return square_length(molecule.atoms[i].position - p) <= square;
    });
  };
  std::vector<bool> out(molecule.atoms.size(), false);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const glm::vec3& p = molecule.atoms[i].position;
    const glm::ivec3 own = cell_of(p);
    for (int k = 0; k < 27 && !out[i]; ++k) {
      const auto found = cells.find(key_of(own + glm::ivec3(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1)));
      if (found != cells.end()) out[i] = is_near(p, found->second);
    }
  }
  return out;
}

}  // namespace caplet
