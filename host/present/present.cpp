// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "present/present.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "present/lights.h"
#include "present/picture_options.h"
#include "scene/principal_axes.h"

namespace caplet {

namespace {

/// A scene is flat if its least extent is below this part of its middle one (standard deviations
/// along the principal axes).
constexpr double kFlat = 0.35;

// --- What is to be framed ---

struct Ball {
  glm::dvec3 center;
  double radius;
};

/// Balls are spheres whose hull contains every shape: a capsule's ends, balls themselves, the
/// corners of the bounds of anything else and of each instance's object. Without shapes it is the
/// unit ball, as in bounds_or_unit_of. Those of capsules take no memory: they are made again
/// wherever they are needed. It refers to the scene.
class Balls {
 public:
  explicit Balls(const Scene& scene) {
    const bool is_empty =
        std::ranges::all_of(scene.shapes, &Shape::is_backdrop) && scene.instances.empty();
    for (const Shape& shape : scene.shapes)
      if (!shape.is_backdrop || is_empty) add(shape);
    add_instances(scene);
    if (size_ == 0) add({glm::dvec3(0), 1});
  }

  std::size_t size() const { return size_; }
  /// Turns them about the origin.
  void turn(const glm::dmat3& by) { turn_ = by; }
  template <class Function>
  void for_each(const Function& function) const {
    const auto turned = [&](Ball ball) {
      if (turn_) ball.center = *turn_ * ball.center;
      function(ball);
    };
    for (const Part& part : parts_) {
      std::ranges::for_each(part.balls, turned);
      if (part.capsules == nullptr) continue;
      const CapsulesShape& of = *part.capsules;
      for (std::size_t i = 0; i < of.p0.size(); ++i) {
        const float radius1 = of.radius1.empty() ? of.radius0[i] : of.radius1[i];
        turned({place(part.world, of.p0[i]), part.scale * of.radius0[i]});
        turned({place(part.world, of.p1[i]), part.scale * radius1});
      }
    }
  }

 private:
  /// Part is some balls, and after them those of capsules.
  struct Part {
    std::vector<Ball> balls{};
    const CapsulesShape* capsules = nullptr;
    glm::dmat4 world{1};
    double scale = 1;
  };

  static glm::dvec3 place(const glm::dmat4& world, const glm::dvec3& p) {
    return glm::dvec3(world * glm::dvec4(p, 1));
  }

  /// Returns how long a transform makes a radius at most.
  static double scale_of(const glm::dmat4& world) {
    const glm::dmat3 linear(world);
    // The Frobenius norm bounds the largest stretch; divided by sqrt(3) it is that of a uniform
    // scale.
    const double stretch =
        std::sqrt(glm::dot(linear[0], linear[0]) + glm::dot(linear[1], linear[1]) +
                  glm::dot(linear[2], linear[2]));
    const bool uniform = std::abs(glm::dot(linear[0], linear[1])) +
                             std::abs(glm::dot(linear[1], linear[2])) +
                             std::abs(glm::dot(linear[2], linear[0])) <=
                         1e-12 * stretch * stretch;
    return uniform
               ? std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])})
               : stretch;
  }

  void add(const Ball& ball) {
    if (parts_.empty() || parts_.back().capsules != nullptr) parts_.emplace_back();
    parts_.back().balls.push_back(ball);
    ++size_;
  }

  void add_corners(const Bounds& bounds, const glm::dmat4& world = glm::dmat4(1)) {
    if (bounds.empty()) return;
    for (int corner = 0; corner < 8; ++corner)
      add({place(world, {corner & 1 ? bounds.max.x : bounds.min.x,
                         corner & 2 ? bounds.max.y : bounds.min.y,
                         corner & 4 ? bounds.max.z : bounds.min.z}),
           0});
  }

  void add_instances(const Scene& scene) {
    std::vector<Bounds> of_objects(scene.objects.size());
    Scene moving;
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
      for (const Shape& shape : scene.objects[i].shapes) of_objects[i].extend(bounds_of(shape));
    for (const Instance& instance : scene.instances) {
      if (instance.motion.empty())
        add_corners(of_objects[instance.object], instance.world_from_object);
      else
        moving.instances.push_back(instance);
    }
    if (moving.instances.empty()) return;
    moving.objects = scene.objects;
    add_corners(bounds_of(moving));
  }

  void add(const Shape& shape) {
    const glm::dmat4& world = shape.world_from_object;
    const double scale = scale_of(world);
    if (const auto* sphere = std::get_if<SphereShape>(&shape.geometry)) {
      add({place(world, {0, 0, 0}), scale * sphere->radius});
    } else if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) {
      parts_.push_back({{}, capsules, world, scale});
      size_ += 2 * capsules->p0.size();
    } else if (const auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry)) {
      for (std::size_t i = 0; i < molecule->centers.size(); ++i)
        add({place(world, molecule->centers[i]), scale * molecule->radii[i]});
    } else {
      add_corners(bounds_of(shape));
    }
  }

  std::vector<Part> parts_;
  std::size_t size_ = 0;
  std::optional<glm::dmat3> turn_;
};

// --- The direction of view ---

struct Axes {
  glm::dvec3 extent{0};  // standard deviations, largest first
  glm::dmat3 axis{1};    // columns, unit
};

/// Returns the principal axes of the balls' centres.
Axes axes_of(const Balls& balls) {
  const auto count = static_cast<double>(balls.size());
  glm::dvec3 mean(0);
  balls.for_each([&](const Ball& ball) { mean += ball.center / count; });
  glm::dmat3 covariance(0);
  balls.for_each([&](const Ball& ball) {
    const glm::dvec3 d = ball.center - mean;
    covariance += glm::outerProduct(d, d) / count;
  });
  const PrincipalAxes found = principal_axes(covariance);
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, std::greater(), [&](int k) { return found.values[k]; });
  Axes axes;
  for (int i = 0; i < 3; ++i) {
    const int from = order[static_cast<std::size_t>(i)];
    axes.extent[i] = std::sqrt(std::max(0.0, found.values[from]));
    axes.axis[i] = found.world_from_axes[from];
  }
  return axes;
}

/// The world is right-handed, so `right` x `up` points back at the viewer.
struct ViewFrame {
  glm::dvec3 right, up, forward;
};

/// `toward_viewer` may have any length. y is up unless the view is along it; then -z is.
ViewFrame view_from(const glm::dvec3& toward_viewer) {
  ViewFrame view;
  view.forward = -glm::normalize(toward_viewer);
  const bool steep = std::abs(view.forward.y) > 0.95;
  const glm::dvec3 up = steep ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
  view.right = glm::normalize(glm::cross(view.forward, up));
  view.up = glm::cross(view.right, view.forward);
  return view;
}

/// Returns a requested view, with y up however steep it is. From above, the front is at the bottom
/// of the image; from below, at the top.
ViewFrame view_asked(const glm::dvec3& toward_viewer) {
  ViewFrame view;
  view.forward = -glm::normalize(toward_viewer);
  const bool is_upright = std::abs(view.forward.y) > 1 - 1e-12;
  const glm::dvec3 up = is_upright ? glm::dvec3(0, 0, view.forward.y) : glm::dvec3(0, 1, 0);
  view.right = glm::normalize(glm::cross(view.forward, up));
  view.up = glm::cross(view.right, view.forward);
  return view;
}

/// Turns the viewer to the right by `azimuth` and up by `elevation`.
ViewFrame turned(const ViewFrame& view, double azimuth, double elevation) {
  const glm::dvec3 level = -view.forward * std::cos(azimuth) + view.right * std::sin(azimuth);
  return view_from(level * std::cos(elevation) + view.up * std::sin(elevation));
}

bool is_flat(const Axes& axes) { return axes.extent[2] < kFlat * axes.extent[1]; }

/// For scenes without an up axis: makes a quarter turn where the longer side then fits the image's
/// longer side clearly better.
ViewFrame along_image(const ViewFrame& view, const Balls& balls, double aspect) {
  glm::dvec2 low(1e300), high(-1e300);
  balls.for_each([&](const Ball& ball) {
    const glm::dvec2 p(glm::dot(view.right, ball.center), glm::dot(view.up, ball.center));
    low = glm::min(low, p - ball.radius);
    high = glm::max(high, p + ball.radius);
  });
  const glm::dvec2 size = high - low;
  const double upright = std::max(size.x / aspect, size.y),
               turned = std::max(size.y / aspect, size.x);
  return turned < 0.8 * upright ? ViewFrame{view.up, -view.right, view.forward} : view;
}

ViewFrame choose_view(const Balls& balls) {
  const Axes axes = axes_of(balls);
  const auto facing = [](glm::dvec3 n) {
    // The viewer is in front, above or at the right, whichever is nearest to the normal.
    const glm::dvec3 size = glm::abs(n);
    const double main = size.z >= size.x && size.z >= size.y ? n.z : (size.y >= size.x ? n.y : n.x);
    return main < 0 ? -n : n;
  };
  if (is_flat(axes))
    return turned(view_from(facing(axes.axis[2])), glm::radians(10.0), glm::radians(6.0));
  // A volume is seen three-quarter, across its widest horizontal direction.
  glm::dvec3 wide(axes.axis[0].x, 0, axes.axis[0].z);
  if (glm::length(wide) < 0.5) wide = {axes.axis[1].x, 0, axes.axis[1].z};
  glm::dvec3 across = glm::length(wide) > 0 ? glm::cross(glm::normalize(wide), glm::dvec3(0, 1, 0))
                                            : glm::dvec3(0, 0, 1);
  return turned(view_from(facing(across)), glm::radians(30.0), glm::radians(18.0));
}

/// Returns the view of the scene's framing; the balls are in world space.
ViewFrame framed_view(const Scene& scene, const Balls& balls) {
  const Framing& framing = scene.framing;
  const double aspect = static_cast<double>(scene.view.film.width) / scene.view.film.height;
  ViewFrame view;
  if (!framing.up) {
    view = framing.toward_viewer ? view_asked(*framing.toward_viewer) : choose_view(balls);
  } else {
    const glm::dmat3 turn = turned_up(*framing.up), back = glm::transpose(turn);
    if (framing.toward_viewer) {
      view = view_asked(turn * *framing.toward_viewer);
    } else {
      Balls upright = balls;
      upright.turn(turn);
      view = choose_view(upright);
    }
    view = {back * view.right, back * view.up, back * view.forward};
  }
  return scene.has_no_up && !framing.up && !framing.toward_viewer ? along_image(view, balls, aspect)
                                                                  : view;
}

void set_camera(Scene& scene, const ViewFrame& view, const glm::dvec3& eye,
                const Projection& projection) {
  scene.view.camera = Camera{};
  scene.view.camera.world_from_camera =
      glm::dmat4(glm::dvec4(view.right, 0), glm::dvec4(view.up, 0), glm::dvec4(view.forward, 0),
                 glm::dvec4(eye, 1));
  scene.view.camera.projection = projection;
  scene.automatic_camera = true;
}

/// The camera stands one extent before the nearest point, for the depth layer; the picture does not
/// depend on it.
void frame_orthographic(Scene& scene, const ViewFrame& view, const Balls& balls) {
  glm::dvec3 low(1e300), high(-1e300);
  balls.for_each([&](const Ball& ball) {
    const glm::dvec3 p(glm::dot(view.right, ball.center), glm::dot(view.up, ball.center),
                       glm::dot(view.forward, ball.center));
    low = glm::min(low, p - ball.radius);
    high = glm::max(high, p + ball.radius);
  });
  const glm::dvec3 middle = 0.5 * (low + high), half = 0.5 * (high - low) / (1 - frame_margin);
  const double width = scene.view.film.width, height = scene.view.film.height;
  double per_pixel = std::max(2 * half.x / width, 2 * half.y / height);
  if (!(per_pixel > 0)) per_pixel = 1 / width;  // a single point
  const double away = 2 * std::max({half.x, half.y, half.z});
  set_camera(scene, view,
             middle.x * view.right + middle.y * view.up + (low.z - away) * view.forward,
             OrthographicProjection{});
  const double x = 0.5 * per_pixel * width, y = 0.5 * per_pixel * height;
  scene.view.camera.screen_window = {-x, x, -y, y};
}

}  // namespace

void frame_camera(Scene& scene) {
  const Balls balls(scene);
  const ViewFrame view = framed_view(scene, balls);
  if (scene.framing.is_orthographic) return frame_orthographic(scene, view, balls);
  const double width = scene.view.film.width, height = scene.view.film.height,
               shorter = std::min(width, height);

  // A ball is inside a side of the view pyramid when its centre is one radius behind the plane.
  // With the plane's angle a to the axis, the apex (x, z) must satisfy cos(a) x - sin(a) z >= R and
  // -cos(a) x - sin(a) z >= L, R and L being the largest of
  // +-cos(a) cx - sin(a) cz + r; both are equal when x is centred, which gives the nearest apex.
  const double half = std::tan(automatic_field_of_view / 2) * (1 - frame_margin);
  struct Side {
    double sine, cosine, right, left;
  };
  const auto fit = [&](const glm::dvec3& across, double tangent) {
    const double angle = std::atan(tangent);
    Side side{std::sin(angle), std::cos(angle), -1e300, -1e300};
    balls.for_each([&](const Ball& ball) {
      const double x = side.cosine * glm::dot(across, ball.center);
      const double depth = ball.radius - side.sine * glm::dot(view.forward, ball.center);
      side.right = std::max(side.right, x + depth);
      side.left = std::max(side.left, -x + depth);
    });
    return side;
  };
  const Side horizontal = fit(view.right, half * width / shorter),
             vertical = fit(view.up, half * height / shorter);
  const auto nearest = [](const Side& side) { return -(side.right + side.left) / (2 * side.sine); };
  const double z = std::min(nearest(horizontal), nearest(vertical));
  const double x = (horizontal.right - horizontal.left) / (2 * horizontal.cosine);
  const double y = (vertical.right - vertical.left) / (2 * vertical.cosine);
  const glm::dvec3 eye = x * view.right + y * view.up + z * view.forward;
  set_camera(scene, view, eye, PerspectiveProjection{automatic_field_of_view});
}

Bounds bounds_or_unit_of(const Scene& scene) {
  const Bounds bounds = bounds_of(scene);
  return bounds.empty() ? Bounds{glm::dvec3(-1), glm::dvec3(1)} : bounds;
}

bool can_be_framed(const Scene& scene) {
  if (scene.shapes.empty() && scene.instances.empty()) return true;
  const Bounds bounds = bounds_of(scene);
  return !bounds.empty() && std::isfinite(glm::length(bounds.max - bounds.min));
}

bool is_lit(const Scene& scene) {
  const auto emits = [](const Shape& shape) { return shape.emission.has_value(); };
  return !scene.lights.empty() || std::ranges::any_of(scene.shapes, emits) ||
         std::ranges::any_of(scene.objects, [&](const Object& object) {
           return std::ranges::any_of(object.shapes, emits);
         });
}

void add_studio_light(Scene& scene) {
  InfiniteLight light;
  light.image = studio_image();
  light.world_from_light = around(scene.view.camera);
  scene.lights.push_back({light, 1, {}, {}, {scene.source, 0, 0}});
}

void add_presentation(Scene& scene) {
  frame_camera(scene);
  add_studio_light(scene);
}

void move_camera(Scene& scene, const Camera& to) {
  const glm::dmat3 turn = glm::dmat3(to.world_from_camera) *
                          glm::inverse(glm::dmat3(scene.view.camera.world_from_camera));
  scene.view.camera = to;
  for (Light& light : scene.lights)
    if (is_preset(light)) {
      auto& infinite = std::get<InfiniteLight>(light.model);
      infinite.world_from_light = turn * infinite.world_from_light;
    }
}

glm::dvec3 palette_color(std::size_t index) {
  static constexpr std::array<std::array<double, 3>, 10> colors = {{
      {0.12, 0.48, 0.82},  // blue
      {0.85, 0.23, 0.12},  // red
      {0.86, 0.62, 0.22},  // amber
      {0.16, 0.56, 0.28},  // green
      {0.66, 0.22, 0.66},  // purple
      {0.12, 0.62, 0.60},  // teal
      {0.86, 0.36, 0.50},  // pink
      {0.52, 0.66, 0.16},  // lime
      {0.45, 0.27, 0.16},  // brown
      {0.62, 0.63, 0.62},  // grey
  }};
  const auto& color = colors[index % colors.size()];
  return {color[0], color[1], color[2]};
}

}  // namespace caplet
