// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace caplet {

/// Which coordinates (s, t) a texture has at a point, as pbrt-v4 (10.2): by the surface's (u, v), or by the point in the
/// texture's space.
struct TextureMapping {
  enum class Kind { uv, spherical, cylindrical, planar, solid } kind = Kind::uv;
  double uscale = 1, vscale = 1;  // uv: (uscale u + udelta, vscale v + vdelta)
  double udelta = 0, vdelta = 0;  // planar: (v1 p + udelta, v2 p + vdelta)
  glm::dvec3 v1{1, 0, 0}, v2{0, 1, 0};
  glm::dmat4 texture_from_world{1};  // of all but uv
};
/// What scene files call them; "solid" is of textures of space alone.
inline constexpr std::array<const char*, 4> texture_mapping_names = {"uv", "spherical", "cylindrical", "planar"};

}  // namespace caplet
