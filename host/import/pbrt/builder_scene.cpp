// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Directives that say what the scene contains: materials, textures, media, lights and shapes.
#include <algorithm>
#include <utility>

#include "import/detail/pbrt/builder.h"
#include "import/detail/pbrt/media.h"
#include "import/detail/pbrt/names.h"
#include "import/detail/pbrt/shapes.h"
#include "import/detail/pbrt/v3.h"

namespace caplet::pbrt {

void SceneBuilder::material(const Statement& at, const std::string& type_or_none,
                            ParameterList own) {
  std::string type = type_or_none;
  if (type.empty() || type == "none") {
    const std::string old = "Material " + in_quotes(type) + " is the old name of \"interface\"";
    draft_.warnings.add(at.where, old, old);
    type = "interface";
  }
  Parameters given = to_.parameters(at, at.of(type), std::move(own), "material");
  const Refusal refusal = refusal_of("Material", type);
  if (!refusal.is_known) {
    draft_.diagnostics.error(at.where, refusal.text, refusal.text);
    to_.state.material = 0;
    return;
  }
  MaterialDraft& materials = draft_.materials;
  to_.state.material = static_cast<std::uint32_t>(materials.uses.size());
  materials.uses.push_back({materials.statements.size(), {}, at.where});
  materials.statements.push_back({type, {}, std::move(given), refusal.text, at.where});
}

void SceneBuilder::make_named_material(const Statement& at, const std::string& name,
                                       ParameterList own) {
  Parameters given = to_.parameters(at, at.of(name), std::move(own), "material");
  const bool has_type = given.has("type");
  const std::string type = given.text("type", "");
  MaterialDraft& materials = draft_.materials;
  if (!materials.named.emplace(name, materials.statements.size()).second) {
    draft_.diagnostics.error(at.where, "the material " + in_quotes(name) + " is defined twice");
    return;
  }
  if (!has_type) given.error("\"string type\" is missing");
  const Refusal refusal = has_type ? refusal_of("Material", type) : Refusal{};
  const SourceLocation where = given.where("type");
  if (!refusal.is_known) draft_.diagnostics.error(where, refusal.text, refusal.text);
  materials.statements.push_back(
      {refusal.is_known ? type : "", name, std::move(given), refusal.text, where});
}

void SceneBuilder::named_material(const Statement&, const Word& name) {
  to_.state.material = draft_.materials.use_of_name(name.text, name.where);
}

void SceneBuilder::texture(const Statement& at, const std::string& name, const Word& kind,
                           const Word& texture_class, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(name), std::move(own), "texture");
  if (to_.state.transform.start.is_skewed()) to_.check_place();
  if (kind.text != "float" && kind.text != "spectrum") {
    const std::string old = v3_name("Texture", kind.text),
                      said = "a texture is \"float\" or \"spectrum\", not " + in_quotes(kind.text);
    draft_.diagnostics.error(kind.where, said + (old.empty() ? "" : ": that is " + old), said);
    return;
  }
  bool known = false;
  for (const NameTable& table : name_tables())
    if (table.directive == "Texture")
      known = std::find(table.refused.begin(), table.refused.end(), texture_class.text) !=
                  table.refused.end() ||
              check_name("Texture", texture_class.text, texture_class.where, draft_.diagnostics);
  if (!known) return;
  TextureValue value = make_texture(name, kind.text, texture_class.text, given, draft_.textures,
                                    {to_.state.transform.start.matrix(),
                                     to_.state.transform.start.inverse(), draft_.image_finder()},
                                    draft_.scene);
  if (!draft_.textures.add(name, std::move(value)))
    draft_.diagnostics.error(at.where, "the texture " + in_quotes(name) + " is defined twice");
}

void SceneBuilder::make_named_medium(const Statement& at, const std::string& name,
                                     ParameterList own) {
  Parameters given = to_.parameters(at, at.of(name), std::move(own), "medium");
  if (to_.state.transform.start.is_skewed()) to_.check_place();
  const bool has_type = given.has("type");
  const std::string type = given.text("type", "");
  const auto [found, fresh] = draft_.media.statements.emplace(name, MediumStatement{});
  if (!fresh) {
    draft_.diagnostics.error(at.where, "the medium " + in_quotes(name) +
                                           " is defined twice (first at " +
                                           found->second.medium.where.to_string() + ")");
    return;
  }
  found->second.medium.where = at.where;
  if (!has_type) return given.error("\"string type\" is missing");
  const Refusal refusal = refusal_of("MakeNamedMedium", type);
  if (!refusal.text.empty()) {
    draft_.diagnostics.error(given.where("type"), refusal.text, refusal.text);
    return;
  }
  to_.warn_that_stays(at, "a medium");
  found->second.medium = make_medium(type, name, given, to_.state.transform.start.matrix());
  found->second.sound = true;
}

std::optional<std::uint32_t> SceneBuilder::side_of(const Word& medium) {
  if (medium.text.empty()) return std::nullopt;
  draft_.media.uses.push_back({medium.text, medium.where});
  return static_cast<std::uint32_t>(draft_.media.uses.size() - 1);
}

void SceneBuilder::medium_interface(const Statement&, const Word& inside,
                                    const std::optional<Word>& outside) {
  to_.state.media.inside = side_of(inside);
  to_.state.media.outside = outside ? side_of(*outside) : to_.state.media.inside;
}

void SceneBuilder::light_source(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own), "light");
  const glm::dmat4 world_from_light =
      to_.state.transform.start.place_of_light(type, draft_.diagnostics);
  to_.warn_that_stays(at, "a light without a shape");
  if (!to_.check_type(at, type)) return;
  if (auto light = make_light(type, given, world_from_light, to_.light_files))
    draft_.scene.lights.push_back(std::move(*light));
}

void SceneBuilder::area_light_source(const Statement& at, const std::string& type,
                                     ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own), "light");
  if (to_.check_type(at, type)) to_.state.emission = make_area_emission(given, to_.light_files);
}

void SceneBuilder::shape(const Statement& at, const std::string& type, ParameterList own) {
  Parameters given = to_.parameters(at, at.of(type), std::move(own), "shape");
  to_.check_place();
  if (!to_.check_type(at, type)) return;
  if (is_file_shape(type)) return add_shapes_of_file(at, type, given, to_);
  const GraphicsState& state = to_.state;
  const auto by_name = [this](const std::string& name, const SourceLocation& where) {
    return draft_.materials.use_of_name(name, where);
  };
  const auto finished = [this](const std::string& name, std::string& problem) {
    return finished_object(name, problem);
  };
  Shape shape = make_shape(type, given, state.material, {draft_.textures, by_name, finished});
  if (!state.transform.moves()) shape.world_from_object = state.transform.start.matrix();
  shape.reverse_orientation = state.reverse_orientation;
  shape.emission = state.emission;
  shape.media = state.media;
  if (!shape.one_sided && given.has("onesided"))
    draft_.materials.said_two_sided.insert(shape.where.to_string());
  const auto& open = draft_.objects.open;
  if (state.transform.moves()) {
    to_.draft.objects.add_moving(std::move(shape), to_.keys(), draft_.scene);
    return;
  }
  (open ? draft_.scene.objects[*open].shapes : draft_.scene.shapes).push_back(std::move(shape));
}

FinishedObject SceneBuilder::finished_object(const std::string& name, std::string& problem) const {
  const ObjectDraft& objects = draft_.objects;
  const auto found = objects.names.find(name);
  if (found == objects.names.end()) {
    problem = "names the object " + in_quotes(name) + ", which is not defined before this" +
              draft_.nearest(name, objects.names);
    return {};
  }
  const Object& object = draft_.scene.objects[found->second];
  if (objects.open != found->second) {
    FinishedObject out{&object};
    for (const ObjectDraft::MovingShape& moving : objects.moving)
      if (moving.of == found->second)
        out.moving.push_back({&draft_.scene.objects[moving.object].shapes[0], &moving.motion});
    return out;
  }
  problem = "names the object " + in_quotes(name) + ", which is being defined (" +
            object.where.to_string() + "): a csg cannot hold itself";
  return {};
}

}  // namespace caplet::pbrt
