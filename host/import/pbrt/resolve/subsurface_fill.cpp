// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes whose material is the boundary of a subsurface.
#include "import/detail/pbrt/resolve.h"

namespace caplet::pbrt {

void fill_subsurfaces(Draft& draft, const std::map<std::uint32_t, Medium>& media_within) {
  if (media_within.empty()) return;
  std::map<std::uint32_t, std::uint32_t> index_of;
  const auto visit = [&](Shape& shape) {
    bool some = false, all = true;
    std::optional<std::uint32_t> of;
    each_surface(shape, [&](std::uint32_t material) {
      const bool is_boundary = media_within.contains(material) && (!of || *of == material);
      some = some || media_within.contains(material);
      all = all && is_boundary;
      of = material;
    });
    if (!some) return;
    if (!all)
      return draft.diagnostics.error(
          shape.where, "all of a shape has one material where one is a \"subsurface\"");
    const auto [found, fresh] =
        index_of.emplace(*of, static_cast<std::uint32_t>(draft.scene.media.size()));
    if (fresh) {
      draft.scene.media.push_back(media_within.at(*of));
      if (draft.scene.media.back().name.empty()) draft.scene.media.back().name = "subsurface";
    }
    shape.media.inside = found->second;
  };
  draft.each_shape(visit);
}

}  // namespace caplet::pbrt
