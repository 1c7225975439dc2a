// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/atom_values.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "base/error.h"
#include "base/quotes.h"
#include "import/detail/selection.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

/// A k-d tree (Bentley 1975): the middle point of each range splits the others along the axis.
class NearestPoints {
 public:
  explicit NearestPoints(std::vector<glm::vec3> points) : points_(std::move(points)) {
    sort(points_, 0);
  }

  float distance_from(const glm::vec3& p) const {
    double least = HUGE_VAL;
    search(points_, 0, p, least);
    return static_cast<float>(std::sqrt(least));
  }

 private:
  static void sort(std::span<glm::vec3> points, int axis) {
    if (points.size() < 2) return;
    const std::size_t middle = points.size() / 2;
    std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle),
                     points.end(),
                     [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    sort(points.first(middle), (axis + 1) % 3);
    sort(points.subspan(middle + 1), (axis + 1) % 3);
  }

  static void search(std::span<const glm::vec3> points, int axis, const glm::vec3& p,
                     double& least) {
    if (points.empty()) return;
    const std::size_t middle = points.size() / 2;
    const glm::dvec3 away = glm::dvec3(p) - glm::dvec3(points[middle]);
    least = std::min(least, glm::dot(away, away));
    const auto below = points.first(middle), above = points.subspan(middle + 1);
    search(away[axis] < 0 ? below : above, (axis + 1) % 3, p, least);
    if (away[axis] * away[axis] < least)
      search(away[axis] < 0 ? above : below, (axis + 1) % 3, p, least);
  }

  std::vector<glm::vec3> points_;
};

std::vector<float> distances(const Molecule& molecule, const std::vector<bool>& from) {
  std::vector<glm::vec3> marked;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i]) marked.push_back(molecule.atoms[i].position);
  const NearestPoints points(std::move(marked));
  std::vector<float> out(molecule.atoms.size());
  tbb::parallel_for(std::size_t{0}, out.size(), [&](std::size_t i) {
    out[i] = points.distance_from(molecule.atoms[i].position);
  });
  return out;
}

std::vector<float> of_atoms(const Molecule& molecule, float Atom::*value) {
  std::vector<float> out;
  out.reserve(molecule.atoms.size());
  for (const Atom& atom : molecule.atoms) out.push_back(atom.*value);
  return out;
}

}  // namespace

float AtomValues::part(std::size_t atom) const {
  if (!(high > low)) return 0.5F;
  return static_cast<float>(
      std::clamp((static_cast<double>(of[atom]) - low) / (high - low), 0.0, 1.0));
}

bool shows_values(MoleculeColor by) {
  return by == MoleculeColor::bfactor || by == MoleculeColor::charge ||
         by == MoleculeColor::distance;
}

AtomValues atom_values(const Molecule& molecule, const Representation& as,
                       const ImportOptions& options,
                       const std::function<const std::vector<Secondary>&()>& secondary) {
  AtomValues out;
  if (!shows_values(as.by)) return out;
  if (as.by == MoleculeColor::bfactor) {
    out = {"bfactor", "B factor", "\u00c5\u00b2", of_atoms(molecule, &Atom::b_factor)};
  } else if (as.by == MoleculeColor::charge) {
    out = {"charge", "Charge", "e", of_atoms(molecule, &Atom::charge)};
    out.map = red_white_blue;
    out.steps = map_steps + 1;  // an odd number, so that 0 is white
  } else {
    const std::vector<bool> from = selected_atoms(molecule, as.from, secondary);
    if (std::ranges::find(from, true) == from.end())
      throw InputError({as.option},
                       "distance from " + caplet::quoted(as.from) + ": it selects no atoms");
    out = {"distance", "Distance", "\u00c5", distances(molecule, from)};
  }
  const auto [low, high] = std::ranges::minmax(out.of);
  out.low = static_cast<double>(low);
  out.high = static_cast<double>(high);
  if (as.by == MoleculeColor::charge) {
    out.high = std::max(std::abs(out.low), std::abs(out.high));
    out.low = -out.high;
  }
  if (const auto asked = options.range("range")) std::tie(out.low, out.high) = *asked;
  return out;
}

}  // namespace caplet
