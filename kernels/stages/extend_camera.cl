// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the closest hits of camera rays, whose queue has neighbours side by side.
#define TRACED_NEIGHBOURS 1
#include "stages/extend.cl"
