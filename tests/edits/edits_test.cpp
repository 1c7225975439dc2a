// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Edits of a scene on a device: the same film and the same picks, to the bit, as of the edited
// scene lowered afresh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <random>
#include <string>

#include "lower/fingerprint.h"
#include "lower/live_scene.h"
#include "lower/lower.h"
#include "render/query.h"
#include "render/renderer.h"
#include "render_scene.h"
#include "support/test_device.h"

namespace caplet::test {
namespace {

using glm::dmat4;
using glm::dvec3;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }
  std::size_t below(std::size_t count) { return engine_() % count; }
  dvec3 within(double low, double high) {
    return {uniform(low, high), uniform(low, high), uniform(low, high)};
  }

 private:
  std::mt19937 engine_;
};

Capsule random_capsule(Random& random, double reach) {
  const dvec3 p = random.within(-reach, reach);
  Capsule out{glm::vec3(p), glm::vec3(p + random.within(-0.5, 0.5)), 0, 0};
  out.radius0 = static_cast<float>(random.uniform(0.03, 0.12));
  out.radius1 = random.below(2) ? out.radius0 : static_cast<float>(random.uniform(0.03, 0.12));
  return out;
}

void add(CapsulesShape& to, const Capsule& capsule, std::uint32_t material) {
  to.p0.push_back(capsule.p0);
  to.p1.push_back(capsule.p1);
  to.radius0.push_back(capsule.radius0);
  to.radius1.push_back(capsule.radius1);
  to.materials.push_back(material);
}

/// Every fourth capsule is where the one before is: rays that hit both hit them at the same t.
Shape random_capsules(Random& random, std::size_t count, double reach) {
  CapsulesShape capsules;
  Capsule last;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 4 != 3) last = random_capsule(random, reach);
    add(capsules, last, static_cast<std::uint32_t>(i % 3));
    const double u0 = random.uniform(0, 1), u1 = random.uniform(0, 2);
    capsules.u.emplace_back(u0, u1);
  }
  Shape shape;
  shape.geometry = std::move(capsules);
  return shape;
}

constexpr const char* surroundings = R"(
Integrator "path" "integer maxdepth" [ 4 ]
LookAt 5 -7 4  0 0 0.3  0 0 1
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" [ 32 ] "integer yresolution" [ 24 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.25 0.3 ]
LightSource "point" "rgb I" [ 6 5 4 ] "point3 from" [ 3 -3 5 ]
LightSource "distant" "blackbody L" [ 5500 ] "point3 from" [ 1 1 2 ] "point3 to" [ 0 0 0 ] "float illuminance" [ 2 ]
Material "diffuse" "rgb reflectance" [ 0.5 0.45 0.4 ]
Shape "disk" "float radius" [ 8 ] "float height" [ -3 ]
Material "conductor" "spectrum eta" [ "metal-Au-eta" ] "spectrum k" [ "metal-Au-k" ] "float roughness" [ 0.1 ]
Shape "sphere" "float radius" [ 0.6 ]
Material "dielectric" "spectrum eta" [ "glass-SF11" ]
Shape "box" "point3 p0" [ 1 1 0 ] "point3 p1" [ 2 2 1 ]
AttributeBegin
  Translate -2 0 1
  Scale 1 1 0.5
  Shape "sphere" "float radius" [ 0.7 ]
AttributeEnd
Shape "trianglemesh" "point3 P" [ -1 -2 1  0 -2 1  -0.5 -2 2 ] "normal N" [ 0 -1 0.1  0.1 -1 0  0 -1 0 ] "integer indices" [ 0 1 2 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 8 8 8 ] "bool twosided" [ true ]
  Shape "cylinder" "float radius" [ 0.2 ] "float zmin" [ 0 ] "float zmax" [ 1 ]
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 3 4 8 ] "float power" [ 40 ]
  Shape "capsule" "point3 p0" [ -2 2 2.5 ] "point3 p1" [ 2 2.4 3 ] "float radius" [ 0.1 ]
AttributeEnd
AttributeBegin
  Material "diffuse" "rgb reflectance" [ 0.1 0.7 0.2 ]
  Shape "sphere" "float radius" [ 0.5 ] "bool onesided" [ true ]
AttributeEnd
ObjectBegin "lamp"
  AreaLightSource "diffuse" "rgb L" [ 9 5 2 ]
  Shape "capsule" "point3 p0" [ 0 0 0 ] "point3 p1" [ 0 0 0.7 ] "float radius" [ 0.15 0.05 ]
ObjectEnd
ObjectBegin "twig"
  Shape "capsule" "point3 p0" [ 0 0 0 ] "point3 p1" [ 0 0 1 ] "float radius" [ 0.08 ]
  Shape "capsule" "point3 p0" [ 0 0 0 ] "point3 p1" [ 0 0 1 ] "float radius" [ 0.08 ] "float u" [ 0.25 0.5 ]
  Scale 1 1 2
  Shape "sphere" "float radius" [ 0.2 ]
ObjectEnd
ObjectInstance "twig"
ObjectInstance "twig"
Translate 0 -2 0
ObjectInstance "lamp"
Translate 0 0 1
ObjectInstance "lamp"
)";

Scene mixed_scene(std::size_t capsules) {
  Scene scene = scene_of_text(surroundings);
  Random random(5);
  scene.shapes.push_back(random_capsules(random, capsules, 2.5));
  Object& bush = scene.objects.emplace_back();
  bush.name = "bush";
  bush.shapes.push_back(random_capsules(random, 300, 1));  // too many for bounds shape by shape
  for (int i = 0; i < 6; ++i) {
    Instance& instance = scene.instances.emplace_back();
    instance.object = static_cast<std::uint32_t>(scene.objects.size() - 1);
    instance.world_from_object = glm::translate(dmat4(1), random.within(-3, 3));
  }
  return scene;
}

/// A scene that is edited, on the test device, beside one that is lowered afresh.
class Edited {
 public:
  explicit Edited(const Scene& scene)
      : live(scene),
        device(test_device(), live.flat()),
        renderer(device, live.view(), {.layers = Layers::all()}) {}

  void edit(const SceneEdit& edit) { live.edit(edit); }

  void send() {
    const SceneChanges changes = live.take_changes();
    device.update(live.flat(), changes);
    fingerprint_.note(changes);
    EXPECT_EQ(fingerprint_.of(live.flat()), fingerprint(live.flat()));
  }

  void expect_fresh(const std::string& after) {
    send();
    const FlatScene flat = lower(live.scene());
    if (!fresh_device) fresh_device = std::make_unique<DeviceScene>(test_device(), flat);
    SceneChanges all;
    all.all = true;
    fresh_device->update(flat, all);
    if (!fresh_renderer)
      fresh_renderer = std::make_unique<Renderer>(*fresh_device, lower_view(live.scene()),
                                                  RendererOptions{.layers = Layers::all()});
    const Film here = film(renderer, live.view()),
               there = film(*fresh_renderer, lower_view(live.scene()));
    ASSERT_EQ(here.layout(), there.layout()) << after;
    std::size_t different = 0;
    for (std::size_t i = 0; i < here.words().size(); ++i)
      different += here.words()[i] != there.words()[i] ? 1 : 0;
    EXPECT_EQ(different, 0u) << after;
    EXPECT_EQ(std::memcmp(&live.flat().world.center_x, &flat.world.center_x, 4 * sizeof(float)), 0)
        << after;
    expect_picks(after);
  }

  LiveScene live;
  DeviceScene device;
  Renderer renderer;
  std::unique_ptr<DeviceScene> fresh_device;
  std::unique_ptr<Renderer> fresh_renderer;

 private:
  SceneFingerprint fingerprint_;

  static Film film(Renderer& renderer, const FlatView& view) {
    renderer.reset(view);
    renderer.pass(renderer.film().layout.window, 0, 4);
    return renderer.film().read();
  }

  void expect_picks(const std::string& after) {
    Random random(9);
    std::vector<RayRecord> rays;
    for (int i = 0; i < 500; ++i) {
      const dvec3 o = random.within(-6, 6), d = random.within(-2, 2) - o;
      rays.push_back(
          {float(o.x), float(o.y), float(o.z), 0, float(d.x), float(d.y), float(d.z), INFINITY});
    }
    Query here(device), there(*fresh_device);
    const HitLists a = here.all(rays, 200), b = there.all(rays, 200);
    ASSERT_EQ(a.begin, b.begin) << after;
    EXPECT_EQ(std::memcmp(a.crossings.data(), b.crossings.data(),
                          a.crossings.size() * sizeof(PickRecord)),
              0)
        << after;
    EXPECT_GT(a.crossings.size(), 100u);
  }
};

dmat4 random_rigid(Random& random, double reach) {
  return glm::rotate(glm::translate(dmat4(1), random.within(-reach, reach)), random.uniform(0, 6),
                     glm::normalize(random.within(0.1, 1)));
}

RgbSpectrum random_color(Random& random) { return {random.within(0.05, 0.95), ColorSpace::srgb}; }

SceneEdit random_capsule_edit(const Scene& scene, const ShapeAt& at, Random& random, double reach) {
  const auto& capsules = std::get<CapsulesShape>(shape_at(scene, at).geometry);
  const std::size_t i = random.below(capsules.p0.size());
  Capsule to = random_capsule(random, reach);
  // Mostly of the kind that it is.
  const Capsule was = capsule_at(scene, at, i);
  if (was.radius0 == was.radius1) to.radius1 = to.radius0;
  if (was.radius0 != was.radius1 && to.radius0 == to.radius1) to.radius1 *= 0.5f;
  // Some onto another one: which of the two is seen must not depend on their places in the tree.
  const Capsule other = capsule_at(scene, at, random.below(capsules.p0.size()));
  if (random.below(3) == 0 && (other.radius0 == other.radius1) == (was.radius0 == was.radius1))
    to = other;
  return CapsuleEdit{at, i, to};
}

SceneEdit random_edit(const Scene& scene, Random& random, std::string& what) {
  const auto last = static_cast<std::uint32_t>(scene.shapes.size() - 1);
  switch (random.below(12)) {
    case 0:
    case 1:
    case 2:
      what = "a capsule";
      return random_capsule_edit(scene, {{}, last}, random, random.below(8) ? 2.5 : 9);
    case 3:
      what = "a capsule of an object";
      return random_capsule_edit(scene, {2u, 0}, random, 1);
    case 4: {
      what = "an emissive capsule of an object";
      return CapsuleEdit{{0u, 0},
                         0,
                         {{0, 0, 0},
                          {0.1f, 0, float(random.uniform(0.3, 1))},
                          0.15f,
                          float(random.uniform(0.03, 0.1))}};
    }
    case 5: {
      what = "an instance";
      const auto i = static_cast<std::uint32_t>(random.below(scene.instances.size()));
      dmat4 to = random_rigid(random, 2.5);
      if (random.below(2))
        to = glm::scale(to, random.within(0.5, 1.5) * (random.below(2) ? 1.0 : -1.0));
      return InstanceEdit{i, to};
    }
    case 6:
    case 7: {
      const auto i = static_cast<std::uint32_t>(random.below(scene.shapes.size()));
      what = "the transform of shape " + std::to_string(i);
      dmat4 to = random_rigid(random, i == last ? 0.5 : 2);
      if (random.below(4) == 0) to = glm::scale(to, {-1, 1, 1});
      if (i == 3)
        to = glm::scale(to, dvec3(1, 1.5, random.uniform(0.5, 0.9)));  // stays an ellipsoid
      return TransformEdit{{{}, i}, to};
    }
    case 8: {
      const auto i = static_cast<std::uint32_t>(random.below(scene.materials.size()));
      what = "material " + std::to_string(i);
      if (random.below(3) == 0) return MaterialEdit{i, DiffuseMaterial{random_color(random)}};
      if (random.below(2))
        return MaterialEdit{i, ConductorMaterial{{}, {}, random_color(random), 0.2, 0.1}};
      return MaterialEdit{
          i, DielectricMaterial{*named_spectrum("glass-BK7"), random.uniform(0, 0.3), 0.1}};
    }
    case 9: {
      const auto i = static_cast<std::uint32_t>(random.below(scene.lights.size()));
      what = "light " + std::to_string(i);
      Light to = scene.lights[i];
      to.scale = random.uniform(0.2, 3);
      if (auto* point = std::get_if<PointLight>(&to.model)) point->position = random.within(-4, 4);
      return LightEdit{i, to};
    }
    case 10: {
      std::vector<std::uint32_t> emissive;
      for (std::uint32_t i = 0; i < scene.shapes.size(); ++i)
        if (scene.shapes[i].emission) emissive.push_back(i);
      const ShapeAt at{{}, emissive[random.below(emissive.size())]};
      what = "an emission";
      AreaEmission to = *shape_at(scene, at).emission;
      to.radiance = random_color(random);
      to.scale = random.uniform(1, 20);
      to.two_sided = random.below(2) == 0;
      return EmissionEdit{at, to};
    }
    default: {
      what = "the camera";
      View to = scene.view;
      to.camera.projection = PerspectiveProjection{random.uniform(0.4, 0.9)};
      to.sampler.seed = static_cast<std::uint32_t>(random.below(100));
      return to;
    }
  }
}

TEST(Edits, RandomOnesMakeWhatAFreshSceneMakes) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    Edited edited(mixed_scene(seed == 1 ? 2000 : 200));
    Random random(seed);
    std::string all;
    for (int step = 0; step < 60; ++step) {
      std::string what;
      edited.edit(random_edit(edited.live.scene(), random, what));
      all += what + "; ";
      if (step % 6 == 5) {
        edited.expect_fresh("seed " + std::to_string(seed) + " after " + all);
        if (testing::Test::HasFailure()) return;
        all.clear();
      }
    }
  }
}

// --- One by one, in place ---

class OneEdit : public testing::Test {
 protected:
  OneEdit() : edited(mixed_scene(600)) {
    for (std::uint32_t i = 0; i < edited.live.scene().shapes.size(); ++i)
      if (const Shape& shape = edited.live.scene().shapes[i]; shape.emission)
        (std::holds_alternative<CapsulesShape>(shape.geometry) ? lit_capsule : lit_tube).shape = i;
  }
  /// Made in place.
  void expect_in_place(const SceneEdit& edit, const std::string& what) {
    edited.edit(edit);
    EXPECT_EQ(edited.live.lowerings(), 1u) << what;
    edited.expect_fresh(what);
  }
  Edited edited;
  ShapeAt lit_capsule, lit_tube;
  const ShapeAt capsules{{}, static_cast<std::uint32_t>(edited.live.scene().shapes.size() - 1)};
};

TEST_F(OneEdit, AMovedCapsule) {
  Random random(1);
  for (const double reach : {2.5, 8.0})
    expect_in_place(random_capsule_edit(edited.live.scene(), capsules, random, reach), "capsule");
  // The chances of the lights depend on the bounds of the world.
  Capsule away = capsule_at(edited.live.scene(), capsules, 0);
  away.p0 += glm::vec3(40, 30, 10);
  away.p1 += glm::vec3(40, 30, 10);
  expect_in_place(CapsuleEdit{capsules, 0, away}, "capsule far away");
  expect_in_place(random_capsule_edit(edited.live.scene(), {2u, 0}, random, 1.5),
                  "capsule of an object");
  Capsule out_of_it = capsule_at(edited.live.scene(), {2u, 0}, 1);
  out_of_it.p1 = out_of_it.p0 + glm::vec3(1, -1, 3);
  out_of_it.radius0 = out_of_it.radius1 =
      out_of_it.radius0 == out_of_it.radius1 ? 0.3f : out_of_it.radius1;
  expect_in_place(CapsuleEdit{{2u, 0}, 1, out_of_it}, "capsule of an object, out of its box");
}

TEST_F(OneEdit, CapsulesMovedOntoOthers) {
  Random random(2);
  for (int i = 0; i < 150; ++i) {
    const std::size_t from = random.below(600), onto = random.below(600);
    const Capsule was = capsule_at(edited.live.scene(), capsules, from),
                  to = capsule_at(edited.live.scene(), capsules, onto);
    if ((was.radius0 == was.radius1) == (to.radius0 == to.radius1))
      edited.edit(CapsuleEdit{capsules, from, to});
  }
  edited.expect_fresh("capsules onto others");
}

TEST_F(OneEdit, ALight) {
  expect_in_place(CapsuleEdit{lit_capsule, 0, {{-1, 2, 2}, {2, 2, 3}, 0.3f, 0.3f}},
                  "an emissive capsule");
  AreaEmission to = *shape_at(edited.live.scene(), lit_tube).emission;
  to.scale = 3;
  to.two_sided = false;
  expect_in_place(EmissionEdit{lit_tube, to}, "emission");
  Light light = edited.live.scene().lights[1];
  light.scale = 4000;
  expect_in_place(LightEdit{1, light}, "light");
  expect_in_place(TransformEdit{lit_capsule, glm::translate(dmat4(1), dvec3(0, 0, 1.5))},
                  "an emissive capsule is moved");
}

// Kernels know moving capsules by the shutter's times.
TEST(AnEdit, OfTheShutterReachesCapsulesThatMove) {
  Scene scene = mixed_scene(20);
  Shape bar;
  CapsulesShape moving;
  moving.p0 = {{-2, 0, 1}, {2, 0, 1}};
  moving.p1 = {{-2, 2, 1}, {2, 2, 3}};
  moving.radius0 = {0.4F, 0.4F};
  moving.times = {0, 1};
  bar.geometry = moving;
  scene.shapes.push_back(bar);
  scene.instances.clear();
  Edited edited(scene);
  View view = edited.live.scene().view;
  view.film.shutter_open = 0.25;
  view.film.exposure_time = 0.5;
  edited.edit(view);
  edited.expect_fresh("under another shutter");
}

// What moves fast has trees for parts of the shutter's time, all of which hold what rests, too.
TEST(AnEdit, BesideWhatMovesFastReachesAllItsTrees) {
  Scene scene = mixed_scene(20);
  Shape swarm;
  CapsulesShape moving;
  for (int i = 0; i < 200; ++i) {
    const float at = static_cast<float>(i % 2) * 6 - 3, high = 0.02f * static_cast<float>(i);
    moving.p0.emplace_back(at, 0, high);
    moving.p1.emplace_back(at, 0.1f, high);
    moving.radius0.push_back(0.05f);
  }
  for (std::size_t i = 0; i < 200; ++i) {
    moving.p0.push_back(-moving.p0[i]);
    moving.p1.push_back(-moving.p1[i]);
    moving.radius0.push_back(0.05f);
  }
  moving.times = {0, 1};
  swarm.geometry = moving;
  scene.shapes.push_back(swarm);
  Edited edited(scene);
  ASSERT_GT(edited.live.flat().world.intervals, 1u);
  const ShapeAt resting{{}, static_cast<std::uint32_t>(scene.shapes.size() - 2)};
  edited.edit(CapsuleEdit{resting, 3, {{0, 0, 2}, {1, 0, 2}, 0.3f, 0.3f}});
  edited.expect_fresh("a capsule");
  edited.edit(InstanceEdit{0, glm::translate(dmat4(1), dvec3(0.5, 0.2, 1))});
  edited.expect_fresh("an instance");
}

// Motions come, go along with what they are of, and go again; other edits keep them.
TEST_F(OneEdit, AMotion) {
  const dmat4 place = glm::translate(dmat4(1), dvec3(0.5, 0.2, 1)),
              end = glm::rotate(glm::translate(place, dvec3(1, 0, 0.5)), 1.2, dvec3(0, 0, 1));
  const SceneEdit moving =
      InstanceEdit{2, place, TransformKeys{{0, place}, {1, end}}, {0, 0, 0.25}};
  const SceneEdit back = inverse(edited.live.scene(), moving);
  edited.edit(moving);
  EXPECT_TRUE(edited.live.flat().moves());
  edited.expect_fresh("an emissive instance that moves");
  edited.edit(TransformEdit{{{}, 1}, place});
  edited.expect_fresh("beside it");
  edited.edit(InstanceEdit{2, glm::translate(place, dvec3(0, 1, 0))});
  edited.expect_fresh("it goes elsewhere");
  const Instance& there = edited.live.scene().instances[2];
  EXPECT_NEAR(glm::length(dvec3(there.motion[1].matrix[3]) - dvec3(end[3]) - dvec3(0, 1, 0)), 0,
              1e-12);
  View view = edited.live.scene().view;
  view.film.shutter_open = 0.25;
  view.film.exposure_time = 0.5;
  edited.edit(view);
  edited.expect_fresh("under another shutter");
  AreaEmission light = *shape_at(edited.live.scene(), {0u, 0}).emission;
  light.scale *= 2;
  edited.edit(EmissionEdit{{0u, 0}, light});
  edited.expect_fresh("and brighter");
  edited.edit(back);
  EXPECT_FALSE(edited.live.flat().moves());
  edited.expect_fresh("at rest again");
  EXPECT_THROW(edited.edit(InstanceEdit{2, place, TransformKeys{{1, place}, {0, end}}}),
               InputError);
}

TEST_F(OneEdit, ATransform) {
  const dmat4 turned = glm::rotate(glm::translate(dmat4(1), dvec3(0.5, 0.2, 1)), 0.7,
                                   glm::normalize(dvec3(1, 2, 3)));
  for (const std::uint32_t i : {1u, 3u, 4u, 7u})
    expect_in_place(TransformEdit{{{}, i}, i == 3 ? glm::scale(turned, dvec3(1, 2, 0.5)) : turned},
                    "shape " + std::to_string(i));
  expect_in_place(InstanceEdit{0, glm::scale(turned, dvec3(1, -2, 1))}, "a mirrored instance");
  expect_in_place(InstanceEdit{2, turned}, "an emissive instance");
  // A ball that was turned is stored with its rotation: it goes again.
  expect_in_place(TransformEdit{{{}, 1}, dmat4(1)}, "turned back");
}

TEST_F(OneEdit, AMaterial) {
  expect_in_place(
      MaterialEdit{0, DiffuseMaterial{RgbSpectrum{dvec3(0.9, 0.1, 0.2), ColorSpace::srgb}}},
      "colour");
  expect_in_place(MaterialEdit{1, DielectricMaterial{*named_spectrum("glass-BK7"), 0.1, 0.1}},
                  "another kind");
}

constexpr const char* small_film =
    "Film \"rgb\" \"integer xresolution\" 96 \"integer yresolution\" 72\n";

TEST(TexturedEdits, AreThoseOfTheEditedScene) {
  const std::string world =
      std::string(small_film) +
      "WorldBegin\nLightSource \"infinite\"\nTexture \"c\" \"spectrum\" \"checkerboard\" \"rgb "
      "tex1\" [.8 .1 .1]\n"
      "\"float uscale\" 8\nMaterial \"diffuse\" \"texture reflectance\" \"c\" Shape \"sphere\"\n"
      "Material \"diffuse\" Translate 2 0 0 Shape \"sphere\" Shape \"sphere\" \"float radius\" 60 "
      "Shape \"sphere\" \"float "
      "radius\" 50";
  const MaterialEdit grey{0, DiffuseMaterial{ConstantSpectrum{0.3}}};
  MaterialEdit checks = grey;
  checks.textures = {{"reflectance", 0}};
  Edited edited(scene_of_text(world));
  edited.edit(grey);
  EXPECT_EQ(edited.live.lowerings(), 2u);
  edited.expect_fresh("a texture goes");
  EXPECT_TRUE(edited.live.scene().materials[0].textures.empty());
  edited.edit(grey);
  EXPECT_EQ(edited.live.lowerings(), 2u);  // no texture before or after: in place
  checks.material = 1;
  edited.edit(checks);
  edited.expect_fresh("a texture comes, for another");
  EXPECT_NE(edited.live.flat().materials[1].textured, 0u);
  checks.textures[0].texture = 7;
  EXPECT_THROW(edited.edit(checks), InputError);
  edited.expect_fresh("what was refused");
}

// The material keeps its displacement, whose steps a material made anew has elsewhere.
TEST(TexturedEdits, KeepWhatBendsTheNormals) {
  Edited edited(
      scene_of_text(std::string(small_film) +
                    "WorldBegin\nLightSource \"infinite\"\nTexture \"h\" \"float\" "
                    "\"checkerboard\" \"float uscale\" 8\n"
                    "Material \"diffuse\" \"texture displacement\" \"h\" Shape \"sphere\""));
  edited.edit(MaterialEdit{0, DiffuseMaterial{ConstantSpectrum{0.3}}});
  EXPECT_EQ(edited.live.lowerings(), 2u);
  EXPECT_NE(edited.live.flat().materials[0].bump, CAPLET_NONE);
  edited.expect_fresh("another colour under the same bumps");
}

// Enough lamps for a light tree, which an edit of one makes anew.
TEST(LampEdits, MakeTheLightTreeAgain) {
  std::string world =
      std::string(small_film) +
      "WorldBegin\nShape \"sphere\" \"float radius\" 60\nAreaLightSource \"diffuse\"\n";
  for (int i = 0; i < 24; ++i)
    world += "Shape \"capsule\" \"point3 p0\" [" + std::to_string(i) + " 0 0] \"point3 p1\" [" +
             std::to_string(i) + " 1 " + std::to_string(i % 5) + "] \"float radius\" 0.2\n";
  Edited edited(scene_of_text(world));
  const auto nodes = edited.live.flat().light_nodes;
  ASSERT_FALSE(nodes.empty());
  edited.edit(TransformEdit{{std::nullopt, 3}, glm::translate(glm::dmat4(1), dvec3(0, 30, 0))});
  EXPECT_NE(edited.live.flat().light_nodes, nodes);
  edited.expect_fresh("a lamp far away");
}

TEST_F(OneEdit, WhatDoesNotFitIsLoweredAgain) {
  edited.edit(CapsuleEdit{capsules, 0, {{0, 0, 2}, {0, 0, 2}, 0.3f, 0.3f}});
  EXPECT_EQ(edited.live.lowerings(), 2u);
  edited.expect_fresh("a capsule that is now a sphere");
  // A box stands straight: turned it becomes an instance.
  edited.edit(TransformEdit{{{}, 2}, glm::rotate(dmat4(1), 0.5, dvec3(0, 0, 1))});
  EXPECT_EQ(edited.live.lowerings(), 3u);
  edited.expect_fresh("a turned box");
  View wide = edited.live.scene().view;
  wide.film.space = ColorSpace::rec2020;
  edited.edit(wide);
  edited.expect_fresh("another colour space");
}

TEST_F(OneEdit, ATreeThatEditsHaveSpoiledIsBuiltAgain) {
  Random random(3);
  std::uint64_t lowerings = 1;
  for (int i = 0; i < 600 && lowerings == 1; ++i) {
    edited.edit(random_capsule_edit(edited.live.scene(), capsules, random, 2.5));
    lowerings = edited.live.lowerings();
  }
  EXPECT_EQ(lowerings, 2u);
  edited.expect_fresh("spoiled");
}

TEST_F(OneEdit, AWrongOneChangesNothing) {
  const Capsule was = capsule_at(edited.live.scene(), capsules, 3);
  EXPECT_THROW(edited.edit(CapsuleEdit{capsules, 3, {{NAN, 0, 0}, {0, 0, 1}, 1, 1}}), InputError);
  EXPECT_THROW(edited.edit(CapsuleEdit{capsules, 3, {{0, 0, 0}, {0, 0, 1}, -1, 1}}), InputError);
  EXPECT_THROW(edited.edit(CapsuleEdit{capsules, 3, {{3e18f, 0, 0}, {0, 0, 1}, 1, 1}}), InputError);
  EXPECT_THROW(edited.edit(CapsuleEdit{capsules, 600, was}), InputError);
  EXPECT_THROW(edited.edit(CapsuleEdit{{{}, 0}, 0, was}), InputError);
  EXPECT_THROW(edited.edit(TransformEdit{{{}, 1}, dmat4(0)}), InputError);
  EXPECT_THROW(edited.edit(InstanceEdit{0, glm::translate(dmat4(1), dvec3(2e18))}), InputError);
  EXPECT_THROW(edited.edit(InstanceEdit{99, dmat4(1)}), InputError);
  EXPECT_THROW(edited.edit(MaterialEdit{0, DiffuseMaterial{ConstantSpectrum{-1}}}), InputError);
  EXPECT_THROW(edited.edit(EmissionEdit{{{}, 0}, {}}), InputError);
  View view = edited.live.scene().view;
  view.camera.projection = PerspectiveProjection{4};
  EXPECT_THROW(edited.edit(view), InputError);
  EXPECT_EQ(capsule_at(edited.live.scene(), capsules, 3).p0, was.p0);
  EXPECT_TRUE(std::holds_alternative<PointLight>(edited.live.scene().lights[1].model));
  edited.expect_fresh("wrong edits");
}

// What lights hold of images is made anew where it changes, and stays where it does not.
TEST_F(OneEdit, OfLightsWithImagesIsThatOfAFreshScene) {
  const auto image = std::make_shared<EnvironmentImage>(
      EnvironmentImage{2, 1, {1, 1, 1, 2, 2, 2}, ColorSpace::srgb, false});
  const auto square =
      std::make_shared<EnvironmentImage>(EnvironmentImage{1, 1, {1, 2, 3}, ColorSpace::srgb, true});
  const auto light = [](auto model) { return Light{std::move(model), 1, {}, {}, {}}; };
  edited.edit(LightEdit{0, light(InfiniteLight{ConstantSpectrum{1}, image, glm::dmat3(1), {}})});
  edited.expect_fresh("a sky");
  edited.edit(LightEdit{1, light(InfiniteLight{ConstantSpectrum{1}, square, glm::dmat3(1), {}})});
  edited.expect_fresh("two skies");
  edited.edit(LightEdit{
      0, light(GoniometricLight{ConstantSpectrum{1}, square, dvec3(0, 0, 4), glm::dmat3(1)})});
  edited.expect_fresh("a goniometric light before a sky");
  edited.edit(LightEdit{1, light(ProjectionLight{image, 60, dvec3(0, 0, 4), glm::dmat3(1)})});
  edited.expect_fresh("a projection in the sky's place");
  const LightPortal portal = {dvec3(0, 0, 4), dvec3(0, 1, 4), dvec3(1, 1, 4), dvec3(1, 0, 4)};
  edited.edit(
      LightEdit{0, light(InfiniteLight{ConstantSpectrum{1}, square, glm::dmat3(1), portal})});
  edited.expect_fresh("a portal");
  edited.edit(LightEdit{1, light(PointLight{})});
  edited.expect_fresh("no picture but the portal's");
}

// Kernels are built for the kinds that a scene has.
TEST(EditKernels, AreBuiltForANewKindAndStay) {
  Edited edited(scene_of_text(R"(
LookAt 0 -5 1  0 0 0  0 0 1
Camera "perspective"
Film "rgb" "integer xresolution" [ 16 ] "integer yresolution" [ 12 ]
WorldBegin
LightSource "infinite"
Material "diffuse"
Shape "capsule" "point3 p0" [ -1 0 0 ] "point3 p1" [ 1 0 0.5 ] "float radius" [ 0.6 ]
)"));
  edited.expect_fresh("nothing");
  ConductorMaterial metal;
  metal.reflectance = ConstantSpectrum{0.8};
  edited.edit(MaterialEdit{0, metal});
  edited.expect_fresh("a metal");
  edited.edit(MaterialEdit{0, DiffuseMaterial{}});
  edited.expect_fresh("diffuse again");
  edited.edit(CapsuleEdit{{{}, 0}, 0, {{-1, 0, 0}, {1, 0, 0.5}, 0.6f, 0.2f}});
  edited.expect_fresh("a tapered capsule");
}

// --- What is sent ---

TEST(EditBytes, OneCapsuleOfMany) {
  Scene scene = mixed_scene(100000);
  Edited edited(scene);
  Random random(4);
  const ShapeAt at{{}, static_cast<std::uint32_t>(scene.shapes.size() - 1)};
  for (int i = 0; i < 5; ++i) {
    const std::uint64_t before = edited.device.bytes_updated();
    edited.edit(random_capsule_edit(edited.live.scene(), at, random, 2.4));
    edited.send();
    EXPECT_LT(edited.device.bytes_updated() - before, 4096u);
    EXPECT_GT(edited.device.bytes_updated() - before, 200u);
  }
  EXPECT_EQ(edited.live.lowerings(), 1u);
  std::uint64_t before = edited.device.bytes_updated();
  edited.edit(InstanceEdit{5, glm::translate(dmat4(1), dvec3(0.5))});
  edited.send();
  EXPECT_LT(edited.device.bytes_updated() - before, 4096u);
  before = edited.device.bytes_updated();
  View view = edited.live.scene().view;
  view.camera.projection = PerspectiveProjection{1};
  edited.edit(view);
  edited.send();
  EXPECT_EQ(edited.device.bytes_updated(), before);
  edited.edit(MaterialEdit{0, DiffuseMaterial{ConstantSpectrum{0.3}}});
  edited.send();
  EXPECT_LE(edited.device.bytes_updated() - before, sizeof(MaterialRecord) + 4096);
  edited.expect_fresh("bytes");
}

}  // namespace
}  // namespace caplet::test
