// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/detail/pbrt/builder.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/reading.h"
#include "import/detail/pbrt/names.h"
#include "import/detail/pbrt/resolve.h"
#include "present/present.h"

namespace caplet::pbrt {

void Warnings::add(const SourceLocation& where, const std::string& message,
                   const std::string& kind) {
  if (const auto found = std::ranges::find(warnings_, kind, &Warning::kind);
      found != warnings_.end())
    ++found->others;
  else
    warnings_.push_back({where, message, kind});
}

void Warnings::log(Diagnostics& diagnostics) const {
  for (const Warning& one : warnings_)
    diagnostics.warning(
        one.where,
        one.message +
            (one.others > 0 ? " (and " + std::to_string(one.others) + " more of this kind)" : ""));
}

std::uint32_t MaterialDraft::use_of_name(const std::string& name, const SourceLocation& where) {
  const auto [at, fresh] = uses_by_name.emplace(name, static_cast<std::uint32_t>(uses.size()));
  if (fresh) uses.push_back({std::nullopt, name, where});
  return at->second;
}

std::optional<std::size_t> MaterialDraft::statement_of(const MaterialUse& use) const {
  if (use.statement || use.made || &use == &uses.front()) return use.statement;
  const auto found = named.find(use.name);
  return found == named.end() ? std::nullopt : std::optional(found->second);
}

TextureImages Draft::image_finder() {
  return [this](Parameters& parameters, const char* name, const ImageEncoding& encoding,
                std::string& problem) -> std::shared_ptr<const TextureImage> {
    const std::string given = parameters.text(name, "");
    const std::string file = resolve_file(given, parameters.where(name), parameters.main_file());
    std::error_code ignored;
    if (given.empty() || !is_file(file, parameters.where(name))) {
      problem = "no such file " + in_quotes(file);
      return nullptr;
    }
    const auto [found, fresh] = texture_images.try_emplace(
        {std::filesystem::weakly_canonical(file, ignored).string(), encoding}, nullptr);
    if (fresh || !found->second) try {
        found->second = std::make_shared<TextureImage>(images.read_texture(file, encoding));
      } catch (const InputError& error) {
        problem = error.messages().front();
      }
    return found->second;
  };
}

ParameterList Building::taken(ParameterList own) {
  for (Parameter& parameter : own) {
    parameter.space = state.space;
    if (!parameter.again.empty())
      draft.warnings.add(parameter.where, parameter.again, "parameter given twice");
  }
  return own;
}

Parameters Building::parameters(const Statement& at, const std::string& owner, ParameterList own,
                                std::string_view attribute_target) {
  SharedParameters attributes;
  if (const auto found = state.attributes.find(attribute_target); found != state.attributes.end())
    attributes = found->second;
  return {taken(std::move(own)), std::move(attributes), owner, at.where, draft.main_file,
          state.space,           draft.diagnostics};
}

bool Building::check_type(const Statement& at, const std::string& type) {
  return check_name(at.directive, type, at.where, draft.diagnostics);
}

Builder::Builder(std::string main_file, const ImageReader& images)
    : building_{{std::move(main_file), images}} {
  building_.draft.scene.source = building_.draft.main_file;
}

Imported Builder::finish(bool needs_light) {
  Draft& draft = building_.draft;
  states_.report_unclosed();
  if (!building_.in_world && !draft.diagnostics.has_errors())
    draft.diagnostics.error({draft.main_file}, "the scene is empty: there is no WorldBegin");
  resolve(draft);
  draft.warnings.log(draft.diagnostics);
  draft.diagnostics.finish();
  draft.scene.view.sampler.seed =
      building_.sampler_seed.value_or(building_.option_seed.value_or(0));
  const bool lit = is_lit(draft.scene);
  if (needs_light && building_.has_camera && !lit)
    draft.diagnostics.warning({draft.main_file}, "the scene has no light: its picture is black");
  Imported out(std::move(draft.scene));
  out.has_camera = building_.has_camera;
  out.is_lit = lit || building_.has_camera;  // an explicit camera without light means a dark scene
  return out;
}

}  // namespace caplet::pbrt
