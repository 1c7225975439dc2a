// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What the schema says of statements is what their readers take: names, types, ranges and defaults.
#include "schema/schema.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "import/detail/pbrt/lights.h"
#include "import/detail/pbrt/materials.h"
#include "import/detail/pbrt/media.h"
#include "import/detail/pbrt/options.h"
#include "import/detail/pbrt/shapes.h"
#include "import/statement.h"

namespace caplet::test {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::IsEmpty, testing::Not;

const std::string no_file;

class NoImages : public ImageReader {
 public:
  EnvironmentImage read_rgb(const std::filesystem::path& path) const override {
    throw InputError({path.string()}, "not read");
  }
};

/// What the reader of a statement asks of `given`; `diagnostics` gets what it says.
std::vector<std::string> asked_of(const std::string& directive, const std::string& type,
                                  std::vector<pbrt::Parameter> given, Diagnostics& diagnostics) {
  pbrt::Parameters parameters(std::move(given), {}, directive, {}, no_file, ColorSpace::srgb,
                              diagnostics);
  const NoImages images;
  Scene scene;
  scene.materials.emplace_back();
  pbrt::LightFiles files(images);
  const pbrt::TextureTable textures;
  const pbrt::TextureImages no_image = [](pbrt::Parameters& of, const char* name,
                                          const ImageEncoding&, std::string&) {
    (void)of.has(name);
    return nullptr;
  };
  const pbrt::PartFinder no_part = [](const std::string&, std::string&) { return std::nullopt; };
  const auto no_material = [](const std::string&, const SourceLocation&) { return 0u; };
  const pbrt::ObjectLookup no_object = [](const std::string&, std::string&) {
    return pbrt::FinishedObject{};
  };
  std::optional<Medium> within;
  if (directive == "Material")
    pbrt::make_material(type, parameters, textures, no_image, no_part, scene, within);
  else if (directive == "Texture")
    pbrt::make_texture("t", type == "marble" ? "spectrum" : "float", type, parameters, textures,
                       {glm::dmat4(1), glm::dmat4(1), no_image}, scene);
  else if (directive == "LightSource")
    pbrt::make_light(type, parameters, glm::dmat4(1), files);
  else if (directive == "AreaLightSource")
    pbrt::make_area_emission(parameters, files);
  else if (directive == "MakeNamedMedium")
    pbrt::make_medium(type, {}, parameters, glm::dmat4(1));
  else if (directive == "Shape")
    pbrt::make_shape(type, parameters, 0, {textures, no_material, no_object});
  else if (directive == "Camera")
    pbrt::set_camera(type, parameters, glm::dmat4(1), scene);
  else if (directive == "Film")
    pbrt::set_film(type, parameters, ColorSpace::srgb, scene);
  else if (directive == "PixelFilter")
    pbrt::set_filter(type, parameters, scene);
  else if (directive == "Sampler")
    pbrt::set_sampler(type, parameters, scene);
  else if (directive == "Integrator")
    pbrt::set_integrator(type, parameters, scene);
  return parameters.asked();
}

/// Calls visit(directive, type) for every type of every family that is no file of another format.
void each_type(
    const std::function<void(const std::string& directive, const std::string& type)>& visit) {
  for (const std::string& family : schema::families()) {
    const std::string directive = schema::directive_of(family);
    std::vector<std::string> types = file_statement_types(directive);
    if (directive == "Shape") types = statement_types(directive);
    EXPECT_THAT(types, Not(IsEmpty())) << family;
    for (const std::string& type : types) {
      SCOPED_TRACE(directive + " \"" + type + "\"");
      visit(directive, type);
    }
  }
}

/// Names that pbrt-v4 has replaced.
bool is_older(const std::string& name) { return name == "LeScale" || name == "temperaturecutoff"; }

pbrt::Parameter given_of(const std::string& name, const std::string& type,
                         std::vector<double> numbers, std::vector<std::string> strings = {}) {
  pbrt::Parameter one;
  one.name = name;
  one.type = type;
  one.numbers = std::move(numbers);
  one.strings = std::move(strings);
  return one;
}

/// What readers ask more after.
std::vector<std::vector<pbrt::Parameter>> openings(const std::string& directive,
                                                   const std::string& type) {
  if (type == "capsule" || type == "capsules")
    return {{given_of("p0", "point3", {0, 0, 0}), given_of("p1", "point3", {0, 0, 1}),
             given_of("radius", "float", {1})}};
  if (directive == "Film")
    return {{given_of("background", "string", {}, {"color"})},
            {given_of("background", "string", {}, {"image"})}};
  return {};
}

TEST(Schema, NamesAreThoseThatReadersAskFor) {
  each_type([](const std::string& directive, const std::string& type) {
    std::set<std::string> asked, known;
    // With nothing given, with each alone, and with all: a reader asks for more where something is
    // there.
    for (std::size_t round = 0; round < 3; ++round) {
      std::vector<std::vector<pbrt::Parameter>> all = openings(directive, type);
      all.emplace(all.begin());
      if (round > 0) {
        for (const std::string& name : asked) {
          pbrt::Parameter one;
          one.name = name;
          one.broken = true;
          if (round == 1)
            all.push_back({one});
          else
            all[0].push_back(one);
        }
      }
      for (std::vector<pbrt::Parameter>& given : all) {
        Diagnostics ignored;
        try {
          for (const std::string& name : asked_of(directive, type, std::move(given), ignored))
            asked.insert(name);
        } catch (const InputError&) {  // of values that are missing
        }
      }
    }
    std::erase_if(asked, is_older);
    for (const schema::Parameter& one : schema::parameters_of(directive, type)) {
      EXPECT_TRUE(known.insert(one.name).second) << one.name << " is there twice";
      EXPECT_NE(one.doc, "") << one.name;
      EXPECT_THAT(one.types, Not(IsEmpty())) << one.name;
    }
    // What depends on the kind of a mapping is asked for by that kind alone.
    if (directive == "Texture" && asked.contains("mapping")) asked.insert({"v1", "v2"});
    // Their readers say that they are not there yet.
    if (type == "plymesh")
      std::erase_if(asked,
                    [](const std::string& name) { return name.starts_with("displacement"); });
    EXPECT_EQ(asked, known);
  });
}

/// One number of a statement.
std::string said_of(const std::string& directive, const std::string& type,
                    const schema::Parameter& parameter, double value) {
  pbrt::Parameter given;
  given.name = parameter.name;
  given.type = parameter.types[0];
  given.numbers = {value};
  Diagnostics diagnostics;
  try {
    asked_of(directive, type, {given}, diagnostics);
    diagnostics.finish();
  } catch (const InputError& error) {
    for (const std::string& message : error.messages())
      if (message.find('"' + parameter.name + '"') != std::string::npos) return message;
  }
  return {};
}

TEST(Schema, RangesAreThoseThatReadersHold) {
  int held = 0;
  each_type([&](const std::string& directive, const std::string& type) {
    for (const schema::Parameter& one : schema::parameters_of(directive, type)) {
      if (!one.has_effect || (one.types[0] != "float" && one.types[0] != "integer")) continue;
      SCOPED_TRACE(one.name);
      // Open above, or held to each other.
      if (one.name == "fov" && directive == "Camera") continue;
      if (one.name == "halffov" || one.name == "coneangle" || one.name == "conedeltaangle")
        continue;
      const auto said = [&](double value) { return said_of(directive, type, one, value); };
      // Lists of numbers say first that there are too few.
      if (!said(one.above_low            ? std::max(one.low, 0.0) + 1
                : std::isfinite(one.low) ? one.low
                                         : 1)
               .empty()) {
        EXPECT_EQ(directive, directive == "Shape"             ? "Shape"
                             : directive == "MakeNamedMedium" ? "MakeNamedMedium"
                             : directive == "Film"            ? "Film"
                                                              : "Camera");
        continue;
      }
      const double step = one.types[0] == "integer" ? 1 : 1e-6 * std::max(1.0, std::abs(one.low));
      if (std::isfinite(one.low)) {
        // A radius of 0 is nothing to see, which validation says.
        if (directive != "Shape" || one.above_low) {
          EXPECT_THAT(said(one.low - step), Not(IsEmpty()));
          EXPECT_EQ(said(one.low).empty(), !one.above_low) << said(one.low);
        }
        ++held;
      }
      if (std::isfinite(one.high) && directive != "Shape") {
        EXPECT_EQ(said(one.high), "");
        if (one.high < 2147483647) {
          EXPECT_THAT(said(one.high + std::max(step, 1e-6 * one.high)), Not(IsEmpty()));
        }
        ++held;
      }
    }
  });
  EXPECT_GT(held, 60);
}

TEST(Schema, TypesAreThoseThatReadersTake) {
  each_type([](const std::string& directive, const std::string& type) {
    for (const schema::Parameter& one : schema::parameters_of(directive, type)) {
      SCOPED_TRACE(one.name);
      pbrt::Parameter given;
      given.name = one.name;
      given.type = "point2";  // which almost nothing takes
      given.numbers = {1, 2};
      Diagnostics diagnostics;
      std::string all;
      try {
        asked_of(directive, type, {given}, diagnostics);
        diagnostics.finish();
      } catch (const InputError& error) {
        for (const std::string& message : error.messages()) all += message + "\n";
      }
      // The reader of a texture's image has its type from who reads the file.
      const bool takes = std::ranges::find(one.types, "point2") != one.types.end() ||
                         !one.has_effect || type == "imagemap";
      if (!takes) {
        EXPECT_THAT(all, HasSubstr('"' + one.name + '"'));
      }
    }
  });
}

TEST(Schema, ModelsSayWhatTheyAreMadeOf) {
  const auto find = [](const char* directive, const char* type, const std::string& name) {
    for (const schema::Parameter& one : schema::parameters_of(directive, type))
      if (one.name == name) return one;
    ADD_FAILURE() << type << " has no " << name;
    return schema::Parameter{};
  };
  EXPECT_EQ(find("Material", "conductor", "eta").fallback, "metal-Cu-eta");
  EXPECT_THAT(find("Material", "conductor", "reflectance").excludes, ElementsAre("eta", "k"));
  EXPECT_THAT(find("Material", "principled", "metallic").types, ElementsAre("float", "texture"));
  EXPECT_EQ(find("Material", "hair", "alpha").unit, "degrees");
  EXPECT_EQ(find("Material", "hair", "eumelanin").fallback, "1.3");
  EXPECT_EQ(find("Material", "subsurface", "eta").fallback, "1.33");
  EXPECT_THAT(find("Texture", "imagemap", "wrap").choices,
              ElementsAre("repeat", "black", "clamp", "octahedralsphere"));
  EXPECT_EQ(find("LightSource", "spot", "coneangle").high, 180);
  EXPECT_EQ(find("PixelFilter", "mitchell", "xradius").fallback, "2");
  EXPECT_EQ(find("Sampler", "stratified", "xsamples").fallback, "4");
  EXPECT_TRUE(find("Integrator", "ambientocclusion", "maxdistance").above_low);
  EXPECT_EQ(find("Integrator", "ambientocclusion", "maxdistance").fallback, "");
  EXPECT_FALSE(find("Integrator", "bdpt", "visualizeweights").has_effect);
  EXPECT_TRUE(find("Camera", "orthographic", "lensradius").has_effect);
  EXPECT_TRUE(find("Camera", "fisheye", "screenwindow").has_effect);
  EXPECT_FALSE(find("Camera", "fisheye", "lensradius").has_effect);
  EXPECT_FALSE(find("Camera", "spherical", "screenwindow").has_effect);
  EXPECT_FALSE(find("Camera", "spherical", "focaldistance").has_effect);
  EXPECT_TRUE(find("Camera", "spherical", "shutterclose").has_effect);
  EXPECT_THAT(find("Camera", "spherical", "mapping").choices,
              ElementsAre("equalarea", "equirectangular"));
  EXPECT_EQ(find("MakeNamedMedium", "uniformgrid", "temperature").unit, "kelvin");
  EXPECT_THAT(schema::parameters_of("Material", "chrome").size(), 2u);  // what all have
}

}  // namespace
}  // namespace caplet::test
