// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Beam lattices (3MF Beam Lattice Extension 1.2). A beam is the frustum between two disks across
// its axis, closed at each end by a ball, by a half ball or not at all. Balls stand at vertices.
#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>
#include <utility>

#include "import/detail/model_3mf.h"

namespace caplet::model_3mf {

namespace {

enum class Closing { sphere, hemisphere, butt };

class Lattice {
 public:
  Lattice(const Part& part, pugi::xml_node object, pugi::xml_node node,
          const std::vector<glm::vec3>& points, std::string name, Colors& colors,
          std::vector<Shape>& shapes)
      : part_(part),
        object_(object),
        node_(node),
        points_(points),
        name_(std::move(name)),
        colors_(colors),
        shapes_(shapes) {}

  void add() {
    if (const std::string mode = attribute(node_, "clippingmode").as_string("none"); mode != "none")
      Diagnostics().warning(part_.file.place(node_),
                            "the lattice is not clipped: clippingmode '" + mode + "' is not read");
    const std::optional<float> radius = part_.positive_if(node_, "radius");
    if (!radius) part_.fail(node_, "a beamlattice needs a radius");
    usual_closing_ = closing(node_, "cap", Closing::sphere);
    for (const pugi::xml_node beam : child(node_, "beams").children())
      if (is(beam, "beam")) add_beam(beam, *radius);
    add_balls();
    if (flat_ > 0)
      Diagnostics().warning(
          part_.file.place(node_),
          fmt::format("{} beams without length and without round ends are left out", flat_));
    for (auto& [alpha, capsules] : bulk_) {
      const std::uint32_t first = capsules.materials[0];
      push(std::move(capsules), glm::dmat4(1), first, alpha);
    }
  }

 private:
  Closing closing(pugi::xml_node node, std::string_view name, Closing otherwise) const {
    const pugi::xml_attribute given = attribute(node, name);
    if (!given) return otherwise;
    const std::string_view text = given.value();
    if (text == "sphere") return Closing::sphere;
    if (text == "hemisphere") return Closing::hemisphere;
    if (text != "butt")
      part_.fail(node, std::string(name) + " is '" + std::string(text) +
                           "': sphere, hemisphere and butt are read");
    return Closing::butt;
  }

  std::size_t vertex(pugi::xml_node node, std::string_view name) const {
    const std::uint32_t index = part_.whole(node, name);
    if (index >= points_.size())
      part_.fail(node, fmt::format("{} is vertex {}: there are {}", name, index, points_.size()));
    return index;
  }

  std::optional<glm::dvec4> color(pugi::xml_node node, std::string_view index) {
    std::optional<std::uint32_t> id = part_.whole_if(node, "pid");
    if (!id) id = part_.whole_if(node_, "pid");
    if (!id) id = part_.whole_if(object_, "pid");
    std::optional<std::uint32_t> which = part_.whole_if(node, index);
    if (!which) which = part_.whole_if(node_, "pindex");
    if (!which) which = part_.whole_if(object_, "pindex");
    return colors_.of(part_, id, which, node);
  }

  void add_beam(pugi::xml_node beam, float usual_radius) {
    const std::size_t v1 = vertex(beam, "v1"), v2 = vertex(beam, "v2");
    if (v1 == v2) part_.fail(beam, "a beam whose ends are the same vertex");
    const std::optional<float> r1 = part_.positive_if(beam, "r1"),
                               r2 = part_.positive_if(beam, "r2");
    if (r2 && !r1) part_.fail(beam, "r2 without r1");
    const std::array<float, 2> radius{r1.value_or(usual_radius),
                                      r2.value_or(r1.value_or(usual_radius))};
    const std::array<Closing, 2> closings{closing(beam, "cap1", usual_closing_),
                                          closing(beam, "cap2", usual_closing_)};
    const std::array<glm::vec3, 2> ends{points_[v1], points_[v2]};
    const std::optional<glm::dvec4> color =
        Colors::mean({this->color(beam, "p1"), this->color(beam, "p2")});
    used_.insert({v1, v2});
    const bool is_round = closings[0] != Closing::butt && closings[1] != Closing::butt;
    if (ends[0] == ends[1]) {
      if (is_round)
        add_ball(ends[0], std::max(radius[0], radius[1]), color);
      else
        ++flat_;
      return;
    }
    // With equal radii, a half ball shows as much as a ball, and both ends together make a capsule.
    if (radius[0] == radius[1] && is_round) return capsule(ends[0], ends[1], radius[0], color);
    const glm::dvec3 p0(ends[0]), p1(ends[1]);
    if (radius[0] == radius[1]) {
      const auto cap = [&](std::size_t i) {
        return closings.at(i) == Closing::butt ? Cap::flat : Cap::round;
      };
      return push(CylinderShape{p0, p1, static_cast<double>(radius[0]), {cap(0), cap(1)}},
                  glm::dmat4(1), color);
    }
    push(ConeShape{p0,
                   p1,
                   {static_cast<double>(radius[0]), static_cast<double>(radius[1])},
                   {Cap::flat, Cap::flat}},
         glm::dmat4(1), color);
    for (std::size_t i = 0; i < 2; ++i) {
      if (closings.at(i) == Closing::sphere) add_ball(ends.at(i), radius.at(i), color);
      if (closings.at(i) == Closing::hemisphere)
        add_half_ball(ends.at(i), ends.at(1 - i), radius.at(i), color);
    }
  }

  void add_balls() {
    const std::string mode = attribute(node_, "ballmode").as_string("none");
    if (mode != "none" && mode != "mixed" && mode != "all")
      part_.fail(node_, "ballmode is '" + mode + "': none, mixed and all are read");
    if (mode == "none") return;
    const std::optional<float> usual = part_.positive_if(node_, "ballradius");
    for (const pugi::xml_node ball : child(node_, "balls").children()) {
      if (!is(ball, "ball")) continue;
      const std::size_t at = vertex(ball, "vindex");
      std::optional<float> radius = part_.positive_if(ball, "r");
      if (!radius) radius = usual;
      if (!radius) part_.fail(ball, "a ball without a radius, in a lattice without ballradius");
      add_ball(points_[at], *radius, color(ball, "p"));
      used_.erase(at);
    }
    if (mode != "all") return;
    if (!usual) part_.fail(node_, "balls at all vertices need ballradius");
    for (const std::size_t at : used_) add_ball(points_[at], *usual, color(node_, "pindex"));
  }

  static double alpha_of(const std::optional<glm::dvec4>& color) { return color ? color->a : 1; }

  void add_ball(const glm::vec3& at, float radius, const std::optional<glm::dvec4>& color) {
    capsule(at, at, radius, color);
  }

  void capsule(const glm::vec3& p0, const glm::vec3& p1, float radius,
               const std::optional<glm::dvec4>& color) {
    CapsulesShape& capsules = bulk_[alpha_of(color)];
    capsules.p0.push_back(p0);
    capsules.p1.push_back(p1);
    capsules.radius0.push_back(radius);
    capsules.materials.push_back(colors_.material(color));
  }

  /// Adds a half ball beyond the disk at `end`, on the side away from `other`.
  void add_half_ball(const glm::vec3& end, const glm::vec3& other, float radius,
                     const std::optional<glm::dvec4>& color) {
    const glm::dvec3 z = glm::normalize(glm::dvec3(end) - glm::dvec3(other));
    const glm::dvec3 across = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(across, z)), y = glm::cross(z, x);
    const glm::dmat4 place{glm::dvec4(x, 0), glm::dvec4(y, 0), glm::dvec4(z, 0),
                           glm::dvec4(glm::dvec3(end), 1)};
    const auto r = static_cast<double>(radius);
    push(PartialSphereShape{r, 0, r, full_turn}, place, color);
  }

  void push(Geometry geometry, const glm::dmat4& place, const std::optional<glm::dvec4>& color) {
    push(std::move(geometry), place, colors_.material(color), alpha_of(color));
  }
  void push(Geometry geometry, const glm::dmat4& place, std::uint32_t material, double alpha) {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.name = name_;
    shape.where = part_.file.place(node_);
    shape.world_from_object = place;
    shape.material = material;
    if (alpha < 1) shape.alpha = TextureOperand(alpha);
    shapes_.push_back(std::move(shape));
  }

  const Part& part_;
  pugi::xml_node object_, node_;
  const std::vector<glm::vec3>& points_;
  std::string name_;
  Colors& colors_;
  std::vector<Shape>& shapes_;
  Closing usual_closing_ = Closing::sphere;
  std::map<double, CapsulesShape> bulk_;  // by alpha, which a shape has as a whole
  std::set<std::size_t> used_;            // vertices at which beams end and no ball stands yet
  std::size_t flat_ = 0;
};

}  // namespace

void add_lattice(const Part& part, pugi::xml_node object, pugi::xml_node lattice,
                 const std::vector<glm::vec3>& points, const std::string& name, Colors& colors,
                 std::vector<Shape>& shapes) {
  Lattice(part, object, lattice, points, name, colors, shapes).add();
}

}  // namespace caplet::model_3mf
