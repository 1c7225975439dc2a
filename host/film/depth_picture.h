// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Depth pictures, as depth cameras measure them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "film/film.h"

namespace caplet {

/// DepthPlane is a, b, c, d of the depths a x + b y + c z + d of points of the world.
using DepthPlane = std::array<double, 4>;

/// Returns the layers that a film needs for depth pictures.
constexpr Layers depth_layers(bool is_planar) {
  return Layers::none().with(is_planar ? Layer::position : Layer::depth);
}

/// Returns the depth of each pixel of a film with depth_layers(), in scene units: the mean of the
/// samples that hit something, of their distances from the camera or, with a plane, of the plane's
/// depths. NaN where no sample hits.
std::vector<float> depths_of(const Film& film, const std::optional<DepthPlane>& plane);

/// Returns depths in whole steps of `unit`; 0 where there is none and beyond 1 to 65535 steps.
/// `beyond` counts the latter.
std::vector<std::uint16_t> depth_steps(const std::vector<float>& depths, double unit,
                                       std::size_t& beyond);

/// DepthPicture says how a depth picture is written.
struct DepthPicture {
  std::filesystem::path path;       // .png: 16 bits of steps; any other: an EXR with the channel Z
  std::optional<DepthPlane> plane;  // of planar depths
  double unit = 0.001;              // of a PNG's steps, scene units
};

/// Writes the picture of a film as write_atomically does. rows(first, count) returns these rows of
/// the film. Throws RunError. Returns how many pixels of a PNG lie beyond its steps.
std::size_t write_depth(const DepthPicture& picture, const FilmLayout& layout,
                        const std::function<Film(int first, int count)>& rows,
                        const std::map<std::string, std::string>& attributes);

}  // namespace caplet
