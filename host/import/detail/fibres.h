// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Files of polylines: hair and streamlines. Conventions: docs/formats/fibres.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace caplet {

struct Fibres {
  std::vector<glm::vec3> points;
  std::vector<std::uint64_t> ends;  // of each fibre: one after its last point
  std::vector<float> radii;         // empty, one in all, or one a point
  std::vector<glm::vec3> colors;    // empty, one in all, or one a point: linear reflectance, 0 to 1
};

/// Readers of a file's bytes; `path` is for messages. What is announced and not there is an error before memory is taken for it.
/// Throw InputError.
Fibres read_hair(std::string_view bytes, const std::string& path);     // cyHair
Fibres read_tressfx(std::string_view bytes, const std::string& path);  // TressFX .tfx, version 4
Fibres read_trk(std::string_view bytes, const std::string& path);      // TrackVis; points in RAS+ millimetres
Fibres read_tck(std::string_view bytes, const std::string& path);      // MRtrix
Fibres read_trx(const std::filesystem::path& path);                    // TRX, an archive
Fibres read_vtk(std::string_view bytes, const std::string& path);      // legacy VTK, POLYDATA with LINES

}  // namespace caplet
