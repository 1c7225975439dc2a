// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/spectrum_color.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "base/check.h"
#include "lower/color.h"
#include "lower/detail/spectrum_observer.h"

namespace caplet {

namespace {

constexpr std::size_t count = CAPLET_LAMBDA_COUNT;

/// Returns the integral over wavelength of the product of two functions, each linear between its 1
/// nm samples.
double integral_of_product(const SpectrumSamples& a, const SpectrumSamples& b) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < count; ++i)
    sum += (2 * a[i] * b[i] + a[i] * b[i + 1] + a[i + 1] * b[i] + 2 * a[i + 1] * b[i + 1]) / 6;
  return sum;
}

std::array<SpectrumSamples, 3> make_observer() {
  std::array<SpectrumSamples, 3> observer;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c) observer[c][i] = cie_1931_observer[3 * i + c];
  SpectrumSamples one;
  one.fill(1);
  const double y = integral_of_product(observer[1], one);
  for (SpectrumSamples& samples : observer)
    for (double& value : samples) value /= y;
  return observer;
}

SpectrumSamples make_illuminant(const char* name) {
  const std::optional<Spectrum> spectrum = named_spectrum(name);
  SpectrumSamples samples = sample(*spectrum);
  const double y = xyz_of(samples).y;
  for (double& value : samples) value /= y;
  return samples;
}

/// Returns chromaticities of red, green and blue.
std::array<glm::dvec2, 3> primaries(ColorSpace space) {
  switch (space) {
    case ColorSpace::dci_p3:
      return {glm::dvec2(0.680, 0.320), glm::dvec2(0.265, 0.690), glm::dvec2(0.150, 0.060)};
    case ColorSpace::rec2020:
      return {glm::dvec2(0.708, 0.292), glm::dvec2(0.170, 0.797), glm::dvec2(0.131, 0.046)};
    case ColorSpace::aces2065_1:
      return {glm::dvec2(0.7347, 0.2653), glm::dvec2(0, 1), glm::dvec2(0.0001, -0.0770)};
    case ColorSpace::srgb:
      break;
  }
  return {glm::dvec2(0.64, 0.33), glm::dvec2(0.30, 0.60), glm::dvec2(0.15, 0.06)};
}

/// The columns are XYZ of red, green and blue, which sum up to the white of the tabulated
/// illuminant.
glm::dmat3 xyz_from_rgb_matrix(ColorSpace space) {
  glm::dmat3 columns;
  const std::array<glm::dvec2, 3> xy = primaries(space);
  for (int c = 0; c < 3; ++c) {
    const glm::dvec2 p = xy[static_cast<std::size_t>(c)];
    columns[c] = glm::dvec3(p.x, p.y, 1 - p.x - p.y);
  }
  const glm::dvec3 amounts = glm::inverse(columns) * xyz_of(illuminant(space));
  for (int c = 0; c < 3; ++c) columns[c] *= amounts[c];
  return columns;
}

std::array<double, 9> row_major(const glm::dmat3& m) {
  return {m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2]};
}

double planck(double nm, double kelvin) {
  constexpr double c2 = 1.438776877e7;  // nm K
  return std::pow(nm, -5) / std::expm1(c2 / (nm * kelvin));
}

double sampled_at(const SampledSpectrum& spectrum, double nm) {
  const auto& [wavelengths, values] = spectrum;
  if (wavelengths.empty()) return 0;
  if (nm <= wavelengths.front()) return values.front();
  if (nm >= wavelengths.back()) return values.back();
  const auto after = static_cast<std::size_t>(
      std::upper_bound(wavelengths.begin(), wavelengths.end(), nm) - wavelengths.begin());
  const double low = wavelengths[after - 1], high = wavelengths[after];
  return values[after - 1] + (nm - low) / (high - low) * (values[after] - values[after - 1]);
}

/// Returns XYZ, of luminance 1, of CIE daylight (CIE 15:2018, 4.1.2), whose temperatures use an
/// older constant of Planck's law.
glm::dvec3 daylight_white(double kelvin) {
  if (kelvin < 4000) {
    const glm::dvec3 xyz = xyz_of(sample(BlackbodySpectrum{kelvin}));
    return xyz / xyz.y;
  }
  const double t = 1e3 / (kelvin * 1.4388 / 1.438);
  const double x = kelvin * 1.4388 / 1.438 <= 7000
                       ? ((-4.607 * t + 2.9678) * t + 0.09911) * t + 0.244063
                       : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.23704;
  const double y = (-3 * x + 2.87) * x - 0.275;
  return {x / y, 1, (1 - x - y) / y};
}

}  // namespace

const std::array<SpectrumSamples, 3>& normalized_observer() {
  static const std::array<SpectrumSamples, 3> observer = make_observer();
  return observer;
}

SpectrumSamples sample(const Spectrum& spectrum) {
  SpectrumSamples samples;
  for (std::size_t i = 0; i < count; ++i)
    samples[i] = evaluate(spectrum, double{CAPLET_LAMBDA_MIN} + static_cast<double>(i));
  return samples;
}

glm::dvec3 xyz_of(const SpectrumSamples& samples) {
  const auto& observer = normalized_observer();
  return {integral_of_product(samples, observer[0]), integral_of_product(samples, observer[1]),
          integral_of_product(samples, observer[2])};
}

const SpectrumSamples& illuminant(ColorSpace space) {
  static const SpectrumSamples d65 = make_illuminant("stdillum-D65"),
                               d60 = make_illuminant("illum-acesD60");
  return space == ColorSpace::aces2065_1 ? d60 : d65;
}

double sigmoid_value(const std::array<double, 3>& coefficients, double nm) {
  const double x = (coefficients[0] * nm + coefficients[1]) * nm + coefficients[2];
  return 0.5 + 0.5 * x / std::sqrt(1 + x * x);
}

SpectrumSamples wavelength_density() {
  // This is the logarithm at nodes, linear between: found by a random search for the least summed
  // variance of linear RGB estimated from four wavelengths u + i/4, over emitters E, D65, A and
  // three saturated ones (docs/numerics.md).
  struct Node {
    double nm, logarithm;
  };
  constexpr double step = 390.0 / 21;
  constexpr std::array<double, 22> logarithms = {
      -4.66, -2.76, -1.06, -0.18, 0.00,  -0.19, -0.42, -0.46, -0.30, -0.22, -0.31,
      -0.24, -0.10, -0.22, -0.13, -0.48, -1.09, -1.67, -2.68, -3.60, -5.69, -5.86};
  std::vector<Node> nodes = {{360, logarithms.front() - 1}};
  for (std::size_t i = 0; i < logarithms.size(); ++i)
    nodes.push_back({370 + step * static_cast<double>(i), logarithms[i]});
  nodes.push_back({830, logarithms.back() - 2});
  SpectrumSamples density;
  std::size_t node = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double nm = double{CAPLET_LAMBDA_MIN} + static_cast<double>(i);
    while (node + 2 < nodes.size() && nodes[node + 1].nm < nm) ++node;
    const Node low = nodes[node], high = nodes[node + 1];
    density[i] = std::exp(low.logarithm +
                          (nm - low.nm) / (high.nm - low.nm) * (high.logarithm - low.logarithm));
  }
  return density;
}

std::array<double, 9> xyz_from_rgb(ColorSpace space) {
  return row_major(xyz_from_rgb_matrix(space));
}
std::array<double, 9> rgb_from_xyz(ColorSpace space) {
  return row_major(glm::inverse(xyz_from_rgb_matrix(space)));
}

std::array<double, 9> picture_from_xyz(const FilmSettings& film) {
  if (film.white_balance == 0) return rgb_from_xyz(film.space);
  const glm::dmat3 cones = glm::transpose(
      glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296));
  const glm::dvec3 white = xyz_of(illuminant(film.space));
  const glm::dvec3 gains =
      (cones * (white / white.y)) / (cones * daylight_white(film.white_balance));
  glm::dmat3 balance(0);
  for (int c = 0; c < 3; ++c) balance[c][c] = gains[c];
  return row_major(glm::inverse(xyz_from_rgb_matrix(film.space)) * glm::inverse(cones) * balance *
                   cones);
}

bool is_constant(const Spectrum& spectrum) {
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum))
    return rgb->rgb.r == rgb->rgb.g && rgb->rgb.g == rgb->rgb.b;
  if (const auto* sampled = std::get_if<SampledSpectrum>(&spectrum))
    return std::all_of(sampled->values.begin(), sampled->values.end(),
                       [sampled](double v) { return v == sampled->values.front(); });
  return std::holds_alternative<ConstantSpectrum>(spectrum);
}

double evaluate(const Spectrum& spectrum, double nm) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum)) return constant->value;
  if (const auto* sampled = std::get_if<SampledSpectrum>(&spectrum))
    return sampled_at(*sampled, nm);
  const auto* blackbody = std::get_if<BlackbodySpectrum>(&spectrum);
  CHECK_EQ_(blackbody != nullptr, true);  // RGB has no wavelengths before its use is known
  constexpr double wien =
      2.897771955e6;  // nm K: the wavelength of the maximum times the temperature
  return planck(nm, blackbody->kelvin) / planck(wien / blackbody->kelvin, blackbody->kelvin);
}

}  // namespace caplet
