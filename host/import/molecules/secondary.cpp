// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Secondary structure by hydrogen bonds: Kabsch and Sander 1983, "Dictionary of protein secondary
// structure", doi:10.1002/bip.360221211. Turns of the backbone make helices, bridges between two
// pieces of it make ladders, and ladders make strands.
#include "import/detail/secondary.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "base/log.h"
#include "import/detail/cell_grid.h"

namespace caplet {

namespace {

// Constants of the paper; lengths in angstroms, energies in kcal/mol.
constexpr double kCoupling = 0.42 * 0.20 * 332;  // charges in e, and e^2 per angstrom
constexpr double kLeastEnergy = -9.9, kBondEnergy = -0.5;
constexpr double kLeastDistance = 0.5;  // nearer atoms have the least energy
constexpr double kNitrogenHydrogen = 1.0;
constexpr double kPeptideBond = 2.5;       // a longer one between C and N is a gap in the chain
constexpr float kCalphaReach = 9.0F;       // residues further apart have no bond
constexpr std::size_t kMostCalphas = 256;  // a cell of 9 angstroms holds some 6 of a real protein

struct Peptide {
  std::uint32_t residue = 0;
  glm::dvec3 n{0}, ca{0}, c{0}, o{0}, h{0};
  std::uint32_t piece = 0;  // peptides of one number are joined by peptide bonds
  bool donates = false;     // not proline, nor the first of its piece
};

/// The two best acceptors of a peptide's hydrogen.
struct Acceptors {
  std::array<std::int64_t, 2> peptide{-1, -1};
  std::array<double, 2> energy{0, 0};
  /// Of equal energies the earlier peptide's counts, in whatever order they are offered.
  void offer(std::int64_t other, double of_bond) {
    const auto beats = [&](std::size_t at) {
      return std::tie(of_bond, other) < std::tie(energy.at(at), peptide.at(at));
    };
    if (beats(0)) {
      peptide = {other, peptide[0]};
      energy = {of_bond, energy[0]};
    } else if (beats(1)) {
      peptide[1] = other;
      energy[1] = of_bond;
    }
  }
};

enum class BridgeKind : std::uint8_t { parallel, antiparallel };

/// Consecutive bridges of one kind; peptides [first, last] of both sides, i before j.
struct Ladder {
  BridgeKind kind = BridgeKind::parallel;
  std::int64_t i_first = 0, i_last = 0, j_first = 0, j_last = 0;
  std::size_t bridges = 1;
};

class Dssp {
 public:
  Dssp(const Molecule& molecule, const std::string& path) : molecule_(molecule), path_(path) {}

  DsspStates states() {
    DsspStates out(molecule_.residues.size(), ' ');
    collect();
    if (!find_bonds()) return out;
    of_.assign(peptides_.size(), ' ');
    add_strands();
    add_helices();
    for (std::size_t p = 0; p < peptides_.size(); ++p) out[peptides_[p].residue] = of_[p];
    return out;
  }

 private:
  void collect() {
    for (std::uint32_t r = 0; r < molecule_.residues.size(); ++r) {
      const Residue& residue = molecule_.residues[r];
      const Backbone atoms =
          residue.kind == ResidueKind::amino_acid ? backbone_of(molecule_, residue) : Backbone();
      if (!atoms.complete()) {
        is_whole_ = false;
        continue;
      }
      Peptide one;
      one.residue = r;
      const auto place = [this](std::int64_t atom) {
        return glm::dvec3(molecule_.atoms[static_cast<std::size_t>(atom)].position);
      };
      one.n = one.h = place(atoms.n);
      one.ca = place(atoms.ca);
      one.c = place(atoms.c);
      one.o = place(atoms.o);
      if (!peptides_.empty()) {
        const Peptide& before = peptides_.back();
        const bool joined = is_whole_ &&
                            molecule_.residues[before.residue].chain == residue.chain &&
                            glm::length(before.c - one.n) <= kPeptideBond;
        one.piece = before.piece + (joined ? 0 : 1);
        const double carbonyl = glm::length(before.c - before.o);
        if (joined && carbonyl > 0) {
          one.h += kNitrogenHydrogen / carbonyl * (before.c - before.o);
          one.donates = residue.name != "PRO";
        }
      }
      is_whole_ = true;
      peptides_.push_back(one);
    }
  }

  /// Returns the energy of the bond from the donor's N-H to the acceptor's C=O, to the thousandth,
  /// as in mkdssp: one of -0.5004 is no bond.
  static double energy(const Peptide& donor, const Peptide& acceptor) {
    const double on = glm::length(acceptor.o - donor.n), ch = glm::length(acceptor.c - donor.h),
                 oh = glm::length(acceptor.o - donor.h), cn = glm::length(acceptor.c - donor.n);
    if (std::min({on, ch, oh, cn}) < kLeastDistance) return kLeastEnergy;
    const double exact = kCoupling * (1 / on + 1 / ch - 1 / oh - 1 / cn);
    return std::max(std::round(exact * 1000) / 1000, kLeastEnergy);
  }

  bool find_bonds() {
    acceptors_.assign(peptides_.size(), {});
    if (peptides_.empty()) return false;
    std::vector<glm::vec3> calphas;
    calphas.reserve(peptides_.size());
    for (const Peptide& one : peptides_) calphas.emplace_back(one.ca);
    const CellGrid grid(calphas, kCalphaReach);
    if (grid.fullest() > kMostCalphas) {
      log::warn(
          "{}: {} alpha carbons within {:.1f} angstroms of each other: no helices and strands are "
          "found (is the unit of length another?)",
          path_, grid.fullest(), static_cast<double>(kCalphaReach));
      return false;
    }
    const auto try_bond = [this](std::uint32_t donor, std::uint32_t acceptor) {
      if (!peptides_[donor].donates) return;
      const double found = energy(peptides_[donor], peptides_[acceptor]);
      if (found < kBondEnergy) acceptors_[donor].offer(acceptor, found);
    };
    grid.pairs([&](std::uint32_t one, std::uint32_t other) {
      const auto [i, j] = std::minmax(one, other);
      if (glm::length(peptides_[i].ca - peptides_[j].ca) > static_cast<double>(kCalphaReach))
        return;
      try_bond(i, j);
      if (j != i + 1) try_bond(j, i);  // the peptide's own C=O is no acceptor
    });
    return true;
  }

  /// Returns whether the donor's N-H is bonded to the acceptor's C=O.
  bool bonded(std::int64_t donor, std::int64_t acceptor) const {
    const Acceptors& of = acceptors_[static_cast<std::size_t>(donor)];
    return of.peptide[0] == acceptor || of.peptide[1] == acceptor;
  }
  /// Returns whether all peptides from one to the other are there and joined.
  bool joined(std::int64_t from, std::int64_t to) const {
    return from >= 0 && to < std::ssize(peptides_) &&
           peptides_[static_cast<std::size_t>(from)].piece ==
               peptides_[static_cast<std::size_t>(to)].piece;
  }

  bool bridge(std::int64_t i, std::int64_t j, BridgeKind& kind) const {
    if (!joined(i - 1, i + 1) || !joined(j - 1, j + 1)) return false;
    if ((bonded(i + 1, j) && bonded(j, i - 1)) || (bonded(j + 1, i) && bonded(i, j - 1))) {
      kind = BridgeKind::parallel;
      return true;
    }
    kind = BridgeKind::antiparallel;
    return (bonded(i + 1, j - 1) && bonded(j + 1, i - 1)) || (bonded(j, i) && bonded(i, j));
  }

  /// Every bridge has a bond; each bond is of one of these pairs.
  std::vector<std::pair<std::int64_t, std::int64_t>> pairs_of_bonds() const {
    std::vector<std::pair<std::int64_t, std::int64_t>> out;
    const auto add = [&out](std::int64_t a, std::int64_t b) {
      if (std::abs(a - b) >= 3) out.emplace_back(std::min(a, b), std::max(a, b));
    };
    for (std::int64_t x = 0; x < std::ssize(acceptors_); ++x)
      for (const std::int64_t y : acceptors_[static_cast<std::size_t>(x)].peptide) {
        if (y < 0) continue;
        add(x - 1, y);
        add(x, y + 1);
        add(x - 1, y + 1);
        add(x, y);
      }
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  std::vector<Ladder> ladders() const {
    std::vector<Ladder> out;
    // The ladders that a bridge (i, j) of this kind would continue.
    std::map<std::tuple<BridgeKind, std::int64_t, std::int64_t>, std::size_t> open;
    for (const auto& [i, j] : pairs_of_bonds()) {
      BridgeKind kind{};
      if (!bridge(i, j, kind)) continue;
      const std::int64_t step = kind == BridgeKind::parallel ? 1 : -1;
      std::size_t at = out.size();
      if (const auto found = open.find({kind, i, j}); found != open.end()) {
        at = found->second;
        Ladder& ladder = out[at];
        ladder.i_last = i;
        (step > 0 ? ladder.j_last : ladder.j_first) = j;
        ++ladder.bridges;
      } else {
        out.push_back({kind, i, i, j, j, 1});
      }
      if (joined(i, i + 1) && joined(std::min(j, j + step), std::max(j, j + step)))
        open[{kind, i + 1, j + step}] = at;
    }
    return out;
  }

  /// Returns whether b goes on where a ends, with at most one peptide between them on one side and
  /// four on the other. As in mkdssp both may end at the same peptide of the second side.
  bool bulge(const Ladder& a, const Ladder& b) const {
    const bool is_parallel = a.kind == BridgeKind::parallel;
    const std::int64_t along = b.i_first - a.i_last,
                       beside = is_parallel ? b.j_first - a.j_last : a.j_first - b.j_last;
    if (a.kind != b.kind || along <= 0 || along >= 6 || beside < 0) return false;
    if (!joined(a.i_first, b.i_last) ||
        !joined(std::min(a.j_first, b.j_first), std::max(a.j_last, b.j_last)))
      return false;
    return (beside < 6 && along < 3) || beside < 3;
  }

  /// Joins ladders at bulges.
  void join(std::vector<Ladder>& all) const {
    std::ranges::sort(all, [](const Ladder& a, const Ladder& b) {
      return std::tie(a.i_first, a.j_first, a.kind) < std::tie(b.i_first, b.j_first, b.kind);
    });
    std::vector<bool> is_gone(all.size(), false);
    for (std::size_t a = 0; a < all.size(); ++a) {
      if (is_gone[a]) continue;
      for (std::size_t b = a + 1; b < all.size() && all[b].i_first < all[a].i_last + 6; ++b) {
        if (is_gone[b] || !bulge(all[a], all[b])) continue;
        all[a].i_last = all[b].i_last;
        all[a].j_first = std::min(all[a].j_first, all[b].j_first);
        all[a].j_last = std::max(all[a].j_last, all[b].j_last);
        all[a].bridges += all[b].bridges;
        is_gone[b] = true;
      }
    }
    std::size_t at = 0;
    std::erase_if(all, [&](const Ladder&) { return is_gone[at++]; });
  }

  void add_strands() {
    std::vector<Ladder> all = ladders();
    join(all);
    for (const Ladder& ladder : all) {
      const char state = ladder.bridges > 1 ? 'E' : 'B';
      const auto mark = [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t p = first; p <= last; ++p)
          if (char& of = of_[static_cast<std::size_t>(p)]; of != 'E') of = state;
      };
      mark(ladder.i_first, ladder.i_last);
      mark(ladder.j_first, ladder.j_last);
    }
  }

  /// Marks helices of two successive turns of n peptides. `yields` are states that they replace.
  void add_helices_of(std::int64_t n, char state, std::string_view yields) {
    const auto turns = [&](std::int64_t i) { return joined(i, i + n) && bonded(i + n, i); };
    for (std::int64_t i = 1; i + n < std::ssize(peptides_); ++i) {
      if (!turns(i) || !turns(i - 1)) continue;
      const std::string_view part =
          std::string_view(of_).substr(static_cast<std::size_t>(i), static_cast<std::size_t>(n));
      if (!yields.empty() && part.find_first_not_of(yields) != std::string_view::npos) continue;
      std::fill_n(of_.begin() + i, n, state);
    }
  }

  /// Alpha helices replace strands. 3-10 helices stand where nothing else is. Pi helices replace
  /// alpha helices, as in mkdssp since version 2.2; of the paper they did not.
  void add_helices() {
    add_helices_of(4, 'H', "");
    add_helices_of(3, 'G', " G");
    add_helices_of(5, 'I', " IH");
  }

  const Molecule& molecule_;
  const std::string& path_;
  std::vector<Peptide> peptides_;
  std::vector<Acceptors> acceptors_;  // of each peptide
  DsspStates of_;                     // of each peptide
  bool is_whole_ = true;
};

}  // namespace

Backbone backbone_of(const Molecule& molecule, const Residue& residue) {
  Backbone out;
  if (molecule.atom_names.empty()) return out;
  for (std::uint32_t i = residue.first_atom; i < residue.first_atom + residue.atom_count; ++i) {
    const std::string& name = molecule.atom_names[i];
    std::int64_t* const of = name == "N"    ? &out.n
                             : name == "CA" ? &out.ca
                             : name == "C"  ? &out.c
                             : name == "O"  ? &out.o
                                            : nullptr;
    if (of && *of < 0) *of = i;
  }
  return out;
}

void state_secondary(Molecule& molecule, const std::vector<std::int32_t>& numbers,
                     std::string_view codes, const std::vector<SecondaryRange>& ranges) {
  molecule.states_secondary = !ranges.empty();
  if (ranges.empty()) return;
  std::unordered_map<std::string, std::vector<std::uint32_t>> chains;  // by number
  for (std::uint32_t r = 0; r < molecule.residues.size(); ++r)
    if (molecule.residues[r].kind == ResidueKind::amino_acid)
      chains[molecule.chains[molecule.residues[r].chain]].push_back(r);
  for (auto& [name, of_chain] : chains)
    std::ranges::stable_sort(of_chain, {}, [&](std::uint32_t r) { return numbers[r]; });
  // How many ranges of each kind begin less those that end before each residue of the sorted chain.
  std::unordered_map<std::string, std::array<std::vector<std::int64_t>, 2>> changes;
  for (const SecondaryRange& range : ranges) {
    const auto chain = chains.find(range.chain);
    if (chain == chains.end() || range.kind == Secondary::coil) continue;
    const std::vector<std::uint32_t>& of_chain = chain->second;
    const auto number_of = [&](std::uint32_t r) { return numbers[r]; };
    // clang 14 cannot compile std::ranges::equal_range.
    const auto first = std::ranges::lower_bound(of_chain, range.number[0], {}, number_of),
               first_end = std::ranges::upper_bound(of_chain, range.number[0], {}, number_of),
               last = std::ranges::lower_bound(of_chain, range.number[1], {}, number_of),
               last_end = std::ranges::upper_bound(of_chain, range.number[1], {}, number_of);
    const auto coded = [&](auto from, auto to, char code, auto otherwise) {
      const auto found = std::find_if(from, to, [&](std::uint32_t r) { return codes[r] == code; });
      return found == to ? otherwise : found;
    };
    const auto begin = coded(first, first_end, range.code[0], first);
    auto end = coded(last, last_end, range.code[1], last_end);
    if (end != last_end) ++end;
    if (begin >= end) continue;
    std::vector<std::int64_t>& change =
        changes[range.chain].at(range.kind == Secondary::helix ? 0 : 1);
    change.resize(of_chain.size() + 1);
    ++change[static_cast<std::size_t>(begin - of_chain.begin())];
    --change[static_cast<std::size_t>(end - of_chain.begin())];
  }
  for (const auto& [name, of_kinds] : changes) {
    const std::vector<std::uint32_t>& of_chain = chains.at(name);
    for (const std::size_t kind : {1U, 0U}) {
      std::int64_t inside = 0;
      for (std::size_t i = 0; i < of_chain.size() && !of_kinds.at(kind).empty(); ++i)
        if ((inside += of_kinds.at(kind)[i]) > 0)
          molecule.residues[of_chain[i]].stated = kind == 0 ? Secondary::helix : Secondary::strand;
    }
  }
}

DsspStates dssp_states(const Molecule& molecule, const std::string& path) {
  return Dssp(molecule, path).states();
}

std::vector<Secondary> secondary_of(const Molecule& molecule, bool by_file,
                                    const std::string& path) {
  std::vector<Secondary> out;
  out.reserve(molecule.residues.size());
  if (by_file) {
    for (const Residue& residue : molecule.residues) out.push_back(residue.stated);
    return out;
  }
  for (const char state : dssp_states(molecule, path))
    out.push_back(state == 'H' || state == 'G' || state == 'I' ? Secondary::helix
                  : state == 'E'                               ? Secondary::strand
                                                               : Secondary::coil);
  return out;
}

}  // namespace caplet
