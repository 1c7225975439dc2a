// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/figure.h"

#include <fmt/format.h>

#include <vector>

#include "base/error.h"
#include "film/preview.h"
#include "lower/lower.h"
#include "post/overlay_options.h"
#include "present/least_width.h"
#include "present/picture_options.h"
#include "render/session.h"
#include "report/denoised.h"
#include "scene/edit.h"
#include "view/detail/shown_view.h"

namespace caplet::view {

namespace {

/// Pages may not name files.
class NoFiles : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    throw InputError(SourceLocation{"background"},
                     fmt::format("'{}' is neither 'transparent' nor a colour", path.string()));
  }
};

LayeredImage developed_picture(const Film& film, const FilmSettings& settings, Layers layers) {
  PictureFlaws flaws;
  const BandedImage bands = report::developed(film, settings, layers, flaws);
  return bands.band(0, bands.whole.data_height);
}

}  // namespace

std::string figure_png(Scene scene, const View& own, const MakeFigure& asked, const Device& device,
                       const std::function<bool(double share)>& goes_on) {
  scene.view = shown_view(own, asked.look, 1, 0);
  FilmSettings& film = scene.view.film;
  scene.view.sampler.samples_per_pixel = asked.samples;
  film.denoise = asked.denoise;
  if (asked.background) film.backdrop = parse_backdrop(*asked.background, NoFiles(), "background");
  if (asked.exposure) film.exposure = parse_exposure(*asked.exposure, "exposure");
  post::Overlays overlays;
  for (const auto& [name, value] : asked.drawn) post::set_overlay(overlays, name, value, name);
  check_edit(Scene(), scene.view);
  const post::Sight sight(scene);
  post::check(overlays, sight, "");
  widen_to_least(scene);

  const FlatScene flat = lower(scene);
  SessionOptions options;
  options.layers = overlays.layers();
  if (asked.denoise)
    options.layers = Layers::of_bits(options.layers.bits() | report::denoising_layers().bits());
  options.most_samples = static_cast<std::uint32_t>(asked.samples);
  Session session(flat, lower_view(scene), std::vector<Device>{device}, options);
  bool is_ended = false;
  session.render(options.most_samples, [&](const SessionProgress& progress) {
    if (goes_on(progress.fraction)) return;
    is_ended = true;
    session.cancel();
  });
  if (is_ended) return {};
  const LayeredImage image = developed_picture(session.film(), film, options.layers);
  Shown picture = shown(image);
  if (overlays.any()) post::draw(picture, image, sight, overlays);
  return png_bytes(picture);
}

}  // namespace caplet::view
