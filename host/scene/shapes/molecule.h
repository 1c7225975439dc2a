// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <memory>
#include <vector>

#include "scene/shapes/family.h"
#include "scene/shapes/molecular_surface.h"

namespace caplet {

/// The solvent-excluded surface of balls. Its primitives are the patches: those of spheres, then
/// those of tori. It is closed, and its normals point out of the molecule.
struct MolecularSurfaceShape {
  std::vector<glm::vec3> centers;
  std::vector<float> radii;
  double probe = 1.4;                    // the radius
  std::vector<std::uint32_t> materials;  // empty, or one a ball
  /// Those of molecular_surface; never null.
  std::shared_ptr<const SurfacePatches> patches = std::make_shared<SurfacePatches>();
};

/// Computes the patches. Nothing is computed, so that there is no patch, where `check` finds errors
/// in the balls. Throws InputError as molecular_surface does.
MolecularSurfaceShape make_molecule(std::vector<glm::vec3> centers, std::vector<float> radii,
                                    double probe, std::vector<std::uint32_t> materials = {});

inline std::size_t count_of(const MolecularSurfaceShape& molecule) {
  return molecule.patches->balls.size() + molecule.patches->tori.size();
}
/// Returns the ball that a patch is nearest to.
inline std::uint32_t ball_of_patch(const MolecularSurfaceShape& molecule, std::size_t patch) {
  const SurfacePatches& all = *molecule.patches;
  return patch < all.balls.size() ? all.balls[patch].ball : all.tori[patch - all.balls.size()].ball;
}
inline std::size_t surfaces_of(const MolecularSurfaceShape&) { return 1; }
inline bool closed(const MolecularSurfaceShape&) { return false; }
inline Beyond beyond(const MolecularSurfaceShape&, const glm::dvec3&) { return unknown; }
/// The surface lies within the convex hull of the balls, as a probe can be anywhere outside of it.
Bounds bounds_under(const MolecularSurfaceShape& molecule, const glm::dmat4& m);
void check(const MolecularSurfaceShape& molecule, ShapeCheck& report);
MolecularSurfaceShape drawn(std::type_identity<MolecularSurfaceShape>, Draws& draws);

}  // namespace caplet
