// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Sweeps: every kind of shape at one value after another of its aspect, radius, place, distance of
// the ray's origin and grazing angle, traced by the kernels and held against the reference.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cases.h"
#include "judge.h"

namespace caplet::test {

/// Every kind that a ray can hit, and `instance`: a unit sphere under an affine map, an ellipsoid.
std::vector<ShapeKind> sweep_kinds();

enum class AxisName { aspect, radius, place, away, graze };
struct Axis {
  AxisName name;
  const char* title;  // of the column
  const char* file;   // of the plot
  std::vector<double> values;
};
/// All five, in the order of AxisName.
const std::vector<Axis>& axes();
/// False where a kind has no such measure (a sphere has no aspect).
bool has_axis(int shape, AxisName axis);

/// What a cell's shapes and rays are like.
struct Setting {
  double radius = 1, aspect = 10;  // length over radius
  double place = 0;                // distance of the shape from the origin of coordinates
  double away = -1;  // distance of the ray's origin from the point aimed at, in radii; -1: all from
                     // one radius to two lengths
  double least_away = 0;  // and no less than this
  double graze = 0;  // 0: rays of all kinds; otherwise by how many radii, or at what angle, rays
                     // pass the surface
};
Setting setting_at(AxisName axis, double value);

struct SweepCases {
  CaseSet cases;
  std::vector<PlacedPrimitive> placed;  // of each primitive
  std::vector<double> radius;       // of each primitive in its space, what errors are compared with
  std::vector<std::uint32_t> cell;  // of each ray
  std::vector<std::uint8_t> passing;  // of each ray: made to pass the silhouette or an edge closely
  Case of(std::size_t ray) const;
};
/// `rays` rays for each value of the axis, through primitives that are each met by 50 of them.
SweepCases sweep_cases(int shape, AxisName axis, std::span<const double> values, int rays,
                       std::uint32_t seed);
/// The same for one setting, as cell `cell`.
void add_cell(int shape, const Setting& setting, std::uint32_t cell, int rays, CaseMaker& maker,
              SweepCases& out);

struct Cell {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t excused = 0,
                wrong = 0;  // differences from the reference that the referee calls touching;
                            // others, and hits out of bound
  std::uint64_t edge_on =
      0;  // hits of sheets seen edge-on, which may lie beside them (docs/numerics.md)
  double bound_worst = 0,
         bound_p99 = 0;  // distance of the hit from the true surface over the bound
  double radius_worst = 0, radius_p99 = 0;            // the same over the radius
  double ulps_p50 = 0, ulps_p99 = 0, ulps_worst = 0;  // error of t
  // These concern rays that pass closely: their number, how many get different answers from device
  // and reference, and the greatest distance from touching of such a ray (in radii, and over the
  // bound).
  std::uint64_t passing = 0, differ = 0;
  double differ_radii = 0, differ_bound = 0;
  std::vector<std::string> examples;  // of what is wrong, at most three
};

/// One a value.
std::vector<Cell> sweep(const Device& device, int shape, AxisName axis,
                        std::span<const double> values, int rays, std::uint32_t seed);

}  // namespace caplet::test
