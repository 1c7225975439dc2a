// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A photometric file either gives a table of finite intensities by ascending angles, or is refused.
#include "import/detail/ies.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using caplet::test::require;
  return caplet::test::run_target([&] {
    const caplet::IesProfile profile =
        caplet::parse_ies("fuzz.ies", {reinterpret_cast<const char*>(data), size});
    require(profile.polar.size() >= 2 &&
            profile.candela.size() == profile.polar.size() * profile.azimuths.size());
    for (const auto* angles : {&profile.polar, &profile.azimuths})
      for (std::size_t i = 0; i < angles->size(); ++i)
        require(i == 0 || (*angles)[i] > (*angles)[i - 1]);
    require(profile.azimuths.size() == 1 ||
            (profile.azimuths.front() == 0 && profile.azimuths.back() < 6.2832));
    for (const double value : profile.candela) require(std::isfinite(value) && value >= 0);
    require(std::isfinite(profile.flux()));
  });
}
