// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "schema/schema.h"

#include <array>

#include "schema/detail/describe.h"
#include "schema/detail/rows.h"

namespace caplet::schema {

namespace {

struct Family {
  const char *name, *directive;
};
constexpr std::array family_rows = {
    Family{"material", "Material"},      Family{"texture", "Texture"},
    Family{"light", "LightSource"},      Family{"arealight", "AreaLightSource"},
    Family{"medium", "MakeNamedMedium"}, Family{"shape", "Shape"},
    Family{"camera", "Camera"},          Family{"film", "Film"},
    Family{"filter", "PixelFilter"},     Family{"sampler", "Sampler"},
    Family{"integrator", "Integrator"}};

constexpr std::array material_rows = {
    Row{{"displacement", "heights along the normal; only the normals follow them"}, "texture"},
    Row{{"normalmap", "an image of normals in tangent space; not together with displacement"},
        "string"}};

constexpr std::array subsurface_rows = {
    Row{{"name", "a measured stuff by its name"}, "string"},
    Row{{"sigma_a", "absorption per unit of length", 0}, "rgb spectrum blackbody float texture"},
    Row{{"sigma_s", "scattering per unit of length", 0}, "rgb spectrum blackbody float texture"},
    Row{{"reflectance", "colour of a half-space of it", 0, 1},
        "rgb spectrum blackbody float texture"},
    Row{{"mfp", "mean free path, with reflectance", 0},
        "rgb spectrum blackbody float texture",
        "1"},
    Row{{"scale", "factor of both coefficients", 0}, "float", "1"},
    Row{{"g", "mean cosine of a scattering", -ScatteringProperties::most_asymmetry,
         ScatteringProperties::most_asymmetry},
        "float",
        "0"}};

constexpr std::array light_rows = {Row{{"scale", "factor of the light", 0}, "float", "1"}};
constexpr Row power_row = {
    {"power", "luminous power that replaces the spectrum's magnitude; not above 0: none", -no_limit,
     no_limit, "lumens"},
    "float",
    "-1"};
constexpr Row illuminance_row = {
    {"illuminance", "illuminance that replaces the spectrum's magnitude; not above 0: none",
     -no_limit, no_limit, "lux"},
    "float",
    "-1"};

constexpr std::array area_rows = {
    Row{{"L", "radiance", 0}, "rgb spectrum blackbody float", "the colour space's white"},
    Row{{"filename", "an image over the surface's (u, v), in place of L"}, "string"},
    Row{{"scale", "factor of the light", 0}, "float", "1"},
    power_row,
    Row{{"twosided", "shines from both sides"}, "bool", "false"},
    Row{{"surfaces", "the surfaces that shine; all where none is named", 0}, "integer"}};

template <class Type>
void describe(std::vector<Parameter>& out, bool may_be_textures = false) {
  const Type model{};
  Describe all(out);
  if (may_be_textures) all.may_be_textures();
  Type::fields(model, all);
}

void add_material(const std::string& type, std::vector<Parameter>& out) {
#define MATERIAL_MODEL(name, Type) \
  if (type == #name) describe<Type>(out, true);
#include "scene/materials.def"
  if (type == "subsurface") {
    DielectricMaterial boundary;
    boundary.eta = ConstantSpectrum{1.33};
    Describe all(out);
    all.may_be_textures();
    DielectricMaterial::fields(boundary, all);
    add_rows(subsurface_rows, out);
  }
  add_rows(material_rows, out);
}

void add_texture(const std::string& type, std::vector<Parameter>& out) {
  if (type == "constant")
    Describe(out).operand({"value", "the value everywhere"}, TextureOperand(1));
#define TEXTURE_MODEL(name, Type) \
  if (type == #name) describe<Type>(out);
#include "scene/textures.def"
}

void add_light(const std::string& type, std::vector<Parameter>& out) {
#define LIGHT_MODEL(name, Type)                                                                \
  if (type == #name) {                                                                         \
    describe<Type>(out);                                                                       \
    out.push_back(parameter_of(Type::unit == LightUnit::power ? power_row : illuminance_row)); \
  }
#include "scene/lights.def"
  add_rows(light_rows, out);
}

void add_medium(const std::string& type, std::vector<Parameter>& out) {
#define MEDIUM_MODEL(name, Type) \
  if (type == #name) describe<Type>(out);
#include "scene/media.def"
  out.push_back(
      parameter_of({{"subsurface", "a walk within it counts as one scattering"}, "bool", "false"}));
}

}  // namespace

const std::vector<std::string>& families() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out;
    for (const Family& family : family_rows) out.emplace_back(family.name);
    return out;
  }();
  return names;
}

std::string directive_of(std::string_view family) {
  for (const Family& one : family_rows)
    if (family == one.name) return one.directive;
  return {};
}

std::vector<Parameter> parameters_of(std::string_view directive, const std::string& type) {
  std::vector<Parameter> out;
  if (directive == "Material")
    add_material(type, out);
  else if (directive == "Texture")
    add_texture(type, out);
  else if (directive == "LightSource")
    add_light(type, out);
  else if (directive == "AreaLightSource")
    add_rows(area_rows, out);
  else if (directive == "MakeNamedMedium")
    add_medium(type, out);
  else if (directive == "Shape")
    add_shape(type, out);
  else
    add_option(directive, type, out);
  return out;
}

}  // namespace caplet::schema
