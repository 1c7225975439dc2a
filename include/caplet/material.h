// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials and textures of a scene.
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

/// A colour in linear sRGB, from 0 up.
struct Rgb {
  double r = 0, g = 0, b = 0;
};

/// Returns a colour of viridis: perceptually uniform from dark blue at 0 to yellow at 1; other
/// values give the end colours.
CAPLET_API Rgb color_map(double part);

/// A constant, a colour, or one of pbrt's names of spectra: "metal-Au-eta", "glass-BK7",
/// "stdillum-D65".
using Spectrum = std::variant<double, Rgb, std::string>;

struct Diffuse {
  Spectrum reflectance = 0.5;
};

/// Roughness is GGX's alpha along dp/du and dp/dv; 0 is perfectly smooth.
struct Conductor {
  Spectrum eta = std::string("metal-Cu-eta"), k = std::string("metal-Cu-k");
  std::optional<Spectrum> reflectance = {};  // at normal incidence, 0 to 1; replaces eta and k
  double roughness_u = 0, roughness_v = 0;
};
struct Dielectric {
  Spectrum eta = 1.5;
  double roughness_u = 0, roughness_v = 0;
};

/// A texture of a scene, by the number that Scene::add_texture returned.
struct TextureNumber {
  std::uint32_t number = 0;
};

/// The light of a black body.
struct Blackbody {
  double kelvin = 6500;
};

/// An image for a texture, row by row from the top: `channels` numbers per pixel, 1: grey, 3:
/// linear sRGB, 4: with alpha, which is not premultiplied.
struct Pixels {
  int width = 0, height = 0, channels = 3;
  std::vector<float> values;
};

/// The value of a parameter: a number, a colour, a name (of a spectrum, a choice or a file), a
/// switch, a texture, a vector, or the numbers of two materials; for shapes, lights and media also
/// a black body, a list of numbers (points are concatenated) or of names; for textures an image.
using Parameter = std::variant<double, Rgb, std::string, bool, TextureNumber, std::array<double, 3>,
                               std::array<std::uint32_t, 2>, Blackbody, std::vector<double>,
                               std::vector<std::string>, std::shared_ptr<const Pixels>>;
using Parameters = std::map<std::string, Parameter>;

/// Any material by its name in scene files: "coateddiffuse", "hair", "principled". Its parameters
/// are those of material_parameters, and "displacement" and "normalmap", textures that change the
/// normals; parameters that are not given have the defaults of docs/formats/pbrt.md.
struct NamedMaterial {
  std::string type;
  Parameters parameters = {};
};

/// Any texture by its name in scene files, of floats or of spectra. An imagemap has "filename" and
/// "encoding" ("sRGB", "linear" or "gamma 2.2"), or "pixels" in place of both (such a scene cannot
/// be written as text). "mapping" and its numbers set the mapping. world_from_texture: three rows
/// of four numbers, for textures that are looked up by points in space.
struct NamedTexture {
  std::string type;
  bool is_float = false;
  Parameters parameters = {};
  std::array<double, 12> world_from_texture = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

using Material = std::variant<Diffuse, Conductor, Dielectric, NamedMaterial>;

/// List the types of NamedMaterial and NamedTexture.
CAPLET_API std::vector<std::string> material_types();
CAPLET_API std::vector<std::string> texture_types();
/// Returns the names of a type's parameters. Roughnesses "alpha_u" and "alpha_v" are GGX's, along
/// dp/du and dp/dv. Throws InputError for an unknown type.
CAPLET_API std::vector<std::string> material_parameters(const std::string& type);
CAPLET_API std::vector<std::string> texture_parameters(const std::string& type);

CAPLET_END
