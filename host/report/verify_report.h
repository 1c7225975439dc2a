// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reports of `caplet verify`.
#pragma once

#include <string>

#include "verify/verify.h"

namespace caplet::report {

/// Returns tables by shape kind, of one or several devices side by side, and the verdict.
std::string plain_text(const verify::Report& report, const std::string& scene);
/// Returns rays, disagreements, seconds; `kinds`: an object per shape kind, of all devices
/// together; `devices`: the same of each.
std::string json_text(const verify::Report& report, const std::string& scene,
                      const verify::Options& options);

}  // namespace caplet::report
