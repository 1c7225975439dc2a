// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The fuzz target of an importer.
#pragma once

#include <algorithm>

#include "import/import.h"
#include "target.h"

namespace caplet::test {

/// The target of an importer of importers.def: it refuses a file with its places, or its scene,
/// with camera and light, is sound or refused by validation. `has_points`: capsules may end in one.
template <class Importer>
int fuzz_importer(Importer import, const std::uint8_t* data, std::size_t size,
                  const ImportOptions& options = {}, bool has_points = false) {
  const MemoryFile file(data, size);
  return run_target([&] {
    const Scene scene = presented(import(file.path(), OnePixel(), options));
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    diagnostics.finish();
    check_scene(scene);
    for (const Shape& shape : scene.shapes)
      if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) {
        for (std::size_t i = 0; i < capsules->radius0.size(); ++i) {
          const float radius0 = capsules->radius0[i],
                      radius1 = capsules->radius1.empty() ? radius0 : capsules->radius1[i];
          require(has_points ? std::max(radius0, radius1) > 0 : std::min(radius0, radius1) > 0);
        }
      }
  });
}

}  // namespace caplet::test
