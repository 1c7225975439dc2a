// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What a page says is refused with the field that is wrong, or is within all that is promised of
// it; and as the line that a journal keeps it says the same.
#include "view/messages.h"

#include <nlohmann/json.hpp>
#include <string>

#include "target.h"

namespace {

using namespace caplet::view;
using caplet::test::require;

bool is_finite(const glm::dmat4& matrix) {
  for (int i = 0; i < 16; ++i)
    if (!std::isfinite(matrix[i % 4][i / 4])) return false;
  return true;
}

bool is_finite(const glm::dvec3& point) {
  return std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z);
}

void check_ids(const std::vector<std::uint32_t>& ids) {
  require(!ids.empty() && ids.size() <= most_chosen);
  for (std::size_t i = 1; i < ids.size(); ++i) require(ids[i - 1] < ids[i]);
}

void check(const Message& message) {
  if (const auto* look = std::get_if<ShowView>(&message)) {
    require(look->width >= 1 && look->width <= most_page_pixels && look->height >= 1 &&
            look->height <= most_page_pixels);
    require(is_finite(look->world_from_camera) && look->fov > 0 && look->fov < 3.1416);
    require(look->lens_radius >= 0 && look->focal_distance > 0 &&
            std::isfinite(look->lens_radius + look->focal_distance));
  } else if (const auto* ask = std::get_if<Ask>(&message)) {
    require(ask->x >= 0 && ask->x < most_page_pixels && ask->y >= 0 && ask->y < most_page_pixels &&
            std::isfinite(ask->number));
  } else if (const auto* save = std::get_if<Save>(&message)) {
    require(!save->name || save->name->size() <= longest_name);
  } else if (const auto* edit = std::get_if<Edit>(&message)) {
    std::visit(
        [](const auto& change) {
          if constexpr (requires { change.ids; }) check_ids(change.ids);
          if constexpr (requires { change.world_from_world; })
            require(is_finite(change.world_from_world));
          if constexpr (requires { change.p0; })
            require(is_finite(change.p0) && is_finite(change.p1) && change.radius0 >= 0 &&
                    change.radius1 >= 0);
          if constexpr (requires { change.by; }) require(is_finite(change.by));
        },
        edit->change);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::run_target([&] {
    const std::string text(reinterpret_cast<const char*>(data), size);
    const Message message = parse_message(text);
    check(message);
    const std::string line = nlohmann::ordered_json::parse(text).dump();
    require(line.find('\n') == std::string::npos);
    const Message again = parse_message(line);
    require(again.index() == message.index());
    if (const auto* edit = std::get_if<Edit>(&message))
      require(std::get<Edit>(again).change.index() == edit->change.index());
    if (const auto* look = std::get_if<ShowView>(&message))
      require(std::get<ShowView>(again).world_from_camera == look->world_from_camera);
  });
}
