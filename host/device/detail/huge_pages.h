// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Puts large buffers of CPUs into pages of 2 MiB, where the system has them: otherwise rays that
// traverse a tree at random miss the TLB at nearly every node.
#pragma once

#include <cstddef>

#include "device/device.h"

namespace caplet {

/// Returns a buffer of `size` bytes in huge pages. The handle is empty where these cannot be had or
/// would not pay: on devices that are not CPUs, on systems without huge pages, for buffers smaller
/// than such a page. $CAPLET_HUGE_PAGES=0: never. Throws cl::Error.
cl::Buffer on_huge_pages(const Device& device, bool read_only, std::size_t size);

}  // namespace caplet
