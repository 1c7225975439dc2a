// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Holds the programs that were compiled for a device; copies of the device share them.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "device/device.h"

namespace caplet {

struct Device::Programs {
  struct Compiled {
    cl::Program program;
    bool own_declarations;  // as Program::own_declarations
  };
  std::mutex mutex;
  std::map<std::pair<std::string, std::string>, Compiled> compiled;  // by options and source
};

}  // namespace caplet
