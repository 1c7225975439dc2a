// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The scene while its statements are read: shapes refer to materials and media that may be stated
// later. The functions of detail/pbrt/resolve.h replace these references at the end.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/spelling.h"
#include "import/detail/pbrt/materials.h"
#include "import/detail/pbrt/parameters.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// Warnings that are logged at the end: the first of each kind, with the number of the others.
class Warnings {
 public:
  void add(const SourceLocation& where, const std::string& message, const std::string& kind);
  void log(Diagnostics& diagnostics) const;

 private:
  struct Warning {
    SourceLocation where;
    std::string message, kind;
    std::size_t others = 0;
  };
  std::vector<Warning> warnings_;
};

struct MaterialStatement {
  std::string type, name;
  Parameters parameters;
  std::string refusal = {};  // why a type is not supported yet: an error only where a shape uses it
  SourceLocation where = {};
};

/// Shapes refer to this until all materials are known: the default, a Material statement, or a
/// name.
struct MaterialUse {
  std::optional<std::size_t> statement;
  std::string name;
  SourceLocation where;
  std::optional<std::uint32_t> made = {};  // a material of another file, already in the scene
};

/// The materials' statements, and their uses. Shape::material is an index into `uses`, of which the
/// first is the default.
struct MaterialDraft {
  std::vector<MaterialStatement> statements;
  std::map<std::string, std::size_t> named;
  std::vector<MaterialUse> uses{1};
  std::map<std::string, std::uint32_t> uses_by_name;
  std::set<std::string>
      said_two_sided;  // places of shapes whose statements state that they are not one-sided

  /// Returns the use of a name; `where` is that of the first use.
  std::uint32_t use_of_name(const std::string& name, const SourceLocation& where);
  /// Returns the statement of a use; no value for the default, for materials of other files and for
  /// unknown names.
  std::optional<std::size_t> statement_of(const MaterialUse& use) const;
};

struct MediumStatement {
  Medium medium;
  bool sound = false;
  std::optional<std::uint32_t> index = {};  // in the scene, once it is used
};

/// The media's statements by name, and their uses. The sides of shapes and the camera are indices
/// into `uses`.
struct MediumDraft {
  struct Use {
    std::string name;
    SourceLocation where;
  };
  std::map<std::string, MediumStatement> statements;
  std::vector<Use> uses;
};

struct ObjectDraft {
  struct Instance {
    std::string name;
    glm::dmat4 world_from_object;
    SourceLocation where;
    TransformKeys motion;
    glm::dvec3 pivot;
  };
  /// A shape that moves within an object: an object of its own, placed in every instance.
  struct MovingShape {
    std::uint32_t of;      // the object that it was stated in
    std::uint32_t object;  // its own
    TransformKeys motion;  // object_from_shape
  };
  std::map<std::string, std::uint32_t> names;
  std::optional<std::size_t> open;  // the object that is being defined
  SourceLocation open_where;
  std::vector<Instance> instances;
  std::vector<MovingShape> moving;

  /// Adds a shape that moves, which is in its own space, to the world or to the open object.
  void add_moving(Shape shape, TransformKeys motion, Scene& scene);
};

struct Draft {
  std::string main_file;
  const ImageReader& images;
  Diagnostics diagnostics = Diagnostics();
  Warnings warnings = {};
  Scene scene = {};
  MaterialDraft materials = {};
  MediumDraft media = {};
  ObjectDraft objects = {};
  TextureTable textures = {};
  std::map<std::pair<std::string, ImageEncoding>, std::shared_ptr<const TextureImage>>
      texture_images = {};
  SharedParameters attributes = {};  // of all Attribute statements

  /// Reads the images that parameters name, each once. The draft must outlive what is returned.
  TextureImages image_finder();
  /// Calls `visit` with every shape of the scene and of its objects.
  template <class Visit>
  void each_shape(const Visit& visit) {
    for (Shape& shape : scene.shapes) visit(shape);
    for (Object& object : scene.objects)
      for (Shape& shape : object.shapes) visit(shape);
  }
  /// Returns "; the nearest known name is ..." for errors that are shown; the search is skipped for
  /// the rest, as it is slow.
  template <class Map>
  std::string nearest(const std::string& name, const Map& map) const {
    if (map.empty() || diagnostics.is_full()) return {};
    std::vector<std::string> known;
    known.reserve(map.size());
    for (const auto& [one, value] : map) known.push_back(one);
    return "; the nearest known name is \"" + nearest_name(name, known) + "\"";
  }
};

}  // namespace caplet::pbrt
