// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes of a medium or two, and what is seen of them.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "render_scene.h"

namespace caplet::test {

/// Parallel rays along +z through the square of half side `half` around the axis.
std::string parallel_view(double half = 1, int max_depth = 100);
/// Light of 1 from everywhere, found by rays alone; the same from a sphere around all, which is
/// sampled as well.
std::string white_sky();
std::string white_walls();

/// Mean of the picture's green, and its standard error.
Mean seen(const std::string& text, int samples, int size = 16);
/// The same of a scene of that size.
Mean seen(const Scene& scene, int samples);
/// Returns the means of the three channels.
std::array<Mean, 3> colors_seen(const std::string& text, int samples, int size = 16);

/// Within four standard errors and a share of it.
testing::AssertionResult agrees(const Mean& mean, double expected, double tolerance = 0.005);

/// Media "a", "b" and "c", which absorb 0.3, 0.5 and 0.9 per unit.
std::string three_media();
/// What the light along +z from the point of that height loses in them, as an optical length.
/// `before`: statements before the camera's.
double lost(double z, const std::string& shapes, const std::string& before = "",
            const std::string& lens = "");
/// Solids that light passes, around the z axis.
std::string sphere(double z, double r, const std::string& inside, const std::string& outside = "");
std::string box(double z0, double z1, const std::string& inside, const std::string& outside = "",
                double half = 1);

/// Mean of exp(-sigma l) over the chords l of a sphere that parallel rays meet.
double sphere_transmittance(double sigma, double radius);

}  // namespace caplet::test
