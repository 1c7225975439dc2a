// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/textures/fbm.h"

namespace caplet {

/// Sums the absolute values of the noise.
struct WrinkledTexture : FbmTexture {};

}  // namespace caplet
