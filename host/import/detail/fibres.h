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

/// Numbers of points or of fibres, which colours may tell: which of a file's, and then they.
struct FibreScalars {
  std::string wanted;              // by its name; empty: the first
  std::vector<std::string> names;  // of those that the file has, until the wanted one was found
  std::string name;                // of what was taken; empty: none
  bool of_points = true;
  std::vector<float> values;  // one a point, or one a fibre

  /// Which component of the file's next array is to be taken into `values`; -1: none. Components of several are "NAME[0]" and so
  /// on. Once one was taken no other is.
  int take(const std::string& array, std::size_t components, bool are_of_points);
};

/// Readers of a file's bytes; `path` is for messages. What is announced and not there is an error before memory is taken for it.
/// `scalars`: what is sought there too. Throw InputError.
Fibres read_hair(std::string_view bytes, const std::string& path);     // cyHair
Fibres read_tressfx(std::string_view bytes, const std::string& path);  // TressFX .tfx, version 4
Fibres read_trk(std::string_view bytes, const std::string& path,
                FibreScalars* scalars = nullptr);                                     // TrackVis; points in RAS+ millimetres
Fibres read_tck(std::string_view bytes, const std::string& path);                     // MRtrix
Fibres read_trx(const std::filesystem::path& path, FibreScalars* scalars = nullptr);  // TRX, an archive
Fibres read_vtk(std::string_view bytes, const std::string& path,
                FibreScalars* scalars = nullptr);  // legacy VTK, POLYDATA with LINES
Fibres read_vtp(std::string_view bytes, const std::string& path,
                FibreScalars* scalars = nullptr);  // VTK's XML, PolyData with Lines

}  // namespace caplet
