// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What files of meshes alone share: words of lines with their places, an axis that is up, materials and images by name.
// Conventions: docs/formats/meshes.md.
#pragma once

#include <array>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// The words of a line, with what they say and errors that name their place.
class LineWords {
 public:
  /// Words end at blanks; from `comment` on there are none.
  LineWords(std::string_view line, const std::string& file, int number, char comment = '#');

  std::size_t count() const { return words_.size(); }
  std::string_view word(std::size_t i) const { return words_[i]; }
  /// From word i to the end of the line (file names with blanks).
  std::string_view rest(std::size_t i) const;
  /// Word i as a number. Throws InputError, also when there is no such word.
  float number(std::size_t i) const;
  std::int64_t whole(std::size_t i) const;
  [[noreturn]] void fail(std::size_t i, const std::string& message) const;

 private:
  std::string_view line_;
  const std::string& file_;
  int number_;
  std::vector<std::string_view> words_;
};

/// Turns the axis that --up says (x, y or z; `usual` where it is not given) to y, the presentation's.
glm::dmat4 world_from_file(const ImportOptions& options, const char* usual);

/// Images by path and encoding, each read once. Throws InputError at `where`.
class MeshImages {
 public:
  MeshImages(Scene& scene, const ImageReader& reader) : scene_(scene), reader_(reader) {}
  /// The texture of an image over uv, as spectra or (the red or only channel) as floats: its index in Scene::textures.
  std::uint32_t texture(const std::filesystem::path& path, bool is_float, bool is_srgb, const SourceLocation& where);

 private:
  Scene& scene_;
  const ImageReader& reader_;
  std::map<std::pair<std::string, bool>, std::shared_ptr<const TextureImage>> images_;
  std::map<std::pair<std::string, int>, std::uint32_t> textures_;
};

/// Adds the material that shapes without one have; its index.
std::uint32_t add_plain_material(Scene& scene);

/// sRGB, from 0 to 1, as linear.
float linear_of_srgb(float value);

/// Numbers of a file as a linear colour: sRGB from 0 to 1, or to 255 where the file has any (`most`) above 1.
glm::vec3 decoded_color(const glm::vec3& numbers, float most);

/// Makes an image of the corners' linear colours, three a triangle, and gives the mesh the texture coordinates (and each triangle
/// the vertices of its own) at which it interpolates them.
ImagemapTexture texture_of_corners(TriangleMeshShape& mesh, const std::vector<glm::vec3>& colors);

/// Gives a mesh a material of its own: its former one's colour times those of the corners, linear, three a triangle. False, and
/// nothing done, where the material has a texture, or no colour that one could be.
bool color_corners(Scene& scene, Shape& shape, std::vector<glm::vec3> colors);

/// A mesh's shape, with its material.
Shape mesh_shape(TriangleMeshShape mesh, std::string name, std::uint32_t material, const SourceLocation& where);

/// The corners of a polygon's triangles, around it as they are: a fan where it is convex (seen along its normal's greatest axis),
/// else its ears (Meisters 1975, doi:10.2307/2319703); what crosses itself, or has more than 2,000 corners, is a fan.
std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const glm::vec3> corners);

/// The meshes of files in memory, or of an OBJ file without its materials, in the file's coordinates; `colors`: where those of
/// corners go, linear, three a triangle. Throw InputError.
TriangleMeshShape parse_stl(std::string_view bytes, const std::string& file);
TriangleMeshShape parse_off(std::string_view bytes, const std::string& file, std::vector<glm::vec3>* colors = nullptr);
std::vector<TriangleMeshShape> read_obj_meshes(const std::filesystem::path& path, const SourceLocation& where);
/// Those of a COLLADA file where its nodes have them, in metres; which axis is up is not looked at, as in ROS.
std::vector<TriangleMeshShape> read_dae_meshes(const std::filesystem::path& path, const SourceLocation& where);

/// What an MTL file says of a material: linear colours, numbers by their names there, files of maps from its folder.
struct MtlValues {
  std::string name;
  int line = 0;
  glm::dvec3 kd{0.6}, ks{0}, ke{0};
  double ns = 0, ni = 1.5, d = 1;
  int illum = -1;
  std::optional<double> metallic, roughness;
  std::string map_kd, map_d, map_pm, map_pr;
};

/// What shapes of a material of an MTL file have.
struct MtlMaterial {
  std::uint32_t material = 0;
  std::optional<AreaEmission> emission;
  std::optional<TextureOperand> alpha;
};
/// The materials of an MTL file by name, added to the scene. Throws InputError.
std::map<std::string, MtlMaterial> read_mtl(const std::filesystem::path& path, const SourceLocation& named_at, Scene& scene,
                                            MeshImages& images);
/// The material of such values, added to the scene; maps are sought in `folder`. Throws InputError at `where`.
MtlMaterial make_mtl(const MtlValues& values, const SourceLocation& where, const std::filesystem::path& folder, Scene& scene,
                     MeshImages& images);

}  // namespace caplet
