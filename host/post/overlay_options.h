// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Overlays of written pictures by name: --NAME in the program, the same names in the library and in
// Python (docs/pictures.md).
#pragma once

#include <string>
#include <vector>

#include "post/overlay.h"

namespace caplet::post {

struct OverlayRow {
  std::string name, values, help;  // values: the allowed values; empty for a switch
  bool is_list = false;            // several values may be given, as lines of one text
};

const std::vector<OverlayRow>& overlay_rows();

/// Turns on the overlay of that name; an empty `value` is the default. Throws InputError that names
/// `flag` for an invalid value, and without a place for an unknown name.
void set_overlay(Overlays& overlays, const std::string& name, const std::string& value,
                 const std::string& flag);

}  // namespace caplet::post
