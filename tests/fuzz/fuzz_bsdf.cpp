// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Any material, light, camera and pixel filter that validation lets through, and any directions and
// random numbers: what kernels/bsdf, lights and math, compiled for the host, say is finite and not
// negative.
#include <algorithm>
#include <cmath>

#include "fuzz_numbers.h"
#include "host_kernels/host_kernels.h"
#include "host_kernels/scene_arrays.h"
#include "target.h"

namespace {

using namespace caplet;
using namespace caplet::test;

template <std::size_t n>
bool finite(const float (&v)[n]) {
  return std::all_of(v, v + n, [](float x) { return std::isfinite(x); });
}
template <std::size_t n>
bool radiometric(const float (&v)[n]) {
  return std::all_of(v, v + n, [](float x) { return x >= 0 && std::isfinite(x); });
}

struct Direction {
  float v[3];
};

/// Unit, often along or near an axis or the surface.
Direction direction(FuzzNumbers& numbers) {
  double v[3];
  for (double& x : v) {
    x = numbers.coordinate();
    if (!std::isfinite(x)) x = 0;
  }
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0)) return {{0, 0, 1}};
  for (double& x : v) x /= largest;
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {{static_cast<float>(v[0] / length), static_cast<float>(v[1] / length),
           static_cast<float>(v[2] / length)}};
}

/// In [0, 1), the ends as random numbers have them (24 bits).
float random_number(FuzzNumbers& numbers) {
  const std::uint8_t first = numbers.byte();
  if (first == 0) return 0;
  if (first == 255) return 0x1.fffffep-1f;
  if (first == 254) return 0x1p-24f;
  return static_cast<float>(first * 65536 + numbers.byte() * 256 + numbers.byte()) * 0x1p-24f;
}

/// 64 eps: BSDFs turn directions within a frame; each coordinate is some ten roundings off.
bool unit(const float (&v)[3]) {
  const double length = std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]);
  return std::abs(length - 1) <= 64 * 0x1p-24;
}

void material(const HostGroups* g, std::uint32_t number, const float (&lambda)[4],
              FuzzNumbers& numbers) {
  const HostKernels& kernels = host_kernels(8);
  const Direction wo = direction(numbers), wi = direction(numbers);
  float f[4];
  const float pdf = kernels.bsdf_eval(g, number, lambda, wo.v, wi.v, f);
  require(radiometric(f) && pdf >= 0 && std::isfinite(pdf));
  float albedo[4];
  kernels.bsdf_albedo(g, number, lambda, wo.v, albedo);
  require(radiometric(albedo));
  const float u[3] = {random_number(numbers), random_number(numbers), random_number(numbers)};
  HostBsdfSample sample;
  if (!kernels.bsdf_sample(g, number, lambda, wo.v, u, &sample)) return;
  require(radiometric(sample.weight) && sample.pdf > 0 && std::isfinite(sample.pdf));
  require(unit(sample.wi));
  require(sample.eta_scale > 0 && std::isfinite(sample.eta_scale));
  require(((sample.wi[2] < 0) != (wo.v[2] < 0)) == (sample.transmitted != 0));
}

void lights(const HostGroups* g, const float (&lambda)[4], FuzzNumbers& numbers) {
  const float u[3] = {random_number(numbers), random_number(numbers), random_number(numbers)};
  float p[3];
  for (float& x : p) {
    x = numbers.number();
    if (!(std::abs(x) <= 1e18f)) x = 0;
  }
  HostLightSample sample;
  if (host_kernels(8).light_sample(g, p, lambda, u, &sample)) {
    require(sample.pdf > 0 && std::isfinite(sample.pdf));
    require(unit(sample.wi));
    require(radiometric(sample.radiance));
    require(finite(sample.target));
  }
  const Direction d = direction(numbers);
  float sky[4];
  host_kernels(8).light_infinite(g, p, d.v, lambda, random_number(numbers), numbers.below(2) != 0,
                                 sky);
  require(radiometric(sky));
}

void camera(const HostGroups* g, const Scene& scene, FuzzNumbers& numbers, float (&lambda)[4]) {
  float u[5];
  for (float& x : u) x = random_number(numbers);
  RayRecord ray;
  HostCameraSample sample;
  host_kernels(8).camera(g, numbers.below(static_cast<unsigned>(scene.view.film.width)),
                         numbers.below(static_cast<unsigned>(scene.view.film.height)), u, &ray,
                         &sample);
  const float origin[3] = {ray.ox, ray.oy, ray.oz}, along[3] = {ray.dx, ray.dy, ray.dz};
  require(finite(origin) && unit(along));
  require(std::isfinite(sample.filter_weight));
  require(radiometric(sample.lambda_pdf) && radiometric(sample.lambda));
  std::copy(sample.lambda, sample.lambda + 4, lambda);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return run_target([&] {
    FuzzNumbers numbers(data, size);
    ModelMaker maker(numbers);
    Scene scene;
    for (unsigned i = 0; i < 3; ++i) scene.materials.push_back(maker.material());
    for (unsigned i = 1 + numbers.below(3); i > 0; --i) scene.lights.push_back(maker.light());
    scene.shapes.emplace_back();
    scene.shapes[0].geometry = SphereShape{1};
    scene.view.film.width = scene.view.film.height = 16;
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row)
        if (const std::uint8_t byte = numbers.byte(); byte >= 200)
          scene.view.camera.world_from_camera[column][row] = numbers.coordinate();
    scene.view.camera.projection = PerspectiveProjection{3.1 * numbers.fraction()};
    scene.view.camera.lens_radius = numbers.below(2) != 0 ? numbers.length() : 0;
    scene.view.camera.focal_distance = numbers.length();
    scene.view.filter.kind = static_cast<PixelFilter::Kind>(numbers.below(4));
    scene.view.filter.radius_x = 4 * numbers.fraction();
    scene.view.filter.radius_y = 4 * numbers.fraction();
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    diagnostics.finish();
    const caplet::test::SceneArrays arrays({lower(scene), lower_view(scene)});
    for (int i = 0; i < 16 && (i < 2 || !numbers.ended()); ++i) {
      float lambda[4];
      camera(arrays.groups(), scene, numbers, lambda);
      material(arrays.groups(), numbers.below(3), lambda, numbers);
      lights(arrays.groups(), lambda, numbers);
    }
  });
}
