// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// pbrt's graphics state: what the statements after it take from those before.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "import/detail/pbrt/parameters.h"
#include "import/detail/pbrt/target.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// A transform, and what is wrong with it.
class OneTransform {
 public:
  const glm::dmat4& matrix() const { return ctm_; }
  glm::dmat4 inverse() const;
  bool is_skewed() const { return skewed_.has_value(); }
  bool is_sound() const { return !flat_ && !skewed_; }
  void multiply(const Statement& at, const glm::dmat4& matrix);
  /// Replaces the matrix; a singular or non-affine transform before it still counts.
  void set(const glm::dmat4& ctm);
  /// Replaces the matrix by a sound one.
  void restart(const glm::dmat4& ctm);
  /// Replaces it by the inverse of `matrix`, which is sound.
  void restart_inverse(const glm::dmat4& matrix);
  /// Reports a singular or non-affine transform before something is placed with it.
  void check_place(Diagnostics& diagnostics) const;
  /// Returns the place of a light. An infinite light has no position: as in pbrt-v4, directions are
  /// mapped by the inverse, whose last row they do not use.
  glm::dmat4 place_of_light(const std::string& type, Diagnostics& diagnostics) const;

 private:
  struct Fault {
    SourceLocation where;
    std::string what;
  };
  glm::dmat4 ctm_{1};
  std::optional<Fault>
      flat_;  // the first singular transform, which was not multiplied into the matrix
  std::optional<Fault>
      skewed_;  // the first that is not affine; the matrix contains it, for directions only
  std::optional<glm::dmat4> inverse_;  // if the file states it, so that it need not be computed
};

/// The current transform at the two times of TransformTimes. Directives change those that
/// ActiveTransform names.
struct CurrentTransform {
  OneTransform start, end;
  bool start_is_active = true, end_is_active = true;

  /// Calls `change` with each active transform.
  template <class Change>
  void each_active(const Change& change) {
    if (start_is_active) change(start);
    if (end_is_active) change(end);
  }
  bool moves() const { return start.matrix() != end.matrix(); }
  /// Reports what is wrong with both; a fault of both once.
  void check_place(Diagnostics& diagnostics) const {
    (start.is_sound() ? end : start).check_place(diagnostics);
  }
};

struct GraphicsState {
  CurrentTransform transform;
  bool reverse_orientation = false;
  ColorSpace space = ColorSpace::srgb;
  std::uint32_t material = 0;  // index into MaterialDraft::uses
  std::optional<AreaEmission> emission;
  MediumSides media;  // indices into MediumDraft::uses
  std::map<std::string, SharedParameters, std::less<>> attributes;
};

/// The open blocks. An imported file cannot close those outside it.
class Blocks {
 public:
  void begin(const Statement& at, const GraphicsState& state);
  /// Returns the state that the block saved. Throws SyntaxError unless `opener` opened the last
  /// block.
  GraphicsState end(const Statement& at, std::string_view opener);
  /// Opens a file's own range of blocks. Returns the range outside, for leave().
  std::size_t enter();
  void leave(std::size_t outer) { floor_ = outer; }
  /// Closes the blocks of the range and reports them. Returns whether an object was among them.
  bool report_unclosed(Diagnostics& diagnostics);

 private:
  struct Block {
    std::string_view opener;
    SourceLocation where;
    GraphicsState saved;
  };
  std::vector<Block> blocks_;
  std::size_t floor_ = 0;  // blocks below this were opened outside the imported file
};

}  // namespace caplet::pbrt
