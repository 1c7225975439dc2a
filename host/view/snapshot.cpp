// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/snapshot.h"

#include <algorithm>
#include <array>

#include "film/chromaticities.h"

namespace caplet::view {

bool is_put_under_by_page(const std::optional<Backdrop>& backdrop) {
  return backdrop && backdrop->kind != Backdrop::Kind::image;
}

Picture shown_of(const LayeredImage& image, bool ids, bool has_alpha) {
  Picture out;
  out.width = image.data_width;
  out.height = image.data_height;
  const std::vector<float>&r = image.find("R")->floats, &g = image.find("G")->floats,
        &b = image.find("B")->floats;
  std::array<double, 9> m{1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (image.space != ColorSpace::srgb)
    m = product(inverse(xyz_from_rgb(chromaticities_of(ColorSpace::srgb))),
                xyz_from_rgb(chromaticities_of(image.space)));
  out.color.resize(3 * r.size());
  for (std::size_t i = 0; i < r.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      out.color[3 * i + c] =
          to_half(static_cast<float>(m[3 * c] * r[i] + m[3 * c + 1] * g[i] + m[3 * c + 2] * b[i]));
  if (has_alpha)
    for (const float coverage : image.find("A")->floats)
      out.alpha.push_back(to_half(std::clamp(coverage, 0.0f, 1.0f)));
  if (ids) {
    out.objects = image.find("object.id")->uints;
    out.primitives = image.find("primitive.id")->uints;
  }
  return out;
}

}  // namespace caplet::view
