// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/names.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/utf8.h"

namespace caplet {

namespace {

void make_valid(std::string& name) {
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) >= 0x80; }))
    name = valid_utf8(name);
}

void make_valid(Shape& shape) {
  make_valid(shape.name);
  if (auto* csg = std::get_if<CsgShape>(&shape.geometry))
    for (std::shared_ptr<const Shape>& operand : csg->operands) {
      auto own = std::make_shared<Shape>(*operand);  // the operand may be shared with another csg
      make_valid(*own);
      if (own->name != operand->name || std::holds_alternative<CsgShape>(own->geometry))
        operand = std::move(own);
    }
}

}  // namespace

void make_names_valid(Scene& scene) {
  for (Texture& texture : scene.textures) make_valid(texture.name);
  for (Material& material : scene.materials) make_valid(material.name);
  for (Medium& medium : scene.media) make_valid(medium.name);
  for (Shape& shape : scene.shapes) make_valid(shape);
  for (Object& object : scene.objects) {
    make_valid(object.name);
    for (Shape& shape : object.shapes) make_valid(shape);
  }
  make_valid(scene.unit);
  if (!scene.legend) return;
  make_valid(scene.legend->title);
  make_valid(scene.legend->unit);
  for (std::string& name : scene.legend->names) make_valid(name);
}

}  // namespace caplet
