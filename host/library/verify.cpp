// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "caplet/verify.h"

#include <fmt/format.h>

#include "library/detail/inside.h"
#include "report/verify_report.h"
#include "verify/verify.h"

namespace caplet::v0 {

namespace {

VerifyReport verified(const caplet::Scene* scene, std::span<const Device> devices,
                      const VerifyOptions& options) {
  std::vector<caplet::Device> on;
  for (const Device& device : devices) on.push_back(Inside::device(device));
  if (on.empty()) throw InputError("nothing to verify: no device is given");
  caplet::verify::Options inner;
  inner.rays = options.rays;
  inner.seed = options.seed;
  inner.progress = options.progress;
  const std::string file = scene ? scene->source : std::string();
  const caplet::verify::Report found = caplet::verify::verify(scene, file, on, inner);
  const std::string label = scene ? file : fmt::format("torture set, seed {}", options.seed);
  VerifyReport out;
  for (const caplet::verify::DeviceReport& one : found.devices)
    out.devices.push_back({to_public(one.info), one.statistics.rays, one.statistics.hits,
                           one.statistics.disagreements, one.statistics.worst(), one.seconds});
  out.text = report::plain_text(found, label);
  out.json = report::json_text(found, label, inner);
  return out;
}

}  // namespace

VerifyReport verify(const Scene& scene, std::span<const Device> devices,
                    const VerifyOptions& options) {
  return verified(Inside::model(scene).get(), devices, options);
}

VerifyReport verify(std::span<const Device> devices, const VerifyOptions& options) {
  return verified(nullptr, devices, options);
}

}  // namespace caplet::v0
