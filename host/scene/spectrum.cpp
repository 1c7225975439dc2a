// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The named spectra: pbrt-v4's, and additions under names of their own (docs/materials.md lists
// them with their sources).
#include "scene/spectrum.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include "scene/detail/spectrum_tables.h"

namespace caplet {

namespace {

constexpr int first_nm = 360, last_nm = 830;

/// Samples an index of refraction `n_squared(micrometres^2)` at 1 nm; constant outside the fitted
/// range [low, high] nm.
SampledSpectrum dispersion(const std::function<double(double)>& n_squared, double low = first_nm,
                           double high = last_nm) {
  SampledSpectrum out;
  for (int nm = first_nm; nm <= last_nm; ++nm) {
    const double micrometres = std::fmin(std::fmax(nm, low), high) * 1e-3;
    out.wavelengths.push_back(nm);
    out.values.push_back(std::sqrt(n_squared(micrometres * micrometres)));
  }
  return out;
}

/// Sellmeier's equation n^2 - 1 = sum B l^2 / (l^2 - C), l in micrometres; `terms` alternates B and
/// C.
SampledSpectrum sellmeier(const std::vector<double>& terms) {
  return dispersion([&terms](double l2) {
    double n2 = 1;
    for (std::size_t i = 0; i + 1 < terms.size(); i += 2) n2 += terms[i] * l2 / (l2 - terms[i + 1]);
    return n2;
  });
}

/// Takes column `index` from rows of `width` numbers that begin with the wavelength.
SampledSpectrum column(std::span<const double> rows, std::size_t width, std::size_t index) {
  SampledSpectrum out;
  for (std::size_t i = 0; i + width <= rows.size(); i += width) {
    out.wavelengths.push_back(rows[i]);
    out.values.push_back(rows[i + index]);
  }
  return out;
}

/// Names the authors of the measurements in metal_tables.
std::string source_of(const std::string& metal) {
  if (metal == "Al") return "Rakic";
  if (metal == "CuZn") return "Querry";
  return metal == "Pt" || metal == "W" ? "Werner" : "Johnson";
}

std::map<std::string, Spectrum> make_all() {
  std::map<std::string, Spectrum> all;
  for (const IlluminantTable& table : illuminant_tables()) {
    SampledSpectrum spectrum;
    for (std::size_t i = 0; i < table.values.size(); ++i)
      spectrum.wavelengths.push_back(table.first + 5.0 * static_cast<double>(i));
    spectrum.values.assign(table.values.begin(), table.values.end());
    all[table.name] = spectrum;
  }
  for (const MetalTable& table : metal_tables())
    // Each metal also has its short name; pbrt's tables, added below, replace those that pbrt
    // defines.
    for (const std::string& name : {std::string("metal-") + table.name,
                                    "metal-" + (table.name + ("-" + source_of(table.name)))}) {
      all[name + "-eta"] = column(table.rows, 3, 1);
      all[name + "-k"] = column(table.rows, 3, 2);
    }
  // pbrt counts these two oxides as metals. Stephens and Malitson 1952; DeVore 1951 (rutile,
  // ordinary ray). Both are clear: k = 0.
  all["metal-MgO-Stephens-eta"] =
      dispersion([](double l2) { return 2.957019 + 0.0216485 / (l2 - 0.0158650) - 0.0101373 * l2; },
                 404.7, 767.9);
  all["metal-TiO2-DeVore-eta"] =
      dispersion([](double l2) { return 5.913 + 0.2441 / (l2 - 0.0803); }, 430, 1530);
  all["metal-MgO-Stephens-k"] = all["metal-TiO2-DeVore-k"] = ConstantSpectrum{0};

  // Schott's catalogue. pbrt names the three SF glasses F5, F10, F11.
  const std::pair<const char*, std::vector<double>> schott[] = {
      {"BK7", {1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653}},
      {"BAF10", {1.5851495, 0.00926681282, 0.143559385, 0.0424489805, 1.08521269, 105.613573}},
      {"FK51A", {0.971247817, 0.00472301995, 0.216901417, 0.0153575612, 0.904651666, 168.68133}},
      {"LASF9", {2.00029547, 0.0121426017, 0.298926886, 0.0538736236, 1.80691843, 156.530829}},
      {"SF5", {1.46141885, 0.0111826126, 0.247713019, 0.0508594669, 0.949995832, 112.041888}},
      {"SF10", {1.61625977, 0.0127534559, 0.259229334, 0.0581983954, 1.07762317, 116.60768}},
      {"SF11", {1.73848403, 0.0136068604, 0.311168974, 0.0615960463, 1.17490871, 121.922711}}};
  for (const auto& [glass, terms] : schott)
    for (const char* source : {"", "-Schott"})
      all[std::string("glass-") + glass + source] = sellmeier(terms);

  // Malitson 1965; Malitson and Dodge 1972 (ordinary ray); Peter 1923; Daimon and Masumura 2007 (20
  // degrees Celsius).
  all["fused-silica"] = sellmeier({0.6961663, 0.0684043 * 0.0684043, 0.4079426,
                                   0.1162414 * 0.1162414, 0.8974794, 9.896161 * 9.896161});
  all["sapphire"] = sellmeier({1.4313493, 0.0726631 * 0.0726631, 0.65054713, 0.1193242 * 0.1193242,
                               5.3414021, 18.028251 * 18.028251});
  all["glass-diamond"] = sellmeier({0.3306, 0.1750 * 0.1750, 4.3356, 0.1060 * 0.1060});
  all["water"] = sellmeier({5.684027565e-1, 5.101829712e-3, 1.726177391e-1, 1.821153936e-2,
                            2.086189578e-2, 2.620722293e-2, 1.130748688e-1, 1.069792721e1});

  // pbrt's tables take precedence over all others of the same name.
  for (const NamedTable& table : pbrt_tables()) all[table.name] = column(table.rows, 2, 1);
  return all;
}

const std::map<std::string, Spectrum>& all_spectra() {
  static const std::map<std::string, Spectrum> all = make_all();
  return all;
}

}  // namespace

std::optional<Spectrum> named_spectrum(const std::string& name) {
  const auto found = all_spectra().find(name);
  if (found == all_spectra().end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> named_spectrum_names() {
  std::vector<std::string> names;
  for (const auto& [name, spectrum] : all_spectra()) names.push_back(name);
  return names;
}

}  // namespace caplet
