// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// This is the CIE 1931 2 degree standard observer.
#pragma once

namespace caplet {

/// These are x-bar, y-bar, z-bar at 360, 361, ... 830 nm.
extern const double cie_1931_observer[471 * 3];

}  // namespace caplet
