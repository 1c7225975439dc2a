// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/environment.h"

#include <cstdlib>

namespace caplet {

std::string environment_variable(const std::string& name) {
  const char* value = std::getenv(name.c_str());
  return value ? value : "";
}

}  // namespace caplet
