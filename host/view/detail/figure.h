// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Figures: pictures that pages ask for, with sizes and overlays of their own.
#pragma once

#include <functional>
#include <string>

#include "device/device.h"
#include "scene/scene.h"
#include "view/messages.h"

namespace caplet::view {

/// Renders a figure of the scene, which is seen with `own` but for the figure's look, in a session
/// of its own, as `caplet render` would: branches have the film's least width. Returns the bytes of
/// a PNG file; none where `goes_on`, which is told the share of the samples that is done, returned
/// false. Throws InputError for what the scene cannot have, and RunError.
std::string figure_png(Scene scene, const View& own, const MakeFigure& asked, const Device& device,
                       const std::function<bool(double share)>& goes_on);

}  // namespace caplet::view
