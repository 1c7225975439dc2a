// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Numbers of atoms that colours show.
#pragma once

#include <functional>
#include <vector>

#include "import/color_map.h"
#include "import/detail/molecule.h"
#include "import/detail/representation.h"
#include "import/detail/secondary.h"

namespace caplet {

struct AtomValues {
  const char *name = "", *title = "", *unit = "";  // the name that materials have
  std::vector<float> of;                           // for each atom
  double low = 0, high = 0;                        // the ends of the map
  ColorMap map = viridis;
  int steps = map_steps;  // of the map

  /// Returns an atom's place in the range, 0 to 1.
  float part(std::size_t atom) const;
};

/// Returns whether the colours show numbers.
bool shows_values(MoleculeColor by);

/// Returns the numbers that the representation's colours show. The range is that of --range, else
/// that of all atoms; of charges its middle is 0. `secondary` is as selected_atoms takes it. Throws
/// InputError where no atom is selected to measure distances from.
AtomValues atom_values(const Molecule& molecule, const Representation& as,
                       const ImportOptions& options,
                       const std::function<const std::vector<Secondary>&()>& secondary);

}  // namespace caplet
