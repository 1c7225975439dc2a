// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What edits cost: from an edit to when the first pass of the new picture may begin, and the bytes
// that are sent.
//
// usage: caplet_bench_edits [CAPSULES [DEVICE]]
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <vector>

#include "base/clock.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "render/renderer.h"

namespace caplet {
namespace {

constexpr int times = 101;

class Random {
 public:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  glm::vec3 within(double low, double high) {
    return {uniform(low, high), uniform(low, high), uniform(low, high)};
  }

 private:
  std::mt19937 engine_{1};
};

/// Capsules along walks; 10,000 instances of a hundred more; a sky, a lamp.
Scene make_scene(std::size_t count, Random& random) {
  Scene scene;
  scene.view.film.width = 960;
  scene.view.film.height = 540;
  scene.materials.resize(3);
  const auto walk = [&](std::size_t capsules, double step) {
    CapsulesShape out;
    glm::vec3 at(0);
    for (std::size_t i = 0; i < capsules; ++i) {
      if (i % 1000 == 0) at = random.within(-50, 50);
      const glm::vec3 next = at + random.within(-step, step);
      out.p0.push_back(at);
      out.p1.push_back(next);
      out.radius0.push_back(static_cast<float>(step / 6));
      at = next;
    }
    Shape shape;
    shape.geometry = std::move(out);
    return shape;
  };
  scene.shapes.push_back(walk(count, 0.4));
  Shape& lamp = scene.shapes.emplace_back();
  lamp.geometry = SphereShape{2};
  lamp.world_from_object = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 70));
  lamp.emission.emplace();
  scene.objects.emplace_back().shapes.push_back(walk(100, 0.2));
  for (int i = 0; i < 10000; ++i)
    scene.instances.push_back(
        {0, glm::translate(glm::dmat4(1), glm::dvec3(random.within(-50, 50))), {}});
  scene.lights.push_back({InfiniteLight{}, 1, {}, {}, {}});
  scene.view.camera.world_from_camera = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -150));
  return scene;
}

void run(std::size_t count, const std::string& choice) {
  Random random;
  const Device on = Device::choose(choice);
  Scene scene = make_scene(count, random);
  fmt::print("{} capsules, 10000 instances of 100, {} x {} pixels, on {}\n", count,
             scene.view.film.width, scene.view.film.height, on.info().name);
  Stopwatch watch;
  LiveScene live(std::move(scene));
  fmt::print("{:<28} {:>9.1f} ms\n", "full lowering", 1e3 * watch.lap());
  DeviceScene device(on, live.flat());
  on.finish();
  fmt::print("{:<28} {:>9.1f} ms  {} bytes\n", "sending all of it", 1e3 * watch.lap(),
             live.flat().device_bytes());
  Renderer renderer(device, live.view());
  renderer.pass(renderer.layout().window, 0, 1);
  on.finish();

  const auto measure = [&](const char* what, const std::function<SceneEdit()>& next) {
    std::vector<double> milliseconds, edits;
    const std::uint64_t before = device.bytes_updated(), lowerings = live.lowerings();
    for (int i = 0; i < times; ++i) {
      const SceneEdit edit = next();
      watch.lap();
      live.edit(edit);
      const double edited = watch.lap();
      device.update(live.flat(), live.take_changes());
      renderer.reset(live.view());
      on.finish();
      edits.push_back(1e3 * edited);
      milliseconds.push_back(1e3 * (edited + watch.lap()));
    }
    std::ranges::sort(milliseconds);
    std::ranges::sort(edits);
    fmt::print(
        "{:<28} {:>9.3f} ms  (least {:.3f}, most {:.3f}; the edit itself {:.3f})  {} bytes, {} "
        "full lowerings\n",
        what, milliseconds[times / 2], milliseconds.front(), milliseconds.back(), edits[times / 2],
        (device.bytes_updated() - before) / times, live.lowerings() - lowerings);
    std::fflush(stdout);
  };
  const auto some = [&](std::size_t below) {
    return std::min(static_cast<std::size_t>(random.uniform(0, static_cast<double>(below))),
                    below - 1);
  };
  measure("one capsule moved", [&] {
    const std::size_t i = some(count);
    Capsule to = capsule_at(live.scene(), {}, i);
    const glm::vec3 by = random.within(-1, 1);
    to.p0 += by;
    to.p1 += by;
    return CapsuleEdit{{}, i, to};
  });
  measure("the camera", [&] {
    View to = live.scene().view;
    to.camera.projection = PerspectiveProjection{random.uniform(0.5, 1)};
    return to;
  });
  measure("a material", [&] {
    return MaterialEdit{
        0, DiffuseMaterial{RgbSpectrum{glm::dvec3(random.within(0.1, 0.9)), ColorSpace::srgb}}};
  });
  measure("an instance of 10,000", [&] {
    const auto i = static_cast<std::uint32_t>(some(10000));
    return InstanceEdit{i, glm::translate(live.scene().instances[i].world_from_object,
                                          glm::dvec3(random.within(-1, 1)))};
  });
  measure("a light", [&] {
    Light to = live.scene().lights[0];
    to.scale = random.uniform(0.5, 2);
    return LightEdit{0, to};
  });
  measure("a lamp moved", [&] {
    return TransformEdit{{{}, 1},
                         glm::translate(glm::dmat4(1), glm::dvec3(random.within(-40, 40)))};
  });
}

}  // namespace
}  // namespace caplet

int main(int argc, char** argv) {
  try {
    caplet::run(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1000000, argc > 2 ? argv[2] : "");
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
