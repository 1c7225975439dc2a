// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "light_trials.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "light_scenes.h"

namespace caplet::test {

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

// E = pi L (r / d)^2 cos, for a sphere wholly above the horizon.
LightTrial area_trial() {
  const glm::dvec3 center(1, 2, 3), p(0.5, 0, 0), away = center - p;
  Shape ball;
  ball.geometry = SphereShape{0.75};
  ball.world_from_object[3] = glm::dvec4(center, 1);
  ball.emission = AreaEmission{};
  LightTrial trial;
  trial.scene.materials.emplace_back();
  trial.scene.shapes = {ball};
  trial.p = p;
  trial.n = {0, 0, 1};
  trial.irradiance = pi * 0.75 * 0.75 / glm::dot(away, away) * away.z / glm::length(away);
  return trial;
}

// E = I cos / d^2.
LightTrial point_trial() {
  PointLight model;
  model.position = {1, 2, 3};
  Light light = light_of(model);
  light.scale = 7;
  LightTrial trial{scene_with({light}), {1, 0, 0}, {0, 0, 1}};
  trial.irradiance = 7.0 / 13 * 3 / std::sqrt(13.0);
  trial.is_delta = true;
  return trial;
}

// As a point light within the angle where the falloff starts.
LightTrial spot_trial() {
  SpotLight model;
  model.position = {0, 0, 2};
  model.direction = {0, 0, -1};
  model.total_angle = 0.5;
  model.falloff_start_angle = 0.3;
  LightTrial trial{scene_with({light_of(model)}), {0.5, 0, 0}, {0, 0, 1}};
  trial.irradiance = 1 / 4.25 * 2 / std::sqrt(4.25);
  trial.is_delta = true;
  return trial;
}

LightTrial distant_trial() {
  DistantLight model;
  model.direction = {0, -0.6, -0.8};
  Light light = light_of(model);
  light.illuminance = 3;
  LightTrial trial{scene_with({light}), {5, 6, 7}, {0, 0, 1}};
  trial.irradiance = 3 * 0.8;
  trial.is_delta = trial.is_infinite = true;
  return trial;
}

// E = pi L under a sky of radiance L.
LightTrial constant_trial() {
  Light light = light_of(InfiniteLight{});
  light.scale = 2.5;
  LightTrial trial{scene_with({light}), {0, 0, 0}, {0, 0, 1}};
  trial.irradiance = 2.5 * pi;
  trial.is_sampled = false;
  trial.is_infinite = true;
  return trial;
}

// The image's upper half (v from 0 to 1/2) is the half space z > 0; radiance u of the way around, up to where it begins anew, has
// a mean of 1/2. The linear interpolation across the horizon, half a texel of 64 to either side, takes and gives light there with
// cosines below pi / 128: less than 1e-3 of it.
LightTrial image_trial() {
  constexpr int width = 128, height = 64;
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) rgb.insert(rgb.end(), 3, y < height / 2 ? (static_cast<float>(x) + 0.5f) / width : 0.f);
  LightTrial trial{scene_with({image_light(width, height, false, rgb)}), {0, 0, 0}, {0, 0, 1}};
  trial.irradiance = 0.5 * pi;
  trial.per_white = true;
  trial.is_infinite = true;
  return trial;
}

}  // namespace caplet::test
