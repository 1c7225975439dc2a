// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The camera of OpenCV's model, against points that OpenCV 5.0.0's projectPoints projected.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "camera_rays.h"
#include "scene/camera.h"
#include "scene/scene.h"

namespace caplet::test::opencv_camera_test {
namespace {

using sampling_test::camera_ray;
using sampling_test::camera_spread;

struct Calibrated {
  std::array<double, 6> intrinsics;
  std::array<double, 8> distortion;
  std::array<std::array<double, 5>, 4> points;
};

// width, height, fx, fy, cx, cy; k1 k2 p1 p2 k3 k4 k5 k6; x y z and the pixel, four times. y goes
// down.
const std::vector<Calibrated> calibrated = {
    {{640, 480, 760.0672, 790.2581, 336.5411, 223.5124},
     {0, 0, 0, 0, 0, 0, 0, 0},
     {{{-0.075, 0.098, 0.545, 231.944696330, 365.613856514},
       {0.794, 0.656, 4.477, 471.339705495, 339.306305204},
       {-0.365, -0.214, 2.666, 232.480886947, 160.078328957},
       {-0.264, 0.097, 5.205, 297.990141153, 238.239592257}}}},
    {{1920, 1080, 3062.4966, 3152.1242, 967.3308, 569.3376},
     {-0.16388, -0.02597, 0, 0, 0, 0, 0, 0},
     {{{0.039, -0.096, 0.803, 1115.662782679, 193.526906315},
       {0.04, -0.131, 8.296, 982.096276294, 519.565442010},
       {0.266, -0.019, 4.723, 1139.720861788, 556.663652737},
       {-0.247, -0.273, 2.135, 614.762547549, 168.252431452}}}},
    {{1280, 720, 1614.3812, 1566.0477, 632.1722, 330.2241},
     {0.08202, -0.02683, -0.00186, 0.00304, 0, 0, 0, 0},
     {{{0.056, 0.773, 5.938, 647.495340944, 534.236463832},
       {0.724, -0.612, 5.1, 862.462869272, 141.425069272},
       {0.03, 0.493, 3.571, 645.843389736, 546.608665767},
       {0.227, -0.496, 3.795, 729.083282174, 124.965724498}}}},
    {{800, 800, 684.272, 660.3361, 418.9803, 392.7668},
     {0.1415, 0.0385, 0.00084, 0.0011, 0.00706, 0, 0, 0},
     {{{-0.802, -0.11, 2.536, 199.616885331, 363.778370515},
       {-0.91, -2.993, 8.727, 346.438921488, 162.287585472},
       {-0.8, 0.484, 3.054, 237.421225115, 498.860898329},
       {0.474, 0.243, 1.619, 622.738537079, 493.590907322}}}},
    {{640, 480, 914.9323, 955.6421, 344.235, 244.1831},
     {-0.19182, -0.02113, 0.00342, 0.00042, -0.01278, 0.07681, 0.02831, 0.01394},
     {{{-0.212, -0.091, 2.536, 267.947636929, 210.005702805},
       {-1.136, 0.593, 4.476, 117.057446870, 368.333014515},
       {0.019, -0.467, 6.886, 346.756980282, 179.497854033},
       {-0.197, -0.038, 0.758, 111.119578249, 197.439445224}}}},
    {{1920, 1080, 1219.5481, 1276.5191, 969.4656, 535.6932},
     {0, 0, 0, 0, 0, 0, 0, 0},
     {{{0.071, 0.787, 3.426, 994.739363894, 828.927447431},
       {0.339, 0.403, 3.521, 1086.883039903, 681.798623828},
       {0.127, 1.352, 8.228, 988.289446463, 745.446946135},
       {-0.219, 0.145, 0.544, 478.507817096, 875.941857169}}}},
    {{1280, 720, 1700.1923, 1752.9879, 618.2058, 355.1342},
     {0.0761, -0.04786, 0, 0, 0, 0, 0, 0},
     {{{0.388, 0.432, 4.861, 754.059432628, 511.090940652},
       {0.29, -0.172, 2.187, 844.055944733, 217.022110541},
       {-0.22, -0.319, 3.442, 509.431770717, 192.514149379},
       {0.858, 0.081, 3.391, 1050.421695961, 397.204861401}}}},
    {{800, 800, 638.9417, 667.8244, 396.6687, 428.8237},
     {-0.04379, 0.02817, 0.00317, 0.00194, 0, 0, 0, 0},
     {{{0.612, -0.779, 7.965, 445.732969740, 363.606125504},
       {-0.082, 0.358, 1.084, 348.615765764, 648.991533689},
       {-0.506, -0.152, 8.583, 359.024470712, 417.010925908},
       {-1.377, 1.434, 6.25, 256.521186142, 581.720717037}}}},
    {{640, 480, 824.8285, 835.5201, 348.2936, 229.9609},
     {-0.09069, -0.01956, -0.00359, -0.0023, 0.01662, 0, 0, 0},
     {{{0.916, -0.849, 5.632, 481.792559015, 104.387636144},
       {-0.238, 0.298, 6.104, 316.142350387, 270.718218994},
       {-0.604, 0.894, 4.46, 237.170465954, 396.227858812},
       {0.091, 0.135, 2.063, 384.620343059, 284.549846960}}}},
    {{1920, 1080, 1090.6598, 1081.0093, 975.8418, 558.9133},
     {0.042, -0.03302, 0.00331, 0.00242, 0.01511, 0.00466, 0.08313, -0.09067},
     {{{-1.608, -0.951, 2.649, 316.751560714, 173.574699358},
       {-1.757, -1.27, 5.32, 615.969407912, 301.371099687},
       {-1.139, 0.098, 1.911, 326.231801651, 615.672512158},
       {0.671, -1.126, 3.14, 1209.879858044, 171.039385857}}}},
    {{1280, 720, 1961.1845, 1968.7148, 658.6952, 369.4816},
     {0, 0, 0, 0, 0, 0, 0, 0},
     {{{0.239, -0.458, 5.382, 745.786076161, 201.946970048},
       {-1.939, 0.655, 8.661, 219.630802644, 518.368356033},
       {0.536, -0.413, 3.379, 969.791646286, 128.854428529},
       {-0.543, -0.617, 5.826, 475.907149279, 160.985714041}}}},
    {{800, 800, 1101.7632, 1081.2397, 421.7686, 417.8276},
     {-0.19834, 0.06503, 0, 0, 0, 0, 0, 0},
     {{{0.99, -0.938, 5.376, 622.125166335, 231.530993100},
       {0.075, 0.059, 1.318, 484.398702502, 466.178837255},
       {0.514, 0.428, 7.503, 497.127254810, 479.408709383},
       {0.948, -0.699, 6.637, 578.166756412, 304.656851379}}}},
    {{640, 480, 930.5605, 967.1266, 299.6907, 211.6021},
     {0.01032, -0.0178, 0.00051, 0.00356, 0, 0, 0, 0},
     {{{-0.185, -0.284, 4.38, 260.418057510, 148.915558710},
       {0.356, -0.445, 3.735, 388.533683216, 96.296220365},
       {-1.239, 0.616, 7.56, 147.408756573, 290.361794781},
       {-0.221, -0.114, 5.086, 259.275773201, 189.932317576}}}},
    {{1920, 1080, 1414.202, 1378.4806, 949.7911, 537.4455},
     {-0.21739, 0.06291, 0.00063, -0.0016, -0.0169, 0, 0, 0},
     {{{0.429, -0.337, 1.632, 1312.129864529, 259.904122650},
       {-2.914, -1.926, 8.204, 465.451599559, 225.830369937},
       {-1.666, -0.816, 7.579, 642.591838021, 390.897908561},
       {0.516, -0.734, 4.196, 1121.785302868, 298.863177301}}}},
    {{1280, 720, 1884.5628, 1861.0763, 652.6529, 335.8085},
     {0.04093, 0.06647, 0.00261, 0.00139, -0.00517, -0.08716, 0.00376, 0.05149},
     {{{-0.792, -0.277, 5.057, 356.730926530, 233.709198358},
       {0.182, 0.19, 1.569, 872.339622661, 562.354223366},
       {-0.955, 0.561, 5.978, 350.316202160, 511.417041254},
       {0.871, 1.262, 8.483, 847.268006206, 614.310189005}}}},
    {{800, 800, 1141.8621, 1173.5049, 393.7012, 408.4737},
     {0, 0, 0, 0, 0, 0, 0, 0},
     {{{-1.074, 0.844, 6.94, 216.992281354, 551.188128761},
       {0.431, -0.122, 3.715, 526.175645518, 369.935988614},
       {-0.277, -1.803, 7.677, 352.500756897, 132.867430012},
       {0.133, -0.315, 5.158, 423.144328984, 336.807541896}}}},
    {{640, 480, 828.0347, 818.2193, 339.8384, 265.1678},
     {-0.09503, -0.02933, 0, 0, 0, 0, 0, 0},
     {{{0.221, 0.323, 1.758, 443.433749158, 414.781612390},
       {0.826, 0.939, 8.325, 421.817942839, 357.257746255},
       {-2.035, -1.753, 8.897, 152.129507395, 105.387389522},
       {-1.252, -0.868, 5.387, 148.892462046, 134.355975609}}}},
    {{1920, 1080, 1902.5287, 1950.1665, 941.4334, 564.8657},
     {-0.16312, 0.06537, -0.00346, -0.00021, 0, 0, 0, 0},
     {{{-1.047, -0.266, 3.154, 320.884732011, 402.482656850},
       {0.165, -0.028, 0.983, 1259.315972437, 509.373682604},
       {3.048, 1.2, 8.289, 1623.446135526, 839.069287782},
       {-0.429, -0.127, 2.431, 607.363053053, 463.267667546}}}},
    {{1280, 720, 815.8682, 777.7691, 640.2002, 337.388},
     {-0.17948, 0.07907, -0.00013, -0.00253, 0.00679, 0, 0, 0},
     {{{-0.769, 0.12, 2.905, 426.485597923, 369.150842462},
       {0.091, 0.551, 5.058, 654.819870584, 421.919585022},
       {-0.936, 1.72, 7.924, 544.677599273, 504.497015248},
       {-0.53, -0.32, 1.462, 352.260249589, 171.850791667}}}},
    {{800, 800, 1262.0451, 1317.7759, 383.84, 428.1945},
     {-0.16687, 0.02597, -2e-05, 0.00332, -0.01838, -0.03693, 0.01999, -0.08672},
     {{{-0.879, -0.259, 7.987, 245.341083899, 385.565965867},
       {0.901, 0.883, 6.969, 546.588224425, 594.593249595},
       {0.661, 0.854, 6.293, 516.110103490, 606.464214400},
       {0.227, -0.2, 1.925, 532.406236306, 291.613472388}}}},
};

Scene scene_of(const Calibrated& of) {
  Scene scene;
  const auto& [width, height, fx, fy, cx, cy] = of.intrinsics;
  const auto& [k1, k2, p1, p2, k3, k4, k5, k6] = of.distortion;
  scene.view.film.width = static_cast<int>(width);
  scene.view.film.height = static_cast<int>(height);
  OpencvProjection camera;
  camera.fx = fx, camera.fy = fy, camera.cx = cx, camera.cy = cy;
  camera.k1 = k1, camera.k2 = k2, camera.k3 = k3, camera.k4 = k4, camera.k5 = k5, camera.k6 = k6;
  camera.p1 = p1, camera.p2 = p2;
  scene.view.camera.projection = camera;
  return scene;
}

TEST(OpencvCamera, ProjectsAsOpencvDoes) {
  ASSERT_EQ(calibrated.size(), 20u);
  for (const Calibrated& of : calibrated) {
    const Scene scene = scene_of(of);
    for (const auto& [x, y, z, column, row] : of.points) {
      const auto found = project(scene.view.camera, scene.view.film, {x, -y, z});
      ASSERT_TRUE(found);
      // Its numbers have nine digits; its pixels count from the middle of the first.
      EXPECT_NEAR(found->x - 0.5, column, 1e-8);
      EXPECT_NEAR(found->y - 0.5, row, 1e-8);
    }
  }
}

// The ray through that pixel goes to the point; on a device, to some roundings of floats.
TEST(OpencvCamera, RaysGoToThePoint) {
  for (const Calibrated& of : calibrated) {
    const Scene scene = scene_of(of);
    for (const auto& [x, y, z, column, row] : of.points) {
      const glm::dvec3 wanted = glm::normalize(glm::dvec3(x, -y, z));
      const glm::dvec2 raster(column + 0.5, row + 0.5);
      EXPECT_LT(
          glm::length(unproject(scene.view.camera, scene.view.film, raster).direction - wanted),
          1e-10);
      const RayRecord there = camera_ray(scene, raster, {0.5f, 0.5f});
      EXPECT_LT(glm::length(glm::dvec3(there.dx, there.dy, there.dz) - wanted), 2e-6);
      EXPECT_EQ(glm::dvec3(there.ox, there.oy, there.oz), glm::dvec3(0));
    }
  }
}

// Intrinsics of a picture of another size, and those that are not given.
TEST(OpencvCamera, IntrinsicsAreOfTheirPicture) {
  Scene scene = scene_of(calibrated[1]);
  const glm::dvec3 point(0.4, -0.3, 5);
  const glm::dvec2 whole = project(scene.view.camera, scene.view.film, point).value();
  auto& camera = std::get<OpencvProjection>(scene.view.camera.projection);
  camera.width = 1920, camera.height = 1080;
  scene.view.film.width = 480, scene.view.film.height = 270;
  const glm::dvec2 quarter = project(scene.view.camera, scene.view.film, point).value();
  EXPECT_NEAR(quarter.x, whole.x / 4, 1e-9);
  EXPECT_NEAR(quarter.y, whole.y / 4, 1e-9);

  Scene plain;
  plain.view.film.width = 400, plain.view.film.height = 300;
  plain.view.camera.projection = OpencvProjection{};
  // Focal length 400 pixels, in the middle of the picture: 200 + 400 * 0.3, 150 - 400 * 0.2.
  const glm::dvec2 found = project(plain.view.camera, plain.view.film, {0.6, 0.4, 2}).value();
  EXPECT_NEAR(found.x, 320, 1e-9);
  EXPECT_NEAR(found.y, 70, 1e-9);
  EXPECT_FALSE(project(plain.view.camera, plain.view.film, {0.6, 0.4, -2}));
}

// r (1 - r^2) is greatest at sqrt(1 / 3), where it is 0.385: places beyond are not reached, and
// points beyond not seen.
TEST(OpencvCamera, EndsAtItsFold) {
  Scene scene;
  scene.view.film.width = scene.view.film.height = 200;
  OpencvProjection camera;
  camera.fx = 100;
  camera.k1 = -1;
  scene.view.camera.projection = camera;
  const double fold = std::sqrt(1.0 / 3);
  const auto slope = [](const glm::dvec3& d) { return std::hypot(d.x, d.y) / d.z; };
  for (const double pixels : {45.0, 70.0, 99.0}) {
    const glm::dvec2 raster(100 + 0.6 * pixels, 100 - 0.8 * pixels);
    const glm::dvec3 d = unproject(scene.view.camera, scene.view.film, raster).direction;
    EXPECT_NEAR(slope(d), fold, 1e-3) << pixels;
    const RayRecord there = camera_ray(scene, raster, {0.5f, 0.5f});
    EXPECT_NEAR(slope({there.dx, there.dy, there.dz}), fold, 1e-2) << pixels;
  }
  EXPECT_TRUE(project(scene.view.camera, scene.view.film, {0.5, 0, 1}));
  EXPECT_FALSE(project(scene.view.camera, scene.view.film, {0.7, 0, 1}));
  EXPECT_FALSE(project(scene.view.camera, scene.view.film, {0, 5, 1}));
}

// By two rays half a pixel to each side: their distance, as far as a pixel is small.
TEST(OpencvCamera, FootprintsAndSpreadsAreDistancesOfRays) {
  for (const std::size_t i : {0U, 4U, 9U, 14U}) {
    const Scene scene = scene_of(calibrated[i]);
    for (const auto& [x, y, z, column, row] : calibrated[i].points) {
      const glm::dvec2 at(column + 0.5, row + 0.5);
      const auto apart = [&, distance = z](const glm::dvec2& step) {
        const auto on_plane = [&](const glm::dvec2& raster) {
          const glm::dvec3 d = unproject(scene.view.camera, scene.view.film, raster).direction;
          return d * (distance / d.z);
        };
        return on_plane(at + step) - on_plane(at - step);
      };
      const double area = glm::length(glm::cross(apart({0.5, 0}), apart({0, 0.5})));
      // Pixels are not quite square, by up to 5 %.
      EXPECT_NEAR(pixel_footprint(scene.view.camera, scene.view.film, {x, -y, z}), std::sqrt(area),
                  0.03 * std::sqrt(area));
      EXPECT_NEAR(double{camera_spread(scene, at)[1]} * glm::length(glm::dvec3(x, y, z)),
                  std::sqrt(area), 0.03 * std::sqrt(area));
    }
  }
}

}  // namespace
}  // namespace caplet::test::opencv_camera_test
