// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What pbrt's text says by a directive, a type and parameters, said by a program: read by the readers of that text, so that what
// there is, its defaults and its checks are the same.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/image_reader.h"
#include "scene/scene.h"
#include "schema/schema.h"

namespace caplet {

/// `type`: pbrt's, which the values are then of; empty: one that the statement asks for and the values suit. A texture is named
/// by its number in the scene ("7"), of type "texture". One of the three holds the values.
struct StatementParameter {
  std::string name, type;
  std::vector<double> numbers = {};
  std::vector<std::string> strings = {};
  std::vector<bool> bools = {};
};

/// directive: "Shape", "LightSource", "AreaLightSource", "MakeNamedMedium", "Camera", "Film", "PixelFilter", "Sampler" or
/// "Integrator"; type: "sphere", "spot", ...
struct ProgramStatement {
  std::string directive, type;
  std::vector<StatementParameter> parameters = {};
};

/// The types of a directive that scene files may have.
std::vector<std::string> file_statement_types(const std::string& directive);
/// Those that a program may state.
std::vector<std::string> statement_types(const std::string& directive);

/// What a statement of a known type may say. Throws InputError for an unknown type.
std::vector<schema::Parameter> statement_parameters(const std::string& directive, const std::string& type);

// Each throws InputError for an unknown type and with everything that is wrong with the parameters. Materials and objects that
// parameters name are those of `scene`.
/// A material without a name or bumps: the materials of a mix
/// are named by their numbers ("7").
Material material_of(const ProgramStatement& statement, const Scene& scene);
/// `pixels`: the image that a texture of images has in place of a file; null: it names one.
Texture texture_of(const ProgramStatement& statement, bool is_float, const glm::dmat4& world_from_texture,
                   const std::shared_ptr<const TextureImage>& pixels, const Scene& scene, const ImageReader& images);
Shape shape_of(const ProgramStatement& statement, std::uint32_t material, const Scene& scene);
Light light_of(const ProgramStatement& statement, const glm::dmat4& world_from_light, const ImageReader& images);
AreaEmission emission_of(const ProgramStatement& statement, const ImageReader& images);
Medium medium_of(const ProgramStatement& statement, const std::string& name, const glm::dmat4& world_from_medium);
/// Camera (`world_from_camera`: for it alone), film, filter, sampler and integrator become what the statement says.
void set_option(const ProgramStatement& statement, const glm::dmat4& world_from_camera, Scene& scene);

/// As scene files do: a closed shape with a material of hair is one-sided, unless the statement says.
void make_hair_one_sided(const ProgramStatement& statement, const Scene& scene, Shape& shape);

}  // namespace caplet
