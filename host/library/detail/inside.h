// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The implementation behind the public classes. In these files caplet::Scene is the model and
// v0::Scene the public class, and likewise for the others.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "caplet/device.h"
#include "caplet/film.h"
#include "caplet/scene.h"
#include "device/device.h"
#include "device/forked.h"
#include "film/film_file.h"
#include "film/image.h"
#include "post/scale_bar.h"
#include "scene/edit.h"
#include "scene/edit_log.h"
#include "scene/scene.h"

namespace caplet::v0 {

/// Returns a number that identifies a state of a scene, different from all others.
std::uint64_t next_serial();

struct Scene::Data {
  caplet::Scene model;
  // The edits since the scene was read. A copy has those of its original up to the copy, and then
  // its own.
  EditLog<SceneEdit> log = EditLog<SceneEdit>(next_serial());
  // These belong to a scene that is built: whether it still lacks a camera or a light; whether
  // present() has added its light; and the state (the origin of `log`) that present() has
  // processed.
  bool open_camera = false, open_light = false, studio_light = false;
  std::optional<std::uint64_t> presented = {};

  void edit(const SceneEdit& edit);
  /// Marks a change that edits cannot express: sessions then take the whole scene again.
  void as_a_whole();
  /// Does the same for a change that leaves the automatic camera and light alone.
  void as_a_whole_in_view();
};

struct Device::Data {
  caplet::Device device;
  DeviceInfo info;
};

struct Film::Data {
  SavedFilm saved;
  std::shared_ptr<const post::Sight> sight;  // of the scene in the film; null where unknown
  double render_seconds = 0;
  mutable std::once_flag once = {};  // guards the development of `image`
  mutable LayeredImage image = {};
};

struct Inside {
  using SceneData = Scene::Data;
  static Scene scene(caplet::Scene model) {
    auto data = std::make_shared<Scene::Data>();
    data->model = std::move(model);
    return Scene(std::move(data));
  }
  static std::shared_ptr<const caplet::Scene> model(const Scene& scene) {
    return {scene.data_, &scene.data_->model};
  }
  static const Scene::Data& data(const Scene& scene) { return *scene.data_; }
  static Device device(caplet::Device device, DeviceInfo info) {
    return Device(
        std::make_shared<const Device::Data>(Device::Data{std::move(device), std::move(info)}));
  }
  /// Throws RunError in a forked process (check_process), before the slow lowering of a scene for
  /// it.
  static const caplet::Device& device(const Device& device) {
    begin_opencl();
    return device.data_->device;
  }
  static Film film(SavedFilm saved, std::shared_ptr<const post::Sight> sight,
                   double render_seconds) {
    return Film(std::shared_ptr<const Film::Data>(
        new Film::Data{std::move(saved), std::move(sight), render_seconds}));
  }
  static const SavedFilm& film(const Film& film) { return film.data_->saved; }
};

DeviceInfo to_public(const caplet::DeviceInfo& info);

/// Throws InputError when the number is outside the range.
void check_range(const char* what, std::int64_t value, std::int64_t least, std::int64_t most);

}  // namespace caplet::v0
