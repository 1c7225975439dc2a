// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// caplet_bench, which `caplet bench` runs: a program of its own, so that no other command loads
// Embree.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "base/error.h"
#include "base/log.h"
#include "bench/bench.h"

int main(int argc, char** argv) {
  CLI::App app{"Traversal speed beside Embree (rtcIntersect1, all cores)"};
  caplet::bench::Options options;
  app.add_option(
         "scene", options.kind,
         "capsules, triangles, or another kind; shapes: all other kinds; lights: the light tree")
      ->required()
      ->check(CLI::IsMember(caplet::bench::kinds()));
  app.add_option("--n", options.count, "primitives")
      ->check(CLI::Range(std::size_t(1), std::size_t(1) << 27));
  app.add_option("--device", options.device, "OpenCL device");
  app.add_option("--seconds", options.seconds, "time for each kind of ray")
      ->check(CLI::PositiveNumber);
  app.add_option("--size", options.size, "camera rays a side")->check(CLI::Range(1, 8192));
  app.add_option("--width", options.width,
                 "8: eight primitives at a time, 1: one; default by device")
      ->check(CLI::IsMember({1, 8}));
  app.add_option("--builders", options.builders, "instead of rays: trees by 1 to so many threads")
      ->check(CLI::Range(1, 64));
  app.add_flag("--alone", options.alone, "without Embree");
  app.add_flag("--sorted", options.sorted,
               "also bounce rays sorted by origin and octant, for ours alone");
  caplet::log::set_quiet(false);
  try {
    app.parse(argc, argv);
    caplet::bench::run(options, [](const std::string& line) {
      fmt::print("{}\n", line);
      std::fflush(stdout);
    });
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const caplet::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
