// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Statements of programs: a directive, a type and parameters in place of pbrt's text. The readers
// of that text read them, so that types, defaults and checks are the same.
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

/// `type`: pbrt's type of the values; empty: the type that the statement asks for and the values
/// fit. A texture is named by its number in the scene ("7"), with the type "texture". One of the
/// three holds the values.
struct StatementParameter {
  std::string name, type;
  std::vector<double> numbers = {};
  std::vector<std::string> strings = {};
  std::vector<bool> bools = {};
};

/// directive: "Shape", "LightSource", "AreaLightSource", "MakeNamedMedium", "Camera", "Film",
/// "PixelFilter", "Sampler" or "Integrator"; type: "sphere", "spot", ...
struct ProgramStatement {
  std::string directive, type;
  std::vector<StatementParameter> parameters = {};
};

/// Lists the types of a directive that scene files accept.
std::vector<std::string> file_statement_types(const std::string& directive);
/// Lists those that a program may state.
std::vector<std::string> statement_types(const std::string& directive);

/// Returns the parameters of a statement of a known type. Throws InputError for an unknown type.
std::vector<schema::Parameter> statement_parameters(const std::string& directive,
                                                    const std::string& type);

// Each throws InputError for an unknown type and with all errors of the parameters. Materials and
// objects that parameters name are those of `scene`.
/// Makes a material without a name or bumps. The materials of a mix are named by their numbers
/// ("7").
Material material_of(const ProgramStatement& statement, const Scene& scene);
/// `pixels`: the image that replaces the file of an image texture; null: the statement names a
/// file.
Texture texture_of(const ProgramStatement& statement, bool is_float,
                   const glm::dmat4& world_from_texture,
                   const std::shared_ptr<const TextureImage>& pixels, const Scene& scene,
                   const ImageReader& images);
Shape shape_of(const ProgramStatement& statement, std::uint32_t material, const Scene& scene);
Light light_of(const ProgramStatement& statement, const glm::dmat4& world_from_light,
               const ImageReader& images);
AreaEmission emission_of(const ProgramStatement& statement, const ImageReader& images);
Medium medium_of(const ProgramStatement& statement, const std::string& name,
                 const glm::dmat4& world_from_medium);
/// Sets camera (`world_from_camera` is for it alone), film, filter, sampler or integrator as the
/// statement says.
void set_option(const ProgramStatement& statement, const glm::dmat4& world_from_camera,
                Scene& scene);

/// Makes a closed shape with a material of hair one-sided, as in scene files, unless the statement
/// sets it.
void make_hair_one_sided(const ProgramStatement& statement, const Scene& scene, Shape& shape);

}  // namespace caplet
