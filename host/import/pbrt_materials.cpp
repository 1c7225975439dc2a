// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt_materials.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace caplet::pbrt {

namespace {

/// Componentwise `f` of a spectrum that has components; no value for a blackbody.
template <class F>
std::optional<Spectrum> map_spectrum(const Spectrum& spectrum, F f) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum)) return ConstantSpectrum{f(constant->value)};
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum))
    return RgbSpectrum{{f(rgb->rgb.x), f(rgb->rgb.y), f(rgb->rgb.z)}, rgb->space};
  if (const auto* sampled = std::get_if<SampledSpectrum>(&spectrum)) {
    SampledSpectrum out = *sampled;
    std::transform(out.values.begin(), out.values.end(), out.values.begin(), f);
    return out;
  }
  return std::nullopt;
}

std::optional<RgbSpectrum> as_rgb(const Spectrum& spectrum, ColorSpace space) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum)) return RgbSpectrum{glm::dvec3(constant->value), space};
  const auto* rgb = std::get_if<RgbSpectrum>(&spectrum);
  return rgb && rgb->space == space ? std::optional(*rgb) : std::nullopt;
}

/// (1 - t) a + t b of constants and RGBs of one colour space, or of spectra sampled at the same wavelengths.
std::optional<Spectrum> mix_spectra(const Spectrum& a, const Spectrum& b, double t) {
  const auto *ca = std::get_if<ConstantSpectrum>(&a), *cb = std::get_if<ConstantSpectrum>(&b);
  if (ca && cb) return ConstantSpectrum{(1 - t) * ca->value + t * cb->value};
  const auto *sa = std::get_if<SampledSpectrum>(&a), *sb = std::get_if<SampledSpectrum>(&b);
  if (sa && sb && sa->wavelengths == sb->wavelengths) {
    SampledSpectrum out = *sa;
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] = (1 - t) * sa->values[i] + t * sb->values[i];
    return out;
  }
  const auto *ra = std::get_if<RgbSpectrum>(&a), *rb = std::get_if<RgbSpectrum>(&b);
  if (!ra && !rb) return std::nullopt;
  const ColorSpace space = ra ? ra->space : rb->space;
  const auto x = as_rgb(a, space), y = as_rgb(b, space);
  if (!x || !y) return std::nullopt;
  return RgbSpectrum{(1 - t) * x->rgb + t * y->rgb, space};
}

/// A spectrum texture's argument: a spectrum, a texture, or the reason why it is not rendered (in `refusal`).
Spectrum texture_argument(Parameters& parameters, const char* name, double fallback, const TextureTable& textures,
                          std::string& refusal) {
  if (const Parameter* named = parameters.values(name, {"texture", "rgb", "spectrum", "blackbody"});
      named && named->type == "texture")
    if (const auto found = textures.find(named->strings[0]); found != textures.end() && !found->second.refusal.empty()) {
      refusal = found->second.refusal;
      return ConstantSpectrum{fallback};
    }
  return parameters.spectrum(name, SpectrumUse::unbounded, &textures).value_or(ConstantSpectrum{fallback});
}

double float_argument(Parameters& parameters, const char* name, double fallback, const TextureTable& textures,
                      std::string& refusal) {
  if (const Parameter* named = parameters.values(name, {"texture", "float"}); named && named->type == "texture")
    if (const auto found = textures.find(named->strings[0]); found != textures.end() && !found->second.refusal.empty()) {
      refusal = found->second.refusal;
      return fallback;
    }
  return parameters.number_or_texture(name, fallback, textures);
}

double alpha_from_roughness(Parameters& parameters, const char* name, double roughness, bool remap) {
  if (roughness < 0) {
    parameters.error(parameters.has(name) ? name : "roughness", "must not be negative");
    return 0;
  }
  return remap ? std::sqrt(roughness) : roughness;
}

/// Reads what scene/materials.def visits.
struct MaterialReader {
  Parameters& parameters;
  const TextureTable& textures;

  void albedo(const char* name, Spectrum& value) { spectrum(name, SpectrumUse::albedo, value); }
  void unbounded(const char* name, Spectrum& value) { spectrum(name, SpectrumUse::unbounded, value); }
  void index(const char* name, Spectrum& value) {
    const Parameter* given = parameters.values(name, {"float", "spectrum", "rgb", "blackbody"});
    if (given && given->type == "float")
      value = ConstantSpectrum{parameters.number(name, std::get<ConstantSpectrum>(value).value)};
    else if (given)
      value = parameters.spectrum(name, SpectrumUse::unbounded).value_or(value);
    if (const auto* constant = std::get_if<ConstantSpectrum>(&value); constant && constant->value <= 0)
      parameters.error(name, "must be positive");
  }
  void number(const char* name, double& value, double low, double high) {
    value = parameters.number_or_texture(name, value, textures);
    if (!(value >= low && value <= high))
      parameters.error(name, "must lie between " + std::to_string(low) + " and " + std::to_string(high));
  }
  void roughness(double& alpha_u, double& alpha_v) {
    const double both = parameters.number_or_texture("roughness", 0, textures);
    const bool remap = parameters.boolean("remaproughness", true);
    alpha_u = alpha_from_roughness(parameters, "uroughness", parameters.number_or_texture("uroughness", both, textures), remap);
    alpha_v = alpha_from_roughness(parameters, "vroughness", parameters.number_or_texture("vroughness", both, textures), remap);
  }
  void metal(Spectrum& eta, Spectrum& k, std::optional<Spectrum>& reflectance) {
    const bool has_indices = parameters.has("eta") || parameters.has("k");
    if (parameters.has("reflectance")) {
      if (has_indices) parameters.error("reflectance", "cannot be combined with \"eta\" or \"k\"");
      reflectance = parameters.spectrum("reflectance", SpectrumUse::albedo, &textures).value_or(ConstantSpectrum{0.5});
    } else {
      eta = named_spectrum("metal-Cu-eta").value_or(ConstantSpectrum{1});
      k = named_spectrum("metal-Cu-k").value_or(ConstantSpectrum{1});
      unbounded("eta", eta);
      unbounded("k", k);
    }
  }

  void spectrum(const char* name, SpectrumUse use, Spectrum& value) {
    if (auto given = parameters.spectrum(name, use, &textures)) value = *std::move(given);
  }
};

}  // namespace

TextureValue make_texture(const std::string& kind, const std::string& texture_class, Parameters& parameters,
                          const TextureTable& textures) {
  TextureValue value;
  value.is_float = kind == "float";
  value.spectrum = ConstantSpectrum{1};
  const auto spectrum = [&](const char* name, double fallback) {
    return texture_argument(parameters, name, fallback, textures, value.refusal);
  };
  const auto number = [&](const char* name, double fallback) {
    return float_argument(parameters, name, fallback, textures, value.refusal);
  };
  if (texture_class == "constant") {
    if (value.is_float)
      value.number = parameters.number("value", 1);
    else
      value.spectrum = spectrum("value", 1);
  } else if (texture_class == "scale") {
    const double scale = number("scale", 1);
    if (value.is_float)
      value.number = scale * number("tex", 1);
    else if (const auto scaled = map_spectrum(spectrum("tex", 1), [=](double x) { return scale * x; }))
      value.spectrum = *scaled;
    else
      value.refusal = "a scaled blackbody texture, which is not rendered yet";
  } else if (texture_class == "mix") {
    const double amount = number("amount", 0.5);
    if (value.is_float)
      value.number = (1 - amount) * number("tex1", 0) + amount * number("tex2", 1);
    else if (const auto mixed = mix_spectra(spectrum("tex1", 0), spectrum("tex2", 1), amount))
      value.spectrum = *mixed;
    else
      value.refusal = "a mix texture of different kinds of spectra, which is not rendered yet";
  } else {
    std::string missing;
    if (texture_class == "imagemap") {
      const std::string name = parameters.text("filename", "");
      const std::string file = resolve_file(name, parameters.where("filename"), parameters.main_file());
      std::error_code ignored;
      if (name.empty() && !parameters.has("filename"))
        parameters.error("\"filename\" is missing");
      else if (!std::filesystem::is_regular_file(file, ignored))
        missing = ", whose file " + in_quotes(file) + " does not exist";
    }
    value.refusal =
        "Texture \"" + texture_class + "\" (" + parameters.where().to_string() + ")" + missing + ", which is not rendered yet";
    return value;
  }
  parameters.finish();
  return value;
}

Material make_material(const std::string& type, Parameters& parameters, const TextureTable& textures) {
  Material material;
  material.where = parameters.where();
  parameters.refuse("displacement");
  parameters.refuse("normalmap");
#define MATERIAL_MODEL(name, Type)                             \
  if (type == #name) {                                         \
    Type model;                                                \
    Type::fields(model, MaterialReader{parameters, textures}); \
    material.model = std::move(model);                         \
  }
#include "scene/materials.def"
  parameters.finish();
  return material;
}

}  // namespace caplet::pbrt
