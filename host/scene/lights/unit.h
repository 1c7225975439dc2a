// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#pragma once

namespace caplet {

/// What a file may give of a light in place of its spectrum's magnitude.
enum class LightUnit { power, illuminance };

}  // namespace caplet
