// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/shapes/molecule.h"

#include <utility>

namespace caplet {

namespace {

/// Returns what is wrong with the balls, or null.
const char* fault_of(const MolecularSurfaceShape& molecule) {
  if (molecule.radii.size() != molecule.centers.size())
    return "the molecular surface has another number of radii than of balls";
  for (const glm::vec3& center : molecule.centers)
    if (!is_finite(center)) return "a ball's centre is not finite";
  for (const float radius : molecule.radii)
    if (!(radius > 0 && std::isfinite(radius))) return "the balls' radii must be positive";
  if (!(static_cast<float>(molecule.probe) > 0 && std::isfinite(molecule.probe)))
    return "the probe's radius must be positive";
  return nullptr;
}

}  // namespace

MolecularSurfaceShape make_molecule(std::vector<glm::vec3> centers, std::vector<float> radii,
                                    double probe, std::vector<std::uint32_t> materials) {
  MolecularSurfaceShape out{std::move(centers), std::move(radii), probe, std::move(materials)};
  if (!fault_of(out))
    out.patches =
        std::make_shared<SurfacePatches>(molecular_surface(out.centers, out.radii, probe));
  return out;
}

Bounds bounds_under(const MolecularSurfaceShape& molecule, const glm::dmat4& m) {
  Bounds bounds;
  const glm::dvec3 unit = row_lengths(glm::dmat3(m));
  for (std::size_t i = 0; i < molecule.centers.size(); ++i)
    extend_box(bounds, transformed(m, glm::dvec3(molecule.centers[i])),
               static_cast<double>(molecule.radii[i]) * unit);
  return bounds;
}

void check(const MolecularSurfaceShape& molecule, ShapeCheck& report) {
  if (const char* fault = fault_of(molecule)) return report.error(fault);
  if (!molecule.materials.empty() && molecule.materials.size() != molecule.centers.size())
    report.error("the molecular surface has another number of materials than of balls");
  for (const std::uint32_t material : molecule.materials)
    if (material >= report.materials())
      return report.error("a ball has the material " + std::to_string(material) +
                          ", but there are " + std::to_string(report.materials()));
}

MolecularSurfaceShape drawn(std::type_identity<MolecularSurfaceShape>, Draws& draws) {
  std::vector<glm::vec3> centers;
  std::vector<float> radii;
  for (std::size_t i = 0, count = 2 + draws.below(4); i < count; ++i) {
    centers.push_back(0.6f * draws.point());
    radii.push_back(static_cast<float>(draws.uniform(0.15, 0.5)));
  }
  return make_molecule(std::move(centers), std::move(radii), draws.uniform(0.1, 0.8));
}

}  // namespace caplet
