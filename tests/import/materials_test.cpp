// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Materials of scene text beyond the first three: what each parameter comes to, and what is wrong
// with its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "import_text.h"

namespace caplet::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

template <class T>
const T& model_of(const Scene& scene, std::size_t shape = 0) {
  return std::get<T>(scene.materials.at(scene.shapes.at(shape).material).model);
}
double constant(const Spectrum& spectrum) { return std::get<ConstantSpectrum>(spectrum).value; }
glm::dvec3 rgb(const Spectrum& spectrum) { return std::get<RgbSpectrum>(spectrum).rgb; }

TEST(Sheets, ThinGlassAndDiffuseTransmission) {
  const Scene scene = world_of(
      "Material \"thindielectric\" \"float eta\" 1.3 Shape \"disk\"\nMaterial \"thindielectric\" "
      "Shape \"disk\"\n"
      "Material \"diffusetransmission\" \"rgb reflectance\" [.1 .2 .3] \"rgb transmittance\" [.4 "
      ".5 .6] \"float scale\" .5 Shape "
      "\"disk\"\n"
      "Material \"diffusetransmission\" Shape \"disk\"");
  EXPECT_EQ(constant(model_of<ThinDielectricMaterial>(scene).eta), 1.3);
  EXPECT_EQ(constant(model_of<ThinDielectricMaterial>(scene, 1).eta), 1.5);
  const auto& sheet = model_of<DiffuseTransmissionMaterial>(scene, 2);
  EXPECT_EQ(rgb(sheet.reflectance), glm::dvec3(.1, .2, .3));
  EXPECT_EQ(rgb(sheet.transmittance), glm::dvec3(.4, .5, .6));
  EXPECT_EQ(sheet.scale, .5);
  const auto& plain = model_of<DiffuseTransmissionMaterial>(scene, 3);
  EXPECT_EQ(constant(plain.reflectance), .25);
  EXPECT_EQ(constant(plain.transmittance), .25);
  EXPECT_EQ(plain.scale, 1);
}

TEST(Principled, EveryParameter) {
  const Scene scene = world_of(
      "Texture \"t\" \"float\" \"checkerboard\"\nTexture \"c\" \"spectrum\" \"checkerboard\"\n"
      "Material \"principled\" \"rgb base_color\" [.1 .2 .3] \"float metallic\" .1 \"float "
      "roughness\" .2 \"float anisotropic\" "
      ".3\n"
      " \"float eta\" 1.4 \"float spec_tint\" .5 \"float spec_trans\" .6 \"float sheen\" .7 "
      "\"float sheen_tint\" .8 \"float "
      "coat\" .9\n"
      " \"float coat_roughness\" .15 \"float coat_eta\" 1.6 \"rgb coat_color\" [.9 .8 .7] Shape "
      "\"sphere\"\n"
      "Material \"principled\" Shape \"sphere\"\n"
      "Material \"principled\" \"texture base_color\" \"c\" \"texture roughness\" \"t\" \"texture "
      "coat\" \"t\" Shape \"sphere\"");
  const auto& all = model_of<PrincipledMaterial>(scene);
  EXPECT_EQ(rgb(all.base_color), glm::dvec3(.1, .2, .3));
  EXPECT_EQ(all.metallic, .1);
  EXPECT_EQ(all.roughness, .2);
  EXPECT_EQ(all.anisotropic, .3);
  EXPECT_EQ(all.eta, 1.4);
  EXPECT_EQ(all.spec_tint, .5);
  EXPECT_EQ(all.spec_trans, .6);
  EXPECT_EQ(all.sheen, .7);
  EXPECT_EQ(all.sheen_tint, .8);
  EXPECT_EQ(all.coat, .9);
  EXPECT_EQ(all.coat_roughness, .15);
  EXPECT_EQ(all.coat_eta, 1.6);
  EXPECT_EQ(rgb(all.coat_color), glm::dvec3(.9, .8, .7));
  const auto& plain = model_of<PrincipledMaterial>(scene, 1);
  EXPECT_EQ(constant(plain.base_color), .5);
  EXPECT_EQ(plain.roughness, .5);
  EXPECT_EQ(plain.eta, 1.5);
  EXPECT_EQ(plain.coat, 0);
  EXPECT_EQ(constant(plain.coat_color), 1);
  std::vector<std::string> fields;
  for (const TexturedField& one : scene.materials.at(scene.shapes.at(2).material).textures)
    fields.push_back(one.field);
  EXPECT_THAT(fields, testing::UnorderedElementsAre("base_color", "roughness", "coat"));
  const auto said = [](const std::string& parameters) {
    return complaint_of(
        [&] { world_of("Material \"principled\" " + parameters + " Shape \"sphere\""); });
  };
  EXPECT_THAT(
      said("\"float metallic\" 1.5"),
      HasSubstr("scene.pbrt:3:23: Material \"principled\": \"metallic\" must lie between 0"));
  EXPECT_THAT(said("\"float roughness\" -.1"), HasSubstr("\"roughness\" must lie between 0"));
  EXPECT_THAT(said("\"float eta\" .9"), HasSubstr("\"eta\" must lie between 1"));
  EXPECT_THAT(said("\"rgb base_color\" [2 0 0]"), HasSubstr("has a component above 1"));
  EXPECT_THAT(said("\"float clearcoat\" 1"), HasSubstr("clearcoat"));
}

// What pbrt-v4 takes: a texture of each kind under one name, an interface by other names,
// integrators that converge to the same image.
TEST(Leniency, NamesThatPbrtAccepts) {
  const Scene scene = scene_of(
      "Integrator \"sppm\" \"integer maxdepth\" 7 \"integer photonsperiteration\" 9 \"float "
      "radius\" 1\nWorldBegin\n"
      "Texture \"t\" \"float\" \"constant\" \"float value\" .25 Texture \"t\" \"spectrum\" "
      "\"constant\" \"rgb value\" [.1 .2 "
      ".3]\n"
      "Material \"coateddiffuse\" \"texture reflectance\" \"t\" \"texture roughness\" \"t\" Shape "
      "\"sphere\"\n"
      "Material \"none\" Shape \"sphere\" Material \"\" Shape \"sphere\"");
  EXPECT_EQ(scene.view.integrator.max_depth, 7);
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(rgb(model_of<CoatedDiffuseMaterial>(scene).reflectance), glm::dvec3(.1, .2, .3));
  EXPECT_EQ(model_of<CoatedDiffuseMaterial>(scene).alpha_u, .5);
  EXPECT_EQ(scene_of("Integrator \"lightpath\" \"integer maxdepth\" 3\nWorldBegin Shape \"sphere\"")
                .view.integrator.max_depth,
            3);
  EXPECT_THAT(complaint_of([] {
                world_of(
                    "Texture \"t\" \"float\" \"constant\" Texture \"t\" \"float\" \"constant\" "
                    "Shape \"sphere\"");
              }),
              HasSubstr("defined twice"));
}

TEST(Multiscatter, IsOfRoughMetalsAndGlass) {
  const Scene scene = world_of(
      "Material \"conductor\" Shape \"sphere\" Material \"conductor\" \"bool multiscatter\" true "
      "Shape \"sphere\"\n"
      "Material \"dielectric\" \"bool multiscatter\" false Shape \"sphere\" Material "
      "\"dielectric\" \"bool multiscatter\" true "
      "Shape \"sphere\"");
  EXPECT_FALSE(model_of<ConductorMaterial>(scene, 0).multiscatter);
  EXPECT_TRUE(model_of<ConductorMaterial>(scene, 1).multiscatter);
  EXPECT_FALSE(model_of<DielectricMaterial>(scene, 2).multiscatter);
  EXPECT_TRUE(model_of<DielectricMaterial>(scene, 3).multiscatter);
}

TEST(Coats, EveryParameter) {
  const Scene scene = world_of(
      "Material \"coateddiffuse\" \"rgb reflectance\" [.1 .2 .3] \"float uroughness\" .04 \"float "
      "vroughness\" .09 \"float "
      "thickness\" .2\n"
      " \"float eta\" 1.4 \"rgb albedo\" [.5 .6 .7] \"float g\" -.3 \"integer maxdepth\" 7 "
      "\"integer nsamples\" 3 Shape "
      "\"sphere\"\n"
      "Material \"coatedconductor\" \"float interface.roughness\" .1 \"float "
      "interface.vroughness\" .2 \"spectrum "
      "interface.eta\" "
      "\"glass-BK7\"\n \"spectrum conductor.eta\" [400 .2 700 .4] \"spectrum conductor.k\" [400 3 "
      "700 4] \"float "
      "conductor.uroughness\" .3 "
      "\"bool remaproughness\" false Shape \"sphere\"\n"
      "Material \"coatedconductor\" \"rgb reflectance\" [.9 .8 .7] \"float conductor.roughness\" "
      ".25 Shape \"sphere\"\n"
      "Material \"coateddiffuse\" Shape \"sphere\" Material \"coatedconductor\" Shape \"sphere\"");
  const auto& paint = model_of<CoatedDiffuseMaterial>(scene);
  EXPECT_EQ(rgb(paint.reflectance), glm::dvec3(.1, .2, .3));
  EXPECT_EQ(constant(paint.eta), 1.4);
  EXPECT_EQ(paint.alpha_u, .2);
  EXPECT_EQ(paint.alpha_v, .3);
  EXPECT_EQ(paint.layer.thickness, .2);
  EXPECT_EQ(rgb(paint.layer.albedo), glm::dvec3(.5, .6, .7));
  EXPECT_EQ(paint.layer.g, -.3);
  EXPECT_EQ(paint.layer.max_depth, 7);
  EXPECT_EQ(paint.layer.samples, 3);
  const auto& metal = model_of<CoatedConductorMaterial>(scene, 1);
  EXPECT_EQ(metal.interface_alpha_u, .1);
  EXPECT_EQ(metal.interface_alpha_v, .2);
  EXPECT_TRUE(std::holds_alternative<SampledSpectrum>(metal.interface_eta));
  EXPECT_EQ(std::get<SampledSpectrum>(metal.eta).values[1], .4);
  EXPECT_EQ(std::get<SampledSpectrum>(metal.k).values[0], 3);
  EXPECT_EQ(metal.alpha_u, .3);
  EXPECT_EQ(metal.alpha_v, 0);
  const auto& tinted = model_of<CoatedConductorMaterial>(scene, 2);
  EXPECT_EQ(rgb(*tinted.reflectance), glm::dvec3(.9, .8, .7));
  EXPECT_EQ(tinted.alpha_v, .5);
  EXPECT_EQ(tinted.interface_alpha_u, 0);
  // pbrt-v4's defaults.
  const auto& plain = model_of<CoatedDiffuseMaterial>(scene, 3);
  EXPECT_EQ(constant(plain.reflectance), .5);
  EXPECT_EQ(constant(plain.eta), 1.5);
  EXPECT_EQ(plain.alpha_u, 0);
  EXPECT_EQ(plain.layer.thickness, .01);
  EXPECT_EQ(constant(plain.layer.albedo), 0);
  EXPECT_EQ(plain.layer.g, 0);
  EXPECT_EQ(plain.layer.max_depth, 10);
  EXPECT_EQ(plain.layer.samples, 1);
  EXPECT_TRUE(std::holds_alternative<SampledSpectrum>(
      model_of<CoatedConductorMaterial>(scene, 4).k));  // copper
}

TEST(Coats, MayBeTextured) {
  const Scene scene = world_of(
      "Texture \"t\" \"float\" \"checkerboard\" Texture \"c\" \"spectrum\" \"checkerboard\"\n"
      "Material \"coatedconductor\" \"texture interface.roughness\" \"t\" \"texture conductor.k\" "
      "\"c\" \"texture thickness\" "
      "\"t\" "
      "\"bool remaproughness\" false Shape \"sphere\"");
  std::vector<std::string> fields;
  for (const TexturedField& one : scene.materials[0].textures) fields.push_back(one.field);
  EXPECT_THAT(fields,
              ElementsAre("interface.alpha_u", "interface.alpha_v", "conductor.k", "thickness"));
  Diagnostics diagnostics;
  validate(scene, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors());
}

TEST(Mixes, OfNamesThatMayComeLater) {
  const Scene scene = world_of(
      "Material \"mix\" \"string materials\" [\"outer\" \"b\"] \"float amount\" .25 Shape "
      "\"sphere\"\n"
      "MakeNamedMaterial \"outer\" \"string type\" \"mix\" \"string materials\" [\"b\" \"a\"]\n"
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"b\" \"string type\" "
      "\"conductor\"\n");
  const auto& mix = model_of<MixMaterial>(scene);
  EXPECT_EQ(mix.amount, .25);
  EXPECT_EQ(scene.materials.at(mix.materials[0]).name, "outer");
  EXPECT_EQ(scene.materials.at(mix.materials[1]).name, "b");
  const auto& outer = std::get<MixMaterial>(scene.materials.at(mix.materials[0]).model);
  EXPECT_EQ(outer.amount, .5);
  EXPECT_EQ(scene.materials.at(outer.materials[1]).name, "a");
}

TEST(Mixes, WrongOnes) {
  const std::string world = "WorldBegin\n";
  EXPECT_THAT(
      complaints(world + "Material \"mix\" \"string materials\" [\"a\" \"b\"]\nShape \"sphere\"\n"
                         "MakeNamedMaterial \"a\" \"string type\" \"diffuse\""),
      ElementsAre("scene.pbrt:2:16: Material \"mix\": \"materials\" names the material \"b\", "
                  "which is not defined; the nearest "
                  "known name is \"a\""));
  EXPECT_THAT(
      complaints(
          world +
          "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]\n"
          "NamedMaterial \"a\"\nShape \"sphere\""),
      testing::Each(HasSubstr("names the material \"a\", of which this is a part")));
  EXPECT_THAT(complaints(world + "Material \"mix\" \"string materials\" \"a\"\nShape \"sphere\""),
              ElementsAre("scene.pbrt:2:16: Material \"mix\": \"materials\" takes the names of 2 "
                          "materials, not of 1"));
  EXPECT_THAT(complaints(world + "Material \"mix\"\nShape \"sphere\""),
              ElementsAre("scene.pbrt:2:1: Material \"mix\": \"materials\" is missing"));
  EXPECT_THAT(
      complaints(world +
                 "MakeNamedMaterial \"m\" \"string type\" \"measured\"\n"
                 "Material \"mix\" \"string materials\" [\"m\" \"m\"]\nShape \"sphere\"")[0],
      HasSubstr("scene.pbrt:2:23: Material \"measured\" is not rendered yet"));
}

TEST(Mixes, AreValidated) {
  Scene scene;
  scene.shapes.emplace_back().geometry = SphereShape{1};
  scene.materials.resize(2);
  const auto said = [&] { return complaints_when([&] { return scene; }); };
  scene.materials[0].model = MixMaterial{{1, 1}};
  EXPECT_THAT(said(), ElementsAre());
  scene.materials[1].model = MixMaterial{{0, 1}};
  EXPECT_THAT(said(), testing::Contains(HasSubstr("a mix is a part of itself")));
  scene.materials[0].model = DiffuseMaterial{};
  EXPECT_THAT(said(), testing::Contains(HasSubstr("a mix is a part of itself")));  // at once
  scene.materials[1].model = MixMaterial{{7, 7}};
  EXPECT_THAT(said(), testing::Contains(HasSubstr("a mix has a material that does not exist")));
}

TEST(Interfaces, AreNotSeen) {
  const Scene scene = world_of(
      "Material \"interface\" Shape \"sphere\" MakeNamedMaterial \"i\" \"string type\" "
      "\"interface\"\n"
      "ObjectBegin \"o\" NamedMaterial \"i\" Shape \"sphere\" Material \"diffuse\" Shape \"disk\" "
      "ObjectEnd ObjectInstance "
      "\"o\"\n"
      "Material \"diffuse\" Shape \"sphere\" \"float radius\" 3");
  ASSERT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(std::get<SphereShape>(scene.shapes[0].geometry).radius, 3);
  EXPECT_EQ(scene.objects.at(0).shapes.size(), 1u);
  // Parts of a shape that are seen keep the whole of it.
  const Scene parts = world_of(
      "MakeNamedMaterial \"i\" \"string type\" \"interface\"\nMakeNamedMaterial \"d\" \"string "
      "type\" \"diffuse\"\n"
      "Shape \"cylinder\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" 1 \"string "
      "materials\" [\"i\" \"d\" "
      "\"d\"]");
  ASSERT_EQ(parts.shapes.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<InterfaceMaterial>(
      parts.materials.at(parts.shapes[0].materials.at(0)).model));
  EXPECT_THAT(
      complaints("WorldBegin\nMaterial \"interface\" \"float g\" 1\nShape \"sphere\"").front(),
      HasSubstr("scene.pbrt:2:22: Material \"interface\": unknown parameter \"g\""));
}

TEST(Hair, ColoursAndShape) {
  const Scene scene = world_of(
      "Material \"hair\" \"rgb sigma_a\" [.1 .2 .3] \"float eta\" 1.4 \"float beta_m\" .2 \"float "
      "beta_n\" .6 \"float alpha\" 3 "
      "Shape "
      "\"capsule\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" .1\n"
      "Material \"hair\" \"rgb reflectance\" [.5 .4 .3] Shape \"sphere\" Material \"hair\" \"rgb "
      "color\" [.6 .4 .3] Shape "
      "\"sphere\"\n"
      "Material \"hair\" \"float eumelanin\" 2 \"float pheomelanin\" .5 Shape \"sphere\" Material "
      "\"hair\" Shape \"sphere\"\n"
      "Material \"diffuse\" Shape \"sphere\"");
  const auto& full = model_of<HairMaterial>(scene);
  EXPECT_EQ(rgb(full.sigma_a), glm::dvec3(.1, .2, .3));
  EXPECT_EQ(full.eta, 1.4);
  EXPECT_EQ(full.beta_m, .2);
  EXPECT_EQ(full.beta_n, .6);
  EXPECT_EQ(full.alpha, 3);
  EXPECT_EQ(rgb(*model_of<HairMaterial>(scene, 1).reflectance), glm::dvec3(.5, .4, .3));
  EXPECT_EQ(rgb(*model_of<HairMaterial>(scene, 2).reflectance), glm::dvec3(.6, .4, .3));
  // d'Eon et al. 2011: 0.419 0.697 1.37 for each of eumelanin, 0.187 0.4 1.05 for pheomelanin; 1.3
  // of the first where nothing is said.
  EXPECT_NEAR(rgb(model_of<HairMaterial>(scene, 3).sigma_a).x, 0.9315, 1e-12);
  EXPECT_NEAR(rgb(model_of<HairMaterial>(scene, 4).sigma_a).z, 1.781, 1e-12);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_TRUE(scene.shapes[i].one_sided) << i;
  EXPECT_FALSE(scene.shapes[5].one_sided);
}

TEST(Materials, AlphaIsGgxsOwn) {
  const Scene scene = scene_of(
      "WorldBegin\nMaterial \"conductor\" \"float alpha_u\" .3 \"float alpha_v\" .2 Shape "
      "\"sphere\"\n"
      "Material \"coatedconductor\" \"float interface.alpha_v\" .4 \"float conductor.roughness\" "
      ".25 Shape \"sphere\"");
  const auto& metal = std::get<ConductorMaterial>(scene.materials[scene.shapes[0].material].model);
  EXPECT_EQ(metal.alpha_u, 0.3);
  EXPECT_EQ(metal.alpha_v, 0.2);
  const auto& coated =
      std::get<CoatedConductorMaterial>(scene.materials[scene.shapes[1].material].model);
  EXPECT_EQ(coated.interface_alpha_u, 0);
  EXPECT_EQ(coated.interface_alpha_v, 0.4);
  EXPECT_EQ(coated.alpha_u, 0.5);  // remapped
  EXPECT_THAT(complaint_of([] {
                scene_of(
                    "WorldBegin\nMaterial \"conductor\" \"float alpha_u\" .3 \"float roughness\" "
                    ".2 Shape \"sphere\"");
              }),
              testing::HasSubstr("\"roughness\" cannot be combined with \"alpha_u\""));
}

TEST(Materials, WrongNumbersHaveTheirPlace) {
  const auto said = [](const std::string& text) {
    return complaints("WorldBegin\nMaterial " + text + "\nShape \"sphere\"").front();
  };
  EXPECT_THAT(
      said("\"coateddiffuse\" \"float g\" 1"),
      HasSubstr("scene.pbrt:2:26: Material \"coateddiffuse\": \"g\" must lie between -0.9"));
  EXPECT_THAT(said("\"coateddiffuse\" \"float thickness\" -1"),
              HasSubstr("scene.pbrt:2:26: Material \"coateddiffuse\": \"thickness\" must"));
  EXPECT_THAT(said("\"coateddiffuse\" \"integer nsamples\" 0"),
              HasSubstr("\"nsamples\" must lie between 1 and 10000"));
  EXPECT_THAT(said("\"coatedconductor\" \"float conductor.roughness\" -1"),
              HasSubstr("\"conductor.roughness\" must not be negative"));
  EXPECT_THAT(
      said("\"coatedconductor\" \"rgb reflectance\" [.5 .5 .5] \"rgb conductor.k\" [1 1 1]"),
      HasSubstr("cannot be combined with \"conductor.eta\" or \"conductor.k\""));
  EXPECT_THAT(said("\"coatedconductor\" \"float interface.ruffness\" 0"),
              HasSubstr("the nearest known name is \"interface.roughness\""));
  EXPECT_THAT(said("\"thindielectric\" \"float eta\" 0"), HasSubstr("\"eta\" must be positive"));
  EXPECT_THAT(said("\"diffusetransmission\" \"float scale\" -2"),
              HasSubstr("\"scale\" must be finite and from"));
  EXPECT_THAT(said("\"hair\" \"float beta_n\" 2"), HasSubstr("\"beta_n\" must lie between 0"));
  EXPECT_THAT(said("\"hair\" \"float eumelanin\" 1 \"rgb sigma_a\" [1 1 1]"),
              HasSubstr("cannot be combined with other ways"));
  EXPECT_THAT(said("\"hair\" \"float eumelanin\" -1"),
              HasSubstr("\"eumelanin\" must not be negative"));
}

}  // namespace
}  // namespace caplet::test
