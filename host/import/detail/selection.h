// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Atoms chosen by words that PyMOL and MDAnalysis share (docs/formats/molecules.md).
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "import/detail/molecule.h"

namespace caplet {

/// Returns for each atom whether the selection holds it. `secondary` returns each residue's part in
/// the secondary structure, and is called only if the selection asks for it. Throws InputError that
/// names --show and the column within `text`.
std::vector<bool> selected_atoms(const Molecule& molecule, std::string_view text,
                                 const std::function<const std::vector<Secondary>&()>& secondary);

/// Returns for each atom whether it is within `distance` (angstroms) of a marked one.
std::vector<bool> atoms_within(const Molecule& molecule, const std::vector<bool>& marked,
                               float distance);

}  // namespace caplet
