// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cmath>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "scene/field.h"
#include "scene/lights/unit.h"
#include "scene/spectrum.h"

namespace caplet {

/// The intensity distribution of a luminaire (ANSI/IES LM-63, type C). Angles are in radians and
/// ascend; intensity is linear between them and zero beyond the polar angles.
struct IesProfile {
  std::vector<double> polar;     // measured from the light's -z; at least 2
  std::vector<double> azimuths;  // from +x towards +y: 0 to 2 pi, or a single one for all
  std::vector<double> candela;   // the values at all polar angles, one azimuth after the other
  std::string file = {};         // the file that it was read from

  /// Returns the lumens: the integral of the intensity over all directions.
  double flux() const {
    double sum = 0;
    for (std::size_t j = 0; j < azimuths.size(); ++j) {
      // The trapezoidal rule over the azimuth is exact for linear intensity.
      const double before = j > 0 ? azimuths[j] - azimuths[j - 1] : 0;
      const double behind = j + 1 < azimuths.size() ? azimuths[j + 1] - azimuths[j] : 0;
      const double around = azimuths.size() == 1 ? 2 * std::numbers::pi : (before + behind) / 2;
      for (std::size_t i = 0; i + 1 < polar.size(); ++i) {
        const double a = polar[i], b = polar[i + 1], low = candela[j * polar.size() + i],
                     high = candela[j * polar.size() + i + 1];
        // Integrates (low + slope (t - a)) sin t by parts.
        const double slope = (high - low) / (b - a);
        sum +=
            around * (low * std::cos(a) - high * std::cos(b) + slope * (std::sin(b) - std::sin(a)));
      }
    }
    return sum;
  }
};

struct IesLight {
  Spectrum intensity = ConstantSpectrum{1};  // multiplied by each candela value
  std::shared_ptr<const IesProfile> profile;
  glm::dvec3 position{0};          // world
  glm::dmat3 world_from_light{1};  // rotation, possibly mirroring

  static constexpr LightUnit unit = LightUnit::power;
  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.emission({"I", "radiant intensity for each candela", 0}, self.intensity);
    visit.place(self.position, self.world_from_light);
    visit.profile({"filename", "the luminaire's IES profile"}, self.profile);
  }
  double per_unit() const { return profile->flux(); }
  LightReach reach() const {
    return {position, {0, 0, 1}, std::numbers::pi, 0, 4 * std::numbers::pi};
  }
  template <class Put>
  void data(Put&& put) const {
    put("position", position);
    put("light_from_world", world_from_light);
    put("profile", profile);
  }
};

}  // namespace caplet
