// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Runs at the end of the scene: finds the materials that are used, makes them, and assigns them to shapes.
#include <algorithm>
#include <functional>
#include <map>

#include "import/detail/pbrt_materials.h"
#include "import/detail/pbrt_parser.h"

namespace caplet::pbrt {

void each_material(Shape& shape, const std::function<void(std::uint32_t&)>& visit) {
  visit(shape.material);
  for (std::uint32_t& material : shape.materials) visit(material);
  if (auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
    for (std::uint32_t& material : capsules->materials) visit(material);
  if (auto* csg = std::get_if<CsgShape>(&shape.geometry))
    for (std::shared_ptr<const Shape>& operand : csg->operands) {
      auto own = std::make_shared<Shape>(*operand);  // a nested operand may be shared
      each_material(*own, visit);
      operand = std::move(own);
    }
}

namespace {

constexpr std::uint32_t interface_material = 0xffffffffu;  // stands for an interface in place of a material's index

/// Calls `visit` with the material of every visible surface.
void each_surface(Shape& shape, const std::function<void(std::uint32_t)>& visit) {
  if (const auto* csg = std::get_if<CsgShape>(&shape.geometry)) {
    if (shape.materials.empty()) {
      for (const std::shared_ptr<const Shape>& operand : csg->operands) {
        Shape own = *operand;
        each_surface(own, visit);
      }
      return;
    }
  }
  const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
  if (!shape.materials.empty())
    std::ranges::for_each(shape.materials, visit);
  else if (capsules && !capsules->materials.empty())
    std::ranges::for_each(capsules->materials, visit);
  else
    visit(shape.material);
}

void each_material(Scene& scene, const std::function<void(std::uint32_t&)>& visit) {
  for (Shape& shape : scene.shapes) pbrt::each_material(shape, visit);
  for (Object& object : scene.objects)
    for (Shape& shape : object.shapes) pbrt::each_material(shape, visit);
}

}  // namespace

/// Returns for each Material statement whether a shape, or a mix on a shape, has its material.
std::vector<bool> Parser::used_materials() {
  std::vector<bool> used(materials_.size(), false);
  std::vector<std::size_t> to_follow;
  const auto use = [&](std::size_t statement) {
    if (!used[statement]) to_follow.push_back(statement);
    used[statement] = true;
  };
  const auto use_name = [&](const std::string& name) {
    if (const auto found = named_materials_.find(name); found != named_materials_.end()) use(found->second);
  };
  each_material(scene_, [&](std::uint32_t& index) {
    const MaterialUse& one = uses_[index];
    if (one.statement)
      use(*one.statement);
    else if (!one.made)
      use_name(one.name);
  });
  while (!to_follow.empty()) {
    MaterialStatement& statement = materials_[to_follow.back()];
    to_follow.pop_back();
    if (statement.type != "mix") continue;
    Diagnostics aside;  // errors are reported when the mix is made
    statement.parameters.report_to(aside);
    if (const Parameter* parts = statement.parameters.values("materials", {"string"}))
      for (const std::string& name : parts->strings) use_name(name);
    statement.parameters.report_to(diagnostics_);
  }
  return used;
}

/// Makes the materials of the statements; parts of a mix are made before it.
class Parser::MaterialMaking {
 public:
  MaterialMaking(Parser& parser, const std::vector<bool>& used) : parser_(parser), used_(used), made_(used.size()) {}

  void make(std::size_t statement) {
    Made& made = made_[statement];
    if (made.state != State::unseen) return;
    made.state = State::open;
    make_unseen(statement);
    made.state = State::done;
  }

  std::vector<std::uint32_t> indices() const {
    std::vector<std::uint32_t> out;
    for (const Made& made : made_) out.push_back(made.index);
    return out;
  }
  /// Returns the media behind boundaries, by the index of the boundary's material in the scene.
  std::map<std::uint32_t, Medium> media_within() const {
    std::map<std::uint32_t, Medium> out;
    for (const Made& made : made_)
      if (made.sound && made.within) out.emplace(made.index, *made.within);
    return out;
  }
  std::map<std::size_t, PartlyThere> partly_there() const {
    std::map<std::size_t, PartlyThere> out;
    for (std::size_t i = 0; i < made_.size(); ++i)
      if (made_[i].partly_there) out.emplace(i, *made_[i].partly_there);
    return out;
  }
  std::size_t left_out = 0;
  std::string first_left_out;

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
    MaterialStatement& statement = parser_.materials_[number];
    Made& made = made_[number];
    if (statement.type.empty()) return;
    Diagnostics aside;
    Diagnostics& diagnostics = used_[number] ? parser_.diagnostics_ : aside;
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
      Material material = make_material(statement.type, statement.parameters, parser_.textures_, parser_.texture_context().images,
                                        part_named, parser_.scene_, made.within);
      material.name = statement.name;
      made.index = static_cast<std::uint32_t>(parser_.scene_.materials.size());
      made.sound = !aside.has_errors();
      if (const auto* mix = std::get_if<MixMaterial>(&material.model); mix && made.sound && part_interface(*mix, material, made))
        return;
      if (made.sound) parser_.scene_.materials.push_back(std::move(material));
    }
    if (!aside.has_errors()) return;
    try {
      aside.finish();
    } catch (const InputError& error) {
      if (left_out++ == 0) first_left_out = error.messages().front();
    }
  }

  /// A mix with an interface becomes its other material, with a probability as alpha; a mix of two interfaces is an interface.
  static bool part_interface(const MixMaterial& mix, const Material& material, Made& made) {
    const bool first = mix.materials[0] == interface_material, second = mix.materials[1] == interface_material;
    if (!first && !second) return false;
    made.index = first && second ? interface_material : mix.materials[first ? 1 : 0];
    if (first && second) {
      made.sound = false;
      return true;
    }
    PartlyThere& there = made.partly_there.emplace(PartlyThere{mix.amount, second, made.within.has_value()});
    for (const TexturedField& field : material.textures)
      if (field.field == "amount") there.amount.texture = field.texture;
    return true;
  }

  /// Makes a part of the mix `whole`.
  std::optional<std::uint32_t> part(const std::string& name, Made& whole, std::string& problem) {
    const auto found = parser_.named_materials_.find(name);
    if (found == parser_.named_materials_.end()) {
      problem =
          "names the material " + in_quotes(name) + ", which is not defined" + parser_.nearest(name, parser_.named_materials_);
      return std::nullopt;
    }
    const Made& made = made_[found->second];
    if (made.state == State::open) {
      problem = "names the material " + in_quotes(name) + ", of which this is a part";
      return std::nullopt;
    }
    make(found->second);
    if (made.partly_there) {
      problem = "names the material " + in_quotes(name) + ", a mix with an interface, of which no other mix is made";
      return std::nullopt;
    }
    if (made.sound && made.within) {
      if (whole.within && whole.within->where.to_string() != made.within->where.to_string()) {
        problem = "names the material " + in_quotes(name) + ", a second subsurface: one alone can be within";
        return std::nullopt;
      }
      whole.within = made.within;
    }
    if (made.sound || made.index == interface_material) return made.index;
    problem = "names the material " + in_quotes(name) + ", which is wrong itself";
    return std::nullopt;
  }

  Parser& parser_;
  const std::vector<bool>& used_;
  std::vector<Made> made_;
};

/// Returns the index in the scene of each statement's material, or interface_material. A material that cannot be rendered is an
/// error if a shape has it, otherwise a warning.
std::vector<std::uint32_t> Parser::make_materials(const std::vector<bool>& used) {
  MaterialMaking making(*this, used);
  for (std::size_t i = 0; i < materials_.size(); ++i) making.make(i);
  if (making.left_out > 0 && !diagnostics_.has_errors())
    diagnostics_.warning(
        {}, making.first_left_out + " (no shape has this material" +
                (making.left_out > 1 ? ", nor " + std::to_string(making.left_out - 1) + " others that are wrong)" : ")"));
  media_within_ = making.media_within();
  partly_there_ = making.partly_there();
  return making.indices();
}

void Parser::resolve_materials() {
  const std::vector<std::uint32_t> index_of_statement = make_materials(used_materials());
  std::vector<std::uint32_t> index_of_use(uses_.size(), 0);
  std::vector<bool> of_shape(uses_.size(), false);
  each_material(scene_, [&](std::uint32_t& use) { of_shape[use] = true; });
  for (std::size_t i = 1; i < uses_.size(); ++i) {
    const MaterialUse& use = uses_[i];
    if (use.made) {
      index_of_use[i] = *use.made;
      continue;
    }
    const auto named = use.statement ? named_materials_.end() : named_materials_.find(use.name);
    if (use.statement || named != named_materials_.end())
      index_of_use[i] = index_of_statement[use.statement ? *use.statement : named->second];
    else if (of_shape[i])
      diagnostics_.error(use.where,
                         "the material " + in_quotes(use.name) + " is not defined" + nearest(use.name, named_materials_));
    else  // pbrt-v4 resolves a name at the shape that uses it
      warn_of_kind(use.where, "the material " + in_quotes(use.name) + " is not defined (no shape has it)", "undefined material");
  }
  take_out_interfaces([&](std::uint32_t number) -> const PartlyThere* {
    const MaterialUse& use = uses_[number];
    const auto named = use.statement ? named_materials_.end() : named_materials_.find(use.name);
    if (number == 0 || use.made || (!use.statement && named == named_materials_.end())) return nullptr;
    const auto found = partly_there_.find(use.statement ? *use.statement : named->second);
    return found == partly_there_.end() ? nullptr : &found->second;
  });
  drop_interfaces(index_of_use);
  if (std::ranges::find(index_of_use, interface_material) != index_of_use.end()) {
    const auto interface = static_cast<std::uint32_t>(scene_.materials.size());
    bool is_used = false;
    std::ranges::replace(index_of_use, interface_material, interface);
    each_material(scene_, [&](std::uint32_t& use) { is_used = is_used || (use != 0 && index_of_use[use] == interface); });
    if (is_used) scene_.materials.push_back({InterfaceMaterial{}, "interface", {main_file_}});
  }
  bool uses_default = false;
  const auto default_index = static_cast<std::uint32_t>(scene_.materials.size());
  index_of_use[0] = default_index;
  each_material(scene_, [&](std::uint32_t& material) {
    uses_default = uses_default || material == 0;
    material = index_of_use[material];
  });
  if (uses_default) scene_.materials.push_back({DiffuseMaterial{}, "default", {main_file_}});
  make_hair_one_sided();
  fill_subsurfaces();
}

/// Fills shapes that have a subsurface material with its medium.
void Parser::fill_subsurfaces() {
  if (media_within_.empty()) return;
  std::map<std::uint32_t, std::uint32_t> index_of;
  const auto visit = [&](Shape& shape) {
    bool some = false, all = true;
    std::optional<std::uint32_t> of;
    each_surface(shape, [&](std::uint32_t material) {
      const bool is_boundary = media_within_.contains(material) && (!of || *of == material);
      some = some || media_within_.contains(material);
      all = all && is_boundary;
      of = material;
    });
    if (!some) return;
    if (!all) return diagnostics_.error(shape.where, "all of a shape has one material where one is a \"subsurface\"");
    const auto [found, fresh] = index_of.emplace(*of, static_cast<std::uint32_t>(scene_.media.size()));
    if (fresh) {
      scene_.media.push_back(media_within_.at(*of));
      if (scene_.media.back().name.empty()) scene_.media.back().name = "subsurface";
    }
    shape.media.inside = found->second;
  };
  for (Shape& shape : scene_.shapes) visit(shape);
  for (Object& object : scene_.objects)
    for (Shape& shape : object.shapes) visit(shape);
}

std::uint32_t Parser::float_texture(Texture texture) {
  texture.is_float = true;
  texture.where = {main_file_};
  scene_.textures.push_back(std::move(texture));
  return static_cast<std::uint32_t>(scene_.textures.size() - 1);
}

/// A mix with an interface lets rays pass at random: the probability becomes the shape's alpha. `partly_there` returns it for a
/// use of a material, or null.
void Parser::take_out_interfaces(const std::function<const PartlyThere*(std::uint32_t use)>& partly_there) {
  if (partly_there_.empty()) return;
  const auto visit = [&](Shape& shape) {
    const PartlyThere* of = nullptr;
    bool all = true, some = false;
    each_surface(shape, [&](std::uint32_t use) {
      const PartlyThere* const own = partly_there(use);
      all = all && own && (!some || own == of);
      some = some || own;
      of = own ? own : of;
    });
    if (!some) return;
    if (!all) return diagnostics_.error(shape.where, "all of a shape has one material where one is a mix with an interface");
    if (shape.emission)
      return diagnostics_.error(shape.where, "the shape is an area light, whose material is no mix with an interface");
    if (shape.media.differ() || of->subsurface)
      return diagnostics_.error(shape.where,
                                "the shape parts media, and its material is a mix with an interface: it would be both");
    TextureOperand alpha = of->amount;
    if (of->inverted && alpha.texture) {
      MixTexture rest;
      rest.tex1 = 1;
      rest.tex2 = 0;
      rest.amount = alpha;
      alpha = 0;
      alpha.texture = float_texture({rest, true, "", {}});
    } else if (of->inverted) {
      alpha = 1 - std::get<ConstantSpectrum>(alpha.value).value;
    }
    if (shape.alpha) {
      ScaleTexture both;
      both.tex = *shape.alpha;
      both.scale = alpha;
      alpha = 0;
      alpha.texture = float_texture({both, true, "", {}});
    }
    shape.alpha = alpha;
  };
  for (Shape& shape : scene_.shapes) visit(shape);
  for (Object& object : scene_.objects)
    for (Shape& shape : object.shapes) visit(shape);
}

/// Removes shapes whose material is an interface and that do not separate media: they are invisible.
void Parser::drop_interfaces(const std::vector<std::uint32_t>& index_of_use) {
  const auto is_interface = [&](std::uint32_t use) { return use != 0 && index_of_use[use] == interface_material; };
  const auto passes = [&](Shape& shape) {
    bool all = true;
    each_surface(shape, [&](std::uint32_t use) { all = all && is_interface(use); });
    if (all && shape.emission) {
      const std::string dark = "the shape emits nothing, as its material is \"interface\"";
      warn_of_kind(shape.where, dark, dark);
      shape.emission.reset();
    }
    return all && !shape.media.differ();
  };
  std::erase_if(scene_.shapes, passes);
  for (Object& object : scene_.objects) std::erase_if(object.shapes, passes);
}

/// Makes hair one-sided: its scattering function includes the path through the fibre, so rays must not hit the far side.
void Parser::make_hair_one_sided() {
  std::vector<bool> hair;
  for (const Material& material : scene_.materials) hair.push_back(std::holds_alternative<HairMaterial>(material.model));
  if (std::ranges::find(hair, true) == hair.end()) return;
  const auto visit = [&](Shape& shape) {
    bool some = false;
    each_material(shape, [&](std::uint32_t& material) { some = some || (material < hair.size() && hair[material]); });
    if (some && is_closed(shape) && !said_two_sided_.contains(shape.where.to_string())) shape.one_sided = true;
  };
  for (Shape& shape : scene_.shapes) visit(shape);
  for (Object& object : scene_.objects)
    for (Shape& shape : object.shapes) visit(shape);
}

}  // namespace caplet::pbrt
