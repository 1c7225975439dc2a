// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Assigns the materials to the shapes that use them.
#include <algorithm>
#include <memory>

#include "import/detail/pbrt/resolve.h"
#include "scene/part_materials.h"

namespace caplet::pbrt {

void each_material(Shape& shape, const std::function<void(std::uint32_t&)>& visit) {
  visit(shape.material);
  for (std::uint32_t& material : shape.materials) visit(material);
  if (auto* parts = part_materials(shape))
    for (std::uint32_t& material : *parts) visit(material);
  if (auto* csg = std::get_if<CsgShape>(&shape.geometry))
    for (std::shared_ptr<const Shape>& operand : csg->operands) {
      auto own = std::make_shared<Shape>(*operand);  // a nested operand may be shared
      each_material(*own, visit);
      operand = std::move(own);
    }
}

void each_material(Draft& draft, const std::function<void(std::uint32_t&)>& visit) {
  draft.each_shape([&](Shape& shape) { each_material(shape, visit); });
}

void each_surface(const Shape& shape, const std::function<void(std::uint32_t)>& visit) {
  if (const auto* csg = std::get_if<CsgShape>(&shape.geometry)) {
    if (shape.materials.empty()) {
      for (const std::shared_ptr<const Shape>& operand : csg->operands)
        each_surface(*operand, visit);
      return;
    }
  }
  const auto* parts = part_materials(shape);
  if (!shape.materials.empty())
    std::ranges::for_each(shape.materials, visit);
  else if (parts && !parts->empty())
    std::ranges::for_each(*parts, visit);
  else
    visit(shape.material);
}

bool is_closed_hair(Shape& shape, const std::vector<Material>& materials) {
  const auto is_hair = [&](std::uint32_t index) {
    return index < materials.size() && std::holds_alternative<HairMaterial>(materials[index].model);
  };
  bool some = false;
  each_material(shape, [&](std::uint32_t& material) { some = some || is_hair(material); });
  return some && is_closed(shape);
}

namespace {

/// Returns the index in the scene of each use's material, or interface_material; 0 for the default
/// and for unknown names, which are errors where a shape has them.
std::vector<std::uint32_t> indices_of_uses(Draft& draft,
                                           const std::vector<std::uint32_t>& index_of_statement) {
  const std::vector<MaterialUse>& uses = draft.materials.uses;
  std::vector<std::uint32_t> index_of_use(uses.size(), 0);
  std::vector<bool> of_shape(uses.size(), false);
  each_material(draft, [&](std::uint32_t& use) { of_shape[use] = true; });
  for (std::size_t i = 1; i < uses.size(); ++i) {
    const MaterialUse& use = uses[i];
    const std::string undefined = "the material " + in_quotes(use.name) + " is not defined";
    if (use.made)
      index_of_use[i] = *use.made;
    else if (const auto statement = draft.materials.statement_of(use))
      index_of_use[i] = index_of_statement[*statement];
    else if (of_shape[i])
      draft.diagnostics.error(use.where,
                              undefined + draft.nearest(use.name, draft.materials.named));
    else  // pbrt-v4 resolves a name at the shape that uses it
      draft.warnings.add(use.where, undefined + " (no shape has it)", "undefined material");
  }
  return index_of_use;
}

/// Adds the material "interface" if a shape has it, and replaces interface_material by its index.
void add_interface(Draft& draft, std::vector<std::uint32_t>& index_of_use) {
  if (std::ranges::find(index_of_use, interface_material) == index_of_use.end()) return;
  const auto interface = static_cast<std::uint32_t>(draft.scene.materials.size());
  bool is_used = false;
  std::ranges::replace(index_of_use, interface_material, interface);
  each_material(draft, [&](std::uint32_t& use) {
    is_used = is_used || (use != 0 && index_of_use[use] == interface);
  });
  if (is_used)
    draft.scene.materials.push_back({InterfaceMaterial{}, "interface", {draft.main_file}});
}

/// Replaces the uses in shapes by indices in the scene; the default material is added if a shape
/// has it.
void assign(Draft& draft, std::vector<std::uint32_t>& index_of_use) {
  bool uses_default = false;
  index_of_use[0] = static_cast<std::uint32_t>(draft.scene.materials.size());
  each_material(draft, [&](std::uint32_t& material) {
    uses_default = uses_default || material == 0;
    material = index_of_use[material];
  });
  if (uses_default)
    draft.scene.materials.push_back({DiffuseMaterial{}, "default", {draft.main_file}});
}

void make_hair_one_sided(Draft& draft) {
  const std::vector<Material>& materials = draft.scene.materials;
  const auto is_hair = [](const Material& one) {
    return std::holds_alternative<HairMaterial>(one.model);
  };
  if (std::ranges::none_of(materials, is_hair)) return;
  draft.each_shape([&](Shape& shape) {
    if (!is_closed_hair(shape, materials)) return;
    if (!draft.materials.said_two_sided.contains(shape.where.to_string())) shape.one_sided = true;
  });
}

}  // namespace

void resolve_materials(Draft& draft) {
  const MadeMaterials made = make_materials(draft);
  std::vector<std::uint32_t> index_of_use = indices_of_uses(draft, made.indices);
  take_out_interfaces(draft, made.partly_there);
  drop_interfaces(draft, index_of_use);
  add_interface(draft, index_of_use);
  assign(draft, index_of_use);
  make_hair_one_sided(draft);
  fill_subsurfaces(draft, made.media_within);
}

}  // namespace caplet::pbrt
