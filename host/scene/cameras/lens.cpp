// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/cameras/lens.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <utility>

namespace caplet {

namespace {

constexpr double per_mm = 0.001;
constexpr int mask_size = 256;  // pbrt-v4's

double index_of(const LensElement& element) { return element.eta > 0 ? element.eta : 1; }

/// A lens as paraxial rays see it: the focal length, and how far behind the last surface parallel
/// rays meet.
struct Paraxial {
  double focal_length = 0, behind = 0;
};

/// Follows a ray at height 1 parallel to the axis. Elements in the order in which it meets them;
/// `eta`: the index before the first. Lengths in mm.
Paraxial paraxial_of(const std::vector<LensElement>& elements, double eta) {
  double height = 1, angle = 0;  // angle: index times slope
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const double next = index_of(elements[i]);
    if (elements[i].radius != 0) angle -= height * (next - eta) / elements[i].radius;
    if (i + 1 < elements.size()) height += angle * elements[i].thickness / next;
    eta = next;
  }
  return {-eta / angle, -eta * height / angle};
}

/// Returns the lens as it is from the film.
std::vector<LensElement> turned(const std::vector<LensElement>& elements) {
  std::vector<LensElement> out(elements.rbegin(), elements.rend());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t at = elements.size() - 1 - i;
    out[i].radius = -elements[at].radius;
    out[i].thickness = at > 0 ? elements[at - 1].thickness : 0;
    out[i].eta = at > 0 ? elements[at - 1].eta : 0;
  }
  return out;
}

/// Returns whether a point lies in a polygon, by the even-odd rule.
bool is_inside(const std::vector<glm::dvec2>& polygon, const glm::dvec2& at) {
  bool inside = false;
  for (std::size_t i = 0, before = polygon.size() - 1; i < polygon.size(); before = i++) {
    const glm::dvec2 &a = polygon[i], &b = polygon[before];
    if ((a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) * (b.x - a.x) / (b.y - a.y))
      inside = !inside;
  }
  return inside;
}

/// Returns corners at angles from +y, or of a star from +x, as pbrt-v4 places them.
std::vector<glm::dvec2> corners(const std::string& name) {
  std::vector<glm::dvec2> out;
  constexpr double fifth = 2 * std::numbers::pi / 5;
  if (name == "square") return {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
  if (name == "pentagon")
    for (int i = 0; i < 5; ++i)
      out.push_back(0.8 * glm::dvec2(std::sin(i * fifth), std::cos(i * fifth)));
  if (name == "star")
    for (int i = 0; i < 10; ++i) {
      const double r = i % 2 == 1 ? 1 : std::cos(fifth) / std::cos(fifth / 2);
      out.push_back(r * glm::dvec2(std::cos(i * fifth / 2), std::sin(i * fifth / 2)));
    }
  return out;
}

}  // namespace

std::shared_ptr<const ApertureMask> aperture_mask(const std::string& name) {
  if (std::ranges::find(aperture_names, name) == aperture_names.end()) return nullptr;
  ApertureMask mask{name, mask_size, mask_size, {}};
  const std::vector<glm::dvec2> polygon = corners(name);
  for (int row = 0; row < mask_size; ++row)
    for (int column = 0; column < mask_size; ++column) {
      const glm::dvec2 at((2 * column + 1.0) / mask_size - 1, 1 - (2 * row + 1.0) / mask_size);
      const double value = polygon.empty()
                               ? std::max(0.0, std::exp(-glm::dot(at, at)) - std::exp(-1.0))
                               : (is_inside(polygon, at) ? 1 : 0);
      mask.values.push_back(static_cast<float>(value));
    }
  normalize(mask);
  return std::make_shared<const ApertureMask>(std::move(mask));
}

bool normalize(ApertureMask& mask) {
  double sum = 0;
  for (float& value : mask.values) {
    value = std::max(value, 0.0f);
    sum += static_cast<double>(value);
  }
  if (!(sum > 0 && std::isfinite(sum))) return false;
  const double scale = std::numbers::pi / 4 * static_cast<double>(mask.values.size()) / sum;
  for (float& value : mask.values) value = static_cast<float>(value * scale);
  return true;
}

const std::vector<LensElement>& plain_lens() {
  // The radii are 2 (n - 1) 50 mm. n: of BK7 at 587.6 nm.
  static const std::vector<LensElement> lens = {
      {0, 1, 1, 25}, {51.68, 4, 1.5168, 25}, {-51.68, 50, 1, 25}};
  return lens;
}

std::optional<FocusedLens> FocusedLens::of(const std::vector<LensElement>& elements,
                                           double aperture, double focus, std::string& problem) {
  if (elements.empty()) {
    problem = "the lens has no surface";
    return std::nullopt;
  }
  const Paraxial to_film = paraxial_of(elements, 1),
                 to_scene = paraxial_of(turned(elements), index_of(elements.back()));
  const double f = to_film.focal_length * per_mm;
  if (!(f > 0 && std::isfinite(f))) {
    problem = "the lens does not gather light";
    return std::nullopt;
  }
  double length = 0;  // from the first surface to the last
  for (std::size_t i = 0; i + 1 < elements.size(); ++i) length += elements[i].thickness * per_mm;
  // Principal planes, as distances from the last surface towards the film.
  const double of_film = to_film.behind * per_mm - f,
               of_scene = f - to_scene.behind * per_mm - length;
  // Between the planes a ray keeps its height; beside them 1 / f = 1 / object + 1 / image.
  const double reach = focus - (of_film - of_scene);
  const double root = reach * (reach - 4 * f);
  if (!(reach > 0 && root >= 0)) {
    problem = "the lens cannot focus so near";
    return std::nullopt;
  }
  const double image = 2 * f * reach / (reach + std::sqrt(root));
  FocusedLens out;
  double z = image + of_film;
  if (!(z > 0)) {
    problem = "the film would lie inside the lens";
    return std::nullopt;
  }
  out.image_distance_ = image;
  out.principal_z_ = z - of_scene;
  for (std::size_t i = elements.size(); i-- > 0;) {
    const LensElement& element = elements[i];
    const double scene_side = i > 0 ? index_of(elements[i - 1]) : 1;
    double diameter = element.diameter;
    if (element.radius == 0) diameter = std::min(diameter, aperture);
    out.surfaces_.push_back({element.radius * per_mm, z,
                             element.radius == 0 ? 1 : index_of(element) / scene_side,
                             diameter / 2 * per_mm});
    if (i > 0) z += elements[i - 1].thickness * per_mm;
  }
  const auto is_stop = [](const Surface& of) { return of.radius == 0; };
  auto stop = std::ranges::find_if(out.surfaces_, is_stop);
  if (stop == out.surfaces_.end())
    stop = std::ranges::min_element(out.surfaces_, {}, &Surface::half);
  out.stop_ = static_cast<std::size_t>(stop - out.surfaces_.begin());
  return out;
}

namespace {

/// Moves a ray to a surface. Returns the normal that faces it.
std::optional<glm::dvec3> move_to(const FocusedLens::Surface& surface, CameraRay& ray) {
  const glm::dvec3 o = ray.origin - glm::dvec3(0, 0, surface.z), d = ray.direction;
  if (surface.radius == 0) {
    ray.origin += (-o.z / d.z) * d;
    return glm::dvec3(0, 0, -1);
  }
  const double side = surface.radius > 0 ? 1 : -1;
  const double b = glm::dot(o, d) + surface.radius * d.z,
               c = glm::dot(o, o) + 2 * surface.radius * o.z;
  const double square = b * b - c;
  if (!(square >= 0)) return std::nullopt;
  const double root = side * std::sqrt(square);
  const double t = side * b > 0 ? -c / (b + root) : root - b;
  if (!(t >= 0)) return std::nullopt;
  ray.origin += t * d;
  const glm::dvec3 normal =
      (o + t * d + glm::dvec3(0, 0, surface.radius)) / std::abs(surface.radius);
  return glm::dot(normal, d) < 0 ? normal : -normal;
}

}  // namespace

std::optional<CameraRay> FocusedLens::trace(CameraRay ray, bool is_clipped) const {
  for (const Surface& surface : surfaces_) {
    const auto normal = move_to(surface, ray);
    if (!normal) return std::nullopt;
    if (is_clipped && std::hypot(ray.origin.x, ray.origin.y) > surface.half) return std::nullopt;
    if (surface.radius == 0) continue;
    const double cosine = -glm::dot(*normal, ray.direction),
                 sine2 = surface.eta * surface.eta * (1 - cosine * cosine);
    if (!(sine2 < 1)) return std::nullopt;
    ray.direction = glm::normalize(surface.eta * ray.direction +
                                   (surface.eta * cosine - std::sqrt(1 - sine2)) * *normal);
  }
  return ray;
}

std::optional<double> FocusedLens::at_stop(double film_x, double rear_x) const {
  FocusedLens part;
  part.surfaces_.assign(surfaces_.begin(),
                        surfaces_.begin() + static_cast<std::ptrdiff_t>(stop_) + 1);
  const glm::dvec3 from(film_x, 0, 0);
  const auto out =
      part.trace({from, glm::normalize(glm::dvec3(rear_x, 0, rear_z()) - from)}, false);
  return out ? std::optional(out->origin.x) : std::nullopt;
}

std::optional<double> FocusedLens::chief_x(double film_x) const {
  // Rays through two places of the rear plane pass the stop on both sides of its middle.
  constexpr int places = 64;
  const double reach = 1.5 * surfaces_.front().half;
  std::optional<double> nearest;
  double least = HUGE_VAL, low = 0, at_low = 0;
  bool has_low = false;
  for (int i = 0; i <= places; ++i) {
    const double x = reach * (2.0 * i / places - 1);
    const auto at = at_stop(film_x, x);
    if (at && has_low && (*at > 0) != (at_low > 0)) {
      double high = x;
      for (int halvings = 0; halvings < 60; ++halvings) {
        const double middle = (low + high) / 2;
        const bool is_low = (at_stop(film_x, middle).value_or(at_low) > 0) == (at_low > 0);
        (is_low ? low : high) = middle;
      }
      return (low + high) / 2;
    }
    if (at && std::abs(*at) < least) {
      least = std::abs(*at);
      nearest = x;
    }
    has_low = at.has_value();
    if (at) at_low = *at;
    low = x;
  }
  return nearest;
}

CameraRay FocusedLens::chief_ray(double film_x) const {
  const glm::dvec3 from(film_x, 0, 0);
  const glm::dvec3 to(chief_x(film_x).value_or(0), 0, rear_z());
  const CameraRay inside{from, glm::normalize(to - from)};
  return trace(inside, false).value_or(inside);
}

FocusedLens::Pupil FocusedLens::pupil_at(double film_x) const {
  constexpr int columns = 48, rows = 24, rounds = 3, most_misses = 20;
  const double widest = 1.5 * surfaces_.front().half;
  const glm::dvec3 from(film_x, 0, 0);
  // Each round looks closer at what the one before has found. Pupils are even in y.
  Pupil within{-widest, widest, -widest, widest};
  for (int round = 0, misses = 0; round < rounds;) {
    const double dx = (within.x1 - within.x0) / columns, dy = within.y1 / rows;
    Pupil found{HUGE_VAL, -HUGE_VAL, 0, 0};
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double x = within.x0 + (column + 0.5) * dx, y = (row + 0.5) * dy;
        if (!trace({from, glm::normalize(glm::dvec3(x, y, rear_z()) - from)})) continue;
        found.x0 = std::min(found.x0, x);
        found.x1 = std::max(found.x1, x);
        found.y1 = std::max(found.y1, y);
      }
    if (found.x0 > found.x1) {
      // One that is smaller than a step lies around the chief ray.
      const auto middle = chief_x(film_x);
      if (!middle || ++misses > most_misses) return {};
      const double reach = std::ldexp(widest, -misses);
      within = {*middle - reach, *middle + reach, -reach, reach};
      continue;
    }
    ++round;
    within = {found.x0 - dx, found.x1 + dx, -(found.y1 + dy), found.y1 + dy};
  }
  return within;
}

std::vector<FocusedLens::Pupil> FocusedLens::pupils(double most, std::size_t count) const {
  std::vector<Pupil> at, out;
  for (std::size_t i = 0; i <= count; ++i)
    at.push_back(pupil_at(most * static_cast<double>(i) / static_cast<double>(count)));
  for (std::size_t i = 0; i < count; ++i) {
    const Pupil &a = at[i], &b = at[i + 1];
    if (!(a.x0 < a.x1))
      out.push_back(b);
    else if (!(b.x0 < b.x1))
      out.push_back(a);
    else
      out.push_back(
          {std::min(a.x0, b.x0), std::max(a.x1, b.x1), std::min(a.y0, b.y0), std::max(a.y1, b.y1)});
  }
  return out;
}

}  // namespace caplet
