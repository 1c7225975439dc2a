// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Spectrum text either gives ascending wavelengths with a value each, or is refused by InputError.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "import/pbrt_spectrum_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto spectrum = caplet::pbrt::parse_spectrum_text("fuzz.spd", {reinterpret_cast<const char*>(data), size});
    if (spectrum.wavelengths.size() != spectrum.values.size() || spectrum.values.empty()) std::abort();
    for (std::size_t i = 1; i < spectrum.wavelengths.size(); ++i)
      if (!(spectrum.wavelengths[i] > spectrum.wavelengths[i - 1])) std::abort();
  } catch (const caplet::InputError&) {
  }
  return 0;
}
