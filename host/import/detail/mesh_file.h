// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Helpers of importers of meshes: words of lines with their places, the up axis, materials and
// images by name. Conventions: docs/formats/meshes.md.
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

/// Splits a line into words, converts them, and reports errors at their places.
class LineWords {
 public:
  /// Words end at blanks; `comment` and all that follows it is ignored.
  LineWords(std::string_view line, const std::string& file, int number, char comment = '#');

  std::size_t count() const { return words_.size(); }
  std::string_view word(std::size_t i) const { return words_[i]; }
  /// Returns the text from word i to the end of the line (for file names with blanks).
  std::string_view rest(std::size_t i) const;
  /// Returns word i as a number. Throws InputError, also when the word is missing.
  float number(std::size_t i) const;
  std::int64_t whole(std::size_t i) const;
  [[noreturn]] void fail(std::size_t i, const std::string& message) const;

 private:
  std::string_view line_;
  const std::string& file_;
  int number_;
  std::vector<std::string_view> words_;
};

/// Returns the rotation that takes the axis of --up (x, y or z; `usual` by default) to y, which is
/// up in the scene.
glm::dmat4 world_from_file(const ImportOptions& options, const char* usual);

/// Caches images by path and encoding. Throws InputError at `where`.
class MeshImages {
 public:
  MeshImages(Scene& scene, const ImageReader& reader) : scene_(scene), reader_(reader) {}
  /// Returns the index in Scene::textures of an image over uv, as spectra or as floats (the red or
  /// only channel).
  std::uint32_t texture(const std::filesystem::path& path, bool is_float, bool is_srgb,
                        const SourceLocation& where);

 private:
  Scene& scene_;
  const ImageReader& reader_;
  std::map<std::pair<std::string, bool>, std::shared_ptr<const TextureImage>> images_;
  std::map<std::pair<std::string, int>, std::uint32_t> textures_;
};

/// Adds the material of shapes without one, and returns its index.
std::uint32_t add_plain_material(Scene& scene);

/// Converts sRGB to linear, both from 0 to 1.
float linear_of_srgb(float value);

/// Converts a file's numbers to a linear colour: sRGB from 0 to 1, or to 255 where the greatest in
/// the file (`most`) is above 1.
glm::vec3 decoded_color(const glm::vec3& numbers, float most);

/// Makes an image of the corners' linear colours, three per triangle. Gives the mesh texture
/// coordinates that interpolate them, and each triangle vertices of its own.
ImagemapTexture texture_of_corners(TriangleMeshShape& mesh, const std::vector<glm::vec3>& colors);

/// Gives a mesh its own material: the colour of its former one times those of the corners, linear,
/// three per triangle. Returns false and changes nothing where the colour is a texture or the
/// material has none that a texture can replace.
bool color_corners(Scene& scene, Shape& shape, std::vector<glm::vec3> colors);

/// Makes a shape of a mesh and its material.
Shape mesh_shape(TriangleMeshShape mesh, std::string name, std::uint32_t material,
                 const SourceLocation& where);

/// Triangulates a polygon and keeps its orientation: a fan where it is convex (seen along the
/// greatest axis of its normal), else by ears (Meisters 1975, doi:10.2307/2319703).
/// Self-intersecting polygons, and those of more than 2,000 corners, become fans.
std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const glm::vec3> corners);

/// Parse the meshes of a file in memory, or of an OBJ file without its materials, in the file's
/// coordinates. `colors` receives the colours of corners, linear, three per triangle. They throw
/// InputError.
TriangleMeshShape parse_stl(std::string_view bytes, const std::string& file);
TriangleMeshShape parse_off(std::string_view bytes, const std::string& file,
                            std::vector<glm::vec3>* colors = nullptr);
std::vector<TriangleMeshShape> read_obj_meshes(const std::filesystem::path& path,
                                               const SourceLocation& where);
/// Reads a COLLADA file's meshes as its nodes place them, in metres. The up axis is ignored, as in
/// ROS.
std::vector<TriangleMeshShape> read_dae_meshes(const std::filesystem::path& path,
                                               const SourceLocation& where);

/// The values of a material in an MTL file: linear colours, numbers by their names there, and map
/// files from its folder.
struct MtlValues {
  std::string name;
  int line = 0;
  glm::dvec3 kd{0.6}, ks{0}, ke{0};
  double ns = 0, ni = 1.5, d = 1;
  int illum = -1;
  std::optional<double> metallic, roughness;
  std::string map_kd, map_d, map_pm, map_pr;
};

/// What shapes take from a material of an MTL file.
struct MtlMaterial {
  std::uint32_t material = 0;
  std::optional<AreaEmission> emission;
  std::optional<TextureOperand> alpha;
};
/// Adds the materials of an MTL file to the scene and returns them by name. Throws InputError.
std::map<std::string, MtlMaterial> read_mtl(const std::filesystem::path& path,
                                            const SourceLocation& named_at, Scene& scene,
                                            MeshImages& images);
/// Adds the material of such values to the scene; maps are sought in `folder`. Throws InputError at
/// `where`.
MtlMaterial make_mtl(const MtlValues& values, const SourceLocation& where,
                     const std::filesystem::path& folder, Scene& scene, MeshImages& images);

}  // namespace caplet
