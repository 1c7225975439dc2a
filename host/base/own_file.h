// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Where this code is installed.
#pragma once

#include <filesystem>

namespace caplet {

/// The program or shared library that this code is in, as an absolute path without links; empty where that cannot be told.
std::filesystem::path own_file();

}  // namespace caplet
