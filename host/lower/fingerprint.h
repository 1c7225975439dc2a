// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Tells whether two runs render the same samples. Hashes of scene files would tell too much (a
// comment changes them) and too little (options, files that they name, another importer's version).
// Scene and view have hashes of their own, so that a refusal says what differs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lower/changes.h"
#include "lower/flat_scene.h"

namespace caplet {

/// Returns a hash of all buffers of a scene: 32 hexadecimal digits. It is the same for every run
/// and machine that lowers the same scene to the same bits.
std::string fingerprint(const FlatScene& scene);

/// Keeps the hashes of a scene's buffers, so that only those that have changed are read again.
class SceneFingerprint {
 public:
  /// Forgets what has changed since the last call of `of`.
  void note(const SceneChanges& changes);
  /// Returns the scene's fingerprint, as the function has it.
  std::string of(const FlatScene& scene);

 private:
  using Hash = std::array<std::uint64_t, 2>;
  struct Buffer {
    std::size_t bytes = 0;
    std::vector<Hash> pieces;  // none: not known
  };

#define GROUP_BEGIN(Type, group)
#define GROUP_END(Type)
#define BUFFER(name, type, access) Buffer name;
  struct Buffers {
    SCENE_GROUPS
  } buffers_;
#undef BUFFER
#undef GROUP_END
#undef GROUP_BEGIN
};

/// Does the same for a view: camera, filter, sampler with its seed, integrator, size and crop.
std::string fingerprint(const FlatView& view);

}  // namespace caplet
