// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PQR: PDB's atoms with charge and radius in place of occupancy and B factor, its fields between
// blanks (apbs.readthedocs.io/en/latest/formats/pqr.html).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <gemmi/model.hpp>
#include <gemmi/resinfo.hpp>
#include <type_traits>

#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/gemmi_structure.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

/// Models have a name in gemmi 0.5 and 0.6, and a number since 0.7.
template <class Model>
Model first_model() {
  if constexpr (std::is_constructible_v<Model, int>)
    return Model(1);
  else
    return Model("1");
}

/// Returns the element of an atom, which PQR does not state: that of an ion named as its residue;
/// a symbol of two letters that is no name of another atom in PDB; else the first letter.
gemmi::Element element_of_name(const std::string& name, const std::string& residue) {
  std::string letters;
  for (const char c : name)
    if (std::isalpha(static_cast<unsigned char>(c)) != 0)
      letters += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    else if (!letters.empty())
      break;
  constexpr std::array whole = {"AL", "BR", "CL", "CU", "FE", "MG", "MN", "SE", "SI", "ZN"};
  const std::string two = letters.substr(0, 2);
  const bool is_ion = letters == residue && gemmi::find_element(letters.c_str()) != gemmi::El::X;
  if (is_ion || std::ranges::find(whole, two) != whole.end()) return gemmi::Element(two);
  return gemmi::Element(letters.substr(0, 1));
}

class PqrReader {
 public:
  PqrReader(std::string_view text, const std::string& path, const ImportOptions& options)
      : text_(text), path_(path), options_(options) {}

  Molecule read() {
    structure_.models.push_back(first_model<gemmi::Model>());
    while (!text_.empty()) {
      const std::string_view line = take_line(text_);
      ++line_;
      if (line.starts_with("ATOM") || line.starts_with("HETATM")) add_atom(words_of(line));
    }
    Molecule out = molecule_of(structure_, path_, options_, {});
    out.has_charges = true;
    for (Atom& atom : out.atoms) {
      const auto number = static_cast<std::size_t>(atom.serial) - 1;
      atom.charge = charges_[number];
      atom.radius = radii_[number];
    }
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({path_, line_, 0}, message);
  }

  float number(std::string_view word) const {
    float out = 0;
    const NumberError error = parse_float(word, out);
    if (error != NumberError::none) fail(describe(error, word));
    return out;
  }

  gemmi::SeqId residue_number(std::string_view word) const {
    const char code = word.empty() || std::isdigit(static_cast<unsigned char>(word.back())) != 0
                          ? ' '
                          : word.back();
    int value = 0;
    if (!parse_number(code == ' ' ? word : word.substr(0, word.size() - 1), value))
      fail(caplet::quoted(word) + " is no number of a residue");
    return {value, code};
  }

  void add_atom(const std::vector<std::string_view>& words) {
    if (words.size() != 10 && words.size() != 11)
      fail(
          fmt::format("{} fields: an atom has 10, or 11 with a chain: ATOM, number, name, residue, "
                      "chain, residue's number, x, y, z, charge and radius",
                      words.size()));
    const std::size_t at = words.size() - 6;
    const gemmi::SeqId number_in_chain = residue_number(words[at]);
    gemmi::Atom atom;
    atom.name = std::string(words[2]);
    const std::string residue(words[3]);
    atom.element = element_of_name(atom.name, residue);
    atom.pos = {number(words[at + 1]), number(words[at + 2]), number(words[at + 3])};
    charges_.push_back(number(words[at + 4]));
    radii_.push_back(number(words[at + 5]));
    if (radii_.back() < 0) fail("the radius is negative");
    atom.serial = static_cast<int>(radii_.size());
    add_to(words.size() == 11 ? std::string(words[4]) : std::string(),
           {number_in_chain, "", residue}, std::move(atom));
    in_file_.prove();
  }

  void add_to(const std::string& chain, const gemmi::ResidueId& id, gemmi::Atom atom) {
    std::vector<gemmi::Chain>& chains = structure_.models[0].chains;
    if (chains.empty() || chains.back().name != chain) chains.emplace_back(chain);
    std::vector<gemmi::Residue>& residues = chains.back().residues;
    if (residues.empty() || residues.back().seqid != id.seqid || residues.back().name != id.name)
      residues.emplace_back(id);
    residues.back().atoms.push_back(std::move(atom));
  }

  std::string_view text_;
  const std::string& path_;
  const ImportOptions& options_;
  int line_ = 0;
  gemmi::Structure structure_;
  std::vector<float> charges_, radii_;  // of all atoms of the file
  Unproven in_file_;
};

}  // namespace

Molecule read_pqr(std::string_view text, const std::string& path, const ImportOptions& options) {
  return PqrReader(text, path, options).read();
}

}  // namespace caplet
