// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet::test {

/// Declares that the running test logs `count` errors.
void expect_logged_errors(int count);

}  // namespace caplet::test
