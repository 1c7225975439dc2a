// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The doctor's findings over machines made up of files, and over answers made up of values.
#include "doctor/diagnosis.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <set>

#include "doctor/detail/machine.h"
#include "support/data.h"

namespace caplet::doctor {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Loader ocl_icd{"OpenCL ICD Loader", "OCL Icd free software", "2.3.1"};
const Loader khronos{"Khronos OpenCL ICD Loader", "Khronos Group", "3.0.1"};

class Machine : public testing::Test {
 protected:
  Machine() {
    machine_.root = test::temporary_folder();
    machine_.variable = [this](const std::string& name) { return variables_[name]; };
    machine_.may = [this](const fs::path& path, int) { return !closed_.contains(path); };
    machine_.group = [](const fs::path&) { return "gpus"; };
    machine_.free_bytes = [this](const fs::path&) { return free_; };
    machine_.user = "ada";
  }
  fs::path write(const std::string& path, const std::string& text = "") const {
    const fs::path file = machine_.root / path;
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
    return file;
  }
  fs::path folder(const std::string& path) const {
    fs::create_directories(machine_.root / path);
    return machine_.root / path;
  }
  /// The one wrong finding of the registry.
  Finding registry_finding(const Loader& loader = ocl_icd) const {
    return only_wrong(check_registry(read_registry(machine_, loader)));
  }
  static Finding only_wrong(const Findings& findings) {
    Findings out;
    for (const Finding& finding : findings)
      if (finding.state == State::wrong) out.push_back(finding);
    EXPECT_EQ(out.size(), 1u);
    if (out.empty()) return {};
    EXPECT_NE(out.front().fix, "");
    return out.front();
  }

  Surroundings machine_;
  std::map<std::string, std::string> variables_;
  std::set<fs::path> closed_;
  std::optional<std::uint64_t> free_ = std::uint64_t{1} << 40;
};

TEST_F(Machine, NoFolderOfDrivers) {
  EXPECT_THAT(registry_finding().what, HasSubstr("does not exist"));
  EXPECT_THAT(registry_finding().fix, HasSubstr("apt-get install"));
}

TEST_F(Machine, NoDriverIsANoteWhereOneIsBundled) {
  const Findings found = check_registry(read_registry(machine_, ocl_icd), true);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].state, State::note);
  EXPECT_THAT(found[0].what,
              AllOf(HasSubstr("does not exist"), HasSubstr("the bundled one is used")));
}

TEST_F(Machine, EmptyFolderOfDrivers) {
  write("etc/OpenCL/vendors/README", "libpocl.so");
  EXPECT_THAT(registry_finding().what, HasSubstr("holds no .icd file"));
  EXPECT_THAT(registry_finding(khronos).what, HasSubstr("holds no .icd file"));
}

TEST_F(Machine, FoldersAndFilesThatCannotBeRead) {
  const fs::path file = write("etc/OpenCL/vendors/a.icd", "liba.so\n");
  closed_ = {file};
  EXPECT_THAT(registry_finding().what, HasSubstr("this file cannot be read"));
  EXPECT_THAT(registry_finding().fix, HasSubstr("sudo chmod a+r '" + file.string()));
  closed_ = {file.parent_path()};
  EXPECT_THAT(registry_finding().what, HasSubstr("folder cannot be read"));
  EXPECT_THAT(registry_finding().fix, HasSubstr("sudo chmod a+rX"));
}

TEST_F(Machine, FilesThatNameNoLibrary) {
  write("etc/OpenCL/vendors/a.icd", "\nliba.so\n");
  EXPECT_THAT(registry_finding().what, HasSubstr("names no library"));
  write("etc/OpenCL/vendors/a.icd", "liba.so\r\n");
  EXPECT_THAT(registry_finding().what, HasSubstr("carriage return"));
}

TEST_F(Machine, TheLoadersVariables) {
  const fs::path usual = write("etc/OpenCL/vendors/a.icd", "liba.so").parent_path();
  const fs::path file = write("other/b.icd", "libb.so");
  const auto libraries = [&](const Loader& loader) {
    std::vector<std::string> out;
    for (const Driver& driver : read_registry(machine_, loader).drivers)
      out.push_back(driver.library);
    return out;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(libraries(ocl_icd), Names{"liba.so"});
  // libOpenCL(7): a folder; a file, also beside the others; else a library.
  variables_["OCL_ICD_VENDORS"] = file.parent_path();
  EXPECT_EQ(libraries(ocl_icd), Names{"libb.so"});
  EXPECT_EQ(libraries(khronos), Names{"libb.so"});
  variables_["OCL_ICD_VENDORS"] = file;
  EXPECT_EQ(libraries(ocl_icd), Names{"libb.so"});
  variables_["OCL_ICD_VENDORS"] = "a.icd";
  EXPECT_EQ(libraries(ocl_icd), Names{"liba.so"});
  variables_["OCL_ICD_VENDORS"] = "libc.so";
  EXPECT_EQ(libraries(ocl_icd), Names{"libc.so"});
  EXPECT_EQ(libraries(khronos), Names{});
  variables_["OCL_ICD_FILENAMES"] = "libd.so:/e/libe.so";
  EXPECT_EQ(libraries(khronos), (Names{"libd.so", "/e/libe.so"}));
  variables_ = {{"OPENCL_VENDOR_PATH", file.parent_path()}};
  EXPECT_EQ(libraries(ocl_icd), Names{"libb.so"});
  variables_["OPENCL_VENDOR_PATH"] = "/nonexistent";
  EXPECT_THAT(registry_finding().fix, HasSubstr("unset OPENCL_VENDOR_PATH"));
}

TEST_F(Machine, GpuNodesThatMayNotBeOpened) {
  EXPECT_THAT(check_permissions(machine_), IsEmpty());
  for (const char* name : {"dev/nvidia0", "dev/kfd", "dev/dri/renderD128"}) {
    const fs::path node = write(name);
    EXPECT_EQ(check_permissions(machine_).back().state, State::ok);
    closed_ = {node};
    const Finding finding = only_wrong(check_permissions(machine_));
    EXPECT_EQ(finding.about, node.string());
    EXPECT_THAT(finding.fix, HasSubstr("sudo usermod -aG gpus ada"));
    closed_.clear();
  }
  closed_ = {write("dev/dri/renderD129")};
  machine_.group = [](const fs::path&) { return "root"; };
  EXPECT_THAT(only_wrong(check_permissions(machine_)).fix,
              HasSubstr("usermod -aG render,video ada"));
}

TEST_F(Machine, NvidiaWithoutItsIcd) {
  Registry registry;
  EXPECT_THAT(check_nvidia(machine_, registry, ocl_icd, true), IsEmpty());
  write("proc/driver/nvidia/version");
  EXPECT_THAT(
      only_wrong(check_nvidia(machine_, registry, ocl_icd, true)).fix,
      testing::AllOf(HasSubstr("nvidia.icd"), HasSubstr("OCL_ICD_VENDORS=libnvidia-opencl.so.1")));
  EXPECT_THAT(only_wrong(check_nvidia(machine_, registry, khronos, true)).fix,
              HasSubstr("OCL_ICD_FILENAMES=libnvidia-opencl.so.1"));
  EXPECT_THAT(only_wrong(check_nvidia(machine_, registry, ocl_icd, false)).fix,
              HasSubstr("NVIDIA_DRIVER_CAPABILITIES"));
  registry.variable = "OCL_ICD_VENDORS";
  EXPECT_EQ(check_nvidia(machine_, registry, ocl_icd, true).at(0).state, State::note);
  registry.drivers.push_back({"nvidia.icd", "libnvidia-opencl.so.1", ""});
  EXPECT_THAT(check_nvidia(machine_, registry, ocl_icd, true), IsEmpty());
}

TEST_F(Machine, GpusThatNoPlatformOffers) {
  write("dev/dri/renderD128");
  write("sys/class/drm/renderD128/device/vendor", "0x8086\n");
  PlatformFacts platform;
  platform.devices.resize(1);
  platform.devices[0].info.type = "cpu";
  EXPECT_THAT(check_unused_gpus(machine_, {platform}).at(0).fix, HasSubstr("intel-opencl-icd"));
  platform.devices[0].info.type = "gpu";
  EXPECT_THAT(check_unused_gpus(machine_, {platform}), IsEmpty());
}

TEST_F(Machine, Memory) {
  write("proc/meminfo", "MemTotal: 9000000 kB\nMemAvailable:    8000000 kB\n");
  EXPECT_THAT(check_memory(machine_).at(0).what, HasSubstr("8192.0 MB"));
  EXPECT_EQ(check_memory(machine_).at(0).state, State::ok);
  write("sys/fs/cgroup/memory.max", "400000000\n");
  write("sys/fs/cgroup/memory.current", "300000000\n");
  EXPECT_THAT(only_wrong(check_memory(machine_)).what, HasSubstr("100.0 MB are free"));
  write("sys/fs/cgroup/memory.max", "max\n");
  machine_.address_space = 1000000000;
  EXPECT_EQ(only_wrong(check_memory(machine_)).fix, "ulimit -v unlimited");
  machine_.address_space = 4000000000;
  EXPECT_EQ(check_memory(machine_).at(1).state, State::note);
}

TEST_F(Machine, Caches) {
  const fs::path kept = write("cache/deep/file", "12345").parent_path().parent_path();
  EXPECT_THAT(check_cache(machine_, kept).at(0).what, HasSubstr(": 1 files, 0.0 MB"));
  EXPECT_EQ(check_cache(machine_, machine_.root / "not/yet/there").at(0).state, State::ok);
  EXPECT_THAT(only_wrong(check_cache(machine_, kept / "deep/file/sub")).what,
              HasSubstr("is not a folder"));
  EXPECT_THAT(only_wrong(check_cache(machine_, "")).fix, HasSubstr("export CAPLET_CACHE="));
  closed_ = {kept};
  EXPECT_THAT(only_wrong(check_cache(machine_, kept)).what, HasSubstr("cannot be written by ada"));
  closed_.clear();
  free_ = 1000000;
  EXPECT_THAT(only_wrong(check_cache(machine_, kept)).what, HasSubstr("1.0 MB free"));
}

TEST_F(Machine, LayersBeforeTheDrivers) {
  EXPECT_THAT(check_layers(machine_), IsEmpty());
  variables_["OPENCL_LAYERS"] = "/a/libhostile_layer.so";
  const Findings found = check_layers(machine_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].state, State::note);
  EXPECT_EQ(found[0].about, "OPENCL_LAYERS");
  EXPECT_THAT(found[0].what, HasSubstr("/a/libhostile_layer.so"));
  EXPECT_THAT(found[0].fix, HasSubstr("unset OPENCL_LAYERS"));
}

TEST_F(Machine, ASysThatIsNotMounted) {
  folder("sys");
  const Findings found = check_sys(machine_);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].state, State::note);
  EXPECT_EQ(found[0].about, (machine_.root / "sys").string());
  EXPECT_THAT(found[0].what, HasSubstr("Not enough memory"));
  EXPECT_THAT(found[0].fix, HasSubstr("mount -t sysfs"));
  folder("sys/devices/system/cpu");
  EXPECT_THAT(check_sys(machine_), IsEmpty());
}

TEST_F(Machine, PoclsCache) {
  EXPECT_THAT(check_pocl_cache(machine_), IsEmpty());
  const fs::path file = write("file");
  variables_["HOME"] = file;
  EXPECT_THAT(only_wrong(check_pocl_cache(machine_)).what, HasSubstr(".cache/pocl/kcache"));
  variables_["XDG_CACHE_HOME"] = machine_.root;
  EXPECT_THAT(check_pocl_cache(machine_).at(0).what,
              HasSubstr((machine_.root / "pocl/kcache").string()));
  variables_["POCL_CACHE_DIR"] = file;
  EXPECT_THAT(only_wrong(check_pocl_cache(machine_)).fix, HasSubstr("POCL_CACHE_DIR"));
}

Answer answered(std::vector<PlatformFacts> platforms) {
  Answer out;
  out.end.finished = true;
  out.platforms = std::move(platforms);
  return out;
}

TEST_F(Machine, Drivers) {
  const Driver driver{"/v/a.icd", "liba.so", ""};
  EXPECT_EQ(judge_driver(driver, answered({PlatformFacts()}), machine_, true).state, State::ok);
  EXPECT_EQ(judge_driver(driver, answered({}), machine_, true).state, State::wrong);
  EXPECT_EQ(judge_driver(driver, answered({}), machine_, false).state, State::note);
  const Driver nvidia{"/v/n.icd", "libnvidia-opencl.so.1", ""};
  EXPECT_EQ(judge_driver(nvidia, answered({}), machine_, false).state, State::note);
  write("dev/nvidia0");
  EXPECT_THAT(judge_driver(nvidia, answered({}), machine_, false).fix, HasSubstr("nvidia-smi"));
  Answer broken = answered({});
  broken.load_error = "liba.so: no such file";
  EXPECT_THAT(judge_driver(driver, broken, machine_, false).what, HasSubstr("no such file"));
  EXPECT_THAT(judge_driver(driver, broken, machine_, false).fix,
              HasSubstr("sudo mv '/v/a.icd' '/v/a.icd.off'"));
  EXPECT_THAT(judge_driver({"OCL_ICD_VENDORS", "liba.so", ""}, broken, machine_, false).fix,
              HasSubstr("unset OCL_ICD_VENDORS"));
  broken.load_error =
      "libi.so: undefined symbol: "
      "_ZN3tbb6detail2r127get_thread_reference_vertexEPNS0_2d126wait_tree_vertex_interfaceE";
  EXPECT_THAT(judge_driver(driver, broken, machine_, true).what,
              HasSubstr("needs a newer libtbb.so.12"));
  EXPECT_THAT(judge_driver(driver, broken, machine_, true).fix,
              HasSubstr("LD_LIBRARY_PATH=FOLDER"));
  broken.end = {false, "", "ended with signal 11 (Segmentation fault)", "last words"};
  EXPECT_THAT(judge_driver(driver, broken, machine_, false).what,
              testing::AllOf(HasSubstr("signal 11"), HasSubstr("last words")));
}

TEST(Platforms, WithoutDevices) {
  PlatformFacts platform;
  platform.name = "rusticl";
  platform.devices_error = "clGetDeviceIDs: CL_DEVICE_NOT_FOUND";
  EXPECT_EQ(judge_platform(platform, true).state, State::wrong);
  EXPECT_EQ(judge_platform(platform, false).state, State::note);
  EXPECT_THAT(judge_platform(platform, true).what,
              HasSubstr("clGetDeviceIDs: CL_DEVICE_NOT_FOUND"));
  EXPECT_THAT(judge_platform(platform, true).fix, HasSubstr("RUSTICL_ENABLE"));
  platform.name = "Portable Computing Language";
  EXPECT_THAT(judge_platform(platform, true).fix, HasSubstr("POCL_CACHE_DIR"));
}

TEST(Devices, WhatTheyMayLack) {
  constexpr std::uint64_t least = 100;
  DeviceFacts good;
  good.info.version = "OpenCL 1.2 x";
  good.info.global_bytes = 4 * least;
  good.info.max_allocation_bytes = least;
  EXPECT_EQ(judge_device(good, least).size(), 1u);
  const auto seen = [&](const std::function<void(DeviceFacts&)>& change) {
    DeviceFacts bad = good;
    change(bad);
    const Findings found = judge_device(bad, least);
    EXPECT_EQ(found.size(), 2u);
    return found.size() == 2 && found[1].state == State::wrong && !found[1].fix.empty()
               ? found[1].what
               : "nothing";
  };
  EXPECT_THAT(seen([](DeviceFacts& d) { d.available = false; }), HasSubstr("not available"));
  EXPECT_THAT(seen([](DeviceFacts& d) { d.compiler = false; }), HasSubstr("no compiler"));
  EXPECT_THAT(seen([](DeviceFacts& d) { d.little_endian = false; }), HasSubstr("big-endian"));
  EXPECT_THAT(seen([](DeviceFacts& d) { d.profile = "EMBEDDED_PROFILE"; }),
              HasSubstr("EMBEDDED_PROFILE"));
  EXPECT_THAT(seen([](DeviceFacts& d) { d.info.version = "OpenCL 1.1 x"; }),
              HasSubstr("OpenCL 1.2 is needed"));
  EXPECT_THAT(seen([](DeviceFacts& d) { d.info.global_bytes = least - 1; }), HasSubstr("memory"));
  good.info.version = "OpenCL 3.0";
  EXPECT_EQ(judge_device(good, least).size(), 1u);
  good.info.max_allocation_bytes = least - 1;
  EXPECT_EQ(judge_device(good, least).at(1).state, State::note);
}

/// What is known of a platform with one device, as the drivers themselves say.
std::vector<std::string> known_of(const std::string& platform, const std::string& device,
                                  const std::string& driver) {
  PlatformFacts facts;
  facts.name = platform;
  facts.devices.resize(1);
  facts.devices[0].info.name = device;
  facts.devices[0].info.driver = driver;
  std::vector<std::string> out;
  for (const Finding& finding : known_quirks({facts})) {
    EXPECT_EQ(finding.state, State::note);
    out.push_back(finding.what);
  }
  return out;
}

TEST(Quirks, OfPoclAndItsCompiler) {
  const char* name = "Portable Computing Language";
  const auto launch = HasSubstr("compiles a kernel when it is launched"),
             keeps = HasSubstr("keeps compiled kernels itself");
  EXPECT_THAT(known_of(name, "pthread-skylake-avx512-Intel(R) Xeon(R) Processor", "3.1+debian"),
              ElementsAre(launch, keeps));
  EXPECT_THAT(known_of(name, "cpu-haswell-Intel(R) Xeon(R) Processor", "7.1+debian"),
              ElementsAre(launch, keeps));
  EXPECT_THAT(known_of(name, "cpu-haswell-Intel(R) Xeon(R) Processor", "6.0+debian"),
              ElementsAre(launch, keeps, HasSubstr("did not reach a fixpoint")));
}

TEST(Quirks, OfIntelsCpuRuntime) {
  const char *name = "Intel(R) OpenCL", *device = "Intel(R) Xeon(R) Processor";
  const auto vectors = HasSubstr("several work-items into one vector");
  EXPECT_THAT(known_of(name, device, "2026.22.10.0.01_160000"), ElementsAre(vectors));
  EXPECT_THAT(known_of(name, device, "2026.20.3.0.19_160000.xmain-hotfix"), ElementsAre(vectors));
  EXPECT_THAT(known_of(name, device, "2024.18.12.0.05_160000"), ElementsAre(vectors));
  EXPECT_THAT(known_of(name, device, "2024.18.7.0.11_160000"), IsEmpty());
  EXPECT_THAT(known_of(name, device, "2024.17.3.0.08_160000"), IsEmpty());
  EXPECT_THAT(known_of(name, device, "2024.16.1.0.27_160000.xmain-hotfix"),
              ElementsAre(HasSubstr("crashed on earlier kernels")));
  // The GPU's platform begins like the CPU's.
  EXPECT_THAT(known_of("Intel(R) OpenCL Graphics", "Intel(R) UHD Graphics 770", "24.35.30872.22"),
              IsEmpty());
}

TEST(Quirks, OfMesasRusticl) {
  const auto enable = HasSubstr("RUSTICL_ENABLE"), zero = HasSubstr("sign");
  EXPECT_THAT(known_of("rusticl", "llvmpipe (LLVM 15.0.6, 256 bits)", "22.3.6"),
              ElementsAre(enable, HasSubstr("a work-item in each lane"), zero));
  EXPECT_THAT(known_of("rusticl", "AMD Radeon RX 6800 (radeonsi, navi21)", "25.0.7-2"),
              ElementsAre(enable, zero));
  PlatformFacts without_devices;
  without_devices.name = "rusticl";
  EXPECT_THAT(known_quirks({without_devices}).at(0).what, enable);
}

TEST(Quirks, OfOclgrind) {
  EXPECT_THAT(known_of("Oclgrind", "Oclgrind Simulator", "Oclgrind 21.10"),
              ElementsAre(HasSubstr("compares vectors wrongly")));
  EXPECT_THAT(known_of("Oclgrind", "Oclgrind Simulator", "Oclgrind 21.1"), IsEmpty());
  EXPECT_THAT(known_of("Oclgrind", "Oclgrind Simulator", "Oclgrind 22.0"), IsEmpty());
}

TEST(Quirks, OfNoOthers) {
  EXPECT_THAT(known_of("Some other platform", "Intel(R) Xeon(R) Processor", "2026.22"), IsEmpty());
  EXPECT_THAT(known_of("Intel(R) OpenCL", "Intel(R) Xeon(R) Processor", ""), IsEmpty());
  EXPECT_THAT(known_of("Intel(R) OpenCL", "Intel(R) Xeon(R) Processor", "99999999999999999999.1"),
              IsEmpty());
}

}  // namespace
}  // namespace caplet::doctor
