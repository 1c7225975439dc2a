// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/session.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "base/check.h"
#include "base/log.h"
#include "render/renderer.h"

namespace caplet {

struct Session::Worker {
  Worker(const Device& device, const FlatScene& flat, const FlatView& of, const RendererOptions& options)
      : scene(device, flat), view(of), renderer(scene, view, options) {}
  DeviceScene scene;
  FlatView view;
  Renderer renderer;
};

Session::Session(const FlatScene& scene, const FlatView& view, const std::vector<Device>& devices, const SessionOptions& options)
    : options_(options), next_(options.sample_begin) {
  CHECK_LT_(std::size_t{0}, devices.size());
  RendererOptions each;
  each.layers = options.layers;
  each.batch_paths = options.batch_paths;
  if (options.most_samples > 0)
    each.most_paths = std::size_t{view.view.crop_width} * view.view.crop_height * std::size_t{options.most_samples};
  for (const Device& device : devices) workers_.push_back(std::make_unique<Worker>(device, scene, view, each));
}

Session::~Session() = default;

DeviceScene& Session::scene_on(std::size_t device) { return workers_[device]->scene; }

void Session::clear() {
  for (const auto& worker : workers_) worker->renderer.reset(worker->view);
  before_.reset();
  next_ = options_.sample_begin;
}

void Session::update(const FlatScene& scene, const SceneChanges& changes, const FlatView& view) {
  for (const auto& worker : workers_) {
    worker->scene.update(scene, changes);
    worker->view = view;
  }
  clear();
}

void Session::resume(Film film) {
  if (!(film.layout() == workers_.front()->renderer.layout()))
    throw InputError("the film is one of another picture, other layers or another scene");
  clear();
  for (const FilmPart& part : film.parts()) next_ = std::max(next_, part.sample_begin + part.sample_count);
  before_ = std::move(film);
}

std::uint32_t Session::render(std::uint32_t sample_count, const std::function<void(const SessionProgress&)>& progress,
                              std::optional<double> time_limit) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  sample_count = std::min(sample_count, std::numeric_limits<std::uint32_t>::max() - next_);
  std::mutex mutex;  // of what follows
  std::uint32_t given = 0, done = 0;
  std::uint64_t not_finite = 0;
  std::exception_ptr failure;

  const auto work = [&](Renderer& renderer) {
    const Window window = renderer.layout().window;
    const auto fill = std::max<std::size_t>(1, renderer.batch_paths() / std::max<std::size_t>(1, window.pixels()));
    const auto most = static_cast<std::uint32_t>(
        std::min<std::size_t>(options_.pass_samples > 0 ? options_.pass_samples : fill, renderer.batch_paths()));
    while (true) {
      std::uint32_t first = 0, count = 0;
      {
        const std::lock_guard lock(mutex);
        const bool late = time_limit && given > 0 && seconds() >= *time_limit;
        if (failure || cancelled_ || late || given == sample_count) return;
        first = given;
        count = std::min(most, sample_count - given);
        given += count;
      }
      const std::uint64_t before = renderer.rays().not_finite;
      renderer.pass(window, next_ + first, count);
      const std::lock_guard lock(mutex);
      not_finite += renderer.rays().not_finite - before;
      done += count;
      if (!progress) continue;
      const double samples = static_cast<double>(done) * static_cast<double>(window.pixels());
      progress({done, sample_count, samples / std::max(1e-9, seconds())});
    }
  };
  {
    std::vector<std::jthread> threads;
    for (const auto& worker : workers_)
      threads.emplace_back([&, renderer = &worker->renderer] {
        try {
          work(*renderer);
        } catch (...) {
          const std::lock_guard lock(mutex);
          if (!failure) failure = std::current_exception();
        }
      });
  }
  cancelled_ = false;
  if (not_finite > 0) log::warn("{} samples were not finite and count as black", not_finite);
  if (failure) {
    try {
      clear();
    } catch (const RunError&) {  // the first failure is the one to tell of
    }
    std::rethrow_exception(failure);
  }
  next_ += done;
  return done;
}

Film Session::film() const {
  Film film = workers_.front()->renderer.film().read();
  for (std::size_t i = 1; i < workers_.size(); ++i) film.add(workers_[i]->renderer.film().read());
  if (before_) film.add(*before_);
  return film;
}

}  // namespace caplet
