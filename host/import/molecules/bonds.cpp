// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/error.h"
#include "base/log.h"
#include "import/detail/molecule.h"

namespace caplet {

namespace {

constexpr float kTolerance = 0.45F, kTooClose = 0.4F;
constexpr std::size_t kMostInACell = 256;
constexpr std::int64_t kMostCells = 1 << 20;  // along an axis: atoms that lie further out share a
                                              // cell, and are compared like all other atoms

struct Cell {
  std::uint64_t key = 0;
  std::uint32_t begin = 0, end = 0;  // a range of `order`
};

/// Cells of one size, sorted by their keys: by x, then y, then z.
class Grid {
 public:
  Grid(const std::vector<Atom>& atoms, float size) {
    glm::vec3 low(std::numeric_limits<float>::infinity());
    for (const Atom& atom : atoms) low = glm::min(low, atom.position);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(atoms.size());
    for (std::uint32_t i = 0; i < atoms.size(); ++i) {
      std::array<std::int64_t, 3> at{};
      for (int axis = 0; axis < 3; ++axis)
        at.at(static_cast<std::size_t>(axis)) =
            std::min(static_cast<std::int64_t>((atoms[i].position[axis] - low[axis]) / size),
                     kMostCells) +
            1;
      keys[i] = {key_of(at[0], at[1], at[2]), i};
    }
    std::ranges::sort(keys);
    order.reserve(keys.size());
    for (const auto& [key, atom] : keys) {
      if (cells.empty() || cells.back().key != key)
        cells.push_back({key, static_cast<std::uint32_t>(order.size()),
                         static_cast<std::uint32_t>(order.size())});
      order.push_back(atom);
      ++cells.back().end;
    }
  }

  static std::uint64_t key_of(std::int64_t x, std::int64_t y, std::int64_t z) {
    constexpr int bits = 21;
    return static_cast<std::uint64_t>(x) << 2 * bits | static_cast<std::uint64_t>(y) << bits |
           static_cast<std::uint64_t>(z);
  }

  std::size_t fullest() const {
    std::size_t most = 0;
    for (const Cell& cell : cells) most = std::max<std::size_t>(most, cell.end - cell.begin);
    return most;
  }

  /// Calls work(i, j) once for each pair of atoms in one cell or in two neighbouring cells.
  template <class Work>
  void pairs(const Work& work) const {
    // Offsets of the keys of the neighbouring columns that come "after" this one; each has three
    // neighbours along z.
    constexpr std::uint64_t y = std::uint64_t{1} << 21, x = y << 21;
    constexpr std::array<std::uint64_t, 4> columns = {y, x - y, x, x + y};
    std::array<std::size_t, 4>
        from{};  // cells before these indices precede the column's first; the indices only increase
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const Cell& cell = cells[c];
      for (std::uint32_t i = cell.begin; i < cell.end; ++i)
        for (std::uint32_t j = i + 1; j < cell.end; ++j) work(order[i], order[j]);
      if (c + 1 < cells.size() && cells[c + 1].key == cell.key + 1)
        across(cell, cells[c + 1], work);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const std::uint64_t first = cell.key + columns.at(k) - 1;
        std::size_t& at = from.at(k);
        while (at < cells.size() && cells[at].key < first) ++at;
        for (std::size_t d = at; d < cells.size() && cells[d].key <= first + 2; ++d)
          across(cell, cells[d], work);
      }
    }
  }

  std::vector<std::uint32_t> order;
  std::vector<Cell> cells;

 private:
  template <class Work>
  void across(const Cell& a, const Cell& b, const Work& work) const {
    for (std::uint32_t i = a.begin; i < a.end; ++i)
      for (std::uint32_t j = b.begin; j < b.end; ++j) work(order[i], order[j]);
  }
};

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
    const Grid grid(atoms, 2 * widest + kTolerance);
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
