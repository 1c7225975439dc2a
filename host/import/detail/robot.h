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

/// An XML file in memory, and the places of its elements.
class XmlFile {
 public:
  /// Throws InputError with line and column for what is no XML. NUL bytes at the end are left out.
  explicit XmlFile(const std::filesystem::path& path, const SourceLocation& named_at = {});
  pugi::xml_node root() const { return document_.document_element(); }
  SourceLocation place(pugi::xml_node node) const { return place(node.offset_debug()); }
  const std::filesystem::path& path() const { return path_; }

 private:
  SourceLocation place(std::ptrdiff_t offset) const;
  std::filesystem::path path_;
  std::string text_;
  std::vector<std::size_t> line_begins_{0};
  pugi::xml_document document_;
};

/// Finite numbers with blanks between them, at least `least` and at most `most`. Throws InputError.
std::vector<double> numbers_of(std::string_view text, std::size_t least, std::size_t most, const SourceLocation& where,
                               const std::string& what);

/// What --pose says: joint=value pairs.
struct Pose {
  explicit Pose(const ImportOptions& options);
  std::map<std::string, double> joints;  // metres and radians
};

/// Throws InputError with the file's places.
Robot read_urdf(const std::filesystem::path& path, const Pose& pose);

}  // namespace caplet
