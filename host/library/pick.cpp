// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/pick.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "library/detail/inside.h"
#include "library/detail/questions.h"
#include "lower/camera.h"
#include "lower/identity.h"
#include "lower/lower.h"
#include "present/film_window.h"
#include "render/known_answers.h"
#include "render/query.h"
#include "scene/carried.h"
#include "scene/frozen.h"

namespace caplet::v0 {

namespace {

RayRecord to_record(const Ray& ray) {
  return {ray.origin[0],    ray.origin[1],    ray.origin[2],    ray.t_min,
          ray.direction[0], ray.direction[1], ray.direction[2], ray.t_max};
}

std::vector<RayRecord> to_records(std::span<const Ray> rays) {
  std::vector<RayRecord> out(rays.size());
  std::ranges::transform(rays, out.begin(), to_record);
  return out;
}

/// Returns the rays' times as Query takes them: none where nothing moves.
std::vector<float> times_of(std::span<const Ray> rays, const caplet::Scene& scene) {
  if (!moves(scene)) return {};
  const double open = scene.view.film.shutter_open, seconds = scene.view.film.open_time();
  std::vector<float> out(rays.size());
  std::ranges::transform(rays, out.begin(), [&](const Ray& ray) {
    const double part = (ray.time - open) / seconds;
    return part > 0 ? static_cast<float>(std::min(part, 1.0)) : 0.0F;  // 0 for what is no number
  });
  return out;
}

Hit to_hit(const PickRecord& pick, const caplet::Scene& scene) {
  const Identity identity = identity_of(scene, pick);
  Hit hit;
  hit.t = pick.t;
  std::ranges::copy(pick.point, hit.point.begin());
  std::ranges::copy(pick.normal, hit.normal.begin());
  hit.uv = {pick.u, pick.v};
  hit.error = pick.error;
  hit.entering = pick.leaving == 0;
  hit.object = identity.shape->name;
  hit.material = scene.materials[pick.material].name;
  hit.object_id = pick.object;
  hit.material_id = pick.material;
  hit.primitive = pick.primitive;
  hit.surface = pick.surface;
  hit.instance = identity.instance;
  return hit;
}

std::optional<Hit> to_nearest(const PickRecord& pick, const caplet::Scene& scene) {
  return pick.object == CAPLET_NONE ? std::nullopt : std::optional(to_hit(pick, scene));
}

constexpr std::size_t rays_at_once = std::size_t{1} << 18;

/// Converts crossings to plain numbers.
class Numbers {
 public:
  explicit Numbers(const caplet::Scene& scene) : scene_(scene) {
    std::size_t shapes = scene.shapes.size();
    for (const Object& object : scene.objects) {
      first_.push_back(shapes);
      shapes += object.shapes.size();
    }
  }
  Crossing crossing(const PickRecord& pick, std::size_t ray) const {
    Crossing out;
    out.ray = static_cast<std::uint32_t>(ray);
    if (pick.object == CAPLET_NONE) return out;
    out.t = pick.t;
    out.error = pick.error;
    out.uv = {pick.u, pick.v};
    out.object_id = pick.object;
    out.material_id = pick.material;
    out.primitive = pick.primitive;
    out.surface = pick.surface;
    out.leaving = pick.leaving;
    std::ranges::copy(pick.point, out.point.begin());
    std::ranges::copy(pick.normal, out.normal.begin());
    if (pick.object < scene_.shapes.size()) {
      out.shape = pick.object;
      return out;
    }
    const Identity identity = identity_of(scene_, pick);
    out.instance = identity.instance.value_or(Crossing::none);
    const std::uint32_t object = scene_.instances[out.instance].object;
    out.shape = static_cast<std::uint32_t>(
        first_[object] +
        static_cast<std::size_t>(identity.shape - scene_.objects[object].shapes.data()));
    return out;
  }

  /// Returns the surface of a crossing; none for a miss. Throws InputError where the scene has no
  /// such surface.
  std::optional<SurfacePlace> place(const Crossing& hit) const {
    if (hit.shape == Crossing::none) return std::nullopt;
    SurfacePlace out{{}, hit.shape, hit.primitive};
    const std::vector<Shape>* shapes = &scene_.shapes;
    if (hit.instance != Crossing::none) {
      if (hit.instance >= scene_.instances.size()) throw no_surface(hit);
      out.instance = hit.instance;
      const std::uint32_t object = scene_.instances[hit.instance].object;
      shapes = &scene_.objects[object].shapes;
      out.shape = hit.shape - first_[object];  // wraps where it is before the first
    }
    if (out.shape >= shapes->size() || out.primitive >= primitive_count((*shapes)[out.shape]))
      throw no_surface(hit);
    return out;
  }

 private:
  static InputError no_surface(const Crossing& hit) {
    return InputError(
        fmt::format("the scene has no primitive {} of shape {}{}", hit.primitive, hit.shape,
                    hit.instance == Crossing::none ? std::string()
                                                   : fmt::format(" in instance {}", hit.instance)));
  }

  const caplet::Scene& scene_;
  std::vector<std::size_t> first_;
};

}  // namespace

std::optional<Hit> Questions::pixel(int x, int y) const {
  check_pixel({x, y}, scene.view.film);
  try_device(device, {.shapes = shapes, .nearest = true});
  const RayRecord ray = ray_of_pixel(scene, x, y);
  return to_nearest(query.closest(std::span(&ray, 1)).front(), scene);
}

std::vector<std::optional<Hit>> Questions::nearest(std::span<const Ray> rays) const {
  try_device(device, {.shapes = shapes, .nearest = true});
  std::vector<std::optional<Hit>> out;
  if (rays.empty()) return out;
  out.reserve(rays.size());
  for (const PickRecord& pick : query.closest(to_records(rays), times_of(rays, scene)))
    out.push_back(to_nearest(pick, scene));
  return out;
}

template <class Take>
void Questions::for_lists(std::span<const Ray> rays, std::size_t most, Take&& take) const {
  if (most < 1 || most > max_query_capacity)
    throw InputError(
        fmt::format("{} hits of a ray: that is not within 1 to {}", most, max_query_capacity));
  try_device(device, {.shapes = shapes, .lists = true});
  if (rays.empty()) return;
  const HitLists lists = query.all(to_records(rays), most, times_of(rays, scene));
  if (!lists.overflowed.empty())
    throw RunError(fmt::format("ray {} has more than {} hits, as {} in all", lists.overflowed[0],
                               most, lists.overflowed.size()));
  for (std::size_t i = 0; i < rays.size(); ++i)
    for (std::size_t k = lists.begin[i]; k < lists.begin[i + 1]; ++k) take(i, lists.crossings[k]);
}

std::vector<std::vector<Hit>> Questions::all(std::span<const Ray> rays, std::size_t most) const {
  std::vector<std::vector<Hit>> out(rays.size());
  for_lists(rays, most, [&](std::size_t ray, const PickRecord& pick) {
    out[ray].push_back(to_hit(pick, scene));
  });
  return out;
}

void Questions::nearest(std::span<const Ray> rays, std::span<Crossing> out) const {
  if (out.size() != rays.size())
    throw InputError(fmt::format("{} rays and room for {} hits", rays.size(), out.size()));
  try_device(device, {.shapes = shapes, .nearest = true});
  const Numbers numbers(scene);
  for (std::size_t first = 0; first < rays.size(); first += rays_at_once) {
    const std::size_t count = std::min(rays_at_once, rays.size() - first);
    const std::span<const Ray> part = rays.subspan(first, count);
    const std::vector<PickRecord> picks = query.closest(to_records(part), times_of(part, scene));
    for (std::size_t i = 0; i < count; ++i) out[first + i] = numbers.crossing(picks[i], first + i);
  }
}

std::vector<Crossing> Questions::crossings(std::span<const Ray> rays, std::size_t most) const {
  std::vector<Crossing> out;
  const Numbers numbers(scene);
  for_lists(rays, most, [&](std::size_t ray, const PickRecord& pick) {
    out.push_back(numbers.crossing(pick, ray));
  });
  return out;
}

struct Picker::Data {
  Data(std::shared_ptr<const caplet::Scene> model, const FlatScene& flat, const caplet::Device& on)
      : scene(std::move(model)), shapes(flat.shapes), device(on), query(flat, on) {}
  Questions questions() { return {query, *scene, shapes, device}; }

  std::shared_ptr<const caplet::Scene> scene;
  std::uint64_t shapes;
  caplet::Device device;
  Query query;
};

Picker::Picker(const Scene& scene, const Device& device) {
  const caplet::Device& on = Inside::device(device);
  data_ = std::make_unique<Data>(Inside::model(scene), lower(*Inside::model(scene)), on);
}
Picker::Picker(Picker&&) noexcept = default;
Picker& Picker::operator=(Picker&&) noexcept = default;
Picker::~Picker() = default;

std::optional<Hit> Picker::pixel(int x, int y) { return data_->questions().pixel(x, y); }
std::optional<Hit> Picker::nearest(const Ray& ray) { return nearest(std::span(&ray, 1)).front(); }
std::vector<std::optional<Hit>> Picker::nearest(std::span<const Ray> rays) {
  return data_->questions().nearest(rays);
}
std::vector<std::vector<Hit>> Picker::all(std::span<const Ray> rays, std::size_t most) {
  return data_->questions().all(rays, most);
}
void Picker::nearest(std::span<const Ray> rays, std::span<Crossing> out) {
  data_->questions().nearest(rays, out);
}
std::vector<Crossing> Picker::crossings(std::span<const Ray> rays, std::size_t most) {
  return data_->questions().crossings(rays, most);
}

void Picker::carry(std::span<const Crossing> hits, double from, double to,
                   std::span<std::array<double, 3>> points) const {
  if (hits.size() != points.size())
    throw InputError(fmt::format("{} hits and {} points", hits.size(), points.size()));
  if (!std::isfinite(from) || !std::isfinite(to))
    throw InputError(fmt::format("times must be finite, not {} and {}", from, to));
  const caplet::Scene& scene = *data_->scene;
  if (!moves(scene)) return;
  const Carrier carrier(scene, from, to);
  const Numbers numbers(scene);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const std::optional<SurfacePlace> place = numbers.place(hits[i]);
    if (!place) continue;
    std::array<double, 3>& p = points[i];
    const glm::dvec3 carried = carrier.carried(*place, {p[0], p[1], p[2]});
    p = {carried.x, carried.y, carried.z};
  }
}

}  // namespace caplet::v0
