// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scene text of any bytes either imports and can be validated, or is refused by InputError.
#include <cstddef>
#include <cstdint>

#include "base/log.h"
#include "import/pbrt.h"

namespace {

class OnePixel : public caplet::ImageReader {
  caplet::EnvironmentImage read_rgb(const std::filesystem::path&) const override { return {1, 1, {1, 1, 1}}; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  caplet::log::set_quiet(true);
  spdlog::set_level(spdlog::level::off);
  try {
    const caplet::Scene scene =
        caplet::pbrt::import_text("nowhere/fuzz.pbrt", {reinterpret_cast<const char*>(data), size}, OnePixel());
    caplet::Diagnostics diagnostics;
    caplet::validate(scene, diagnostics);
    diagnostics.finish();
    caplet::bounds_of(scene);
    caplet::count_primitives(scene);
  } catch (const caplet::InputError&) {
  }
  return 0;
}
