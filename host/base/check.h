// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Checks for programmer errors: they print both values and throw std::logic_error.
#pragma once

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "base/error.h"

#define CAPLET_CHECK_OP(a, op, b)                                                      \
  do {                                                                                 \
    const auto& check_a_ = (a);                                                        \
    const auto& check_b_ = (b);                                                        \
    if (!(check_a_ op check_b_))                                                       \
      ::caplet::detail::check_failed(#a " " #op " " #b, fmt::format("{}", check_a_),   \
                                     fmt::format("{}", check_b_), __FILE__, __LINE__); \
  } while (false)
#define CHECK_EQ_(a, b) CAPLET_CHECK_OP(a, ==, b)
#define CHECK_LT_(a, b) CAPLET_CHECK_OP(a, <, b)
#define CHECK_LE_(a, b) CAPLET_CHECK_OP(a, <=, b)

namespace caplet {

/// Converts integers and throws std::logic_error when the value does not fit.
template <class To, class From>
To narrow(From value) {
  if (!std::in_range<To>(value))
    detail::check_failed("narrow", fmt::format("{}", value),
                         fmt::format("{}", std::numeric_limits<To>::max()), __FILE__, __LINE__);
  return static_cast<To>(value);
}

}  // namespace caplet
