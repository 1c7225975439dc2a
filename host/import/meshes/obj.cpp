// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Wavefront OBJ: polygons with normals and texture coordinates, groups, and materials of MTL files.
#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "base/check.h"
#include "base/log.h"
#include "base/quotes.h"
#include "base/reading.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

/// The indices of one corner, from 0; -1: not given.
struct ObjCorner {
  std::int64_t position = -1, uv = -1, normal = -1;
  bool operator==(const ObjCorner&) const = default;
};
struct ObjCornerHash {
  std::size_t operator()(const ObjCorner& c) const {
    std::uint64_t h = static_cast<std::uint64_t>(c.position) * 0x9e3779b97f4a7c15U;
    h = (h ^ static_cast<std::uint64_t>(c.uv + 1)) * 0xbf58476d1ce4e5b9U;
    h = (h ^ static_cast<std::uint64_t>(c.normal + 1)) * 0x94d049bb133111ebU;
    return h ^ h >> 31;
  }
};

struct ObjPart {
  TriangleMeshShape mesh;
  std::unordered_map<ObjCorner, std::uint32_t, ObjCornerHash> vertices;
  std::vector<glm::vec3> colors;  // of the mesh's vertices, as numbers of the file
  bool all_uvs = true, all_normals = true, all_colors = true;
  std::string name, material;
  int line = 0;
};

class ObjReader {
 public:
  ObjReader(const std::filesystem::path& path, const ImageReader& images,
            const ImportOptions& options)
      : path_(path), options_(options), images_(scene_, images) {
    scene_.source = path.string();
  }

  Scene read() {
    parse();
    finish();
    return std::move(scene_);
  }

  /// Reads only the meshes, without materials.
  std::vector<TriangleMeshShape> read_meshes() {
    with_materials_ = false;
    parse();
    std::vector<TriangleMeshShape> out;
    for (const std::unique_ptr<ObjPart>& part : parts_) {
      complete(*part);
      out.push_back(std::move(part->mesh));
    }
    return out;
  }

 private:
  void parse() {
    const TextFile file(path_);
    Unproven in_file;
    in_file_ = &in_file;
    std::string_view text = file.text();
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    std::string joined;
    for (line_ = 1; !text.empty(); ++line_) {
      std::string_view line = take_line(text);
      // A line that ends in a backslash continues on the next one.
      int more = 0;
      while (line.ends_with('\\') && !text.empty()) {
        joined.assign(line.substr(0, line.size() - 1));
        joined += ' ';
        joined += take_line(text);
        kept_.push_back(std::move(joined));
        line = kept_.back();
        ++more;
      }
      statement(LineWords(line, scene_.source, line_));
      line_ += more;
      kept_.clear();
    }
    if (thin_faces_ > 0)
      Diagnostics().warning(
          {scene_.source, first_thin_face_, 0},
          fmt::format("{} faces of fewer than three corners are left out", thin_faces_));
    if (left_out_ > 0)
      Diagnostics().warning(
          {scene_.source, first_left_out_, 0},
          fmt::format("{} statements of points, lines, curves and surfaces are left out",
                      left_out_));
  }

  void statement(const LineWords& words) {
    if (words.count() == 0) return;
    const std::string_view what = words.word(0);
    if (what == "v") {
      vertex_statement(words);
      if (in_file_) in_file_->prove();
    }
    if (what == "vt")
      uvs_.emplace_back(words.number(1), words.count() > 2 ? words.number(2) : 0);
    else if (what == "vn")
      normals_.emplace_back(words.number(1), words.number(2), words.number(3));
    else if (what == "f")
      face(words);
    else if (what == "o" || what == "g")
      start(std::string(words.rest(1)), material_);
    else if (what == "usemtl")
      start(name_, std::string(words.rest(1)));
    else if (what == "mtllib" && with_materials_)
      library(words);
    else if (what == "p" || what == "l" || what == "curv" || what == "curv2" || what == "surf" ||
             what == "cstype") {
      if (left_out_++ == 0) first_left_out_ = line_;
    }
  }

  /// Three numbers after the position are a colour; a single one is a weight.
  void vertex_statement(const LineWords& words) {
    positions_.emplace_back(words.number(1), words.number(2), words.number(3));
    if (words.count() != 7 || !with_materials_) return;
    const glm::vec3 color(words.number(4), words.number(5), words.number(6));
    colors_.resize(positions_.size() - 1, glm::vec3(-1));
    colors_.push_back(glm::max(color, glm::vec3(0)));
    most_color_ = std::max({most_color_, color.x, color.y, color.z});
  }

  void start(std::string name, std::string material) {
    name_ = std::move(name);
    material_ = std::move(material);
    current_ = nullptr;
  }

  ObjPart& part() {
    if (current_) return *current_;
    const auto [found, fresh] = part_index_.try_emplace({name_, material_}, parts_.size());
    if (fresh) {
      parts_.push_back(std::make_unique<ObjPart>());
      parts_.back()->name = name_;
      parts_.back()->material = material_;
      parts_.back()->line = line_;
    }
    return *(current_ = parts_[found->second].get());
  }

  /// Reads "7", "7/3", "7//2" or "7/3/2". Indices count from 1, or backwards from -1.
  ObjCorner corner(const LineWords& words, std::size_t i) const {
    ObjCorner out;
    std::string_view text = words.word(i);
    const std::size_t counts[] = {positions_.size(), uvs_.size(), normals_.size()};
    std::int64_t* const fields[] = {&out.position, &out.uv, &out.normal};
    for (int k = 0; k < 3; ++k) {
      const std::size_t slash = std::min(text.find('/'), text.size());
      const std::string_view field = text.substr(0, slash);
      if (!field.empty()) {
        std::int64_t value = 0;
        const auto count = static_cast<std::int64_t>(counts[k]);
        if (!parse_number(field, value)) words.fail(i, quoted(words.word(i)) + " is no corner");
        if (value == 0 || value > count || value < -count)
          words.fail(
              i, fmt::format("{}: there are {} before this line", quoted(words.word(i)), count));
        *fields[k] = value > 0 ? value - 1 : count + value;
      } else if (k == 0) {
        words.fail(i, quoted(words.word(i)) + " is no corner");
      }
      if (slash == text.size()) return out;
      text.remove_prefix(slash + 1);
    }
    words.fail(i, quoted(words.word(i)) + " is no corner");
  }

  std::uint32_t vertex(ObjPart& part, const ObjCorner& c) {
    const auto [entry, fresh] =
        part.vertices.try_emplace(c, narrow<std::uint32_t>(part.mesh.positions.size()));
    if (fresh) {
      part.mesh.positions.push_back(positions_[static_cast<std::size_t>(c.position)]);
      part.mesh.uvs.push_back(c.uv >= 0 ? uvs_[static_cast<std::size_t>(c.uv)] : glm::vec2(0));
      part.mesh.normals.push_back(c.normal >= 0 ? normals_[static_cast<std::size_t>(c.normal)]
                                                : glm::vec3(0));
      part.all_uvs &= c.uv >= 0;
      part.all_normals &= c.normal >= 0;
      const auto at = static_cast<std::size_t>(c.position);
      part.colors.push_back(at < colors_.size() ? colors_[at] : glm::vec3(-1));
      part.all_colors &= part.colors.back().x >= 0;
    }
    return entry->second;
  }

  void face(const LineWords& words) {
    if (words.count() < 4) {
      for (std::size_t i = 1; i < words.count(); ++i) corner(words, i);
      if (thin_faces_++ == 0) first_thin_face_ = line_;
      return;
    }
    ObjPart& to = part();
    corners_.clear();
    places_.clear();
    for (std::size_t i = 1; i < words.count(); ++i) {
      corners_.push_back(vertex(to, corner(words, i)));
      places_.push_back(to.mesh.positions[corners_.back()]);
    }
    if (corners_.size() == 3)
      to.mesh.triangles.push_back({corners_[0], corners_[1], corners_[2]});
    else
      for (const auto& [a, b, c] : triangles_of(places_))
        to.mesh.triangles.push_back({corners_[a], corners_[b], corners_[c]});
  }

  void library(const LineWords& words) {
    const SourceLocation here{scene_.source, line_, 0};
    const std::filesystem::path file =
        path_.parent_path() / std::filesystem::path(std::string(words.rest(1)));
    if (!is_there(file, here)) {
      Diagnostics().warning(
          here, "the materials of '" + file.string() + "' cannot be had: there is no such file");
      return;
    }
    for (auto& [name, material] : read_mtl(file, here, scene_, images_))
      materials_.insert_or_assign(name, material);
  }

  /// Texture coordinates and normals must be given for all corners or for none.
  static void complete(ObjPart& part) {
    if (!part.all_uvs) part.mesh.uvs.clear();
    if (!part.all_normals) part.mesh.normals.clear();
  }

  void finish() {
    std::optional<std::uint32_t> plain;
    const glm::dmat4 world = world_from_file(options_, "y");
    scene_.world_from_file = glm::dmat3(world);
    for (const std::unique_ptr<ObjPart>& part : parts_) {
      complete(*part);
      const SourceLocation where{scene_.source, part->line, 0};
      const auto material = materials_.find(part->material);
      if (material == materials_.end() && !part->material.empty() &&
          unknown_.insert_or_assign(part->material, true).second)
        Diagnostics().warning(where, "the material " + caplet::quoted(part->material) +
                                         " is in no mtllib: it is grey");
      if (material == materials_.end() && !plain) plain = add_plain_material(scene_);
      std::string name = part->name.empty() ? path_.stem().string() : part->name;
      Shape shape =
          mesh_shape(std::move(part->mesh), std::move(name),
                     material == materials_.end() ? *plain : material->second.material, where);
      if (material != materials_.end()) {
        shape.emission = material->second.emission;
        shape.alpha = material->second.alpha;
      }
      shape.world_from_object = world;
      if (part->all_colors) color(*part, shape);
      scene_.shapes.push_back(std::move(shape));
    }
    if (scene_.shapes.empty()) throw InputError({scene_.source, 0, 0}, "holds no faces");
  }

  /// Multiplies the vertices' colours by the material's; without a material they are used alone.
  void color(const ObjPart& part, Shape& shape) {
    std::vector<glm::vec3> corners;
    for (const auto& triangle : std::get<TriangleMeshShape>(shape.geometry).triangles)
      for (const std::uint32_t vertex : triangle)
        corners.push_back(decoded_color(part.colors[vertex], most_color_));
    if (part.material.empty() || !materials_.contains(part.material)) {
      if (!white_) {
        white_ = narrow<std::uint32_t>(scene_.materials.size());
        scene_.materials.push_back({DiffuseMaterial{ConstantSpectrum{1}}, "", shape.where});
      }
      shape.material = *white_;
    }
    if (!color_corners(scene_, shape, std::move(corners)))
      Diagnostics().warning(shape.where, "the colours of the vertices are left out: the material " +
                                             caplet::quoted(part.material) +
                                             " has textures or no colour");
  }

  const std::filesystem::path& path_;
  const ImportOptions& options_;
  Unproven* in_file_ = nullptr;  // set while the file is parsed
  bool with_materials_ = true;
  Scene scene_;
  MeshImages images_;
  int line_ = 0, first_left_out_ = 0;
  std::size_t left_out_ = 0, thin_faces_ = 0;
  int first_thin_face_ = 0;
  std::vector<std::uint32_t> corners_;  // of the current face
  std::vector<glm::vec3> places_;
  std::vector<std::string> kept_;
  std::vector<glm::vec3> positions_, normals_,
      colors_;  // colours end at the last vertex that has one; -1: none
  float most_color_ = 0;
  std::optional<std::uint32_t> white_;
  std::vector<glm::vec2> uvs_;
  std::string name_, material_;
  ObjPart* current_ = nullptr;
  std::map<std::pair<std::string, std::string>, std::size_t> part_index_;
  std::vector<std::unique_ptr<ObjPart>> parts_;
  std::map<std::string, MtlMaterial> materials_;
  std::map<std::string, bool> unknown_;
};

class NoImageFiles : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    throw InputError(path.string() + ": no images");
  }
};

}  // namespace

std::vector<TriangleMeshShape> read_obj_meshes(const std::filesystem::path& path,
                                               const SourceLocation&) {
  const ImportOptions none;
  const NoImageFiles images;
  return ObjReader(path, images, none).read_meshes();
}

Scene import_obj(const std::filesystem::path& path, const ImageReader& images,
                 const ImportOptions& options) {
  return ObjReader(path, images, options).read();
}

}  // namespace caplet
