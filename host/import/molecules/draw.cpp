// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws molecules: spheres are capsules of length 0, bonds are capsules split in two where the
// colours of their atoms differ, and traces are tapered capsules along a Catmull-Rom curve.
// Cartoons are drawn by cartoon.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "base/check.h"
#include "base/error.h"
#include "base/log.h"
#include "base/reading.h"
#include "import/color_map.h"
#include "import/detail/atom_values.h"
#include "import/detail/cartoon.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/molecule.h"
#include "import/detail/option_files.h"
#include "import/detail/representation.h"
#include "import/detail/secondary.h"
#include "import/detail/selection.h"
#include "import/detail/text_file.h"
#include "import/detail/value_colors.h"
#include "present/present.h"
#include "table/npy.h"

namespace caplet {

namespace {

constexpr std::size_t kMostInDetail =
    2000;  // atoms; larger molecules are drawn as spheres by default
constexpr std::size_t kLeastOfCartoon =
    10;                         // residues; chains of as many are drawn as cartoons by default
constexpr float kBall = 0.25F;  // of the van der Waals radius
constexpr float kIon = 0.5F;    // of it: near the radii of cations by Shannon 1976
constexpr float kBondRadius = 0.12F, kStickRadius = 0.2F, kTraceRadius = 0.45F;  // angstroms
constexpr float kThinTrace = 0.25F, kThickTrace = 1.1F;  // radii at the least and greatest b factor
constexpr int kTraceSteps = 6;                           // capsules between two residues

class Painter {
 public:
  /// `secondary`: a value for each residue where the colours need it, else none. `values`: those of
  /// atom_values.
  Painter(Scene& scene, const Molecule& molecule, const std::vector<Secondary>& secondary,
          const Representation& as, AtomValues values)
      : scene_(scene),
        molecule_(molecule),
        secondary_(secondary),
        by_(as.by),
        color_(as.color),
        values_(std::move(values)),
        value_colors_(scene, values_.name, values_.low, values_.high, values_.steps, values_.map) {}

  /// Returns the atom's place in the range of the values, 0 to 1.
  float part(const Atom& atom) const { return values_.part(index_of(atom)); }

  std::uint32_t material(const Atom& atom) {
    const Residue& residue = molecule_.residues[atom.residue];
    switch (by_) {
      case MoleculeColor::element:
        return of_element(atom);
      case MoleculeColor::chain:
        return named("chain " + molecule_.chains[residue.chain],
                     [&] { return palette_color(residue.chain); });
      case MoleculeColor::residue:
        return named(residue.name.empty() ? "residue" : residue.name,
                     [&] { return palette_color(index_.size()); });
      case MoleculeColor::bfactor:
      case MoleculeColor::charge:
      case MoleculeColor::distance:
        return value_colors_.of(static_cast<double>(values_.of[index_of(atom)]));
      case MoleculeColor::secondary:
        return of_secondary(atom);
      case MoleculeColor::fixed:
        return named("molecule", [&] { return color_; });
    }
    return 0;
  }

  /// Returns the legend of values, or of the names of what was drawn; none of a fixed colour.
  std::optional<Legend> legend() const {
    if (shows_values(by_))
      return map_legend(values_.title, values_.unit, values_.low, values_.high, values_.map);
    if (by_ == MoleculeColor::fixed) return std::nullopt;
    std::vector<std::uint32_t> materials;
    for (const auto& [name, material] : index_) materials.push_back(material);
    std::ranges::sort(materials);  // in the order in which they were first drawn
    const char* title = by_ == MoleculeColor::element   ? "Element"
                        : by_ == MoleculeColor::chain   ? ""  // names say it
                        : by_ == MoleculeColor::residue ? "Residue"
                                                        : "Secondary structure";
    return names_legend(title, scene_.materials, materials);
  }

  std::uint32_t of_element(const Atom& atom) {
    return named(element_name(atom.element), [&] { return element_color(atom.element); });
  }
  MoleculeColor by() const { return by_; }

 private:
  /// The colours of RasMol's and Jmol's scheme "structure".
  std::uint32_t of_secondary(const Atom& atom) {
    const auto encoded = [this](const char* name, const glm::vec3& bytes) {
      return named(name, [&] { return glm::dvec3(decoded_color(bytes, 255)); });
    };
    switch (molecule_.residues[atom.residue].kind) {
      case ResidueKind::amino_acid:
        break;
      case ResidueKind::nucleotide:
        return encoded("nucleic acid", {174, 0, 254});
      default:
        return of_element(atom);
    }
    switch (secondary_[atom.residue]) {
      case Secondary::helix:
        return encoded("helix", {255, 0, 128});
      case Secondary::strand:
        return encoded("strand", {255, 200, 0});
      case Secondary::coil:
        break;
    }
    return encoded("coil", {255, 255, 255});
  }

  std::uint32_t named(const std::string& name, const std::function<glm::dvec3()>& color) {
    const auto [entry, fresh] =
        index_.try_emplace(name, narrow<std::uint32_t>(scene_.materials.size()));
    if (fresh)
      scene_.materials.push_back(
          {DiffuseMaterial{RgbSpectrum{color()}}, name, {scene_.source, 0, 0}});
    return entry->second;
  }

  std::size_t index_of(const Atom& atom) const {
    return static_cast<std::size_t>(&atom - molecule_.atoms.data());
  }

  Scene& scene_;
  const Molecule& molecule_;
  const std::vector<Secondary>& secondary_;
  MoleculeColor by_;
  glm::dvec3 color_;
  AtomValues values_;
  ValueColors value_colors_;
  std::map<std::string, std::uint32_t> index_;
};

/// The capsules of one kind in a chain; they become one shape.
struct DrawnPart {
  CapsulesShape capsules;
  bool tapered = false;
  void add(const glm::vec3& p0, const glm::vec3& p1, float r0, float r1, std::uint32_t material) {
    capsules.p0.push_back(p0);
    capsules.p1.push_back(p1);
    capsules.radius0.push_back(r0);
    capsules.radius1.push_back(r1);
    capsules.materials.push_back(material);
    tapered |= r0 != r1;
  }
  /// Adds a capsule of a tube, with u at both ends.
  void add(const glm::vec3& p0, const glm::vec3& p1, float r0, float r1, std::uint32_t material,
           const glm::vec2& u) {
    add(p0, p1, r0, r1, material);
    capsules.u.push_back(u);
  }
};

class MoleculeDrawing {
 public:
  /// `chosen` marks the atoms to draw.
  MoleculeDrawing(const Molecule& molecule, const std::vector<Bond>& bonds,
                  const std::vector<Secondary>& secondary, std::vector<bool> chosen,
                  const Representation& as, Painter& painter)
      : molecule_(molecule),
        bonds_(bonds),
        secondary_(secondary),
        chosen_(std::move(chosen)),
        style_(as.style),
        opacity_(as.opacity),
        probe_(as.probe),
        painter_(painter) {}

  /// Makes the shapes of the residues that `kept` marks, which are placed `copies` times.
  std::vector<Shape> shapes(const Scene& scene, const std::vector<bool>& kept,
                            std::size_t copies = 1) {
    parts_.clear();
    const auto is_chosen = [&](std::uint32_t i) {
      return chosen_[i] && kept[molecule_.atoms[i].residue];
    };
    if (has_surface()) find_covered(is_chosen);
    const auto is_drawn = [&](std::uint32_t i) {
      return is_chosen(i) && in_detail(molecule_.atoms[i]);
    };
    for (std::uint32_t i = 0; i < molecule_.atoms.size(); ++i) {
      if (!is_drawn(i)) continue;
      const Atom& atom = molecule_.atoms[i];
      const float radius = ball_radius(atom);
      if (!(radius > 0)) continue;  // some force fields give hydrogen no size
      part(atom, " atoms").add(atom.position, atom.position, radius, radius, color_of(atom));
    }
    if (style_ != MoleculeStyle::spheres)
      for (const auto& [i, j] : bonds_)
        if (is_drawn(i) && is_drawn(j) && has_bonds(molecule_.atoms[i]))
          add_bond(molecule_.atoms[i], molecule_.atoms[j]);
    if (style_ == MoleculeStyle::trace) add_traces(kept);
    std::vector<Shape> out;
    for (auto& [name, part] : parts_) {
      if (!part.tapered) part.capsules.radius1 = {};
      Shape shape;
      shape.name = name;
      shape.where = {scene.source, 0, 0};
      shape.geometry = std::move(part.capsules);
      out.push_back(std::move(shape));
    }
    if (style_ == MoleculeStyle::cartoon)
      for (Shape& shape : cartoon_shapes(
               molecule_, secondary_, with_guide(kept),
               [this](const Atom& atom) { return painter_.material(atom); }, scene.source, copies))
        out.push_back(std::move(shape));
    if (style_ == MoleculeStyle::surface) {
      Shape shape;
      shape.name = "surface";
      shape.where = {scene.source, 0, 0};
      shape.geometry = surface_of(is_chosen, scene.source);
      if (primitive_count(shape) > 0) out.push_back(std::move(shape));
    }
    if (opacity_ < 1)
      for (Shape& shape : out) shape.alpha = TextureOperand(opacity_);
    return out;
  }

 private:
  bool follows_chains() const {
    return style_ == MoleculeStyle::trace || style_ == MoleculeStyle::cartoon;
  }
  bool has_surface() const {
    return style_ == MoleculeStyle::surface || style_ == MoleculeStyle::accessible;
  }
  static int rank_of(ResidueKind kind) {
    return kind == ResidueKind::water ? 0 : kind == ResidueKind::other ? 1 : 2;
  }
  int rank_of(const Atom& atom) const { return rank_of(molecule_.residues[atom.residue].kind); }
  /// Surfaces cover polymers; where none is chosen, ligands; else water.
  template <class IsChosen>
  void find_covered(const IsChosen& is_chosen) {
    covered_rank_ = 0;
    for (std::uint32_t i = 0; i < molecule_.atoms.size(); ++i)
      if (is_chosen(i)) covered_rank_ = std::max(covered_rank_, rank_of(molecule_.atoms[i]));
  }
  bool is_covered(const Atom& atom) const { return rank_of(atom) == covered_rank_; }
  template <class IsChosen>
  MolecularSurfaceShape surface_of(const IsChosen& is_chosen, const std::string& path) {
    std::vector<glm::vec3> centers;
    std::vector<float> radii;
    std::vector<std::uint32_t> materials;
    for (std::uint32_t i = 0; i < molecule_.atoms.size(); ++i) {
      const Atom& atom = molecule_.atoms[i];
      if (!is_chosen(i) || !is_covered(atom) || !(ball_radius_of(atom) > 0)) continue;
      centers.push_back(atom.position);
      radii.push_back(ball_radius_of(atom));
      materials.push_back(painter_.material(atom));
    }
    try {
      return make_molecule(std::move(centers), std::move(radii), static_cast<double>(probe_),
                           std::move(materials));
    } catch (const InputError& error) {
      throw InputError({path}, std::string("surface: ") + error.what());
    }
  }

  /// Returns the kept residues whose guide atom is chosen.
  std::vector<bool> with_guide(std::vector<bool> kept) const {
    for (std::size_t r = 0; r < kept.size(); ++r) {
      const std::int64_t guide = kept[r] ? guide_atom(molecule_, molecule_.residues[r]) : -1;
      kept[r] = guide >= 0 && chosen_[static_cast<std::size_t>(guide)];
    }
    return kept;
  }
  /// The styles trace, cartoon and surface draw residues of no chain as sticks.
  bool in_detail(const Atom& atom) const {
    if (has_surface())
      return is_covered(atom) ? style_ == MoleculeStyle::accessible : rank_of(atom) == 1;
    if (!follows_chains()) return true;
    const Residue& residue = molecule_.residues[atom.residue];
    return residue.trace_atom < 0 && residue.kind == ResidueKind::other;
  }
  float ball_radius(const Atom& atom) const {
    switch (style_) {
      case MoleculeStyle::spheres:
        return ball_radius_of(atom);
      case MoleculeStyle::accessible:
        return is_covered(atom) ? ball_radius_of(atom) + probe_ : stick_end_radius(atom);
      case MoleculeStyle::ball_and_stick:
        return kBall * van_der_waals_radius(atom.element);
      default:
        return stick_end_radius(atom);
    }
  }
  /// Ions, which no stick leads to, are balls that can be seen.
  float stick_end_radius(const Atom& atom) const {
    const Residue& residue = molecule_.residues[atom.residue];
    return residue.kind == ResidueKind::other && residue.atom_count == 1
               ? kIon * van_der_waals_radius(atom.element)
               : kStickRadius;
  }
  bool has_bonds(const Atom& atom) const { return !has_surface() || !is_covered(atom); }
  float bond_radius() const {
    return style_ == MoleculeStyle::ball_and_stick ? kBondRadius : kStickRadius;
  }
  std::uint32_t color_of(const Atom& atom) const {
    return follows_chains() || (has_surface() && !is_covered(atom)) ? painter_.of_element(atom)
                                                                    : painter_.material(atom);
  }
  DrawnPart& part(const Atom& atom, const char* what) {
    const std::string& chain = molecule_.chains[molecule_.residues[atom.residue].chain];
    return parts_[(chain.empty() ? "molecule" : "chain " + chain) + what];
  }

  void add_bond(const Atom& a, const Atom& b) {
    const std::uint32_t color_a = color_of(a), color_b = color_of(b);
    const float radius = bond_radius();
    DrawnPart& out = part(a, " bonds");
    if (color_a == color_b) {
      out.add(a.position, b.position, radius, radius, color_a);
      return;
    }
    const glm::vec3 middle = 0.5F * a.position + 0.5F * b.position;
    out.add(a.position, middle, radius, radius, color_a);
    out.add(middle, b.position, radius, radius, color_b);
  }

  void add_traces(const std::vector<bool>& kept) {
    std::vector<const Atom*> run;
    std::optional<std::pair<std::uint32_t, ResidueKind>> last;
    const auto finish = [&] {
      add_tube(run);
      run.clear();
    };
    for (std::size_t r = 0; r < molecule_.residues.size(); ++r) {
      const Residue& residue = molecule_.residues[r];
      const auto traced = static_cast<std::size_t>(residue.trace_atom);
      if (!kept[r] || residue.trace_atom < 0 || !chosen_[traced]) continue;
      const Atom& atom = molecule_.atoms[traced];
      const float gap = residue.kind == ResidueKind::amino_acid ? calpha_gap : phosphorus_gap;
      const std::pair now{residue.chain, residue.kind};
      if (!run.empty() && (last != now || glm::length(atom.position - run.back()->position) > gap))
        finish();
      run.push_back(&atom);
      last = now;
    }
    finish();
  }

  float tube_radius(const Atom& atom) const {
    return painter_.by() == MoleculeColor::bfactor
               ? kThinTrace + (kThickTrace - kThinTrace) * painter_.part(atom)
               : kTraceRadius;
  }

  void add_tube(const std::vector<const Atom*>& run) {
    if (run.empty()) return;
    if (run.size() == 1) {
      const float radius = tube_radius(*run[0]);
      part(*run[0], " trace")
          .add(run[0]->position, run[0]->position, radius, radius, painter_.material(*run[0]),
               glm::vec2(0));
      return;
    }
    const auto at = [&run](std::ptrdiff_t i) {
      return run[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, std::ssize(run) - 1))]
          ->position;
    };
    // u increases evenly from residue to residue.
    const auto u_at = [&run](std::ptrdiff_t i, int step) {
      return (static_cast<float>(i) + static_cast<float>(step) / kTraceSteps) /
             static_cast<float>(std::ssize(run) - 1);
    };
    for (std::ptrdiff_t i = 0; i + 1 < std::ssize(run); ++i) {
      const Atom &a = *run[static_cast<std::size_t>(i)], &b = *run[static_cast<std::size_t>(i) + 1];
      const glm::vec3 p0 = at(i - 1), p1 = at(i), p2 = at(i + 1), p3 = at(i + 2);
      const float r1 = tube_radius(a), r2 = tube_radius(b);
      glm::vec3 before = p1;
      float radius_before = r1;
      for (int step = 1; step <= kTraceSteps; ++step) {
        const float t = static_cast<float>(step) / kTraceSteps;
        // The curve is that of Catmull and Rom 1974.
        const glm::vec3 on_curve =
            0.5F * (2.0F * p1 + (p2 - p0) * t + (2.0F * p0 - 5.0F * p1 + 4.0F * p2 - p3) * (t * t) +
                    (3.0F * p1 - p0 - 3.0F * p2 + p3) * (t * t * t));
        const glm::vec3 p = step == kTraceSteps ? p2 : on_curve;
        const float radius = r1 + (r2 - r1) * t;
        part(a, " trace")
            .add(before, p, radius_before, radius,
                 painter_.material(2 * step <= kTraceSteps ? a : b),
                 {u_at(i, step - 1), u_at(i, step)});
        before = p;
        radius_before = radius;
      }
    }
  }

  const Molecule& molecule_;
  const std::vector<Bond>& bonds_;
  const std::vector<Secondary>& secondary_;
  std::vector<bool> chosen_;
  MoleculeStyle style_;
  double opacity_;
  float probe_;
  int covered_rank_ = 0;  // of surfaces
  Painter& painter_;
  std::map<std::string, DrawnPart> parts_;
};

void add_assembly(Scene& scene, const Molecule& molecule, const std::string& name,
                  std::vector<MoleculeDrawing>& drawings) {
  const auto found = molecule.assemblies.find(name);
  if (found == molecule.assemblies.end()) {
    std::string known;
    for (const auto& [other, parts] : molecule.assemblies)
      known += (known.empty() ? "" : ", ") + other;
    throw InputError({"--assembly"}, "'" + name + "' is none of the file (" +
                                         (known.empty() ? "it has none" : known) + ")");
  }
  for (const AssemblyPart& part : found->second) {
    const std::set<std::string> chains(part.chains.begin(), part.chains.end()),
        parts(part.parts.begin(), part.parts.end());
    std::vector<bool> kept(molecule.residues.size());
    for (std::size_t r = 0; r < kept.size(); ++r)
      kept[r] = parts.empty() ? chains.contains(molecule.chains[molecule.residues[r].chain])
                              : parts.contains(molecule.residues[r].part);
    Object object;
    object.name = fmt::format("assembly {}, part {}", name, scene.objects.size() + 1);
    object.where = {scene.source, 0, 0};
    for (MoleculeDrawing& drawing : drawings)
      for (Shape& shape : drawing.shapes(scene, kept, part.operators.size()))
        object.shapes.push_back(std::move(shape));
    if (object.shapes.empty()) continue;
    for (const glm::dmat4& placed : part.operators)
      scene.instances.push_back(
          {narrow<std::uint32_t>(scene.objects.size()), placed, object.where});
    scene.objects.push_back(std::move(object));
  }
  if (scene.instances.empty())
    throw InputError({"--assembly"}, "'" + name + "' holds none of the atoms");
}

/// Moves the atoms to frame `number` of the array; bonds are those of the file's own positions.
void move_atoms(Molecule& molecule, const std::string& path, std::uint32_t number) {
  begin_reading(path);
  NpyReader reader(path, {3}, 3);
  const std::uint64_t frames = reader.shape()[0], atoms = reader.shape()[1];
  if (atoms != molecule.atoms.size())
    throw InputError({path}, fmt::format("has places of {} atoms, and {} are drawn of the molecule",
                                         atoms, molecule.atoms.size()));
  if (number > frames)
    throw InputError({"--model"}, fmt::format("{}: the array has {} frames", number, frames));
  std::vector<double> places(3 * molecule.atoms.size());
  reader.go_to((number - 1) * atoms);
  reader.read(places);
  for (std::size_t i = 0; i < molecule.atoms.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const double at = places[3 * i + static_cast<std::size_t>(axis)];
      if (!(std::abs(at) <= static_cast<double>(largest_number)))
        throw InputError({path},
                         fmt::format("frame {}, atom {}: the place is not finite or out of range",
                                     number, i + 1));
      molecule.atoms[i].position[axis] = static_cast<float>(at);
    }
  molecule.frames = narrow<std::uint32_t>(frames);
}

/// Returns whether a chain has enough of a backbone to be drawn as a cartoon by default.
bool has_polymer(const Molecule& molecule) {
  std::vector<std::size_t> residues(molecule.chains.size(), 0);
  return std::ranges::any_of(molecule.residues, [&](const Residue& r) {
    return guide_atom(molecule, r) >= 0 && ++residues[r.chain] == kLeastOfCartoon;
  });
}

/// Returns the style of a molecule without --style. Polymers are cartoons, as in ChimeraX and
/// Mol*, unless the colours tell atoms apart.
MoleculeStyle automatic_style(const Molecule& molecule, const ImportOptions& options) {
  const std::string color = options.text("color").value_or("");
  if (color != "element" && color != "charge" && has_polymer(molecule))
    return MoleculeStyle::cartoon;
  return molecule.atoms.size() > kMostInDetail ? MoleculeStyle::spheres
                                               : MoleculeStyle::ball_and_stick;
}

/// Throws InputError where the file lacks what the style or the colours need.
void check_asked(const Molecule& molecule, const Representation& as) {
  const auto [style, by] = std::pair(as.style, as.by);
  if (by == MoleculeColor::bfactor && !molecule.has_b_factors)
    throw InputError({"--color"}, "the file has no b factors");
  if (by == MoleculeColor::charge && !molecule.has_charges)
    throw InputError({"--color"}, "the file has no charges");
  if (style == MoleculeStyle::trace &&
      std::ranges::none_of(molecule.residues, [](const Residue& r) { return r.trace_atom >= 0; }))
    throw InputError({as.option},
                     "trace: the file has neither alpha carbons nor phosphorus of a polymer");
  if (style == MoleculeStyle::cartoon &&
      std::ranges::none_of(molecule.residues,
                           [&](const Residue& r) { return guide_atom(molecule, r) >= 0; }))
    throw InputError({as.option}, "cartoon: the file has no backbone of a polymer");
  if (by == MoleculeColor::secondary &&
      std::ranges::none_of(molecule.residues, [](const Residue& r) {
        return r.kind == ResidueKind::amino_acid || r.kind == ResidueKind::nucleotide;
      }))
    throw InputError({"--color"}, "secondary: the file has no polymer");
}

/// Returns each residue's part in the secondary structure. By default it is the file's where it
/// states any.
std::vector<Secondary> asked_secondary(const Molecule& molecule, bool by_file,
                                       const std::string& path) {
  if (by_file && !molecule.states_secondary)
    throw InputError({"--secondary"}, "the file has no records of helices and strands");
  return secondary_of(molecule, by_file, path);
}

/// Counts what is drawn of the molecule, and the models of its file. Ligands are residues of no
/// polymer but water; formats without residues have atoms and models.
std::vector<std::pair<std::string, std::uint64_t>> contents_of(const Molecule& molecule) {
  std::vector<std::pair<std::string, std::uint64_t>> out = {{"atoms", molecule.atoms.size()}};
  if (std::ranges::any_of(molecule.residues, [](const Residue& r) { return !r.name.empty(); })) {
    out.emplace_back("residues", molecule.residues.size());
    out.emplace_back("chains", molecule.chains.size());
    out.emplace_back("ligands",
                     std::ranges::count(molecule.residues, ResidueKind::other, &Residue::kind));
  }
  out.emplace_back("models", molecule.frames);
  return out;
}

using MoleculeReader = Molecule (*)(std::string_view, const std::string&, const ImportOptions&);

Imported import_molecule(const std::filesystem::path& path, const ImportOptions& options,
                         MoleculeReader reader) {
  Scene scene;
  scene.source = path.string();
  const std::optional<std::string> positions = options.text("positions");
  ImportOptions of_file = options;
  if (positions) of_file.set("model", "1");  // the option then selects a frame of the array
  Molecule molecule = reader(read_text(path, {}), scene.source, of_file);
  const OptionFiles may_be_read(options);
  if (const std::optional<std::string> file = options.text("components"))
    for (auto& [name, bonds] : component_bonds_of(read_text(*file, {"--components"}), *file))
      molecule.components.insert_or_assign(name, std::move(bonds));
  const std::vector<Representation> representations =
      asked_representations(options, automatic_style(molecule, options));
  for (const Representation& as : representations) check_asked(molecule, as);
  if (options.text("range") && std::ranges::none_of(representations, [](const Representation& as) {
        return shows_values(as.by);
      }))
    throw InputError({"--range"}, "goes with colours by bfactor, charge or distance");
  const bool has_bonds = std::ranges::any_of(
      representations, [](const Representation& as) { return as.style != MoleculeStyle::spheres; });
  const std::vector<Bond> bonds =
      has_bonds ? all_bonds(molecule, scene.source) : std::vector<Bond>();
  if (positions) move_atoms(molecule, *positions, options.number("model", 1));
  const bool by_file =
      options.choice("secondary", {"file", "dssp"}, molecule.states_secondary ? 0 : 1) == 0;
  std::vector<Secondary> secondary;
  const auto with_secondary = [&]() -> const std::vector<Secondary>& {
    if (secondary.empty()) secondary = asked_secondary(molecule, by_file, scene.source);
    return secondary;
  };
  std::map<std::tuple<MoleculeColor, double, double, double, std::string>, Painter> painters;
  std::vector<MoleculeDrawing> drawings;
  for (const Representation& as : representations) {
    if (as.style == MoleculeStyle::cartoon || as.by == MoleculeColor::secondary) with_secondary();
    std::vector<bool> chosen = selected_atoms(molecule, as.selection, with_secondary);
    if (std::ranges::find(chosen, true) == chosen.end())
      log::warn("{}: --show '{}' selects no atoms", scene.source, as.selection);
    const std::tuple key(as.by, as.color.x, as.color.y, as.color.z, as.from);
    auto painter = painters.find(key);
    if (painter == painters.end())
      painter = painters
                    .try_emplace(key, scene, molecule, secondary, as,
                                 atom_values(molecule, as, options, with_secondary))
                    .first;
    drawings.emplace_back(molecule, bonds, secondary, std::move(chosen), as, painter->second);
    if (shows_values(as.by) && !scene.legend) scene.legend = painter->second.legend();
  }
  const std::optional<std::string> assembly = options.text("assembly");
  if (assembly && *assembly != "none") {
    add_assembly(scene, molecule, *assembly, drawings);
  } else {
    const std::vector<bool> kept(molecule.residues.size(), true);
    for (MoleculeDrawing& drawing : drawings)
      for (Shape& shape : drawing.shapes(scene, kept)) scene.shapes.push_back(std::move(shape));
    if (scene.shapes.empty() && options.text("show"))
      throw InputError({"--show"}, "selects none of the file's atoms, or nothing that is drawn");
  }
  for (const auto& [key, painter] : painters) {
    const std::optional<Legend> legend = painter.legend();
    if (legend && scene.legend)
      add_names(*scene.legend, *legend);
    else if (legend)
      scene.legend = legend;
  }
  scene.contents = contents_of(molecule);
  scene.has_no_up = true;
  scene.unit = "\u00c5";
  Imported out(std::move(scene));
  out.frames = molecule.frames;
  return out;
}

}  // namespace

Imported import_pdb(const std::filesystem::path& path, const ImageReader&,
                    const ImportOptions& options) {
  return import_molecule(path, options, read_pdb);
}
Imported import_mmcif(const std::filesystem::path& path, const ImageReader&,
                      const ImportOptions& options) {
  return import_molecule(path, options, read_mmcif);
}
Imported import_pqr(const std::filesystem::path& path, const ImageReader&,
                    const ImportOptions& options) {
  return import_molecule(path, options, read_pqr);
}
Imported import_sdf(const std::filesystem::path& path, const ImageReader&,
                    const ImportOptions& options) {
  return import_molecule(path, options, read_sdf);
}
Imported import_xyz(const std::filesystem::path& path, const ImageReader&,
                    const ImportOptions& options) {
  return import_molecule(path, options, read_xyz);
}

}  // namespace caplet
