// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// The share of scattering in what a collision takes, such that half of space behind a smooth boundary of relative index `eta`
/// sends back `reflectance` (0 to 1) of the light that has come in through it. g: mean cosine, -1 < g < 1.
///
/// The albedo of half of space under even light, without a boundary, is (1 - s)(1 - 0.139 s) / (1 + 1.17 s), s^2 = (1 - albedo) /
/// (1 - g albedo) (van de Hulst, "Multiple light scattering", 1980); the boundary's reflections of light from within are taken as
/// even too (Saunderson, "Calculation of the color of pigmented plastics", 1942).
double albedo_within(double reflectance, double eta, double g);

/// The part of even light that a smooth boundary reflects, seen from outside: index `eta` > 0 beyond it.
double even_reflectance(double eta);

}  // namespace caplet
