// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/materials.h"

#include <algorithm>

#include "base/check.h"
#include "lower/detail/family_data.h"

namespace caplet {

namespace {

static_assert(std::ranges::all_of(material_floats, [](std::uint32_t floats) { return floats <= material_stride; }),
              "material_stride is too small");

template <class Model>
constexpr std::uint32_t kind_of = material_count;
#define MATERIAL_MODEL(name, Type) \
  template <>                      \
  constexpr std::uint32_t kind_of<Type> = material_##name;
#include "scene/materials.def"

// Every row of materials.def has its model.
#define MATERIAL_MODEL(name, Type) +1
static_assert(0
#include "scene/materials.def"
              == material_count);

/// Writes what scene/materials.def visits.
struct MaterialWriter {
  FamilyData& data;
  SpectrumTable& spectra;
  MaterialRecord& record;

  void albedo(const char* name, const Spectrum& value) { data.put_index(name, spectra.add_reflectance(value)); }
  void unbounded(const char* name, const Spectrum& value) { data.put_index(name, spectra.add_unbounded(value)); }
  void index(const char* name, const Spectrum& value) {
    unbounded(name, value);
    if ((material_traits[record.kind] & trait_dispersive) != 0 && !is_constant(value)) record.flags |= CAPLET_MATERIAL_DISPERSIVE;
  }
  void number(const char* name, double value, double, double) { data.put(name, value); }
  void roughness(double alpha_u, double alpha_v) {
    data.put("alpha_u", alpha_u);
    data.put("alpha_v", alpha_v);
  }
  void metal(const Spectrum& eta, const Spectrum& k, const std::optional<Spectrum>& reflectance) {
    unbounded("eta", reflectance ? ConstantSpectrum{1} : eta);
    data.put_index("k", reflectance ? spectra.add_extinction(*reflectance) : spectra.add_unbounded(k));
  }
};

}  // namespace

MaterialRecord lower_material(const Material& material, std::uint32_t index, SpectrumTable& spectra, FlatScene& out) {
  MaterialRecord record{};
  record.data = index * material_stride;
  if (out.material_data.size() < record.data + material_stride) out.material_data.resize(record.data + material_stride);
  std::visit(
      [&](const auto& model) {
        record.kind = kind_of<std::decay_t<decltype(model)>>;
        FamilyData data(material_fields[record.kind], &out.material_data[record.data]);
        model.fields(model, MaterialWriter{data, spectra, record});
        data.finish();
      },
      material.model);
  return record;
}

}  // namespace caplet
