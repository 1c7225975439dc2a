// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// URDF: links, the tree of their joints, visual and collision geometry (wiki.ros.org/urdf/XML). rpy
// rotates about the fixed x, then y, then z.
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "base/reading.h"
#include "import/detail/robot.h"

namespace caplet {

namespace {

class UrdfReader {
 public:
  UrdfReader(const std::filesystem::path& path, const Pose& pose) : file_(path), pose_(pose) {}

  Robot read() {
    const pugi::xml_node root = file_.root();
    if (std::string_view(root.name()) != "robot") fail(root, "the root element is not <robot>");
    for (const pugi::xml_node material : root.children("material"))
      if (material.child("color"))
        colors_[material.attribute("name").value()] = color(material.child("color"));
    std::map<std::string, pugi::xml_node> links;
    for (const pugi::xml_node link : root.children("link"))
      if (!links.emplace(link.attribute("name").value(), link).second)
        fail(link, "a link of this name was there before");
    if (links.empty()) fail(root, "holds no links");
    std::multimap<std::string, pugi::xml_node> joints;
    std::set<std::string> children;
    for (const pugi::xml_node joint : root.children("joint")) {
      const std::string parent = joint.child("parent").attribute("link").value();
      const std::string child = joint.child("child").attribute("link").value();
      if (!links.contains(parent))
        fail(joint, "its parent link '" + parent + "' is none of the file");
      if (!links.contains(child)) fail(joint, "its child link '" + child + "' is none of the file");
      if (!children.insert(child).second)
        fail(joint, "the link '" + child + "' has another parent");
      joints.emplace(parent, joint);
      joints_.emplace(joint.attribute("name").value(), joint);
    }
    if (pose_.keyframe)
      throw InputError({"--pose"}, "'" + *pose_.keyframe +
                                       "' is not JOINT=VALUE, and the file has no keyframes");
    for (const auto& [name, values] : pose_.joints)
      if (values.size() != 1)
        throw InputError({"--pose"}, name + ": one number is needed");
      else if (!joints_.contains(name))
        throw InputError({"--pose"}, "the file has no joint '" + name + "'");
    std::vector<std::pair<std::string, glm::dmat4>> open;
    for (const auto& [name, link] : links)
      if (!children.contains(name)) open.emplace_back(name, glm::dmat4(1));
    std::size_t placed = 0;
    while (!open.empty()) {
      const auto [name, world] = open.back();
      open.pop_back();
      ++placed;
      add_link(links.at(name), world);
      for (auto [at, end] = joints.equal_range(name); at != end; ++at)
        open.emplace_back(at->second.child("child").attribute("link").value(),
                          world * joint_pose(at->second));
    }
    if (placed != links.size()) fail(root, "the joints make a cycle");
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(file_.place(node), message);
  }
  std::vector<double> numbers(pugi::xml_node node, const char* name, std::size_t count) const {
    return numbers_of(node.attribute(name).value(), count, count, file_.place(node), name);
  }
  glm::dvec3 vector(pugi::xml_node node, const char* name, glm::dvec3 otherwise) const {
    if (!node.attribute(name)) return otherwise;
    const std::vector<double> v = numbers(node, name, 3);
    return {v[0], v[1], v[2]};
  }
  double length(pugi::xml_node node, const char* name) const {
    const double value = numbers(node, name, 1)[0];
    if (!(value > 0)) fail(node, std::string(name) + " is not positive");
    return value;
  }
  glm::dvec4 color(pugi::xml_node node) const {
    const std::vector<double> v = numbers(node, "rgba", 4);
    return {v[0], v[1], v[2], v[3]};
  }
  glm::dmat4 origin(pugi::xml_node of) const {
    const pugi::xml_node node = of.child("origin");
    const glm::dvec3 xyz = vector(node, "xyz", {0, 0, 0}), rpy = vector(node, "rpy", {0, 0, 0});
    glm::dmat4 out = glm::translate(glm::dmat4(1), xyz);
    out = glm::rotate(out, rpy.z, {0.0, 0.0, 1.0});
    out = glm::rotate(out, rpy.y, {0.0, 1.0, 0.0});
    return glm::rotate(out, rpy.x, {1.0, 0.0, 0.0});
  }
  /// Returns a joint's position in the pose, or that of the joint it mimics; 0 by default.
  /// `followers`: joints that mimic it.
  double joint_value(pugi::xml_node joint, std::size_t followers = 0) const {
    const auto own = pose_.joints.find(joint.attribute("name").value());
    if (own != pose_.joints.end()) return own->second[0];
    const pugi::xml_node mimic = joint.child("mimic");
    if (!mimic) return 0;
    const auto other = joints_.find(mimic.attribute("joint").value());
    if (other == joints_.end())
      fail(mimic, "it follows '" + std::string(mimic.attribute("joint").value()) +
                      "', no joint of the file");
    if (followers == joints_.size()) fail(mimic, "joints follow each other in a circle");
    const auto number = [&](const char* name, double otherwise) {
      return mimic.attribute(name) ? numbers(mimic, name, 1)[0] : otherwise;
    };
    return number("multiplier", 1) * joint_value(other->second, followers + 1) +
           number("offset", 0);
  }
  glm::dmat4 joint_pose(pugi::xml_node joint) const {
    const glm::dmat4 at = origin(joint);
    const double value = joint_value(joint);
    if (value == 0) return at;
    const std::string_view type = joint.attribute("type").value();
    const glm::dvec3 axis = vector(joint.child("axis"), "xyz", {1, 0, 0});
    if (!(glm::length(axis) > 0)) fail(joint, "its axis has no length");
    if (type == "revolute" || type == "continuous")
      return glm::rotate(at, value, glm::normalize(axis));
    if (type == "prismatic") return glm::translate(at, value * glm::normalize(axis));
    const std::string message =
        "a joint of type '" + std::string(type) + "' is not moved by one number";
    const std::string name = joint.attribute("name").value();
    if (pose_.joints.contains(name)) throw InputError({"--pose"}, name + ": " + message);
    fail(joint, message);
  }

  void add_link(pugi::xml_node link, const glm::dmat4& world) {
    for (const pugi::xml_node part : link.children()) {
      const bool collides = std::string_view(part.name()) == "collision";
      if (!collides && std::string_view(part.name()) != "visual") continue;
      RobotGeom geom;
      geom.where = file_.place(part);
      geom.name = link.attribute("name").value();
      geom.collides = collides;
      geom.world = world * origin(part);
      const pugi::xml_node material = part.child("material");
      if (material.child("color")) {
        geom.rgba = color(material.child("color"));
      } else if (material) {
        const auto known = colors_.find(material.attribute("name").value());
        if (known != colors_.end()) geom.rgba = known->second;
      }
      const pugi::xml_node geometry = part.child("geometry").first_child();
      const std::string_view kind = geometry.name();
      if (kind == "sphere") {
        geom.kind = GeomKind::sphere;
        // A sphere of radius 0 marks a point and is not drawn.
        if (numbers(geometry, "radius", 1)[0] == 0) {
          Diagnostics().warning(geom.where, "a sphere of radius 0 is left out");
          continue;
        }
        geom.size.x = length(geometry, "radius");
      } else if (kind == "cylinder" || kind == "capsule") {
        geom.kind = kind == "capsule" ? GeomKind::capsule : GeomKind::cylinder;
        geom.size = {length(geometry, "radius"), length(geometry, "length") / 2, 0};
      } else if (kind == "box") {
        geom.kind = GeomKind::box;
        geom.size = vector(geometry, "size", {0, 0, 0}) / 2.0;
      } else if (kind == "mesh") {
        geom.kind = GeomKind::mesh;
        geom.geom_from_mesh = glm::scale(glm::dmat4(1), vector(geometry, "scale", {1, 1, 1}));
        geom.mesh = mesh_path(geometry);
        geom.has_mesh_looks = !collides;
      } else {
        fail(part, "its geometry is none of: sphere, cylinder, capsule, box, mesh");
      }
      out_.geoms.push_back(std::move(geom));
    }
  }

  /// Resolves package://NAME/REST: REST or NAME/REST beside the file or in a folder above it.
  std::filesystem::path mesh_path(pugi::xml_node node) const {
    std::string name = node.attribute("filename").value();
    if (name.empty()) fail(node, "a mesh without filename");
    const std::filesystem::path folder = file_.path().parent_path();
    if (name.starts_with("file://")) return name.substr(7);
    if (!name.starts_with("package://")) return folder / name;
    name.erase(0, 10);
    const std::size_t slash = name.find('/');
    const std::string rest = slash == std::string::npos ? name : name.substr(slash + 1);
    std::filesystem::path at = folder;
    for (int up = 0; up < 5; ++up, at /= "..")
      for (const std::string& tried : {rest, name})
        if (may_read(at / tried) && is_file(at / tried, file_.place(node))) return at / tried;
    return folder / rest;
  }

  XmlFile file_;
  const Pose& pose_;
  Robot out_;
  std::map<std::string, glm::dvec4> colors_;
  std::map<std::string, pugi::xml_node> joints_;
};

}  // namespace

Robot read_urdf(const std::filesystem::path& path, const Pose& pose) {
  return UrdfReader(path, pose).read();
}

}  // namespace caplet
