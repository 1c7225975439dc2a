// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The names by which mattes tell the things in a picture: Cryptomatte 1.2.0 (Friedman and Jones
// 2015, "Fully automatic ID mattes with support for motion blur and transparency"; Psyop,
// "Cryptomatte specification", 2018).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.h"

namespace caplet {

/// Returns MurmurHash3 (x86, 32 bits, seed 0) of a name's bytes, with bit 23 turned over where its
/// bits would be those of a float that is zero, subnormal, infinite or not a number.
std::uint32_t matte_hash(std::string_view name);

/// Returns the name of a shape of the world, or of an object that instances place; without one,
/// its kind and its index, such as "capsule 12" and "object 3".
std::string matte_name(const Shape& shape, std::size_t index);
std::string matte_name(const Object& object, std::size_t index);
/// Returns the material's name; without one, "material" and its index.
std::string matte_name(const Material& material, std::size_t index);
/// Returns the name of the file that states the shape, without folders and extension; "scene" where
/// a program made it.
std::string matte_asset(const Shape& shape);

/// MatteNames are the names in a scene that its mattes have, each once, in order.
struct MatteNames {
  std::vector<std::string> objects, materials, assets;
};
MatteNames matte_names(const Scene& scene);

}  // namespace caplet
