// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What programs that build scenes may get wrong, and no importer does: each mistake in a sound
// scene gives one error, at the place of what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "import_text.h"

namespace caplet::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Returns a scene that has one of each of what can be wrong. Each thing has a line of its own, as
/// if a file had stated it.
Scene sound_scene() {
  Scene scene;
  scene.source = "scene";
  int line = 0;
  const auto where = [&] { return SourceLocation{"scene", ++line, 1}; };
  const StubImages images;
  const auto light_image = [&](const char* name) {
    return std::make_shared<const EnvironmentImage>(images.read_rgb(name));
  };
  const auto one = std::make_shared<const std::vector<float>>(1, 1.0f);
  const auto three = std::make_shared<const std::vector<float>>(3, 1.0f);

  scene.textures = {{CheckerboardTexture{}, true, "grey", where()},
                    {ScaleTexture{}, false, "colour", where()},
                    {ImagemapTexture{.image = std::make_shared<const TextureImage>(
                                         images.read_texture("square", {}))},
                     false, "picture", where()},
                    {DirectionmixTexture{}, false, "turned", where()}};
  scene.materials = {{DiffuseMaterial{}, "plain", where(), {{"reflectance", 1}}},
                     {MixMaterial{.materials = {0, 2}}, "mixed", where()},
                     {DiffuseMaterial{}, "raised", where(), {}, 0}};
  scene.media = {{HomogeneousMedium{}, "haze", where()},
                 {UniformGridMedium{}, "cells", where()},
                 {RgbGridMedium{}, "colours", where()},
                 {CloudMedium{}, "puffs", where()}};
  std::get<UniformGridMedium>(scene.media[1].model).density = one;
  std::get<RgbGridMedium>(scene.media[2].model).sigma_s.rgb = three;
  const auto add_light = [&](const auto& model) {
    scene.lights.emplace_back().model = model;
    scene.lights.back().where = where();
  };
  add_light(PointLight{});
  add_light(DistantLight{});
  add_light(ProjectionLight{.image = light_image("wide")});
  add_light(GoniometricLight{.image = light_image("square")});
  add_light(InfiniteLight{});
  for (Shape& shape : std::vector<Shape>(3)) {
    shape.where = where();
    shape.geometry = SphereShape{};
    scene.shapes.push_back(shape);
  }
  scene.shapes.at(1).alpha = 0.5;
  scene.objects = {{"o", {scene.shapes.back()}, where()}};
  scene.shapes.pop_back();
  scene.instances = {{0, glm::dmat4(1), where()}};
  return scene;
}

template <class Model, class Family>
Model& as(std::vector<Family>& family, std::size_t index) {
  return std::get<Model>(family.at(index).model);
}

template <class T>
std::shared_ptr<T> changed(const std::shared_ptr<const T>& of, std::function<void(T&)> change) {
  auto copy = std::make_shared<T>(*of);
  change(*copy);
  return copy;
}

struct Mistake {
  std::string error;
  std::function<void(Scene&)> make;
};

std::vector<Mistake> of_textures_and_materials() {
  return {
      {"3:1: the texture's image has the wrong size",
       [](Scene& s) { as<ImagemapTexture>(s.textures, 2).image = nullptr; }},
      {"3:1: the texture's image has the wrong size",
       [](Scene& s) {
         auto& image = as<ImagemapTexture>(s.textures, 2).image;
         image = changed<TextureImage>(image, [](TextureImage& of) { of.height = 0; });
       }},
      {"3:1: the texture's image has the wrong size",
       [](Scene& s) {
         auto& image = as<ImagemapTexture>(s.textures, 2).image;
         image = changed<TextureImage>(image, [](TextureImage& of) { of.floats.pop_back(); });
       }},
      {"3:1: the texture's image has the wrong size",
       [](Scene& s) {
         auto& image = as<ImagemapTexture>(s.textures, 2).image;
         image = changed<TextureImage>(image, [](TextureImage& of) {
           of.channels = 2;
           of.floats.resize(of.values());
         });
       }},
      {"3:1: wrap is none that there is",
       [](Scene& s) { as<ImagemapTexture>(s.textures, 2).wrap = 99; }},
      {"3:1: wrap is none that there is",
       [](Scene& s) { as<ImagemapTexture>(s.textures, 2).wrap = -1; }},
      {"4:1: dir is no direction of unit length",
       [](Scene& s) {
         as<DirectionmixTexture>(s.textures, 3).dir = {0, 0, 1.1};
       }},
      {"4:1: dir is no direction of unit length",
       [](Scene& s) {
         as<DirectionmixTexture>(s.textures, 3).dir = {0, 0, nan};
       }},
      {"2:1: tex is no texture of spectra before",
       [](Scene& s) { as<ScaleTexture>(s.textures, 1).tex.texture = 0; }},
      {"2:1: tex is no texture of spectra before",
       [](Scene& s) { as<ScaleTexture>(s.textures, 1).tex.texture = 1; }},
      {"2:1: scale is not a finite number",
       [](Scene& s) { as<ScaleTexture>(s.textures, 1).scale = infinity; }},
      {"2:1: tex is not a spectrum of finite values from 0 up",
       [](Scene& s) {
         as<ScaleTexture>(s.textures, 1).tex.value = RgbSpectrum{{0, -1, 0}};
       }},
      {"5:1: the reflectance is not a texture of spectra",
       [](Scene& s) { s.materials.at(0).textures.at(0).texture = 0; }},
      {"5:1: the reflectance is not a texture of spectra",
       [](Scene& s) { s.materials.at(0).textures.at(0).texture = 99; }},
      {"5:1: the material has no colour that may be a texture, or has it twice",
       [](Scene& s) { s.materials.at(0).textures.at(0).field = "colour"; }},
      {"5:1: the material has no reflectance that may be a texture, or has it twice",
       [](Scene& s) { s.materials.at(0).textures.push_back(s.materials.at(0).textures.at(0)); }},
      {"5:1: the reflectance is not a spectrum of finite values from 0 up",
       [](Scene& s) { as<DiffuseMaterial>(s.materials, 0).reflectance = ConstantSpectrum{-1}; }},
      {"6:1: a mix has a material that does not exist",
       [](Scene& s) { as<MixMaterial>(s.materials, 1).materials[1] = 99; }},
      {"6:1: a mix is a part of itself",
       [](Scene& s) { as<MixMaterial>(s.materials, 1).materials[1] = 1; }},
      {"7:1: the displacement is not a texture of floats",
       [](Scene& s) { s.materials.at(2).displacement = 1; }},
      {"7:1: the normalmap is no image",
       [](Scene& s) {
         s.materials.at(2).displacement.reset();
         s.materials.at(2).normalmap = 0;
       }},
  };
}

std::vector<Mistake> of_media() {
  const auto haze = [](Scene& s) -> HomogeneousMedium& {
    return as<HomogeneousMedium>(s.media, 0);
  };
  const auto cells = [](Scene& s) -> UniformGridMedium& {
    return as<UniformGridMedium>(s.media, 1);
  };
  const auto colours = [](Scene& s) -> RgbGridMedium& { return as<RgbGridMedium>(s.media, 2); };
  const auto puffs = [](Scene& s) -> CloudMedium& { return as<CloudMedium>(s.media, 3); };
  const auto values = [](std::vector<float> of) {
    return std::make_shared<const std::vector<float>>(std::move(of));
  };
  const std::string no_spectrum = " is not a spectrum of finite values from 0 up";
  return {
      {"8:1: sigma_a" + no_spectrum,
       [=](Scene& s) { haze(s).scattering.sigma_a = ConstantSpectrum{nan}; }},
      {"8:1: sigma_s" + no_spectrum,
       [=](Scene& s) {
         haze(s).scattering.sigma_s = SampledSpectrum{{500, 400}, {1, 1}};
       }},
      {"8:1: Le" + no_spectrum, [=](Scene& s) { haze(s).radiance = BlackbodySpectrum{0}; }},
      {"8:1: scale must be finite and from 0 up", [=](Scene& s) { haze(s).scattering.scale = -1; }},
      {"8:1: g must lie between -0.999999 and 0.999999",
       [=](Scene& s) { haze(s).scattering.g = 1; }},
      {"8:1: Lescale must be finite and from 0 up",
       [=](Scene& s) { haze(s).radiance_scale = infinity; }},
      {"9:1: the medium's box from p0 to p1 has no inside",
       [=](Scene& s) { cells(s).bounds.p1.y = cells(s).bounds.p0.y; }},
      {"9:1: the medium's box from p0 to p1 has no inside",
       [=](Scene& s) { cells(s).bounds.p1.y = 2e18; }},
      {"9:1: a grid must have at least one cell along each side",
       [=](Scene& s) { cells(s).counts[2] = 0; }},
      {"9:1: density has 1 values, but a grid of 1 x 2 x 1 cells takes 2",
       [=](Scene& s) { cells(s).counts[1] = 2; }},
      {"9:1: density has 0 values, but a grid of 1 x 1 x 1 cells takes 1",
       [=](Scene& s) { cells(s).density = nullptr; }},
      {"9:1: density has values that are negative or not finite",
       [=](Scene& s) { cells(s).density = values({-1}); }},
      {"9:1: density has values that are negative or not finite",
       [=](Scene& s) { cells(s).density = values({std::numeric_limits<float>::infinity()}); }},
      {"9:1: a medium cannot have both an \"Le\" and a \"temperature\"",
       [=](Scene& s) {
         cells(s).radiance = ConstantSpectrum{1};
         cells(s).temperature = values({1});
       }},
      {"10:1: the grid needs a \"sigma_a\" or a \"sigma_s\"",
       [=](Scene& s) { colours(s).sigma_s.rgb = nullptr; }},
      {"10:1: an \"Le\" needs a \"sigma_a\"",
       [=](Scene& s) {
         colours(s).radiance.rgb = values({1, 1, 1});
       }},
      {"10:1: sigma_s has 2 values, but a grid of 1 x 1 x 1 cells takes 3",
       [=](Scene& s) {
         colours(s).sigma_s.rgb = values({1, 1});
       }},
      {"11:1: the transform is not finite",
       [=](Scene& s) { puffs(s).bounds.world_from_medium[0][0] = nan; }},
      {"11:1: the transform is singular (it flattens the shape)",
       [=](Scene& s) { puffs(s).bounds.world_from_medium[0][0] = 0; }},
  };
}

std::vector<Mistake> of_lights() {
  const auto sky = [](Scene& s) -> InfiniteLight& { return as<InfiniteLight>(s.lights, 4); };
  const auto resized = [](std::shared_ptr<const EnvironmentImage>& image, int width) {
    image = changed<EnvironmentImage>(image, [=](EnvironmentImage& of) { of.width = width; });
  };
  const LightPortal square = {glm::dvec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const auto with_corner = [=](std::size_t i, glm::dvec3 p) {
    LightPortal portal = square;
    portal.at(i) = p;
    return portal;
  };
  return {
      {"12:1: the light's scale must be finite and from 0 up",
       [](Scene& s) { s.lights.at(0).scale = -1; }},
      {"12:1: the light's scale must be finite and from 0 up",
       [](Scene& s) { s.lights.at(0).scale = infinity; }},
      {"12:1: I is not a spectrum of finite values from 0 up",
       [](Scene& s) { as<PointLight>(s.lights, 0).intensity = ConstantSpectrum{-1}; }},
      {"12:1: the light's position is not finite",
       [](Scene& s) { as<PointLight>(s.lights, 0).position.z = nan; }},
      {"13:1: the light's direction is not finite",
       [](Scene& s) { as<DistantLight>(s.lights, 1).direction.x = infinity; }},
      {"14:1: the light's position is not finite",
       [](Scene& s) { as<ProjectionLight>(s.lights, 2).position.x = nan; }},
      {"14:1: the light's rotation is not finite",
       [](Scene& s) { as<ProjectionLight>(s.lights, 2).world_from_light[2][1] = nan; }},
      {"14:1: the light has no image",
       [](Scene& s) { as<ProjectionLight>(s.lights, 2).image = nullptr; }},
      {"14:1: the light's image has the wrong size",
       [=](Scene& s) { resized(as<ProjectionLight>(s.lights, 2).image, 5); }},
      {"14:1: the light's image has the wrong size",
       [=](Scene& s) { resized(as<ProjectionLight>(s.lights, 2).image, 0); }},
      {"14:1: the light's image has pixels that are not finite",
       [](Scene& s) {
         auto& image = as<ProjectionLight>(s.lights, 2).image;
         image = changed<EnvironmentImage>(
             image, [](EnvironmentImage& of) { of.rgb.back() = static_cast<float>(nan); });
       }},
      {"15:1: the light's image is not square",
       [](Scene& s) {
         as<GoniometricLight>(s.lights, 3).image = as<ProjectionLight>(s.lights, 2).image;
       }},
      {"15:1: the light has no profile", [](Scene& s) { s.lights.at(3).model = IesLight{}; }},
      {"15:1: the light's profile is no table of intensities by ascending angles",
       [](Scene& s) {
         s.lights.at(3).model = IesLight{
             .profile = std::make_shared<IesProfile>(IesProfile{{0, 2, 1}, {0}, {1, 1, 1}})};
       }},
      {"15:1: the light's profile is no table of intensities by ascending angles",
       [](Scene& s) {
         s.lights.at(3).model =
             IesLight{.profile = std::make_shared<IesProfile>(IesProfile{{0, 1, 2}, {0}, {1, 1}})};
       }},
      {"16:1: the portal has a corner that is not within 1e18",
       [=](Scene& s) {
         sky(s).portal = with_corner(2, {1, 2e18, 0});
       }},
      {"16:1: the portal has two corners in one place",
       [=](Scene& s) {
         sky(s).portal = with_corner(1, {0, 0, 0});
       }},
      {"16:1: the portal's corners are not those of a rectangle, in order",
       [=](Scene& s) {
         sky(s).portal = with_corner(2, {1.1, 1, 0});
       }},
      {"16:1: L is not a spectrum of finite values from 0 up",
       [=](Scene& s) { sky(s).radiance = ConstantSpectrum{infinity}; }},
  };
}

std::vector<Mistake> of_shapes() {
  const auto emits = [](Scene& s) -> AreaEmission& { return s.shapes.at(0).emission.emplace(); };
  return {
      {"17:1: the transform is singular (it flattens the shape)",
       [](Scene& s) { s.shapes.at(0).world_from_object[1][1] = 0; }},
      {"17:1: the transform is not finite",
       [](Scene& s) { s.shapes.at(0).world_from_object[3][1] = nan; }},
      {"17:1: the inverse of the transform has entries beyond 1e18, where 32-bit floats end",
       [](Scene& s) {
         s.shapes.at(0).world_from_object = glm::scale(glm::dmat4(1), glm::dvec3(1e-19));
       }},
      {"17:1: the shape has a material that does not exist",
       [](Scene& s) { s.shapes.at(0).material = 99; }},
      {"17:1: the emission's scale must be from 0 up", [=](Scene& s) { emits(s).scale = -1; }},
      {"17:1: the emission's scale must be from 0 up",
       [=](Scene& s) { emits(s).scale = infinity; }},
      {"17:1: the emission is not a spectrum of finite values from 0 up",
       [=](Scene& s) { emits(s).radiance = ConstantSpectrum{-1}; }},
      {"17:1: the light is on surface 1, but the surfaces are numbered from 0 to 0",
       [=](Scene& s) { emits(s).surfaces = {1}; }},
      {"17:1: the inside of the shape has a medium that does not exist",
       [](Scene& s) { s.shapes.at(0).media.inside = 4; }},
      {"17:1: the outside of the shape has a medium that does not exist",
       [](Scene& s) { s.shapes.at(0).media.outside = 4; }},
      {"18:1: the alpha is not a finite number",
       [](Scene& s) { s.shapes.at(1).alpha->value = ConstantSpectrum{nan}; }},
      {"18:1: the alpha is not a texture of floats",
       [](Scene& s) { s.shapes.at(1).alpha->texture = 1; }},
      {"21:1: an instance of an object that does not exist",
       [](Scene& s) { s.instances.at(0).object = 1; }},
      {"21:1: the shape reaches further than 1e18 from the origin, where 32-bit floats end",
       [](Scene& s) {
         glm::dmat4& m = s.instances.at(0).world_from_object;
         m = glm::scale(glm::dmat4(1), glm::dvec3(1e18));
         m[3][0] = 9e17;
       }},
  };
}

std::vector<Mistake> of_settings() {
  return {
      {"the camera has a medium that does not exist", [](Scene& s) { s.view.camera.medium = 4; }},
      {"the camera's field of view must lie between 0 and 180 degrees",
       [](Scene& s) { s.view.camera.projection = PerspectiveProjection{0}; }},
      {"the camera's field of view must lie between 0 and 180 degrees",
       [](Scene& s) { s.view.camera.projection = PerspectiveProjection{3.15}; }},
      {"the camera's lens radius must be from 0 up",
       [](Scene& s) { s.view.camera.lens_radius = -1; }},
      {"the camera's lens radius must be at most 1e18, and 1e18 times its focal distance, where "
       "32-bit floats end",
       [](Scene& s) { s.view.camera.lens_radius = 2e18; }},
      {"the normal of the clipping plane must be a unit vector",
       [](Scene& scene) {
         scene.view.clip = ClipPlane{{0, 0, 2}, 0};
       }},
      {"the normal of the clipping plane must be a unit vector",
       [](Scene& scene) {
         scene.view.clip = ClipPlane{glm::dvec3(NAN), 0};
       }},
      {"the clipping plane must be within 1e18 of the origin",
       [](Scene& scene) {
         scene.view.clip = ClipPlane{{0, 1, 0}, -2e18};
       }},
      {"the clipping plane must be within 1e18 of the origin",
       [](Scene& scene) {
         scene.view.clip = ClipPlane{{0, 1, 0}, NAN};
       }},
      {"the camera's focal distance must be positive",
       [](Scene& s) { s.view.camera.focal_distance = 0; }},
      {"the image size must be positive", [](Scene& s) { s.view.film.width = 0; }},
      {"the image size must be positive", [](Scene& s) { s.view.film.height = -1; }},
      {"the image of 16385 x 16384 pixels is larger than 2^28 pixels",
       [](Scene& s) {
         s.view.film.width = 16385;
         s.view.film.height = 16384;
       }},
      {"the samples per pixel must be positive",
       [](Scene& s) { s.view.sampler.samples_per_pixel = 0; }},
      {"the depth must not be negative", [](Scene& s) { s.view.integrator.max_depth = -1; }},
      {"the integrator's greatest distance must be positive",
       [](Scene& s) { s.view.integrator.max_distance = 0; }},
      {"the pixel filter's radius must be positive", [](Scene& s) { s.view.filter.radius_y = 0; }},
  };
}

TEST(Validate, ASoundSceneHasNoErrors) {
  EXPECT_THAT(complaints_when(sound_scene), testing::IsEmpty());
}

TEST(Validate, EachMistakeHasItsError) {
  for (const auto& family :
       {of_textures_and_materials(), of_media(), of_lights(), of_shapes(), of_settings()})
    for (const Mistake& mistake : family) {
      SCOPED_TRACE(mistake.error);
      const std::string file = mistake.error[0] <= '9' ? "scene:" : "scene: ";
      EXPECT_THAT(complaints_when([&] {
                    Scene scene = sound_scene();
                    mistake.make(scene);
                    return scene;
                  }),
                  testing::ElementsAre(file + mistake.error));
    }
}

}  // namespace
}  // namespace caplet::test
