// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads binary and text STL, and OFF.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <unordered_map>

#include "base/check.h"
#include "base/quotes.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/ply.h"
#include "import/detail/text_file.h"

namespace caplet {

namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;  // bytes of binary files

/// Merges corners at the same place into one vertex, so that closed meshes are recognised as
/// closed.
class Welder {
 public:
  explicit Welder(TriangleMeshShape& mesh) : mesh_(mesh) {}
  std::uint32_t operator()(const glm::vec3& p) {
    const glm::vec3 q = p + glm::vec3(0);  // -0 becomes 0
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k) h = (h ^ std::bit_cast<std::uint32_t>(q[k])) * 0x9e3779b97f4a7c15U;
    for (auto [at, end] = index_.equal_range(h); at != end; ++at)
      if (mesh_.positions[at->second] == q) return at->second;
    const auto i = narrow<std::uint32_t>(mesh_.positions.size());
    index_.emplace(h, i);
    mesh_.positions.push_back(q);
    return i;
  }

 private:
  TriangleMeshShape& mesh_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> index_;
};

TriangleMeshShape binary_stl(std::string_view bytes, const std::string& file, std::uint32_t count) {
  TriangleMeshShape mesh;
  Welder vertex(mesh);
  mesh.triangles.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const char* at = bytes.data() + kHeader + i * kFacet +
                     sizeof(glm::vec3);  // skips the normal, which follows from the corners
    std::array<glm::vec3, 3> corners;
    static_assert(sizeof corners == 36);
    std::memcpy(corners.data(), at, sizeof corners);
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(corners[k][axis]) <= largest_number))
          throw InputError(
              {file, 0, 0},
              fmt::format("corner {} of facet {} is not finite or out of range", k + 1, i + 1));
      triangle[k] = vertex(corners[k]);
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

TriangleMeshShape text_stl(std::string_view text, const std::string& file) {
  TriangleMeshShape mesh;
  Welder vertex(mesh);
  std::vector<std::uint32_t> loop;
  int number = 1;
  bool open = false;
  Unproven in_file;
  for (; !text.empty(); ++number) {
    const LineWords words(take_line(text), file, number, '\0');
    if (words.count() == 0) continue;
    if (words.word(0) == "facet" || words.word(0) == "endfacet") in_file.prove();
    if (words.word(0) == "outer") {
      loop.clear();
      open = true;
    } else if (words.word(0) == "vertex") {
      if (!open) words.fail(0, "a vertex outside a loop");
      loop.push_back(vertex({words.number(1), words.number(2), words.number(3)}));
    } else if (words.word(0) == "endloop") {
      if (loop.size() < 3) words.fail(0, "a facet has three corners");
      for (std::size_t i = 2; i < loop.size(); ++i)
        mesh.triangles.push_back({loop[0], loop[i - 1], loop[i]});
      open = false;
    } else if (words.word(0) != "solid" && words.word(0) != "facet" &&
               words.word(0) != "endfacet" && words.word(0) != "endsolid") {
      words.fail(0, quoted(words.word(0)) + " is no statement of an STL file");
    }
  }
  if (open) throw InputError({file, number, 0}, "the file ends within a facet");
  return mesh;
}

TriangleMeshShape parse_either_stl(std::string_view bytes, const std::string& file) {
  if (bytes.size() >= kHeader) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeader - sizeof count, sizeof count);
    const std::uint64_t announced = kHeader + std::uint64_t{count} * kFacet;
    if (announced == bytes.size()) return binary_stl(bytes, file, count);
    const bool text =
        bytes.starts_with("solid") && bytes.substr(0, 1024).find("facet") != std::string_view::npos;
    if (!text)
      throw InputError({file, 0, 0},
                       fmt::format("{} facets are announced, which take {} bytes; the file has {}",
                                   count, announced, bytes.size()));
  }
  if (!bytes.starts_with("solid"))
    throw InputError({file, 1, 1},
                     "is no STL file: it neither begins with 'solid' nor has a header");
  return text_stl(bytes, file);
}

/// Reads words across the lines of a file.
class OffReader {
 public:
  OffReader(std::string_view text, const std::string& file, std::vector<glm::vec3>* colors)
      : text_(text), file_(file), colors_(colors) {}
  TriangleMeshShape read() {
    std::string kind(word());
    if (!kind.ends_with("OFF")) fail("is no OFF file");
    kind.resize(kind.size() - 3);
    if (kind.find_first_of("4n") != std::string::npos)
      fail("points of other than three coordinates are not read");
    // Normals and texture coordinates are skipped: normals precede the colours, texture coordinates
    // follow them.
    const std::size_t extra = kind.find('N') != std::string::npos ? 3U : 0U;
    const bool has_colors = colors_ && kind.find('C') != std::string::npos;
    std::vector<glm::vec3> of_vertices, of_triangles;
    bool all_vertices = has_colors,
         all_faces = colors_ && !has_colors;  // whether all have a colour
    const std::int64_t vertices = whole(), faces = whole();
    whole();
    if (vertices < 0 || faces < 0) fail("a count is negative");
    TriangleMeshShape mesh;
    for (std::int64_t i = 0; i < vertices; ++i) {
      glm::vec3 p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = number();
      for (std::size_t k = 0; k < extra; ++k) number();
      mesh.positions.push_back(p);
      if (has_colors) {
        const std::optional<glm::vec3> own = color();
        all_vertices &= own.has_value();
        of_vertices.push_back(own.value_or(glm::vec3(0)));
      }
      end_line();
    }
    for (std::int64_t i = 0; i < faces; ++i) {
      const std::int64_t corners = whole();
      if (corners < 0) fail("a count is negative");
      std::vector<std::uint32_t> around;
      std::vector<glm::vec3> places;
      for (std::int64_t k = 0; k < corners; ++k) {
        const std::int64_t index = whole();
        if (index < 0 || index >= vertices)
          fail(fmt::format("vertex {}: there are {}", index, vertices));
        around.push_back(static_cast<std::uint32_t>(index));
        places.push_back(mesh.positions[around.back()]);
      }
      for (const auto& [a, b, c] : triangles_of(places))
        mesh.triangles.push_back({around[a], around[b], around[c]});
      if (all_faces) {
        const std::optional<glm::vec3> own = color();
        all_faces = own.has_value();
        of_triangles.resize(mesh.triangles.size(), own.value_or(glm::vec3(0)));
      }
      end_line();
    }
    if (all_vertices || all_faces) add_colors(mesh, of_vertices, of_triangles);
    return mesh;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({file_, line_, 0}, message);
  }
  std::string_view word() {
    while (rest_.empty()) {
      if (text_.empty()) fail("the file ends before what it announces");
      rest_ = take_line(text_);
      ++line_;
      rest_ = rest_.substr(0, rest_.find('#'));
      skip();
    }
    std::size_t end = 0;
    while (end < rest_.size() && !is_blank(rest_[end])) ++end;
    const std::string_view out = rest_.substr(0, end);
    rest_.remove_prefix(end);
    skip();
    return out;
  }
  void skip() {
    while (!rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  }
  void end_line() { rest_ = {}; }
  /// Reads three numbers from the rest of the line; none if it has fewer (a single number is an
  /// index into a colour table).
  std::optional<glm::vec3> color() {
    const std::vector<std::string_view> words = words_of(rest_);
    if (words.size() < 3) return std::nullopt;
    glm::vec3 out;
    for (std::size_t k = 0; k < 3; ++k) {
      float value = 0;
      const NumberError error = parse_float(words[k], value);
      if (error != NumberError::none) fail(describe(error, words[k]));
      out[static_cast<glm::length_t>(k)] = value;
      most_ = std::max(most_, value);
    }
    return out;
  }
  void add_colors(const TriangleMeshShape& mesh, const std::vector<glm::vec3>& of_vertices,
                  const std::vector<glm::vec3>& of_triangles) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
      for (const std::uint32_t vertex : mesh.triangles[i])
        colors_->push_back(
            decoded_color(of_vertices.empty() ? of_triangles[i] : of_vertices[vertex], most_));
  }
  float number() {
    const std::string_view text = word();
    float value = 0;
    const NumberError error = parse_float(text, value);
    if (error != NumberError::none) fail(describe(error, text));
    return value;
  }
  std::int64_t whole() {
    const std::string_view text = word();
    std::int64_t value = 0;
    if (!parse_number(text, value)) fail(quoted(text) + " is no whole number");
    return value;
  }
  std::string_view text_, rest_;
  const std::string& file_;
  int line_ = 0;
  std::vector<glm::vec3>* colors_;
  float most_ = 0;  // the greatest number of the colours
};

Scene scene_of(TriangleMeshShape mesh, const std::filesystem::path& path,
               const ImportOptions& options, const char* usual_up,
               std::vector<glm::vec3> colors = {}) {
  Scene scene;
  scene.source = path.string();
  if (mesh.triangles.empty()) throw InputError({scene.source, 0, 0}, "holds no faces");
  Shape shape = mesh_shape(std::move(mesh), path.stem().string(), add_plain_material(scene),
                           {scene.source, 0, 0});
  if (!colors.empty()) {
    scene.materials[0] = {DiffuseMaterial{ConstantSpectrum{1}}, "", {scene.source, 0, 0}};
    color_corners(scene, shape, std::move(colors));
    scene.materials.erase(scene.materials.begin());
    shape.material = 0;
  }
  shape.world_from_object = world_from_file(options, usual_up);
  scene.world_from_file = glm::dmat3(shape.world_from_object);
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace

TriangleMeshShape parse_stl(std::string_view bytes, const std::string& file) {
  return parse_either_stl(bytes, file);
}
TriangleMeshShape parse_off(std::string_view bytes, const std::string& file,
                            std::vector<glm::vec3>* colors) {
  return OffReader(bytes, file, colors).read();
}

Scene import_stl(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  return scene_of(parse_stl(read_file(path, {}), path.string()), path, options, "z");
}
Scene import_off(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  std::vector<glm::vec3> colors;
  TriangleMeshShape mesh = parse_off(TextFile(path).text(), path.string(), &colors);
  return scene_of(std::move(mesh), path, options, "y", std::move(colors));
}
Scene import_ply(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  std::vector<glm::vec3> colors;
  TriangleMeshShape mesh = read_ply(path, {}, &colors);
  return scene_of(std::move(mesh), path, options, "y", std::move(colors));
}

}  // namespace caplet
