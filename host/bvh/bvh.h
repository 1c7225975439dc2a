// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Builds binned-SAH bounding volume hierarchies over boxes in parallel, collapsed to eight children
// a node. It does not depend on shapes. Wald, "On fast construction of SAH-based bounding volume
// hierarchies", 2007; Wald, Benthin and Boulos, "Getting rid of packets", 2008 (collapse to wide
// nodes).
#pragma once

#include <cstdint>
#include <vector>

namespace caplet::bvh {

/// Reference is a box with the primitive's opaque group: a leaf holds primitives of one group only.
struct Reference {
  float min[3];
  std::uint32_t primitive;
  float max[3];
  std::uint32_t group;
};
static_assert(sizeof(Reference) == 32);

inline constexpr int width = 8;

/// child[i] >= 0 is a node index; < 0 is leaf ~child[i]; empty slots have min > max and child =
/// 0x7fffffff.
struct Node {
  float min[3][width];
  float max[3][width];
  std::int32_t child[width];
};

struct Leaf {
  std::uint32_t first;  // in Tree::order
  std::uint32_t count;  // 1..8
  std::uint32_t group;
};

struct Tree {
  std::vector<Node> nodes;  // node 0 is the root, present also for one primitive and for none;
                            // children after parents, depth-first
  std::vector<Leaf> leaves;
  std::vector<std::uint32_t> order;  // indices into the references given
  int depth = 0;                     // nodes on the longest path
  double sah = 0;  // expected node visits + leaf visits of a random line through the root box
};

/// No path of a tree is longer than this, whatever the boxes: the builder splits at the median once
/// the surface area heuristic has used up its share, so that the levels left always suffice. This
/// holds for up to 2^31 references.
inline constexpr int max_depth = 39;

/// With 65,536 and more references, `quick` uses smaller cells of a grid, and uses them farther
/// down, before it uses references one by one: a fifth less processor time for 0.4 to 0.8 % more
/// area (1 M boxes). Fewer references give the same tree.
enum class Effort { full, quick };

/// Builds the same tree for any number of threads. Boxes are finite with min <= max, groups less
/// than 64. References of the groups in `single_groups` (bit k: group k) get a leaf each. Without
/// references the tree is a root without children.
Tree build(std::vector<Reference> references, std::uint64_t single_groups = 0,
           Effort effort = Effort::full);

}  // namespace caplet::bvh
