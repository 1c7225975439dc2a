// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// How parts of a molecule are drawn: the options style, color and show.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "import/import_options.h"

namespace caplet {

enum class MoleculeStyle { ball_and_stick, spheres, sticks, trace, cartoon, surface, accessible };
enum class MoleculeColor { element, chain, residue, bfactor, secondary, charge, distance, fixed };

struct Representation {
  std::string selection = "all";  // as selected_atoms takes it
  MoleculeStyle style = MoleculeStyle::ball_and_stick;
  MoleculeColor by = MoleculeColor::element;
  glm::dvec3 color{0};            // linear sRGB, for MoleculeColor::fixed
  std::string from;               // for MoleculeColor::distance: from which atoms, as `selection`
  double opacity = 1;             // 0 to 1
  float probe = 1.4F;             // radius, for surfaces; angstroms
  const char* option = "--show";  // what asked for it, for errors
};

/// Returns what `show` lists, "SELECTION: STYLE [by COLOR] [opacity X]" between semicolons or on
/// lines; without it, all atoms as `style` and `color` say. `automatic` is the style if none is
/// given; `color` is that of representations without `by`, else it depends on their style. Throws
/// InputError.
std::vector<Representation> asked_representations(const ImportOptions& options,
                                                  MoleculeStyle automatic);

}  // namespace caplet
