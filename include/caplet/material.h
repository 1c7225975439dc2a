// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What surfaces are made of: materials and textures of a scene.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "caplet/export.h"

CAPLET_BEGIN

/// Linear sRGB, from 0 up.
struct Rgb {
  double r = 0, g = 0, b = 0;
};

/// The colours that tell numbers (viridis): perceptually even from dark blue at 0 to yellow at 1; beyond, those of the ends.
CAPLET_API Rgb color_map(double part);

/// The same at all wavelengths, a colour, or a name that pbrt scenes may use: "metal-Au-eta", "glass-BK7", "stdillum-D65".
using Spectrum = std::variant<double, Rgb, std::string>;

struct Diffuse {
  Spectrum reflectance = 0.5;
};

/// Roughness is GGX's alpha along dp/du and dp/dv; 0: perfectly smooth.
struct Conductor {
  Spectrum eta = std::string("metal-Cu-eta"), k = std::string("metal-Cu-k");
  std::optional<Spectrum> reflectance = {};  // at normal incidence, 0 to 1; replaces eta and k
  double roughness_u = 0, roughness_v = 0;
};
struct Dielectric {
  Spectrum eta = 1.5;
  double roughness_u = 0, roughness_v = 0;
};

/// A texture of a scene, by the number that Scene::add_texture gave it.
struct TextureNumber {
  std::uint32_t number = 0;
};

/// Light of a black body.
struct Blackbody {
  double kelvin = 6500;
};

/// An image of a texture, row by row from the top: `channels` numbers a pixel, 1 of grey, 3 of linear sRGB, 4 with alpha, which
/// is not multiplied in.
struct Pixels {
  int width = 0, height = 0, channels = 3;
  std::vector<float> values;
};

/// What a parameter may be: a number, a colour, a name (of a spectrum, a choice or a file), a switch, a texture, a vector, the
/// numbers of two materials; of shapes, lights and media also a black body, many numbers (points one behind the other), or many
/// names; of textures an image.
using Parameter = std::variant<double, Rgb, std::string, bool, TextureNumber, std::array<double, 3>, std::array<std::uint32_t, 2>,
                               Blackbody, std::vector<double>, std::vector<std::string>, std::shared_ptr<const Pixels>>;
using Parameters = std::map<std::string, Parameter>;

/// Any material by the name that scene files have for it: "coateddiffuse", "hair", "principled". Parameters are those that
/// material_parameters tells, and "displacement" and "normalmap", textures that bend the normals; those that are left out have
/// the values of docs/formats/pbrt.md.
struct NamedMaterial {
  std::string type;
  Parameters parameters = {};
};

/// The same of a texture, of floats or of spectra. An imagemap has "filename" and "encoding" ("sRGB", "linear" or "gamma 2.2"),
/// or "pixels" in place of both; a scene with such cannot be written as text. A mapping "mapping" and its numbers.
/// world_from_texture: three rows of four numbers, of textures that go by points of space.
struct NamedTexture {
  std::string type;
  bool is_float = false;
  Parameters parameters = {};
  std::array<double, 12> world_from_texture = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

using Material = std::variant<Diffuse, Conductor, Dielectric, NamedMaterial>;

/// What NamedMaterial and NamedTexture may be.
CAPLET_API std::vector<std::string> material_types();
CAPLET_API std::vector<std::string> texture_types();
/// The names of a type's parameters. Roughnesses "alpha_u" and "alpha_v" are GGX's, along dp/du and dp/dv. Throws InputError for
/// an unknown type.
CAPLET_API std::vector<std::string> material_parameters(const std::string& type);
CAPLET_API std::vector<std::string> texture_parameters(const std::string& type);

CAPLET_END
