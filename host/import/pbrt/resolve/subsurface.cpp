// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/subsurface.h"

#include <algorithm>
#include <glm/common.hpp>
#include <variant>

#include "base/spelling.h"
#include "scene/media/subsurface.h"

namespace caplet::pbrt {

namespace {

/// Returns the red, green and blue of a spectrum that has them.
std::optional<glm::dvec3> as_colors(const Spectrum& spectrum) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum))
    return glm::dvec3(constant->value);
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) return rgb->rgb;
  return std::nullopt;
}

/// Computes means of whole textures in red, green and blue; no value for textures without a simple
/// mean.
struct TextureMean {
  const Scene& scene;

  std::optional<glm::dvec3> of(const TextureOperand& operand) const {
    return operand.texture ? of(*operand.texture) : as_colors(operand.value);
  }
  std::optional<glm::dvec3> of(std::uint32_t texture) const {
    return std::visit(*this, scene.textures[texture].model);
  }

  std::optional<glm::dvec3> operator()(const ImagemapTexture& map) const {
    const TextureImage& image = *map.image;
    const auto channels = static_cast<std::size_t>(image.channels);
    glm::dvec3 sum(0);
    for (std::size_t i = 0; i < image.values(); ++i) {
      const std::size_t channel = i % channels;
      const double value = image.bytes.empty() ? image.floats[i] : image.decoded[image.bytes[i]];
      if (channels < 3)
        sum += channel == 0 ? glm::dvec3(value) : glm::dvec3(0);
      else if (channel < 3)
        sum[static_cast<int>(channel)] += value;
    }
    const glm::dvec3 mean = map.scale * sum / (static_cast<double>(image.width) * image.height);
    return map.invert ? glm::max(1.0 - mean, 0.0) : mean;
  }
  std::optional<glm::dvec3> operator()(const ScaleTexture& product) const {
    const auto a = of(product.tex), b = of(product.scale);
    return a && b ? std::optional(*a * *b) : std::nullopt;
  }
  std::optional<glm::dvec3> operator()(const MixTexture& mix) const {
    const auto a = of(mix.tex1), b = of(mix.tex2), amount = of(mix.amount);
    return a && b && amount ? std::optional((1.0 - *amount) * *a + *amount * *b) : std::nullopt;
  }
  std::optional<glm::dvec3> operator()(const CheckerboardTexture& board) const {
    const auto a = of(board.tex1), b = of(board.tex2);
    return a && b ? std::optional(0.5 * (*a + *b)) : std::nullopt;
  }
  template <class Other>
  std::optional<glm::dvec3> operator()(const Other&) const {
    return std::nullopt;
  }
};

}  // namespace

Medium subsurface_medium(Parameters& parameters, const TextureTable& textures, const Scene& scene,
                         const Spectrum& eta) {
  HomogeneousMedium model;
  model.scattering = HomogeneousMedium::milk();
  ScatteringProperties& of = model.scattering;
  const double scale = parameters.number("scale", 1);
  if (scale < 0) parameters.error("scale", "must not be negative");
  double g = parameters.number("g", 0);
  if (!(g > -1 && g < 1)) parameters.error("g", "must lie between -1 and 1, and be neither");
  g = std::clamp(g, -ScatteringProperties::most_asymmetry, ScatteringProperties::most_asymmetry);

  const std::string name = parameters.text("name", "");
  // A texture is replaced by its mean, because the medium cannot vary with the surface.
  const auto spectrum = [&](const char* given, SpectrumUse use) -> std::optional<Spectrum> {
    const auto texture = parameters.texture(given, false, textures);
    if (!texture) return parameters.spectrum(given, use, &textures);
    const auto mean = TextureMean{scene}.of(*texture);
    if (!mean) {
      parameters.error(given, "varies over the surface: no medium can be made of it");
      return std::nullopt;
    }
    parameters.diagnostics().warning(
        parameters.where(given), parameters.owner() + ": \"" + given +
                                     "\" varies over the surface, and counts by its mean within");
    const glm::dvec3 held = glm::clamp(*mean, 0.0, use == SpectrumUse::albedo ? 1.0 : 1e9);
    return RgbSpectrum{held, parameters.space()};
  };
  const auto sigma_a = spectrum("sigma_a", SpectrumUse::unbounded),
             sigma_s = spectrum("sigma_s", SpectrumUse::unbounded);
  const auto reflectance = spectrum("reflectance", SpectrumUse::albedo),
             mfp = spectrum("mfp", SpectrumUse::unbounded);
  if (!name.empty() + (sigma_a || sigma_s) + reflectance.has_value() > 1)
    parameters.error("takes one of \"name\", \"sigma_a\" with \"sigma_s\", and \"reflectance\"");
  if (sigma_a.has_value() != sigma_s.has_value())
    parameters.error(sigma_a ? "sigma_a" : "sigma_s",
                     sigma_a ? "needs a \"sigma_s\"" : "needs a \"sigma_a\"");
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
    of.g = 0;  // as in pbrt-v4: these coefficients assume isotropic scattering
  } else if (sigma_a && sigma_s) {
    of.sigma_a = *sigma_a;
    of.sigma_s = *sigma_s;
  } else if (reflectance) {
    const auto color = as_colors(*reflectance), free = as_colors(mfp.value_or(ConstantSpectrum{1}));
    const auto* index = std::get_if<ConstantSpectrum>(&eta);
    if (!color || !free || !index || !(free->x > 0 && free->y > 0 && free->z > 0) || !(scale > 0)) {
      parameters.error("reflectance",
                       !index ? "needs an \"eta\" that is a number"
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
      of.scale = 1 / scale;  // scales the mean free path
    }
  }
  return {model, name, parameters.where(), true};
}

}  // namespace caplet::pbrt
