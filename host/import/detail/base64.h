// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace caplet {

/// Decodes up to `most` bytes of base64 (RFC 4648). Blanks are skipped. After padding another text
/// may follow, whose bytes are appended. There is no value where a letter does not belong to
/// base64.
std::optional<std::string> bytes_of_base64(std::string_view text,
                                           std::size_t most = std::string::npos);

}  // namespace caplet
