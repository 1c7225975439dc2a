// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The fuzz target of an importer.
#pragma once

#include "import/import.h"
#include "target.h"

namespace caplet::test {

/// The target of an importer of importers.def: it refuses a file with its places, or its scene, with camera and light, is sound
/// or refused by validation.
template <class Importer>
int fuzz_importer(Importer import, const std::uint8_t* data, std::size_t size, const ImportOptions& options = {}) {
  const MemoryFile file(data, size);
  return run_target([&] {
    const Scene scene = presented(import(file.path(), OnePixel(), options));
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    diagnostics.finish();
    check_scene(scene);
    for (const Shape& shape : scene.shapes)
      if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry)) {
        for (const float radius : capsules->radius0) require(radius > 0);
        for (const float radius : capsules->radius1) require(radius > 0);
      }
  });
}

}  // namespace caplet::test
