// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace caplet::view {

/// Returns whether only this machine can reach a server at `host`, a numeric address: 127.0.0.0/8
/// and ::1.
bool is_this_machine_alone(const std::string& host);

/// Returns the addresses of a server that listens at `host`: for 0.0.0.0 and :: those of the
/// machine's networks, else the host itself. The list is never empty: without a network it is
/// 127.0.0.1 or ::1.
std::vector<std::string> addresses_reached(const std::string& host);

/// Returns "127.0.0.1:8080", "[::1]:8080".
std::string authority_of(const std::string& host, std::uint16_t port);

}  // namespace caplet::view
