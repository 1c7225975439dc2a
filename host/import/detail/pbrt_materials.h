// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "import/detail/pbrt_parameters.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// The image that a parameter names, read once however often it is named; null where it cannot be had, and `problem` says why.
using TextureImages = std::function<std::shared_ptr<const TextureImage>(Parameters& parameters, const char* name,
                                                                        const ImageEncoding& encoding, std::string& problem)>;

/// What textures take of where they stand.
struct TextureContext {
  glm::dmat4 world_from_texture, texture_from_world;
  TextureImages images;
  bool needs_files = true;  // an image without a "filename" is an error
};

/// The "encoding" of an image.
ImageEncoding image_encoding(Parameters& parameters);

/// What a Texture statement (`kind` "float" or "spectrum", a known class) comes to. One that varies is added to the scene.
TextureValue make_texture(const std::string& name, const std::string& kind, const std::string& texture_class,
                          Parameters& parameters, const TextureTable& textures, const TextureContext& context, Scene& scene);

/// The index in the scene of the material that a mix names; none with the reason in `problem`.
using PartFinder = std::function<std::optional<std::uint32_t>(const std::string& name, std::string& problem)>;

/// The material of an accepted type. The scene gets the textures that its remapped roughness takes. `within`: of a "subsurface",
/// the medium behind its boundary.
Material make_material(const std::string& type, Parameters& parameters, const TextureTable& textures, const TextureImages& images,
                       const PartFinder& part_named, Scene& scene, std::optional<Medium>& within);

/// A material that a program states: as make_material, but what bends its normals is for others to say, and textures that it
/// would need beside those of `textures` are errors.
Material make_program_material(const std::string& type, Parameters& parameters, const TextureTable& textures,
                               const PartFinder& part_named);
/// A texture that a program states, "normalmap" among them; none with what is wrong reported.
std::optional<Texture> make_program_texture(const std::string& texture_class, bool is_float, Parameters& parameters,
                                            const TextureTable& textures, const TextureContext& context);

}  // namespace caplet::pbrt
