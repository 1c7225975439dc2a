// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// `caplet render --noise`: renders to a noise in place of a number of samples.
#pragma once

#include <optional>

#include "cli/render_flags.h"
#include "film/sample_plan.h"
#include "render/render.h"
#include "scene/sampler.h"

namespace caplet::cli {

/// Returns what pixels are rendered to, if it is a noise, for previews of this exposure. Throws
/// InputError.
std::optional<NoiseTarget> noise_target(const RenderFlags& options,
                                        const PreviewExposure& exposure = {});

/// Returns the options with the noise that the scene's file asks for, where they have neither one
/// nor a number of samples. Throws InputError where options do not go together.
RenderFlags with_noise_of(const SamplerSettings& sampler, RenderFlags options);

/// Replaces a sampler whose points are even at one number of samples alone, and warns.
void take_open_sampler(SamplerSettings& sampler);

/// Logs how far the render came.
void tell_of(const NoiseReached& reached, const NoiseTarget& target);

}  // namespace caplet::cli
