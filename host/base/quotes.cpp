// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/quotes.h"

#include <utility>

namespace caplet {

namespace {

thread_local Unproven* innermost = nullptr;

}  // namespace

Unproven::Unproven() : outer_(std::exchange(innermost, this)) {}
Unproven::~Unproven() { innermost = outer_; }

bool may_quote() { return !innermost || innermost->is_proven(); }

}  // namespace caplet
