// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Deep pictures: for each pixel the surfaces that its camera rays meet first, by their distance.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "film/film.h"

namespace caplet {

struct DeepSample {
  float depth = 0;  // as Z: distance from the camera
  float alpha = 0;  // of what the samples before let through, this one stops as much
};

/// Returns the layers that a film needs for deep pictures.
constexpr Layers deep_layers() { return Layers::none().with(Layer::depth).with(Layer::deep); }

/// Returns what a pixel shows from near to far: one sample for the distances within 1/64 of each
/// other, at their mean; all beyond the first CAPLET_SLOTS of these are one sample. Composited by
/// `over` their alpha is the coverage, and their mean distance by their shares is Z.
std::vector<DeepSample> deep_samples(const Film& film, std::size_t pixel);

/// Writes a deep scanline EXR with the channels A and Z of a film with deep_layers(), as
/// write_exr does. rows(first, count) returns these rows of it. Throws RunError.
void write_deep_exr(const std::filesystem::path& path, const FilmLayout& layout,
                    const std::function<Film(int first, int count)>& rows,
                    const std::map<std::string, std::string>& attributes);

}  // namespace caplet
