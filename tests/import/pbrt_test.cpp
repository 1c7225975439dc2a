// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Scene text that is right: every directive, parameter type and form, and what they come to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>

#include "import_text.h"

namespace caplet::test::pbrt_test {
namespace {

namespace fs = std::filesystem;

// Coordinates here are of order 10 and go through a dozen double operations: 1e-12 is a thousand
// times the rounding.
constexpr double rounding = 1e-12;

void expect_near(const glm::dvec3& a, const glm::dvec3& b) {
  EXPECT_LE(glm::length(a - b), rounding)
      << a.x << " " << a.y << " " << a.z << " for " << b.x << " " << b.y << " " << b.z;
}
glm::dvec3 image_of(const glm::dmat4& m, const glm::dvec3& p) {
  return glm::dvec3(m * glm::dvec4(p, 1));
}
glm::dvec3 direction_of(const glm::dmat4& m, const glm::dvec3& v) {
  return glm::dvec3(m * glm::dvec4(v, 0));
}
const Material& material_of(const Scene& scene, const Shape& shape) {
  return scene.materials.at(shape.material);
}
template <class T>
const T& model_of(const Scene& scene, std::size_t shape = 0) {
  return std::get<T>(material_of(scene, scene.shapes.at(shape)).model);
}

TEST(Camera, LookAtSeesItsTargetAhead) {
  const Scene scene = scene_of(
      "LookAt 1 2 3  1 2 10  0 1 0\nCamera \"perspective\" \"float fov\" 90\nWorldBegin\nShape "
      "\"sphere\"");
  const glm::dmat4& m = scene.view.camera.world_from_camera;
  expect_near(image_of(m, {0, 0, 0}), {1, 2, 3});
  expect_near(direction_of(m, {0, 0, 1}), {0, 0, 1});
  expect_near(direction_of(m, {0, 1, 0}), {0, 1, 0});
  expect_near(direction_of(m, {1, 0, 0}), {1, 0, 0});
  EXPECT_DOUBLE_EQ(fov_of(scene.view.camera), std::acos(-1.0) / 2);
}

TEST(Camera, MirroredLookAt) {
  // Along -x with z up, pbrt's right is up x forward = -y; the leading scale mirrors it to +y.
  const std::string rest =
      "LookAt 5 0 0  0 0 0  0 0 1\nCamera \"perspective\"\nWorldBegin\nShape \"sphere\"";
  expect_near(direction_of(scene_of(rest).view.camera.world_from_camera, {1, 0, 0}), {0, -1, 0});
  expect_near(
      direction_of(scene_of("Scale -1 1 1\n" + rest).view.camera.world_from_camera, {1, 0, 0}),
      {0, 1, 0});
}

TEST(Camera, TransformIsColumnMajorAndMapsWorldToCamera) {
  const Scene scene = scene_of(
      "Transform [ 1 0 0 0  0 1 0 0  0 0 -1 0  0 -1 6.8 1 ]\nCamera "
      "\"perspective\"\nWorldBegin\nShape \"sphere\"");
  expect_near(image_of(scene.view.camera.world_from_camera, {0, 0, 0}), {0, 1, 6.8});
  expect_near(direction_of(scene.view.camera.world_from_camera, {0, 0, 1}), {0, 0, -1});
}

TEST(Camera, AllParameters) {
  const Scene scene = scene_of(
      "Camera \"perspective\" \"float frameaspectratio\" [1.5] \"float screenwindow\" [-1 1 -.5 "
      ".5] \"float lensradius\" .1\n"
      " \"float focaldistance\" [7] \"float shutteropen\" .125 \"float shutterclose\" .375\n"
      "Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" [32] \"string filename\" "
      "\"a.exr\" \"float diagonal\" 35\n"
      " \"bool savefp16\" true \"float iso\" 200 \"string sensor\" \"cie1931\" \"float "
      "maxcomponentvalue\" 9\n"
      " \"float cropwindow\" [0 .5 .25 1]\nWorldBegin\nShape \"sphere\"");
  EXPECT_EQ(scene.view.camera.frame_aspect_ratio, 1.5);
  EXPECT_EQ(scene.view.camera.screen_window, (std::array<double, 4>{-1, 1, -.5, .5}));
  EXPECT_EQ(scene.view.camera.lens_radius, .1);
  EXPECT_EQ(scene.view.camera.focal_distance, 7);
  EXPECT_EQ(scene.view.film.exposure_time, .25);
  EXPECT_EQ(scene.view.film.iso, 200);
  EXPECT_EQ(scene.view.film.filename, "a.exr");
  EXPECT_EQ(scene.view.film.max_component_value, 9);
  EXPECT_EQ(scene.view.film.crop, (std::array<int, 4>{0, 32, 8, 32}));
}

TEST(Options, FiltersSamplersIntegratorsSeeds) {
  const auto filter = [](const std::string& text) {
    return scene_of("PixelFilter " + text + "\nWorldBegin\nShape \"sphere\"").view.filter;
  };
  EXPECT_EQ(filter("\"box\"").radius_x, 0.5);
  EXPECT_EQ(filter("\"triangle\"").radius_y, 2);
  EXPECT_EQ(filter("\"gaussian\"").radius_x, 1.5);
  EXPECT_EQ(filter("\"gaussian\" \"float sigma\" .3").sigma, .3);
  EXPECT_EQ(filter("\"mitchell\"").radius_x, 2);
  EXPECT_EQ(filter("\"mitchell\" \"float B\" .5 \"float xradius\" 3").b, .5);
  for (const char* name : {"halton", "independent", "paddedsobol", "sobol", "zsobol", "pmj02bn"}) {
    const Scene scene = scene_of("Option \"seed\" 3\nSampler \"" + std::string(name) +
                                 "\" \"integer pixelsamples\" 5\nWorldBegin\nShape \"sphere\"");
    EXPECT_EQ(scene.view.sampler.samples_per_pixel, 5) << name;
    EXPECT_EQ(scene.view.sampler.seed, 3u);
  }
  EXPECT_EQ(scene_of("Sampler \"stratified\" \"integer xsamples\" 3 \"integer ysamples\" 7 "
                     "\"integer seed\" 9\nOption \"integer seed\" [4]\n"
                     "WorldBegin\nShape \"sphere\"")
                .view.sampler.samples_per_pixel,
            21);
  EXPECT_EQ(
      scene_of(
          "Sampler \"sobol\" \"integer seed\" 9\nOption \"seed\" 4\nWorldBegin\nShape \"sphere\"")
          .view.sampler.seed,
      9u);
  for (const char* name : {"path", "volpath", "simplepath", "simplevolpath", "bdpt", "mlt"})
    EXPECT_EQ(scene_of("Integrator \"" + std::string(name) +
                       "\" \"integer maxdepth\" 8\nWorldBegin\nShape \"sphere\"")
                  .view.integrator.max_depth,
              8);
  EXPECT_EQ(scene_of("Accelerator \"kdtree\" \"integer maxprims\" 2\nTransformTimes 0 "
                     "1\nActiveTransform All\nOption "
                     "\"disablewavelengthjitter\" false\n"
                     "Option \"rendercoordsys\" \"world\"\nMediumInterface \"\" "
                     "\"\"\nWorldBegin\nShape \"sphere\"")
                .view.integrator.max_depth,
            5);
}

TEST(Transforms, ComposeInWrittenOrder) {
  const Scene scene = world_of(
      "AttributeBegin Translate 1 2 3 Scale 2 2 2 Rotate 90 0 0 1 Shape \"sphere\" AttributeEnd\n"
      "TransformBegin ConcatTransform [0 1 0 0 -1 0 0 0 0 0 1 0 5 0 0 1] CoordinateSystem "
      "\"turned\" Shape \"sphere\" "
      "TransformEnd\n"
      "CoordSysTransform \"turned\" Translate 1 0 0 Shape \"sphere\" Identity Shape \"sphere\"");
  expect_near(image_of(scene.shapes[0].world_from_object, {1, 0, 0}), {1, 4, 3});
  expect_near(image_of(scene.shapes[1].world_from_object, {1, 0, 0}), {5, 1, 0});
  expect_near(image_of(scene.shapes[2].world_from_object, {0, 0, 0}), {5, 1, 0});
  expect_near(image_of(scene.shapes[3].world_from_object, {1, 2, 3}), {1, 2, 3});
}

TEST(Transforms, CameraSpace) {
  const Scene scene = scene_of(
      "LookAt 4 0 0  0 0 0  0 0 1\nCamera \"perspective\"\nWorldBegin\n"
      "CoordSysTransform \"camera\" Translate 0 0 1 Shape \"sphere\" CoordSysTransform \"world\" "
      "Shape \"sphere\"");
  expect_near(image_of(scene.shapes[0].world_from_object, {0, 0, 0}), {3, 0, 0});
  expect_near(image_of(scene.shapes[1].world_from_object, {0, 0, 0}), {0, 0, 0});
}

TEST(Objects, InstanceComposesUseWithDefinition) {
  const Scene scene = world_of(
      "Translate 0 0 1\nObjectBegin \"ball\"\n  Scale 2 2 2 AreaLightSource \"diffuse\" Shape "
      "\"sphere\" \"string name\" "
      "\"lamp\"\nObjectEnd\n"
      "Translate 10 0 0\nObjectInstance \"ball\"\nObjectInstance \"later\"\nObjectBegin \"later\" "
      "Shape \"disk\" ObjectEnd");
  ASSERT_EQ(scene.objects.size(), 2u);
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.shapes.size(), 0u);
  EXPECT_EQ(scene.objects[0].shapes[0].name, "lamp");
  EXPECT_TRUE(scene.objects[0].shapes[0].emission.has_value());
  // (10, 0, 1) of the use after (0, 0, 1) and the scale by 2 of the definition.
  const Bounds bounds = bounds_of(scene);
  expect_near(bounds.min, {8, -2, 0});
  // The disk was defined at (10, 0, 1) and is used there again.
  expect_near(bounds.max, {21, 2, 4});
  EXPECT_EQ(count_primitives(scene),
            (std::map<std::string, std::uint64_t>{{"sphere", 1}, {"disk", 1}}));
}

TEST(Parameters, SpectraInAllForms) {
  const auto reflectance = [](const std::string& before, const std::string& parameter) {
    const Scene scene =
        world_of(before + "\nMaterial \"diffuse\" " + parameter + "\nShape \"sphere\"");
    return model_of<DiffuseMaterial>(scene).reflectance;
  };
  EXPECT_EQ(std::get<ConstantSpectrum>(reflectance("", "")).value, 0.5);
  EXPECT_EQ(std::get<RgbSpectrum>(reflectance("", "\"rgb reflectance\" [.1 .2 .3]")).rgb,
            glm::dvec3(.1, .2, .3));
  const std::pair<const char*, ColorSpace> spaces[] = {{"srgb", ColorSpace::srgb},
                                                       {"dci-p3", ColorSpace::dci_p3},
                                                       {"rec2020", ColorSpace::rec2020},
                                                       {"aces2065-1", ColorSpace::aces2065_1}};
  for (const auto& [name, space] : spaces)
    EXPECT_EQ(std::get<RgbSpectrum>(reflectance("ColorSpace \"" + std::string(name) + "\"",
                                                "\"rgb reflectance\" [1 0 0]"))
                  .space,
              space);
  EXPECT_EQ(std::get<BlackbodySpectrum>(reflectance("", "\"blackbody reflectance\" 3000")).kelvin,
            3000);
  const auto inline_pairs =
      std::get<SampledSpectrum>(reflectance("", "\"spectrum reflectance\" [400 .1 500 .2 600 .3]"));
  EXPECT_THAT(inline_pairs.wavelengths, testing::ElementsAre(400, 500, 600));
  EXPECT_THAT(inline_pairs.values, testing::ElementsAre(.1, .2, .3));
  const fs::path file = temporary_folder() / "grey.spd";
  write_file(file, "# grey\n400 0.25\n700 +.25 # end\n");
  EXPECT_THAT(std::get<SampledSpectrum>(
                  reflectance("", "\"spectrum reflectance\" \"" + file.string() + "\""))
                  .values,
              testing::ElementsAre(.25, .25));
}

TEST(Parameters, OldAndNewFormsAreTheSame) {
  for (const char* form : {"\"bool twosided\" true", "\"bool twosided\" [true]",
                           "\"bool twosided\" \"true\"", "\"bool twosided\" [\"true\"]",
                           "\"bool   twosided \" [ true ] # a comment", "\"bool\ttwosided\" true"})
    EXPECT_TRUE(world_of("AreaLightSource \"diffuse\" " + std::string(form) + "\nShape \"sphere\"")
                    .shapes[0]
                    .emission->two_sided)
        << form;
  for (const char* form :
       {"\"point3 p0\" [1 2 3]", "\"point p0\" [1 2 3]", "\"point p0\" [+1 2. 3e0]"}) {
    const Scene scene =
        world_of("Shape \"capsule\" \"point3 p1\" [0 0 0] \"float radius\" 1 " + std::string(form));
    EXPECT_EQ(std::get<CapsulesShape>(scene.shapes[0].geometry).p0[0], glm::vec3(1, 2, 3)) << form;
  }
  EXPECT_EQ(world_of("Shape \"sphere\" \"string name\" [\"a \\\"b\\\\\"]").shapes[0].name,
            "a \"b\\");
}

TEST(Parameters, AttributesGiveDefaults) {
  const Scene scene = world_of(
      "AttributeBegin Attribute \"shape\" \"float radius\" 3 Shape \"sphere\" Shape \"sphere\" "
      "\"float radius\" 2 AttributeEnd\n"
      "Shape \"sphere\" Attribute \"material\" \"float roughness\" .25 Attribute \"light\" \"float "
      "scale\" 5\n"
      "Material \"dielectric\" Shape \"sphere\" LightSource \"point\" LightSource \"point\" "
      "\"float scale\" 2");
  const auto radius = [&](std::size_t i) {
    return std::get<SphereShape>(scene.shapes[i].geometry).radius;
  };
  EXPECT_EQ(radius(0), 3);
  EXPECT_EQ(radius(1), 2);
  EXPECT_EQ(radius(2), 1);
  EXPECT_EQ(model_of<DielectricMaterial>(scene, 3).alpha_u, 0.5);
  EXPECT_EQ(scene.lights[0].scale, 5);
  EXPECT_EQ(scene.lights[1].scale, 2);
}

TEST(Materials, ConductorsAndDielectrics) {
  const Scene scene = world_of(
      "Material \"conductor\" \"rgb eta\" [.2 .9 1.1] \"rgb k\" [3.9 2.4 2.1] \"float uroughness\" "
      ".04 \"float vroughness\" .09\n"
      "Shape \"sphere\"\nMaterial \"conductor\" \"rgb reflectance\" [.5 0 1] \"float roughness\" "
      ".3 \"bool remaproughness\" "
      "false\n"
      "Shape \"sphere\"\nMaterial \"dielectric\" \"float eta\" 1.33 Shape \"sphere\"\nMaterial "
      "\"dielectric\" Shape \"sphere\"\n"
      "Material \"dielectric\" \"spectrum eta\" \"glass-BK7\" Shape \"sphere\" Material "
      "\"conductor\" \"spectrum eta\" [300 2 "
      "900 2] Shape \"sphere\"");
  EXPECT_EQ(model_of<ConductorMaterial>(scene).alpha_u, 0.2);
  EXPECT_EQ(model_of<ConductorMaterial>(scene).alpha_v, 0.3);
  const auto& metal = model_of<ConductorMaterial>(scene, 1);
  EXPECT_EQ(metal.alpha_v, 0.3);
  // As the file says it: the k that reflects it comes from its spectrum (tests/render: Metals).
  ASSERT_TRUE(metal.reflectance.has_value());
  EXPECT_EQ(std::get<RgbSpectrum>(*metal.reflectance).rgb, glm::dvec3(.5, 0, 1));
  EXPECT_FALSE(model_of<ConductorMaterial>(scene).reflectance.has_value());
  EXPECT_EQ(std::get<ConstantSpectrum>(model_of<DielectricMaterial>(scene, 2).eta).value, 1.33);
  EXPECT_EQ(std::get<ConstantSpectrum>(model_of<DielectricMaterial>(scene, 3).eta).value, 1.5);
  EXPECT_FALSE(
      std::holds_alternative<ConstantSpectrum>(model_of<DielectricMaterial>(scene, 4).eta));
  EXPECT_EQ(std::get<SampledSpectrum>(model_of<ConductorMaterial>(scene, 5).eta).values.size(), 2u);
}

TEST(Materials, NamesMayComeLaterAndShapesMayNameTheirs) {
  const Scene scene = world_of(
      "NamedMaterial \"red\" Shape \"sphere\" Shape \"disk\" \"string materials\" \"blue\"\n"
      "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [1 0 0]\n"
      "MakeNamedMaterial \"blue\" \"string type\" [\"diffuse\"] \"rgb reflectance\" [0 0 1]");
  EXPECT_EQ(material_of(scene, scene.shapes[0]).name, "red");
  EXPECT_EQ(material_of(scene, scene.shapes[1]).name, "blue");
}

TEST(Textures, ConstantsScalesAndMixes) {
  const Scene scene = world_of(
      "Texture \"half\" \"float\" \"constant\" \"float value\" .5\nTexture \"red\" \"spectrum\" "
      "\"constant\" \"rgb value\" [1 .5 "
      "0]\n"
      "Texture \"dark\" \"spectrum\" \"scale\" \"texture tex\" \"red\" \"texture scale\" \"half\"\n"
      "Texture \"blend\" \"spectrum\" \"mix\" \"texture tex1\" \"red\" \"rgb tex2\" [0 0 1] "
      "\"float amount\" .25\n"
      "Material \"diffuse\" \"texture reflectance\" \"dark\" Shape \"sphere\" Material \"diffuse\" "
      "\"texture reflectance\" "
      "\"blend\" Shape \"sphere\"\n"
      "Material \"dielectric\" \"texture roughness\" \"half\" \"bool remaproughness\" false Shape "
      "\"sphere\"");
  EXPECT_EQ(std::get<RgbSpectrum>(model_of<DiffuseMaterial>(scene, 0).reflectance).rgb,
            glm::dvec3(.5, .25, 0));
  EXPECT_EQ(std::get<RgbSpectrum>(model_of<DiffuseMaterial>(scene, 1).reflectance).rgb,
            glm::dvec3(.75, .375, .25));
  EXPECT_EQ(model_of<DielectricMaterial>(scene, 2).alpha_u, .5);
}

TEST(Textures, ThatVaryAreOfTheScene) {
  const Scene scene = world_of(
      "Texture \"checks\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 4 "
      "\"float udelta\" .5 \"float "
      "vdelta\" .25\n"
      "\"rgb tex1\" [1 0 0] \"string mapping\" \"uv\" \"integer dimension\" 2\n"
      "Texture \"rough\" \"float\" \"checkerboard\" \"float tex1\" .3 \"float tex2\" .1\n"
      "Texture \"half\" \"float\" \"constant\" \"float value\" .5\n"
      "Texture \"dim\" \"spectrum\" \"scale\" \"texture tex\" \"checks\" \"texture scale\" "
      "\"half\"\n"
      "Texture \"blend\" \"spectrum\" \"mix\" \"texture tex1\" \"dim\" \"rgb tex2\" [0 0 1] "
      "\"texture amount\" \"rough\"\n"
      "Texture \"glow\" \"spectrum\" \"constant\" \"blackbody value\" 3000\n"
      "Texture \"glows\" \"spectrum\" \"scale\" \"texture tex\" \"glow\" \"float scale\" .25\n"
      "Material \"diffuse\" \"texture reflectance\" \"blend\" Shape \"sphere\"\n"
      "Material \"conductor\" \"texture k\" \"glows\" \"float roughness\" .25 \"texture "
      "vroughness\" \"rough\" Shape \"sphere\"\n"
      "Material \"dielectric\" \"texture roughness\" \"rough\" \"float uroughness\" .5 \"bool "
      "remaproughness\" false Shape "
      "\"sphere\"");
  ASSERT_EQ(scene.textures.size(), 6u);
  const auto& checks = std::get<CheckerboardTexture>(scene.textures[0].model);
  EXPECT_EQ(scene.textures[0].name, "checks");
  EXPECT_FALSE(scene.textures[0].is_float);
  EXPECT_EQ(checks.mapping.uscale, 8);
  EXPECT_EQ(checks.mapping.vscale, 4);
  EXPECT_EQ(checks.mapping.udelta, .5);
  EXPECT_EQ(checks.mapping.vdelta, .25);
  EXPECT_EQ(std::get<RgbSpectrum>(checks.tex1.value).rgb, glm::dvec3(1, 0, 0));
  EXPECT_EQ(std::get<ConstantSpectrum>(checks.tex2.value).value,
            0);  // pbrt-v4: 1 and 0 where nothing is given
  const auto& rough = std::get<CheckerboardTexture>(scene.textures[1].model);
  EXPECT_TRUE(scene.textures[1].is_float);
  EXPECT_EQ(std::get<ConstantSpectrum>(rough.tex1.value).value, .3);
  const auto& dim = std::get<ScaleTexture>(scene.textures[2].model);
  EXPECT_EQ(dim.tex.texture, 0u);
  EXPECT_EQ(dim.scale.texture, std::nullopt);
  EXPECT_EQ(std::get<ConstantSpectrum>(dim.scale.value).value, .5);
  const auto& blend = std::get<MixTexture>(scene.textures[3].model);
  EXPECT_EQ(blend.tex1.texture, 2u);
  EXPECT_EQ(blend.tex2.texture, std::nullopt);
  EXPECT_EQ(blend.amount.texture, 1u);
  // What cannot be one constant is a texture too.
  EXPECT_TRUE(std::holds_alternative<BlackbodySpectrum>(
      std::get<ScaleTexture>(scene.textures[4].model).tex.value));
  EXPECT_EQ(std::get<RootTexture>(scene.textures[5].model).tex.texture, 1u);
  const auto fields = [&](std::size_t shape) {
    std::vector<std::pair<std::string, std::uint32_t>> all;
    for (const TexturedField& one : material_of(scene, scene.shapes[shape]).textures)
      all.emplace_back(one.field, one.texture);
    return all;
  };
  using testing::ElementsAre, testing::Pair;
  EXPECT_THAT(fields(0), ElementsAre(Pair("reflectance", 3u)));
  EXPECT_THAT(fields(1), ElementsAre(Pair("k", 4u), Pair("alpha_v", 5u)));
  EXPECT_THAT(fields(2), ElementsAre(Pair("alpha_v", 1u)));
  EXPECT_EQ(model_of<ConductorMaterial>(scene, 1).alpha_u, .5);
  EXPECT_EQ(model_of<DielectricMaterial>(scene, 2).alpha_u, .5);
}

TEST(Lights, PlacesAndDirectionsAreInWorldSpace) {
  const Scene scene = world_of(
      "Shape \"sphere\" Translate 1 0 0 Rotate 90 0 1 0\nLightSource \"point\" \"point3 from\" [0 "
      "0 2] \"float power\" 60\n"
      "LightSource \"spot\" \"float coneangle\" 60 \"float conedeltaangle\" 20\n"
      "LightSource \"distant\" \"point3 from\" [0 0 0] \"point3 to\" [0 0 -1] \"float "
      "illuminance\" 9 \"blackbody L\" 5000\n"
      "ColorSpace \"rec2020\" LightSource \"infinite\" \"float scale\" .5");
  const auto& point = std::get<PointLight>(scene.lights[0].model);
  expect_near(point.position, {3, 0, 0});  // a quarter turn about y maps z to x
  EXPECT_EQ(scene.lights[0].power, 60);
  const auto& spot = std::get<SpotLight>(scene.lights[1].model);
  expect_near(spot.direction, {1, 0, 0});
  EXPECT_NEAR(spot.total_angle, std::acos(0.5), rounding);
  EXPECT_NEAR(spot.falloff_start_angle, std::acos(-1.0) * 40 / 180, rounding);
  expect_near(std::get<DistantLight>(scene.lights[2].model).direction, {-1, 0, 0});
  EXPECT_EQ(scene.lights[2].illuminance, 9);
  const auto& sky = std::get<InfiniteLight>(scene.lights[3].model);
  EXPECT_EQ(std::get<RgbSpectrum>(sky.radiance).space, ColorSpace::rec2020);
  EXPECT_EQ(scene.lights[3].scale, .5);
}

// pbrt-v4's samplers that are randomised in ways of choice.
TEST(Options, RandomizationIsOfSomeSamplers) {
  const auto said = [](const std::string& name) {
    return complaints("Sampler \"" + name +
                      "\" \"string randomization\" \"fastowen\"\nWorldBegin\nShape \"sphere\"");
  };
  for (const char* name : {"halton", "paddedsobol", "sobol", "zsobol"})
    EXPECT_TRUE(said(name).empty()) << name;
  for (const char* name : {"independent", "pmj02bn", "stratified"})
    EXPECT_FALSE(said(name).empty()) << name;
}

TEST(Lights, BlackBodiesAreWarm) {
  const auto said = [](const std::string& kelvin) {
    return complaints("WorldBegin\nShape \"sphere\"\nLightSource \"infinite\" \"blackbody L\" " +
                      kelvin);
  };
  EXPECT_TRUE(said("1").empty());
  for (const char* kelvin : {"0", "-1"}) EXPECT_FALSE(said(kelvin).empty()) << kelvin;
}

TEST(Lights, ConesGoUpToHalfATurn) {
  const auto spot = [](const std::string& cone, const std::string& delta) {
    return complaints("WorldBegin\nShape \"sphere\"\nLightSource \"spot\" \"float coneangle\" " +
                      cone + " \"float conedeltaangle\" " + delta);
  };
  for (const auto& [cone, delta] :
       {std::pair("180", "0"), std::pair("180", "180"), std::pair("1", "1")})
    EXPECT_TRUE(spot(cone, delta).empty()) << cone << ' ' << delta;
  for (const auto& [cone, delta] : {std::pair("180.5", "0"), std::pair("0", "0"),
                                    std::pair("10", "10.5"), std::pair("10", "-1")})
    EXPECT_FALSE(spot(cone, delta).empty()) << cone << ' ' << delta;
}

TEST(Lights, ImagesOfBothLayouts) {
  const fs::path folder = temporary_folder();
  for (const char* name : {"square.exr", "wide.exr"}) {
    write_file(folder / name, "stub");
    const Scene scene = world_of("Scale -2 2 2 LightSource \"infinite\" \"string filename\" \"" +
                                 (folder / name).string() + "\"\nShape \"sphere\"");
    const auto& sky = std::get<InfiniteLight>(scene.lights[0].model);
    EXPECT_EQ(sky.image->equal_area, std::string(name) == "square.exr");
    EXPECT_EQ(sky.world_from_light[0], glm::dvec3(-1, 0, 0));
  }
}

TEST(Shapes, BoundsAreOfTheTransformedShape) {
  const Scene scene = world_of(
      "AttributeBegin Rotate 45 0 0 1 Scale 3 1 1 Shape \"sphere\" Shape \"disk\" \"float height\" "
      "2 \"float radius\" [2] "
      "AttributeEnd\n"
      "AttributeBegin Scale 1 1 2 Shape \"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 5] "
      "\"float radius\" [1 .5] "
      "AttributeEnd\n"
      "ReverseOrientation Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 9 9 9] \"integer "
      "indices\" [0 1 2] \"vector S\" "
      "[1 0 0]\n"
      " \"normal3 N\" [0 0 1 0 0 1 0 0 1 0 0 1] \"point2 st\" [0 0 1 0 0 1 1 1]\nShape "
      "\"trianglemesh\" \"point P\" [0 0 0 1 0 0 "
      "0 1 0]");
  const double side =
      std::sqrt((9 + 1) / 2.0);  // rows of the turned scale: (3, -1) / sqrt 2 and (3, 1) / sqrt 2
  expect_near(bounds_of(scene.shapes[0]).max, {side, side, 1});
  expect_near(bounds_of(scene.shapes[1]).max, {2 * side, 2 * side, 2});
  expect_near(bounds_of(scene.shapes[1]).min, {-2 * side, -2 * side, 2});
  expect_near(bounds_of(scene.shapes[2]).min, {-1, -1, -2});
  expect_near(bounds_of(scene.shapes[2]).max, {1, 1, 11});
  expect_near(bounds_of(scene.shapes[3]).max, {1, 1, 0});
  EXPECT_FALSE(scene.shapes[2].reverse_orientation);
  EXPECT_TRUE(scene.shapes[3].reverse_orientation);
  EXPECT_EQ(std::get<TriangleMeshShape>(scene.shapes[4].geometry).triangles.size(), 1u);
  EXPECT_EQ(scene.shapes[4].where.line, 7);
}

TEST(Files, IncludeSharesStateAndImportHasItsOwn) {
  const fs::path folder = temporary_folder();
  fs::create_directories(folder / "parts");
  const std::string part =
      "Translate 1 0 0\nMakeNamedMaterial \"blue\" \"string type\" \"diffuse\"\nInclude "
      "\"ball.pbrt\"";
  write_file(folder / "parts" / "part.pbrt", part);
  write_file(folder / "parts" / "ball.pbrt", "Shape \"sphere\"");
  for (const char* directive : {"Include", "Import"}) {
    write_file(folder / "main.pbrt",
               "WorldBegin\n" + std::string(directive) +
                   " \"parts/part.pbrt\"\nNamedMaterial \"blue\" Shape \"sphere\"");
    const Scene scene = import_scene(folder / "main.pbrt", StubImages());
    expect_near(image_of(scene.shapes.at(0).world_from_object, {0, 0, 0}), {1, 0, 0});
    expect_near(image_of(scene.shapes.at(1).world_from_object, {0, 0, 0}),
                {std::string(directive) == "Include" ? 1.0 : 0.0, 0, 0});
    EXPECT_EQ(material_of(scene, scene.shapes[1]).name, "blue");
  }
}

TEST(Files, GzipAndUpperCaseExtensions) {
  const fs::path path = temporary_folder() / "SCENE.PBRT.GZ";
  const std::string text = "WorldBegin\nShape \"sphere\"\n";
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  EXPECT_EQ(import_scene(path, StubImages()).shapes.size(), 1u);
}

TEST(Presentation, FillsInWhatTheFileDoesNotSay) {
  EXPECT_FALSE(scene_of("WorldBegin\nShape \"sphere\"").lights.empty());
  const Scene lit =
      scene_of("WorldBegin\nTranslate 50 0 0 Shape \"sphere\" LightSource \"infinite\"");
  EXPECT_EQ(lit.lights.size(), 1u);
  const glm::dmat4 camera_from_world = glm::inverse(lit.view.camera.world_from_camera);
  EXPECT_GT(image_of(camera_from_world, {50, 0, 0}).z, 1.0);
  EXPECT_EQ(world_of("Shape \"sphere\"").lights.size(), 0u);
}

std::size_t count_of(const Scene& scene, const char* kind) {
  const auto counts = count_primitives(scene);
  return counts.contains(kind) ? counts.at(kind) : 0;
}

TEST(SharedScenes, LoadWithTheirStatements) {
  CAPLET_NEEDS_DATA();
  const fs::path scenes = data_folder() / "scenes_pbrt";
  const Scene veach = import_scene(scenes / "veach-mis" / "scene-v4.pbrt", StubImages());
  EXPECT_EQ(veach.shapes.size(), 9u);
  EXPECT_EQ(count_of(veach, "sphere"), 3u);
  EXPECT_EQ(std::count_if(veach.shapes.begin(), veach.shapes.end(),
                          [](const Shape& shape) {
                            return std::holds_alternative<TriangleMeshShape>(shape.geometry);
                          }),
            6);
  const Scene box = import_scene(scenes / "cornell-box" / "scene-v4.pbrt", StubImages());
  EXPECT_EQ(box.view.integrator.max_depth, 4);
  EXPECT_EQ(box.shapes.size(), 8u);
  const Scene coffee = import_scene(scenes / "coffee" / "scene-v4.pbrt", StubImages());
  EXPECT_EQ(std::ranges::count_if(coffee.materials,
                                  [](const Material& one) {
                                    return std::holds_alternative<CoatedDiffuseMaterial>(one.model);
                                  }),
            3);
}

TEST(SharedScenes, MitsubaReferencesLoad) {
  CAPLET_NEEDS_DATA();
  class AnyImage : public ImageReader {
    EnvironmentImage read_rgb(const fs::path&) const override { return {2, 1, {1, 1, 1, 1, 1, 1}}; }
  };
  const fs::path folder = data_folder() / "reference" / "mitsuba";
  for (const char* name :
       {"cornell", "cornell-grey", "mis-grey", "glossy-grey", "environment", "capsules-grey"}) {
    const Scene scene = import_scene(folder / (std::string(name) + ".pbrt"), AnyImage());
    EXPECT_EQ(scene.view.film.width, 128) << name;
    EXPECT_EQ(scene.view.filter.kind, PixelFilter::Kind::box);
    const std::map<std::string, std::size_t> capsules = {{"capsules-grey", 198},
                                                         {"environment", 2}};
    EXPECT_EQ(count_of(scene, "capsule"), capsules.contains(name) ? capsules.at(name) : 0) << name;
  }
}

}  // namespace
}  // namespace caplet::test::pbrt_test
