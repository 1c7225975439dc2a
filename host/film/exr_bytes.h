// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// EXR files in memory.
#pragma once

#include <string>

namespace caplet {

struct LayeredImage;  // film/image.h

/// Returns the bytes of the file that write_exr writes, with ZIP. Throws RunError.
std::string exr_bytes(const LayeredImage& image);

}  // namespace caplet
