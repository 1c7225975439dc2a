// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scene text of any bytes either imports and is sound once it is validated, or is refused. What is
// sound is written, or refused, and what is written is read as the same text. It can name the files
// of the folder beside/.
#include "export/export.h"
#include "import/detail/pbrt/pbrt.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return caplet::test::run_target([&] {
    const caplet::Scene scene = caplet::pbrt::import_text(
        CAPLET_FUZZ_BESIDE "/fuzz.pbrt", {reinterpret_cast<const char*>(data), size},
        caplet::test::OnePixel());
    caplet::Diagnostics diagnostics;
    caplet::validate(scene, diagnostics);
    diagnostics.finish();
    caplet::test::check_scene(scene);
    const auto text_of = [](const caplet::Scene& one) {
      std::string out;
      caplet::write_pbrt(one, CAPLET_FUZZ_BESIDE, [&](std::string_view piece) { out += piece; });
      return out;
    };
    const std::string text = text_of(scene);
    try {
      const caplet::Scene again = caplet::pbrt::import_text(CAPLET_FUZZ_BESIDE "/fuzz.pbrt", text,
                                                            caplet::test::OnePixel());
      caplet::test::require(text_of(again) == text);
    } catch (const caplet::InputError&) {
      caplet::test::require(false);
    }
  });
}
