// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "base/error.h"
#include "lower/color.h"
#include "lower/identity.h"
#include "scene/field.h"
#include "view/detail/form_fields.h"
#include "view/detail/scene_text.h"

namespace caplet::view {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t longest_text = 100;
constexpr std::size_t most_mix_depth = 8;

/// Returns the name of these samples in scene files; empty: none.
std::string name_of(const SampledSpectrum& spectrum) {
  static const auto named = [] {
    std::map<std::vector<double>, std::string> out;
    for (const std::string& name : named_spectrum_names())
      if (const auto known = named_spectrum(name))
        if (const auto* sampled = std::get_if<SampledSpectrum>(&*known))
          out.emplace(sampled->values, name);
    return out;
  }();
  const auto found = named.find(spectrum.values);
  return found == named.end() ? std::string() : found->second;
}

Json spectrum_text(const Spectrum& spectrum) {
  if (const auto* constant = std::get_if<ConstantSpectrum>(&spectrum))
    return {{"constant", constant->value}};
  if (const auto* rgb = std::get_if<RgbSpectrum>(&spectrum))
    return {{"rgb", to_json(rgb->rgb)},
            {"space", color_space_names[static_cast<std::size_t>(rgb->space)]}};
  if (const auto* black = std::get_if<BlackbodySpectrum>(&spectrum))
    return {{"blackbody", black->kelvin}};
  const auto& sampled = std::get<SampledSpectrum>(spectrum);
  const std::string name = name_of(sampled);
  return name.empty() ? Json{{"samples", sampled.values.size()}} : Json{{"name", name}};
}

/// Writes all fields.
class Writer final : public FormFields {
 public:
  Json fields = Json::array();

  void number(const std::string& name, double& value, double low, double high,
              Slot* slot) override {
    Json& field = add("number", name, value);
    if (std::isfinite(low)) field["low"] = low;
    if (std::isfinite(high)) field["high"] = high;
    say(field, slot);
  }
  void whole(const std::string& name, int& value, int low, int high) override {
    Json& field = add("whole", name, value);
    field["low"] = low;
    field["high"] = high;
  }
  void choice(const std::string& name, int& value,
              const std::vector<std::string>& options) override {
    add("choice", name, options[static_cast<std::size_t>(value)])["options"] = options;
  }
  void flag(const std::string& name, bool& value) override { add("flag", name, value); }
  void text(const std::string& name, std::string& value) override { add("text", name, value); }
  void spectrum(const std::string& name, Spectrum& value, double most, Slot* slot) override {
    Json& field = add("spectrum", name, spectrum_text(value));
    if (std::isfinite(most)) field["high"] = most;
    say(field, slot);
  }
  void option(const std::string& name, std::optional<double>& value) override {
    add("option", name, value ? Json(*value) : Json(nullptr));
  }
  void point(const std::string& name, glm::dvec3& value) override {
    add("point", name, to_json(value));
  }
  void direction(const std::string& name, glm::dvec3& value) override {
    add("direction", name, to_json(value));
  }
  void file(const std::string& name, const std::string& value) override {
    add("file", name, value);
  }
  void material(const std::string& name, std::uint32_t& value) override {
    add("material", name, value);
  }
  void texture(const std::string& name, Slot& slot) override {
    say(add("texture", name, nullptr), &slot);
  }

 private:
  Json& add(const char* type, const std::string& name, Json value) {
    fields.push_back({{"name", name}, {"type", type}, {"value", std::move(value)}});
    return fields.back();
  }
  static void say(Json& field, const Slot* slot) {
    if (!slot) return;
    field["texture"] = slot->texture ? Json(*slot->texture) : Json(nullptr);
    field["of_floats"] = slot->is_float;
    if (slot->before != SIZE_MAX) field["before"] = slot->before;
  }
};

/// Sets one field.
class Setter final : public FormFields {
 public:
  Setter(const Set& set, const Scene& scene) : set_(set), scene_(scene) {}

  void number(const std::string& name, double& value, double low, double high,
              Slot* slot) override {
    if (!is_it(name) || textured(slot)) return;
    const double to = get<double>("a number");
    if (!(to >= low && to <= high) || !std::isfinite(to)) refuse(must_lie_within(low, high));
    value = to;
  }
  void whole(const std::string& name, int& value, int low, int high) override {
    if (!is_it(name)) return;
    const double to = get<double>("a number");
    if (to != std::floor(to)) refuse("must be a whole number");
    if (!(to >= low && to <= high)) refuse(must_lie_within(low, high));
    value = static_cast<int>(to);
  }
  void choice(const std::string& name, int& value,
              const std::vector<std::string>& options) override {
    if (!is_it(name)) return;
    const std::string& to = get<std::string>("a text");
    const auto found = std::ranges::find(options, to);
    if (found == options.end())
      refuse(fmt::format("is \"{}\", and none of {}", to, fmt::join(options, ", ")));
    value = static_cast<int>(found - options.begin());
  }
  void flag(const std::string& name, bool& value) override {
    if (is_it(name)) value = get<bool>("true or false");
  }
  void text(const std::string& name, std::string& value) override {
    if (!is_it(name)) return;
    const std::string& to = get<std::string>("a text");
    if (to.size() > longest_text) refuse(fmt::format("is longer than {} bytes", longest_text));
    if (std::ranges::any_of(to, [](unsigned char c) { return c < 0x20 || c == 0x7f; }))
      refuse("has control characters");
    value = to;
  }
  void spectrum(const std::string& name, Spectrum& value, double most, Slot* slot) override {
    if (!is_it(name) || textured(slot)) return;
    const auto& to = get<Spectrum>("a spectrum");
    const auto within = [&](double x) { return std::isfinite(x) && x >= 0 && x <= most; };
    if (const auto* constant = std::get_if<ConstantSpectrum>(&to);
        constant && !within(constant->value))
      refuse(must_lie_within(0, most));
    if (const auto* rgb = std::get_if<RgbSpectrum>(&to);
        rgb && !(within(rgb->rgb.x) && within(rgb->rgb.y) && within(rgb->rgb.z)))
      refuse(must_lie_within(0, most));
    value = to;
  }
  void option(const std::string& name, std::optional<double>& value) override {
    if (!is_it(name)) return;
    if (std::holds_alternative<std::monostate>(set_.to)) return value.reset();
    const double to = get<double>("a number");
    if (!(to > 0 && std::isfinite(to))) refuse("must be above 0");
    value = to;
  }
  void point(const std::string& name, glm::dvec3& value) override {
    if (is_it(name)) value = three();
  }
  void direction(const std::string& name, glm::dvec3& value) override {
    if (!is_it(name)) return;
    const glm::dvec3 to = three();
    if (!(glm::length(to) > 0)) refuse("has no length");
    value = glm::normalize(to);
  }
  void file(const std::string& name, const std::string&) override {
    if (is_it(name)) refuse("stays what the scene's file says");
  }
  void material(const std::string& name, std::uint32_t& value) override {
    if (!is_it(name)) return;
    const double to = get<double>("a number");
    if (!(to >= 0 && to < static_cast<double>(scene_.materials.size())) || to != std::floor(to))
      refuse(fmt::format("is no material, of {} counted from 0", scene_.materials.size()));
    value = static_cast<std::uint32_t>(to);
  }
  void texture(const std::string& name, Slot& slot) override {
    if (!is_it(name)) return;
    if (std::holds_alternative<std::monostate>(set_.to)) return slot.texture.reset();
    if (!textured(&slot)) refuse("is not a texture");
  }

  void finish() const {
    if (!found_) throw InputError(SourceLocation{set_.field}, "there is no such field");
  }

 private:
  bool is_it(const std::string& name) {
    if (found_ || name != set_.field) return false;
    return found_ = true;
  }
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(SourceLocation{set_.field}, why);
  }
  template <class T>
  const T& get(const char* what) const {
    const T* value = std::get_if<T>(&set_.to);
    if (!value) refuse(fmt::format("is not {}", what));
    return *value;
  }
  glm::dvec3 three() const {
    const auto& to = get<std::vector<double>>("a list of three numbers");
    if (to.size() != 3) refuse("is not a list of three numbers");
    return {to[0], to[1], to[2]};
  }
  /// Sets the texture of a slot and returns true; without a texture it clears the slot.
  bool textured(Slot* slot) const {
    const auto* choice = std::get_if<TextureChoice>(&set_.to);
    if (!choice) {
      if (slot) slot->texture.reset();
      return false;
    }
    if (!slot) refuse("may not be a texture");
    if (choice->texture >= std::min(scene_.textures.size(), slot->before))
      refuse("is no texture that there is, or one that comes later");
    if (scene_.textures[choice->texture].is_float != slot->is_float)
      refuse(fmt::format("is not a texture of {}", slot->is_float ? "floats" : "spectra"));
    slot->texture = choice->texture;
    return true;
  }

  const Set& set_;
  const Scene& scene_;
  bool found_ = false;
};

/// Finds a colour that represents a material, in linear sRGB: that of its first spectrum.
struct Swatch : IgnoresFields {
  explicit Swatch(const Scene& of, std::size_t within = 0) : scene(of), depth(within) {}
  const Scene& scene;
  std::size_t depth;
  std::optional<glm::dvec3> color = {};

  void albedo(const Field&, const Spectrum& value) { take(of(value)); }
  void parts(const Field&, const std::array<std::uint32_t, 2>& materials) {
    glm::dvec3 sum(0);
    for (const std::uint32_t part : materials) {
      Swatch one(scene, depth + 1);
      if (depth < most_mix_depth && part < scene.materials.size())
        std::visit([&](const auto& m) { m.fields(m, one); }, scene.materials[part].model);
      sum += 0.5 * one.color.value_or(clear);
    }
    take(sum);
  }
  void pigment(const PigmentFields&, const Spectrum& sigma_a,
               const std::optional<Spectrum>& reflectance) {
    if (reflectance) return take(of(*reflectance));
    const glm::dvec3 absorbed = of(sigma_a);
    take({std::exp(-2 * absorbed.x), std::exp(-2 * absorbed.y), std::exp(-2 * absorbed.z)});
  }
  /// The colour is the reflectance at normal incidence.
  void metal(const MetalFields&, const Spectrum& eta, const Spectrum& k,
             const std::optional<Spectrum>& reflectance) {
    if (reflectance) return take(of(*reflectance));
    const glm::dvec3 n = of(eta), e = of(k);
    glm::dvec3 out;
    for (int i = 0; i < 3; ++i)
      out[i] = ((n[i] - 1) * (n[i] - 1) + e[i] * e[i]) / ((n[i] + 1) * (n[i] + 1) + e[i] * e[i]);
    take(out);
  }

  static constexpr glm::dvec3 clear{0.8, 0.9, 0.95};

 private:
  void take(const glm::dvec3& value) {
    if (!color) color = value;
  }
  static glm::dvec3 of(const Spectrum& value) {
    if (const auto* rgb = std::get_if<RgbSpectrum>(&value)) return rgb->rgb;
    return {evaluate(value, 610), evaluate(value, 545), evaluate(value, 460)};
  }
};

Json swatch(const Scene& scene, const Material& material) {
  Swatch out(scene);
  std::visit([&](const auto& m) { m.fields(m, out); }, material.model);
  return to_json(glm::clamp(out.color.value_or(Swatch::clear), 0.0, 1.0));
}

template <class Model, class... More>
Json written(Model model, const More&... more) {
  Writer writer;
  visit_form(writer, model, more...);
  return std::move(writer.fields);
}

template <class Model, class... More>
void set_one(Model& model, const Scene& scene, const Set& set, const More&... more) {
  Setter setter(set, scene);
  Model changed = model;
  visit_form(setter, changed, more...);
  setter.finish();
  model = std::move(changed);
}

}  // namespace

Json form_text(const Scene& scene, const View& view, const FormSubject& part) {
  using Kind = FormSubject::Kind;
  const auto has = [&](const auto& of) { return part.number < of.size(); };
  Json out{{"of", form_subject_names[static_cast<std::size_t>(part.kind)]}, {"part", part.number}};
  if (part.kind == Kind::material) {
    if (!has(scene.materials)) return nullptr;
    out["fields"] = written(scene.materials[part.number], part.number, scene);
  } else if (part.kind == Kind::texture) {
    if (!has(scene.textures)) return nullptr;
    out["fields"] = written(scene.textures[part.number], part.number);
  } else if (part.kind == Kind::light) {
    if (!has(scene.lights)) return nullptr;
    out["fields"] = written(scene.lights[part.number]);
  } else if (part.kind == Kind::emission) {
    if (!has(scene.shapes)) return nullptr;
    out["fields"] = written(scene.shapes[part.number].emission);
  } else if (part.kind == Kind::shape) {
    if (!has(scene.shapes)) return nullptr;
    const Shape& shape = scene.shapes[part.number];
    out["title"] = geometry_name(shape);
    // Only the fields are copied, because other data may be large.
    Shape one;
    one.name = shape.name;
    one.one_sided = shape.one_sided;
    one.geometry = CapsulesShape{};
    if (primitive_count(shape) == 1) one.geometry = shape.geometry;
    out["fields"] = written(one);
  } else {
    out["fields"] = written(view, part.kind);
  }
  return out;
}

Json lists_text() {
  Json out;
  for (const FormSubject::Kind kind : {FormSubject::Kind::material, FormSubject::Kind::texture,
                                       FormSubject::Kind::light, FormSubject::Kind::shape})
    out[form_subject_names[static_cast<std::size_t>(kind)]] = new_kinds(kind);
  out["spectra"] = named_spectrum_names();
  return out;
}

Json parts_text(const Scene& scene) {
  Json materials = Json::array(), textures = Json::array(), lights = Json::array();
  for (std::uint32_t i = 0; i < scene.materials.size() && i < most_named; ++i)
    materials.push_back(
        {{"name", material_label(scene, i)}, {"color", swatch(scene, scene.materials[i])}});
  for (std::size_t i = 0; i < scene.textures.size() && i < most_named; ++i)
    textures.push_back(
        {{"name", scene.textures[i].name}, {"of_floats", scene.textures[i].is_float}});
  static constexpr const char* kinds[] = {
#define LIGHT_MODEL(row, Type) #row,
#include "scene/lights.def"
  };
  for (std::size_t i = 0; i < scene.lights.size() && i < most_named; ++i)
    lights.push_back(kinds[scene.lights[i].model.index()]);
  return {{"materials", std::move(materials)},
          {"textures", std::move(textures)},
          {"lights", std::move(lights)}};
}

void set_field(Material& material, const Scene& scene, const Set& set) {
  set_one(material, scene, set, set.part.number, scene);
}
void set_field(Texture& texture, const Scene& scene, const Set& set) {
  set_one(texture, scene, set, set.part.number);
}
void set_field(Light& light, const Scene& scene, const Set& set) { set_one(light, scene, set); }
void set_field(std::optional<AreaEmission>& emission, const Scene& scene, const Set& set) {
  set_one(emission, scene, set);
}
void set_field(Shape& shape, const Scene& scene, const Set& set) { set_one(shape, scene, set); }
void set_field(View& view, const Scene& scene, const Set& set) {
  set_one(view, scene, set, set.part.kind);
}

}  // namespace caplet::view
