// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// Returns whether the variable CAPLET_ROWS is `all`: scenes are then lowered, and kernels
/// compiled, for all rows of the lists and not for those of the scene, so that tests of other
/// scenes find the kernels compiled. Throws InputError if the variable says anything else but
/// `scene`.
bool for_all_rows();

}  // namespace caplet
