// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// COLLADA 1.4 and 1.5: the geometry of the visual scene, placed by its nodes, and the colours and
// images of its materials. Conventions: docs/formats/meshes.md. assimp 5.2 is no substitute: it
// took 3 GB for a damaged file of 2 KiB, and leaked memory for files that it refused.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <optional>
#include <unordered_map>

#include "base/check.h"
#include "base/log.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/text_file.h"
#include "import/detail/xml.h"

namespace caplet {

namespace {

constexpr int kDeepestNode = 500;  // nesting of nodes
constexpr std::size_t kMostPlacedNodes =
    1'000'000;  // placed nodes; those of instances count each time
constexpr std::size_t kMostVertices = 50'000'000;  // likewise
constexpr std::uint64_t kMostInputs = 64;          // indices per corner

struct DaeCorner {
  std::uint32_t position = 0, normal = 0, uv = 0;
  bool operator==(const DaeCorner&) const = default;
};
struct DaeCornerHash {
  std::size_t operator()(const DaeCorner& c) const {
    return (c.position * std::size_t{0x9e3779b97f4a7c15} ^ c.normal) *
               std::size_t{0xbf58476d1ce4e5b9} ^
           c.uv;
  }
};

/// The faces of a geometry that share a material.
struct DaePart {
  TriangleMeshShape mesh;
  std::string symbol;
  SourceLocation where;
};

/// A part as the scene places it, in the file's unit.
struct PlacedPart {
  const DaePart* part = nullptr;
  glm::dmat4 scene_from_part{1};
  std::string name, material;  // the node's name; the material's id
};

class DaeReader {
 public:
  DaeReader(const std::filesystem::path& path, std::string text) : file_(path, std::move(text)) {
    if (std::string_view(file_.root().name()) != "COLLADA")
      fail(file_.root(), "the root element is not <COLLADA>");
    struct Walker : pugi::xml_tree_walker {
      explicit Walker(std::unordered_map<std::string, pugi::xml_node>& to) : ids(to) {}
      bool for_each(pugi::xml_node& node) override {
        if (const pugi::xml_attribute id = node.attribute("id")) ids.try_emplace(id.value(), node);
        return true;
      }
      std::unordered_map<std::string, pugi::xml_node>& ids;
    } walker(ids_);
    file_.root().traverse(walker);
  }

  std::vector<PlacedPart> read() {
    const pugi::xml_node instance = file_.root().child("scene").child("instance_visual_scene");
    const pugi::xml_node scene =
        instance ? target(instance, "visual_scene")
                 : file_.root().child("library_visual_scenes").child("visual_scene");
    if (scene) {
      for (const pugi::xml_node node : scene.children("node")) place(node, glm::dmat4(1), 0);
    } else {
      for (const pugi::xml_node geometry :
           file_.root().child("library_geometries").children("geometry"))
        place_geometry(geometry, {}, glm::dmat4(1), geometry.attribute("name").value());
    }
    if (left_out_ > 0)
      Diagnostics().warning(
          first_left_out_,
          fmt::format("{} lines, splines and skews of nodes are left out", left_out_));
    if (placed_.empty()) throw InputError({file_.path().string(), 0, 0}, "holds no faces");
    return std::move(placed_);
  }

  /// Returns the file's unit in metres.
  double unit() const {
    const pugi::xml_attribute meter = file_.root().child("asset").child("unit").attribute("meter");
    if (!meter) return 1;
    const double value = numbers_of(
        meter.value(), 1, 1, file_.place(file_.root().child("asset").child("unit")), "meter")[0];
    if (!(value > 0)) fail(file_.root().child("asset").child("unit"), "meter is not positive");
    return value;
  }
  const char* up() const {
    const std::string_view text = trimmed(file_.root().child("asset").child_value("up_axis"));
    return text == "Z_UP" ? "z" : text == "X_UP" ? "x" : "y";
  }

  /// Returns the values of a material; none if it does not exist.
  std::optional<MtlValues> look(const std::string& id, SourceLocation& where) const {
    const auto found = ids_.find(id);
    if (found == ids_.end() || std::string_view(found->second.name()) != "material")
      return std::nullopt;
    const pugi::xml_node material = found->second;
    where = file_.place(material);
    MtlValues out;
    const pugi::xml_attribute name = material.attribute("name");
    out.name = *name.value() ? name.value() : id;
    const pugi::xml_node effect = target(material.child("instance_effect"), "effect");
    const pugi::xml_node profile = effect.child("profile_COMMON");
    pugi::xml_node shading;
    for (const char* kind : {"phong", "blinn", "lambert", "constant"})
      if (!shading) shading = profile.child("technique").child(kind);
    if (!shading) return out;
    if (const auto color = color_of(shading.child("diffuse"))) out.kd = glm::dvec3(*color);
    out.map_kd = image_of(profile, effect, shading.child("diffuse"));
    if (!out.map_kd.empty()) out.kd = glm::dvec3(1);
    if (std::string_view(shading.name()) == "phong" || std::string_view(shading.name()) == "blinn")
      if (const auto color = color_of(shading.child("specular"))) out.ks = glm::dvec3(*color);
    out.ns = std::max(0.0, value_of(shading.child("shininess"), 0));
    if (const auto color = color_of(shading.child("emission"))) out.ke = glm::dvec3(*color);
    out.ni = value_of(shading.child("index_of_refraction"), 1.5);
    out.d = opacity_of(shading);
    return out;
  }

 private:
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(file_.place(node), message);
  }
  void leave_out(pugi::xml_node node) {
    if (left_out_++ == 0) first_left_out_ = file_.place(node);
  }

  /// Returns the element that "#id" in an attribute names.
  pugi::xml_node target(pugi::xml_node from, const char* kind,
                        const char* attribute = "url") const {
    const std::string text = from.attribute(attribute).value();
    if (!text.starts_with('#'))
      fail(from,
           fmt::format("{}=\"{}\": only what is in the file itself is read", attribute, text));
    // Some programs give the arrays of every geometry the same ids, so nearby elements come first.
    for (pugi::xml_node around = from.parent(); around; around = around.parent())
      if (std::string_view(around.name()) == "mesh" || std::string_view(around.name()) == "source")
        if (const pugi::xml_node near =
                around.find_child_by_attribute(kind, "id", text.c_str() + 1))
          return near;
    const auto found = ids_.find(text.substr(1));
    if (found == ids_.end() || std::string_view(found->second.name()) != kind)
      fail(from, fmt::format("there is no {} of the id '{}'", kind, text.substr(1)));
    return found->second;
  }

  std::vector<float> floats(pugi::xml_node node) const {
    std::vector<float> out;
    each_word(std::string_view(node.child_value()), [&](std::string_view word) {
      float value = 0;
      const NumberError error = parse_float(word, value);
      if (error != NumberError::none)
        fail(node, fmt::format("<{}>: {}", node.name(), describe(error, word)));
      out.push_back(value);
    });
    return out;
  }
  void wholes(pugi::xml_node node, std::vector<std::uint32_t>& out) const {
    each_word(std::string_view(node.child_value()), [&](std::string_view word) {
      std::uint32_t value = 0;
      if (!parse_number(word, value))
        fail(node, fmt::format("<{}>: {} is no count or index", node.name(), caplet::quoted(word)));
      out.push_back(value);
    });
  }
  std::uint64_t count_in(pugi::xml_node node, const char* name, std::uint64_t usual) const {
    const pugi::xml_attribute attribute = node.attribute(name);
    std::uint64_t value = usual;
    if (attribute && !parse_number(trimmed(attribute.value()), value))
      fail(node, fmt::format("{}=\"{}\" is no count", name, attribute.value()));
    return value;
  }

  // --- Geometry ---

  /// An array of numbers in rows.
  struct Source {
    std::vector<float> numbers;
    std::uint64_t offset = 0, stride = 0;
    pugi::xml_node accessor;
    float at(std::uint32_t row, std::uint64_t column) const {
      return numbers[offset + row * stride + column];
    }
  };
  /// The index at position `at` of a corner refers to `source`.
  struct Input {
    const Source* source = nullptr;
    std::uint64_t at = 0, count = 0;
  };
  struct Inputs {
    Input position, normal, uv;
    std::uint64_t stride = 1;
  };

  Input input(pugi::xml_node from, std::uint64_t at, std::uint64_t columns) {
    const pugi::xml_node node = target(from, "source", "source");
    const auto [entry, fresh] = sources_.try_emplace(node.hash_value());
    Source& source = entry->second;
    if (fresh) {
      source.accessor = node.child("technique_common").child("accessor");
      const pugi::xml_node array = source.accessor
                                       ? target(source.accessor, "float_array", "source")
                                       : node.child("float_array");
      if (!array) fail(node, "<source> without an array of floats");
      source.numbers = floats(array);
      source.offset = count_in(source.accessor, "offset", 0);
      source.stride = count_in(source.accessor, "stride", source.accessor ? 1 : columns);
    }
    if (source.stride < columns)
      fail(from, fmt::format("rows of {} numbers, and {} are needed", source.stride, columns));
    const std::uint64_t size = source.numbers.size();
    Input out{&source, at, 0};
    if (source.offset <= size && size - source.offset >= columns)
      out.count = (size - source.offset - columns) / source.stride + 1;
    if (const std::uint64_t count = count_in(source.accessor, "count", out.count);
        count > out.count)
      fail(source.accessor,
           fmt::format("{} rows are announced, and {} are there", count, out.count));
    return out;
  }

  Inputs inputs(pugi::xml_node primitive) {
    Inputs out;
    for (const pugi::xml_node input : primitive.children("input")) {
      const std::string_view semantic = input.attribute("semantic").value();
      const std::uint64_t offset = count_in(input, "offset", 0);
      if (offset >= kMostInputs)
        fail(input, fmt::format("offset=\"{}\" is no place of a corner's number", offset));
      out.stride = std::max(out.stride, offset + 1);
      if (semantic == "VERTEX") {
        for (const pugi::xml_node of_vertices :
             target(input, "vertices", "source").children("input"))
          use(of_vertices, of_vertices.attribute("semantic").value(), offset, out);
      } else {
        use(input, semantic, offset, out);
      }
    }
    if (!out.position.source)
      fail(primitive, fmt::format("<{}> without places of its vertices", primitive.name()));
    return out;
  }
  void use(pugi::xml_node from, std::string_view semantic, std::uint64_t at, Inputs& out) {
    if (semantic == "POSITION")
      out.position = input(from, at, 3);
    else if (semantic == "NORMAL" && !out.normal.source)
      out.normal = input(from, at, 3);
    else if (semantic == "TEXCOORD" && !out.uv.source)
      out.uv = input(from, at, 2);
  }

  /// Reads the faces of <triangles>, <polylist> and so on.
  DaePart part_of(pugi::xml_node primitive) {
    DaePart out;
    out.symbol = primitive.attribute("material").value();
    out.where = file_.place(primitive);
    const std::string_view kind = primitive.name();
    const Inputs in = inputs(primitive);
    std::unordered_map<DaeCorner, std::uint32_t, DaeCornerHash> known;
    std::vector<std::uint32_t> numbers, around;
    std::vector<glm::vec3> places;
    const auto vertex = [&](std::uint64_t corner) {
      const auto index = [&](const Input& of, const char* what) {
        if (!of.source) return std::uint32_t{0};
        const std::uint32_t i = numbers[corner * in.stride + of.at];
        if (i >= of.count) fail(primitive, fmt::format("{} {}: there are {}", what, i, of.count));
        return i;
      };
      const DaeCorner c{index(in.position, "vertex"), index(in.normal, "normal"),
                        index(in.uv, "texture coordinate")};
      const auto [entry, fresh] =
          known.try_emplace(c, narrow<std::uint32_t>(out.mesh.positions.size()));
      if (fresh) {
        const auto vector = [](const Input& of, std::uint32_t row) {
          return glm::vec3(of.source->at(row, 0), of.source->at(row, 1), of.source->at(row, 2));
        };
        out.mesh.positions.push_back(vector(in.position, c.position));
        if (in.normal.source) out.mesh.normals.push_back(vector(in.normal, c.normal));
        if (in.uv.source)
          out.mesh.uvs.emplace_back(in.uv.source->at(c.uv, 0), in.uv.source->at(c.uv, 1));
      }
      return entry->second;
    };
    const auto face = [&](std::uint64_t first, std::uint64_t count) {
      around.clear();
      places.clear();
      for (std::uint64_t k = first; k < first + count; ++k) {
        around.push_back(vertex(k));
        places.push_back(out.mesh.positions[around.back()]);
      }
      for (const auto& [a, b, c] : triangles_of(places))
        out.mesh.triangles.push_back({around[a], around[b], around[c]});
    };
    const auto read = [&](pugi::xml_node p) {
      numbers.clear();
      wholes(p, numbers);
      return numbers.size() / in.stride;
    };
    if (kind == "triangles") {
      const std::uint64_t corners = read(primitive.child("p"));
      if (corners / 3 < count_in(primitive, "count", 0))
        fail(primitive, fmt::format("{} corners are fewer than are announced", corners));
      for (std::uint64_t k = 0; k + 3 <= corners; k += 3) face(k, 3);
    } else if (kind == "polylist") {
      std::vector<std::uint32_t> sizes;
      wholes(primitive.child("vcount"), sizes);
      const std::uint64_t corners = read(primitive.child("p"));
      std::uint64_t at = 0;
      for (const std::uint32_t size : sizes) {
        if (size > corners - at)
          fail(primitive, fmt::format("{} corners are fewer than <vcount> says", corners));
        face(at, size);
        at += size;
      }
    } else {
      for (pugi::xml_node p : primitive.children()) {
        if (std::string_view(p.name()) == "ph") p = p.child("p");  // holes are filled
        if (std::string_view(p.name()) != "p") continue;
        const std::uint64_t corners = read(p);
        if (kind == "polygons") face(0, corners);
        for (std::uint64_t k = 2; k < corners && kind != "polygons"; ++k) {
          const std::uint32_t a = vertex(kind == "trifans" ? 0 : k - 2), b = vertex(k - 1),
                              c = vertex(k);
          if (kind == "tristrips" && k % 2 != 0)
            out.mesh.triangles.push_back({b, a, c});
          else
            out.mesh.triangles.push_back({a, b, c});
        }
      }
    }
    return out;
  }

  const std::vector<DaePart>& parts_of(pugi::xml_node geometry) {
    const auto [entry, fresh] = geometries_.try_emplace(geometry.hash_value());
    if (!fresh) return entry->second;
    for (const pugi::xml_node primitive : geometry.child("mesh").children()) {
      const std::string_view kind = primitive.name();
      if (kind == "lines" || kind == "linestrips") leave_out(primitive);
      if (kind != "triangles" && kind != "polylist" && kind != "polygons" && kind != "trifans" &&
          kind != "tristrips")
        continue;
      DaePart part = part_of(primitive);
      if (!part.mesh.triangles.empty()) entry->second.push_back(std::move(part));
    }
    if (const pugi::xml_node spline = geometry.child("spline")) leave_out(spline);
    return entry->second;
  }

  // --- Nodes ---

  /// Fills the first rows of a matrix from numbers in row order.
  static void fill_rows(const std::vector<double>& v, int rows, glm::dmat4& m) {
    std::size_t at = 0;
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < 4; ++column) m[column][row] = v[at++];
  }
  glm::dmat4 transform_of(pugi::xml_node node) {
    glm::dmat4 out(1);
    for (const pugi::xml_node part : node.children()) {
      const std::string_view kind = part.name();
      const auto values = [&](std::size_t count) {
        return numbers_of(part.child_value(), count, count, file_.place(part), part.name());
      };
      if (kind == "matrix") {
        const std::vector<double> v = values(16);
        glm::dmat4 m(1);
        fill_rows(v, 4, m);
        if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
          fail(part, "the last row of a matrix is not 0 0 0 1");
        out = out * m;
      } else if (kind == "translate") {
        const std::vector<double> v = values(3);
        out = glm::translate(out, glm::dvec3(v[0], v[1], v[2]));
      } else if (kind == "scale") {
        const std::vector<double> v = values(3);
        out = glm::scale(out, glm::dvec3(v[0], v[1], v[2]));
      } else if (kind == "rotate") {
        const std::vector<double> v = values(4);
        const glm::dvec3 axis(v[0], v[1], v[2]);
        if (glm::length(axis) > 0) out = glm::rotate(out, glm::radians(v[3]), axis);
      } else if (kind == "lookat") {
        const std::vector<double> v = values(9);
        const glm::dmat4 eye =
            glm::lookAt(glm::dvec3(v[0], v[1], v[2]), glm::dvec3(v[3], v[4], v[5]),
                        glm::dvec3(v[6], v[7], v[8]));
        if (!(std::abs(glm::determinant(eye)) > 0.5))
          fail(part, "looks along the direction that is up, or at itself");
        out = out * glm::inverse(eye);
      } else if (kind == "skew") {
        leave_out(part);
      }
    }
    return out;
  }

  void place(pugi::xml_node node, const glm::dmat4& above, int depth) {
    if (depth > kDeepestNode)
      fail(node, "nodes hold themselves, or are too many within each other");
    if (++nodes_ > kMostPlacedNodes)
      fail(node, fmt::format("more than {} nodes with those of instances", kMostPlacedNodes));
    const glm::dmat4 here = above * transform_of(node);
    const char* name = *node.attribute("name").value() ? node.attribute("name").value()
                                                       : node.attribute("id").value();
    for (const pugi::xml_node child : node.children()) {
      const std::string_view kind = child.name();
      if (kind == "node") {
        place(child, here, depth + 1);
      } else if (kind == "instance_node") {
        place(target(child, "node"), here, depth + 1);
      } else if (kind == "instance_geometry") {
        place_geometry(target(child, "geometry"), child, here, name);
      } else if (kind == "instance_controller") {
        // The mesh is drawn in its bind pose: bones are not moved.
        const pugi::xml_node skin = target(child, "controller").child("skin");
        if (!skin) {
          leave_out(child);
          continue;
        }
        glm::dmat4 bound(1);
        if (const pugi::xml_node shape = skin.child("bind_shape_matrix")) {
          const std::vector<double> v =
              numbers_of(shape.child_value(), 16, 16, file_.place(shape), shape.name());
          fill_rows(v, 3, bound);
        }
        place_geometry(target(skin, "geometry", "source"), child, here * bound, name);
      }
    }
  }

  void place_geometry(pugi::xml_node geometry, pugi::xml_node instance,
                      const glm::dmat4& scene_from_part, const char* name) {
    for (const DaePart& part : parts_of(geometry)) {
      vertices_ += part.mesh.positions.size();
      if (vertices_ > kMostVertices)
        fail(geometry, fmt::format("more than {} vertices with those of instances", kMostVertices));
      PlacedPart placed{&part, scene_from_part, name, part.symbol};
      for (const pugi::xml_node bound :
           instance.child("bind_material").child("technique_common").children("instance_material"))
        if (part.symbol == bound.attribute("symbol").value()) {
          const std::string_view to = bound.attribute("target").value();
          placed.material = to.substr(to.starts_with('#') ? 1 : 0);
        }
      placed_.push_back(std::move(placed));
    }
  }

  // --- Materials ---

  std::optional<glm::dvec4> color_of(pugi::xml_node node) const {
    const pugi::xml_node color = node.child("color");
    if (!color) return std::nullopt;
    std::vector<double> v = numbers_of(color.child_value(), 3, 4, file_.place(color), "color");
    v.resize(4, 1);
    return glm::max(glm::dvec4(v[0], v[1], v[2], v[3]), 0.0);
  }
  double value_of(pugi::xml_node node, double usual) const {
    const pugi::xml_node value = node.child("float");
    return value ? numbers_of(value.child_value(), 1, 1, file_.place(value), node.name())[0]
                 : usual;
  }
  /// Applies the modes of <transparent>. Full transparency becomes opaque, because some programs
  /// write 0 for none.
  double opacity_of(pugi::xml_node shading) const {
    const pugi::xml_node transparent = shading.child("transparent");
    const double amount = value_of(shading.child("transparency"), 1);
    const std::optional<glm::dvec4> color = color_of(transparent);
    if (!color)
      return shading.child("transparency") && amount > 0 && amount < 1 && !transparent ? amount : 1;
    const std::string_view way = transparent.attribute("opaque").value();
    const double luminance = 0.212671 * color->r + 0.715160 * color->g +
                             0.072169 * color->b;  // weights of the specification
    const double out = way == "RGB_ZERO"  ? 1 - luminance * amount
                       : way == "A_ZERO"  ? 1 - color->a * amount
                       : way == "RGB_ONE" ? luminance * amount
                                          : color->a * amount;
    return out > 0 ? std::min(out, 1.0) : 1;
  }

  /// Returns the file of a texture's image; empty if there is none.
  std::string image_of(pugi::xml_node profile, pugi::xml_node effect, pugi::xml_node node) const {
    std::string name = node.child("texture").attribute("texture").value();
    if (name.empty()) return {};
    const auto parameter = [&](const std::string& sid) {
      for (const pugi::xml_node of : {profile, effect})
        for (const pugi::xml_node found : of.children("newparam"))
          if (sid == found.attribute("sid").value()) return found;
      return pugi::xml_node();
    };
    // The name refers to a sampler of a surface of an image, to a sampler of an image (1.5), or to
    // the image.
    if (const pugi::xml_node sampler = parameter(name).child("sampler2D")) {
      if (const pugi::xml_node image = sampler.child("instance_image")) {
        name = std::string_view(image.attribute("url").value())
                   .substr(*image.attribute("url").value() == '#' ? 1 : 0);
      } else {
        name = trimmed(sampler.child_value("source"));
        name = trimmed(parameter(name).child("surface").child_value("init_from"));
      }
    }
    const auto found = ids_.find(name);
    if (found == ids_.end() || std::string_view(found->second.name()) != "image") {
      Diagnostics().warning(file_.place(node),
                            "the texture " + quoted_name(node) + " has no image: it is left out");
      return {};
    }
    const pugi::xml_node from = found->second.child("init_from");
    std::string_view uri =
        trimmed(from.child("ref") ? from.child_value("ref") : from.child_value());
    if (uri.starts_with("file://")) uri.remove_prefix(7);
    return unescaped(uri);
  }
  static std::string quoted_name(pugi::xml_node node) {
    return fmt::format(
        "'{}'", std::string_view(node.child("texture").attribute("texture").value()).substr(0, 80));
  }
  /// Decodes "%20" to a blank, and so on.
  static std::string unescaped(std::string_view uri) {
    std::string out;
    for (std::size_t i = 0; i < uri.size(); ++i) {
      unsigned code = 0;
      const bool coded = uri[i] == '%' && i + 2 < uri.size() &&
                         std::from_chars(uri.data() + i + 1, uri.data() + i + 3, code, 16).ptr ==
                             uri.data() + i + 3 &&
                         code > 0;
      out += coded ? static_cast<char>(code) : uri[i];
      if (coded) i += 2;
    }
    return out;
  }

  XmlFile file_;
  std::unordered_map<std::string, pugi::xml_node> ids_;
  std::map<std::size_t, Source> sources_;
  std::map<std::size_t, std::vector<DaePart>> geometries_;
  std::vector<PlacedPart> placed_;
  std::size_t nodes_ = 0, vertices_ = 0, left_out_ = 0;
  SourceLocation first_left_out_;
};

}  // namespace

std::vector<TriangleMeshShape> read_dae_meshes(const std::filesystem::path& path,
                                               const SourceLocation& where) {
  DaeReader reader(path, read_file(path, where));
  const std::vector<PlacedPart> parts = reader.read();
  const glm::dmat4 unit = glm::scale(glm::dmat4(1), glm::dvec3(reader.unit()));
  std::vector<TriangleMeshShape> out;
  for (const PlacedPart& placed : parts) {
    const glm::dmat4 to = unit * placed.scene_from_part;
    const glm::dmat3 turn(to);
    // Normals transform by the cofactors: the inverse transpose up to a factor, and defined for
    // singular matrices too.
    const glm::dmat3 normals(glm::cross(turn[1], turn[2]), glm::cross(turn[2], turn[0]),
                             glm::cross(turn[0], turn[1]));
    TriangleMeshShape mesh = placed.part->mesh;
    for (glm::vec3& p : mesh.positions) {
      p = glm::dvec3(to * glm::dvec4(p, 1));
      for (int k = 0; k < 3; ++k)
        if (!(std::abs(p[k]) <= largest_number))
          throw InputError(placed.part->where, "a vertex is not finite or out of range");
    }
    for (glm::vec3& n : mesh.normals) n = normals * glm::dvec3(n);
    out.push_back(std::move(mesh));
  }
  return out;
}

Scene import_dae(const std::filesystem::path& path, const ImageReader& images,
                 const ImportOptions& options) {
  Scene scene;
  scene.source = path.string();
  DaeReader reader(path, read_file(path, {}));
  const std::vector<PlacedPart> parts = reader.read();
  const glm::dmat4 world =
      world_from_file(options, reader.up()) * glm::scale(glm::dmat4(1), glm::dvec3(reader.unit()));
  scene.world_from_file = glm::dmat3(world_from_file(options, reader.up()));
  MeshImages textures(scene, images);
  std::map<std::string, MtlMaterial> materials;
  std::optional<std::uint32_t> plain;
  for (const PlacedPart& placed : parts) {
    auto material = materials.find(placed.material);
    SourceLocation where;
    if (material == materials.end()) {
      if (const std::optional<MtlValues> look = reader.look(placed.material, where))
        material = materials
                       .emplace(placed.material,
                                make_mtl(*look, where, path.parent_path(), scene, textures))
                       .first;
      else if (!plain)
        plain = add_plain_material(scene);
    }
    std::string name = placed.name.empty() ? path.stem().string() : placed.name;
    Shape shape = mesh_shape(placed.part->mesh, std::move(name),
                             material == materials.end() ? *plain : material->second.material,
                             placed.part->where);
    if (material != materials.end()) {
      shape.emission = material->second.emission;
      shape.alpha = material->second.alpha;
    }
    shape.world_from_object = world * placed.scene_from_part;
    scene.shapes.push_back(std::move(shape));
  }
  return scene;
}

}  // namespace caplet
