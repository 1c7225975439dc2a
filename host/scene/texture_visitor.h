// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>

#include "scene/texture_image.h"
#include "scene/texture_mapping.h"
#include "scene/texture_operand.h"

namespace caplet {

/// Ignores every call of textures.def: a base of those that look at some.
struct TextureVisitor {
  void operand(const char*, const TextureOperand&) {}
  void factor(const char*, const TextureOperand&) {}
  void number(const char*, double) {}
  template <class Names>
  void choice(const char*, int, const Names&) {}
  void flag(const char*, int) {}
  void image(const std::shared_ptr<const TextureImage>&) {}
  void mapping(const TextureMapping&) {}
  void board(const TextureMapping&) {}
  void place(const glm::dmat4&) {}
  void direction(const char*, const glm::dvec3&) {}
  void count(const char*, int, int, int) {}
  void only(bool) {}
  void colors() {}
  void vectors(const std::shared_ptr<const TextureImage>&) {}
};

}  // namespace caplet
