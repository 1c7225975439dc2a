// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/addresses.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>

namespace caplet::view {

namespace {

/// Returns the address of an interface that is up and no loopback; empty for one that a browser
/// could not use, such as an address of one link.
std::string address_of(const ifaddrs& interface, bool with_v6) {
  if (!interface.ifa_addr || !(interface.ifa_flags & IFF_UP) ||
      (interface.ifa_flags & IFF_LOOPBACK))
    return {};
  std::array<char, INET6_ADDRSTRLEN> text{};
  const int family = interface.ifa_addr->sa_family;
  if (family == AF_INET) {
    const auto* address = reinterpret_cast<const sockaddr_in*>(interface.ifa_addr);
    ::inet_ntop(family, &address->sin_addr, text.data(), text.size());
  } else if (family == AF_INET6 && with_v6) {
    const auto* address = reinterpret_cast<const sockaddr_in6*>(interface.ifa_addr);
    if (!IN6_IS_ADDR_LINKLOCAL(&address->sin6_addr))
      ::inet_ntop(family, &address->sin6_addr, text.data(), text.size());
  }
  return text.data();
}

}  // namespace

bool is_this_machine_alone(const std::string& host) {
  return host.starts_with("127.") || host == "::1";
}

std::vector<std::string> addresses_reached(const std::string& host) {
  const bool all_v6 = host == "::";
  if (host != "0.0.0.0" && !all_v6) return {host};
  std::vector<std::string> out;
  ifaddrs* first = nullptr;
  if (::getifaddrs(&first) == 0) {
    for (const ifaddrs* one = first; one; one = one->ifa_next)
      if (std::string address = address_of(*one, all_v6);
          !address.empty() && std::ranges::find(out, address) == out.end())
        out.push_back(std::move(address));
    ::freeifaddrs(first);
  }
  if (out.empty()) out.emplace_back(all_v6 ? "::1" : "127.0.0.1");
  return out;
}

std::string authority_of(const std::string& host, std::uint16_t port) {
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port)
                                             : fmt::format("[{}]:{}", host, port);
}

}  // namespace caplet::view
