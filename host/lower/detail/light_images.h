// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Fills light_texels and light_cdf, with each picture once however many lights have it.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <memory>
#include <vector>

#include "lower/detail/environment.h"
#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// LoweredPicture is a picture of lights.def, with its integrals.
struct LoweredPicture {
  std::array<std::uint32_t, 5> field{};  // of the type `picture`
  EnvironmentIntegrals integrals;        // of skies and portals
  double mean = 0;                       // luminance of colours, or grey
};

class LightImages {
 public:
  /// These begin and end a round of lowering. Pictures that are requested in the order of the last
  /// round stay where they were.
  void begin();
  void end(FlatScene& out);
  /// Returns whether the last round has changed light_texels or light_cdf.
  bool has_changed() const { return has_changed_; }

  // The references hold until the next call.

  const LoweredPicture& sky(const std::shared_ptr<const EnvironmentImage>& image, FlatScene& out);
  const LoweredPicture& picture(const LightPicture& picture, FlatScene& out);
  const LoweredPicture& profile(const std::shared_ptr<const IesProfile>& profile, FlatScene& out);
  /// Returns the light's image as it is seen through the portal, or, without an image, one
  /// radiance.
  const LoweredPicture& portal(const InfiniteLight& light, FlatScene& out);

 private:
  enum class Use { sky, color, grey, profile, portal };
  struct Entry {
    Use use;
    std::shared_ptr<const void> of;
    glm::dmat3 turn{1};  // of a portal: image_from_portal
    LoweredPicture picture;
    std::size_t texels_begin = 0, cdf_begin = 0;
  };
  template <class Make>
  const LoweredPicture& find(Use use, const std::shared_ptr<const void>& of, const glm::dmat3& turn,
                             FlatScene& out, Make&& make);

  std::vector<Entry> entries_;
  std::size_t asked_ = 0;  // of this round
  bool has_changed_ = false;
};

/// Returns the rows of the portal's space in the world: along p0 p3, along p0 p1, and the direction
/// in which it is seen.
glm::dmat3 portal_from_world(const LightPortal& portal);

}  // namespace caplet
