// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Fibres as capsules, one from each point to the next; colours by direction, by fibre, or the file's.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "base/check.h"
#include "base/error.h"
#include "import/detail/color_map.h"
#include "import/detail/fibres.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/text_file.h"
#include "import/detail/value_colors.h"
#include "present/present.h"

namespace caplet {

namespace {

enum class ColorBy { direction, fibre, file, scalar };
constexpr int kSteps = 15;               // of a colour's component: so many materials there are at most, cubed
constexpr float kThinPart = 1.0F / 700;  // of the extent: the radius of what has none, unless a length is usual
constexpr double kMelanin = 0.5;         // light brown
constexpr float kStreamline = 0.2F;      // millimetres

float radius_asked(const ImportOptions& options, float usual) {
  const std::optional<std::string> text = options.text("radius");
  if (!text) return usual;
  float value = 0;
  const NumberError error = parse_float(*text, value);
  if (error != NumberError::none) throw InputError({"--radius"}, describe(error, *text));
  if (!(value > 0)) throw InputError({"--radius"}, "'" + *text + "' is not positive");
  return value;
}

/// Whether colours tell scalars, and which.
std::optional<FibreScalars> scalars_asked(const ImportOptions& options) {
  const std::string by = options.text("color").value_or("");
  if (by != "scalar" && !by.starts_with("scalar:")) {
    if (options.text("range")) throw InputError({"--range"}, "goes with --color scalar");
    return std::nullopt;
  }
  FibreScalars out;
  if (by != "scalar") {
    out.wanted = by.substr(std::string("scalar:").size());
    if (out.wanted.empty()) throw InputError({"--color"}, "'scalar:' names none");
  }
  return out;
}

/// Materials by the scalars; their range goes to where the options say.
ValueColors scalar_colors(Scene& scene, const FibreScalars& scalars, const ImportOptions& options) {
  if (scalars.name.empty()) {
    constexpr std::size_t most = 20;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < std::min(most, scalars.names.size()); ++i) known.push_back(caplet::quoted(scalars.names[i]));
    if (scalars.names.size() > most) known.push_back(fmt::format("and {} more", scalars.names.size() - most));
    throw InputError({"--color"}, known.empty()
                                      ? fmt::format("'{}': {} has no scalars", *options.text("color"), scene.source)
                                      : fmt::format("{} is none of the scalars of {}: {}", caplet::quoted(scalars.wanted),
                                                    scene.source, fmt::join(known, ", ")));
  }
  const ValueRange range = range_of(scalars.values);
  if (!range.is_there)
    throw InputError({"--color"}, fmt::format("{}: there is no value in {}", caplet::quoted(scalars.name), scene.source));
  if (options.seen) {
    *options.seen = range;
    options.seen->what = scalars.name;
  }
  const auto ends = options.range("range").value_or(std::pair(range.low, range.high));
  return {scene, scalars.name, ends.first, ends.second, map_steps};
}

/// Of a segment: the mean of its ends, of which one may have none.
double mean_of(float a, float b) {
  if (std::isnan(a)) return static_cast<double>(b);
  return std::isnan(b) ? static_cast<double>(a) : 0.5 * (static_cast<double>(a) + static_cast<double>(b));
}

class Colors {
 public:
  Colors(Scene& scene, ColorBy by) : scene_(scene), by_(by) {}
  std::uint32_t of(const glm::dvec3& color) {
    const glm::ivec3 step(glm::clamp(color, 0.0, 1.0) * static_cast<double>(kSteps) + 0.5);
    const auto [entry, fresh] = index_.try_emplace((step.x * (kSteps + 1) + step.y) * (kSteps + 1) + step.z,
                                                   narrow<std::uint32_t>(scene_.materials.size()));
    if (fresh) {
      const glm::dvec3 shown = glm::dvec3(step) / static_cast<double>(kSteps);
      const std::string name = by_ == ColorBy::direction
                                   ? fmt::format("direction {:.2g} {:.2g} {:.2g}", shown.x, shown.y, shown.z)
                                   : fmt::format("color {:.2g} {:.2g} {:.2g}", shown.x, shown.y, shown.z);
      // Full colours reflect nothing of two thirds of the light: 0.85 and 0.05.
      const glm::dvec3 reflectance = by_ == ColorBy::direction ? 0.05 + 0.8 * shown : shown;
      scene_.materials.push_back({DiffuseMaterial{RgbSpectrum{reflectance}}, name, {scene_.source, 0, 0}});
    }
    return entry->second;
  }

 private:
  Scene& scene_;
  ColorBy by_;
  std::map<int, std::uint32_t> index_;
};

struct Usual {
  float radius = 0;  // 0: by the extent
  ColorBy color = ColorBy::direction;
  const char* up = "y";
  bool hair = false;
  const char* unit = "";  // of the file's lengths
};

Scene scene_of(const Fibres& fibres, const std::filesystem::path& path, const ImportOptions& options, const Usual& usual,
               const FibreScalars* scalars = nullptr) {
  Scene scene;
  scene.source = path.string();
  if (fibres.points.empty()) throw InputError({scene.source, 0, 0}, "holds no fibres");
  const std::optional<FibreScalars> asked = scalars_asked(options);
  const ColorBy by = asked ? ColorBy::scalar
                           : static_cast<ColorBy>(options.choice("color", {"direction", "fibre", "file", "scalar"},
                                                                 static_cast<std::size_t>(usual.color)));
  const bool as_hair = usual.hair && !options.text("color");
  if (options.text("color") && by == ColorBy::file && fibres.colors.empty())
    throw InputError({"--color"}, "the file has no colours");
  glm::vec3 low(fibres.points[0]), high(low);
  for (const glm::vec3& p : fibres.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const float extent = glm::length(high - low);
  const float radius = radius_asked(options, usual.radius > 0 ? usual.radius : std::max(kThinPart * extent, 1e-6F));
  const bool own_radii = !fibres.radii.empty() && !options.text("radius");
  const auto radius_at = [&](std::size_t i) {
    const float own = own_radii ? fibres.radii[fibres.radii.size() == 1 ? 0 : i] : 0;
    return own > 0 ? own : radius;
  };
  if (as_hair) {
    HairMaterial hair;
    hair.sigma_a = RgbSpectrum{kMelanin * glm::dvec3(0.419, 0.697, 1.37)};  // of eumelanin: d'Eon et al. 2011
    scene.materials.push_back({hair, "hair", {scene.source, 0, 0}});
  }
  Colors colors(scene, by);
  ValueColors of_scalar;
  if (by == ColorBy::scalar) of_scalar = scalar_colors(scene, scalars ? *scalars : *asked, options);
  CapsulesShape capsules;
  bool tapered = false;
  std::size_t begin = 0;
  for (std::size_t f = 0; f < fibres.ends.size(); ++f) {
    const std::size_t end = fibres.ends[f];
    for (std::size_t i = begin; i < end; ++i) {
      // A fibre of one point is a ball.
      const std::size_t next = i + 1 < end ? i + 1 : i;
      if (next == i && end - begin > 1) break;
      const glm::vec3 p0 = fibres.points[i], p1 = fibres.points[next];
      std::uint32_t material = 0;
      if (!as_hair) {
        const glm::dvec3 d(p1 - p0);
        const double length = glm::length(d);
        switch (by) {
          case ColorBy::direction:
            material = colors.of(length > 0 ? glm::abs(d) / length : glm::dvec3(0.5));
            break;
          case ColorBy::fibre:
            material = colors.of(palette_color(f));
            break;
          case ColorBy::file:
            material = colors.of(glm::dvec3(fibres.colors[fibres.colors.size() == 1 ? 0 : i]));
            break;
          case ColorBy::scalar:
            material = of_scalar.of(scalars->of_points ? mean_of(scalars->values[i], scalars->values[next])
                                                       : static_cast<double>(scalars->values[f]));
            break;
        }
      }
      capsules.p0.push_back(p0);
      capsules.p1.push_back(p1);
      capsules.radius0.push_back(radius_at(i));
      capsules.radius1.push_back(radius_at(next));
      capsules.materials.push_back(material);
      tapered |= capsules.radius0.back() != capsules.radius1.back();
    }
    begin = end;
  }
  if (!tapered) capsules.radius1 = {};
  if (as_hair) capsules.materials = {};
  Shape shape;
  shape.geometry = std::move(capsules);
  shape.name = path.stem().string();
  shape.where = {scene.source, 0, 0};
  shape.world_from_object = world_from_file(options, usual.up);
  scene.world_from_file = glm::dmat3(shape.world_from_object);
  scene.unit = usual.unit;
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace

Scene import_hair(const std::filesystem::path& path, const ImageReader&, const ImportOptions& options) {
  return scene_of(read_hair(read_file(path, {}), path.string()), path, options, {0, ColorBy::file, "z", true});
}
Scene import_tressfx(const std::filesystem::path& path, const ImageReader&, const ImportOptions& options) {
  return scene_of(read_tressfx(read_file(path, {}), path.string()), path, options, {0, ColorBy::fibre, "y", true});
}
Scene import_trk(const std::filesystem::path& path, const ImageReader&, const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  const Fibres fibres = read_trk(read_file(path, {}), path.string(), scalars ? &*scalars : nullptr);
  return scene_of(fibres, path, options, {kStreamline, ColorBy::direction, "z", false, "mm"}, scalars ? &*scalars : nullptr);
}
Scene import_tck(const std::filesystem::path& path, const ImageReader&, const ImportOptions& options) {
  return scene_of(read_tck(read_file(path, {}), path.string()), path, options,
                  {kStreamline, ColorBy::direction, "z", false, "mm"});
}
Scene import_trx(const std::filesystem::path& path, const ImageReader&, const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  const Fibres fibres = read_trx(path, scalars ? &*scalars : nullptr);
  return scene_of(fibres, path, options, {kStreamline, ColorBy::direction, "z", false}, scalars ? &*scalars : nullptr);
}
Scene import_vtk(const std::filesystem::path& path, const ImageReader&, const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  const Fibres fibres = read_vtk(read_file(path, {}), path.string(), scalars ? &*scalars : nullptr);
  return scene_of(fibres, path, options, {0, ColorBy::direction, "z", false}, scalars ? &*scalars : nullptr);
}

}  // namespace caplet
