// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The stage `clip` for scenes with media, whose boundaries paths carry.
#define CLIP_IN_MEDIA
#include "stages/clip.cl"
