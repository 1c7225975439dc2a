// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "report/device_json.h"

namespace caplet::report {

nlohmann::ordered_json device_json(const DeviceInfo& device) {
  return {{"index", device.index},
          {"name", device.name},
          {"type", device.type},
          {"vendor", device.vendor},
          {"driver", device.driver},
          {"version", device.version},
          {"platform", device.platform},
          {"bundled", device.bundled},
          {"compute_units", device.compute_units},
          {"native_float_width", device.native_float_width},
          {"encoding", name_of(natural_encoding(device))},
          {"global_bytes", device.global_bytes},
          {"max_allocation_bytes", device.max_allocation_bytes}};
}

}  // namespace caplet::report
