// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What pbrt's text says by a directive, a type and parameters, said by a program: read by the readers of that text, so that what
// there is, its defaults and its checks are the same.
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/image_reader.h"
#include "scene/scene.h"

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

/// The types of a directive that can be rendered.
std::vector<std::string> statement_types(const std::string& directive);

struct KnownStatementParameter {
  std::string name;
  std::vector<std::string> types;
};
/// What a statement of an accepted type asks for, whatever of it is given.
std::vector<KnownStatementParameter> statement_parameters(const std::string& directive, const std::string& type);

// Each throws InputError for an unknown type and with everything that is wrong with the parameters. Materials and objects that
// parameters name are those of `scene`.
Shape shape_of(const ProgramStatement& statement, std::uint32_t material, const Scene& scene);
Light light_of(const ProgramStatement& statement, const glm::dmat4& world_from_light, const ImageReader& images);
AreaEmission emission_of(const ProgramStatement& statement, const ImageReader& images);
Medium medium_of(const ProgramStatement& statement, const std::string& name, const glm::dmat4& world_from_medium);
/// Camera (`world_from_camera`: for it alone), film, filter, sampler and integrator become what the statement says.
void set_option(const ProgramStatement& statement, const glm::dmat4& world_from_camera, Scene& scene);

/// As scene files do: a closed shape with a material of hair is one-sided, unless the statement says.
void make_hair_one_sided(const ProgramStatement& statement, const Scene& scene, Shape& shape);

}  // namespace caplet
