// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet doctor`: reports the installation, its problems and their solutions.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/utf8.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/options.h"
#include "doctor/diagnosis.h"
#include "render/known_answers.h"
#include "render/renderer.h"
#include "report/device_json.h"

namespace caplet::cli {

namespace {

void print_line(const doctor::Finding& finding) {
  fmt::print("{:<6} {}: {}\n", doctor::name_of(finding.state), one_line(finding.about),
             one_line(finding.what));
  if (!finding.fix.empty()) fmt::print("       fix: {}\n", one_line(finding.fix));
  std::fflush(stdout);  // a self-test takes a while, and children must not print buffered text
}

void print_diagnosis_json(const doctor::Diagnosis& diagnosis) {
  nlohmann::ordered_json findings = nlohmann::ordered_json::array(), platforms = findings,
                         devices = findings;
  for (const doctor::Finding& finding : diagnosis.findings)
    findings.push_back({{"state", doctor::name_of(finding.state)},
                        {"about", finding.about},
                        {"what", finding.what},
                        {"fix", finding.fix}});
  for (const doctor::PlatformFacts& platform : diagnosis.platforms) {
    platforms.push_back({{"name", platform.name},
                         {"vendor", platform.vendor},
                         {"version", platform.version},
                         {"devices", platform.devices.size()}});
    for (const doctor::DeviceFacts& device : platform.devices)
      devices.push_back(report::device_json(device.info));
  }
  const nlohmann::ordered_json out{
      {"findings", findings}, {"platforms", platforms}, {"devices", devices}};
  fmt::print("{}\n", json_dump(out, 2));
}

}  // namespace

void add_doctor(CLI::App& app) {
  struct Chosen {
    doctor::Options options;
    bool json = false;
  };
  const auto chosen = std::make_shared<Chosen>();
  CLI::App* command = app.add_subcommand("doctor",
                                         "Look for what keeps OpenCL from working here: drivers, "
                                         "permissions, memory, caches, devices");
  command
      ->add_option("--device", chosen->options.device,
                   "Test only this device: index, cpu, gpu, bundled or part of its name")
      ->type_name("cpu|gpu|bundled|DEVICE")
      ->default_str("all of them");
  command
      ->add_option("--timeout", chosen->options.seconds,
                   "Most seconds a driver may take to answer; four times that for a self-test")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str()
      ->type_name("SECONDS");
  command->add_flag("--json", chosen->json, "Print a JSON object for machines");
  command->footer(footer_with({"caplet doctor"},
                              "Exit codes: 0 nothing is wrong, 1 something is, 2 the usage is."));
  command->callback([chosen] {
    chosen->options.least_bytes = [](bool) { return least_batch_bytes(); };
    chosen->options.test = [](const Device& device) { try_device(device, whole_trial); };
    const bool json = chosen->json;
    const doctor::Diagnosis diagnosis = with_device_flag([&] {
      return doctor::diagnose(doctor::this_machine(), chosen->options,
                              [json](const doctor::Finding& finding) {
                                if (!json) print_line(finding);
                              });
    });
    if (json) print_diagnosis_json(diagnosis);
    std::fflush(stdout);
    if (diagnosis.anything_wrong()) throw CLI::RuntimeError(1);
  });
}

}  // namespace caplet::cli
