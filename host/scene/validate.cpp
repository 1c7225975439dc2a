// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Checks that a scene can be rendered.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <map>
#include <set>

#include "scene/field.h"
#include "scene/scene.h"
#include "scene/transform.h"

namespace caplet {

namespace {

template <class Vector>
bool finite(const Vector& v) {
  for (glm::length_t i = 0; i < v.length(); ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

class Validator {
 public:
  Validator(const Scene& scene, Diagnostics& diagnostics)
      : scene_(scene), diagnostics_(diagnostics) {}

  void run() {
    const SourceLocation file{scene_.source};
    for (std::uint32_t i = 0; i < scene_.textures.size(); ++i)
      std::visit(
          [&](const auto& model) {
            model.fields(model, TextureFields(*this, scene_.textures[i], i));
          },
          scene_.textures[i].model);
    const bool textures_are_sound = said_.empty();
    for (const Material& material : scene_.materials) {
      std::visit([&](const auto& m) { m.fields(m, Checks(*this, material.where)); },
                 material.model);
      if (textures_are_sound) textured(material);
    }
    mixes();
    for (const Medium& medium : scene_.media)
      std::visit([&](const auto& m) { m.fields(m, MediumFields(*this, medium.where)); },
                 medium.model);
    for (const Shape& one : scene_.shapes) shape(one);
    for (const Object& object : scene_.objects)
      for (const Shape& one : object.shapes) shape(one);
    for (const Instance& instance : scene_.instances) {
      if (instance.object >= scene_.objects.size())
        error(instance.where, "an instance of an object that does not exist");
      transform(instance.world_from_object, instance.where);
      motion(instance.motion, instance.where);
    }
    if (said_.empty()) instances();
    if (said_.empty()) open_surfaces();
    for (const Light& one : scene_.lights) light(one);
    camera(file);
    clip(file);
    film(file);
  }

 private:
  /// Reports an error once: an operand of a csg is visited as a shape of its object too.
  void error(const SourceLocation& where, const std::string& message) {
    if (said_.insert(where.to_string() + message).second) diagnostics_.error(where, message);
  }

  static bool moderate(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row)
        if (!(std::abs(m[column][row]) <= largest_length)) return false;
    return true;
  }

  void transform(const glm::dmat4& m, const SourceLocation& where) {
    for (int i = 0; i < 4; ++i)
      if (!finite(m[i])) return error(where, "the transform is not finite");
    const glm::dmat3 a(m);
    // The determinant is relative to the largest box that the columns could span; below 1e-12 an
    // inverse keeps at most 4 digits.
    const double product = glm::length(a[0]) * glm::length(a[1]) * glm::length(a[2]);
    if (!(std::abs(glm::determinant(a)) > 1e-12 * product) || !std::isfinite(product))
      error(where, "the transform is singular (it flattens the shape)");
    else if (said_.empty() && !moderate(glm::inverse(m)))
      error(where, "the inverse of the transform has entries beyond 1e18, where 32-bit floats end");
  }

  void motion(const TransformKeys& keys, const SourceLocation& where) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
      transform(keys[i].matrix, where);
      if (said_.empty() && !moderate(keys[i].matrix)) error(where, too_large);
      if (!std::isfinite(keys[i].time)) error(where, "a time of the motion is not finite");
      if (i == 0) continue;
      if (!(keys[i].time > keys[i - 1].time))
        error(where, "the times of the motion do not rise (TransformTimes, if it is stated)");
      if (glm::determinant(glm::dmat3(keys[i].matrix)) *
              glm::determinant(glm::dmat3(keys[0].matrix)) <
          0)
        error(where, "the motion turns a thing into its mirror image");
    }
    if (keys.size() == 1) error(where, "a motion has two keys or more");
  }

  void spectrum(const Spectrum& s, const SourceLocation& where, const std::string& what) {
    bool good = true;
    if (const auto* constant = std::get_if<ConstantSpectrum>(&s))
      good = std::isfinite(constant->value) && constant->value >= 0;
    if (const auto* rgb = std::get_if<RgbSpectrum>(&s))
      good = finite(rgb->rgb) && rgb->rgb.x >= 0 && rgb->rgb.y >= 0 && rgb->rgb.z >= 0;
    if (const auto* black = std::get_if<BlackbodySpectrum>(&s))
      good = std::isfinite(black->kelvin) && black->kelvin > 0;
    if (const auto* sampled = std::get_if<SampledSpectrum>(&s)) {
      good = !sampled->values.empty() && sampled->values.size() == sampled->wavelengths.size();
      for (std::size_t i = 0; good && i < sampled->values.size(); ++i)
        good = std::isfinite(sampled->values[i]) && sampled->values[i] >= 0 &&
               std::isfinite(sampled->wavelengths[i]) &&
               (i == 0 || sampled->wavelengths[i] > sampled->wavelengths[i - 1]);
    }
    if (!good) error(where, what + " is not a spectrum of finite values from 0 up");
  }

  /// Checks numbers and spectra of every family.
  struct Checks : IgnoresFields, CompositesInParts<Checks> {
    Checks(Validator& all, const SourceLocation& at) : validator(all), where(at) {}
    Validator& validator;
    const SourceLocation& where;

    using CompositesInParts<Checks>::roughness;
    using CompositesInParts<Checks>::metal;
    using CompositesInParts<Checks>::pigment;

    void error(const std::string& message) { validator.error(where, message); }
    void spectrum(const Field& field, const Spectrum& s) {
      validator.spectrum(s, where, field.name);
    }
    void albedo(const Field& field, const Spectrum& s) {
      validator.spectrum(s, where, "the " + std::string(field.name));
    }
    void unbounded(const Field& field, const Spectrum& s) { spectrum(field, s); }
    void index(const Field& field, const Spectrum& s) { spectrum(field, s); }
    void emission(const Field& field, const Spectrum& s) { spectrum(field, s); }
    void number(const Field& field, double value) {
      if (!(is_within(field, value) && std::isfinite(value)))
        error(std::string(field.name) + ' ' + must_lie_within(field));
    }
    void integer(const Field& field, int value) { number(field, value); }
    template <class Names>
    void choice(const Field& field, int value, const Names& names) {
      if (value < 0 || value >= static_cast<int>(names.size()))
        error(std::string(field.name) + " is none that there is");
    }
  };

  /// Checks the calls of textures.def.
  struct TextureFields : Checks {
    TextureFields(Validator& of, const Texture& one, std::uint32_t number)
        : Checks(of, one.where), texture(one), index(number) {}
    const Texture& texture;
    std::uint32_t index;

    void operand(const Field& field, const TextureOperand& of) {
      check(field, of, texture.is_float);
    }
    void factor(const Field& field, const TextureOperand& of) { check(field, of, true); }
    void image(const Field&, const std::shared_ptr<const TextureImage>& of) {
      if (!of || of->width < 1 || of->height < 1 ||
          (of->channels != 1 && of->channels != 3 && of->channels != 4) ||
          (of->bytes.empty() ? of->floats.size() : of->bytes.size()) != of->values())
        error("the texture's image has the wrong size");
    }
    void vectors(const Field& field, const std::shared_ptr<const TextureImage>& of) {
      image(field, of);
    }
    void mapping(const TextureMapping& of) {
      TextureMapping::fields(of, *this);
      if (of.kind != TextureMapping::Kind::uv) place(of.texture_from_world);
    }
    void board(const TextureMapping& of) { mapping(of); }
    void vector(const Field& field, const glm::dvec3& v) {
      if (!finite(v)) error(std::string(field.name) + " is not finite");
    }
    void direction(const Field& field, const glm::dvec3& v) {
      if (!(std::abs(glm::length(v) - 1) < 1e-6))
        error(std::string(field.name) + " is no direction of unit length");
    }
    void only(bool is_float) {
      if (texture.is_float != is_float)
        error("the texture is of " + std::string(is_float ? "floats" : "spectra") + " alone");
    }
    void place(const glm::dmat4& m) {
      if (!moderate(m))
        error("the texture's transform has entries beyond 1e18, where 32-bit floats end");
    }
    void check(const Field& field, const TextureOperand& of, bool is_float) {
      if (of.texture) {
        if (*of.texture >= index || validator.scene_.textures[*of.texture].is_float != is_float)
          error(std::string(field.name) + " is no texture of " + (is_float ? "floats" : "spectra") +
                " before");
      } else if (!is_float) {
        spectrum(field, of.value);
      } else {
        const auto* number_of = std::get_if<ConstantSpectrum>(&of.value);
        if (!number_of || !std::isfinite(number_of->value))
          error(std::string(field.name) + " is not a finite number");
      }
    }
  };

  /// Collects which parameters of a material may be textures, and whether of floats, from the calls
  /// of materials.def.
  struct TexturedFields : IgnoresFields, CompositesInParts<TexturedFields> {
    std::map<std::string, bool, std::less<>> is_float = {};

    using CompositesInParts<TexturedFields>::roughness;
    using CompositesInParts<TexturedFields>::metal;
    using CompositesInParts<TexturedFields>::pigment;

    void albedo(const Field& field, const Spectrum&) { is_float[field.name] = false; }
    void unbounded(const Field& field, const Spectrum&) { is_float[field.name] = false; }
    void number(const Field& field, double) { is_float[field.name] = true; }
  };

  /// Checks that a texture is one of floats and has few enough parts.
  void float_texture(std::uint32_t texture, const SourceLocation& where, const char* name) {
    if (texture >= scene_.textures.size() || !scene_.textures[texture].is_float)
      error(where, "the " + std::string(name) + " is not a texture of floats");
    else
      parts(texture);
  }

  void parts(std::uint32_t texture) {
    if (texture_steps(scene_.textures, texture) > most_texture_steps)
      error(scene_.textures[texture].where,
            "the texture \"" + scene_.textures[texture].name + "\" is made of more than " +
                std::to_string(most_texture_steps) + " textures and constants");
  }

  void textured(const Material& material) {
    if (material.displacement)
      float_texture(*material.displacement, material.where, "displacement");
    if (material.normalmap &&
        (*material.normalmap >= scene_.textures.size() ||
         !std::holds_alternative<NormalmapTexture>(scene_.textures[*material.normalmap].model)))
      error(material.where, "the normalmap is no image");
    if (material.displacement && material.normalmap)
      error(material.where, "the material has both a displacement and a normalmap");
    TexturedFields fields;
    std::visit([&](const auto& m) { m.fields(m, fields); }, material.model);
    std::set<std::string> seen;
    for (const TexturedField& one : material.textures) {
      const auto found = fields.is_float.find(one.field);
      if (found == fields.is_float.end() || !seen.insert(one.field).second)
        error(material.where,
              "the material has no " + one.field + " that may be a texture, or has it twice");
      else if (one.texture >= scene_.textures.size() ||
               scene_.textures[one.texture].is_float != found->second)
        error(material.where, "the " + one.field + " is not a texture of " +
                                  (found->second ? "floats" : "spectra"));
      else
        parts(one.texture);
    }
  }

  /// Checks that parts of mixes are materials that exist, and that no mix contains itself.
  void mixes() {
    enum class State { unseen, open, done };
    std::vector<State> states(scene_.materials.size(), State::unseen);
    std::vector<std::uint32_t> open;  // each is a part of the one before
    for (std::uint32_t i = 0; i < states.size(); ++i) {
      if (states[i] == State::unseen) open.push_back(i);
      while (!open.empty()) {
        const std::uint32_t at = open.back();
        const auto* mix = std::get_if<MixMaterial>(&scene_.materials[at].model);
        const bool first_time = states[at] == State::unseen;
        states[at] = first_time && mix ? State::open : State::done;
        if (states[at] == State::done) {
          open.pop_back();
          continue;
        }
        for (const std::uint32_t part : mix->materials)
          if (part >= states.size())
            error(scene_.materials[at].where, "a mix has a material that does not exist");
          else if (states[part] == State::open)
            error(scene_.materials[at].where, "a mix is a part of itself");
          else if (states[part] == State::unseen)
            open.push_back(part);
      }
    }
  }

  /// Checks the calls of media.def.
  struct MediumFields : Checks {
    using Checks::Checks;
    using Checks::emission;

    template <class Preset>
    void scattering(const ScatteringProperties& of, Preset&&) {
      ScatteringProperties::fields(of, *this);
    }
    void emission(const Field& field, const std::optional<Spectrum>& radiance, double scale = 0) {
      if (radiance) spectrum(field, *radiance);
      number(radiance_scale_field, scale);
    }
    void asymmetry(double g) { number(asymmetry_field, g); }
    void bounds(const MediumBounds& of) {
      for (int k = 0; k < 3; ++k)
        if (!(of.p0[k] < of.p1[k] && of.p0[k] >= -largest_length && of.p1[k] <= largest_length))
          return error("the medium's box from p0 to p1 has no inside");
      validator.transform(of.world_from_medium, where);
    }
    void counts(const GridCounts& of) {
      for (const int count : of)
        if (count < 1) return error("a grid must have at least one cell along each side");
    }
    void grid(const Field& field, const FloatGrid& of, const GridCounts& counts, bool is_needed) {
      if (of || is_needed) values(field.name, of, counts, 1);
    }
    void grid(const Field& field, const ColorGrid& of, const GridCounts& counts) {
      if (of.rgb) values(field.name, of.rgb, counts, 3);
    }
    void volume(const SparseGridPointer& density, const SparseGridPointer& temperature,
                const glm::dmat4& world_from_medium) {
      if (!density || density->bricks.empty()) return error("the medium has no density anywhere");
      bounds({density->box.min, density->box.max, world_from_medium});
      for (const SparseGridPointer& grid : {density, temperature}) {
        if (!grid) continue;
        std::array<std::int64_t, 3> low{}, high{};
        for (const auto& brick : grid->bricks)
          for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min<std::int64_t>(low[k], brick[k]);
            high[k] = std::max<std::int64_t>(high[k], brick[k]);
          }
        double spanned = 1;
        for (std::size_t k = 0; k < 3; ++k) spanned *= static_cast<double>(high[k] - low[k] + 1);
        if (spanned > static_cast<double>(most_spanned_bricks) ||
            grid->values.size() != 512 * grid->bricks.size())
          return error("a grid's bricks span too much, or have the wrong number of values");
        validator.transform(world_from_medium * grid->medium_from_voxels, where);
        for (const float value : grid->values)
          if (!(value >= 0 && std::isfinite(value)))
            return error("a grid has values that are negative or not finite");
      }
    }
    void heat(const std::optional<Spectrum>& radiance, const FloatGrid& temperature) {
      if (radiance && temperature)
        error("a medium cannot have both an \"Le\" and a \"temperature\"");
    }
    void any_of(const ColorGrid& sigma_a, const ColorGrid& sigma_s, const ColorGrid& radiance) {
      if (!sigma_a.rgb && !sigma_s.rgb) error("the grid needs a \"sigma_a\" or a \"sigma_s\"");
      if (radiance.rgb && !sigma_a.rgb) error("an \"Le\" needs a \"sigma_a\"");
    }
    void values(const char* name, const FloatGrid& of, const GridCounts& counts, std::size_t each) {
      if (std::ranges::min(counts) < 1) return;  // an error of its own
      const std::size_t expected = each * cells_of(counts), given = of ? of->size() : 0;
      if (given != expected)
        return error(std::string(name) + " has " + std::to_string(given) +
                     " values, but a grid of " + std::to_string(counts[0]) + " x " +
                     std::to_string(counts[1]) + " x " + std::to_string(counts[2]) +
                     " cells takes " + std::to_string(expected));
      for (const float value : *of)
        if (!(value >= 0 && std::isfinite(value)))
          return error(std::string(name) + " has values that are negative or not finite");
    }
  };

  void medium(const std::optional<std::uint32_t>& index, const SourceLocation& where,
              const char* what) {
    if (index && *index >= scene_.media.size())
      error(where, std::string(what) + " has a medium that does not exist");
  }

  /// A medium needs an enclosure: a solid, a closed mesh, or several surfaces, which are trusted to
  /// enclose it together. One open surface may be a window of a room whose walls are opaque.
  void open_surfaces() {
    std::map<std::pair<std::optional<std::uint32_t>, std::optional<std::uint32_t>>,
             std::vector<const Shape*>>
        open;
    const auto add = [&](const std::vector<Shape>& shapes) {
      for (const Shape& shape : shapes)
        if (shape.media.inside && shape.media.differ() && open_edges(shape) > 0)
          open[{shape.media.inside, shape.media.outside}].push_back(&shape);
    };
    add(scene_.shapes);
    for (const Object& object : scene_.objects) add(object.shapes);
    for (const auto& [sides, shapes] : open) {
      if (shapes.size() > 1) continue;
      const Shape& shape = *shapes[0];
      const Medium& medium = scene_.media[*shape.media.inside];
      const std::string said = "the medium " + medium.name + " is on an open surface: a " +
                               geometry_name(shape) + " does not enclose it";
      if (open_edges(shape) <= most_open_edges)
        diagnostics_.warning(shape.where, said + " altogether");
      else if (medium.subsurface)
        error(shape.where, said);
      else
        diagnostics_.warning(shape.where, said + "; what goes through it is within");
    }
  }
  static constexpr double most_open_edges =
      0.1;  // of a mesh that counts as closed except for holes

  /// Checks the calls of lights.def.
  struct LightFields : Checks {
    using Checks::Checks;

    void position(const Field&, const glm::dvec3& p) {
      if (!finite(p)) error("the light's position is not finite");
    }
    void direction(const Field&, const Field&, const glm::dvec3& d) {
      if (!finite(d)) error("the light's direction is not finite");
    }
    void place(const glm::dvec3& p, const glm::dmat3& turn) {
      if (!finite(p)) error("the light's position is not finite");
      if (!finite(turn[0]) || !finite(turn[1]) || !finite(turn[2]))
        error("the light's rotation is not finite");
    }
    void image(const Field&, const std::shared_ptr<const EnvironmentImage>& of) {
      if (!of) return error("the light has no image");
      validator.image(*of, where);
    }
    void directions(const Field& field, const std::shared_ptr<const EnvironmentImage>& of) {
      image(field, of);
      if (of && of->width != of->height) error("the light's image is not square");
    }
    void profile(const Field&, const std::shared_ptr<const IesProfile>& of) {
      if (!of) return error("the light has no profile");
      bool good = of->polar.size() >= 2 && !of->azimuths.empty() &&
                  of->candela.size() == of->polar.size() * of->azimuths.size();
      for (const auto* angles : {&of->polar, &of->azimuths})
        for (std::size_t i = 0; i < angles->size(); ++i)
          good = good && std::isfinite((*angles)[i]) && (i == 0 || (*angles)[i] > (*angles)[i - 1]);
      for (const double value : of->candela) good = good && std::isfinite(value) && value >= 0;
      if (!good) error("the light's profile is no table of intensities by ascending angles");
    }
    void sky(const InfiniteLight& l) {
      emission(InfiniteLight::radiance_field, l.radiance);
      if (l.image) validator.image(*l.image, where);
      if (l.portal) validator.portal(*l.portal, where);
    }
  };

  void image(const EnvironmentImage& of, const SourceLocation& where) {
    if (of.width <= 0 || of.height <= 0 ||
        of.rgb.size() !=
            3 * static_cast<std::size_t>(of.width) * static_cast<std::size_t>(of.height))
      return error(where, "the light's image has the wrong size");
    for (const float value : of.rgb)
      if (!std::isfinite(value))
        return error(where, "the light's image has pixels that are not finite");
  }

  /// The sides match a rectangle's to 1e-3, as in pbrt-v4.
  void portal(const LightPortal& p, const SourceLocation& where) {
    for (const glm::dvec3& corner : p)
      for (int k = 0; k < 3; ++k)
        if (!(std::abs(corner[k]) <= largest_length))
          return error(where, "the portal has a corner that is not within 1e18");
    std::array<glm::dvec3, 4> sides;  // 01, 12, 32, 03
    const std::array<glm::dvec3, 4> edges = {p[1] - p[0], p[2] - p[1], p[2] - p[3], p[3] - p[0]};
    for (std::size_t i = 0; i < 4; ++i) {
      if (!(glm::length(edges[i]) > 0))
        return error(where, "the portal has two corners in one place");
      sides[i] = glm::normalize(edges[i]);
    }
    const auto along = [&](std::size_t a, std::size_t b) { return glm::dot(sides[a], sides[b]); };
    if (!(std::abs(along(0, 2) - 1) < 1e-3 && std::abs(along(1, 3) - 1) < 1e-3 &&
          std::abs(along(0, 1)) < 1e-3 && std::abs(along(0, 3)) < 1e-3))
      error(where, "the portal's corners are not those of a rectangle, in order");
  }

  /// Reports what a geometry finds at the place of its shape.
  class Report : public ShapeCheck {
   public:
    Report(Validator& all, const SourceLocation& where) : all_(all), where_(where) {}
    void error(const std::string& message) override { all_.error(where_, message); }
    void error(std::string_view field, const std::string& message) override {
      error('"' + std::string(field) + "\" " + message);
    }
    std::size_t materials() const override { return all_.scene_.materials.size(); }
    void operand(const Shape& shape) override { all_.geometry(shape); }

   private:
    Validator& all_;
    const SourceLocation& where_;
  };

  /// Checks where instances lie, by the boxes of their objects.
  void instances() {
    std::vector<Bounds> boxes(scene_.objects.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (const Shape& one : scene_.objects[i].shapes) boxes[i].extend(bounds_of(one));
    for (const Instance& instance : scene_.instances) {
      const Bounds& box = boxes[instance.object];
      if (box.empty()) continue;
      Bounds placed;
      const auto place = [&](const glm::dmat4& world_from_object) {
        for (int corner = 0; corner < 8; ++corner)
          placed.extend(
              glm::dvec3(world_from_object * glm::dvec4(corner & 1 ? box.max.x : box.min.x,
                                                        corner & 2 ? box.max.y : box.min.y,
                                                        corner & 4 ? box.max.z : box.min.z, 1)));
      };
      place(instance.world_from_object);
      for (const TransformKey& key : instance.motion) place(key.matrix);
      if (!within_reach(placed))
        error(instance.where, too_far);
      else if (!moderate(instance.world_from_object))
        error(instance.where, too_large);
    }
  }

  /// Checks transform, geometry and materials, for operands too.
  void geometry(const Shape& s) {
    transform(s.world_from_object, s.where);
    Report report(*this, s.where);
    check_geometry(s, report);
    if (s.alpha) {
      const auto* number_of = std::get_if<ConstantSpectrum>(&s.alpha->value);
      if (s.alpha->texture)
        float_texture(*s.alpha->texture, s.where, "alpha");
      else if (!number_of || !std::isfinite(number_of->value))
        error(s.where, "the alpha is not a finite number");
    }
    if (const auto* csg = std::get_if<CsgShape>(&s.geometry))
      for (std::size_t i = 0; i < csg->operands.size(); ++i) {
        const Shape& operand = *csg->operands[i];
        if (operand.alpha)
          error(operand.where,
                "an operand of a csg has no \"alpha\" of its own: give it to the csg");
        if (i < csg->motions.size()) motion(csg->motions[i], operand.where);
      }
    medium(s.media.inside, s.where, "the inside of the shape");
    medium(s.media.outside, s.where, "the outside of the shape");
    if (s.one_sided && s.media.inside && s.media.differ())
      error(s.where, "a shape that is not seen from inside holds no medium");
    if (s.material >= scene_.materials.size())
      error(s.where, "the shape has a material that does not exist");
    for (const std::uint32_t material : s.materials)
      if (material >= scene_.materials.size())
        error(s.where, "a surface of the shape has a material that does not exist");
    if (!s.materials.empty() && s.materials.size() != surface_count(s))
      error(s.where, "the shape has " + std::to_string(surface_count(s)) +
                         " surfaces, but materials for " + std::to_string(s.materials.size()));
  }

  void emission(const Shape& s) {
    spectrum(s.emission->radiance, s.where, "the emission");
    if (s.emission->image) image(*s.emission->image, s.where);
    if (!(s.emission->scale >= 0 && std::isfinite(s.emission->scale)))
      error(s.where, "the emission's scale must be from 0 up");
    for (const std::uint32_t surface : s.emission->surfaces)
      if (surface >= surface_count(s))
        error(s.where, "the light is on surface " + std::to_string(surface) +
                           ", but the surfaces are numbered from 0 to " +
                           std::to_string(surface_count(s) - 1));
    if (s.emission->power && std::holds_alternative<CsgShape>(s.geometry))
      error(s.where,
            "a csg cannot be a light of a given \"power\", as its area is not known; give it an "
            "\"L\"");
    if (s.emission->power && moves(s))
      error(
          s.where,
          "a shape whose points move cannot be a light of a given \"power\", as its area changes; "
          "give it an \"L\"");
  }

  void shape(const Shape& s) {
    const std::size_t before = said_.size();
    geometry(s);
    if (said_.size() != before) return;
    if (s.emission) emission(s);
    const Bounds bounds = bounds_of(s);
    if (bounds.empty()) {
      if (std::holds_alternative<CsgShape>(s.geometry))
        diagnostics_.warning(s.where,
                             "the csg is empty and draws nothing: its operands leave no solid");
    } else if (!within_reach(bounds)) {
      error(s.where, too_far);
    } else if (!moderate(s.world_from_object)) {
      error(s.where, too_large);
    }
  }

  static constexpr const char* too_far =
      "the shape reaches further than 1e18 from the origin, where 32-bit floats end";
  static constexpr const char* too_large =
      "the transform has entries beyond 1e18, where 32-bit floats end";
  static bool within_reach(const Bounds& bounds) {
    for (int k = 0; k < 3; ++k)
      if (!(bounds.min[k] >= -largest_length && bounds.max[k] <= largest_length)) return false;
    return true;
  }

  void light(const Light& l) {
    if (!(l.scale >= 0 && std::isfinite(l.scale)))
      error(l.where, "the light's scale must be finite and from 0 up");
    std::visit([&](const auto& model) { model.fields(model, LightFields(*this, l.where)); },
               l.model);
  }

  struct CameraFields : Checks {
    using Checks::Checks;

    void field_of_view(double radians) {
      if (!(radians > 0 && radians < 3.14159265358979))
        error("the camera's field of view must lie between 0 and 180 degrees");
    }
  };

  void camera(const SourceLocation& file) {
    const Camera& c = scene_.view.camera;
    medium(c.medium, file, "the camera");
    transform(c.world_from_camera, file);
    motion(c.motion, file);
    if (said_.empty() && !moderate(c.world_from_camera)) error(file, too_large);
    std::visit([&](const auto& of) { of.fields(of, CameraFields(*this, file)); }, c.projection);
    std::visit(
        [&](const auto& of) {
          if constexpr (requires { of.problem(); })
            if (const std::string problem = of.problem(); !problem.empty())
              error(file, "the camera: " + problem);
        },
        c.projection);
    if (!(c.lens_radius >= 0 && std::isfinite(c.lens_radius)))
      error(file, "the camera's lens radius must be from 0 up");
    if (c.blades < 0 || c.blades > 64)
      error(file, "the blades of the camera's lens must be 0 to 64");
    if (!std::isfinite(c.blade_rotation))
      error(file, "the rotation of the camera's blades must be finite");
    if (!(c.focal_distance > 0 && std::isfinite(c.focal_distance)))
      error(file, "the camera's focal distance must be positive");
    else if (!(c.lens_radius <= largest_length &&
               c.lens_radius <= largest_length * c.focal_distance))
      error(file,
            "the camera's lens radius must be at most 1e18, and 1e18 times its focal distance, "
            "where 32-bit floats end");
  }

  void clip(const SourceLocation& file) {
    const auto& clip = scene_.view.clip;
    if (!clip) return;
    if (!is_unit(glm::length(clip->normal)))
      error(file, "the normal of the clipping plane must be a unit vector");
    if (!(std::abs(clip->offset) <= largest_length))
      error(file, "the clipping plane must be within 1e18 of the origin");
  }

  void film(const SourceLocation& file) {
    const FilmSettings& f = scene_.view.film;
    if (!(f.readout >= 0 && std::isfinite(f.readout)))
      error(file, "the readout of the shutter must be finite and from 0 up");
    if (const double noise = scene_.view.sampler.noise;
        noise != 0 && !(noise >= least_noise && noise <= 1))
      error(file, "the noise of the sampler must be 0, or from 1e-5 to 1");
    if (f.width <= 0 || f.height <= 0)
      error(file, "the image size must be positive");
    else if (std::int64_t{f.width} * f.height > most_image_pixels)
      error(file, "the image of " + std::to_string(f.width) + " x " + std::to_string(f.height) +
                      " pixels is larger than 2^28 pixels");
    if (scene_.view.sampler.samples_per_pixel <= 0)
      error(file, "the samples per pixel must be positive");
    if (scene_.view.integrator.max_depth < 0) error(file, "the depth must not be negative");
    if (!(scene_.view.integrator.max_distance > 0))
      error(file, "the integrator's greatest distance must be positive");
    if (!(scene_.view.filter.radius_x > 0 && scene_.view.filter.radius_y > 0))
      error(file, "the pixel filter's radius must be positive");
  }

  const Scene& scene_;
  Diagnostics& diagnostics_;
  std::set<std::string> said_;
};

}  // namespace

void validate(const Scene& scene, Diagnostics& diagnostics) { Validator(scene, diagnostics).run(); }

}  // namespace caplet
