// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The target of scenes: a few shapes of any size that validation lets through, lowered, and any
// rays. The traversal, surfaces and lights of kernels/, compiled for the host, must stay within
// their arrays and answer with numbers that mean something.
#pragma once

#include <tbb/global_control.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <tuple>

#include "fuzz_numbers.h"
#include "host_kernels/host_kernels.h"
#include "host_kernels/scene_arrays.h"
#include "shared/shapes.h"
#include "target.h"

namespace caplet::test {

constexpr std::uint32_t capacity = 24;

template <std::size_t n>
bool finite(const float (&v)[n]) {
  return std::all_of(v, v + n, [](float x) { return std::isfinite(x); });
}

/// Unit length: kernels divide by a square root, OpenCL allows them 6 and 5 eps each, and three
/// products and sums, 16 in all; twice that.
inline bool unit(const float (&v)[3]) {
  const double length = std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2]);
  return std::abs(length - 1) <= 32 * 0x1p-24;
}

inline bool within_reach(const float (&p)[3]) {
  return std::all_of(p, p + 3,
                     [](float x) { return std::abs(x) <= static_cast<float>(largest_length); });
}

inline bool same(const HitRecord& a, const HitRecord& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

/// The order that lists promise.
inline bool before(const FlatScene& scene, const HitRecord& a, const HitRecord& b) {
  if (a.t != b.t) return a.t < b.t;
  const bool a_leaves = a.surface & CAPLET_LEAVING, b_leaves = b.surface & CAPLET_LEAVING;
  if (a_leaves != b_leaves) return a_leaves;
  const auto key = [&](const HitRecord& hit) {
    const std::uint32_t object =
        hit.instance == CAPLET_NONE ? 0 : scene.instances[hit.instance].object + 1;
    return std::tuple(object, primitive_at(scene.leaves, hit.slot), hit.instance, hit.surface);
  };
  return key(a) < key(b);
}

class Checker {
 public:
  Checker(const FlatScene& scene, FuzzNumbers& numbers)
      : scene_(scene), arrays_({scene, {}}), numbers_(numbers) {}

  void ray(const RayRecord& ray) {
    const HostGroups* g = arrays_.groups();
    const HostKernels& kernels = host_kernels(8);
    const HitRecord hit = kernels.trace_closest(g, &ray);
    // One lane at a time computes the same.
    require(same(hit, host_kernels(1).trace_closest(g, &ray)));
    const bool found = hit.slot != CAPLET_NONE;
    require((kernels.trace_any(g, &ray) != 0) == found);
    if (!found) require(std::isinf(hit.t));

    const float dd = ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz;
    const float oo = std::abs(ray.ox) + std::abs(ray.oy) + std::abs(ray.oz);
    const bool sound = dd > 0 && std::isfinite(dd) && std::isfinite(oo) && ray.t_min < ray.t_max;
    HitRecord list[capacity];
    const std::uint32_t count = kernels.trace_all(g, &ray, capacity, list);
    require(count <= capacity + 1);
    if (!sound) {
      require(!found && count == 0);
      return;
    }
    const std::uint32_t kept = std::min(count, capacity);
    for (std::uint32_t i = 0; i < kept; ++i) {
      crossing(ray, list[i]);
      require(i == 0 || before(scene_, list[i - 1], list[i]));
    }
    HitRecord scalar[capacity];
    require(host_kernels(1).trace_all(g, &ray, capacity, scalar) == count);
    for (std::uint32_t i = 0; i < kept; ++i) require(same(list[i], scalar[i]));
    // A shorter list is the beginning of a longer one.
    HitRecord short_list[3];
    require(kernels.trace_all(g, &ray, 3, short_list) == std::min(count, 4u));
    for (std::uint32_t i = 0; i < std::min(count, 3u); ++i) require(same(list[i], short_list[i]));
    if (found) crossing(ray, hit);
  }

  /// Samples the lights from a point within the reach of scenes.
  void light(const float (&p)[3]) {
    float u[3], lambda[4];
    for (float& x : u) x = static_cast<float>(numbers_.byte()) / 256;
    for (float& x : lambda) x = 360 + 470 * static_cast<float>(numbers_.fraction());
    HostLightSample sample;
    if (!host_kernels(8).light_sample(arrays_.groups(), p, lambda, u, &sample)) return;
    require(std::isfinite(sample.pdf) && sample.pdf > 0);
    require(unit(sample.wi));
    require(finite(sample.radiance) &&
            *std::min_element(sample.radiance, sample.radiance + 4) >= 0);
    require(sample.infinite || finite(sample.target));
  }

 private:
  void crossing(const RayRecord& ray, const HitRecord& hit) {
    require(std::isfinite(hit.t) && hit.t > ray.t_min && hit.t > 0 && hit.t < ray.t_max);
    require((hit.slot & ~CAPLET_SLOT_LINKED) < scene_.leaves.size());
    const std::uint32_t primitive = primitive_at(scene_.leaves, hit.slot);
    require(primitive / CAPLET_PAGE_PRIMITIVES < scene_.primitive_geometry.size());
    require(hit.instance == CAPLET_NONE || hit.instance < scene_.instances.size());

    const HostGroups* g = arrays_.groups();
    HostSurface s;
    host_kernels(8).surface_at(g, &ray, &hit, &s);
    require(s.geometry < scene_.geometries.size() && s.primitive == primitive);
    require(s.material < scene_.materials.size());
    require(s.light == CAPLET_NONE || s.light < scene_.lights.size());
    require(finite(s.p) && finite(s.dpdu) && finite(s.dpdv) && finite(s.uv));
    require(unit(s.ng) && unit(s.ns));
    require(s.ng[0] * s.ns[0] + s.ng[1] * s.ns[1] + s.ng[2] * s.ns[2] >= -32 * 0x1p-24f);
    require(std::isfinite(s.error) && s.error >= 0);

    const PickRecord pick = host_kernels(8).pick_record(g, &ray, &hit);
    require(finite(pick.point) && unit(pick.normal) && pick.t == hit.t);
    require(pick.normal[0] * ray.dx + pick.normal[1] * ray.dy + pick.normal[2] * ray.dz <= 0);

    const float back[3] = {-ray.dx, -ray.dy, -ray.dz};
    float origin[3];
    host_kernels(8).offset_origin(&s, back, origin);
    require(finite(origin));
    if (within_reach(origin)) light(origin);
    if (s.light == CAPLET_NONE) return;
    // Light densities are for unit directions.
    RayRecord unit_ray = ray;
    const double length =
        std::sqrt(double(ray.dx) * ray.dx + double(ray.dy) * ray.dy + double(ray.dz) * ray.dz);
    unit_ray.dx = static_cast<float>(ray.dx / length);
    unit_ray.dy = static_cast<float>(ray.dy / length);
    unit_ray.dz = static_cast<float>(ray.dz / length);
    HitRecord unit_hit = hit;
    unit_hit.t = static_cast<float>(hit.t * length);
    if (!std::isfinite(unit_hit.t)) return;
    const float lambda[4] = {400, 500, 600, 700};
    float emitted[4];
    const float pdf = host_kernels(8).light_area(g, &unit_ray, &unit_hit, lambda, emitted);
    require(std::isfinite(pdf) && pdf >= 0);
    require(finite(emitted) && *std::min_element(emitted, emitted + 4) >= 0);
  }

  const FlatScene& scene_;
  SceneArrays arrays_;
  FuzzNumbers& numbers_;
};

inline RayRecord make_ray(FuzzNumbers& numbers, const WorldRecord& world) {
  RayRecord ray{};
  ray.t_max = std::numeric_limits<float>::infinity();
  const unsigned form = numbers.below(4);
  if (form == 0) {  // any bits
    float* words[] = {&ray.ox, &ray.oy, &ray.oz, &ray.t_min, &ray.dx, &ray.dy, &ray.dz, &ray.t_max};
    for (float* word : words) *word = numbers.number();
    return ray;
  }
  ray.ox = numbers.number();
  ray.oy = numbers.number();
  ray.oz = numbers.number();
  // Towards a point near the middle of the scene.
  const auto offset = [&] {
    return world.radius * (static_cast<float>(numbers.byte()) - 128) / 128;
  };
  ray.dx = world.center_x + offset() - ray.ox;
  ray.dy = world.center_y + offset() - ray.oy;
  ray.dz = world.center_z + offset() - ray.oz;
  if (form == 1) {
    float* const components[] = {&ray.dx, &ray.dy, &ray.dz};
    *components[numbers.below(3)] = numbers.number();
  }
  if (form == 2) {
    ray.t_min = numbers.number();
    ray.t_max = numbers.number();
  }
  return ray;
}

/// Scenes of csg shapes, or of one of all other kinds or all of them.
inline int fuzz_scene(const std::uint8_t* data, std::size_t size, bool csg) {
  static const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  return run_target([&] {
    FuzzNumbers numbers(data, size);
    const unsigned kind = numbers.below(ModelMaker::csg_kind + 1), count = 1 + numbers.below(3);
    const Scene scene =
        ModelMaker(numbers).scene(csg                           ? ModelMaker::csg_kind
                                  : kind < ModelMaker::csg_kind ? kind
                                                                : ModelMaker::simple_kinds,
                                  count);
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    diagnostics.finish();
    ::setenv("CAPLET_ROWS", "all", 1);  // as host_kernels.cl is
    const FlatScene flat = lower(scene);
    Checker checker(flat, numbers);
    for (int i = 0; i < 16 && (i < 2 || !numbers.ended()); ++i)
      checker.ray(make_ray(numbers, flat.world));
    float p[3];
    for (float& x : p) {
      x = numbers.number();
      if (!(std::abs(x) <= static_cast<float>(largest_length))) x = 0;
    }
    checker.light(p);
  });
}

}  // namespace caplet::test
