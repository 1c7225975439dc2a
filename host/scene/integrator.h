// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "scene/field.h"
#include "shared/kinds.h"

namespace caplet {

struct IntegratorSettings {
  enum class Kind { path, ambient_occlusion, simple_path, random_walk } kind = Kind::path;
  int max_depth = 5;                                              // scattering events
  double max_distance = std::numeric_limits<double>::infinity();  // ambient occlusion, scene units
  bool cosine_sample = true;                      // ambient occlusion: else directions are uniform
  bool sample_bsdf = true, sample_lights = true;  // simple path

  /// Returns which directions paths take, and how they find lights: CAPLET_STRATEGY_... bits.
  std::uint32_t strategy() const {
    switch (kind) {
      case Kind::path:
        break;
      case Kind::ambient_occlusion:
        return CAPLET_STRATEGY_OCCLUSION | (cosine_sample ? 0 : CAPLET_STRATEGY_UNIFORM);
      case Kind::simple_path:
        return (sample_lights ? CAPLET_STRATEGY_NO_MIS : CAPLET_STRATEGY_NO_LIGHTS) |
               (sample_bsdf ? 0 : CAPLET_STRATEGY_UNIFORM);
      case Kind::random_walk:
        return CAPLET_STRATEGY_NO_LIGHTS | CAPLET_STRATEGY_UNIFORM | CAPLET_STRATEGY_SPHERE;
    }
    return 0;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    if (self.kind == Kind::ambient_occlusion) {
      visit.flag({"cossample", "directions by the cosine, else uniform"}, self.cosine_sample);
      visit.number(
          {"maxdistance", "how far what occludes may be", 0, no_limit, "scene units", true},
          self.max_distance);
      return;
    }
    visit.integer({"maxdepth", "most scattering events of a path", 0, most_integer},
                  self.max_depth);
    if (self.kind != Kind::simple_path) return;
    visit.flag({"samplebsdf", "directions by the BSDF, else uniform"}, self.sample_bsdf);
    visit.flag({"samplelights", "lights are sampled at each hit"}, self.sample_lights);
  }
};

/// Lists the names in scene files, in the order of IntegratorSettings::Kind.
inline constexpr std::array integrator_names = {"path", "ambientocclusion", "simplepath",
                                                "randomwalk"};

}  // namespace caplet
