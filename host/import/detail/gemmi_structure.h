// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string>
#include <vector>

#include "import/detail/molecule.h"
#include "import/detail/secondary.h"

namespace gemmi {
struct Structure;
}

namespace caplet {

/// Returns what the options keep of a structure. `secondary`: the file's helices and strands;
/// `path` is for messages. Throws InputError.
Molecule molecule_of(gemmi::Structure& structure, const std::string& path,
                     const ImportOptions& options, std::vector<SecondaryRange> secondary);

}  // namespace caplet
