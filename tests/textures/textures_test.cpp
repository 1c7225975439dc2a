// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What materials take of textures at a point, on a device.
#include <gtest/gtest.h>

#include <cmath>

#include "device/device.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "support/test_device.h"
#include "texture_trials.h"

namespace caplet::test {
namespace {

const char* const kernel_text = R"CL(
#include "bsdf/bsdf.cl"

// Of the first material at uv: reflectance, eta, k, alpha_u, alpha_v at four wavelengths.
__kernel void look_up(__global const MaterialRecord* materials, __global const float* material_data,
                      __global const TextureRecord* textures, __global const float* texture_data,
                      __global const SpectrumRecord* spectra, __global const float* spectrum_tables, float u, float v, __global float* out,
                      uint count) {
  if (get_global_id(0) >= count) return;
  const Materials all = {materials, material_data, textures, texture_data};
  const Spectra values = {spectra, spectrum_tables};
  const Bsdf b = bsdf_make(&all, &values, 0, (float2)(u, v), (float4)(450.0f, 500.0f, 550.0f, 600.0f));
  vstore4(b.reflectance, 0, out);
  vstore4(b.eta, 1, out);
  vstore4(b.k, 2, out);
  out[12] = b.alpha_u;
  out[13] = b.alpha_v;
}
)CL";

struct Looked {
  std::array<float, 4> reflectance, eta, k;
  float alpha_u = 0, alpha_v = 0;
};

/// Programs by the textures that they are built for.
Program& program_of(std::uint64_t textures) {
  static std::map<std::uint64_t, Program> built;
  if (const auto found = built.find(textures); found != built.end()) return found->second;
  return built
      .emplace(textures,
               Program::from_source(test_device(), "textures", flatten_kernels(kernel_text, {{"textures", textures}}), ""))
      .first->second;
}

constexpr std::uint64_t every_kind = ~std::uint64_t{0};

Looked look_up(const Scene& scene, double u, double v, std::uint64_t kinds = every_kind) {
  FlatScene flat = lower(scene);
  const Device& device = test_device();
  flat.spectrum_tables.push_back(0);  // never empty
  flat.texture_data.push_back(0);
  flat.textures.push_back({});
  const Buffer<MaterialRecord> materials(device, std::span<const MaterialRecord>(flat.materials));
  const Buffer<float> data(device, std::span<const float>(flat.material_data));
  const Buffer<TextureRecord> textures(device, std::span<const TextureRecord>(flat.textures));
  const Buffer<float> texture_data(device, std::span<const float>(flat.texture_data));
  const Buffer<SpectrumRecord> spectra(device, std::span<const SpectrumRecord>(flat.spectra));
  const Buffer<float> tables(device, std::span<const float>(flat.spectrum_tables)), out(device, 14);
  cl::Kernel kernel = program_of(kinds).kernel("look_up");
  set_arguments(device, kernel, materials, data, textures, texture_data, spectra, tables, static_cast<cl_float>(u),
                static_cast<cl_float>(v), out, cl_uint{1});
  launch(device, kernel, 1, 1);
  const std::vector<float> values = out.read();
  Looked looked;
  std::copy_n(&values[0], 4, looked.reflectance.begin());
  std::copy_n(&values[4], 4, looked.eta.begin());
  std::copy_n(&values[8], 4, looked.k.begin());
  looked.alpha_u = values[12];
  looked.alpha_v = values[13];
  return looked;
}

Scene scene_of(decltype(Material::model) model, std::vector<Texture> textures, std::vector<TexturedField> fields) {
  Scene scene;
  scene.shapes.emplace_back().geometry = SphereShape{1};
  scene.textures = std::move(textures);
  scene.materials.push_back({std::move(model), "m", {}, std::move(fields)});
  Diagnostics problems;
  validate(scene, problems);
  problems.finish();  // throws where there are any
  return scene;
}

Scene scene_of(const TextureTrial& trial, bool is_float) {
  std::vector<Texture> textures = trial.textures;
  // Factors stay textures of floats; those of the trials that are one are no other's operand.
  std::vector<bool> is_factor(textures.size());
  for (const Texture& texture : textures) {
    if (const auto* mix = std::get_if<MixTexture>(&texture.model); mix && mix->amount.texture)
      is_factor[*mix->amount.texture] = true;
    if (const auto* scale = std::get_if<ScaleTexture>(&texture.model); scale && scale->scale.texture)
      is_factor[*scale->scale.texture] = true;
  }
  for (std::size_t i = 0; i < textures.size(); ++i) textures[i].is_float = is_float || is_factor[i];
  const auto last = static_cast<std::uint32_t>(textures.size() - 1);
  ConductorMaterial metal{ConstantSpectrum{1}, ConstantSpectrum{1}, std::nullopt, 0.5, 0.5};
  if (is_float) return scene_of(metal, textures, {{"alpha_u", last}});
  if (trial.field != "k") return scene_of(DiffuseMaterial{}, textures, {{"reflectance", last}});
  metal.reflectance = ConstantSpectrum{0.5};
  return scene_of(metal, textures, {{"reflectance", last}});
}

TEST(EveryTexture, HasItsValuesAsSpectraAndAsFloats) {
  for (const TextureOnTrial& texture : textures_on_trial()) {
    const bool of_metals = texture.trial.field == "k";
    for (const bool is_float : {false, true}) {
      if (of_metals && is_float) continue;
      const Scene scene = scene_of(texture.trial, is_float);
      for (const TextureTrial::Value& expected : texture.trial.values) {
        const Looked found = look_up(scene, expected.u, expected.v);
        const double slack = texture.trial.tolerance * expected.value;
        if (is_float) {
          EXPECT_NEAR(found.alpha_u, expected.value, slack) << texture.name << ' ' << expected.u << ' ' << expected.v;
          EXPECT_EQ(found.alpha_v, 0.5f) << texture.name;
        } else {
          for (const float value : of_metals ? found.k : found.reflectance)
            EXPECT_NEAR(value, expected.value, slack) << texture.name << ' ' << expected.u << ' ' << expected.v;
          if (of_metals) {
            EXPECT_EQ(found.eta, (std::array<float, 4>{1, 1, 1, 1}));
          }
        }
      }
    }
  }
}

// What a renderer builds for a scene's textures says what the kernels of all say; without the one on trial they do not.
TEST(EveryTexture, IsInTheKernelsOfItsScene) {
  for (const TextureOnTrial& texture : textures_on_trial()) {
    const Scene scene = scene_of(texture.trial, texture.trial.field != "k");
    const std::uint64_t kinds = lower(scene).texture_kinds(), own = std::uint64_t{1} << texture.kind;
    EXPECT_NE(kinds & own, 0u) << texture.name;
    for (const TextureTrial::Value& at : texture.trial.values) {
      const Looked all = look_up(scene, at.u, at.v), few = look_up(scene, at.u, at.v, kinds),
                   without = look_up(scene, at.u, at.v, every_kind & ~own);
      EXPECT_EQ(all.alpha_u, few.alpha_u) << texture.name;
      EXPECT_EQ(all.k, few.k) << texture.name;
      EXPECT_TRUE(without.alpha_u != all.alpha_u || without.k != all.k) << texture.name;
    }
  }
}

TEST(Textures, ScenesWithoutThemHaveNoStepsAndNoKernelsOfThem) {
  const FlatScene flat = lower(scene_of(DiffuseMaterial{}, {}, {}));
  EXPECT_TRUE(flat.textures.empty());
  EXPECT_EQ(flat.texture_kinds(), 0u);
  EXPECT_EQ(flat.materials[0].textured, 0u);
}

// Colours, as a constant of the same colour has them.
TEST(Textures, OfColoursAreThoseOfConstants) {
  const RgbSpectrum red{{0.8, 0.1, 0.05}}, blue{{0.1, 0.2, 0.9}};
  CheckerboardTexture checks;
  checks.tex1.value = red;
  checks.tex2.value = blue;
  const Scene scene = scene_of(DiffuseMaterial{}, {{checks, false, "t", {}}}, {{"reflectance", 0}});
  EXPECT_EQ(look_up(scene, 0.5, 0.5).reflectance, look_up(scene_of(DiffuseMaterial{red}, {}, {}), 0, 0).reflectance);
  EXPECT_EQ(look_up(scene, 1.5, 0.5).reflectance, look_up(scene_of(DiffuseMaterial{blue}, {}, {}), 0, 0).reflectance);
  // Of a metal's eta they are unbounded: 3 is 3.
  checks.tex1 = 3;
  checks.tex2 = 0.5;
  const Scene metal =
      scene_of(ConductorMaterial{ConstantSpectrum{1}, ConstantSpectrum{2}, {}, 0, 0}, {{checks, false, "t", {}}}, {{"eta", 0}});
  EXPECT_EQ(look_up(metal, 0.5, 0.5).eta[1], 3);
  EXPECT_EQ(look_up(metal, 1.5, 0.5).eta[1], 0.5f);
  EXPECT_EQ(look_up(metal, 1.5, 0.5).k[1], 2);
}

TEST(Textures, ReflectancesEndAtOneAndRoughnessAtZero) {
  ScaleTexture twice;
  twice.tex = 0.75;
  twice.scale = 2;
  EXPECT_EQ(look_up(scene_of(DiffuseMaterial{}, {{twice, false, "t", {}}}, {{"reflectance", 0}}), 0, 0).reflectance[2], 1);
  twice.scale = -2;
  EXPECT_EQ(look_up(scene_of(DiffuseMaterial{}, {{twice, false, "t", {}}}, {{"reflectance", 0}}), 0, 0).reflectance[2], 0);
  ConductorMaterial metal{ConstantSpectrum{1}, ConstantSpectrum{1}, {}, 0.5, 0.5};
  EXPECT_EQ(look_up(scene_of(metal, {{twice, true, "t", {}}}, {{"alpha_v", 0}}), 0, 0).alpha_v, CAPLET_ALPHA_MIN);
}

// Sixteen levels, each of which takes the one below twice: 2^15 paths, 31 steps.
TEST(Textures, WhatIsUsedTwiceIsEvaluatedOnce) {
  std::vector<Texture> textures;
  CheckerboardTexture checks;
  checks.tex1 = 0.5;
  checks.tex2 = 0.25;
  textures.push_back({checks, true, "0", {}});
  for (std::uint32_t i = 1; i <= 14; ++i) {
    MixTexture mixed;
    mixed.tex1 = operand_of(i - 1);
    mixed.tex2 = operand_of(i - 1);
    mixed.amount = 0.5;
    textures.push_back({mixed, true, std::to_string(i), {}});
  }
  EXPECT_EQ(texture_steps(textures, 14), 31u);  // the checkerboard's three, and 14 times a mix and its amount
  const Scene scene = scene_of(DielectricMaterial{}, textures, {{"alpha_u", 14}, {"alpha_v", 0}});
  ASSERT_EQ(lower(scene).textures.size(), 31u + 3u);
  EXPECT_EQ(look_up(scene, 0.5, 0.5).alpha_u, 0.5f);
  EXPECT_EQ(look_up(scene, 1.5, 0.5).alpha_u, 0.25f);
  EXPECT_EQ(look_up(scene, 1.5, 0.5).alpha_v, 0.25f);
  textures.push_back(textures[14]);
  std::get<MixTexture>(textures[15].model).tex1 = operand_of(14);
  textures[15].name = "deep";
  EXPECT_THROW(scene_of(DielectricMaterial{}, textures, {{"alpha_u", 15}}), InputError);
}

TEST(Textures, TheModelRefusesWhatHasNoSense) {
  const Texture number{CheckerboardTexture{}, true, "t", {}}, color{CheckerboardTexture{}, false, "t", {}};
  const DiffuseMaterial diffuse;
  EXPECT_NO_THROW(scene_of(diffuse, {color}, {{"reflectance", 0}}));
  EXPECT_THROW(scene_of(diffuse, {number}, {{"reflectance", 0}}), InputError);
  EXPECT_THROW(scene_of(diffuse, {color}, {{"reflectance", 1}}), InputError);
  EXPECT_THROW(scene_of(diffuse, {color}, {{"reflectance", 0}, {"reflectance", 0}}), InputError);
  EXPECT_THROW(scene_of(diffuse, {color}, {{"eta", 0}}), InputError);
  EXPECT_THROW(scene_of(DielectricMaterial{}, {color}, {{"eta", 0}}), InputError);
  EXPECT_THROW(scene_of(DielectricMaterial{}, {color}, {{"alpha_u", 0}}), InputError);
  EXPECT_NO_THROW(scene_of(DielectricMaterial{}, {number}, {{"alpha_u", 0}}));
  // An operand comes before, and is of the same.
  ScaleTexture scaled;
  scaled.tex = operand_of(0);
  EXPECT_THROW(scene_of(diffuse, {{scaled, false, "t", {}}}, {}), InputError);
  EXPECT_THROW(scene_of(diffuse, {number, {scaled, false, "t", {}}}, {}), InputError);
  EXPECT_NO_THROW(scene_of(diffuse, {color, {scaled, false, "t", {}}}, {}));
  CheckerboardTexture bad;
  bad.uscale = INFINITY;
  EXPECT_THROW(scene_of(diffuse, {{bad, false, "t", {}}}, {}), InputError);
  bad = {};
  bad.tex1 = -1;
  EXPECT_THROW(scene_of(diffuse, {{bad, false, "t", {}}}, {}), InputError);
}

// A plane of 8 x 8 squares of 0.2 and 0.6 fills the picture under a sky of radiance 1: each pixel within a square is its
// reflectance.
TEST(TexturedPictures, OfAFloorUnderAConstantSky) {
  const Scene scene = scene_of_text(
      "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 90\nPixelFilter \"box\"\n"
      "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\nWorldBegin\nLightSource \"infinite\" \"rgb L\" [1 1 "
      "1]\n"
      "Texture \"checks\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.2 .2 .2] \"rgb tex2\" [.6 .6 .6]\n"
      "\"float uscale\" 8 \"float vscale\" 8\nMaterial \"diffuse\" \"texture reflectance\" \"checks\"\n"
      "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0]");
  const Rendered rendered = render_model(scene, 64);
  const Mean mean = mean_of(rendered.image, "G");
  EXPECT_LT(mean.error, 2e-3);
  EXPECT_NEAR(mean.value, 0.4, 4 * mean.error + 1e-3);
  // Four pixels a square: v runs up, the rows run down; the camera sees u to the left, as pbrt's are left-handed. Either way the
  // squares along one diagonal of the picture are even and those along the other odd.
  const std::vector<float>& albedo = channel(rendered.image, "albedo.G").floats;
  int dark = 0, bright = 0;
  for (std::size_t y = 0; y < 32; ++y)
    for (std::size_t x = 0; x < 32; ++x) {
      const float value = albedo[32 * y + x];
      dark += std::abs(value - 0.2f) < 2e-3f;
      bright += std::abs(value - 0.6f) < 2e-3f;
      EXPECT_NEAR(value, albedo[32 * (31 - y) + (31 - x)], 2e-3);
      EXPECT_NEAR(value + albedo[32 * y + (31 - x)], 0.8, 4e-3);
      EXPECT_NEAR(value, albedo[32 * (y / 4 * 4) + x / 4 * 4], 2e-3);
    }
  EXPECT_EQ(dark, 512);
  EXPECT_EQ(bright, 512);
}

}  // namespace
}  // namespace caplet::test
