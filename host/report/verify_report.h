// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What `caplet verify` prints.
#pragma once

#include <string>

#include "verify/verify.h"

namespace caplet::report {

/// Tables by shape kind, of one device or of several beside each other, and the verdict.
std::string plain_text(const verify::Report& report, const std::string& scene);
/// rays, disagreements, seconds; `kinds`: an object a shape kind, of all devices together; `devices`: the same of each.
std::string json_text(const verify::Report& report, const std::string& scene, const verify::Options& options);

}  // namespace caplet::report
