// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/spectrum.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "base/check.h"
#include "lower/detail/spectrum_color.h"
#include "lower/detail/spectrum_uplift.h"

namespace caplet {

namespace {

/// Returns wavelengths at u = i / CAPLET_WAVELENGTH_CELLS: the inverse of the CDF of the sampling
/// density.
std::vector<float> make_wavelength_table() {
  constexpr std::size_t cells = CAPLET_WAVELENGTH_CELLS;
  const SpectrumSamples density = wavelength_density();
  std::array<double, CAPLET_LAMBDA_COUNT> cdf;
  cdf[0] = 0;
  for (std::size_t i = 1; i < cdf.size(); ++i)
    cdf[i] = cdf[i - 1] + 0.5 * (density[i - 1] + density[i]);
  std::vector<float> table(cells + 1);
  std::size_t i = 0;
  for (std::size_t cell = 0; cell <= cells; ++cell) {
    const double u = static_cast<double>(cell) / cells * cdf.back();
    while (i + 2 < cdf.size() && cdf[i + 1] < u) ++i;
    const double fraction = std::clamp((u - cdf[i]) / (cdf[i + 1] - cdf[i]), 0.0, 1.0);
    table[cell] = static_cast<float>(double{CAPLET_LAMBDA_MIN} + static_cast<double>(i) + fraction);
  }
  return table;
}

template <class Function>
std::vector<float> tabulate(const SpectrumSamples& samples, Function function) {
  std::vector<float> table;
  for (const double value : samples) table.push_back(static_cast<float>(function(value)));
  return table;
}

SpectrumRecord constant_record(double value) {
  SpectrumRecord record{};
  record.kind = spectrum_constant;
  record.scale = static_cast<float>(value);
  return record;
}

SpectrumRecord sigmoid_record(const glm::dvec3& rgb, double scale, ColorSpace space) {
  const SigmoidFit fit = fit_sigmoid(rgb, space);
  SpectrumRecord record{};
  record.kind = spectrum_sigmoid;
  record.scale = static_cast<float>(scale);
  record.c0 = static_cast<float>(fit.coefficients[0]);
  record.c1 = static_cast<float>(fit.coefficients[1]);
  record.c2 = static_cast<float>(fit.coefficients[2]);
  return record;
}

double maximum(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// Returns the value of a spectrum that is_constant().
double constant_value(const Spectrum& spectrum) {
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) return rgb->rgb.r;
  return evaluate(spectrum, double{CAPLET_LAMBDA_MIN});
}

/// ScaledColor is rgb >= 0 as scale and a colour of maximum 1/2, where sigmoids are smooth.
struct ScaledColor {
  explicit ScaledColor(const RgbSpectrum& spectrum) {
    const glm::dvec3 color = glm::max(spectrum.rgb, 0.0);
    scale = 2 * maximum(color);
    rgb = scale > 0 ? color / scale : glm::dvec3(0);
  }
  double scale;
  glm::dvec3 rgb;
};

}  // namespace

SpectrumTable::SpectrumTable(FlatScene& out, ColorSpace space) : out_(out), space_(space) {
  const auto& observer = normalized_observer();
  out_.observer.clear();
  for (std::size_t i = 0; i < observer[0].size(); ++i) {
    for (const SpectrumSamples& samples : observer)
      out_.observer.push_back(static_cast<float>(samples[i]));
    out_.observer.push_back(0);
  }
  out_.wavelength_table = make_wavelength_table();
  out_.world.illuminant_table = illuminant_table(space_);
}

std::uint32_t SpectrumTable::illuminant_table(ColorSpace space) {
  return add_table(tabulate(illuminant(space), [](double v) { return v; }));
}

std::uint32_t SpectrumTable::uplift_table(ColorSpace space) {
  const auto [found, fresh] =
      uplift_tables_.try_emplace(space, narrow<std::uint32_t>(out_.spectrum_tables.size()));
  if (!fresh) return found->second;
  const std::vector<float>& table = sigmoid_table(space);
  out_.spectrum_tables.insert(out_.spectrum_tables.end(), table.begin(), table.end());
  return found->second;
}

std::uint32_t SpectrumTable::add_table(std::vector<float> table) {
  const auto [found, fresh] =
      tables_.try_emplace(std::move(table), narrow<std::uint32_t>(out_.spectrum_tables.size()));
  if (fresh)
    out_.spectrum_tables.insert(out_.spectrum_tables.end(), found->first.begin(),
                                found->first.end());
  return found->second;
}

std::uint32_t SpectrumTable::add_record(const SpectrumRecord& record) {
  const Key key{record.kind, record.scale, record.c0, record.c1, record.c2, record.table};
  const auto [found, fresh] = records_.try_emplace(key, narrow<std::uint32_t>(out_.spectra.size()));
  if (fresh) out_.spectra.push_back(record);
  return found->second;
}

std::uint32_t SpectrumTable::add_samples(std::vector<float> table) {
  SpectrumRecord record{};
  record.kind = spectrum_table;
  record.scale = 1;
  record.table = add_table(std::move(table));
  return add_record(record);
}

std::uint32_t SpectrumTable::add_reflectance(const Spectrum& spectrum) {
  const auto in_range = [](double v) { return std::clamp(v, 0.0, 1.0); };
  if (is_constant(spectrum)) return add_record(constant_record(in_range(constant_value(spectrum))));
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) {
    const glm::dvec3 color = glm::clamp(rgb->rgb, 0.0, 1.0);
    if (color.r == color.g && color.g == color.b) return add_record(constant_record(color.r));
    return add_record(sigmoid_record(color, 1, rgb->space));
  }
  return add_samples(tabulate(sample(spectrum), in_range));
}

std::uint32_t SpectrumTable::add_unbounded(const Spectrum& spectrum) {
  const auto positive = [](double v) { return std::max(v, 0.0); };
  if (is_constant(spectrum)) return add_record(constant_record(positive(constant_value(spectrum))));
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) {
    const ScaledColor color(*rgb);
    return add_record(sigmoid_record(color.rgb, color.scale, rgb->space));
  }
  return add_samples(tabulate(sample(spectrum), positive));
}

std::uint32_t SpectrumTable::add_number(double value) { return add_record(constant_record(value)); }

std::uint32_t SpectrumTable::add_extinction(const Spectrum& reflectance) {
  const auto k_of = [](double r) {
    r = std::clamp(r, 0.0, 0.9999);
    return 2 * std::sqrt(r) / std::sqrt(1 - r);
  };
  if (is_constant(reflectance))
    return add_record(constant_record(k_of(constant_value(reflectance))));
  const auto* rgb = std::get_if<RgbSpectrum>(&reflectance);
  if (!rgb) return add_samples(tabulate(sample(reflectance), k_of));
  const glm::dvec3 color = glm::clamp(rgb->rgb, 0.0, 1.0);
  if (color.r == color.g && color.g == color.b) return add_record(constant_record(k_of(color.r)));
  const SigmoidFit fit = fit_sigmoid(color, rgb->space);
  SpectrumSamples samples;
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] =
        sigmoid_value(fit.coefficients, double{CAPLET_LAMBDA_MIN} + static_cast<double>(i));
  return add_samples(tabulate(samples, k_of));
}

std::uint32_t SpectrumTable::add_illuminant(const Spectrum& spectrum) {
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) {
    const ScaledColor color(*rgb);
    SpectrumRecord record{};
    if (is_constant(spectrum)) {
      record.kind = spectrum_table;
      record.scale = static_cast<float>(color.scale / 2);
    } else {
      record = sigmoid_record(color.rgb, color.scale, rgb->space);
      record.kind = spectrum_sigmoid_illuminant;
    }
    record.table = illuminant_table(rgb->space);
    return add_record(record);
  }
  if (is_constant(spectrum))
    return add_record(constant_record(constant_value(spectrum) > 0 ? 1 : 0));
  SpectrumSamples samples = sample(spectrum);
  for (double& value : samples) value = std::max(value, 0.0);
  const double luminance = xyz_of(samples).y;
  return add_samples(
      tabulate(samples, [luminance](double v) { return luminance > 0 ? v / luminance : 0; }));
}

double SpectrumTable::illuminant_luminance(const Spectrum& spectrum) const {
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) {
    const ScaledColor color(*rgb);
    if (is_constant(spectrum)) return color.scale / 2;
    const SigmoidFit fit = fit_sigmoid(color.rgb, rgb->space);
    SpectrumSamples samples = illuminant(rgb->space);
    for (std::size_t i = 0; i < samples.size(); ++i)
      samples[i] *= color.scale * sigmoid_value(fit.coefficients,
                                                double{CAPLET_LAMBDA_MIN} + static_cast<double>(i));
    return xyz_of(samples).y;
  }
  SpectrumSamples samples = sample(spectrum);
  for (double& value : samples) value = std::max(value, 0.0);
  return xyz_of(samples).y > 0 ? 1 : 0;
}

}  // namespace caplet
