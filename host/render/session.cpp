// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "render/session.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "base/check.h"
#include "render/device_scene.h"
#include "render/renderer.h"

namespace caplet {

struct Session::Worker {
  Worker(const Device& device, const FlatScene& flat, const FlatView& view, const RendererOptions& options)
      : scene(device, flat), renderer(scene, view, options) {}
  DeviceScene scene;
  Renderer renderer;
};

Session::Session(const FlatScene& scene, const FlatView& view, const std::vector<Device>& devices, const SessionOptions& options)
    : options_(options) {
  CHECK_LT_(std::size_t{0}, devices.size());
  CHECK_LT_(0u, options.sample_count);
  RendererOptions each;
  each.layers = options.layers;
  each.batch_paths = options.batch_paths;
  for (const Device& device : devices) workers_.push_back(std::make_unique<Worker>(device, scene, view, each));
}

Session::~Session() = default;

Film Session::run(const std::function<void(const SessionProgress&)>& progress) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::mutex mutex;  // of what follows
  std::uint32_t given = 0, done = 0;
  std::exception_ptr failure;

  const auto work = [&](Renderer& renderer) {
    const Window window = renderer.film().layout.window;
    const auto fill = std::max<std::size_t>(1, renderer.batch_paths() / std::max<std::size_t>(1, window.pixels()));
    const auto most = static_cast<std::uint32_t>(
        std::min<std::size_t>(options_.pass_samples > 0 ? options_.pass_samples : fill, renderer.batch_paths()));
    while (true) {
      std::uint32_t first = 0, count = 0;
      {
        const std::lock_guard lock(mutex);
        const bool late = options_.time_limit && given > 0 && seconds() >= *options_.time_limit;
        if (failure || cancelled_ || late || given == options_.sample_count) return;
        first = given;
        count = std::min(most, options_.sample_count - given);
        given += count;
      }
      renderer.pass(window, options_.sample_begin + first, count);
      const std::lock_guard lock(mutex);
      done += count;
      if (!progress) continue;
      const double samples = static_cast<double>(done) * static_cast<double>(window.pixels());
      progress({done, options_.sample_count, samples / std::max(1e-9, seconds())});
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
  if (failure) std::rethrow_exception(failure);
  Film film = workers_.front()->renderer.film().read();
  for (std::size_t i = 1; i < workers_.size(); ++i) film.add(workers_[i]->renderer.film().read());
  return film;
}

}  // namespace caplet
