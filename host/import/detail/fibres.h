// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads files of polylines: hair and streamlines. Conventions: docs/formats/fibres.md.
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
  std::vector<std::uint64_t> ends;  // for each fibre, one after its last point
  std::vector<float> radii;         // empty, one for all, or one per point
  std::vector<glm::vec3>
      colors;  // empty, one for all, or one per point: linear reflectance, 0 to 1
};

/// Scalars of points or of fibres that colours may show: the request, and then the values that a
/// reader finds.
struct FibreScalars {
  std::string wanted;              // the requested name; empty: the first
  std::vector<std::string> names;  // names of the file's scalars, up to the requested one
  std::string name;                // the name of the scalar that was taken; empty: none
  bool of_points = true;
  std::vector<float> values;  // one per point, or one per fibre

  /// Returns which component of the file's next array is to be taken into `values`, or -1. Arrays
  /// of several components are named "NAME[0]" and so on. Only one array is taken.
  int take(const std::string& array, std::size_t components, bool are_of_points);
};

/// Readers of a file's bytes; `path` is for messages. Counts are checked against the size of the
/// file before memory is allocated. `scalars`: also fills the requested scalars. They throw
/// InputError.
Fibres read_hair(std::string_view bytes, const std::string& path);     // cyHair
Fibres read_tressfx(std::string_view bytes, const std::string& path);  // TressFX .tfx, version 4
Fibres read_trk(std::string_view bytes, const std::string& path,
                FibreScalars* scalars = nullptr);  // TrackVis; points in RAS+ millimetres
Fibres read_tck(std::string_view bytes, const std::string& path);  // MRtrix
Fibres read_trx(const std::filesystem::path& path,
                FibreScalars* scalars = nullptr);  // TRX, an archive
Fibres read_vtk(std::string_view bytes, const std::string& path,
                FibreScalars* scalars = nullptr);  // legacy VTK, POLYDATA with LINES
Fibres read_vtp(std::string_view bytes, const std::string& path,
                FibreScalars* scalars = nullptr);  // VTK's XML, PolyData with Lines

}  // namespace caplet
