// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The statements before WorldBegin: camera, film, filter, sampler, integrator, options.
#pragma once

#include <optional>
#include <string>

#include "import/detail/pbrt/parameters.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// `images` reads what the camera and the film name; without it such a name is an error.
void set_camera(const std::string& type, Parameters& parameters,
                const glm::dmat4& world_from_camera, Scene& scene,
                const ImageReader* images = nullptr);
void set_film(const std::string& type, Parameters& parameters, ColorSpace space, Scene& scene,
              const ImageReader* images = nullptr);
void set_filter(const std::string& type, Parameters& parameters, Scene& scene);
/// Returns the sampler's own seed, if it has one.
std::optional<std::uint32_t> set_sampler(const std::string& type, Parameters& parameters,
                                         Scene& scene);
void set_integrator(const std::string& type, Parameters& parameters, Scene& scene);
/// Checks the parameters of an accelerator, which have no effect because accelerators do not change
/// the picture.
void check_accelerator(const std::string& type, Parameters& parameters);

/// Handles one Option statement of `file`; `value` is the token after the name. Returns the seed if
/// it sets one.
std::optional<std::uint32_t> set_option(const std::string& name, const Token& value,
                                        const std::string& file, Diagnostics& diagnostics);

}  // namespace caplet::pbrt
