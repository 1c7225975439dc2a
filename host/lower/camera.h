// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts the scene's camera and film window to CameraRecord and the image fields of the uniforms.
#pragma once

#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// Fills out.camera and view.width, height and crop_*. The field of view is that of the shorter
/// side of the frame (its aspect is frame_aspect_ratio if given, else that of the image), or that
/// of a screen window's unit. The scene must have passed validate().
void lower_camera(const Scene& scene, FlatView& out);

/// Returns the ray through the middle of pixel (x, y) of the full image, from the top left, and the
/// middle of the lens: world space, unit direction, t in (0, infinity), but only on this side of a
/// clipping plane. It is the ray of kernels/stages/generate.cl, up to rounding.
RayRecord ray_of_pixel(const Scene& scene, int x, int y);

}  // namespace caplet
