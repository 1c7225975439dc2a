// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lists the parameters that cameras of some projections have beside Camera::fields.
#pragma once

#include <array>

#include "scene/field.h"

namespace caplet {

/// The names of Projection's alternatives in scene files, in their order.
inline constexpr std::array projection_names = {"perspective", "orthographic", "spherical"};

inline constexpr Field fov_field = {
    "fov", "field of view of the picture's shorter side", 0, 180, "degrees", true};
inline constexpr Field frame_aspect_ratio_field = {
    "frameaspectratio",
    "width over height of what the camera sees; else that of the picture",
    0,
    no_limit,
    "",
    true};

}  // namespace caplet
