// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lowering is a lowered scene, with everything that is known of it beside the flat arrays.
#pragma once

#include "lower/detail/geometry.h"
#include "lower/detail/light_images.h"
#include "lower/detail/lights.h"
#include "lower/flat_scene.h"
#include "lower/linking.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// It refers to the shapes of the scene, which must stay where they are. Its subtrees refer to each
/// other, so it stays where it is.
struct Lowering {
  /// Lowers the scene. Throws as lower() does.
  explicit Lowering(const Scene& scene, const Linking& linking = {});
  Lowering(const Lowering&) = delete;
  Lowering& operator=(const Lowering&) = delete;

  FlatScene flat;
  ImageNumbers images;
  SpectrumTable spectra;
  LoweredGeometry geometry;
  LightImages light_images;
};

}  // namespace caplet
