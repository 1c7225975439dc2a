// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include <array>
#include <cstdint>

#include "scene/field.h"

namespace caplet {

/// The least noise that a picture can be rendered to.
inline constexpr double least_noise = 1e-5;
/// The noise of pictures of files that say nothing of samples.
inline constexpr double usual_noise = 0.05;
/// The most samples of a pixel of a picture that is rendered to a noise, unless asked.
inline constexpr int most_noise_samples = 1 << 14;

/// What noise is measured in (film/noise.h): shares of the luminance, or of the display's range.
enum class NoiseSpace { relative, display };
inline constexpr std::array noise_space_names = {"relative", "display"};

struct SamplerSettings {
  enum class Kind {
#define SAMPLER(name) name,
#include "shared/samplers.def"
#undef SAMPLER
  } kind = Kind::sobol;
  int samples_per_pixel = 16;
  std::uint32_t seed = 0;
  int x_strata = 4,
      y_strata =
          4;  // stratified, where their product is samples_per_pixel; else strata_of divides it
  bool jitter = true;  // stratified
  double noise = 0;    // of the picture, to which it is rendered with at most samples_per_pixel; 0:
                       // samples_per_pixel of every pixel. Not of stratified ones
  int noise_space = 0;  // NoiseSpace

  NoiseSpace space() const { return static_cast<NoiseSpace>(noise_space); }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    if (self.kind == Kind::stratified) {
      visit.integer({"xsamples", "strata along x", 1, 1 << 24}, self.x_strata);
      visit.integer({"ysamples", "strata along y", 1, 1 << 24}, self.y_strata);
      visit.flag({"jitter", "samples lie at random in their strata, else in the middle"},
                 self.jitter);
    } else {
      visit.integer({"pixelsamples", "samples of each pixel", 1, most_integer},
                    self.samples_per_pixel);
      visit.number(
          {"noise", "to which the picture is rendered, with at most pixelsamples; 0: any", 0, 1},
          self.noise);
      visit.choice({"noisespace", "what noise is a share of: luminance, or the display's range"},
                   self.noise_space, noise_space_names);
    }
    visit.seed({"seed", "another one gives other noise"}, self.seed);
  }
};

/// Returns whether the first samples of a pixel are as even as any number of them: those of the
/// others are so at the number alone that they are made for.
constexpr bool is_open_ended(SamplerSettings::Kind kind) {
  return kind == SamplerSettings::Kind::sobol || kind == SamplerSettings::Kind::independent;
}

/// Lists the names in scene files, in the order of SamplerSettings::Kind.
inline constexpr std::array sampler_names = {
#define SAMPLER(name) #name,
#include "shared/samplers.def"
#undef SAMPLER
};

/// Returns strata along x and y whose product is samples_per_pixel: the sampler's own, or else
/// those nearest to a square.
std::array<int, 2> strata_of(const SamplerSettings& sampler);

}  // namespace caplet
