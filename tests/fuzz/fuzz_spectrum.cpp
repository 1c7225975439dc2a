// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spectrum text either gives ascending wavelengths with a value each, or is refused.
#include "import/detail/pbrt/spectrum_file.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using caplet::test::require;
  return caplet::test::run_target([&] {
    const auto spectrum =
        caplet::pbrt::parse_spectrum_text("fuzz.spd", {reinterpret_cast<const char*>(data), size});
    require(!spectrum.values.empty() && spectrum.wavelengths.size() == spectrum.values.size());
    for (const double value : spectrum.values) require(std::isfinite(value));
    for (std::size_t i = 0; i < spectrum.wavelengths.size(); ++i)
      require(spectrum.wavelengths[i] > (i == 0 ? 0 : spectrum.wavelengths[i - 1]) &&
              std::isfinite(spectrum.wavelengths[i]));
  });
}
