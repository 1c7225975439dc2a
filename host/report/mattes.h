// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The attributes of a picture tell programs which mattes it has.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "film/layers.h"
#include "scene/scene.h"

namespace caplet::report {

/// Returns the attributes by which programs find the mattes among the layers, and the names in them
/// (Cryptomatte 1.2.0): of each a name, a hash, a conversion and a manifest.
std::map<std::string, std::string> matte_attributes(const Scene& scene, Layers layers);

/// Returns the names in a matte, in order, of the attributes of a picture that has it; none where
/// it does not.
std::vector<std::string> names_in_matte(const std::map<std::string, std::string>& attributes,
                                        Layer matte);

/// Leaves out the attributes of mattes that are not among the layers.
void drop_other_mattes(std::map<std::string, std::string>& attributes, Layers layers);

}  // namespace caplet::report
