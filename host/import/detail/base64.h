// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace caplet {

/// The first `most` bytes of base64 (RFC 4648), or as many as there are; blanks are passed over, and after padding another text
/// may follow, whose bytes join. None where a letter is none of base64.
std::optional<std::string> bytes_of_base64(std::string_view text, std::size_t most = std::string::npos);

}  // namespace caplet
