// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "view/detail/form_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/spelling.h"
#include "scene/field.h"

namespace caplet::view {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double degree = std::numbers::pi / 180;
constexpr const char* kind_field = "kind";

const std::vector<std::string> material_kinds = {
#define MATERIAL_MODEL(name, Type) #name,
#include "scene/materials.def"
};
const std::vector<std::string> light_kinds = {
#define LIGHT_MODEL(name, Type) #name,
#include "scene/lights.def"
};
const std::vector<std::string> texture_kinds = {
#define TEXTURE_MODEL(name, Type) #name,
#include "scene/textures.def"
};

using MaterialModel = decltype(Material::model);
using LightModel = decltype(Light::model);
using TextureModel = decltype(Texture::model);

void add_whole(FormFields& to, const Field& field, int& value) {
  to.whole(field.name, value, static_cast<int>(field.low), static_cast<int>(field.high));
}

/// Visits an angle in degrees.
void angle(FormFields& to, const Field& field, double& radians) {
  const double before = radians / degree;
  double now = before;
  to.number(field.name, now, field.low, field.high);
  if (now != before) radians = now * degree;
}

/// Names the textures of fields as scene files do.
class MaterialFields : public CompositesInParts<MaterialFields> {
 public:
  MaterialFields(FormFields& to, Material& material) : to_(to), material_(material) {}

  void albedo(const Field& field, Spectrum& value) { spectrum(field, value); }
  void unbounded(const Field& field, Spectrum& value) { spectrum(field, value); }
  void index(const Field& field, Spectrum& value) { to_.spectrum(field.name, value, field.high); }
  void number(const Field& field, double& value) {
    with_slot(field.name, true,
              [&](Slot& slot) { to_.number(field.name, value, field.low, field.high, &slot); });
  }
  void integer(const Field& field, int& value) { add_whole(to_, field, value); }
  void flag(const Field& field, bool& value) { to_.flag(field.name, value); }
  void parts(const Field&, std::array<std::uint32_t, 2>& of) {
    to_.material("material 0", of[0]);
    to_.material("material 1", of[1]);
  }
  void metal(const MetalFields& fields, Spectrum& eta, Spectrum& k,
             std::optional<Spectrum>& reflectance) {
    instead("metal", {std::string(fields.eta.name) + " and k", fields.reflectance.name},
            {fields.eta.name, fields.k.name}, reflectance);
    CompositesInParts::metal(fields, eta, k, reflectance);
  }
  void pigment(const PigmentFields& fields, Spectrum& sigma_a,
               std::optional<Spectrum>& reflectance) {
    instead("pigment", {fields.sigma_a.name, fields.reflectance.name}, {fields.sigma_a.name},
            reflectance);
    CompositesInParts::pigment(fields, sigma_a, reflectance);
  }

 private:
  void spectrum(const Field& field, Spectrum& value) {
    with_slot(field.name, false,
              [&](Slot& slot) { to_.spectrum(field.name, value, field.high, &slot); });
  }
  template <class Work>
  void with_slot(const std::string& field, bool is_float, Work&& work) {
    Slot slot{is_float, texture_of(material_, field)};
    const auto before = slot.texture;
    work(slot);
    if (slot.texture == before) return;
    drop(field);
    if (slot.texture) material_.textures.push_back({field, *slot.texture});
  }
  void drop(const std::string& field) {
    std::erase_if(material_.textures, [&](const TexturedField& one) { return one.field == field; });
  }
  /// Offers a reflectance as an alternative to other fields.
  void instead(const char* name, const std::vector<std::string>& options,
               const std::vector<std::string>& others, std::optional<Spectrum>& reflectance) {
    const int before = reflectance ? 1 : 0;
    int now = before;
    to_.choice(name, now, options);
    if (now == before) return;
    drop("reflectance");
    for (const std::string& other : others) drop(other);
    reflectance = now == 1 ? std::optional<Spectrum>(ConstantSpectrum{0.5}) : std::nullopt;
  }

  FormFields& to_;
  Material& material_;
};

MaterialModel default_material(std::size_t kind, std::uint32_t own, std::size_t materials) {
  MaterialModel out = model_of<MaterialModel>(kind);
  if (auto* const mix = std::get_if<MixMaterial>(&out)) {
    mix->materials[0] = own == 0 ? 1 : 0;
    mix->materials[1] = materials > 2 && own != 1 ? 1 : mix->materials[0];
  }
  return out;
}

/// The interface cannot be seen: files drop shapes that have it and separate no media.
bool bounds_alone(std::size_t kind) {
  return std::holds_alternative<InterfaceMaterial>(model_of<MaterialModel>(kind));
}

class TextureFields : public IgnoresFields {
 public:
  TextureFields(FormFields& to, bool is_float, std::uint32_t own)
      : to_(to), is_float_(is_float), own_(own) {}

  void operand(const Field& field, TextureOperand& of) {
    if (is_float_) return factor(field, of);
    Slot slot{false, of.texture, own_};
    to_.spectrum(field.name, of.value, infinity, &slot);
    of.texture = slot.texture;
  }
  void factor(const Field& field, TextureOperand& of) {
    Slot slot{true, of.texture, own_};
    const auto* constant = std::get_if<ConstantSpectrum>(&of.value);
    double value = constant ? constant->value : 0;
    to_.number(field.name, value, -infinity, infinity, &slot);
    of.value = ConstantSpectrum{value};
    of.texture = slot.texture;
  }
  void number(const Field& field, double& value) {
    to_.number(field.name, value, field.low, field.high);
  }
  void integer(const Field& field, int& value) { add_whole(to_, field, value); }
  void vector(const Field& field, glm::dvec3& value) { to_.point(field.name, value); }
  template <class Names>
  void choice(const Field& field, int& value, const Names& names) {
    to_.choice(field.name, value, std::vector<std::string>(names.begin(), names.end()));
  }
  void flag(const Field& field, bool& value) { to_.flag(field.name, value); }
  void image(const Field& field, const std::shared_ptr<const TextureImage>& of) {
    to_.file(field.name, of ? of->file : "");
  }
  void vectors(const Field& field, const std::shared_ptr<const TextureImage>& of) {
    image(field, of);
  }
  void mapping(TextureMapping& of) {
    int kind = static_cast<int>(of.kind);
    choice(TextureMapping::kind_field, kind, texture_mapping_names);
    of.kind = static_cast<TextureMapping::Kind>(kind);
    TextureMapping::fields(of, *this);
  }
  void board(TextureMapping& of) {
    if (of.kind != TextureMapping::Kind::solid) mapping(of);
  }
  void direction(const Field& field, glm::dvec3& value) { to_.direction(field.name, value); }

 private:
  FormFields& to_;
  bool is_float_;
  std::uint32_t own_;
};

/// Describes a texture: one of images needs a file, and one of operands only would be a constant.
struct TextureKind : IgnoresFields {
  bool has_image = false, has_more = false;
  std::optional<bool> is_float = {};

  void number(const Field&, double) { has_more = true; }
  void integer(const Field&, int) { has_more = true; }
  void mapping(const TextureMapping&) { has_more = true; }
  void board(const TextureMapping&) { has_more = true; }
  void place(const glm::dmat4&) { has_more = true; }
  void direction(const Field&, const glm::dvec3&) { has_more = true; }
  void image(const Field&, const std::shared_ptr<const TextureImage>&) { has_image = true; }
  void vectors(const Field&, const std::shared_ptr<const TextureImage>&) { has_image = true; }
  void only(bool of_floats) { is_float = of_floats; }
};

TextureKind texture_kind(const TextureModel& model) {
  TextureKind out;
  std::visit([&](const auto& m) { m.fields(m, out); }, model);
  return out;
}

struct LightFields {
  FormFields& to;

  void emission(const Field& field, Spectrum& value) { to.spectrum(field.name, value, infinity); }
  void position(const Field& field, glm::dvec3& value) { to.point(field.name, value); }
  void direction(const Field&, const Field&, glm::dvec3& value) {
    to.direction("direction", value);
  }
  void number(const Field& field, double& value) {
    to.number(field.name, value, field.low, field.high);
  }
  void place(glm::dvec3& at, const glm::dmat3&) { to.point("from", at); }
  void image(const Field& field, const std::shared_ptr<const EnvironmentImage>& of) {
    to.file(field.name, of ? of->file : "");
  }
  void directions(const Field& field, const std::shared_ptr<const EnvironmentImage>& of) {
    image(field, of);
  }
  void profile(const Field& field, const std::shared_ptr<const IesProfile>& of) {
    to.file(field.name, of ? of->file : "");
  }
  void cone(double& total_angle, double& falloff_start_angle) {
    const double edge_before = std::max(0.0, total_angle - falloff_start_angle),
                 total_before = total_angle;
    double edge = edge_before;
    angle(to, SpotLight::cone_field, total_angle);
    angle(to, SpotLight::delta_field, edge);
    if (edge != edge_before || total_angle != total_before)
      falloff_start_angle = std::max(0.0, total_angle - edge);
  }
  void sky(InfiniteLight& light) {
    if (light.image)
      image(InfiniteLight::image_field, light.image);
    else
      emission(InfiniteLight::radiance_field, light.radiance);
  }
};

/// Visits the fields of options.
class OptionFields {
 public:
  explicit OptionFields(FormFields& to) : to_(to) {}

  void number(const Field& field, double& value) {
    to_.number(field.name, value, field.low, field.high);
  }
  /// Files may say more: what a page asks for must end.
  void integer(const Field& field, int& value) {
    const int most = std::string_view(field.name) == "maxdepth" ? 10000 : 1 << 24;
    to_.whole(field.name, value, static_cast<int>(field.low),
              std::min(static_cast<int>(field.high), most));
  }
  void flag(const Field& field, bool& value) { to_.flag(field.name, value); }
  /// An unsigned integer, as in scene files.
  void seed(const Field& field, std::uint32_t& value) {
    int seed = static_cast<int>(value);
    to_.whole(field.name, seed, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    value = static_cast<std::uint32_t>(seed);
  }
  template <class Names>
  void choice(const Field& field, int& value, const Names& names) {
    value = kind(field.name, value, names);
  }
  void field_of_view(double& radians) { angle(to_, fov_field, radians); }
  void lens(const Field& field, const std::shared_ptr<const Lens>& of) {
    to_.file(field.name, of ? of->file : "");
  }
  void aperture(const Field& field, const std::shared_ptr<const ApertureMask>& of) {
    to_.file(field.name, of ? of->name : "");
  }
  template <class Kind, class Names>
  Kind kind(const char* name, Kind now, const Names& names) {
    int number = static_cast<int>(now);
    to_.choice(name, number, {names.begin(), names.end()});
    return static_cast<Kind>(number);
  }

 private:
  FormFields& to_;
};

/// The place of the camera is no field.
void visit_camera(FormFields& fields, Camera& camera) {
  OptionFields options(fields);
  const std::size_t kind = options.kind(kind_field, camera.projection.index(), projection_names);
  if (kind != camera.projection.index()) {
    camera.projection = model_of<Projection>(kind);
    camera.screen_window.reset();  // its unit belongs to the projection
    return;
  }
  std::visit([&](auto& of) { of.fields(of, options); }, camera.projection);
  if (!has_screen_window(camera)) return;
  fields.option(frame_aspect_ratio_field.name, camera.frame_aspect_ratio);
  if (has_image_plane(camera)) Camera::fields(camera, options);
}

/// Properties that lights of different kinds share.
struct LightTraits {
  std::optional<Spectrum> spectrum = {};
  std::optional<glm::dvec3> at = {}, towards = {};
};
/// Reads or writes the shared properties.
struct LightCopy : IgnoresFields {
  explicit LightCopy(LightTraits& of, bool puts = false) : traits_(of), puts_(puts) {}

  void emission(const Field&, Spectrum& value) { pass(value, traits_.spectrum); }
  void position(const Field&, glm::dvec3& value) { pass(value, traits_.at); }
  void direction(const Field&, const Field&, glm::dvec3& value) { pass(value, traits_.towards); }
  void place(glm::dvec3& at, const glm::dmat3&) { pass(at, traits_.at); }
  void sky(InfiniteLight& light) {
    if (!light.image) pass(light.radiance, traits_.spectrum);
  }

 private:
  template <class T>
  void pass(T& value, std::optional<T>& kept) {
    if (!puts_)
      kept = value;
    else if (kept)
      value = *kept;
  }

  LightTraits& traits_;
  bool puts_;
};

LightModel light_of(std::size_t kind, LightTraits& traits) {
  LightModel out = model_of<LightModel>(kind);
  std::visit([&](auto& m) { m.fields(m, LightCopy(traits, true)); }, out);
  return out;
}

/// Returns whether validate() accepts the light on its own.
bool stands_alone(LightModel model) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.emplace_back().geometry = SphereShape{};
  scene.lights.push_back({std::move(model), 1, {}, {}, {}});
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  return !diagnostics.has_errors();
}

struct NewShape {
  std::string name;
  Geometry geometry;
};

/// Lists capsules and the shapes of scene/geometries.def whose defaults are complete.
const std::vector<NewShape>& new_shapes() {
  static const std::vector<NewShape> all = [] {
    std::vector<NewShape> out;
    const auto offer = [&](const std::string& name, Geometry geometry) {
      if (std::ranges::any_of(out, [&](const NewShape& other) { return other.name == name; }))
        return;
      Scene scene;
      scene.materials.emplace_back();
      scene.shapes.emplace_back().geometry = geometry;
      Diagnostics diagnostics;
      if (primitive_count(scene.shapes[0]) > 0) validate(scene, diagnostics);
      if (primitive_count(scene.shapes[0]) > 0 && !diagnostics.has_errors())
        out.push_back({name, std::move(geometry)});
    };
    offer("capsule", CapsulesShape{{{0, 0, 0}}, {{0, 0, 1}}, {0.3f}, {}, {}});
    offer("tapered capsule", CapsulesShape{{{0, 0, 0}}, {{0, 0, 1}}, {0.4f}, {0.2f}, {}});
    offer("tetrahedron", TriangleMeshShape{{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                                           {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}},
                                           {},
                                           {}});
#define GEOMETRY(Type, name) offer(#name, Type{});
#include "scene/geometries.def"
    return out;
  }();
  return all;
}

template <class Options>
std::size_t row_of(const Options& known, const std::string& name) {
  const auto found = std::ranges::find(known, name);
  if (found == known.end())
    throw InputError(SourceLocation{kind_field},
                     fmt::format("is \"{}\"; the nearest known name is \"{}\"", name,
                                 nearest_name(name, known)));
  return static_cast<std::size_t>(found - known.begin());
}

template <class List>
std::string free_name(const List& of, const std::string& wanted) {
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::any_of(of, [&](const auto& one) { return one.name == name; });
  };
  for (int i = 1;; ++i)
    if (const std::string name = i == 1 ? wanted : fmt::format("{} {}", wanted, i); !is_taken(name))
      return name;
}

}  // namespace

void visit_form(FormFields& fields, Material& material, std::uint32_t own, const Scene& scene) {
  fields.text("name", material.name);
  const auto before = static_cast<int>(material.model.index());
  int kind = before;
  fields.choice(kind_field, kind, material_kinds);
  if (kind != before) {
    if (bounds_alone(static_cast<std::size_t>(kind)))
      throw InputError(SourceLocation{kind_field},
                       "bounds media alone: a shape that holds none would be nothing");
    material.model = default_material(static_cast<std::size_t>(kind), own, scene.materials.size());
    material.textures.clear();
    return;
  }
  std::visit([&](auto& m) { m.fields(m, MaterialFields(fields, material)); }, material.model);
  if (material.normalmap) return;
  Slot slot{true, material.displacement};
  fields.texture("displacement", slot);
  material.displacement = slot.texture;
}

void visit_form(FormFields& fields, Texture& texture, std::uint32_t own) {
  fields.text("name", texture.name);
  std::visit([&](auto& m) { m.fields(m, TextureFields(fields, texture.is_float, own)); },
             texture.model);
}

void visit_form(FormFields& fields, Light& light) {
  const auto before = static_cast<int>(light.model.index());
  int kind = before;
  fields.choice(kind_field, kind, light_kinds);
  if (kind != before) {
    LightTraits traits;
    std::visit([&](auto& m) { m.fields(m, LightCopy(traits)); }, light.model);
    light.model = light_of(static_cast<std::size_t>(kind), traits);
    light.power = light.illuminance = std::nullopt;
    return;
  }
  std::visit([&](auto& m) { m.fields(m, LightFields{fields}); }, light.model);
  fields.number("scale", light.scale, 0, infinity);
  const LightUnit unit = std::visit([](const auto& m) { return m.unit; }, light.model);
  if (unit == LightUnit::power)
    fields.option("power", light.power);
  else
    fields.option("illuminance", light.illuminance);
}

void visit_form(FormFields& fields, std::optional<AreaEmission>& emission) {
  bool emits = emission.has_value();
  fields.flag("emits", emits);
  if (emits != emission.has_value()) {
    emission = emits ? std::optional(AreaEmission{}) : std::nullopt;
    return;
  }
  if (!emission) return;
  if (emission->image)
    fields.file("filename", emission->image->file);
  else
    fields.spectrum("L", emission->radiance, infinity);
  fields.number("scale", emission->scale, 0, infinity);
  fields.option("power", emission->power);
  fields.flag("twosided", emission->two_sided);
}

void visit_form(FormFields& fields, Shape& shape) {
  fields.text("name", shape.name);
  fields.flag("onesided", shape.one_sided);
  const auto positive = [&](const char* name, double& value) {
    fields.number(name, value, 0, largest_length);
  };
  const auto any = [&](const char* name, double& value) {
    fields.number(name, value, -largest_length, largest_length);
  };
  const auto turn = [&](const char* name, double& radians) {
    const double before = radians / degree;
    double now = before;
    fields.number(name, now, 0, 360);
    if (now != before) radians = now >= 360 ? full_turn : now * degree;
  };
  const auto caps = [&](std::array<Cap, 2>& of) {
    for (std::size_t i = 0; i < 2; ++i) {
      int cap = static_cast<int>(of[i]);
      fields.choice(fmt::format("cap {}", i), cap, {"flat", "round", "open"});
      of[i] = static_cast<Cap>(cap);
    }
  };
  std::visit(
      [&](auto& geometry) {
        using Type = std::remove_reference_t<decltype(geometry)>;
        if constexpr (FieldedShape<Type>) {
          struct Each : Fields {
            FormFields& to;
            explicit Each(FormFields& fields) : to(fields) {}
            void corners(const char* name0, const char* name1, glm::dvec3& p0,
                         glm::dvec3& p1) override {
              to.point(name0, p0);
              to.point(name1, p1);
            }
            void positive(const char* name, double& value) override {
              to.number(name, value, 0, largest_length);
            }
          } each(fields);
          caplet::fields(geometry, each);
        } else if constexpr (std::is_same_v<Type, SphereShape>) {
          positive("radius", geometry.radius);
        } else if constexpr (std::is_same_v<Type, DiskShape>) {
          any("height", geometry.height);
          positive("radius", geometry.radius);
          positive("innerradius", geometry.inner_radius);
          turn("phimax", geometry.phi_max);
        } else if constexpr (std::is_same_v<Type, CylinderShape>) {
          fields.point("p0", geometry.p0);
          fields.point("p1", geometry.p1);
          positive("radius", geometry.radius);
          caps(geometry.caps);
        } else if constexpr (std::is_same_v<Type, ConeShape>) {
          fields.point("p0", geometry.p0);
          fields.point("p1", geometry.p1);
          positive("radius 0", geometry.radius[0]);
          positive("radius 1", geometry.radius[1]);
          caps(geometry.caps);
        } else if constexpr (std::is_same_v<Type, PartialSphereShape> ||
                             std::is_same_v<Type, OpenCylinderShape>) {
          positive("radius", geometry.radius);
          any("zmin", geometry.z_min);
          any("zmax", geometry.z_max);
          turn("phimax", geometry.phi_max);
        } else if constexpr (std::is_same_v<Type, MolecularSurfaceShape>) {
          const double before = geometry.probe;
          positive("probe", geometry.probe);
          if (geometry.probe != before)
            geometry =
                make_molecule(geometry.centers, geometry.radii, geometry.probe, geometry.materials);
        }
      },
      shape.geometry);
}

void visit_form(FormFields& fields, View& view, FormSubject::Kind of) {
  OptionFields options(fields);
  if (of == FormSubject::Kind::camera) {
    visit_camera(fields, view.camera);
  } else if (of == FormSubject::Kind::film) {
    FilmSettings& film = view.film;
    const int width = film.width, height = film.height;
    FilmSettings::fields(film, options);
    if (film.width != width || film.height != height)
      film.crop.reset();  // the crop was part of the old picture
    fields.number("shutter opens", film.shutter_open, -infinity, infinity);
    fields.number("exposure time", film.exposure_time, 0, infinity);
    fields.number("readout", film.readout, 0, infinity);
    film.readout_order = options.kind("readout order", film.readout_order, readout_orders);
    film.space = options.kind("colorspace", film.space, color_space_names);
  } else if (of == FormSubject::Kind::filter) {
    const auto kind = options.kind(kind_field, view.filter.kind, filter_names);
    if (kind != view.filter.kind) return view.filter.set_kind(kind);
    PixelFilter::fields(view.filter, options);
  } else if (of == FormSubject::Kind::sampler) {
    SamplerSettings& sampler = view.sampler;
    const auto kind = options.kind(kind_field, sampler.kind, sampler_names);
    const std::array<int, 2> strata = strata_of(sampler);
    sampler.kind = kind;
    sampler.x_strata = strata[0];
    sampler.y_strata = strata[1];
    SamplerSettings::fields(sampler, options);
    if (kind == SamplerSettings::Kind::stratified)
      sampler.samples_per_pixel = sampler.x_strata * sampler.y_strata;
  } else {
    view.integrator.kind = options.kind(kind_field, view.integrator.kind, integrator_names);
    IntegratorSettings::fields(view.integrator, options);
  }
}

std::vector<std::string> new_kinds(FormSubject::Kind what) {
  std::vector<std::string> out;
  if (what == FormSubject::Kind::material)
    for (std::size_t i = 0; i < material_kinds.size(); ++i)
      if (!bounds_alone(i)) out.push_back(material_kinds[i]);
  if (what == FormSubject::Kind::shape)
    for (const NewShape& each : new_shapes()) out.push_back(each.name);
  if (what == FormSubject::Kind::light)
    for (std::size_t i = 0; i < light_kinds.size(); ++i)
      if (stands_alone(model_of<LightModel>(i))) out.push_back(light_kinds[i]);
  if (what == FormSubject::Kind::texture)
    for (std::size_t i = 0; i < texture_kinds.size(); ++i)
      if (const TextureKind kind = texture_kind(model_of<TextureModel>(i));
          !kind.has_image && kind.has_more)
        out.push_back(texture_kinds[i]);
  return out;
}

Material new_material(const Scene& scene, const Add& add) {
  if (add.like) {
    if (*add.like >= scene.materials.size())
      throw InputError(SourceLocation{"like"},
                       fmt::format("there are {} materials", scene.materials.size()));
    Material out = scene.materials[*add.like];
    out.name =
        free_name(scene.materials, out.name.empty() ? material_kinds[out.model.index()] : out.name);
    return out;
  }
  (void)row_of(new_kinds(FormSubject::Kind::material), add.kind);
  const std::size_t kind = row_of(material_kinds, add.kind);
  Material out;
  out.model = default_material(kind, static_cast<std::uint32_t>(scene.materials.size()),
                               scene.materials.size());
  out.name = free_name(scene.materials, add.kind);
  return out;
}

Texture new_texture(const Scene& scene, const Add& add) {
  (void)row_of(new_kinds(FormSubject::Kind::texture), add.kind);
  Texture out;
  out.model = model_of<TextureModel>(row_of(texture_kinds, add.kind));
  out.is_float = texture_kind(out.model).is_float.value_or(add.is_float);
  out.name = free_name(scene.textures, add.kind);
  return out;
}

Light new_light(const Add& add) {
  (void)row_of(new_kinds(FormSubject::Kind::light), add.kind);
  LightTraits traits;
  traits.at = add.at;
  if (glm::length(add.towards) > 0) traits.towards = glm::normalize(add.towards);
  Light out;
  out.model = light_of(row_of(light_kinds, add.kind), traits);
  // The light has the same brightness at that distance, whatever its kind.
  if (std::visit([](const auto& m) { return m.unit; }, out.model) == LightUnit::power)
    out.scale = add.size * add.size;
  return out;
}

Shape new_shape(const Scene& scene, const Add& add) {
  const std::size_t row = row_of(new_kinds(FormSubject::Kind::shape), add.kind);
  if (add.material >= scene.materials.size())
    throw InputError(SourceLocation{"material"},
                     fmt::format("there are {} materials", scene.materials.size()));
  Shape out;
  out.geometry = new_shapes()[row].geometry;
  out.material = add.material;
  out.name = free_name(scene.shapes, add.kind);
  const Bounds bounds = bounds_of(out.geometry, glm::dmat4(1));
  const glm::dvec3 extent = bounds.max - bounds.min;
  const double factor = add.size * 2 / std::max({extent.x, extent.y, extent.z});
  out.world_from_object =
      glm::translate(glm::scale(glm::translate(glm::dmat4(1), add.at), glm::dvec3(factor)),
                     -0.5 * (bounds.min + bounds.max));
  return out;
}

}  // namespace caplet::view
