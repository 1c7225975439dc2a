// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Assets of MJCF: meshes, height fields and materials.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "base/reading.h"
#include "import/detail/gzip_file.h"
#include "import/detail/mesh_file.h"
#include "import/detail/mjcf.h"
#include "import/detail/text_file.h"

namespace caplet::mjcf {

namespace {

constexpr std::size_t kMany = 30'000'000;  // numbers in one attribute

struct Heights {
  std::size_t rows = 0, columns = 0;  // rows from the least y up
  std::vector<float> values;          // 0 to 1
};

/// Scales the values linearly to 0 to 1.
void stretch(std::vector<float>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  for (float& v : values) v = most > least ? (v - least) / (most - least) : 0;
}

Heights heights_of(const Element& of, const ImageReader& images,
                   const std::filesystem::path& path) {
  Heights out;
  const auto counted = [&](double rows, double columns) {
    constexpr double most = 1 << 13, most_cells = 1 << 22;
    if (!(rows >= 2 && columns >= 2) || rows > most || columns > most ||
        rows * columns > most_cells || rows != std::floor(rows) || columns != std::floor(columns))
      of.fail(fmt::format("a height field has 2 to {} rows and columns, and at most 2^22 heights",
                          most));
    out.rows = static_cast<std::size_t>(rows);
    out.columns = static_cast<std::size_t>(columns);
  };
  if (!of.text("file").empty()) {
    check_may_read(path, of.where());
    const std::string ending = lower_case_ending(path);
    if (ending == ".png" || of.text("content_type") == "image/png") {
      const TextureImage image = images.read_texture(path, {ImageEncoding::Kind::linear, 1});
      counted(image.height, image.width);
      for (std::size_t row = 0; row < out.rows; ++row)  // the image's bottom row is at the least y
        for (std::size_t column = 0; column < out.columns; ++column) {
          const std::size_t at = ((out.rows - 1 - row) * out.columns + column) *
                                 static_cast<std::size_t>(image.channels);
          float sum = 0;
          const int channels = std::min(image.channels, 3);
          for (std::size_t k = 0; k < static_cast<std::size_t>(channels); ++k)
            sum += image.floats.empty() ? static_cast<float>(image.bytes[at + k])
                                        : image.floats[at + k];
          out.values.push_back(sum / static_cast<float>(channels));
        }
    } else {
      // The file has two integers, then floats.
      const std::string bytes = read_file(path, of.where());
      std::array<std::int32_t, 2> counts{};
      if (bytes.size() < sizeof counts)
        throw InputError({path.string()}, "is no height field: it is too short");
      std::memcpy(counts.data(), bytes.data(), sizeof counts);
      counted(counts[0], counts[1]);
      if (bytes.size() != sizeof counts + 4 * out.rows * out.columns)
        throw InputError({path.string()},
                         fmt::format("{} rows and {} columns of heights need other than {} bytes",
                                     out.rows, out.columns, bytes.size()));
      out.values.resize(out.rows * out.columns);
      std::memcpy(out.values.data(), bytes.data() + sizeof counts, bytes.size() - sizeof counts);
      for (const float v : out.values)
        if (!(std::abs(v) <= largest_number))
          throw InputError({path.string()}, "a height is not finite or out of range");
    }
  } else {
    counted(of.number("nrow", 0), of.number("ncol", 0));
    out.values.resize(out.rows * out.columns);
    if (of.has("elevation")) {
      const std::vector<double> said = numbers_of(of.text("elevation"), out.values.size(),
                                                  out.values.size(), of.where(), "elevation");
      for (std::size_t row = 0; row < out.rows; ++row)
        for (std::size_t column = 0; column < out.columns; ++column)
          out.values[row * out.columns + column] =
              static_cast<float>(said[(out.rows - 1 - row) * out.columns + column]);
    }
  }
  stretch(out.values);
  return out;
}

/// Makes the surface, two triangles per cell, and the sides and bottom of the base.
TriangleMeshShape height_mesh(const Heights& heights, const std::vector<double>& size) {
  TriangleMeshShape mesh;
  const std::size_t rows = heights.rows, columns = heights.columns, far = rows * columns;
  for (const bool below : {false, true})
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t column = 0; column < columns; ++column) {
        const double x =
            size[0] * (2 * static_cast<double>(column) / static_cast<double>(columns - 1) - 1);
        const double y =
            size[1] * (2 * static_cast<double>(row) / static_cast<double>(rows - 1) - 1);
        mesh.positions.emplace_back(
            x, y, below ? -size[3] : size[2] * heights.values[row * columns + column]);
      }
  const auto at = [&](std::size_t row, std::size_t column) {
    return static_cast<std::uint32_t>(row * columns + column);
  };
  const auto under = static_cast<std::uint32_t>(far);
  const auto wall = [&](std::uint32_t a, std::uint32_t b) {
    mesh.triangles.push_back({a + under, b + under, b});
    mesh.triangles.push_back({a + under, b, a});
  };
  for (std::size_t row = 0; row + 1 < rows; ++row)
    for (std::size_t column = 0; column + 1 < columns; ++column) {
      const std::uint32_t a = at(row, column), b = at(row, column + 1), c = at(row + 1, column + 1),
                          d = at(row + 1, column);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a + under, c + under, b + under});
      mesh.triangles.push_back({a + under, d + under, c + under});
    }
  for (std::size_t column = 0; column + 1 < columns; ++column) {
    wall(at(0, column), at(0, column + 1));
    wall(at(rows - 1, column + 1), at(rows - 1, column));
  }
  for (std::size_t row = 0; row + 1 < rows; ++row) {
    wall(at(row, columns - 1), at(row + 1, columns - 1));
    wall(at(row + 1, 0), at(row, 0));
  }
  return mesh;
}

/// Reads a mesh that is written in the model itself.
TriangleMeshShape written_mesh(const Element& of) {
  const auto numbers = [&](const char* name, std::size_t of_each) {
    const std::vector<double> v = numbers_of(of.text(name), 0, kMany, of.where(), name);
    if (v.size() % of_each != 0)
      of.fail(fmt::format("{}: a multiple of {} numbers is needed", name, of_each));
    return v;
  };
  TriangleMeshShape mesh;
  const std::vector<double> positions = numbers("vertex", 3), normals = numbers("normal", 3),
                            uvs = numbers("texcoord", 2), faces = numbers("face", 3);
  if (faces.empty()) of.fail("a mesh of vertices alone, whose hull is meant, is not read");
  for (std::size_t i = 0; i < positions.size(); i += 3)
    mesh.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  if (normals.size() == positions.size())
    for (std::size_t i = 0; i < normals.size(); i += 3)
      mesh.normals.emplace_back(normals[i], normals[i + 1], normals[i + 2]);
  if (uvs.size() / 2 == mesh.positions.size())
    for (std::size_t i = 0; i < uvs.size(); i += 2) mesh.uvs.emplace_back(uvs[i], 1 - uvs[i + 1]);
  for (std::size_t i = 0; i < faces.size(); i += 3) {
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double v = faces[i + k];
      if (!(v >= 0) || v != std::floor(v) || v >= static_cast<double>(mesh.positions.size()))
        of.fail(fmt::format("face: {} is no vertex, of {}", v, mesh.positions.size()));
      triangle[k] = static_cast<std::uint32_t>(v);
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

void Assets::make(const Element& of, std::size_t bytes) {
  made_ += bytes;
  if (made_ > most_made)
    of.fail(fmt::format("the model's built-in textures and height fields take more than {} bytes",
                        most_made));
}

void Assets::mesh(const Model& model, const std::string& name, RobotGeom& geom) {
  const Element of = model.asset("mesh", name, geom.where);
  if (of.has("builtin") && of.text("builtin") != "none")
    of.fail("builtin: meshes that MuJoCo makes itself are not read");
  if (!of.text("file").empty()) {
    geom.mesh = model.file(of, of.text("file"), model.compiler().meshes);
    geom.needs_mesh = true;
    if (!is_mesh_file(geom.mesh))
      of.fail("the mesh '" + geom.mesh.string() + "' is of a format that is not read");
  } else {
    std::shared_ptr<const MeshParts>& parts = meshes_[of.node().internal_object()];
    if (!parts) parts = std::make_shared<const MeshParts>(MeshParts{written_mesh(of)});
    geom.parts = parts;
  }
  // Points are translated by -refpos, rotated by the inverse of refquat, then scaled.
  const glm::dvec3 scale = of.vector("scale", {1, 1, 1}),
                   reference = of.vector("refpos", {0, 0, 0});
  for (int k = 0; k < 3; ++k)
    if (scale[k] == 0) of.fail("scale: 0 leaves nothing of it");
  const std::vector<double> q = of.numbers("refquat", 4, {1, 0, 0, 0});
  const glm::dquat turn(q[0], q[1], q[2], q[3]);
  if (!(glm::length(turn) > 1e-14)) of.fail("refquat has no length");
  geom.geom_from_mesh = glm::scale(glm::dmat4(1), scale) *
                        glm::mat4_cast(glm::conjugate(glm::normalize(turn))) *
                        glm::translate(glm::dmat4(1), -reference);
}

std::optional<MeshFit> Assets::fit(const Model& model, const std::string& name,
                                   const SourceLocation& user) {
  const Element of = model.asset("mesh", name, user);
  MeshFit out;
  out.by_extent = model.compiler().fits_extents;
  enum : std::size_t { convex, exact, legacy, shell };
  const std::size_t inertia = of.choice("inertia", {"convex", "exact", "legacy", "shell"}, legacy);
  if (inertia == convex) return std::nullopt;
  if (inertia == exact) out.mass = MeshFit::Mass::exact;
  if (inertia == shell) out.mass = MeshFit::Mass::shell;
  return out;
}

std::string Assets::mesh_material(const Model& model, const std::string& name,
                                  const SourceLocation& user) {
  return model.asset("mesh", name, user).text("material");
}

void Assets::height_field(const Model& model, const std::string& name, RobotGeom& geom) {
  const Element of = model.asset("hfield", name, geom.where);
  std::shared_ptr<const MeshParts>& parts = heights_[of.node().internal_object()];
  if (!parts) {
    const std::vector<double> size = of.numbers("size", 4, {0, 0, 0, 0});
    for (const double v : size)
      if (!(v > 0)) of.fail("size: four positive numbers are needed");
    const std::filesystem::path path =
        of.text("file").empty() ? std::filesystem::path()
                                : model.file(of, of.text("file"), model.compiler().meshes);
    const Heights heights = heights_of(of, images_, path);
    // Each value takes two vertices and four triangles.
    make(of, heights.values.size() *
                 (2 * sizeof(glm::vec3) + 4 * sizeof(std::array<std::uint32_t, 3>)));
    parts = std::make_shared<const MeshParts>(MeshParts{height_mesh(heights, size)});
  }
  geom.parts = parts;
}

std::size_t Assets::material(const Model& model, const std::string& name,
                             const SourceLocation& user) {
  const Element of = model.asset("material", name, user);
  const auto [entry, fresh] =
      materials_.try_emplace(of.node().internal_object(), robot_.materials.size());
  if (!fresh) return entry->second;
  RobotMaterial out;
  out.where = of.where();
  out.name = name;
  const std::vector<double> rgba = of.numbers("rgba", 4, {1, 1, 1, 1});
  out.rgba = {rgba[0], rgba[1], rgba[2], rgba[3]};
  out.emission = std::max(0.0, of.number("emission", 0));
  out.specular = std::clamp(of.number("specular", 0.5), 0.0, 1.0);
  out.shininess = std::clamp(of.number("shininess", 0.5), 0.0, 1.0);
  out.reflectance = std::clamp(of.number("reflectance", 0), 0.0, 1.0);
  const double metallic = of.number("metallic", -1), roughness = of.number("roughness", -1);
  if (metallic >= 0) out.metallic = std::min(metallic, 1.0);
  if (roughness >= 0) out.roughness = std::min(roughness, 1.0);
  const std::vector<double> repeat = of.numbers("texrepeat", 1, {1, 1});
  out.texrepeat = {repeat[0], repeat[1]};
  out.texuniform = of.yes("texuniform", false);
  std::string texture = of.text("texture");
  model.each(of.node(), [&](pugi::xml_node layer) {
    const std::string_view role = layer.attribute("role").value();
    if (std::string_view(layer.name()) == "layer" && (role == "rgb" || role == "rgba"))
      texture = layer.attribute("texture").value();
  });
  if (!texture.empty()) out.texture = this->texture(model, texture, out.where);
  robot_.materials.push_back(std::move(out));
  return entry->second;
}

std::shared_ptr<const RobotTexture> Assets::texture(const Model& model, const std::string& name,
                                                    const SourceLocation& user) {
  const Element of = model.asset("texture", name, user);
  std::shared_ptr<const RobotTexture>& known = textures_[of.node().internal_object()];
  if (known) return known;
  auto out = std::make_shared<RobotTexture>();
  out->by_direction = of.choice("type", {"2d", "cube", "skybox"}, 1) != 0;
  if (!out->by_direction && of.text("builtin", "none") == "none" && !of.text("file").empty() &&
      !of.yes("hflip", false) && !of.yes("vflip", false)) {
    const std::filesystem::path path = model.file(of, of.text("file"), model.compiler().textures);
    try {
      out->image = std::make_shared<const TextureImage>(images_.read_texture(path, {}));
    } catch (const InputError& error) {
      of.fail(error.what());
    }
  } else if (!out->by_direction) {
    out->image = texture_image(flat_texture(of, images_));
  } else {
    const Cube cube = cube_texture(of, images_);
    out->image = texture_image(by_angles(cube, std::clamp(2 * cube.faces[0].height, 2, 1024)));
  }
  make(of, out->image->bytes.size());
  return known = out;
}

std::shared_ptr<const EnvironmentImage> Assets::sky(const Model& model) {
  for (const auto& [name, node] : model.assets("texture")) {
    const Element of = model.element(node, "texture", model.root_class());
    if (of.text("type") != "skybox") continue;
    const Cube cube = cube_texture(of, images_);
    const Pixels pixels = around(cube, std::clamp(2 * cube.faces[0].height, 2, 1024));
    auto out = std::make_shared<EnvironmentImage>();
    out->width = pixels.width;
    out->height = pixels.height;
    for (const std::uint8_t byte : pixels.rgb)
      out->rgb.push_back(static_cast<float>(decoded_value({}, byte / 255.0)));
    return out;
  }
  return nullptr;
}

}  // namespace caplet::mjcf
