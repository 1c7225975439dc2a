// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Overlays by name, as people ask for them (overlays.def).
#pragma once

#include <string>
#include <vector>

#include "post/overlay.h"

namespace caplet::post {

struct OverlayRow {
  std::string name, values, help;  // values: what may be said beside the name; empty of a switch
};

const std::vector<OverlayRow>& overlay_rows();

/// Asks for the overlay of that name; an empty `value` is the usual one. Throws InputError naming `flag` for a value that it
/// cannot have, and without a place for a name that there is none of.
void set_overlay(Overlays& overlays, const std::string& name, const std::string& value, const std::string& flag);

}  // namespace caplet::post
