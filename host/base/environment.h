// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string>

namespace caplet {

/// Returns the value of an environment variable of this process; empty where it is not set.
std::string environment_variable(const std::string& name);

}  // namespace caplet
