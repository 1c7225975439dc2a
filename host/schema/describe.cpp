// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "schema/detail/describe.h"

namespace caplet::schema {

std::string text_of(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string text_of(const Spectrum& spectrum) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum))
    return text_of(constant->value);
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum))
    return fmt::format("{} {} {}", rgb->rgb.x, rgb->rgb.y, rgb->rgb.z);
  if (const auto* black = std::get_if<BlackbodySpectrum>(&spectrum)) return text_of(black->kelvin);
  const auto& sampled = std::get<SampledSpectrum>(spectrum);
  for (const std::string& name : named_spectrum_names()) {
    const auto known = named_spectrum(name);
    const auto* other = known ? std::get_if<SampledSpectrum>(&*known) : nullptr;
    if (other && other->values == sampled.values && other->wavelengths == sampled.wavelengths)
      return name;
  }
  return {};
}

}  // namespace caplet::schema
