// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scenes in the formats that Embree's tutorials read: XML with a companion file of numbers, and the
// viewer's .ecs. Conventions: docs/formats/embree.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "import/detail/mesh_file.h"
#include "import/detail/xml.h"
#include "scene/scene.h"

namespace caplet::embree {

/// An XML file and its lists of numbers, which are in the elements or in the companion file
/// NAME.bin or NAME.xml.bin.
class SceneFile {
 public:
  explicit SceneFile(const std::filesystem::path& path, const SourceLocation& named_at = {})
      : xml_(path, named_at) {}

  const std::filesystem::path& path() const { return xml_.path(); }
  pugi::xml_node root() const { return xml_.root(); }
  SourceLocation place(pugi::xml_node node) const { return xml_.place(node); }
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(place(node), message);
  }

  /// Returns an element's numbers, `width` per row; none without an element. Finite unless
  /// `with_nan`. Throws InputError.
  std::vector<float> floats(pugi::xml_node node, std::size_t width, bool with_nan = false);
  std::vector<std::uint32_t> indices(pugi::xml_node node, std::size_t width);
  std::vector<std::uint32_t> bytes(pugi::xml_node node);
  /// Returns all text of an element, across comments.
  static std::string text_of(pugi::xml_node node);

 private:
  /// Returns the bytes of `size` rows from `ofs` on.
  std::string_view binary(pugi::xml_node node, std::size_t row);

  XmlFile xml_;
  std::optional<std::string> companion_;
};

/// Counts what is drawn differently or not at all, and keeps the first place.
class Notes {
 public:
  void add(const std::string& what, const SourceLocation& where);
  void tell() const;

 private:
  struct Note {
    std::size_t count = 0;
    SourceLocation where;
  };
  std::map<std::string, Note> notes_;
};

/// What shapes take from a material.
using MeshMaterial = MtlMaterial;

/// Makes the shapes of a geometry element in its own coordinates; other elements give none. Throws
/// InputError.
bool is_geometry(std::string_view name);
std::vector<Shape> shapes_of(SceneFile& file, pugi::xml_node node, const MeshMaterial& look,
                             Notes& notes);

/// Adds a <material> to the scene. Throws InputError.
MeshMaterial read_material(SceneFile& file, pugi::xml_node node, const std::string& name,
                           Scene& scene, MeshImages& images, Notes& notes);

/// A light of an element or of the viewer's options: E, I or L. It shines along z of its own space.
struct LightElement {
  std::string name;  // the element's name
  glm::dvec3 emission{0};
  glm::dmat4 space{1};
  double least_angle = 0, most_angle = 0;  // degrees from the axis
  SourceLocation where;
};
bool is_light(std::string_view name);
/// Throws InputError.
LightElement read_light(SceneFile& file, pugi::xml_node node);
/// Adds a light or an emissive shape; nothing where the light is dark. Throws InputError.
void add_light(const LightElement& light, const glm::dmat4& world, Scene& scene);

/// Reads an AffineSpace. Throws InputError.
glm::dmat4 affine_space(SceneFile& file, pugi::xml_node node);

/// Embree's camera. The field of view, in degrees, spans the height.
struct View {
  glm::dvec3 from{0.0001, 0.0001, -3}, to{0}, up{0, 1, 0};
  double fov = 90;
  bool is_left_handed = false;
};
/// Throws InputError at `where` when the direction or angle is not valid.
Camera camera_of(const View& view, const FilmSettings& film, const SourceLocation& where);

/// The contents of a .ecs file.
struct ViewerOptions {
  std::vector<std::pair<std::filesystem::path, SourceLocation>> files;
  std::optional<View> view;
  std::optional<glm::ivec2> size;  // of the picture, in pixels
  std::vector<LightElement> lights;
};
/// Throws InputError with line and column.
ViewerOptions read_ecs(const std::filesystem::path& path, Notes& notes);

}  // namespace caplet::embree
