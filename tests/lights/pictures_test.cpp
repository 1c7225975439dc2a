// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Lights with images and measured ones against sums that the tests make themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <numbers>
#include <set>

#include "light_bench.h"
#include "light_scenes.h"

namespace caplet::test::pictures_test {

namespace {

using glm::dvec3;

using std::numbers::pi;

/// Radiance of an image's white at the wavelength that the bench tells.
double white() {
  static const double radiance =
      LightBench(lower(scene_with({image_light(2, 1, false, std::vector<float>(6, 1.f))})))
          .sky({{0, 0, 1}})[0]
          .x;
  return radiance;
}

/// Intensity of a light at one point, towards a point.
double intensity(LightBench& bench, const dvec3& light, const dvec3& p) {
  return bench.sample(p, 1)[0].radiance * glm::dot(light - p, light - p);
}

/// Irradiance at p of a surface with normal n by samples, and its standard error.
struct Estimate {
  double mean = 0, error = 0;
};
Estimate irradiance(LightBench& bench, const dvec3& p, const dvec3& n, std::size_t count = 400000) {
  double mean = 0, squares = 0;
  for (const SampledLight& s : bench.sample(p, count)) {
    const double x = s.pdf > 0 ? s.radiance * std::max(0.0, glm::dot(s.wi, n)) / s.pdf : 0;
    mean += x / static_cast<double>(count);
    squares += x * x / static_cast<double>(count);
  }
  return {mean, std::sqrt(std::max(0.0, squares - mean * mean) / static_cast<double>(count))};
}

std::vector<float> grey(const std::vector<double>& values) {
  std::vector<float> rgb;
  for (const double value : values) rgb.insert(rgb.end(), 3, static_cast<float>(value));
  return rgb;
}

/// A rectangle of two triangles from the origin of its plane: x and y from 0 to 1 under m, uv = (x,
/// y).
Shape panel(const glm::dmat4& m) {
  TriangleMeshShape mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Shape shape;
  shape.geometry = mesh;
  shape.world_from_object = m;
  shape.emission = AreaEmission{};
  return shape;
}

/// The sum over a rectangle, corner + x a + y b, of radiance(x, y) times both cosines over the
/// squared distance from p.
double quadrature(const dvec3& corner, const dvec3& a, const dvec3& b, const dvec3& p,
                  const dvec3& n, const std::function<double(double, double)>& radiance) {
  constexpr int steps = 600;
  const dvec3 across = glm::cross(a, b);
  double sum = 0;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      const double x = (i + 0.5) / steps, y = (j + 0.5) / steps;
      const dvec3 to = corner + x * a + y * b - p;
      const double squared = glm::dot(to, to);
      sum += radiance(x, y) * std::abs(glm::dot(across, to)) * std::max(0.0, glm::dot(to, n)) /
             (squared * squared);
    }
  return sum / (steps * steps);
}

/// Linear between the middles of 2 x 2 texels, and as at the edges beyond; values from the top
/// left. v = 0 at the bottom.
double bilinear(const std::vector<double>& texels, double u, double v) {
  const double s = std::clamp(2 * u - 0.5, 0.0, 1.0), t = std::clamp(2 * (1 - v) - 0.5, 0.0, 1.0);
  return (1 - t) * ((1 - s) * texels[0] + s * texels[1]) +
         t * ((1 - s) * texels[2] + s * texels[3]);
}

const std::vector<double> corners = {1, 5, 0, 20};
const dvec3 p_below(0.3, -0.2, 0), up(0, 0, 1);

/// A panel over p_below that shines down.
Shape lamp() {
  glm::dmat4 m(1);
  m[0] = {2, 0, 0.5, 0};
  m[1] = {0, 1, 0, 0};
  m[3] = {-1, -0.5, 1, 1};
  Shape shape = panel(m);
  shape.reverse_orientation = true;
  shape.emission->image = picture_image(2, 2, grey(corners));
  return shape;
}

Scene scene_of(const Shape& shape) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes = {shape};
  return scene;
}

}  // namespace

TEST(Goniometric, UniformIsAPointLight) {
  GoniometricLight model;
  model.position = {1, 2, 3};
  model.image = picture_image(4, 4, std::vector<float>(48, 1.f), true);
  Light light = light_of(model);
  light.power = 60;
  LightBench bench(lower(scene_with({light})));
  PointLight plain;
  plain.position = model.position;
  Light other = light_of(plain);
  other.power = 60;
  LightBench point(lower(scene_with({other})));
  for (const dvec3& p : {dvec3(0, 0, 0), dvec3(1, 2, -4), dvec3(5, 2, 3), dvec3(1, 2, 9)})
    EXPECT_NEAR(bench.sample(p, 1)[0].radiance, point.sample(p, 1)[0].radiance,
                1e-5 * point.sample(p, 1)[0].radiance);
}

TEST(Goniometric, PowerIsThatOfAllDirections) {
  GoniometricLight model;
  model.image =
      picture_image(4, 4, grey({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}), true);
  model.world_from_light = glm::dmat3(0, 1, 0, 0, 0, 1, 1, 0, 0);
  Light light = light_of(model);
  light.power = 25;
  LightBench bench(lower(scene_with({light})));
  double sum = 0;
  constexpr std::size_t count = 4000;
  for (const dvec3& d : sphere_directions(count))
    sum += intensity(bench, {0, 0, 0}, 2.0 * d) * 4 * pi / count;
  EXPECT_NEAR(sum, 25, 0.15);
}

// The flux through a plane that holds all of the picture.
TEST(Projection, PowerIsWhatReachesAPlane) {
  ProjectionLight model;
  model.fov = 70;
  // pbrt-v4 sums at the middles of texels: of a fine image that is the integral.
  std::vector<double> texels;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 128; ++x) texels.push_back(1 + x / 32 + 4 * (y / 32));
  model.image = picture_image(128, 64, grey(texels));
  Light light = light_of(model);
  light.power = 40;
  LightBench bench(lower(scene_with({light})));
  const double h = std::tan(35 * pi / 180), w = 2 * h;
  constexpr int steps = 40;
  double sum = 0;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < 2 * steps; ++i) {
      const dvec3 p(w * ((i + 0.5) / steps - 1), h * (2 * (j + 0.5) / steps - 1), 1);
      const SampledLight s = bench.sample(p, 1)[0];
      sum += s.radiance * std::abs(s.wi.z) * (w / steps) * (2 * h / steps);
    }
  EXPECT_NEAR(sum / white(), 40, 0.02);
  for (const dvec3& outside :
       {dvec3(w * 1.001, 0, 1), dvec3(0, h * 1.001, 1), dvec3(0, 0, -1), dvec3(1, 0, 0)})
    EXPECT_EQ(bench.sample(outside, 1)[0].pdf, 0);
}

// A picture stands upright for one who looks the way of the light, x to the right and y up.
TEST(Projection, ShowsThePictureUpright) {
  ProjectionLight model;
  model.fov = 90;
  model.image = picture_image(2, 2, grey({1, 2, 3, 4}));
  LightBench bench(lower(scene_with({light_of(model)})));
  const auto at = [&](double x, double y) {
    return intensity(bench, {0, 0, 0}, {x, y, 1}) / white();
  };
  EXPECT_NEAR(at(-0.5, 0.5), 1, 1e-3);
  EXPECT_NEAR(at(0.5, 0.5), 2, 1e-3);
  EXPECT_NEAR(at(-0.5, -0.5), 3, 1e-3);
  EXPECT_NEAR(at(0.5, -0.5), 4, 1e-3);
}

TEST(Ies, AUniformProfileIsAPointLight) {
  IesLight model;
  model.profile = std::make_shared<IesProfile>(
      IesProfile{{0, 1, 2, pi}, {0, pi, 2 * pi}, std::vector<double>(12, 3.0)});
  EXPECT_NEAR(model.profile->flux(), 12 * pi, 1e-9);
  LightBench bench(lower(scene_with({light_of(model)})));
  for (const dvec3& d : sphere_directions(50))
    EXPECT_NEAR(intensity(bench, {0, 0, 0}, 2.0 * d), 3, 1e-5);
}

TEST(Ies, IsLinearBetweenAnglesAndDarkBeyond) {
  IesLight model;
  // I = (1 + theta) (phi of the first half, 2 pi - phi of the second), up to the horizon.
  IesProfile profile{{0, 0.5, pi / 2}, {0, pi / 2, pi, 2 * pi}, {}};
  for (const double azimuth : profile.azimuths)
    for (const double polar : profile.polar)
      profile.candela.push_back((1 + polar) * std::min(azimuth, 2 * pi - azimuth));
  model.profile = std::make_shared<IesProfile>(profile);
  model.position = {1, 1, 1};
  LightBench bench(lower(scene_with({light_of(model)})));
  for (const double theta : {0.2, 0.7, 1.5})
    for (const double phi : {0.3, 2.0, 4.0, 6.0}) {
      const dvec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                    -std::cos(theta));
      const double expected = (1 + theta) * std::min(phi, 2 * pi - phi);
      EXPECT_NEAR(intensity(bench, model.position, model.position + d), expected, 2e-5 * expected)
          << theta << ' ' << phi;
    }
  EXPECT_EQ(bench.sample({1, 2, 1.5}, 1)[0].pdf, 0);
  // By the integral of (1 + theta) sin theta, 1 - cos t + sin t - t cos t, and of the triangle over
  // phi, pi^2.
  EXPECT_NEAR(profile.flux(), 2 * pi * pi, 1e-9);
}

TEST(TexturedArea, IsItsImageOverUv) {
  const Shape shape = lamp();
  LightBench bench(lower(scene_of(shape)));
  const Estimate found = irradiance(bench, p_below, up);
  const double expected = quadrature({-1, -0.5, 1}, {2, 0, 0.5}, {0, 1, 0}, p_below, up,
                                     [](double x, double y) { return bilinear(corners, x, y); });
  EXPECT_NEAR(found.mean / white(), expected, 4 * found.error / white() + 1e-3 * expected);
}

// Over a capsule of a chain the image lies as over pbrt's curve: u from end to end, v by where the
// ray passes the axis.
TEST(TexturedArea, OfAChainIsItsImageAlongIt) {
  constexpr double r = 0.3, height = 0.6;
  CapsulesShape capsule{{{-1, 0, static_cast<float>(height)}},
                        {{1, 0, static_cast<float>(height)}},
                        {static_cast<float>(r)},
                        {},
                        {},
                        {{0, 1}}};
  Shape shape;
  shape.geometry = capsule;
  shape.emission = AreaEmission{};
  shape.emission->image = picture_image(2, 2, grey(corners));
  LightBench bench(lower(scene_of(shape)));
  const dvec3 p(0.4, -0.2, 0);
  const Estimate found = irradiance(bench, p, up);
  const auto radiance = [&](const dvec3& x) {
    const double offset =
        glm::dot(p - dvec3(0, 0, height), glm::normalize(glm::cross(x - p, dvec3(1, 0, 0))));
    return bilinear(corners, std::clamp(0.5 + 0.5 * x.x, 0.0, 1.0), 0.5 + offset / (2 * r));
  };
  double expected = 0;
  constexpr int steps = 1000;
  const auto add = [&](const dvec3& x, const dvec3& n, double area) {
    const dvec3 to = x - p;
    const double squared = glm::dot(to, to), here = -glm::dot(to, n), there = to.z;
    if (here > 0 && there > 0) expected += radiance(x) * here * there / (squared * squared) * area;
  };
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double phi = 2 * pi * (i + 0.5) / steps, share = (j + 0.5) / steps;
      const dvec3 side(0, std::cos(phi), std::sin(phi)), middle(0, 0, height);
      add(middle + dvec3(2 * share - 1, 0, 0) + r * side, side, 2 * 2 * pi * r / (steps * steps));
      for (const double end :
           {-1, 1}) {  // caps, by height along the axis, over which areas are even
        const dvec3 n = end * share * dvec3(1, 0, 0) + std::sqrt(1 - share * share) * side;
        // On a cap v is by the distance from the axis over the radius, wherever on it the ray comes
        // to.
        add(middle + dvec3(end, 0, 0) + r * n, n, 2 * pi * r * r / (steps * steps));
      }
    }
  EXPECT_NEAR(found.mean / white(), expected, 4 * found.error / white() + 1e-3 * expected);
}

TEST(TexturedArea, PowerIsThatOfTheImagesMean) {
  Shape shape = lamp();
  const double area = glm::length(glm::cross(dvec3(2, 0, 0.5), dvec3(0, 1, 0)));
  const double own = pi * area * 26 / 4;
  LightBench plain(lower(scene_of(shape)));
  shape.emission->power = 3 * own;
  LightBench bench(lower(scene_of(shape)));
  EXPECT_NEAR(irradiance(bench, p_below, up, 1000).mean,
              3 * irradiance(plain, p_below, up, 1000).mean,
              1e-2 * irradiance(plain, p_below, up, 1000).mean);
}

// Light comes where rays are stopped: by the chance of it, here a picture of it over uv.
TEST(TexturedArea, ShinesWhereItIsThere) {
  Shape shape = lamp();
  shape.emission->image = nullptr;
  Scene scene = scene_of(shape);
  Texture texture;
  texture.is_float = true;
  BilerpTexture bilerp;
  const std::vector<double> values = {0, 0.2, 0.5, 1};  // of (0 0), (0 1), (1 0), (1 1)
  bilerp.v00 = values[0];
  bilerp.v01 = values[1];
  bilerp.v10 = values[2];
  bilerp.v11 = values[3];
  texture.model = bilerp;
  scene.textures = {texture};
  TextureOperand alpha(1);
  alpha.texture = 0;
  scene.shapes[0].alpha = alpha;
  const double expected =
      quadrature({-1, -0.5, 1}, {2, 0, 0.5}, {0, 1, 0}, p_below, up, [&](double x, double y) {
        return (1 - x) * ((1 - y) * values[0] + y * values[1]) +
               x * ((1 - y) * values[2] + y * values[3]);
      });
  for (const bool two_sided : {false, true}) {
    scene.shapes[0].emission->two_sided = two_sided;
    LightBench bench(lower(scene));
    const Estimate found = irradiance(bench, p_below, up);
    EXPECT_NEAR(found.mean, expected, 4 * found.error + 1e-4 * expected) << two_sided;
  }
}

// pbrt-v4: a light with the number 0 for alpha shines as if it were there, and no ray meets it.
TEST(TexturedArea, OfAlphaZeroShinesUnseen) {
  Shape shape = lamp();
  LightBench bench(lower(scene_of(shape)));
  shape.alpha = TextureOperand(0);
  LightBench unseen(lower(scene_of(shape)));
  const std::vector<SampledLight> expected = bench.sample(p_below, 100),
                                  found = unseen.sample(p_below, 100);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].radiance, expected[i].radiance);
    EXPECT_EQ(found[i].pdf, expected[i].pdf);
    EXPECT_EQ(found[i].delta, found[i].pdf > 0);
  }
}

// Each point of an unseen tube that shines to both sides gives light, through the near side too.
// The sum over z and phi of the cosines over the squared distance is exact to 1e-6 by the midpoint
// rule of 2,000 by 400 points.
TEST(TexturedArea, OfAlphaZeroShinesFromItsFarSide) {
  constexpr double r = 0.3, z_min = -1, z_max = 2;
  const dvec3 p(1, 0.5, 0.25), n(-1, 0, 0);
  double expected = 0;
  for (int j = 0; j < 400; ++j)
    for (int i = 0; i < 2000; ++i) {
      const double phi = 2 * pi * (i + 0.5) / 2000, z = z_min + (z_max - z_min) * (j + 0.5) / 400;
      const dvec3 out(std::cos(phi), std::sin(phi), 0), away = r * out + dvec3(0, 0, z) - p;
      const double squared = glm::dot(away, away);
      expected +=
          std::abs(glm::dot(out, away)) * std::max(0.0, glm::dot(n, away)) / (squared * squared);
    }
  expected *= 2 * pi * r * (z_max - z_min) / (400 * 2000);
  for (const bool pbrts_form : {true, false}) {
    SCOPED_TRACE(pbrts_form);
    Shape tube;
    if (pbrts_form)
      tube.geometry = OpenCylinderShape{r, z_min, z_max};
    else
      tube.geometry = CylinderShape{{0, 0, z_min}, {0, 0, z_max}, r, {Cap::open, Cap::open}};
    tube.emission = AreaEmission{};
    tube.emission->two_sided = true;
    tube.alpha = TextureOperand(0);
    LightBench bench(lower(scene_of(tube)));
    const Estimate found = irradiance(bench, p, n);
    EXPECT_NEAR(found.mean, expected, 4 * found.error);
    EXPECT_LT(found.error, 0.01 * expected);
    // Shadow rays go to both sides: what lies within the tube shades the far one alone.
    int near = 0, far = 0;
    for (const SampledLight& s : bench.sample(p, 20000))
      if (s.pdf > 0)
        ++(s.target.x * (p.x - s.target.x) + s.target.y * (p.y - s.target.y) > 0 ? near : far);
    EXPECT_GT(near, 300);
    EXPECT_GT(far, 300);
  }
}

// Three unseen balls as one shape, in a row: a ray crosses it six times, and each crossing gives
// light. A ball of radius r at the distance d gives pi r^2 / d^2 times the cosine by one of its
// sides, and as much by the other.
TEST(TexturedArea, OfAlphaZeroShinesFromAllItsCrossings) {
  CsgShape row{CsgShape::Operation::set_union, {}};
  double expected = 0;
  for (const auto& [center, radius] :
       {std::pair(dvec3(0, 0, 1), 0.25), {dvec3(0.1, 0, 2), 0.5}, {dvec3(0, 0.1, 4), 1.0}}) {
    Shape ball;
    ball.geometry = SphereShape{static_cast<float>(radius)};
    ball.world_from_object = glm::translate(glm::dmat4(1), center);
    row.operands.push_back(std::make_shared<const Shape>(ball));
    const double distance = glm::length(center);
    expected += pi * radius * radius / (distance * distance) * center.z / distance;
  }
  for (const bool two_sided : {false, true}) {
    SCOPED_TRACE(two_sided);
    Shape shape;
    shape.geometry = row;
    shape.emission = AreaEmission{};
    shape.emission->two_sided = two_sided;
    shape.alpha = TextureOperand(0);
    LightBench bench(lower(scene_of(shape)));
    const Estimate found = irradiance(bench, {0, 0, 0}, {0, 0, 1});
    const double wanted = (two_sided ? 2 : 1) * expected;
    EXPECT_NEAR(found.mean, wanted, 4 * found.error);
    EXPECT_LT(found.error, 0.01 * wanted);
  }
}

// The far side of a ball that lets rays through is found by rays alone: no sample lies there.
TEST(TexturedArea, WhatLiesBehindItsOwnFrontHasNoDensity) {
  Shape ball;
  ball.geometry = SphereShape{1};
  ball.emission = AreaEmission{};
  ball.emission->two_sided = true;
  ball.alpha = TextureOperand(0.5);
  LightBench bench(lower(scene_of(ball)));
  const std::vector<double> densities =
      bench.area_pdf(0, {0, 0, 4},
                     {{{0, 0, 1}, {0, 0, 1}, 1},
                      {{0, 0, -1}, {0, 0, -1}, 1},
                      {{0.2, 0, -std::sqrt(0.96)}, {0.2, 0, -std::sqrt(0.96)}, 1}});
  EXPECT_GT(densities[0], 0);
  EXPECT_EQ(densities[1], 0);
  EXPECT_EQ(densities[2], 0);
}

namespace {

const LightPortal window = {{{-1, -0.5, 2}, {-1, 0.5, 2}, {1, 0.5, 2}, {1, -0.5, 2}}};

std::vector<float> uneven(int side) {
  std::vector<double> values;
  for (int i = 0; i < side * side; ++i) values.push_back(i % 7 == 0 ? 20 : 0.1 * (i % 5));
  return grey(values);
}

Light portal_light() {
  Light light = image_light(16, 16, true, uneven(16));
  std::get<InfiniteLight>(light.model).portal = window;
  return light;
}

bool is_through(const dvec3& p, const dvec3& d) {
  if (!(d.z > 0) || !(p.z < 2)) return false;
  const dvec3 at = p + d * ((2 - p.z) / d.z);
  return std::abs(at.x) < 1 && std::abs(at.y) < 0.5;
}

}  // namespace

TEST(Portal, ShowsWhatIsThroughItAlone) {
  LightBench bench(lower(scene_with({portal_light()}))),
      open(lower(scene_with({image_light(16, 16, true, uneven(16))})));
  const std::vector<dvec3> directions = sphere_directions(20000);
  for (const dvec3& p : {dvec3(0, 0, 0), dvec3(3, 1, 1), dvec3(0.2, 0.1, 1.99), dvec3(0, 0, 2.5)}) {
    const std::vector<glm::dvec2> sky = bench.sky(directions, p);
    int inside = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      if (!is_through(p, directions[i])) {
        EXPECT_EQ(sky[i].x, 0);
      }
      inside += sky[i].x > 0;
    }
    EXPECT_EQ(inside > 0, p.z < 2);
  }
}

// The image is resampled at the middles of texels, so that a fine image changes little; the mean
// over many directions is the sky's.
TEST(Portal, GivesTheSkysLight) {
  std::vector<double> values;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) values.push_back(1 + std::sin(0.1 * x) * std::cos(0.07 * y));
  const Light sky = image_light(128, 128, true, grey(values));
  Light light = sky;
  std::get<InfiniteLight>(light.model).portal = window;
  LightBench bench(lower(scene_with({light}))), open(lower(scene_with({sky})));
  const dvec3 p(0.5, 0.3, 0.4), n = glm::normalize(dvec3(0.2, 0, 1));
  const std::vector<dvec3> directions = sphere_directions(400000);
  const std::vector<glm::dvec2> radiance = open.sky(directions);
  double expected = 0;
  for (std::size_t i = 0; i < directions.size(); ++i)
    if (is_through(p, directions[i]))
      expected += radiance[i].x * std::max(0.0, glm::dot(directions[i], n)) * 4 * pi / 400000;
  const Estimate found = irradiance(bench, p, n);
  EXPECT_NEAR(found.mean, expected, 4 * found.error + 4e-3 * expected);
}

// Over every direction that a point sees through the portal, the densities have the integral 1; and
// those of samples are those that rays find.
TEST(Portal, DensityIsThatOfTheSamples) {
  LightBench bench(lower(scene_with({portal_light()})));
  const std::vector<dvec3> directions = sphere_directions(1000000);
  for (const dvec3& p : {dvec3(0, 0, 0), dvec3(2.5, 1, 1.5), dvec3(0.2, 0.1, 1.8)}) {
    double sum = 0;
    for (const glm::dvec2& sky : bench.sky(directions, p))
      if (sky.x > 0) sum += sky.y * 4 * pi / 1000000;
    EXPECT_NEAR(sum, 1, 0.01);
    const std::vector<SampledLight> samples = bench.sample(p, 2000);
    std::vector<dvec3> sampled;
    for (const SampledLight& s : samples) {
      ASSERT_GT(s.pdf, 0);
      EXPECT_TRUE(is_through(p, s.wi));
      sampled.push_back(s.wi);
    }
    const std::vector<glm::dvec2> sky = bench.sky(sampled, p);
    int apart = 0;
    for (std::size_t i = 0; i < samples.size(); ++i)
      apart +=
          std::abs(sky[i].x - samples[i].radiance) > 1e-3 * samples[i].radiance ||
          (samples[i].pdf > 0.02 && std::abs(sky[i].y - samples[i].pdf) > 3e-3 * samples[i].pdf);
    EXPECT_LE(apart, 4);  // on borders of texels
  }
}

// A constant sky through a portal is an emissive panel there.
TEST(Portal, OfOneRadianceIsAPanel) {
  InfiniteLight model;
  model.portal = window;
  LightBench bench(lower(scene_with({light_of(model)})));
  const dvec3 p(0.5, 0.3, 0.4);
  const Estimate found = irradiance(bench, p, up);
  const double expected =
      quadrature({-1, -0.5, 2}, {2, 0, 0}, {0, 1, 0}, p, up, [](double, double) { return 1; });
  EXPECT_NEAR(found.mean, expected, 4 * found.error + 1e-3 * expected);
}

TEST(Skies, AreTheSumOfSeveral) {
  const Light first = image_light(4, 2, false, grey({1, 2, 3, 4, 5, 6, 7, 8})),
              second = image_light(4, 4, true, uneven(4)), third = light_of(InfiniteLight{}),
              fourth = portal_light();
  const std::vector<dvec3> directions = sphere_directions(500);
  std::vector<double> sums(directions.size(), 0);
  for (const Light& one : {first, second, third, fourth}) {
    const std::vector<glm::dvec2> sky = LightBench(lower(scene_with({one}))).sky(directions);
    for (std::size_t i = 0; i < sky.size(); ++i) sums[i] += sky[i].x;
  }
  const FlatScene flat = lower(scene_with({first, third, second, fourth, first}));
  const std::vector<glm::dvec2> all = LightBench(flat).sky(directions),
                                again = LightBench(lower(scene_with({first}))).sky(directions);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR(all[i].x, sums[i] + again[i].x, 1e-4 * all[i].x);
  // An image that is named twice is there once: 8 texels, 16, and 256 as the portal shows them.
  EXPECT_EQ(flat.light_texels.size(), 4u * (8 + 16 + 256));
}

// Lights at one point in a tree: whatever lights a point has a chance there.
TEST(LightTree, KnowsWhereLightsWithImagesShine) {
  std::vector<Light> lights;
  for (int i = 0; i < 24; ++i) {
    const dvec3 at(i % 5, i / 5, 0.3 * (i % 3));
    const double turn = 0.7 * i;
    const glm::dmat3 rotation(std::cos(turn), std::sin(turn), 0, 0, 0, 1, std::sin(turn),
                              -std::cos(turn), 0);
    if (i % 3 == 0) {
      ProjectionLight model;
      model.image = picture_image(2, 1, grey({1, 3}));
      model.fov = 100;
      model.position = at;
      model.world_from_light = rotation;
      lights.push_back(light_of(model));
    } else if (i % 3 == 1) {
      GoniometricLight model;
      model.image = picture_image(2, 2, grey({1, 0, 0, 0}), true);
      model.position = at;
      model.world_from_light = rotation;
      lights.push_back(light_of(model));
    } else {
      IesLight model;
      model.profile = std::make_shared<IesProfile>(IesProfile{{0, 1, pi / 2}, {0}, {5, 1, 0}});
      model.position = at;
      model.world_from_light = rotation;
      lights.push_back(light_of(model));
    }
  }
  const FlatScene flat = lower(scene_with(lights));
  ASSERT_FALSE(flat.light_nodes.empty());
  LightBench bench(flat);
  std::vector<LightBench> alone;
  for (const Light& light : lights) alone.emplace_back(lower(scene_with({light})));
  for (const dvec3& p : {dvec3(0.5, 0.5, 1), dvec3(7, -3, 0.1), dvec3(2.2, 2.7, -2)}) {
    const std::vector<double> chances = bench.chances({p, {}}, lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
      const bool reaches = alone[i].sample(p, 1)[0].pdf > 0;
      EXPECT_TRUE(!reaches || chances[i] > 0) << i;
    }
  }
}

}  // namespace caplet::test::pictures_test
