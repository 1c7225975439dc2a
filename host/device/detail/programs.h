// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Holds the programs that were compiled for a device; copies of the device share them, and all
// devices of a process that are the same one of PoCL.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "device/device.h"

namespace caplet {

class Device::Programs {
 public:
  struct Compiled {
    cl::Program program;
    bool own_declarations = false;  // as Program::own_declarations
  };
  using Key = std::pair<std::string, std::string>;  // options and source
  /// A render needs some fifteen. Beyond this many, the one that was used longest ago is dropped;
  /// a program is about a megabyte.
  static constexpr std::size_t most = 64;

  std::optional<Compiled> find(const Key& key);
  void add(const Key& key, const Compiled& compiled);

 private:
  struct Entry {
    Compiled compiled;
    std::uint64_t last_use;
  };
  std::mutex mutex_;
  std::map<Key, Entry> entries_;
  std::uint64_t uses_ = 0;
};

/// Returns the key of a program's binary in Caplet's cache.
std::string cache_key(const DeviceInfo& info, const std::string& options,
                      const std::string& source);

/// The context of a device and what was compiled in it.
struct Device::Shared {
  cl::Context context;
  std::shared_ptr<Programs> programs;
};

}  // namespace caplet
