// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/worlds.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/lowering.h"
#include "lower/detail/shapes.h"
#include "lower/encode.h"
#include "scene/frozen.h"
#include "scene/transform.h"

namespace caplet {

namespace {

constexpr std::uint32_t no_child = 0x7fffffff;  // bvh::Node

bool is_placement(const glm::dmat4& matrix) {
  const glm::dvec4& shift = matrix[3];
  return is_affine(matrix) && has_inverse(matrix) && std::isfinite(shift.x + shift.y + shift.z);
}

void keep_geometry_alone(Shape& shape) {
  shape.emission.reset();
  shape.alpha.reset();
  shape.media = {};
}

/// The tree of one world, whose nodes and rows are counted from 0.
struct WorldTree {
  std::vector<float> nodes, leaves;
  std::uint64_t node_count() const { return nodes.size() / CAPLET_NODE_FLOATS; }
  std::uint64_t rows() const { return leaves.size() / 8; }
};

/// Copies a tree to where its first node is number `node` and its first row is `row`.
void copy_tree(const WorldTree& tree, std::uint64_t node, std::uint64_t row, FlatScene& to) {
  std::ranges::copy(tree.leaves, to.leaves.begin() + static_cast<std::ptrdiff_t>(row * 8));
  float* out = &to.nodes[node * CAPLET_NODE_FLOATS];
  std::ranges::copy(tree.nodes, out);
  for (std::uint64_t n = 0; n < tree.node_count(); ++n)
    for (std::size_t i = 0; i < CAPLET_WIDTH; ++i) {
      float& child = out[n * CAPLET_NODE_FLOATS + CAPLET_NODE_CHILDREN + i];
      const auto reference = std::bit_cast<std::uint32_t>(child);
      if (reference == no_child) continue;
      // The low bits of a leaf's reference are its row.
      child = std::bit_cast<float>(reference +
                                   narrow<std::uint32_t>(reference >> 31 != 0 ? row : node));
    }
}

// Shapes of more primitives are placed by an instance, whose one box stands for all in a world's
// tree; the resting ones together are another.
constexpr std::size_t most_in_tree = 64;

/// Returns primitive i of a shape whose primitives hold all that its kernels read, under a
/// transform that they can hold; none for other kinds.
std::optional<FlatPrimitive> primitive_under(const Shape& shape, std::size_t i,
                                             const glm::dmat4& m) {
  std::vector<float> unused;
  if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
    return flat_capsule(*capsules, i, &m, similarity_scale(m));
  if (const auto* sphere = std::get_if<SphereShape>(&shape.geometry))
    return flat_primitive(*sphere, m, unused);
  if (const auto* cylinder = std::get_if<CylinderShape>(&shape.geometry))
    return flat_primitive(*cylinder, m, unused);
  if (const auto* cone = std::get_if<ConeShape>(&shape.geometry))
    return flat_primitive(*cone, m, unused);
  return std::nullopt;
}

/// Appends the primitives of a shape that stands_in_tree, under a transform. Returns false, and
/// appends nothing, where they cannot hold it. `of`: the primitives as lowered, which have the same
/// ids.
bool append_under(const Shape& shape, const glm::dmat4& m, std::span<const FlatPrimitive> of,
                  std::vector<FlatPrimitive>& out) {
  if (!subtree_key(shape, m).is_common()) return false;
  for (std::size_t i = 0; i < of.size(); ++i) {
    out.push_back(primitive_under(shape, i, m).value());
    out.back().id = of[i].id;
  }
  return true;
}

/// `shape`: without a transform.
bool stands_in_tree(const Shape& shape) {
  const std::size_t count = primitive_count(shape);
  return count > 0 && count <= most_in_tree &&
         subtree_key(shape, shape.world_from_object).is_common() &&
         primitive_under(shape, 0, shape.world_from_object).has_value();
}

// A capsule whose ends change may be of any of these kinds in a world. Its shape is lowered with as
// many capsules of each kind as it has, one kind after the other: so there are kernels for all of
// them, and numbers and geometry records to take in a world.
constexpr std::array end_kinds{shape_capsule, shape_tapered_capsule, shape_sphere};

/// Returns a shape with such capsules in the place of its own.
CapsulesShape of_each_kind(const CapsulesShape& of) {
  CapsulesShape out;
  for (const auto kind : end_kinds)
    for (std::size_t i = 0; i < count_of(of); ++i) {
      out.p0.emplace_back(0, 0, 0);
      out.p1.emplace_back(kind == shape_sphere ? 0 : 1, 0, 0);
      out.radius0.push_back(1);
      out.radius1.push_back(kind == shape_tapered_capsule ? 0.5F : 1);
      if (!of.materials.empty()) out.materials.push_back(of.materials[i]);
    }
  return out;
}

std::size_t index_of_kind(const FlatPrimitive& p) {
  const auto found = std::ranges::find(end_kinds, static_cast<int>(p.shape));
  CHECK_EQ_(found != end_kinds.end(), true);
  return static_cast<std::size_t>(found - end_kinds.begin());
}

bool is_capsule(const Capsule& c) {
  const auto is_finite = [](const glm::vec3& v) { return std::isfinite(v.x + v.y + v.z); };
  return is_finite(c.p0) && is_finite(c.p1) && std::isfinite(c.radius0 + c.radius1) &&
         c.radius0 >= 0 && c.radius1 >= 0;
}

/// Marks which of `count` shapes are in a list, by their index in it; CAPLET_NONE: not.
std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> list, std::size_t count) {
  std::vector<std::uint32_t> out(count, CAPLET_NONE);
  for (std::size_t i = 0; i < list.size(); ++i) {
    CHECK_LT_(std::size_t{list[i]}, count);
    CHECK_EQ_(out[list[i]], std::uint32_t{CAPLET_NONE});
    out[list[i]] = narrow<std::uint32_t>(i);
  }
  return out;
}

}  // namespace

struct Worlds::State {
  /// A shape whose capsules have other ends in each world.
  struct Deforming {
    std::uint32_t in_tree = CAPLET_NONE;  // index into Places::in_tree
    std::uint32_t moving = CAPLET_NONE;   // index into the moving shapes; CAPLET_NONE: it rests
    glm::dmat4 world_from_object{1};      // where it rests
    std::size_t first = 0, count = 0;     // its capsules, of those of all deforming shapes
  };

  /// Places is a scene in which everything that moves is an object with an instance. Its shapes of
  /// the world are those that stand in the worlds' trees themselves: simple moving ones, again, and
  /// the resting ones where they are few.
  struct Places {
    Places(Scene from, std::span<const std::uint32_t> moving,
           std::span<const std::uint32_t> deforming);
    /// Returns how many capsules the deforming shapes have in all.
    std::size_t ends() const {
      return deforming.empty() ? 0 : deforming.back().first + deforming.back().count;
    }

    Scene scene;
    std::vector<Deforming> deforming;
    std::vector<std::uint32_t> in_tree;         // numbers of the shapes of the world
    std::vector<std::size_t> capsules_in_tree;  // by them: how many one that deforms has, else 0
    std::vector<std::uint32_t> moving_in_tree;  // by moving shape: index into those, or CAPLET_NONE
    std::size_t resting_in_tree = 0;            // of them, from here on, rest
    // By instance of `scene`:
    std::vector<std::uint32_t> moving_of;    // index into `moving`; CAPLET_NONE: it rests
    std::vector<std::uint32_t> instance_of;  // index into the instances that `from` had
    std::vector<std::vector<std::uint32_t>> shapes_of;  // numbers of the object's shapes
  };

  State(Scene from, std::span<const std::uint32_t> moving_shapes,
        std::span<const std::uint32_t> deforming_shapes)
      : moving(moving_shapes.size()),
        places(std::move(from), moving_shapes, deforming_shapes),
        lowering(places.scene, Linking::none()),
        placed_of(moving) {
    const FlatScene& flat = lowering.flat;
    first_node = flat.nodes.size();
    first_leaf = flat.leaves.size();
    first_instance = flat.instances.size();
    const auto& placed = lowering.geometry.placed;
    for (std::size_t i = 0; i < placed.size(); ++i) {
      const std::uint32_t of = placed[i].scene_instance;
      const std::uint32_t which = of == CAPLET_NONE ? CAPLET_NONE : places.moving_of[of];
      if (which != CAPLET_NONE) {
        placed_of[which].push_back(i);
        continue;
      }
      FlatPrimitive box{shape_instance, placed[i].instance, {}};
      set_instance_box(*placed[i].subtree, placed[i].world_from_subtree, nullptr, box);
      resting.push_back(box);
    }
    for (std::size_t i = places.resting_in_tree; i < places.in_tree.size(); ++i)
      if (lowering.geometry.world.extents[i].subtree == &lowering.geometry.world.subtrees[0])
        for (const FlatPrimitive& p : lowered(i)) resting.push_back(p);
    changes.all = true;
  }

  /// Returns the primitives of a shape of the world, as lowered.
  std::span<const FlatPrimitive> lowered(std::size_t shape) const {
    const ShapeExtent& extent = lowering.geometry.world.extents[shape];
    if (!extent.subtree) return {};
    return std::span(extent.subtree->primitives)
        .subspan(extent.first, extent.end.primitives - extent.begin.primitives);
  }

  /// Returns where a deforming shape is in world `w`.
  const glm::dmat4& transform_of(const Deforming& shape, std::size_t w,
                                 std::span<const glm::dmat4> transforms) const {
    return shape.moving == CAPLET_NONE ? shape.world_from_object
                                       : transforms[w * moving + shape.moving];
  }

  /// Throws InputError unless a world's deforming shapes can be what is asked.
  void check_ends(std::size_t w, std::size_t number, std::span<const glm::dmat4> transforms,
                  std::span<const Capsule> ends) const {
    for (const Deforming& shape : places.deforming) {
      const std::uint32_t which = places.in_tree[shape.in_tree];
      if (similarity_scale(transform_of(shape, w, transforms)) <= 0)
        throw InputError(fmt::format(
            "world {}: the transform of shape {}, whose ends change, is not a similarity (of one "
            "scale in all directions)",
            number, which));
      for (std::size_t i = 0; i < shape.count; ++i)
        if (!is_capsule(ends[w * places.ends() + shape.first + i]))
          throw InputError(
              fmt::format("world {}: capsule {} of shape {} is not finite or has a negative radius",
                          number, i, which));
    }
  }

  /// Appends the capsules of a deforming shape of a world.
  void append(const Deforming& shape, const glm::dmat4& m, std::span<const Capsule> ends,
              std::vector<FlatPrimitive>& out) const {
    CapsulesShape capsules;
    for (const Capsule& c : ends) {
      capsules.p0.push_back(c.p0);
      capsules.p1.push_back(c.p1);
      capsules.radius0.push_back(c.radius0);
      capsules.radius1.push_back(c.radius1);
    }
    const std::span<const FlatPrimitive> of = lowered(shape.in_tree);
    const double scale = similarity_scale(m);
    for (std::size_t i = 0; i < shape.count; ++i) {
      out.push_back(flat_capsule(capsules, i, m == glm::dmat4(1) ? nullptr : &m, scale));
      out.back().id = of[index_of_kind(out.back()) * shape.count + i].id;
    }
  }

  /// Writes the instances of world `w`, and returns its tree.
  WorldTree place(std::size_t w, std::span<const glm::dmat4> transforms,
                  std::span<const Capsule> ends) {
    FlatScene& flat = lowering.flat;
    const auto& placed = lowering.geometry.placed;
    std::vector<FlatPrimitive> primitives = resting;
    for (std::size_t k = 0; k < moving; ++k) {
      const glm::dmat4& m = transforms[w * moving + k];
      const std::uint32_t in_tree = places.moving_in_tree[k];
      if (in_tree != CAPLET_NONE &&
          append_under(places.scene.shapes[in_tree], m, lowered(in_tree), primitives))
        continue;
      for (const std::size_t i : placed_of[k]) {
        const std::size_t number = first_instance + w * placed.size() + i;
        // The object holds the shape without a transform, so its tree has none either.
        flat.instances[number] =
            instance_record(*placed[i].subtree, m, flat.instances[placed[i].instance].object);
        FlatPrimitive& box = primitives.emplace_back(
            FlatPrimitive{shape_instance, narrow<std::uint32_t>(number), {}});
        set_instance_box(*placed[i].subtree, m, nullptr, box);
      }
    }
    for (const Deforming& shape : places.deforming)
      append(shape, transform_of(shape, w, transforms),
             ends.subspan(w * places.ends() + shape.first, shape.count), primitives);
    WorldTree out;
    encode_tree(primitives, out.nodes, out.leaves, flat.leaf_kind_bits);
    return out;
  }

  std::size_t moving;
  Places places;
  Lowering lowering;
  std::vector<std::vector<std::size_t>> placed_of;  // by moving shape: of LoweredGeometry::placed
  std::size_t first_node = 0, first_leaf = 0, first_instance = 0;  // of worlds, in the flat arrays
  std::vector<FlatPrimitive> resting;  // what rests, in every world's tree
  std::vector<uint> roots;
  SceneChanges changes;
};

Worlds::State::Places::Places(Scene from, std::span<const std::uint32_t> moving,
                              std::span<const std::uint32_t> deforming_shapes)
    : scene(std::move(from)), moving_in_tree(moving.size(), CAPLET_NONE) {
  const std::vector<std::uint32_t> moved = places_in(moving, scene.shapes.size());
  const std::vector<std::uint32_t> deforms = places_in(deforming_shapes, scene.shapes.size());
  deforming.resize(deforming_shapes.size());
  for (std::size_t k = 0; k < deforming.size(); ++k) {
    const Shape& shape = scene.shapes[deforming_shapes[k]];
    const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
    if (!capsules)
      throw InputError(shape.where, fmt::format("worlds: shape {} has no capsules whose ends could "
                                                "change",
                                                deforming_shapes[k]));
    deforming[k].moving = moved[deforming_shapes[k]];
    deforming[k].world_from_object = shape.world_from_object;
    deforming[k].first = k > 0 ? deforming[k - 1].first + deforming[k - 1].count : 0;
    deforming[k].count = count_of(*capsules);
  }
  scene.lights.clear();
  scene.textures.clear();
  scene.media.clear();
  for (Material& material : scene.materials) material = Material();
  std::vector<std::vector<std::uint32_t>> numbers;  // by object
  auto number = narrow<std::uint32_t>(scene.shapes.size());
  for (Object& object : scene.objects) {
    numbers.emplace_back();
    for (Shape& shape : object.shapes) {
      keep_geometry_alone(shape);
      numbers.back().push_back(number++);
    }
  }
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    moving_of.push_back(CAPLET_NONE);
    instance_of.push_back(narrow<std::uint32_t>(i));
    shapes_of.push_back(numbers[scene.instances[i].object]);
  }
  const auto place = [&](Object object, std::vector<std::uint32_t> shapes, std::uint32_t which) {
    Instance& instance = scene.instances.emplace_back();
    instance.object = narrow<std::uint32_t>(scene.objects.size());
    scene.objects.push_back(std::move(object));
    moving_of.push_back(which);
    instance_of.push_back(CAPLET_NONE);
    shapes_of.push_back(std::move(shapes));
  };
  std::vector<Shape> shapes;
  Object resting;
  std::vector<std::uint32_t> resting_numbers;
  std::size_t resting_primitives = 0;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    Shape& shape = scene.shapes[i];
    keep_geometry_alone(shape);
    const auto own = narrow<std::uint32_t>(i);
    if (deforms[i] != CAPLET_NONE) {
      auto& capsules = std::get<CapsulesShape>(shape.geometry);
      capsules = of_each_kind(capsules);
      shape.world_from_object = glm::dmat4(1);
      if (!subtree_key(shape, shape.world_from_object).is_common())
        throw InputError(shape.where, fmt::format("worlds: shape {} shows one side alone, and its "
                                                  "ends cannot change",
                                                  i));
      deforming[deforms[i]].in_tree = narrow<std::uint32_t>(shapes.size());
      capsules_in_tree.resize(shapes.size());
      capsules_in_tree.push_back(deforming[deforms[i]].count);
      in_tree.push_back(own);
      shapes.push_back(std::move(shape));
      continue;
    }
    if (moved[i] == CAPLET_NONE) {
      resting_primitives += primitive_count(shape);
      resting.shapes.push_back(std::move(shape));
      resting_numbers.push_back(own);
      continue;
    }
    shape.world_from_object = glm::dmat4(1);
    if (stands_in_tree(shape)) {
      moving_in_tree[moved[i]] = narrow<std::uint32_t>(shapes.size());
      in_tree.push_back(own);
      shapes.push_back(shape);
    }
    Object object;
    object.shapes.push_back(std::move(shape));
    place(std::move(object), {own}, moved[i]);
  }
  resting_in_tree = shapes.size();
  if (resting_primitives > most_in_tree) {
    place(std::move(resting), std::move(resting_numbers), CAPLET_NONE);
  } else {
    std::ranges::move(resting.shapes, std::back_inserter(shapes));
    in_tree.insert(in_tree.end(), resting_numbers.begin(), resting_numbers.end());
  }
  scene.shapes = std::move(shapes);
  capsules_in_tree.resize(scene.shapes.size());
}

Worlds::Worlds(Scene scene, std::span<const std::uint32_t> moving,
               std::span<const std::uint32_t> deforming) {
  if (moves(scene))
    throw InputError("worlds: the scene moves while its shutter is open, and worlds stand still");
  state_ = std::make_unique<State>(std::move(scene), moving, deforming);
}
Worlds::Worlds(Worlds&&) noexcept = default;
Worlds& Worlds::operator=(Worlds&&) noexcept = default;
Worlds::~Worlds() = default;

void Worlds::place(std::size_t worlds, std::span<const glm::dmat4> transforms,
                   std::span<const Capsule> ends, std::size_t first_world) {
  State& s = *state_;
  CHECK_EQ_(transforms.size(), worlds * s.moving);
  CHECK_EQ_(ends.size(), worlds * s.places.ends());
  s.roots.clear();
  for (std::size_t i = 0; i < transforms.size(); ++i)
    if (!is_placement(transforms[i]))
      throw InputError(
          fmt::format("world {}: the transform of moving shape {} is not affine, not "
                      "finite, or singular (it flattens the shape)",
                      first_world + i / s.moving, i % s.moving));
  for (std::size_t w = 0; w < worlds; ++w) s.check_ends(w, first_world + w, transforms, ends);
  FlatScene& flat = s.lowering.flat;
  const std::size_t placed = s.lowering.geometry.placed.size();
  flat.instances.resize(s.first_instance + worlds * placed);
  std::vector<WorldTree> trees(worlds);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, worlds),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t w = range.begin(); w < range.end(); ++w)
                        trees[w] = s.place(w, transforms, ends);
                    });
  std::vector<std::uint64_t> nodes(worlds + 1), rows(worlds + 1);
  nodes[0] = s.first_node / CAPLET_NODE_FLOATS;
  rows[0] = s.first_leaf / 8;
  for (std::size_t w = 0; w < worlds; ++w) {
    nodes[w + 1] = nodes[w] + trees[w].node_count();
    rows[w + 1] = rows[w] + trees[w].rows();
  }
  check_tree_limits(rows[worlds], nodes[worlds], flat.leaf_kind_bits);
  flat.nodes.resize(nodes[worlds] * CAPLET_NODE_FLOATS);
  flat.leaves.resize(rows[worlds] * 8);
  tbb::parallel_for(std::size_t{0}, worlds,
                    [&](std::size_t w) { copy_tree(trees[w], nodes[w], rows[w], flat); });
  std::ranges::transform(std::span(nodes).first(worlds), std::back_inserter(s.roots),
                         [](std::uint64_t node) { return narrow<uint>(node); });
  s.changes.nodes.add(s.first_node, flat.nodes.size() - s.first_node);
  s.changes.leaves.add(s.first_leaf, flat.leaves.size() - s.first_leaf);
  s.changes.instances.add(s.first_instance, flat.instances.size() - s.first_instance);
}

std::size_t Worlds::moving() const { return state_->moving; }
std::size_t Worlds::ends() const { return state_->places.ends(); }
const FlatScene& Worlds::flat() const { return state_->lowering.flat; }
std::span<const uint> Worlds::roots() const { return state_->roots; }
SceneChanges Worlds::take_changes() { return std::exchange(state_->changes, {}); }

WorldsIdentity Worlds::identity_of(const PickRecord& pick) const {
  const State::Places& places = state_->places;
  const std::size_t in_tree = places.in_tree.size();
  if (pick.object < in_tree) {
    const std::size_t capsules = places.capsules_in_tree[pick.object];
    return {places.in_tree[pick.object], CAPLET_NONE,
            capsules == 0 ? pick.primitive : narrow<std::uint32_t>(pick.primitive % capsules)};
  }
  const std::size_t instance = pick.object - in_tree;
  CHECK_LT_(instance, places.shapes_of.size());
  const std::vector<std::uint32_t>& shapes = places.shapes_of[instance];
  CHECK_LT_(pick.shape - in_tree, shapes.size());
  return {shapes[pick.shape - in_tree], places.instance_of[instance], pick.primitive};
}

}  // namespace caplet
