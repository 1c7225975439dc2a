// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scene/field.h"

namespace caplet {

/// The coordinates (s, t) of a texture at a point, as in pbrt-v4 (10.2): from the surface's (u, v),
/// or from the point in the texture's space.
struct TextureMapping {
  enum class Kind { uv, spherical, cylindrical, planar, solid } kind = Kind::uv;
  double uscale = 1, vscale = 1;  // uv: (uscale u + udelta, vscale v + vdelta)
  double udelta = 0, vdelta = 0;  // planar: (v1 p + udelta, v2 p + vdelta)
  glm::dvec3 v1{1, 0, 0}, v2{0, 1, 0};
  glm::dmat4 texture_from_world{1};  // used by all kinds but uv

  static constexpr Field kind_field = {"mapping", "where the texture coordinates (s, t) come from"};
  static constexpr Field dimension_field = {"dimension", "2, or 3 for cubes in texture space", 2,
                                            3};
  /// Visits the parameters of its kind; calls number and vector.
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    if (self.kind == Kind::uv) {
      visit.number({"uscale", "factor of u"}, self.uscale);
      visit.number({"vscale", "factor of v"}, self.vscale);
    }
    if (self.kind == Kind::planar) {
      visit.vector({"v1", "s is its dot product with the point"}, self.v1);
      visit.vector({"v2", "t is its dot product with the point"}, self.v2);
    }
    if (self.kind == Kind::uv || self.kind == Kind::planar) {
      visit.number({"udelta", "offset of s"}, self.udelta);
      visit.number({"vdelta", "offset of t"}, self.vdelta);
    }
  }
};
/// These are the names in scene files; "solid" is for three-dimensional textures.
inline constexpr std::array<const char*, 4> texture_mapping_names = {"uv", "spherical",
                                                                     "cylindrical", "planar"};

}  // namespace caplet
