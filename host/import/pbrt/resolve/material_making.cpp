// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Finds the materials that are used, and makes them.
#include <utility>

#include "import/detail/pbrt/materials.h"
#include "import/detail/pbrt/resolve.h"

namespace caplet::pbrt {

namespace {

/// Returns for each Material statement whether a shape, or a mix on a shape, has its material.
std::vector<bool> used_materials(Draft& draft) {
  MaterialDraft& materials = draft.materials;
  std::vector<bool> used(materials.statements.size(), false);
  std::vector<std::size_t> to_follow;
  const auto use = [&](std::size_t statement) {
    if (!used[statement]) to_follow.push_back(statement);
    used[statement] = true;
  };
  const auto use_name = [&](const std::string& name) {
    if (const auto found = materials.named.find(name); found != materials.named.end())
      use(found->second);
  };
  each_material(draft, [&](std::uint32_t& index) {
    const MaterialUse& one = materials.uses[index];
    if (one.statement)
      use(*one.statement);
    else if (!one.made)
      use_name(one.name);
  });
  while (!to_follow.empty()) {
    MaterialStatement& statement = materials.statements[to_follow.back()];
    to_follow.pop_back();
    if (statement.type != "mix") continue;
    Diagnostics aside;  // errors are reported when the mix is made
    statement.parameters.report_to(aside);
    if (const Parameter* parts = statement.parameters.values("materials", {"string"}))
      for (const std::string& name : parts->strings) use_name(name);
    statement.parameters.report_to(draft.diagnostics);
  }
  return used;
}

/// Makes the materials of the statements; parts of a mix are made before it.
class MaterialMaking {
 public:
  MaterialMaking(Draft& draft, const std::vector<bool>& used)
      : draft_(draft), used_(used), made_(used.size()) {}

  void make(std::size_t statement) {
    Made& made = made_[statement];
    if (made.state != State::unseen) return;
    made.state = State::open;
    make_unseen(statement);
    made.state = State::done;
  }

  MadeMaterials result() const {
    MadeMaterials out;
    for (std::size_t i = 0; i < made_.size(); ++i) {
      const Made& made = made_[i];
      out.indices.push_back(made.index);
      if (made.sound && made.within) out.media_within.emplace(made.index, *made.within);
      if (made.partly_there) out.partly_there.emplace(i, *made.partly_there);
    }
    return out;
  }
  /// Warns of materials that are wrong and that no shape has.
  void warn_of_left_out() {
    if (left_out_ == 0 || draft_.diagnostics.has_errors()) return;
    draft_.diagnostics.warning({}, first_left_out_ + " (no shape has this material" +
                                       (left_out_ > 1 ? ", nor " + std::to_string(left_out_ - 1) +
                                                            " others that are wrong)"
                                                      : ")"));
  }

 private:
  enum class State { unseen, open, done };
  struct Made {
    State state = State::unseen;
    std::uint32_t index = 0;  // index in the scene
    bool sound = false;
    std::optional<Medium> within = {};
    std::optional<PartlyThere> partly_there = {};
  };

  void make_unseen(std::size_t number) {
    MaterialStatement& statement = draft_.materials.statements[number];
    Made& made = made_[number];
    if (statement.type.empty()) return;
    Diagnostics aside;
    Diagnostics& diagnostics = used_[number] ? draft_.diagnostics : aside;
    if (!statement.refusal.empty()) {
      diagnostics.error(statement.where, statement.refusal, statement.refusal);
    } else if (statement.type == "interface") {
      statement.parameters.report_to(diagnostics);
      statement.parameters.finish();
      made.index = interface_material;
    } else {
      statement.parameters.report_to(diagnostics);
      const PartFinder part_named = [this, &made](const std::string& name, std::string& problem) {
        return part(name, made, problem);
      };
      Material material =
          make_material(statement.type, statement.parameters, draft_.textures,
                        draft_.image_finder(), part_named, draft_.scene, made.within);
      material.name = statement.name;
      made.index = static_cast<std::uint32_t>(draft_.scene.materials.size());
      made.sound = !aside.has_errors();
      if (const auto* mix = std::get_if<MixMaterial>(&material.model);
          mix && made.sound && part_interface(*mix, material, made))
        return;
      if (made.sound) draft_.scene.materials.push_back(std::move(material));
    }
    if (!aside.has_errors()) return;
    try {
      aside.finish();
    } catch (const InputError& error) {
      if (left_out_++ == 0) first_left_out_ = error.messages().front();
    }
  }

  /// A mix with an interface becomes its other material, with a probability as alpha; a mix of two
  /// interfaces is an interface.
  static bool part_interface(const MixMaterial& mix, const Material& material, Made& made) {
    const bool first = mix.materials[0] == interface_material,
               second = mix.materials[1] == interface_material;
    if (!first && !second) return false;
    made.index = first && second ? interface_material : mix.materials[first ? 1 : 0];
    if (first && second) {
      made.sound = false;
      return true;
    }
    PartlyThere& there =
        made.partly_there.emplace(PartlyThere{mix.amount, second, made.within.has_value()});
    for (const TexturedField& field : material.textures)
      if (field.field == "amount") there.amount.texture = field.texture;
    return true;
  }

  /// Makes a part of the mix `whole`.
  std::optional<std::uint32_t> part(const std::string& name, Made& whole, std::string& problem) {
    const auto found = draft_.materials.named.find(name);
    if (found == draft_.materials.named.end()) {
      problem = "names the material " + in_quotes(name) + ", which is not defined" +
                draft_.nearest(name, draft_.materials.named);
      return std::nullopt;
    }
    const Made& made = made_[found->second];
    if (made.state == State::open) {
      problem = "names the material " + in_quotes(name) + ", of which this is a part";
      return std::nullopt;
    }
    make(found->second);
    if (made.partly_there) {
      problem = "names the material " + in_quotes(name) +
                ", a mix with an interface, of which no other mix is made";
      return std::nullopt;
    }
    if (made.sound && made.within) {
      if (whole.within && whole.within->where.to_string() != made.within->where.to_string()) {
        problem = "names the material " + in_quotes(name) +
                  ", a second subsurface: one alone can be within";
        return std::nullopt;
      }
      whole.within = made.within;
    }
    if (made.sound || made.index == interface_material) return made.index;
    problem = "names the material " + in_quotes(name) + ", which is wrong itself";
    return std::nullopt;
  }

  Draft& draft_;
  const std::vector<bool>& used_;
  std::vector<Made> made_;
  std::size_t left_out_ = 0;
  std::string first_left_out_;
};

}  // namespace

MadeMaterials make_materials(Draft& draft) {
  const std::vector<bool> used = used_materials(draft);
  MaterialMaking making(draft, used);
  for (std::size_t i = 0; i < draft.materials.statements.size(); ++i) making.make(i);
  making.warn_of_left_out();
  return making.result();
}

}  // namespace caplet::pbrt
