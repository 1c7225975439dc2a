// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "light_trials.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <numbers>

#include "light_scenes.h"

namespace caplet::test {

namespace {

using std::numbers::pi;

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

// E = pi L R^2 / (R^2 + d^2) over the middle of a disk; half of the rays that meet it go through.
LightTrial textured_area_trial() {
  Shape disk;
  disk.geometry = DiskShape{2, 1.5};
  disk.alpha = TextureOperand(0.5);
  disk.emission = AreaEmission{};
  disk.emission->image = picture_image(1, 1, {3, 3, 3});
  disk.reverse_orientation = true;
  LightTrial trial;
  trial.scene.materials.emplace_back();
  trial.scene.shapes = {disk};
  trial.p = {0, 0, 0};
  trial.n = {0, 0, 1};
  trial.irradiance = 0.5 * 3 * pi * 2.25 / 6.25;
  trial.per_white = true;
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

// The quarter of the directions with positive x and negative z of the light's is one texel.
LightTrial goniometric_trial() {
  GoniometricLight model;
  model.position = {0, 0, 2};
  model.image = picture_image(2, 2, {0, 0, 0, 2, 4, 9, 0, 0, 0, 0, 0, 0}, true);
  LightTrial trial{scene_with({light_of(model)}), {1, 0.5, 0}, {0, 0, 1}};
  trial.irradiance = 5 / 5.25 * 2 / std::sqrt(5.25);
  trial.is_delta = true;
  return trial;
}

// Downwards, and turned so that the image's right side is at +x and its upper one at -y.
LightTrial projection_trial() {
  ProjectionLight model;
  model.position = {0, 0, 3};
  model.world_from_light = glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1);
  model.image = picture_image(2, 2, {0, 0, 0, 7, 7, 7, 0, 0, 0, 0, 0, 0});
  model.fov = 60;
  LightTrial trial{scene_with({light_of(model)}), {0.5, -0.3, 0}, {0, 0, 1}};
  trial.irradiance = 7 / 9.34 * 3 / std::sqrt(9.34);
  trial.per_white = true;
  trial.is_delta = true;
  return trial;
}

// Half of the way from straight down to the horizon.
LightTrial ies_trial() {
  IesLight model;
  model.position = {0, 0, 2};
  model.profile = std::make_shared<IesProfile>(IesProfile{{0, pi / 2}, {0}, {10, 4}});
  LightTrial trial{scene_with({light_of(model)}), {2, 0, 0}, {0, 0, 1}};
  trial.irradiance = 7.0 / 8 * 2 / std::sqrt(8.0);
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

// The image's upper half (v from 0 to 1/2) is the half space z > 0; radiance u of the way around,
// up to where it begins anew, has a mean of 1/2. The linear interpolation across the horizon, half
// a texel of 64 to either side, takes and gives light there with cosines below pi / 128: less than
// 1e-3 of it.
LightTrial image_trial() {
  constexpr int width = 128, height = 64;
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      rgb.insert(rgb.end(), 3, y < height / 2 ? (static_cast<float>(x) + 0.5f) / width : 0.f);
  LightTrial trial{scene_with({image_light(width, height, false, rgb)}), {0, 0, 0}, {0, 0, 1}};
  trial.irradiance = 0.5 * pi;
  trial.per_white = true;
  trial.is_infinite = true;
  return trial;
}

// Four times that of a rectangle of sides a and b at distance d, with a corner over the point: L /
// 2 (A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + B / sqrt(1 + B^2) atan(A / sqrt(1 + B^2))), A = a
// / d, B = b / d.
LightTrial portal_trial() {
  Light light = image_light(16, 16, true, std::vector<float>(3 * 16 * 16, 2.f));
  std::get<InfiniteLight>(light.model).portal =
      LightPortal{{{-1, -0.5, 2}, {-1, 0.5, 2}, {1, 0.5, 2}, {1, -0.5, 2}}};
  LightTrial trial{scene_with({light}), {0, 0, 0}, {0, 0, 1}};
  const double a = 0.5, b = 0.25, wide = std::sqrt(1 + a * a), high = std::sqrt(1 + b * b);
  trial.irradiance =
      4 * 2 * 0.5 * (a / wide * std::atan(b / wide) + b / high * std::atan(a / high));
  trial.per_white = true;
  trial.is_infinite = true;
  return trial;
}

}  // namespace caplet::test
