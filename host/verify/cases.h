// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Failures as files that a later run asks again: JSON, with every float of the ray in hexadecimal, so that its bits are kept.
#pragma once

#include <filesystem>
#include <vector>

#include "verify/verify.h"

namespace caplet::verify {

/// Writes case-00001.json, ... into the folder, which is made when missing. Throws RunError.
void save_cases(const std::filesystem::path& folder, const std::vector<Failure>& failures);

struct Case {
  std::filesystem::path file;
  SceneName scene;
  RayRecord ray{};
};

/// One case, or all case-*.json of a folder in order. Throws InputError when there is none, or one is not a case.
std::vector<Case> load_cases(const std::filesystem::path& path);

}  // namespace caplet::verify
