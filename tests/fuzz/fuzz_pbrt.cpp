// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scene text of any bytes either imports and is sound once it is validated, or is refused. It can name the files of the folder
// beside/.
#include "import/detail/pbrt.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::run_target([&] {
    const caplet::Scene scene = caplet::pbrt::import_text(CAPLET_FUZZ_BESIDE "/fuzz.pbrt",
                                                          {reinterpret_cast<const char*>(data), size}, caplet::test::OnePixel());
    caplet::Diagnostics diagnostics;
    caplet::validate(scene, diagnostics);
    diagnostics.finish();
    caplet::test::check_scene(scene);
  });
}
