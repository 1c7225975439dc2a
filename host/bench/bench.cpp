// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "bench/bench.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>
#include <optional>
#include <span>

#include "base/clock.h"
#include "bench/detail/walks.h"
#include "bench/device_tracer.h"
#include "bench/peer.h"
#include "lower/light_tree.h"
#include "lower/lower.h"
#include "shared/kinds.h"

namespace caplet::bench {

namespace {

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

void say(const Say& line, const std::string& name, double ours, double peer,
         const std::string& unit, const std::string& more = {}) {
  const std::string beside =
      peer > 0 ? fmt::format("\"embree\": {:.4g}, \"ratio\": {:.4g}", peer, ours / peer)
               : "\"embree\": null, \"ratio\": null";
  line(fmt::format("{{\"name\": \"{}\", \"ours\": {:.4g}, {}, \"unit\": \"{}\"{}}}", name, ours,
                   beside, unit, more));
}

enum class Question { closest, any };

struct Bench {
  const Say& line;
  const Peer* peer;  // null: Embree has no such shape
  const std::vector<float>& leaves;
  double seconds;
  bool by_shape = false;  // ids of the peer are not primitive ids

  /// Alternates between both until the time is up, at least three rounds. `ours`: the same rays,
  /// possibly in another order.
  void run(const std::string& name, DeviceTracer& tracer, const std::vector<RayRecord>& ours,
           const std::vector<RayRecord>& theirs, Question question = Question::closest) {
    if (ours.empty()) return;
    const bool any = question == Question::any;
    std::vector<std::uint32_t> ids(theirs.size());
    const auto ask = [&] { any ? tracer.run_any() : tracer.run_closest(); };
    const auto ask_peer = [&] {
      return any ? peer->trace_any(theirs, ids) : peer->trace(theirs, ids);
    };
    tracer.set_rays(ours);
    ask();
    const std::size_t peer_hits = peer ? ask_peer() : 0;
    std::vector<double> a, b;
    const auto begin = Clock::now();
    while (a.size() < 3 || seconds_since(begin) < seconds) {
      auto start = Clock::now();
      ask();
      a.push_back(static_cast<double>(ours.size()) / seconds_since(start) * 1e-6);
      if (peer == nullptr) continue;
      start = Clock::now();
      ask_peer();
      b.push_back(static_cast<double>(theirs.size()) / seconds_since(start) * 1e-6);
    }
    // `found` is the result of each ray, with the peer's numbering.
    std::vector<std::uint32_t> found;
    if (any) {
      for (const int one : tracer.any()) found.push_back(one != 0 ? 1 : 0);
    } else {
      for (const HitRecord& hit : tracer.hits())
        found.push_back(hit.slot == CAPLET_NONE ? CAPLET_NONE
                                                : std::bit_cast<std::uint32_t>(leaves[hit.slot]));
    }
    const auto our_hits = std::count_if(found.begin(), found.end(), [&](std::uint32_t one) {
      return one != (any ? 0 : CAPLET_NONE);
    });
    std::string more = fmt::format(", \"rays\": {}, \"hits\": {}", ours.size(), our_hits);
    if (peer) more += fmt::format(", \"embree_hits\": {}", peer_hits);
    if (peer && &ours == &theirs && (any || !by_shape)) {
      std::size_t same = 0;
      for (std::size_t i = 0; i < found.size(); i++) same += ids[i] == found[i] ? 1 : 0;
      more += fmt::format(", \"{}\": {:.6f}", any ? "same_answer" : "same_primitive",
                          static_cast<double>(same) / static_cast<double>(found.size()));
    }
    say(line, name, median(a), peer ? median(b) : 0, "Mrays/s", more);
  }
};

/// Traces like a renderer: camera rays have a stage of their own.
struct Tracers {
  DeviceTracer camera, others;

  Tracers(const Device& device, int width, std::uint64_t shapes, int kind_bits)
      : camera(tracer_for(device, width, shapes, kind_bits, DeviceTracer::Manner::stream)),
        others(tracer_for(device, width, shapes, kind_bits, DeviceTracer::Manner::pool)) {}

  void upload(std::span<const float> nodes, std::span<const float> leaves,
              std::span<const InstanceRecord> instances, uint root) {
    camera.upload(nodes, leaves, instances, root);
    others.upload(nodes, leaves, instances, root);
  }

 private:
  static DeviceTracer tracer_for(const Device& device, int width, std::uint64_t shapes,
                                 int kind_bits, DeviceTracer::Manner manner) {
    return DeviceTracer(device, width, fmt::format("-DCAPLET_LEAF_KIND_BITS={}", kind_bits),
                        {{"shapes", shapes}}, manner);
  }
};

int width_for(const Device& device, const Options& options) {
  return options.width != 0 ? options.width : device.is_cpu() ? 8 : 1;
}

void run_shapes(const std::string& kind, const Device& device, const Options& options,
                const Say& line) {
  std::vector<FlatPrimitive> same;
  const FlatScene scene =
      lower(walk_scene(kind, std::min<std::size_t>(options.count, 100000), same));
  std::optional<Peer> peer;
  if (!same.empty() && Peer::is_there() && !options.alone) peer.emplace(same);
  Tracers tracers(device, width_for(device, options), scene.shapes, scene.leaf_kind_bits);
  tracers.upload(scene.nodes, scene.leaves, scene.instances, scene.world.root);
  Bench bench{line, peer ? &*peer : nullptr, scene.leaves, options.seconds, true};
  const auto camera = camera_rays(options.size);
  bench.run(kind + " camera", tracers.camera, camera, camera);
  const auto scattered = scattered_rays(camera, tracers.camera.closest(camera));
  bench.run(kind + " scattered", tracers.others, scattered, scattered);
  bench.run(kind + " any", tracers.others, scattered, scattered, Question::any);
}

/// Returns the seconds of `work` on this number of threads, which may exceed the number of cores.
template <class Work>
double seconds_on(int threads, const Work& work) {
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism,
                                 static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  return arena.execute(work);
}

/// Measures tree builds on 1 to options.builders threads, each followed by Embree's; reports
/// medians.
void run_builders(std::span<const FlatPrimitive> primitives, int kind_bits, const Options& options,
                  const Say& line) {
  constexpr int repetitions = 7;
  const bool beside = Peer::is_there() && !options.alone;
  for (int threads = 1; threads <= options.builders; ++threads) {
    std::vector<double> ours, theirs;
    for (int i = 0; i < repetitions; ++i) {
      ours.push_back(seconds_on(threads, [&] {
        std::vector<float> nodes, leaves;
        const Clock::time_point start = Clock::now();
        encode_tree(primitives, nodes, leaves, kind_bits);
        return seconds_since(start);
      }));
      if (beside)
        theirs.push_back(seconds_on(threads, [&] { return Peer(primitives).build_seconds(); }));
    }
    say(line, fmt::format("{} build, {} thread{}", options.kind, threads, threads == 1 ? "" : "s"),
        median(ours), beside ? median(theirs) : 0, "s");
  }
}

void run_walks(const Device& device, const Options& options, const Say& line) {
  const std::string& kind = options.kind;
  const auto primitives =
      kind == "triangles" ? walk_triangles(options.count) : walk_capsules(options.count);
  if (options.builders > 0) {
    std::uint64_t shapes = 0;
    for (const FlatPrimitive& p : primitives) shapes |= shape_bit(p.shape);
    return run_builders(primitives, leaf_kind_bits(shapes), options, line);
  }
  std::vector<float> nodes, leaves;
  const Clock::time_point start = Clock::now();
  std::uint64_t shapes = 0;
  for (const FlatPrimitive& p : primitives) shapes |= shape_bit(p.shape);
  const EncodedTree tree = encode_tree(primitives, nodes, leaves, leaf_kind_bits(shapes));
  const double build = seconds_since(start);
  std::optional<Peer> peer;
  if (Peer::is_there() && !options.alone) peer.emplace(primitives);
  say(line, kind + " build", build, peer ? peer->build_seconds() : 0, "s",
      fmt::format(", \"nodes\": {}, \"depth\": {}, \"sah\": {:.3f}", tree.nodes, tree.depth,
                  tree.sah));
  const double n = static_cast<double>(options.count);
  say(line, kind + " memory",
      static_cast<double>((nodes.size() + leaves.size() + options.count) * sizeof(float)) / n, 0,
      "bytes/primitive",
      fmt::format(", \"node_bytes\": {:.2f}, \"leaf_bytes\": {:.2f}",
                  static_cast<double>(nodes.size() * sizeof(float)) / n,
                  static_cast<double>(leaves.size() * sizeof(float)) / n));

  Tracers tracers(device, width_for(device, options), shapes, leaf_kind_bits(shapes));
  tracers.upload(nodes, leaves, {}, tree.root);
  Bench bench{line, peer ? &*peer : nullptr, leaves, options.seconds};
  const auto camera = camera_rays(options.size);
  bench.run(kind + " camera", tracers.camera, camera, camera);
  auto bounce = bounce_rays(primitives, tree.slots, camera, tracers.camera.closest(camera));
  bench.run(kind + " bounce", tracers.others, bounce, bounce);
  bench.run(kind + " any", tracers.others, bounce, bounce, Question::any);
  if (options.sorted) {
    auto in_order = bounce;
    sort_rays(in_order);
    bench.run(kind + " bounce sorted", tracers.others, in_order, bounce);
  }
}

/// Makes tree lights as lowering does: they shine in all directions, from one side.
TreeLights tree_lights(std::span<const FlatPrimitive> primitives) {
  TreeLights out;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    double low[3], high[3];
    primitive_box(primitives[i], low, high);
    LightBounds bounds{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
    bounds.intensity = high[0] - low[0];
    out.add(static_cast<std::uint32_t>(i), bounds);
  }
  return out;
}

/// Returns the processor seconds of the whole program, including system time.
double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Measures the cost of emissive capsules, in processor seconds and in device bytes: the light tree
/// compared with the tree of the same capsules, and all data of lights compared with the scene
/// without lights. Reports medians of five.
void run_lights(const Options& options, const Say& line) {
  constexpr int repetitions = 5;
  const auto primitives = walk_capsules(options.count);
  const TreeLights lights = tree_lights(primitives);
  std::vector<double> geometry, trees, dark, bright;
  FlatScene tree, with, without;
  const auto timed = [](std::vector<double>& seconds, const auto& work) {
    const double start = processor_seconds();
    work();
    seconds.push_back(processor_seconds() - start);
  };
  for (int i = 0; i < repetitions; ++i) {
    timed(geometry, [&] {
      std::vector<float> nodes, leaves;
      encode_tree(primitives, nodes, leaves);
    });
    tree = FlatScene();
    timed(trees, [&] { lower_light_tree(lights, lights.lights.size(), tree); });
  }
  Scene walks = walk_lamps(options.count, false);
  for (int i = 0; i < repetitions; ++i) {
    walks.shapes[0].emission.reset();
    without = FlatScene();
    timed(dark, [&] { without = lower(walks); });
    walks.shapes[0].emission = AreaEmission{};
    with = FlatScene();
    timed(bright, [&] { with = lower(walks); });
  }
  const double n = static_cast<double>(options.count);
  const auto told = [&](const char* name, double light, double other, const char* of,
                        const char* unit) {
    line(
        fmt::format("{{\"name\": \"{}\", \"ours\": {:.4g}, \"{}\": {:.4g}, \"ratio\": {:.4g}, "
                    "\"unit\": \"{}\"}}",
                    name, light, of, other, light / other, unit));
  };
  told("light tree", median(trees), median(geometry), "geometry's tree", "processor s");
  told("lights", median(bright) - median(dark), median(dark), "all of geometry", "processor s");
  told("light tree memory",
       static_cast<double>((tree.light_nodes.size() + tree.light_places.size()) * sizeof(uint)) / n,
       static_cast<double>(without.geometry_bytes()) / n, "geometry", "bytes/light");
  told("lights memory", static_cast<double>(with.device_bytes() - without.device_bytes()) / n,
       static_cast<double>(without.geometry_bytes()) / n, "geometry", "bytes/light");
}

}  // namespace

std::vector<std::string> kinds() {
  std::vector<std::string> out{"capsules", "triangles", "lights", "shapes"};
  out.insert(out.end(), walk_kinds().begin(), walk_kinds().end());
  return out;
}

void run(const Options& options, const Say& line) {
  if (options.kind == "lights") return run_lights(options, line);
  const Device device = Device::choose(options.device);
  if (options.kind == "triangles" || options.kind == "capsules")
    return run_walks(device, options, line);
  for (const std::string& one : walk_kinds())
    if (options.kind == "shapes" || options.kind == one) run_shapes(one, device, options, line);
}

}  // namespace caplet::bench
