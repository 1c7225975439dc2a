// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts shapes of the scene to geometry records, primitives and trees.
#pragma once

#include "lower/detail/images.h"
#include "lower/detail/subtrees.h"
#include "lower/flat_scene.h"
#include "lower/linking.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// Fills nodes, leaves, instances, geometries, primitive_geometry, mesh_*, world.root and the
/// bounding sphere, and returns what edits need. A shape whose transform its kernel form cannot
/// hold (an ellipsoid, a sheared capsule) becomes an instance of its own tree, shared by all shapes
/// under the same transform.
LoweredGeometry lower_geometry(const Scene& scene, const ImageNumbers& images,
                               SpectrumTable& spectra, const Linking& linking, FlatScene& out);

}  // namespace caplet
