// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "device/device.h"

namespace caplet {

void self_test(const Device& device) { device.finish(); }

}  // namespace caplet
