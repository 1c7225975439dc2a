// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// SWC neurons (Cannon et al. 1998, doi:10.1016/S0165-0270(98)00091-0): samples with a radius and a
// parent each. Conventions: docs/formats/swc.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "import/detail/swc_sample.h"

namespace caplet {

/// Parses the text of an SWC file and links parents. Radii are as written, 0 included. `name` is
/// the file's name in messages. Throws InputError with file:line:column (up to 20 at once): wrong
/// columns, non-numbers, non-finite or negative values, repeated ids, missing parents,
/// self-parents, cycles, no samples.
std::vector<SwcSample> parse_swc(std::string_view text, const std::string& name);

}  // namespace caplet
