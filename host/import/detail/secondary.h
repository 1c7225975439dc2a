// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Secondary structure: which residues of a molecule are in helices and strands.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "import/detail/molecule.h"

namespace caplet {

/// The backbone of an amino acid: indices into Molecule::atoms, -1 for an atom that is not there.
struct Backbone {
  std::int64_t n = -1, ca = -1, c = -1, o = -1;
  bool complete() const { return n >= 0 && ca >= 0 && c >= 0 && o >= 0; }
};
/// Returns the first of a residue's atoms of each name.
Backbone backbone_of(const Molecule& molecule, const Residue& residue);

/// Residues from one to another of a chain, by their numbers and insertion codes (' ': none).
struct SecondaryRange {
  Secondary kind = Secondary::coil;
  std::string chain;
  std::array<std::int32_t, 2> number{};
  std::array<char, 2> code{' ', ' '};
};

/// Gives the amino acids of the ranges their kind. `numbers` and `codes` are those of the residues,
/// which lie in the file's order. Ends that no residue has are passed over; a residue in ranges of
/// both kinds is in a helix.
void state_secondary(Molecule& molecule, const std::vector<std::int32_t>& numbers,
                     std::string_view codes, const std::vector<SecondaryRange>& ranges);

/// The states of the dictionary of protein secondary structure: H alpha helix, G 3-10 helix, I pi
/// helix, E strand, B isolated bridge, ' ' other.
using DsspStates = std::string;

/// Assigns secondary structure by hydrogen bonds, one state a residue, as Kabsch and Sander 1983
/// (Biopolymers 22, 2577-2637, doi:10.1002/bip.360221211) define it. Residues that are no amino
/// acids, or lack one of N, CA, C and O, are ' ' and break the chain. Takes time in proportion to
/// the residues. If more than 256 alpha carbons share a cell of 9 angstroms, it warns and all are
/// ' '; `path` is for this message.
DsspStates dssp_states(const Molecule& molecule, const std::string& path);

/// Returns each residue's part in the secondary structure: by the file's records or by hydrogen
/// bonds, where H, G and I are helices and E is a strand.
std::vector<Secondary> secondary_of(const Molecule& molecule, bool by_file,
                                    const std::string& path);

}  // namespace caplet
