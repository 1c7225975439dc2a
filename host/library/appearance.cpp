// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials and textures by the names of their lists: what their `fields` visit is taken from a table of parameters.
#include "library/detail/appearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <memory>

#include "base/spelling.h"
#include "film/image.h"
#include "import/color_map.h"
#include "scene/texture_visitor.h"

namespace caplet::v0 {

namespace {

/// The parameters of one material or texture, as they are asked for.
class Given {
 public:
  Given(std::string owner, const Parameters& parameters) : owner_(std::move(owner)), parameters_(parameters) {}

  /// Null where it is left out.
  const Parameter* find(const std::string& name) {
    if (std::ranges::find(asked_, name) == asked_.end()) asked_.push_back(name);
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? nullptr : &found->second;
  }
  template <class T>
  const T* get(const std::string& name, const char* what) {
    const Parameter* given = find(name);
    if (!given) return nullptr;
    if (const T* value = std::get_if<T>(given)) return value;
    wrong(name, what);
  }
  void number(const std::string& name, double& value) {
    if (const double* given = get<double>(name, "a number")) value = *given;
  }
  void whole(const std::string& name, int& value, int low, int high) {
    double given = value;
    number(name, given);
    if (!(given >= low && given <= high) || given != std::floor(given))
      throw InputError(fmt::format("{}: '{}' is not a whole number from {} to {}", owner_, name, low, high));
    value = static_cast<int>(given);
  }
  /// A spectrum; false where it is left out or a texture.
  bool spectrum(const std::string& name, caplet::Spectrum& value) {
    const Parameter* given = find(name);
    if (!given || std::holds_alternative<TextureNumber>(*given)) return false;
    if (const double* number = std::get_if<double>(given))
      value = to_model(Spectrum(*number));
    else if (const Rgb* rgb = std::get_if<Rgb>(given))
      value = to_model(Spectrum(*rgb));
    else if (const auto* three = std::get_if<std::array<double, 3>>(given))
      value = to_model(Spectrum(Rgb{(*three)[0], (*three)[1], (*three)[2]}));
    else if (const std::string* text = std::get_if<std::string>(given))
      value = to_model(Spectrum(*text));
    else if (const Blackbody* body = std::get_if<Blackbody>(given))
      value = BlackbodySpectrum{body->kelvin};
    else
      wrong(name, "a spectrum or a texture");
    return true;
  }
  std::optional<std::uint32_t> texture(const std::string& name) {
    const Parameter* given = find(name);
    const TextureNumber* texture = given ? std::get_if<TextureNumber>(given) : nullptr;
    return texture ? std::optional(texture->number) : std::nullopt;
  }
  [[noreturn]] void wrong(const std::string& name, const std::string& what) const {
    throw InputError(fmt::format("{}: '{}' must be {}", owner_, name, what));
  }
  /// What was not asked for there is none of.
  void finish() const {
    for (const auto& [name, value] : parameters_)
      if (std::ranges::find(asked_, name) == asked_.end())
        throw InputError(fmt::format("{} has no parameter '{}'; the nearest is '{}'", owner_, name, nearest_name(name, asked_)));
  }
  const std::vector<std::string>& asked() const { return asked_; }

 private:
  std::string owner_;
  const Parameters& parameters_;
  std::vector<std::string> asked_;
};

constexpr int most_texels = 1 << 15;  // a side

/// The greatest number of a spectrum that is given by such.
double greatest_of(const caplet::Spectrum& spectrum) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum)) return constant->value;
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum)) return std::max({rgb->rgb.x, rgb->rgb.y, rgb->rgb.z});
  return 0;
}

/// Of the calls of scene/materials.def.
struct MaterialTaker {
  Given& given;
  std::vector<TexturedField>& textures;

  bool textured(const std::string& name) {
    const auto texture = given.texture(name);
    if (texture) textures.push_back({name, *texture});
    return texture.has_value();
  }
  void albedo(const std::string& name, caplet::Spectrum& value) {
    unbounded(name, value);
    if (greatest_of(value) > 1) given.wrong(name, "a reflectance, of no component above 1");
  }
  void unbounded(const std::string& name, caplet::Spectrum& value) {
    if (!textured(name)) given.spectrum(name, value);
  }
  void index(const std::string& name, caplet::Spectrum& value) {
    if (given.texture(name)) given.wrong(name, "a spectrum");
    given.spectrum(name, value);
  }
  void number(const std::string& name, double& value, double, double) {
    if (!textured(name)) given.number(name, value);
  }
  void whole(const std::string& name, int& value, int low, int high) { given.whole(name, value, low, high); }
  void flag(const std::string& name, bool& value) {
    if (const bool* on = given.get<bool>(name, "true or false")) value = *on;
  }
  void parts(std::array<std::uint32_t, 2>& materials) {
    if (const auto* two = given.get<std::array<std::uint32_t, 2>>("materials", "the numbers of two materials")) materials = *two;
  }
  void pigment(caplet::Spectrum& sigma_a, std::optional<caplet::Spectrum>& reflectance) {
    if (given.find("reflectance")) albedo("reflectance", reflectance.emplace(ConstantSpectrum{0.5}));
    unbounded("sigma_a", sigma_a);
  }
  void roughness(double& alpha_u, double& alpha_v, const std::string& prefix = "") {
    number(prefix + "alpha_u", alpha_u, 0, 0);
    number(prefix + "alpha_v", alpha_v, 0, 0);
  }
  void metal(caplet::Spectrum& eta, caplet::Spectrum& k, std::optional<caplet::Spectrum>& reflectance,
             const std::string& prefix = "") {
    eta = *named_spectrum("metal-Cu-eta");
    k = *named_spectrum("metal-Cu-k");
    if (given.find("reflectance")) albedo("reflectance", reflectance.emplace(ConstantSpectrum{0.5}));
    unbounded(prefix + "eta", eta);
    unbounded(prefix + "k", k);
  }
};

/// Of the calls of scene/textures.def.
struct TextureTaker : TextureVisitor {
  TextureTaker(Given& of, const NamedTexture& from, bool with_files) : given(of), texture(from), reads(with_files) {}
  Given& given;
  const NamedTexture& texture;
  bool reads;

  void operand(const char* name, TextureOperand& of) {
    if (texture.is_float) return factor(name, of);
    if (!(of.texture = given.texture(name))) given.spectrum(name, of.value);
  }
  void factor(const char* name, TextureOperand& of) {
    double value = std::get<ConstantSpectrum>(of.value).value;
    if (!(of.texture = given.texture(name))) given.number(name, value);
    of.value = ConstantSpectrum{value};
  }
  void number(const char* name, double& value) { given.number(name, value); }
  void flag(const char* name, int& value) {
    if (const bool* on = given.get<bool>(name, "true or false")) value = *on ? 1 : 0;
  }
  template <class Names>
  void choice(const char* name, int& value, const Names& names) {
    const std::string* chosen = given.get<std::string>(name, "a name");
    if (!chosen) return;
    const auto found = std::ranges::find(names, *chosen);
    if (found == names.end())
      given.wrong(name, fmt::format("one that there is, not '{}'; the nearest is '{}'", *chosen,
                                    nearest_name(*chosen, std::vector<std::string>(names.begin(), names.end()))));
    value = static_cast<int>(found - names.begin());
  }
  void image(std::shared_ptr<const TextureImage>& image) { read(image, {}); }
  void vectors(std::shared_ptr<const TextureImage>& image) { read(image, {ImageEncoding::Kind::linear, 1}); }
  void read(std::shared_ptr<const TextureImage>& image, ImageEncoding encoding) {
    const auto* pixels = given.get<std::shared_ptr<const Pixels>>("pixels", "an image");
    const std::string* file = given.get<std::string>("filename", "the name of a file");
    if (const std::string* name = given.get<std::string>("encoding", "a name")) encoding = encoding_named(*name);
    if (!reads) return;
    if (pixels) {
      if (file || given.find("encoding")) given.wrong("pixels", "alone, without filename and encoding");
      image = image_of(**pixels);
      return;
    }
    if (!file) given.wrong("filename", "there");
    image = std::make_shared<TextureImage>(FileImageReader().read_texture(*file, encoding));
  }
  std::shared_ptr<const TextureImage> image_of(const Pixels& pixels) const {
    const auto wide = static_cast<std::size_t>(pixels.width), tall = static_cast<std::size_t>(pixels.height);
    if (pixels.width < 1 || pixels.height < 1 || pixels.width > most_texels || pixels.height > most_texels)
      given.wrong("pixels", fmt::format("an image of 1 to {} pixels a side", most_texels));
    if (pixels.channels != 1 && pixels.channels != 3 && pixels.channels != 4)
      given.wrong("pixels", "an image of 1, 3 or 4 channels");
    if (pixels.values.size() != wide * tall * static_cast<std::size_t>(pixels.channels))
      given.wrong("pixels", "as many numbers as its sides say");
    if (!std::ranges::all_of(pixels.values, [](float value) { return std::isfinite(value); })) given.wrong("pixels", "finite");
    auto out = std::make_shared<TextureImage>();
    out->width = pixels.width;
    out->height = pixels.height;
    out->channels = pixels.channels;
    out->floats = pixels.values;
    out->encoding = {ImageEncoding::Kind::linear, 1};
    return out;
  }
  ImageEncoding encoding_named(const std::string& name) const {
    if (name == "sRGB") return {};
    if (name == "linear") return {ImageEncoding::Kind::linear, 1};
    double gamma = 0;
    const char* const end = name.data() + name.size();
    if (name.starts_with("gamma "))
      if (const auto [at, error] = std::from_chars(name.data() + 6, end, gamma);
          error == std::errc() && at == end && gamma > 0 && std::isfinite(gamma))
        return {ImageEncoding::Kind::gamma, gamma};
    given.wrong("encoding", "\"sRGB\", \"linear\" or \"gamma X\" with X above 0");
  }
  void mapping(TextureMapping& value) {
    int kind = 0;
    choice("mapping", kind, texture_mapping_names);
    value.kind = static_cast<TextureMapping::Kind>(kind);
    value.texture_from_world = glm::inverse(world());
    for (const auto& [name, to] : {std::pair("uscale", &value.uscale), std::pair("vscale", &value.vscale),
                                   std::pair("udelta", &value.udelta), std::pair("vdelta", &value.vdelta)})
      given.number(name, *to);
    vector("v1", value.v1);
    vector("v2", value.v2);
  }
  void board(TextureMapping& value) {
    int dimension = 2;
    given.whole("dimension", dimension, 2, 3);
    mapping(value);
    if (dimension == 3) value.kind = TextureMapping::Kind::solid;
  }
  void place(glm::dmat4& value) { value = glm::inverse(world()); }
  void direction(const char* name, glm::dvec3& value) {
    vector(name, value);
    value = glm::dvec3(world() * glm::dvec4(value, 0));
    if (!(glm::length(value) > 0)) given.wrong(name, "a direction");
    value = glm::normalize(value);
  }
  void count(const char* name, int& value, int low, int high) { given.whole(name, value, low, high); }
  void vector(const char* name, glm::dvec3& value) {
    if (const auto* three = given.get<std::array<double, 3>>(name, "three numbers"))
      value = glm::dvec3((*three)[0], (*three)[1], (*three)[2]);
  }
  glm::dmat4 world() const {
    glm::dmat4 out(1);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c)
        out[c][r] = texture.world_from_texture[4 * static_cast<std::size_t>(r) + static_cast<std::size_t>(c)];
    return out;
  }
};

[[noreturn]] void unknown(const char* what, const std::string& type, const std::vector<std::string>& known) {
  throw InputError(fmt::format("there is no {} '{}'; the nearest is '{}'", what, type, nearest_name(type, known)));
}

caplet::Material taken(const NamedMaterial& from, Given& given) {
  caplet::Material out;
  bool known = false;
#define MATERIAL_MODEL(name, Type)                           \
  if (from.type == #name) {                                  \
    Type model;                                              \
    Type::fields(model, MaterialTaker{given, out.textures}); \
    out.model = std::move(model);                            \
    known = true;                                            \
  }
#include "scene/materials.def"
  if (!known) unknown("material", from.type, material_types());
  return out;
}

caplet::Texture taken(const NamedTexture& from, Given& given, bool with_files) {
  caplet::Texture out;
  bool known = false;
#define TEXTURE_MODEL(name, Type)                               \
  if (from.type == #name) {                                     \
    Type model;                                                 \
    Type::fields(model, TextureTaker(given, from, with_files)); \
    out.model = std::move(model);                               \
    known = true;                                               \
  }
#include "scene/textures.def"
  if (!known) unknown("texture", from.type, texture_types());
  out.is_float = from.is_float;
  return out;
}

struct ToModel {
  caplet::Material operator()(const Diffuse& m) const { return of(DiffuseMaterial{to_model(m.reflectance)}); }
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
    Given given(m.type, m.parameters);
    caplet::Material out = taken(m, given);
    out.displacement = given.texture("displacement");
    out.normalmap = given.texture("normalmap");
    given.finish();
    return out;
  }
  static caplet::Material of(decltype(caplet::Material::model) model) {
    caplet::Material out;
    out.model = std::move(model);
    return out;
  }
};

}  // namespace

Rgb color_map(double part) {
  const glm::dvec3 color = viridis(part);
  return {color.x, color.y, color.z};
}

caplet::Spectrum to_model(const Spectrum& spectrum) {
  if (const auto* value = std::get_if<double>(&spectrum)) return ConstantSpectrum{*value};
  if (const auto* rgb = std::get_if<Rgb>(&spectrum)) return RgbSpectrum{{rgb->r, rgb->g, rgb->b}, ColorSpace::srgb};
  const std::string& name = std::get<std::string>(spectrum);
  if (const auto found = named_spectrum(name)) return *found;
  throw InputError(
      fmt::format("there is no spectrum '{}'; the nearest is '{}'", name, nearest_name(name, named_spectrum_names())));
}

caplet::Material to_model(const Material& material) { return std::visit(ToModel{}, material); }

caplet::Texture to_model(const NamedTexture& texture) {
  Given given(texture.type, texture.parameters);
  caplet::Texture out = taken(texture, given, true);
  given.finish();
  return out;
}

void check_bends(const caplet::Scene& scene, const caplet::Material& material) {
  const auto has = [&](std::uint32_t texture) { return texture < scene.textures.size(); };
  if (material.displacement && !(has(*material.displacement) && scene.textures[*material.displacement].is_float))
    throw InputError("the displacement is not a texture of floats");
  if (material.normalmap &&
      !(has(*material.normalmap) && std::holds_alternative<NormalmapTexture>(scene.textures[*material.normalmap].model)))
    throw InputError("the normalmap is not a texture of that type");
  if (material.displacement && material.normalmap) throw InputError("the material has both a displacement and a normalmap");
}

void check_textures(const caplet::Scene& scene) {
  caplet::Scene one = scene;
  one.materials.emplace_back();
  one.shapes.emplace_back().geometry = SphereShape{1};
  Diagnostics diagnostics;
  validate(one, diagnostics);
  diagnostics.finish();
}

std::vector<std::string> material_types() {
  return {
#define MATERIAL_MODEL(name, Type) #name,
#include "scene/materials.def"
  };
}

std::vector<std::string> texture_types() {
  return {
#define TEXTURE_MODEL(name, Type) #name,
#include "scene/textures.def"
  };
}

std::vector<std::string> material_parameters(const std::string& type) {
  const NamedMaterial material{type, {}};
  Given given(type, material.parameters);
  taken(material, given);
  return given.asked();
}

std::vector<std::string> texture_parameters(const std::string& type) {
  const NamedTexture texture{type, false, {}};
  Given given(type, texture.parameters);
  taken(texture, given, false);
  return given.asked();
}

}  // namespace caplet::v0
