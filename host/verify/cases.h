// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Stores failures in files that a later run can repeat: JSON, with every float of the ray in
// hexadecimal to keep its bits.
#pragma once

#include <filesystem>
#include <vector>

#include "verify/verify.h"

namespace caplet::verify {

/// Writes case-00001.json, ... into the folder, which is created if it is missing. Throws RunError.
void save_cases(const std::filesystem::path& folder, const std::vector<Failure>& failures);

struct Case {
  std::filesystem::path file;
  SceneName scene;
  RayRecord ray{};
};

/// Loads one case, or all case-*.json of a folder in order. Throws InputError when there is none,
/// or one is not a case.
std::vector<Case> load_cases(const std::filesystem::path& path);

}  // namespace caplet::verify
