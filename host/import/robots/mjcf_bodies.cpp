// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Poses the bodies of an MJCF model: frames, replicas and attached models, joints, geoms, lights,
// cameras and tendons.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "import/detail/mjcf.h"
#include "import/detail/text_file.h"

namespace caplet::mjcf {

namespace {

/// The context of an element: its model, the default class of elements that name none, and the
/// change of names.
struct Scope {
  const Model* model = nullptr;
  const Class* childclass = nullptr;
  std::string prefix, suffix;
  int depth = 0;

  std::string name(const char* own) const { return prefix + own + suffix; }
};

/// Hands out the numbers of a pose, joint by joint in the order of the file.
class ElementValues {
 public:
  ElementValues(const Model& model, const Pose& pose) : pose_(pose) {
    if (!pose.keyframe) return;
    std::string known;
    for (const pugi::xml_node section : model.sections("keyframe"))
      model.each(section, [&](pugi::xml_node key) {
        const std::string name = key.attribute("name").value();
        known += (known.empty() ? "" : ", ") + name;
        if (name != *pose.keyframe || given_) return;
        given_ = true;
        where_ = model.place(key);
        constexpr std::size_t many = 1'000'000;
        if (key.attribute("qpos"))
          qpos_ = numbers_of(key.attribute("qpos").value(), 0, many, where_, "qpos");
        if (key.attribute("mpos"))
          mpos_ = numbers_of(key.attribute("mpos").value(), 0, many, where_, "mpos");
        if (key.attribute("mquat"))
          mquat_ = numbers_of(key.attribute("mquat").value(), 0, many, where_, "mquat");
      });
    if (!given_)
      throw InputError({"--pose"}, fmt::format("the file has no keyframe {}{}",
                                               quoted(std::string_view(*pose.keyframe)),
                                               known.empty() ? "" : " (it has: " + known + ")"));
  }

  /// Returns the position of a joint, of `otherwise.size()` numbers.
  std::vector<double> joint(const std::string& name, std::vector<double> otherwise) {
    const std::size_t count = otherwise.size(), begin = at_;
    at_ += count;
    if (qpos_ && at_ <= qpos_->size())
      otherwise.assign(qpos_->begin() + static_cast<std::ptrdiff_t>(begin),
                       qpos_->begin() + static_cast<std::ptrdiff_t>(at_));
    const auto own = pose_.joints.find(name);
    if (own == pose_.joints.end()) return otherwise;
    moved_.insert(name);
    if (own->second.size() != count)
      throw InputError({"--pose"},
                       fmt::format("{}: {} numbers, not {}", name, count, own->second.size()));
    return own->second;
  }
  void mocap(glm::dvec3& position, glm::dquat& rotation) {
    const std::size_t i = mocaps_++;
    if (mpos_.size() >= 3 * (i + 1)) position = {mpos_[3 * i], mpos_[3 * i + 1], mpos_[3 * i + 2]};
    if (mquat_.size() >= 4 * (i + 1))
      rotation = turn({mquat_[4 * i], mquat_[4 * i + 1], mquat_[4 * i + 2], mquat_[4 * i + 3]});
  }
  /// Throws InputError when the pose does not fit the model.
  void finish() const {
    if (qpos_ && qpos_->size() != at_)
      throw InputError(where_,
                       fmt::format("qpos: {} numbers, but the joints take {}", qpos_->size(), at_));
    for (const auto& [name, values] : pose_.joints)
      if (!moved_.contains(name))
        throw InputError({"--pose"}, "the file has no joint '" + name + "'");
  }
  /// Normalises a quaternion; zero becomes the identity, as in MuJoCo.
  static glm::dquat turn(const std::array<double, 4>& q) {
    const glm::dquat out(q[0], q[1], q[2], q[3]);
    const double length = glm::length(out);
    return length > 1e-14 ? out / length : glm::dquat(1, 0, 0, 0);
  }

 private:
  const Pose& pose_;
  bool given_ = false;
  SourceLocation where_;
  std::optional<std::vector<double>> qpos_;
  std::vector<double> mpos_, mquat_;
  std::size_t at_ = 0, mocaps_ = 0;
  std::set<std::string> moved_;
};

class BodiesReader {
 public:
  BodiesReader(const Model& model, const Pose& pose, Robot& robot, Assets& assets)
      : model_(model), values_(model, pose), robot_(robot), assets_(assets) {}

  void read() {
    const Scope scope{&model_, model_.root_class(), {}, {}, 0};
    const std::vector<pugi::xml_node> worlds = model_.sections("worldbody");
    bodies_["world"] = glm::dmat4(1);
    contents(worlds, scope, glm::dmat4(1));
    values_.finish();
    if (robot_.geoms.empty())
      throw InputError(model_.place(worlds.empty() ? model_.root() : worlds[0]), "holds no geoms");
    for (const auto& [light, target] : aimed_)
      aim(robot_.lights[light].direction, robot_.lights[light].position, target);
    for (const auto& [camera, target] : watching_) look(robot_.cameras[camera].world, target);
    tendons(scope);
    for (const Scope& other : attached_) tendons(other);
    skins(scope);
    for (const Scope& other : attached_) skins(other);
  }

 private:
  // --- The content of a body, with frames, replicas and attached models resolved ---

  void count(const Scope& scope, pugi::xml_node node) {
    if (scope.depth > most_nested)
      scope.model->fail(node, fmt::format("elements are nested more than {} deep", most_nested));
    if (++elements_ > most_elements)
      scope.model->fail(
          node,
          fmt::format("the model has more than {} elements, replicas among them", most_elements));
  }

  template <class Use>
  void each(const Model& model, pugi::xml_node of, Scope scope, const glm::dmat4& frame,
            Use&& use) {
    ++scope.depth;
    model.each(of, [&](pugi::xml_node child) { one(child, scope, frame, use); });
  }

  template <class Use>
  void one(pugi::xml_node node, const Scope& scope, const glm::dmat4& frame, Use& use) {
    count(scope, node);
    const Model& model = *scope.model;
    const std::string_view kind = node.name();
    if (kind == "frame") {
      check_attributes(model, node);
      Scope inner = scope;
      inner.childclass = model.class_of(node, "childclass", scope.childclass);
      each(model, node, inner, frame * Element(model, node, "frame", nullptr).pose(), use);
    } else if (kind == "replicate") {
      replicate(node, scope, frame, use);
    } else if (kind == "attach") {
      attach(node, scope, frame, use);
    } else {
      use(node, scope, frame);
    }
  }

  template <class Use>
  void replicate(pugi::xml_node node, const Scope& scope, glm::dmat4 frame, Use& use) {
    const Model& model = *scope.model;
    check_attributes(model, node);
    const Element element(model, node, "replicate", nullptr);
    const double asked = element.number("count", -1);
    if (!(asked >= 0) || asked != std::floor(asked) || asked > static_cast<double>(most_elements))
      element.fail(fmt::format("count: a whole number from 0 to {} is needed", most_elements));
    const std::size_t count = static_cast<std::size_t>(asked);
    const std::size_t digits = std::to_string(count).size();
    // Copy i is rotated i times; its offset from the one before is rotated likewise.
    const std::vector<double> euler = element.numbers("euler", 3, {0, 0, 0});
    const glm::dvec3 offset = element.vector("offset", {0, 0, 0});
    Scope inner = scope;
    inner.childclass = model.class_of(node, "childclass", scope.childclass);
    const double scale = model.compiler().degrees ? glm::radians(1.0) : 1;
    glm::dvec3 at(0);
    for (std::size_t i = 0; i < count; ++i) {
      glm::dquat turn(1, 0, 0, 0);
      for (std::size_t k = 0; k < 3; ++k) {
        const char letter = model.compiler().euler[k];
        const bool moves = letter >= 'a';
        glm::dvec3 axis(0);
        axis[moves ? letter - 'x' : letter - 'X'] = 1;
        const glm::dquat one = glm::angleAxis(static_cast<double>(i) * euler[k] * scale, axis);
        turn = moves ? turn * one : one * turn;
      }
      std::string number = std::to_string(i);
      number.insert(0, digits - number.size(), '0');
      inner.suffix = element.text("sep") + number + scope.suffix;
      this->count(scope, node);
      each(model, node, inner, frame * placed(at, turn), use);
      at += turn * offset;
    }
  }

  template <class Use>
  void attach(pugi::xml_node node, const Scope& scope, const glm::dmat4& frame, Use& use) {
    check_attributes(*scope.model, node);
    const Element element(*scope.model, node, "attach", nullptr);
    const Model& other = scope.model->attached(element.text("model"), element.where());
    Scope inner{&other, other.root_class(), scope.prefix + element.text("prefix"), scope.suffix,
                scope.depth + 1};
    if (used_.insert({node.internal_object(), inner.suffix}).second) attached_.push_back(inner);
    const std::vector<pugi::xml_node> worlds = other.sections("worldbody");
    const std::string body = element.text("body"), named = element.text("frame");
    if (body.empty() && named.empty()) {
      for (const pugi::xml_node world : worlds) each(other, world, inner, frame, use);
      return;
    }
    for (const pugi::xml_node world : worlds)
      if (const pugi::xml_node found = find(other, world, body.empty() ? "frame" : "body",
                                            body.empty() ? named : body, inner, 0))
        return one(found, inner, frame, use);
    element.fail(fmt::format("its model has no {} {}", body.empty() ? "frame" : "body",
                             quoted(std::string_view(body.empty() ? named : body))));
  }

  /// Returns the element of this name in `of`; `scope` receives its default class.
  static pugi::xml_node find(const Model& model, pugi::xml_node of, std::string_view kind,
                             const std::string& name, Scope& scope, int depth) {
    if (depth > most_nested)
      model.fail(of, fmt::format("elements are nested more than {} deep", most_nested));
    pugi::xml_node found;
    const Class* outer = model.class_of(of, "childclass", scope.childclass);
    model.each(of, [&](pugi::xml_node child) {
      const std::string_view is = child.name();
      if (found || (is != "body" && is != "frame")) return;
      if (is == kind && child.attribute("name").value() == name) {
        found = child;
        scope.childclass = outer;
        return;
      }
      Scope inner = scope;
      inner.childclass = outer;
      if ((found = find(model, child, kind, name, inner, depth + 1)))
        scope.childclass = inner.childclass;
    });
    return found;
  }

  // --- Bodies ---

  /// A body's own content comes first, then the bodies in it: this is MuJoCo's order.
  void contents(const std::vector<pugi::xml_node>& nodes, const Scope& scope,
                const glm::dmat4& world) {
    const auto things = [&](pugi::xml_node child, const Scope& at, const glm::dmat4& frame) {
      thing(child, at, world * frame);
    };
    const auto inner = [&](pugi::xml_node child, const Scope& at, const glm::dmat4& frame) {
      if (std::string_view(child.name()) == "body") body(child, at, world * frame);
    };
    for (const pugi::xml_node node : nodes) each(*scope.model, node, scope, glm::dmat4(1), things);
    for (const pugi::xml_node node : nodes) each(*scope.model, node, scope, glm::dmat4(1), inner);
  }

  void body(pugi::xml_node node, const Scope& outer, const glm::dmat4& parent) {
    check_attributes(*outer.model, node);
    Scope scope = outer;
    scope.childclass = scope.model->class_of(node, "childclass", scope.childclass);
    const Element element(*scope.model, node, "body", nullptr);
    glm::dmat4 world = parent * element.pose();
    if (element.yes("mocap", false)) {
      glm::dvec3 position(world[3]);
      glm::dquat rotation = glm::quat_cast(glm::dmat3(world));
      values_.mocap(position, rotation);
      world = placed(position, rotation);
    }
    each(*scope.model, node, scope, glm::dmat4(1),
         [&](pugi::xml_node child, const Scope& at, const glm::dmat4& frame) {
           const std::string_view kind = child.name();
           if (kind == "freejoint" || kind == "joint") joint(child, at, frame, world);
         });
    bodies_.try_emplace(scope.name(node.attribute("name").value()), world);
    contents({node}, scope, world);
  }

  void joint(pugi::xml_node node, const Scope& scope, const glm::dmat4& frame, glm::dmat4& world) {
    const std::string name = scope.name(node.attribute("name").value());
    const bool is_free = std::string_view(node.name()) == "freejoint";
    const Element element = scope.model->element(node, "joint", scope.childclass);
    const std::size_t kind =
        is_free ? 0 : element.choice("type", {"free", "ball", "slide", "hinge"}, 3);
    if (kind == 0) {
      const glm::dquat q = glm::quat_cast(glm::dmat3(world));
      const std::vector<double> v =
          values_.joint(name, {world[3].x, world[3].y, world[3].z, q.w, q.x, q.y, q.z});
      world = placed({v[0], v[1], v[2]}, ElementValues::turn({v[3], v[4], v[5], v[6]}));
      return;
    }
    const glm::dvec3 at(frame * glm::dvec4(element.vector("pos", {0, 0, 0}), 1));
    if (kind == 1) {
      const std::vector<double> v = values_.joint(name, {1, 0, 0, 0});
      world = world * placed(at, ElementValues::turn({v[0], v[1], v[2], v[3]})) *
              glm::translate(glm::dmat4(1), -at);
      return;
    }
    glm::dvec3 axis = glm::dmat3(frame) * element.vector("axis", {0, 0, 1});
    if (!(glm::length(axis) > 1e-14)) element.fail("its axis has no length");
    axis = glm::normalize(axis);
    const double reference = kind == 2 ? element.number("ref", 0) : element.angle("ref", 0);
    const double moved = values_.joint(name, {reference})[0] - reference;
    if (moved == 0) return;
    if (kind == 2)
      world = glm::translate(world, moved * axis);
    else
      world = world * placed(at, glm::angleAxis(moved, axis)) * glm::translate(glm::dmat4(1), -at);
  }

  /// Reads a geom, a light, a camera or a site.
  void thing(pugi::xml_node node, const Scope& scope, const glm::dmat4& world) {
    const std::string_view kind = node.name();
    if (kind == "geom") return geom(node, scope, world);
    if (kind == "light") return light(node, scope, world);
    if (kind == "camera") return camera(node, scope, world);
    if (kind == "site") {
      const Element element = scope.model->element(node, "site", scope.childclass);
      const glm::dvec3 at =
          element.has("fromto") ? middle(element) : element.vector("pos", {0, 0, 0});
      if (node.attribute("name"))
        sites_[scope.name(node.attribute("name").value())] = glm::dvec3(world * glm::dvec4(at, 1));
      return;
    }
    if (kind == "composite" || kind == "flexcomp")
      return Diagnostics().warning(scope.model->place(node),
                                   fmt::format("<{}> is left out: it is not read", kind));
    if (kind != "body" && kind != "joint" && kind != "freejoint" && kind != "inertial" &&
        kind != "plugin")
      scope.model->fail(node, "a body has no " + quoted(kind));
  }

  static glm::dvec3 middle(const Element& element) {
    const std::vector<double> v = element.numbers("fromto", 6, std::vector<double>(6));
    return {(v[0] + v[3]) / 2, (v[1] + v[4]) / 2, (v[2] + v[5]) / 2};
  }

  /// Fits a solid to a mesh; returns false if it is left out.
  bool fit(const Element& element, const Model& model, const std::string& mesh, bool is_none,
           RobotGeom& geom) {
    if (is_none) {
      Diagnostics().warning(geom.where,
                            "the geom is left out: of its type none is fitted to a mesh");
      return false;
    }
    geom.fit = Assets::fit(model, mesh, geom.where);
    if (!geom.fit) {
      Diagnostics().warning(
          geom.where,
          "the geom is left out: solids that are fitted to the hull of a mesh are not read");
      return false;
    }
    geom.fit->scale = element.number("fitscale", 1);
    if (!(geom.fit->scale > 0)) element.fail("fitscale: a positive number is needed");
    assets_.mesh(model, mesh, geom);
    return true;
  }

  void geom(pugi::xml_node node, const Scope& scope, const glm::dmat4& world) {
    check_attributes(*scope.model, node);
    const Element element = scope.model->element(node, "geom", scope.childclass);
    if (robot_.geoms.size() >= most_geoms)
      element.fail(fmt::format("the model has more than {} geoms", most_geoms));
    RobotGeom geom;
    geom.where = element.where();
    geom.name = node.attribute("name") ? scope.name(node.attribute("name").value())
                                       : fmt::format("geom {}", geoms_);
    ++geoms_;
    geom.group = static_cast<int>(std::clamp(element.number("group", 0), -1.0, 6.0));
    geom.collides = element.number("contype", 1) != 0 || element.number("conaffinity", 1) != 0;
    if (element.has("rgba")) {
      const std::vector<double> c = element.numbers("rgba", 4, {0.5, 0.5, 0.5, 1});
      if (c != std::vector<double>{0.5, 0.5, 0.5, 1}) geom.rgba = {c[0], c[1], c[2], c[3]};
    }
    std::string material = element.text("material");
    enum Types : std::size_t {
      plane,
      hfield,
      sphere,
      capsule,
      ellipsoid,
      cylinder,
      box,
      mesh,
      sdf
    };
    const std::size_t type = element.choice(
        "type",
        {"plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"},
        sphere);
    const std::string mesh_name = element.text("mesh");
    const std::vector<double> size = element.numbers("size", 0, {0, 0, 0});
    geom.size = {size[0], size[1], size[2]};
    geom.world = world * element.pose();
    if (element.has("fromto")) {
      if (type != capsule && type != cylinder && type != ellipsoid && type != box)
        element.fail("fromto: only capsules, cylinders, ellipsoids and boxes have it");
      const std::vector<double> v = element.numbers("fromto", 6, std::vector<double>(6));
      const glm::dvec3 along(v[0] - v[3], v[1] - v[4], v[2] - v[5]);
      if (!(glm::length(along) > 1e-14)) element.fail("fromto: its ends are the same");
      geom.size = {size[0], glm::length(along) / 2, 0};
      if (type == ellipsoid || type == box) geom.size = {size[0], size[0], geom.size.y};
      geom.world = world * placed(middle(element), from_z(along));
    }
    const bool is_fitted = !mesh_name.empty() && type != mesh;
    if (is_fitted && !fit(element, *scope.model, mesh_name,
                          type == plane || type == hfield || type == sdf, geom))
      return;
    const auto positive = [&](int count) {
      for (int k = 0; k < count; ++k)
        if (!is_fitted && !(geom.size[k] > 0))
          element.fail(fmt::format("size: {} positive numbers are needed", count));
    };
    switch (type) {
      case plane:
        geom.kind = GeomKind::plane;
        break;
      case sphere:
        positive(1);
        geom.kind = GeomKind::sphere;
        break;
      case capsule:
      case cylinder:
        positive(2);
        geom.kind = type == capsule ? GeomKind::capsule : GeomKind::cylinder;
        break;
      case ellipsoid:
      case box:
        positive(3);
        geom.kind = type == box ? GeomKind::box : GeomKind::ellipsoid;
        break;
      case mesh:
        geom.kind = GeomKind::mesh;
        if (mesh_name.empty()) element.fail("a geom of type mesh names a mesh");
        assets_.mesh(*scope.model, mesh_name, geom);
        if (material.empty()) material = Assets::mesh_material(*scope.model, mesh_name, geom.where);
        break;
      case hfield:
        geom.kind = GeomKind::mesh;
        assets_.height_field(*scope.model, element.text("hfield"), geom);
        break;
      default:
        Diagnostics().warning(geom.where,
                              "the geom is left out: signed distance fields are not read");
        return;
    }
    if (!material.empty()) geom.material = assets_.material(*scope.model, material, geom.where);
    named_[geom.name] = robot_.geoms.size();
    robot_.geoms.push_back(std::move(geom));
  }

  // --- Lights and cameras ---

  void light(pugi::xml_node node, const Scope& scope, const glm::dmat4& world) {
    check_attributes(*scope.model, node);
    const Element element = scope.model->element(node, "light", scope.childclass);
    if (!element.yes("active", true)) return;
    RobotLight out;
    out.where = element.where();
    out.position = glm::dvec3(world * glm::dvec4(element.vector("pos", {0, 0, 0}), 1));
    out.direction = glm::dmat3(world) * element.vector("dir", {0, 0, -1});
    if (!(glm::length(out.direction) > 1e-14)) element.fail("dir has no length");
    out.direction = glm::normalize(out.direction);
    out.ambient = element.vector("ambient", {0, 0, 0});
    out.diffuse = element.vector("diffuse", {0.7, 0.7, 0.7});
    out.cutoff = element.number("cutoff", 45);
    out.exponent = element.number("exponent", 10);
    const std::size_t type = element.choice("type", {"spot", "directional", "point", "image"},
                                            element.yes("directional", false) ? 1 : 0);
    if (type == 3)
      return Diagnostics().warning(out.where,
                                   "the light is left out: lights of images are not read");
    out.kind = type == 1                       ? RobotLight::Kind::distant
               : type == 2 || out.cutoff >= 90 ? RobotLight::Kind::point
                                               : RobotLight::Kind::spot;
    const std::size_t mode =
        element.choice("mode", {"fixed", "track", "trackcom", "targetbody", "targetbodycom"}, 0);
    if (mode >= 3)
      aimed_.emplace_back(robot_.lights.size(), scope.name(element.text("target").c_str()));
    robot_.lights.push_back(out);
  }

  void camera(pugi::xml_node node, const Scope& scope, const glm::dmat4& world) {
    check_attributes(*scope.model, node);
    const Element element = scope.model->element(node, "camera", scope.childclass);
    RobotCamera out;
    out.name = scope.name(node.attribute("name").value());
    out.world = world * element.pose();
    out.fovy = element.number("fovy", 45);
    out.orthographic =
        element.text("projection") == "orthographic" || element.yes("orthographic", false);
    if (!(out.fovy > 0) || (!out.orthographic && !(out.fovy < 180)))
      element.fail("fovy: an angle from 0 to 180 degrees is needed");
    const std::size_t mode =
        element.choice("mode", {"fixed", "track", "trackcom", "targetbody", "targetbodycom"}, 0);
    if (mode >= 3)
      watching_.emplace_back(robot_.cameras.size(), scope.name(element.text("target").c_str()));
    robot_.cameras.push_back(std::move(out));
  }

  void aim(glm::dvec3& direction, const glm::dvec3& from, const std::string& target) const {
    const auto body = bodies_.find(target);
    if (body == bodies_.end()) return;
    const glm::dvec3 way = glm::dvec3(body->second[3]) - from;
    if (glm::length(way) > 1e-9) direction = glm::normalize(way);
  }
  void look(glm::dmat4& world, const std::string& target) const {
    glm::dvec3 forward = -glm::dvec3(world[2]);
    aim(forward, glm::dvec3(world[3]), target);
    const glm::dvec3 right = glm::cross(forward, glm::dvec3(0, 0, 1));
    if (!(glm::length(right) > 1e-9)) return;
    const glm::dvec3 x = glm::normalize(right);
    world = glm::dmat4({x, 0}, {glm::cross(x, forward), 0}, {-forward, 0}, world[3]);
  }

  // --- Skins and tendons ---

  void skins(const Scope& scope) {
    const Model& model = *scope.model;
    const auto draw = [&](pugi::xml_node node) {
      if (std::string_view(node.name()) == "flex")
        Diagnostics().warning(model.place(node), "<flex> is left out: it is not read");
      if (std::string_view(node.name()) != "skin") return;
      const auto body = [&](const std::string& name) -> const glm::dmat4* {
        const auto found = bodies_.find(scope.name(name.c_str()));
        return found == bodies_.end() ? nullptr : &found->second;
      };
      read_skin(model, node, body, &model == &model_, robot_, assets_);
    };
    for (const char* section : {"asset", "deformable"})
      for (const pugi::xml_node of : model.sections(section)) model.each(of, draw);
  }

  /// Draws tendons that run straight from site to site as capsules.
  void tendons(const Scope& scope) {
    const Model& model = *scope.model;
    for (const pugi::xml_node section : model.sections("tendon"))
      model.each(section, [&](pugi::xml_node node) {
        if (std::string_view(node.name()) != "spatial") return;
        const Element element = model.element(node, "tendon", model.root_class());
        std::vector<glm::dvec3> points;
        bool wraps = false;
        const auto draw = [&] {
          for (std::size_t i = 1; i < points.size(); ++i)
            segment(element, scope, points[i - 1], points[i]);
          points.clear();
        };
        model.each(node, [&](pugi::xml_node part) {
          const std::string_view kind = part.name();
          if (kind == "geom") wraps = true;
          if (kind == "pulley") draw();
          if (kind != "site") return;
          const std::string name = scope.name(part.attribute("site").value());
          const auto site = sites_.find(name);
          if (site == sites_.end()) {
            // If a model is attached in part, its other sites do not exist.
            if (&model == &model_)
              model.fail(part, "there is no site " + quoted(std::string_view(name)));
            return;
          }
          points.push_back(site->second);
        });
        if (wraps)
          Diagnostics().warning(
              element.where(),
              "the tendon is left out: tendons that wrap around geoms are not read");
        else
          draw();
      });
  }

  void segment(const Element& element, const Scope& scope, const glm::dvec3& a,
               const glm::dvec3& b) {
    if (!(glm::length(b - a) > 1e-14)) return;
    RobotGeom geom;
    geom.where = element.where();
    geom.name = scope.name(element.node().attribute("name").value());
    geom.kind = GeomKind::capsule;
    geom.size = {element.number("width", 0.003), glm::length(b - a) / 2, 0};
    if (!(geom.size.x > 0)) return;
    geom.group = static_cast<int>(std::clamp(element.number("group", 0), -1.0, 6.0));
    geom.world = placed((a + b) / 2.0, from_z(b - a));
    const std::vector<double> c = element.numbers("rgba", 4, {0.5, 0.5, 0.5, 1});
    if (element.has("rgba")) geom.rgba = {c[0], c[1], c[2], c[3]};
    if (element.has("material"))
      geom.material = assets_.material(*scope.model, element.text("material"), geom.where);
    robot_.geoms.push_back(std::move(geom));
  }

  const Model& model_;
  ElementValues values_;
  Robot& robot_;
  Assets& assets_;
  std::size_t elements_ = 0, geoms_ = 0;
  std::map<std::string, glm::dmat4> bodies_;
  std::map<std::string, glm::dvec3> sites_;
  std::map<std::string, std::size_t> named_;
  std::set<std::pair<const void*, std::string>> used_;
  std::vector<Scope> attached_;
  std::vector<std::pair<std::size_t, std::string>> aimed_, watching_;
};

}  // namespace

void read_bodies(const Model& model, const Pose& pose, Robot& robot, Assets& assets) {
  BodiesReader(model, pose, robot, assets).read();
}

}  // namespace caplet::mjcf
