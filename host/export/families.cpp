// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "export/detail/families.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "scene/field.h"
#include "scene/transform.h"

namespace caplet::pbrt_text {

namespace {

void transform(Statement& to, const glm::dmat4& matrix) {
  if (!has_inverse(matrix) || !is_affine(matrix))
    refuse(to.where(), "the transform has no inverse");
  if (matrix != glm::dmat4(1)) to.within("Transform " + matrix_text(matrix) + "\n");
}

std::string encoding_name(const ImageEncoding& encoding) {
  if (encoding.kind == ImageEncoding::Kind::linear) return "linear";
  return encoding.kind == ImageEncoding::Kind::srgb ? "sRGB"
                                                    : "gamma " + number_text(encoding.gamma);
}

/// Writes the fields of scene/textures.def.
struct TextureWriter : IgnoresFields {
  TextureWriter(Statement& statement, const Names& all, const Stream& out, bool of_floats)
      : to(statement), names(all), stream(out), is_float(of_floats) {}
  Statement& to;
  const Names& names;
  const Stream& stream;
  bool is_float;
  std::optional<glm::dmat4> texture_from_world = {};
  bool is_turned = false;  // it has directions, which are in world space

  void operand(const Field& field, const TextureOperand& of) {
    if (of.texture)
      to.texture(field.name, names.textures[*of.texture]);
    else
      to.spectrum(field.name, of.value);
  }
  void factor(const Field& field, const TextureOperand& of) { operand(field, of); }
  void number(const Field& field, double value) { to.number(field.name, value); }
  void integer(const Field& field, int value) { to.whole(field.name, value); }
  void vector(const Field& field, const glm::dvec3& value) { to.vector(field.name, value); }
  template <class Options>
  void choice(const Field& field, int value, const Options& options) {
    to.text(field.name, options[static_cast<std::size_t>(value)]);
  }
  void flag(const Field& field, bool value) { to.boolean(field.name, value); }
  void image(const Field& field, const std::shared_ptr<const TextureImage>& of) {
    if (!of) refuse(to.where(), "the texture has no image");
    to.image(field.name, *of, "the texture's image", stream);
    to.text("encoding", encoding_name(of->encoding));
  }
  void mapping(const TextureMapping& of) {
    choice(TextureMapping::kind_field, static_cast<int>(of.kind), texture_mapping_names);
    if (of.kind != TextureMapping::Kind::uv) place(of.texture_from_world);
    TextureMapping::fields(of, *this);
  }
  void board(const TextureMapping& of) {
    if (of.kind != TextureMapping::Kind::solid) return mapping(of);
    to.whole(TextureMapping::dimension_field.name, 3);
    place(of.texture_from_world);
  }
  void place(const glm::dmat4& inverse) {
    if ((texture_from_world && *texture_from_world != inverse) || is_turned)
      refuse(to.where(), "the texture has two places");
    texture_from_world = inverse;
  }
  void direction(const Field& field, const glm::dvec3& value) {
    if (texture_from_world) refuse(to.where(), "the texture has two places");
    if (!is_unit(glm::length(value)))
      refuse(to.where(), "the texture's direction is not of unit length");
    is_turned = true;
    to.vector(field.name, value);
  }
};

/// Writes the fields of scene/materials.def.
struct MaterialWriter : CompositesInParts<MaterialWriter> {
  MaterialWriter(Statement& statement, const Material& of, const Names& all)
      : to(statement), material(of), names(all) {}
  Statement& to;
  const Material& material;
  const Names& names;
  bool said_remap = false;

  void albedo(const Field& field, const Spectrum& value) { spectrum(field, value); }
  void unbounded(const Field& field, const Spectrum& value) { spectrum(field, value); }
  void index(const Field& field, const Spectrum& value) { to.spectrum(field.name, value); }
  void number(const Field& field, double value) {
    if (!textured(field.name, field.name)) to.number(field.name, value);
  }
  void integer(const Field& field, int value) { to.whole(field.name, value); }
  /// pbrt does not know these flags, so they are written only when they are true.
  void flag(const Field& field, bool value) {
    if (value) to.boolean(field.name, true);
  }
  void parts(const Field& field, const std::array<std::uint32_t, 2>& of) {
    to.texts(field.name, {names.materials[of[0]], names.materials[of[1]]});
  }
  void roughness(const RoughnessFields& fields, double alpha_u, double alpha_v) {
    if (!said_remap) to.boolean("remaproughness", false);
    said_remap = true;
    if (!textured(fields.uroughness, fields.alpha_u.name)) to.number(fields.uroughness, alpha_u);
    if (!textured(fields.vroughness, fields.alpha_v.name)) to.number(fields.vroughness, alpha_v);
  }

 private:
  void spectrum(const Field& field, const Spectrum& value) {
    if (!textured(field.name, field.name)) to.spectrum(field.name, value);
  }
  bool textured(const std::string& name, const std::string& field) {
    const auto texture = texture_of(material, field);
    if (texture) to.texture(name, names.textures[*texture]);
    return texture.has_value();
  }
};

/// Writes the fields of scene/media.def.
struct MediumWriter {
  Statement& to;
  const Stream& stream;

  template <class Preset>
  void scattering(const ScatteringProperties& of, Preset&&) {
    ScatteringProperties::fields(of, *this);
  }
  void unbounded(const Field& field, const Spectrum& value) { to.spectrum(field.name, value); }
  void asymmetry(double g) { number(asymmetry_field, g); }
  void emission(const Field& field, const std::optional<Spectrum>& radiance) {
    if (radiance) to.spectrum(field.name, *radiance);
  }
  void emission(const Field& field, const std::optional<Spectrum>& radiance, double scale) {
    emission(field, radiance);
    number(radiance_scale_field, scale);
  }
  void bounds(const MediumBounds& of) {
    transform(to, of.world_from_medium);
    to.point("p0", of.p0);
    to.point("p1", of.p1);
  }
  void counts(const GridCounts& of) {
    for (std::size_t k = 0; k < 3; ++k) to.whole(grid_count_names[k], of[k]);
  }
  void grid(const Field& field, const FloatGrid& of, const GridCounts&, bool) {
    list("float", field.name, of, {});
  }
  void grid(const Field& field, const ColorGrid& of, const GridCounts&) {
    list("rgb", field.name, of.rgb, of.space);
  }
  void number(const Field& field, double value) { to.number(field.name, value); }
  void volume(const SparseGridPointer& density, const SparseGridPointer& temperature,
              const glm::dmat4& world_from_medium) {
    if (temperature && temperature->file != density->file)
      refuse(to.where(), "the medium's density and temperature are of different files");
    transform(to, world_from_medium);
    to.file("filename", density->file, "the medium's grid", stream);
  }
  void heat(const std::optional<Spectrum>&, const FloatGrid&) {}
  void any_of(const ColorGrid&, const ColorGrid&, const ColorGrid&) {}

 private:
  void list(const char* type, const char* name, const FloatGrid& of,
            std::optional<ColorSpace> space) {
    if (of)
      to.list(
          type, name, of->size(), [of](Text& text, std::size_t i) { text << (*of)[i]; }, space);
  }
};

/// Writes the fields of scene/lights.def. The light's space is around its position.
struct LightWriter {
  Statement& to;
  const Stream& stream;
  glm::dvec3 position_ = glm::dvec3(0);
  std::string position_name = {};
  bool is_placed = false;

  void emission(const Field& field, const Spectrum& value) { to.spectrum(field.name, value); }
  void position(const Field& field, const glm::dvec3& value) {
    position_ = value;
    position_name = field.name;
  }
  void direction(const Field&, const Field& towards, const glm::dvec3& value) {
    if (!is_unit(glm::length(value)))
      refuse(to.where(), "the light's direction is not of unit length");
    transform(to, glm::translate(glm::dmat4(1), position_));
    is_placed = true;
    to.point(towards.name, value);
  }
  void number(const Field& field, double value) { to.number(field.name, value); }
  void place(const glm::dvec3& at, const glm::dmat3& turn) {
    if (!is_unit(glm::length(turn[0])))
      refuse(to.where(), "the light's rotation is not of unit length");
    glm::dmat4 matrix(turn);
    matrix[3] = glm::dvec4(at, 1);
    transform(to, matrix);
    is_placed = true;
  }
  void image(const Field& field, const std::shared_ptr<const EnvironmentImage>& of) {
    to.image(field.name, *of, "the light's image", stream);
  }
  void directions(const Field& field, const std::shared_ptr<const EnvironmentImage>& of) {
    image(field, of);
  }
  void profile(const Field& field, const std::shared_ptr<const IesProfile>& of) {
    to.file(field.name, of->file, "the light's profile", stream);
  }
  void cone(double total_angle, double falloff_start_angle) {
    const double cone = degrees_of(total_angle);
    to.number(SpotLight::cone_field.name, cone);
    to.number(SpotLight::delta_field.name,
              degrees_below(cone, std::min(falloff_start_angle, total_angle)));
  }
  void sky(const InfiniteLight& light) {
    if (light.image) {
      place(glm::dvec3(0), light.world_from_light);
      if (light.image->preset.empty())
        image(InfiniteLight::image_field, light.image);
      else
        to.text(InfiniteLight::preset_field.name, light.image->preset);
    } else {
      emission(InfiniteLight::radiance_field, light.radiance);
    }
    if (!light.portal) return;
    const LightPortal& p = *light.portal;
    to.numbers("point3", InfiniteLight::portal_field.name,
               {p[0].x, p[0].y, p[0].z, p[1].x, p[1].y, p[1].z, p[2].x, p[2].y, p[2].z, p[3].x,
                p[3].y, p[3].z});
  }
  void finish() {
    if (!position_name.empty() && !is_placed) to.point(position_name, position_);
  }
};

/// Importers fold textures of constants into a constant, which would remove the texture.
bool is_constant(const ScaleTexture& of) { return !of.tex.texture && !of.scale.texture; }
bool is_constant(const MixTexture& of) {
  return !of.tex1.texture && !of.tex2.texture && !of.amount.texture;
}
template <class Model>
bool is_constant(const Model&) {
  return false;
}

}  // namespace

std::optional<Statement> texture_statement(const Scene& scene, std::uint32_t texture,
                                           const Names& names, const Stream& stream) {
  const auto& [model, is_float, name, where] = scene.textures[texture];
  static constexpr const char* classes[] = {
#define TEXTURE_MODEL(row, Type) #row,
#define OWN_TEXTURE_MODEL(row, Type) nullptr,
#include "scene/textures.def"
  };
  const char* const texture_class = classes[model.index()];
  if (!texture_class) return std::nullopt;
  if (std::visit([](const auto& m) { return is_constant(m); }, model))
    refuse(where, "the texture is made of constants alone");
  Statement out("Texture " + quoted(names.textures[texture], where) +
                    (is_float ? " \"float\" \"" : " \"spectrum\" \"") + texture_class + "\"",
                "texture", where);
  TextureWriter writer(out, names, stream, is_float);
  std::visit([&](const auto& m) { m.fields(m, writer); }, model);
  if (writer.texture_from_world && *writer.texture_from_world != glm::dmat4(1))
    out.within(inverse_text(*writer.texture_from_world));
  return out;
}

Statement material_statement(const Scene& scene, std::uint32_t material, const Names& names,
                             const Stream& stream) {
  const auto& [model, name, where, textures, displacement, normalmap] = scene.materials[material];
  static constexpr const char* types[] = {
#define MATERIAL_MODEL(row, Type) #row,
#include "scene/materials.def"
  };
  Statement out("MakeNamedMaterial " + quoted(names.materials[material], where), "material", where);
  out.text("type", types[model.index()]);
  MaterialWriter writer(out, scene.materials[material], names);
  std::visit([&](const auto& m) { m.fields(m, writer); }, model);
  if (displacement) out.texture("displacement", names.textures[*displacement]);
  if (normalmap)
    out.image("normalmap", *std::get<NormalmapTexture>(scene.textures[*normalmap].model).image,
              "the material's normal map", stream);
  return out;
}

Statement medium_statement(const Medium& medium, const std::string& name, const Stream& stream) {
  const auto& [model, own_name, where, subsurface] = medium;
  static constexpr const char* types[] = {
#define MEDIUM_MODEL(row, Type) #row,
#include "scene/media.def"
  };
  Statement out("MakeNamedMedium " + quoted(name, where), "medium", where);
  out.text("type", types[model.index()]);
  std::visit([&](const auto& m) { m.fields(m, MediumWriter{out, stream}); }, model);
  if (subsurface) out.boolean("subsurface", true);
  return out;
}

Statement light_statement(const Light& light, const Stream& stream) {
  const auto& [model, scale, power, illuminance, where] = light;
  static constexpr const char* types[] = {
#define LIGHT_MODEL(row, Type) #row,
#include "scene/lights.def"
  };
  Statement out(std::string("LightSource \"") + types[model.index()] + "\"", "light", where);
  LightWriter writer{out, stream};
  std::visit([&](const auto& m) { m.fields(m, writer); }, model);
  writer.finish();
  if (scale != 1) out.number("scale", scale);
  const LightUnit unit = std::visit([](const auto& m) { return m.unit; }, model);
  if ((power && (unit != LightUnit::power || !(*power > 0))) ||
      (illuminance && (unit != LightUnit::illuminance || !(*illuminance > 0))))
    refuse(
        where,
        "the light has a power or an illuminance that its kind has not, or that is not positive");
  if (power) out.number("power", *power);
  if (illuminance) out.number("illuminance", *illuminance);
  return out;
}

Statement area_statement(const AreaEmission& emission, const SourceLocation& where,
                         const Stream& stream) {
  const auto& [radiance, image, scale, power, two_sided, surfaces] = emission;
  Statement out("AreaLightSource \"diffuse\"", "light", where);
  if (image)
    out.image("filename", *image, "the area light's image", stream);
  else
    out.spectrum("L", radiance);
  if (scale != 1) out.number("scale", scale);
  if (power && !(*power > 0)) refuse(where, "the area light has a power that is not positive");
  if (power) out.number("power", *power);
  if (two_sided) out.boolean("twosided", true);
  out.list("integer", "surfaces", surfaces.size(),
           [&numbers = emission.surfaces](Text& text, std::size_t i) {
             text << std::int64_t{numbers[i]};
           });
  return out;
}

}  // namespace caplet::pbrt_text
