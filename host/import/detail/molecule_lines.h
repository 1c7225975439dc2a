// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The readers of molecules line by line share these: MDL's files (sdf.cpp) and XYZ (xyz.cpp).
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/molecule.h"
#include "import/detail/text_file.h"

namespace caplet {

class MoleculeLines {
 protected:
  /// `missing` is the error when a line is wanted behind the end of the file.
  MoleculeLines(std::string_view text, const std::string& path, const char* missing)
      : text_(text), path_(path), missing_(missing) {
    if (text_.starts_with("\xef\xbb\xbf")) text_.remove_prefix(3);
  }

  [[noreturn]] void fail(std::size_t column, const std::string& message) const {
    throw InputError({path_, line_, static_cast<int>(column)}, message);
  }

  std::string_view line() {
    ++line_;
    if (text_.empty()) fail(0, missing_);
    return take_line(text_);
  }

  /// Returns an atom at the place, numbered as the next one.
  Atom next_atom(const glm::vec3& position, std::string_view symbol) const {
    Atom atom;
    atom.position = position;
    atom.element = element_of(symbol);
    atom.serial = static_cast<std::int32_t>(out_.atoms.size()) + 1;
    return atom;
  }
  void add(const Atom& atom) {
    out_.atoms.push_back(atom);
    in_file_.prove();
  }

  /// Puts all atoms into one residue of one chain.
  void close_residue() {
    out_.chains = {""};
    Residue all;
    all.atom_count = static_cast<std::uint32_t>(out_.atoms.size());
    out_.residues.push_back(all);
  }

  std::string_view text_;  // what is not read yet
  const std::string& path_;
  int line_ = 0;
  Molecule out_;

 private:
  const char* missing_;
  Unproven in_file_;
};

}  // namespace caplet
