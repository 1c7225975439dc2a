// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "import/statement.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <functional>
#include <glm/matrix.hpp>

#include "base/spelling.h"
#include "import/detail/pbrt/lights.h"
#include "import/detail/pbrt/materials.h"
#include "import/detail/pbrt/media.h"
#include "import/detail/pbrt/names.h"
#include "import/detail/pbrt/options.h"
#include "import/detail/pbrt/resolve.h"
#include "import/detail/pbrt/shapes.h"

namespace caplet {

namespace {

/// Statements of programs have no files.
const std::string no_file;

void check_type(const ProgramStatement& statement) {
  const std::vector<std::string> known = statement_types(statement.directive);
  if (std::ranges::find(known, statement.type) != known.end()) return;
  throw InputError(fmt::format("there is no {} '{}'; the nearest is '{}'", statement.directive,
                               statement.type, nearest_name(statement.type, known)));
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
      throw InputError(fmt::format("{} \"{}\": \"{}\" has no value", statement.directive,
                                   statement.type, given.name));
  }
  return own;
}

pbrt::Parameters parameters_of(const ProgramStatement& statement, std::vector<pbrt::Parameter> own,
                               Diagnostics& diagnostics) {
  return {std::move(own),
          {},
          statement.directive + " \"" + statement.type + "\"",
          {},
          no_file,
          ColorSpace::srgb,
          diagnostics};
}

/// Returns the textures by number; none if the statement names none.
pbrt::TextureTable textures_for(const ProgramStatement& statement, const Scene& scene) {
  pbrt::TextureTable table;
  if (std::ranges::none_of(statement.parameters,
                           [](const auto& one) { return one.type == "texture"; }))
    return table;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    pbrt::TextureValue value;
    value.is_float = scene.textures[i].is_float;
    value.texture = static_cast<std::uint32_t>(i);
    table.add(std::to_string(i), std::move(value));
  }
  return table;
}

std::optional<std::uint32_t> number_of(const std::string& text) {
  std::uint32_t out = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(out)
                                                                  : std::nullopt;
}

template <class Known>
[[noreturn]] void unknown_name(const char* what, const std::string& name, const Known& known) {
  std::vector<std::string> names;
  names.reserve(known.size());
  for (const auto& one : known) names.push_back(one.name);
  throw InputError(names.empty() ? fmt::format("there is no {} '{}'", what, name)
                                 : fmt::format("there is no {} '{}'; the nearest is '{}'", what,
                                               name, nearest_name(name, names)));
}

Shape read_shape(const ProgramStatement& statement, pbrt::Parameters& parameters,
                 std::uint32_t material, const Scene& scene) {
  const pbrt::TextureTable textures = textures_for(statement, scene);
  const auto material_named = [&](const std::string& name, const SourceLocation&) {
    const auto found = std::ranges::find(scene.materials, name, &Material::name);
    if (found == scene.materials.end()) unknown_name("material", name, scene.materials);
    return static_cast<std::uint32_t>(found - scene.materials.begin());
  };
  const auto object_named = [&](const std::string& name, std::string& problem) {
    const auto found = std::ranges::find(scene.objects, name, &Object::name);
    if (found != scene.objects.end()) return pbrt::FinishedObject{&*found};
    problem = "names the object " + pbrt::in_quotes(name) + ", which there is none of";
    return pbrt::FinishedObject{};
  };
  return pbrt::make_shape(statement.type, parameters, material,
                          {textures, material_named, object_named});
}

void read_option(const ProgramStatement& statement, pbrt::Parameters& parameters,
                 const glm::dmat4& world_from_camera, Scene& scene) {
  if (statement.directive == "Camera")
    pbrt::set_camera(statement.type, parameters, world_from_camera, scene);
  if (statement.directive == "Film")
    pbrt::set_film(statement.type, parameters, ColorSpace::srgb, scene);
  if (statement.directive == "PixelFilter") pbrt::set_filter(statement.type, parameters, scene);
  if (statement.directive == "Integrator") pbrt::set_integrator(statement.type, parameters, scene);
  if (statement.directive == "Sampler")
    if (const auto seed = pbrt::set_sampler(statement.type, parameters, scene))
      scene.view.sampler.seed = *seed;
}

/// Returns what `work` makes of the statement's parameters. Throws InputError with all their
/// errors.
template <class Work>
auto read(const ProgramStatement& statement, const Work& work) {
  check_type(statement);
  Diagnostics diagnostics;
  pbrt::Parameters parameters = parameters_of(statement, own_of(statement), diagnostics);
  auto out = work(parameters);
  diagnostics.finish();
  return out;
}

}  // namespace

std::vector<std::string> file_statement_types(const std::string& directive) {
  for (const pbrt::NameTable& table : pbrt::name_tables())
    if (table.directive == directive) return table.accepted;
  return {};
}

std::vector<std::string> statement_types(const std::string& directive) {
  std::vector<std::string> types = file_statement_types(directive);
  if (directive == "Shape")
    std::erase_if(types, pbrt::is_file_shape);                   // these give a scene, not a shape
  if (directive == "Material") std::erase(types, "subsurface");  // it is a material and a medium
  if (directive == "Texture") {
    std::erase(types, "constant");  // that is a number or a spectrum
    types.emplace_back("normalmap");
  }
  return types;
}

std::vector<schema::Parameter> statement_parameters(const std::string& directive,
                                                    const std::string& type) {
  check_type({directive, type});
  return schema::parameters_of(directive, type);
}

Shape shape_of(const ProgramStatement& statement, std::uint32_t material, const Scene& scene) {
  return read(statement, [&](pbrt::Parameters& parameters) {
    return read_shape(statement, parameters, material, scene);
  });
}

Material material_of(const ProgramStatement& statement, const Scene& scene) {
  return read(statement, [&](pbrt::Parameters& parameters) {
    const auto numbered = [&](const std::string& name,
                              std::string& problem) -> std::optional<std::uint32_t> {
      const std::optional<std::uint32_t> found = number_of(name);
      // A material may be named before it exists; the scene is validated as a whole.
      if (!found) problem = "takes the numbers of two materials";
      return found;
    };
    return pbrt::make_program_material(statement.type, parameters, textures_for(statement, scene),
                                       numbered);
  });
}

Texture texture_of(const ProgramStatement& statement, bool is_float,
                   const glm::dmat4& world_from_texture,
                   const std::shared_ptr<const TextureImage>& pixels, const Scene& scene,
                   const ImageReader& images) {
  pbrt::TextureContext context{world_from_texture, glm::inverse(world_from_texture), {}, false};
  context.images = [&](pbrt::Parameters& parameters, const char* name,
                       const ImageEncoding& encoding, std::string& problem) {
    std::shared_ptr<const TextureImage> image = pixels;
    if (pixels && (parameters.has(name) || parameters.has("encoding"))) {
      problem = "pixels take neither a filename nor an encoding";
      image = nullptr;
    } else if (!pixels && !parameters.has(name)) {
      problem = "there is no filename";
    } else if (!pixels) {
      try {
        image = std::make_shared<TextureImage>(
            images.read_texture(parameters.text(name, ""), encoding));
      } catch (const InputError& error) {
        problem = error.messages().front();
      }
    }
    return image;
  };
  return read(statement,
              [&](pbrt::Parameters& parameters) {
                return pbrt::make_program_texture(statement.type, is_float, parameters,
                                                  textures_for(statement, scene), context);
              })
      .value();
}

Light light_of(const ProgramStatement& statement, const glm::dmat4& world_from_light,
               const ImageReader& images) {
  pbrt::LightFiles files(images);
  return read(statement,
              [&](pbrt::Parameters& parameters) {
                return pbrt::make_light(statement.type, parameters, world_from_light, files);
              })
      .value();
}

AreaEmission emission_of(const ProgramStatement& statement, const ImageReader& images) {
  pbrt::LightFiles files(images);
  return read(statement, [&](pbrt::Parameters& parameters) {
    return pbrt::make_area_emission(parameters, files);
  });
}

Medium medium_of(const ProgramStatement& statement, const std::string& name,
                 const glm::dmat4& world_from_medium) {
  return read(statement, [&](pbrt::Parameters& parameters) {
    return pbrt::make_medium(statement.type, name, parameters, world_from_medium);
  });
}

void set_option(const ProgramStatement& statement, const glm::dmat4& world_from_camera,
                Scene& scene) {
  read(statement, [&](pbrt::Parameters& parameters) {
    read_option(statement, parameters, world_from_camera, scene);
    return true;
  });
}

void make_hair_one_sided(const ProgramStatement& statement, const Scene& scene, Shape& shape) {
  if (std::ranges::find(statement.parameters, "onesided", &StatementParameter::name) !=
      statement.parameters.end())
    return;
  if (pbrt::is_closed_hair(shape, scene.materials)) shape.one_sided = true;
}

}  // namespace caplet
