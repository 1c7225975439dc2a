// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "import/detail/pbrt/parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// Returns the image that a parameter names; each is read once. Returns null with the reason in
/// `problem` on failure.
using TextureImages = std::function<std::shared_ptr<const TextureImage>(
    Parameters& parameters, const char* name, const ImageEncoding& encoding, std::string& problem)>;

/// What textures take from their place in the scene.
struct TextureContext {
  glm::dmat4 world_from_texture, texture_from_world;
  TextureImages images;
  bool needs_files = true;  // an image without a "filename" is an error
};

/// Reads the "encoding" of an image.
ImageEncoding image_encoding(Parameters& parameters);

/// Evaluates a Texture statement (`kind` "float" or "spectrum", a known class). One that varies is
/// added to the scene.
TextureValue make_texture(const std::string& name, const std::string& kind,
                          const std::string& texture_class, Parameters& parameters,
                          const TextureTable& textures, const TextureContext& context,
                          Scene& scene);

/// Returns the index in the scene of the material that a mix names; no value, with the reason in
/// `problem`, on failure.
using PartFinder =
    std::function<std::optional<std::uint32_t>(const std::string& name, std::string& problem)>;

/// Makes the material of an accepted type. Textures of its remapped roughness are added to the
/// scene. `within` receives the medium inside a "subsurface".
Material make_material(const std::string& type, Parameters& parameters,
                       const TextureTable& textures, const TextureImages& images,
                       const PartFinder& part_named, Scene& scene, std::optional<Medium>& within);

/// Makes a material that a program states, as make_material does, but without bumps. Textures that
/// would have to be added to those of `textures` are errors.
Material make_program_material(const std::string& type, Parameters& parameters,
                               const TextureTable& textures, const PartFinder& part_named);
/// Makes a texture that a program states, including "normalmap"; no value when it has errors
/// (reported).
std::optional<Texture> make_program_texture(const std::string& texture_class, bool is_float,
                                            Parameters& parameters, const TextureTable& textures,
                                            const TextureContext& context);

}  // namespace caplet::pbrt
