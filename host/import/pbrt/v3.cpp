// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/v3.h"

#include <span>

namespace caplet::pbrt {

namespace {

struct RenamedStatement {
  std::string_view directive, name, now;  // now: the new name; empty: there is none
};

constexpr RenamedStatement names[] = {
    {"Material", "disney", "\"diffuse\" (\"color\" is \"reflectance\")"},
    {"Material", "fourier", "\"measured\" (\"bsdffile\" is \"filename\")"},
    {"Material", "glass", "\"dielectric\" (\"index\" is \"eta\")"},
    {"Material", "kdsubsurface", "\"subsurface\" (\"Kd\" is \"reflectance\")"},
    {"Material", "matte", "\"diffuse\" (\"Kd\" is \"reflectance\")"},
    {"Material", "metal", "\"conductor\""},
    {"Material", "mirror", "\"conductor\" (smooth silver)"},
    {"Material", "plastic", "\"coateddiffuse\" (\"Kd\" is \"reflectance\")"},
    {"Material", "substrate", "\"coateddiffuse\" (\"Kd\" is \"reflectance\")"},
    {"Material", "translucent", "\"diffusetransmission\" (\"Kd\" is \"transmittance\")"},
    {"Material", "uber", "\"coateddiffuse\" (\"Kd\" is \"reflectance\")"},
    {"Texture", "color", "\"spectrum\""},
    {"Film", "image", "\"rgb\""},
    {"Camera", "environment", "\"spherical\""},
    {"Sampler", "02sequence", "\"paddedsobol\""},
    {"Sampler", "lowdiscrepancy", "\"paddedsobol\""},
    {"Sampler", "maxmindist", "\"pmj02bn\""},
    {"Sampler", "random", "\"independent\""},
    {"Integrator", "directlighting", "\"path\""},
    {"Integrator", "whitted", "\"path\""},
    {"Shape", "heightfield", ""},
    {"Shape", "hyperboloid", ""},
    {"Shape", "nurbs", ""},
    {"Shape", "paraboloid", ""},
    {"type", "color", "\"rgb\""},
    {"type", "xyz", ""},
};

constexpr RenamedStatement parameters[] = {
    {"Material", "Kd", "\"reflectance\""},
    {"Material", "bumpmap", "\"displacement\""},
    {"Material", "index", "\"eta\""},
    {"LightSource", "mapname", "\"filename\""},
    {"LightSource", "nsamples", ""},
    {"LightSource", "samples", ""},
    {"AreaLightSource", "nsamples", ""},
    {"AreaLightSource", "samples", ""},
    {"PixelFilter", "xwidth", "\"xradius\""},
    {"PixelFilter", "ywidth", "\"yradius\""},
    {"Film", "scale", ""},
};

std::string found(std::span<const RenamedStatement> rows, std::string_view directive,
                  std::string_view name) {
  for (const RenamedStatement& row : rows)
    if (row.directive == directive && row.name == name)
      return row.now.empty() ? "pbrt-v3's, which pbrt-v4 does not have"
                             : "pbrt-v3's name for " + std::string(row.now);
  return {};
}

}  // namespace

std::string v3_name(std::string_view directive, std::string_view name) {
  if (directive.empty() && name == "WorldEnd")
    return "this scene is in the language of pbrt-v3, Caplet reads that of pbrt-v4; pbrt-v4's own "
           "\"pbrt --upgrade\" rewrites it";
  return found(names, directive, name);
}

std::string v3_parameter(std::string_view directive, std::string_view name) {
  return found(parameters, directive == "MakeNamedMaterial" ? "Material" : directive, name);
}

}  // namespace caplet::pbrt
