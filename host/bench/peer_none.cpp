// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Replaces peer.cpp in builds without Embree.
#include <stdexcept>

#include "bench/peer.h"

namespace caplet::bench {

struct Peer::Scene {};

namespace {
[[noreturn]] void refuse() { throw std::runtime_error("Embree is not built in"); }
}  // namespace

bool Peer::is_there() { return false; }
Peer::Peer(std::span<const FlatPrimitive>, PeerMode) { refuse(); }
Peer::Peer(const RoundCurves&, PeerMode) { refuse(); }
Peer::~Peer() = default;
std::size_t Peer::trace(std::span<const RayRecord>, std::span<std::uint32_t>) const { refuse(); }
std::vector<PeerHit> Peer::closest(std::span<const RayRecord>) const { refuse(); }
std::string Peer::version() { refuse(); }

}  // namespace caplet::bench
