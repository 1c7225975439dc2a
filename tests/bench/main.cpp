// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Camera and bounce rays through the traversal kernels and through Embree, alternating, the same rays in the same order: medians
// of Mrays/s, one JSON object a line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <optional>
#include <set>

#include "base/error.h"
#include "device_tracer.h"
#include "lower/lower.h"
#include "peer.h"
#include "scenes.h"
#include "shared/shapes.h"

namespace {

using caplet::HitRecord;
using caplet::RayRecord;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// As a renderer builds its kernels (stage_options).
std::string kernel_options(std::uint64_t shapes, int kind_bits) {
  return fmt::format("-DCAPLET_SHAPES=0x{:x}UL -DCAPLET_LEAF_KIND_BITS={}", shapes, kind_bits);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

void print_json(const std::string& name, double ours, double peer, const std::string& unit, const std::string& more = {}) {
  const std::string beside =
      peer > 0 ? fmt::format("\"embree\": {:.4g}, \"ratio\": {:.4g}", peer, ours / peer) : "\"embree\": null, \"ratio\": null";
  fmt::print("{{\"name\": \"{}\", \"ours\": {:.4g}, {}, \"unit\": \"{}\"{}}}\n", name, ours, beside, unit, more);
  std::fflush(stdout);
}

struct Bench {
  caplet::test::DeviceTracer& tracer;
  const caplet::test::Peer* peer;  // null: Embree has no such shape
  const std::vector<float>& leaves;
  double seconds;
  bool by_shape = false;  // ids of the peer are not primitive ids

  /// Alternates both until the time is up, three rounds at least. `ours`: the same rays, perhaps in another order.
  void run(const std::string& name, const std::vector<RayRecord>& ours, const std::vector<RayRecord>& theirs) {
    if (ours.empty()) return;
    std::vector<std::uint32_t> ids(theirs.size());
    tracer.set_rays(ours);
    tracer.run_closest();
    const std::size_t peer_hits = peer ? peer->trace(theirs, ids) : 0;
    std::vector<double> a, b;
    const auto begin = Clock::now();
    while (a.size() < 3 || seconds_since(begin) < seconds) {
      auto start = Clock::now();
      tracer.run_closest();
      a.push_back(static_cast<double>(ours.size()) / seconds_since(start) * 1e-6);
      if (peer == nullptr) continue;
      start = Clock::now();
      peer->trace(theirs, ids);
      b.push_back(static_cast<double>(theirs.size()) / seconds_since(start) * 1e-6);
    }
    const auto hits = tracer.hits();
    const auto our_hits = std::count_if(hits.begin(), hits.end(), [](const HitRecord& h) { return h.slot != CAPLET_NONE; });
    std::string more = fmt::format(", \"rays\": {}, \"hits\": {}", ours.size(), our_hits);
    if (peer) more += fmt::format(", \"embree_hits\": {}", peer_hits);
    if (peer && &ours == &theirs && !by_shape) {
      std::size_t same = 0;
      for (std::size_t i = 0; i < hits.size(); i++)
        same +=
            ids[i] == (hits[i].slot == CAPLET_NONE ? CAPLET_NONE : std::bit_cast<std::uint32_t>(leaves[hits[i].slot])) ? 1 : 0;
      more += fmt::format(", \"same_primitive\": {:.6f}", static_cast<double>(same) / static_cast<double>(hits.size()));
    }
    print_json(name, median(a), peer ? median(b) : 0, "Mrays/s", more);
  }
};

void run_shapes(const std::string& kind, std::size_t count, const caplet::Device& device, double seconds, int size, int width) {
  std::vector<caplet::FlatPrimitive> same;
  const caplet::FlatScene scene = caplet::lower(caplet::bench::walk_scene(kind, count, same));
  std::optional<caplet::test::Peer> peer;
  if (!same.empty()) peer.emplace(same);
  caplet::test::DeviceTracer tracer(device,
                                    width != 0        ? width
                                    : device.is_cpu() ? 8
                                                      : 1,
                                    kernel_options(scene.shapes, scene.leaf_kind_bits));
  tracer.upload(scene.nodes, scene.leaves, scene.instances, scene.world.root);
  Bench bench{tracer, peer ? &*peer : nullptr, scene.leaves, seconds, true};
  const auto camera = caplet::bench::camera_rays(size);
  bench.run(kind + " camera", camera, camera);
  const auto scattered = caplet::bench::scattered_rays(camera, tracer.closest(camera));
  bench.run(kind + " scattered", scattered, scattered);
}

int run(int argc, char** argv) {
  CLI::App app{"Traversal speed beside Embree 3 (rtcIntersect1, all cores)"};
  std::string kind, device_name = "cpu";
  std::size_t count = 1000000;
  double seconds = 5;
  int size = 1024, width = 0;
  bool sorted = false;
  std::set<std::string> names(caplet::bench::walk_kinds().begin(), caplet::bench::walk_kinds().end());
  names.insert({"capsules", "triangles", "shapes"});
  app.add_option("scene", kind, "capsules, triangles, or another kind; shapes: all other kinds")
      ->required()
      ->check(CLI::IsMember(names));
  app.add_option("--n", count, "primitives")->check(CLI::Range(std::size_t(1), std::size_t(1) << 27));
  app.add_option("--device", device_name, "OpenCL device");
  app.add_option("--seconds", seconds, "time for each kind of ray")->check(CLI::PositiveNumber);
  app.add_option("--size", size, "camera rays a side")->check(CLI::Range(1, 8192));
  app.add_option("--width", width, "8: eight primitives at a time, 1: one; default by device")->check(CLI::IsMember({1, 8}));
  app.add_flag("--sorted", sorted, "also bounce rays sorted by origin and octant, for ours alone");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  if (kind != "triangles" && kind != "capsules") {
    const caplet::Device device = caplet::Device::choose(device_name);
    for (const std::string& one : caplet::bench::walk_kinds())
      if (kind == "shapes" || kind == one) run_shapes(one, std::min<std::size_t>(count, 100000), device, seconds, size, width);
    return 0;
  }
  const auto primitives = kind == "triangles" ? caplet::bench::walk_triangles(count) : caplet::bench::walk_capsules(count);
  std::vector<float> nodes, leaves;
  const auto start = Clock::now();
  std::uint64_t shapes = 0;
  for (const caplet::FlatPrimitive& p : primitives) shapes |= caplet::shape_bit(p.shape);
  const caplet::EncodedTree tree = caplet::encode_tree(primitives, nodes, leaves, caplet::leaf_kind_bits(shapes));
  const double build = seconds_since(start);
  const caplet::test::Peer peer(primitives);
  print_json(kind + " build", build, peer.build_seconds(), "s",
             fmt::format(", \"nodes\": {}, \"depth\": {}, \"sah\": {:.3f}", tree.nodes, tree.depth, tree.sah));
  const double n = static_cast<double>(count);
  print_json(
      kind + " memory", static_cast<double>((nodes.size() + leaves.size() + count) * sizeof(float)) / n, 0, "bytes/primitive",
      fmt::format(", \"node_bytes\": {:.2f}, \"leaf_bytes\": {:.2f}", static_cast<double>(nodes.size() * sizeof(float)) / n,
                  static_cast<double>(leaves.size() * sizeof(float)) / n));

  const caplet::Device device = caplet::Device::choose(device_name);
  caplet::test::DeviceTracer tracer(device,
                                    width != 0        ? width
                                    : device.is_cpu() ? 8
                                                      : 1,
                                    kernel_options(shapes, caplet::leaf_kind_bits(shapes)));
  tracer.upload(nodes, leaves, {}, tree.root);
  Bench bench{tracer, &peer, leaves, seconds};
  const auto camera = caplet::bench::camera_rays(size);
  bench.run(kind + " camera", camera, camera);
  auto bounce = caplet::bench::bounce_rays(primitives, tree.slots, camera, tracer.closest(camera));
  bench.run(kind + " bounce", bounce, bounce);
  if (sorted) {
    auto in_order = bounce;
    caplet::bench::sort_rays(in_order);
    bench.run(kind + " bounce sorted", in_order, bounce);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const caplet::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
