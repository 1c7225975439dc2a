// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Patches of molecular surfaces (kernels/shapes/molecular_patch.cl).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/check.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/shapes.h"

namespace caplet {

using glm::dvec3;
using Matrix = glm::dmat4;

namespace {

const float* data_of_patch(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return &leaves[molecular_patch_begin(p.data)];
}

bool is_torus(const float* data) { return std::bit_cast<std::uint32_t>(data[4]) == CAPLET_NONE; }

void put3(float* to, const dvec3& v) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(v[k]);
}

/// Returns where new data begin, in `size` floats or more.
std::uint32_t begin_data(std::vector<float>& leaves, std::size_t size) {
  const std::size_t begin = (leaves.size() + 7) / 8 * 8;
  leaves.resize(begin + (size + 7) / 8 * 8);
  return narrow<std::uint32_t>(begin);
}

/// Returns the bounds of a box's image.
Bounds image_of(const Bounds& box, const Matrix& m) {
  Bounds out;
  const dvec3 half = 0.5 * (box.max - box.min);
  dvec3 reach(0);
  for (int k = 0; k < 3; ++k) reach += glm::abs(dvec3(m[k])) * half[k];
  extend_box(out, apply_point(m, 0.5 * (box.min + box.max)), reach);
  return out;
}

/// Sets the primitive's data and its box. Numbers are rounded to floats and points reach beyond
/// their borders by some roundings of their size: 2^-18 of all lengths is more.
FlatPrimitive patch_primitive(std::uint32_t begin, const Bounds& bounds, const Matrix& m,
                              const dvec3& center, double size) {
  Bounds box = image_of(bounds, m);
  const double more = 0x1p-18 * (glm::length(box.max - box.min) + size + glm::length(center));
  box.min -= dvec3(more);
  box.max += dvec3(more);
  FlatPrimitive p = make_primitive(shape_molecular_patch);
  const dvec3 middle = 0.5 * (box.min + box.max);
  put(p, molecular_patch_at_c, middle);
  p.data[molecular_patch_at_r] =
      std::nextafter(static_cast<float>(0.5 * glm::length(box.max - box.min)), INFINITY);
  p.data[molecular_patch_at_begin] = std::bit_cast<float>(begin);
  for (int k = 0; k < 3; ++k) {
    p.kept_box()[k] = std::nextafter(static_cast<float>(box.min[k]), -INFINITY);
    p.kept_box()[3 + k] = std::nextafter(static_cast<float>(box.max[k]), INFINITY);
  }
  return p;
}

FlatPrimitive flat_ball_patch(const SurfacePatches& all, const SurfacePatches::BallPatch& patch,
                              const Matrix& m, double scale, std::vector<float>& leaves) {
  const std::uint32_t begin = begin_data(leaves, 8 + 4 * std::size_t{patch.plane_count});
  float* data = &leaves[begin];
  const dvec3 center = apply_point(m, patch.center);
  put3(data, center);
  data[3] = static_cast<float>(scale * patch.radius);
  data[4] = std::bit_cast<float>(patch.plane_count);
  data[5] = static_cast<float>(patch.probe);
  const glm::dmat3 turn = glm::dmat3(m) / scale;
  for (std::uint32_t i = 0; i < patch.plane_count; ++i) {
    const SurfacePatches::Plane& plane = all.planes[patch.plane_begin + i];
    put3(data + 8 + 4 * i, turn * plane.normal);
    data[8 + 4 * i + 3] = static_cast<float>(scale * plane.offset);
  }
  return patch_primitive(begin, patch.bounds, m, center, scale * patch.radius);
}

FlatPrimitive flat_torus_patch(const SurfacePatches::TorusPatch& patch, const Matrix& m,
                               double scale, std::vector<float>& leaves) {
  const std::uint32_t begin = begin_data(leaves, 24);
  float* data = &leaves[begin];
  const dvec3 center = apply_point(m, patch.center);
  const glm::dmat3 turn = glm::dmat3(m) / scale;
  // A reflection turns phi the other way; with the opposite axis it runs as before, and theta, its
  // height being turned over, from 2 pi - theta_min to 2 pi - theta_max.
  const bool mirrored = glm::determinant(turn) < 0;
  const auto theta = [&](double of) { return mirrored ? full_turn - of : of; };
  const double low = theta(mirrored ? patch.theta_max : patch.theta_min),
               high = theta(mirrored ? patch.theta_min : patch.theta_max);
  put3(data, center);
  data[3] = static_cast<float>(scale * patch.minor);
  data[4] = std::bit_cast<float>(CAPLET_NONE);
  data[5] = static_cast<float>(scale * patch.major);
  const bool whole = patch.phi_max >= full_turn;
  data[6] = whole ? 2.0f : static_cast<float>(std::cos(patch.phi_max));
  data[7] = whole ? 0.0f : static_cast<float>(std::sin(patch.phi_max));
  put3(data + 8, (mirrored ? -1.0 : 1.0) * (turn * patch.axis));
  data[11] = static_cast<float>(patch.phi_max);
  put3(data + 12, turn * patch.start);
  data[16] = static_cast<float>(std::cos(low));
  data[17] = static_cast<float>(std::sin(low));
  data[18] = static_cast<float>(std::cos(high));
  data[19] = static_cast<float>(std::sin(high));
  data[20] = static_cast<float>(theta(patch.theta_min));
  data[21] = static_cast<float>(theta(patch.theta_max));
  return patch_primitive(begin, patch.bounds, m, center, scale * (patch.major + patch.minor));
}

/// Calls `add` with some 65,000 elements of area (vectors along the normal) that make up the patch:
/// cells of the torus, or of the points of a Fibonacci lattice on the sphere.
template <class Add>
void for_each_element(const float* data, const Add& add) {
  if (is_torus(data)) {
    constexpr int n = 256;
    const dvec3 axis = point3(data + 8), x = point3(data + 12), y = glm::cross(axis, x);
    const double minor = double{data[3]}, major = double{data[5]}, low = double{data[20]};
    const double step_phi = double{data[11]} / n, step = (double{data[21]} - low) / n;
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k) {
        const double theta = low + (k + 0.5) * step, phi = (i + 0.5) * step_phi;
        const dvec3 spoke = std::cos(phi) * x + std::sin(phi) * y;
        const double area = (major + minor * std::cos(theta)) * minor * std::abs(step) * step_phi;
        add(area * (std::cos(theta) * spoke + std::sin(theta) * axis));
      }
    return;
  }
  const double r = double{data[3]};
  const auto count = std::bit_cast<std::uint32_t>(data[4]);
  constexpr int points = 65536;
  for (int i = 0; i < points; ++i) {
    const double z = 1 - (2 * i + 1) / double(points), across = std::sqrt(1 - z * z);
    const double phi = i * std::numbers::pi * (3 - std::sqrt(5));
    const dvec3 d(across * std::cos(phi), across * std::sin(phi), z);
    bool inside = true;
    for (std::uint32_t j = 0; j < count && inside; ++j)
      inside = r * glm::dot(point3(data + 8 + 4 * j), d) <= double{data[8 + 4 * j + 3]};
    if (inside) add((4 * std::numbers::pi * r * r / points) * d);
  }
}

}  // namespace

std::vector<FlatPrimitive> flat_patches(const MolecularSurfaceShape& molecule, const Matrix& m,
                                        std::vector<float>& leaves) {
  const double scale = similarity_scale(m);
  std::vector<FlatPrimitive> out;
  out.reserve(count_of(molecule));
  for (const auto& patch : molecule.patches->balls)
    out.push_back(flat_ball_patch(*molecule.patches, patch, m, scale, leaves));
  for (const auto& patch : molecule.patches->tori)
    out.push_back(flat_torus_patch(patch, m, scale, leaves));
  return out;
}

bool bakes_under(const MolecularSurfaceShape&, const Matrix& m) { return similarity_scale(m) > 0; }
glm::dmat3 turn_under(const MolecularSurfaceShape&, const Matrix& m) {
  return turn_of_similarity(m);
}

double molecular_patch_area(const float* data, const glm::dmat3& cofactor) {
  double area = 0;
  for_each_element(data, [&](const dvec3& element) { area += glm::length(cofactor * element); });
  return area;
}

double molecular_patch_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return molecular_patch_area(data_of_patch(p, leaves), glm::dmat3(1));
}

/// There are none: placed_area uses molecular_patch_area.
void molecular_patch_pieces(const FlatPrimitive&, const std::vector<float>&, Pieces&) {}

}  // namespace caplet
