// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Draws fibres as capsules from each point to the next, coloured by direction, by fibre, or as in
// the file.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/check.h"
#include "base/error.h"
#include "import/color_map.h"
#include "import/detail/fibres.h"
#include "import/detail/gzip_file.h"
#include "import/detail/importers.h"
#include "import/detail/mesh_file.h"
#include "import/detail/text_file.h"
#include "import/detail/value_colors.h"
#include "present/present.h"

namespace caplet {

namespace {

enum class FibreColor { direction, fibre, file, scalar };
// Levels per colour component: the first that gives at most kMostColors materials is used. The last
// always does.
constexpr int kSteps[] = {255, 85, 51, 17, 15};
constexpr std::size_t kMostColors = 16 * 16 * 16;
constexpr float kThinPart =
    1.0F / 700;  // of the extent: the default radius where the format has no usual one
constexpr double kMelanin = 0.5;     // light brown
constexpr float kStreamline = 0.2F;  // millimetres
constexpr double kNoMean = std::numeric_limits<double>::quiet_NaN();

float radius_asked(const ImportOptions& options, float usual) {
  const std::optional<std::string> text = options.text("radius");
  if (!text) return usual;
  float value = 0;
  const NumberError error = parse_float(*text, value);
  if (error != NumberError::none) throw InputError({"--radius"}, describe(error, *text));
  if (!(value > 0)) throw InputError({"--radius"}, "'" + *text + "' is not positive");
  return value;
}

/// Returns the scalars that colours show, if the options ask for them.
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

/// Makes materials by the scalars, whose range is added to that of the options.
ValueColors scalar_colors(Scene& scene, const FibreScalars& scalars, const ImportOptions& options) {
  if (scalars.name.empty()) {
    constexpr std::size_t most = 20;
    std::vector<std::string> known;
    for (std::size_t i = 0; i < std::min(most, scalars.names.size()); ++i)
      known.push_back(caplet::quoted(scalars.names[i]));
    if (scalars.names.size() > most)
      known.push_back(fmt::format("and {} more", scalars.names.size() - most));
    throw InputError(
        {"--color"},
        known.empty()
            ? fmt::format("'{}': {} has no scalars", *options.text("color"), scene.source)
            : fmt::format("{} is none of the scalars of {}: {}", caplet::quoted(scalars.wanted),
                          scene.source, fmt::join(known, ", ")));
  }
  const ValueRange range = range_of(scalars.values);
  if (!range.is_there)
    throw InputError({"--color"}, fmt::format("{}: there is no value in {}",
                                              caplet::quoted(scalars.name), scene.source));
  if (options.seen) {
    *options.seen = range;
    options.seen->what = scalars.name;
  }
  const auto ends = options.range("range").value_or(std::pair(range.low, range.high));
  return {scene, scalars.name, ends.first, ends.second, map_steps};
}

/// Returns the mean of a segment's ends, one of which may have no value.
double mean_of(float a, float b) {
  if (std::isnan(a)) return static_cast<double>(b);
  return std::isnan(b) ? static_cast<double>(a)
                       : 0.5 * (static_cast<double>(a) + static_cast<double>(b));
}

/// The materials of the capsules, in their order, by colour.
class FibreColors {
 public:
  FibreColors(Scene& scene, FibreColor by) : scene_(scene), by_(by) {}
  void reserve(std::size_t count) { keys_.reserve(count); }
  void add(const glm::dvec3& color) {
    const glm::uvec3 step(glm::clamp(color, 0.0, 1.0) * static_cast<double>(kSteps[0]) + 0.5);
    keys_.push_back((step.x << 16U) + (step.y << 8U) + step.z);
  }

  /// Returns them; no colours are left.
  std::vector<std::uint32_t> materials() {
    const auto same = [](std::uint32_t key) { return key; };
    const std::vector<std::uint32_t> colors = distinct(keys_, same);
    const auto* steps = kSteps;
    while (distinct(colors, [&](auto key) { return cell_of(key, *steps); }).size() > kMostColors)
      ++steps;
    std::map<std::uint32_t, std::uint32_t> index;
    for (std::uint32_t& key : keys_) {
      const std::uint32_t cell = cell_of(key, *steps);
      const auto [entry, fresh] =
          index.try_emplace(cell, narrow<std::uint32_t>(scene_.materials.size()));
      if (fresh)
        add_material(glm::dvec3(cell >> 16U, cell >> 8U & 255U, cell & 255U) /
                     static_cast<double>(*steps));
      key = entry->second;
    }
    return std::move(keys_);
  }

 private:
  /// Returns each value that `of` gives for the keys, once.
  template <class Of>
  static std::vector<std::uint32_t> distinct(const std::vector<std::uint32_t>& keys, const Of& of) {
    std::vector<bool> seen(std::size_t{1} << 24U);
    std::vector<std::uint32_t> out;
    for (const std::uint32_t key : keys) {
      const std::uint32_t value = of(key);
      if (!seen[value]) out.push_back(value);
      seen[value] = true;
    }
    return out;
  }
  static std::uint32_t cell_of(std::uint32_t key, int steps) {
    const auto one = [&](unsigned shift) {
      return ((key >> shift & 255U) * static_cast<std::uint32_t>(steps) + 127U) / 255U << shift;
    };
    return one(16) + one(8) + one(0);
  }
  void add_material(const glm::dvec3& shown) {
    const std::string name =
        fmt::format("{} {:.3g} {:.3g} {:.3g}", by_ == FibreColor::direction ? "direction" : "color",
                    shown.x, shown.y, shown.z);
    const glm::dvec3 reflectance = by_ == FibreColor::direction ? direction_color(shown) : shown;
    scene_.materials.push_back(
        {DiffuseMaterial{RgbSpectrum{reflectance}}, name, {scene_.source, 0, 0}});
  }

  Scene& scene_;
  FibreColor by_;
  std::vector<std::uint32_t> keys_;  // a colour in steps of 1/255
};

/// Returns how far along its fibre each point is, from 0 to 1: by length, or by number where the
/// length is 0.
std::vector<float> shares_along(const glm::vec3* points, std::size_t count) {
  std::vector<double> way(count, 0);
  for (std::size_t i = 1; i < count; ++i)
    way[i] = way[i - 1] + glm::length(glm::dvec3(points[i]) - glm::dvec3(points[i - 1]));
  std::vector<float> out(count, 0);
  for (std::size_t i = 1; i < count; ++i)
    out[i] = static_cast<float>(way.back() > 0
                                    ? way[i] / way.back()
                                    : static_cast<double>(i) / static_cast<double>(count - 1));
  return out;
}

/// Reads an option that is a share; none if it is not given. Throws InputError.
std::optional<double> share_asked(const ImportOptions& options, const std::string& name) {
  const std::optional<std::string> text = options.text(name);
  if (!text) return std::nullopt;
  double out = 0;
  if (!parse_number(*text, out) || !(out > 0 && out <= 1))
    throw InputError({"--" + name}, caplet::quoted(*text) + " is no number above 0 and up to 1");
  return out;
}

/// Which fibres are drawn.
class FibreChoice {
 public:
  explicit FibreChoice(const ImportOptions& options)
      : share_(share_asked(options, "share")),
        lengths_(options.range("lengths")),
        values_(options.range("values")) {}

  /// `value`: the mean of the fibre's values; NaN where there are none.
  bool keeps(std::size_t fibre, std::span<const glm::vec3> points, double value) const {
    if (share_ && !(part_of(fibre) < *share_)) return false;
    if (values_ && !(value >= values_->first && value <= values_->second)) return false;
    if (!lengths_) return true;
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
      length += glm::length(glm::dvec3(points[i]) - glm::dvec3(points[i - 1]));
    return length >= lengths_->first && length <= lengths_->second;
  }
  bool needs_values() const { return values_.has_value(); }

 private:
  /// Returns an even share of 0 to 1 by the number alone (Steele, Lea and Flood 2014, SplitMix64),
  /// so that a smaller share is part of a larger one.
  static double part_of(std::uint64_t fibre) {
    std::uint64_t z = (fibre + 1) * 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30U) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27U) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ z >> 31U) >> 11U) * 0x1p-53;
  }

  std::optional<double> share_;
  std::optional<std::pair<double, double>> lengths_, values_;
};

/// Returns the mean of a fibre's values that are numbers.
double mean_value(const FibreScalars& scalars, std::size_t fibre, std::size_t begin,
                  std::size_t end) {
  if (!scalars.of_points) return static_cast<double>(scalars.values[fibre]);
  double sum = 0, count = 0;
  for (std::size_t i = begin; i < end; ++i)
    if (const auto value = static_cast<double>(scalars.values[i]); !std::isnan(value)) {
      sum += value;
      ++count;
    }
  return count > 0 ? sum / count : kNoMean;
}

struct Usual {
  float radius = 0;  // 0: derived from the extent
  FibreColor color = FibreColor::direction;
  const char* up = "y";
  bool hair = false;
  const char* unit = "";  // of lengths in the file
};

Scene scene_of(Fibres fibres, const std::filesystem::path& path, const ImportOptions& options,
               const Usual& usual, const FibreScalars* scalars = nullptr) {
  Scene scene;
  scene.source = path.string();
  if (fibres.points.empty()) throw InputError({scene.source, 0, 0}, "holds no fibres");
  const std::optional<FibreScalars> asked = scalars_asked(options);
  const FibreColor by = asked ? FibreColor::scalar
                              : static_cast<FibreColor>(options.choice(
                                    "color", {"direction", "fibre", "file", "scalar"},
                                    static_cast<std::size_t>(usual.color)));
  const bool as_hair = usual.hair && !options.text("color");
  if (options.text("color") && by == FibreColor::file && fibres.colors.empty())
    throw InputError({"--color"}, "the file has no colours");
  glm::vec3 low(fibres.points[0]), high(low);
  for (const glm::vec3& p : fibres.points) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const float extent = glm::length(high - low);
  const float radius =
      radius_asked(options, usual.radius > 0 ? usual.radius : std::max(kThinPart * extent, 1e-6F));
  const bool own_radii = !fibres.radii.empty() && !options.text("radius");
  // Only files with a radius for each point have tapered fibres.
  const bool may_taper = own_radii && fibres.radii.size() > 1;
  const auto radius_at = [&](std::size_t i) {
    const float own = own_radii ? fibres.radii[fibres.radii.size() == 1 ? 0 : i] : 0;
    return own > 0 ? own : radius;
  };
  if (as_hair) {
    HairMaterial hair;
    hair.sigma_a = RgbSpectrum{
        kMelanin * glm::dvec3(0.419, 0.697, 1.37)};  // absorption of eumelanin: d'Eon et al. 2011
    scene.materials.push_back({hair, "hair", {scene.source, 0, 0}});
  }
  FibreColors colors(scene, by);
  ValueColors of_scalar;
  if (by == FibreColor::scalar)
    of_scalar = scalar_colors(scene, scalars ? *scalars : *asked, options);
  const FibreChoice choice(options);
  if (choice.needs_values() && by != FibreColor::scalar)
    throw InputError({"--values"}, "goes with --color scalar");
  CapsulesShape capsules;
  const std::size_t most = fibres.points.size();
  capsules.p0.reserve(most);
  capsules.p1.reserve(most);
  capsules.radius0.reserve(most);
  capsules.u.reserve(most);
  if (may_taper) capsules.radius1.reserve(most);
  if (!as_hair && by != FibreColor::scalar) colors.reserve(most);
  bool tapered = false;
  std::size_t begin = 0, drawn = 0;
  for (std::size_t f = 0; f < fibres.ends.size(); ++f) {
    const std::size_t end = fibres.ends[f];
    if (!choice.keeps(f, std::span(fibres.points).subspan(begin, end - begin),
                      scalars ? mean_value(*scalars, f, begin, end) : kNoMean)) {
      begin = end;
      continue;
    }
    ++drawn;
    const std::vector<float> u = shares_along(fibres.points.data() + begin, end - begin);
    for (std::size_t i = begin; i < end; ++i) {
      // A fibre of one point becomes a ball.
      const std::size_t next = i + 1 < end ? i + 1 : i;
      if (next == i && end - begin > 1) break;
      const glm::vec3 p0 = fibres.points[i], p1 = fibres.points[next];
      if (!as_hair) {
        const glm::dvec3 d(p1 - p0);
        const double length = glm::length(d);
        switch (by) {
          case FibreColor::direction:
            colors.add(length > 0 ? glm::abs(d) / length : glm::dvec3(0.5));
            break;
          case FibreColor::fibre:
            colors.add(palette_color(f));
            break;
          case FibreColor::file:
            colors.add(glm::dvec3(fibres.colors[fibres.colors.size() == 1 ? 0 : i]));
            break;
          case FibreColor::scalar:
            capsules.materials.push_back(
                of_scalar.of(scalars->of_points ? mean_of(scalars->values[i], scalars->values[next])
                                                : static_cast<double>(scalars->values[f])));
            break;
        }
      }
      capsules.p0.push_back(p0);
      capsules.p1.push_back(p1);
      capsules.radius0.push_back(radius_at(i));
      if (may_taper) capsules.radius1.push_back(radius_at(next));
      capsules.u.emplace_back(u[i - begin], u[next - begin]);
      tapered |= may_taper && capsules.radius0.back() != capsules.radius1.back();
    }
    begin = end;
  }
  if (drawn == 0)
    throw InputError(
        {scene.source, 0, 0},
        fmt::format("--share, --lengths and --values leave none of {} fibres", fibres.ends.size()));
  if (!tapered) capsules.radius1 = {};
  fibres = {};
  if (!as_hair && by != FibreColor::scalar) capsules.materials = colors.materials();
  Shape shape;
  shape.geometry = std::move(capsules);
  shape.name = path.stem().string();
  if (const auto opacity = share_asked(options, "opacity"); opacity && *opacity < 1)
    shape.alpha = TextureOperand(*opacity);
  shape.where = {scene.source, 0, 0};
  shape.world_from_object = world_from_file(options, usual.up);
  scene.world_from_file = glm::dmat3(shape.world_from_object);
  scene.contents = {{"fibres", drawn}};
  scene.unit = usual.unit;
  if (by == FibreColor::direction && !as_hair) {
    scene.legend = Legend{"Direction", "", 0, 1, {}};
    scene.legend->of_directions = true;
  }
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace

Scene import_hair(const std::filesystem::path& path, const ImageReader&,
                  const ImportOptions& options) {
  Fibres fibres = read_hair(read_file(path, {}), path.string());
  return scene_of(std::move(fibres), path, options, {0, FibreColor::file, "z", true});
}
Scene import_tressfx(const std::filesystem::path& path, const ImageReader&,
                     const ImportOptions& options) {
  Fibres fibres = read_tressfx(read_file(path, {}), path.string());
  return scene_of(std::move(fibres), path, options, {0, FibreColor::fibre, "y", true});
}
Scene import_trk(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  Fibres fibres = read_trk(read_file(path, {}), path.string(), scalars ? &*scalars : nullptr);
  return scene_of(std::move(fibres), path, options,
                  {kStreamline, FibreColor::direction, "z", false, "mm"},
                  scalars ? &*scalars : nullptr);
}
Scene import_tck(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  Fibres fibres = read_tck(read_file(path, {}), path.string());
  return scene_of(std::move(fibres), path, options,
                  {kStreamline, FibreColor::direction, "z", false, "mm"});
}
Scene import_trx(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  Fibres fibres = read_trx(path, scalars ? &*scalars : nullptr);
  return scene_of(std::move(fibres), path, options,
                  {kStreamline, FibreColor::direction, "z", false}, scalars ? &*scalars : nullptr);
}
Scene import_vtk(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  Fibres fibres = read_vtk(read_file(path, {}), path.string(), scalars ? &*scalars : nullptr);
  return scene_of(std::move(fibres), path, options, {0, FibreColor::direction, "z", false},
                  scalars ? &*scalars : nullptr);
}
Scene import_vtp(const std::filesystem::path& path, const ImageReader&,
                 const ImportOptions& options) {
  std::optional<FibreScalars> scalars = scalars_asked(options);
  Fibres fibres = read_vtp(read_file(path, {}), path.string(), scalars ? &*scalars : nullptr);
  return scene_of(std::move(fibres), path, options, {0, FibreColor::direction, "z", false},
                  scalars ? &*scalars : nullptr);
}

}  // namespace caplet
