// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/lights.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <utility>

#include "base/check.h"
#include "lower/detail/environment.h"
#include "lower/detail/family_data.h"
#include "lower/detail/light_table.h"
#include "lower/detail/light_tree.h"

namespace caplet {

namespace {

constexpr double pi = std::numbers::pi;

template <class Model>
constexpr std::uint32_t kind_of = light_count;
#define LIGHT_MODEL(name, Type) \
  template <>                   \
  constexpr std::uint32_t kind_of<Type> = light_##name;
// An InfiniteLight is one of two.
enum { light_infinite = light_count };
#include "scene/lights.def"

// Every row of lights.def has its model: `area` is an emission, and `constant` and `image` have one together.
#define LIGHT_MODEL(name, Type) +1
static_assert(2
#include "scene/lights.def"
              == light_count);

/// One light of the scene (not an emissive shape): its record, data and power.
class LightLowering {
 public:
  LightLowering(SpectrumTable& spectra, LoweredEnvironment& environment, FlatScene& out)
      : spectra_(spectra), environment_(environment), out_(out), radius_(out.world.radius) {}

  /// Luminance of the radiance of the brightest light so far, spread over all directions and the scene where it has none.
  double brightest() const { return brightest_; }

  /// `bounded`: takes the light where it is somewhere.
  void add(const Light& light, std::vector<LightShare>& shares, std::vector<TreeLight>& bounded) {
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
            bounded.push_back({narrow<uint>(shares.size() - 1),
                               {reach.position, reach.position, reach.axis, std::cos(reach.cone), std::cos(reach.reach),
                                power / model.per_unit()}});
          }
        },
        light.model);
  }

 private:
  // Every function fills `record` and returns the luminous power that reaches the scene. pbrt's "power" and "illuminance" replace
  // the magnitude that the spectrum (normalised to luminance 1; rgb as written) has by itself.

  template <class Model>
  double lower(const Model& light, LightRecord& record) {
    record.kind = kind_of<Model>;
    Emission emission{*this, record,
                      Model::unit == LightUnit::power ? replaced(light_->power, light.per_unit())
                                                      : replaced(light_->illuminance, light.per_unit())};
    Model::fields(light, emission);
    FamilyData data = data_of(record);
    light.data([&](const char* field, const auto& value) { data.put(field, value); });
    data.finish();
    return light.power(radius_) * emission.luminance;
  }

  double lower(const InfiniteLight& light, LightRecord& record) {
    if (!light.image) {
      const double power = replaced(light_->power, 4 * pi * pi * radius_ * radius_);
      record.kind = light_constant;
      emit(record, light.radiance, light_->illuminance ? replaced(light_->illuminance, pi) : power);
      brightest_ = std::max(brightest_, luminance(light.radiance, record));
      return 0;  // found by BSDF sampling
    }
    if (out_.lighting.environment_width > 0) throw InputError(light_->where, "only one infinite light may have an image");
    if (environment_.image != light.image) environment_ = {light.image, lower_environment(*light.image, out_)};
    out_.lighting.environment_width = narrow<uint>(light.image->width);
    out_.lighting.environment_height = narrow<uint>(light.image->height);
    out_.lighting.environment_square = light.image->equal_area ? 1 : 0;
    const EnvironmentIntegrals& of = environment_.integrals;
    record.kind = light_image;
    record.spectrum = spectra_.add_illuminant(RgbSpectrum{glm::dvec3(1), light.image->space});
    const double power = replaced(light_->power, of.luminance * pi * radius_ * radius_);
    record.scale =
        static_cast<float>(light_->scale * (light_->illuminance ? replaced(light_->illuminance, of.illuminance) : power));
    data_of(record).put_rows("light_from_world", light.world_from_light);  // the transpose is the inverse
    return of.luminance * pi * radius_ * radius_ * record.scale;
  }

  /// The factor for a spectrum that by itself gives a power or illuminance of `of_unit`, so that it gives `wanted`.
  static double replaced(const std::optional<double>& wanted, double of_unit) {
    if (!wanted) return 1;
    return of_unit > 0 ? *wanted / of_unit : 0;
  }

  /// Of what scene/lights.def visits, the spectrum.
  struct Emission {
    LightLowering& lowering;
    LightRecord& record;
    double factor;
    double luminance = 0;

    void emission(const char*, const Spectrum& spectrum) {
      lowering.emit(record, spectrum, factor);
      luminance = lowering.luminance(spectrum, record);
    }
    void position(const char*, const glm::dvec3&) {}
    void direction(const char*, const char*, const glm::dvec3&) {}
    void number(const char*, double, double, double) {}
    void cone(double, double) {}
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
  LoweredEnvironment& environment_;
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
  // Of a flat side its radiance by its area; of a convex solid a quarter of that, from everywhere in the mean.
  out.intensity = power / (one_way ? pi : 4 * pi);
  return out;
}

/// Makes the tree of `bounded` and takes it for one choice of `shares`, beside the lights that are in none: half of the random
/// numbers by power, half evenly to groups, as light_table has it.
void lower_many_lights(const std::vector<TreeLight>& bounded, std::vector<LightShare>& shares, FlatScene& out) {
  lower_light_tree(bounded.size() >= CAPLET_LIGHT_TREE_FROM ? bounded : std::vector<TreeLight>{}, shares.size(), out);
  out.lighting.tree_share = 0;
  if (out.lighting.tree_nodes == 0) return;
  std::vector<std::uint32_t> groups;  // of the others
  double of_tree = 0, of_others = 0;
  for (const TreeLight& light : bounded) of_tree += std::exchange(shares[light.light].power, 0);
  for (const LightShare& share : shares) {
    if (!(share.power > 0)) continue;
    of_others += share.power;
    groups.push_back(share.group);
  }
  std::ranges::sort(groups);
  const auto others = static_cast<double>(std::distance(groups.begin(), std::ranges::unique(groups).begin()));
  const double chance = 0.5 * of_tree / (of_tree + of_others) + 0.5 / (1 + others);
  out.lighting.tree_share = others > 0 ? static_cast<uint>(std::clamp(chance, 0x1p-8, 1 - 0x1p-8) * 0x1p32) : CAPLET_NONE;
}

}  // namespace

void lower_lights(const Scene& scene, const std::vector<Emitter>& emitters, SpectrumTable& spectra,
                  LoweredEnvironment& environment, FlatScene& out) {
  out.lights.clear();
  out.light_data.clear();
  out.lighting.environment_width = out.lighting.environment_height = out.lighting.environment_square = 0;
  std::vector<LightShare> shares;
  std::vector<TreeLight> bounded;
  double brightest = 0;
  out.lights.reserve(emitters.size() + scene.lights.size());
  shares.reserve(emitters.size() + scene.lights.size());
  for (const Emitter& emitter : emitters) {
    LightRecord record{};
    record.kind = light_area;
    record.spectrum = emitter.spectrum;
    record.scale = static_cast<float>(emitter.scale);
    record.flags = emitter.two_sided ? CAPLET_LIGHT_BOTH_SIDES : 0;
    record.slot = emitter.slot;
    record.instance = emitter.instance;
    record.geometry = emitter.geometry;
    record.data = CAPLET_NONE;
    if (emitter.by_ball) {
      record.data = narrow<uint>(out.light_data.size());
      out.light_data.resize(record.data + area_floats);
      FamilyData data(light_fields[light_area], &out.light_data[record.data]);
      data.put("ball_center", glm::dvec3(emitter.ball[0], emitter.ball[1], emitter.ball[2]));
      data.put("ball_radius", emitter.ball[3]);
      // Rounded up: nothing of the shape may lie outside.
      out.light_data[record.data + area_at_ball_radius] *= 1 + 0x1p-18f;
    }
    out.lights.push_back(record);
    brightest = std::max(brightest, emitter.luminance);
    const double power = pi * emitter.area * emitter.luminance * (emitter.two_sided ? 2 : 1);
    shares.push_back({std::isfinite(power) && power > 0 ? power : 0, emitter.group});
    if (shares.back().power > 0) bounded.push_back({narrow<uint>(shares.size() - 1), bounds_of(emitter, power)});
  }
  LightLowering lowering(spectra, environment, out);
  for (const Light& light : scene.lights)
    if (!is_infinite(light)) lowering.add(light, shares, bounded);
  out.lighting.infinite_begin = narrow<uint>(out.lights.size());
  for (const Light& light : scene.lights)
    if (is_infinite(light)) lowering.add(light, shares, bounded);
  if (out.lighting.environment_width == 0) {
    environment = {};
    out.environment_texels.clear();
    out.environment_cdf.clear();
  }
  out.lighting.radiance = static_cast<float>(std::max(brightest, lowering.brightest()));
  out.lighting.light_count = narrow<uint>(out.lights.size());
  out.lighting.sampled_light_count =
      narrow<uint>(std::ranges::count_if(shares, [](const LightShare& share) { return share.power > 0; }));
  lower_many_lights(bounded, shares, out);
  out.light_alias = light_table(shares);
}

}  // namespace caplet
