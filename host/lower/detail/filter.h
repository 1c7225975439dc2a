// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts the pixel filter to the tables that kernels/math/filter.cl samples.
#pragma once

#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// Returns the value of the filter along one axis at `x` pixels from the centre (0 beyond
/// `radius`); the filter itself is the product of both axes'. It is not normalised. Box 1; triangle
/// radius - |x|; gaussian exp(-x^2 / 2 sigma^2) less its value at the radius; Mitchell and
/// Netravali 1988 with b and c, stretched to the radius.
double filter_value(const PixelFilter& filter, double x, double radius);

/// Fills filter_table, view.filter_width and filter_height. Each axis is piecewise linear over its
/// cells (box and triangle exactly; others within 1e-3 of the maximum); a cell never holds both
/// signs. The x axis first, then y: cells + 1 positions (pixels), cells + 1 running integrals of
/// |f| (0 to 1), cells + 1 values of f, and the integral of |f| over that of f.
void lower_filter(const PixelFilter& filter, FlatView& out);

}  // namespace caplet
