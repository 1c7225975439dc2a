// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A robot as its file states it, in any format: geoms, their poses, their materials, lights and
// cameras. Lengths are in metres, z is up. Conventions: docs/formats/robots.md.
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "import/detail/xml.h"
#include "import/import_options.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet {

/// A plane is z = 0, seen from above.
enum class GeomKind { sphere, capsule, cylinder, box, mesh, plane, ellipsoid };

using MeshParts = std::vector<TriangleMeshShape>;

/// How a solid is fitted to a mesh: to the box of its inertia, or to its extent along the inertia's
/// axes.
struct MeshFit {
  /// How mass is measured: volumes from the centre of the faces, all positive or signed, or the
  /// surface.
  enum class Mass { legacy, exact, shell } mass = Mass::legacy;
  bool by_extent = false;
  double scale = 1;
};

struct RobotGeom {
  GeomKind kind = GeomKind::sphere;
  glm::dvec3 size{0};  // half lengths; radius and half length; of a plane half lengths, 0: infinite
  glm::dmat4 world{1};
  std::optional<glm::dvec4> rgba;       // sRGB, as shown on a screen; none: the material's, or grey
  std::optional<std::size_t> material;  // index into Robot::materials
  std::string name;
  int group = 0;
  bool collides = false;  // URDF: collision geometry, else visual. MJCF: may collide
  std::filesystem::path mesh;
  bool needs_mesh = false;                 // a missing mesh is an error
  bool has_mesh_looks = false;             // materials of the mesh's file win
  std::shared_ptr<const MeshParts> parts;  // replaces `mesh`
  glm::dmat4 geom_from_mesh{1};
  std::optional<MeshFit> fit;  // of a solid: the mesh gives its size and place
  SourceLocation where;
};

/// A texture of a geom, mapped by the direction from its centre, or by its x and y (or the texture
/// coordinates of a mesh that has some).
struct RobotTexture {
  std::shared_ptr<const TextureImage> image;
  bool by_direction = false;  // latitude-longitude, z up
};

struct RobotMaterial {
  glm::dvec4 rgba{1};
  double emission = 0, specular = 0.5, shininess = 0.5, reflectance = 0;
  std::optional<double> metallic, roughness;
  std::shared_ptr<const RobotTexture> texture;
  glm::dvec2 texrepeat{1};
  bool texuniform = false;
  std::string name;
  SourceLocation where;
};

struct RobotLight {
  enum class Kind { spot, distant, point } kind = Kind::spot;
  glm::dvec3 position{0}, direction{0, 0, -1}, ambient{0}, diffuse{0.7};
  double cutoff = 45, exponent = 10;  // of a spot: half its angle in degrees
  SourceLocation where;
};

struct RobotCamera {
  std::string name;
  glm::dmat4 world{1};  // it looks along -z, and y is up
  double fovy = 45;     // degrees; orthographic: the height of the view
  bool orthographic = false;
};

struct Robot {
  std::vector<RobotGeom> geoms;
  std::vector<RobotMaterial> materials;
  std::vector<RobotLight> lights;
  std::vector<RobotCamera> cameras;
  std::optional<glm::dvec3> headlight_ambient, headlight_diffuse;
  std::shared_ptr<const EnvironmentImage> sky;
};

/// The contents of --pose: joint=value pairs, and optionally the name of a keyframe.
struct Pose {
  explicit Pose(const ImportOptions& options);
  std::optional<std::string> keyframe;
  std::map<std::string, std::vector<double>>
      joints;  // metres and radians; ball joints: w x y z; free joints: x y z w x y z
};

/// Caches meshes by file.
class MeshFiles {
 public:
  /// Returns the meshes of an STL, OBJ, PLY, OFF, MSH or DAE file in the file's coordinates. Throws
  /// InputError.
  std::shared_ptr<const MeshParts> read(const std::filesystem::path& path,
                                        const SourceLocation& where);

 private:
  std::map<std::string, std::shared_ptr<const MeshParts>> meshes_;
};
/// Returns whether MeshFiles reads files with this ending.
bool is_mesh_file(const std::filesystem::path& path);

/// Throws InputError with the file's places.
Robot read_urdf(const std::filesystem::path& path, const Pose& pose);
Robot read_mjcf(const std::filesystem::path& path, const Pose& pose, const ImageReader& images);

/// Sets the size and place of a geom that is fitted to a mesh. Returns false where the mesh is
/// empty.
bool fit(RobotGeom& geom, const MeshParts& parts);

/// Returns ".stl" for a.STL.
std::string lower_case_ending(const std::filesystem::path& path);

}  // namespace caplet
