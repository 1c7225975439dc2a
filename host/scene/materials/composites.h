// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Groups of fields that several materials share.
#pragma once

#include "scene/field.h"
#include "scene/spectrum.h"

namespace caplet {

inline constexpr RoughnessFields surface_roughness = {{"alpha_u", "GGX alpha along dp/du", 0},
                                                      {"alpha_v", "GGX alpha along dp/dv", 0},
                                                      "roughness",
                                                      "uroughness",
                                                      "vroughness"};
inline constexpr RoughnessFields interface_roughness = {
    {"interface.alpha_u", "GGX alpha of the coat along dp/du", 0},
    {"interface.alpha_v", "GGX alpha of the coat along dp/dv", 0},
    "interface.roughness",
    "interface.uroughness",
    "interface.vroughness"};
inline constexpr RoughnessFields conductor_roughness = {
    {"conductor.alpha_u", "GGX alpha of the metal along dp/du", 0},
    {"conductor.alpha_v", "GGX alpha of the metal along dp/dv", 0},
    "conductor.roughness",
    "conductor.uroughness",
    "conductor.vroughness"};

inline constexpr Field metal_reflectance = {
    "reflectance", "reflectance at normal incidence, in place of eta and k", 0, 1};
inline constexpr MetalFields plain_metal = {
    {"eta", "real part of the metal's index of refraction", 0},
    {"k", "imaginary part of the metal's index of refraction", 0},
    metal_reflectance};
inline constexpr MetalFields coated_metal = {
    {"conductor.eta", "real part of the metal's index of refraction", 0},
    {"conductor.k", "imaginary part of the metal's index of refraction", 0},
    metal_reflectance};

/// Copper is the default metal.
Spectrum copper_eta() noexcept;
Spectrum copper_k() noexcept;

inline constexpr Field multiscatter_field = {
    "multiscatter", "restore the energy that one scattering at facets loses"};

}  // namespace caplet
