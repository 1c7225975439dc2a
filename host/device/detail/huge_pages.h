// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Large buffers of processors in pages of 2 MiB, where the system has such: rays that go through a tree at random otherwise miss
// the processor's table of pages at nearly every node.
#pragma once

#include <cstddef>

#include "device/device.h"

namespace caplet {

/// A buffer of `size` bytes in huge pages; an empty handle where these are not to be had or would not pay: on devices that are no
/// processors, on systems without, for buffers smaller than such a page. $CAPLET_HUGE_PAGES=0: never. Throws cl::Error.
cl::Buffer on_huge_pages(const Device& device, bool read_only, std::size_t size);

}  // namespace caplet
