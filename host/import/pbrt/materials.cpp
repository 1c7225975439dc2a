// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/materials.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/spelling.h"
#include "import/detail/pbrt/fields.h"
#include "import/detail/pbrt/subsurface.h"
#include "scene/transform.h"

namespace caplet::pbrt {

namespace {

/// Applies `f` to each component of a spectrum; no value for a blackbody.
template <class F>
std::optional<Spectrum> map_spectrum(const Spectrum& spectrum, F f) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum))
    return ConstantSpectrum{f(constant->value)};
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
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum))
    return RgbSpectrum{glm::dvec3(constant->value), space};
  const auto* rgb = std::get_if<RgbSpectrum>(&spectrum);
  return rgb && rgb->space == space ? std::optional(*rgb) : std::nullopt;
}

/// Returns (1 - t) a + t b for constants, for RGBs of one colour space, or for spectra sampled at
/// the same wavelengths.
std::optional<Spectrum> mix_spectra(const Spectrum& a, const Spectrum& b, double t) {
  const auto *ca = std::get_if<ConstantSpectrum>(&a), *cb = std::get_if<ConstantSpectrum>(&b);
  if (ca && cb) return ConstantSpectrum{(1 - t) * ca->value + t * cb->value};
  const auto *sa = std::get_if<SampledSpectrum>(&a), *sb = std::get_if<SampledSpectrum>(&b);
  if (sa && sb && sa->wavelengths == sb->wavelengths) {
    SampledSpectrum out = *sa;
    for (std::size_t i = 0; i < out.values.size(); ++i)
      out.values[i] = (1 - t) * sa->values[i] + t * sb->values[i];
    return out;
  }
  const auto *ra = std::get_if<RgbSpectrum>(&a), *rb = std::get_if<RgbSpectrum>(&b);
  if (!ra && !rb) return std::nullopt;
  const ColorSpace space = ra ? ra->space : rb->space;
  const auto x = as_rgb(a, space), y = as_rgb(b, space);
  if (!x || !y) return std::nullopt;
  return RgbSpectrum{(1 - t) * x->rgb + t * y->rgb, space};
}

/// Returns a spectrum texture's argument: a spectrum, a texture, or the reason why it is not
/// rendered (in `refusal`).
Spectrum texture_argument(Parameters& parameters, const char* name, double fallback,
                          const TextureTable& textures, std::string& refusal) {
  if (const Parameter* named =
          parameters.values(name, {"texture", "rgb", "spectrum", "blackbody", "float"});
      named && named->type == "texture")
    if (const TextureValue* found = textures.find(named->strings[0], false);
        found && !found->refusal.empty()) {
      refusal = found->refusal;
      return ConstantSpectrum{fallback};
    }
  return parameters.spectrum(name, SpectrumUse::unbounded, &textures)
      .value_or(ConstantSpectrum{fallback});
}

double float_argument(Parameters& parameters, const char* name, double fallback,
                      const TextureTable& textures, std::string& refusal) {
  if (const Parameter* named = parameters.values(name, {"texture", "float"});
      named && named->type == "texture")
    if (const TextureValue* found = textures.find(named->strings[0], true);
        found && !found->refusal.empty()) {
      refusal = found->refusal;
      return fallback;
    }
  return parameters.number_or_texture(name, fallback, textures);
}

double alpha_from_roughness(Parameters& parameters, const char* name, double roughness,
                            bool remap) {
  if (roughness < 0) {
    parameters.error(name, "must not be negative");
    return 0;
  }
  return remap ? std::sqrt(roughness) : roughness;
}

/// Adds the square root of a texture of floats, which need not be of this scene.
std::uint32_t root_of(std::uint32_t texture, const SourceLocation& where, Scene& scene) {
  RootTexture root;
  root.tex.texture = texture;
  std::string name = texture < scene.textures.size() ? scene.textures[texture].name : std::string();
  scene.textures.push_back({root, true, std::move(name), where});
  return static_cast<std::uint32_t>(scene.textures.size() - 1);
}

/// Makes a texture of the pigments' absorption; each amount is a texture or a number.
std::uint32_t melanin_texture(const TextureOperand& eumelanin, const TextureOperand& pheomelanin,
                              const SourceLocation& where, Scene& scene) {
  const auto add = [&](auto model) {
    scene.textures.push_back({std::move(model), false, "melanin", where});
    return static_cast<std::uint32_t>(scene.textures.size() - 1);
  };
  // A mix gives half the sum, so both terms are doubled.
  const auto twice = [&](const Spectrum& color, const TextureOperand& amount) {
    ScaleTexture product;
    auto rgb = std::get<RgbSpectrum>(color);
    rgb.rgb *= 2.0;
    product.tex.value = rgb;
    product.scale = amount;
    return add(product);
  };
  MixTexture sum;
  sum.tex1.texture = twice(HairMaterial::melanin(1, 0), eumelanin);
  sum.tex2.texture = twice(HairMaterial::melanin(0, 1), pheomelanin);
  return add(sum);
}

/// Reads the fields of scene/materials.def.
struct MaterialReader : FieldReader {
  const TextureTable& textures;
  const PartFinder& part_named;
  Material& material;
  Scene& scene;

  void albedo(const Field& field, Spectrum& value) { spectrum(field, SpectrumUse::albedo, value); }
  void unbounded(const Field& field, Spectrum& value) {
    spectrum(field, SpectrumUse::unbounded, value);
  }
  void index(const Field& field, Spectrum& value) {
    const char* const name = field.name;
    const Parameter* given = parameters.values(name, {"float", "spectrum", "rgb", "blackbody"});
    if (given && given->type == "float")
      value = ConstantSpectrum{parameters.number(name, std::get<ConstantSpectrum>(value).value)};
    else if (given)
      value = parameters.spectrum(name, SpectrumUse::unbounded).value_or(value);
    if (const auto* constant = std::get_if<ConstantSpectrum>(&value);
        constant && constant->value <= 0)
      parameters.error(name, "must be positive");
  }
  void number(const Field& field, double& value) {
    if (textured(field.name, field.name, true)) return;
    value = parameters.number_or_texture(field.name, value, textures);
    check(field, value);
  }
  void parts(const Field& field, std::array<std::uint32_t, 2>& materials) {
    const char* const name = field.name;
    const Parameter* given = parameters.values(name, {"string"});
    if (!given || given->strings.size() != 2) {
      if (given || !parameters.has(name))
        parameters.error(name, given ? "takes the names of 2 materials, not of " +
                                           std::to_string(given->strings.size())
                                     : "is missing");
      return;
    }
    for (std::size_t i = 0; i < 2; ++i) {
      std::string problem;
      if (const auto found = part_named(given->strings[i], problem))
        materials[i] = *found;
      else
        parameters.error(name, problem);
    }
  }
  void pigment(const PigmentFields& fields, Spectrum& sigma_a,
               std::optional<Spectrum>& reflectance) {
    const char* const color = parameters.has("reflectance") ? "reflectance" : "color";
    const bool has_color = parameters.has(color),
               has_melanin = parameters.has("eumelanin") || parameters.has("pheomelanin");
    if (parameters.has("sigma_a") + has_color + has_melanin > 1)
      parameters.error(has_color ? color : "sigma_a",
                       "cannot be combined with other ways to say the colour");
    if (has_color) {
      Spectrum value = ConstantSpectrum{0.5};
      if (const auto texture = parameters.texture(color, false, textures))
        material.textures.push_back({fields.reflectance.name, *texture});
      else if (auto given = parameters.spectrum(color, SpectrumUse::albedo, &textures))
        value = *std::move(given);
      reflectance = value;
    } else if (parameters.has("sigma_a")) {
      unbounded(fields.sigma_a, sigma_a);
    } else {
      const auto amount = [&](const char* name, double fallback) {
        TextureOperand operand = 0;
        if (operand.texture = parameters.texture(name, true, textures); operand.texture)
          return operand;
        const double value = parameters.number_or_texture(name, fallback, textures);
        if (value < 0) parameters.error(name, "must not be negative");
        operand.value = ConstantSpectrum{std::max(value, 0.0)};
        return operand;
      };
      const TextureOperand eumelanin =
                               amount("eumelanin", has_melanin ? 0 : HairMaterial::eumelanin),
                           pheomelanin = amount("pheomelanin", 0);
      if (eumelanin.texture || pheomelanin.texture)
        material.textures.push_back(
            {fields.sigma_a.name,
             melanin_texture(eumelanin, pheomelanin, parameters.where(), scene)});
      else
        sigma_a = HairMaterial::melanin(std::get<ConstantSpectrum>(eumelanin.value).value,
                                        std::get<ConstantSpectrum>(pheomelanin.value).value);
    }
  }
  void roughness(const RoughnessFields& fields, double& alpha_u, double& alpha_v) {
    if (parameters.has(fields.alpha_u.name) || parameters.has(fields.alpha_v.name)) {
      for (const char* other : {fields.roughness, fields.uroughness, fields.vroughness})
        if (parameters.has(other))
          parameters.error(other, "cannot be combined with " + in_quotes(fields.alpha_u.name));
      number(fields.alpha_u, alpha_u);
      number(fields.alpha_v, alpha_v);
      parameters.boolean("remaproughness", true);
      return;
    }
    const auto texture = parameters.texture(fields.roughness, true, textures);
    const double both = texture ? 0 : parameters.number_or_texture(fields.roughness, 0, textures);
    const bool remap = parameters.boolean("remaproughness", true);
    const auto alpha = [&](const char* name, const char* field, double& value) {
      const auto own = parameters.texture(name, true, textures);
      if (const auto used = own || parameters.has(name) ? own : texture)
        material.textures.push_back(
            {field, remap ? root_of(*used, parameters.where(own ? name : fields.roughness), scene)
                          : *used});
      else
        value = alpha_from_roughness(parameters, parameters.has(name) ? name : fields.roughness,
                                     parameters.number_or_texture(name, both, textures), remap);
    };
    alpha(fields.uroughness, fields.alpha_u.name, alpha_u);
    alpha(fields.vroughness, fields.alpha_v.name, alpha_v);
  }
  void metal(const MetalFields& fields, Spectrum& eta, Spectrum& k,
             std::optional<Spectrum>& reflectance) {
    const char *const eta_name = fields.eta.name, *const k_name = fields.k.name;
    const bool has_indices = parameters.has(eta_name) || parameters.has(k_name);
    if (parameters.has(fields.reflectance.name)) {
      if (has_indices)
        parameters.error(fields.reflectance.name, "cannot be combined with " + in_quotes(eta_name) +
                                                      " or " + in_quotes(k_name));
      reflectance = ConstantSpectrum{0.5};
      albedo(fields.reflectance, *reflectance);
    } else {
      unbounded(fields.eta, eta);
      unbounded(fields.k, k);
    }
  }

 private:
  void spectrum(const Field& field, SpectrumUse use, Spectrum& value) {
    if (textured(field.name, field.name, false)) return;
    if (auto given = parameters.spectrum(field.name, use, &textures)) value = *std::move(given);
  }
  bool textured(const char* name, const char* field, bool is_float) {
    const auto texture = parameters.texture(name, is_float, textures);
    if (texture) material.textures.push_back({field, *texture});
    return texture.has_value();
  }
};

/// Reads the fields of scene/textures.def.
struct TextureReader : FieldReader {
  const TextureTable& textures;
  const TextureContext& context;
  bool is_float;
  std::string& refusal;
  bool& failed;  // an error was reported

  void operand(const Field& field, TextureOperand& of) {
    if (is_float) return factor(field, of);
    const double fallback = std::get<ConstantSpectrum>(of.value).value;
    if (of.texture = parameters.texture(field.name, false, textures); !of.texture)
      of.value = texture_argument(parameters, field.name, fallback, textures, refusal);
  }
  void factor(const Field& field, TextureOperand& of) {
    const double fallback = std::get<ConstantSpectrum>(of.value).value;
    if (of.texture = parameters.texture(field.name, true, textures); !of.texture)
      of.value =
          ConstantSpectrum{float_argument(parameters, field.name, fallback, textures, refusal)};
  }
  void image(const Field& field, std::shared_ptr<const TextureImage>& image) {
    const ImageEncoding encoding = image_encoding(parameters);
    if (context.needs_files && !parameters.has(field.name))
      return error("\"string filename\" is missing");
    std::string problem;
    image = context.images(parameters, field.name, encoding, problem);
    if (!image && refusal.empty())
      refusal = "Texture \"imagemap\" (" + parameters.where().to_string() +
                "), whose image cannot be had: " + problem;
  }
  void vectors(const Field& field, std::shared_ptr<const TextureImage>& of) { image(field, of); }
  void mapping(TextureMapping& value) {
    int kind = 0;
    choice(TextureMapping::kind_field, kind, texture_mapping_names);
    value.kind = static_cast<TextureMapping::Kind>(kind);
    value.texture_from_world = context.texture_from_world;
    TextureMapping::fields(value, *this);
  }
  void vector(const Field& field, glm::dvec3& value) {
    value = parameters.vector(field.name, value);
  }
  void board(TextureMapping& value) {
    const int dimension = parameters.integer("dimension", 2);
    if (dimension != 2 && dimension != 3) parameters.error("dimension", "must be 2 or 3");
    if (dimension != 3) return mapping(value);
    value.kind = TextureMapping::Kind::solid;
    value.texture_from_world = context.texture_from_world;
  }
  void place(glm::dmat4& value) { value = context.texture_from_world; }
  void direction(const Field& field, glm::dvec3& value) {
    const glm::dvec3 turned(context.world_from_texture *
                            glm::dvec4(parameters.vector(field.name, value), 0));
    if (const double length = glm::length(turned); length > 0)
      value = is_unit(length) ? turned : glm::normalize(turned);
    else
      parameters.error(field.name, "is no direction");
  }
  void only(bool floats) {
    if (is_float != floats)
      error(std::string("is a texture of ") + (floats ? "floats" : "spectra") + " alone");
  }
  void colors() {}

 private:
  void error(const std::string& message) {
    parameters.error(message);
    failed = true;
  }
};

/// Returns the constant value of a texture whose operands are all constant; no value if it varies
/// over the surface.
std::optional<Spectrum> folded(const ScaleTexture& model) {
  if (model.tex.texture || model.scale.texture) return std::nullopt;
  const double scale = std::get<ConstantSpectrum>(model.scale.value).value;
  return map_spectrum(model.tex.value, [=](double x) { return scale * x; });
}
std::optional<Spectrum> folded(const MixTexture& model) {
  if (model.tex1.texture || model.tex2.texture || model.amount.texture) return std::nullopt;
  return mix_spectra(model.tex1.value, model.tex2.value,
                     std::get<ConstantSpectrum>(model.amount.value).value);
}
template <class Model>
std::optional<Spectrum> folded(const Model&) {
  return std::nullopt;
}

/// Reads the model of a class; no value for one without a model.
std::optional<decltype(Texture::model)> texture_model(const std::string& texture_class,
                                                      TextureReader reader) {
#define TEXTURE_MODEL(name, Type) \
  if (texture_class == #name) {   \
    Type model;                   \
    Type::fields(model, reader);  \
    return model;                 \
  }
#include "scene/textures.def"
  return std::nullopt;
}

}  // namespace

ImageEncoding image_encoding(Parameters& parameters) {
  const std::string name = parameters.text("encoding", "sRGB");
  if (name == "sRGB") return {ImageEncoding::Kind::srgb, 1};
  if (name == "linear") return {ImageEncoding::Kind::linear, 1};
  if (name.starts_with("gamma ")) {
    double gamma = 0;
    const char* const end = name.data() + name.size();
    const auto [at, error] = std::from_chars(name.data() + 6, end, gamma);
    if (error == std::errc() && at == end && gamma > 0 && std::isfinite(gamma))
      return {ImageEncoding::Kind::gamma, gamma};
  }
  parameters.error("encoding", "is " + in_quotes(name) +
                                   ", not \"sRGB\", \"linear\" or \"gamma X\" with X above 0");
  return {};
}

TextureValue make_texture(const std::string& name, const std::string& kind,
                          const std::string& texture_class, Parameters& parameters,
                          const TextureTable& textures, const TextureContext& context,
                          Scene& scene) {
  TextureValue value;
  value.is_float = kind == "float";
  value.spectrum = ConstantSpectrum{1};
  bool known = false, failed = false;
  if (texture_class == "constant") {
    known = true;
    if (value.is_float)
      value.number = parameters.number("value", 1);
    else
      value.spectrum = texture_argument(parameters, "value", 1, textures, value.refusal);
  }
  if (auto model =
          texture_model(texture_class,
                        {{parameters}, textures, context, value.is_float, value.refusal, failed})) {
    known = true;
    if (const auto constant = std::visit([](const auto& one) { return folded(one); }, *model)) {
      value.spectrum = *constant;
      if (value.is_float) value.number = std::get<ConstantSpectrum>(*constant).value;
    } else if (value.refusal.empty() && !failed) {
      value.texture = static_cast<std::uint32_t>(scene.textures.size());
      scene.textures.push_back({*std::move(model), value.is_float, name, parameters.where()});
    }
  }
  if (!known) {
    value.refusal = "Texture \"" + texture_class + "\" (" + parameters.where().to_string() +
                    "), which is not rendered yet";
    return value;
  }
  parameters.finish();
  return value;
}

namespace {

/// Reads the displacement or normal map of a material. A constant displacement has no effect.
void read_bump(Parameters& parameters, const TextureTable& textures, const TextureImages& images,
               Material& material, Scene& scene) {
  if (const auto texture = parameters.texture("displacement", true, textures))
    material.displacement = *texture;
  else
    parameters.number_or_texture("displacement", 0, textures);
  if (!parameters.has("normalmap")) return;
  if (parameters.has("displacement"))
    parameters.error("normalmap", "cannot be combined with \"displacement\"");
  std::string problem;
  const auto image =
      images(parameters, "normalmap", ImageEncoding{ImageEncoding::Kind::linear, 1}, problem);
  if (!image) return parameters.error("normalmap", problem, "normalmap: " + problem);
  if (image->channels < 3)
    return parameters.error("normalmap", "is an image in grey, which has no normals");
  material.normalmap = static_cast<std::uint32_t>(scene.textures.size());
  scene.textures.push_back({NormalmapTexture{image}, false, "", parameters.where("normalmap")});
}

/// Reads the model of an accepted type into `material`. Textures that it needs besides are added to
/// `scene`.
void read_model(const std::string& type, Parameters& parameters, const TextureTable& textures,
                const PartFinder& part_named, Material& material, Scene& scene) {
#define MATERIAL_MODEL(name, Type)                                                            \
  if (type == #name) {                                                                        \
    Type model;                                                                               \
    Type::fields(model, MaterialReader{{parameters}, textures, part_named, material, scene}); \
    material.model = std::move(model);                                                        \
  }
#include "scene/materials.def"
}

}  // namespace

Material make_material(const std::string& type, Parameters& parameters,
                       const TextureTable& textures, const TextureImages& images,
                       const PartFinder& part_named, Scene& scene, std::optional<Medium>& within) {
  Material material;
  material.where = parameters.where();
  read_bump(parameters, textures, images, material, scene);
  read_model(type, parameters, textures, part_named, material, scene);
  if (type == "subsurface") {
    DielectricMaterial boundary;
    boundary.eta = ConstantSpectrum{1.33};
    DielectricMaterial::fields(boundary,
                               MaterialReader{{parameters}, textures, part_named, material, scene});
    within = subsurface_medium(parameters, textures, scene, boundary.eta);
    material.model = std::move(boundary);
  }
  parameters.finish();
  return material;
}

Material make_program_material(const std::string& type, Parameters& parameters,
                               const TextureTable& textures, const PartFinder& part_named) {
  Material material;
  Scene more;
  read_model(type, parameters, textures, part_named, material, more);
  // The scene would need further textures, roots and mixes.
  if (!more.textures.empty())
    parameters.error("takes textures as \"alpha_u\", \"alpha_v\" and \"sigma_a\" alone");
  parameters.finish();
  return material;
}

std::optional<Texture> make_program_texture(const std::string& texture_class, bool is_float,
                                            Parameters& parameters, const TextureTable& textures,
                                            const TextureContext& context) {
  Texture out;
  out.is_float = is_float;
  std::string refusal;
  bool failed = false;
  if (auto model = texture_model(texture_class,
                                 {{parameters}, textures, context, is_float, refusal, failed}))
    out.model = *std::move(model);
  if (!refusal.empty()) parameters.error(refusal);
  parameters.finish();
  return failed || !refusal.empty() ? std::nullopt : std::optional(std::move(out));
}

}  // namespace caplet::pbrt
