// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// PoCL loads compiled kernels from its cache into the process. Damaged ones end the process with
// SIGABRT, SIGBUS or SIGSEGV, or cause CL errors. The program then runs itself again, once, with a
// fresh cache folder, and names the one to delete.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "device/device.h"

namespace caplet {

/// FreshPoclCache is a separate folder for PoCL's cache for as long as the object lives:
/// POCL_CACHE_DIR names it. Make it before any OpenCL call of the process.
class FreshPoclCache {
 public:
  /// Throws RunError when no folder can be made.
  FreshPoclCache();
  ~FreshPoclCache();
  FreshPoclCache(const FreshPoclCache&) = delete;
  FreshPoclCache& operator=(const FreshPoclCache&) = delete;

 private:
  std::filesystem::path folder_;
  std::optional<std::string> before_;
};

/// Make a SecondTry in main before anything else, for as long as the program runs.
class SecondTry {
 public:
  /// Takes `arguments` as main has them. In the second process it makes the fresh cache folder.
  explicit SecondTry(char** arguments);
  ~SecondTry();
  SecondTry(const SecondTry&) = delete;
  SecondTry& operator=(const SecondTry&) = delete;

  /// From this call to driver_works() a crash of PoCL starts the second process, whatever signal
  /// handlers PoCL has set. Does nothing on other platforms, and without a SecondTry.
  static void guard(const Device& device);
  /// Call this once the driver has run the kernels: later crashes are not caused by its cache. In
  /// the second process it says which folder to delete.
  static void driver_works();
  /// Starts the second process in place of this one if the driver is guarded and its cache may have
  /// caused the error. Returns otherwise.
  static void after(const DriverError& error);

 private:
  std::optional<FreshPoclCache> fresh_;
};

}  // namespace caplet
