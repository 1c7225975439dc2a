// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/clip.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "present/picture_options.h"
#include "present/present.h"

namespace caplet {

namespace {

std::optional<double> number_of(std::string_view text) {
  double out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(out))
    return std::nullopt;
  return out;
}

/// Returns the offset of the plane below which there is this share of the scene.
double offset_of_share(const Bounds& bounds, const glm::dvec3& normal, double share) {
  double low = INFINITY, high = -INFINITY;
  for (int corner = 0; corner < 8; ++corner) {
    const double at = glm::dot(normal, glm::dvec3(corner & 1 ? bounds.max.x : bounds.min.x,
                                                  corner & 2 ? bounds.max.y : bounds.min.y,
                                                  corner & 4 ? bounds.max.z : bounds.min.z));
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return low + share * (high - low);
}

}  // namespace

ClipPlane parse_clip(const std::string& text, const Scene& scene, const std::string& flag) {
  const auto refuse = [&](const std::string& why) -> InputError {
    return InputError(SourceLocation{flag}, "'" + text + "' " + why);
  };
  const std::size_t equals = text.find('=');
  const std::string direction = text.substr(0, equals);
  const glm::dmat4& camera = scene.view.camera.world_from_camera;
  ClipPlane out{};
  double place_to_offset = 1, origin = 0;  // offset = origin + place_to_offset * place
  if (direction == "view") {
    out.normal = -glm::normalize(glm::dvec3(camera[2]));
    origin = glm::dot(out.normal, glm::dvec3(camera[3]));
    place_to_offset = -1;
  } else if (const auto vector = three_numbers(direction)) {
    if (!(glm::length(*vector) > 0) || !std::isfinite(glm::length(*vector)))
      throw refuse("has no direction");
    out.normal = *vector / glm::length(*vector);
  } else {
    const std::string_view axis = std::string_view(direction).substr(
        direction.starts_with('-') || direction.starts_with('+') ? 1 : 0);
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z')
      throw refuse(
          "cuts along none of: x, y, z, -x, -y, -z, view, or x,y,z; behind = there may be where, "
          "as in x=1.5 or x=30%");
    out.normal = scene.world_from_file * parse_axis(direction, flag);
    if (direction.starts_with('-')) place_to_offset = -1;
  }
  if (equals == std::string::npos) {
    out.offset = offset_of_share(bounds_or_unit_of(scene), out.normal, 0.5);
    return out;
  }
  std::string_view place = std::string_view(text).substr(equals + 1);
  const bool is_share = place.ends_with('%');
  if (is_share) place.remove_suffix(1);
  const auto number = number_of(place);
  if (!number || (is_share && !(*number >= 0 && *number <= 100)))
    throw refuse("needs a number behind =, or a share from 0% to 100%");
  out.offset = is_share ? offset_of_share(bounds_or_unit_of(scene), out.normal, *number / 100)
                        : origin + place_to_offset * *number;
  if (!std::isfinite(out.offset)) throw refuse("lies too far away");
  return out;
}

}  // namespace caplet
