// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// 3MF packages (Core Specification 1.3): objects of triangles and components, placed by build
// items; colours of base materials and colour groups (Materials Extension); other parts by path
// (Production Extension).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "base/check.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/model_3mf.h"
#include "import/detail/text_file.h"
#include "present/present.h"
#include "scene/texture_image.h"

namespace caplet {

namespace model_3mf {

std::string_view local_name(const char* name) {
  const char* colon = std::strchr(name, ':');
  return colon != nullptr ? colon + 1 : name;
}
bool is(pugi::xml_node node, std::string_view name) { return local_name(node.name()) == name; }
pugi::xml_node child(pugi::xml_node node, std::string_view name) {
  for (const pugi::xml_node one : node.children())
    if (is(one, name)) return one;
  return {};
}
pugi::xml_attribute attribute(pugi::xml_node node, std::string_view name) {
  for (const pugi::xml_attribute one : node.attributes())
    if (local_name(one.name()) == name) return one;
  return {};
}

void Part::fail(pugi::xml_node node, const std::string& message) const {
  throw InputError(file.place(node), message);
}

std::optional<std::uint32_t> Part::whole_if(pugi::xml_node node, std::string_view name) const {
  const pugi::xml_attribute given = attribute(node, name);
  if (!given) return std::nullopt;
  std::uint32_t value = 0;
  if (!parse_number(std::string_view(given.value()), value))
    fail(node, std::string(name) + ": " + caplet::quoted(given.value()) + " is no index");
  return value;
}
std::uint32_t Part::whole(pugi::xml_node node, std::string_view name) const {
  const auto value = whole_if(node, name);
  if (!value) fail(node, std::string(node.name()) + " needs " + std::string(name));
  return *value;
}
float Part::number(pugi::xml_node node, std::string_view name) const {
  const pugi::xml_attribute given = attribute(node, name);
  if (!given) fail(node, std::string(node.name()) + " needs " + std::string(name));
  float value = 0;
  const NumberError error = parse_float(given.value(), value);
  if (error != NumberError::none)
    fail(node, std::string(name) + ": " + describe(error, given.value()));
  return value;
}
std::optional<float> Part::positive_if(pugi::xml_node node, std::string_view name) const {
  if (!attribute(node, name)) return std::nullopt;
  const float value = number(node, name);
  if (!(value > 0)) fail(node, std::string(name) + " is not positive");
  return value;
}
glm::dmat4 Part::transform(pugi::xml_node node) const {
  const pugi::xml_attribute given = attribute(node, "transform");
  if (!given) return glm::dmat4(1);
  const std::vector<double> m = numbers_of(given.value(), 12, 12, file.place(node), "transform");
  return {
      {m[0], m[1], m[2], 0}, {m[3], m[4], m[5], 0}, {m[6], m[7], m[8], 0}, {m[9], m[10], m[11], 1}};
}

std::optional<glm::dvec4> Colors::of(const Part& part, std::optional<std::uint32_t> id,
                                     std::optional<std::uint32_t> index, pugi::xml_node node) {
  if (!id) return std::nullopt;
  if (const auto other = part.other_properties.find(*id); other != part.other_properties.end()) {
    if (!has_warned_)
      Diagnostics().warning(part.file.place(node), "properties of " + other->second +
                                                       " are not read: what has them is grey");
    has_warned_ = true;
    return std::nullopt;
  }
  const auto found = part.colors.find(*id);
  if (found == part.colors.end())
    part.fail(node, fmt::format("there is no property group {}", *id));
  if (index.value_or(0) >= found->second.size())
    part.fail(node, fmt::format("property {} of group {}: it has {}", index.value_or(0), *id,
                                found->second.size()));
  return found->second[index.value_or(0)];
}

std::optional<glm::dvec4> Colors::mean(const std::vector<std::optional<glm::dvec4>>& colors) {
  constexpr double kSteps = 31;
  if (std::ranges::all_of(colors, [&](const auto& color) { return color == colors[0]; }))
    return colors[0];
  glm::dvec4 sum(0);
  double count = 0;
  for (const auto& color : colors)
    if (color) {
      sum += *color;
      ++count;
    }
  return glm::round(sum / count * kSteps) / kSteps;
}

std::uint32_t Colors::material(const std::optional<glm::dvec4>& color) {
  if (!color) {
    if (!plain_) plain_ = add_plain_material(scene_);
    return *plain_;
  }
  const auto [entry, fresh] = materials_.try_emplace(
      {color->r, color->g, color->b}, narrow<std::uint32_t>(scene_.materials.size()));
  if (fresh)
    scene_.materials.push_back({DiffuseMaterial{RgbSpectrum{glm::dvec3(*color)}},
                                fmt::format("color {}", materials_.size()),
                                {scene_.source, 0, 0}});
  return entry->second;
}

}  // namespace model_3mf

namespace {

using model_3mf::attribute;
using model_3mf::child;
using model_3mf::Colors;
using model_3mf::is;
using model_3mf::Part;

constexpr std::size_t kDeepestObject = 64;      // nesting of objects
constexpr std::size_t kMostPlaces = 2'000'000;  // shared objects count each time
constexpr std::string_view kModel = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";

class PackageReader {
 public:
  PackageReader(const std::filesystem::path& path, const ImportOptions& options)
      : zip_(path), options_(options), colors_(scene_) {
    scene_.source = path.string();
  }

  Scene read() {
    const Part& root = part(model_name());
    const glm::dmat4 world =
        glm::scale(world_from_file(options_, "z"), glm::dvec3(root.millimetres));
    for (const pugi::xml_node item : child(root.file.root(), "build").children())
      if (is(item, "item")) visit(root, item, world, 0);
    place_objects();
    if (scene_.shapes.empty() && scene_.instances.empty())
      fail("holds nothing to draw: its build places no triangles and no beams");
    add_presentation(scene_);
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({zip_.path().string(), 0, 0}, message);
  }

  /// Parsed XML takes more memory than its text: 64 bytes per element, 40 per attribute.
  std::string text_of(const std::string& name) {
    std::string text = zip_.read(name);
    const auto nodes = static_cast<std::uintmax_t>(std::ranges::count(text, '<')),
               attributes = static_cast<std::uintmax_t>(std::ranges::count(text, '='));
    constexpr std::uintmax_t most = std::uintmax_t{3} << 30;
    if (64 * nodes + 40 * attributes > most)
      fail(name + ": has more elements than 3 GiB of memory hold");
    return text;
  }

  /// Returns the model's name, which the package's relationship gives.
  std::string model_name() {
    const auto relations = zip_.find("_rels/.rels");
    if (!relations) fail("is no 3MF package: the archive has no _rels/.rels");
    const XmlFile file(zip_.path() / *relations, text_of(*relations));
    for (const pugi::xml_node node : file.root().children())
      if (is(node, "Relationship") && std::string_view(node.attribute("Type").value()) == kModel)
        return node.attribute("Target").value();
    throw InputError(file.place(file.root()), "no relationship names a 3D model");
  }

  const Part& part(const std::string& target) {
    std::string name = target;
    while (name.starts_with('/')) name.erase(0, 1);
    const auto there = zip_.find(name);
    if (!there) fail("the archive has no " + caplet::quoted(target));
    const auto [entry, fresh] = parts_.try_emplace(*there);
    if (fresh) {
      auto out = std::make_unique<Part>(zip_.path() / *there, text_of(*there));
      read_part(*out);
      entry->second = std::move(out);
    }
    return *entry->second;
  }

  void read_part(Part& out) const {
    const pugi::xml_node model = out.file.root();
    if (!is(model, "model")) out.fail(model, "the part is no 3D model");
    out.millimetres = unit(out, model);
    check_extensions(out, model);
    for (const pugi::xml_node resource : child(model, "resources").children()) {
      if (is(resource, "object"))
        out.objects.emplace(out.whole(resource, "id"), resource);
      else if (is(resource, "basematerials"))
        read_colors(out, resource, "base", "displaycolor");
      else if (is(resource, "colorgroup"))
        read_colors(out, resource, "color", "color");
      else if (const auto id = out.whole_if(resource, "id"))
        out.other_properties.emplace(*id, std::string(model_3mf::local_name(resource.name())));
    }
  }

  static double unit(const Part& out, pugi::xml_node model) {
    const std::string_view name = attribute(model, "unit").as_string("millimeter");
    constexpr std::array<std::pair<std::string_view, double>, 6> units{{{"micron", 1e-3},
                                                                        {"millimeter", 1},
                                                                        {"centimeter", 10},
                                                                        {"inch", 25.4},
                                                                        {"foot", 304.8},
                                                                        {"meter", 1000}}};
    for (const auto& [known, millimetres] : units)
      if (name == known) return millimetres;
    out.fail(model, caplet::quoted(name) + " is no unit of length");
  }

  static void check_extensions(const Part& out, pugi::xml_node model) {
    constexpr std::array<std::string_view, 5> known{
        "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02",
        "http://schemas.microsoft.com/3dmanufacturing/beamlattice/balls/2020/07",
        "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
        "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
        "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07"};
    for (const std::string_view prefix : words_of(attribute(model, "requiredextensions").value())) {
      const std::string space = model.attribute(("xmlns:" + std::string(prefix)).c_str()).value();
      if (std::ranges::find(known, space) == known.end())
        out.fail(model, "requires the extension " + caplet::quoted(prefix) + " (" + space +
                            "), which is not read");
    }
  }

  static void read_colors(Part& out, pugi::xml_node group, std::string_view element,
                          std::string_view name) {
    std::vector<glm::dvec4>& colors = out.colors[out.whole(group, "id")];
    for (const pugi::xml_node node : group.children()) {
      if (!is(node, element)) continue;
      const std::string_view text = attribute(node, name).value();
      std::uint32_t bits = 0;
      const char* end = text.data() + text.size();
      if ((text.size() != 7 && text.size() != 9) || text[0] != '#' ||
          std::from_chars(text.data() + 1, end, bits, 16).ptr != end)
        out.fail(node, caplet::quoted(text) + " is no color (#RRGGBB or #RRGGBBAA)");
      if (text.size() == 7) bits = (bits << 8U) | 0xffU;
      glm::dvec4 color;
      for (int k = 0; k < 4; ++k)
        color[k] = static_cast<double>((bits >> static_cast<unsigned>(24 - 8 * k)) & 0xffU) / 255;
      for (int k = 0; k < 3; ++k) color[k] = decoded_value({}, color[k]);
      colors.push_back(color);
    }
  }

  /// Visits `node`, an item or a component, which names an object.
  void visit(const Part& from, pugi::xml_node node, const glm::dmat4& parent, std::size_t depth) {
    if (depth > kDeepestObject)
      from.fail(node, fmt::format("lies within more than {} other objects: are there cycles?",
                                  kDeepestObject));
    if (++visited_ > kMostPlaces)
      from.fail(node, fmt::format("more than {} objects are placed", kMostPlaces));
    const pugi::xml_attribute path = attribute(node, "path");
    const Part& in = path ? part(path.value()) : from;
    const std::uint32_t id = from.whole(node, "objectid");
    const auto object = in.objects.find(id);
    if (object == in.objects.end()) from.fail(node, fmt::format("there is no object {}", id));
    const glm::dmat4 world = parent * from.transform(node);
    if (child(object->second, "mesh")) {
      const auto [entry, fresh] = index_.try_emplace({&in, id}, placed_.size());
      if (fresh) placed_.push_back({&in, object->second, {}});
      placed_[entry->second].places.push_back(world);
    }
    for (const pugi::xml_node component : child(object->second, "components").children())
      if (is(component, "component")) visit(in, component, world, depth + 1);
  }

  void place_objects() {
    for (const Placed& placed : placed_) {
      std::vector<Shape> shapes = shapes_of(*placed.part, placed.object);
      if (shapes.empty()) continue;
      const SourceLocation where = placed.part->file.place(placed.object);
      if (placed.places.size() == 1) {
        for (Shape& shape : shapes) {
          shape.world_from_object = placed.places[0] * shape.world_from_object;
          scene_.shapes.push_back(std::move(shape));
        }
        continue;
      }
      Object object;
      object.name = shapes[0].name;
      object.where = where;
      object.shapes = std::move(shapes);
      for (const glm::dmat4& place : placed.places)
        scene_.instances.push_back({narrow<std::uint32_t>(scene_.objects.size()), place, where});
      scene_.objects.push_back(std::move(object));
    }
  }

  std::vector<Shape> shapes_of(const Part& part, pugi::xml_node object) {
    const pugi::xml_node mesh = child(object, "mesh");
    const std::string given = attribute(object, "name").value();
    const std::string name =
        given.empty() ? fmt::format("object {}", part.whole(object, "id")) : given;
    std::vector<glm::vec3> points;
    for (const pugi::xml_node vertex : child(mesh, "vertices").children())
      if (is(vertex, "vertex"))
        points.emplace_back(part.number(vertex, "x"), part.number(vertex, "y"),
                            part.number(vertex, "z"));
    std::vector<Shape> shapes;
    add_triangles(part, object, child(mesh, "triangles"), points, name, shapes);
    if (const pugi::xml_node lattice = child(mesh, "beamlattice"))
      model_3mf::add_lattice(part, object, lattice, points, name, colors_, shapes);
    return shapes;
  }

  void add_triangles(const Part& part, pugi::xml_node object, pugi::xml_node triangles,
                     const std::vector<glm::vec3>& points, const std::string& name,
                     std::vector<Shape>& shapes) {
    struct Group {
      TriangleMeshShape mesh;
      std::map<std::uint32_t, std::uint32_t> vertices;  // by the object's indices
    };
    std::map<std::pair<std::uint32_t, double>, Group> groups;  // by material and alpha
    const std::optional<std::uint32_t> usual_id = part.whole_if(object, "pid"),
                                       usual_index = part.whole_if(object, "pindex");
    for (const pugi::xml_node triangle : triangles.children()) {
      if (!is(triangle, "triangle")) continue;
      std::array<std::uint32_t, 3> corners{};
      std::vector<std::optional<glm::dvec4>> colors;
      constexpr std::array<const char*, 3> vertex_names{"v1", "v2", "v3"},
          property_names{"p1", "p2", "p3"};
      const std::optional<std::uint32_t> own = part.whole_if(triangle, "pid"),
                                         id = own ? own : usual_id;
      std::optional<std::uint32_t> first = part.whole_if(triangle, "p1");
      if (!first) first = usual_index;
      for (std::size_t k = 0; k < 3; ++k) {
        corners.at(k) = part.whole(triangle, vertex_names.at(k));
        if (corners.at(k) >= points.size())
          part.fail(triangle, fmt::format("{} is vertex {}: there are {}", vertex_names.at(k),
                                          corners.at(k), points.size()));
        const std::optional<std::uint32_t> index = part.whole_if(triangle, property_names.at(k));
        if (id) colors.push_back(colors_.of(part, id, index ? index : first, triangle));
      }
      const std::optional<glm::dvec4> color = colors.empty() ? std::nullopt : Colors::mean(colors);
      Group& group = groups[{colors_.material(color), color ? color->a : 1.0}];
      for (std::uint32_t& corner : corners) {
        const auto [entry, fresh] =
            group.vertices.try_emplace(corner, narrow<std::uint32_t>(group.mesh.positions.size()));
        if (fresh) group.mesh.positions.push_back(points[corner]);
        corner = entry->second;
      }
      group.mesh.triangles.push_back(corners);
    }
    for (auto& [look, group] : groups) {
      Shape shape = mesh_shape(std::move(group.mesh), name, look.first, part.file.place(object));
      if (look.second < 1) shape.alpha = TextureOperand(look.second);
      shapes.push_back(std::move(shape));
    }
  }

  struct Placed {
    const Part* part;
    pugi::xml_node object;
    std::vector<glm::dmat4> places;
  };

  ZipFile zip_;
  const ImportOptions& options_;
  Scene scene_;
  Colors colors_;
  std::map<std::string, std::unique_ptr<Part>> parts_;
  std::map<std::pair<const Part*, std::uint32_t>, std::size_t> index_;
  std::vector<Placed> placed_;  // in the order of the build
  std::size_t visited_ = 0;
};

}  // namespace

Scene import_3mf(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  return PackageReader(path, options).read();
}

}  // namespace caplet
