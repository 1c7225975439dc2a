// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// Returns the single-scattering albedo at which a half-space behind a smooth boundary of relative
/// index `eta` > 0 reflects the share `reflectance` (0 to 1) of diffuse incident light. g: mean
/// cosine, -1 < g < 1.
///
/// For isotropic scattering (g 0) the albedo solves the transport equation: Chandrasekhar's
/// reflection of a half-space (Radiative Transfer, 1950) with internal reflection at the boundary;
/// within 0.001. Otherwise similarity keeps (1 - albedo) / (1 - g albedo) the same: reflectances
/// are within 0.02 up to a g of 0.7, and too low where they are small.
double albedo_within(double reflectance, double eta, double g);

}  // namespace caplet
