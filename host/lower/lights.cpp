// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/lights.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "lower/detail/covered_ends.h"
#include "lower/detail/family_data.h"
#include "lower/detail/light_table.h"
#include "lower/light_tree.h"

namespace caplet {

namespace {

using std::numbers::pi;

template <class Model>
constexpr std::uint32_t light_kinds = light_count;
#define LIGHT_MODEL(name, Type) \
  template <>                   \
  constexpr std::uint32_t light_kinds<Type> = light_##name;
// An InfiniteLight becomes one of three kinds.
enum { light_infinite = light_count };
#include "scene/lights.def"

// Every row of lights.def has its model: `area` and `textured_area` are emissions, and `constant`,
// `image` and `portal` have one together.
#define LIGHT_MODEL(name, Type) +1
static_assert(4
#include "scene/lights.def"
              == light_count);

template <class Model>
concept HasImage = requires(const Model& model) {
  model.solid_angle(0.0, 0.0);
};
/// HasColors is true for models whose image has the colours.
template <class Model>
concept HasColors = HasImage<Model> && !requires(const Model& model) {
  model.intensity;
};

/// Returns the integral of an image over directions: of luminance, or of grey.
template <HasImage Model>
double integral_of(const Model& light) {
  const EnvironmentImage& image = *light.image;
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* rgb =
          &image.rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x))];
      const double value =
          HasColors<Model>
              ? luminance_of(rgb, image.space)
              : (static_cast<double>(usable(rgb[0])) + usable(rgb[1]) + usable(rgb[2])) / 3;
      sum += value * light.solid_angle((x + 0.5) / image.width, (y + 0.5) / image.height);
    }
  return sum / (static_cast<double>(image.width) * image.height);
}

/// LightLowering converts one light of the scene (not an emissive shape): its record, data and
/// power.
class LightLowering {
 public:
  LightLowering(SpectrumTable& spectra, LightImages& images, FlatScene& out)
      : spectra_(spectra), images_(images), out_(out), radius_(out.world.radius) {}

  /// Returns the luminance of the radiance of the brightest light so far, spread over all
  /// directions and the scene where it has none.
  double brightest() const { return brightest_; }

  /// Adds a light. `bounded` receives it if it has a place.
  void add(const Light& light, std::vector<LightShare>& shares, TreeLights& bounded) {
    light_ = &light;
    LightRecord record{};
    record.slot = record.instance = record.geometry = CAPLET_NONE;
    record.data = narrow<uint>(out_.light_data.size());
    double power = 0;
    std::visit([&](const auto& model) { power = lower(model, record); }, light.model);
    out_.lights.push_back(record);
    brightest_ = std::max(brightest_, power / (4 * pi * pi * radius_ * radius_));
    const auto group = shares.empty() ? 0 : shares.back().group + 1;
    shares.push_back({std::isfinite(power) && power > 0 ? power : 0, group});
    std::visit(
        [&](const auto& model) {
          if constexpr (requires { model.reach(); }) {
            if (!(shares.back().power > 0)) return;
            const LightReach reach = model.reach();
            bounded.add(narrow<uint>(shares.size() - 1),
                        {reach.position, reach.position, reach.axis, std::cos(reach.cone),
                         std::cos(reach.reach), power / reach.solid_angle});
          }
        },
        light.model);
  }

 private:
  // Every function fills `record` and returns the luminous power that reaches the scene. pbrt's
  // "power" and "illuminance" replace the magnitude that the spectrum (normalised to luminance 1;
  // rgb as written) has by itself.

  template <class Model>
  double lower(const Model& light, LightRecord& record) {
    record.kind = light_kinds<Model>;
    double unit;
    if constexpr (HasImage<Model>)
      unit = integral_of(light);
    else
      unit = light.per_unit();
    Emission emission(
        *this, record,
        replaced(Model::unit == LightUnit::power ? light_->power : light_->illuminance, unit));
    Model::fields(light, emission);
    if constexpr (HasColors<Model>)
      emission.emission({"filename", ""}, RgbSpectrum{glm::dvec3(1), light.image->space});
    FamilyData data = data_of(record);
    light.data([&](const char* field, const auto& value) { put(data, field, value); });
    data.finish();
    if constexpr (requires { light.power(radius_); })
      return light.power(radius_) * emission.luminance;
    else
      return unit * emission.luminance;
  }

  template <class Value>
  void put(FamilyData& data, const char* field, const Value& value) {
    data.put(field, value);
  }
  void put(FamilyData& data, const char* field, const glm::dmat3& turn) {
    data.put_rows(field, turn);
  }
  void put(FamilyData& data, const char* field, const LightPicture& picture) {
    data.put_picture(field, images_.picture(picture, out_).field);
  }
  void put(FamilyData& data, const char* field, const std::shared_ptr<const IesProfile>& profile) {
    data.put_picture(field, images_.profile(profile, out_).field);
  }

  double lower(const InfiniteLight& light, LightRecord& record) {
    if (light.portal) return lower_portal(light, record);
    if (!light.image) {
      const double power = replaced(light_->power, 4 * pi * pi * radius_ * radius_);
      record.kind = light_constant;
      emit(record, light.radiance, light_->illuminance ? replaced(light_->illuminance, pi) : power);
      brightest_ = std::max(brightest_, luminance(light.radiance, record));
      // BSDF sampling finds it as well. In a room under such a sky light samples took 1.4 times the
      // time for 1.15 times the variance.
      return 0;
    }
    const LoweredPicture picture = images_.sky(light.image, out_);
    const EnvironmentIntegrals& of = picture.integrals;
    record.kind = light_image;
    record.spectrum = spectra_.add_illuminant(RgbSpectrum{glm::dvec3(1), light.image->space});
    const double power = replaced(light_->power, of.luminance * pi * radius_ * radius_);
    record.scale = static_cast<float>(
        light_->scale *
        (light_->illuminance ? replaced(light_->illuminance, of.illuminance) : power));
    FamilyData data = data_of(record);
    data.put_rows("light_from_world", light.world_from_light);  // the transpose is the inverse
    data.put_picture("picture", picture.field);
    data.finish();
    return of.luminance * pi * radius_ * radius_ * record.scale;
  }

  /// Lowers a portal. Power and illuminance are those of the sky without its portal, but the light
  /// is chosen by what goes through the portal.
  double lower_portal(const InfiniteLight& light, LightRecord& record) {
    EnvironmentIntegrals sky{4 * pi, pi};
    if (FlatScene scratch; light.image && (light_->power || light_->illuminance))
      sky = lower_environment(*light.image, scratch);
    const LoweredPicture picture = images_.portal(light, out_);
    record.kind = light_portal;
    const Spectrum color =
        light.image ? RgbSpectrum{glm::dvec3(1), light.image->space} : light.radiance;
    emit(record, color,
         light_->illuminance ? replaced(light_->illuminance, sky.illuminance)
                             : replaced(light_->power, sky.luminance * pi * radius_ * radius_));
    const LightPortal& corners = *light.portal;
    const double width = glm::length(corners[3] - corners[0]),
                 height = glm::length(corners[1] - corners[0]);
    FamilyData data = data_of(record);
    data.put("corner", corners[0]);
    data.put_rows("portal_from_world", glm::transpose(portal_from_world(corners)));
    data.put("width", width);
    data.put("height", height);
    data.put_picture("picture", picture.field);
    data.finish();
    const double unit = luminance(color, record);
    brightest_ = std::max(brightest_, unit * picture.integrals.luminance / (2 * pi));
    return width * height * picture.integrals.illuminance * unit;
  }

  /// Returns the factor for a spectrum that by itself gives a power or illuminance of `of_unit`, so
  /// that it gives `wanted`.
  static double replaced(const std::optional<double>& wanted, double of_unit) {
    if (!wanted) return 1;
    return of_unit > 0 ? *wanted / of_unit : 0;
  }

  /// Takes the spectrum from what scene/lights.def visits.
  struct Emission : IgnoresFields {
    Emission(LightLowering& all, LightRecord& to, double times)
        : lowering(all), record(to), factor(times) {}
    LightLowering& lowering;
    LightRecord& record;
    double factor;
    double luminance = 0;

    void emission(const Field&, const Spectrum& spectrum) {
      lowering.emit(record, spectrum, factor);
      luminance = lowering.luminance(spectrum, record);
    }
  };

  void emit(LightRecord& record, const Spectrum& spectrum, double factor) {
    record.spectrum = spectra_.add_illuminant(spectrum);
    record.scale = static_cast<float>(light_->scale * factor);
  }
  double luminance(const Spectrum& spectrum, const LightRecord& record) const {
    return spectra_.illuminant_luminance(spectrum) * record.scale;
  }
  FamilyData data_of(const LightRecord& record) {
    out_.light_data.resize(record.data + light_floats[record.kind]);
    return {light_fields[record.kind], &out_.light_data[record.data]};
  }

  SpectrumTable& spectra_;
  LightImages& images_;
  FlatScene& out_;
  const double radius_;
  double brightest_ = 0;
  const Light* light_ = nullptr;
};

bool is_infinite(const Light& light) { return std::holds_alternative<InfiniteLight>(light.model); }

LightBounds bounds_of(const Emitter& emitter, double power) {
  const auto vector = [](const double* v) { return glm::dvec3(v[0], v[1], v[2]); };
  LightBounds out{vector(emitter.min), vector(emitter.max), vector(emitter.axis)};
  const bool one_way = out.axis != glm::dvec3(0);
  if (!one_way) out.axis = {0, 0, 1};
  out.cos_cone = one_way ? 1 : -1;
  // The intensity of a flat side is its radiance times its area; that of a convex solid is a
  // quarter of that, in the mean over all directions.
  out.intensity = power / (one_way ? pi : 4 * pi);
  return out;
}

/// Makes the tree of `bounded` and leaves in `shares` the lights that the table has beside it,
/// without `emitters` and the lights of the tree. The tree is one choice more: half of the random
/// numbers go by power, half evenly to groups, as in light_table.
void lower_many_lights(const TreeLights& bounded, std::size_t emitters,
                       std::vector<LightShare>& shares, FlatScene& out) {
  static const TreeLights none;
  const bool many = bounded.lights.size() >= CAPLET_LIGHT_TREE_FROM;
  lower_light_tree(many ? bounded : none, shares.size(), out);
  out.lighting.tree_share = 0;
  out.lighting.table_begin = 0;
  if (!many) return;
  std::vector<std::uint32_t> groups;  // of the others
  double of_tree = 0, of_others = 0;
  for (const TreeLights::One& light : bounded.lights)
    of_tree += std::exchange(shares[light.light].power, 0);
  for (const LightShare& share : shares) {
    if (!(share.power > 0)) continue;
    of_others += share.power;
    groups.push_back(share.group);
  }
  std::ranges::sort(groups);
  const auto others =
      static_cast<double>(std::distance(groups.begin(), std::unique(groups.begin(), groups.end())));
  const double chance = 0.5 * of_tree / (of_tree + of_others) + 0.5 / (1 + others);
  // Rows are for lights that may be chosen: emissive primitives stand first.
  out.lighting.table_begin = others > 0 ? narrow<uint>(emitters) : out.lighting.light_count;
  shares.erase(shares.begin(), shares.begin() + out.lighting.table_begin);
  out.lighting.tree_share =
      others > 0 ? static_cast<uint>(std::clamp(chance, 0x1p-8, 1 - 0x1p-8) * 0x1p32) : CAPLET_NONE;
}

}  // namespace

void lower_lights(const Scene& scene, const std::vector<Emitter>& emitters, SpectrumTable& spectra,
                  LightImages& images, FlatScene& out) {
  out.lights.clear();
  out.light_data.clear();
  images.begin();
  std::vector<LightShare> shares;
  TreeLights bounded;
  double brightest = 0;
  bounded.lights.reserve(emitters.size());
  out.lights.reserve(emitters.size() + scene.lights.size());
  shares.reserve(emitters.size() + scene.lights.size());
  const std::vector<LightCover> covers = covered_ends(emitters, out);
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    const Emitter& emitter = emitters[i];
    LightRecord record{};
    record.kind = light_area;
    record.spectrum = emitter.spectrum;
    double scale = emitter.scale, luminance = emitter.luminance;
    LoweredPicture picture;
    if (emitter.of_image) {
      picture = images.picture({emitter.of_image->image, false}, out);
      if (emitter.of_image->power) scale = picture.mean > 0 ? scale / picture.mean : 0;
      luminance = scale * picture.mean;
    }
    record.scale = static_cast<float>(scale);
    record.flags = covers[i].flags | (emitter.two_sided ? CAPLET_LIGHT_BOTH_SIDES : 0);
    record.slot = emitter.slot;
    record.instance = emitter.instance;
    record.geometry = emitter.geometry;
    record.data = CAPLET_NONE;
    const bool has_alpha = out.geometries[emitter.geometry].alpha != CAPLET_NONE;
    if (emitter.of_image || has_alpha) record.kind = light_textured_area;
    if (emitter.unseen) record.flags |= CAPLET_LIGHT_UNSEEN;
    if (emitter.by_ball || record.kind == light_textured_area) {
      record.data = narrow<uint>(out.light_data.size());
      out.light_data.resize(record.data + light_floats[record.kind]);
      FamilyData data(light_fields[record.kind], &out.light_data[record.data]);
      data.put("ball_center", glm::dvec3(emitter.ball[0], emitter.ball[1], emitter.ball[2]));
      data.put("ball_radius", emitter.by_ball ? emitter.ball[3] : -1);
      if (record.kind == light_textured_area) data.put_picture("picture", picture.field);
      // The radius is rounded up: no part of the shape may lie outside.
      static_assert(int{area_at_ball_radius} == int{textured_area_at_ball_radius} &&
                    int{area_at_ball_center} == int{textured_area_at_ball_center});
      out.light_data[record.data + area_at_ball_radius] *= 1 + 0x1p-18f;
    }
    out.lights.push_back(record);
    brightest = std::max(brightest, luminance);
    const double power =
        pi * emitter.area * covers[i].share * luminance * (emitter.two_sided ? 2 : 1);
    shares.push_back({std::isfinite(power) && power > 0 ? power : 0, emitter.group});
    if (shares.back().power > 0)
      bounded.add(narrow<uint>(shares.size() - 1), bounds_of(emitter, power));
  }
  LightLowering lowering(spectra, images, out);
  for (const Light& light : scene.lights)
    if (!is_infinite(light)) lowering.add(light, shares, bounded);
  out.lighting.infinite_begin = narrow<uint>(out.lights.size());
  for (const Light& light : scene.lights)
    if (is_infinite(light)) lowering.add(light, shares, bounded);
  images.end(out);
  out.lighting.radiance = static_cast<float>(std::max(brightest, lowering.brightest()));
  out.lighting.light_count = narrow<uint>(out.lights.size());
  out.lighting.sampled_light_count = narrow<uint>(
      std::ranges::count_if(shares, [](const LightShare& share) { return share.power > 0; }));
  lower_many_lights(bounded, emitters.size(), shares, out);
  out.light_alias = light_table(shares);
}

}  // namespace caplet
