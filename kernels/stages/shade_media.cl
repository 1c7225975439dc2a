// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shades the hits of rays in a scene with media.
#define SHADE_IN_MEDIA
#include "stages/shade.cl"
