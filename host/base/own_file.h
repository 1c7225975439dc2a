// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds where this code is installed.
#pragma once

#include <filesystem>

namespace caplet {

/// Returns the program or shared library that contains this code, as an absolute path without
/// links; empty if unknown.
std::filesystem::path own_file();

}  // namespace caplet
