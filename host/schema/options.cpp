// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Schema of cameras, films, filters, samplers and integrators.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "schema/detail/describe.h"
#include "schema/detail/rows.h"
#include "schema/kind_of.h"
#include "schema/schema.h"

namespace caplet::schema {

namespace {

bool is_one_of(const std::string& type, std::initializer_list<const char*> names) {
  return std::ranges::find(names, type) != names.end();
}

constexpr std::array window_rows = {Row{frame_aspect_ratio_field, "float"},
                                    Row{{"screenwindow",
                                         "x min, x max, y min, y max of what is seen; else the "
                                         "shorter side is -1 to 1"},
                                        "float"}};
constexpr Row readout_row = {readout_field, "float", "0"};
constexpr std::array camera_rows = {
    Row{{"shutteropen", "start of the exposure", -no_limit, no_limit, "seconds"}, "float", "0"},
    Row{{"shutterclose", "end of the exposure, whose length is a factor of the picture", -no_limit,
         no_limit, "seconds"},
        "float",
        "1"},
    Row{{"automatic", "framed to the scene"}, "bool", "false"},
    Row{{"noup", "an automatic camera may turn the scene within the picture"}, "bool", "false"},
    Row{{"view", "direction towards an automatic camera"}, "vector3"},
    Row{{"up", "direction that is up for an automatic camera"}, "vector3"},
    Row{{"clipplane", "a, b, c, d: what lies beyond a x + b y + c z = d in the world is cut away"},
        "float"},
    Row{{"unit", "unit of lengths, for scale bars"}, "string"},
    Row{{"fileaxes", "the axes that are drawn: x, y and z, each a column of a rotation"}, "float"},
    Row{{"legend", "title of the colours' legend"}, "string"},
    Row{{"legendunit", "unit of the legend's values"}, "string"},
    Row{{"legendrange", "values of the first and the last colour"}, "float"},
    Row{{"legendcolors", "linear sRGB, as displayed, three numbers a colour", 0, 1}, "float"},
    Row{{"legendnames", "names of the colours, where they tell no values"}, "string"},
    Row{{"legenddirections", "colours tell directions along the axes that are drawn"},
        "bool",
        "false"}};

constexpr std::array film_rows = {
    Row{{"filename", "where the picture is written"}, "string", "pbrt.exr"},
    Row{{"pixelbounds", "x0, x1, y0, y1 of the part that is rendered"}, "integer"},
    Row{{"cropwindow", "the same as shares of the picture; not together with pixelbounds", 0, 1},
        "float"},
    Row{{"sensor", "a camera's sensor: its white balance counts, its curves do not"},
        "string",
        "cie1931"},
    Row{{"background", "\"transparent\", \"color\" or \"image\""}, "string"},
    Row{{"backgroundcolor", "linear sRGB, as displayed", 0, 1}, "float"},
    Row{{"backgroundfile", "an image"}, "string"}};
constexpr std::array film_ignored = {Row{{"savefp16", "16-bit floats"}, "bool", "true"}};
constexpr std::array gbuffer_ignored = {
    Row{{"coordinatesystem", "of the layers"}, "string", "camera"}};
constexpr std::array spectral_ignored = {Row{{"nbuckets", "of the spectrum"}, "integer"},
                                         Row{{"lambdamin", "of the spectrum"}, "float"},
                                         Row{{"lambdamax", "of the spectrum"}, "float"}};
constexpr std::array randomization_ignored = {
    Row{{"randomization", "of the points: Owen's always"}, "string"}};

/// A parameter of pbrt-v4's integrators of these types, separated by blanks, without an effect.
struct IgnoredOfIntegrator {
  Row row;
  std::string_view types;
};
constexpr const char* of_pbrt = "of pbrt-v4's integrator";
constexpr std::array integrator_ignored = {
    IgnoredOfIntegrator{{{"maxdepth", of_pbrt}, "integer"}, "ambientocclusion"},
    IgnoredOfIntegrator{{{"lightsampler", of_pbrt}, "string"}, "path volpath"},
    IgnoredOfIntegrator{{{"regularize", of_pbrt}, "bool"}, "path volpath bdpt mlt"},
    IgnoredOfIntegrator{{{"rrthreshold", of_pbrt}, "float"}, "path volpath simplevolpath"},
    IgnoredOfIntegrator{{{"visualizestrategies", of_pbrt}, "bool"}, "bdpt"},
    IgnoredOfIntegrator{{{"visualizeweights", of_pbrt}, "bool"}, "bdpt"},
    IgnoredOfIntegrator{{{"bootstrapsamples", of_pbrt}, "integer float"}, "mlt"},
    IgnoredOfIntegrator{{{"chains", of_pbrt}, "integer float"}, "mlt"},
    IgnoredOfIntegrator{{{"mutationsperpixel", of_pbrt}, "integer float"}, "mlt"},
    IgnoredOfIntegrator{{{"largestepprobability", of_pbrt}, "integer float"}, "mlt"},
    IgnoredOfIntegrator{{{"sigma", of_pbrt}, "integer float"}, "mlt"},
    IgnoredOfIntegrator{{{"photonsperiteration", of_pbrt}, "integer float"}, "sppm"},
    IgnoredOfIntegrator{{{"radius", of_pbrt}, "integer float"}, "sppm"},
    IgnoredOfIntegrator{{{"seed", of_pbrt}, "integer float"}, "sppm"}};

bool of_type(const IgnoredOfIntegrator& one, std::string_view type) {
  return (" " + std::string(one.types) + " ").find(" " + std::string(type) + " ") !=
         std::string::npos;
}

void add_camera(const std::string& type, std::vector<Parameter>& out) {
  const auto kind = kind_of<std::size_t>(type, projection_names);
  Camera camera;
  camera.projection = model_of<Projection>(kind.value_or(0));
  Describe all(out);
  std::visit([&](const auto& of) { of.fields(of, all); }, camera.projection);
  const std::size_t own = out.size();
  add_rows(window_rows, out);
  const std::size_t windows = out.size();
  Camera::fields(camera, all);
  // They are read for every camera, as in pbrt-v4.
  for (std::size_t i = own; i < out.size(); ++i)
    out[i].has_effect = i < windows ? has_screen_window(camera) : has_image_plane(camera);
  if (type == "orthographic") all.flag(Camera::parallel_lens_field, false);
  add_rows(camera_rows, out);
  add_rows(std::array{readout_row}, out);
  all.choice(readout_order_field, 0, readout_orders);
}

void add_film(const std::string& type, std::vector<Parameter>& out) {
  const FilmSettings film;
  Describe all(out);
  FilmSettings::fields(film, all);
  add_rows(film_rows, out);
  add_ignored(film_ignored, out);
  if (type == "gbuffer") add_ignored(gbuffer_ignored, out);
  if (type == "spectral") add_ignored(spectral_ignored, out);
}

void add_integrator(const std::string& type, std::vector<Parameter>& out) {
  IntegratorSettings integrator;
  integrator.kind = kind_of<IntegratorSettings::Kind>(type, integrator_names)
                        .value_or(IntegratorSettings::Kind{});
  Describe all(out);
  IntegratorSettings::fields(integrator, all);
  for (const IgnoredOfIntegrator& one : integrator_ignored)
    if (of_type(one, type)) add_ignored({&one.row, 1}, out);
}

}  // namespace

std::vector<const char*> ignored_integrator_parameters(std::string_view type) {
  std::vector<const char*> out;
  for (const IgnoredOfIntegrator& one : integrator_ignored)
    if (of_type(one, type)) out.push_back(one.row.field.name);
  return out;
}

void add_option(std::string_view directive, const std::string& type, std::vector<Parameter>& out) {
  Describe all(out);
  if (directive == "Camera") add_camera(type, out);
  if (directive == "Film") add_film(type, out);
  if (directive == "Integrator") add_integrator(type, out);
  if (directive == "PixelFilter") {
    PixelFilter filter;
    filter.set_kind(kind_of<PixelFilter::Kind>(type, filter_names).value_or(PixelFilter::Kind{}));
    PixelFilter::fields(filter, all);
  }
  if (directive == "Sampler") {
    SamplerSettings sampler;
    sampler.kind =
        kind_of<SamplerSettings::Kind>(type, sampler_names).value_or(SamplerSettings::Kind{});
    SamplerSettings::fields(sampler, all);
    if (is_one_of(type, {"halton", "paddedsobol", "sobol", "zsobol"}))
      add_ignored(randomization_ignored, out);
  }
}

}  // namespace caplet::schema
