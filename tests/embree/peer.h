// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "bench/peer.h"

namespace caplet::test {

using bench::Peer;
using bench::PeerHit;
using bench::PeerMode;
using bench::RoundCurves;

}  // namespace caplet::test
