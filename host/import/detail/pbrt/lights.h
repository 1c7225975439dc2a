// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "import/detail/pbrt/parameters.h"
#include "scene/image_reader.h"
#include "scene/scene.h"

namespace caplet::pbrt {

/// The images and profiles that lights name; each is read once.
class LightFiles {
 public:
  explicit LightFiles(const ImageReader& reader) : reader_(reader) {}
  /// Reads the file that parameter `name` names. Reports errors, and then returns null.
  std::shared_ptr<const EnvironmentImage> image(Parameters& parameters, const char* name);
  std::shared_ptr<const IesProfile> profile(Parameters& parameters, const char* name);

 private:
  template <class File, class Read>
  std::shared_ptr<const File> file(Parameters& parameters, const char* name, Read&& read,
                                   std::map<std::string, std::shared_ptr<const File>>& files);

  const ImageReader& reader_;
  std::map<std::string, std::shared_ptr<const EnvironmentImage>> images_;
  std::map<std::string, std::shared_ptr<const IesProfile>> profiles_;
};

/// Makes the light of a LightSource statement of an accepted type; no value when it had errors
/// (reported).
std::optional<Light> make_light(const std::string& type, Parameters& parameters,
                                const glm::dmat4& world_from_light, LightFiles& files);

/// Makes the emission that an AreaLightSource statement gives to the shapes after it.
AreaEmission make_area_emission(Parameters& parameters, LightFiles& files);

}  // namespace caplet::pbrt
