// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes a list of parameters from a model's `fields`.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/scene.h"
#include "schema/parameter.h"

namespace caplet::schema {

/// Returns the value as scene files write it.
std::string text_of(double value);
std::string text_of(const Spectrum& spectrum);

class Describe {
 public:
  explicit Describe(std::vector<Parameter>& out) : out_(out) {}

  void albedo(const Field& field, const Spectrum& value) {
    add(field, surface_spectrum, text_of(value));
  }
  void unbounded(const Field& field, const Spectrum& value) {
    add(field, surface_spectrum, text_of(value));
  }
  void index(const Field& field, const Spectrum& value) {
    add(field, {"float", "spectrum", "rgb", "blackbody"}, text_of(value)).above_low = true;
  }
  void emission(const Field& field, const Spectrum&) {
    add(field, light_spectrum, "the colour space's white");
  }
  void emission(const Field& field, const std::optional<Spectrum>&) {
    add(field, light_spectrum, "");
  }
  void emission(const Field& field, const std::optional<Spectrum>& radiance, double scale) {
    emission(field, radiance);
    add(radiance_scale_field, {"float"}, text_of(scale));
  }
  void operand(const Field& field, const TextureOperand& of) {
    add(field, {"float", "rgb", "spectrum", "blackbody", "texture"}, text_of(of.value));
  }
  void factor(const Field& field, const TextureOperand& of) {
    add(field, {"float", "texture"}, text_of(of.value));
  }
  void number(const Field& field, double value) {
    add(field,
        textured_ ? std::vector<std::string>{"float", "texture"}
                  : std::vector<std::string>{"float"},
        text_of(value));
  }
  void integer(const Field& field, int value) { add(field, {"integer"}, fmt::format("{}", value)); }
  void seed(const Field& field, std::uint32_t value) {
    add(field, {"integer"}, fmt::format("{}", value));
  }
  void flag(const Field& field, bool value) { add(field, {"bool"}, value ? "true" : "false"); }
  template <class Names>
  void choice(const Field& field, int value, const Names& names) {
    add(field, {"string"}, names[static_cast<std::size_t>(value)]).choices = {names.begin(),
                                                                              names.end()};
  }
  void field_of_view(double) {
    add(fov_field, {"float"}, "90");
    add(half_fov_field, {"float"}, "-1");
  }
  void lens(const Field& field, const std::shared_ptr<const Lens>& of) { image(field, of); }
  void aperture(const Field& field, const std::shared_ptr<const ApertureMask>& of) {
    image(field, of);
  }
  void position(const Field& field, const glm::dvec3& value) {
    add(field, {"point3"}, text_of(value));
  }
  void vector(const Field& field, const glm::dvec3& value) {
    add(field, {"vector3"}, text_of(value));
  }
  void direction(const Field& field, const glm::dvec3& value) { vector(field, value); }
  void direction(const Field& from, const Field& to, const glm::dvec3&) {
    if (!has(from.name)) position(from, glm::dvec3(0));
    position(to, glm::dvec3(0, 0, 1));
  }
  template <class Image>
  void image(const Field& field, const std::shared_ptr<Image>&) {
    add(field, {"string"}, "");
    if constexpr (std::is_same_v<Image, const TextureImage>)
      add({"encoding", "\"sRGB\", \"linear\" or \"gamma X\""}, {"string"}, "sRGB");
  }
  template <class Image>
  void directions(const Field& field, const std::shared_ptr<Image>& of) {
    image(field, of);
  }
  template <class Image>
  void vectors(const Field& field, const std::shared_ptr<Image>& of) {
    image(field, of);
  }
  void profile(const Field& field, const std::shared_ptr<const IesProfile>& of) {
    image(field, of);
  }
  void parts(const Field& field, const std::array<std::uint32_t, 2>&) {
    add(field, {"string"}, "");
  }
  void roughness(const RoughnessFields& fields, double, double) {
    for (const Field& alpha : {fields.alpha_u, fields.alpha_v})
      add(alpha, {"float", "texture"}, "").excludes = {fields.roughness, fields.uroughness,
                                                       fields.vroughness};
    add({fields.roughness, "roughness along both directions", 0}, {"float", "texture"}, "0");
    add({fields.uroughness, "roughness along dp/du", 0}, {"float", "texture"}, "that of both");
    add({fields.vroughness, "roughness along dp/dv", 0}, {"float", "texture"}, "that of both");
    if (!has("remaproughness"))
      add({"remaproughness", "GGX's alpha is the square root of the roughness"}, {"bool"}, "true");
  }
  void metal(const MetalFields& fields, const Spectrum& eta, const Spectrum& k,
             const std::optional<Spectrum>&) {
    unbounded(fields.eta, eta);
    unbounded(fields.k, k);
    add(fields.reflectance, surface_spectrum, "").excludes = {fields.eta.name, fields.k.name};
  }
  void pigment(const PigmentFields& fields, const Spectrum&, const std::optional<Spectrum>&) {
    add(fields.sigma_a, surface_spectrum, "").excludes = {"reflectance", "color", "eumelanin",
                                                          "pheomelanin"};
    add(fields.reflectance, surface_spectrum, "").excludes = {"sigma_a", "eumelanin",
                                                              "pheomelanin"};
    add({"color", "the same as reflectance", 0, 1}, surface_spectrum, "").excludes = {
        "sigma_a", "eumelanin", "pheomelanin"};
    add({"eumelanin", "concentration of the brown pigment", 0}, {"float", "texture"},
        text_of(HairMaterial::eumelanin));
    add({"pheomelanin", "concentration of the red pigment", 0}, {"float", "texture"}, "0");
  }
  void mapping(const TextureMapping& of) {
    choice(TextureMapping::kind_field, static_cast<int>(of.kind), texture_mapping_names);
    for (const auto kind : {TextureMapping::Kind::uv, TextureMapping::Kind::planar}) {
      TextureMapping one;
      one.kind = kind;
      TextureMapping::fields(one, New{*this});
    }
  }
  void board(const TextureMapping& of) {
    integer(TextureMapping::dimension_field, 2);
    mapping(of);
  }
  template <class... Values>
  void place(const Values&...) {}
  void only(bool) {}
  void colors() {}
  void cone(double, double) {
    add(SpotLight::cone_field, {"float"}, "30").above_low = true;
    add(SpotLight::delta_field, {"float"}, "5");
  }
  void sky(const InfiniteLight&) {
    const auto one_of = [&](const Field& field, std::vector<std::string> types,
                            const char* fallback) {
      Parameter& out = add(field, std::move(types), fallback);
      for (const Field* other : {&InfiniteLight::radiance_field, &InfiniteLight::image_field,
                                 &InfiniteLight::preset_field})
        if (other->name != field.name) out.excludes.emplace_back(other->name);
    };
    one_of(InfiniteLight::radiance_field, light_spectrum, "the colour space's white");
    one_of(InfiniteLight::image_field, {"string"}, "");
    one_of(InfiniteLight::preset_field, {"string"}, "");
    add(InfiniteLight::portal_field, {"point3"}, "");
  }
  template <class Preset>
  void scattering(const ScatteringProperties&, Preset&& preset) {
    add(scattering_preset_field, {"string"}, "").excludes = {"sigma_a", "sigma_s"};
    const ScatteringProperties of = preset();
    ScatteringProperties::fields(of, Coefficients{*this});
  }
  void asymmetry(double g) { add(asymmetry_field, {"float"}, text_of(g)); }
  void bounds(const MediumBounds& of) {
    position({"p0", "a corner of the medium's box"}, of.p0);
    position({"p1", "the opposite corner"}, of.p1);
  }
  void counts(const GridCounts& of) {
    for (std::size_t k = 0; k < 3; ++k)
      integer({grid_count_names[k], "cells along this side", 1}, of[k]);
  }
  void grid(const Field& field, const FloatGrid&, const GridCounts&, bool) {
    add(field, {"float"}, "");
  }
  void grid(const Field& field, const ColorGrid&, const GridCounts&) { add(field, {"rgb"}, ""); }
  void volume(const SparseGridPointer&, const SparseGridPointer&, const glm::dmat4&) {
    add({"filename", "a NanoVDB file with the grids density and, if it glows, temperature"},
        {"string"}, "");
  }
  void heat(const std::optional<Spectrum>&, const FloatGrid&) {}
  void any_of(const ColorGrid&, const ColorGrid&, const ColorGrid&) {}

  /// Allows textures for the numbers and spectra that follow.
  void may_be_textures() { textured_ = true; }

  Parameter& add(const Field& field, std::vector<std::string> types, std::string fallback) {
    Parameter& out = out_.emplace_back(Parameter{field.name, field.doc});
    out.types = std::move(types);
    out.fallback = std::move(fallback);
    out.low = field.low;
    out.high = field.high;
    out.above_low = field.above_low;
    out.unit = field.unit;
    return out;
  }
  bool has(std::string_view name) const {
    for (const Parameter& one : out_)
      if (one.name == name) return true;
    return false;
  }

 private:
  /// Adds only fields that an earlier kind does not have.
  struct New {
    Describe& to;
    void number(const Field& field, double value) const {
      if (!to.has(field.name)) to.number(field, value);
    }
    void vector(const Field& field, const glm::dvec3& value) const {
      if (!to.has(field.name)) to.vector(field, value);
    }
  };
  /// Coefficients of media cannot be textures.
  struct Coefficients {
    Describe& to;
    void unbounded(const Field& field, const Spectrum& value) const {
      to.add(field, medium_spectrum, text_of(value));
    }
    void number(const Field& field, double value) const { to.number(field, value); }
    void asymmetry(double g) const { to.asymmetry(g); }
  };

  static std::string text_of(const glm::dvec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }
  static std::string text_of(double value) { return schema::text_of(value); }
  static std::string text_of(const Spectrum& value) { return schema::text_of(value); }

  static inline const std::vector<std::string> surface_spectrum = {"rgb", "spectrum", "blackbody",
                                                                   "float", "texture"};
  static inline const std::vector<std::string> light_spectrum = {"rgb", "spectrum", "blackbody",
                                                                 "float"};
  static inline const std::vector<std::string> medium_spectrum = light_spectrum;

  std::vector<Parameter>& out_;
  bool textured_ = false;
};

}  // namespace caplet::schema
