// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/materials.h"

#include <algorithm>

#include "base/check.h"
#include "lower/detail/family_data.h"
#include "lower/detail/textures.h"
#include "scene/field.h"
#include "scene/matte_names.h"

namespace caplet {

namespace {

static_assert(std::ranges::all_of(material_floats,
                                  [](std::uint32_t floats) { return floats <= material_stride; }),
              "material_stride is too small");

template <class Model>
constexpr std::uint32_t material_kinds = material_count;
#define MATERIAL_MODEL(name, Type) \
  template <>                      \
  constexpr std::uint32_t material_kinds<Type> = material_##name;
#include "scene/materials.def"

// Every row of materials.def has its model.
#define MATERIAL_MODEL(name, Type) +1
static_assert(0
#include "scene/materials.def"
              == material_count);

static_assert(material_stride <= 32, "MaterialRecord.textured has a bit for each float");

/// Writes the fields that scene/materials.def visits.
struct MaterialWriter : CompositesInParts<MaterialWriter> {
  FamilyData& data;
  SpectrumTable& spectra;
  MaterialRecord& record;
  const Scene& scene;
  const Material& material;
  const ImageNumbers& images;
  FlatScene& out;

  /// Names of fields have underscores for the dots of parameters.
  static std::string field_of(std::string name) {
    std::ranges::replace(name, '.', '_');
    return name;
  }
  /// If the scene's `parameter` is a texture, makes the field of `name` one, with a last step of
  /// this kind if there is one, and returns true.
  bool textured(const std::string& parameter, const std::string& name, TextureUse use,
                std::optional<uint> last = {}) {
    const auto texture = texture_of(material, parameter);
    if (!texture) return false;
    for (const FamilyField& field : material_fields[record.kind])
      if (field.name == field_of(name)) record.textured |= 1u << field.at;
    data.put_index(field_of(name), lower_texture(scene, *texture, use, last, images, spectra, out));
    return true;
  }
  bool textured(const std::string& name, TextureUse use) { return textured(name, name, use); }

  void albedo(const Field& field, const Spectrum& value) {
    if (!textured(field.name, TextureUse::albedo))
      data.put_index(field_of(field.name), spectra.add_reflectance(value));
  }
  void unbounded(const Field& field, const Spectrum& value) {
    if (!textured(field.name, TextureUse::unbounded))
      data.put_index(field_of(field.name), spectra.add_unbounded(value));
  }
  void index(const Field& field, const Spectrum& value) {
    data.put_index(field_of(field.name), spectra.add_unbounded(value));
    if ((material_traits[record.kind] & trait_dispersive) != 0 && !is_constant(value))
      record.flags |= CAPLET_MATERIAL_DISPERSIVE;
  }
  void number(const Field& field, double value) {
    if (!textured(field.name, TextureUse::number)) data.put(field_of(field.name), value);
  }
  void integer(const Field& field, int value) { data.put(field.name, value); }
  /// There is only one flag, so its name is not needed.
  void flag(const Field&, bool on) {
    if (on) record.flags |= CAPLET_MATERIAL_MULTISCATTER;
  }
  void parts(const Field&, const std::array<std::uint32_t, 2>& materials) {
    data.put_index("first", materials[0]);
    data.put_index("second", materials[1]);
  }
  void pigment(const PigmentFields& fields, const Spectrum& sigma_a,
               const std::optional<Spectrum>& reflectance) {
    data.put("is_color", reflectance ? 1 : 0);
    if (reflectance ? textured(fields.reflectance.name, "pigment", TextureUse::albedo)
                    : textured(fields.sigma_a.name, "pigment", TextureUse::unbounded))
      return;
    data.put_index("pigment", reflectance ? spectra.add_reflectance(*reflectance)
                                          : spectra.add_unbounded(sigma_a));
  }
  void metal(const MetalFields& fields, const Spectrum& eta, const Spectrum& k,
             const std::optional<Spectrum>& reflectance) {
    unbounded(fields.eta, reflectance ? ConstantSpectrum{1} : eta);
    if (!reflectance)
      unbounded(fields.k, k);
    else if (!textured(fields.reflectance.name, fields.k.name, TextureUse::albedo,
                       texture_extinction))
      data.put_index(field_of(fields.k.name), spectra.add_extinction(*reflectance));
  }
};

}  // namespace

MaterialRecord lower_material(const Scene& scene, std::uint32_t index, const ImageNumbers& images,
                              SpectrumTable& spectra, FlatScene& out) {
  const Material& material = scene.materials[index];
  MaterialRecord record{};
  record.data = index * material_stride;
  record.name = matte_hash(matte_name(material, index));
  record.bump = CAPLET_NONE;
  if (const auto bump = material.normalmap ? material.normalmap : material.displacement) {
    const std::optional<uint> last =
        material.normalmap ? std::nullopt : std::optional<uint>(texture_displacement);
    record.bump = lower_texture(scene, *bump, TextureUse::number, last, images, spectra, out);
    record.bump_kind = last.value_or(texture_normalmap);
  }
  if (out.material_data.size() < record.data + material_stride)
    out.material_data.resize(record.data + material_stride);
  std::visit(
      [&](const auto& model) {
        record.kind = material_kinds<std::decay_t<decltype(model)>>;
        FamilyData data(material_fields[record.kind], &out.material_data[record.data]);
        model.fields(model,
                     MaterialWriter{{}, data, spectra, record, scene, material, images, out});
        data.finish();
      },
      material.model);
  return record;
}

}  // namespace caplet
