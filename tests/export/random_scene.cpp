// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "random_scene.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>
#include <random>

#include "import/import.h"
#include "scene/frozen.h"

namespace caplet::test {

namespace fs = std::filesystem;

namespace {

float pixel(const fs::path& path, std::size_t i) {
  return static_cast<float>(std::hash<std::string>()(path.stem().string()) % 97 + i % 13) / 128;
}

class Random : public Draws {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) override {
    return std::uniform_real_distribution<>(low, high)(engine_);
  }
  double power(double low, double high) override { return std::pow(10, uniform(low, high)); }
  std::size_t below(std::size_t n) override { return engine_() % n; }
  glm::dvec3 direction() override {
    for (;;)
      if (const glm::dvec3 d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)); glm::length(d) > 0.1)
        return glm::normalize(d);
  }
  glm::dmat3 turn() {
    const glm::dvec3 x = direction(), z = glm::normalize(glm::cross(x, direction()));
    return {x, glm::cross(z, x), one_in(2) ? z : -z};
  }
  glm::dmat4 transform() {
    glm::dmat4 out(turn());
    const double scale = uniform(0.3, 2);
    for (int k = 0; k < 3; ++k) out[k] *= scale * (one_in(2) ? 1 : uniform(0.5, 1.5));
    out[3] = glm::dvec4(5.0 * direction(), 1);
    return out;
  }
  double within(double low, double high) {
    return uniform(std::isfinite(low) ? low : -3, std::isfinite(high)  ? std::min(high, 1e3)
                                                  : std::isfinite(low) ? low + 3
                                                                       : 3);
  }
  Spectrum spectrum(double most) {
    const auto part = [&] { return uniform(0.01, most); };
    switch (below(4)) {
      case 0:
        return ConstantSpectrum{part()};
      case 1:
        return RgbSpectrum{{part(), part(), part()}, static_cast<ColorSpace>(below(4))};
      case 2:
        return SampledSpectrum{{400, uniform(450, 600), 700}, {part(), part(), part()}};
      default:
        return most < 1 ? Spectrum(ConstantSpectrum{part()})
                        : Spectrum(BlackbodySpectrum{uniform(1000, 9000)});
    }
  }

 private:
  std::mt19937 engine_;
};

struct Files {
  fs::path folder;
  NamedImages images = {};
  std::string named(const std::string& name) const {
    const fs::path path = folder / name;
    if (!fs::exists(path))
      std::ofstream(path)
          << "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0 1 1 60\n0 45 90\n0\n100 80 7\n";
    return path.string();
  }
  // Each once, as importers have them.
  std::shared_ptr<const TextureImage> texture(const std::string& name,
                                              const ImageEncoding& encoding) const {
    auto& image = textures[{name, encoding}];
    if (!image) image = std::make_shared<TextureImage>(images.read_texture(named(name), encoding));
    return image;
  }
  std::shared_ptr<const EnvironmentImage> light(const std::string& name) const {
    auto& image = lights[name];
    if (!image) image = std::make_shared<EnvironmentImage>(images.read_rgb(named(name)));
    return image;
  }
  mutable std::map<std::pair<std::string, ImageEncoding>, std::shared_ptr<const TextureImage>>
      textures = {};
  mutable std::map<std::string, std::shared_ptr<const EnvironmentImage>> lights = {};
  mutable std::shared_ptr<const IesProfile> lamp = {};
};

struct FillTexture : IgnoresFields {
  FillTexture(Random& draws, const Files& from, const Scene& of, bool floats)
      : random(draws), files(from), scene(of), is_float(floats) {}
  Random& random;
  const Files& files;
  const Scene& scene;
  bool is_float;
  bool fits = true;
  std::size_t operands = 0;

  std::optional<std::uint32_t> other(bool floats) {
    for (std::uint32_t i = 0; i < scene.textures.size(); ++i)
      if (scene.textures[i].is_float == floats && texture_steps(scene.textures, i) < 8) return i;
    return std::nullopt;
  }
  void operand(const Field&, TextureOperand& of) { put(of, is_float); }
  void factor(const Field&, TextureOperand& of) { put(of, true); }
  void put(TextureOperand& of, bool floats) {
    of.value = floats ? Spectrum(ConstantSpectrum{random.uniform(0.1, 0.9)}) : random.spectrum(0.9);
    // The first is a texture, for what is of constants alone is read as one.
    if (operands++ == 0 || random.one_in(4)) of.texture = other(floats);
  }
  void number(const Field&, double& value) { value = random.uniform(0.2, 2); }
  template <class Names>
  void choice(const Field&, int& value, const Names& names) {
    value = static_cast<int>(random.below(names.size()));
  }
  void flag(const Field&, bool& value) { value = random.one_in(2); }
  void image(const Field&, std::shared_ptr<const TextureImage>& of) {
    const ImageEncoding encodings[] = {
        {}, {ImageEncoding::Kind::linear, 1}, {ImageEncoding::Kind::gamma, 2.1}};
    of = files.texture("colors.png", encodings[random.below(3)]);
  }
  void mapping(TextureMapping& of) {
    of.kind = static_cast<TextureMapping::Kind>(random.below(4));
    if (of.kind != TextureMapping::Kind::uv) of.texture_from_world = random.transform();
    if (of.kind == TextureMapping::Kind::uv)
      of.uscale = random.uniform(1, 9), of.vscale = random.uniform(1, 9);
    if (of.kind == TextureMapping::Kind::planar)
      of.v1 = random.direction(), of.v2 = random.direction();
    if (of.kind == TextureMapping::Kind::planar || of.kind == TextureMapping::Kind::uv)
      of.udelta = 0.3, of.vdelta = 0.7;
  }
  void board(TextureMapping& of) {
    mapping(of);
    if (!random.one_in(3)) return;
    of = {};
    of.kind = TextureMapping::Kind::solid;
    of.texture_from_world = random.transform();
  }
  void place(glm::dmat4& of) { of = random.transform(); }
  void direction(const Field&, glm::dvec3& of) { of = random.direction(); }
  void integer(const Field& field, int& value) {
    value = static_cast<int>(field.low) + 1 + static_cast<int>(random.below(6));
  }
  void only(bool floats) { fits = fits && floats == is_float; }
  void vectors(const Field&, std::shared_ptr<const TextureImage>&) { fits = false; }
};

struct FillMaterial : CompositesInParts<FillMaterial> {
  FillMaterial(Random& draws, const Scene& of, Material& to)
      : random(draws), scene(of), material(to) {}
  Random& random;
  const Scene& scene;
  Material& material;

  bool textured(const std::string& field, bool floats) {
    if (!random.one_in(3)) return false;
    std::vector<std::uint32_t> fitting;
    for (std::uint32_t i = 0; i < scene.textures.size(); ++i)
      if (scene.textures[i].is_float == floats &&
          !std::holds_alternative<NormalmapTexture>(scene.textures[i].model))
        fitting.push_back(i);
    material.textures.push_back({field, fitting[random.below(fitting.size())]});
    return true;
  }
  void albedo(const Field& field, Spectrum& of) {
    if (!textured(field.name, false)) of = random.spectrum(0.99);
  }
  void unbounded(const Field& field, Spectrum& of) {
    if (!textured(field.name, false)) of = random.spectrum(3);
  }
  void index(const Field&, Spectrum& of) {
    of = random.one_in(2) ? Spectrum(ConstantSpectrum{random.uniform(1.1, 2)})
                          : SampledSpectrum{{400, 700}, {1.6, 1.5}};
  }
  void number(const Field& field, double& of) {
    if (!textured(field.name, true)) of = random.within(field.low, field.high);
  }
  void integer(const Field& field, int& of) {
    of = static_cast<int>(field.low) + 1 + static_cast<int>(random.below(9));
  }
  void flag(const Field&, bool& of) { of = random.one_in(2); }
  void parts(const Field&, std::array<std::uint32_t, 2>& of) { of = {0, 1}; }
  void pigment(const PigmentFields& fields, Spectrum& sigma_a,
               std::optional<Spectrum>& reflectance) {
    if (random.one_in(2)) reflectance = ConstantSpectrum{0.5};
    CompositesInParts::pigment(fields, sigma_a, reflectance);
  }
  void metal(const MetalFields& fields, Spectrum& eta, Spectrum& k,
             std::optional<Spectrum>& reflectance) {
    if (random.one_in(2)) reflectance = ConstantSpectrum{0.5};
    CompositesInParts::metal(fields, eta, k, reflectance);
  }
};

struct FillMedium {
  Random& random;
  GridCounts counts_ = {1, 1, 1};
  bool fits = true;

  template <class Preset>
  void scattering(ScatteringProperties& of, Preset&&) {
    of = {random.spectrum(2), random.spectrum(2), random.uniform(0.5, 2),
          random.uniform(-0.9, 0.9)};
  }
  void asymmetry(double& g) { g = random.uniform(-0.9, 0.9); }
  void emission(const Field&, std::optional<Spectrum>& of) {
    if (random.one_in(2)) of = random.spectrum(2);
  }
  void emission(const Field& field, std::optional<Spectrum>& of, double& scale) {
    emission(field, of);
    scale = random.uniform(0.1, 2);
  }
  void bounds(MediumBounds& of) {
    of = {random.direction() - 2.0, random.direction() + 2.0, random.transform()};
  }
  void counts(GridCounts& of) { of = counts_ = {2, 3, 1 + static_cast<int>(random.below(3))}; }
  void grid(const Field& field, FloatGrid& of, const GridCounts&, bool is_needed) {
    if (is_needed || std::string(field.name) != "temperature") of = values(1);
  }
  void grid(const Field&, ColorGrid& of, const GridCounts&) {
    of = {values(3), static_cast<ColorSpace>(random.below(4))};
  }
  FloatGrid values(std::size_t each) {
    std::vector<float> out(each * cells_of(counts_));
    for (float& value : out) value = static_cast<float>(random.uniform(0, 2));
    return std::make_shared<const std::vector<float>>(std::move(out));
  }
  void number(const Field& field, double& of) { of = random.within(field.low, field.high); }
  void volume(SparseGridPointer&, SparseGridPointer&, glm::dmat4&) {
    fits = false;
  }  // of files: round_trip_test.cpp
  void heat(const std::optional<Spectrum>&, const FloatGrid&) {}
  void any_of(const ColorGrid&, const ColorGrid&, const ColorGrid&) {}
};

struct FillLight {
  Random& random;
  const Files& files;

  void emission(const Field&, Spectrum& of) { of = random.spectrum(5); }
  void position(const Field&, glm::dvec3& of) { of = 7.0 * random.direction(); }
  void direction(const Field&, const Field&, glm::dvec3& of) { of = random.direction(); }
  void number(const Field& field, double& of) { of = random.uniform(field.low, field.high); }
  void place(glm::dvec3& at, glm::dmat3& turn) {
    at = 7.0 * random.direction();
    turn = random.turn();
  }
  void image(const Field&, std::shared_ptr<const EnvironmentImage>& of) { of = read("wide.exr"); }
  void directions(const Field&, std::shared_ptr<const EnvironmentImage>& of) {
    of = read("square.exr");
  }
  void profile(const Field&, std::shared_ptr<const IesProfile>& of) {
    if ((of = files.lamp)) return;
    auto made = std::make_shared<IesProfile>();
    made->file = files.named("lamp.ies");
    const double quarter = std::numbers::pi / 4;
    made->polar = {0, quarter, 2 * quarter};
    made->azimuths = {0};
    made->candela = {100, 80, 7};
    of = files.lamp = made;
  }
  void cone(double& total, double& start) {
    total = random.uniform(0.3, 1.5);
    start = random.uniform(0.1, total);
  }
  void sky(InfiniteLight& of) {
    if (random.one_in(2)) {
      of.image = read(random.one_in(2) ? "square.exr" : "wide.exr");
      of.world_from_light = random.turn();
    } else {
      of.radiance = random.spectrum(3);
    }
    if (!random.one_in(2)) return;
    const glm::dmat3 turn = random.turn();
    const glm::dvec3 corner = 3.0 * turn[2], x = 0.3 * turn[0], y = 0.4 * turn[1];
    of.portal = LightPortal{corner, corner + y, corner + x + y, corner + x};
  }
  std::shared_ptr<const EnvironmentImage> read(const char* name) { return files.light(name); }
};

class Maker {
 public:
  Maker(unsigned seed, fs::path folder) : random_(seed), files_{std::move(folder)} {}

  Scene run() {
    textures();
    materials();
    media();
    lights();
    shapes();
    camera();
    motions();
    scene_.source = "random";
    return std::move(scene_);
  }

 private:
  void textures() {
    for (const bool is_float : {true, false}) {
      BilerpTexture first;
      FillTexture fill(random_, files_, scene_, is_float);
      BilerpTexture::fields(first, fill);
      scene_.textures.push_back({first, is_float, "first", {}});
    }
#define TEXTURE_MODEL(row, Type)                                                       \
  for (const bool is_float : {true, false}) {                                          \
    Type model;                                                                        \
    FillTexture fill(random_, files_, scene_, is_float);                               \
    Type::fields(model, fill);                                                         \
    if (fill.fits)                                                                     \
      scene_.textures.push_back({model, is_float, random_.one_in(3) ? "" : #row, {}}); \
  }
#include "scene/textures.def"
  }

  void materials() {
    for (int i = 0; i < 2; ++i)
      scene_.materials.push_back({DiffuseMaterial{random_.spectrum(0.9)}, "", {}});
#define MATERIAL_MODEL(row, Type)                                 \
  for (int i = 0; i < 2; ++i) {                                   \
    Material material;                                            \
    Type model;                                                   \
    Type::fields(model, FillMaterial(random_, scene_, material)); \
    material.model = model;                                       \
    material.name = i == 0 ? #row : "two of \"" #row "\"";        \
    if (!std::is_same_v<Type, InterfaceMaterial>) bend(material); \
    if (i == 0 || !std::is_same_v<Type, InterfaceMaterial>)       \
      scene_.materials.push_back(std::move(material));            \
  }
#include "scene/materials.def"
  }
  void bend(Material& material) {
    if (random_.one_in(3)) material.displacement = 0;
    if (material.displacement || !random_.one_in(3)) return;
    const auto image = files_.texture("normals.png", {ImageEncoding::Kind::linear, 1});
    material.normalmap = static_cast<std::uint32_t>(scene_.textures.size());
    scene_.textures.push_back({NormalmapTexture{image}, false, "", {}});
  }

  void media() {
#define MEDIUM_MODEL(row, Type)                                                        \
  {                                                                                    \
    Type model;                                                                        \
    FillMedium fill{random_};                                                          \
    Type::fields(model, fill);                                                         \
    if (fill.fits) scene_.media.push_back({model, random_.one_in(2) ? "" : #row, {}}); \
  }
#include "scene/media.def"
  }

  void lights() {
#define LIGHT_MODEL(row, Type)                                                                    \
  for (int i = 0; i < 2; ++i) {                                                                   \
    Type model;                                                                                   \
    Type::fields(model, FillLight{random_, files_});                                              \
    Light light{model, random_.uniform(0.5, 2), {}, {}, {}};                                      \
    if (i == 1)                                                                                   \
      (Type::unit == LightUnit::power ? light.power : light.illuminance) = random_.uniform(1, 9); \
    scene_.lights.push_back(std::move(light));                                                    \
  }
#include "scene/lights.def"
  }

  template <class Type>
  void add(std::type_identity<Type> type) {
    for (int sort = 0; sort < drawn_sorts<Type>; ++sort) {
      random_.size = random_.uniform(0.2, 1);
      random_.angle = random_.uniform(0.5, 6.2);
      random_.sort = sort;
      finish(drawn(type, random_));
    }
  }
  void add(std::type_identity<CsgShape>) {
    CsgShape csg;
    csg.operation = static_cast<CsgShape::Operation>(random_.below(3));
    for (int i = 0; i < 3; ++i) {
      Shape operand;
      operand.geometry = i == 0 ? Geometry(SphereShape{1})
                                : Geometry(BoxShape{glm::dvec3(-0.7), glm::dvec3(0.5 + 0.1 * i)});
      operand.world_from_object = random_.transform();
      operand.world_from_object[3] = glm::dvec4(0, 0, 0, 1);
      operand.material = static_cast<std::uint32_t>(i);
      csg.operands.push_back(std::make_shared<const Shape>(operand));
      scene_.objects.push_back({"", {operand}, {}});
    }
    if (random_.one_in(2)) csg.motions = {{}, keys(csg.operands[1]->world_from_object), {}};
    finish(csg);
    if (Shape& made = scene_.shapes.back(); made.materials.empty())
      made.material = csg.operands[0]->material;
  }

  /// A shape of the world or of the object, with all that a shape may have.
  void finish(Geometry geometry) {
    Shape shape;
    shape.geometry = std::move(geometry);
    if (!random_.one_in(3)) shape.world_from_object = random_.transform();
    const auto some = [&] {
      for (;;)
        if (const auto i = static_cast<std::uint32_t>(random_.below(scene_.materials.size()));
            !std::holds_alternative<InterfaceMaterial>(scene_.materials[i].model))
          return i;
    };
    shape.material = some();
    if (surface_count(shape) > 1 && random_.one_in(2)) {
      for (std::size_t i = 0; i < surface_count(shape); ++i) shape.materials.push_back(some());
      shape.material = shape.materials[0];
    }
    if (auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
        capsules && count_of(*capsules) > 1 && random_.one_in(2))
      for (std::size_t i = 0; i < count_of(*capsules); ++i) capsules->materials.push_back(some());
    if (auto* molecule = std::get_if<MolecularSurfaceShape>(&shape.geometry);
        molecule && random_.one_in(2))
      for (std::size_t i = 0; i < molecule->centers.size(); ++i)
        molecule->materials.push_back(some());
    if (random_.one_in(3)) shape.name = "a shape \\ named";
    shape.reverse_orientation = random_.one_in(3);
    if (is_closed(shape) && next_medium_ < scene_.media.size()) {
      shape.media.inside = next_medium_++;
    } else {
      shape.one_sided = random_.one_in(3);
      if (random_.one_in(3)) emit(shape);
    }
    if (random_.one_in(4)) {
      shape.alpha = TextureOperand(random_.uniform(0.1, 0.9));
      if (random_.one_in(2)) {
        shape.alpha = TextureOperand(1);
        shape.alpha->texture = 0;
      }
    }
    scene_.shapes.push_back(std::move(shape));
  }
  void emit(Shape& shape) {
    AreaEmission emission;
    if (random_.one_in(3))
      emission.image = files_.light("wide.exr");
    else
      emission.radiance = random_.spectrum(4);
    emission.scale = random_.uniform(0.5, 2);
    if (random_.one_in(2) && !std::holds_alternative<CsgShape>(shape.geometry))
      emission.power = random_.uniform(1, 5);
    emission.two_sided = random_.one_in(2);
    if (surface_count(shape) > 1) emission.surfaces = {1};
    shape.emission = emission;
  }

  void shapes() {
#define GEOMETRY(Type, name) add(std::type_identity<Type>());
    for (int i = 0; i < 2; ++i) {
#include "scene/geometries.def"
    }
    CapsulesShape many;
    for (int i = 0; i < 50; ++i) {
      many.p0.push_back(3.f * glm::vec3(random_.direction()));
      many.p1.push_back(many.p0.back() + glm::vec3(random_.direction()));
      many.radius0.push_back(static_cast<float>(random_.uniform(0.01, 0.1)));
      many.radius1.push_back(static_cast<float>(random_.uniform(0.01, 0.1)));
    }
    finish(many);
    many.times = {0.25, 1};
    finish(many);
    if (auto& emission = scene_.shapes.back().emission) emission->power.reset();
    TriangleMeshShape bending{{}, {{0, 1, 2}, {2, 1, 3}}, {}, {}};
    bending.times = {0.25, 0.5, 1};
    for (int i = 0; i < 12; ++i) {
      bending.positions.push_back(3.f * glm::vec3(random_.direction()));
      bending.normals.emplace_back(random_.direction());
    }
    for (int i = 0; i < 4; ++i)
      bending.uvs.emplace_back(random_.uniform(0, 1), random_.uniform(0, 1));
    finish(bending);
    if (auto& emission = scene_.shapes.back().emission) emission->power.reset();
    // A box of no light's business around a medium.
    const auto interface = std::ranges::find_if(scene_.materials, [](const Material& one) {
      return std::holds_alternative<InterfaceMaterial>(one.model);
    });
    Shape box;
    box.geometry = BoxShape{glm::dvec3(-9), glm::dvec3(9)};
    box.material = static_cast<std::uint32_t>(interface - scene_.materials.begin());
    box.media.inside = 0;
    scene_.shapes.push_back(box);
    // Objects: some shapes of the world go there.
    Object object{"thing", {}, {}};
    for (int i = 0; i < 4; ++i) {
      object.shapes.push_back(scene_.shapes[static_cast<std::size_t>(2 * i + 1)]);
      object.shapes.back().media = {};
    }
    scene_.objects.push_back(object);
    for (int i = 0; i < 3; ++i)
      scene_.instances.push_back(
          {static_cast<std::uint32_t>(scene_.objects.size() - 1), random_.transform(), {}});
  }

  /// A motion from `first` on, by a turn and a shift.
  TransformKeys keys(const glm::dmat4& first) {
    glm::dmat3 turn = random_.turn();
    if (glm::determinant(turn) < 0) turn = -turn;
    glm::dmat4 end = glm::dmat4(turn) * first;
    end[3] = first[3] + glm::dvec4(random_.direction(), 0);
    return {{0.5, first}, {2, end}};
  }

  /// Some instances move, and the camera.
  void motions() {
    if (random_.one_in(2)) scene_.view.camera.motion = keys(scene_.view.camera.world_from_camera);
    const bool about_camera = random_.one_in(2);
    for (Instance& instance : scene_.instances) {
      if (random_.one_in(3)) continue;
      instance.motion = keys(instance.world_from_object);
      if (about_camera) instance.pivot = rendering_origin(scene_.view.camera);
    }
  }

  void camera() {
    scene_.view.camera.world_from_camera = glm::dmat4(random_.turn());
    scene_.view.camera.world_from_camera[3] = glm::dvec4(20.0 * random_.direction(), 1);
    const std::size_t projection = random_.below(7);
    if (projection < 2)
      scene_.view.camera.projection = PerspectiveProjection{random_.uniform(0.3, 1.5)};
    if (projection == 2) scene_.view.camera.projection = OrthographicProjection{};
    if (projection == 3)
      scene_.view.camera.projection = SphericalProjection{static_cast<int>(random_.below(2))};
    if (projection == 4)
      scene_.view.camera.projection =
          FisheyeProjection{static_cast<int>(random_.below(2)), random_.uniform(20, 360)};
    if (projection == 5)
      scene_.view.camera.projection = RealisticProjection{
          nullptr, aperture_mask(aperture_names[random_.below(aperture_names.size())]),
          random_.uniform(1, 20), random_.uniform(2, 30)};
    if (projection == 6)
      scene_.view.camera.projection = OmnistereoProjection{random_.uniform(-1, 1)};
    scene_.view.camera.blades = random_.one_in(2) ? 0 : 3 + static_cast<int>(random_.below(9));
    scene_.view.camera.blade_rotation = random_.uniform(-90, 90);
    scene_.view.camera.frame_aspect_ratio = random_.uniform(0.5, 2);
    scene_.view.camera.screen_window = {-random_.uniform(0.5, 1), 0.9, -0.8,
                                        random_.uniform(0.5, 1)};
    if (random_.one_in(2))
      scene_.view.clip =
          ClipPlane{glm::normalize(glm::dvec3(random_.uniform(-1, 1), random_.uniform(-1, 1), 2)),
                    random_.uniform(-9, 9)};
    scene_.view.camera.lens_radius = random_.uniform(0.01, 0.1);
    scene_.view.camera.focal_distance = random_.uniform(1, 30);
    scene_.view.filter = {static_cast<PixelFilter::Kind>(random_.below(5)), random_.uniform(0.5, 2),
                          random_.uniform(0.5, 2)};
    if (scene_.view.filter.kind == PixelFilter::Kind::gaussian) scene_.view.filter.sigma = 0.4;
    if (scene_.view.filter.kind == PixelFilter::Kind::mitchell)
      scene_.view.filter.b = 0.2, scene_.view.filter.c = 0.4;
    if (scene_.view.filter.kind == PixelFilter::Kind::sinc) scene_.view.filter.tau = 2.5;
    scene_.view.film = {64,
                        48,
                        std::array<int, 4>{3, 50, 2, 40},
                        "a name.exr",
                        200,
                        0.7,
                        2.8,
                        0.25,
                        0.125,
                        static_cast<int>(random_.below(4)),
                        22.5,
                        12.5,
                        5200,
                        static_cast<ColorSpace>(random_.below(4))};
    SamplerSettings& sampler = scene_.view.sampler;
    sampler.kind = static_cast<SamplerSettings::Kind>(random_.below(4));
    sampler.samples_per_pixel = 1 + static_cast<int>(random_.below(1000));
    sampler.seed = static_cast<std::uint32_t>(0xfffffff0u + random_.below(9));
    if (sampler.kind == SamplerSettings::Kind::stratified) {
      sampler.x_strata = 1 + static_cast<int>(random_.below(9));
      sampler.y_strata = 1 + static_cast<int>(random_.below(9));
      sampler.samples_per_pixel = sampler.x_strata * sampler.y_strata;
      sampler.jitter = random_.one_in(2);
    }
    IntegratorSettings& integrator = scene_.view.integrator;
    integrator.kind = static_cast<IntegratorSettings::Kind>(random_.below(4));
    integrator.max_depth = static_cast<int>(random_.below(20));
    if (integrator.kind == IntegratorSettings::Kind::ambient_occlusion) {
      integrator.cosine_sample = random_.one_in(2);
      if (random_.one_in(2)) integrator.max_distance = random_.uniform(0.1, 10);
    }
    if (integrator.kind == IntegratorSettings::Kind::simple_path) {
      integrator.sample_bsdf = random_.one_in(2);
      integrator.sample_lights = random_.one_in(2);
    }
    scene_.automatic_camera = random_.one_in(2);
    scene_.has_no_up = random_.one_in(2);
    if (random_.one_in(2)) scene_.framing.toward_viewer = random_.direction();
    if (random_.one_in(2)) scene_.framing.up = random_.direction();
    if (random_.one_in(2)) scene_.unit = "\xc2\xb5m";
    if (random_.one_in(2)) {
      scene_.world_from_file = glm::dmat3(0);
      const std::size_t first = random_.below(3);
      for (std::size_t i = 0; i < 3; ++i)
        scene_.world_from_file[static_cast<int>(i)][static_cast<int>((first + i) % 3)] = 1;
    }
    if (random_.one_in(2)) {
      Legend legend{"a \"title\"", "\xc2\xb5m", -1.5, random_.uniform(0, 9), {}};
      for (std::size_t i = random_.below(4); i < 4; ++i)
        legend.colors.emplace_back(random_.uniform(0, 1), 0.25, random_.uniform(0, 1));
      if (random_.one_in(2)) legend.names.assign(legend.colors.size(), "a name");
      legend.of_directions = random_.one_in(3);
      scene_.legend = legend;
    }
    if (random_.one_in(2)) scene_.view.film.backdrop = Backdrop{};
    if (random_.one_in(2))
      scene_.view.film.backdrop =
          Backdrop{Backdrop::Kind::color, {0.25, 0.5, random_.uniform(0, 1)}, nullptr};
    scene_.view.film.exposure = {random_.uniform(-3, 3), random_.one_in(3)};
    if (random_.one_in(2)) scene_.view.film.least_width = random_.uniform(0, 3);
  }

  Random random_;
  Files files_;
  Scene scene_;
  std::uint32_t next_medium_ = 0;
};

}  // namespace

EnvironmentImage NamedImages::read_rgb(const fs::path& path) const {
  EnvironmentImage image;
  image.height = 4;
  image.width = path.stem() == "wide" ? 8 : 4;
  image.rgb.resize(static_cast<std::size_t>(3 * image.width * image.height));
  for (std::size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = pixel(path, i);
  image.equal_area = image.width == image.height;
  image.file = path.string();
  return image;
}

TextureImage NamedImages::read_texture(const fs::path& path, const ImageEncoding& encoding) const {
  TextureImage image;
  image.width = image.height = 4;
  image.channels = 3;
  for (std::size_t i = 0; i < image.values(); ++i)
    image.floats.push_back(static_cast<float>(decoded_value(encoding, pixel(path, i))));
  image.file = path.string();
  image.encoding = encoding;
  return image;
}

Scene random_scene(unsigned seed, const fs::path& folder) { return Maker(seed, folder).run(); }

}  // namespace caplet::test
