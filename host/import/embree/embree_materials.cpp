// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's materials, lights, transforms and cameras, and the viewer's options.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <span>

#include "base/check.h"
#include "base/quotes.h"
#include "import/detail/embree.h"
#include "import/detail/text_file.h"

namespace caplet::embree {

namespace {

glm::dvec3 vector_of(std::span<const double> numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// Reads the parameters of a material by name.
class Parameters {
 public:
  Parameters(SceneFile& file, pugi::xml_node node) {
    for (const pugi::xml_node entry : node.children()) {
      if (entry.type() != pugi::node_element) continue;
      const std::string name = entry.attribute("name").value();
      std::string_view type = entry.name();
      if (type == "param") type = entry.attribute("type").value();
      if (type.starts_with("float") || type.starts_with("int")) {
        const std::string_view digits = type.substr(
            type.find_first_of("1234567890", 0) == std::string_view::npos ? type.size()
                                                                          : type.size() - 1);
        const std::size_t count = digits.empty() ? 1 : static_cast<std::size_t>(digits[0] - '0');
        if (count > 4 || count < 1) file.fail(entry, quoted(type) + " is no type of a parameter");
        values_[name] =
            numbers_of(SceneFile::text_of(entry), count, count, file.place(entry), name);
      } else if (type == "texture3d" || type == "texture") {
        images_[name] = entry.attribute("src").value();
      } else {
        file.fail(entry, quoted(type) + " is no type of a parameter");
      }
    }
  }
  double number(const char* name, double otherwise) const {
    const auto found = values_.find(name);
    return found == values_.end() || found->second.size() != 1 ? otherwise : found->second[0];
  }
  glm::dvec3 color(const char* name, double otherwise) const {
    const auto found = values_.find(name);
    return found == values_.end() || found->second.size() != 3
               ? glm::dvec3(otherwise)
               : glm::max(vector_of(found->second), glm::dvec3(0));
  }
  glm::dvec3 reflectance(const char* name, double otherwise) const {
    return glm::min(color(name, otherwise), glm::dvec3(1));
  }
  std::string image(const char* name) const {
    const auto found = images_.find(name);
    return found == images_.end() ? "" : found->second;
  }

 private:
  std::map<std::string, std::vector<double>> values_;
  std::map<std::string, std::string> images_;
};

MeshMaterial added(Scene& scene, const Material& material) {
  MeshMaterial out;
  out.material = narrow<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(material);
  return out;
}

double index_of(double inside, double outside) {
  return std::clamp(outside > 0 ? inside / outside : inside, 0.2, 5.0);
}

/// Returns GGX's alpha of the same width as Embree's microfacet distribution, a power cosine with
/// the exponent n = 1 / roughness: alpha^2 = 2 / (n + 2) (Walter et al. 2007, section 5.2).
double alpha_of(double roughness) {
  const double inverse_exponent = std::clamp(roughness, 0.0, 1.0);
  return std::sqrt(2 * inverse_exponent / (1 + 2 * inverse_exponent));
}

}  // namespace

MeshMaterial read_material(SceneFile& file, pugi::xml_node node, const std::string& name,
                           Scene& scene, MeshImages& images, Notes& notes) {
  const SourceLocation where = file.place(node);
  std::string code = SceneFile::text_of(node.child("code"));
  if (code.size() > 1 && code.front() == '"' && code.back() == '"')
    code = code.substr(1, code.size() - 2);
  const Parameters given(file, node.child("parameters"));
  Material out;
  out.where = where;
  out.name = name.empty() ? code : name;
  if (code == "OBJ" || code == "OBJMaterial") {
    const bool is_old = code == "OBJMaterial";
    MtlValues values;
    values.name = out.name;
    values.kd = given.color(is_old ? "kd" : "Kd", 1);
    values.ks = given.color(is_old ? "ks" : "Ks", 0);
    values.ns = std::max(0.0, given.number(is_old ? "ns" : "Ns", 10));
    values.d = given.number("d", 1);
    values.map_kd = given.image("map_Kd");
    values.map_d = given.image("map_d");
    return make_mtl(values, where, file.path().parent_path(), scene, images);
  }
  if (code == "Matte" || code == "Velvet") {
    out.model = DiffuseMaterial{RgbSpectrum{given.reflectance("reflectance", 1)}};
  } else if (code == "Hair") {
    HairMaterial hair;
    hair.reflectance =
        RgbSpectrum{glm::min(given.color("Kr", 1) + given.color("Kt", 0), glm::dvec3(1))};
    out.model = hair;
  } else if (code == "Mirror") {
    ConductorMaterial mirror;
    mirror.reflectance = RgbSpectrum{given.reflectance("reflectance", 1)};
    out.model = mirror;
  } else if (code == "Metal") {
    // Multiplies the reflectance of eta and k at normal incidence by the file's.
    const glm::dvec3 eta = given.color("eta", 1.4), k = given.color("k", 0);
    const glm::dvec3 below = (eta - 1.0) * (eta - 1.0) + k * k,
                     above = (eta + 1.0) * (eta + 1.0) + k * k;
    ConductorMaterial metal;
    metal.reflectance = RgbSpectrum{below / above * given.reflectance("reflectance", 1)};
    metal.alpha_u = metal.alpha_v = alpha_of(given.number("roughness", 0.01));
    out.model = metal;
  } else if (code == "Dielectric") {
    out.model = DielectricMaterial{
        ConstantSpectrum{index_of(given.number("etaInside", 1.4), given.number("etaOutside", 1))},
        0, 0};
  } else if (code == "ThinDielectric" || code == "ThinGlass") {
    out.model = ThinDielectricMaterial{ConstantSpectrum{index_of(given.number("eta", 1.4), 1)}};
  } else if (code == "Plastic" || code == "MetallicPaint") {
    PrincipledMaterial paint;
    paint.base_color =
        RgbSpectrum{given.reflectance(code == "Plastic" ? "pigmentColor" : "shadeColor", 1)};
    paint.eta = std::clamp(given.number("eta", 1.4), 1.01, 4.0);
    paint.roughness = std::sqrt(alpha_of(given.number("roughness", 0.01)));
    out.model = paint;
  } else {
    notes.add(node.child("parameters")
                  ? "the material " + caplet::quoted(code) + " is not known: it is grey"
                  : "a material is defined nowhere: it is grey",
              where);
    out.model = DiffuseMaterial{ConstantSpectrum{0.5}};
  }
  return added(scene, out);
}

// --- Transforms ---

glm::dmat4 affine_space(SceneFile& file, pugi::xml_node node) {
  const auto numbers = [&](const char* name, std::size_t count) {
    return numbers_of(node.attribute(name).value(), count, count, file.place(node), name);
  };
  const auto turned = [&](const glm::dvec3& axis, double degrees) {
    if (!(glm::length(axis) > 0)) file.fail(node, "an axis of no length");
    return glm::rotate(glm::dmat4(1), glm::radians(degrees), glm::normalize(axis));
  };
  if (node.attribute("translate"))
    return glm::translate(glm::dmat4(1), vector_of(numbers("translate", 3)));
  if (node.attribute("scale")) return glm::scale(glm::dmat4(1), vector_of(numbers("scale", 3)));
  constexpr const char* turns[] = {"rotate_x", "rotate_y", "rotate_z"};
  for (int k = 0; k < 3; ++k)
    if (node.attribute(turns[k])) {
      glm::dvec3 axis(0);
      axis[k] = 1;
      return turned(axis, numbers(turns[k], 1)[0]);
    }
  if (node.attribute("angle")) {
    const glm::dmat4 turn = turned(vector_of(numbers("axis", 3)), numbers("angle", 1)[0]);
    if (!node.attribute("point")) return turn;
    const glm::dvec3 point = vector_of(numbers("point", 3));
    return glm::translate(glm::dmat4(1), point) * turn * glm::translate(glm::dmat4(1), -point);
  }
  const std::vector<double> m =
      numbers_of(SceneFile::text_of(node), 12, 12, file.place(node), node.name());
  return {
      {m[0], m[4], m[8], 0}, {m[1], m[5], m[9], 0}, {m[2], m[6], m[10], 0}, {m[3], m[7], m[11], 1}};
}

// --- Lights ---

bool is_light(std::string_view name) {
  constexpr std::string_view names[] = {"PointLight",   "SpotLight",    "DirectionalLight",
                                        "DistantLight", "AmbientLight", "TriangleLight",
                                        "QuadLight"};
  return std::ranges::find(names, name) != std::end(names);
}

LightElement read_light(SceneFile& file, pugi::xml_node node) {
  const auto numbers = [&](const char* what, std::size_t count) {
    const pugi::xml_node child = node.child(what);
    if (!child) file.fail(node, fmt::format("<{}> has no <{}>", node.name(), what));
    return numbers_of(SceneFile::text_of(child), count, count, file.place(child), what);
  };
  LightElement out;
  out.name = node.name();
  out.where = file.place(node);
  if (const pugi::xml_node space = node.child("AffineSpace")) out.space = affine_space(file, space);
  const bool is_point = out.name == "PointLight" || out.name == "SpotLight";
  out.emission = vector_of(numbers(is_point ? "I" : out.name == "DirectionalLight" ? "E" : "L", 3));
  if (out.name == "SpotLight") {
    out.least_angle = numbers("angleMin", 1)[0];
    out.most_angle = numbers("angleMax", 1)[0];
  }
  if (out.name == "DistantLight") out.most_angle = numbers("halfAngle", 1)[0];
  return out;
}

void add_light(const LightElement& light, const glm::dmat4& world, Scene& scene) {
  const glm::dvec3 emission = glm::max(light.emission, glm::dvec3(0));
  if (!(std::max({emission.x, emission.y, emission.z}) > 0)) return;
  const glm::dmat4 placed = world * light.space;
  const RgbSpectrum color{emission};
  if (light.name == "TriangleLight" || light.name == "QuadLight") {
    TriangleMeshShape mesh;
    if (light.name == "TriangleLight") {
      mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
      mesh.triangles = {{0, 1, 2}};
    } else {
      mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
      mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    }
    Shape shape = mesh_shape(std::move(mesh), light.name, add_plain_material(scene), light.where);
    shape.world_from_object = placed;
    AreaEmission shines;
    shines.radiance = color;
    shines.two_sided = true;
    shape.emission = shines;
    scene.shapes.push_back(std::move(shape));
    return;
  }
  Light out;
  out.where = light.where;
  const glm::dvec3 along(placed[2]);
  if (light.name == "AmbientLight") {
    InfiniteLight model;
    model.radiance = color;
    out.model = model;
  } else if (light.name == "PointLight") {
    out.model = PointLight{color, glm::dvec3(placed[3])};
  } else if (!(glm::length(along) > 0)) {
    throw InputError(light.where, "a light without a direction");
  } else if (light.name == "SpotLight") {
    SpotLight model;
    model.intensity = color;
    model.position = glm::dvec3(placed[3]);
    model.direction = glm::normalize(along);
    model.total_angle = std::clamp(glm::radians(light.most_angle), 1e-3, 1.5707);
    model.falloff_start_angle = std::clamp(glm::radians(light.least_angle), 0.0, model.total_angle);
    out.model = model;
  } else {
    out.model = DistantLight{color, glm::normalize(along)};
    // The irradiance of a disk in the sky is its radiance times pi sin^2 of its half angle.
    if (light.name == "DistantLight") {
      const double sine = std::sin(glm::radians(std::clamp(light.most_angle, 0.0, 90.0)));
      out.scale = std::numbers::pi * sine * sine;
      if (!(out.scale > 0)) return;
    }
  }
  scene.lights.push_back(std::move(out));
}

// --- Cameras ---

Camera camera_of(const View& view, const FilmSettings& film, const SourceLocation& where) {
  if (!(view.fov > 0 && view.fov < 179))
    throw InputError(where, fmt::format("a field of view of {:.6g} degrees", view.fov));
  const glm::dvec3 along = view.to - view.from, side = glm::cross(along, view.up);
  if (!(glm::length(along) > 0) ||
      !(glm::length(side) > 1e-12 * glm::length(along) * glm::length(view.up)))
    throw InputError(where, "the camera looks nowhere, or along its own up");
  const glm::dvec3 z = glm::normalize(along), x = glm::normalize(side), y = glm::cross(x, z);
  Camera out;
  const glm::dvec3 right = view.is_left_handed ? -x : x;
  out.world_from_camera = {glm::dvec4(right, 0), glm::dvec4(y, 0), glm::dvec4(z, 0),
                           glm::dvec4(view.from, 1)};
  const double over_height = std::tan(glm::radians(view.fov) / 2);
  const double narrower =
      film.width < film.height ? static_cast<double>(film.width) / film.height : 1;
  out.projection = PerspectiveProjection{2 * std::atan(over_height * narrower)};
  return out;
}

namespace {

struct Word {
  std::string_view text;
  SourceLocation where;
};

std::vector<Word> words_of_file(std::string_view text, const std::string& file) {
  std::vector<Word> out;
  for (int line = 1; !text.empty(); ++line) {
    const std::string_view whole = take_line(text);
    if (trimmed(whole).starts_with('#')) continue;
    for (const std::string_view word : caplet::words_of(whole))
      out.push_back({word, {file, line, static_cast<int>(word.data() - whole.data()) + 1}});
  }
  return out;
}

/// Accepts "-vp" and "--vp", but not "-1".
std::string_view option_of(std::string_view word) {
  const std::size_t begin = word.find_first_not_of('-');
  if (begin == 0 || begin == std::string_view::npos ||
      std::isalpha(static_cast<unsigned char>(word[begin])) == 0)
    return {};
  return word.substr(begin);
}

}  // namespace

ViewerOptions read_ecs(const std::filesystem::path& path, Notes& notes) {
  const TextFile text(path);
  const std::vector<Word> words = words_of_file(text.text(), path.string());
  ViewerOptions out;
  View view;
  bool has_view = false;
  Unproven in_file;  // it is a scene file once -i or another known option comes first
  std::size_t i = 0;
  const auto next = [&](const Word& option) -> const Word& {
    if (i >= words.size()) throw InputError(option.where, quoted(option.text) + " ends early");
    return words[i++];
  };
  const auto numbers = [&](const Word& option, std::size_t count) {
    std::vector<double> values;
    while (values.size() < count) {
      const Word& word = next(option);
      values.push_back(numbers_of(word.text, 1, 1, word.where, quoted(option.text)).at(0));
    }
    return values;
  };
  glm::dvec3 direction(0);
  while (i < words.size()) {
    const Word& option = words[i++];
    const std::string_view name = option_of(option.text);
    if (name.empty()) throw InputError(option.where, quoted(option.text) + " is no option");
    const auto sees = [&](glm::dvec3& value) {
      value = vector_of(numbers(option, 3));
      has_view = true;
    };
    constexpr std::pair<std::string_view, const char*> lights[] = {
        {"ambientlight", "AmbientLight"},
        {"pointlight", "PointLight"},
        {"directionallight", "DirectionalLight"},
        {"dirlight", "DirectionalLight"},
        {"distantlight", "DistantLight"}};
    const auto* light = std::ranges::find(lights, name, [](const auto& row) { return row.first; });
    if (name == "i" || name == "input") {
      const Word& name_of_file = next(option);
      out.files.emplace_back(path.parent_path() / std::string(name_of_file.text),
                             name_of_file.where);
    } else if (name == "vp") {
      sees(view.from);
    } else if (name == "vi") {
      sees(view.to);
    } else if (name == "vd") {
      sees(direction);
    } else if (name == "vu") {
      sees(view.up);
    } else if (name == "fov") {
      view.fov = numbers(option, 1)[0];
      has_view = true;
    } else if (name == "lefthanded" || name == "righthanded") {
      view.is_left_handed = name == "lefthanded";
    } else if (name == "size") {
      const std::vector<double> size = numbers(option, 2);
      for (const double one : size)
        if (!(one >= 1 && one <= 65536 && one == std::floor(one)))
          throw InputError(option.where, "is no size of a picture");
      out.size = glm::ivec2(static_cast<int>(size[0]), static_cast<int>(size[1]));
    } else if (light != std::end(lights)) {
      LightElement one;
      one.name = light->second;
      one.where = option.where;
      if (one.name == "PointLight")
        one.space[3] = glm::dvec4(vector_of(numbers(option, 3)), 1);
      else if (one.name != "AmbientLight")
        one.space[2] = glm::dvec4(vector_of(numbers(option, 3)), 0);
      one.emission = vector_of(numbers(option, 3));
      if (one.name == "DistantLight") one.most_angle = numbers(option, 1)[0];
      out.lights.push_back(std::move(one));
    } else {
      notes.add("the option " + caplet::quoted(option.text) + " is passed over", option.where);
      while (i < words.size() && option_of(words[i].text).empty()) ++i;
      continue;
    }
    in_file.prove();
  }
  if (direction != glm::dvec3(0)) view.to = view.from + direction;
  if (has_view) out.view = view;
  if (out.files.empty()) throw InputError({path.string(), 0, 0}, "names no scene (-i FILE)");
  return out;
}

}  // namespace caplet::embree
