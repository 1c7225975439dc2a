// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Holds capsules whose leaf blocks share their points, by their places in the scene's shapes: so
// they take no memory of their own before the blocks are written.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "lower/flat_primitive.h"
#include "lower/reference_box.h"
#include "scene/scene.h"

namespace caplet {

/// PlacedCapsules are the capsules of a shape under a similarity. They refer to the shape.
class PlacedCapsules {
 public:
  /// `scale`: similarity_scale(m).
  PlacedCapsules(const CapsulesShape& shape, const glm::dmat4& m, double scale);

  std::size_t size() const { return count_of(*shape_); }
  /// Returns capsule i, a sphere, capsule or tapered capsule, with id 0.
  FlatPrimitive operator[](std::size_t i) const;
  /// Gives back the memory of capsules `first` up to `end`.
  void release(std::size_t first, std::size_t end) const;
  bool is_chain() const { return !shape_->u.empty(); }
  /// Returns u at the ends of capsule i of a chain.
  glm::vec2 u(std::size_t i) const { return shape_->u[i]; }

 private:
  const CapsulesShape* shape_;
  std::optional<glm::dmat4> m_;  // none: the identity
  double scale_;
};

/// CapsuleRow is capsules of a shape of which each begins where the one before ends, with its
/// radius and its u.
struct CapsuleRow {
  std::uint32_t first, count;
};
/// Returns all rows of at least `least_count`, in order. Spheres are in none.
std::vector<CapsuleRow> rows_of(const PlacedCapsules& capsules, std::size_t least_count);

/// LooseCapsules are the capsules of a tree of which none is linked, where nothing needs them as
/// primitives afterwards.
class LooseCapsules {
 public:
  /// Adds a whole shape, whose ids begin with `id`. `counts`: how many there are of each kind.
  void add(const PlacedCapsules& shape, std::uint32_t id, std::span<const std::uint64_t> counts);

  std::size_t size() const { return size_; }
  /// Returns how many there are of each kind of shape.
  std::span<const std::uint64_t> counts() const { return counts_; }
  /// Returns one as a primitive.
  FlatPrimitive operator[](std::size_t i) const;

 private:
  struct Placed {
    PlacedCapsules capsules;
    std::uint32_t id;
    std::size_t first;  // its place among all
  };
  std::vector<Placed> shapes_;
  std::array<std::uint64_t, shape_count> counts_{};
  std::size_t size_ = 0;
};

/// LinkedCapsules are those of one tree, all of chains or none.
class LinkedCapsules {
 public:
  explicit LinkedCapsules(bool are_chains)
      : rows_per_block_(CAPLET_LINK_ROWS + (are_chains ? 1 : 0)) {}

  /// Begins with the capsules of a shape, whose ids begin with `id`.
  void begin(const PlacedCapsules& shape, std::uint32_t id) { shapes_.push_back({shape, id}); }
  /// Adds a row of the last shape.
  void add_row(const CapsuleRow& row);

  /// Returns the number of capsules.
  std::size_t size() const { return size_; }
  /// Returns the number of leaf blocks. Those of a row are of equal length, for their boxes are
  /// smaller so than those of full ones and a rest.
  std::size_t blocks() const { return row_of_block_.size(); }
  /// Returns how many rows of 8 floats a leaf block takes.
  std::uint32_t rows_per_block() const { return rows_per_block_; }

  /// Appends all leaf blocks (shared/shapes.h) to `leaves`, and calls `set_box` with the number and
  /// box (as reference_box) of each, from several threads. `release`: also gives back the memory of
  /// the shapes' capsules, which are then of any values.
  void append(std::vector<float>& leaves,
              const std::function<void(std::size_t block, const ReferenceBox&)>& set_box,
              bool release) const;

 private:
  struct Placed {
    PlacedCapsules capsules;
    std::uint32_t id;
  };
  struct Row {
    std::uint32_t shape, first_block;
    CapsuleRow capsules;
  };
  struct Block {
    std::size_t shape, first, end;  // of its capsules
  };
  Block block(std::size_t number) const;
  ReferenceBox box(const Block& block) const;
  void write(const Block& block, float* to) const;

  std::uint32_t rows_per_block_;
  std::vector<Placed> shapes_;
  std::vector<Row> rows_;
  std::vector<std::uint32_t> row_of_block_;
  std::size_t size_ = 0;
};

/// TreeLinks are the linked capsules of a tree, those of chains apart.
struct TreeLinks {
  std::array<LinkedCapsules, 2> by_form{LinkedCapsules(false), LinkedCapsules(true)};
  LinkedCapsules& of(const PlacedCapsules& capsules) {
    return by_form[capsules.is_chain() ? 1 : 0];
  }
  std::size_t size() const { return by_form[0].size() + by_form[1].size(); }
};

}  // namespace caplet
