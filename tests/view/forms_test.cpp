// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Forms: every field of every row of the lists, set, refused and taken back; parts that come and
// go; what is hidden. Against the same scenes as text.
#include "view/forms.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "export/export.h"
#include "lower/lower.h"
#include "render/renderer.h"
#include "render_scene.h"
#include "support/test_device.h"
#include "view/editor.h"

namespace caplet::view::forms_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Kind = FormSubject::Kind;

std::string scene_text_with(const std::string& material, const std::string& more = "",
                            const std::string& light = "") {
  return fmt::format(R"(
Integrator "path" "integer maxdepth" [ 3 ]
LookAt 4 -5 3  0 0 0.3  0 0 1
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.45 0.5 ]
{}
Texture "noise" "float" "fbm"
Texture "board" "spectrum" "checkerboard" "rgb tex1" [ 0.8 0.2 0.1 ] "rgb tex2" [ 0.1 0.2 0.8 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.7 0.1 0.1 ]
MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
MakeNamedMaterial "it" {}
MakeNamedMaterial "boarded" "string type" "diffuse" "texture reflectance" [ "board" ]
MakeNamedMaterial "rough" "string type" "conductor" "texture roughness" [ "noise" ] "bool remaproughness" false
NamedMaterial "red"
Shape "disk" "float radius" [ 6 ] "float height" [ -0.8 ]
NamedMaterial "it"
Shape "sphere" "float radius" [ 0.8 ]
NamedMaterial "white"
Shape "box" "point3 p0" [ 1 1 -0.8 ] "point3 p1" [ 2 2 0.5 ]
NamedMaterial "boarded"
Shape "sphere" "float radius" [ 0.1 ]
NamedMaterial "rough"
Shape "sphere" "float radius" [ 0.15 ]
{}
)",
                     light, material, more);
}

constexpr std::uint32_t it = 2, ball = 1;  // the material, and the thing that has it
const std::string plain = R"("string type" "diffuse")";

Scene scene_with(const std::string& material, const std::string& more = "",
                 const std::string& light = "") {
  return test::scene_of_text(scene_text_with(material, more, light));
}

std::vector<std::uint64_t> picture_of(const FlatScene& flat, const FlatView& view) {
  DeviceScene scene(test::test_device(), flat);
  Renderer renderer(scene, view);
  renderer.pass(renderer.layout().window, 0, 1, {});
  const Film film = renderer.film().read();
  return {film.words().begin(), film.words().end()};
}
std::vector<std::uint64_t> picture_of(const LiveScene& live) {
  return picture_of(live.flat(), live.view());
}
std::vector<std::uint64_t> picture_of(const Scene& scene) {
  return picture_of(lower(scene), lower_view(scene));
}

/// As it is kept, without where its statements stood.
std::string text_of(const Scene& scene) {
  std::string out;
  write_pbrt(scene, std::filesystem::temp_directory_path(),
             [&](std::string_view piece) { out += piece; });
  return out;
}

Json field_of(const LiveScene& live, const View& view, const FormSubject& part,
              const std::string& name) {
  const Json form = form_text(live.scene(), view, part);
  for (const Json& field : form["fields"])
    if (field["name"] == name) return field;
  return nullptr;
}

std::vector<std::string> kinds_of(const char* list) {
  return lists_text()[list].get<std::vector<std::string>>();
}

/// A value that the field may have, which it has not now; none where it is not to be set.
std::optional<Value> another(const Json& field) {
  const std::string type = field["type"];
  const double low = field.value("low", -1000.0), high = field.value("high", 1000.0);
  if (type == "number") {
    const double now = field["value"];
    for (const double share : {0.3, 0.6})
      if (const double to =
              std::round(1e4 * (std::max(low, -8.0) +
                                share * (std::min(high, 8.0) - std::max(low, -8.0)))) /
              1e4;
          to != now)
        return to;
  }
  if (type == "whole") return field["value"].get<double>() == low + 2 ? low + 3 : low + 2;
  if (type == "flag") return !field["value"].get<bool>();
  if (type == "text") return std::string("another name");
  if (type == "option") return 3.5;
  if (type == "point") return std::vector<double>{0.25, -0.5, 2};
  if (type == "direction") return std::vector<double>{0, 3, -4};
  if (type == "spectrum")
    return Value(std::in_place_type<Spectrum>, RgbSpectrum{{0.25, 0.5, 0.75}, ColorSpace::srgb});
  if (type == "choice" && field["name"] != "kind")
    for (const Json& option : field["options"])
      if (option != field["value"]) return option.get<std::string>();
  return {};
}

/// What no field of the type may be.
std::vector<Value> bad(const Json& field) {
  const std::string type = field["type"];
  std::vector<Value> out{std::vector<double>{1, 2}, std::string("nonsense\n"), TextureChoice{99}};
  if (type != "flag") out.emplace_back(true);
  if (field.contains("low")) out.emplace_back(field["low"].get<double>() - 1);
  if (field.contains("high") && type != "spectrum")
    out.emplace_back(field["high"].get<double>() + 1);
  if (type == "spectrum")
    out.emplace_back(std::in_place_type<Spectrum>, RgbSpectrum{{0.5, -1, 0}, ColorSpace::srgb});
  if (type == "spectrum" && field.contains("high"))
    out.emplace_back(std::in_place_type<Spectrum>, ConstantSpectrum{1.5});
  if (type == "option") out.emplace_back(0.0);
  if (type == "direction") out.emplace_back(std::vector<double>{0, 0, 0});
  return out;
}

/// Sets each field that the part's form has, takes it back, and tries what is wrong.
void try_form(LiveScene& live, Editor& editor, const FormSubject& part) {
  const std::string before = text_of(editor.document());
  const Json form = form_text(live.scene(), editor.view(), part);
  ASSERT_FALSE(form.is_null());
  for (const Json& field : form["fields"]) {
    const std::string name = field["name"];
    SCOPED_TRACE(name);
    for (const Value& wrong : bad(field)) {
      EXPECT_THAT(
          [&] {
            editor.make(Set{part, name, wrong});
          },
          ThrowsMessage<InputError>(HasSubstr(name)))
          << wrong.index();
      EXPECT_FALSE(editor.can_undo());
    }
    EXPECT_EQ(text_of(editor.document()), before);
    const std::optional<Value> to = another(field);
    if (!to) continue;
    editor.make(Set{part, name, *to});
    const Json now = field_of(live, editor.view(), part, name);
    EXPECT_NE(now["value"], field["value"]);
    if (const auto* number = std::get_if<double>(&*to)) {
      EXPECT_NEAR(now["value"].get<double>(), *number, 1e-9);
    }
    EXPECT_NE(text_of(editor.document()), before);
    EXPECT_TRUE(editor.undo());
    EXPECT_EQ(text_of(editor.document()), before);
  }
}

TEST(Forms, SetEveryFieldOfEveryMaterial) {
  std::set<std::string> seen;
  for (const std::string& kind : kinds_of("material")) {
    SCOPED_TRACE(kind);
    LiveScene live(scene_with(plain));
    {
      Editor editor(live);
      if (kind != "diffuse") editor.make(Set{{Kind::material, it}, "kind", kind});
    }
    Editor editor(live);
    EXPECT_EQ(field_of(live, editor.view(), {Kind::material, it}, "kind")["value"], kind);
    try_form(live, editor, {Kind::material, it});
    seen.insert(kind);
  }
  for (const char* kind :
       {"diffuse", "conductor", "dielectric", "mix", "hair", "principled", "coateddiffuse"})
    EXPECT_TRUE(seen.contains(kind)) << kind;
  LiveScene live(scene_with(plain));
  Editor editor(live);
  EXPECT_THROW(editor.make(Set{{Kind::material, it}, "kind", std::string("interface")}),
               InputError);
}

// What pbrt's documentation says a material of the kind is when nothing more is said.
TEST(Forms, NewMaterialsAreWhatFilesHaveWithoutParameters) {
  for (const std::string& kind : kinds_of("material")) {
    if (kind == "mix") continue;  // has to name its parts
    SCOPED_TRACE(kind);
    LiveScene live(scene_with(plain));
    Editor editor(live);
    editor.make(Add{Kind::material, kind});
    ASSERT_EQ(editor.made(), std::vector<std::uint32_t>{
                                 static_cast<std::uint32_t>(live.scene().materials.size() - 1)});
    const Scene fresh = scene_with(fmt::format(R"("string type" "{}")", kind));
    const FormSubject made{Kind::material, editor.made()[0]}, theirs{Kind::material, it};
    const Json mine = form_text(live.scene(), editor.view(), made)["fields"];
    const Json file = form_text(fresh, editor.view(), theirs)["fields"];
    ASSERT_EQ(mine.size(), file.size());
    for (std::size_t i = 1; i < mine.size(); ++i) EXPECT_EQ(mine[i], file[i]);  // 0: the name
  }
}

TEST(Forms, GiveThePictureOfTheSceneAsText) {
  struct Case {
    const char* from;
    Set set;
    const char* to;
  };
  const auto spectrum = [](Spectrum value) {
    return Value(std::in_place_type<Spectrum>, std::move(value));
  };
  const FormSubject part{Kind::material, it};
  const std::vector<Case> cases{
      {R"("string type" "diffuse")",
       {part, "reflectance", spectrum(RgbSpectrum{{0.2, 0.6, 0.3}, ColorSpace::srgb})},
       R"("string type" "diffuse" "rgb reflectance" [ 0.2 0.6 0.3 ])"},
      {R"("string type" "diffuse")",
       {part, "reflectance", TextureChoice{1}},
       R"("string type" "diffuse" "texture reflectance" [ "board" ])"},
      {R"("string type" "diffuse" "texture reflectance" [ "board" ])",
       {part, "reflectance", spectrum(ConstantSpectrum{0.25})},
       R"("string type" "diffuse" "spectrum reflectance" [ 400 0.25 700 0.25 ])"},
      {R"("string type" "diffuse")",
       {part, "kind", std::string("dielectric")},
       R"("string type" "dielectric")"},
      {R"("string type" "dielectric")",
       {part, "eta", spectrum(*named_spectrum("glass-BK7"))},
       R"("string type" "dielectric" "spectrum eta" [ "glass-BK7" ])"},
      {R"("string type" "conductor")",
       {part, "alpha_u", 0.25},
       R"("string type" "conductor" "float uroughness" [ 0.25 ] "bool remaproughness" false)"},
      {R"("string type" "conductor")",
       {part, "metal", std::string("reflectance")},
       R"("string type" "conductor" "float reflectance" [ 0.5 ])"},
      {R"("string type" "conductor")",
       {part, "k", spectrum(*named_spectrum("metal-Ag-k"))},
       R"("string type" "conductor" "spectrum k" [ "metal-Ag-k" ])"},
      {R"("string type" "principled")",
       {part, "metallic", 0.75},
       R"("string type" "principled" "float metallic" [ 0.75 ])"},
      {R"("string type" "coateddiffuse")",
       {part, "thickness", 0.5},
       R"("string type" "coateddiffuse" "float thickness" [ 0.5 ])"},
      {R"("string type" "mix" "string materials" [ "red" "white" ])",
       {part, "amount", 0.25},
       R"("string type" "mix" "string materials" [ "red" "white" ] "float amount" [ 0.25 ])"},
      {R"("string type" "diffuse")",
       {part, "displacement", TextureChoice{0}},
       R"("string type" "diffuse" "texture displacement" [ "noise" ])"},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.to);
    LiveScene live(scene_with(one.from));
    Editor editor(live);
    const auto first = picture_of(live);
    // By the text's own numbers.
    std::size_t found = 0;
    Set set = one.set;
    if (auto* choice = std::get_if<TextureChoice>(&set.to)) {
      const std::string wanted = choice->texture == 1 ? "board" : "noise";
      while (live.scene().textures[found].name != wanted) ++found;
      choice->texture = static_cast<std::uint32_t>(found);
    }
    editor.make(set);
    EXPECT_TRUE(picture_of(live) == picture_of(scene_with(one.to)));
    EXPECT_FALSE(picture_of(live) == first);
    EXPECT_TRUE(editor.undo());
    EXPECT_TRUE(picture_of(live) == first);
  }
}

TEST(Forms, SetEveryFieldOfLightsTexturesShapesAndSettings) {
  for (const std::string& kind : kinds_of("light")) {
    SCOPED_TRACE(kind);
    LiveScene live(scene_with(plain));
    {
      Editor editor(live);
      editor.make(Add{Kind::light, kind, {}, {1, 2, 3}, {0, 0, -1}, 2});
      ASSERT_EQ(editor.made(), std::vector<std::uint32_t>{1});
    }
    Editor editor(live);
    try_form(live, editor, {Kind::light, 1});
  }
  for (const std::string& kind : kinds_of("texture")) {
    SCOPED_TRACE(kind);
    LiveScene live(scene_with(plain));
    std::uint32_t made = 0;
    {
      Editor editor(live);
      editor.make(Add{Kind::texture, kind});
      made = editor.made().at(0);
      editor.make(Set{{Kind::material, it},
                      live.scene().textures[made].is_float ? "displacement" : "reflectance",
                      TextureChoice{made}});
    }
    Editor editor(live);
    try_form(live, editor, {Kind::texture, made});
  }
  LiveScene live(scene_with(plain, R"(AreaLightSource "diffuse" "rgb L" [ 3 3 3 ]
Shape "cylinder" "point3 p0" [ 0 0 1 ] "point3 p1" [ 0 1 1 ] "float radius" [ 0.2 ])"));
  const auto lamp = static_cast<std::uint32_t>(live.scene().shapes.size() - 1);
  {
    Editor editor(live);
    for (const Kind kind :
         {Kind::camera, Kind::film, Kind::filter, Kind::sampler, Kind::integrator})
      try_form(live, editor, {kind});
    try_form(live, editor, {Kind::emission, lamp});
    try_form(live, editor, {Kind::emission, ball});
  }
  for (const std::string& kind : kinds_of("shape")) {
    SCOPED_TRACE(kind);
    LiveScene other(scene_with(plain));
    std::uint32_t made = 0;
    {
      Editor editor(other);
      editor.make(Add{Kind::shape, kind, {}, {1, 2, 3}, {}, 0.5, 1});
      made = editor.made().at(0);
    }
    const Bounds bounds = bounds_of(other.scene().shapes[made]);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR((bounds.min[i] + bounds.max[i]) / 2, i + 1, 1e-6);
    EXPECT_NEAR(std::max({bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y,
                          bounds.max.z - bounds.min.z}),
                1, 1e-6);
    EXPECT_EQ(other.scene().shapes[made].material, 1u);
    EXPECT_TRUE(picture_of(other) == picture_of(other.scene()));
  }
}

TEST(Forms, KeepTheSettingsOfTheDocumentApartFromWhatIsLookedAt) {
  LiveScene live(scene_with(plain));
  Editor editor(live);
  View looked = live.scene().view;
  looked.film.width = 100;
  looked.camera.projection = PerspectiveProjection{0.5};
  live.edit(looked);
  editor.make(Set{{Kind::film}, "xresolution", 77.0});
  editor.make(Set{{Kind::film}, "iso", 200.0});
  editor.make(Set{{Kind::filter}, "kind", std::string("box")});
  editor.make(Set{{Kind::integrator}, "maxdepth", 10000.0});
  EXPECT_THROW(editor.make(Set{{Kind::integrator}, "maxdepth", 10001.0}), InputError);
  EXPECT_THROW(editor.make(Set{{Kind::sampler}, "pixelsamples", 16777217.0}), InputError);
  ASSERT_TRUE(editor.undo());
  editor.make(Set{{Kind::integrator}, "maxdepth", 9.0});
  const Scene kept = editor.document();
  EXPECT_EQ(kept.view.film.width, 77);
  EXPECT_EQ(kept.view.film.height, 24);
  EXPECT_NEAR(fov_of(kept.view.camera), 40 * 3.14159265358979 / 180, 1e-12);
  EXPECT_EQ(kept.view.film.iso, 200);
  EXPECT_EQ(kept.view.filter.kind, PixelFilter::Kind::box);
  EXPECT_EQ(kept.view.filter.radius_x, 0.5);
  EXPECT_EQ(live.scene().view.film.iso, 200);
  EXPECT_EQ(live.scene().view.integrator.max_depth, 9);
  while (editor.undo()) {
  }
  EXPECT_EQ(editor.document().view.film.width, 32);
  EXPECT_EQ(live.scene().view.integrator.max_depth, 3);
}

TEST(Forms, SetTheCameraOfTheDocument) {
  LiveScene live(scene_with(plain));
  Editor editor(live);
  const FormSubject camera{Kind::camera};
  const std::string before = text_of(editor.document());
  EXPECT_EQ(field_of(live, editor.view(), camera, "kind")["value"], "perspective");
  EXPECT_NEAR(field_of(live, editor.view(), camera, "fov")["value"].get<double>(), 40, 1e-9);
  editor.make(Set{camera, "fov", 60.0});
  EXPECT_NEAR(fov_of(editor.document().view.camera), 3.14159265358979 / 3, 1e-12);
  editor.make(Set{{Kind::film}, "iso", 200.0});
  for (const char* kind : {"realistic", "omnistereo", "orthographic", "spherical"}) {
    editor.make(Set{camera, "kind", std::string(kind)});
    EXPECT_THAT(text_of(editor.document()), HasSubstr(fmt::format("Camera \"{}\"", kind)));
    Editor again(live);
    try_form(live, again, camera);
  }
  EXPECT_TRUE(field_of(live, editor.view(), camera, "fov").is_null());
  EXPECT_EQ(editor.camera_changes(), 5u);
  EXPECT_THROW(editor.make(Set{camera, "kind", std::string("nonesuch")}), InputError);
  // A camera that is saved stays when other settings are undone.
  View saved = editor.document().view;
  saved.camera.world_from_camera[3].x += 2;
  saved.clip = ClipPlane{{0, 0, 1}, 2};
  editor.adopt_camera(saved);
  editor.make(Set{{Kind::film}, "iso", 300.0});
  EXPECT_TRUE(editor.undo());
  EXPECT_EQ(editor.document().view.camera.world_from_camera, saved.camera.world_from_camera);
  EXPECT_EQ(editor.document().view.clip->offset, 2);
  while (editor.undo()) {
  }
  EXPECT_EQ(text_of(editor.document()), before);
}

TEST(Forms, NameLightsThatComeAndGo) {
  LiveScene live(
      scene_with(plain, "", R"(LightSource "spot" "point3 from" [ 0 0 5 ] "point3 to" [ 0 0 0 ])"));
  Editor editor(live);
  const auto first = picture_of(live);
  editor.make(Remove{{Kind::light, 1}});
  EXPECT_TRUE(picture_of(live) == picture_of(scene_with(plain)));
  EXPECT_THROW(editor.make(Remove{{Kind::light, 1}}), InputError);
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(picture_of(live) == first);
  // Another kind keeps its place.
  editor.make(Set{{Kind::light, 1}, "kind", std::string("point")});
  EXPECT_TRUE(picture_of(live) ==
              picture_of(scene_with(plain, "", R"(LightSource "point" "point3 from" [ 0 0 5 ])")));
}

TEST(Hiding, IsThePictureWithoutAndKeepsTheDocument) {
  const std::string more = R"(ObjectBegin "twig"
Shape "capsule" "point3 p0" [ 0 0 0 ] "point3 p1" [ 0 0 1 ] "float radius" [ 0.2 ]
ObjectEnd
ObjectInstance "twig"
Translate 0.5 -2 0
ObjectInstance "twig")";
  LiveScene live(scene_with(plain, more));
  Editor editor(live);
  const Scene whole = live.scene();
  const std::string text = text_of(editor.document());
  const auto first = picture_of(live);
  editor.make(Hide{{1, 2, 5}});
  Scene without = whole;
  without.instances.erase(without.instances.begin());
  without.shapes.erase(without.shapes.begin() + 1, without.shapes.begin() + 3);
  EXPECT_TRUE(picture_of(live) == picture_of(without));
  EXPECT_EQ(editor.hidden().shapes.size(), 2u);
  EXPECT_EQ(editor.hidden().instances.size(), 1u);
  EXPECT_EQ(text_of(editor.document()), text);
  // Gone and copied while others are hidden: the disk at the first place, a copy at the last.
  editor.make(Delete{{0}});
  EXPECT_EQ(editor.document().shapes.size(), whole.shapes.size() - 1);
  EXPECT_EQ(text_of(editor.document()).find("disk"), std::string::npos);
  EXPECT_TRUE(std::holds_alternative<BoxShape>(editor.document().shapes[1].geometry));
  editor.make(Show{1});  // the box
  EXPECT_TRUE(std::holds_alternative<BoxShape>(live.scene().shapes[0].geometry));
  EXPECT_EQ(editor.hidden().shapes.size(), 1u);
  editor.make(Show{});
  EXPECT_TRUE(editor.hidden().empty());
  Scene deleted = whole;
  deleted.shapes.erase(deleted.shapes.begin());
  EXPECT_TRUE(picture_of(live) == picture_of(deleted));
  EXPECT_EQ(text_of(live.scene()), text_of(deleted));
  while (editor.undo()) {
  }
  EXPECT_TRUE(picture_of(live) == first);
  EXPECT_TRUE(editor.hidden().empty());
  while (editor.redo()) {
  }
  EXPECT_EQ(text_of(live.scene()), text_of(deleted));
}

// The scene's other materials are textured, and the ball holds a medium.
TEST(Forms, LeaveWhatShapesReferToInPlace) {
  LiveScene live(scene_with(R"("string type" "dielectric")",
                            R"(MakeNamedMedium "fog" "string type" "homogeneous"
MediumInterface "fog" ""
AreaLightSource "diffuse"
Shape "sphere" "float radius" [ 0.3 ])"));
  Editor editor(live);
  editor.make(Move{{5}, glm::dmat4(1)});
  editor.make(Set{{Kind::emission, 5}, "scale", 2.0});
  EXPECT_TRUE(picture_of(live) == picture_of(live.scene()));
}

TEST(Forms, OfferNoShapeThatIsNone) {
  const std::vector<std::string> kinds = kinds_of("shape");
  for (const char* kind :
       {"capsule", "tapered capsule", "sphere", "disk", "cylinder", "cone", "box"})
    EXPECT_THAT(kinds, testing::Contains(kind));
  EXPECT_THAT(kinds, testing::Not(testing::Contains("polyhedron")));
  EXPECT_THAT(kinds, testing::Not(testing::Contains("csg")));
}

TEST(Hiding, IsolatesAndRefusesToShowNothing) {
  LiveScene live(scene_with(plain));
  Editor editor(live);
  EXPECT_THROW(editor.make(Hide{{0, 1, 2, 3, 4}}), InputError);
  EXPECT_THROW(editor.make(Hide{{9}}), InputError);
  EXPECT_THROW(editor.make(Show{}), InputError);
  editor.make(Hide{{1, 2}, true});
  EXPECT_EQ(editor.made(), (std::vector<std::uint32_t>{0, 1}));
  ASSERT_EQ(live.scene().shapes.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<BoxShape>(live.scene().shapes[1].geometry));
  EXPECT_THROW(editor.make(Show{3}), InputError);
  // What is new comes after what is hidden.
  editor.make(Add{Kind::shape, "cone", {}, {0, 0, 1}, {}, 0.3, 0});
  EXPECT_TRUE(std::holds_alternative<ConeShape>(editor.document().shapes.back().geometry));
  EXPECT_EQ(editor.document().shapes.size(), 6u);
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.undo());
  EXPECT_TRUE(editor.hidden().empty());
}

}  // namespace
}  // namespace caplet::view::forms_test
