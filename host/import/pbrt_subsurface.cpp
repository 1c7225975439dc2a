// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt_subsurface.h"

#include <algorithm>

#include "base/spelling.h"
#include "scene/media/subsurface.h"

namespace caplet::pbrt {

namespace {

/// Coefficients that vary over the surface would vary within: there is no such medium.
void refuse_textures(Parameters& parameters, const TextureTable& textures) {
  for (const char* name : {"sigma_a", "sigma_s", "reflectance", "mfp"})
    if (parameters.texture(name, false, textures)) parameters.error(name, "varies over the surface: no medium can be made of it");
}

/// Red, green and blue of what can be one.
std::optional<glm::dvec3> as_colors(const Spectrum& spectrum) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum)) return glm::dvec3(constant->value);
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) return rgb->rgb;
  return std::nullopt;
}

}  // namespace

Medium subsurface_medium(Parameters& parameters, const TextureTable& textures, const Spectrum& eta) {
  HomogeneousMedium model;
  model.scattering = HomogeneousMedium::milk();
  ScatteringProperties& of = model.scattering;
  const double scale = parameters.number("scale", 1);
  if (scale < 0) parameters.error("scale", "must not be negative");
  double g = parameters.number("g", 0);
  if (!(g > -1 && g < 1)) parameters.error("g", "must lie between -1 and 1, and be neither");
  g = std::clamp(g, -ScatteringProperties::most_asymmetry, ScatteringProperties::most_asymmetry);
  refuse_textures(parameters, textures);

  const std::string name = parameters.text("name", "");
  const auto spectrum = [&](const char* given, SpectrumUse use) { return parameters.spectrum(given, use, &textures); };
  const auto sigma_a = spectrum("sigma_a", SpectrumUse::unbounded), sigma_s = spectrum("sigma_s", SpectrumUse::unbounded);
  const auto reflectance = spectrum("reflectance", SpectrumUse::albedo), mfp = spectrum("mfp", SpectrumUse::unbounded);
  if (!name.empty() + (sigma_a || sigma_s) + reflectance.has_value() > 1)
    parameters.error("takes one of \"name\", \"sigma_a\" with \"sigma_s\", and \"reflectance\"");
  if (sigma_a.has_value() != sigma_s.has_value())
    parameters.error(sigma_a ? "sigma_a" : "sigma_s", sigma_a ? "needs a \"sigma_s\"" : "needs a \"sigma_a\"");
  if (mfp && !reflectance) parameters.error("mfp", "needs a \"reflectance\"");
  of.scale = scale;
  of.g = g;
  if (!name.empty()) {
    const auto known = named_scattering(name);
    if (known) of = *known;
    of.scale = scale;
    if (!known)
      parameters.error("name", "is " + in_quotes(name) + "; the nearest known name is \"" +
                                   nearest_name(name, named_scattering_names()) + "\"");
    of.g = 0;  // as pbrt-v4: these coefficients are of even scattering
  } else if (sigma_a && sigma_s) {
    of.sigma_a = *sigma_a;
    of.sigma_s = *sigma_s;
  } else if (reflectance) {
    const auto color = as_colors(*reflectance), free = as_colors(mfp.value_or(ConstantSpectrum{1}));
    const auto* index = std::get_if<ConstantSpectrum>(&eta);
    if (!color || !free || !index || !(free->x > 0 && free->y > 0 && free->z > 0) || !(scale > 0)) {
      parameters.error("reflectance", !index ? "needs an \"eta\" that is a number"
                                             : "and \"mfp\" must be colours or numbers, and the latter positive");
    } else {
      glm::dvec3 a, s;
      for (int k = 0; k < 3; ++k) {
        const double albedo = albedo_within((*color)[k], index->value, g);
        s[k] = albedo / (*free)[k];
        a[k] = (1 - albedo) / (*free)[k];
      }
      const auto* rgb = std::get_if<RgbSpectrum>(&*reflectance);
      const ColorSpace space = rgb ? rgb->space : parameters.space();
      of.sigma_a = RgbSpectrum{a, space};
      of.sigma_s = RgbSpectrum{s, space};
      of.scale = 1 / scale;  // of the free path
    }
  }
  return {model, name, parameters.where()};
}

}  // namespace caplet::pbrt
