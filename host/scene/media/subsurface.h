// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// The share of scattering in what a collision takes, such that half of space behind a smooth boundary of relative index `eta` >
/// 0 sends back `reflectance` (0 to 1) of the even light that has come in through it. g: mean cosine, -1 < g < 1.
///
/// Of even scattering (g 0) it is that of transport: Chandrasekhar's reflection of half of space (Radiative Transfer, 1950) and
/// what the boundary sends back within, solved together; within 0.001 of it. Otherwise by similarity, (1 - albedo) / (1 - g
/// albedo) being the same: reflectances come out within 0.02 up to a g of 0.7, too low where they are small.
double albedo_within(double reflectance, double eta, double g);

}  // namespace caplet
