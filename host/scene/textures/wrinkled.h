// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

#include "scene/textures/fbm.h"

namespace caplet {

/// The same of the noise's magnitude.
struct WrinkledTexture : FbmTexture {};

}  // namespace caplet
