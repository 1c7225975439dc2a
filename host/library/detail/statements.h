// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Converts parameters of the public classes to those of statements.
#pragma once

#include <cstddef>
#include <string>

#include "caplet/material.h"
#include "import/statement.h"

namespace caplet::v0 {

/// Puts the values of `parameter` into `out`: of a list, `count` values from `first` on, or all
/// where `count` is 0. Throws InputError for an image, and for numbers that are not finite; the
/// message names `owner`.
void put_values(const std::string& owner, const Parameter& parameter, StatementParameter& out,
                std::size_t first = 0, std::size_t count = 0);

ProgramStatement to_statement(const std::string& directive, const std::string& type,
                              const Parameters& parameters);

}  // namespace caplet::v0
