// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/eye_films.h"

#include <algorithm>
#include <cmath>
#include <glm/vec4.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "film/develop.h"
#include "film/exr_bytes.h"
#include "film/sample_plan.h"
#include "present/least_width.h"
#include "report/denoised.h"
#include "view/detail/figure.h"
#include "view/detail/shown_view.h"
#include "view/detail/snapshot.h"

namespace caplet::view {

namespace {

constexpr int coarsest_scale = 16;
constexpr double first_guess_paths_a_second = 5e5;
constexpr double quick_seconds = 0.05;  // for widening lines, in a picture that is hardly late then
constexpr std::size_t most_places = 64;

/// Returns some centres of capsules and spheres, in the world, spread over the scene's shapes.
std::vector<glm::dvec3> places_of_lines(const Scene& scene) {
  std::vector<glm::dvec3> out;
  const auto add = [&](const Shape& shape, const glm::dmat4& world_from_object) {
    if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
        capsules && !capsules->p0.empty()) {
      const glm::dvec3 middle(capsules->p0[capsules->p0.size() / 2]);
      out.emplace_back(world_from_object * shape.world_from_object * glm::dvec4(middle, 1));
    }
    if (std::holds_alternative<SphereShape>(shape.geometry))
      out.emplace_back(world_from_object * shape.world_from_object * glm::dvec4(0, 0, 0, 1));
  };
  for (const Shape& shape : scene.shapes) add(shape, glm::dmat4(1));
  for (const Instance& instance : scene.instances)
    for (const Shape& shape : scene.objects[instance.object].shapes)
      add(shape, instance.world_from_object);
  const std::size_t step = out.size() / most_places + 1;
  std::vector<glm::dvec3> some;
  for (std::size_t i = 0; i < out.size(); i += step) some.push_back(out[i]);
  return some;
}

/// Returns by how much of itself a pixel's footprint differs most at these places.
double change_of_footprints(const View& a, const View& b, const std::vector<glm::dvec3>& places) {
  if (a.film.least_width != b.film.least_width) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (const glm::dvec3& p : places) {
    const double before = pixel_footprint(a.camera, a.film, p),
                 now = pixel_footprint(b.camera, b.film, p);
    most = std::max(most, std::abs(now - before) / std::min(now, before));
  }
  return most;
}

SessionOptions session_options(const ViewerOptions& options, bool denoises) {
  SessionOptions out;
  out.layers = Layers::none().with(Layer::object).with(Layer::primitive).with(Layer::variance);
  if (denoises) out.layers = Layers::of_bits(out.layers.bits() | report::denoising_layers().bits());
  out.batch_paths = options.batch_paths;
  return out;
}

}  // namespace

EyeFilms::EyeFilms(LiveScene& live, const Editor& editor, const Device& device,
                   const ViewerOptions& options, bool denoises)
    : live_(live),
      editor_(editor),
      options_(options),
      session_options_(session_options(options, denoises)),
      device_(device),
      session_(live.flat(), live.view(), std::vector<Device>{device}, session_options_),
      look_(look_of_scene(live.scene())),
      paths_a_second_(first_guess_paths_a_second) {
  (void)live_.take_changes();
}

std::uint32_t EyeFilms::target() const {
  return static_cast<std::uint32_t>(
      options_.samples > 0 ? options_.samples : live_.scene().view.sampler.samples_per_pixel);
}

double EyeFilms::noise_target() const {
  return options_.noise > 0 || options_.samples > 0 ? options_.noise
                                                    : live_.scene().view.sampler.noise;
}

/// Returns whether the pictures of all eyes, with equal samples, have the noise that is asked for.
bool EyeFilms::has_little_noise() const {
  const std::size_t last = eyes() - 1;
  return noise_target() > 0 && samples_[last] >= NoiseTarget{}.least &&
         samples_[last] == samples_[0] && std::max(noise_[0], noise_[last]) <= noise_target();
}

void EyeFilms::look_with(const ShowView& look, int scale, std::size_t eye) {
  View own = live_.scene().view;
  own.camera = editor_.view().camera;
  live_.edit(shown_view(own, look, scale, static_cast<int>(eye)));
  const SceneChanges changes = live_.take_changes();
  session_.update(live_.flat(), changes, live_.view());
  eye_ = eye;
  widen(shown_view(own, look, 1, static_cast<int>(eye)), scale, !changes.empty());
}

/// Widens the scene's lines for `full`, the view of all pixels. Lines that a look makes a little
/// too wide or thin are left where widening takes long, and more so while the camera moves.
void EyeFilms::widen(const View& full, int scale, bool has_changed) {
  if (!(full.film.least_width > 0)) return wide_.reset();
  const double tolerance = !wide_ || wide_->seconds < quick_seconds ? 0 : scale > 1 ? 1e9 : 0.1;
  const Clock::time_point start = Clock::now();
  const bool stays =
      wide_ && !has_changed && change_of_footprints(wide_->view, full, wide_->places) <= tolerance;
  if (stays) {
    wide_->live.edit(live_.scene().view);
  } else {
    Scene scene = live_.scene();
    scene.view = full;
    widen_to_least(scene);
    scene.view = live_.scene().view;
    if (wide_)
      wide_->live.replace(std::move(scene));
    else
      wide_ = std::make_unique<Wide>(std::move(scene), device_, session_options_);
    wide_->view = full;
    wide_->places = places_of_lines(live_.scene());
  }
  wide_->session.update(wide_->live.flat(), wide_->live.take_changes(), wide_->live.view());
  if (!stays) wide_->seconds = seconds_since(start);
}

EyeFilms::Wide::Wide(Scene scene, const Device& device, const SessionOptions& options)
    : live(std::move(scene)),
      session(live.flat(), live.view(), std::vector<Device>{device}, options) {
  (void)live.take_changes();
}

/// Starts the film of `look` with a pixel for each square of `scale` pixels.
void EyeFilms::set_film(const ShowView& look, int scale) {
  look_with(look, scale, 0);
  scale_ = scale;
  samples_ = {0, 0};
  noise_.fill(std::numeric_limits<double>::infinity());
  films_ = {};
}

/// Switches to the other eye of a pair and resumes its film.
void EyeFilms::change_eyes() {
  films_[eye_] = drawn().film();
  look_with(look_, scale_, 1 - eye_);
  if (samples_[eye_] > 0) drawn().resume(std::move(*films_[eye_]));
}

void EyeFilms::begin(const ShowView& look) {
  drop();
  const double pixels = static_cast<double>(look.width) * look.height;
  const double affordable = std::max(1.0, options_.coarse_seconds * paths_a_second_);
  first_scale_ =
      std::clamp(static_cast<int>(std::ceil(std::sqrt(pixels / affordable))), 1, coarsest_scale);
  set_film(look, first_scale_);
  look_ = look;
  ++view_;
  begun_ = Clock::now();
}

std::uint32_t EyeFilms::samples_of_step(std::size_t eye, double pixels) const {
  if (scale_ != 1) return 1;
  if (eye == 1) return samples_[0] - samples_[1];
  const double affordable = options_.step_seconds * paths_a_second_ / pixels;
  return std::clamp(static_cast<std::uint32_t>(affordable), 1u,
                    std::max(1u, std::min(samples_[0], target() - samples_[0])));
}

void EyeFilms::step(const std::function<void(bool is_first)>& between_batches) {
  const bool both = samples_[0] > 0 && (eyes() == 1 || samples_[1] > 0);
  // A film between the first one and that of all pixels costs a quarter of the latter at most.
  if (scale_ == 0 || (scale_ > 1 && both))
    set_film(look_, scale_ > 3 && scale_ == first_scale_ ? (scale_ + 1) / 2 : 1);
  const std::size_t eye = eyes() == 2 && samples_[1] < samples_[0] ? 1 : 0;
  if (eye != eye_) change_eyes();
  const double pixels =
      static_cast<double>(live_.scene().view.film.width) * live_.scene().view.film.height;
  const std::uint32_t count = samples_of_step(eye, pixels);
  const bool is_first = scale_ > 1 && scale_ == first_scale_;
  const Clock::time_point start = Clock::now();
  drawn().render(count, [&](const SessionProgress&) { between_batches(is_first); });
  const double seconds = std::max(1e-4, seconds_since(start));
  paths_a_second_ = 0.5 * (paths_a_second_ + pixels * count / seconds);
  samples_[eye_] += count;
}

Film EyeFilms::film(std::size_t eye) {
  return eye == eye_ ? drawn().film() : films_.at(eye).value();
}

NoisyImage EyeFilms::noisy(std::size_t eye) {
  FilmSettings settings = live_.scene().view.film;
  NoisyImage out;
  out.backdrop = std::exchange(settings.backdrop, {});
  out.image = develop(film(eye), settings, session_options_.layers);
  out.samples = samples(eye);
  out.eye = eye;
  return out;
}

Picture EyeFilms::picture(std::size_t eye) {
  PictureFlaws flaws;
  FilmSettings settings = live_.scene().view.film;
  const bool has_alpha = is_put_under_by_page(settings.backdrop);
  if (has_alpha) settings.backdrop.reset();
  const LayeredImage image = develop(film(eye), settings, session_options_.layers, flaws);
  Picture out = shown_of(image, is_full(), has_alpha);
  const std::optional<double> noise =
      flaws.noise.in({live_.scene().view.sampler.space(), settings.exposure});
  out.noise = static_cast<float>(noise.value_or(0));
  noise_[eye] = noise.value_or(std::numeric_limits<double>::infinity());
  out.version = ++version_;
  out.view = view_;
  out.eye = static_cast<int>(eye);
  out.scale = scale_;
  out.samples = samples_[eye];
  return out;
}

std::string EyeFilms::snapshot() {
  return exr_bytes(develop(film(0), live_.scene().view.film, session_options_.layers));
}

std::string EyeFilms::figure(const MakeFigure& asked,
                             const std::function<bool(double share)>& goes_on) {
  return figure_png(live_.scene(), editor_.view(), asked, device_, goes_on);
}

}  // namespace caplet::view
