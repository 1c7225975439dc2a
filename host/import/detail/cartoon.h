// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Cartoons of molecules: ribbons of proteins, tubes and slabs of nucleic acids.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "import/detail/molecule.h"
#include "scene/shape.h"

namespace caplet {

/// Returns the atom that a cartoon's curve goes by: the alpha carbon of an amino acid; of a
/// nucleotide the phosphorus, or else O5', C4' or C1'. -1 for other residues and without it.
std::int64_t guide_atom(const Molecule& molecule, const Residue& residue);

/// Draws the amino acids and nucleotides that `kept` marks. The shapes of a residue have its name
/// ("chain A LYS 33"): of an amino acid a mesh, of a nucleotide capsules and a box. `secondary` has
/// a value for each residue, `material` returns the material of a guide atom. A chain has a gap
/// where guide atoms are more than 4.6 angstroms (amino acids) or 9 apart, as in the style trace;
/// an amino acid between two gaps is a ball. Curves are cut the more coarsely the more residues the
/// molecule has, times the `copies` of it that are placed.
std::vector<Shape> cartoon_shapes(const Molecule& molecule, const std::vector<Secondary>& secondary,
                                  const std::vector<bool>& kept,
                                  const std::function<std::uint32_t(const Atom&)>& material,
                                  const std::string& path, std::size_t copies = 1);

}  // namespace caplet
