// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/media.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <string>

#include "base/check.h"
#include "lower/detail/family_data.h"
#include "lower/detail/media_grids.h"
#include "lower/detail/sparse_grid.h"

namespace caplet {

namespace {

template <class Model>
constexpr std::uint32_t medium_kinds = medium_count;
#define MEDIUM_MODEL(name, Type) \
  template <>                    \
  constexpr std::uint32_t medium_kinds<Type> = medium_##name;
#include "scene/media.def"

// Every row of media.def has its model.
#define MEDIUM_MODEL(name, Type) +1
static_assert(0
#include "scene/media.def"
              == medium_count);

/// Writes the fields that scene/media.def visits.
struct MediumWriter {
  FamilyData& data;
  std::span<const FamilyField> fields;
  SpectrumTable& spectra;
  FlatScene& out;

  template <class Preset>
  void scattering(const ScatteringProperties& of, Preset&&) {
    data.put_index("sigma_a", spectra.add_unbounded(of.sigma_a));
    data.put_index("sigma_s", spectra.add_unbounded(of.sigma_s));
    data.put("scale", of.scale);
    data.put("g", of.g);
  }
  void emission(const Field& field, const std::optional<Spectrum>& radiance, double scale) {
    emission(field, radiance);
    data.put("le_scale", radiance ? scale : 0);
  }
  void emission(const Field&, const std::optional<Spectrum>& radiance) {
    data.put_index("le", radiance ? spectra.add_illuminant(*radiance) : spectra.add_number(0));
  }
  void number(const Field& given, double value) {
    const char* const name = given.name;
    // pbrt-v4's colours that are no lights' are scaled by the illuminant's own magnitude.
    if (name == std::string_view("Lescale"))
      data.put("le_scale", value * illuminant_magnitude);
    else
      data.put(name, value);
  }
  void asymmetry(double g) { data.put("g", g); }
  void bounds(const MediumBounds& of) {
    const glm::dvec3 sides = of.p1 - of.p0;
    const glm::dmat4 m = glm::scale(glm::dmat4(1), 1.0 / sides) *
                         glm::translate(glm::dmat4(1), -of.p0) * glm::inverse(of.world_from_medium);
    std::array<float, 12> rows;
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        rows[static_cast<std::size_t>(4 * r + c)] = static_cast<float>(m[c][r]);
    data.put_floats("place", rows);
    if (!has("low")) return;
    data.put("low", of.p0);
    data.put("sides", sides);
  }
  void counts(const GridCounts& of) {
    data.put_index("nx", narrow<uint>(of[0]));
    data.put_index("ny", narrow<uint>(of[1]));
    data.put_index("nz", narrow<uint>(of[2]));
  }
  void grid(const Field& given, const FloatGrid& of, const GridCounts&, bool) {
    std::string field = given.name;
    std::ranges::transform(field, field.begin(), [](char c) {
      return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    data.put_index(field, of ? add(*of) : CAPLET_NONE);
  }
  void grid(const Field& field, const ColorGrid& of, const GridCounts&) {
    const char* const name = field.name;
    const bool emits = name == std::string_view("Le");
    if (emits) data.put_index("illuminant", spectra.illuminant_table(of.space));
    data.put_index(emits ? "le" : name, of.rgb ? add(grid_spectra(of)) : CAPLET_NONE);
  }
  void heat(const std::optional<Spectrum>& radiance, const FloatGrid& temperature) {
    data.put("le_scale", temperature ? illuminant_magnitude : radiance ? 1 : 0);
  }
  void volume(const SparseGridPointer& density, const SparseGridPointer& temperature,
              const glm::dmat4& world_from_medium) {
    bounds({density->box.min, density->box.max, world_from_medium});
    data.put_index("density", add(sparse_floats(*density, world_from_medium)));
    data.put_index("temperature",
                   temperature ? add(sparse_floats(*temperature, world_from_medium)) : CAPLET_NONE);
  }
  void any_of(const ColorGrid&, const ColorGrid&, const ColorGrid&) {}

  /// Adds values to media_grids, aligned to four, and returns where they begin.
  uint add(const std::vector<float>& values) {
    out.media_grids.resize((out.media_grids.size() + 3) / 4 * 4);
    const auto begin = narrow<uint>(out.media_grids.size());
    out.media_grids.insert(out.media_grids.end(), values.begin(), values.end());
    return begin;
  }
  bool has(std::string_view field) const {
    return std::ranges::any_of(fields, [&](const FamilyField& one) { return one.name == field; });
  }
  /// This is the integral of the CIE's y in nm, by which pbrt-v4 divides spectra of luminance 1.
  static constexpr double illuminant_magnitude = 106.856895;
};

template <class Model>
void put_majorants(const Model& model, FamilyData& data, FlatScene& out) {
  if constexpr (requires { medium_majorants(model); }) {
    const std::vector<float> majorants = medium_majorants(model);
    data.put_index("majorants", narrow<uint>(out.media_grids.size()));
    out.media_grids.insert(out.media_grids.end(), majorants.begin(), majorants.end());
  }
}

}  // namespace

void lower_media(const Scene& scene, SpectrumTable& spectra, FlatScene& out) {
  for (const Medium& medium : scene.media)
    std::visit(
        [&](const auto& model) {
          MediumRecord record{};
          record.kind = medium_kinds<std::decay_t<decltype(model)>>;
          record.data = narrow<uint>(out.media_data.size());
          record.flags = medium.subsurface ? CAPLET_MEDIUM_SUBSURFACE : 0u;
          out.media_data.resize(out.media_data.size() + medium_floats[record.kind]);
          FamilyData data(medium_fields[record.kind], &out.media_data[record.data]);
          model.fields(model, MediumWriter{data, medium_fields[record.kind], spectra, out});
          put_majorants(model, data, out);
          data.finish();
          out.mediums.push_back(record);
        },
        medium.model);
}

}  // namespace caplet
