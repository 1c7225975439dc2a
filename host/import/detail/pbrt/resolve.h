// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// These run at the end of a scene, when all statements are known: they decide which materials and
// media are used, and make interfaces, hair, subsurfaces and instances.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "import/detail/pbrt/draft.h"

namespace caplet::pbrt {

/// Resolves all references of the draft. Errors are reported.
void resolve(Draft& draft);

/// Replaces names by indices of the scene's media. Only media that are used are added.
void resolve_media(Draft& draft);
/// Makes the materials and assigns them to shapes.
void resolve_materials(Draft& draft);

/// Stands for an interface in place of a material's index.
inline constexpr std::uint32_t interface_material = 0xffffffffu;

/// For a mix with an interface: the probability of the other material, which becomes an alpha.
struct PartlyThere {
  TextureOperand amount;
  bool inverted;    // 1 - amount
  bool subsurface;  // the other material contains a medium
};

/// The materials of the statements.
struct MadeMaterials {
  std::vector<std::uint32_t> indices;  // in the scene, or interface_material; by statement
  std::map<std::uint32_t, Medium>
      media_within;  // media behind boundaries, by the boundary's index in the scene
  std::map<std::size_t, PartlyThere> partly_there;  // by statement
};

/// Makes the materials of all statements. One that cannot be rendered is an error if a shape has
/// it, otherwise a warning.
MadeMaterials make_materials(Draft& draft);

/// Calls `visit` with every material index of a shape.
void each_material(Shape& shape, const std::function<void(std::uint32_t&)>& visit);
void each_material(Draft& draft, const std::function<void(std::uint32_t&)>& visit);
/// Calls `visit` with the material of every visible surface.
void each_surface(const Shape& shape, const std::function<void(std::uint32_t)>& visit);

/// A mix with an interface lets rays pass at random: the probability becomes the shape's alpha.
/// `partly_there` is by statement.
void take_out_interfaces(Draft& draft, const std::map<std::size_t, PartlyThere>& partly_there);
/// Removes shapes whose material is an interface and that do not separate media: they are
/// invisible.
void drop_interfaces(Draft& draft, const std::vector<std::uint32_t>& index_of_use);

/// Returns whether the shape is closed and of hair, which is one-sided: its scattering function
/// includes the path through the fibre, so rays must not hit the far side.
bool is_closed_hair(Shape& shape, const std::vector<Material>& materials);

/// Fills shapes that have a subsurface material with its medium.
void fill_subsurfaces(Draft& draft, const std::map<std::uint32_t, Medium>& media_within);

}  // namespace caplet::pbrt
