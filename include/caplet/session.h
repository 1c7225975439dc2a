// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A scene on devices that is rendered, queried and changed repeatedly.
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

/// Members throw RunError. Only one thread at a time may call them, except cancel().
class CAPLET_API Session {
 public:
  /// Copies the scene to the devices. Several devices share the samples; the result does not depend
  /// on the division of work as long as they are of one kind. A device that fails or hangs is
  /// dropped with a warning, and the others repeat its work; a session fails with its last device.
  /// Throws InputError when the scene exceeds a limit.
  Session(const Scene& scene, const Device& device, const ExtraLayers& layers = {});
  Session(const Scene& scene, std::span<const Device> devices, const ExtraLayers& layers = {});
  Session(Session&&) noexcept;
  Session& operator=(Session&&) noexcept;
  ~Session();

  /// Takes the scene's present state, and empties the film. For the same scene or a copy with edits
  /// since, only differences are sent; any other scene is sent as a whole. Throws InputError when
  /// it exceeds a limit; the session then keeps its former state, with the edits that were made
  /// before.
  void update(const Scene& scene);

  /// Empties the film, of which `sample` will be the first: for shares of a picture's samples,
  /// whose films are added.
  void begin_at(std::uint32_t sample);
  /// Adds the next `samples` samples of every pixel to the film, and returns how many were
  /// finished. Blocks.
  int render(int samples, const RenderOptions& options = {});
  /// Gives each pixel of the film the samples that it still needs for a noise (options.noise does
  /// not count), and returns the noise that the film has. Blocks. Throws InputError when the target
  /// is out of range, when the film was resumed with gaps between its samples, with samplers whose
  /// points are even at one number of samples alone (zsobol, stratified), and without layers
  /// (ExtraLayers::none).
  double render_to(const NoiseTarget& target, const RenderOptions& options = {});
  /// May be called from any thread: the render in progress, or else the next one, finishes its
  /// passes and starts no more.
  void cancel();
  /// Returns the film so far.
  Film film() const;
  /// Starts from this film's samples: renders add the samples after them. Throws InputError when it
  /// belongs to another scene, view or size.
  void resume(const Film& film);

  /// These are queries as in Picker, for the session's scene.
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
