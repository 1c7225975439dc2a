// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/session.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "device/forked.h"
#include "library/detail/inside.h"
#include "library/detail/questions.h"
#include "library/detail/sessions.h"
#include "lower/fingerprint.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "render/known_answers.h"
#include "render/render.h"
#include "report/mattes.h"
#include "report/picture.h"

namespace caplet::v0 {

namespace {

std::vector<caplet::Device> inner(std::span<const Device> devices) {
  std::vector<caplet::Device> out;
  for (const Device& device : devices) out.push_back(Inside::device(device));
  if (out.empty()) throw InputError("a session needs a device");
  return out;
}

const std::vector<caplet::Device>& tried(const std::vector<caplet::Device>& devices,
                                         const FlatScene& flat) {
  for (const caplet::Device& device : devices)
    try_device(device, {.shapes = flat.shapes, .render = true});
  return devices;
}

}  // namespace

std::uint32_t SessionRuns::render(caplet::Session& session, std::uint32_t samples,
                                  const RenderOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const auto told = [&](const SessionProgress& progress) {
    options.progress({progress.fraction, progress.samples_per_second});
  };
  const std::uint32_t done = session.render(
      samples, options.progress ? told : std::function<void(const SessionProgress&)>(),
      options.time_limit);
  seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  interrupted = done < samples && !options.time_limit;
  return done;
}

void check_noise(const NoiseTarget& target, const SamplerSettings& sampler) {
  if (!(target.noise >= least_noise && target.noise <= 1))
    throw InputError(fmt::format("noise: {} is not from 1e-5 to 1", target.noise));
  check_range("the least samples", target.least_samples, 2, 1 << 24);
  check_range("the most samples", target.most_samples, target.least_samples, 1 << 24);
  if (!is_open_ended(sampler.kind))
    throw InputError(fmt::format(
        "noise: the sampler is {}, whose points are even at one number of samples alone; sobol and "
        "independent go with a noise",
        sampler_names.at(static_cast<std::size_t>(sampler.kind))));
}

Layers layers_with(const ExtraLayers& extra) {
  if (extra.none) {
    if (extra.cryptomatte || extra.deep)
      throw InputError("layers: none, and cryptomatte or deep, do not go together");
    return Layers::none();
  }
  Layers out = Layers::all();
  if (extra.cryptomatte) out = Layers::of_bits(out.bits() | Layers::mattes().bits());
  return extra.deep ? out.with(Layer::deep) : out;
}

double SessionRuns::render_to(caplet::Session& session, const NoiseTarget& target,
                              const RenderOptions& options) {
  if (!session.layout().layers.has(Layer::variance))
    throw InputError("noise: a picture without layers does not tell it");
  caplet::RenderOptions inner;
  inner.noise = {
      target.noise,
      static_cast<std::uint32_t>(target.least_samples),
      static_cast<std::uint32_t>(target.most_samples),
      {target.in_display ? NoiseSpace::display : NoiseSpace::relative, std::exp2(target.exposure)}};
  inner.time_limit = options.time_limit;
  const auto told = [&](const Progress& progress) {
    options.progress({progress.fraction, progress.samples_per_second});
  };
  const RenderResult result = caplet::render(
      session, {}, inner, options.progress ? told : std::function<void(const Progress&)>());
  seconds += result.render_seconds;
  interrupted = result.reached->noise > target.noise && !options.time_limit &&
                result.reached->mean_samples < target.most_samples;
  return result.reached->noise;
}

FilmOrigin SessionRuns::origin(const caplet::Session& session, const FlatScene& flat,
                               const FlatView& view, SceneFingerprint& known) {
  if (scene_hash_.empty()) {
    scene_hash_ = known.of(flat);
    view_hash_ = fingerprint(view);
  }
  return {session.layout(), scene_hash_, view_hash_};
}

void SessionRuns::resume(const SavedFilm& film) { before_ = film.notes; }

Film SessionRuns::film(caplet::Session& session, const caplet::Scene& scene, const FlatScene& flat,
                       const FlatView& view, SceneFingerprint& known) {
  if (!sight_) sight_ = std::make_shared<const post::Sight>(scene);
  SavedFilm saved;
  saved.film = session.film();
  const FilmOrigin of = origin(session, flat, view, known);
  saved.scene = of.scene;
  saved.view = of.view;
  saved.settings = scene.view.film;
  RenderResult result;
  result.samples_per_pixel = static_cast<int>(std::lround(saved.film.mean_samples()));
  result.render_seconds = seconds;
  result.interrupted = interrupted;
  result.devices = session.work();
  auto notes = report::picture_metadata(scene, scene.source, "libcaplet", result);
  notes.merge(report::matte_attributes(scene, saved.film.layout().layers));
  saved.notes = notes_together(before_, std::move(notes));
  return Inside::film(std::move(saved), sight_, seconds);
}

struct Session::Data {
  Data(const Scene& of, std::span<const Device> on, const ExtraLayers& layers)
      : devices(inner(on)),
        live(*Inside::model(of)),
        session(live.flat(), live.view(), tried(devices, live.flat()),
                {.layers = layers_with(layers)}),
        at(Inside::data(of).log.state()) {}

  void send() {
    if (live.flat().shapes != tried_shapes) tried(devices, live.flat());
    tried_shapes = live.flat().shapes;
    const SceneChanges changes = live.take_changes();
    fingerprint.note(changes);
    session.update(live.flat(), changes, live.view());
    runs = {};
  }

  Questions questions() {
    if (const auto scene = session.scene_on(0);
        scene != asked) {  // it changes when the first device is lost
      query.emplace(*scene);
      asked = scene;
    }
    return {*query, live.scene(), live.flat().shapes, session.device(0)};
  }

  std::vector<caplet::Device> devices;
  LiveScene live;
  caplet::Session session;
  std::shared_ptr<DeviceScene> asked;
  std::optional<Query> query;
  std::uint64_t at;  // the state of the scene in the session
  SceneFingerprint fingerprint;
  SessionRuns runs;
  std::uint64_t tried_shapes = live.flat().shapes;  // the shapes that the devices were tested with
};

Session::Session(const Scene& scene, const Device& device, const ExtraLayers& layers)
    : Session(scene, std::span(&device, 1), layers) {}
Session::Session(const Scene& scene, std::span<const Device> devices, const ExtraLayers& layers)
    : data_(std::make_unique<Data>(scene, devices, layers)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

void Session::update(const Scene& scene) {
  begin_opencl();
  Data& d = *data_;
  const Inside::SceneData& now = Inside::data(scene);
  const auto missing = now.log.since(d.at);
  if (!missing) {
    d.live.replace(now.model);
    d.at = now.log.state();
    return d.send();
  }
  try {
    for (const auto& [edit, state] : *missing) {
      d.live.put(edit);
      d.at = state;
    }
    d.live.edit(now.model.view);
  } catch (...) {
    d.send();
    throw;
  }
  d.send();
}

int Session::render(int samples, const RenderOptions& options) {
  check_range("samples", samples, 1, 1 << 24);
  return static_cast<int>(
      data_->runs.render(data_->session, static_cast<std::uint32_t>(samples), options));
}

double Session::render_to(const NoiseTarget& target, const RenderOptions& options) {
  check_noise(target, data_->live.scene().view.sampler);
  return data_->runs.render_to(data_->session, target, options);
}

void Session::cancel() { data_->session.cancel(); }

Film Session::film() const {
  Data& d = *data_;
  return d.runs.film(d.session, d.live.scene(), d.live.flat(), d.live.view(), d.fingerprint);
}

void Session::begin_at(std::uint32_t sample) {
  data_->session.begin_at(sample);
  data_->runs = {};
}

void Session::resume(const Film& film) {
  Data& d = *data_;
  const SavedFilm& saved = Inside::film(film);
  const std::string why = difference(
      saved.origin(), d.runs.origin(d.session, d.live.flat(), d.live.view(), d.fingerprint));
  if (!why.empty()) throw InputError("the film cannot be continued: " + why);
  d.session.resume(saved.film);
  d.runs.resume(saved);
}

std::optional<Hit> Session::pixel(int x, int y) { return data_->questions().pixel(x, y); }
std::optional<Hit> Session::nearest(const Ray& ray) { return nearest(std::span(&ray, 1)).front(); }
std::vector<std::optional<Hit>> Session::nearest(std::span<const Ray> rays) {
  return data_->questions().nearest(rays);
}
std::vector<std::vector<Hit>> Session::all(std::span<const Ray> rays, std::size_t most) {
  return data_->questions().all(rays, most);
}
void Session::nearest(std::span<const Ray> rays, std::span<Crossing> out) {
  data_->questions().nearest(rays, out);
}
std::vector<Crossing> Session::crossings(std::span<const Ray> rays, std::size_t most) {
  return data_->questions().crossings(rays, most);
}

}  // namespace caplet::v0
