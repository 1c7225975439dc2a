// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "base/spelling.h"
#include "import/detail/pbrt/lexer.h"
#include "import/detail/pbrt/v3.h"
#include "scene/scene.h"

namespace caplet::pbrt {

namespace {

std::vector<std::string> shape_types() {
  std::vector<std::string> types = {
#define SHAPE_TYPE(name, make) #name,
#define FILE_SHAPE_TYPE(name) #name,
#include "import/pbrt/shape_types.def"
#undef SHAPE_TYPE
  };
#define GEOMETRY(Type, name) \
  if (FieldedShape<Type>) types.emplace_back(#name);
#include "scene/geometries.def"
  std::ranges::sort(types);
  return types;
}

/// Sorts both lists, and removes accepted names from the refused ones.
NameTable table_of(std::string directive, std::vector<std::string> accepted,
                   std::vector<std::string> refused) {
  std::ranges::sort(accepted);
  std::erase_if(
      refused, [&](const std::string& name) { return std::ranges::binary_search(accepted, name); });
  return {std::move(directive), std::move(accepted), std::move(refused)};
}

/// What is rendered, and what is rendered as one of that.
template <class Names>
std::vector<std::string> with(const Names& names, std::initializer_list<const char*> aliases) {
  std::vector<std::string> out(names.begin(), names.end());
  out.insert(out.end(), aliases.begin(), aliases.end());
  return out;
}

}  // namespace

bool is_file_shape(std::string_view type) {
#define SHAPE_TYPE(name, make)
#define FILE_SHAPE_TYPE(name) \
  if (type == #name) return true;
#include "import/pbrt/shape_types.def"
#undef SHAPE_TYPE
  return false;
}

const std::vector<NameTable>& name_tables() {
  static const std::vector<NameTable> tables = {
      {"Accelerator", {"bvh", "kdtree"}, {}},
      {"ActiveTransform", {"All", "EndTime", "StartTime"}, {}},
      {"AreaLightSource", {"diffuse"}, {}},
      table_of("Camera", with(projection_names, {}), {}),
      table_of("ColorSpace", {color_space_names.begin(), color_space_names.end()}, {}),
      {"Film", {"gbuffer", "rgb", "spectral"}, {}},
      table_of(
          "Integrator",
          with(integrator_names, {"bdpt", "lightpath", "mlt", "simplevolpath", "sppm", "volpath"}),
          {"function"}),
      table_of("LightSource",
               {
#define LIGHT_MODEL(name, Type) #name,
#include "scene/lights.def"
               },
               {}),
      table_of("MakeNamedMedium",
               {
#define MEDIUM_MODEL(name, Type) #name,
#include "scene/media.def"
               },
               {"cloud", "homogeneous", "nanovdb", "rgbgrid", "uniformgrid"}),
      table_of("Material",
               {
                   "subsurface",
#define MATERIAL_MODEL(name, Type) #name,
#include "scene/materials.def"
               },
               {"coatedconductor", "coateddiffuse", "diffusetransmission", "hair", "interface",
                "measured", "mix", "subsurface", "thindielectric"}),
      {"Option",
       {"disablepixeljitter", "disabletexturefiltering", "disablewavelengthjitter",
        "displacementedgescale", "forcediffuse", "pixelstats", "rendercoordsys", "seed",
        "wavefront"},
       {"msereferenceimage", "msereferenceout"}},
      table_of("PixelFilter", {filter_names.begin(), filter_names.end()}, {}),
      table_of("Sampler", with(sampler_names, {"halton", "paddedsobol", "pmj02bn"}), {}),
      {"Shape", shape_types(), {}},
      table_of("Texture",
               {
                   "constant",
#define TEXTURE_MODEL(name, Type) #name,
#define OWN_TEXTURE_MODEL(name, Type)
#include "scene/textures.def"
               },
               {"bilerp", "checkerboard", "directionmix", "dots", "fbm", "imagemap", "marble",
                "ptex", "windy", "wrinkled"}),
  };
  return tables;
}

const std::vector<std::string>& directive_names() {
  static const std::vector<std::string> names = {"Accelerator",
                                                 "ActiveTransform",
                                                 "AreaLightSource",
                                                 "Attribute",
                                                 "AttributeBegin",
                                                 "AttributeEnd",
                                                 "Camera",
                                                 "ColorSpace",
                                                 "ConcatTransform",
                                                 "CoordSysTransform",
                                                 "CoordinateSystem",
                                                 "Film",
                                                 "Identity",
                                                 "Import",
                                                 "Include",
                                                 "Integrator",
                                                 "InverseTransform",
                                                 "LightSource",
                                                 "LookAt",
                                                 "MakeNamedMaterial",
                                                 "MakeNamedMedium",
                                                 "Material",
                                                 "MediumInterface",
                                                 "NamedMaterial",
                                                 "ObjectBegin",
                                                 "ObjectEnd",
                                                 "ObjectInstance",
                                                 "Option",
                                                 "PixelFilter",
                                                 "ReverseOrientation",
                                                 "Rotate",
                                                 "Sampler",
                                                 "Scale",
                                                 "Shape",
                                                 "Texture",
                                                 "Transform",
                                                 "TransformBegin",
                                                 "TransformEnd",
                                                 "TransformTimes",
                                                 "Translate",
                                                 "WorldBegin"};
  return names;
}

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

bool is_known_name(std::string_view directive, const std::string& name) {
  return std::ranges::any_of(name_tables(), [&](const NameTable& table) {
    return table.directive == directive &&
           (contains(table.accepted, name) || contains(table.refused, name));
  });
}

Refusal refusal_of(std::string_view directive, const std::string& name) {
  for (const NameTable& table : name_tables()) {
    if (table.directive != directive) continue;
    if (contains(table.accepted, name)) return {};
    if (contains(table.refused, name))
      return {fmt::format("{} \"{}\" is not rendered yet", table.directive, name)};
    const std::string unknown = fmt::format("unknown {} {}", table.directive, in_quotes(name));
    if (const std::string old = v3_name(directive, name); !old.empty())
      return {fmt::format("{}: that is {}", unknown, old), false};
    std::vector<std::string> known = table.accepted;
    known.insert(known.end(), table.refused.begin(), table.refused.end());
    return {fmt::format("{}; the nearest known name is \"{}\"", unknown, nearest_name(name, known)),
            false};
  }
  return {"unknown directive " + in_quotes(directive), false};
}

bool check_name(std::string_view directive, const std::string& name, const SourceLocation& where,
                Diagnostics& diagnostics) {
  const Refusal refusal = refusal_of(directive, name);
  if (refusal.text.empty()) return true;
  diagnostics.error(where, refusal.text, refusal.text);
  return false;
}

}  // namespace caplet::pbrt
