// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The options of what is drawn on a picture.
#pragma once

#include <CLI/App.hpp>

#include "post/overlay.h"

namespace caplet::cli {

/// Adds an option for each row of post/overlays.def; what they say goes into `overlays`.
void add_overlays(CLI::App& command, post::Overlays& overlays);

}  // namespace caplet::cli
