// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What stands behind the public classes. In these files caplet::Scene is the model and v0::Scene the public class of that name,
// and so for the others.
#pragma once

#include <memory>

#include "caplet/device.h"
#include "caplet/film.h"
#include "caplet/scene.h"
#include "device/device.h"
#include "film/image.h"
#include "scene/scene.h"

namespace caplet::v0 {

struct Scene::Data {
  caplet::Scene model;
};

struct Device::Data {
  caplet::Device device;
  DeviceInfo info;
};

struct Film::Data {
  LayeredImage image;
  int samples_per_pixel = 0;
  double render_seconds = 0;
};

struct Inside {
  static Scene scene(caplet::Scene model) { return Scene(std::make_shared<Scene::Data>(Scene::Data{std::move(model)})); }
  static std::shared_ptr<const caplet::Scene> model(const Scene& scene) { return {scene.data_, &scene.data_->model}; }
  static Device device(caplet::Device device, DeviceInfo info) {
    return Device(std::make_shared<const Device::Data>(Device::Data{std::move(device), std::move(info)}));
  }
  static const caplet::Device& device(const Device& device) { return device.data_->device; }
  static Film film(LayeredImage image, int samples_per_pixel, double render_seconds) {
    return Film(std::make_shared<const Film::Data>(Film::Data{std::move(image), samples_per_pixel, render_seconds}));
  }
};

DeviceInfo to_public(const caplet::DeviceInfo& info);

}  // namespace caplet::v0
