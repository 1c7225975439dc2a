// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Media of MakeNamedMedium statements.
#include "import/detail/pbrt/media.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "base/spelling.h"
#include "import/detail/nanovdb.h"
#include "import/detail/pbrt/fields.h"

namespace caplet::pbrt {

namespace {

/// Reads the fields of scene/media.def.
struct MediumReader : FieldReader {
  const glm::dmat4& world_from_medium;

  template <class Preset>
  void scattering(ScatteringProperties& of, Preset&& preset) {
    of = preset();
    const std::string name = parameters.text("preset", "");
    if (!name.empty()) {
      for (const char* given : {"sigma_a", "sigma_s"})
        if (parameters.has(given)) parameters.error(given, "cannot be combined with \"preset\"");
      if (const auto known = named_scattering(name))
        of = *known;
      else
        parameters.error("preset", "is " + in_quotes(name) + "; the nearest known name is \"" +
                                       nearest_name(name, named_scattering_names()) + "\"");
    } else {
      coefficient("sigma_a", of.sigma_a);
      coefficient("sigma_s", of.sigma_s);
    }
    of.scale = parameters.number("scale", of.scale);
    if (of.scale < 0) parameters.error("scale", "must not be negative");
    asymmetry(of.g);
  }
  void asymmetry(double& g) {
    g = parameters.number("g", g);
    if (!(g > -1 && g < 1)) parameters.error("g", "must lie between -1 and 1, and be neither");
    constexpr double most = ScatteringProperties::most_asymmetry;
    g = std::clamp(g, -most, most);
  }
  void emission(const Field& field, std::optional<Spectrum>& radiance, double& scale) {
    emission(field, radiance);
    scale = parameters.number("Lescale", scale);
    if (scale < 0) parameters.error("Lescale", "must not be negative");
  }
  void emission(const Field& field, std::optional<Spectrum>& radiance) {
    radiance = parameters.spectrum(field.name, SpectrumUse::illuminant);
  }
  void volume(SparseGridPointer& density, SparseGridPointer& temperature, glm::dmat4& place) {
    place = world_from_medium;
    if (!parameters.has("filename")) return parameters.error("\"string filename\" is missing");
    const std::string file = resolve_file(parameters.text("filename", ""),
                                          parameters.where("filename"), parameters.main_file());
    try {
      density = read_nanovdb(file, "density", parameters.where("filename"));
      temperature = read_nanovdb(file, "temperature", parameters.where("filename"));
      if (!density) parameters.error("filename", file + " has no grid \"density\"");
    } catch (const InputError& problem) {
      add_errors(problem, parameters.where("filename"), parameters.diagnostics());
    }
  }
  void number(Field field, double& value) {
    // pbrt-v4 accepts these older names.
    const std::string_view asked = field.name;
    const char* const older = asked == "temperatureoffset" ? "temperaturecutoff"
                              : asked == "Lescale"         ? "LeScale"
                                                           : field.name;
    if (older != field.name && !parameters.has(field.name) && parameters.has(older))
      field.name = older;
    FieldReader::number(field, value);
  }
  void bounds(MediumBounds& of) {
    const glm::dvec3 p0 = parameters.point("p0", of.p0), p1 = parameters.point("p1", of.p1);
    of = {glm::min(p0, p1), glm::max(p0, p1), world_from_medium};
    for (int k = 0; k < 3; ++k)
      if (of.p0[k] == of.p1[k])
        return parameters.error(parameters.has("p1") ? "p1" : "p0", "makes the medium's box flat");
  }
  void counts(GridCounts& of) {
    double cells = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      of[k] = parameters.integer(grid_count_names[k], of[k]);
      if (of[k] < 1) parameters.error(grid_count_names[k], "must be at least 1");
      of[k] = std::max(of[k], 1);
      cells *= of[k];
    }
    if (cells > static_cast<double>(most_grid_cells))
      parameters.error("the grid has more than 2^28 cells");
  }
  void grid(const Field& field, FloatGrid& of, const GridCounts& counts, bool is_needed) {
    const char* const name = field.name;
    const Parameter* given = parameters.values(name, {"float"});
    if (!given && is_needed && !parameters.has(name))
      parameters.error("\"float " + std::string(name) + "\" is missing");
    if (given) of = values(name, *given, counts, 1);
  }
  void grid(const Field& field, ColorGrid& of, const GridCounts& counts) {
    const Parameter* given = parameters.values(field.name, {"rgb"});
    if (given) of = {values(field.name, *given, counts, 3), given->space};
  }
  FloatGrid values(const char* name, const Parameter& given, const GridCounts& counts,
                   std::size_t each) {
    const auto expected = static_cast<double>(each) * counts[0] * counts[1] * counts[2];
    if (static_cast<double>(given.numbers.size()) != expected) {
      parameters.error(
          name,
          "has " + std::to_string(given.numbers.size() / each) + " values, but a grid of " +
              std::to_string(counts[0]) + " x " + std::to_string(counts[1]) + " x " +
              std::to_string(counts[2]) + " cells takes " +
              std::to_string(static_cast<long long>(expected) / static_cast<long long>(each)));
      return nullptr;
    }
    std::vector<float> out;
    out.reserve(given.numbers.size());
    for (const double value : given.numbers) {
      if (!(value >= 0 && std::isfinite(static_cast<float>(value)))) {
        parameters.error(name, "has values that are negative or not finite");
        return nullptr;
      }
      out.push_back(static_cast<float>(value));
    }
    return std::make_shared<const std::vector<float>>(std::move(out));
  }
  void heat(const std::optional<Spectrum>& radiance, const FloatGrid& temperature) {
    if (radiance && temperature) parameters.error("temperature", "cannot be combined with \"Le\"");
  }
  void any_of(const ColorGrid&, const ColorGrid&, const ColorGrid& radiance) {
    if (!parameters.has("sigma_a") && !parameters.has("sigma_s"))
      parameters.error("needs an \"rgb sigma_a\" or an \"rgb sigma_s\"");
    if (radiance.rgb && !parameters.has("sigma_a")) parameters.error("Le", "needs a \"sigma_a\"");
  }

  void coefficient(const char* name, Spectrum& value) {
    if (auto given = parameters.spectrum(name, SpectrumUse::unbounded)) value = *std::move(given);
  }
};

}  // namespace

Medium make_medium(const std::string& type, const std::string& name, Parameters& parameters,
                   const glm::dmat4& world_from_medium) {
  Medium medium;
  medium.name = name;
  medium.where = parameters.where();
#define MEDIUM_MODEL(row, Type)                                         \
  if (type == #row) {                                                   \
    Type model;                                                         \
    Type::fields(model, MediumReader{{parameters}, world_from_medium}); \
    medium.model = std::move(model);                                    \
  }
#include "scene/media.def"
  medium.subsurface = parameters.boolean("subsurface", false);
  parameters.finish();
  return medium;
}

}  // namespace caplet::pbrt
