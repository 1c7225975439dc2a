// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera_ray.h"
#include "scene/cameras/lens.h"
#include "scene/field.h"

namespace caplet {

/// A lens of several surfaces before a film, which rays pass as in the world: pbrt-v4's. Camera
/// units are metres, and the camera stands where its film is.
struct RealisticProjection {
  std::shared_ptr<const Lens> lens;              // null: plain_lens()
  std::shared_ptr<const ApertureMask> aperture;  // null: round
  double aperture_diameter = 1;                  // mm
  double focus_distance = 10;

  static constexpr bool has_window = false, has_plane = false, is_parallel = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit.lens(
        {"lensfile", "the lens: radius, thickness, index and diameter of each surface, in mm"},
        self.lens);
    visit.number({"aperturediameter", "diameter of the stop", 0, no_limit, "mm", true},
                 self.aperture_diameter);
    visit.number({"focusdistance", "distance from the film to what is sharp", 0, no_limit,
                  "camera units", true},
                 self.focus_distance);
    visit.aperture({"aperture",
                    "form of the stop: \"gaussian\", \"pentagon\", \"square\", "
                    "\"star\" or an image; else it is round"},
                   self.aperture);
  }

  double plane_scale() const { return 1; }
  std::uint32_t mapping() const { return 0; }
  /// Returns the film as places: where it lies behind the lens, turned the right way round.
  /// `film`: its size in pixels; `diagonal`: mm.
  std::array<double, 4> plane(const glm::dvec2& film, double diagonal) const;
  std::string problem() const {
    std::string said;
    focused(said);
    return said;
  }
  /// Returns what kernels/camera/realistic.cl reads.
  std::vector<float> table(double diagonal) const;
  /// Returns the lens in focus; nothing, with the reason, where it cannot be.
  std::optional<FocusedLens> focused(std::string& problem) const;
  /// The chief ray, as it leaves the lens.
  CameraRay ray(const glm::dvec2& place) const;
  std::optional<glm::dvec2> place(const glm::dvec3& point) const;
  /// As a pinhole has it that makes pictures of the same size.
  double footprint(const glm::dvec3& point, const glm::dvec2& pixel) const;
};

}  // namespace caplet
