// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "scene/append.h"

#include <array>
#include <map>
#include <memory>
#include <utility>

#include "base/check.h"
#include "scene/field.h"
#include "scene/part_materials.h"

namespace caplet {

namespace {

std::uint32_t count_of(std::size_t count) { return narrow<std::uint32_t>(count); }

/// Shifts the indices of the textures that a texture uses as operands.
struct MoveOperands : IgnoresFields {
  std::uint32_t by = 0;
  void operand(const Field&, TextureOperand& operand) const {
    if (operand.texture) *operand.texture += by;
  }
  void factor(const Field& field, TextureOperand& factor) const { operand(field, factor); }
};

class Appending {
 public:
  Appending(Scene& to, Scene& part) : to_(to), part_(part) {
    out_.textures = count_of(to.textures.size());
    out_.media = count_of(to.media.size());
    out_.objects = count_of(to.objects.size());
  }

  Appended run() {
    for (Texture& texture : part_.textures) {
      MoveOperands move;
      move.by = out_.textures;
      std::visit([&](auto& model) { std::remove_cvref_t<decltype(model)>::fields(model, move); },
                 texture.model);
      to_.textures.push_back(std::move(texture));
    }
    add_materials();
    for (Medium& medium : part_.media) to_.media.push_back(std::move(medium));
    for (Shape& shape : part_.shapes) {
      move(shape);
      to_.shapes.push_back(std::move(shape));
    }
    for (Object& object : part_.objects) {
      for (Shape& shape : object.shapes) move(shape);
      to_.objects.push_back(std::move(object));
    }
    for (Instance& instance : part_.instances) {
      instance.object += out_.objects;
      to_.instances.push_back(instance);
    }
    for (Light& light : part_.lights) to_.lights.push_back(std::move(light));
    return std::move(out_);
  }

 private:
  using Key = std::pair<std::string, std::array<double, 3>>;
  static std::optional<Key> key_of(const Material& material) {
    const auto* diffuse = std::get_if<DiffuseMaterial>(&material.model);
    const auto* rgb = diffuse ? std::get_if<RgbSpectrum>(&diffuse->reflectance) : nullptr;
    if (!rgb || material.name.empty() || !material.textures.empty() || material.displacement ||
        material.normalmap)
      return {};
    if (rgb->space != RgbSpectrum{}.space) return {};
    return Key{material.name, {rgb->rgb.x, rgb->rgb.y, rgb->rgb.z}};
  }

  void add_materials() {
    std::map<Key, std::uint32_t> there;
    for (std::size_t i = 0; i < to_.materials.size(); ++i)
      if (auto key = key_of(to_.materials[i])) there.try_emplace(*std::move(key), count_of(i));
    std::uint32_t next = count_of(to_.materials.size());
    const std::uint32_t first = next;
    for (const Material& material : part_.materials) {
      const std::optional<Key> key = key_of(material);
      const auto found = key ? there.find(*key) : there.end();
      out_.materials.push_back(found == there.end() ? next++ : found->second);
    }
    for (std::size_t i = 0; i < part_.materials.size(); ++i) {
      if (out_.materials[i] < first) continue;
      Material& material = part_.materials[i];
      for (TexturedField& field : material.textures) field.texture += out_.textures;
      for (auto* bend : {&material.displacement, &material.normalmap})
        if (*bend) **bend += out_.textures;
      if (auto* mix = std::get_if<MixMaterial>(&material.model))
        for (std::uint32_t& one : mix->materials) one = out_.materials.at(one);
      to_.materials.push_back(std::move(material));
    }
  }

  void move(Shape& shape) {
    shape.material =
        shape.material < out_.materials.size() ? out_.materials[shape.material] : shape.material;
    for (std::uint32_t& one : shape.materials) one = out_.materials.at(one);
    if (auto* parts = part_materials(shape))
      for (std::uint32_t& one : *parts) one = out_.materials.at(one);
    if (auto* csg = std::get_if<CsgShape>(&shape.geometry))
      for (std::shared_ptr<const Shape>& operand : csg->operands) {
        auto own = std::make_shared<Shape>(*operand);  // the operand may be shared with another csg
        move(*own);
        operand = std::move(own);
      }
    if (shape.alpha && shape.alpha->texture) *shape.alpha->texture += out_.textures;
    for (auto* side : {&shape.media.inside, &shape.media.outside})
      if (*side) **side += out_.media;
  }

  Scene& to_;
  Scene& part_;
  Appended out_;
};

}  // namespace

void prefix_names(Scene& scene, const std::string& name, const std::string& itself) {
  const auto rename = [&](std::string& one) {
    one = one.empty() || one == itself ? name : name + ": " + one;
  };
  for (Shape& shape : scene.shapes) rename(shape.name);
  for (Object& object : scene.objects) {
    rename(object.name);
    for (Shape& shape : object.shapes) rename(shape.name);
  }
}

Appended append(Scene& to, Scene part) { return Appending(to, part).run(); }

}  // namespace caplet
