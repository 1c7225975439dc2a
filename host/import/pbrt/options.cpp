// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "base/log.h"
#include "base/spelling.h"
#include "import/detail/pbrt/fields.h"
#include "import/detail/pbrt/lens_file.h"
#include "scene/transform.h"
#include "schema/kind_of.h"
#include "schema/schema.h"

namespace caplet::pbrt {

namespace {

/// The most samples of a pixel of a picture with a noise, unless the file says else.

double positive(Parameters& parameters, std::string_view name, double fallback) {
  const double value = parameters.number(name, fallback);
  if (value > 0) return value;
  parameters.error(name, "must be positive");
  return fallback;
}

void warn(Parameters& parameters, std::string_view name, const std::string& message) {
  parameters.diagnostics().warning(parameters.where(name), parameters.owner() + ": " + message);
}

/// Lists the camera sensors whose response curves pbrt-v4 has.
const std::vector<std::string>& camera_sensors() {
  static const std::vector<std::string> names = {"canon_eos_100d",
                                                 "canon_eos_1dx_mkii",
                                                 "canon_eos_200d",
                                                 "canon_eos_200d_mkii",
                                                 "canon_eos_5d",
                                                 "canon_eos_5d_mkii",
                                                 "canon_eos_5d_mkiii",
                                                 "canon_eos_5d_mkiv",
                                                 "canon_eos_5ds",
                                                 "canon_eos_m",
                                                 "cie1931",
                                                 "hasselblad_l1d_20c",
                                                 "nikon_d810",
                                                 "nikon_d850",
                                                 "sony_ilce_6400",
                                                 "sony_ilce_7m3",
                                                 "sony_ilce_7rm3",
                                                 "sony_ilce_9"};
  return names;
}

/// Reads "sensor" and "whitebalance". For a camera's sensor only pbrt-v4's white balance is
/// applied, not its response curves.
void set_sensor(Parameters& parameters, FilmSettings& film) {
  const std::string sensor = parameters.text("sensor", "cie1931");
  const auto& known = camera_sensors();
  if (std::ranges::find(known, sensor) == known.end())
    return parameters.error("sensor", "is " + in_quotes(sensor) + "; the nearest known name is \"" +
                                          nearest_name(sensor, known) + "\"");
  if (film.white_balance > 0 && !(film.white_balance >= 1000 && film.white_balance <= 25000))
    parameters.error("whitebalance", must_lie_within(1000, 25000) + " kelvin");
  if (sensor == "cie1931") return;
  if (film.white_balance == 0) film.white_balance = 6500;
  warn(parameters, "sensor",
       "the colours are those of the CIE 1931 observer, not of " + in_quotes(sensor));
}

/// Reads the direction and the up axis of an automatic camera.
Framing framing_of(Parameters& parameters, bool is_orthographic) {
  Framing framing;
  framing.is_orthographic = is_orthographic;
  for (auto [name, value] : {std::pair{"view", &framing.toward_viewer}, {"up", &framing.up}}) {
    if (!parameters.has(name)) continue;
    const glm::dvec3 direction = parameters.vector(name, {0, 1, 0});
    const double length = glm::length(direction);
    if (length > 0 && std::isfinite(length))
      *value = is_unit(length) ? direction : direction / length;
    else
      parameters.error(name, "has no direction");
  }
  return framing;
}

/// Reads the axes that are drawn, which are a rotation to 1e-6.
glm::dmat3 file_axes_of(Parameters& parameters) {
  glm::dmat3 out(1);
  const Parameter* axes = parameters.values("fileaxes", {"float"});
  if (!axes) return out;
  if (axes->numbers.size() != 9) {
    parameters.error("fileaxes", "takes 9 values, not " + std::to_string(axes->numbers.size()));
    return out;
  }
  for (int i = 0; i < 9; ++i) out[i / 3][i % 3] = axes->numbers[static_cast<std::size_t>(i)];
  const glm::dmat3 rest = glm::transpose(out) * out - glm::dmat3(1);
  double most = std::abs(glm::determinant(out) - 1);
  for (int i = 0; i < 9; ++i) most = std::max(most, std::abs(rest[i / 3][i % 3]));
  if (!(most <= 1e-6)) {
    parameters.error("fileaxes", "is no rotation");
    return glm::dmat3(1);
  }
  return out;
}

/// Reads the clipping plane: what lies beyond a x + b y + c z = d is cut away.
std::optional<ClipPlane> clip_of(Parameters& parameters) {
  const Parameter* plane = parameters.values("clipplane", {"float"});
  if (!plane) return std::nullopt;
  const std::vector<double>& v = plane->numbers;
  if (v.size() != 4) {
    parameters.error("clipplane", "takes 4 values, not " + std::to_string(v.size()));
    return std::nullopt;
  }
  const glm::dvec3 normal(v[0], v[1], v[2]);
  const double length = glm::length(normal);
  if (!(length > 0) || !std::isfinite(length) || !std::isfinite(v[3] / length)) {
    parameters.error("clipplane", "is no plane");
    return std::nullopt;
  }
  if (is_unit(length)) return ClipPlane{normal, v[3]};
  return ClipPlane{normal / length, v[3] / length};
}

/// Reads the legend of the colours; none without a title.
std::optional<Legend> legend_of(Parameters& parameters) {
  Legend out;
  out.unit = parameters.text("legendunit", "");
  out.of_directions = parameters.boolean("legenddirections", false);
  if (const Parameter* range = parameters.values("legendrange", {"float"})) {
    const std::vector<double>& v = range->numbers;
    if (v.size() == 2 && std::isfinite(v[0]) && std::isfinite(v[1]))
      std::tie(out.low, out.high) = std::pair(v[0], v[1]);
    else
      parameters.error("legendrange", "is not two finite numbers");
  }
  const Parameter* colors = parameters.values("legendcolors", {"float"});
  if (colors) {
    const std::vector<double>& v = colors->numbers;
    if (v.size() % 3 != 0 || !std::ranges::all_of(v, [](double c) { return c >= 0 && c <= 1; }))
      parameters.error("legendcolors", "is no list of colours, three numbers from 0 to 1 each");
    else
      for (std::size_t i = 0; i < v.size(); i += 3)
        out.colors.emplace_back(v[i], v[i + 1], v[i + 2]);
  }
  if (const Parameter* names = parameters.values("legendnames", {"string"}))
    out.names = names->strings;
  if (!parameters.has("legend")) return std::nullopt;
  out.title = parameters.text("legend", "");
  if (out.colors.empty() && !out.of_directions) {
    if (!colors) parameters.error("legend", "needs legendcolors, or legenddirections");
    return std::nullopt;
  }
  if (!out.names.empty() && out.names.size() != out.colors.size()) {
    parameters.error("legendnames", fmt::format("has {} names for {} colours", out.names.size(),
                                                out.colors.size()));
    return std::nullopt;
  }
  return out;
}

/// Reads the background. The path of an image is resolved here; `images` reads it if it is given.
std::optional<Backdrop> backdrop_of(Parameters& parameters, const ImageReader* images) {
  const std::string kind = parameters.text("background", "");
  if (kind.empty()) return std::nullopt;
  Backdrop out;
  if (kind == "color") {
    out.kind = Backdrop::Kind::color;
    const Parameter* color = parameters.values("backgroundcolor", {"float"});
    const auto is_within = [](double v) { return v >= 0 && v <= 1; };
    if (!color || color->numbers.size() != 3 || !std::ranges::all_of(color->numbers, is_within))
      parameters.error("backgroundcolor", "must be three numbers from 0 to 1");
    else
      out.color = {color->numbers[0], color->numbers[1], color->numbers[2]};
  } else if (kind == "image") {
    const std::string name = parameters.text("backgroundfile", "");
    try {
      if (!images) throw InputError("pictures cannot be read here");
      out.kind = Backdrop::Kind::image;
      out.image = std::make_shared<const EnvironmentImage>(images->read_rgb(
          resolve_file(name, parameters.where("backgroundfile"), parameters.main_file())));
    } catch (const InputError& error) {
      parameters.error("backgroundfile", error.what());
      return std::nullopt;
    }
  } else if (kind != "transparent") {
    parameters.error("background", "must be \"transparent\", \"color\" or \"image\"");
  }
  return out;
}

/// Reads the parameters that cameras of one projection have.
struct ProjectionReader : FieldReader {
  const ImageReader* images;

  void lens(const Field& field, std::shared_ptr<const Lens>& value) const {
    const std::string name = parameters.text(field.name, "");
    if (name.empty()) return;
    const SourceLocation where = parameters.where(field.name);
    try {
      value = std::make_shared<const Lens>(
          read_lens_file(resolve_file(name, where, parameters.main_file()), where));
    } catch (const InputError& error) {
      add_errors(error, where, parameters.diagnostics());
    }
  }
  void aperture(const Field& field, std::shared_ptr<const ApertureMask>& value) const {
    const std::string name = parameters.text(field.name, "");
    if (name.empty()) return;
    value = aperture_mask(name);
    if (value) return;
    try {
      if (!images) throw InputError("pictures cannot be read here");
      const std::string file =
          resolve_file(name, parameters.where(field.name), parameters.main_file());
      const EnvironmentImage image = images->read_rgb(file);
      ApertureMask mask{file, image.width, image.height, {}};
      for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
        mask.values.push_back((image.rgb[i] + image.rgb[i + 1] + image.rgb[i + 2]) / 3);
      if (!normalize(mask)) throw InputError("lets no light pass");
      value = std::make_shared<const ApertureMask>(std::move(mask));
    } catch (const InputError& error) {
      parameters.error(field.name, std::string(error.what()) +
                                       " (\"gaussian\", \"pentagon\", "
                                       "\"square\" and \"star\" need no image)");
    }
  }

  /// "fov", or "halffov" where it is above 0.
  void field_of_view(double& radians) const {
    const double given = parameters.number(fov_field.name, 90),
                 half = parameters.number(half_fov_field.name, -1);
    const double degrees = half > 0 ? 2 * half : given;
    if (degrees > 0 && degrees < 180)
      radians = degrees * glm::pi<double>() / 180;
    else if (half > 0)
      parameters.error(half_fov_field.name, "must be below 90 degrees");
    else
      parameters.error(fov_field.name, "must be above 0 and below 180 degrees");
  }
};

Projection projection_of(const std::string& type, Parameters& parameters,
                         const ImageReader* images) {
  const auto kind = schema::kind_of<std::size_t>(type, projection_names);
  Projection out = model_of<Projection>(kind.value_or(0));
  std::visit([&](auto& of) { of.fields(of, ProjectionReader{{parameters}, images}); }, out);
  std::visit(
      [&](const auto& of) {
        if constexpr (requires { of.problem(); })
          if (const std::string problem = of.problem(); !problem.empty()) parameters.error(problem);
      },
      out);
  return out;
}

}  // namespace

void set_camera(const std::string& type, Parameters& parameters,
                const glm::dmat4& world_from_camera, Scene& scene, const ImageReader* images) {
  Camera camera;
  camera.world_from_camera = world_from_camera;
  camera.projection = projection_of(type, parameters, images);
  if (parameters.has(frame_aspect_ratio_field.name))
    camera.frame_aspect_ratio = positive(parameters, frame_aspect_ratio_field.name, 1);
  if (const Parameter* window = parameters.values("screenwindow", {"float"})) {
    const auto& v = window->numbers;
    if (v.size() != 4)
      parameters.error("screenwindow", "takes 4 values, not " + std::to_string(v.size()));
    else if (!(v[0] < v[1] && v[2] < v[3]))
      parameters.error("screenwindow", "must be x min, x max, y min, y max with min below max");
    else
      camera.screen_window = {v[0], v[1], v[2], v[3]};
  }
  Camera::fields(camera, FieldReader{parameters});
  const bool has_parallel_lens =
      is_orthographic(camera) && parameters.boolean(Camera::parallel_lens_field.name, false);
  if (is_orthographic(camera) && camera.lens_radius > 0 && !has_parallel_lens) {
    // All rays of pbrt-v4 then leave the same lens: a perspective through the window at the focal
    // distance.
    camera.projection = PerspectiveProjection{2 * std::atan(1 / camera.focal_distance)};
    warn(parameters, "lensradius",
         "makes a perspective of it, as in pbrt-v4; with \"bool parallellens\" true it makes none");
  }
  const double open = parameters.number("shutteropen", 0),
               close = parameters.number("shutterclose", 1);
  if (close > open) {
    scene.view.film.exposure_time = close - open;
    scene.view.film.shutter_open = open;
    FieldReader reader{parameters};
    scene.view.film.readout = 0;
    scene.view.film.readout_order = 0;
    reader.number(readout_field, scene.view.film.readout);
    reader.choice(readout_order_field, scene.view.film.readout_order, readout_orders);
  } else {
    parameters.error("shutterclose", "must be after shutteropen");
  }
  scene.automatic_camera = parameters.boolean("automatic", false);
  scene.has_no_up = parameters.boolean("noup", false);
  scene.framing = framing_of(parameters, is_orthographic(camera) && scene.automatic_camera);
  scene.view.clip = clip_of(parameters);
  scene.unit = parameters.text("unit", "");
  scene.world_from_file = file_axes_of(parameters);
  scene.legend = legend_of(parameters);
  parameters.finish();
  scene.view.camera = camera;
}

void set_film(const std::string& type, Parameters& parameters, ColorSpace space, Scene& scene,
              const ImageReader* images) {
  FilmSettings film;
  film.exposure_time = scene.view.film.exposure_time;
  film.shutter_open = scene.view.film.shutter_open;
  film.readout = scene.view.film.readout;
  film.readout_order = scene.view.film.readout_order;
  film.space = space;
  FilmSettings::fields(film, FieldReader{parameters});
  film.filename = parameters.text("filename", "pbrt.exr");
  if (const Parameter* bounds = parameters.values("pixelbounds", {"integer"})) {
    const auto& v = bounds->numbers;
    if (v.size() == 4)
      film.crop = {static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]),
                   static_cast<int>(v[3])};
    else
      parameters.error("pixelbounds", "takes 4 values, not " + std::to_string(v.size()));
  }
  if (const Parameter* window = parameters.values("cropwindow", {"float"})) {
    const auto& v = window->numbers;
    // pbrt computes in 32-bit floats: 0.07 of 100 is pixel 7, not a little more.
    const auto pixel = [](double fraction, int size) {
      return static_cast<int>(std::ceil(static_cast<float>(fraction) * static_cast<float>(size)));
    };
    if (v.size() != 4)
      parameters.error("cropwindow", "takes 4 values, not " + std::to_string(v.size()));
    else if (!(0 <= v[0] && v[0] < v[1] && v[1] <= 1 && 0 <= v[2] && v[2] < v[3] && v[3] <= 1))
      parameters.error("cropwindow", "must be x min, x max, y min, y max within 0 and 1");
    else if (film.crop)
      parameters.error("cropwindow", "cannot be combined with \"pixelbounds\"");
    else
      film.crop = {pixel(v[0], film.width), pixel(v[1], film.width), pixel(v[2], film.height),
                   pixel(v[3], film.height)};
  }
  if (film.crop) {
    const auto& c = *film.crop;
    if (!(0 <= c[0] && c[0] < c[1] && c[1] <= film.width && 0 <= c[2] && c[2] < c[3] &&
          c[3] <= film.height))
      parameters.error(parameters.has("pixelbounds") ? "pixelbounds" : "cropwindow",
                       "must be x0, x1, y0, y1 of a part of the image that is not empty");
  }
  parameters.boolean("savefp16", true);
  set_sensor(parameters, film);
  if (type == "gbuffer") {
    parameters.text("coordinatesystem", "camera");
    warn(parameters, {}, "the layers have names of our own (--layers), and are of the world");
  }
  if (type == "spectral") {
    for (const char* name : {"nbuckets", "lambdamin", "lambdamax"}) parameters.ignore(name);
    warn(parameters, {}, "red, green and blue are written, not the spectrum");
  }
  film.backdrop = backdrop_of(parameters, images);
  parameters.finish();
  scene.view.film = film;
}

void set_filter(const std::string& type, Parameters& parameters, Scene& scene) {
  PixelFilter filter;
  filter.set_kind(
      schema::kind_of<PixelFilter::Kind>(type, filter_names).value_or(PixelFilter::Kind::gaussian));
  PixelFilter::fields(filter, FieldReader{parameters});
  parameters.finish();
  scene.view.filter = filter;
}

std::optional<std::uint32_t> set_sampler(const std::string& type, Parameters& parameters,
                                         Scene& scene) {
  SamplerSettings sampler;
  const bool has_seed = parameters.has("seed");
  const auto kind = schema::kind_of<SamplerSettings::Kind>(type, sampler_names);
  sampler.kind = kind.value_or(SamplerSettings::Kind::sobol);
  SamplerSettings::fields(sampler, FieldReader{parameters});
  if (sampler.noise > 0 && sampler.noise < least_noise)
    parameters.error("noise", "must be 0, or from 1e-5 to 1");
  if (sampler.noise > 0 && !parameters.has("pixelsamples"))
    sampler.samples_per_pixel = most_noise_samples;
  if (!kind) warn(parameters, {}, "rendered by the sampler \"sobol\", whose noise is another");
  if (sampler.kind == SamplerSettings::Kind::stratified) {
    const std::int64_t samples = std::int64_t{sampler.x_strata} * sampler.y_strata;
    if (samples > INT32_MAX)
      parameters.error("xsamples", "times \"ysamples\" is more than 2^31 samples a pixel");
    else
      sampler.samples_per_pixel = static_cast<int>(samples);
  }
  if (type == "halton" || type == "paddedsobol" || type == "sobol" || type == "zsobol")
    parameters.text("randomization", "");
  parameters.finish();
  const std::uint32_t seed = std::exchange(sampler.seed, scene.view.sampler.seed);
  scene.view.sampler = sampler;
  return has_seed ? std::optional(seed) : std::nullopt;
}

void set_integrator(const std::string& type, Parameters& parameters, Scene& scene) {
  IntegratorSettings integrator;
  const auto kind = schema::kind_of<IntegratorSettings::Kind>(type == "volpath" ? "path" : type,
                                                              integrator_names);
  integrator.kind = kind.value_or(IntegratorSettings::Kind::path);
  if (!kind) warn(parameters, {}, "rendered by the path tracer, which converges to the same image");
  IntegratorSettings::fields(integrator, FieldReader{parameters});
  if (type == "path" || type == "volpath") parameters.text("lightsampler", "bvh");
  if (type == "path" || type == "volpath" || type == "bdpt" || type == "mlt")
    if (parameters.boolean("regularize", false))
      warn(parameters, "regularize", "nothing is made rougher than it is (\"regularize\")");
  // The others write additional pictures, or affect only noise.
  for (const char* name : schema::ignored_integrator_parameters(type)) parameters.ignore(name);
  parameters.finish();
  scene.view.integrator = integrator;
}

void check_accelerator(const std::string& type, Parameters& parameters) {
  for (const char* name : {"maxnodeprims", "splitmethod"})
    if (type == "bvh") parameters.ignore(name);
  for (const char* name : {"intersectcost", "traversalcost", "emptybonus", "maxprims", "maxdepth"})
    if (type == "kdtree") parameters.ignore(name);
  log::info("{}: {} has no effect on the image and is ignored", parameters.where().to_string(),
            parameters.owner());
  parameters.finish();
}

std::optional<std::uint32_t> set_option(const std::string& name, const Token& value,
                                        const std::string& file, Diagnostics& diagnostics) {
  const auto wrong = [&](const std::string& message) {
    diagnostics.error(place_of(value, file), "Option " + in_quotes(name) + " " + message);
  };
  if (name == "seed") return static_cast<std::uint32_t>(parse_integer(value, file));
  if (name == "displacementedgescale") {
    parse_number(value, file);
  } else if (name == "rendercoordsys") {
    if (value.text != "camera" && value.text != "cameraworld" && value.text != "world")
      wrong("must be \"camera\", \"cameraworld\" or \"world\", not " + in_quotes(value.text));
  } else if (value.text != "true" && value.text != "false") {
    wrong("must be true or false, not " + in_quotes(value.text));
  } else if (value.text == "true" && name != "disabletexturefiltering" && name != "pixelstats" &&
             name != "wavefront") {
    wrong("is not rendered yet");
  }
  return std::nullopt;
}

}  // namespace caplet::pbrt
