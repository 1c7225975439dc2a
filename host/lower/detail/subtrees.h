// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is what lowering knows of a scene's geometry beside the flat arrays: which tree holds what,
// and where it is placed. Edits use it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <glm/mat4x4.hpp>
#include <optional>
#include <vector>

#include "lower/detail/emitter.h"
#include "lower/detail/images.h"
#include "lower/detail/linked_capsules.h"
#include "lower/encode.h"
#include "lower/flat_primitive.h"
#include "lower/flat_scene.h"
#include "lower/motion.h"
#include "lower/spectrum.h"
#include "scene/scene.h"

namespace caplet {

/// Subtree is one tree: primitives in its space, and the shapes that emissive ones come from.
struct Subtree {
  glm::dmat4 placed{1};  // object_from_subtree
  uint flags = 0;        // of its instances
  /// Primitives are by id; after them, in the world's first subtree, come the instances. Loose and
  /// linked capsules are none of them.
  std::vector<FlatPrimitive> primitives;
  LooseCapsules loose;
  TreeLinks linked;
  std::vector<const Shape*> shapes;  // those that gave primitives
  struct Emissive {
    std::size_t first, count;  // a range of `primitives`
    const Shape* shape;
    std::size_t offset;  // of the first in GeometryRecord.light_offset
  };
  std::vector<Emissive> emissive;
  std::size_t emitter_count = 0;
  EncodedTree tree;

  std::size_t size() const { return primitives.size() + loose.size() + linked.size(); }
};

/// PlacedSubtree is an instance record: a subtree as placed, by the number of the record.
struct PlacedSubtree {
  const Subtree* subtree;
  std::uint32_t instance;
  glm::dmat4 world_from_subtree;
  std::uint32_t scene_instance;  // index into Scene::instances; CAPLET_NONE: a subtree of the world
  std::size_t top;               // index into the primitives of the world's first subtree
  std::optional<MotionPath> motion = {};  // world_from_subtree, of one that moves
};

/// Lengths holds the lengths of the arrays that shapes add to.
struct Lengths {
  std::size_t geometries = 0, primitives = 0, surfaces = 0, indices = 0, normals = 0, uvs = 0,
              leaves = 0;
};

/// ShapeExtent is a shape's range of the flat arrays: from `begin` on up to `end`. `subtree` is
/// null where it gave nothing.
struct ShapeExtent {
  Subtree* subtree = nullptr;
  std::size_t first = 0;    // of its primitives in the subtree
  bool has_linked = false;  // some of its capsules are linked
  Lengths begin, end;
};

/// LoweredShapes holds shapes of the world or of one object. Parts stay where they are when this is
/// moved; a copy would refer to the first's.
struct LoweredShapes {
  LoweredShapes() = default;
  LoweredShapes(LoweredShapes&&) = default;
  LoweredShapes& operator=(LoweredShapes&&) = default;
  std::deque<Subtree> subtrees;  // the first holds what is baked into the common space; then one
                                 // for each transform that cannot be
  std::vector<ShapeExtent> extents;  // by shape
};

struct LoweredGeometry {
  LoweredShapes world;
  std::vector<LoweredShapes> objects;
  std::vector<PlacedSubtree> placed;
  std::vector<Emitter> emitters;  // in the order of their lights
};

/// SubtreeKey decides the subtree that a shape belongs to, and the matrix under which it is stored
/// there.
struct SubtreeKey {
  glm::dmat4 placed{1};
  uint flags = 0;
  glm::dmat4 baked{1};
  /// Returns whether the shape needs no subtree of its own.
  bool is_common() const { return placed == glm::dmat4(1) && flags == 0; }
  bool same_subtree(const SubtreeKey& other) const {
    return placed == other.placed && flags == other.flags;
  }
};
SubtreeKey subtree_key(const Shape& shape, const glm::dmat4& world_from_object);

/// Returns the record of a subtree as placed; `object`: InstanceRecord.object.
InstanceRecord instance_record(const Subtree& subtree, const glm::dmat4& world_from_subtree,
                               std::uint32_t object);
/// Writes the box of an instance into its primitive of the top tree. `motion`: its path, from one
/// time to another; null: it rests.
void set_instance_box(const Subtree& subtree, const glm::dmat4& world_from_subtree,
                      const MotionPath* motion, FlatPrimitive& instance, float begin = 0,
                      float end = 1);

/// Sets the lights of an emissive shape of a subtree as placed, one for each of its primitives.
void set_emitters(const Subtree& subtree, const Subtree::Emissive& emissive, std::uint32_t instance,
                  const glm::dmat4& world_from_subtree, const MotionPath* motion,
                  std::uint32_t group, SpectrumTable& spectra, const FlatScene& flat, Emitter* out);

/// Sets the bounding sphere of the world; it is the unit sphere where the tree is empty, so that
/// lights have a power.
void set_world_bounds(const EncodedTree& tree, WorldRecord& world);

/// Lowers one shape by itself into empty arrays `out` under `baked`: its primitives, with ids from
/// 0 on.
Subtree lower_shape_alone(const Scene& scene, const Shape& shape, const glm::dmat4& baked,
                          std::uint32_t object, const ImageNumbers& images, SpectrumTable& spectra,
                          FlatScene& out);

}  // namespace caplet
