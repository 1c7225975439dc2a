// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "base/spelling.h"
#include "import/detail/pbrt_lights.h"
#include "import/detail/pbrt_media.h"
#include "import/detail/pbrt_names.h"
#include "import/detail/pbrt_options.h"
#include "import/detail/pbrt_shapes.h"

namespace caplet {

namespace {

/// Where there are no files.
const std::string no_file;

/// Reads no images: for what asks for none.
class NoImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override { throw InputError({path.string()}, "not read"); }
};

void check_type(const ProgramStatement& statement) {
  const std::vector<std::string> known = statement_types(statement.directive);
  if (std::ranges::find(known, statement.type) != known.end()) return;
  throw InputError(fmt::format("there is no {} '{}'; the nearest is '{}'", statement.directive, statement.type,
                               nearest_name(statement.type, known)));
}

std::vector<pbrt::Parameter> own_of(const ProgramStatement& statement) {
  std::vector<pbrt::Parameter> own;
  for (const StatementParameter& given : statement.parameters) {
    pbrt::Parameter& one = own.emplace_back();
    one.type = given.type;
    one.name = given.name;
    one.numbers = given.numbers;
    one.strings = given.strings;
    one.bools = given.bools;
    if (given.numbers.empty() && given.strings.empty() && given.bools.empty())
      throw InputError(fmt::format("{} \"{}\": \"{}\" has no value", statement.directive, statement.type, given.name));
  }
  return own;
}

pbrt::Parameters parameters_of(const ProgramStatement& statement, std::vector<pbrt::Parameter> own, Diagnostics& diagnostics) {
  return {std::move(own), {}, statement.directive + " \"" + statement.type + "\"", {}, no_file, ColorSpace::srgb, diagnostics};
}

/// Textures by their numbers.
pbrt::TextureTable textures_of(const Scene& scene) {
  pbrt::TextureTable table;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    pbrt::TextureValue value;
    value.is_float = scene.textures[i].is_float;
    value.texture = static_cast<std::uint32_t>(i);
    table.add(std::to_string(i), std::move(value));
  }
  return table;
}

template <class Known>
[[noreturn]] void unknown_name(const char* what, const std::string& name, const Known& known) {
  std::vector<std::string> names;
  for (const auto& one : known) names.push_back(one.name);
  throw InputError(names.empty()
                       ? fmt::format("there is no {} '{}'", what, name)
                       : fmt::format("there is no {} '{}'; the nearest is '{}'", what, name, nearest_name(name, names)));
}

Shape read_shape(const ProgramStatement& statement, pbrt::Parameters& parameters, std::uint32_t material, const Scene& scene) {
  // Most shapes ask for none.
  const bool is_textured = std::ranges::any_of(statement.parameters, [](const auto& one) { return one.type == "texture"; });
  const pbrt::TextureTable textures = is_textured ? textures_of(scene) : pbrt::TextureTable();
  const auto material_named = [&](const std::string& name, const SourceLocation&) {
    const auto found = std::ranges::find(scene.materials, name, &Material::name);
    if (found == scene.materials.end()) unknown_name("material", name, scene.materials);
    return static_cast<std::uint32_t>(found - scene.materials.begin());
  };
  const auto object_named = [&](const std::string& name, std::string& problem) -> const Object* {
    const auto found = std::ranges::find(scene.objects, name, &Object::name);
    if (found != scene.objects.end()) return &*found;
    problem = "names the object " + pbrt::in_quotes(name) + ", which there is none of";
    return nullptr;
  };
  return pbrt::make_shape(statement.type, parameters, material, {textures, material_named, object_named});
}

void read_option(const ProgramStatement& statement, pbrt::Parameters& parameters, const glm::dmat4& world_from_camera,
                 Scene& scene) {
  if (statement.directive == "Camera") pbrt::set_camera(statement.type, parameters, world_from_camera, scene);
  if (statement.directive == "Film") pbrt::set_film(statement.type, parameters, ColorSpace::srgb, scene);
  if (statement.directive == "PixelFilter") pbrt::set_filter(statement.type, parameters, scene);
  if (statement.directive == "Integrator") pbrt::set_integrator(statement.type, parameters, scene);
  if (statement.directive == "Sampler")
    if (const auto seed = pbrt::set_sampler(statement.type, parameters, scene)) scene.sampler.seed = *seed;
}

/// What `work` makes of the statement's parameters. Throws InputError with all that is wrong with them.
template <class Work>
auto read(const ProgramStatement& statement, const Work& work) {
  check_type(statement);
  Diagnostics diagnostics;
  pbrt::Parameters parameters = parameters_of(statement, own_of(statement), diagnostics);
  auto out = work(parameters);
  diagnostics.finish();
  return out;
}

/// Asks for all that there is to ask for.
void ask(const ProgramStatement& statement, pbrt::Parameters& parameters) {
  const NoImages images;
  Scene scene;
  pbrt::LightFiles files(images);
  if (statement.directive == "Shape")
    read_shape(statement, parameters, 0, scene);
  else if (statement.directive == "LightSource")
    pbrt::make_light(statement.type, parameters, glm::dmat4(1), files);
  else if (statement.directive == "AreaLightSource")
    pbrt::make_area_emission(parameters, files);
  else if (statement.directive == "MakeNamedMedium")
    pbrt::make_medium(statement.type, {}, parameters, glm::dmat4(1));
  else
    read_option(statement, parameters, glm::dmat4(1), scene);
}

}  // namespace

std::vector<std::string> statement_types(const std::string& directive) {
  for (const pbrt::NameTable& table : pbrt::name_tables())
    if (table.directive == directive) {
      std::vector<std::string> types = table.accepted;
      if (directive == "Shape") std::erase_if(types, pbrt::is_file_shape);  // no shape, but a scene
      return types;
    }
  return {};
}

std::vector<KnownStatementParameter> statement_parameters(const std::string& directive, const std::string& type) {
  const ProgramStatement statement{directive, type};
  check_type(statement);
  std::vector<KnownStatementParameter> out;
  // With nothing given, and with everything that was asked for there, but of no value: what is asked for then is more.
  for (int round = 0; round < 2; ++round) {
    std::vector<pbrt::Parameter> own;
    for (const KnownStatementParameter& known : out) {
      pbrt::Parameter& one = own.emplace_back();
      one.name = known.name;
      one.broken = true;
    }
    Diagnostics ignored;
    pbrt::Parameters parameters = parameters_of(statement, std::move(own), ignored);
    parameters.note_types();
    try {
      ask(statement, parameters);
    } catch (const InputError&) {  // of values that are missing
    }
    for (const pbrt::AskedParameter& asked : parameters.asked()) {
      auto found = std::ranges::find(out, asked.name, &KnownStatementParameter::name);
      if (found == out.end()) found = out.insert(out.end(), {asked.name, {}});
      for (const std::string& one : asked.types)
        if (std::ranges::find(found->types, one) == found->types.end()) found->types.push_back(one);
    }
  }
  return out;
}

Shape shape_of(const ProgramStatement& statement, std::uint32_t material, const Scene& scene) {
  return read(statement, [&](pbrt::Parameters& parameters) { return read_shape(statement, parameters, material, scene); });
}

Light light_of(const ProgramStatement& statement, const glm::dmat4& world_from_light, const ImageReader& images) {
  pbrt::LightFiles files(images);
  return read(statement,
              [&](pbrt::Parameters& parameters) { return pbrt::make_light(statement.type, parameters, world_from_light, files); })
      .value();
}

AreaEmission emission_of(const ProgramStatement& statement, const ImageReader& images) {
  pbrt::LightFiles files(images);
  return read(statement, [&](pbrt::Parameters& parameters) { return pbrt::make_area_emission(parameters, files); });
}

Medium medium_of(const ProgramStatement& statement, const std::string& name, const glm::dmat4& world_from_medium) {
  return read(statement, [&](pbrt::Parameters& parameters) {
    return pbrt::make_medium(statement.type, name, parameters, world_from_medium);
  });
}

void set_option(const ProgramStatement& statement, const glm::dmat4& world_from_camera, Scene& scene) {
  read(statement, [&](pbrt::Parameters& parameters) {
    read_option(statement, parameters, world_from_camera, scene);
    return true;
  });
}

void make_hair_one_sided(const ProgramStatement& statement, const Scene& scene, Shape& shape) {
  const auto is_hair = [&](std::uint32_t material) {
    return material < scene.materials.size() && std::holds_alternative<HairMaterial>(scene.materials[material].model);
  };
  if (std::ranges::find(statement.parameters, "onesided", &StatementParameter::name) != statement.parameters.end()) return;
  bool some = is_hair(shape.material) || std::ranges::any_of(shape.materials, is_hair);
  if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
    some = some || std::ranges::any_of(capsules->materials, is_hair);
  if (some && is_closed(shape)) shape.one_sided = true;
}

}  // namespace caplet
