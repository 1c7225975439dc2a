// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <string>
#include <string_view>

namespace caplet {

/// Returns 32 hexadecimal digits: FNV-1a with 128 bits (Fowler, Noll, Vo; RFC 9923).
std::string content_hash(std::string_view bytes);

}  // namespace caplet
