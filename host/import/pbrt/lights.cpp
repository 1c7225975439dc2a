// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/lights.h"

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/matrix.hpp>

#include "base/reading.h"
#include "base/spelling.h"
#include "import/detail/ies.h"
#include "import/detail/pbrt/fields.h"
#include "present/lights.h"
#include "scene/transform.h"

namespace caplet::pbrt {

namespace {

/// Returns pbrt's default illuminant: the colour space's white.
Spectrum white(Parameters& parameters, std::string_view name) {
  return parameters.spectrum(name, SpectrumUse::illuminant)
      .value_or(RgbSpectrum{glm::dvec3(1), parameters.space()});
}

std::optional<double> positive_or_none(Parameters& parameters, std::string_view name) {
  const double value = parameters.number(name, -1);
  return value > 0 ? std::optional(value) : std::nullopt;
}

double scale_of(Parameters& parameters) {
  const double scale = parameters.number("scale", 1);
  if (scale < 0) parameters.error("scale", "must not be negative");
  return scale;
}

/// Returns the unit direction from -> to in world space; reports when both are the same point.
glm::dvec3 direction(Parameters& parameters, const glm::dvec3& from, const glm::dvec3& to,
                     const glm::dmat4& world_from_light) {
  const glm::dvec3 along(world_from_light * glm::dvec4(to - from, 0));
  const double length = glm::length(along);
  if (length > 0 && std::isfinite(length)) return is_unit(length) ? along : along / length;
  parameters.error("\"from\" and \"to\" give no direction");
  return {0, 0, 1};
}

/// Returns the rotation (possibly mirroring) of a similarity transform.
glm::dmat3 rotation_of(Parameters& parameters, const glm::dmat4& world_from_light) {
  const glm::dmat3 a(world_from_light);
  const double scale = glm::length(a[0]);
  const glm::dmat3 r = is_unit(scale) ? a : a / scale;
  // Matrices in scene files have six digits; a deviation from orthonormal beyond 1e-3 means a shear
  // or an uneven scale.
  const glm::dmat3 error = glm::transpose(r) * r - glm::dmat3(1);
  bool orthonormal = true;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) orthonormal = orthonormal && std::abs(error[i][j]) < 1e-3;
  if (!orthonormal) parameters.error("the light cannot be sheared or scaled unevenly");
  return r;
}

std::string file_of(Parameters& parameters, const char* name) {
  return resolve_file(parameters.text(name, ""), parameters.where(name), parameters.main_file());
}

std::string size_of(Parameters& parameters, const char* name, const EnvironmentImage& image) {
  return file_of(parameters, name) + " is " + std::to_string(image.width) + " x " +
         std::to_string(image.height) + " pixels";
}

/// Reads the fields of scene/lights.def.
struct LightReader : FieldReader {
  const glm::dmat4& world_from_light;
  LightFiles& files;

  void emission(const Field& field, Spectrum& value) { value = white(parameters, field.name); }
  void position(const Field& field, glm::dvec3& value) {
    value =
        glm::dvec3(world_from_light * glm::dvec4(parameters.point(field.name, glm::dvec3(0)), 1));
  }
  void place(glm::dvec3& position, glm::dmat3& rotation) {
    position = glm::dvec3(world_from_light[3]);
    rotation = rotation_of(parameters, world_from_light);
  }
  void image(const Field& field, std::shared_ptr<const EnvironmentImage>& value) {
    if (is_there(field)) value = files.image(parameters, field.name);
  }
  void directions(const Field& field, std::shared_ptr<const EnvironmentImage>& value) {
    image(field, value);
    if (value && value->width != value->height)
      parameters.error(field.name,
                       size_of(parameters, field.name, *value) + ", and not square (equal-area)");
  }
  void profile(const Field& field, std::shared_ptr<const IesProfile>& value) {
    if (is_there(field)) value = files.profile(parameters, field.name);
  }
  void direction(const Field& from, const Field& to, glm::dvec3& value) {
    value = pbrt::direction(parameters, parameters.point(from.name, glm::dvec3(0)),
                            parameters.point(to.name, glm::dvec3(0, 0, 1)), world_from_light);
  }
  void cone(double& total_angle, double& falloff_start_angle) {
    const double cone = parameters.number("coneangle", 30),
                 delta = parameters.number("conedeltaangle", 5);
    if (!(cone > 0 && cone <= 180))
      parameters.error("coneangle", "must be above 0 and at most 180 degrees");
    if (!(delta >= 0 && delta <= cone))
      parameters.error("conedeltaangle", "must lie between 0 and \"coneangle\"");
    total_angle = cone * glm::pi<double>() / 180;
    falloff_start_angle = (cone - delta) * glm::pi<double>() / 180;
  }
  void sky(InfiniteLight& light) {
    const bool has_radiance = parameters.has("L");
    light.radiance = white(parameters, "L");
    if (const std::string preset = parameters.text("preset", ""); !preset.empty()) {
      for (const char* other : {"L", "filename"})
        if (parameters.has(other))
          parameters.error("preset", "cannot be combined with " + in_quotes(other));
      light.image = light_preset(preset);
      if (!light.image)
        return parameters.error("preset", "is " + in_quotes(preset) +
                                              "; the nearest known name is " +
                                              in_quotes(nearest_name(preset, light_presets())));
      light.world_from_light = rotation_of(parameters, world_from_light);
    } else if (!parameters.text("filename", "").empty()) {
      if (has_radiance) parameters.error("filename", "cannot be combined with \"L\"");
      light.image = files.image(parameters, "filename");
      light.world_from_light = rotation_of(parameters, world_from_light);
      if (light.image && !light.image->equal_area && light.image->width != 2 * light.image->height)
        parameters.error("filename", size_of(parameters, "filename", *light.image) +
                                         ", neither 1:1 (equal-area) nor 2:1 (latitude-longitude)");
    }
    if (const Parameter* corners = parameters.values("portal", {"point3"})) portal(light, *corners);
  }

 private:
  bool is_there(const Field& field) {
    if (parameters.has(field.name)) return true;
    parameters.error("\"string " + std::string(field.name) + "\" is missing");
    return false;
  }
  // Validation checks that the corners form a rectangle.
  void portal(InfiniteLight& light, const Parameter& corners) {
    if (corners.numbers.size() != 12) return parameters.error("portal", "must be four points");
    LightPortal& to = light.portal.emplace();
    for (std::size_t i = 0; i < 4; ++i)
      to[i] = {corners.numbers[3 * i], corners.numbers[3 * i + 1], corners.numbers[3 * i + 2]};
  }
};

}  // namespace

template <class File, class Read>
std::shared_ptr<const File> LightFiles::file(
    Parameters& parameters, const char* name, Read&& read,
    std::map<std::string, std::shared_ptr<const File>>& files) {
  const std::string given = parameters.text(name, "");
  const std::string path = file_of(parameters, name);
  std::error_code ignored;
  if (given.empty() || !is_there(path, parameters.where(name))) {
    parameters.error(name, "no such file " + in_quotes(path));
    return nullptr;
  }
  const auto [found, fresh] =
      files.try_emplace(std::filesystem::weakly_canonical(path, ignored).string(), nullptr);
  if (!fresh && found->second) return found->second;
  try {
    found->second = read(path);
  } catch (const InputError& problem) {
    parameters.error(name, problem.messages().front());
  }
  return found->second;
}

std::shared_ptr<const EnvironmentImage> LightFiles::image(Parameters& parameters,
                                                          const char* name) {
  const auto read = [&](const std::string& path) {
    auto image = std::make_shared<EnvironmentImage>(reader_.read_rgb(path));
    if (image->width < 1 || image->height < 1) throw InputError(path + " has no pixels");
    image->equal_area = image->width == image->height;
    return image;
  };
  return file(parameters, name, read, images_);
}

std::shared_ptr<const IesProfile> LightFiles::profile(Parameters& parameters, const char* name) {
  return file(
      parameters, name,
      [](const std::string& path) { return std::make_shared<IesProfile>(read_ies(path)); },
      profiles_);
}

std::optional<Light> make_light(const std::string& type, Parameters& parameters,
                                const glm::dmat4& world_from_light, LightFiles& files) {
  Light light;
  light.where = parameters.where();
  light.scale = scale_of(parameters);
#define LIGHT_MODEL(name, Type)                                                              \
  if (type == #name) {                                                                       \
    if (Type::unit == LightUnit::power) light.power = positive_or_none(parameters, "power"); \
    if (Type::unit == LightUnit::illuminance)                                                \
      light.illuminance = positive_or_none(parameters, "illuminance");                       \
    Type model;                                                                              \
    Type::fields(model, LightReader{{parameters}, world_from_light, files});                 \
    light.model = std::move(model);                                                          \
  }
#include "scene/lights.def"
  parameters.finish();
  return light;
}

AreaEmission make_area_emission(Parameters& parameters, LightFiles& files) {
  AreaEmission emission;
  const bool has_radiance = parameters.has("L");
  emission.radiance = white(parameters, "L");
  emission.scale = scale_of(parameters);
  emission.power = positive_or_none(parameters, "power");
  emission.two_sided = parameters.boolean("twosided", false);
  if (const Parameter* surfaces = parameters.values("surfaces", {"integer"}))
    for (const double surface : surfaces->numbers) {
      if (surface < 0) {
        parameters.error("surfaces", "are numbered from 0 up");
        break;
      }
      emission.surfaces.push_back(static_cast<std::uint32_t>(surface));
    }
  if (!parameters.text("filename", "").empty()) {
    if (has_radiance) parameters.error("filename", "cannot be combined with \"L\"");
    emission.image = files.image(parameters, "filename");
  }
  parameters.finish();
  return emission;
}

}  // namespace caplet::pbrt
