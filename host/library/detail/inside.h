// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What stands behind the public classes. In these files caplet::Scene is the model and v0::Scene the public class of that name,
// and so for the others.
#pragma once

#include <cstdint>
#include <map>
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
#include "film/film.h"
#include "film/image.h"
#include "post/scale_bar.h"
#include "scene/edit.h"
#include "scene/scene.h"

namespace caplet::v0 {

/// A number that no other state of a scene has.
std::uint64_t next_serial();

struct Scene::Data {
  caplet::Scene model;
  /// A scene as it came, and its edits since: a copy has those of the scene that it is a copy of up to then, and its own.
  struct Logged {
    std::uint64_t serial;
    SceneEdit edit;
  };
  std::uint64_t origin = next_serial();
  std::vector<Logged> edits;
  // A scene that is built has these: whether no one has given it a camera, or a light; whether
  // present() has given it its light; and the state (`origin`) that present() has processed.
  bool open_camera = false, open_light = false, studio_light = false;
  std::optional<std::uint64_t> presented = {};

  void edit(const SceneEdit& edit);
  /// What has changed is more than edits say: sessions take the scene anew.
  void as_a_whole();
  /// The same, of what neither camera nor light follow.
  void as_a_whole_in_view();
};

struct Device::Data {
  caplet::Device device;
  DeviceInfo info;
};

struct Film::Data {
  caplet::Film film;
  std::shared_ptr<const post::Sight> sight;  // what it is a film of
  std::map<std::string, std::string> notes;  // for its pictures
  double render_seconds = 0;
  mutable std::once_flag once = {};  // when it is developed
  mutable LayeredImage image = {};
};

struct Inside {
  using SceneData = Scene::Data;
  static Scene scene(caplet::Scene model) {
    auto data = std::make_shared<Scene::Data>();
    data->model = std::move(model);
    return Scene(std::move(data));
  }
  static std::shared_ptr<const caplet::Scene> model(const Scene& scene) { return {scene.data_, &scene.data_->model}; }
  static const Scene::Data& data(const Scene& scene) { return *scene.data_; }
  static Device device(caplet::Device device, DeviceInfo info) {
    return Device(std::make_shared<const Device::Data>(Device::Data{std::move(device), std::move(info)}));
  }
  /// Throws RunError in a forked process (check_process): before a scene is lowered for it, which takes time.
  static const caplet::Device& device(const Device& device) {
    begin_opencl();
    return device.data_->device;
  }
  static Film film(caplet::Film film, std::shared_ptr<const post::Sight> sight, std::map<std::string, std::string> notes,
                   double render_seconds) {
    return Film(
        std::shared_ptr<const Film::Data>(new Film::Data{std::move(film), std::move(sight), std::move(notes), render_seconds}));
  }
  static const caplet::Film& film(const Film& film) { return film.data_->film; }
};

DeviceInfo to_public(const caplet::DeviceInfo& info);

/// Throws InputError when the number is not within the range.
void check_range(const char* what, std::int64_t value, std::int64_t least, std::int64_t most);

}  // namespace caplet::v0
