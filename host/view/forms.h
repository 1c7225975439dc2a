// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Makes forms of a scene's parts from the lists of host/scene.
#pragma once

#include <nlohmann/json.hpp>

#include "scene/edit.h"
#include "scene/scene.h"
#include "view/parts.h"

namespace caplet::view {

/// Returns a part's fields in order, with name, type, value and range (docs/viewer.md), or null if
/// the part does not exist.
nlohmann::ordered_json form_text(const Scene& scene, const View& view, const FormSubject& part);

/// Returns the choices: the kinds of every list, and the named spectra.
nlohmann::ordered_json lists_text();

/// Returns materials with a representative colour, textures and lights, by name.
nlohmann::ordered_json parts_text(const Scene& scene);

// Sets `field`. Throw InputError with the field as its place when no field has that name, or the
// value has the wrong type or is out of range.
void set_field(Material& material, const Scene& scene, const Set& set);
void set_field(Texture& texture, const Scene& scene, const Set& set);
void set_field(Light& light, const Scene& scene, const Set& set);
void set_field(std::optional<AreaEmission>& emission, const Scene& scene, const Set& set);
void set_field(Shape& shape, const Scene& scene, const Set& set);
void set_field(View& view, const Scene& scene, const Set& set);

}  // namespace caplet::view
