// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where the driver of a portable installation is looked for, and when its devices are meant.
#include "device/bundled.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "device/select.h"
#include "support/data.h"
#include "support/environment.h"

namespace caplet {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using Variables = std::map<std::string, std::string>;

std::function<std::string(const std::string&)> with(const Variables& variables) {
  return [=](const std::string& name) {
    return variables.contains(name) ? variables.at(name) : std::string();
  };
}

/// An installation's folder of the driver, with an empty library.
fs::path make_driver(const fs::path& folder) {
  fs::create_directories(folder / "lib/caplet");
  std::ofstream(folder / "lib/caplet/libpocl-caplet.so.2");
  return folder;
}

TEST(BundledDriver, LiesBesideTheExtensionAndBesideTheProgramsFolder) {
  const fs::path package = test::temporary_folder();
  const fs::path folder = make_driver(package / "pocl");
  for (const char* file : {"_caplet.abi3.so", "bin/caplet"}) {
    const BundledDriver found = bundled_driver(package / file, with({}));
    EXPECT_EQ(found.folder, folder) << file;
    EXPECT_EQ(found.library, folder / "lib/caplet/libpocl-caplet.so.2");
    EXPECT_EQ(found.linker, folder / "bin");
  }
  EXPECT_FALSE(bundled_driver(package / "deeper/bin/caplet", with({})));
  EXPECT_FALSE(bundled_driver({}, with({})));
}

TEST(BundledDriver, AFolderWithoutTheLibraryIsNone) {
  const fs::path package = test::temporary_folder();
  fs::create_directories(package / "pocl/lib/caplet");
  EXPECT_FALSE(bundled_driver(package / "bin/caplet", with({})));
}

TEST(BundledDriver, IsNamedOrForbiddenByTheVariable) {
  const fs::path package = test::temporary_folder(), other = make_driver(package / "other");
  make_driver(package / "pocl");
  EXPECT_EQ(
      bundled_driver(package / "bin/caplet", with({{"CAPLET_BUNDLED_DRIVER", other.string()}}))
          .folder,
      other);
  EXPECT_FALSE(bundled_driver(package / "bin/caplet", with({{"CAPLET_BUNDLED_DRIVER", "0"}})));
  EXPECT_FALSE(bundled_driver(package / "bin/caplet",
                              with({{"CAPLET_BUNDLED_DRIVER", (package / "none").string()}})));
}

TEST(BundledDriver, HasACacheOfItsOwn) {
  const test::ScopedVariable folder("CAPLET_CACHE", "/cache");
  EXPECT_EQ(bundled_cache_folder(with({})), "/cache/pocl");
  EXPECT_EQ(bundled_cache_folder(with({{"POCL_CACHE_DIR", "/mine"}})), "/mine");
}

TEST(BundledDriver, TakesAWholeLevelThatTheProcessorHas) {
  EXPECT_EQ(bundled_level(true, true), "");
  EXPECT_EQ(bundled_level(false, true), "avx");
  EXPECT_EQ(bundled_level(false, false), "sse2");
}

TEST(BundledDriver, ItsLinkerIsTheFirstInThePath) {
  EXPECT_EQ(with_first("/usr/bin:/bin", "/w/pocl/bin"), "/w/pocl/bin:/usr/bin:/bin");
  EXPECT_EQ(with_first("/w/pocl/bin:/usr/bin", "/w/pocl/bin"), "/w/pocl/bin:/usr/bin");
  EXPECT_EQ(with_first("/w/pocl/bin2:/usr/bin", "/w/pocl/bin"),
            "/w/pocl/bin:/w/pocl/bin2:/usr/bin");
  EXPECT_EQ(with_first("/usr/bin:/w/pocl/bin", "/w/pocl/bin"), "/w/pocl/bin:/usr/bin:/w/pocl/bin");
  EXPECT_EQ(with_first("", "/w/pocl/bin"), "/w/pocl/bin");
}

DeviceInfo device(int index, const char* name, const char* type, bool bundled = false) {
  DeviceInfo out;
  out.index = index;
  out.name = name;
  out.type = type;
  out.bundled = bundled;
  return out;
}

const std::vector<DeviceInfo> gpu_and_bundled = {device(0, "Radeon", "gpu"),
                                                 device(1, "pthread-EPYC", "cpu", true)};
const std::vector<DeviceInfo> both = {device(0, "pthread-EPYC", "cpu"),
                                      device(1, "pthread-EPYC", "cpu", true)};
const std::vector<DeviceInfo> alone = {device(0, "pthread-EPYC", "cpu", true)};

TEST(SelectBundled, IsTheDefaultWhereThereIsNothingElse) {
  EXPECT_EQ(select_device(alone, ""), 0u);
  EXPECT_EQ(select_device(both, ""), 0u);
  EXPECT_EQ(select_device(gpu_and_bundled, ""), 0u);
  EXPECT_EQ(select_device(gpu_and_bundled, "cpu"), 1u);
}

TEST(SelectBundled, ByItsWordOrIndex) {
  EXPECT_EQ(select_device(both, "bundled"), 1u);
  EXPECT_EQ(select_device(both, "Bundled"), 1u);
  EXPECT_EQ(select_device(both, "1"), 1u);
  EXPECT_THAT(select_devices(both, "bundled,0"), ElementsAre(1, 0));
  try {
    select_device({both[0]}, "bundled");
    ADD_FAILURE();
  } catch (const UnknownDevice& error) {
    EXPECT_THAT(
        error.what(),
        HasSubstr(
            "no OpenCL driver came with this program; the devices are 0 'pthread-EPYC' (cpu)"));
  }
}

TEST(SelectBundled, ANameMeansTheMachinesDeviceFirst) {
  EXPECT_EQ(select_device(both, "epyc"), 0u);
  EXPECT_EQ(select_device(both, "pthread-epyc"), 0u);
  EXPECT_EQ(select_device(gpu_and_bundled, "epyc"), 1u);
  try {
    select_device(both, "tesla");
    ADD_FAILURE();
  } catch (const UnknownDevice& error) {
    EXPECT_THAT(error.what(), HasSubstr("0 'pthread-EPYC' (cpu), 1 'pthread-EPYC' (cpu, bundled)"));
  }
}

TEST(SelectBundled, AllDoesNotTakeTheProcessorTwice) {
  EXPECT_THAT(select_devices(both, "all"), ElementsAre(0));
  EXPECT_THAT(select_devices(gpu_and_bundled, "all"), ElementsAre(0, 1));
  EXPECT_THAT(select_devices(alone, "all"), ElementsAre(0));
}

/// What is selected without knowing the bundled device, where anything is, is what is selected with
/// it.
TEST(SelectBundled, TheMachinesDevicesAreEnoughWhereTheyAreMeant) {
  for (const std::vector<DeviceInfo>& devices : {gpu_and_bundled, both, alone}) {
    const std::vector<DeviceInfo> machine(devices.begin(), devices.end() - 1);
    for (const char* choice :
         {"", "0", "1", "cpu", "gpu", "all", "bundled", "epyc", "radeon", "0,1"}) {
      const auto early = select_machine_devices(machine, choice, true);
      if (early) {
        EXPECT_EQ(*early, select_devices(devices, choice)) << choice;
      }
    }
  }
  EXPECT_TRUE(select_machine_devices({gpu_and_bundled[0]}, "", false));
  EXPECT_TRUE(select_machine_devices({both[0]}, "cpu", false));
  EXPECT_TRUE(select_machine_devices({both[0]}, "all", true));
  EXPECT_FALSE(select_machine_devices({gpu_and_bundled[0]}, "all", true));
  EXPECT_FALSE(select_machine_devices({gpu_and_bundled[0]}, "cpu", false));
  EXPECT_FALSE(select_machine_devices({both[0]}, "bundled", false));
  EXPECT_FALSE(select_machine_devices({}, "", false));
}

}  // namespace
}  // namespace caplet
