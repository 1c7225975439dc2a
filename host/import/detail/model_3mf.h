// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads 3MF packages: their XML parts, colours and beam lattices. Conventions: docs/formats/3mf.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/detail/xml.h"
#include "import/detail/zip_file.h"
#include "scene/scene.h"

namespace caplet::model_3mf {

/// Returns the name of an element or attribute without its namespace prefix.
std::string_view local_name(const char* name);
bool is(pugi::xml_node node, std::string_view name);
pugi::xml_node child(pugi::xml_node node, std::string_view name);
pugi::xml_attribute attribute(pugi::xml_node node, std::string_view name);

/// A part of the package with resources: objects and colours by their ids.
struct Part {
  Part(const std::filesystem::path& name, std::string text) : file(name, std::move(text)) {}

  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;
  /// Return the value of an attribute. A missing one is an error unless there is an `otherwise`.
  std::uint32_t whole(pugi::xml_node node, std::string_view name) const;
  std::optional<std::uint32_t> whole_if(pugi::xml_node node, std::string_view name) const;
  float number(pugi::xml_node node, std::string_view name) const;
  std::optional<float> positive_if(pugi::xml_node node, std::string_view name) const;
  /// Returns the file's 3 x 4 transform as a matrix of columns; the identity if it is missing.
  glm::dmat4 transform(pugi::xml_node node) const;

  XmlFile file;
  double millimetres = 1;  // per unit of length
  std::map<std::uint32_t, pugi::xml_node> objects;
  std::map<std::uint32_t, std::vector<glm::dvec4>> colors;  // linear, with alpha
  std::map<std::uint32_t, std::string>
      other_properties;  // properties that are not read, by element name
};

/// Makes materials of the scene from the colours of resources.
class Colors {
 public:
  explicit Colors(Scene& scene) : scene_(scene) {}
  /// Returns the colour of property `index` of resource `id`, if it has one. Throws InputError at
  /// `node` for missing ones.
  std::optional<glm::dvec4> of(const Part& part, std::optional<std::uint32_t> id,
                               std::optional<std::uint32_t> index, pugi::xml_node node);
  /// Returns the colour if all are equal, else their mean in steps of 1/31.
  static std::optional<glm::dvec4> mean(const std::vector<std::optional<glm::dvec4>>& colors);
  std::uint32_t material(const std::optional<glm::dvec4>& color);

 private:
  Scene& scene_;
  std::map<std::array<double, 3>, std::uint32_t> materials_;
  std::optional<std::uint32_t> plain_;
  bool has_warned_ = false;
};

/// Appends the shapes of an object's beam lattice. Throws InputError.
void add_lattice(const Part& part, pugi::xml_node object, pugi::xml_node lattice,
                 const std::vector<glm::vec3>& points, const std::string& name, Colors& colors,
                 std::vector<Shape>& shapes);

}  // namespace caplet::model_3mf
