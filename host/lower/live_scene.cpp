// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/live_scene.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <utility>

#include "base/check.h"
#include "lower/detail/flat_shapes.h"
#include "lower/detail/lowering.h"
#include "lower/detail/materials.h"
#include "lower/detail/shapes.h"
#include "lower/detail/tree_edit.h"
#include "lower/lower.h"
#include "scene/frozen.h"

namespace caplet {

namespace {

using Matrix = glm::dmat4;

/// A tree of at least this many primitives is built again when edits have made it this many times
/// as costly.
constexpr std::size_t rebuilt_from_primitives = 256;
constexpr double rebuilt_at_growth = 2;
/// Beyond this share of a tree it is cheaper to build it again than to move primitive by primitive.
constexpr std::size_t most_moved = 4096, least_unmoved_share = 8;

template <class T>
bool same_bytes(const T& a, const T& b) {
  using Bytes = std::array<std::byte, sizeof(T)>;
  return std::bit_cast<Bytes>(a) == std::bit_cast<Bytes>(b);
}

/// Adds the ranges of `now` that differ from `before`.
template <class T>
void add_differences(const std::vector<T>& before, const std::vector<T>& now, ChangedRanges& out) {
  const std::size_t common = std::min(before.size(), now.size());
  std::size_t begin = 0, end = now.size();
  while (begin < common && same_bytes(before[begin], now[begin])) ++begin;
  if (before.size() == now.size())
    while (end > begin && same_bytes(before[end - 1], now[end - 1])) --end;
  out.add(begin, end - begin);
}

}  // namespace

struct LiveScene::State {
  State(Scene of, const Linking& links) : scene(std::move(of)), linking(links) {
    linking.keeps_primitives = true;
    lower_all();
  }

  void lower_all() {
    auto fresh = std::make_unique<Lowering>(scene, linking);
    trees = std::make_unique<TreeEdit>(fresh->flat, fresh->geometry);
    lowering = std::move(fresh);
    changes = {};
    changes.all = true;
    ++lowerings;
  }

  FlatScene& flat() { return lowering->flat; }
  LoweredGeometry& geometry() { return lowering->geometry; }
  Subtree& top() { return geometry().world.subtrees[0]; }

  ShapeExtent& extent(const ShapeAt& at) {
    return (at.object ? geometry().objects[*at.object] : geometry().world).extents[at.shape];
  }

  // Each of these updates the flat arrays for an edit that is made already; `before`: what stood
  // there. They return false, and change nothing, if that cannot be done in place.

  bool follow(const CapsuleEdit& edit, const CapsuleEdit&) {
    const Shape& shape = shape_at(scene, edit.at);
    ShapeExtent& of = extent(edit.at);
    if (!of.subtree) return false;
    if (of.has_linked) return unlink();
    const Matrix baked = subtree_key(shape, shape.world_from_object).baked;
    const std::size_t at = of.first + edit.capsule;
    FlatPrimitive& p = of.subtree->primitives[at];
    const FlatPrimitive moved =
        flat_capsule(std::get<CapsulesShape>(shape.geometry), edit.capsule,
                     baked == Matrix(1) ? nullptr : &baked, similarity_scale(baked));
    if (moved.shape != p.shape) return false;
    std::copy(std::begin(moved.data), std::end(moved.data), std::begin(p.data));
    trees->move(*of.subtree, at, changes);
    subtree_has_changed(*of.subtree, &shape);
    return true;
  }

  /// Has the scene lowered again without linked capsules, which cannot be moved one by one.
  bool unlink() {
    linking = Linking::none();
    return false;
  }

  bool follow(const TransformEdit& edit, const TransformEdit& before) {
    const Shape& shape = shape_at(scene, edit.at);
    ShapeExtent& of = extent(edit.at);
    if (!of.subtree) return false;
    const SubtreeKey old = subtree_key(shape, before.world_from_object),
                     now = subtree_key(shape, edit.world_from_object);
    const bool other_subtree = !now.same_subtree(old);
    if (other_subtree && (now.is_common() || old.is_common() || of.subtree->shapes.size() != 1))
      return false;
    if (now.baked != old.baked && !bake(shape, of, now.baked)) return false;
    of.subtree->placed = now.placed;
    of.subtree->flags = now.flags;
    subtree_has_changed(*of.subtree, &shape);
    return true;
  }

  /// Bakes a shape of which only numbers change, under another matrix.
  bool bake(const Shape& shape, ShapeExtent& of, const Matrix& baked) {
    if (of.has_linked) return unlink();
    Subtree& subtree = *of.subtree;
    const std::size_t count = of.end.primitives - of.begin.primitives;
    if (count > most_moved && count * least_unmoved_share > subtree.primitives.size()) return false;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t kind = subtree.primitives[of.first + i].shape;
      // These kinds keep data in `leaves` that depend on the matrix.
      if (kind == shape_csg || kind == shape_polyhedron || kind == shape_molecular_patch ||
          shape_has(kind, trait_moves))
        return false;
    }
    FlatScene fresh;
    const Subtree own =
        lower_shape_alone(scene, shape, baked, 0, lowering->images, lowering->spectra, fresh);
    const auto as_long = [&](std::size_t size, std::size_t Lengths::*length) {
      return size == of.end.*length - of.begin.*length;
    };
    if (!as_long(fresh.geometries.size(), &Lengths::geometries) ||
        !as_long(own.primitives.size(), &Lengths::primitives) ||
        !as_long(fresh.mesh_indices.size(), &Lengths::indices) ||
        !as_long(fresh.mesh_normals.size(), &Lengths::normals) ||
        !as_long(fresh.mesh_uvs.size(), &Lengths::uvs))
      return false;
    for (std::size_t i = 0; i < count; ++i)
      if (own.primitives[i].shape != subtree.primitives[of.first + i].shape) return false;

    FlatScene& to = flat();
    if (!fresh.geometries.empty()) {
      const uint space = set_uv_space(to.geometries[of.begin.geometries].uv_space, fresh);
      for (std::size_t i = 0; i < fresh.geometries.size(); ++i) {
        GeometryRecord& record = to.geometries[of.begin.geometries + i];
        record.uv_space = space;
        record.flags = fresh.geometries[i].flags;
      }
      changes.geometries.add(of.begin.geometries, fresh.geometries.size());
    }
    const auto put = [](const auto& from, auto& target, std::size_t begin, ChangedRanges& changed) {
      std::ranges::copy(from, target.begin() + static_cast<std::ptrdiff_t>(begin));
      changed.add(begin, from.size());
    };
    put(fresh.mesh_indices, to.mesh_indices, of.begin.indices, changes.mesh_indices);
    put(fresh.mesh_normals, to.mesh_normals, of.begin.normals, changes.mesh_normals);
    put(fresh.mesh_uvs, to.mesh_uvs, of.begin.uvs, changes.mesh_uvs);
    for (std::size_t i = 0; i < count; ++i) {
      FlatPrimitive& p = subtree.primitives[of.first + i];
      std::copy_n(own.primitives[i].data, 12, p.data);
      trees->move(subtree, of.first + i, changes);
    }
    return true;
  }

  /// Writes the rotation of a shape that is lowered into `fresh`, and returns its place. `old`:
  /// where the last one stood.
  uint set_uv_space(uint old, const FlatScene& fresh) {
    const uint from = fresh.geometries[0].uv_space;
    if (from == CAPLET_NONE) return CAPLET_NONE;
    std::vector<float>& leaves = flat().leaves;
    std::size_t at = old;
    if (old == CAPLET_NONE) {
      at = (leaves.size() + 7) / 8 * 8;
      leaves.resize(at + 16);
      trees->leaves_have_grown();
    }
    std::copy_n(&fresh.leaves[from], 16, &leaves[at]);
    changes.leaves.add(at, 16);
    return narrow<uint>(at);
  }

  bool follow(const EmissionEdit& edit, const EmissionEdit& before) {
    ShapeExtent& of = extent(edit.at);
    if (!of.subtree || edit.to.surfaces != before.to.surfaces) return false;
    for (std::size_t i = of.begin.geometries; i < of.end.geometries; ++i) {
      uint& flags = flat().geometries[i].flags;
      flags &= ~CAPLET_GEOMETRY_EMIT_BOTH_SIDES;
      if (edit.to.two_sided) flags |= CAPLET_GEOMETRY_EMIT_BOTH_SIDES;
    }
    changes.geometries.add(of.begin.geometries, of.end.geometries - of.begin.geometries);
    update_emitters(*of.subtree, &shape_at(scene, edit.at));
    lower_lights_again();
    return true;
  }

  bool follow(const InstanceEdit& edit, const InstanceEdit&) {
    for (PlacedSubtree& placed : geometry().placed)
      if (placed.scene_instance == edit.instance) place_again(placed);
    world_may_have_changed();
    return true;
  }

  bool follow(const MaterialEdit& edit, const MaterialEdit& before) {
    const Material& material = scene.materials[edit.material];
    if (!edit.textures.empty() || !before.textures.empty() || material.normalmap ||
        material.displacement)
      return false;  // other steps, and perhaps other kinds of them
    flat().materials[edit.material] =
        lower_material(scene, edit.material, lowering->images, lowering->spectra, flat());
    changes.materials.add(edit.material, 1);
    changes.material_data.add(flat().materials[edit.material].data, material_stride);
    return true;
  }

  bool follow(const LightEdit&, const LightEdit&) {
    lower_lights_again();
    return true;
  }

  bool follow(const View& edit, const View& before) {
    const bool same_shutter = edit.film.shutter_open == before.film.shutter_open &&
                              edit.film.open_time() == before.film.open_time();
    return (same_shutter || !moves(scene)) && edit.film.space == before.film.space &&
           edit.film.backdrop.has_value() == before.film.backdrop.has_value();
  }

  /// Call this when `subtree` has other primitives or another place; `shape`, where it emits, has
  /// other areas.
  void subtree_has_changed(Subtree& subtree, const Shape* shape) {
    if (&subtree != &top()) {
      for (PlacedSubtree& placed : geometry().placed)
        if (placed.subtree == &subtree) place_again(placed);
    } else if (shape->emission) {
      update_emitters(subtree, shape);
    }
    world_may_have_changed();
  }

  /// Updates an instance's record, its box in the world, and its lights.
  void place_again(PlacedSubtree& placed) {
    const Subtree& subtree = *placed.subtree;
    CHECK_EQ_(placed.motion.has_value(), false);
    placed.world_from_subtree =
        placed.scene_instance == CAPLET_NONE
            ? subtree.placed
            : scene.instances[placed.scene_instance].world_from_object * subtree.placed;
    InstanceRecord& record = flat().instances[placed.instance];
    InstanceRecord fresh = instance_record(subtree, placed.world_from_subtree, record.object);
    fresh.light_base = record.light_base;
    if (!same_bytes(record, fresh)) {
      record = fresh;
      changes.instances.add(placed.instance, 1);
    }
    FlatPrimitive& box = top().primitives[placed.top];
    set_instance_box(subtree, placed.world_from_subtree, nullptr, box);
    trees->move(top(), placed.top, changes);
    if (subtree.emitter_count == 0) return;
    for (const Subtree::Emissive& emissive : subtree.emissive)
      emit_again(subtree, emissive, placed.instance, placed.world_from_subtree, nullptr,
                 record.light_base);
  }

  /// Updates the lights of a shape wherever its subtree is.
  void update_emitters(const Subtree& subtree, const Shape* shape) {
    for (const Subtree::Emissive& emissive : subtree.emissive) {
      if (emissive.shape != shape) continue;
      if (&subtree == &top()) emit_again(subtree, emissive, CAPLET_NONE, Matrix(1), nullptr, 0);
      for (const PlacedSubtree& placed : geometry().placed)
        if (placed.subtree == &subtree)
          emit_again(subtree, emissive, placed.instance, placed.world_from_subtree,
                     placed.motion ? &*placed.motion : nullptr,
                     flat().instances[placed.instance].light_base);
    }
  }

  void emit_again(const Subtree& subtree, const Subtree::Emissive& emissive, uint instance,
                  const Matrix& world_from_subtree, const MotionPath* motion, uint light_base) {
    Emitter* first = &geometry().emitters[light_base + emissive.offset];
    set_emitters(subtree, emissive, instance, world_from_subtree, motion, first->group,
                 lowering->spectra, flat(), first);
    lights_are_old = true;
  }

  /// Updates the world's bounds, and the lights, if these depend on what has changed.
  void world_may_have_changed() {
    const WorldRecord before = flat().world;
    set_world_bounds(top().tree, flat().world);
    if (!same_bytes(before, flat().world)) {
      changes.world.add(0, 1);
      if (!scene.lights.empty()) lights_are_old = true;
    }
    if (lights_are_old) lower_lights_again();
  }

  void lower_lights_again() {
    FlatScene& to = flat();
    const auto lights = to.lights;
    const auto data = to.light_data;
    const auto alias = to.light_alias;
    const auto nodes = to.light_nodes, places = to.light_places;
    const LightingRecord lighting = to.lighting;
    lower_lights(scene, geometry().emitters, lowering->spectra, lowering->light_images, to);
    add_differences(lights, to.lights, changes.lights);
    add_differences(data, to.light_data, changes.light_data);
    add_differences(alias, to.light_alias, changes.light_alias);
    add_differences(nodes, to.light_nodes, changes.light_nodes);
    add_differences(places, to.light_places, changes.light_places);
    if (!same_bytes(lighting, to.lighting)) changes.lighting.add(0, 1);
    if (lowering->light_images.has_changed()) {
      changes.light_texels.add(0, to.light_texels.size());
      changes.light_cdf.add(0, to.light_cdf.size());
    }
    lights_are_old = false;
  }

  static bool is_displacement(const SceneEdit& edit) {
    return std::holds_alternative<CapsuleEdit>(edit) ||
           std::holds_alternative<TransformEdit>(edit) ||
           std::holds_alternative<InstanceEdit>(edit);
  }

  /// Returns whether an instance moves, or did, or a tree has parts of the shutter's time: then a
  /// displacement has everything lowered again.
  bool is_moving() const {
    const auto has_intervals = [](const LoweredShapes& shapes) {
      return std::ranges::any_of(shapes.subtrees,
                                 [](const Subtree& one) { return one.tree.intervals > 1; });
    };
    return has_intervals(lowering->geometry.world) ||
           std::ranges::any_of(lowering->geometry.objects, has_intervals) ||
           std::ranges::any_of(scene.instances,
                               [](const Instance& one) { return !one.motion.empty(); }) ||
           std::ranges::any_of(lowering->geometry.placed,
                               [](const PlacedSubtree& one) { return one.motion.has_value(); });
  }

  /// Returns whether other surfaces may separate media afterwards, or in another order of size.
  bool parts_media(const SceneEdit& edit, const SceneEdit& before) const {
    const auto passes = [](const SceneEdit& one) {
      const auto* material = std::get_if<MaterialEdit>(&one);
      return material && std::holds_alternative<InterfaceMaterial>(material->to);
    };
    const bool displaces = is_displacement(edit);
    return (displaces && !lowering->flat.boundaries.empty()) || passes(edit) != passes(before);
  }

  bool has_bad_tree() const {
    const auto is_bad = [&](const Subtree& subtree) {
      return subtree.size() >= rebuilt_from_primitives &&
             trees->cost_growth(subtree) > rebuilt_at_growth;
    };
    const LoweredGeometry& all = lowering->geometry;
    return std::ranges::any_of(all.world.subtrees, is_bad) ||
           std::ranges::any_of(all.objects, [&](const LoweredShapes& object) {
             return std::ranges::any_of(object.subtrees, is_bad);
           });
  }

  SceneEdit put(const SceneEdit& edit) {
    SceneEdit before = inverse(scene, edit);
    put_edit(scene, edit);
    try {
      const std::size_t spectra = flat().spectra.size(), tables = flat().spectrum_tables.size();
      const bool followed = !parts_media(edit, before) && !(is_displacement(edit) && is_moving()) &&
                            std::visit(
                                [&](const auto& one) {
                                  return follow(one, std::get<std::decay_t<decltype(one)>>(before));
                                },
                                edit);
      if (!followed || has_bad_tree()) {
        lower_all();
        return before;
      }
      changes.spectra.add(spectra, flat().spectra.size() - spectra);
      changes.spectrum_tables.add(tables, flat().spectrum_tables.size() - tables);
      return before;
    } catch (...) {
      put_edit(scene, before);
      lower_all();
      throw;
    }
  }

  Scene scene;
  Linking linking;
  std::unique_ptr<Lowering> lowering;
  std::unique_ptr<TreeEdit> trees;
  SceneChanges changes;
  std::uint64_t lowerings = 0;
  bool lights_are_old = false;
};

LiveScene::LiveScene(Scene scene, const Linking& linking)
    : state_(std::make_unique<State>(std::move(scene), linking)) {
  state_->changes = {};
}
LiveScene::LiveScene(LiveScene&&) noexcept = default;
LiveScene& LiveScene::operator=(LiveScene&&) noexcept = default;
LiveScene::~LiveScene() = default;

const Scene& LiveScene::scene() const { return state_->scene; }
const FlatScene& LiveScene::flat() const { return state_->lowering->flat; }
FlatView LiveScene::view() const { return lower_view(state_->scene); }

SceneEdit LiveScene::edit(const SceneEdit& edit) {
  check_edit(state_->scene, edit);
  return state_->put(edit);
}
SceneEdit LiveScene::put(const SceneEdit& edit) { return state_->put(edit); }

void LiveScene::replace(Scene scene) {
  auto fresh = std::make_unique<State>(std::move(scene), state_->linking);
  fresh->lowerings += state_->lowerings;
  state_ = std::move(fresh);
}

SceneChanges LiveScene::take_changes() { return std::exchange(state_->changes, {}); }
std::uint64_t LiveScene::lowerings() const { return state_->lowerings; }

}  // namespace caplet
