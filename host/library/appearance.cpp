// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials and textures by type name, read by the readers of scene files.
#include "library/detail/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/spelling.h"
#include "caplet/shape.h"
#include "film/image.h"
#include "import/color_map.h"
#include "import/statement.h"
#include "library/detail/places.h"
#include "library/detail/statements.h"

namespace caplet::v0 {

namespace {

constexpr int most_texels = 1 << 15;  // per side

std::shared_ptr<const TextureImage> image_of(const Pixels& pixels) {
  const auto wrong = [](const std::string& what) { throw InputError("'pixels' must be " + what); };
  const auto wide = static_cast<std::size_t>(pixels.width),
             tall = static_cast<std::size_t>(pixels.height);
  if (pixels.width < 1 || pixels.height < 1 || pixels.width > most_texels ||
      pixels.height > most_texels)
    wrong(fmt::format("an image of 1 to {} pixels a side", most_texels));
  if (pixels.channels != 1 && pixels.channels != 3 && pixels.channels != 4)
    wrong("an image of 1, 3 or 4 channels");
  if (pixels.values.size() != wide * tall * static_cast<std::size_t>(pixels.channels))
    wrong("as many numbers as its sides say");
  if (!std::ranges::all_of(pixels.values, [](float value) { return std::isfinite(value); }))
    wrong("finite");
  auto out = std::make_shared<TextureImage>();
  out->width = pixels.width;
  out->height = pixels.height;
  out->channels = pixels.channels;
  out->floats = pixels.values;
  out->encoding = {ImageEncoding::Kind::linear, 1};
  return out;
}

/// Removes the texture of `name` from `parameters` and returns it.
std::optional<std::uint32_t> taken(Parameters& parameters, const std::string& name) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return std::nullopt;
  const auto* texture = std::get_if<TextureNumber>(&found->second);
  if (!texture) throw InputError(fmt::format("'{}' must be a texture", name));
  const std::uint32_t number = texture->number;
  parameters.erase(found);
  return number;
}

struct ToModel {
  const caplet::Scene& scene;
  caplet::Material operator()(const Diffuse& m) const {
    return of(DiffuseMaterial{to_model(m.reflectance)});
  }
  caplet::Material operator()(const Conductor& m) const {
    ConductorMaterial out;
    out.eta = to_model(m.eta);
    out.k = to_model(m.k);
    if (m.reflectance) out.reflectance = to_model(*m.reflectance);
    out.alpha_u = m.roughness_u;
    out.alpha_v = m.roughness_v;
    return of(std::move(out));
  }
  caplet::Material operator()(const Dielectric& m) const {
    return of(DielectricMaterial{to_model(m.eta), m.roughness_u, m.roughness_v});
  }
  caplet::Material operator()(const NamedMaterial& m) const {
    Parameters parameters = m.parameters;
    const auto displacement = taken(parameters, "displacement"),
               normalmap = taken(parameters, "normalmap");
    ProgramStatement statement = to_statement("Material", m.type, parameters);
    // A mix names its parts by number.
    for (StatementParameter& one : statement.parameters)
      if (one.name == "materials") {
        for (const double number : one.numbers) one.strings.push_back(fmt::format("{}", number));
        one.numbers.clear();
      }
    caplet::Material out = material_of(statement, scene);
    out.displacement = displacement;
    out.normalmap = normalmap;
    return out;
  }
  static caplet::Material of(decltype(caplet::Material::model) model) {
    caplet::Material out;
    out.model = std::move(model);
    return out;
  }
};

std::vector<std::string> names_of(Statement statement, const std::string& type) {
  std::vector<std::string> out;
  for (const KnownParameter& one : statement_parameters(statement, type)) out.push_back(one.name);
  return out;
}

}  // namespace

Rgb color_map(double part) {
  const glm::dvec3 color = viridis(part);
  return {color.x, color.y, color.z};
}

caplet::Spectrum to_model(const Spectrum& spectrum) {
  if (const auto* value = std::get_if<double>(&spectrum)) return ConstantSpectrum{*value};
  if (const auto* rgb = std::get_if<Rgb>(&spectrum))
    return RgbSpectrum{{rgb->r, rgb->g, rgb->b}, ColorSpace::srgb};
  const std::string& name = std::get<std::string>(spectrum);
  if (const auto found = named_spectrum(name)) return *found;
  throw InputError(fmt::format("there is no spectrum '{}'; the nearest is '{}'", name,
                               nearest_name(name, named_spectrum_names())));
}

caplet::Material to_model(const Material& material, const caplet::Scene& scene) {
  return std::visit(ToModel{scene}, material);
}

caplet::Texture to_model(const NamedTexture& texture, const caplet::Scene& scene) {
  Parameters parameters = texture.parameters;
  std::shared_ptr<const TextureImage> pixels;
  if (const auto found = parameters.find("pixels"); found != parameters.end()) {
    const auto* given = std::get_if<std::shared_ptr<const Pixels>>(&found->second);
    if (!given || !*given) throw InputError("'pixels' must be an image");
    pixels = image_of(**given);
    parameters.erase(found);
  }
  return texture_of(to_statement("Texture", texture.type, parameters), texture.is_float,
                    to_model(texture.world_from_texture), pixels, scene, FileImageReader());
}

void check_bends(const caplet::Scene& scene, const caplet::Material& material) {
  const auto has = [&](std::uint32_t texture) { return texture < scene.textures.size(); };
  if (material.displacement &&
      !(has(*material.displacement) && scene.textures[*material.displacement].is_float))
    throw InputError("the displacement is not a texture of floats");
  if (material.normalmap &&
      !(has(*material.normalmap) &&
        std::holds_alternative<NormalmapTexture>(scene.textures[*material.normalmap].model)))
    throw InputError("the normalmap is not a texture of that type");
  if (material.displacement && material.normalmap)
    throw InputError("the material has both a displacement and a normalmap");
}

void check_textures(const caplet::Scene& scene) {
  caplet::Scene one = scene;
  one.materials.emplace_back();
  one.shapes.emplace_back().geometry = SphereShape{1};
  Diagnostics diagnostics;
  validate(one, diagnostics);
  diagnostics.finish();
}

std::vector<std::string> material_types() { return statement_types(Statement::material); }

std::vector<std::string> texture_types() { return statement_types(Statement::texture); }

std::vector<std::string> material_parameters(const std::string& type) {
  return names_of(Statement::material, type);
}

std::vector<std::string> texture_parameters(const std::string& type) {
  return names_of(Statement::texture, type);
}

}  // namespace caplet::v0
