// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "film/depth_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/atomic_file.h"
#include "base/error.h"
#include "film/detail/image_png.h"
#include "film/image.h"

namespace caplet {

std::vector<float> depths_of(const Film& film, const std::optional<DepthPlane>& plane) {
  std::vector<float> out(film.layout().window.pixels());
  for (std::size_t pixel = 0; pixel < out.size(); ++pixel) {
    const double hits = film.sum(Layer::coverage, 0, pixel);
    if (!(hits > 0)) {
      out[pixel] = std::numeric_limits<float>::quiet_NaN();
    } else if (plane) {
      // It is linear, so that the depth of the mean position is the mean depth.
      double depth = plane->at(3);
      for (const std::size_t c : {0U, 1U, 2U})
        depth += plane->at(c) * film.sum(Layer::position, c, pixel) / hits;
      out[pixel] = static_cast<float>(depth);
    } else {
      out[pixel] = static_cast<float>(film.sum(Layer::depth, 0, pixel) / hits);
    }
  }
  return out;
}

std::vector<std::uint16_t> depth_steps(const std::vector<float>& depths, double unit,
                                       std::size_t& beyond) {
  std::vector<std::uint16_t> out(depths.size());
  beyond = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double steps = std::round(double{depths[i]} / unit);
    if (steps >= 1 && steps <= 65535)
      out[i] = static_cast<std::uint16_t>(steps);
    else if (!std::isnan(depths[i]))
      ++beyond;
  }
  return out;
}

std::size_t write_depth(const DepthPicture& picture, const FilmLayout& layout,
                        const std::function<Film(int first, int count)>& rows,
                        const std::map<std::string, std::string>& attributes) {
  std::vector<float> depths;
  const int step = band_rows(layout.window.width, 2 * layout.words_per_pixel());
  for (int first = 0; first < layout.window.height; first += step) {
    const std::vector<float> some =
        depths_of(rows(first, std::min(step, layout.window.height - first)), picture.plane);
    depths.insert(depths.end(), some.begin(), some.end());
  }
  if (picture.path.extension() == ".png") {
    std::size_t beyond = 0;
    std::string bytes;
    const std::string why =
        image_files::encode_grey_png(layout.window.width, layout.window.height,
                                     depth_steps(depths, picture.unit, beyond), bytes);
    if (!why.empty()) throw RunError(fmt::format("{}: {}", picture.path.string(), why));
    write_bytes(picture.path, bytes);
    return beyond;
  }
  LayeredImage image = image_of(layout);
  image.metadata = attributes;
  image.channels.push_back({"Z", std::move(depths), {}});
  write_exr(picture.path, image);
  return 0;
}

}  // namespace caplet
