// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/spelling.h"
#include "base/threads.h"
#include "film/deep.h"
#include "film/denoise.h"
#include "film/preview.h"
#include "library/detail/inside.h"
#include "post/overlay.h"
#include "post/overlay_options.h"
#include "report/bands.h"
#include "report/denoised.h"
#include "report/mattes.h"
#include "scene/matte_names.h"

namespace caplet::v0 {

namespace {

const Channel& channel_of(const LayeredImage& image, const std::string& name) {
  if (const Channel* channel = image.find(name)) return *channel;
  std::vector<std::string> names;
  for (const Channel& channel : image.channels) names.push_back(channel.name);
  throw InputError(fmt::format("there is no channel '{}'; the nearest is '{}'", name,
                               nearest_name(name, names)));
}

Layer layer_of(Matte matte) { return matte_layers.at(static_cast<std::size_t>(matte)); }

void check_has(const caplet::Film& film, Layer layer) {
  if (!film.layout().layers.has(layer))
    throw InputError(
        fmt::format("the film was rendered without the layer {}", row_of(layer).option));
}

}  // namespace

Film::Film(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
Film::Film(const Film&) = default;
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(const Film&) = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

const Film::Data& Film::developed() const {
  std::call_once(data_->once, [&] {
    PictureFlaws flaws;
    LayeredImage image = report::whole_of(report::developed(
        data_->saved.film, data_->saved.settings, data_->saved.film.layout().layers, flaws));
    flaws.warn();
    image.metadata = data_->saved.notes;
    if (data_->saved.settings.denoise) image.metadata["caplet.denoiser"] = denoiser_name();
    data_->image = std::move(image);
  });
  return *data_;
}

int Film::width() const { return data_->saved.film.layout().window.width; }
int Film::height() const { return data_->saved.film.layout().window.height; }
int Film::x() const { return data_->saved.film.layout().window.x; }
int Film::y() const { return data_->saved.film.layout().window.y; }
int Film::samples_per_pixel() const {
  return static_cast<int>(std::lround(data_->saved.film.mean_samples()));
}

std::vector<SampleRange> Film::samples() const {
  std::vector<SampleRange> out;
  for (const FilmPart& part : data_->saved.film.parts())
    out.push_back({part.sample_begin, part.sample_count});
  std::ranges::sort(out, {}, &SampleRange::first);
  return out;
}

void Film::add(const Film& other) {
  SavedFilm sum = data_->saved;
  caplet::add(sum, other.data_->saved);
  *this = Inside::film(std::move(sum), data_->sight ? data_->sight : other.data_->sight,
                       data_->render_seconds + other.data_->render_seconds);
}

void Film::save(const std::filesystem::path& file) const { save_film(file, data_->saved); }

Film Film::load(const std::filesystem::path& file) {
  return Inside::film(load_film(file), nullptr, 0);
}

Film Film::load(const std::filesystem::path& file, const Scene& scene) {
  const caplet::Scene& model = *Inside::model(scene);
  SavedFilm saved = load_film(file);
  saved.settings = model.view.film;
  return Inside::film(std::move(saved), std::make_shared<const post::Sight>(model), 0);
}

std::vector<std::string> Film::channels() const {
  std::vector<std::string> out;
  for (const Channel& channel : developed().image.channels) out.push_back(channel.name);
  return out;
}

std::vector<float> Film::values(const std::string& channel) const {
  const Channel& found = channel_of(developed().image, channel);
  if (found.floats.empty()) throw InputError(fmt::format("channel '{}' holds ids", channel));
  return found.floats;
}

std::vector<std::uint32_t> Film::ids(const std::string& channel) const {
  const Channel& found = channel_of(developed().image, channel);
  if (found.uints.empty()) throw InputError(fmt::format("channel '{}' holds no ids", channel));
  return found.uints;
}

std::vector<std::string> Film::matte_names(Matte matte) const {
  check_has(data_->saved.film, layer_of(matte));
  return report::names_in_matte(data_->saved.notes, layer_of(matte));
}

std::vector<float> Film::matte(Matte matte, const std::string& name) const {
  const std::vector<std::string> names = matte_names(matte);
  if (std::ranges::find(names, name) == names.end())
    throw InputError(fmt::format("there is no '{}' in the matte; the nearest is '{}'", name,
                                 nearest_name(name, names)));
  const caplet::Film& film = data_->saved.film;
  const std::uint32_t key = matte_hash(name);
  std::vector<float> out;
  for (std::size_t pixel = 0; pixel < film.layout().window.pixels(); ++pixel) {
    double covered = 0;
    for (const Slot& slot : film.slots(layer_of(matte), pixel))
      if (slot.key == key) covered = slot.samples;
    const std::uint32_t samples = film.samples(pixel);
    out.push_back(samples > 0 ? static_cast<float>(covered / samples) : 0.0f);
  }
  return out;
}

void Film::write_deep_exr(const std::filesystem::path& file) const {
  const caplet::Film& film = data_->saved.film;
  check_has(film, Layer::deep);
  caplet::write_deep_exr(
      file, film.layout(), [&](int first, int count) { return film.rows(first, count); },
      data_->saved.notes);
}

void Film::write_exr(const std::filesystem::path& file) const {
  const LayeredImage& image = developed().image;
  const std::uint64_t bytes = std::uint64_t{4} * image.channels.size() *
                              static_cast<std::uint64_t>(image.data_width) *
                              static_cast<std::uint64_t>(image.data_height);
  caplet::write_exr(file, image, compression_for(bytes, data_->render_seconds, usable_threads()));
}

void Film::write_preview(const std::filesystem::path& file, const OverlayOptions& drawn) const {
  check_preview_format(file, "preview");
  check_preview_size(file, width(), height(), "preview");
  post::Overlays asked;
  for (const auto& [name, value] : drawn) post::set_overlay(asked, name, value, name);
  if (asked.any() && !data_->sight)
    throw InputError("overlays need the scene of the film: load the film with it");
  if (asked.any()) post::check(asked, *data_->sight, "");
  if (!data_->saved.film.layout().layers.has_all(asked.layers()))
    throw InputError(
        "the film does not have the layers that outlines and the depth cue are drawn from (depth, "
        "object)");
  const LayeredImage& image = developed().image;
  Shown picture = shown(image);
  if (asked.any()) post::draw(picture, image, *data_->sight, asked);
  caplet::write_preview(file, picture);
}

std::vector<Overlay> overlays() {
  std::vector<Overlay> out;
  for (const post::OverlayRow& row : post::overlay_rows())
    out.push_back({row.name, row.values, row.help});
  return out;
}

}  // namespace caplet::v0
