// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Crystals of small molecules and minerals: files of the core CIF dictionary, whose atoms are at
// fractions of a cell.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <gemmi/cifdoc.hpp>
#include <gemmi/numb.hpp>
#include <gemmi/symmetry.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "import/detail/molecule.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

constexpr double kSame = 0.4;  // angstroms: closer copies of one atom are the same
constexpr std::size_t kMostOperators =
    192;  // of a space group: 48 of the point group times four of the centring

/// Maps an atom to `turn` times its coordinates plus `shift`. Coordinates are fractions of the
/// cell.
struct Operator {
  glm::dmat3 turn{0};
  glm::dvec3 shift{0};
};

class CrystalReader {
 public:
  CrystalReader(const std::string& path, const ImportOptions& options)
      : path_(path), options_(options) {}

  Molecule read(gemmi::cif::Block& block) {
    if (options_.text("select"))
      throw InputError({"--select"}, "says nothing to a crystal of fractions: it has no residues");
    read_cell(block);
    read_sites(block);
    out_.name = block.name;
    out_.chains.emplace_back();
    Residue all;
    all.atom_count = static_cast<std::uint32_t>(out_.atoms.size());
    out_.residues.push_back(all);
    out_.assemblies["cell"] = {{{""}, {}, {glm::dmat4(1)}}};
    if (options_.text("assembly") == "cell") fill_cell(operators(block));
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({path_, 0, 0}, message);
  }

  void read_cell(gemmi::cif::Block& block) {
    std::array<double, 6> cell{};
    std::size_t count = 0;
    for (const char* tag : {"_cell_length_a", "_cell_length_b", "_cell_length_c",
                            "_cell_angle_alpha", "_cell_angle_beta", "_cell_angle_gamma"}) {
      const std::string* text = block.find_value(tag);
      // Angles default to 90 degrees.
      cell.at(count) = !text && count > 2 ? 90
                       : text             ? gemmi::cif::as_number(*text)
                                          : std::numeric_limits<double>::quiet_NaN();
      if (!(cell.at(count) > 0) || !(cell.at(count) < (count > 2 ? 180 : 1e6)))
        fail(fmt::format("{} is {}, and the atoms are fractions of the cell", tag,
                         text ? caplet::quoted(*text) : "missing"));
      ++count;
    }
    // a lies along x, b in the plane of x and y (International Tables for Crystallography B, 1.1).
    const double ca = std::cos(glm::radians(cell[3])), cb = std::cos(glm::radians(cell[4]));
    const double cg = std::cos(glm::radians(cell[5])), sg = std::sin(glm::radians(cell[5]));
    const double x = (ca - cb * cg) / sg, square = 1 - cb * cb - x * x;
    if (!(square > 1e-9)) fail("the angles of the cell are those of no cell");
    place_from_fraction_ = {{cell[0], 0, 0},
                            {cell[1] * cg, cell[1] * sg, 0},
                            {cell[2] * cb, cell[2] * x, cell[2] * std::sqrt(square)}};
  }

  void read_sites(gemmi::cif::Block& block) {
    const std::string altloc = options_.text("altloc").value_or("first");
    const bool hydrogens = options_.yes("hydrogens", true);
    std::int64_t first_group = 0;
    std::size_t without_place = 0;
    for (const auto row :
         block.find("_atom_site_",
                    {"label", "fract_x", "fract_y", "fract_z", "?type_symbol", "?U_iso_or_equiv",
                     "?B_iso_or_equiv", "?disorder_group", "?calc_flag"})) {
      if (row.has2(8) && row.str(8) == "dum") continue;
      const glm::dvec3 fraction(gemmi::cif::as_number(row[1]), gemmi::cif::as_number(row[2]),
                                gemmi::cif::as_number(row[3]));
      if (gemmi::cif::is_null(row[1]) || gemmi::cif::is_null(row[2]) ||
          gemmi::cif::is_null(row[3])) {
        ++without_place;
        continue;
      }
      Atom atom;
      atom.element = element_in(row.has2(4) ? row.str(4) : row.str(0));
      if (atom.element == 0) atom.element = element_in(row.str(0));
      if (atom.hydrogen() && !hydrogens) continue;
      // Disordered atoms have a small group number; a negative one is disorder about a symmetry
      // element.
      std::int64_t group = 0;
      if (row.has2(7) && parse_number(std::string_view(row.str(7)), group) && group != 0) {
        if (first_group == 0) first_group = group;
        const auto letter = static_cast<char>('0' + std::abs(group % 10));
        if (altloc == "first" ? group != first_group
                              : altloc != "all" && altloc != std::string(1, letter))
          continue;
        atom.altloc = letter;
      }
      if (row.has2(5))
        atom.b_factor =
            b_factor(8 * glm::pi<double>() * glm::pi<double>() * gemmi::cif::as_number(row[5]));
      if (!row.has2(5) && row.has2(6)) atom.b_factor = b_factor(gemmi::cif::as_number(row[6]));
      out_.has_b_factors |= atom.b_factor != 0;
      add(atom, fraction, row.str(0));
    }
    if (out_.atoms.empty())
      fail(without_place > 0 ? "holds no atoms whose place is known and that are asked for"
                             : "holds no atoms that are asked for");
  }

  static float b_factor(double value) {
    return std::abs(value) <= static_cast<double>(largest_number) ? static_cast<float>(value) : 0;
  }

  /// Reads "Si4+", "C12", "FE". If the first two letters are no element, the first one is used.
  static std::uint8_t element_in(const std::string& symbol) {
    std::size_t letters = 0;
    while (letters < symbol.size() && std::isalpha(static_cast<unsigned char>(symbol[letters])))
      ++letters;
    for (std::size_t count = std::min<std::size_t>(letters, 2); count > 0; --count)
      if (const std::uint8_t element = element_of(symbol.substr(0, count))) return element;
    return 0;
  }

  void add(Atom atom, const glm::dvec3& fraction, const std::string& label) {
    const glm::dvec3 p = place_from_fraction_ * fraction;
    for (int axis = 0; axis < 3; ++axis)
      if (!(std::abs(p[axis]) <= static_cast<double>(largest_number)))
        fail("the atom " + caplet::quoted(label) + " has no finite place");
    atom.position = p;
    atom.serial = static_cast<std::int32_t>(out_.atoms.size()) + 1;
    out_.atoms.push_back(atom);
    out_.atom_names.push_back(label);
    fractions_.push_back(fraction);
  }

  // --- All of the cell ---

  /// Parses "x+1/2, -y, z-x".
  Operator parse_operator(const std::string& text) const {
    Operator out;
    int row = 0;
    double sign = 1, number = 0;
    bool has_number = false;
    const auto end_of_term = [&] {
      if (has_number) out.shift[row] += sign * number;
      has_number = false;
      sign = 1;
    };
    for (std::size_t i = 0; i < text.size();) {
      const auto c = static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
      if (c == ',') {
        end_of_term();
        if (++row > 2) break;
      } else if (c == '+' || c == '-') {
        end_of_term();
        sign = c == '-' ? -1 : 1;
      } else if (c >= 'x' && c <= 'z') {
        out.turn[c - 'x'][row] += sign * (has_number ? number : 1);
        has_number = false;
      } else if (std::isdigit(static_cast<unsigned char>(c)) || c == '.') {
        std::size_t end = i;
        while (end < text.size() &&
               (std::isdigit(static_cast<unsigned char>(text[end])) || text[end] == '.'))
          ++end;
        double value = 0;
        if (!parse_number(std::string_view(text).substr(i, end - i), value)) row = 3;
        number = has_number && i > 0 && text[i - 1] == '/' ? number / value : value;
        has_number = true;
        i = end;
        continue;
      } else if (c != ' ' && c != '\t' && c != '/' && c != '*') {
        row = 3;
        break;
      }
      ++i;
    }
    if (row != 2)
      fail(caplet::quoted(text) + " is no operator: three parts of x, y, z and fractions");
    end_of_term();
    const double turned = std::abs(glm::determinant(out.turn));
    if (!(std::abs(turned - 1) < 1e-6) || !(glm::dot(out.shift, out.shift) < 1e6))
      fail(caplet::quoted(text) + " is no operator of a crystal");
    return out;
  }

  std::vector<Operator> operators(gemmi::cif::Block& block) const {
    std::vector<Operator> out;
    for (const char* tag : {"_space_group_symop_operation_xyz", "_symmetry_equiv_pos_as_xyz"}) {
      for (const std::string& text : block.find_values(tag)) {
        if (out.size() == kMostOperators)
          fail(fmt::format("more than {} operators", kMostOperators));
        out.push_back(parse_operator(gemmi::cif::as_string(text)));
      }
      if (!out.empty()) return out;
    }
    for (const char* tag : {"_space_group_name_H-M_alt", "_symmetry_space_group_name_H-M"})
      if (const std::string* name = block.find_value(tag))
        if (const gemmi::SpaceGroup* group =
                gemmi::find_spacegroup_by_name(gemmi::cif::as_string(*name))) {
          for (const gemmi::Op& op : group->operations().all_ops_sorted())
            out.push_back(parse_operator(op.triplet()));
          return out;
        }
    fail("has neither operators nor the name of a space group: its cell cannot be filled");
  }

  /// Returns connected components of the bonds, each as a list of atoms.
  std::vector<std::vector<std::uint32_t>> fragments() const {
    std::vector<std::uint32_t> root(out_.atoms.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&root](std::uint32_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    for (const auto& [a, b] : all_bonds(out_, path_)) root[find(b)] = find(a);
    std::vector<std::vector<std::uint32_t>> out;
    std::vector<std::int64_t> index(root.size(), -1);
    for (std::uint32_t i = 0; i < root.size(); ++i) {
      std::int64_t& at = index[find(i)];
      if (at < 0) {
        at = static_cast<std::int64_t>(out.size());
        out.emplace_back();
      }
      out[static_cast<std::size_t>(at)].push_back(i);
    }
    return out;
  }

  /// Adds the operators' copies of all atoms without duplicates. A bonded group moves as a whole,
  /// with its centre in the cell.
  void fill_cell(const std::vector<Operator>& operators) {
    const std::vector<std::vector<std::uint32_t>> parts = fragments();
    const std::vector<Atom> atoms = std::move(out_.atoms);
    const std::vector<std::string> names = std::move(out_.atom_names);
    const std::vector<glm::dvec3> fractions = std::move(fractions_);
    out_.atoms.clear();
    out_.atom_names.clear();
    fractions_.clear();
    for (const std::vector<std::uint32_t>& part : parts) {
      std::vector<std::vector<glm::dvec3>> copies(part.size());
      for (const Operator& op : operators) {
        std::vector<glm::dvec3> placed;
        glm::dvec3 middle(0);
        for (const std::uint32_t atom : part) {
          placed.push_back(op.turn * fractions[atom] + op.shift);
          middle += placed.back() / static_cast<double>(part.size());
        }
        const glm::dvec3 shift = -glm::floor(
            middle + 1e-6);  // a centre on the cell's face stays on this side despite rounding
        for (std::size_t i = 0; i < part.size(); ++i) {
          const glm::dvec3 p = placed[i] + shift;
          const bool known =
              std::any_of(copies[i].begin(), copies[i].end(), [&](const glm::dvec3& other) {
                const glm::dvec3 d = p - other;
                return glm::length(place_from_fraction_ * (d - glm::round(d))) < kSame;
              });
          if (known) continue;
          copies[i].push_back(p);
          add(atoms[part[i]], p, names[part[i]]);
        }
      }
    }
    out_.residues.front().atom_count = static_cast<std::uint32_t>(out_.atoms.size());
  }

  const std::string& path_;
  const ImportOptions& options_;
  glm::dmat3 place_from_fraction_{1};
  std::vector<glm::dvec3> fractions_;  // of each atom
  Molecule out_;
};

}  // namespace

std::optional<Molecule> read_crystal(gemmi::cif::Document& document, const std::string& path,
                                     const ImportOptions& options) {
  std::vector<gemmi::cif::Block*> blocks;
  for (gemmi::cif::Block& block : document.blocks)
    if (block.find_values("_atom_site_fract_x").length() > 0) blocks.push_back(&block);
  if (blocks.empty()) return std::nullopt;
  const std::uint32_t number = options.number("model", 1);
  if (number > blocks.size())
    throw InputError({"--model"},
                     fmt::format("{}: the file has {} structures", number, blocks.size()));
  Molecule out = CrystalReader(path, options).read(*blocks[number - 1]);
  out.frames = static_cast<std::uint32_t>(blocks.size());
  return out;
}

}  // namespace caplet
