// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Whether this build is instrumented by AddressSanitizer (preset asan), for tests that must ask for
// less then.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define CAPLET_TEST_SANITIZED 1
#endif
#endif

namespace caplet::test {

#if defined(CAPLET_TEST_SANITIZED) || defined(__SANITIZE_ADDRESS__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace caplet::test
