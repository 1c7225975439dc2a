// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Peptides of the tests: backbones with given torsion angles, as text of PDB files.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace caplet::test {

struct BackboneAtoms {
  glm::dvec3 n, ca, c, o;
};

/// Returns the place at `length` from c, with the angle b-c-d and the torsion a-b-c-d in degrees.
inline glm::dvec3 placed(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         double length, double angle, double torsion) {
  const glm::dvec3 bc = glm::normalize(c - b), normal = glm::normalize(glm::cross(b - a, bc)),
                   up = glm::cross(normal, bc);
  const double bend = glm::radians(angle), turn = glm::radians(torsion);
  return c + length * (-std::cos(bend) * bc + std::sin(bend) * std::cos(turn) * up +
                       std::sin(bend) * std::sin(turn) * normal);
}

/// A backbone of `count` residues with these torsion angles in degrees and the bonds of Engh and
/// Huber 1991 (doi:10.1107/S0108767391001071), in angstroms.
inline std::vector<BackboneAtoms> backbone(int count, double phi, double psi) {
  std::vector<BackboneAtoms> out;
  glm::dvec3 n(0, 0, 0), ca(1.458, 0, 0), c = placed({0, 1, 0}, n, ca, 1.525, 111, 180);
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 next_n = placed(n, ca, c, 1.329, 116.6, psi),
                     o = placed(n, ca, c, 1.231, 120.1, psi + 180),
                     next_ca = placed(ca, c, next_n, 1.458, 121.7, 180),
                     next_c = placed(c, next_n, next_ca, 1.525, 111, phi);
    out.push_back({n, ca, c, o});
    n = next_n;
    ca = next_ca;
    c = next_c;
  }
  return out;
}

/// A line of an atom, by the columns of a PDB file.
inline std::string pdb_line(int serial, const std::string& name, const std::string& residue,
                            char chain, int number, const glm::dvec3& at, double b = 0,
                            char code = ' ', const std::string& element = "") {
  return fmt::format(
      "ATOM  {:5} {:4} {:>3} {}{:4}{}   {:8.3f}{:8.3f}{:8.3f}{:6.2f}{:6.2f}          {:>2}\n",
      serial, name.size() < 4 ? " " + name : name, residue, chain, number, code, at.x, at.y, at.z,
      1.0, b, element.empty() ? name.substr(0, 1) : element);
}

/// The lines of a backbone, its residues numbered from `first`.
inline std::string lines_of(const std::vector<BackboneAtoms>& atoms, char chain = 'A',
                            int first = 1, const std::string& residue = "ALA",
                            const glm::dvec3& moved = glm::dvec3(0)) {
  std::string out;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const int number = first + static_cast<int>(i), serial = 4 * static_cast<int>(i) + 1;
    out += pdb_line(serial, "N", residue, chain, number, atoms[i].n + moved);
    out += pdb_line(serial + 1, "CA", residue, chain, number, atoms[i].ca + moved, 0, ' ', "C");
    out += pdb_line(serial + 2, "C", residue, chain, number, atoms[i].c + moved);
    out += pdb_line(serial + 3, "O", residue, chain, number, atoms[i].o + moved);
  }
  return out;
}

}  // namespace caplet::test
