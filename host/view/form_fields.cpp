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
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/spelling.h"

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

template <class Model, std::size_t index = 0>
Model model_of(std::size_t which) {
  if (which == index) return Model(std::in_place_index<index>);
  if constexpr (index + 1 < std::variant_size_v<Model>) return model_of<Model, index + 1>(which);
  return Model();
}

/// Calls textures "field" what scene files call them.
class MaterialFields {
 public:
  MaterialFields(FormFields& to, Material& material) : to_(to), material_(material) {}

  void albedo(const char* name, Spectrum& value) { spectrum(name, value, 1); }
  void unbounded(const char* name, Spectrum& value) { spectrum(name, value, infinity); }
  void index(const char* name, Spectrum& value) { to_.spectrum(name, value, infinity); }
  void number(const std::string& name, double& value, double low, double high) {
    with_slot(name, true, [&](Slot& slot) { to_.number(name, value, low, high, &slot); });
  }
  void whole(const char* name, int& value, int low, int high) { to_.whole(name, value, low, high); }
  void flag(const char* name, bool& value) { to_.flag(name, value); }
  void parts(std::array<std::uint32_t, 2>& of) {
    to_.material("material 0", of[0]);
    to_.material("material 1", of[1]);
  }
  void roughness(double& alpha_u, double& alpha_v, const std::string& prefix = "") {
    number(prefix + "alpha_u", alpha_u, 0, infinity);
    number(prefix + "alpha_v", alpha_v, 0, infinity);
  }
  void metal(Spectrum& eta, Spectrum& k, std::optional<Spectrum>& reflectance, const std::string& prefix = "") {
    instead("metal", {prefix + "eta and k", "reflectance"}, {prefix + "eta", prefix + "k"}, reflectance);
    if (reflectance) return spectrum("reflectance", *reflectance, 1);
    spectrum(prefix + "eta", eta, infinity);
    spectrum(prefix + "k", k, infinity);
  }
  void pigment(Spectrum& sigma_a, std::optional<Spectrum>& reflectance) {
    instead("pigment", {"sigma_a", "reflectance"}, {"sigma_a"}, reflectance);
    if (reflectance)
      spectrum("reflectance", *reflectance, 1);
    else
      spectrum("sigma_a", sigma_a, infinity);
  }

 private:
  void spectrum(const std::string& name, Spectrum& value, double most) {
    with_slot(name, false, [&](Slot& slot) { to_.spectrum(name, value, most, &slot); });
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
  /// A reflectance that may replace what is said otherwise.
  void instead(const char* name, const std::vector<std::string>& options, const std::vector<std::string>& others,
               std::optional<Spectrum>& reflectance) {
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

/// What a material is where nothing is said of it, as importers have it.
struct MaterialDefaults {
  std::uint32_t own = 0;
  std::size_t materials = 0;

  void albedo(const char*, Spectrum&) {}
  void unbounded(const char*, Spectrum&) {}
  void index(const char*, Spectrum&) {}
  void number(const char*, double&, double, double) {}
  void whole(const char*, int&, int, int) {}
  void flag(const char*, bool&) {}
  void parts(std::array<std::uint32_t, 2>& of) {
    of[0] = own == 0 ? 1 : 0;
    of[1] = materials > 2 && own != 1 ? 1 : of[0];
  }
  void roughness(double&, double&, const char* = "") {}
  void metal(Spectrum& eta, Spectrum& k, std::optional<Spectrum>&, const char* = "") {
    eta = *named_spectrum("metal-Cu-eta");
    k = *named_spectrum("metal-Cu-k");
  }
  // Brown hair (Chiang et al. 2016).
  void pigment(Spectrum& sigma_a, std::optional<Spectrum>&) {
    sigma_a = RgbSpectrum{1.3 * glm::dvec3(0.419, 0.697, 1.37), ColorSpace::srgb};
  }
};

MaterialModel default_material(std::size_t kind, std::uint32_t own, std::size_t materials) {
  MaterialModel out = model_of<MaterialModel>(kind);
  std::visit([&](auto& m) { m.fields(m, MaterialDefaults{own, materials}); }, out);
  return out;
}

/// Not seen, so that files know no shape that has it and parts no media.
bool bounds_alone(std::size_t kind) { return std::holds_alternative<InterfaceMaterial>(model_of<MaterialModel>(kind)); }

class TextureFields {
 public:
  TextureFields(FormFields& to, bool is_float, std::uint32_t own) : to_(to), is_float_(is_float), own_(own) {}

  void operand(const char* name, TextureOperand& of) {
    if (is_float_) return factor(name, of);
    Slot slot{false, of.texture, own_};
    to_.spectrum(name, of.value, infinity, &slot);
    of.texture = slot.texture;
  }
  void factor(const char* name, TextureOperand& of) {
    Slot slot{true, of.texture, own_};
    const auto* constant = std::get_if<ConstantSpectrum>(&of.value);
    double value = constant ? constant->value : 0;
    to_.number(name, value, -infinity, infinity, &slot);
    of.value = ConstantSpectrum{value};
    of.texture = slot.texture;
  }
  void number(const char* name, double& value) { to_.number(name, value, -infinity, infinity); }
  template <class Names>
  void choice(const char* name, int& value, const Names& names) {
    to_.choice(name, value, std::vector<std::string>(names.begin(), names.end()));
  }
  void flag(const char* name, int& value) {
    bool is_set = value != 0;
    to_.flag(name, is_set);
    value = is_set ? 1 : 0;
  }
  void image(const std::shared_ptr<const TextureImage>& of) { to_.file("filename", of ? of->file : ""); }
  void mapping(TextureMapping& of) {
    int kind = static_cast<int>(of.kind);
    choice("mapping", kind, texture_mapping_names);
    of.kind = static_cast<TextureMapping::Kind>(kind);
    if (of.kind == TextureMapping::Kind::uv) {
      number("uscale", of.uscale);
      number("vscale", of.vscale);
    }
    if (of.kind == TextureMapping::Kind::planar) {
      to_.point("v1", of.v1);
      to_.point("v2", of.v2);
    }
    if (of.kind == TextureMapping::Kind::uv || of.kind == TextureMapping::Kind::planar) {
      number("udelta", of.udelta);
      number("vdelta", of.vdelta);
    }
  }
  void board(TextureMapping& of) {
    if (of.kind != TextureMapping::Kind::solid) mapping(of);
  }
  void place(const glm::dmat4&) {}
  void direction(const char* name, glm::dvec3& value) { to_.direction(name, value); }
  void count(const char* name, int& value, int low, int high) { to_.whole(name, value, low, high); }
  void only(bool) {}
  void colors() {}
  void vectors(const std::shared_ptr<const TextureImage>& of) { image(of); }

 private:
  FormFields& to_;
  bool is_float_;
  std::uint32_t own_;
};

/// Whether a texture can be made out of nothing: what is of images cannot, and what is of operands alone is a constant then.
struct TextureKind {
  bool has_image = false, has_more = false;
  std::optional<bool> is_float = {};

  void operand(const char*, const TextureOperand&) {}
  void factor(const char*, const TextureOperand&) {}
  void number(const char*, double) { has_more = true; }
  template <class Names>
  void choice(const char*, int, const Names&) {
    has_more = true;
  }
  void flag(const char*, int) { has_more = true; }
  void image(const std::shared_ptr<const TextureImage>&) { has_image = true; }
  void mapping(const TextureMapping&) { has_more = true; }
  void board(const TextureMapping&) { has_more = true; }
  void place(const glm::dmat4&) { has_more = true; }
  void direction(const char*, const glm::dvec3&) { has_more = true; }
  void count(const char*, int, int, int) { has_more = true; }
  void only(bool of_floats) { is_float = of_floats; }
  void colors() {}
  void vectors(const std::shared_ptr<const TextureImage>&) { has_image = true; }
};

TextureKind texture_kind(const TextureModel& model) {
  TextureKind out;
  std::visit([&](const auto& m) { m.fields(m, out); }, model);
  return out;
}

struct LightFields {
  FormFields& to;

  void emission(const char* name, Spectrum& value) { to.spectrum(name, value, infinity); }
  void position(const char* name, glm::dvec3& value) { to.point(name, value); }
  void direction(const char*, const char*, glm::dvec3& value) { to.direction("direction", value); }
  void number(const char* name, double& value, double low, double high) { to.number(name, value, low, high); }
  void place(glm::dvec3& at, const glm::dmat3&) { to.point("from", at); }
  void image(const char* name, const std::shared_ptr<const EnvironmentImage>& of) { to.file(name, of ? of->file : ""); }
  void directions(const char* name, const std::shared_ptr<const EnvironmentImage>& of) { image(name, of); }
  void profile(const char* name, const std::shared_ptr<const IesProfile>& of) { to.file(name, of ? of->file : ""); }
  void cone(double& total_angle, double& falloff_start_angle) {
    const double edge_before = std::max(0.0, total_angle - falloff_start_angle), total_before = total_angle;
    double edge = edge_before;
    angle("coneangle", total_angle, 180);
    angle("conedeltaangle", edge, 180);
    if (edge != edge_before || total_angle != total_before) falloff_start_angle = std::max(0.0, total_angle - edge);
  }
  void sky(InfiniteLight& light) {
    if (light.image)
      image("filename", light.image);
    else
      emission("L", light.radiance);
  }

 private:
  void angle(const char* name, double& radians, double most) {
    const double before = radians / degree;
    double now = before;
    to.number(name, now, 0, most);
    if (now != before) radians = now * degree;
  }
};

/// What lights of different kinds have alike.
struct LightTraits {
  std::optional<Spectrum> spectrum = {};
  std::optional<glm::dvec3> at = {}, towards = {};
};
/// Takes them, or puts them.
struct LightCopy {
  LightTraits& traits;
  bool puts = false;

  template <class T>
  void pass(T& value, std::optional<T>& kept) {
    if (!puts)
      kept = value;
    else if (kept)
      value = *kept;
  }
  void emission(const char*, Spectrum& value) { pass(value, traits.spectrum); }
  void position(const char*, glm::dvec3& value) { pass(value, traits.at); }
  void direction(const char*, const char*, glm::dvec3& value) { pass(value, traits.towards); }
  void number(const char*, double, double, double) {}
  void place(glm::dvec3& at, const glm::dmat3&) { pass(at, traits.at); }
  template <class Image>
  void image(const char*, const Image&) {}
  template <class Image>
  void directions(const char*, const Image&) {}
  template <class Profile>
  void profile(const char*, const Profile&) {}
  void cone(double, double) {}
  void sky(InfiniteLight& light) {
    if (!light.image) pass(light.radiance, traits.spectrum);
  }
};

LightModel light_of(std::size_t kind, LightTraits& traits) {
  LightModel out = model_of<LightModel>(kind);
  std::visit([&](auto& m) { m.fields(m, LightCopy{traits, true}); }, out);
  return out;
}

/// What validate() says of a light with nothing else there.
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

/// What scene/geometries.def has that is a shape without more being said, and capsules.
const std::vector<NewShape>& new_shapes() {
  static const std::vector<NewShape> all = [] {
    std::vector<NewShape> out;
    const auto offer = [&](const std::string& name, Geometry geometry) {
      if (std::ranges::any_of(out, [&](const NewShape& other) { return other.name == name; })) return;
      Scene scene;
      scene.materials.emplace_back();
      scene.shapes.emplace_back().geometry = geometry;
      Diagnostics diagnostics;
      if (primitive_count(scene.shapes[0]) > 0) validate(scene, diagnostics);
      if (primitive_count(scene.shapes[0]) > 0 && !diagnostics.has_errors()) out.push_back({name, std::move(geometry)});
    };
    offer("capsule", CapsulesShape{{{0, 0, 0}}, {{0, 0, 1}}, {0.3f}, {}, {}});
    offer("tapered capsule", CapsulesShape{{{0, 0, 0}}, {{0, 0, 1}}, {0.4f}, {0.2f}, {}});
    offer("tetrahedron",
          TriangleMeshShape{
              {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}, {}, {}});
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
                     fmt::format("is \"{}\"; the nearest known name is \"{}\"", name, nearest_name(name, known)));
  return static_cast<std::size_t>(found - known.begin());
}

template <class List>
std::string free_name(const List& of, const std::string& wanted) {
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::any_of(of, [&](const auto& one) { return one.name == name; });
  };
  for (int i = 1;; ++i)
    if (const std::string name = i == 1 ? wanted : fmt::format("{} {}", wanted, i); !is_taken(name)) return name;
}

}  // namespace

void visit_form(FormFields& fields, Material& material, std::uint32_t own, const Scene& scene) {
  fields.text("name", material.name);
  const auto before = static_cast<int>(material.model.index());
  int kind = before;
  fields.choice(kind_field, kind, material_kinds);
  if (kind != before) {
    if (bounds_alone(static_cast<std::size_t>(kind)))
      throw InputError(SourceLocation{kind_field}, "bounds media alone: a shape that holds none would be nothing");
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
  std::visit([&](auto& m) { m.fields(m, TextureFields(fields, texture.is_float, own)); }, texture.model);
}

void visit_form(FormFields& fields, Light& light) {
  const auto before = static_cast<int>(light.model.index());
  int kind = before;
  fields.choice(kind_field, kind, light_kinds);
  if (kind != before) {
    LightTraits traits;
    std::visit([&](auto& m) { m.fields(m, LightCopy{traits}); }, light.model);
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
  const auto positive = [&](const char* name, double& value) { fields.number(name, value, 0, largest_length); };
  const auto any = [&](const char* name, double& value) { fields.number(name, value, -largest_length, largest_length); };
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
            void corners(const char* name0, const char* name1, glm::dvec3& p0, glm::dvec3& p1) override {
              to.point(name0, p0);
              to.point(name1, p1);
            }
            void positive(const char* name, double& value) override { to.number(name, value, 0, largest_length); }
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
        } else if constexpr (std::is_same_v<Type, PartialSphereShape> || std::is_same_v<Type, OpenCylinderShape>) {
          positive("radius", geometry.radius);
          any("zmin", geometry.z_min);
          any("zmax", geometry.z_max);
          turn("phimax", geometry.phi_max);
        }
      },
      shape.geometry);
}

void visit_form(FormFields& fields, ViewEdit& view, Part::Kind of) {
  if (of == Part::Kind::film) {
    FilmSettings& film = view.film;
    constexpr int most_pixels_along = 1 << 16;
    const int width = film.width, height = film.height;
    fields.whole("xresolution", film.width, 1, most_pixels_along);
    fields.whole("yresolution", film.height, 1, most_pixels_along);
    if (film.width != width || film.height != height) film.crop.reset();  // a part of the picture that was
    fields.number("iso", film.iso, 0, infinity);
    fields.number("exposure time", film.exposure_time, 0, infinity);
    fields.number("whitebalance", film.white_balance, 0, 1e6);
    fields.number("maxcomponentvalue", film.max_component_value, 0, infinity);
    int space = static_cast<int>(film.space);
    fields.choice("colorspace", space, {"srgb", "dci-p3", "rec2020", "aces2065-1"});
    film.space = static_cast<ColorSpace>(space);
  } else if (of == Part::Kind::filter) {
    PixelFilter& filter = view.filter;
    static const std::array<double, 5> radii = {0.5, 2, 1.5, 2, 4};  // pbrt-v4's
    const auto before = static_cast<int>(filter.kind);
    int kind = before;
    fields.choice(kind_field, kind, {"box", "triangle", "gaussian", "mitchell", "sinc"});
    if (kind != before) {
      filter = PixelFilter{};
      filter.kind = static_cast<PixelFilter::Kind>(kind);
      filter.radius_x = filter.radius_y = radii[static_cast<std::size_t>(kind)];
      return;
    }
    fields.number("xradius", filter.radius_x, 0, 64);
    fields.number("yradius", filter.radius_y, 0, 64);
    if (filter.kind == PixelFilter::Kind::gaussian) fields.number("sigma", filter.sigma, 0, 64);
    if (filter.kind == PixelFilter::Kind::mitchell) {
      fields.number("B", filter.b, -infinity, infinity);
      fields.number("C", filter.c, -infinity, infinity);
    }
    if (filter.kind == PixelFilter::Kind::sinc) fields.number("tau", filter.tau, 0, 64);
  } else if (of == Part::Kind::sampler) {
    int kind = static_cast<int>(view.sampler.kind);
    fields.choice(kind_field, kind, {sampler_names.begin(), sampler_names.end()});
    view.sampler.kind = static_cast<SamplerSettings::Kind>(kind);
    fields.whole("pixelsamples", view.sampler.samples_per_pixel, 1, 1 << 24);
    if (view.sampler.kind == SamplerSettings::Kind::stratified) fields.flag("jitter", view.sampler.jitter);
    int seed = static_cast<int>(view.sampler.seed);  // as scene files say it
    fields.whole("seed", seed, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
    view.sampler.seed = static_cast<std::uint32_t>(seed);
  } else {
    IntegratorSettings& integrator = view.integrator;
    int kind = static_cast<int>(integrator.kind);
    fields.choice(kind_field, kind, {integrator_names.begin(), integrator_names.end()});
    integrator.kind = static_cast<IntegratorSettings::Kind>(kind);
    if (integrator.kind == IntegratorSettings::Kind::ambient_occlusion) {
      fields.flag("cossample", integrator.cosine_sample);
      fields.number("maxdistance", integrator.max_distance, 0, infinity);
      return;
    }
    fields.whole("maxdepth", integrator.max_depth, 0, 10000);
    if (integrator.kind == IntegratorSettings::Kind::simple_path) {
      fields.flag("samplebsdf", integrator.sample_bsdf);
      fields.flag("samplelights", integrator.sample_lights);
    }
  }
}

std::vector<std::string> new_kinds(Part::Kind what) {
  std::vector<std::string> out;
  if (what == Part::Kind::material)
    for (std::size_t i = 0; i < material_kinds.size(); ++i)
      if (!bounds_alone(i)) out.push_back(material_kinds[i]);
  if (what == Part::Kind::shape)
    for (const NewShape& each : new_shapes()) out.push_back(each.name);
  if (what == Part::Kind::light)
    for (std::size_t i = 0; i < light_kinds.size(); ++i)
      if (stands_alone(model_of<LightModel>(i))) out.push_back(light_kinds[i]);
  if (what == Part::Kind::texture)
    for (std::size_t i = 0; i < texture_kinds.size(); ++i)
      if (const TextureKind kind = texture_kind(model_of<TextureModel>(i)); !kind.has_image && kind.has_more)
        out.push_back(texture_kinds[i]);
  return out;
}

Material new_material(const Scene& scene, const Add& add) {
  if (add.like) {
    if (*add.like >= scene.materials.size())
      throw InputError(SourceLocation{"like"}, fmt::format("there are {} materials", scene.materials.size()));
    Material out = scene.materials[*add.like];
    out.name = free_name(scene.materials, out.name.empty() ? material_kinds[out.model.index()] : out.name);
    return out;
  }
  (void)row_of(new_kinds(Part::Kind::material), add.kind);
  const std::size_t kind = row_of(material_kinds, add.kind);
  Material out;
  out.model = default_material(kind, static_cast<std::uint32_t>(scene.materials.size()), scene.materials.size());
  out.name = free_name(scene.materials, add.kind);
  return out;
}

Texture new_texture(const Scene& scene, const Add& add) {
  (void)row_of(new_kinds(Part::Kind::texture), add.kind);
  Texture out;
  out.model = model_of<TextureModel>(row_of(texture_kinds, add.kind));
  out.is_float = texture_kind(out.model).is_float.value_or(add.is_float);
  out.name = free_name(scene.textures, add.kind);
  return out;
}

Light new_light(const Add& add) {
  (void)row_of(new_kinds(Part::Kind::light), add.kind);
  LightTraits traits;
  traits.at = add.at;
  if (glm::length(add.towards) > 0) traits.towards = glm::normalize(add.towards);
  Light out;
  out.model = light_of(row_of(light_kinds, add.kind), traits);
  // As bright at that distance whatever it is.
  if (std::visit([](const auto& m) { return m.unit; }, out.model) == LightUnit::power) out.scale = add.size * add.size;
  return out;
}

Shape new_shape(const Scene& scene, const Add& add) {
  const std::size_t row = row_of(new_kinds(Part::Kind::shape), add.kind);
  if (add.material >= scene.materials.size())
    throw InputError(SourceLocation{"material"}, fmt::format("there are {} materials", scene.materials.size()));
  Shape out;
  out.geometry = new_shapes()[row].geometry;
  out.material = add.material;
  out.name = free_name(scene.shapes, add.kind);
  const Bounds bounds = bounds_of(out.geometry, glm::dmat4(1));
  const glm::dvec3 extent = bounds.max - bounds.min;
  const double factor = add.size * 2 / std::max({extent.x, extent.y, extent.z});
  out.world_from_object =
      glm::translate(glm::scale(glm::translate(glm::dmat4(1), add.at), glm::dvec3(factor)), -0.5 * (bounds.min + bounds.max));
  return out;
}

}  // namespace caplet::view
