// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The graph of an Embree scene: groups, transforms and references to named elements. Elements
// become shapes, or instances where they occur more than once.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/check.h"
#include "base/reading.h"
#include "import/detail/embree.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/import.h"
#include "scene/append.h"

namespace caplet {

namespace fs = std::filesystem;

namespace embree {

namespace {

constexpr int kDeepest = 500, kHighest = 5000;  // nesting of elements, and with references
constexpr std::size_t kMostXmlFiles = 20;
constexpr std::size_t kMostVisited = 4'000'000, kMostPlaced = 1'000'000;
constexpr std::size_t kMostKeys = 4'000'000;  // of all that is visited

/// Where something is.
struct Place {
  glm::dmat4 first{1};        // of what moves: at its first key
  TransformKeys motion = {};  // none: it rests
};

/// Interpolates matrices as Embree does, entry by entry.
glm::dmat4 at_time(const TransformKeys& keys, double time) {
  std::size_t i = 1;
  while (i + 1 < keys.size() && keys[i].time < time) ++i;
  const TransformKey &a = keys[i - 1], &b = keys[i];
  const double t = (time - a.time) / (b.time - a.time);
  return a.matrix * (1 - t) + b.matrix * t;
}

/// Returns the place of what is at `inner` within `outer`. Where both move, it has the keys of
/// both.
Place operator*(const Place& outer, const Place& inner) {
  Place out{outer.first * inner.first};
  std::vector<double> times;
  for (const TransformKeys* keys : {&outer.motion, &inner.motion})
    for (const TransformKey& key : *keys) times.push_back(key.time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  for (const double time : times)
    out.motion.push_back(
        {time, (outer.motion.empty() ? outer.first : at_time(outer.motion, time)) *
                   (inner.motion.empty() ? inner.first : at_time(inner.motion, time))});
  return out;
}

double time_of(std::size_t step, std::size_t steps) {
  return static_cast<double>(step) / static_cast<double>(steps - 1);
}

struct Node {
  std::vector<Place> places;  // of the children; none: at the node itself
  std::vector<std::shared_ptr<const Node>> children;
  std::vector<Shape> shapes;
  std::optional<LightElement> light;
  std::vector<View> views;  // of a camera, at its time steps
  SourceLocation where;
  int height = 0;  // the nesting depth of its content
};
using NodePtr = std::shared_ptr<const Node>;

/// A null child is ignored.
void add_child(Node& to, NodePtr child) {
  if (!child) return;
  to.height = std::max(to.height, child->height + 1);
  if (to.height > kHighest)
    throw InputError(to.where,
                     fmt::format("more than {} elements lie within each other", kHighest));
  to.children.push_back(std::move(child));
}

class EmbreeReader {
 public:
  EmbreeReader(const fs::path& path, const ImageReader& reader, const ImportOptions& options)
      : reader_(reader), options_(options), images_(scene_, reader) {
    scene_.source = path.string();
  }

  Imported read(const fs::path& path) {
    std::vector<NodePtr> roots;
    ViewerOptions viewer;
    if (is_xml(path)) {
      roots.push_back(file(path, {}, 0));
    } else {
      viewer = read_ecs(path, notes_);
      for (const auto& [one, where] : viewer.files) {
        if (!is_file(one, where))
          throw InputError(where, "there is no file '" + one.string() + "'");
        if (!is_xml(one))
          throw InputError(where, "'" + one.string() + "' is no XML: it is not read");
        roots.push_back(file(one, where, 0));
      }
    }
    const glm::dmat4 world = world_from_file(options_, "y");
    scene_.world_from_file = glm::dmat3(world);
    for (const NodePtr& root : roots) visit(*root, {world});
    place();
    if (scene_.shapes.empty() && scene_.instances.empty())
      throw InputError({scene_.source, 0, 0}, "holds no geometry");
    const std::size_t before = scene_.shapes.size();
    for (const auto& [light, place] : lights_) add_light(*light, place, scene_);
    for (const LightElement& light : viewer.lights) add_light(light, world, scene_);
    const bool is_lit = !scene_.lights.empty() || scene_.shapes.size() > before;
    if (viewer.size) {
      scene_.view.film.width = viewer.size->x;
      scene_.view.film.height = viewer.size->y;
    }
    if (viewer.view) see({*viewer.view}, {world}, {scene_.source, 0, 0});
    set_camera();
    notes_.tell();
    Imported out(std::move(scene_));
    out.has_camera = !views_.empty();
    out.is_lit = is_lit;
    return out;
  }

 private:
  static bool is_xml(const fs::path& path) {
    const std::string text = read_file(path, {}).substr(0, 256);
    const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first != std::string::npos && text[first] == '<';
  }

  NodePtr file(const fs::path& path, const SourceLocation& named_at, int depth) {
    std::error_code error;
    fs::path same = fs::weakly_canonical(path, error);
    if (error) same = path;
    if (const auto found = files_.find(same); found != files_.end()) {
      if (!found->second)
        throw InputError(named_at, "'" + path.string() + "' names itself, or a file that names it");
      return found->second;
    }
    if (files_.size() == kMostXmlFiles)
      throw InputError(named_at, fmt::format("more than {} files", kMostXmlFiles));
    files_[same] = nullptr;
    SceneFile scene_file(path, named_at);
    const pugi::xml_node root = scene_file.root();
    if (std::string_view(root.name()) != "scene")
      scene_file.fail(root, "the root element is not <scene>: this is no scene of Embree");
    auto group = std::make_shared<Node>();
    group->where = scene_file.place(root);
    children(scene_file, root, *group, depth);
    return files_[same] = group;
  }

  void children(SceneFile& from, pugi::xml_node node, Node& to, int depth) {
    for (const pugi::xml_node child : node.children())
      if (child.type() == pugi::node_element) add_child(to, element(from, child, depth + 1));
  }

  /// Returns null where nothing is drawn.
  NodePtr element(SceneFile& from, pugi::xml_node node, int depth) {
    if (depth > kDeepest) from.fail(node, fmt::format("lies within {} others", kDeepest));
    const std::string_view name = node.name();
    const std::string id = node.attribute("id").value();
    if (name == "ref") {
      const auto found = nodes_.find(id);
      if (found == nodes_.end())
        from.fail(node, "there is nothing of the id '" + id + "' before it");
      return found->second;
    }
    if (name == "assign") return assign(from, node, id, depth);
    NodePtr out = made(from, node, name, depth);
    if (!id.empty()) nodes_[id] = out;
    return out;
  }

  NodePtr assign(SceneFile& from, pugi::xml_node node, const std::string& id, int depth) {
    const std::string_view type = node.attribute("type").value();
    pugi::xml_node child = node.first_child();
    while (child && child.type() != pugi::node_element) child = child.next_sibling();
    if (!child || (type != "material" && type != "scene"))
      from.fail(node, "assigns neither a material nor a scene");
    if (type == "material")
      looks_[id] = look(from, child, node.attribute("name").value());
    else
      nodes_[id] = element(from, child, depth + 1);
    return nullptr;
  }

  NodePtr made(SceneFile& from, pugi::xml_node node, std::string_view name, int depth) {
    auto out = std::make_shared<Node>();
    out->where = from.place(node);
    if (is_geometry(name)) {
      out->shapes = shapes_of(from, node, look(from, node.child("material"), ""), notes_);
      return out;
    }
    if (is_light(name)) {
      out->light = read_light(from, node);
      return out;
    }
    if (name == "Group" || name == "Flatten" || name == "TimeRange" ||
        name.starts_with("Convert")) {
      children(from, node, *out, depth);
    } else if (name == "Transform" || name == "MultiTransform" || name == "Transform2" ||
               name == "TransformAnimation") {
      transform(from, node, *out, depth);
    } else if (name == "Animation" || name == "Animation2") {
      notes_.add("what moves is drawn as at its first moment", out->where);
      Node all;
      children(from, node, all, depth);
      if (!all.children.empty()) add_child(*out, all.children.front());
    } else if (name == "PerspectiveCamera") {
      out->views = {camera(from, node)};
    } else if (name == "AnimatedPerspectiveCamera") {
      for (const pugi::xml_node step : node.children("PerspectiveCamera"))
        out->views.push_back(camera(from, step));
    } else if (name == "xml" || name == "extern" || name == "extern_combine" || name == "obj") {
      add_child(*out, other(from, node, depth));
    } else if (name == "SubdivisionMesh" || name == "FurBall" || name == "AnimatedLight") {
      notes_.add(fmt::format("<{}> is left out", name), out->where);
      return nullptr;
    } else {
      from.fail(node, "<" + std::string(name) + "> is no element of Embree's scenes");
    }
    return out;
  }

  /// Reads one transform, or all those of a MultiTransform, at each time step.
  void transform(SceneFile& from, pugi::xml_node node, Node& to, int depth) {
    std::vector<std::vector<glm::dmat4>> steps;
    for (const pugi::xml_node child : node.children()) {
      if (child.type() != pugi::node_element) continue;
      const std::string_view name = child.name();
      if (name == "AffineSpace" || name == "AffineSpaceArray") {
        steps.push_back(name == "AffineSpace" ? std::vector{affine_space(from, child)}
                                              : affine_spaces(from, child));
        if (steps.back().size() != steps[0].size())
          from.fail(child, fmt::format("has {} transforms, the first time step {}",
                                       steps.back().size(), steps[0].size()));
      } else if (name == "Quaternion" || name == "QuaternionArray") {
        from.fail(child, "turns by quaternions are not read");
      } else {
        add_child(to, element(from, child, depth + 1));
      }
    }
    if (steps.empty()) from.fail(node, "a transform without an AffineSpace");
    if (steps[0].empty()) to.children.clear();  // placed nowhere
    for (std::size_t i = 0; i < steps[0].size(); ++i) {
      Place& place = to.places.emplace_back(Place{steps[0][i]});
      for (std::size_t step = 0; steps.size() > 1 && step < steps.size(); ++step)
        place.motion.push_back({time_of(step, steps.size()), steps[step][i]});
    }
  }

  static std::vector<glm::dmat4> affine_spaces(SceneFile& from, pugi::xml_node node) {
    std::vector<glm::dmat4> out;
    if (node.attribute("ofs")) {  // three columns of the linear part, then the translation
      const std::vector<float> m = from.floats(node, 12);
      for (std::size_t i = 0; i < m.size(); i += 12) {
        glm::dmat4& one = out.emplace_back(1);
        for (int column = 0; column < 4; ++column)
          for (int row = 0; row < 3; ++row)
            one[column][row] =
                static_cast<double>(m[i + static_cast<std::size_t>(3 * column + row)]);
      }
    }
    for (const pugi::xml_node one : node.children())
      if (one.type() == pugi::node_element) out.push_back(affine_space(from, one));
    return out;
  }

  static View camera(const SceneFile& from, pugi::xml_node node) {
    const auto vector = [&](const char* name) {
      const std::vector<double> v =
          numbers_of(node.attribute(name).value(), 3, 3, from.place(node), name);
      return glm::dvec3(v[0], v[1], v[2]);
    };
    View out;
    out.from = vector("from");
    out.to = vector("to");
    out.up = vector("up");
    out.fov = numbers_of(node.attribute("fov").value(), 1, 1, from.place(node), "fov")[0];
    return out;
  }

  MeshMaterial look(SceneFile& from, pugi::xml_node node, const std::string& name) {
    const std::string id = node.attribute("id").value();
    if (!id.empty())
      if (const auto found = looks_.find(id); found != looks_.end()) return found->second;
    if (!node) {
      if (!plain_) plain_ = add_plain_material(scene_);
      return {*plain_, {}, {}};
    }
    const MeshMaterial out =
        read_material(from, node, name.empty() ? id : name, scene_, images_, notes_);
    if (!id.empty()) looks_[id] = out;
    return out;
  }

  /// Reads another file: an Embree scene or a mesh.
  NodePtr other(SceneFile& from, pugi::xml_node node, int depth) {
    const std::string src = node.attribute("src").value();
    const SourceLocation where = from.place(node);
    if (src.empty()) from.fail(node, "names no file (src)");
    const fs::path path = from.path().parent_path() / src;
    if (!is_file(path, where)) from.fail(node, "there is no file '" + path.string() + "'");
    const Format& format = format_of(path);
    if (format.name == "embree") return file(path, where, depth);
    if (format.name != "obj" && format.name != "ply" && format.name != "stl" &&
        format.name != "off")
      from.fail(node, "'" + path.string() + "': files of the format " + format.name +
                          " are not read within a scene of Embree");
    Imported part = format.import(path, reader_, {});
    auto out = std::make_shared<Node>();
    out->where = where;
    const std::size_t before = scene_.shapes.size();
    append(scene_, std::move(part.scene));
    out->shapes.assign(
        std::make_move_iterator(scene_.shapes.begin() + static_cast<std::ptrdiff_t>(before)),
        std::make_move_iterator(scene_.shapes.end()));
    scene_.shapes.resize(before);
    return out;
  }

  void visit(const Node& node, const Place& world) {
    if (++visited_ > kMostVisited)
      throw InputError(node.where, fmt::format("more than {} elements are placed", kMostVisited));
    if ((keys_ += world.motion.size()) > kMostKeys)
      throw InputError(node.where, fmt::format("what moves has more than {} keys", kMostKeys));
    if (!node.views.empty() && views_.empty()) see(node.views, world, node.where);
    if (node.light) {
      if (!world.motion.empty()) notes_.add("lights do not move", node.where);
      lights_.emplace_back(&*node.light, world.first);
    }
    if (!node.shapes.empty()) {
      const auto [at, fresh] = placed_index_.try_emplace(&node, placed_.size());
      if (fresh) placed_.push_back({&node, {}});
      placed_[at->second].places.push_back(world);
      if (++placements_ > kMostPlaced)
        throw InputError(node.where, fmt::format("more than {} shapes are placed", kMostPlaced));
    }
    if (node.places.empty())
      for (const NodePtr& child : node.children) visit(*child, world);
    for (const Place& place : node.places) {
      if (node.children.empty()) break;
      const Place within = world * place;
      for (const NodePtr& child : node.children) visit(*child, within);
    }
  }

  /// Keeps a camera, at its own time steps or, where it has one, at the keys of its place.
  void see(const std::vector<View>& views, const Place& world, const SourceLocation& where) {
    const auto moved = [](View view, const glm::dmat4& by) {
      view.from = glm::dvec3(by * glm::dvec4(view.from, 1));
      view.to = glm::dvec3(by * glm::dvec4(view.to, 1));
      view.up = glm::dmat3(by) * view.up;
      return view;
    };
    view_at_ = where;
    views_.clear();
    if (views.size() > 1 && !world.motion.empty())
      notes_.add("a camera that moves within what moves does not go with it", where);
    if (views.size() == 1 && !world.motion.empty())
      for (const TransformKey& key : world.motion)
        views_.emplace_back(key.time, moved(views[0], key.matrix));
    else
      for (std::size_t step = 0; step < views.size(); ++step)
        views_.emplace_back(views.size() > 1 ? time_of(step, views.size()) : 0,
                            moved(views[step], world.first));
  }

  void set_camera() {
    if (views_.empty()) return;
    Camera& camera = scene_.view.camera;
    camera = camera_of(views_[0].second, scene_.view.film, view_at_);
    for (const auto& [time, view] : views_) {
      if (view.fov != views_[0].second.fov)
        notes_.add("the field of view stays as at its first moment", view_at_);
      if (views_.size() > 1)
        camera.motion.push_back(
            {time, camera_of(view, scene_.view.film, view_at_).world_from_camera});
    }
  }

  void place() {
    for (const Placed& one : placed_) {
      std::vector<Shape> shapes = one.node->shapes;
      if (one.places.size() == 1 && one.places[0].motion.empty()) {
        for (Shape& shape : shapes) {
          shape.world_from_object = one.places[0].first * shape.world_from_object;
          scene_.shapes.push_back(std::move(shape));
        }
        continue;
      }
      const auto index = narrow<std::uint32_t>(scene_.objects.size());
      Object object;
      object.name = shapes[0].name;
      object.where = one.node->where;
      object.shapes = std::move(shapes);
      for (const Place& place : one.places)
        scene_.instances.push_back({index, place.first, one.node->where, place.motion});
      scene_.objects.push_back(std::move(object));
    }
  }

  struct Placed {
    const Node* node;
    std::vector<Place> places;
  };

  const ImageReader& reader_;
  const ImportOptions& options_;
  Scene scene_;
  MeshImages images_;
  Notes notes_;
  std::map<fs::path, NodePtr> files_;  // null while a file is being read
  std::map<std::string, NodePtr> nodes_;
  std::map<std::string, MeshMaterial> looks_;
  std::optional<std::uint32_t> plain_;
  std::vector<std::pair<double, View>> views_;  // of the camera, by time
  std::vector<std::pair<const LightElement*, glm::dmat4>> lights_;
  SourceLocation view_at_;
  std::size_t visited_ = 0, placements_ = 0, keys_ = 0;
  std::vector<Placed> placed_;
  std::map<const Node*, std::size_t> placed_index_;
};

}  // namespace

}  // namespace embree

Imported import_embree(const fs::path& path, const ImageReader& images,
                       const ImportOptions& options) {
  return embree::EmbreeReader(path, images, options).read(path);
}

}  // namespace caplet
