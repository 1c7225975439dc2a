// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "lower/detail/lights.h"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <numbers>

#include "base/check.h"
#include "lower/detail/environment.h"
#include "lower/detail/light_table.h"

namespace caplet {

namespace {

constexpr double pi = std::numbers::pi;

/// One light of the scene (not an emissive shape): its record, data and power.
class LightLowering {
 public:
  LightLowering(SpectrumTable& spectra, LoweredEnvironment& environment, FlatScene& out)
      : spectra_(spectra), environment_(environment), out_(out), radius_(out.world.radius) {}

  /// Luminance of the radiance of the brightest light so far, spread over all directions and the scene where it has none.
  double brightest() const { return brightest_; }

  void add(const Light& light, std::vector<LightShare>& shares) {
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
  }

 private:
  // Every function fills `record` and returns the luminous power that reaches the scene. pbrt's "power" and "illuminance" replace
  // the magnitude that the spectrum (normalised to luminance 1; rgb as written) has by itself.

  double lower(const PointLight& light, LightRecord& record) {
    emit(record, light_point, light.intensity, replaced(light_->power, 4 * pi));
    put(light.position);
    return 4 * pi * luminance(light.intensity, record);
  }

  double lower(const SpotLight& light, LightRecord& record) {
    const double total = std::cos(light.total_angle);
    const double start = std::cos(std::min(light.falloff_start_angle, light.total_angle));
    // The mean of the smooth edge is a half.
    const double cone = 2 * pi * ((1 - start) + (start - total) / 2);
    emit(record, light_spot, light.intensity, replaced(light_->power, cone));
    put(light.position);
    put(light.direction);
    put(total);
    put(start);
    return cone * luminance(light.intensity, record);
  }

  double lower(const DistantLight& light, LightRecord& record) {
    emit(record, light_distant, light.irradiance, replaced(light_->illuminance, 1));
    put(-light.direction);
    return pi * radius_ * radius_ * luminance(light.irradiance, record);
  }

  double lower(const InfiniteLight& light, LightRecord& record) {
    if (!light.image) {
      const double power = replaced(light_->power, 4 * pi * pi * radius_ * radius_);
      emit(record, light_constant, light.radiance, light_->illuminance ? replaced(light_->illuminance, pi) : power);
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
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) put(light.world_from_light[r][c]);  // the transpose is the inverse
    return of.luminance * pi * radius_ * radius_ * record.scale;
  }

  /// The factor for a spectrum that by itself gives a power or illuminance of `of_unit`, so that it gives `wanted`.
  static double replaced(const std::optional<double>& wanted, double of_unit) {
    if (!wanted) return 1;
    return of_unit > 0 ? *wanted / of_unit : 0;
  }

  void emit(LightRecord& record, int kind, const Spectrum& spectrum, double factor) {
    record.kind = static_cast<uint>(kind);
    record.spectrum = spectra_.add_illuminant(spectrum);
    record.scale = static_cast<float>(light_->scale * factor);
  }
  double luminance(const Spectrum& spectrum, const LightRecord& record) const {
    return spectra_.illuminant_luminance(spectrum) * record.scale;
  }
  void put(double value) { out_.light_data.push_back(static_cast<float>(value)); }
  void put(const glm::dvec3& v) {
    for (int k = 0; k < 3; ++k) put(v[k]);
  }

  SpectrumTable& spectra_;
  LoweredEnvironment& environment_;
  FlatScene& out_;
  const double radius_;
  double brightest_ = 0;
  const Light* light_ = nullptr;
};

bool is_infinite(const Light& light) { return std::holds_alternative<InfiniteLight>(light.model); }

}  // namespace

void lower_lights(const Scene& scene, const std::vector<Emitter>& emitters, SpectrumTable& spectra,
                  LoweredEnvironment& environment, FlatScene& out) {
  out.lights.clear();
  out.light_data.clear();
  out.lighting.environment_width = out.lighting.environment_height = out.lighting.environment_square = 0;
  std::vector<LightShare> shares;
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
      for (const double value : emitter.ball) out.light_data.push_back(static_cast<float>(value));
      // Rounded up: nothing of the shape may lie outside.
      out.light_data.back() *= 1 + 0x1p-18f;
    }
    out.lights.push_back(record);
    brightest = std::max(brightest, emitter.luminance);
    const double power = pi * emitter.area * emitter.luminance * (emitter.two_sided ? 2 : 1);
    shares.push_back({std::isfinite(power) && power > 0 ? power : 0, emitter.group});
  }
  LightLowering lowering(spectra, environment, out);
  for (const Light& light : scene.lights)
    if (!is_infinite(light)) lowering.add(light, shares);
  out.lighting.infinite_begin = narrow<uint>(out.lights.size());
  for (const Light& light : scene.lights)
    if (is_infinite(light)) lowering.add(light, shares);
  if (out.lighting.environment_width == 0) {
    environment = {};
    out.environment_texels.clear();
    out.environment_cdf.clear();
  }
  out.lighting.radiance = static_cast<float>(std::max(brightest, lowering.brightest()));
  out.lighting.light_count = narrow<uint>(out.lights.size());
  out.light_alias = light_table(shares);
  out.lighting.sampled_light_count = 0;
  for (const AliasRecord& row : out.light_alias)
    if (row.probability > 0) ++out.lighting.sampled_light_count;
}

}  // namespace caplet
