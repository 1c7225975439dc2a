// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/cartoon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "import/detail/ribbon.h"
#include "import/detail/secondary.h"

namespace caplet {

namespace {

using glm::dvec3;

constexpr float kTube = 0.6F, kRod = 0.25F;             // radii of nucleic acids
constexpr double kSlabHeight = 0.5, kSlabMargin = 0.4;  // beyond the atoms of the ring
constexpr int kStrandPasses = 2;                        // of smoothing the sides of strands

// Files with more residues have coarser curves, which bounds their memory: an amino
// acid of 3.8 angstroms has at most 576, 256 or 96 triangles.
constexpr std::size_t kMostFine = 3'000, kMostMedium = 20'000;

RibbonDetail detail_for(std::size_t residues) {
  if (residues <= kMostFine) return {12, 6};
  return residues <= kMostMedium ? RibbonDetail{8, 4} : RibbonDetail{4, 3};
}

/// Returns whether the atom has the name, which old files write with * in place of '.
bool is_named(const std::string& atom, std::string_view name) {
  return std::ranges::equal(atom, name,
                            [](char a, char b) { return a == b || (a == '*' && b == '\''); });
}

/// Returns the first of a residue's atoms with the name, or -1.
std::int64_t atom_named(const Molecule& molecule, const Residue& residue, std::string_view name) {
  if (molecule.atom_names.empty()) return -1;
  for (std::uint32_t i = residue.first_atom; i < residue.first_atom + residue.atom_count; ++i)
    if (is_named(molecule.atom_names[i], name)) return i;
  return -1;
}

dvec3 across(const dvec3& v, const dvec3& unit) { return v - glm::dot(v, unit) * unit; }
std::optional<dvec3> unit(const dvec3& v) {
  const double size = glm::length(v);
  return size > 1e-6 ? std::optional(v / size) : std::nullopt;
}

/// Means of three with weights 1, 2, 1, within pieces of the same kind.
std::vector<dvec3> smoothed(const std::vector<dvec3>& values, const std::vector<RibbonGuide>& of,
                            Secondary kind) {
  std::vector<dvec3> out = values;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (of[i].kind != kind) continue;
    const bool has_left = i > 0 && of[i - 1].kind == kind,
               has_right = i + 1 < values.size() && of[i + 1].kind == kind;
    out[i] = 0.25 * (has_left ? values[i - 1] : values[i]) + 0.5 * values[i] +
             0.25 * (has_right ? values[i + 1] : values[i]);
  }
  return out;
}

class CartoonDrawing {
 public:
  CartoonDrawing(const Molecule& molecule, const std::vector<Secondary>& secondary,
                 const std::function<std::uint32_t(const Atom&)>& material, const std::string& path)
      : molecule_(molecule), secondary_(secondary), material_(material), path_(path) {}

  std::vector<Shape> shapes(const std::vector<bool>& kept, std::size_t copies) {
    std::vector<std::int64_t> guides(molecule_.residues.size(), -1);
    std::size_t count = 0;
    for (std::size_t r = 0; r < guides.size(); ++r) {
      guides[r] = guide_atom(molecule_, molecule_.residues[r]);
      count += guides[r] >= 0 ? 1 : 0;
    }
    detail_ = detail_for(count * copies);
    std::vector<std::uint32_t> run;  // residues without a gap
    for (std::uint32_t r = 0; r < guides.size(); ++r) {
      if (guides[r] < 0 || !kept[r]) continue;
      if (!run.empty() && !goes_on(run.back(), r, guides)) finish(run, guides);
      run.push_back(r);
    }
    finish(run, guides);
    return std::move(out_);
  }

 private:
  dvec3 place(std::int64_t atom) const {
    return dvec3(molecule_.atoms[static_cast<std::size_t>(atom)].position);
  }

  bool goes_on(std::uint32_t from, std::uint32_t to,
               const std::vector<std::int64_t>& guides) const {
    const Residue &a = molecule_.residues[from], &b = molecule_.residues[to];
    const float gap = b.kind == ResidueKind::amino_acid ? calpha_gap : phosphorus_gap;
    return a.chain == b.chain && a.kind == b.kind &&
           glm::length(place(guides[to]) - place(guides[from])) <= static_cast<double>(gap);
  }

  void finish(std::vector<std::uint32_t>& run, const std::vector<std::int64_t>& guides) {
    if (run.empty()) return;
    std::vector<dvec3> places;
    places.reserve(run.size());
    for (const std::uint32_t r : run) places.push_back(place(guides[r]));
    if (molecule_.residues[run[0]].kind == ResidueKind::nucleotide)
      add_nucleotides(run, std::move(places), guides);
    else
      add_ribbon(run, places, guides);
    run.clear();
  }

  Shape& add(std::uint32_t residue, Geometry geometry, std::int64_t guide) {
    const Residue& of = molecule_.residues[residue];
    const std::string& chain = molecule_.chains[of.chain];
    Shape shape;
    shape.name = (chain.empty() ? "" : "chain " + chain + " ") + of.name +
                 (of.number.empty() ? "" : " " + of.number);
    shape.where = {path_, 0, 0};
    shape.geometry = std::move(geometry);
    shape.material = material_(molecule_.atoms[static_cast<std::size_t>(guide)]);
    out_.push_back(std::move(shape));
    return out_.back();
  }

  static void add_capsule(const dvec3& p0, const dvec3& p1, float radius, CapsulesShape& out) {
    out.p0.emplace_back(p0);
    out.p1.emplace_back(p1);
    out.radius0.push_back(radius);
  }

  // --- Proteins ---

  /// Returns the directions of the ribbon's width. That of a peptide is the direction of its
  /// carbonyl oxygen across the chain, which lies in the plane of the peptide. Without oxygen it
  /// is across the bend of the chain. Those of strands alternate, and are turned around.
  std::vector<dvec3> sides_of(const std::vector<std::uint32_t>& run,
                              const std::vector<dvec3>& places) const {
    const std::size_t count = run.size();
    std::vector<dvec3> of_peptides;  // between a residue and the next
    dvec3 last(0);
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const std::optional<dvec3> along = unit(places[i + 1] - places[i]);
      std::optional<dvec3> side;
      if (along) {
        const std::int64_t oxygen = backbone_of(molecule_, molecule_.residues[run[i]]).o;
        if (oxygen >= 0) side = unit(across(place(oxygen) - places[i], *along));
        if (!side && i > 0) side = unit(glm::cross(places[i] - places[i - 1], *along));
        if (!side && i + 2 < count) side = unit(glm::cross(*along, places[i + 2] - places[i + 1]));
        if (!side)
          side =
              unit(glm::cross(*along, std::abs(along->x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
      }
      if (!side) side = last == dvec3(0) ? dvec3(0, 0, 1) : last;
      if (glm::dot(*side, last) < 0) side = -*side;
      of_peptides.push_back(*side);
      last = *side;
    }
    std::vector<dvec3> out;
    for (std::size_t i = 0; i < count; ++i) {
      const dvec3 &before = of_peptides[i == 0 ? 0 : i - 1],
                  &behind = of_peptides[i + 1 == count ? i - 1 : i];
      out.push_back(unit(before + behind).value_or(behind));
    }
    return out;
  }

  void add_ribbon(const std::vector<std::uint32_t>& run, const std::vector<dvec3>& places,
                  const std::vector<std::int64_t>& guides) {
    if (run.size() == 1) {
      CapsulesShape ball;
      add_capsule(places[0], places[0], static_cast<float>(coil_section.half_width), ball);
      add(run[0], std::move(ball), guides[run[0]]);
      return;
    }
    std::vector<RibbonGuide> ribbon(run.size());
    for (std::size_t i = 0; i < run.size(); ++i) {
      ribbon[i].kind = secondary_[run[i]];
      ribbon[i].place = places[i];
      // The pleats of a strand, whose alpha carbons lie alternately above and below it, vanish.
      if (ribbon[i].kind == Secondary::strand && i > 0 && i + 1 < run.size())
        ribbon[i].place = 0.25 * places[i - 1] + 0.5 * places[i] + 0.25 * places[i + 1];
    }
    std::vector<dvec3> sides = sides_of(run, places);
    sides = smoothed(sides, ribbon, Secondary::helix);
    for (int pass = 0; pass < kStrandPasses; ++pass)
      sides = smoothed(sides, ribbon, Secondary::strand);
    for (std::size_t i = 0; i < run.size(); ++i) ribbon[i].side = sides[i];
    std::vector<TriangleMeshShape> meshes = ribbon_meshes(ribbon, detail_);
    for (std::size_t i = 0; i < run.size(); ++i) add(run[i], std::move(meshes[i]), guides[run[i]]);
  }

  // --- Nucleic acids ---

  void add_nucleotides(const std::vector<std::uint32_t>& run, std::vector<dvec3> places,
                       const std::vector<std::int64_t>& guides) {
    // The tube ends at the last residue's O3', where the next phosphorus would be bonded.
    const std::int64_t tail = atom_named(molecule_, molecule_.residues[run.back()], "O3'");
    if (tail >= 0) places.push_back(place(tail));
    const double last = static_cast<double>(places.size() - 1);
    const NaturalSpline curve(std::move(places));
    // A sugar lies between two phosphorus atoms: its residue has the curve between them.
    const double shift = tail >= 0 ? 0 : 0.5;
    for (std::size_t i = 0; i < run.size(); ++i) {
      const double at = static_cast<double>(i) - shift, begin = std::max(at, 0.0),
                   end = std::min(at + 1, last);
      const auto steps = static_cast<std::uint32_t>(
          std::max(1.0, std::round((end - begin) * static_cast<double>(detail_.pieces))));
      std::vector<dvec3> on_curve;
      for (std::uint32_t k = 0; k <= steps; ++k)
        on_curve.push_back(
            curve.at(std::lerp(begin, end, static_cast<double>(k) / static_cast<double>(steps))));
      if (on_curve.front() == on_curve.back()) on_curve.resize(2);
      // The rods come first: a shape's last capsule goes on in the next shape (post/joined.cpp).
      CapsulesShape shape = rods_of(run[i], on_curve);
      for (std::size_t k = 0; k + 1 < on_curve.size(); ++k)
        add_capsule(on_curve[k], on_curve[k + 1], kTube, shape);
      add(run[i], std::move(shape), guides[run[i]]);
    }
    for (const std::uint32_t r : run) add_slab(r, guides[r]);
  }

  struct BaseRing {
    std::vector<dvec3> atoms;
    dvec3 sugar{0}, root{0};  // C1' and the atom nearest to it; without C1' both are the first atom
  };
  /// Returns the atoms of a nucleotide's rings, N1 to C6 in their order; none if there are fewer
  /// than three.
  std::optional<BaseRing> base_ring(std::uint32_t residue) const {
    static constexpr std::array<std::string_view, 9> names = {"N1", "C2", "N3", "C4", "C5",
                                                              "C6", "N7", "C8", "N9"};
    const Residue& of = molecule_.residues[residue];
    BaseRing out;
    for (const std::string_view name : names)
      if (const std::int64_t atom = atom_named(molecule_, of, name); atom >= 0)
        out.atoms.push_back(place(atom));
    if (out.atoms.size() < 3) return std::nullopt;
    const std::int64_t sugar = atom_named(molecule_, of, "C1'");
    out.sugar = sugar >= 0 ? place(sugar) : out.atoms[0];
    out.root = nearest(out.atoms, out.sugar);
    return out;
  }

  static dvec3 nearest(const std::vector<dvec3>& points, const dvec3& to) {
    return *std::ranges::min_element(points, {},
                                     [&](const dvec3& p) { return glm::dot(p - to, p - to); });
  }

  /// Returns the rods from the tube over the sugar's C1' to the base.
  CapsulesShape rods_of(std::uint32_t residue, const std::vector<dvec3>& on_curve) const {
    CapsulesShape out;
    const std::optional<BaseRing> ring = base_ring(residue);
    if (!ring) return out;
    const dvec3 on_tube = nearest(on_curve, ring->sugar);
    if (on_tube != ring->sugar) add_capsule(on_tube, ring->sugar, kRod, out);
    if (ring->sugar != ring->root) add_capsule(ring->sugar, ring->root, kRod, out);
    return out;
  }

  /// Adds a box around the rings of a base.
  void add_slab(std::uint32_t residue, std::int64_t guide) {
    const std::optional<BaseRing> base = base_ring(residue);
    if (!base) return;
    const std::vector<dvec3>& ring = base->atoms;
    dvec3 middle(0), normal(0);
    for (const dvec3& p : ring) middle += p / static_cast<double>(ring.size());
    // The ring's atoms are those of a plane: the sum of its triangles is across it. N1 to C6 go
    // around the ring, in this order.
    for (std::size_t i = 0; i < std::min<std::size_t>(ring.size(), 6); ++i)
      normal += glm::cross(ring[i] - middle,
                           ring[(i + 1) % std::min<std::size_t>(ring.size(), 6)] - middle);
    const std::optional<dvec3> up = unit(normal);
    const std::optional<dvec3> outward = up ? unit(across(middle - base->root, *up)) : std::nullopt;
    if (!outward) return;
    const dvec3 sideways = glm::cross(*up, *outward);
    dvec3 low(0, 0, -kSlabHeight / 2), high(0, 0, kSlabHeight / 2);
    for (const dvec3& p : ring) {
      const dvec3 at(glm::dot(p - middle, *outward), glm::dot(p - middle, sideways), 0);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    const dvec3 margin(kSlabMargin, kSlabMargin, 0);
    Shape& slab = add(residue, BoxShape{low - margin, high + margin}, guide);
    slab.world_from_object = glm::dmat4(glm::dvec4(*outward, 0), glm::dvec4(sideways, 0),
                                        glm::dvec4(*up, 0), glm::dvec4(middle, 1));
  }

  const Molecule& molecule_;
  const std::vector<Secondary>& secondary_;
  const std::function<std::uint32_t(const Atom&)>& material_;
  const std::string& path_;
  RibbonDetail detail_;
  std::vector<Shape> out_;
};

}  // namespace

std::int64_t guide_atom(const Molecule& molecule, const Residue& residue) {
  if (residue.trace_atom >= 0) return residue.trace_atom;
  if (residue.kind != ResidueKind::nucleotide) return -1;
  for (const std::string_view name : {"O5'", "C4'", "C1'"})
    if (const std::int64_t atom = atom_named(molecule, residue, name); atom >= 0) return atom;
  return -1;
}

std::vector<Shape> cartoon_shapes(const Molecule& molecule, const std::vector<Secondary>& secondary,
                                  const std::vector<bool>& kept,
                                  const std::function<std::uint32_t(const Atom&)>& material,
                                  const std::string& path, std::size_t copies) {
  return CartoonDrawing(molecule, secondary, material, path).shapes(kept, copies);
}

}  // namespace caplet
