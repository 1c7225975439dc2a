// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/texture.h"

#include <set>

namespace caplet {

namespace {

struct Counter {
  const std::vector<Texture>& textures;
  std::set<std::uint32_t> seen = {};
  std::size_t steps = 0;

  void operand(const char*, const TextureOperand& of) {
    if (of.texture)
      add(*of.texture);
    else
      ++steps;
  }
  void factor(const char* name, const TextureOperand& of) { operand(name, of); }
  void number(const char*, double) {}
  void fixed(const char*, int) {}
  void mapping(double, double, double, double) {}

  void add(std::uint32_t texture) {
    if (steps > most_texture_steps || !seen.insert(texture).second) return;
    ++steps;
    std::visit([&](const auto& model) { model.fields(model, *this); }, textures[texture].model);
  }
};

}  // namespace

std::size_t texture_steps(const std::vector<Texture>& textures, std::uint32_t texture) {
  Counter counter{textures};
  counter.add(texture);
  return counter.steps;
}

}  // namespace caplet
