// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/trial.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "base/interrupt.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/options.h"
#include "device/second_try.h"
#include "device/self_test.h"
#include "doctor/child.h"

namespace caplet::cli {

namespace {

constexpr double most_seconds = 600;  // a slow compiler takes a minute and a half on one core
constexpr const char* not_started = "not started";
constexpr int exit_wrong_device = 3;

std::string error_text(const std::string& line) {
  const std::string before = "caplet: error: ";
  return line.starts_with(before) ? line.substr(before.size()) : line;
}

/// Returns whether the trial compiles this kernel itself.
bool is_of_trial(const CompileJob& job, const Trial& trial) {
  return trial.render &&
         (job.kernel == "extend" || job.kernel == "extend_camera" || job.kernel == "connect");
}

void test_apart(const Device& device, const Trial& trial) {
  log::info("testing {} once, and compiling for it", device.info().name);
  std::vector<std::string> words{"caplet",     "try-device",
                                 "--device",   std::to_string(device.info().index),
                                 "--encoding", name_of(device.encoding())};
  words.push_back(fmt::format("--shapes={}", trial.shapes));
  if (trial.render) words.push_back("--render");
  if (trial.nearest) words.push_back("--nearest");
  if (trial.lists) words.push_back("--lists");
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // This process already has threads, so its child may only call exec.
  const auto in_child = [&] {
    return doctor::in_child(
        [&] {
          ::execv("/proc/self/exe", arguments.data());
          return std::string(not_started);
        },
        most_seconds, interrupt_requested);
  };
  doctor::ChildEnd end = in_child();
  if (!end.finished && end.exit_code != exit_wrong_device && device.is_pocl() &&
      !interrupt_requested()) {
    // PoCL's cache may be broken, which SecondTry handles.
    const FreshPoclCache fresh;
    end = in_child();
  }
  if (end.finished && end.answer == not_started) return try_device(device, trial);
  if (end.finished) {
    // A child that could not store its result could not report that either.
    if (needs_trial(device, trial)) remember_trial(device, trial);
    return;
  }
  if (interrupt_requested()) throw RunError("interrupted");
  if (end.exit_code == exit_wrong_device) throw WrongDevice(error_text(end.said));
  if (end.exit_code == 1 || end.exit_code == 2) throw RunError(error_text(end.said));
  throw RunError(
      fmt::format("device '{}' (driver {}): its driver {} while Caplet's kernels were compiled and "
                  "tried{}; use another device or "
                  "driver (--device; `caplet doctor` tells more), or another --encoding",
                  device.info().name, device.info().driver, end.how,
                  end.said.empty() ? "" : fmt::format(" (it printed: {})", end.said)));
}

}  // namespace

void try_device_apart(const Device& device, const Trial& trial, const NextJobs& next) {
  if (!needs_trial(device, trial)) return;
  std::vector<CompileJob> jobs;
  if (next && compiler_count() > 1) jobs = next(device);
  std::erase_if(jobs, [&](const CompileJob& job) {
    return is_of_trial(job, trial) || is_cached(device, job);
  });
  Compilers compilers(device, std::move(jobs), compiler_count() - 1);
  test_apart(device, trial);
  SecondTry::guard(device);  // this process may compile now
  compilers.finish();
}

std::vector<Device> tried_apart(const std::vector<Device>& devices, const Trial& trial,
                                const NextJobs& next) {
  std::vector<Device> out;
  for (const Device& device : devices) try {
      try_device_apart(device, trial, next);
      out.push_back(device);
    } catch (const RunError& error) {
      if (interrupt_requested() || (out.empty() && &device == &devices.back())) throw;
      log::warn("device {} '{}' is left out: {}", device.info().index, device.info().name,
                error.what());
    }
  return out;
}

void add_try_device(CLI::App& app) {
  struct Options {
    std::string device;
    Encoding encoding = Encoding::automatic;
    Trial trial;
  };
  const auto o = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("try-device", "Test a device; other commands run this");
  command->group("");
  command->add_option("--device", o->device);
  add_encoding(*command, o->encoding);
  command->add_option("--shapes", o->trial.shapes);
  command->add_flag("--render", o->trial.render);
  command->add_flag("--nearest", o->trial.nearest);
  command->add_flag("--lists", o->trial.lists);
  command->callback([o] {
    log::set_quiet(true);
    try {
      try_device(choose_device(o->device, o->encoding), o->trial);
    } catch (const WrongDevice& wrong) {
      std::string message = wrong.what();
      std::ranges::replace(message, '\n', ' ');
      fmt::print(stderr, "caplet: error: {}\n", message);
      throw CLI::RuntimeError(exit_wrong_device);
    }
  });
}

}  // namespace caplet::cli
