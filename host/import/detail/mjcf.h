// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads the text of MJCF, MuJoCo's models (MuJoCo's XML reference describes the format): included
// files, defaults, poses and attributes.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "import/detail/robot.h"

namespace caplet::mjcf {

/// The deepest nesting of elements and of models; elements that replicate creates count too.
inline constexpr int most_nested = 500;
inline constexpr std::size_t most_elements = 4'000'000, most_geoms = 1'000'000;
/// The most bytes of a model's procedural textures and height fields.
inline constexpr std::size_t most_made = std::size_t{1} << 30;

/// A default class: its own attributes, and the class that it inherits from.
struct Class {
  const Class* parent = nullptr;
  std::vector<pugi::xml_node> elements;
};

struct Compiler {
  bool degrees = true, strips_paths = false, fits_extents = false;
  std::string euler = "xyz";
  std::filesystem::path meshes, textures;  // folders
};

class Model;

/// An element with the defaults of its class. `tag`: the name of the element in defaults.
class Element {
 public:
  Element(const Model& model, pugi::xml_node node, const char* tag, const Class* of)
      : model_(&model), node_(node), tag_(tag), class_(of) {}

  pugi::xml_node node() const { return node_; }
  const Model& model() const { return *model_; }
  SourceLocation where() const;
  [[noreturn]] void fail(const std::string& message) const;

  /// Returns its own attribute, or that of the nearest class that has it.
  pugi::xml_attribute attribute(const char* name) const;
  bool has(const char* name) const { return static_cast<bool>(attribute(name)); }
  std::string text(const char* name, const std::string& otherwise = {}) const;
  bool yes(const char* name, bool otherwise) const;
  /// Returns `otherwise` with its first numbers replaced by the attributes', outer classes first;
  /// each has at least `least`.
  std::vector<double> numbers(const char* name, std::size_t least,
                              std::vector<double> otherwise) const;
  double number(const char* name, double otherwise) const {
    return numbers(name, 1, {otherwise})[0];
  }
  glm::dvec3 vector(const char* name, glm::dvec3 otherwise) const;
  /// Returns the index of the attribute's value in `choices`.
  std::size_t choice(const char* name, std::initializer_list<const char*> choices,
                     std::size_t otherwise) const;
  /// Returns an angle in radians.
  double angle(const char* name, double otherwise) const;

  /// Reads quat, axisangle, euler, xyaxes or zaxis, of which at most one may be present.
  glm::dquat rotation() const;
  /// Combines pos and rotation.
  glm::dmat4 pose() const;

 private:
  template <class Use>
  void levels(Use&& use)
      const;  // visits nodes that may have attributes, nearest first, until `use` is true
  const Model* model_;
  pugi::xml_node node_;
  const char* tag_;
  const Class* class_;
};

/// Returns the shortest rotation that takes z to this direction.
glm::dquat from_z(const glm::dvec3& direction);
glm::dmat4 placed(const glm::dvec3& position, const glm::dquat& rotation);

/// A model: its sections, defaults and assets. Throws InputError.
class Model {
 public:
  /// `above`: the models that are being read, without this one's file.
  Model(const std::filesystem::path& path, const SourceLocation& named_at,
        std::set<std::string> above);

  /// Calls use(child) for the elements in `of`; elements of an included file come where it is
  /// included.
  template <class Use>
  void each(pugi::xml_node of, Use&& use) const {
    for (const pugi::xml_node child : of.children()) {
      if (child.type() != pugi::node_element) continue;
      if (std::string_view(child.name()) == "include")
        each(included(child), use);
      else
        use(child);
    }
  }

  const std::string& name() const { return name_; }
  const Compiler& compiler() const { return compiler_; }
  const std::filesystem::path& folder() const { return folder_; }
  SourceLocation place(pugi::xml_node node) const;
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;

  /// Returns the sections of this name.
  std::vector<pugi::xml_node> sections(std::string_view name) const;
  pugi::xml_node root() const { return root_; }
  const Class* root_class() const { return &classes_.at("main"); }
  /// Returns the class that `node` names by `attribute`, or `otherwise`.
  const Class* class_of(pugi::xml_node node, const char* attribute, const Class* otherwise) const;
  Element element(pugi::xml_node node, const char* tag, const Class* otherwise) const {
    return {*this, node, tag, class_of(node, "class", otherwise)};
  }

  /// Returns the asset of a kind ("mesh", "texture", ...) by its name. Throws InputError at `user`.
  Element asset(const char* kind, const std::string& name, const SourceLocation& user) const;
  /// Returns the model that an asset names. It is read at its first use.
  const Model& attached(const std::string& name, const SourceLocation& user) const;
  std::filesystem::path file(const Element& of, const std::string& name,
                             const std::filesystem::path& folder) const;
  const std::map<std::string, pugi::xml_node>& assets(const char* kind) const;

 private:
  pugi::xml_node included(pugi::xml_node node) const;
  void read_compiler(pugi::xml_node node);
  void read_defaults(pugi::xml_node node, const Class* parent, int depth);
  void read_assets(pugi::xml_node node);

  std::filesystem::path folder_;
  mutable std::map<const void*, std::unique_ptr<XmlFile>> files_;  // by document
  mutable std::map<const void*, pugi::xml_node>
      includes_;                        // the root of the included file, by element
  mutable std::set<std::string> seen_;  // files that were included
  std::set<std::string> above_;
  std::string name_;
  pugi::xml_node root_;
  Compiler compiler_;
  std::map<std::string, Class> classes_;
  std::map<std::string, std::map<std::string, pugi::xml_node>> assets_;
  mutable std::map<std::string, std::unique_ptr<Model>> models_;
};

/// Throws InputError for an attribute that elements of this name do not have.
void check_attributes(const Model& model, pugi::xml_node node);

/// The robot's materials, textures and meshes; each is made once.
class Assets {
 public:
  Assets(Robot& robot, const ImageReader& images) : robot_(robot), images_(images) {}
  std::size_t material(const Model& model, const std::string& name, const SourceLocation& user);
  /// Sets a geom's fields from a mesh or height field.
  void mesh(const Model& model, const std::string& name, RobotGeom& geom);
  void height_field(const Model& model, const std::string& name, RobotGeom& geom);
  /// Returns how a solid is fitted to a mesh by its inertia setting; no value for a fit to the
  /// hull, which is not supported.
  static std::optional<MeshFit> fit(const Model& model, const std::string& name,
                                    const SourceLocation& user);
  /// Returns the material that a mesh names; empty without one.
  static std::string mesh_material(const Model& model, const std::string& name,
                                   const SourceLocation& user);
  /// Returns the first texture of type skybox, or null.
  std::shared_ptr<const EnvironmentImage> sky(const Model& model);

 private:
  std::shared_ptr<const RobotTexture> texture(const Model& model, const std::string& name,
                                              const SourceLocation& user);
  /// Counts the bytes that an element generates. Throws InputError beyond most_made.
  void make(const Element& of, std::size_t bytes);
  Robot& robot_;
  const ImageReader& images_;
  std::map<const void*, std::size_t> materials_;  // by element
  std::map<const void*, std::shared_ptr<const RobotTexture>> textures_;
  std::map<const void*, std::shared_ptr<const MeshParts>> heights_, meshes_;
  std::size_t made_ = 0;
};

/// An image as MJCF's textures use it: red, green and blue bytes, rows from the top.
struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};
/// The six faces of a cube map: right, left, up, down, front and back, each as seen from within
/// with z up.
struct Cube {
  std::array<Pixels, 6> faces;
};
/// Make built-in textures and read those of files. They throw InputError.
Pixels flat_texture(const Element& of, const ImageReader& images);
Cube cube_texture(const Element& of, const ImageReader& images);
/// Converts a sky, whose up face is at z, to latitude-longitude with z up; it has twice as many
/// columns as rows.
Pixels around(const Cube& cube, int height);
/// Converts a geom's cube map, whose up face is at y and whose front is at z, to the layout of
/// spherical mapping: columns by the angle from z, rows from below by the angle around z; `width`
/// columns.
Pixels by_angles(const Cube& cube, int width);
std::shared_ptr<const TextureImage> texture_image(const Pixels& pixels);

/// Reads a skin as a mesh, posed by the bodies that move it (`body` returns the pose of a body by
/// its name, or null). If a model is attached in part (not `is_whole`), skins of missing bodies are
/// not drawn.
void read_skin(const Model& model, pugi::xml_node node,
               const std::function<const glm::dmat4*(const std::string&)>& body, bool is_whole,
               Robot& robot, Assets& assets);

/// Reads the bodies of a model in the pose, with everything in them.
void read_bodies(const Model& model, const Pose& pose, Robot& robot, Assets& assets);

}  // namespace caplet::mjcf
