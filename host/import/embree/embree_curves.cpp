// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's curves, points and meshes.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "import/detail/cubic_chain.h"
#include "import/detail/embree.h"
#include "scene/shapes/capsule_motion.h"
#include "scene/shapes/mesh_motion.h"

namespace caplet::embree {

namespace {

constexpr std::size_t most_moved = 100'000'000;  // capsules and triangles at all time steps

using glm::dvec4;

enum class Basis { linear, cone, bezier, bspline, hermite, catmull_rom };

struct Curves {
  Basis basis = Basis::linear;
  bool is_flat = false, is_oriented = false;
  bool in_pairs = false;  // each index is followed by the number of its hair
};

struct Element {
  const char* name;
  Curves curves;
};
constexpr Element elements[] = {{"Hair", {Basis::bezier, true, false, true}},
                                {"BezierHair", {Basis::bezier, true, false, true}},
                                {"BezierCurves", {Basis::bezier, false, false, true}},
                                {"BSplineHair", {Basis::bspline, true, false, false}},
                                {"BSplineCurves", {Basis::bspline, false, false, false}},
                                {"LineSegments", {Basis::linear, true, false, false}},
                                {"RoundLineSegments", {Basis::linear, false, false, false}},
                                {"ConeSegments", {Basis::cone, false, false, false}}};

Curves curves_of(const SceneFile& file, pugi::xml_node node) {
  const std::string_view name = node.name(), basis = node.attribute("basis").value(),
                         type = node.attribute("type").value();
  for (const Element& element : elements)
    if (name == element.name) return element.curves;
  constexpr std::pair<const char*, Basis> bases[] = {{"linear", Basis::linear},
                                                     {"bezier", Basis::bezier},
                                                     {"bspline", Basis::bspline},
                                                     {"hermite", Basis::hermite},
                                                     {"catmull_rom", Basis::catmull_rom}};
  Curves out;
  const auto* found =
      std::ranges::find(bases, basis, [](const auto& row) { return std::string_view(row.first); });
  if (found == std::end(bases))
    file.fail(node,
              fmt::format("basis=\"{}\" is none of linear, bezier, bspline, hermite, catmull_rom",
                          basis.substr(0, 40)));
  out.basis = found->second;
  out.is_flat = type == "flat" || type == "ribbon";
  out.is_oriented = type == "normal_oriented" && out.basis != Basis::linear;
  const bool is_surface = type == "surface" && out.basis != Basis::linear;
  if (!out.is_flat && !out.is_oriented && type != "round" && !is_surface)
    file.fail(node, fmt::format("type=\"{}\" is none of round, flat, normal_oriented",
                                type.substr(0, 40)));
  return out;
}

std::size_t vertices_of(Basis basis) {
  return basis == Basis::linear || basis == Basis::cone || basis == Basis::hermite ? 2 : 4;
}

/// Returns the lists of an element at its time steps; one where it rests.
std::vector<pugi::xml_node> lists_of(pugi::xml_node node, const std::string& name) {
  const pugi::xml_node animated = node.child(("animated_" + name).c_str());
  if (!animated) return {node.child(name.c_str())};
  std::vector<pugi::xml_node> out;
  for (const pugi::xml_node one : animated.children())
    if (one.type() == pugi::node_element) out.push_back(one);
  if (out.empty()) out.emplace_back();
  return out;
}

/// Returns the list at a time step, or the only one.
pugi::xml_node list_at(pugi::xml_node node, const std::string& name, std::size_t step) {
  const std::vector<pugi::xml_node> lists = lists_of(node, name);
  return lists[std::min(step, lists.size() - 1)];
}

std::vector<dvec4> rows4(SceneFile& file, pugi::xml_node node, bool with_nan) {
  const std::vector<float> numbers = file.floats(node, 4, with_nan);
  std::vector<dvec4> out;
  for (std::size_t i = 0; i < numbers.size(); i += 4)
    out.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]);
  return out;
}

template <class Vector>
std::vector<Vector> rows(SceneFile& file, pugi::xml_node node) {
  constexpr std::size_t width = sizeof(Vector) / sizeof(float);
  const std::vector<float> numbers = file.floats(node, width);
  std::vector<Vector> out;
  for (std::size_t i = 0; i < numbers.size(); i += width) {
    Vector& v = out.emplace_back();
    for (std::size_t k = 0; k < width; ++k) v[static_cast<glm::length_t>(k)] = numbers[i + k];
  }
  return out;
}

class CurveSet {
 public:
  /// `step`: of the time, from 0.
  CurveSet(SceneFile& file, pugi::xml_node node, std::size_t step, Notes& notes)
      : file_(file), node_(node), step_(step), notes_(notes) {}

  std::vector<Shape> read(const MeshMaterial& look) {
    const Curves curves = curves_of(file_, node_);
    basis_ = curves.basis;
    if (curves.is_flat) notes_.add("flat curves are drawn as round ones", file_.place(node_));
    if (curves.is_oriented)
      notes_.add("curves that are oriented by normals are drawn as round ones", file_.place(node_));
    const pugi::xml_node positions = list_at(node_, "positions", step_);
    points_ = rows4(file_, positions, basis_ == Basis::bspline);
    const std::vector<std::uint32_t> indices =
        file_.indices(node_.child("indices"), curves.in_pairs ? 2 : 1);
    if (basis_ == Basis::hermite)
      tangents_ = rows4(file_, list_at(node_, "tangents", step_), false);
    if (basis_ == Basis::hermite && tangents_.size() != points_.size())
      file_.fail(node_, fmt::format("{} tangents of {} points", tangents_.size(), points_.size()));
    const std::vector<std::uint32_t> flags = file_.bytes(node_.child("flags"));
    const std::size_t step = curves.in_pairs ? 2 : 1;
    for (std::size_t i = 0; i < indices.size(); i += step) {
      const std::size_t first = indices[i], count = vertices_of(basis_);
      if (first >= points_.size() || points_.size() - first < count)
        file_.fail(node_, fmt::format("the curve from point {} on takes {} points; there are {}",
                                      first, count, points_.size()));
      if (basis_ == Basis::cone)
        cone(first, i < flags.size() ? flags[i] : 0);
      else
        curve(first);
    }
    end_strand();
    return shapes(look);
  }

  std::vector<Shape> read_points(const MeshMaterial& look) {
    const std::string_view type = node_.attribute("type").value();
    if (type != "sphere" && type != "disc" && type != "oriented")
      file_.fail(node_,
                 fmt::format("type=\"{}\" is none of sphere, disc, oriented", type.substr(0, 40)));
    if (type != "sphere")
      notes_.add("points that are discs are drawn as balls", file_.place(node_));
    points_ = rows4(file_, list_at(node_, "positions", step_), false);
    for (const dvec4& p : points_) segment(p, p, {});
    return shapes(look);
  }

 private:
  dvec4 point(std::size_t i) const {
    const dvec4& p = points_[i];
    if (!(p.w >= 0))
      file_.fail(node_, fmt::format("the radius of point {} is {}", i,
                                    p.w < 0 ? "negative" : "no number"));
    for (int k = 0; k < 3; ++k)
      if (std::isnan(p[k])) file_.fail(node_, fmt::format("point {} is no number", i));
    return p;
  }

  /// Adds a capsule. u: at both ends, where it is part of a curve.
  void segment(const dvec4& a, const dvec4& b, const std::optional<glm::vec2>& u) {
    if (!(a.w > 0) && !(b.w > 0)) {
      if (a.w < 0 || b.w < 0) file_.fail(node_, "a radius is negative");
      notes_.add("what has no thickness is left out", file_.place(node_));
      return;
    }
    if (a.w < 0 || b.w < 0) file_.fail(node_, "a radius is negative");
    capsules_.p0.emplace_back(a);
    capsules_.p1.emplace_back(b);
    capsules_.radius0.push_back(static_cast<float>(a.w));
    capsules_.radius1.push_back(static_cast<float>(b.w));
    if (u) capsules_.u.push_back(*u);
  }

  /// Returns the Bezier control points of curve i.
  CubicTube tube(std::size_t i) const {
    if (basis_ == Basis::bezier) return {point(i), point(i + 1), point(i + 2), point(i + 3)};
    if (basis_ == Basis::hermite) {
      const dvec4 p0 = point(i), p1 = point(i + 1);
      return {p0, p0 + tangents_[i] / 3.0, p1 - tangents_[i + 1] / 3.0, p1};
    }
    const dvec4 p1 = point(i + 1), p2 = point(i + 2);
    if (basis_ == Basis::catmull_rom)
      return {p1, p1 + (p2 - point(i)) / 6.0, p2 - (point(i + 3) - p1) / 6.0, p2};
    // At an end, whose point is NaN, the curve continues straight beyond the next point.
    const auto is_end = [&](std::size_t k) {
      return std::isnan(points_[k].x) || std::isnan(points_[k].w);
    };
    const dvec4 p0 = is_end(i) ? 2.0 * p1 - p2 : point(i),
                p3 = is_end(i + 3) ? 2.0 * p2 - p1 : point(i + 3);
    return {(p0 + 4.0 * p1 + p2) / 6.0, (2.0 * p1 + p2) / 3.0, (p1 + 2.0 * p2) / 3.0,
            (p1 + 4.0 * p2 + p3) / 6.0};
  }

  /// Ends a strand: consecutive curves that are joined end to end. u runs over all of them.
  void end_strand() {
    for (std::size_t i = strand_begin_; i < capsules_.u.size(); ++i)
      capsules_.u[i] = glm::vec2(glm::dvec2(capsules_.u[i]) / static_cast<double>(strand_curves_));
    strand_begin_ = capsules_.u.size();
    strand_curves_ = 0;
  }

  void curve(std::size_t first) {
    if (first != strand_next_) end_strand();
    strand_next_ = first + (basis_ == Basis::bezier ? 3 : 1);
    const auto u0 = static_cast<double>(strand_curves_++);
    if (basis_ == Basis::linear)
      return segment(point(first), point(first + 1), glm::vec2(u0, u0 + 1));
    const CubicTube c = tube(first);
    glm::dvec3 low(c[0]), high(c[0]);
    double widest = 0;
    for (const dvec4& p : c) {
      low = glm::min(low, glm::dvec3(p));
      high = glm::max(high, glm::dvec3(p));
      widest = std::max(widest, std::abs(p.w));
    }
    CapsulesShape chords;
    CubicChain chain(chords);
    chain.start(c[0]);
    chain.add(c, std::max(2e-3 * widest, 1e-5 * glm::length(high - low)), u0, u0 + 1);
    for (std::size_t i = 0; i < chords.p0.size(); ++i)
      segment(dvec4(glm::dvec3(chords.p0[i]), chords.radius0[i]),
              dvec4(glm::dvec3(chords.p1[i]), chords.radius1[i]), chords.u[i]);
  }

  /// Adds a cone. Bits of flags mark a neighbour at the first and at the second end, which then has
  /// no cap.
  void cone(std::size_t first, std::uint32_t flags) {
    constexpr std::uint32_t left = 1, right = 2;
    const dvec4 a = point(first), b = point(first + 1);
    if (glm::vec3(a) == glm::vec3(b) || !(std::max(a.w, b.w) > 0)) {
      notes_.add("cones without length or thickness are left out", file_.place(node_));
      return;
    }
    const std::array<Cap, 2> caps{(flags & left) != 0 ? Cap::open : Cap::flat,
                                  (flags & right) != 0 ? Cap::open : Cap::flat};
    if (a.w == b.w)
      cones_.emplace_back(CylinderShape{glm::dvec3(a), glm::dvec3(b), a.w, caps});
    else
      cones_.emplace_back(ConeShape{glm::dvec3(a), glm::dvec3(b), {a.w, b.w}, caps});
  }

  std::vector<Shape> shapes(const MeshMaterial& look) {
    std::vector<Geometry> all = std::move(cones_);
    if (!capsules_.p0.empty()) {
      if (capsules_.radius0 == capsules_.radius1) capsules_.radius1.clear();
      all.emplace_back(std::move(capsules_));
    }
    std::vector<Shape> out;
    for (Geometry& geometry : all) {
      Shape& shape = out.emplace_back();
      shape.geometry = std::move(geometry);
      shape.name = node_.attribute("name").empty() ? node_.name() : node_.attribute("name").value();
      shape.material = look.material;
      shape.alpha = look.alpha;
      shape.where = file_.place(node_);
    }
    return out;
  }

  SceneFile& file_;
  pugi::xml_node node_;
  std::size_t step_;
  Notes& notes_;
  Basis basis_ = Basis::linear;
  std::vector<dvec4> points_, tangents_;
  CapsulesShape capsules_;
  std::size_t strand_begin_ = 0,
              strand_curves_ = 0;  // its first capsule, and the number of its curves so far
  std::size_t strand_next_ = 0;    // the first point of its next curve
  std::vector<Geometry> cones_;
};

/// Returns quadrilaterals, each of which Embree splits into two triangles; a grid consists of
/// quadrilaterals.
std::vector<std::array<std::uint32_t, 4>> quads_of(SceneFile& file, pugi::xml_node node,
                                                   std::size_t vertices) {
  std::vector<std::array<std::uint32_t, 4>> out;
  if (std::string_view(node.name()) == "QuadMesh") {
    const std::vector<std::uint32_t> indices = file.indices(node.child("indices"), 4);
    for (std::size_t i = 0; i < indices.size(); i += 4)
      out.push_back({indices[i], indices[i + 1], indices[i + 2], indices[i + 3]});
    return out;
  }
  // Each row holds the first vertex, the stride between rows, columns and rows.
  const std::vector<std::uint32_t> grids = file.indices(node.child("grids"), 4);
  for (std::size_t i = 0; i < grids.size(); i += 4) {
    const std::uint64_t first = grids[i], stride = grids[i + 1], columns = grids[i + 2],
                        lines = grids[i + 3];
    if (columns == 0 || lines == 0 || first >= vertices || stride > vertices ||
        columns > vertices || lines > vertices || (lines - 1) * stride + columns > vertices - first)
      file.fail(node, fmt::format("grid {} goes on beyond the {} points", i / 4, vertices));
    if (out.size() + (lines - 1) * (columns - 1) > (std::uint64_t{1} << 27))
      file.fail(node, "grids of more than 2^27 cells");
    for (std::uint64_t y = 0; y + 1 < lines; ++y)
      for (std::uint64_t x = 0; x + 1 < columns; ++x) {
        const auto at = static_cast<std::uint32_t>(first + y * stride + x),
                   below = static_cast<std::uint32_t>(at + stride);
        out.push_back({at, at + 1, below + 1, below});
      }
  }
  return out;
}

std::vector<Shape> mesh(SceneFile& file, pugi::xml_node node, const MeshMaterial& look,
                        std::size_t step) {
  TriangleMeshShape out;
  out.positions = rows<glm::vec3>(file, list_at(node, "positions", step));
  out.normals = rows<glm::vec3>(file, list_at(node, "normals", step));
  out.uvs = rows<glm::vec2>(file, node.child("texcoords"));
  const std::size_t count = out.positions.size();
  if ((!out.normals.empty() && out.normals.size() != count) ||
      (!out.uvs.empty() && out.uvs.size() != count))
    file.fail(node, "has another number of normals or texture coordinates than of points");
  if (std::string_view(node.name()) == "TriangleMesh") {
    const std::vector<std::uint32_t> indices = file.indices(node.child("triangles"), 3);
    for (std::size_t i = 0; i < indices.size(); i += 3)
      out.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  } else {
    for (const std::array<std::uint32_t, 4>& q : quads_of(file, node, count)) {
      out.triangles.push_back({q[0], q[1], q[3]});
      if (q[2] != q[3]) out.triangles.push_back({q[2], q[3], q[1]});  // else it is a triangle
    }
  }
  for (const auto& triangle : out.triangles)
    for (const std::uint32_t i : triangle)
      if (i >= count) file.fail(node, fmt::format("point {}: there are {}", i, count));
  if (out.triangles.empty()) return {};
  Shape shape = mesh_shape(
      std::move(out), node.attribute("name").empty() ? node.name() : node.attribute("name").value(),
      look.material, file.place(node));
  shape.alpha = look.alpha;
  std::vector<Shape> all;
  all.push_back(std::move(shape));
  return all;
}

/// Appends the points of one more step; returns whether all shapes can move so.
bool add_step(std::vector<Shape>& shapes, std::size_t steps, std::vector<Shape> next) {
  if (shapes.size() != next.size()) return false;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    auto *capsules = std::get_if<CapsulesShape>(&shapes[i].geometry),
         *next_capsules = std::get_if<CapsulesShape>(&next[i].geometry);
    auto *mesh = std::get_if<TriangleMeshShape>(&shapes[i].geometry),
         *next_mesh = std::get_if<TriangleMeshShape>(&next[i].geometry);
    const bool goes_on = capsules && next_capsules
                             ? add_key(*capsules, steps, std::move(*next_capsules))
                             : mesh && next_mesh && add_key(*mesh, steps, *next_mesh);
    if (!goes_on) return false;
  }
  return true;
}

std::vector<double>& times_of(Shape& shape) {
  auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
  return capsules ? capsules->times : std::get<TriangleMeshShape>(shape.geometry).times;
}

bool is_mesh(std::string_view name) {
  return name == "TriangleMesh" || name == "QuadMesh" || name == "GridMesh";
}

}  // namespace

bool is_geometry(std::string_view name) {
  return is_mesh(name) || name == "Curves" || name == "Points" ||
         std::ranges::any_of(elements,
                             [&](const Element& element) { return name == element.name; });
}

std::vector<Shape> shapes_of(SceneFile& file, pugi::xml_node node, const MeshMaterial& look,
                             Notes& notes) {
  const auto shapes_at = [&](std::size_t step) {
    const std::string_view name = node.name();
    if (is_mesh(name)) return mesh(file, node, look, step);
    CurveSet set(file, node, step, notes);
    return name == "Points" ? set.read_points(look) : set.read(look);
  };
  const std::size_t steps = lists_of(node, "positions").size();
  std::vector<Shape> out = shapes_at(0);
  if (steps < 2 || out.empty()) return out;
  std::size_t points = 0;
  for (const Shape& shape : out) points += primitive_count(shape);
  if (steps * points > most_moved)
    file.fail(node, fmt::format("{} capsules or triangles at {} time steps", points, steps));
  std::vector<Shape> moving = out;
  for (std::size_t step = 1; step < steps; ++step)
    if (!add_step(moving, step, shapes_at(step))) {
      notes.add("what moves is drawn as at its first moment", file.place(node));
      return out;
    }
  // Steps are evenly in the time that the shutter is open, a second.
  for (Shape& shape : moving)
    for (std::size_t step = 0; step < steps; ++step)
      times_of(shape).push_back(static_cast<double>(step) / static_cast<double>(steps - 1));
  return moving;
}

}  // namespace caplet::embree
