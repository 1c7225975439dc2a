// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene on devices that is rendered, looked at and changed again and again.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "caplet/device.h"
#include "caplet/film.h"
#include "caplet/pick.h"
#include "caplet/render.h"
#include "caplet/scene.h"

CAPLET_BEGIN

/// Members throw RunError. One thread at a time, but for cancel().
class CAPLET_API Session {
 public:
  /// Puts the scene as it now is on the devices. Several share the samples; what comes out does not depend on who did what, as
  /// long as they are of one kind. One that fails or hangs is left out with a warning, and the others do its work again; a
  /// session fails with its last device. Throws InputError when the scene is beyond a limit.
  Session(const Scene& scene, const Device& device);
  Session(const Scene& scene, std::span<const Device> devices);
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  /// The scene as it now is; the film is empty again. Of the scene that was here, or a copy of it, with edits since, only what
  /// differs is sent; any other takes the whole way. Throws InputError when it is beyond a limit; the session then shows what it
  /// showed, with such edits as came before.
  void update(const Scene& scene);

  /// Adds the next `samples` samples of every pixel to the film and returns how many were finished. Blocks.
  int render(int samples, const RenderOptions& options = {});
  /// From any thread: the render under way, or else the next one, finishes its passes and begins no more.
  void cancel();
  /// What has been added up, as of now.
  Film film() const;
  /// Begins with this film's samples: renders add those that come after. Throws InputError when it is of another scene, view or
  /// layers.
  void resume(const Film& film);

  /// As Picker, of the scene as it is here.
  std::optional<Hit> pixel(int x, int y);
  std::optional<Hit> nearest(const Ray& ray);
  std::vector<std::optional<Hit>> nearest(std::span<const Ray> rays);
  std::vector<std::vector<Hit>> all(std::span<const Ray> rays, std::size_t most = 256);
  void nearest(std::span<const Ray> rays, std::span<Crossing> out);
  std::vector<Crossing> crossings(std::span<const Ray> rays, std::size_t most = 256);

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

CAPLET_END
