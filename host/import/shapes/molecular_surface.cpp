// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <utility>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

/// Reads one positive radius a ball, or one for all; none where they are missing or wrong
/// (reported).
std::vector<float> radii(Parameters& parameters, std::size_t count) {
  const Parameter* given = parameters.values("radius", {"float"});
  if (!given) return {};
  std::vector<float> out;
  out.reserve(given->numbers.size());
  for (const double value : given->numbers) {
    out.push_back(to_float(parameters, "radius", value));
    if (out.back() > 0) continue;
    parameters.error("radius", "must be positive");
    return {};
  }
  if (out.size() == 1) out.resize(count, out[0]);
  if (out.size() == count || count == 0) return out;
  parameters.error("radius", "has " + std::to_string(out.size()) + " values for " +
                                 std::to_string(count) + " balls");
  return {};
}

}  // namespace

MolecularSurfaceShape make_molecular_surface(Parameters& parameters,
                                             const MaterialIndex& material_index) {
  for (const char* name : {"P", "radius"})
    if (!parameters.has(name)) parameters.error("\"" + std::string(name) + "\" is missing");
  std::vector<glm::vec3> centers = vectors3(parameters, parameters.values("P", {"point3"}));
  std::vector<float> balls = radii(parameters, centers.size());
  const double probe = positive_length(parameters, "probe", 1.4);
  std::vector<std::uint32_t> materials =
      listed_materials(parameters, "ballmaterials", material_index, centers.size(), "balls");
  if (centers.empty() || balls.size() != centers.size()) return {};
  try {
    return make_molecule(std::move(centers), std::move(balls), probe, std::move(materials));
  } catch (const InputError& error) {
    parameters.error("probe", error.what());
    return {};
  }
}

}  // namespace caplet::pbrt
