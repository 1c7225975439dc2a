// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/texture.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/field.h"

namespace caplet {

namespace {

struct Counter : IgnoresFields {
  explicit Counter(const std::vector<Texture>& of) : textures(of) {}
  const std::vector<Texture>& textures;
  std::set<std::uint32_t> seen = {};
  std::size_t steps = 0;

  void operand(const Field&, const TextureOperand& of) {
    if (of.texture)
      add(*of.texture);
    else
      ++steps;
  }
  void factor(const Field& field, const TextureOperand& of) { operand(field, of); }

  void add(std::uint32_t texture) {
    if (steps > most_texture_steps || !seen.insert(texture).second) return;
    ++steps;
    std::visit([&](const auto& model) { model.fields(model, *this); }, textures[texture].model);
  }
};

struct Images : IgnoresFields {
  std::vector<const TextureImage*> found = {};
  void image(const Field&, const std::shared_ptr<const TextureImage>& of) {
    if (of && std::ranges::find(found, of.get()) == found.end()) found.push_back(of.get());
  }
  void vectors(const Field& field, const std::shared_ptr<const TextureImage>& of) {
    image(field, of);
  }
};

}  // namespace

std::vector<const TextureImage*> images_of(const std::vector<Texture>& textures) {
  Images images;
  for (const Texture& texture : textures)
    std::visit([&](const auto& model) { model.fields(model, images); }, texture.model);
  return images.found;
}

double decoded_value(const ImageEncoding& encoding, double value) {
  if (encoding.kind == ImageEncoding::Kind::linear) return value;
  if (encoding.kind == ImageEncoding::Kind::gamma) return std::pow(value, encoding.gamma);
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

std::size_t texture_steps(const std::vector<Texture>& textures, std::uint32_t texture) {
  Counter counter(textures);
  counter.add(texture);
  return counter.steps;
}

}  // namespace caplet
