// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The public classes, by nothing but their headers.
#include <caplet/import.h>
#include <caplet/log.h>
#include <caplet/pick.h>
#include <caplet/render.h>
#include <caplet/session.h>
#include <caplet/verify.h>
#include <caplet/write.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "library_device.h"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Library : public testing::Test {
 protected:
  Library()
      : folder_(fs::temp_directory_path() / ("caplet-library-" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "ball.pbrt") << R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 12 "integer yresolution" 8
Sampler "independent" "integer pixelsamples" 4
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
MakeNamedMaterial "white" "string type" "diffuse"
NamedMaterial "white"
Shape "sphere" "float radius" 1 "string name" "ball"
)";
  }
  ~Library() override { fs::remove_all(folder_); }

  fs::path folder_;
};

TEST_F(Library, ASceneTellsWhatItHolds) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  EXPECT_EQ(scene.width(), 12);
  EXPECT_EQ(scene.height(), 8);
  EXPECT_EQ(scene.samples_per_pixel(), 4);
  EXPECT_EQ(scene.noise(), 0);
  EXPECT_EQ(scene.primitives(), (std::map<std::string, std::uint64_t>{{"sphere", 1}}));
  EXPECT_THAT(scene.materials(), testing::Contains("white"));
  EXPECT_EQ(scene.bounds().min, (std::array<double, 3>{-1, -1, -1}));
  EXPECT_EQ(scene.bounds().max, (std::array<double, 3>{1, 1, 1}));
}

TEST_F(Library, FilesTakeTheProgramsOptions) {
  std::ofstream(folder_ / "cell.swc") << "1 2 0 0 0 0.01 -1\n2 2 4 1 0 0.01 1\n";
  const caplet::Scene top =
      caplet::import_scene(folder_ / "cell.swc", {{"view", "top"}, {"least-width", "4"}});
  EXPECT_NEAR(top.camera()[6], -1,
              1e-12);  // by rows: what looks down has forward, the third column, along -y
  for (const auto& [name, value, says] :
       {std::array{"veiw", "top", "'view'"}, std::array{"view", "inside", "--view"},
        std::array{"style", "sticks", "--style"}}) {
    try {
      caplet::import_scene(folder_ / "cell.swc", {{name, value}});
      ADD_FAILURE() << name;
    } catch (const caplet::InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(says));
    }
  }
  // A picture's lines are wide, hits are of the shapes.
  caplet::Scene small = top;
  small.set_size(64, 64);
  small.set_samples_per_pixel(4);
  const std::vector<float> coverage = caplet::render(small, test_device()).values("A");
  double wide = 0, thin = 0;
  for (const float share : coverage) wide += double{share};
  caplet::Scene as_it_is =
      caplet::import_scene(folder_ / "cell.swc", {{"view", "top"}, {"least-width", "0"}});
  as_it_is.set_size(64, 64);
  as_it_is.set_samples_per_pixel(4);
  for (const float share : caplet::render(as_it_is, test_device()).values("A"))
    thin += double{share};
  // A line of 0.95 x 64 pixels, four wide; 0.02 of 4.02 units of it wide.
  EXPECT_NEAR(wide, 0.95 * 64 * 4, 25);
  EXPECT_LT(thin, 40);
}

// docs/formats: poses are of robots, assemblies of PDB and mmCIF, ranges of what is coloured by
// values, groups of robots.
TEST_F(Library, FormatsTellTheirOptions) {
  std::map<std::string, std::set<std::string>> formats_of;
  for (const caplet::SceneFormat& format : caplet::scene_formats())
    for (const std::string& option : format.options) formats_of[option].insert(format.name);
  using Names = std::set<std::string>;
  EXPECT_EQ(formats_of["pose"], (Names{"mjcf", "urdf"}));
  EXPECT_EQ(formats_of["groups"], (Names{"mjcf", "urdf"}));
  EXPECT_EQ(formats_of["assembly"], (Names{"mmcif", "pdb"}));
  EXPECT_EQ(formats_of["range"],
            (Names{"mmcif", "pdb", "pqr", "sdf", "swc", "trk", "trx", "vtk", "vtp", "xyz"}));
  EXPECT_EQ(formats_of["values"], (Names{"trk", "trx", "vtk", "vtp"}));
}

TEST_F(Library, AChangedCopyLeavesTheFirstAsItWas) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::Scene copy = scene;
  copy.set_size(24, 16);
  copy.set_seed(7);
  EXPECT_EQ(scene.width(), 12);
  EXPECT_EQ(scene.seed(), 0u);
  EXPECT_EQ(copy.width(), 24);
  EXPECT_EQ(copy.seed(), 7u);
}

TEST_F(Library, WrongInputIsAnInputErrorWithItsPlace) {
  std::ofstream(folder_ / "wrong.pbrt") << "WorldBegin\nShape \"spehre\"\n";
  try {
    caplet::import_scene(folder_ / "wrong.pbrt");
    FAIL();
  } catch (const caplet::InputError& error) {
    EXPECT_THAT(error.messages().at(0), AllOf(HasSubstr("wrong.pbrt:2:"), HasSubstr("sphere")));
  }
  EXPECT_THROW(caplet::import_scene(folder_ / "none.pbrt"), caplet::InputError);
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  EXPECT_THROW(scene.set_size(0, 8), caplet::InputError);
  EXPECT_THROW(scene.set_size(1 << 15, 1 << 14), caplet::InputError);
  EXPECT_THROW(scene.set_crop(0, 0, 13, 8), caplet::InputError);
  EXPECT_THROW(scene.set_crop(3, 3, 3, 4), caplet::InputError);
  EXPECT_THROW(scene.set_samples_per_pixel(0), caplet::InputError);
  EXPECT_THROW(scene.set_max_depth(-1), caplet::InputError);
}

TEST_F(Library, ErrorsDoNotSpeakOfTheCommandLine) {
  try {
    caplet::choose_device("no such device");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_THAT(error.what(), Not(HasSubstr("--")));
  }
}

// A white ball in a white sky of radiance 1: nothing but the sky's light can leave it, so a pixel
// is at most 1; beside it, 1.
TEST_F(Library, AFilmHasThePicture) {
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  scene.set_crop(2, 1, 12, 7);
  double last = -1;
  caplet::RenderOptions options;
  options.progress = [&](const caplet::RenderProgress& progress) { last = progress.fraction; };
  const caplet::Film film = caplet::render(scene, test_device(), options);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(film.width(), 10);
  EXPECT_EQ(film.height(), 6);
  EXPECT_EQ(film.x(), 2);
  EXPECT_EQ(film.y(), 1);
  EXPECT_EQ(film.samples_per_pixel(), 4);
  EXPECT_THAT(film.channels(), testing::IsSupersetOf({"R", "G", "B", "A", "Z", "N.X", "albedo.R",
                                                      "variance.G", "object.id"}));
  const std::vector<float> green = film.values("G"), cover = film.values("A");
  const std::vector<std::uint32_t> ids = film.ids("object.id");
  ASSERT_EQ(green.size(), 60u);
  ASSERT_EQ(ids.size(), 60u);
  // The middle of the 12 x 8 picture is between pixels 5 and 6, 3 and 4.
  const std::size_t middle = (4 - 1) * 10 + (6 - 2);
  EXPECT_EQ(cover[middle], 1);
  EXPECT_EQ(ids[middle], 0u);
  EXPECT_GT(green[middle], 0.1f);
  EXPECT_LT(green[middle], 1.0f);
  // The last pixel of the row looks 5.5 / 4 tan(15 deg) = 20 degrees aside; the ball ends at asin(1
  // / 5) = 11.5.
  EXPECT_EQ(cover[39], 0);
  EXPECT_EQ(ids[39], 0xffffffffu);
  // Four samples of four wavelengths: within six of the standard errors that the film states, and
  // more than none.
  EXPECT_LT(std::abs(green[39] - 1), 6 * std::sqrt(film.values("variance.G")[39]) + 1e-6f);
  EXPECT_NEAR(green[39], 1, 0.05);
  EXPECT_THROW(film.values("object.id"), caplet::InputError);
  EXPECT_THROW(film.ids("R"), caplet::InputError);
  EXPECT_THROW(film.values("Gr"), caplet::InputError);
  film.write_exr(folder_ / "out.exr");
  EXPECT_GT(fs::file_size(folder_ / "out.exr"), 100u);
  EXPECT_THROW(film.write_preview(folder_ / "out.nothing"), caplet::InputError);
}

// One ball: what covers a pixel is the ball, and its file and material.
TEST_F(Library, MattesAreOnRequest) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  const caplet::Film film =
      caplet::render(scene, test_device(), {}, {.cryptomatte = true, .deep = true});
  const std::vector<float> alpha = film.values("A");
  EXPECT_THAT(film.channels(), testing::IsSupersetOf({"CryptoObject00.R", "CryptoAsset02.A"}));
  for (const auto& [matte, name] :
       {std::pair{caplet::Matte::object, film.matte_names(caplet::Matte::object).at(0)},
        {caplet::Matte::material, film.matte_names(caplet::Matte::material).at(0)},
        {caplet::Matte::asset, "ball"}}) {
    EXPECT_EQ(film.matte(matte, name), alpha) << name;
    EXPECT_THROW(film.matte(matte, "nothing"), caplet::InputError);
  }
  EXPECT_THAT(film.matte_names(caplet::Matte::asset), testing::ElementsAre("ball"));
  film.write_deep_exr(folder_ / "deep.exr");
  EXPECT_GT(fs::file_size(folder_ / "deep.exr"), 100u);

  // Films that are added, saved and loaded keep them.
  film.save(folder_ / "mattes.film");
  caplet::Session session(scene, test_device(), {.cryptomatte = true, .deep = true});
  session.begin_at(4);
  session.render(4);
  caplet::Film sum = caplet::Film::load(folder_ / "mattes.film");
  sum.add(session.film());
  EXPECT_EQ(sum.matte(caplet::Matte::asset, "ball"), sum.values("A"));

  const caplet::Film plain = caplet::render(scene, test_device());
  EXPECT_THROW(plain.matte_names(caplet::Matte::object), caplet::InputError);
  EXPECT_THROW(plain.matte(caplet::Matte::object, "ball"), caplet::InputError);
  EXPECT_THROW(plain.write_deep_exr(folder_ / "none.exr"), caplet::InputError);
  EXPECT_FALSE(fs::exists(folder_ / "none.exr"));
}

TEST_F(Library, APictureWithoutLayers) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::Session session(scene, test_device(), {.none = true});
  session.render(16);
  const caplet::Film alone = session.film(), usual = caplet::render(scene, test_device());
  EXPECT_THAT(alone.channels(), testing::ElementsAre("R", "G", "B", "A"));
  double sum = 0, expected = 0;
  for (const float value : alone.values("G")) sum += double{value};
  for (const float value : usual.values("G")) expected += double{value};
  EXPECT_NEAR(sum, expected, 0.02 * expected);
  EXPECT_THROW(caplet::render(scene, test_device(), {}, {.deep = true, .none = true}),
               caplet::InputError);
  EXPECT_THROW(caplet::render(scene, test_device(), {}, {.cryptomatte = true, .none = true}),
               caplet::InputError);
  EXPECT_THROW(session.render_to({.noise = 0.5}), caplet::InputError);
  caplet::RenderOptions to_noise;
  to_noise.noise = caplet::NoiseTarget{.noise = 0.5};
  EXPECT_THROW(caplet::render(scene, test_device(), to_noise, {.none = true}), caplet::InputError);
}

TEST_F(Library, OverlaysAreDrawnByName) {
  const caplet::Film film =
      caplet::render(caplet::import_scene(folder_ / "ball.pbrt"), test_device());
  for (const caplet::Overlay& one : caplet::overlays())
    EXPECT_FALSE(one.name.empty() || one.help.empty());
  const fs::path file = folder_ / "drawn.png";
  for (const caplet::OverlayOptions& wrong : {caplet::OverlayOptions{{"outline", "wide"}},
                                              {{"outlin", ""}},
                                              {{"color-bar", ""}},
                                              {{"scale-bar", "1e9"}}})
    EXPECT_THROW(film.write_preview(file, wrong), caplet::InputError);
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(Library, LookAtShowsARightHandedWorldUnmirrored) {
  // The camera's +x is to the right of the picture: along the world's +x where the view is from +z
  // with y up.
  caplet::Scene scene;
  scene.add_shape("sphere", {});
  scene.look_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0});
  EXPECT_EQ(scene.camera()[0], 1);
  EXPECT_EQ(scene.camera()[10], -1);
  scene.look_at({0, 0, -9}, {0, 0, 0}, {0, 1, 0});
  EXPECT_EQ(scene.camera()[0], -1);
  // As LookAt of pbrt's text has it, where that is what there was.
  scene.set_camera("perspective", {}, caplet::identity);
  scene.look_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0});
  EXPECT_EQ(scene.camera()[0], -1);
}

TEST_F(Library, TheTimeLimitEndsARender) {
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  scene.set_size(320, 240);
  scene.set_samples_per_pixel(1 << 20);  // hours
  caplet::RenderOptions options;
  options.time_limit = 1e-9;
  const int samples = caplet::render(scene, test_device(), options).samples_per_pixel();
  EXPECT_GT(samples, 0);
  EXPECT_LT(samples, 1 << 10);
}

TEST_F(Library, ARenderHasTheNoiseThatIsAskedFor) {
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::RenderOptions options;
  options.noise = {0.02, 8, 1 << 14};
  const caplet::Film film = caplet::render(scene, test_device(), options);
  const std::vector<std::uint32_t> samples = film.ids("samples");
  const auto [least, most] = std::ranges::minmax(samples);
  EXPECT_GE(least, 8u);
  EXPECT_GT(most, 2 * least);
  EXPECT_LE(most, 1u << 14);
  double sum = 0;
  for (const std::uint32_t n : samples) sum += n;
  EXPECT_EQ(film.samples_per_pixel(), std::lround(sum / static_cast<double>(samples.size())));
  caplet::Session session(scene, test_device());
  EXPECT_LE(session.render_to(*options.noise), 0.02);
  EXPECT_EQ(session.film().ids("samples"), samples);
  for (const caplet::NoiseTarget bad : {caplet::NoiseTarget{0, 8, 64},
                                        {1.5, 8, 64},
                                        {0.1, 1, 64},
                                        {0.1, 65, 64},
                                        {0.1, 8, 1 << 25}})
    EXPECT_THROW(session.render_to(bad), caplet::InputError);
  scene.set_option(caplet::Statement::sampler, "stratified", {});
  EXPECT_THROW(caplet::render(scene, test_device(), options), caplet::InputError);
  EXPECT_THROW(caplet::Session(scene, test_device()).render_to(*options.noise), caplet::InputError);
}

TEST_F(Library, PicksTellWhatAPixelShowsAndRaysHit) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::Picker picker(scene, test_device());
  const caplet::Ray ray{{0, 0, 5}, {0, 0, -2}}, beside{{0, 3, 5}, {0, 0, -1}};
  const auto hit = picker.nearest(ray);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->t, 2, 1e-6);  // in lengths of the direction
  EXPECT_NEAR(hit->point[2], 1, 1e-6);
  EXPECT_NEAR(hit->normal[2], 1, 1e-6);
  EXPECT_EQ(hit->object, "ball");
  EXPECT_EQ(hit->material, "white");
  EXPECT_EQ(scene.materials().at(hit->material_id), "white");
  EXPECT_TRUE(hit->entering);
  EXPECT_FALSE(hit->instance.has_value());
  EXPECT_FALSE(picker.nearest(beside).has_value());
  const auto lists = picker.all(std::array{ray, beside});
  ASSERT_EQ(lists.size(), 2u);
  ASSERT_EQ(lists[0].size(), 2u);
  EXPECT_NEAR(lists[0][1].t, 3, 1e-6);
  EXPECT_FALSE(lists[0][1].entering);
  EXPECT_TRUE(lists[1].empty());
  EXPECT_THROW(picker.all(std::array{ray}, 1), caplet::RunError);
  ASSERT_TRUE(picker.pixel(6, 4).has_value());
  EXPECT_EQ(picker.pixel(6, 4)->object, "ball");
  EXPECT_FALSE(picker.pixel(0, 0).has_value());
  EXPECT_THROW(picker.pixel(12, 0), caplet::InputError);
  EXPECT_THROW(picker.pixel(-1, 0), caplet::InputError);
}

// --- Edits ---

bool same_pictures(const caplet::Film& a, const caplet::Film& b) {
  for (const char* channel : {"R", "G", "B", "A", "Z", "variance.G"})
    if (a.values(channel) != b.values(channel)) return false;
  return a.ids("object.id") == b.ids("object.id") && a.ids("primitive.id") == b.ids("primitive.id");
}

class LibraryEdits : public Library {
 protected:
  LibraryEdits() {
    std::ofstream(folder_ / "edits.pbrt") << R"(LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 4
WorldBegin
LightSource "point" "rgb I" [9 9 9] "point3 from" [0 3 4]
MakeNamedMaterial "white" "string type" "diffuse"
MakeNamedMaterial "other" "string type" "diffuse" "rgb reflectance" [0.1 0.2 0.9]
NamedMaterial "white"
Shape "capsule" "point3 p0" [-0.5 0 0] "point3 p1" [0.5 0 0] "float radius" 0.3 "string name" "bar"
ObjectBegin "thing"
  NamedMaterial "other"
  Shape "capsule" "point3 p0" [0 0 0] "point3 p1" [0 0.5 0] "float radius" [0.2 0.1] "string name" "pin"
ObjectEnd
ObjectInstance "thing"
AreaLightSource "diffuse" "rgb L" [4 4 4]
Shape "sphere" "float radius" 0.2 "string name" "lamp"
)";
  }
  caplet::Scene scene() const { return caplet::import_scene(folder_ / "edits.pbrt"); }
};

TEST_F(LibraryEdits, ASceneTellsAndTakesWhatIsEdited) {
  caplet::Scene edited = scene();
  const caplet::Scene before = edited;
  EXPECT_THAT(edited.shapes(), testing::ElementsAre("bar", "lamp", "pin"));
  const std::uint32_t bar = edited.shape("bar"), pin = edited.shape("pin"),
                      lamp = edited.shape("lamp");
  EXPECT_EQ(edited.capsules(bar), 1u);
  EXPECT_EQ(edited.capsules(lamp), 0u);
  EXPECT_EQ(edited.capsule(pin, 0).radius1, 0.1f);
  edited.set_capsule(bar, 0, {{-1, 0, 0}, {1, 0, 0}, 0.25f, 0.25f});
  EXPECT_EQ(edited.capsule(bar, 0).p1, (std::array<float, 3>{1, 0, 0}));
  EXPECT_EQ(edited.bounds().max[0], 1.25);
  EXPECT_EQ(before.capsule(bar, 0).p1, (std::array<float, 3>{0.5f, 0, 0}));
  const caplet::Transform moved{1, 0, 0, 2, 0, 1, 0, 3, 0, 0, 1, 4};
  edited.set_transform(lamp, moved);
  EXPECT_EQ(edited.transform(lamp), moved);
  ASSERT_EQ(edited.instances(), 1u);
  edited.set_instance(0, moved);
  EXPECT_EQ(edited.instance(0), moved);
  ASSERT_EQ(edited.lights(), 1u);
  edited.set_light(0, caplet::Rgb{1, 0, 0}, 3);
  EXPECT_EQ(edited.light_scale(0), 3);
  edited.set_fov(45);
  EXPECT_NEAR(edited.fov(), 45, 1e-12);
  EXPECT_THROW(edited.shape("bra"), caplet::InputError);
  EXPECT_THROW(edited.capsule(lamp, 0), caplet::InputError);
  EXPECT_THROW(edited.capsule(bar, 1), caplet::InputError);
  EXPECT_THROW(edited.capsules(3), caplet::InputError);
  EXPECT_THROW(edited.set_capsule(bar, 0, {{0, 0, 0}, {1, 0, 0}, -1, -1}), caplet::InputError);
  EXPECT_THROW(edited.set_transform(bar, caplet::Transform{}), caplet::InputError);
  EXPECT_THROW(edited.set_material(9, caplet::Diffuse{}), caplet::InputError);
  EXPECT_THROW(edited.set_material(0, caplet::Diffuse{std::string("metal-Gold-eta")}),
               caplet::InputError);
  EXPECT_THROW(edited.set_emission(bar, 1.0, 1), caplet::InputError);
  EXPECT_THROW(edited.set_light(1, 1.0, 1), caplet::InputError);
  EXPECT_THROW(edited.look_at({0, 0, 5}, {0, 0, 0}, {0, 0, 1}), caplet::InputError);
  EXPECT_THROW(edited.set_fov(180), caplet::InputError);
  EXPECT_EQ(edited.capsule(bar, 0).radius0, 0.25f);
}

TEST_F(LibraryEdits, ASessionFollowsThem) {
  const caplet::Device device = test_device();
  caplet::Scene edited = scene();
  caplet::Session session(edited, device);
  EXPECT_EQ(session.render(4), 4);
  EXPECT_TRUE(same_pictures(session.film(), caplet::render(edited, device)));
  const caplet::Scene copy = edited;
  const std::vector<std::function<void()>> edits = {
      [&] {
        edited.set_capsule(edited.shape("bar"), 0, {{-1, 0.3f, 0}, {1, 0, 0}, 0.25f, 0.25f});
      },
      [&] {
        edited.set_capsule(edited.shape("pin"), 0, {{0, 0, 0}, {0, 0.7f, 0}, 0.3f, 0.1f});
      },
      [&] {
        edited.set_instance(0, {1, 0, 0, 0.5, 0, 1, 0, 0.5, 0, 0, 1, 1});
      },
      [&] { edited.set_material(0, caplet::Conductor{.roughness_u = 0.2, .roughness_v = 0.3}); },
      [&] {
        edited.set_light(0, caplet::Rgb{1, 5, 2}, 3);
      },
      [&] {
        edited.set_emission(edited.shape("lamp"), caplet::Rgb{9, 1, 1}, 2);
      },
      [&] {
        edited.set_transform(edited.shape("lamp"), {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 1});
      },
      [&] {
        edited.look_at({1, 2, 5}, {0, 0, 0}, {0, 1, 0});
      },
      [&] { edited.set_fov(40); },
      [&] { edited.set_size(20, 20); },
  };
  caplet::Film last = session.film();
  for (std::size_t i = 0; i < edits.size(); ++i) {
    edits[i]();
    session.update(edited);
    EXPECT_EQ(session.film().samples_per_pixel(), 0);
    session.render(1);
    session.render(3);
    const caplet::Film film = session.film();
    EXPECT_TRUE(same_pictures(film, caplet::render(edited, device))) << i;
    if (i + 1 < edits.size()) {
      EXPECT_FALSE(same_pictures(film, last)) << i;
    }
    last = film;
  }
  const auto hit = session.pixel(10, 9);
  caplet::Picker picker(edited, device);
  const auto expected = picker.pixel(10, 9);
  ASSERT_TRUE(hit && expected);
  EXPECT_EQ(hit->t, expected->t);
  EXPECT_EQ(hit->object, expected->object);
  // A scene that has gone another way.
  session.update(copy);
  session.render(4);
  EXPECT_TRUE(same_pictures(session.film(), caplet::render(copy, device)));
}

TEST_F(LibraryEdits, FilmsAreAddedSavedAndLoaded) {
  const caplet::Device device = test_device();
  const caplet::Scene of = scene();
  caplet::Session session(of, device);
  session.render(3);
  const caplet::Film first = session.film();
  first.save(folder_ / "film.exr");
  caplet::Session other(of, device);
  other.resume(caplet::Film::load(folder_ / "film.exr", of));
  other.render(1);
  EXPECT_TRUE(same_pictures(other.film(), caplet::render(of, device)));
  std::uint32_t next = 0;
  for (const caplet::SampleRange& range : other.film().samples()) {
    EXPECT_EQ(range.first, next);
    next = range.first + range.count;
  }
  EXPECT_EQ(next, 4u);
  // Read, added to, and written over.
  caplet::Film loaded = caplet::Film::load(folder_ / "film.exr", of);
  EXPECT_TRUE(same_pictures(loaded, first));
  ASSERT_EQ(loaded.samples().size(), 1u);
  EXPECT_EQ(loaded.samples()[0].first, 0u);
  EXPECT_EQ(loaded.samples()[0].count, 3u);
  EXPECT_THROW(loaded.add(first), caplet::InputError);
  EXPECT_THROW(loaded.add(other.film()), caplet::InputError);
  other.film().save(folder_ / "film.exr");
  EXPECT_EQ(caplet::Film::load(folder_ / "film.exr", of).samples_per_pixel(), 4);
  EXPECT_THROW(caplet::Film::load(folder_ / "edits.pbrt", of), caplet::InputError);
  caplet::Scene wide = of;
  wide.set_size(30, 16);
  EXPECT_THROW(caplet::Session(wide, device).resume(first), caplet::InputError);
}

// Samples of another scene are refused, also where a session's scene has been edited in between.
TEST_F(LibraryEdits, FilmsAreOfTheSceneAsItIs) {
  caplet::Scene edited = scene();
  caplet::Session session(edited, test_device());
  session.render(2);
  caplet::Film before = session.film();
  edited.set_capsule(edited.shape("bar"), 0, {{-1, 0.3f, 0}, {1, 0, 0}, 0.25f, 0.25f});
  session.update(edited);
  session.render(2);
  caplet::Film after = session.film();
  session.begin_at(2);
  session.render(2);
  EXPECT_THROW(before.add(session.film()), caplet::InputError);
  after.add(session.film());
  EXPECT_EQ(after.samples_per_pixel(), 4);
}

TEST_F(LibraryEdits, ASessionTriesItsDeviceBeforeItRenders) {
  namespace fs = std::filesystem;
  fs::copy(fs::path(CAPLET_SCENES).parent_path() / "kernels", folder_ / "kernels",
           fs::copy_options::recursive);
  const fs::path file = folder_ / "kernels" / "trace" / "hits.cl";
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string right = "hit.t = nearest->t;";
  const std::size_t at = text.find(right);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << text.replace(at, right.size(), "hit.t = 2.0f * nearest->t;");
  ::setenv("CAPLET_KERNELS", (folder_ / "kernels").c_str(), 1);
  EXPECT_THROW(caplet::Session(scene(), test_device()), caplet::RunError);
  ::unsetenv("CAPLET_KERNELS");
}

TEST_F(LibraryEdits, ASessionIsCancelledFromAnotherThread) {
  caplet::Scene large = scene();
  large.set_size(320, 240);
  caplet::Session session(large, test_device());
  caplet::RenderOptions options;
  std::jthread other;
  options.progress = [&](const caplet::RenderProgress&) {
    if (!other.joinable()) other = std::jthread([&] { session.cancel(); });
  };
  const int done = session.render(1 << 24, options);  // days
  EXPECT_GT(done, 0);
  EXPECT_EQ(session.film().samples_per_pixel(), done);
}

// --- Materials and textures ---

class LibraryAppearance : public LibraryEdits {};

// Every row of the lists, with what it has when nothing is said of it.
TEST_F(LibraryAppearance, EveryTypeIsThere) {
  caplet::Scene edited = scene();
  EXPECT_THAT(caplet::material_types(),
              testing::IsSupersetOf({"diffuse", "coatedconductor", "hair", "mix", "principled",
                                     "diffusetransmission"}));
  for (const std::string& type : caplet::material_types()) {
    caplet::NamedMaterial material{type};
    if (type == "mix") material.parameters["materials"] = std::array<std::uint32_t, 2>{0, 1};
    EXPECT_NO_THROW(edited.add_material(type, material)) << type;
    EXPECT_THAT(caplet::material_parameters(type),
                testing::IsSupersetOf({"displacement", "normalmap"}))
        << type;
    EXPECT_EQ(caplet::material_parameters(type).size() == 2, type == "interface") << type;
  }
  EXPECT_EQ(edited.materials().size(),
            scene().materials().size() + caplet::material_types().size());
  EXPECT_EQ(edited.materials().back(), caplet::material_types().back());
  EXPECT_THAT(caplet::texture_types(),
              testing::IsSupersetOf({"checkerboard", "imagemap", "fbm", "marble", "directionmix"}));
  for (const std::string& type : caplet::texture_types()) {
    if (type == "imagemap" || type == "normalmap") continue;  // need a file
    EXPECT_NO_THROW(edited.add_texture({type, type != "marble"})) << type;
  }
  EXPECT_THAT(caplet::material_parameters("coateddiffuse"),
              testing::UnorderedElementsAre("reflectance", "eta", "alpha_u", "alpha_v", "roughness",
                                            "uroughness", "vroughness", "remaproughness",
                                            "thickness", "albedo", "g", "maxdepth", "nsamples",
                                            "displacement", "normalmap"));
  EXPECT_THAT(caplet::texture_parameters("checkerboard"),
              testing::IsSupersetOf({"tex1", "tex2", "dimension", "mapping", "uscale", "v1"}));
  EXPECT_THAT(caplet::texture_parameters("imagemap"),
              testing::IsSupersetOf({"filename", "encoding", "wrap", "invert", "pixels"}));
}

TEST_F(LibraryAppearance, WhatThereIsNoneOfIsToldWithTheNearest) {
  caplet::Scene edited = scene();
  const auto said = [&](const caplet::NamedMaterial& material) -> std::string {
    try {
      edited.set_material(0, material);
    } catch (const caplet::InputError& error) {
      return error.messages().at(0);
    }
    return {};
  };
  using Named = caplet::NamedMaterial;
  EXPECT_THAT(said(Named{"coatdiffuse"}),
              AllOf(HasSubstr("'coatdiffuse'"), HasSubstr("'coateddiffuse'")));
  EXPECT_THAT(said(Named{"diffuse", {{"reflectanse", 0.5}}}),
              AllOf(HasSubstr("\"reflectanse\""), HasSubstr("\"reflectance\"")));
  EXPECT_THAT(said(Named{"diffuse", {{"reflectance", true}}}),
              HasSubstr("\"reflectance\" must be of type rgb or spectrum or blackbody or float or "
                        "texture, not 1 bool"));
  EXPECT_THAT(said(Named{"hair", {{"beta_m", caplet::Rgb{}}}}),
              HasSubstr("\"beta_m\" must be of type float or texture, not rgb"));
  EXPECT_THAT(said(Named{"hair", {{"beta_m", 2.0}}}),
              HasSubstr("\"beta_m\" must lie between 0 and 1"));
  EXPECT_THAT(said(Named{"coateddiffuse", {{"maxdepth", 1.5}}}),
              HasSubstr("\"maxdepth\" must be a whole number, not 1.5"));
  EXPECT_THAT(said(Named{"conductor", {{"eta", std::string("metal-Gold-eta")}}}),
              HasSubstr("metal-"));
  EXPECT_THAT(said(Named{"conductor", {{"multiscatter", 1.0}}}),
              HasSubstr("\"multiscatter\" must be of type bool, not 1 number"));
  EXPECT_THAT(said(Named{"diffuse", {{"reflectance", caplet::TextureNumber{7}}}}),
              HasSubstr("reflectance"));
  EXPECT_THAT(said(Named{"diffuse", {{"displacement", caplet::TextureNumber{7}}}}),
              HasSubstr("displacement"));
  EXPECT_THAT(said(Named{"mix", {{"materials", std::array<std::uint32_t, 2>{0, 1}}}}),
              HasSubstr("itself"));
  EXPECT_THROW(edited.add_texture({"checkboard"}), caplet::InputError);
  EXPECT_THROW(edited.add_texture({"checkerboard", false, {{"mapping", std::string("round")}}}),
               caplet::InputError);
  EXPECT_THROW(edited.add_texture({"marble", true}), caplet::InputError);
  EXPECT_THROW(edited.add_texture({"scale", false, {{"tex", caplet::TextureNumber{0}}}}),
               caplet::InputError);
  EXPECT_THROW(edited.add_texture({"imagemap"}), caplet::InputError);
  EXPECT_THROW(
      edited.add_texture({"imagemap", false, {{"filename", (folder_ / "none.png").string()}}}),
      caplet::InputError);
  EXPECT_THROW(caplet::material_parameters("glass"), caplet::InputError);
  // Nothing of it has changed the picture.
  EXPECT_TRUE(
      same_pictures(caplet::render(edited, test_device()), caplet::render(scene(), test_device())));
}

// What is named is what scene files name.
TEST_F(LibraryAppearance, NamedMaterialsAreThoseOfSceneFiles) {
  std::ifstream in(folder_ / "edits.pbrt");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string old = "MakeNamedMaterial \"white\" \"string type\" \"diffuse\"";
  const std::size_t at = text.find(old);
  ASSERT_NE(at, std::string::npos);
  std::ofstream(folder_ / "named.pbrt") << text.replace(
      at, old.size(),
      R"(Texture "squares" "float" "checkerboard" "float uscale" 4 "float vscale" 8 "float tex2" 0.25
Texture "heights" "float" "fbm" "integer octaves" 3
MakeNamedMaterial "white" "string type" "principled" "rgb base_color" [0.8 0.3 0.1] "texture metallic" "squares" "float roughness" 0.3 "float coat" 0.5 "texture displacement" "heights")");
  caplet::Scene edited = scene();
  const caplet::TextureNumber squares = edited.add_texture(
      {"checkerboard", true, {{"uscale", 4.0}, {"vscale", 8.0}, {"tex2", 0.25}}});
  const caplet::TextureNumber heights = edited.add_texture({"fbm", true, {{"octaves", 3.0}}});
  edited.set_material(0, caplet::NamedMaterial{"principled",
                                               {{"base_color", caplet::Rgb{0.8, 0.3, 0.1}},
                                                {"metallic", squares},
                                                {"roughness", 0.3},
                                                {"coat", 0.5},
                                                {"displacement", heights}}});
  EXPECT_TRUE(
      same_pictures(caplet::render(edited, test_device()),
                    caplet::render(caplet::import_scene(folder_ / "named.pbrt"), test_device())));
}

TEST_F(LibraryAppearance, ASessionFollowsWhatIsAdded) {
  const caplet::Device device = test_device();
  caplet::Scene edited = scene();
  caplet::Session session(edited, device);
  session.render(4);
  const caplet::Film before = session.film();
  const auto follows = [&](const char* what) {
    session.update(edited);
    session.render(4);
    EXPECT_TRUE(same_pictures(session.film(), caplet::render(edited, device))) << what;
    EXPECT_FALSE(same_pictures(session.film(), before)) << what;
  };
  edited.set_material(
      0, caplet::NamedMaterial{"coateddiffuse",
                               {{"reflectance", caplet::Rgb{0.7, 0.1, 0.1}}, {"alpha_u", 0.1}}});
  follows("a coat");
  const caplet::TextureNumber squares = edited.add_texture(
      {"checkerboard", false, {{"tex1", caplet::Rgb{0.1, 0.7, 0.1}}, {"uscale", 6.0}}});
  edited.set_material(0, caplet::NamedMaterial{"diffuse", {{"reflectance", squares}}});
  follows("a texture");
  const std::uint32_t gold =
      edited.add_material("gold", caplet::Conductor{.reflectance = caplet::Rgb{0.9, 0.6, 0.2}});
  edited.set_material(
      0, caplet::NamedMaterial{
             "mix", {{"materials", std::array<std::uint32_t, 2>{gold, 1}}, {"amount", 0.3}}});
  follows("a mix");
}

TEST_F(Library, VerifyCounts) {
  const caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  caplet::VerifyOptions options;
  options.rays = 2000;
  const caplet::Device device = test_device();
  const caplet::VerifyReport report = caplet::verify(scene, std::span(&device, 1), options);
  ASSERT_EQ(report.devices.size(), 1u);
  EXPECT_EQ(report.devices[0].rays, 2000u);
  EXPECT_EQ(report.devices[0].device.name, device.info().name);
  EXPECT_GT(report.devices[0].hits, 100u);
  EXPECT_TRUE(report.agrees()) << report.text;
  EXPECT_LE(report.devices[0].worst, 1);
  EXPECT_THAT(report.json, HasSubstr("\"verdict\": \"agrees\""));
}

TEST_F(Library, MessagesGoWhereTheyAreWanted) {
  std::ofstream(folder_ / "dark.pbrt") << "Camera \"perspective\"\nWorldBegin\nShape \"sphere\"\n";
  std::vector<std::pair<caplet::LogLevel, std::string>> said;
  caplet::set_log_sink(
      [&](caplet::LogLevel level, std::string_view message) { said.emplace_back(level, message); });
  caplet::import_scene(folder_ / "dark.pbrt");
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].first, caplet::LogLevel::warning);
  EXPECT_THAT(said[0].second, HasSubstr("the scene has no light"));
  caplet::set_log_level(caplet::LogLevel::error);
  caplet::import_scene(folder_ / "dark.pbrt");
  EXPECT_EQ(said.size(), 1u);
  caplet::set_log_level(caplet::LogLevel::warning);
  caplet::set_log_sink({});
}

TEST_F(Library, AnEditedSceneIsWrittenAndReadAgain) {
  caplet::Scene scene = caplet::import_scene(folder_ / "ball.pbrt");
  scene.set_material(
      0, caplet::NamedMaterial{"principled",
                               {{"base_color", caplet::Rgb{0.8, 0.3, 0.1}}, {"metallic", 0.25}}});
  caplet::write_scene(scene, folder_ / "written.pbrt");
  const caplet::Scene read = caplet::import_scene(folder_ / "written.pbrt");
  const caplet::Device device = test_device();
  const caplet::Film a = caplet::render(scene, device), b = caplet::render(read, device);
  for (const char* channel : {"R", "G", "B", "Z"})
    EXPECT_EQ(a.values(channel), b.values(channel)) << channel;
  EXPECT_THROW(caplet::write_scene(scene, folder_ / "written.exr"), caplet::InputError);
}

}  // namespace
