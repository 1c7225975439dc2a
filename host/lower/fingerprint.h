// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tells whether two runs render the same samples. Hashes of scene files would tell too much (a
// comment changes them) and too little (options, files that they name, another importer's version).
// Scene and view have hashes of their own, so that a refusal says what differs.
#pragma once

#include <string>

#include "lower/flat_scene.h"

namespace caplet {

/// Returns a hash of all buffers of a scene: 32 hexadecimal digits. It is the same for every run
/// and machine that lowers the same scene to the same bits.
std::string fingerprint(const FlatScene& scene);

/// Does the same for a view: camera, filter, sampler with its seed, integrator, size and crop.
std::string fingerprint(const FlatView& view);

}  // namespace caplet
