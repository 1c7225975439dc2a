// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "doctor/diagnosis.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "device/bundled.h"
#include "device/cache.h"
#include "device/pocl_needs.h"
#include "device/second_try.h"
#include "device/select.h"
#include "doctor/detail/machine.h"

namespace caplet::doctor {

namespace {

/// A row: a known problem of platforms, devices and driver versions that match.
struct Quirk {
  const char* platform;  // how the platform's name begins
  const char* device;    // how the device's name begins
  const char* from;      // first affected driver version; empty: any
  const char* before;    // first version that is not affected; empty: none
  const char* what;
};

constexpr Quirk quirks[] = {
    // https://github.com/pocl/pocl/issues/1958 (compiled at the launch),
    // https://github.com/pocl/pocl/pull/738 (small grids)
    {"Portable Computing Language", "", "", "",
     "compiles a kernel when it is launched, not when the program is built, and again for 65536 "
     "work-items or more: the first "
     "render waits for it, later ones find it in PoCL's cache"},
    // host/device/program.cpp
    {"Portable Computing Language", "", "", "",
     "keeps compiled kernels itself; Caplet's cache holds what the self-test said, and marks of "
     "what "
     "is compiled"},
    // https://github.com/pocl/pocl/issues/1608; kernels/trace/trace.cl. Single: `shade` of
    // scenes/neuron.swc
    {"Portable Computing Language", "", "6.0", "6.1",
     "has a compiler that may abort the process (\"Instruction Combining did not reach a "
     "fixpoint\"); Caplet's kernels are "
     "written so that it does not in the wide encoding, which is its own; in the single one it "
     "does for some scenes"},
    // Seen with 2025.0.4 (which calls itself 2024.18.12) and later, not with 2024.2.1 (2024.18.7);
    // kernels/stages/kernel.cl
    {"Intel(R) OpenCL", "Intel(R)", "2024.18.8", "",
     "may put several work-items into one vector, which is slow, and wrong where functions are "
     "called; Caplet's kernels ask it "
     "not to, others (CAPLET_KERNELS) must, too"},
    // Seen with 2023.2.4, which calls itself 2024.16.
    {"Intel(R) OpenCL", "Intel(R)", "2023", "2024.17",
     "has a compiler that crashed on earlier kernels of the single encoding: stay with the wide "
     "one, which is its own; and "
     "lacks functions of its own vector library (__ocl_svml_...), so that some scenes do not "
     "build: 2024.1 has them"},
    // https://docs.mesa3d.org/rusticl
    {"rusticl", "", "", "",
     "offers only the devices of the drivers that RUSTICL_ENABLE names (RUSTICL_ENABLE=radeonsi, "
     "iris, llvmpipe)"},
    {"rusticl", "llvmpipe", "", "",
     "runs a work-item in each lane of the processor's vectors: the wide encoding takes minutes to "
     "compile and is slower than "
     "the single one, which is its own"},
    // Seen with 22.3 and 25.0: fma(-0, 0, +0) is -0.
    {"rusticl", "", "", "",
     "may give a zero of fma() the wrong sign; no kernel of Caplet's takes it"},
    // Seen with Debian's oclgrind 21.10-3: the self-test's comparisons of float8.
    {"Oclgrind", "", "21.10", "21.11",
     "is a simulator for debugging, and compares vectors wrongly: it cannot render (unless kernels "
     "are built as "
     "tools/oclgrind.sh does)"},
};

/// Returns the numbers of a text's first version: "Oclgrind 21.10" has 21 and 10,
/// "2024.18.7.0.11_160000" 2024, 18, 7, 0 and 11.
std::vector<int> version_numbers(std::string_view text) {
  std::vector<int> out;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  while (!text.empty() && !digit(text.front())) text.remove_prefix(1);
  while (!text.empty() && digit(text.front())) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return out;
    out.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.size() < 2 || text.front() != '.') return out;
    text.remove_prefix(1);
  }
  return out;
}

bool concerns(const Quirk& quirk, const PlatformFacts& platform) {
  if (!platform.name.starts_with(quirk.platform)) return false;
  const std::string_view device_name(quirk.device), from(quirk.from), before(quirk.before);
  if (device_name.empty() && from.empty()) return true;
  return std::ranges::any_of(platform.devices, [&](const DeviceFacts& device) {
    const std::vector<int> version = version_numbers(device.info.driver);
    return device.info.name.starts_with(device_name) && version >= version_numbers(from) &&
           (before.empty() || version < version_numbers(before));
  });
}

std::string printed(const ChildEnd& end) {
  return end.said.empty() ? "" : fmt::format(" (it printed: {})", end.said);
}

/// Accepts "OpenCL 1.2 ..." and later versions.
bool at_least_1_2(const std::string& version) {
  int major = 0, minor = 0;
  if (std::sscanf(version.c_str(), "OpenCL %d.%d", &major, &minor) != 2) return false;
  return major > 1 || (major == 1 && minor >= 2);
}

constexpr const char* about_bundled = "bundled driver";  // takes the place of an .icd file

std::string remove_text(const Driver& driver) {
  if (driver.from == about_bundled) return "export CAPLET_BUNDLED_DRIVER=0";
  if (!driver.from.ends_with(".icd")) return "unset " + driver.from;
  return fmt::format("sudo mv '{0}' '{0}.off'", driver.from);
}

bool is_pocl(const DeviceInfo& info) {
  return info.platform.starts_with("Portable Computing Language");
}

std::string title(const DeviceInfo& info) {
  return fmt::format("device {} {}", info.index, info.name);
}

/// Makes all checks in order.
class Examination {
 public:
  Examination(const Surroundings& machine, const Options& options,
              const std::function<void(const Finding&)>& tell)
      : machine_(machine), options_(options), tell_(tell) {}

  Diagnosis run() {
    find_loader();
    ask_drivers();
    add(check_permissions(machine_));
    add(check_sys(machine_));
    add(check_nvidia(machine_, registry_, loader_,
                     has_nvidia(machine_) && can_load("libnvidia-opencl.so.1", options_.seconds)));
    ask_platforms();
    add(check_unused_gpus(machine_, out_.platforms));
    add(check_memory(machine_));
    add(check_cache(machine_, cache_folder()));
    if (has_pocl_) add(check_pocl_cache(machine_));
    if (bundled_devices_) add(check_bundled_cache(machine_));
    add(known_quirks(out_.platforms));
    test_devices();
    return std::move(out_);
  }

 private:
  struct Testable {
    DeviceInfo info;
    Variables variables;
  };

  void add(Finding finding) {
    tell_(finding);
    out_.findings.push_back(std::move(finding));
  }
  void add(const Findings& findings) {
    for (const Finding& finding : findings) add(finding);
  }

  void find_loader() {
    loader_ = ask_loader();
    add(Finding{State::ok, "ICD loader",
                loader_.name.empty()
                    ? "does not say its name"
                    : fmt::format("{} {} ({})", loader_.name, loader_.version, loader_.vendor),
                ""});
    registry_ = read_registry(machine_, loader_);
    add(check_registry(registry_, static_cast<bool>(bundled_driver())));
    add(check_layers(machine_));
  }

  void ask_drivers() {
    for (const Driver& driver : registry_.drivers)
      if (driver.problem.empty())
        answers_.push_back({driver, ask_driver(driver, loader_, options_.seconds)});
    if (const BundledDriver bundled = bundled_driver()) {
      answers_.push_back(
          {{about_bundled, bundled.library.string(), ""}, ask_bundled(options_.seconds)});
      bundled_devices_ = answers_.back().second.has_devices();
    }
    for (const auto& [driver, answer] : answers_) {
      const bool needed = std::none_of(answers_.begin(), answers_.end(),
                                       [](const auto& each) { return each.second.has_devices(); });
      add(judge_driver(driver, answer, machine_, needed));
      has_pocl_ = has_pocl_ || (driver.from != about_bundled &&
                                driver.library.find("pocl") != std::string::npos);
    }
  }

  /// Asks all platforms at once, as other commands do; if a driver crashes or hangs, asks one
  /// driver after the other.
  void ask_platforms() {
    const bool broken = std::any_of(answers_.begin(), answers_.end(),
                                    [](const auto& each) { return !each.second.end.finished; });
    if (!broken) {
      Answer all = ask_all({}, options_.seconds);
      if (!all.end.finished)
        add(Finding{State::wrong, "platforms",
                    "the drivers together: " + all.end.how + printed(all.end),
                    "use one driver alone: " + only_text("LIBRARY", loader_) + " caplet ..."});
      take(all.platforms, {});
    } else {
      for (const auto& [driver, answer] : answers_)
        if (answer.end.finished)
          take(answer.platforms,
               only(driver.from == about_bundled ? "/nonexistent" : driver.library, loader_));
    }
    if (out_.platforms.empty() && !registry_.drivers.empty())
      add(Finding{State::wrong, "platforms", "no driver answers: there is no OpenCL platform",
                  install_a_driver});
    const bool none = std::none_of(out_.platforms.begin(), out_.platforms.end(),
                                   [](const auto& each) { return !each.devices.empty(); });
    for (const PlatformFacts& platform : out_.platforms) {
      add(judge_platform(platform, none));
      for (const DeviceFacts& device : platform.devices)
        add(judge_device(device, options_.least_bytes(device.info.type == "cpu")));
    }
    if (broken && !none)
      add(Finding{State::note, "platforms",
                  "asked one driver at a time: a broken one prevents every other use",
                  "until it is mended: " + working_driver() + " caplet ..."});
  }

  std::string working_driver() const {
    for (const auto& [driver, answer] : answers_)
      if (answer.has_devices())
        return only_text(driver.from == about_bundled ? "/nonexistent" : driver.library, loader_);
    return {};
  }

  void take(const std::vector<PlatformFacts>& platforms, const Variables& variables) {
    for (const PlatformFacts& platform : platforms) {
      out_.platforms.push_back(platform);
      for (const DeviceFacts& device : platform.devices)
        devices_.push_back({device.info, variables});
    }
  }

  void test_devices() {
    if (devices_.empty()) return;
    std::vector<Testable> chosen = devices_;
    if (!options_.device.empty()) {
      std::vector<DeviceInfo> infos;
      for (std::size_t i = 0; i < devices_.size(); ++i) infos.push_back(devices_[i].info);
      chosen = {devices_[select_device(infos, options_.device)]};
    }
    for (const Testable& device : chosen) {
      const ChildEnd end =
          test_device(device.info.index, device.variables, options_.test, 4 * options_.seconds);
      if (end.finished)
        add(Finding{State::ok, title(device.info), "passes the self-test", ""});
      else if (is_pocl(device.info) && passes_with_fresh_cache(device)) {
        const std::string folder = (device.info.bundled ? bundled_cache_folder(machine_.variable)
                                                        : pocl_cache_folder(machine_.variable))
                                       .string();
        add(Finding{State::wrong, "PoCL's cache",
                    fmt::format("{} is damaged: with it, {} fails the self-test ({}{}); with a "
                                "fresh folder it passes",
                                folder, title(device.info), end.how, printed(end)),
                    fmt::format("rm -r '{}'", folder)});
      } else
        add(Finding{State::wrong, title(device.info),
                    "fails the self-test: " + end.how + printed(end),
                    fmt::format("update the driver ({}), or use another device; then report it to "
                                "the driver's makers",
                                device.info.driver)});
    }
  }

  bool passes_with_fresh_cache(const Testable& device) const {
    const FreshPoclCache fresh;
    return test_device(device.info.index, device.variables, options_.test, 4 * options_.seconds)
        .finished;
  }

  const Surroundings& machine_;
  const Options& options_;
  const std::function<void(const Finding&)>& tell_;
  Loader loader_;
  Registry registry_;
  std::vector<std::pair<Driver, Answer>> answers_;
  std::vector<Testable> devices_;
  bool has_pocl_ = false, bundled_devices_ = false;
  Diagnosis out_;
};

}  // namespace

Finding judge_driver(const Driver& driver, const Answer& answer, const Surroundings& machine,
                     bool needed) {
  if (!answer.end.finished)
    return {State::wrong, driver.from,
            fmt::format("the driver {} {}{}; so does every program that uses OpenCL",
                        driver.library, answer.end.how, printed(answer.end)),
            "update or reinstall this driver, or take it out: " + remove_text(driver)};
  // Mangled names of the C++ namespace tbb begin with this.
  if (answer.load_error.find("undefined symbol: _ZN3tbb") != std::string::npos)
    return {State::wrong, driver.from,
            fmt::format(
                "the driver {} needs a newer libtbb.so.12 than the one that Caplet has loaded: {}",
                driver.library, answer.load_error),
            "make a folder that holds nothing but the libtbb.so.12 that came with the driver, and "
            "name it: "
            "LD_LIBRARY_PATH=FOLDER caplet ..."};
  if (!answer.load_error.empty())
    return {State::wrong, driver.from,
            fmt::format("the driver {} cannot be loaded: {}", driver.library, answer.load_error),
            "reinstall the package of this driver, or take it out: " + remove_text(driver)};
  if (!answer.platforms.empty())
    return {State::ok, driver.from,
            fmt::format("the driver {} offers {} platform{}", driver.library,
                        answer.platforms.size(), answer.platforms.size() == 1 ? "" : "s"),
            ""};
  const std::string what = fmt::format("the driver {} offers no platform", driver.library);
  if (driver.library.find("nvidia") != std::string::npos && has_nvidia(machine))
    return {State::wrong, driver.from, what + ", though the GPU's kernel driver is here",
            "nvidia-smi tells what is amiss; after an update of the driver: sudo reboot"};
  return {needed ? State::wrong : State::note, driver.from,
          what + ": it finds no hardware of its kind, or may not use it",
          needed ? install_a_driver : ""};
}

Finding judge_platform(const PlatformFacts& platform, bool needed) {
  const std::string about = "platform " + platform.name;
  if (!platform.devices.empty() && platform.devices_error.empty())
    return {State::ok, about,
            fmt::format("{}, {} device{}", platform.version, platform.devices.size(),
                        platform.devices.size() == 1 ? "" : "s"),
            ""};
  const std::string what = platform.devices_error.empty()
                               ? "has no device"
                               : "offers no device: " + platform.devices_error;
  const State state = needed ? State::wrong : State::note;
  if (platform.name == "rusticl")
    return {state, about, what,
            "export RUSTICL_ENABLE=DRIVER (radeonsi, iris, llvmpipe...; docs.mesa3d.org/rusticl)"};
  if (platform.name.starts_with("Portable Computing Language"))
    return {
        state, about, what,
        "let PoCL write its cache folder (POCL_CACHE_DIR) and have memory (ulimit -v unlimited)"};
  return {state, about, what,
          "check the permissions above, update its driver, or " + std::string(install_a_driver)};
}

Findings judge_device(const DeviceFacts& device, std::uint64_t least_bytes) {
  const DeviceInfo& info = device.info;
  const std::string about = title(info);
  Findings out;
  const std::string other = "use another device, or update the driver " + info.driver;
  const auto lacks = [&](const std::string& what, const std::string& fix) {
    out.push_back({State::wrong, about, what, fix});
  };
  if (!device.available) lacks("is not available", "end the program that holds it, or " + other);
  if (!device.compiler) lacks("has no compiler for OpenCL C", other);
  if (!at_least_1_2(info.version))
    lacks(fmt::format("has '{}', and OpenCL 1.2 is needed", info.version), other);
  if (device.profile != "FULL_PROFILE")
    lacks(fmt::format("has the profile {}, which may round differently", device.profile), other);
  if (!device.little_endian) lacks("is big-endian, and records are written little-endian", other);
  // OpenCL 1.2, table 4.3, requires at least 1/4 of the memory, and 128 MiB. Some devices report
  // less.
  if (const std::uint64_t least =
          std::min<std::uint64_t>(info.global_bytes / 4, std::uint64_t{128} << 20);
      info.max_allocation_bytes < least)
    out.push_back({State::note, about,
                   fmt::format("allocates at most {:.0f} MB at once: large scenes do not fit",
                               static_cast<double>(info.max_allocation_bytes) * 1e-6),
                   ""});
  if (info.global_bytes < least_bytes)
    lacks(fmt::format("has {:.0f} MB of memory, and a batch of paths takes {:.0f} MB",
                      static_cast<double>(info.global_bytes) * 1e-6,
                      static_cast<double>(least_bytes) * 1e-6),
          "use another device");
  out.insert(out.begin(),
             Finding{State::ok, about,
                     fmt::format("{}, {}, driver {}, {} compute units, {:.1f} GB", info.type,
                                 info.version, info.driver, info.compute_units,
                                 static_cast<double>(info.global_bytes) * 1e-9),
                     ""});
  return out;
}

Findings known_quirks(const std::vector<PlatformFacts>& platforms) {
  Findings out;
  for (const Quirk& quirk : quirks)
    if (std::ranges::any_of(
            platforms, [&](const PlatformFacts& platform) { return concerns(quirk, platform); }))
      out.push_back({State::note, quirk.platform, quirk.what, ""});
  return out;
}

bool Diagnosis::anything_wrong() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.state == State::wrong; });
}

Diagnosis diagnose(const Surroundings& machine, const Options& options,
                   const std::function<void(const Finding&)>& tell) {
  return Examination(machine, options, tell).run();
}

}  // namespace caplet::doctor
