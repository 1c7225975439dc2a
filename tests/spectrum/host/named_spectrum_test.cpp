// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The named spectra against the catalogues and tables they come from.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "lower/detail/spectrum_color.h"
#include "lower/spectrum.h"
#include "scene/spectrum.h"
#include "support/data.h"

namespace caplet {
namespace {

double value_at(const std::string& name, double nm) {
  const std::optional<Spectrum> spectrum = named_spectrum(name);
  if (!spectrum) throw std::runtime_error("no spectrum " + name);
  return evaluate(*spectrum, nm);
}

TEST(NamedSpectrum, KnowsEveryNameOfPbrt) {
  std::vector<std::string> names = {"glass-BK7",    "glass-BAF10",  "glass-FK51A",   "glass-LASF9",
                                    "glass-F5",     "glass-F10",    "glass-F11",     "stdillum-A",
                                    "stdillum-D50", "stdillum-D65", "illum-acesD60", "metal-Ag-eta",
                                    "metal-Al-eta", "metal-Au-eta", "metal-Cu-eta"};
  for (const char* metal : {"Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"})
    for (const char* part : {"-eta", "-k"}) names.push_back(std::string("metal-") + metal + part);
  for (int i = 1; i <= 12; ++i) names.push_back("stdillum-F" + std::to_string(i));
  for (const std::string& name : names) EXPECT_TRUE(named_spectrum(name).has_value()) << name;
  const std::vector<std::string> all = named_spectrum_names();
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_THAT(all, testing::IsSupersetOf(
                       {"metal-W-k", "water", "sapphire", "fused-silica", "glass-diamond"}));
  EXPECT_FALSE(named_spectrum("glass-bk7").has_value());
  EXPECT_FALSE(named_spectrum("").has_value());
}

TEST(NamedSpectrum, WavelengthsAscend) {
  for (const std::string& name : named_spectrum_names()) {
    const std::optional<Spectrum> spectrum = named_spectrum(name);
    const auto* sampled = std::get_if<SampledSpectrum>(&*spectrum);
    if (!sampled) continue;
    ASSERT_EQ(sampled->wavelengths.size(), sampled->values.size()) << name;
    EXPECT_TRUE(std::adjacent_find(sampled->wavelengths.begin(), sampled->wavelengths.end(),
                                   std::greater_equal<>()) == sampled->wavelengths.end())
        << name;
    for (const double value : sampled->values) EXPECT_GE(value, 0) << name;
  }
}

// Indices at the d line as the catalogues print them: to half a unit of the last digit, and 1e-6
// for the 1 nm steps (n'' < 1e-6 / nm^2).
TEST(NamedSpectrum, GlassesAtTheDLine) {
  const std::pair<const char*, double> catalogue[] = {
      {"glass-BK7-Schott", 1.5168},    {"glass-BAF10-Schott", 1.67003},
      {"glass-FK51A-Schott", 1.48656}, {"glass-LASF9-Schott", 1.85025},
      {"glass-SF5", 1.67271},          {"glass-SF10", 1.72828},
      {"glass-SF11", 1.78472},         {"glass-SF5-Schott", 1.67271},
      {"glass-SF11-Schott", 1.78472}};
  // SF5 and SF10 are printed as 1.67270 and 1.72825 in the later catalogue whose coefficients are
  // used: 3e-5 apart.
  for (const auto& [name, index] : catalogue)
    EXPECT_NEAR(value_at(name, 587.5618), index, 3.6e-5) << name;
  // pbrt's tables, linear over 21 nm: up to n'' 21^2 / 8 = 6e-5 above the curve for the flints.
  const std::pair<const char*, double> pbrt[] = {{"glass-BK7", 1.5168},    {"glass-BAF10", 1.67003},
                                                 {"glass-FK51A", 1.48656}, {"glass-LASF9", 1.85025},
                                                 {"glass-F5", 1.67271},    {"glass-F10", 1.72828},
                                                 {"glass-F11", 1.78472}};
  for (const auto& [name, index] : pbrt) EXPECT_NEAR(value_at(name, 587.5618), index, 1e-4) << name;
  EXPECT_NEAR(value_at("fused-silica", 587.5618), 1.45846, 6e-6);  // Malitson 1965
  EXPECT_NEAR(value_at("sapphire", 587.5618), 1.76823, 1e-4);      // ordinary ray
  EXPECT_NEAR(value_at("water", 589.3), 1.33336, 5e-5);  // Daimon and Masumura: 20 degrees
  EXPECT_NEAR(value_at("glass-diamond", 589.3), 2.4173, 5e-4);
  EXPECT_NEAR(value_at("metal-TiO2-DeVore-eta", 589.3), 2.613, 2e-3);  // rutile, ordinary
  EXPECT_NEAR(value_at("metal-MgO-Stephens-eta", 589.3), 1.7373,
              3e-4);  // Stephens and Malitson, 30 degrees
}

// In pbrt text its names mean its own tables, row for row.
TEST(NamedSpectrum, PbrtsNamesArePbrtsTables) {
  CAPLET_NEEDS_DATA();
  std::size_t tables = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::data_folder() / "ior" / "pbrt")) {
    if (entry.path().extension() != ".csv") continue;
    const std::string name = entry.path().stem().string();
    std::ifstream file(entry.path());
    std::string line;
    ASSERT_TRUE(std::getline(file, line) && line == "nm,value") << name;
    SampledSpectrum published;
    while (std::getline(file, line)) {
      const std::size_t comma = line.find(',');
      published.wavelengths.push_back(std::stod(line.substr(0, comma)));
      published.values.push_back(std::stod(line.substr(comma + 1)));
    }
    const std::optional<Spectrum> found = named_spectrum(name);
    ASSERT_TRUE(found && std::holds_alternative<SampledSpectrum>(*found)) << name;
    EXPECT_EQ(std::get<SampledSpectrum>(*found).wavelengths, published.wavelengths) << name;
    EXPECT_EQ(std::get<SampledSpectrum>(*found).values, published.values) << name;
    ++tables;
  }
  EXPECT_EQ(tables, 21u);
}

// Copper's n at 600 nm, by hand from the rows around it: pbrt-v4's 0.468 (590.400818 nm) and
// 0.35125 (604.800842), Johnson and Christy's 0.70 (582.1) and 0.30 (616.8).
TEST(NamedSpectrum, OtherTablesHaveNamesOfTheirOwn) {
  EXPECT_NEAR(value_at("metal-Cu-eta", 600), 0.39017, 1e-5);
  EXPECT_NEAR(value_at("metal-Cu-Johnson-eta", 600), 0.49366, 1e-5);
  for (const char* metal : {"Cr", "Fe", "Ni", "Ti"})
    EXPECT_EQ(value_at(std::string("metal-") + metal + "-Johnson-k", 500),
              value_at(std::string("metal-") + metal + "-k", 500));
  EXPECT_EQ(value_at("metal-W-Werner-eta", 500), value_at("metal-W-eta", 500));
}

TEST(NamedSpectrum, MetalsReflectAsTheirTables) {
  CAPLET_NEEDS_DATA();
  std::ifstream file(test::data_folder() / "reference/tables/metal_nk_samples.csv");
  ASSERT_TRUE(file);
  const std::vector<std::pair<std::string, std::string>> used = {
      {"Cu", "Johnson"}, {"Au", "Johnson"}, {"Ag", "Johnson"}, {"Al", "Rakic"}, {"Cr", "Johnson"},
      {"Fe", "Johnson"}, {"Ni", "Johnson"}, {"Ti", "Johnson"}, {"W", "Werner"}, {"Pt", "Werner"}};
  std::string line;
  int compared = 0;
  while (std::getline(file, line)) {
    if (line.starts_with("#") || line.starts_with("metal,")) continue;
    std::istringstream fields(line);
    std::string metal, table, field;
    double row[4];
    std::getline(fields, metal, ',');
    std::getline(fields, table, ',');
    for (double& number : row) {
      std::getline(fields, field, ',');
      number = std::stod(field);
    }
    if (std::find(used.begin(), used.end(), std::pair(metal, table)) == used.end()) continue;
    const double n = value_at("metal-" + metal + "-" + table + "-eta", 1000 * row[0]),
                 k = value_at("metal-" + metal + "-" + table + "-k", 1000 * row[0]);
    // Printed to five digits; interpolated in the wavelength there as here.
    EXPECT_NEAR(n, row[1], 6e-6) << line;
    EXPECT_NEAR(k, row[2], 6e-6) << line;
    EXPECT_NEAR(((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k), row[3], 6e-6) << line;
    ++compared;
  }
  EXPECT_EQ(compared, 30);
}

// Tristimulus values of the illuminants: ASTM E308-01 table 5 (1931 observer). Ours are summed at 1
// nm with the 5 nm tables joined linearly, theirs at 5 nm; lamps with lines differ most.
TEST(NamedSpectrum, WhitesOfTheIlluminants) {
  struct White {
    const char* name;
    double x, z, tolerance;
  };
  const White whites[] = {
      {"stdillum-D65", 0.95047, 1.08883, 1e-4}, {"stdillum-D50", 0.96422, 0.82521, 1e-4},
      {"stdillum-A", 1.09850, 0.35585, 1e-4},   {"stdillum-F2", 0.99186, 0.67393, 3e-3},
      {"stdillum-F7", 0.95041, 1.08747, 3e-3},  {"stdillum-F11", 1.00962, 0.64350, 3e-3}};
  for (const White& white : whites) {
    const std::optional<Spectrum> spectrum = named_spectrum(white.name);
    const glm::dvec3 xyz = xyz_of(sample(*spectrum));
    EXPECT_NEAR(xyz.x / xyz.y, white.x, white.tolerance) << white.name;
    EXPECT_NEAR(xyz.z / xyz.y, white.z, white.tolerance) << white.name;
  }
  const std::optional<Spectrum> aces = named_spectrum("illum-acesD60");
  const glm::dvec3 xyz = xyz_of(sample(*aces));
  EXPECT_NEAR(xyz.x / (xyz.x + xyz.y + xyz.z), 0.32168, 3e-4);
  EXPECT_NEAR(xyz.y / (xyz.x + xyz.y + xyz.z), 0.33767, 3e-4);
}

}  // namespace
}  // namespace caplet
