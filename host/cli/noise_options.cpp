// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "cli/noise_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/check.h"
#include "base/error.h"
#include "base/log.h"

namespace caplet::cli {

std::optional<NoiseTarget> noise_target(const RenderFlags& options,
                                        const PreviewExposure& exposure) {
  if (!options.noise) return {};
  NoiseTarget out;
  out.noise = *options.noise;
  out.measure = {options.noise_space.value_or(NoiseSpace::relative), exposure};
  if (options.samples_per_pixel) out.most = narrow<std::uint32_t>(*options.samples_per_pixel);
  if (options.least_samples) out.least = narrow<std::uint32_t>(*options.least_samples);
  if (out.least > out.most && options.least_samples)
    throw InputError(SourceLocation{"--min-spp"},
                     fmt::format("{} is more than the most, {} (--spp)", out.least, out.most));
  out.least = std::min(out.least, out.most);
  if (!options.film.samples.empty())
    throw InputError(SourceLocation{"--samples"},
                     "does not go with --noise, which gives pixels different numbers of samples");
  return out;
}

RenderFlags with_noise_of(const SamplerSettings& sampler, RenderFlags options) {
  const bool has_own = options.noise || options.samples_per_pixel;
  if (!has_own && sampler.noise > 0) {
    if (!options.film.samples.empty())
      throw InputError(
          SourceLocation{"--samples"},
          "needs --spp: the scene is rendered to a noise, which gives pixels different "
          "numbers of samples");
    options.noise = sampler.noise;
    options.samples_per_pixel = sampler.samples_per_pixel;
    if (!options.noise_space) options.noise_space = sampler.space();
  }
  if (options.least_samples && !options.noise && !options.time_limit)
    throw InputError(SourceLocation{"--min-spp"}, "goes with --noise or --time");
  if (options.noise_space && !options.noise)
    throw InputError(SourceLocation{"--noise-space"}, "goes with --noise");
  return options;
}

void take_open_sampler(SamplerSettings& sampler) {
  if (is_open_ended(sampler.kind)) return;
  log::warn(
      "--noise: the sampler is sobol in place of {}, whose points are even at one number of "
      "samples alone",
      sampler_names.at(static_cast<std::size_t>(sampler.kind)));
  sampler.kind = SamplerSettings::Kind::sobol;
}

void tell_of(const NoiseReached& reached, const NoiseTarget& target) {
  log::info("noise {:.2f} % after {:.1f} samples per pixel in the mean{}", 100 * reached.noise,
            reached.mean_samples,
            reached.noise > target.noise
                ? fmt::format("; {:g} % are asked for, with up to {} (--spp)", 100 * target.noise,
                              target.most)
                : "");
}

}  // namespace caplet::cli
