// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What light_texels and light_cdf hold, each once however many lights have it.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <memory>
#include <vector>

#include "lower/detail/environment.h"
#include "lower/flat_scene.h"
#include "scene/scene.h"

namespace caplet {

/// A picture of lights.def, and what is known of it.
struct LoweredPicture {
  std::array<std::uint32_t, 5> field{};  // of the type `picture`
  EnvironmentIntegrals integrals;        // of skies and portals
  double mean = 0;                       // luminance of colours, or grey
};

class LightImages {
 public:
  /// A round of lowering. What is asked for in the order of the last round stays where it was.
  void begin();
  void end(FlatScene& out);
  /// Whether the last round has changed light_texels or light_cdf.
  bool has_changed() const { return has_changed_; }

  // The references hold until the next call.

  const LoweredPicture& sky(const std::shared_ptr<const EnvironmentImage>& image, FlatScene& out);
  const LoweredPicture& picture(const LightPicture& picture, FlatScene& out);
  const LoweredPicture& profile(const std::shared_ptr<const IesProfile>& profile, FlatScene& out);
  /// The light's image as it is seen through the portal, or, without an image, one radiance.
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
  const LoweredPicture& find(Use use, const std::shared_ptr<const void>& of, const glm::dmat3& turn, FlatScene& out, Make&& make);

  std::vector<Entry> entries_;
  std::size_t asked_ = 0;  // of this round
  bool has_changed_ = false;
};

/// The rows of its space in the world: along p0 p3, along p0 p1, and the way that it is seen.
glm::dmat3 portal_from_world(const LightPortal& portal);

}  // namespace caplet
