// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Pictures of scenes that a clipping plane cuts: faces by closed forms, and light against the same
// cut made by csg.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "lower/camera.h"
#include "lower/lower.h"
#include "render/renderer.h"
#include "scene_text.h"

namespace caplet::test {
namespace {

using glm::dvec3;

constexpr int kSize = 32;
constexpr double kCut = 0.3;

/// Looks down the z axis at [-2, 2] x [-2, 2] from z = 10, x to the right and y up. What lies above
/// z = 0.3 is cut away.
const std::string cut_from_above =
    "Scale -1 1 1\nLookAt 0 0 10  0 0 0  0 1 0\n"
    "Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]"
    " \"float clipplane\" [0 0 2 0.6]\n"
    "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32\n"
    "PixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" 0\nWorldBegin\n";

double x_of(std::size_t pixel) {
  return -2 + (static_cast<double>(pixel % kSize) + 0.5) * 4 / kSize;
}
double y_of(std::size_t pixel) {
  return 2 - (static_cast<double>(pixel / kSize) + 0.5) * 4 / kSize;
}

/// A box from -1 to 1, without some of its faces. Those of an inverted one are wound inward.
std::string box_mesh(bool has_top, bool has_bottom, bool is_inverted = false) {
  std::string faces = "0 1 5 0 5 4  2 3 7 2 7 6  1 2 6 1 6 5  0 4 7 0 7 3";
  if (has_bottom) faces += "  0 2 1 0 3 2";
  if (has_top) faces += "  4 5 6 4 6 7";
  if (is_inverted) std::ranges::reverse(faces);
  return "Shape \"trianglemesh\" \"point3 P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1"
         " -1 -1 1 1 -1 1 1 1 1 -1 1 1] \"integer indices\" [" +
         faces + "]\n";
}

struct Cut {
  const char* name;
  std::string text;
  std::function<bool(double x, double y)> is_face;
};

std::vector<Cut> cuts() {
  const auto disk = [](double radius) {
    return [radius](double x, double y) { return std::hypot(x, y) < radius; };
  };
  const auto square = [](double x, double y) { return std::max(std::abs(x), std::abs(y)) < 1; };
  const auto nowhere = [](double, double) { return false; };
  const std::string sphere = "Shape \"sphere\" \"float radius\" 1\n";
  return {
      {"sphere", sphere, disk(std::sqrt(1 - 0.09))},
      {"reversed sphere", "ReverseOrientation\n" + sphere, disk(std::sqrt(1 - 0.09))},
      {"capsule",
       "Shape \"capsule\" \"point3 p0\" [-1 0 0] \"point3 p1\" [1 0 0] \"float radius\" 0.6\n",
       [](double x, double y) {
         return std::hypot(std::max(std::abs(x) - 1, 0.0), y) < std::sqrt(0.36 - 0.09);
       }},
      {"capsule along the view",
       "Shape \"capsule\" \"point3 p0\" [0 0 -2] \"point3 p1\" [0 0 2] \"float radius\" 0.6\n",
       disk(0.6)},
      {"box", "Shape \"box\" \"point3 p0\" [-1 -1 -1] \"point3 p1\" [1 1 1]\n", square},
      {"mesh", box_mesh(true, true), square},
      {"reversed mesh", "ReverseOrientation\n" + box_mesh(true, true), square},
      {"inverted mesh", box_mesh(true, true, true), square},
      {"inverted and reversed mesh", "ReverseOrientation\n" + box_mesh(true, true, true), square},
      {"mesh below the plane", "Scale 0.2 0.2 0.2\n" + box_mesh(true, true), nowhere},
      {"inverted mesh below the plane", "Scale 0.2 0.2 0.2\n" + box_mesh(true, true, true),
       nowhere},
      {"sphere below the plane", "Scale 0.2 0.2 0.2\n" + sphere, nowhere},
      {"mirrored mesh", "Scale 1 -1 1\n" + box_mesh(true, true), square},
      {"molecular surface",
       "Shape \"molecularsurface\" \"point3 P\" [0 0 0] \"float radius\" 1 \"float probe\" 0.5\n",
       disk(std::sqrt(1 - 0.09))},
      {"instance",
       "ObjectBegin \"o\"\nScale 0.5 0.5 0.5\n" + sphere +
           "ObjectEnd\nTranslate 0 0 0.1\nObjectInstance \"o\"\n",
       disk(std::sqrt(0.25 - 0.04))},
      {"mirrored instance of a mesh",
       "ObjectBegin \"o\"\n" + box_mesh(true, true) +
           "ObjectEnd\nScale -1 1 1\nObjectInstance \"o\"\n",
       square},
      {"hollow ball",
       "ObjectBegin \"a\"\n" + sphere + "ObjectEnd\nObjectBegin \"b\"\nScale .5 .5 .5\n" + sphere +
           "ObjectEnd\nShape \"csg\" \"string operation\" \"difference\""
           " \"string operands\" [ \"a\" \"b\" ]\n",
       [](double x, double y) {
         const double from_axis = std::hypot(x, y);
         return from_axis > std::sqrt(0.25 - 0.09) && from_axis < std::sqrt(1 - 0.09);
       }},
      {"spheres that hold each other", sphere + "Scale .5 .5 .5\n" + sphere,
       disk(std::sqrt(1 - 0.09))},
      {"ball of glass", "Material \"dielectric\"\n" + sphere, disk(std::sqrt(1 - 0.09))},
  };
}

// A face lies in the plane to rounding, its normal is the plane's, and its depth is the camera's
// distance; around it the solid itself is seen, below the plane.
TEST(Clip, ClosesSolidsInThePlane) {
  for (const Cut& cut : cuts()) {
    SCOPED_TRACE(cut.name);
    Scene scene = scene_of_text(cut_from_above + cut.text);
    scene.view.filter = point_filter();
    const LayeredImage image = render_model(scene, 1, every_layer()).image;
    int faces = 0;
    for (std::size_t pixel = 0; pixel < std::size_t{kSize} * kSize; ++pixel) {
      if (!cut.is_face(x_of(pixel), y_of(pixel))) {
        if (at(image, "A", pixel) > 0) {
          EXPECT_LT(at(image, "P.Z", pixel), kCut - 1e-4) << x_of(pixel) << " " << y_of(pixel);
        }
        continue;
      }
      ++faces;
      const dvec3 p = at3(image, "P", "XYZ", pixel), n = at3(image, "N", "XYZ", pixel);
      EXPECT_NEAR(p.x, x_of(pixel), 2e-6);
      EXPECT_NEAR(p.y, y_of(pixel), 2e-6);
      EXPECT_NEAR(p.z, kCut, 2e-6);
      EXPECT_NEAR(at(image, "Z", pixel), 10 - kCut, 4e-6);
      EXPECT_EQ(n, dvec3(0, 0, 1));
    }
    EXPECT_EQ(faces >= 30, std::string(cut.name).find("below") == std::string::npos) << faces;
  }
}

// Of several solids the face is the innermost one's.
TEST(Clip, ShowsTheInnerSolid) {
  for (const char* order : {"1 0.5", "0.5 1"}) {
    const std::string text = order;
    const std::size_t space = text.find(' ');
    const auto sphere = [](const std::string& radius) {
      return "Shape \"sphere\" \"float radius\" " + radius + "\n";
    };
    Scene scene = scene_of_text(cut_from_above + sphere(text.substr(0, space)) +
                                sphere(text.substr(space + 1)));
    scene.view.filter = point_filter();
    const LayeredImage image = render_model(scene, 1, every_layer()).image;
    const unsigned inner = text.starts_with("0.5") ? 0 : 1;
    for (std::size_t pixel = 0; pixel < std::size_t{kSize} * kSize; ++pixel) {
      const double from_axis = std::hypot(x_of(pixel), y_of(pixel));
      if (from_axis >= 1) continue;
      const bool is_inner = from_axis < std::sqrt(0.25 - 0.09);
      EXPECT_EQ(channel(image, "object.id").uints[pixel], is_inner ? inner : 1 - inner);
    }
  }
}

// Open surfaces, and what lets light pass, hold nothing: one looks into them.
TEST(Clip, LeavesOpenSurfacesOpen) {
  const std::string cases[] = {
      box_mesh(true, false),
      "Material \"interface\"\n" + box_mesh(true, true) +
          "Material \"diffuse\"\nTranslate 0 0 -1\nShape \"disk\" \"float radius\" 1.6\n"};
  for (const std::string& text : cases) {
    Scene scene = scene_of_text(cut_from_above + text);
    scene.view.filter = point_filter();
    const LayeredImage image = render_model(scene, 1, every_layer()).image;
    const std::size_t middle = kSize * kSize / 2 + kSize / 2;
    EXPECT_EQ(at(image, "A", middle), text.starts_with("Material") ? 1 : 0);
    if (at(image, "A", middle) > 0) {
      EXPECT_NEAR(at(image, "P.Z", middle), -1, 1e-6);
    }
  }
}

// A camera within what is cut away that looks further away sees nothing, and one on this side sees
// no further than the plane.
TEST(Clip, EndsRaysAtThePlane) {
  const std::string head =
      "Camera \"perspective\" \"float fov\" 40 \"float clipplane\" [0 0 1 2]\n"
      "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\nWorldBegin\n"
      "Shape \"sphere\" \"float radius\" 1\nTranslate 0 0 4\nShape \"sphere\" \"float radius\" 1\n";
  const auto coverage = [&](const std::string& from) {
    return mean(channel(render_text(from + head, 16, {}, every_layer()).image, "A"));
  };
  EXPECT_EQ(coverage("LookAt 0 0 2.5  0 0 9  0 1 0\n"), 0) << "beyond the plane, looking away";
  EXPECT_EQ(coverage("LookAt 0 0 1.5  0 0 9  0 1 0\n"), 0) << "before it, looking at it";
  EXPECT_GT(coverage("LookAt 0 0 9  0 0 0  0 1 0\n"), 0.02) << "from beyond, looking back";
}

// What is cut away casts no shadow, and does not shine.
TEST(Clip, CutsShadowsAndLamps) {
  const std::string head = std::string("Scale -1 1 1\nLookAt 0 0 10  0 0 0  0 1 0\n") +
                           "Camera \"orthographic\" \"float screenwindow\" [-2 2 -2 2]" +
                           " \"float clipplane\" [0 0 1 0.5]\n" +
                           "Film \"rgb\" \"integer xresolution\" 8 \"integer yresolution\" 8\n" +
                           "Integrator \"path\" \"integer maxdepth\" 5\nWorldBegin\n";
  const std::string floor =
      "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5]\nShape \"disk\" \"float radius\" 3\n"
      "Translate 0 0 1\n";
  const std::string cap = "Shape \"disk\" \"float radius\" 3\n";
  const auto green = [&](const std::string& text) {
    return mean(channel(render_text(head + text, 64, {}, every_layer()).image, "G"));
  };
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n",
                    lamp = "AreaLightSource \"diffuse\" \"rgb L\" [9 9 9]\n";
  EXPECT_NEAR(green(sky + floor + cap), 0.5, 2e-3) << "a floor under the whole sky";
  EXPECT_EQ(green(floor + lamp + "Shape \"sphere\" \"float radius\" 0.4\n"), 0);
  EXPECT_GT(green(floor + lamp + "Translate 0 0 -0.8\nShape \"sphere\" \"float radius\" 0.1\n"),
            0.01);
  // A delta light is no solid, and is not cut.
  EXPECT_GT(green(floor + "LightSource \"point\" \"rgb I\" [9 9 9]\n"), 0.1);
}

/// The same solids twice: cut by the plane, and by csg.
std::string clipped_scene(bool by_plane) {
  std::string out =
      "LookAt 3 4 6  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 35" +
      std::string(by_plane ? " \"float clipplane\" [0 0 1 0.3]" : "") +
      "\nFilm \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 75\n"
      "Integrator \"volpath\" \"integer maxdepth\" 8\nWorldBegin\n"
      "LightSource \"infinite\" \"rgb L\" [0.6 0.7 0.9]\n"
      "LightSource \"distant\" \"point3 from\" [2 5 4] \"rgb L\" [2 2 2]\n"
      "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [.8 .2 .15]\n"
      "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\n"
      "MakeNamedMaterial \"rough\" \"string type\" \"dielectric\" \"float roughness\" 0.3\n"
      "MakeNamedMaterial \"none\" \"string type\" \"interface\"\n"
      "MakeNamedMaterial \"skin\" \"string type\" \"subsurface\" \"string name\" \"Skin1\""
      " \"float scale\" 100\nMakeNamedMedium \"fog\" \"string type\" \"homogeneous\""
      " \"rgb sigma_s\" [2 1 .5] \"rgb sigma_a\" [.1 .1 .3]\n"
      "AttributeBegin\nTranslate 0 -1 0\nNamedMaterial \"red\"\nShape \"trianglemesh\""
      " \"point3 P\" [-5 0 -5  5 0 -5  5 0 0.3  -5 0 0.3] \"integer indices\" [0 2 1 0 3 2]\n"
      "AttributeEnd\n";
  struct Solid {
    const char *material, *medium, *place, *shape;
  };
  const char* capsule =
      "\"capsule\" \"point3 p0\" [0 -1 0] \"point3 p1\" [0 1 0.4] \"float radius\" 0.5";
  const Solid solids[] = {{"none", "fog", "0 0 0", "\"sphere\" \"float radius\" 0.9"},
                          {"red", "", "0 0.2 0.1", "\"sphere\" \"float radius\" 0.3"},
                          {"glass", "fog", "1.9 0 0", "\"sphere\" \"float radius\" 0.8"},
                          {"rough", "", "0.2 1.7 0", "\"sphere\" \"float radius\" 0.7"},
                          {"skin", "", "-1.7 0 0", capsule}};
  int number = 0;
  for (const Solid& solid : solids) {
    const std::string name = std::to_string(number++),
                      material = "NamedMaterial \"" + std::string(solid.material) + "\"\n",
                      shape =
                          "Translate " + std::string(solid.place) + "\nShape " + solid.shape + "\n",
                      medium = *solid.medium
                                   ? "MediumInterface \"" + std::string(solid.medium) + "\" \"\"\n"
                                   : "";
    out += "AttributeBegin\n" + medium + material;
    if (by_plane)
      out += shape;
    else
      out += "ObjectBegin \"s" + name + "\"\n" + shape + "ObjectEnd\nObjectBegin \"c" + name +
             "\"\nShape \"box\" \"point3 p0\" [-4 -4 0.3] \"point3 p1\" [4 4 8]\n" +
             "ObjectEnd\nShape \"csg\" \"string operation\" \"difference\" \"string operands\"" +
             " [ \"s" + name + "\" \"c" + name + "\" ]\n";
    out += "AttributeEnd\n";
  }
  return out;
}

// Most random numbers are the same, so that nearly all pixels are alike: fog and glass with fog
// within, rough glass, a subsurface, and a solid within another.
TEST(Clip, LightsCutSolidsAsCsgDoes) {
  const LayeredImage by_plane = render_text(clipped_scene(true), 64, {}, every_layer()).image,
                     by_csg = render_text(clipped_scene(false), 64, {}, every_layer()).image;
  for (const char* name : {"R", "G", "B"}) {
    const Mean ours = mean_of(by_plane, name), theirs = mean_of(by_csg, name);
    EXPECT_NEAR(ours.value, theirs.value, 2 * std::hypot(ours.error, theirs.error)) << name;
    int apart = 0;
    for (std::size_t pixel = 0; pixel < 7500; ++pixel)
      apart += std::abs(at(by_plane, name, pixel) - at(by_csg, name, pixel)) > 0.05;
    EXPECT_LT(apart, 300) << name;
  }
}

// A ray that leaves glass within glass meets the face of the outer one.
TEST(Clip, ClosesWhatIsAroundGlass) {
  const auto text = [](bool by_plane) {
    const auto cut = [&](const std::string& name, const std::string& shape) {
      if (by_plane) return "Shape " + shape;
      return "ObjectBegin \"" + name + "\"\nShape " + shape + "ObjectEnd\nObjectBegin \"c" + name +
             "\"\nShape \"box\" \"point3 p0\" [-4 -4 0.3] \"point3 p1\" [4 4 8]\nObjectEnd\n" +
             "Shape \"csg\" \"string operation\" \"difference\" \"string operands\" [ \"" + name +
             "\" \"c" + name + "\" ]\n";
    };
    return "LookAt 3 4 6  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 18" +
           std::string(by_plane ? " \"float clipplane\" [0 0 1 0.3]" : "") +
           "\nFilm \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 30\n"
           "Integrator \"path\" \"integer maxdepth\" 12\nWorldBegin\n"
           "LightSource \"infinite\" \"rgb L\" [0.6 0.7 0.9]\n"
           "LightSource \"distant\" \"point3 from\" [2 5 4] \"rgb L\" [2 2 2]\n"
           "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [.8 .2 .15]\n"
           "Translate 0 -1 0\nShape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2]"
           " \"point3 P\" [-5 0 -5  5 0 -5  5 0 0.3  -5 0 0.3]\nAttributeEnd\n"
           "Material \"dielectric\"\n" +
           cut("outer", "\"sphere\" \"float radius\" 0.9\n") +
           "Material \"dielectric\" \"float eta\" 1.3\nTranslate 0.1 0.1 -0.3\n" +
           "Shape \"sphere\" \"float radius\" 0.4\n";
  };
  const LayeredImage by_plane = render_text(text(true), 64, {}, every_layer()).image,
                     by_csg = render_text(text(false), 64, {}, every_layer()).image;
  for (const char* name : {"R", "G", "B"}) {
    const double theirs = mean_of(by_csg, name).value;
    EXPECT_NEAR(mean_of(by_plane, name).value, theirs, 3e-4 * theirs) << name;
    int apart = 0;
    for (std::size_t pixel = 0; pixel < 1200; ++pixel)
      apart += std::abs(at(by_plane, name, pixel) - at(by_csg, name, pixel)) > 0.02;
    EXPECT_LT(apart, 5) << name;
  }
}

// Programs that know of planes draw what has none as others do.
TEST(Clip, LeavesOtherViewsAlone) {
  const std::string text = clipped_scene(true);
  Scene plain = scene_of_text(text);
  plain.view.clip.reset();
  const FlatScene flat = lower(plain);
  const auto words_of = [&](bool was_clipped) {
    DeviceScene scene(test_device(), flat);
    FlatView view = lower_view(was_clipped ? scene_of_text(text) : plain);
    Renderer renderer(scene, view);
    renderer.reset(lower_view(plain));
    renderer.pass(renderer.layout().window, 0, 2);
    const Film film = renderer.film().read();
    return std::vector<std::uint64_t>(film.words().begin(), film.words().end());
  };
  EXPECT_EQ(words_of(true), words_of(false));
}

TEST(Clip, PicksWhatIsSeen) {
  const Scene scene = scene_of_text(cut_from_above + "Shape \"sphere\" \"float radius\" 1\n");
  const RayRecord ray = ray_of_pixel(scene, kSize / 2, kSize / 2);
  EXPECT_NEAR(ray.t_min, 10 - kCut, 1e-6);
  EXPECT_TRUE(std::isinf(ray.t_max));
  Scene beyond = scene;
  beyond.view.clip = ClipPlane{{0, 0, 1}, 11};
  EXPECT_EQ(ray_of_pixel(beyond, 0, 0).t_min, 0);
  beyond.view.clip = ClipPlane{{0, 0, -1}, -3};
  EXPECT_NEAR(ray_of_pixel(beyond, 0, 0).t_max, 7, 1e-6);
  beyond.view.clip = ClipPlane{{0, 0, 1}, -20};
  beyond.view.camera.world_from_camera[2] *= -1;
  EXPECT_EQ(ray_of_pixel(beyond, 0, 0).t_max, 0);
}

}  // namespace
}  // namespace caplet::test
