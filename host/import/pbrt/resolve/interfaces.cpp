// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Shapes whose material is "interface", or a mix with one.
#include <algorithm>

#include "import/detail/pbrt/resolve.h"

namespace caplet::pbrt {

namespace {

std::uint32_t float_texture(Texture texture, Draft& draft) {
  texture.is_float = true;
  texture.where = {draft.main_file};
  draft.scene.textures.push_back(std::move(texture));
  return static_cast<std::uint32_t>(draft.scene.textures.size() - 1);
}

/// Returns the shape's alpha times the probability that it is there.
TextureOperand alpha_of(const PartlyThere& there, const Shape& shape, Draft& draft) {
  TextureOperand alpha = there.amount;
  if (there.inverted && alpha.texture) {
    MixTexture rest;
    rest.tex1 = 1;
    rest.tex2 = 0;
    rest.amount = alpha;
    alpha = 0;
    alpha.texture = float_texture({rest, true, "", {}}, draft);
  } else if (there.inverted) {
    alpha = 1 - std::get<ConstantSpectrum>(alpha.value).value;
  }
  if (shape.alpha) {
    ScaleTexture both;
    both.tex = *shape.alpha;
    both.scale = alpha;
    alpha = 0;
    alpha.texture = float_texture({both, true, "", {}}, draft);
  }
  return alpha;
}

}  // namespace

void take_out_interfaces(Draft& draft, const std::map<std::size_t, PartlyThere>& partly_there) {
  if (partly_there.empty()) return;
  const auto probability_of = [&](std::uint32_t use) -> const PartlyThere* {
    const auto statement = draft.materials.statement_of(draft.materials.uses[use]);
    const auto found = statement ? partly_there.find(*statement) : partly_there.end();
    return found == partly_there.end() ? nullptr : &found->second;
  };
  const auto visit = [&](Shape& shape) {
    const PartlyThere* of = nullptr;
    bool all = true, some = false;
    each_surface(shape, [&](std::uint32_t use) {
      const PartlyThere* const own = probability_of(use);
      all = all && own && (!some || own == of);
      some = some || own;
      of = own ? own : of;
    });
    if (!some) return;
    if (!all)
      return draft.diagnostics.error(
          shape.where, "all of a shape has one material where one is a mix with an interface");
    if (shape.emission)
      return draft.diagnostics.error(
          shape.where, "the shape is an area light, whose material is no mix with an interface");
    if (shape.media.differ() || of->subsurface)
      return draft.diagnostics.error(
          shape.where,
          "the shape parts media, and its material is a mix with an interface: it would be both");
    shape.alpha = alpha_of(*of, shape, draft);
  };
  draft.each_shape(visit);
}

void drop_interfaces(Draft& draft, const std::vector<std::uint32_t>& index_of_use) {
  const auto is_interface = [&](std::uint32_t use) {
    return use != 0 && index_of_use[use] == interface_material;
  };
  const auto passes = [&](Shape& shape) {
    bool all = true;
    each_surface(shape, [&](std::uint32_t use) { all = all && is_interface(use); });
    if (all && shape.emission) {
      const std::string dark = "the shape emits nothing, as its material is \"interface\"";
      draft.warnings.add(shape.where, dark, dark);
      shape.emission.reset();
    }
    return all && !shape.media.differ();
  };
  std::erase_if(draft.scene.shapes, passes);
  for (Object& object : draft.scene.objects) std::erase_if(object.shapes, passes);
}

}  // namespace caplet::pbrt
