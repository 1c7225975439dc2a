// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Random primitives and rays from fixed seeds.
#pragma once

#include <glm/mat4x4.hpp>
#include <random>
#include <vector>

#include "lower/encode.h"
#include "shared/kinds.h"
#include "shared/records.h"
#include "support/test_scale.h"

namespace caplet::test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float uniform(float low, float high) {
    return low + (high - low) * (static_cast<float>(engine_() >> 8) * 0x1p-24f);
  }
  unsigned below(unsigned n) { return static_cast<unsigned>(engine_() % n); }

 private:
  std::mt19937 engine_;
};

/// The kinds that these tests make and that brute.h knows; the others: tests/shapes.
inline constexpr unsigned random_kinds[] = {shape_sphere, shape_capsule, shape_tapered_capsule,
                                            shape_triangle, shape_disk};

/// One primitive of the kind, in about [-1, 1]^3, of about `size`.
FlatPrimitive random_primitive(Random& random, unsigned shape, float size);
/// `count` primitives of one kind, or, with shape_instance, of all these kinds mixed.
std::vector<FlatPrimitive> random_scene(unsigned seed, unsigned shape, unsigned count, float size);
/// Rays from around and inside [-1, 1]^3, of all lengths.
std::vector<RayRecord> random_rays(unsigned seed, int count);

struct Encoded {
  std::vector<float> nodes, leaves;
  EncodedTree tree;
};
Encoded encode(const std::vector<FlatPrimitive>& primitives, int kind_bits = CAPLET_LEAF_KIND_BITS);

/// One object, placed many times among primitives of the world.
struct PlacedScene {
  std::vector<float> nodes, leaves;
  std::vector<FlatPrimitive> of_object, of_world;
  EncodedTree object, world;  // the world's slots: first those of of_world
  std::vector<InstanceRecord> instances;
};
/// Its placement, and the inverse.
void place(InstanceRecord& instance, const glm::dmat4& world_from_object);
/// All kinds in the object, capsules in the world, within about [-6, 6]^3; turned, stretched by up
/// to 4 in each direction and, every other one, mirrored.
PlacedScene placed_scene(unsigned seed, unsigned instance_count);

}  // namespace caplet::test
