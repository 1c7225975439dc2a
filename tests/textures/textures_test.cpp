// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What materials take of textures at a point, on a device.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "device/device.h"
#include "lower/detail/images.h"
#include "lower/detail/lowering.h"
#include "lower/detail/textures.h"
#include "lower/lower.h"
#include "render_scene.h"
#include "support/test_device.h"
#include "texture_trials.h"

namespace caplet::test {
namespace {

const char* const kernel_text = R"CL(
#include "bsdf/bsdf.cl"

// This evaluates the first material at a place: reflectance, eta, k, alpha_u, alpha_v at four
// wavelengths; and the texture whose first step is `step`.
__kernel void look_up(__global const MaterialRecord* materials, __global const float* material_data,
                      __global const TextureRecord* textures, __global const float* texture_data,
                      __global const ImageRecord* images, __global const uint* texels,
                      __global const SpectrumRecord* spectra, __global const float* spectrum_tables, __global const float* at, uint step,
                      __global float* out, uint count) {
  if (get_global_id(0) >= count) return;
  const Materials all = {materials, material_data, textures, texture_data, images, texels};
  const Spectra values = {spectra, spectrum_tables};
  const TexturePlace place = {vload2(0, at),       load3(at + 2),       load3(at + 5),      load3(at + 8), load3(at + 11),
                              vload2(0, at + 14), vload2(0, at + 16)};
  const float4 lambda = (float4)(450.0f, 500.0f, 550.0f, 600.0f);
  const Bsdf b = bsdf_make(&all, &values, 0, &place, lambda);
  const TexturePoint point = {&all, &values, place, lambda};
  if (any_texture && step != CAPLET_NONE) vstore4(texture_eval(step, &point), 0, out + 14);
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
  std::array<float, 4> step = {};
};

/// Programs by the textures that they are built for.
Program& program_of(std::uint64_t textures) {
  static std::map<std::uint64_t, Program> built;
  if (const auto found = built.find(textures); found != built.end()) return found->second;
  return built
      .emplace(textures,
               Program::from_source(test_device(), "textures",
                                    flatten_kernels(kernel_text, {{"textures", textures}}), ""))
      .first->second;
}

constexpr std::uint64_t every_kind = ~std::uint64_t{0};

/// Evaluates the first material, and the texture whose first step is `step` of `flat`.
Looked look_up(FlatScene flat, const TextureTrial::Value& at, std::uint64_t kinds,
               std::uint32_t step = CAPLET_NONE) {
  const Device& device = test_device();
  flat.spectrum_tables.push_back(0);  // never empty
  flat.texture_data.push_back(0);
  flat.textures.push_back({});
  flat.images.push_back({});
  flat.texels.push_back({});
  std::vector<float> place = {static_cast<float>(at.u), static_cast<float>(at.v)};
  for (const auto& v : {at.p, at.n, at.dpdx, at.dpdy})
    place.insert(place.end(), v.begin(), v.end());
  for (const auto& v : {at.duvdx, at.duvdy}) place.insert(place.end(), v.begin(), v.end());
  const Buffer<MaterialRecord> materials(device, std::span<const MaterialRecord>(flat.materials));
  const Buffer<float> data(device, std::span<const float>(flat.material_data));
  const Buffer<TextureRecord> textures(device, std::span<const TextureRecord>(flat.textures));
  const Buffer<float> texture_data(device, std::span<const float>(flat.texture_data));
  const Buffer<ImageRecord> images(device, std::span<const ImageRecord>(flat.images));
  const Buffer<uint> texels(device, std::span<const uint>(flat.texels));
  const Buffer<SpectrumRecord> spectra(device, std::span<const SpectrumRecord>(flat.spectra));
  const Buffer<float> tables(device, std::span<const float>(flat.spectrum_tables)),
      places(device, std::span<const float>(place));
  Buffer<float> out(device, 18);
  out.clear();
  cl::Kernel kernel = program_of(kinds).kernel("look_up");
  set_arguments(device, kernel, materials, data, textures, texture_data, images, texels, spectra,
                tables, places, cl_uint{step}, out, cl_uint{1});
  launch(device, kernel, 1, 1);
  const std::vector<float> values = out.read();
  Looked looked;
  std::copy_n(&values[0], 4, looked.reflectance.begin());
  std::copy_n(&values[4], 4, looked.eta.begin());
  std::copy_n(&values[8], 4, looked.k.begin());
  looked.alpha_u = values[12];
  looked.alpha_v = values[13];
  std::copy_n(&values[14], 4, looked.step.begin());
  return looked;
}

Looked look_up(const Scene& scene, const TextureTrial::Value& at,
               std::uint64_t kinds = every_kind) {
  return look_up(lower(scene), at, kinds);
}
Looked look_up(const Scene& scene, double u, double v, std::uint64_t kinds = every_kind) {
  return look_up(scene, TextureTrial::Value{u, v, 0}, kinds);
}

Scene scene_of(decltype(Material::model) model, std::vector<Texture> textures,
               std::vector<TexturedField> fields) {
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
    if (const auto* scale = std::get_if<ScaleTexture>(&texture.model);
        scale && scale->scale.texture)
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

/// The steps of a trial whose texture no material has: in `flat`, the number of the first.
std::uint32_t step_of(const TextureTrial& trial, FlatScene& flat) {
  Scene scene = scene_of(DiffuseMaterial{}, trial.textures, {});
  Lowering lowering(scene);
  const auto last = trial.last < 0 ? std::nullopt : std::optional(static_cast<uint>(trial.last));
  const std::uint32_t step =
      lower_texture(scene, static_cast<std::uint32_t>(trial.textures.size() - 1),
                    TextureUse::number, last, lowering.images, lowering.spectra, lowering.flat);
  flat = std::move(lowering.flat);
  return step;
}

TEST(EveryTexture, HasItsValuesAsSpectraAndAsFloats) {
  for (const TextureOnTrial& texture : textures_on_trial()) {
    const TextureTrial& trial = texture.trial;
    const bool of_metals = trial.field == "k";
    for (const bool is_float : {false, true}) {
      if ((of_metals && is_float) || !(is_float ? trial.of_floats : trial.of_spectra)) continue;
      FlatScene flat;
      std::uint32_t step = CAPLET_NONE;
      if (trial.field == "step")
        step = step_of(trial, flat);
      else
        flat = lower(scene_of(trial, is_float));
      for (const TextureTrial::Value& expected : trial.values) {
        const Looked found = look_up(flat, expected, every_kind, step);
        const double slack = trial.tolerance * std::abs(expected.value);
        const std::string where =
            fmt::format("{} {} {} {}", texture.name, expected.u, expected.v, expected.p[0]);
        if (step != CAPLET_NONE) {
          EXPECT_NEAR(found.step[0], expected.value, slack) << where;
        } else if (is_float) {
          EXPECT_NEAR(found.alpha_u, expected.value, slack) << where;
          EXPECT_EQ(found.alpha_v, 0.5f) << texture.name;
        } else {
          for (const float value : of_metals ? found.k : found.reflectance)
            EXPECT_NEAR(value, expected.value, slack) << where;
          if (of_metals) {
            EXPECT_EQ(found.eta, (std::array<float, 4>{1, 1, 1, 1}));
          }
        }
      }
    }
  }
}

// What a renderer builds for a scene's textures says what the kernels of all say; without the one
// on trial they do not.
TEST(EveryTexture, IsInTheKernelsOfItsScene) {
  for (const TextureOnTrial& texture : textures_on_trial()) {
    const TextureTrial& trial = texture.trial;
    FlatScene flat;
    std::uint32_t step = CAPLET_NONE;
    if (trial.field == "step")
      step = step_of(trial, flat);
    else
      flat = lower(scene_of(trial, trial.field != "k" && trial.of_floats));
    const std::uint64_t kinds = flat.texture_kinds(), own = std::uint64_t{1} << texture.kind;
    EXPECT_NE(kinds & own, 0u) << texture.name;
    for (const TextureTrial::Value& at : trial.values) {
      const Looked all = look_up(flat, at, every_kind, step), few = look_up(flat, at, kinds, step),
                   without = look_up(flat, at, every_kind & ~own, step);
      EXPECT_EQ(all.alpha_u, few.alpha_u) << texture.name;
      EXPECT_EQ(all.k, few.k) << texture.name;
      EXPECT_EQ(all.reflectance, few.reflectance) << texture.name;
      EXPECT_EQ(all.step, few.step) << texture.name;
      EXPECT_TRUE(without.alpha_u != all.alpha_u || without.k != all.k ||
                  without.reflectance != all.reflectance || without.step != all.step)
          << texture.name;
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
  EXPECT_EQ(look_up(scene, 0.5, 0.5).reflectance,
            look_up(scene_of(DiffuseMaterial{red}, {}, {}), 0, 0).reflectance);
  EXPECT_EQ(look_up(scene, 1.5, 0.5).reflectance,
            look_up(scene_of(DiffuseMaterial{blue}, {}, {}), 0, 0).reflectance);
  // For a metal's eta they are unbounded: 3 is 3.
  checks.tex1 = 3;
  checks.tex2 = 0.5;
  const Scene metal =
      scene_of(ConductorMaterial{ConstantSpectrum{1}, ConstantSpectrum{2}, {}, 0, 0},
               {{checks, false, "t", {}}}, {{"eta", 0}});
  EXPECT_EQ(look_up(metal, 0.5, 0.5).eta[1], 3);
  EXPECT_EQ(look_up(metal, 1.5, 0.5).eta[1], 0.5f);
  EXPECT_EQ(look_up(metal, 1.5, 0.5).k[1], 2);
}

TEST(Textures, ReflectancesEndAtOneAndRoughnessAtZero) {
  ScaleTexture twice;
  twice.tex = 0.75;
  twice.scale = 2;
  EXPECT_EQ(
      look_up(scene_of(DiffuseMaterial{}, {{twice, false, "t", {}}}, {{"reflectance", 0}}), 0, 0)
          .reflectance[2],
      1);
  twice.scale = -2;
  EXPECT_EQ(
      look_up(scene_of(DiffuseMaterial{}, {{twice, false, "t", {}}}, {{"reflectance", 0}}), 0, 0)
          .reflectance[2],
      0);
  ConductorMaterial metal{ConstantSpectrum{1}, ConstantSpectrum{1}, {}, 0.5, 0.5};
  EXPECT_EQ(look_up(scene_of(metal, {{twice, true, "t", {}}}, {{"alpha_v", 0}}), 0, 0).alpha_v,
            CAPLET_ALPHA_MIN);
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
  EXPECT_EQ(texture_steps(textures, 14),
            31u);  // the checkerboard's three, and 14 times a mix and its amount
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
  const Texture number{CheckerboardTexture{}, true, "t", {}},
      color{CheckerboardTexture{}, false, "t", {}};
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
  bad.mapping.uscale = INFINITY;
  EXPECT_THROW(scene_of(diffuse, {{bad, false, "t", {}}}, {}), InputError);
  bad = {};
  bad.tex1 = -1;
  EXPECT_THROW(scene_of(diffuse, {{bad, false, "t", {}}}, {}), InputError);
}

// --- Images ---

float number_of(const ImagemapTexture& map, const TextureTrial::Value& at) {
  const ConductorMaterial metal{ConstantSpectrum{1}, ConstantSpectrum{1}, {}, 0.5, 0.5};
  return look_up(scene_of(metal, {{map, true, "t", {}}}, {{"alpha_u", 0}}), at).alpha_u;
}
float number_of(const ImagemapTexture& map, double u, double v) {
  return number_of(map, TextureTrial::Value{u, v, 0});
}

TEST(Images, EndAsTheyAreWrapped) {
  ImagemapTexture map;
  map.image = image_of(2, 2, 1, {0.125f, 0.25f, 0.5f, 1});
  const auto at = [&](int wrap, int filter, double u, double v) {
    map.wrap = wrap;
    map.filter = filter;
    return number_of(map, u, v);
  };
  // Left of the lower row: its other end, nothing, itself, the upper row's first (over the edge of
  // an octahedron).
  EXPECT_EQ(at(CAPLET_WRAP_REPEAT, CAPLET_FILTER_POINT, -0.25, 0.25), 1);
  EXPECT_EQ(at(CAPLET_WRAP_BLACK, CAPLET_FILTER_POINT, -0.25, 0.25), CAPLET_ALPHA_MIN);
  EXPECT_EQ(at(CAPLET_WRAP_CLAMP, CAPLET_FILTER_POINT, -0.25, 0.25), 0.5f);
  EXPECT_EQ(at(CAPLET_WRAP_OCTAHEDRAL, CAPLET_FILTER_POINT, -0.25, 0.25), 0.125f);
  EXPECT_EQ(at(CAPLET_WRAP_OCTAHEDRAL, CAPLET_FILTER_POINT, 0.25, 1.25), 0.25f);
  EXPECT_EQ(at(CAPLET_WRAP_BLACK, CAPLET_FILTER_BILINEAR, 0, 0.25), 0.25f);
  EXPECT_EQ(at(CAPLET_WRAP_CLAMP, CAPLET_FILTER_BILINEAR, -3, 70), 0.125f);
  EXPECT_EQ(at(CAPLET_WRAP_CLAMP, CAPLET_FILTER_POINT, INFINITY, NAN), number_of(map, 0, 1));
}

TEST(Images, AreScaledInvertedAndOfSomeChannels) {
  ImagemapTexture map;
  map.image = image_of(1, 1, 1, {0.25f});
  map.scale = 2;
  EXPECT_EQ(number_of(map, 0.3, 0.3), 0.5f);
  map.invert = 1;
  map.scale = 3;
  EXPECT_EQ(number_of(map, 0.3, 0.3), 0.25f);
  map.scale = 5;
  EXPECT_EQ(number_of(map, 0.3, 0.3), CAPLET_ALPHA_MIN);  // not below 0
  map.invert = 0;
  map.scale = 1;
  map.image = image_of(1, 1, 3, {0.25f, 0.5f, 0.75f});
  EXPECT_EQ(number_of(map, 0, 0), 0.5f);
  map.image = image_of(1, 1, 4, {0.25f, 0.5f, 0.75f, 0.125f});
  EXPECT_EQ(number_of(map, 0, 0), 0.125f);
}

TEST(Images, OfBytesAreWhatTheyStandFor) {
  auto image = std::make_shared<TextureImage>();
  image->width = 3;  // rows of whole words are nobody's concern
  image->height = 1;
  image->channels = 3;
  image->bytes = {0, 51, 255, 255, 0, 51, 51, 255, 0};
  for (int i = 0; i < 256; ++i)
    image->decoded[static_cast<std::size_t>(i)] = static_cast<float>(i) / 510;
  // As vectors they are not resampled.
  Scene scene = scene_of(DiffuseMaterial{}, {{NormalmapTexture{image}, true, "t", {}}}, {});
  Lowering lowering(scene);
  const std::uint32_t step = lower_texture(scene, 0, TextureUse::number, {}, lowering.images,
                                           lowering.spectra, lowering.flat);
  for (int x = 0; x < 3; ++x) {
    const Looked found =
        look_up(lowering.flat, TextureTrial::Value{(x + 0.5) / 3, 0.5, 0}, every_kind, step);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found.step[static_cast<std::size_t>(c)],
                  2 * image->bytes[static_cast<std::size_t>(3 * x + c)] / 510.0 - 1, 1e-6);
  }
}

// Images of 16 bits and of halves have no more than 65,536 values: texels are their numbers, and
// what is looked up is the same to the bit.
TEST(Images, OfFewValuesAreNumbers) {
  const auto value_of = [](int i) { return 0.1f + static_cast<float>(i * 37 % 900) / 1900; };
  for (const int channels : {1, 3, 4}) {
    std::vector<float> values;
    for (int i = 0; i < 64 * 64 * channels; ++i) values.push_back(value_of(i));
    ImagemapTexture map;
    map.image = image_of(64, 64, channels, values);
    map.filter = CAPLET_FILTER_POINT;
    map.wrap = CAPLET_WRAP_CLAMP;
    const FlatScene flat = lower(scene_of(DiffuseMaterial{}, {{map, true, "t", {}}}, {}));
    const ImageRecord& image = flat.images.at(0);
    EXPECT_EQ(flat.texels[image.levels_begin + 3], CAPLET_TEXELS_NUMBERS);
    // The next level is of means, and as floats; the table has 900 values.
    EXPECT_EQ(flat.texels[image.levels_begin + 7], CAPLET_TEXELS_FLOATS);
    EXPECT_EQ(flat.texels[image.levels_begin + 4] - flat.texels[image.levels_begin],
              64u * 64u * static_cast<unsigned>(channels) / 2);
    for (const int at : {0, 1, 63, 64, 2000, 4095}) {
      const double u = (at % 64 + 0.5) / 64, v = 1 - (at / 64 + 0.5) / 64;
      const auto texel = [&](int c) { return values[static_cast<std::size_t>(at * channels + c)]; };
      const float expected = channels == 4   ? texel(3)
                             : channels == 1 ? texel(0)
                                             : (texel(0) + texel(1) + texel(2)) / 3;
      if (channels == 3)
        EXPECT_NEAR(number_of(map, u, v), expected, 1e-6) << at;
      else
        EXPECT_EQ(number_of(map, u, v), expected) << channels << " " << at;
    }
  }
  // Images with more values than would save something, and images of few texels, stay floats.
  std::vector<float> all;
  for (int i = 0; i < 64 * 64; ++i) all.push_back(static_cast<float>(i) / 5000);
  ImagemapTexture map;
  map.image = image_of(64, 64, 1, all);
  FlatScene flat = lower(scene_of(DiffuseMaterial{}, {{map, true, "t", {}}}, {}));
  EXPECT_EQ(flat.texels[flat.images.at(0).levels_begin + 3], CAPLET_TEXELS_FLOATS);
  map.image = image_of(8, 8, 1, std::vector<float>(64, 0.5f));
  flat = lower(scene_of(DiffuseMaterial{}, {{map, true, "t", {}}}, {}));
  EXPECT_EQ(flat.texels[flat.images.at(0).levels_begin + 3], CAPLET_TEXELS_FLOATS);
}

// Levels of a checkerboard of texels are grey; of sides that are no powers of two the mean stays,
// within the filter's ripple.
TEST(Images, HaveMipLevelsOfTheirMeans) {
  std::vector<float> checks;
  for (int i = 0; i < 64; ++i) checks.push_back((i / 8 + i) % 2 ? 1.f : 0.f);
  ImagemapTexture map;
  map.image = image_of(8, 8, 1, checks);
  map.filter = CAPLET_FILTER_TRILINEAR;
  TextureTrial::Value at{0.5 / 8, 0.5 / 8, 0};
  EXPECT_EQ(number_of(map, at), 1);  // the bottom row's first
  // Looks are over twice the sides: two texels, the first level, along either side and in either
  // direction; half way to it.
  for (const bool is_x : {true, false})
    for (const bool is_u : {true, false}) {
      const auto along = [&](float way) {
        at.duvdx = at.duvdy = {0, 0};
        (is_x ? at.duvdx : at.duvdy)[is_u ? 0 : 1] = way;
        return number_of(map, at);
      };
      EXPECT_EQ(along(0.125f), 0.5f);
      EXPECT_EQ(along(-0.125f), 0.5f);
      EXPECT_NEAR(along(std::sqrt(2.f) / 16), 0.75, 1e-6);
    }
  at.duvdx = {100, 0};
  EXPECT_EQ(number_of(map, at), 0.5f);
  map.image = image_of(3, 5, 1, {0, 0.5f, 1, 0, 0.5f, 1, 0, 0.5f, 1, 0, 0.5f, 1, 0, 0.5f, 1});
  EXPECT_NEAR(number_of(map, at), 0.5, 0.01);
}

// The image has stripes along t, seen from far along t alone: EWA keeps them, the others do not.
TEST(Images, EwaKeepsWhatOneSideIsNarrowEnoughFor) {
  std::vector<float> stripes;
  for (int i = 0; i < 64; ++i) stripes.push_back(i % 2 ? 1.f : 0.25f);
  ImagemapTexture map;
  map.image = image_of(8, 8, 1, stripes);
  TextureTrial::Value at{1.5 / 8, 0.5, 0};
  at.duvdy = {0, 0.5f};
  map.filter = CAPLET_FILTER_BILINEAR;
  EXPECT_EQ(number_of(map, at), 0.625f);
  map.filter = CAPLET_FILTER_EWA;
  EXPECT_EQ(number_of(map, at), 1);
  map.maxanisotropy = 1;
  EXPECT_EQ(number_of(map, at), 0.625f);
  // Looks along the longer side see what the middle does not: two bright rows of eight at one end.
  std::vector<float> rows(64, 0.f);
  std::fill_n(rows.begin(), 16, 1.f);
  map.image = image_of(8, 8, 1, rows);
  map.maxanisotropy = 8;
  EXPECT_GT(number_of(map, at), 0.05f);
  EXPECT_LT(number_of(map, at), 0.5f);
  // The same of columns, along u.
  for (int i = 0; i < 64; ++i) rows[static_cast<std::size_t>(i)] = i % 8 < 2 ? 1.f : 0.f;
  map.image = image_of(8, 8, 1, rows);
  at = {0.5, 1.5 / 8, 0};
  at.duvdx = {0.5f, 0};
  EXPECT_GT(number_of(map, at), 0.05f);
  EXPECT_LT(number_of(map, at), 0.5f);
}

// Alpha is a share whatever the colours' encoding: 0 and 255 are clear and opaque, 128 is 0.502,
// not the 0.216 of a colour. So it is in the first level, in smaller ones, and in images whose
// sides are resampled.
TEST(Images, HaveTheirAlphaAsAShare) {
  const auto rgba = [](int width, int height, const std::vector<std::uint8_t>& alpha) {
    auto image = std::make_shared<TextureImage>();
    image->width = width;
    image->height = height;
    image->channels = 4;
    for (const std::uint8_t a : alpha)
      for (const std::uint8_t byte : {std::uint8_t{200}, std::uint8_t{100}, std::uint8_t{50}, a})
        image->bytes.push_back(byte);
    for (int i = 0; i < 256; ++i) {
      const double x = i / 255.0;  // sRGB, IEC 61966-2-1
      image->decoded[static_cast<std::size_t>(i)] =
          static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
    }
    return image;
  };
  ImagemapTexture map;
  map.filter = CAPLET_FILTER_TRILINEAR;
  map.image = rgba(2, 2, {128, 64, 255, 26});
  EXPECT_NEAR(number_of(map, 0.25, 0.75), 128 / 255.0, 1e-6);
  EXPECT_NEAR(number_of(map, 0.75, 0.75), 64 / 255.0, 1e-6);
  EXPECT_NEAR(number_of(map, 0.75, 0.25), 26 / 255.0, 1e-6);
  TextureTrial::Value wide{0.5, 0.5, 0};
  wide.duvdx = {8, 0};
  EXPECT_NEAR(number_of(map, wide), (128 + 64 + 255 + 26) / 4 / 255.0,
              0.5 / 255 + 1e-6);  // rounded to a byte
  map.image = rgba(3, 1, {128, 128, 128});
  EXPECT_NEAR(number_of(map, 0.5, 0.5), 128 / 255.0, 0.5 / 255 + 1e-6);
}

TEST(Images, AreOnTheDeviceOnceForEachWrap) {
  ImagemapTexture map;
  map.image = image_of(3, 3, 1, std::vector<float>(9, 0.5f));
  std::vector<Texture> textures;
  for (const auto wrap : {CAPLET_WRAP_REPEAT, CAPLET_WRAP_CLAMP, CAPLET_WRAP_REPEAT}) {
    map.wrap = static_cast<int>(wrap);
    textures.push_back({map, true, "t", {}});
  }
  map.image = image_of(4, 4, 1, std::vector<float>(16, 0.5f));
  for (const auto wrap : {CAPLET_WRAP_REPEAT, CAPLET_WRAP_CLAMP}) {
    map.wrap = static_cast<int>(wrap);
    textures.push_back({map, true, "t", {}});
  }
  EXPECT_EQ(lower(scene_of(DiffuseMaterial{}, textures, {})).images.size(), 3u);
}

/// Reflectances of an image of one colour.
std::array<float, 4> reflectance_of(const glm::dvec3& rgb, ColorSpace space = ColorSpace::srgb) {
  auto image = std::make_shared<TextureImage>();
  image->width = image->height = 1;
  image->channels = 3;
  image->space = space;
  image->floats = {static_cast<float>(rgb.x), static_cast<float>(rgb.y), static_cast<float>(rgb.z)};
  ImagemapTexture map;
  map.image = image;
  return look_up(scene_of(DiffuseMaterial{}, {{map, false, "t", {}}}, {{"reflectance", 0}}), 0, 0)
      .reflectance;
}

// The spectrum of an image's colour is that of a constant one, but for what is between the nodes of
// a table.
TEST(Images, HaveTheSpectraOfConstants) {
  for (const glm::dvec3& rgb : std::vector<glm::dvec3>{{0.8, 0.1, 0.05},
                                                       {0.1, 0.2, 0.9},
                                                       {0.02, 0.04, 0.3},
                                                       {0.3, 0.57, 0.1},
                                                       {0.001, 0.0005, 0.002},
                                                       {0.5, 0.5, 0.5},
                                                       {0.9, 0.85, 0.8},
                                                       {0, 0, 0},
                                                       {1, 1, 1}}) {
    const auto constant =
        look_up(scene_of(DiffuseMaterial{RgbSpectrum{rgb}}, {}, {}), 0, 0).reflectance;
    const auto of_image = reflectance_of(rgb);
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(of_image[i], constant[i], 2e-3 + 5e-3 * constant[i])
          << rgb.x << ' ' << rgb.y << ' ' << rgb.z;
  }
  const glm::dvec3 green{0.1, 0.6, 0.2};
  const auto wide =
      look_up(scene_of(DiffuseMaterial{RgbSpectrum{green, ColorSpace::rec2020}}, {}, {}), 0, 0)
          .reflectance;
  const auto of_image = reflectance_of(green, ColorSpace::rec2020);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(of_image[i], wide[i], 5e-3);
  EXPECT_GT(std::abs(wide[1] - reflectance_of(green)[1]), 0.02);
}

// --- Mappings ---

TEST(Mappings, HaveTheirCoordinates) {
  // s and t of a point by a bilinear texture that is one of them.
  const auto st = [](const TextureMapping& mapping, const std::array<float, 3>& p) {
    std::array<float, 2> found;
    for (int k = 0; k < 2; ++k) {
      BilerpTexture one;
      one.v00 = 0;
      one.v10 = k == 0 ? 1 : 0;
      one.v01 = k == 1 ? 1 : 0;
      one.v11 = 1;
      one.mapping = mapping;
      FlatScene flat;
      const std::uint32_t step = step_of({{{one, true, "t", {}}}, {}, 0, "step"}, flat);
      found[static_cast<std::size_t>(k)] =
          look_up(flat, TextureTrial::Value{9, 9, 0, p}, every_kind, step).step[0];
    }
    return found;
  };
  const auto near = [](const std::array<float, 2>& found, double s, double t) {
    EXPECT_NEAR(found[0], s, 2e-6);
    EXPECT_NEAR(found[1], t, 2e-6);
  };
  TextureMapping mapping;
  mapping.kind = TextureMapping::Kind::spherical;
  near(st(mapping, {2, 0, 0}), 0.5, 0);
  near(st(mapping, {0, 3, 3}), 0.25, 0.25);
  near(st(mapping, {1, -1, 0}), 0.5, 0.875);
  near(st(mapping, {0, 0, -5}), 1, 0);
  mapping.kind = TextureMapping::Kind::cylindrical;
  near(st(mapping, {2, 0, 7}), 0.5, 7);
  near(st(mapping, {0, 3, -1}), 0.75, -1);
  near(st(mapping, {-1, -1e-9f, 0.5f}), 0, 0.5);
  mapping.kind = TextureMapping::Kind::planar;
  mapping.v1 = {0.5, 0, 0};
  mapping.v2 = {0, 0, 2};
  mapping.udelta = 0.25;
  mapping.vdelta = -1;
  near(st(mapping, {3, 4, 5}), 1.75, 9);
  mapping.texture_from_world = glm::dmat4(1);
  mapping.texture_from_world[3] = {1, 0, -2, 1};
  near(st(mapping, {3, 4, 5}), 2.25, 5);
}

// As wide as one square, about its middle, a footprint sees that square alone, as wide as two both
// as much: along each coordinate. Boards are means over twice the sides of what is seen.
TEST(Mappings, ChangeAlongTheSidesOfWhatIsSeen) {
  constexpr float pi = 3.14159265f;
  struct Side {
    TextureMapping::Kind kind;
    std::array<float, 3> p,
        one;  // where (s, t) is in the middle of a square, and the way that is one square
  };
  const std::vector<Side> sides = {
      {TextureMapping::Kind::spherical,
       {-2, 0, 0},
       {0, 0, 2 * pi}},  // half a turn from pole to pole
      {TextureMapping::Kind::spherical, {-2, 0, 0}, {0, 4 * pi, 0}},  // a turn around
      {TextureMapping::Kind::spherical, {-3, 0, 0}, {0, 0, 3 * pi}},
      {TextureMapping::Kind::cylindrical, {2, 0, 0.5f}, {0, 4 * pi, 0}},
      {TextureMapping::Kind::cylindrical, {2, 0, 0.5f}, {0, 0, 1}},
      {TextureMapping::Kind::planar, {0.5f, 0.5f, 0}, {1, 0, 7}},
      {TextureMapping::Kind::planar, {0.5f, 0.5f, 0}, {0, -1, 0}},
  };
  for (const Side& side : sides)
    for (const bool is_x : {true, false}) {
      CheckerboardTexture board;
      board.mapping.kind = side.kind;
      FlatScene flat;
      const std::uint32_t step = step_of({{{board, true, "t", {}}}, {}, 0, "step"}, flat);
      TextureTrial::Value at{0, 0, 0, side.p};
      const auto seen = [&](float share) {
        for (std::size_t k = 0; k < 3; ++k)
          (is_x ? at.dpdx : at.dpdy)[k] = 0.5f * share * side.one[k];
        return look_up(flat, at, every_kind, step).step[0];
      };
      EXPECT_NEAR(seen(0.999f), 1, 1e-5);
      EXPECT_NEAR(seen(2), 0.5, 1e-4);
      EXPECT_NEAR(seen(1.5f), 2 / 3.0,
                  1e-4);  // 1 of one square, and a quarter of each neighbour: (1 - 0.5) / 1.5
    }
}

// --- Filters ---

// Means over boxes by sums over many points.
TEST(Checkerboards, AreTheMeanOfWhatIsSeen) {
  CheckerboardTexture board;
  FlatScene flat;
  const std::uint32_t step = step_of({{{board, true, "t", {}}}, {}, 0, "step"}, flat);
  for (const auto& [u, v, w, h] : std::vector<std::array<double, 4>>{{0.3, 0.7, 0.5, 0.1},
                                                                     {0.9, 0.2, 0.5, 0},
                                                                     {0.97, 0.96, 0.3, 0.2},
                                                                     {-3.4, 7.8, 2.5, 1.25},
                                                                     {1000.25, 0.5, 7.3, 0.4},
                                                                     {0.5, 0.5, 2, 2},
                                                                     {0.5, 0.5, 1, 1}}) {
    TextureTrial::Value at{u, v, 0};
    at.duvdx = {static_cast<float>(0.5 * w), 0};
    at.duvdy = {0, static_cast<float>(0.5 * h)};
    const auto mean = [](double x, double width) {
      int odd = 0;
      for (int i = 0; i < 100'000; ++i)
        odd += static_cast<int>(std::floor(x + ((i + 0.5) / 100'000 - 0.5) * width)) & 1;
      return 1 - 2 * odd / 1e5;
    };
    EXPECT_NEAR(look_up(flat, at, every_kind, step).step[0], 0.5 + 0.5 * mean(u, w) * mean(v, h),
                2e-4)
        << u << ' ' << v;
  }
}

TEST(Checkerboards, OfSpaceAreCubes) {
  CheckerboardTexture board;
  board.mapping.kind = TextureMapping::Kind::solid;
  FlatScene flat;
  const std::uint32_t step = step_of({{{board, true, "t", {}}}, {}, 0, "step"}, flat);
  const auto at = [&](float x, float y, float z) {
    return look_up(flat, TextureTrial::Value{0, 0, 0, {x, y, z}}, every_kind, step).step[0];
  };
  EXPECT_EQ(at(0.5f, 0.5f, 0.5f), 1);
  EXPECT_EQ(at(0.5f, 0.5f, 1.5f), 0);
  EXPECT_EQ(at(0.5f, -0.5f, 1.5f), 1);
  EXPECT_EQ(at(-0.5f, -0.5f, -0.5f), 0);
}

// What is seen reaches as far as its sides on both sides of the point: along each axis by the
// longer of the two. Means over boxes by sums over many points, one axis after the other.
TEST(Checkerboards, OfSpaceAreTheMeanOfWhatIsSeen) {
  CheckerboardTexture board;
  board.mapping.kind = TextureMapping::Kind::solid;
  FlatScene flat;
  const std::uint32_t step = step_of({{{board, true, "t", {}}}, {}, 0, "step"}, flat);
  const auto mean = [](double x, double half) {
    int odd = 0;
    for (int i = 0; i < 100'000; ++i)
      odd += static_cast<int>(std::floor(x + ((i + 0.5) / 50'000 - 1) * half)) & 1;
    return 1 - 2 * odd / 1e5;
  };
  for (const auto& [p, dx, dy] : std::vector<std::array<std::array<float, 3>, 3>>{
           {{{0.3f, 0.8f, 0.1f}, {0.4f, 0, 0.3f}, {0.1f, 0.3f, 0}}},
           {{{0.5f, 0.5f, 0.9f}, {0, 0, 0.35f}, {0, 0, -0.2f}}},
           {{{-2.7f, 1.1f, 3.9f}, {-0.7f, 0.45f, 0.2f}, {0.3f, -0.8f, 0.9f}}},
           {{{0.25f, 5.75f, -0.4f}, {0, 0.35f, 0}, {0.3f, 0, 0.8f}}}}) {
    const TextureTrial::Value at{0, 0, 0, p, {0, 0, 1}, dx, dy};
    double expected = 1;
    for (std::size_t k = 0; k < 3; ++k)
      expected *= mean(double{p[k]}, std::max(std::abs(double{dx[k]}), std::abs(double{dy[k]})));
    EXPECT_NEAR(look_up(flat, at, every_kind, step).step[0], 0.5 + 0.5 * expected, 3e-4) << p[0];
  }
}

}  // namespace
}  // namespace caplet::test
