// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What was compiled for a device, shared by its copies.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "device/device.h"

namespace caplet {

struct Device::Programs {
  std::mutex mutex;
  std::map<std::pair<std::string, std::string>, cl::Program> compiled;  // by options and source
};

}  // namespace caplet
