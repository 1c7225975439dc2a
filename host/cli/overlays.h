// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The options of overlays on pictures.
#pragma once

#include <CLI/App.hpp>

#include "post/overlay.h"

namespace caplet::cli {

/// Adds an option for each row of post::overlay_rows(); its values are stored in `overlays`.
void add_overlays(CLI::App& command, post::Overlays& overlays);

}  // namespace caplet::cli
