// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A robot as its file has it, whatever the format: geoms, where they lie in the pose that was asked for. Metres, z up.
// Conventions: docs/formats/robots.md.
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "import/detail/xml.h"
#include "import/import_options.h"

namespace caplet {

enum class GeomKind { sphere, capsule, cylinder, box, mesh };

struct RobotGeom {
  GeomKind kind = GeomKind::sphere;
  glm::dvec3 size{0};  // half lengths; radius and half length; of a mesh its scale
  glm::dmat4 world{1};
  glm::dvec4 rgba{0.5, 0.5, 0.5, 1};  // as shown on a screen: sRGB
  std::string name;
  bool collides = false;  // collision geometry; else visual
  std::filesystem::path mesh;
  SourceLocation where;
};

struct Robot {
  std::vector<RobotGeom> geoms;
};

/// What --pose says: joint=value pairs.
struct Pose {
  explicit Pose(const ImportOptions& options);
  std::map<std::string, double> joints;  // metres and radians
};

/// Throws InputError with the file's places.
Robot read_urdf(const std::filesystem::path& path, const Pose& pose);

}  // namespace caplet
