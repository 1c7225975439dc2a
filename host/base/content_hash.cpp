// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/content_hash.h"

#include <fmt/format.h>

#include <cstdint>

namespace caplet {

std::string content_hash(std::string_view bytes) {
  // The offset basis is 0x6c62272e07bb014262b821756295c58d, the prime 2^88 + 0x13b.
  using Wide = unsigned __int128;
  Wide hash = (static_cast<Wide>(0x6c62272e07bb0142u) << 64) | 0x62b821756295c58du;
  const Wide prime = (static_cast<Wide>(1) << 88) | 0x13bu;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  return fmt::format("{:016x}{:016x}", static_cast<std::uint64_t>(hash >> 64),
                     static_cast<std::uint64_t>(hash));
}

}  // namespace caplet
