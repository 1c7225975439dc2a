// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A small scene of many kinds, and pictures of live scenes and of the same scenes lowered afresh.
#pragma once

#include <cstdint>
#include <vector>

#include "lower/live_scene.h"
#include "lower/lower.h"
#include "render/renderer.h"
#include "render_scene.h"
#include "support/test_device.h"

namespace caplet::test {

inline constexpr const char* some_text = R"(
Integrator "path" "integer maxdepth" [ 3 ]
LookAt 5 -7 4  0 0 0.3  0 0 1
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" [ 40 ] "integer yresolution" [ 30 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.2 0.25 0.3 ]
LightSource "point" "rgb I" [ 6 5 4 ] "point3 from" [ 3 -3 5 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.7 0.1 0.1 ]
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" [ "metal-Au-eta" ] "spectrum k" [ "metal-Au-k" ] "float roughness" [ 0.2 ]
MakeNamedMaterial "glass" "string type" "dielectric"
NamedMaterial "red"
Shape "disk" "float radius" [ 8 ] "float height" [ -1 ]
NamedMaterial "gold"
Shape "sphere" "float radius" [ 0.6 ]
Shape "box" "point3 p0" [ 1 1 0 ] "point3 p1" [ 2 2 1 ]
Translate -1 0 0
Shape "capsule" "point3 p0" [ 0 -1 0 ] "point3 p1" [ 0 1 0.5 ] "float radius" [ 0.3 ]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [ 8 8 8 ]
  Shape "cylinder" "float radius" [ 0.2 ] "float zmin" [ 1 ] "float zmax" [ 2 ]
AttributeEnd
ObjectBegin "twig"
  NamedMaterial "glass"
  Shape "capsule" "point3 p0" [ 0 0 0 ] "point3 p1" [ 0 0 1 ] "float radius" [ 0.2 ]
ObjectEnd
ObjectInstance "twig"
Translate 0.5 -2 0
ObjectInstance "twig"
)";

inline Scene some_scene() { return test::scene_of_text(some_text); }

/// A sphere, and before it three capsules that are much thinner than a pixel, with a least width.
inline Scene thin_scene() {
  Scene scene = test::scene_of_text(
      "LookAt 0 -5 0  0 0 0  0 0 1\nCamera \"perspective\" \"float fov\" [ 40 ]\n"
      "Film \"rgb\" \"float leastwidth\" [ 4 ]\nWorldBegin\nLightSource \"infinite\"\n"
      "Translate 0 2 0\nShape \"sphere\"\n");
  CapsulesShape lines;
  for (const float z : {-0.6f, 0.0f, 0.6f}) {
    lines.p0.emplace_back(-1, 0, z);
    lines.p1.emplace_back(1, 0, z);
    lines.radius0.push_back(1e-4f);
  }
  Shape shape;
  shape.geometry = lines;
  scene.shapes.push_back(shape);
  return scene;
}

inline std::vector<std::uint64_t> picture_of(const FlatScene& flat, const FlatView& view,
                                             std::uint32_t samples = 2) {
  DeviceScene scene(test::test_device(), flat);
  Renderer renderer(scene, view);
  renderer.pass(renderer.layout().window, 0, samples, {});
  const Film film = renderer.film().read();
  return {film.words().begin(), film.words().end()};
}

inline std::vector<std::uint64_t> picture_of(const LiveScene& live, std::uint32_t samples = 2) {
  return picture_of(live.flat(), live.view(), samples);
}
inline std::vector<std::uint64_t> fresh_picture_of(const Scene& scene, std::uint32_t samples = 2) {
  return picture_of(lower(scene), lower_view(scene), samples);
}

}  // namespace caplet::test
