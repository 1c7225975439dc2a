// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A glTF 2.0 file: checked access to its JSON, its buffers and its materials (Khronos, "glTF 2.0
// Specification").
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::gltf {

/// What a node's transform is made of.
struct Parts {
  glm::dvec3 translation{0}, scale{1};
  glm::dquat rotation{1, 0, 0, 0};  // w, x, y, z
  glm::dmat4 matrix() const;
};

/// A file as text or GLB. Missing members take the given default. Members of another type, out of
/// range or not finite throw InputError.
class File {
 public:
  using Json = nlohmann::json;
  /// Parses `bytes`. Throws InputError with line and column for invalid JSON.
  File(std::filesystem::path path, std::string bytes);

  std::filesystem::path path;
  Json json;

  [[noreturn]] void fail(const std::string& message) const;
  void check_version() const;

  /// Returns a list of the root, or of an object; empty where it is missing.
  const Json& list(const char* name) const { return list_of(json, name); }
  const Json& list_of(const Json& object, const char* name) const;
  const Json& object(const Json& of, const char* name) const;
  const Json& extension(const Json& of, const char* name) const {
    return object(object(of, "extensions"), name);
  }
  std::string text(const Json& of, const char* name, const std::string& otherwise) const;
  double number(const Json& of, const char* name, double otherwise) const;
  bool flag(const Json& of, const char* name, bool otherwise) const;
  template <class Vector>
  Vector vector(const Json& of, const char* name, Vector otherwise) const {
    const Json& values = list_of(of, name);
    if (values.empty()) return otherwise;
    if (values.size() != static_cast<std::size_t>(Vector::length()))
      fail(std::string(name) + " has another number of components");
    for (glm::length_t k = 0; k < Vector::length(); ++k)
      otherwise[k] = number_value(values[static_cast<std::size_t>(k)], name);
    return otherwise;
  }
  double number_value(const Json& value, const char* what) const;
  /// Returns an index below `count`.
  std::size_t index_value(const Json& value, std::size_t count, const char* what) const;
  std::optional<std::size_t> index(const Json& of, const char* name, std::size_t count,
                                   const char* what) const;
  /// Returns the node's `matrix`, or the product of its translation, rotation and scale.
  glm::dmat4 transform_of(const Json& node) const;
  /// Returns them of a node without a matrix.
  Parts parts_of(const Json& node) const;

  /// Returns the values of an accessor with 1 to 4 components of any type; they are finite.
  template <class Vector>
  std::vector<Vector> vectors(std::size_t accessor);
  std::vector<std::uint32_t> indices(std::size_t accessor);
  std::vector<glm::dmat4> matrices(std::size_t accessor);
  /// Returns colours of three components; a fourth is ignored.
  std::vector<glm::vec3> colors(std::size_t accessor);
  /// Returns the bytes of a buffer view.
  std::string_view view(std::size_t index);
  /// Decodes "data:...;base64,..."; there is no value for other addresses.
  std::optional<std::string> data_uri(const std::string& uri) const;
  /// Returns the path of the file that an address names, relative to this one.
  std::filesystem::path beside(const std::string& uri) const;

 private:
  struct Elements;
  Elements elements(std::size_t accessor);
  /// Returns elements of a type and count that lie in the buffer view that `of` names. `stride`:
  /// the view's may be another one than that of elements one behind the other.
  Elements stored(std::size_t accessor, const Json& of, int type, std::size_t components,
                  std::size_t count, bool has_stride);
  std::string_view buffer(std::size_t index);

  std::string bytes_;
  std::string_view binary_;  // the binary chunk of a GLB
  std::map<std::size_t, std::string> buffers_;
  std::uintmax_t held_ = 0,
                 taken_ =
                     0;  // bytes of the file and its buffers, and bytes that accessors have read
};

/// The file's first animation, of translations, rotations, scales and weights of morph targets.
class Animation {
 public:
  /// Reads the animation, if there is one. Throws InputError; warns of what it leaves out.
  explicit Animation(File& file);

  /// Returns the transforms of the last of `nodes`, each of which is a child of the one before,
  /// within a `world`: at the times at which one of them has a key, and, where the way between them
  /// is curved, at times between these. None: no node moves. A key can be alone.
  TransformKeys keys(const std::vector<std::size_t>& nodes, const glm::dmat4& world);

  /// Returns the times at which a mesh changes that a node's weights and joints move, each of which
  /// is the last node of a chain; and times between them, so that joints turn by little from one to
  /// the next. None: nothing moves.
  std::vector<double> bending_times(std::size_t node,
                                    const std::vector<std::vector<std::size_t>>& joints) const;
  /// Returns the times of these alone at which one of them has a key, in order.
  std::vector<double> key_times(std::size_t node,
                                const std::vector<std::vector<std::size_t>>& joints) const;
  /// Returns the node's own transform at a time.
  glm::dmat4 transform_at(std::size_t node, double time) const;
  /// Returns the weights of a node's morph targets at a time, or those given where they rest.
  std::vector<double> weights_at(std::size_t node, double time, std::vector<double> resting) const;

 private:
  using Json = nlohmann::json;
  enum class Way { step, linear, cubic };
  /// What values at two keys and their tangents count at a time between them.
  struct Share {
    std::size_t key = 0;  // the first of the two; with one alone `b` is 0
    double u = 0, a = 1, out_tangent = 0, in_tangent = 0, b = 0;
  };
  struct Times {
    Way way = Way::linear;
    std::vector<double> times;
    Share at(double time) const;
    /// Returns the number of values of a key.
    std::size_t each() const { return way == Way::cubic ? 3 : 1; }
  };
  enum Part : std::size_t { translation, rotation, scale };
  static constexpr std::array<std::string_view, 3> part_names = {"translation", "rotation",
                                                                 "scale"};
  struct Channel : Times {
    std::vector<glm::dvec4> values;
    glm::dvec4 at(double time, bool turns) const;
  };
  /// Weights of all targets at the first key, then at the next.
  struct Weights : Times {
    std::vector<double> values;
  };

  /// Reads the sampler's way and times, and returns the accessor of its values.
  std::size_t read_times(const Json& sampler, Times& out);
  void add(std::size_t node, std::size_t part, const Json& sampler);
  void add_weights(std::size_t node, const Json& sampler);
  void warn(const std::string& what) const;
  /// Adds the times of a channel's keys.
  static void gather(const Times& channel, std::vector<double>& times);
  /// Calls add(channel) for the weights of a node and each channel of the nodes of joints' chains.
  template <class Add>
  void for_channels(std::size_t node, const std::vector<std::vector<std::size_t>>& joints,
                    const Add& add) const;
  /// Returns by how much the nodes of a chain turn between two times, in radians.
  double turn_of(const std::vector<std::size_t>& nodes, double from, double to) const;

  File& file_;
  std::map<std::size_t, std::array<std::optional<Channel>, part_names.size()>> nodes_;
  std::map<std::size_t, Weights> weights_;
  std::size_t keys_ = 0;  // so far
};

/// Meshes whose vertices are moved by morph targets and by a skin's joints.
class Bending {
 public:
  /// `world`: in which all nodes lie.
  Bending(File& file, const Animation& animation, const glm::dmat4& world);
  /// Returns whether a node's mesh has targets or a skin.
  bool bends(std::size_t node) const;
  bool has_skin(std::size_t node) const;
  /// Moves the vertices of a primitive of the node's mesh, at all times of the animation. Those of
  /// a skin are then in the world, and others in the node's space.
  void bend(std::size_t node, const nlohmann::json& primitive, TriangleMeshShape& mesh);

 private:
  using Json = nlohmann::json;
  struct Target {
    std::vector<glm::vec3> positions, normals;  // what is added; none: nothing
  };
  struct Skin {
    std::vector<std::vector<std::size_t>> chains;  // of each joint, from the root to it
    std::vector<glm::dmat4> inverse_bind;
    std::vector<glm::vec4> joints, weights;  // of the vertices, some sets one behind the other
  };

  std::vector<Target> targets_of(const Json& primitive, std::size_t count);
  std::vector<double> resting_weights(std::size_t node, std::size_t count) const;
  std::optional<Skin> skin_of(std::size_t node, const Json& primitive, std::size_t count);
  std::vector<std::size_t> chain_of(std::size_t node) const;
  /// Throws where so many times are too many for these joints.
  void check_joints(const std::vector<std::vector<std::size_t>>& chains, std::size_t times) const;
  /// Applies weighted targets.
  static void morph(const std::vector<Target>& targets, const std::vector<double>& weights,
                    TriangleMeshShape& mesh);
  /// Applies the skin at a time; returns whether it mirrors the mesh.
  bool apply(const Skin& skin, double time, TriangleMeshShape& mesh) const;

  File& file_;
  const Animation& animation_;
  const glm::dmat4& world_;
  std::vector<std::optional<std::size_t>> parents_;
  std::size_t moved_ = 0;  // vertices at all times so far
};

/// What a shape takes from a glTF material.
struct MeshMaterial {
  std::uint32_t material = 0;
  std::optional<AreaEmission> emission;
  std::optional<TextureOperand> alpha;
};

class Materials {
 public:
  Materials(File& file, Scene& scene, const ImageReader& reader)
      : file_(file), scene_(scene), reader_(reader) {}
  /// Makes the material at its first use; without an index it is the default material.
  const MeshMaterial& look(std::optional<std::size_t> material);

 private:
  using Json = nlohmann::json;
  struct Sampler {
    int wrap = 0;
    TextureMapping mapping;
  };
  MeshMaterial make(const Json& material);
  std::shared_ptr<const TextureImage> image(std::size_t index, bool is_srgb);
  /// Returns the image that a texture reference names, and its sampler; no value without a texture.
  std::optional<std::pair<std::size_t, Sampler>> lookup(const Json& of, const char* name);
  std::uint32_t add_texture(std::shared_ptr<const TextureImage> image, const Sampler& sampler,
                            bool is_float);

  File& file_;
  Scene& scene_;
  const ImageReader& reader_;
  std::map<std::optional<std::size_t>, MeshMaterial> looks_;
  std::map<std::pair<std::size_t, bool>, std::shared_ptr<const TextureImage>> images_;
};

}  // namespace caplet::gltf
