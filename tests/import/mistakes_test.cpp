// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is wrong with scenes of pbrt's text, in every reader of parameters: one clear line each, at
// the place that the text marks.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "import/detail/pbrt/spectrum_file.h"
#include "import/statement.h"
#include "import_text.h"
#include "support/log_of.h"

namespace caplet::test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr, testing::StartsWith;

/// The text without the mark ^, and where the mark was.
struct Marked {
  explicit Marked(std::string with) : text(std::move(with)) {
    const std::size_t at = text.find('^');
    if (at == std::string::npos) return;
    text.erase(at, 1);
    const std::string before = text.substr(0, at);
    const std::size_t line = before.rfind('\n');
    place = fmt::format("scene.pbrt:{}:{}: ", std::ranges::count(before, '\n') + 1,
                        line == std::string::npos ? at + 1 : at - line);
  }
  std::string text, place;
};

struct MarkedCase {
  const char *text, *said;
};

/// Each text has one complaint, at its mark.
void expect_complaints(std::initializer_list<MarkedCase> cases, const std::string& before = "",
                       const std::string& behind = "") {
  for (const MarkedCase& one : cases) {
    const Marked marked(before + one.text + behind);
    EXPECT_THAT(complaints(marked.text), ElementsAre(marked.place + one.said)) << one.text;
  }
}

TEST(MarkedScenes, OfValues) {
  expect_complaints(
      {{R"(Shape "disk" "bool onesided" ^maybe)",
        R"("bool onesided": expected true or false, found "maybe")"},
       {R"(Shape "disk" "string name" ^5)",
        R"("string name": expected a quoted string, found "5")"},
       {R"(Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" ^"a")",
        R"("integer indices": expected an integer, found the string "a")"},
       {R"(Shape "disk" "float radius" [1 ^[2] 3])", "a bracket within brackets"},
       {R"(Shape "disk" ^"radius" [1])", R"(expected a parameter ("type name"), found "radius")"},
       {R"(Shape "disk" ^"flot radius" 1)",
        R"(unknown parameter type "flot"; the nearest known type is "float")"},
       {R"(LightSource "point" ^"blackbody I" [3000 4000])",
        R"("blackbody I" takes 1 value, not 2)"}},
      "WorldBegin\n", "\nShape \"sphere\"");
  expect_complaints(
      {{R"(Shape "sphere" "float radius"^)", R"(the parameter "float radius" has no value)"},
       {R"(Shape "sphere" "float radius" ^])", R"(the parameter "float radius" has no value)"}},
      "WorldBegin\nShape \"sphere\"\n");
  expect_complaints(
      {{R"(["glass-BK7" 1])", R"("spectrum reflectance" mixes names and numbers)"},
       {R"(["glass-BK7" "glass-F5"])", R"("spectrum reflectance" takes one name or file, not 2)"},
       {"[400 .1 500]",
        R"("spectrum reflectance" takes pairs of wavelength and value, not 3 values)"},
       {"[400]", R"("spectrum reflectance" takes pairs of wavelength and value, not 1 value)"}},
      "WorldBegin\nMaterial \"diffuse\" ^\"spectrum reflectance\" ", "\nShape \"sphere\"");
}

TEST(MarkedScenes, OfParameters) {
  expect_complaints({{R"(Camera "perspective" ^"bool automatic" [true false])",
                      R"(Camera "perspective": "automatic" takes 1 value, not 2)"},
                     {R"(Camera "perspective" ^"vector3 view" [0 0 1 0 1 0])",
                      R"(Camera "perspective": "view" takes 1 vector, not 2)"},
                     {R"(Film "rgb" ^"string filename" ["a" "b"])",
                      R"(Film "rgb": "filename" takes 1 value, not 2)"},
                     {R"(Sampler "sobol" ^"integer pixelsamples" [1 2])",
                      R"(Sampler "sobol": "pixelsamples" takes 1 value, not 2)"}},
                    "", "\nWorldBegin\nShape \"sphere\"");
  expect_complaints(
      {{R"(LightSource "point" ^"point3 from" [0 0 0 1 1 1 2 2 2])",
        R"(LightSource "point": "from" takes 1 point, not 3)"},
       {R"(Material "diffuse" ^"spectrum reflectance" [400 .5 500 1.25])",
        R"(Material "diffuse": "reflectance" is a reflectance and has a value above 1)"},
       {R"(Material "diffuse" ^"spectrum reflectance" "glass-BK")",
        R"(Material "diffuse": "reflectance" names neither a known spectrum nor a file, "glass-BK")"
        R"(; the nearest known name is "glass-BK7")"},
       {R"(Attribute "shape" ^"float radius" -1)", R"(Shape "sphere": "radius" must be positive)"},
       {R"(Shape "trianglemesh" ^"point3 P" [0 0 0 1 0 0 0 1e19 0])",
        R"(Shape "trianglemesh": "P" is too large a number (above 1e18))"},
       {R"(Shape "trianglemesh" ^"point3 P" [0 0 0 1 0 0 0 0 -1.1e18])",
        R"(Shape "trianglemesh": "P" is too large a number (above 1e18))"},
       {R"(Shape "capsules" ^"string filename" "none.capsules")", "none.capsules: no such file"},
       {R"(Material "dielectric" ^"texture roughness" "none")",
        R"(Material "dielectric": "roughness" names an unknown texture, "none")"}},
      "WorldBegin\n", "\nShape \"sphere\"");
}

// A texture that is not rendered is named where it is used, through those that are made of it.
TEST(MarkedScenes, OfTexturesThatAreNotRendered) {
  expect_complaints(
      {{R"(Material "dielectric" ^"texture roughness" "f")",
        R"(Material "dielectric": "roughness" uses Texture "ptex" (scene.pbrt:2:1), which is not rendered yet)"},
       {R"(Texture "g" "float" "scale" "texture tex" "f"
Material "dielectric" ^"texture roughness" "g")",
        R"(Material "dielectric": "roughness" uses Texture "ptex" (scene.pbrt:2:1), which is not rendered yet)"},
       {R"(Texture "t" "spectrum" "mix" "texture tex2" "s"
Material "diffuse" ^"texture reflectance" "t")",
        R"(Material "diffuse": "reflectance" uses Texture "ptex" (scene.pbrt:3:1), which is not rendered yet)"},
       {R"(Texture "t" "spectrum" "constant" "texture value" "s"
Material "diffuse" ^"texture reflectance" "t")",
        R"(Material "diffuse": "reflectance" uses Texture "ptex" (scene.pbrt:3:1), which is not rendered yet)"}},
      "WorldBegin\nTexture \"f\" \"float\" \"ptex\" \"string filename\" \"a\"\n"
      "Texture \"s\" \"spectrum\" \"ptex\" \"string filename\" \"a\"\n",
      "\nShape \"sphere\"");
}

TEST(MarkedScenes, OfStatements) {
  expect_complaints(
      {{R"(MakeNamedMaterial "a" "string type" "diffuse"
^MakeNamedMaterial "a" "string type" "diffuse")",
        R"(the material "a" is defined twice)"},
       {R"(ObjectBegin "a" ObjectEnd
^ObjectBegin "a" ObjectEnd)",
        R"(the object "a" is defined twice (first at scene.pbrt:2:1))"},
       {"^Rotate 30 0 0 0", "Rotate has no axis"},
       {"Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ^2]",
        R"(Transform takes 16 numbers, found "2")"},
       {R"(^LightSource "distant" "point3 from" [1 2 3] "point3 to" [1 2 3])",
        R"(LightSource "distant": "from" and "to" give no direction)"},
       {R"(LightSource "infinite" ^"string preset" "studio" "rgb L" [1 1 1])",
        R"(LightSource "infinite": "preset" cannot be combined with "L")"},
       {R"(LightSource "infinite" ^"string preset" "studyo")",
        R"(LightSource "infinite": "preset" is "studyo"; the nearest known name is "studio")"}},
      "WorldBegin\n", "\nShape \"sphere\"");
  // 2^20 times 256 cells are allowed, and as many values are asked for.
  for (const bool too_many : {false, true})
    EXPECT_THAT(complaints("WorldBegin\nMakeNamedMedium \"m\" \"string type\" \"uniformgrid\" "
                           "\"integer nx\" 1024 \"integer ny\" 1024 \"integer nz\" " +
                           std::string(too_many ? "257" : "256") +
                           " \"float density\" [1]\nMediumInterface \"m\" \"\" Shape \"sphere\""),
                too_many ? testing::Matcher<std::vector<std::string>>(
                               Contains("scene.pbrt:2:1: MakeNamedMedium \"m\": the grid has more "
                                        "than 2^28 cells"))
                         : testing::Not(Contains(HasSubstr("2^28"))));
  // One error does not hide those behind it.
  EXPECT_THAT(complaints("WorldBegin\nBogus \"x\nShape \"sphere\""),
              ElementsAre(StartsWith("scene.pbrt:2:1: unknown directive \"Bogus\""),
                          "scene.pbrt:2:7: this string is not closed on its line"));
}

TEST(MarkedScenes, OfOptions) {
  expect_complaints(
      {{R"(Option "seed" [^])", R"(Option needs a value, found "]")"},
       {R"(^Option "seed" [1 2])", "Option takes one value"},
       {R"(Option "displacementedgescale" ^x)", R"(expected a number, found "x")"},
       {R"(Option "rendercoordsys" ^"sky")",
        R"(Option "rendercoordsys" must be "camera", "cameraworld" or "world", not "sky")"},
       {R"(Option "wavefront" ^3)", R"(Option "wavefront" must be true or false, not "3")"},
       {R"(Camera "perspective" ^"vector3 view" [0 0 0])",
        R"(Camera "perspective": "view" has no direction)"},
       {R"(Camera "perspective" ^"vector3 up" [0 0 0])",
        R"(Camera "perspective": "up" has no direction)"},
       {R"(Camera "perspective" ^"float clipplane" [0 0 1])",
        R"(Camera "perspective": "clipplane" takes 4 values, not 3)"},
       {R"(Camera "perspective" ^"float clipplane" [0 0 0 1])",
        R"(Camera "perspective": "clipplane" is no plane)"},
       {R"(Camera "perspective" ^"float clipplane" [1e-300 0 0 1e20])",
        R"(Camera "perspective": "clipplane" is no plane)"},
       {R"(Camera "perspective" ^"float screenwindow" [1 -1 0 1])",
        R"(Camera "perspective": "screenwindow" must be x min, x max, y min, y max with min below max)"},
       {R"(Camera "perspective" ^"float screenwindow" [-1 1 1 1])",
        R"(Camera "perspective": "screenwindow" must be x min, x max, y min, y max with min below max)"},
       {R"(Camera "perspective" ^"float fileaxes" [1 0 0])",
        R"(Camera "perspective": "fileaxes" takes 9 values, not 3)"},
       {R"(Camera "perspective" ^"float fileaxes" [0 1 0 1 0 0 0 0 1])",
        R"(Camera "perspective": "fileaxes" is no rotation)"},
       {R"(Camera "perspective" ^"float fileaxes" [1 0 0 0.1 1 0 0 0 1])",
        R"(Camera "perspective": "fileaxes" is no rotation)"},
       {R"(Camera "perspective" ^"string legend" "depth")",
        R"(Camera "perspective": "legend" needs legendcolors, or legenddirections)"},
       {R"(Camera "perspective" "string legend" "depth" ^"float legendcolors" [1 0])",
        R"(Camera "perspective": "legendcolors" is no list of colours, three numbers from 0 to 1 each)"},
       {R"(Camera "perspective" "string legend" "depth" ^"float legendcolors" [1 0 1.5])",
        R"(Camera "perspective": "legendcolors" is no list of colours, three numbers from 0 to 1 each)"},
       {R"(Camera "perspective" "string legend" "" "float legendcolors" [1 0 1] ^"float legendrange" 5)",
        R"(Camera "perspective": "legendrange" is not two finite numbers)"},
       {R"(Camera "perspective" "string legend" "" "float legendcolors" [1 0 1] ^"string legendnames" ["a" "b"])",
        R"(Camera "perspective": "legendnames" has 2 names for 1 colours)"},
       {R"(Film "rgb" "integer pixelbounds" [0 9 0 9] ^"float cropwindow" [0 1 0 1])",
        R"(Film "rgb": "cropwindow" cannot be combined with "pixelbounds")"},
       {R"(Film "rgb" ^"integer pixelbounds" [5 5 0 9])",
        R"(Film "rgb": "pixelbounds" must be x0, x1, y0, y1 of a part of the image that is not empty)"},
       {R"(Film "rgb" "integer xresolution" 100 ^"integer pixelbounds" [0 101 0 9])",
        R"(Film "rgb": "pixelbounds" must be x0, x1, y0, y1 of a part of the image that is not empty)"},
       // Both are up to pixel 51.
       {R"(Film "rgb" "integer xresolution" 100 ^"float cropwindow" [.502 .508 0 1])",
        R"(Film "rgb": "cropwindow" must be x0, x1, y0, y1 of a part of the image that is not empty)"},
       {R"(Film "rgb" ^"string background" "sky")",
        R"(Film "rgb": "background" must be "transparent", "color" or "image")"},
       {R"(Film "rgb" "string background" "color" ^"float backgroundcolor" [0 0 1.5])",
        R"(Film "rgb": "backgroundcolor" must be three numbers from 0 to 1)"},
       {R"(Sampler "stratified" ^"integer xsamples" 65536 "integer ysamples" 32768)",
        R"(Sampler "stratified": "xsamples" times "ysamples" is more than 2^31 samples a pixel)"}},
      "", "\nWorldBegin\nShape \"sphere\"");
  for (const char* sound :
       {R"(Option "displacementedgescale" 2)", R"(Option "rendercoordsys" "cameraworld")",
        R"(Option "wavefront" true)", R"(Option "seed" [7])",
        R"(Film "rgb" "integer xresolution" 100 "integer pixelbounds" [0 100 0 9])"})
    EXPECT_THAT(complaints(std::string(sound) + "\nWorldBegin\nShape \"sphere\""),
                testing::IsEmpty())
        << sound;
}

TEST(Films, HaveABackground) {
  const auto film = [](const std::string& text) {
    return scene_of("Film \"rgb\" " + text + "\nWorldBegin\nShape \"sphere\"").view.film;
  };
  EXPECT_FALSE(film("").backdrop.has_value());
  const auto image =
      film(R"("string background" "image" "string backgroundfile" "square.exr")").backdrop;
  ASSERT_TRUE(image && image->image);
  EXPECT_EQ(image->kind, Backdrop::Kind::image);
  EXPECT_EQ(image->image->height, 4);  // as StubImages has it
  const auto color =
      film(R"("string background" "color" "float backgroundcolor" [0 .5 1])").backdrop;
  ASSERT_TRUE(color);
  EXPECT_EQ(color->kind, Backdrop::Kind::color);
  EXPECT_EQ(color->color, glm::dvec3(0, .5, 1));
  const auto none = film(R"("string background" "transparent")").backdrop;
  ASSERT_TRUE(none);
  EXPECT_EQ(none->kind, Backdrop::Kind::transparent);
}

// As many attributes as no statement has parameters.
TEST(MarkedScenes, OfTooManyAttributes) {
  const auto with = [](int count, const char* last) {
    std::string text = "WorldBegin\nAttribute \"shape\"\n";
    for (int i = 1; i < count; ++i) text += fmt::format("\"float a{}\" 1\n", i);
    return text + last + "\nShape \"sphere\"";
  };
  EXPECT_THAT(complaints(with(257, "\"float b\" 1")).front(),
              "scene.pbrt:259:1: more than 256 attributes of one target");
  for (const std::string& text : {with(256, "\"float b\" 1"), with(257, "\"float a7\" 1")})
    EXPECT_THAT(complaints(text), testing::Not(Contains(HasSubstr("more than 256"))));
}

TEST(Spectra, OfFilesAreCheckedWithTheirPlaces) {
  const auto said = [](const std::string& text) {
    return complaint_of([&] { pbrt::parse_spectrum_text("s.spd", text); });
  };
  EXPECT_EQ(said("400 1\n-500 2\n"), "s.spd:2:1: a wavelength must be positive");
  EXPECT_EQ(said("0 1\n"), "s.spd:1:1: a wavelength must be positive");
  EXPECT_EQ(said("400 1\n500 2 500 3\n"), "s.spd:2:7: wavelengths must ascend");
  EXPECT_EQ(said("400 1\n 500\n"), "s.spd:2:2: this wavelength has no value");
  EXPECT_EQ(said("# nothing\n"), "s.spd: the spectrum file is empty");
  const SampledSpectrum sound = pbrt::parse_spectrum_text("s.spd", "400 1 # one\n500.5 2");
  EXPECT_EQ(sound.wavelengths, (std::vector<double>{400, 500.5}));
  EXPECT_EQ(sound.values, (std::vector<double>{1, 2}));
}

// Constants alone are folded: of two spectra of the same wavelengths, or of numbers and colours.
TEST(Textures, OfConstantSpectraAreConstant) {
  const Scene scene = world_of(R"(
Texture "a" "spectrum" "constant" "spectrum value" [400 .25 500 .5]
Texture "b" "spectrum" "constant" "spectrum value" [400 .75 500 1]
Texture "c" "spectrum" "constant" "spectrum value" [400 .75 600 1]
Texture "grey" "spectrum" "constant" "float value" .5
Texture "red" "spectrum" "constant" "rgb value" [1 0 .25]
Texture "half" "spectrum" "scale" "texture tex" "a" "float scale" .5
Texture "ab" "spectrum" "mix" "texture tex1" "a" "texture tex2" "b" "float amount" .25
Texture "pale" "spectrum" "mix" "texture tex1" "grey" "texture tex2" "red" "float amount" .25
Texture "ac" "spectrum" "mix" "texture tex1" "a" "texture tex2" "c" "float amount" .25
Texture "ar" "spectrum" "mix" "texture tex1" "a" "texture tex2" "red" "float amount" .25
Material "diffuse" "texture reflectance" "half" Shape "sphere"
Material "diffuse" "texture reflectance" "ab" Shape "sphere"
Material "diffuse" "texture reflectance" "pale" Shape "sphere"
Material "diffuse" "texture reflectance" "ac" Shape "sphere"
Material "diffuse" "texture reflectance" "ar" Shape "sphere"
)");
  const auto material = [&](std::size_t i) -> const Material& {
    return scene.materials.at(scene.shapes.at(i).material);
  };
  const auto sampled = [&](std::size_t i) {
    return std::get<SampledSpectrum>(std::get<DiffuseMaterial>(material(i).model).reflectance);
  };
  EXPECT_EQ(sampled(0).wavelengths, (std::vector<double>{400, 500}));
  EXPECT_EQ(sampled(0).values, (std::vector<double>{.125, .25}));
  EXPECT_EQ(sampled(1).wavelengths, (std::vector<double>{400, 500}));
  EXPECT_EQ(sampled(1).values, (std::vector<double>{.375, .625}));
  EXPECT_EQ(std::get<RgbSpectrum>(std::get<DiffuseMaterial>(material(2).model).reflectance).rgb,
            glm::dvec3(.625, .375, .4375));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(material(i).textures.empty()) << i;
  // What cannot be one constant is a texture.
  for (std::size_t i = 3; i < 5; ++i) EXPECT_EQ(material(i).textures.size(), 1U) << i;
}

TEST(Textures, HaveADirection) {
  const Scene scene = world_of(R"(
Rotate 90 0 0 1
Texture "d" "spectrum" "directionmix" "vector3 dir" [3 0 0]
Material "diffuse" "texture reflectance" "d" Shape "sphere"
)");
  const auto& mix = std::get<DirectionmixTexture>(scene.textures.at(0).model);
  EXPECT_LT(glm::length(mix.dir - glm::dvec3(0, 1, 0)), 1e-12);
  expect_complaints({{R"(Texture "d" "spectrum" "directionmix" ^"vector3 dir" [0 0 0])",
                      R"(Texture "d": "dir" is no direction)"}},
                    "WorldBegin\n",
                    "\nMaterial \"diffuse\" \"texture reflectance\" \"d\" Shape \"sphere\"");
}

TEST(ProgramStatements, OfMaterials) {
  const Scene scene = world_of(
      "Texture \"t\" \"float\" \"checkerboard\"\nTexture \"c\" \"spectrum\" \"checkerboard\"\n"
      "Material \"dielectric\" \"texture uroughness\" \"t\" \"bool remaproughness\" false "
      "Shape \"sphere\"\nMaterial \"diffuse\" \"texture reflectance\" \"c\" Shape \"sphere\"\n");
  const Material rough = material_of(
      {"Material", "dielectric", {{"alpha_u", "texture", {}, {"0"}}, {"alpha_v", "", {.5}}}},
      scene);
  ASSERT_EQ(rough.textures.size(), 1U);
  EXPECT_EQ(rough.textures[0].field, "alpha_u");
  EXPECT_EQ(rough.textures[0].texture, 0U);
  EXPECT_EQ(std::get<DielectricMaterial>(rough.model).alpha_v, .5);
  const Material plain =
      material_of({"Material", "diffuse", {{"reflectance", "", {.25, .5, .75}}}}, scene);
  EXPECT_EQ(std::get<RgbSpectrum>(std::get<DiffuseMaterial>(plain.model).reflectance).rgb,
            glm::dvec3(.25, .5, .75));
  // A texture says that it is one.
  EXPECT_THAT(complaint_of([&] {
                material_of({"Material",
                             "dielectric",
                             {{"alpha_u", "texture", {}, {"0"}}, {"alpha_v", "", {}, {"0"}}}},
                            scene);
              }),
              HasSubstr("\"alpha_v\" takes no texture other than constants here"));
  // The root of the texture would be another texture.
  EXPECT_THAT(
      complaint_of([&] {
        material_of({"Material", "dielectric", {{"roughness", "texture", {}, {"0"}}}}, scene);
      }),
      HasSubstr("takes textures as \"alpha_u\", \"alpha_v\" and \"sigma_a\" alone"));
  EXPECT_THAT(complaint_of([&] {
                material_of({"Material", "diffuse", {{"reflectence", "", {.25}}}}, scene);
              }),
              HasSubstr("unknown parameter \"reflectence\""));
}

TEST(ProgramStatements, OfTextures) {
  const Scene scene = world_of("Shape \"sphere\"");
  const StubImages images;
  const auto texture = [&](const std::string& type, std::vector<StatementParameter> parameters,
                           bool is_float = false,
                           const std::shared_ptr<const TextureImage>& pixels = nullptr) {
    return texture_of({"Texture", type, std::move(parameters)}, is_float, glm::dmat4(1), pixels,
                      scene, images);
  };
  const auto said = [&](const std::string& type, const std::vector<StatementParameter>& parameters,
                        const std::shared_ptr<const TextureImage>& pixels = nullptr) {
    return complaint_of([&] { texture(type, parameters, false, pixels); });
  };
  const Texture scale = texture("scale", {{"tex", "", {.5}}, {"scale", "", {.25}}}, true);
  EXPECT_TRUE(scale.is_float);
  EXPECT_EQ(std::get<ConstantSpectrum>(std::get<ScaleTexture>(scale.model).scale.value).value, .25);
  const auto pixels = std::make_shared<const TextureImage>();
  EXPECT_EQ(std::get<NormalmapTexture>(texture("normalmap", {}, false, pixels).model).image,
            pixels);
  const Texture read = texture("normalmap", {{"filename", "", {}, {"n.png"}}});
  EXPECT_FALSE(read.is_float);
  EXPECT_EQ(std::get<NormalmapTexture>(read.model).image->width, 4);
  EXPECT_THAT(said("imagemap", {}), HasSubstr("there is no filename"));
  EXPECT_THAT(said("imagemap", {{"filename", "", {}, {"broken.png"}}}),
              HasSubstr("broken.png: broken image"));
  EXPECT_THAT(said("imagemap", {{"filename", "", {}, {"a.png"}}}, pixels),
              HasSubstr("pixels take neither a filename nor an encoding"));
  EXPECT_THAT(said("scale", {{"scal", "", {.5}}}), HasSubstr("unknown parameter \"scal\""));
}

// Values without a type are of the type that is asked for, where they suit it.
TEST(ProgramStatements, WholeNumbersAreIntegers) {
  Scene scene;
  const auto set = [&](double samples) {
    set_option({"Sampler", "sobol", {{"pixelsamples", "", {samples}}}}, glm::dmat4(1), scene);
    return scene.view.sampler.samples_per_pixel;
  };
  EXPECT_EQ(set(8), 8);
  EXPECT_EQ(set(16777217), 16777217);  // no float has it
  EXPECT_THAT(complaint_of([&] { set(1.5); }),
              HasSubstr("\"pixelsamples\" must be a whole number, not 1.5"));
  EXPECT_THAT(complaint_of([&] { set(4e9); }),
              HasSubstr("\"pixelsamples\" must be of type integer, not 1 number"));
}

const std::string kCylinder =
    "Shape \"cylinder\" \"point3 p0\" [0 0 0] \"point3 p1\" [0 0 1] \"float radius\" 1 ";

TEST(MarkedScenes, OfSurfacesOfSeveralMaterials) {
  const std::string parts =
      "WorldBegin\nMakeNamedMaterial \"paint\" \"string type\" \"diffuse\"\n"
      "MakeNamedMaterial \"gone\" \"string type\" \"interface\"\n"
      "MakeNamedMaterial \"wax\" \"string type\" \"subsurface\"\n"
      "MakeNamedMaterial \"lace\" \"string type\" \"mix\" \"string materials\" [\"paint\" "
      "\"gone\"]\n";
  expect_complaints({{R"("string materials" ["lace" "paint" "paint"])",
                      "all of a shape has one material where one is a mix with an interface"},
                     {R"("string materials" ["paint" "paint" "lace"])",
                      "all of a shape has one material where one is a mix with an interface"},
                     {R"("string materials" ["wax" "paint" "paint"])",
                      R"(all of a shape has one material where one is a "subsurface")"},
                     {R"("string materials" ["paint" "wax" "wax"])",
                      R"(all of a shape has one material where one is a "subsurface")"}},
                    parts + "^" + kCylinder);
  for (const char* sound : {"lace", "wax"})
    EXPECT_THAT(complaints(parts + kCylinder +
                           fmt::format("\"string materials\" [\"{0}\" \"{0}\" \"{0}\"]", sound)),
                testing::IsEmpty())
        << sound;
}

TEST(Interfaces, DoNotShine) {
  LogOf log;
  const Scene scene = world_of(
      "Material \"diffuse\" Shape \"sphere\"\nMaterial \"interface\"\n"
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n Shape \"disk\"\n");
  EXPECT_EQ(scene.shapes.size(), 1U);
  EXPECT_THAT(
      log.text(),
      HasSubstr("scene.pbrt:6:2: the shape emits nothing, as its material is \"interface\""));
}

TEST(Unused, WrongMaterialsAreOneWarning) {
  const std::string first =
      "Material \"diffuse\" Shape \"sphere\"\nMakeNamedMaterial \"a\" \"string type\" \"diffuse\" "
      "\"rgb reflectance\" [2 2 2]\n";
  const std::string said =
      "scene.pbrt:4:47: MakeNamedMaterial \"a\": \"reflectance\" is a "
      "reflectance and has a component above 1 (no shape has this material";
  {
    LogOf log;
    world_of(first);
    EXPECT_THAT(log.text(), HasSubstr(said + ")"));
  }
  LogOf log;
  world_of(first + "MakeNamedMaterial \"b\" \"string type\" \"diffuse\" \"float reflectance\" 2\n");
  EXPECT_THAT(log.text(), HasSubstr(said + ", nor 1 others that are wrong)"));
}

TEST(Subsurface, OfSpectraThatAreNoColours) {
  expect_complaints(
      {{R"(^"rgb reflectance" [.5 .5 .5] "spectrum mfp" [400 1 700 2])",
        R"(Material "subsurface": "reflectance" and "mfp" must be colours or numbers, and the latter positive)"},
       {R"(^"rgb reflectance" [.5 .5 .5] "rgb mfp" [1 0 1])",
        R"(Material "subsurface": "reflectance" and "mfp" must be colours or numbers, and the latter positive)"},
       {R"(^"spectrum reflectance" [400 .5 700 .25])",
        R"(Material "subsurface": "reflectance" and "mfp" must be colours or numbers, and the latter positive)"},
       {R"(^"rgb reflectance" [.5 .5 .5] "spectrum eta" "glass-BK7")",
        R"(Material "subsurface": "reflectance" needs an "eta" that is a number)"}},
      "WorldBegin\nMaterial \"subsurface\" ", "\nShape \"sphere\"");
}

// A grey image has one mean for the three, a mix that of its parts.
TEST(Subsurface, MeansOfGreyImagesAndMixes) {
  const auto grey = temporary_folder() / "grey.png";
  write_file(grey, "");
  const auto absorption = [&](const std::string& reflectance) {
    const Scene scene = world_of(
        "Texture \"grey\" \"spectrum\" \"imagemap\" \"string encoding\" \"linear\" \"string "
        "filename\" \"" +
        grey.string() +
        "\"\nTexture \"board\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.2 .4 .6] \"rgb tex2\" "
        "[.4 .4 .2]\nTexture \"mix\" \"spectrum\" \"mix\" \"texture tex1\" \"board\" \"rgb tex2\" "
        "[.7 .8 .1] \"float amount\" .25\nMaterial \"subsurface\" \"rgb mfp\" [.1 .2 .3] " +
        reflectance + "\nShape \"sphere\"");
    return std::get<RgbSpectrum>(
               std::get<HomogeneousMedium>(scene.media.at(0).model).scattering.sigma_a)
        .rgb;
  };
  // The image has k / 64, k from 0 to 15: 7.5 / 64 at the mean.
  EXPECT_LT(glm::length(absorption("\"texture reflectance\" \"grey\"") -
                        absorption("\"rgb reflectance\" [.1171875 .1171875 .1171875]")),
            1e-4);
  EXPECT_LT(glm::length(absorption("\"texture reflectance\" \"mix\"") -
                        absorption("\"rgb reflectance\" [.4 .5 .325]")),
            1e-9);
}

// Files within each other: at most 64, with that of the scene.
TEST(Includes, AreNotTooDeep) {
  const std::filesystem::path folder = temporary_folder();
  for (int i = 0; i <= 64; ++i)
    write_file(folder / fmt::format("{}.pbrt", i),
               (i == 0 ? "WorldBegin\nShape \"sphere\"\n" : "\n\n") +
                   fmt::format("Include \"{}.pbrt\"\n", i + 1));
  const auto said = [&] {
    return complaint_of([&] { import_scene(folder / "0.pbrt", StubImages()); });
  };
  EXPECT_EQ(said(), (folder / "63.pbrt").string() + ":3:9: more than 64 files within each other");
  write_file(folder / "63.pbrt", "Shape \"sphere\"\n");
  EXPECT_EQ(said(), "");
}

// The same 4 MiB, of which 65 more than the first are above 256 MiB.
TEST(Includes, AreNotReadOverAndOver) {
  const std::filesystem::path folder = temporary_folder();
  std::string comment = "Shape \"sphere\"\n#";
  comment.resize(std::size_t{1} << 22, ' ');
  write_file(folder / "large.pbrt", comment);
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 70; ++i) text += "Include \"large.pbrt\"\n";
  write_file(folder / "main.pbrt", text);
  EXPECT_EQ(complaint_of([&] { import_scene(folder / "main.pbrt", StubImages()); }),
            (folder / "main.pbrt").string() +
                ":67:9: the same files are included over and over: more than 256 MiB of text that "
                "was read before");
}

}  // namespace
}  // namespace caplet::test
