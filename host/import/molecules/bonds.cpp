// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "base/error.h"
#include "base/log.h"
#include "import/detail/cell_grid.h"
#include "import/detail/molecule.h"

namespace caplet {

namespace {

constexpr float kTolerance = 0.45F, kTooClose = 0.4F;
constexpr std::size_t kMostInACell = 256;

/// Adds the bonds of residues whose component is known, and marks those residues.
void add_component_bonds(const Molecule& molecule, std::vector<bool>& known,
                         std::vector<Bond>& out) {
  if (molecule.components.empty() || molecule.atom_names.empty()) return;
  for (std::size_t r = 0; r < molecule.residues.size(); ++r) {
    const Residue& residue = molecule.residues[r];
    const auto component = molecule.components.find(residue.name);
    if (component == molecule.components.end()) continue;
    known[r] = true;
    std::unordered_multimap<std::string, std::uint32_t> by_name;
    for (std::uint32_t i = residue.first_atom; i < residue.first_atom + residue.atom_count; ++i)
      by_name.emplace(molecule.atom_names[i], i);
    for (const auto& [name_a, name_b] : component->second) {
      const auto [a_begin, a_end] = by_name.equal_range(name_a);
      const auto [b_begin, b_end] = by_name.equal_range(name_b);
      for (auto a = a_begin; a != a_end; ++a)
        for (auto b = b_begin; b != b_end; ++b) {
          const char at_a = molecule.atoms[a->second].altloc,
                     at_b = molecule.atoms[b->second].altloc;
          if (a->second != b->second && (at_a == '\0' || at_b == '\0' || at_a == at_b))
            out.emplace_back(std::min(a->second, b->second), std::max(a->second, b->second));
        }
    }
  }
}

}  // namespace

std::vector<Bond> all_bonds(const Molecule& molecule, const std::string& path) {
  std::vector<Bond> out = molecule.bonds;
  std::vector<bool> known(molecule.residues.size(), false);
  add_component_bonds(molecule, known, out);
  if (!molecule.bonds_are_complete && !molecule.atoms.empty()) {
    const std::vector<Atom>& atoms = molecule.atoms;
    float widest = 0;
    std::array<float, 256> radius{};
    for (const Atom& atom : atoms)
      widest = std::max(widest, radius.at(atom.element) = covalent_radius(atom.element));
    std::vector<glm::vec3> places;
    places.reserve(atoms.size());
    for (const Atom& atom : atoms) places.push_back(atom.position);
    const CellGrid grid(places, 2 * widest + kTolerance);
    if (grid.fullest() > kMostInACell) {
      log::warn(
          "{}: {} atoms within {:.1f} angstroms of each other: no bonds are found by distance (is "
          "the unit of length another?)",
          path, grid.fullest(), 2 * widest + kTolerance);
    } else {
      grid.pairs([&](std::uint32_t i, std::uint32_t j) {
        const Atom &a = atoms[i], &b = atoms[j];
        if (a.hydrogen() && b.hydrogen()) return;
        if (a.altloc != '\0' && b.altloc != '\0' && a.altloc != b.altloc) return;
        if (a.residue == b.residue && known[a.residue]) return;
        const glm::vec3 d = a.position - b.position;
        const float square = d.x * d.x + d.y * d.y + d.z * d.z,
                    reach = radius.at(a.element) + radius.at(b.element) + kTolerance;
        if (square < reach * reach && square > kTooClose * kTooClose)
          out.emplace_back(std::min(i, j), std::max(i, j));
      });
    }
  }
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace caplet
