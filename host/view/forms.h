// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Forms of a scene's parts, made from the lists of host/scene.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/edit.h"
#include "scene/scene.h"
#include "view/parts.h"

namespace caplet::view {

/// A part's fields in order, each with its name, type, value and range (docs/viewer.md). Null where there is no such part.
nlohmann::ordered_json form_text(const Scene& scene, const ViewEdit& view, const Part& part);

/// What there is to be chosen: the kinds that the lists know, and the spectra that have names.
nlohmann::ordered_json lists_text();

/// Materials with a colour each, textures and lights by their names.
nlohmann::ordered_json parts_text(const Scene& scene);

// Sets `field`. Throw InputError with the field as its place when there is none of that name, or the value is not one of its kind
// and range.
void set_field(Material& material, const Scene& scene, const Set& set);
void set_field(Texture& texture, const Scene& scene, const Set& set);
void set_field(Light& light, const Scene& scene, const Set& set);
void set_field(std::optional<AreaEmission>& emission, const Scene& scene, const Set& set);
void set_field(Shape& shape, const Scene& scene, const Set& set);
void set_field(ViewEdit& view, const Scene& scene, const Set& set);

}  // namespace caplet::view
