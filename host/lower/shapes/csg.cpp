// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lowers csg shapes: operands, flattened, and the expression over them. Layout:
// kernels/shapes/csg.cl.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/check.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/floats.h"
#include "lower/detail/shapes.h"
#include "lower/motion.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;
using glm::dvec3;

constexpr double eps = 0x1p-24;
constexpr std::size_t lanes_per_group = 4;

/// Place is where a solid is in the csg's space.
struct Place {
  Matrix matrix{1};                       // of one that rests
  std::function<Matrix(double)> at = {};  // of one that moves, by seconds
  std::vector<double> times = {};         // when its speed changes, seconds

  /// Returns the place of an operand of a csg that is here.
  Place of_operand(const CsgShape& csg, std::size_t i) const {
    const Matrix& rests = csg.operands[i]->world_from_object;
    const TransformKeys& keys = csg.motion(i);
    if (!at && keys.empty()) return {matrix * rests};
    Place out{Matrix(1), {}, times};
    for (const TransformKey& key : keys) out.times.push_back(key.time);
    std::shared_ptr<const AnimatedTransform> own;
    if (!keys.empty()) own = std::make_shared<const AnimatedTransform>(keys);
    out.at = [outer = *this, own, rests](double seconds) {
      return (outer.at ? outer.at(seconds) : outer.matrix) * (own ? own->at(seconds) : rests);
    };
    return out;
  }

  /// Returns how it moves while the shutter is open, in csg space; no value where it rests then.
  std::optional<MotionPath> path(const dvec3& center, const FilmSettings& film,
                                 const SourceLocation& where) const {
    if (!at) return std::nullopt;
    const Matrix to_center = glm::translate(Matrix(1), -center);
    return MotionPath::of([&](double seconds) { return to_center * at(seconds); }, times, film,
                          where);
  }

  Matrix at_opening(const FilmSettings& film) const { return at ? at(film.shutter_open) : matrix; }
};

struct Solid {
  const Shape* shape;
  Place place;
  std::uint32_t surface_begin;
  bool subtracted;
};

/// Operand is a solid as its kernel reads it: in csg space or, where `placed`, in a space of its
/// own.
struct Operand {
  FlatPrimitive flat, grown;
  std::uint32_t surface;  // with CAPLET_CSG_SUBTRACTED
  std::uint32_t uv_space;
  std::optional<glm::vec2> u;  // at the ends of a chain's capsule
  bool placed;
  Matrix csg_from_object{1};         // of one that rests
  std::optional<MotionPath> motion;  // of csg_from_object
  double error;                      // in csg space
};

/// Flattening makes the expression a postfix program over its solids, in the order of their
/// surfaces.
class Flattening {
 public:
  std::vector<Solid> solids;
  std::vector<std::uint32_t> program;

  void add(const CsgShape& csg, const Place& place, bool subtracted) {
    using Operation = CsgShape::Operation;
    CHECK_LT_(std::size_t(0), csg.operands.size());
    const bool takes_away = csg.operation == Operation::set_difference;
    for (std::size_t i = 0; i < csg.operands.size(); ++i) {
      const Shape& operand = *csg.operands[i];
      const Place placed = place.of_operand(csg, i);
      const bool turned = subtracted != (takes_away && i > 0);
      if (const auto* nested = std::get_if<CsgShape>(&operand.geometry)) {
        add(*nested, placed, turned);
      } else {
        if (!is_closed(operand))
          throw InputError(operand.where, "a csg operand must be a closed solid");
        if (solids.size() == CAPLET_CSG_MAX_OPERANDS)
          throw InputError(operand.where, fmt::format("a csg shape of more than {} solids",
                                                      CAPLET_CSG_MAX_OPERANDS));
        program.push_back(narrow<std::uint32_t>(solids.size()));
        solids.push_back({&operand, placed, surfaces_, turned});
        surfaces_ += narrow<std::uint32_t>(surface_count(operand));
        if (surfaces_ > CAPLET_SURFACE_MASK)
          throw InputError(operand.where, fmt::format("a csg shape of more than {} surfaces",
                                                      CAPLET_SURFACE_MASK));
      }
      if (i > 0)
        program.push_back(csg.operation == Operation::set_union          ? CAPLET_CSG_UNION
                          : csg.operation == Operation::set_intersection ? CAPLET_CSG_INTERSECTION
                                                                         : CAPLET_CSG_DIFFERENCE);
    }
  }

 private:
  std::uint32_t surfaces_ = 0;
};

/// FlatOf returns a solid's kernel form: that of the shape by itself.
struct FlatOf {
  const Matrix& m;
  const FilmSettings& film;
  std::vector<float>& leaves;
  const SourceLocation& where;

  FlatPrimitive operator()(const CapsulesShape& capsules) const {
    if (count_of(capsules) != 1)
      throw InputError(where, "a csg operand of capsules must hold exactly one");
    if (!capsules.times.empty()) {
      const CapsuleMotion motion(capsules, film.shutter_open, film.open_time());
      return MovingCapsules(motion, leaves).primitive(0);
    }
    return flat_capsule(capsules, 0, &m, similarity_scale(m));
  }
  FlatPrimitive operator()(const TriangleMeshShape&) const { return open(); }
  FlatPrimitive operator()(const BilinearMeshShape&) const { return open(); }
  FlatPrimitive operator()(const MolecularSurfaceShape&) const { return open(); }
  template <class One>
  FlatPrimitive operator()(const One& one) const {
    const FlatPrimitive p = flat_primitive(one, m, leaves);
    return shape_has(p.shape, trait_solid) ? p : open();
  }
  [[noreturn]] FlatPrimitive open() const {
    throw InputError(where, "a csg operand must be a closed solid");
  }
};

double length3(const double (&v)[3]) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

/// Returns the solid with its surfaces moved out by `b`.
FlatPrimitive grown_by(const FlatPrimitive& p, double b, std::vector<float>& leaves) {
  switch (p.shape) {
#define SHAPE(name, traits)                                                 \
  case shape_##name:                                                        \
    if constexpr (((traits) & (trait_solid | trait_linked)) == trait_solid) \
      return name##_grown(p, b, leaves);                                    \
    break;
#define COMPOUND(name, traits)
#include "shared/shapes.def"
#undef SHAPE
    default:
      break;
  }
  throw std::logic_error("only solids grow");
}

/// Returns `solid`, moved so that `center` is the origin of csg space. Rays come from the ball of
/// `radius` around it.
Operand make_operand(const Solid& solid, const dvec3& center, double radius,
                     const FilmSettings& film, std::vector<float>& leaves) {
  Operand out{};
  Shape moved = *solid.shape;
  moved.world_from_object = glm::translate(Matrix(1), -center) * solid.place.at_opening(film);
  out.motion = solid.place.path(center, film, moved.where);
  out.placed = out.motion || !bakes(moved);
  // from: how far from the origin of the operand's space rays may begin; scale: of lengths from
  // there to csg space.
  double from = radius, scale = 1;
  if (out.placed) {
    out.csg_from_object = moved.world_from_object;
    const Matrix object_from_csg =
                     out.motion ? out.motion->greatest(true) : glm::inverse(out.csg_from_object),
                 outward = out.motion ? out.motion->greatest(false) : out.csg_from_object;
    double reach[3] = {};
    scale = 0;
    for (int k = 0; k < 3; ++k) {
      reach[k] = std::abs(object_from_csg[3][k]);
      for (int j = 0; j < 3; ++j) reach[k] += std::abs(object_from_csg[j][k]) * radius;
      scale += glm::dot(dvec3(outward[k]), dvec3(outward[k]));
    }
    from = length3(reach);
    scale = std::sqrt(scale);
    moved.world_from_object = Matrix(1);
  }
  const Bounds bounds = bounds_of(moved);
  const double extent = glm::length(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
  // The kernels' error is at most 16 eps (distance of the origin + size): at most from + extent,
  // and 2 extent. The transform to the operand's space adds 5 eps of its terms (matrix, products,
  // sums), 8 here; the entries of one that moves are cubics in time, 4 eps more, 12 here.
  const double roundings = out.motion ? 12 : out.placed ? 8 : 0;
  const double error = eps * (16 * (from + 3 * extent) + roundings * from);
  out.flat =
      std::visit(FlatOf{moved.world_from_object, film, leaves, solid.shape->where}, moved.geometry);
  out.uv_space = append_uv_space(moved.geometry, moved.world_from_object, leaves);
  if (const auto* capsules = std::get_if<CapsulesShape>(&moved.geometry);
      capsules && !capsules->u.empty())
    out.u = capsules->u[0];
  out.grown = grown_by(out.flat, error, leaves);
  out.error = error * scale;
  out.surface = solid.surface_begin | (solid.subtracted ? CAPLET_CSG_SUBTRACTED : 0u);
  return out;
}

/// Group holds operands that one call of a span function evaluates.
struct Group {
  std::vector<std::size_t> operands;
};

std::vector<Group> grouped(const std::vector<Operand>& operands) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const auto fits = [&](const Group& group) {
      const Operand& first = operands[group.operands[0]];
      return group.operands.size() < lanes_per_group && !first.motion && !operands[i].motion &&
             first.flat.shape == operands[i].flat.shape && first.placed == operands[i].placed &&
             first.csg_from_object == operands[i].csg_from_object &&
             first.u.has_value() == operands[i].u.has_value();
    };
    const auto found = std::find_if(groups.begin(), groups.end(), fits);
    if (found != groups.end())
      found->operands.push_back(i);
    else
      groups.push_back({{i}});
  }
  return groups;
}

float as_row(std::size_t number) { return std::bit_cast<float>(narrow<std::uint32_t>(number)); }

std::size_t round_up(std::size_t n) { return (n + 7) / 8 * 8; }

/// Appends `count` zeros, in whole rows, and returns where they begin.
std::size_t append_rows(std::vector<float>& leaves, std::size_t count) {
  const std::size_t begin = round_up(leaves.size());
  leaves.resize(begin + round_up(count));
  return begin;
}

void write_group(const Group& group, const std::vector<Operand>& operands, std::size_t first,
                 std::size_t row, std::vector<float>& leaves) {
  const Operand& one = operands[group.operands[0]];
  const std::uint32_t rows = rows_of(one.flat.shape);
  const std::size_t block = append_rows(leaves, rows * 8);
  for (std::size_t lane = 0; lane < lanes_per_group; ++lane) {
    // Lanes without an operand repeat the first.
    const Operand& operand = operands[group.operands[lane < group.operands.size() ? lane : 0]];
    leaves[block + lane] = as_row(operand.uv_space);
    for (std::size_t j = 0; j + 1 < rows; ++j) {
      leaves[block + 8 * (j + 1) + lane] = operand.flat.data[j];
      leaves[block + 8 * (j + 1) + lanes_per_group + lane] = operand.grown.data[j];
    }
  }
  std::size_t transform = CAPLET_NONE;
  if (one.motion) {
    transform = append_rows(leaves, 0);
    one.motion->append(true, leaves);
    append_rows(leaves, 0);  // what follows begins with a row
  } else if (one.placed) {
    transform = append_rows(leaves, 24);
    write_matrix(&leaves[transform], glm::inverse(one.csg_from_object));
    write_matrix(&leaves[transform + 12], one.csg_from_object);
  }
  std::size_t chain = CAPLET_NONE;
  if (one.u) {
    chain = append_rows(leaves, 2 * lanes_per_group);
    for (std::size_t lane = 0; lane < group.operands.size(); ++lane) {
      leaves[chain + 2 * lane] = operands[group.operands[lane]].u->x;
      leaves[chain + 2 * lane + 1] = operands[group.operands[lane]].u->y;
    }
  }
  const std::size_t values[] = {one.flat.shape,
                                block,
                                group.operands.size(),
                                first,
                                transform,
                                chain,
                                one.motion ? one.motion->segments() : 0};
  for (std::size_t k = 0; k < std::size(values); ++k) leaves[row + k] = as_row(values[k]);
}

}  // namespace

std::uint64_t csg_operand_shapes(const FlatPrimitive& csg, const std::vector<float>& leaves) {
  const auto number = [&](std::size_t at) {
    return std::bit_cast<std::uint32_t>(leaves[csg_begin(csg.data) + at]);
  };
  std::uint64_t shapes = 0;
  for (std::size_t group = 0; group < number(4); ++group)
    shapes |= shape_bit(number(8 * (1 + group)));
  return shapes;
}

bool csg_has_chain(const FlatPrimitive& csg, const std::vector<float>& leaves) {
  const auto number = [&](std::size_t at) {
    return std::bit_cast<std::uint32_t>(leaves[csg_begin(csg.data) + at]);
  };
  for (std::size_t group = 0; group < number(4); ++group)
    if (number(8 * (1 + group) + 5) != CAPLET_NONE) return true;
  return false;
}

bool csg_moves(const FlatPrimitive& csg, const std::vector<float>& leaves) {
  const auto number = [&](std::size_t at) {
    return std::bit_cast<std::uint32_t>(leaves[csg_begin(csg.data) + at]);
  };
  for (std::size_t group = 0; group < number(4); ++group)
    if (number(8 * (1 + group) + 6) > 0) return true;
  return false;
}

namespace {

/// Returns bounds of a csg while the shutter is open.
Bounds bounds_while_open(const CsgShape& csg, const Place& place, const FilmSettings& film) {
  Bounds out;
  for (std::size_t i = 0; i < csg.operands.size(); ++i) {
    if (csg.operation == CsgShape::Operation::set_difference && i > 0) break;
    const Shape& operand = *csg.operands[i];
    const Place own = place.of_operand(csg, i);
    Bounds box;
    if (const auto* nested = std::get_if<CsgShape>(&operand.geometry))
      box = bounds_while_open(*nested, own, film);
    else if (const auto path = own.path(dvec3(0), film, operand.where))
      box = path->swept(bounds_of(operand.geometry, Matrix(1)));
    else
      box = bounds_of(operand.geometry, own.at_opening(film));
    if (csg.operation == CsgShape::Operation::set_intersection && i > 0) {
      out.min = glm::max(out.min, box.min);
      out.max = glm::min(out.max, box.max);
    } else {
      out.extend(box);
    }
  }
  return out;
}

}  // namespace

// Operands hold their own transforms.
bool bakes_under(const CsgShape&, const Matrix&) { return true; }
glm::dmat3 turn_under(const CsgShape&, const Matrix&) { return glm::dmat3(1); }

FlatPrimitive flat_primitive(const CsgShape& csg, const Matrix& m, std::vector<float>& leaves) {
  return flat_csg(csg, m, FilmSettings(), leaves);
}

FlatPrimitive flat_csg(const CsgShape& csg, const Matrix& m, const FilmSettings& film,
                       std::vector<float>& leaves) {
  Flattening flattening;
  flattening.add(csg, {m}, false);

  Bounds box = moves(csg) ? bounds_while_open(csg, {m}, film) : bounds_of(Geometry(csg), m);
  for (int k = 0; k < 3; ++k)  // no bounds (boxes of an intersection that do not meet): an empty
                               // box at any place will do
    if (!(box.min[k] <= box.max[k])) box.min[k] = box.max[k] = 0.5 * (box.min[k] + box.max[k]);
  dvec3 center;
  for (int k = 0; k < 3; ++k) center[k] = static_cast<float>(0.5 * (box.min[k] + box.max[k]));
  // Rays that begin on the shape's surface must begin within this ball: 2^-16 is more than their
  // rounding.
  const double radius = glm::length(glm::max(box.max - center, center - box.min)) * (1 + 0x1p-16);

  std::vector<Operand> operands;
  double error = 0;
  for (const Solid& solid : flattening.solids) {
    operands.push_back(make_operand(solid, center, radius, film, leaves));
    error = std::max(error, operands.back().error);
  }
  const std::vector<Group> groups = grouped(operands);
  std::vector<std::uint32_t> number(operands.size());
  std::vector<std::uint32_t> surfaces;
  for (const Group& group : groups)
    for (const std::size_t i : group.operands) {
      number[i] = narrow<std::uint32_t>(surfaces.size());
      surfaces.push_back(operands[i].surface);
    }

  const std::size_t begin =
      append_rows(leaves, 8 * (1 + groups.size()) + round_up(surfaces.size()) +
                              round_up(flattening.program.size()));
  for (int k = 0; k < 3; ++k)
    leaves[begin + static_cast<std::size_t>(k)] = static_cast<float>(center[k]);
  leaves[begin + 3] = std::nextafter(static_cast<float>(radius), INFINITY);
  leaves[begin + 4] = as_row(groups.size());
  leaves[begin + 5] = as_row(flattening.program.size());
  leaves[begin + 6] = as_row(operands.size());
  std::size_t at = begin + 8, first = 0;
  for (const Group& group : groups) {
    write_group(group, operands, first, at, leaves);
    first += group.operands.size();
    at += 8;
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) leaves[at + i] = as_row(surfaces[i]);
  at += round_up(surfaces.size());
  for (std::size_t i = 0; i < flattening.program.size(); ++i) {
    const std::uint32_t code = flattening.program[i];
    leaves[at + i] = as_row(code < CAPLET_CSG_UNION ? number[code] : code);
  }

  FlatPrimitive p{shape_csg, 0, {}};
  p.data[csg_at_begin] = as_row(begin);
  put(p, csg_data, box.min - error);
  put(p, csg_data + 3, box.max + error);
  return p;
}

}  // namespace caplet
