// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A molecule as its file states it, in any format: atoms, residues, chains and explicit bonds.
// Lengths are in angstroms. Conventions: docs/formats/molecules.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "import/import_options.h"

namespace gemmi::cif {
struct Document;
}

namespace caplet {

struct Atom {
  glm::vec3 position{0};
  float b_factor = 0;         // square angstroms; 0 where the file has none
  float charge = 0;           // elementary charges; 0 where the file has none
  float radius = -1;          // angstroms; negative where the file has none
  std::uint32_t residue = 0;  // index into Molecule::residues
  std::int32_t serial = 0;    // the file's number, used by its bonds
  std::uint8_t element = 0;   // atomic number; 0: unknown
  char altloc = '\0';
  bool hydrogen() const { return element == 1; }
};

enum class ResidueKind : std::uint8_t { other, amino_acid, nucleotide, water };

/// What a residue is part of; a strand of a sheet.
enum class Secondary : std::uint8_t { coil, helix, strand };

struct Residue {
  std::string name;         // "TRP"; empty for formats without residues
  std::string number;       // "33", "33A" with an insertion code; empty for such formats
  std::uint32_t chain = 0;  // index into Molecule::chains
  std::string part;         // mmCIF's label_asym_id, which assemblies use; otherwise empty
  std::uint32_t first_atom = 0, atom_count = 0;
  std::int32_t trace_atom = -1;  // the alpha carbon or the phosphorus: index into atoms
  ResidueKind kind = ResidueKind::other;
  Secondary stated = Secondary::coil;  // by the file's records, where it has any
};

/// Neighbours of a chain whose alpha carbons, or phosphorus atoms, are further apart have residues
/// missing between them; in angstroms.
inline constexpr float calpha_gap = 4.6F, phosphorus_gap = 9.0F;

using Bond = std::pair<std::uint32_t, std::uint32_t>;  // atoms, the smaller index first

/// Copies of some chains. Each of `operators` makes one copy.
struct AssemblyPart {
  std::vector<std::string> chains, parts;  // author names, or label_asym_id; one list is empty
  std::vector<glm::dmat4> operators;
};

/// Bonds within residues: pairs of atom names, by the component's name.
using ComponentBonds = std::map<std::string, std::vector<std::pair<std::string, std::string>>>;

struct Molecule {
  std::string name;
  std::vector<std::string> chains;
  std::vector<Residue> residues;  // the atoms of a residue are consecutive
  std::vector<Atom> atoms;
  std::vector<std::string>
      atom_names;                   // the name of each atom, "CA"; empty for formats without names
  std::vector<Bond> bonds;          // those that the file states
  bool bonds_are_complete = false;  // no further bonds are sought by distance
  ComponentBonds components;        // those in the file
  std::map<std::string, std::vector<AssemblyPart>> assemblies;
  bool has_b_factors = false, has_charges = false;
  bool states_secondary = false;  // the file has records of helices or strands
  std::uint32_t frames = 1;       // models or frames of the file
};

/// Readers, each of one family of files. `path` is for messages; `text` is the file's text,
/// decompressed. The options model, altloc, select, hydrogens and water choose what is kept. They
/// throw InputError with the file's places.
Molecule read_pdb(std::string_view text, const std::string& path, const ImportOptions& options);
Molecule read_mmcif(std::string_view text, const std::string& path, const ImportOptions& options);
Molecule read_pqr(std::string_view text, const std::string& path, const ImportOptions& options);
Molecule read_sdf(std::string_view text, const std::string& path, const ImportOptions& options);
Molecule read_xyz(std::string_view text, const std::string& path, const ImportOptions& options);

/// Reads a crystal of the core CIF dictionary, whose atoms are at fractions of a cell; no value for
/// other documents. `--assembly cell` fills the cell by the file's operators or its space group's.
/// Throws InputError.
std::optional<Molecule> read_crystal(gemmi::cif::Document& document, const std::string& path,
                                     const ImportOptions& options);

/// Returns the atomic number of a symbol in any case ("Fe", "FE"), of "26", or of a symbol with
/// digits after it ("C12"); else 0.
std::uint8_t element_of(std::string_view symbol);
float covalent_radius(std::uint8_t element);       // Cordero et al. 2008, doi:10.1039/b801115j
float van_der_waals_radius(std::uint8_t element);  // Bondi 1964, Alvarez 2013, as gemmi lists them
/// Returns the file's radius of an atom, or its element's van der Waals radius.
float ball_radius_of(const Atom& atom);
glm::dvec3 element_color(std::uint8_t element);  // Jmol's colours, linear sRGB
const char* element_name(std::uint8_t element);  // "Fe"

/// Reads the components of an mmCIF file, such as one of the chemical component dictionary. Throws
/// InputError.
ComponentBonds component_bonds_of(std::string_view text, const std::string& path);

/// Returns all bonds of a molecule, sorted and without duplicates: those that the file states,
/// those of residues with a known component, and all others by distance: more than 0.4 and less
/// than the sum of the covalent radii and 0.45 angstroms, except between two hydrogens or between
/// different alternative places. If more than 256 atoms share a cell of the search, it warns and
/// finds none by distance.
std::vector<Bond> all_bonds(const Molecule& molecule, const std::string& path);

}  // namespace caplet
