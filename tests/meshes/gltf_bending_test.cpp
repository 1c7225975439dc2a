// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Morph targets and skins of glTF files, by closed forms.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>

#include "import/import.h"
#include "support/import_files.h"

namespace caplet::gltf_bending_test {
namespace {

using glm::vec3;
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;
const auto half_angle = static_cast<float>(std::sqrt(0.5));  // sine and cosine of 45 degrees

/// A file whose accessors are made one by one.
class Gltf {
 public:
  int floats(const std::vector<float>& values, const std::string& type, std::size_t components) {
    return add(std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size()), 5126,
               values.size() / components, type);
  }
  int points(const std::vector<float>& values) { return floats(values, "VEC3", 3); }
  int bytes(const std::string& values) { return add(values, 5121, values.size() / 4, "VEC4"); }
  /// Adds an accessor of points in bytes, four of which are a point.
  int bytes_of_points(const std::string& values) {
    const int at = view(values);
    views_.back().insert(views_.back().size() - 1, R"(,"byteStride":4)");
    accessors_.push_back(
        fmt::format(R"({{"bufferView":{},"componentType":5121,"count":{},"type":"VEC3"}})", at,
                    values.size() / 4));
    return static_cast<int>(accessors_.size()) - 1;
  }
  /// Adds an accessor of points of which some are not 0.
  int sparse_points(std::size_t count, const std::string& places,
                    const std::vector<float>& values) {
    const std::string data(reinterpret_cast<const char*>(values.data()), 4 * values.size());
    const int at = view(places), of = view(data);
    accessors_.push_back(fmt::format(
        R"({{"componentType":5126,"count":{},"type":"VEC3","sparse":{{"count":{},)"
        R"("indices":{{"bufferView":{},"componentType":5121}},"values":{{"bufferView":{}}}}}}})",
        count, places.size(), at, of));
    return static_cast<int>(accessors_.size()) - 1;
  }

  /// `rest`: the members of nodes, meshes, skins and animations.
  Scene scene(const std::string& rest) {
    test::write_beside("bending.bin", data_);
    const auto joined = [](const std::vector<std::string>& parts) {
      std::string out;
      for (const std::string& part : parts) out += (out.empty() ? "" : ",") + part;
      return out;
    };
    const std::string text = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},"uri":"bending.bin"}}],)"
        R"("bufferViews":[{}],"accessors":[{}],"scene":0,"scenes":[{{"nodes":[0]}}],{}}})",
        data_.size(), joined(views_), joined(accessors_), rest);
    return import_scene(test::write_beside("bending.gltf", text), test::OneTexel(), {});
  }

 private:
  int view(const std::string& bytes) {
    while (data_.size() % 4 != 0) data_.push_back('\0');
    views_.push_back(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", data_.size(),
                                 bytes.size()));
    data_ += bytes;
    return static_cast<int>(views_.size()) - 1;
  }
  int add(const std::string& bytes, int type, std::size_t count, const std::string& shape) {
    accessors_.push_back(
        fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"}})", view(bytes),
                    type, count, shape));
    return static_cast<int>(accessors_.size()) - 1;
  }

  std::string data_;
  std::vector<std::string> views_, accessors_;
};

const TriangleMeshShape& mesh_of(const Scene& scene) {
  const Shape& shape = scene.shapes.empty() ? scene.objects.at(0).shapes.at(0) : scene.shapes[0];
  return std::get<TriangleMeshShape>(shape.geometry);
}
void expect_near(const vec3& is, const vec3& should, float within = 1e-6F) {
  EXPECT_LE(glm::length(is - should), within) << is.x << " " << is.y << " " << is.z;
}

const std::vector<float> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

TEST(GltfMorphs, RestByTheirWeights) {
  Gltf file;
  const int base = file.points(triangle), normal = file.points({0, 0, 1, 0, 0, 1, 0, 0, 1}),
            one = file.points({0, 0, 2, 0, 0, 0, 0, 0, 0}),
            turned = file.points({1, 0, 0, 1, 0, 0, 0, 0, 0}),
            other = file.sparse_points(3, std::string("\1\2", 2), {0, 4, 0, 8, 0, 0});
  const std::string mesh = fmt::format(
      R"("meshes":[{{"weights":[0.5,0.25],"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{}}},)"
      R"("targets":[{{"POSITION":{},"NORMAL":{}}},{{"POSITION":{}}}]}}]}}])",
      base, normal, one, turned, other);
  const TriangleMeshShape by_mesh = mesh_of(file.scene(R"("nodes":[{"mesh":0}],)" + mesh));
  EXPECT_TRUE(by_mesh.times.empty());
  EXPECT_EQ(by_mesh.positions, (std::vector<vec3>{{0, 0, 1}, {1, 1, 0}, {2, 1, 0}}));
  EXPECT_EQ(by_mesh.normals, (std::vector<vec3>{{0.5F, 0, 1}, {0.5F, 0, 1}, {0, 0, 1}}));
  const Scene placed =
      file.scene(R"("nodes":[{"mesh":0,"weights":[0,1],"translation":[5,0,0]}],)" + mesh);
  EXPECT_EQ(mesh_of(placed).positions, (std::vector<vec3>{{0, 0, 0}, {1, 4, 0}, {8, 1, 0}}));
  EXPECT_EQ(placed.shapes.at(0).world_from_object[3].x, 5);
}

TEST(GltfMorphs, MoveByAnAnimation) {
  for (const std::string way : {"LINEAR", "CUBICSPLINE", "STEP"}) {
    Gltf file;
    const int base = file.points(triangle), one = file.points({0, 0, 2, 0, 0, 0, 0, 0, 0}),
              other = file.points({0, 0, 0, 0, 4, 0, 0, 0, 0}),
              times = file.floats({1, 3}, "SCALAR", 1);
    // In-tangents, values, out-tangents of both weights, at each of two times.
    const std::vector<float> values =
        way == "CUBICSPLINE" ? std::vector<float>{9, 9, 0, 1, 1, 0, 2, 0, 1, 0.5F, 9, 9}
                             : std::vector<float>{0, 1, 1, 0.5F};
    const int weights = file.floats(values, "SCALAR", 1);
    const Scene scene = file.scene(fmt::format(
        R"("nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}},)"
        R"("targets":[{{"POSITION":{}}},{{"POSITION":{}}}]}}]}}],"animations":[{{"channels":[)"
        R"({{"sampler":0,"target":{{"node":0,"path":"weights"}}}}],"samplers":[)"
        R"({{"input":{},"output":{},"interpolation":"{}"}}]}}])",
        base, one, other, times, weights, way));
    const TriangleMeshShape& mesh = mesh_of(scene);
    ASSERT_EQ(mesh.positions.size(), 3 * mesh.times.size());
    ASSERT_EQ(mesh.times.size(), way == "LINEAR" ? 2U : way == "STEP" ? 3U : 9U) << way;
    EXPECT_EQ(mesh.times.front(), 1);
    EXPECT_EQ(mesh.times.back(), 3);
    for (std::size_t key = 0; key < mesh.times.size(); ++key) {
      const double u = (mesh.times[key] - 1) / 2;
      double first = u, second = 1 - 0.5 * u;
      if (way == "STEP") {
        first = u < 1 ? 0 : 1;
        second = u < 1 ? 1 : 0.5;
      } else if (way == "CUBICSPLINE") {
        // Of seconds 2: h00 p0 + 2 h10 m0 + h01 p1 + 2 h11 m1.
        const double h00 = 2 * u * u * u - 3 * u * u + 1, h10 = u * u * u - 2 * u * u + u,
                     h01 = 1 - h00, h11 = u * u * u - u * u;
        first = h00 * 0 + 2 * h10 * 1 + h01 * 1 + 2 * h11 * 2;
        second = h00 * 1 + 2 * h10 * 0 + h01 * 0.5 + 2 * h11 * 0;
      }
      expect_near(mesh.positions[3 * key], vec3(0, 0, 2 * first));
      expect_near(mesh.positions[3 * key + 1], vec3(1, 4 * second, 0));
      expect_near(mesh.positions[3 * key + 2], vec3(0, 1, 0));
    }
    EXPECT_EQ(scene.view.film.exposure_time, 0.02);
  }
}

// A rod of two joints along x, the second of which makes a quarter turn about its own place. A
// vertex of the first stays, one of the second goes round, and one of both is halfway between.
struct Rod {
  Gltf file;
  std::string rest;
  explicit Rod(const std::string& root = "", bool animated = true) {
    const int points = file.points({0, 0, 0, 3, 0, 0, 2, 1, 0}),
              normals = file.points({0, 1, 0, 0, 1, 0, 1, 1, 0}),
              joints = file.bytes(std::string("\0\0\0\0\1\0\0\0\0\1\0\0", 12)),
              weights = file.floats({1, 0, 0, 0, 2, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4", 4);
    // The second joint is at (1, 0, 0), and so is the mesh bound.
    const int binds = file.floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,  //
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
                                  "MAT4", 16);
    const int times = file.floats({0, 1}, "SCALAR", 1),
              turns = file.floats({0, 0, 0, 1, 0, 0, half_angle, half_angle}, "VEC4", 4);
    rest = fmt::format(
        R"("nodes":[{{"children":[1,3]{}}},{{"children":[2]}},{{"translation":[1,0,0]}},)"
        R"({{"mesh":0,"skin":0,"name":"rod","translation":[7,7,7]}}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{},"JOINTS_0":{},)"
        R"("WEIGHTS_0":{}}}}}]}}],"skins":[{{"joints":[1,2],"inverseBindMatrices":{}}}])",
        root, points, normals, joints, weights, binds);
    if (animated)
      rest += fmt::format(
          R"(,"animations":[{{"channels":[{{"sampler":0,"target":{{"node":2,"path":"rotation"}}}}],)"
          R"("samplers":[{{"input":{},"output":{}}}]}}])",
          times, turns);
  }
};

TEST(GltfSkins, FollowTheirJoints) {
  Rod rod(R"(,"translation":[0,0,5])");
  const Scene scene = rod.file.scene(rod.rest);
  ASSERT_EQ(scene.shapes.size(), 1U);
  EXPECT_EQ(scene.shapes[0].name, "rod");
  EXPECT_TRUE(scene.instances.empty());
  EXPECT_EQ(scene.shapes[0].world_from_object, glm::dmat4(1));
  const TriangleMeshShape& mesh = mesh_of(scene);
  // A quarter turn in steps of at most 0.1.
  ASSERT_EQ(mesh.times.size(), 17U);
  for (std::size_t key = 0; key < mesh.times.size(); ++key) {
    const auto angle = static_cast<float>(pi / 2 * mesh.times[key]);
    const float c = std::cos(angle), s = std::sin(angle);
    expect_near(mesh.positions[3 * key], {0, 0, 5});
    expect_near(mesh.positions[3 * key + 1], {1 + 2 * c, 2 * s, 5});
    // (1 1) of the second joint's space turned, and (2 1) of the first's.
    expect_near(mesh.positions[3 * key + 2],
                0.5F * vec3(2, 1, 5) + 0.5F * vec3(1 + c - s, s + c, 5));
    expect_near(mesh.normals[3 * key], {0, 1, 0});
    expect_near(mesh.normals[3 * key + 1], {-s, c, 0});
  }
  EXPECT_EQ(scene.view.film.exposure_time, 0.02);
}

TEST(GltfSkins, AreAsTheirJointsWithoutAnAnimation) {
  Rod rod(R"(,"rotation":[0,0,1,0])", false);
  const Scene scene = rod.file.scene(rod.rest);
  const TriangleMeshShape& mesh = mesh_of(scene);
  EXPECT_TRUE(mesh.times.empty());
  ASSERT_EQ(mesh.positions.size(), 3U);
  expect_near(mesh.positions[1], {-3, 0, 0});
  expect_near(mesh.positions[2], {-2, -1, 0});
  EXPECT_EQ(scene.view.film.exposure_time, 1);
}

// Normals stay at right angles to what is stretched.
TEST(GltfSkins, AreStretched) {
  Rod rod(R"(,"scale":[2,1,1])", false);
  const TriangleMeshShape mesh = mesh_of(rod.file.scene(rod.rest));
  expect_near(mesh.positions[1], {6, 0, 0});
  expect_near(mesh.normals[2], glm::normalize(vec3(1, 2, 0)));
}

// A skeleton that mirrors turns faces over, so that they are seen from the side that normals tell.
TEST(GltfSkins, OfAMirroredSkeletonAreTurnedOver) {
  Rod rod(R"(,"scale":[-1,1,1])", false);
  const Scene mirrored = rod.file.scene(rod.rest);
  Rod straight("", false);
  const Scene scene = straight.file.scene(straight.rest);
  using Triangle = std::array<std::uint32_t, 3>;
  EXPECT_EQ(mesh_of(scene).triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(mesh_of(mirrored).triangles, (std::vector<Triangle>{{0, 2, 1}}));
  expect_near(mesh_of(mirrored).positions[1], {-3, 0, 0});
}

// Colours at corners give triangles vertices of their own, at every time.
TEST(GltfSkins, KeepTheirColours) {
  Rod rod;
  const int colors = rod.file.points({1, 0, 0, 0, 1, 0, 0, 0, 1});
  const std::string before = R"("JOINTS_0")";
  std::string rest = rod.rest;
  rest.insert(rest.find(before), fmt::format(R"("COLOR_0":{},)", colors));
  Rod plain;
  const Scene colored = rod.file.scene(rest), other = plain.file.scene(plain.rest);
  const TriangleMeshShape &mesh = mesh_of(colored), &expected = mesh_of(other);
  ASSERT_EQ(mesh.times, expected.times);
  ASSERT_EQ(mesh.positions.size(), expected.positions.size());
  for (std::size_t key = 0; key < mesh.times.size(); ++key)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(mesh.positions[3 * key + mesh.triangles[0][k]], expected.positions[3 * key + k]);
      EXPECT_EQ(mesh.normals[3 * key + mesh.triangles[0][k]], expected.normals[3 * key + k]);
    }
  EXPECT_FALSE(colored.textures.empty());
}

TEST(GltfSkins, RefuseWhatIsNone) {
  const auto error = [](const std::string& from, const std::string& to) {
    Rod rod;
    const std::size_t at = rod.rest.find(from);
    EXPECT_NE(at, std::string::npos);
    return test::complaint(
        [&] { rod.file.scene(std::string(rod.rest).replace(at, from.size(), to)); });
  };
  EXPECT_THAT(error(R"("joints":[1,2])", R"("joints":[1])"),
              HasSubstr("vertex 1 has joint 1, of 1"));
  EXPECT_THAT(error(R"("joints":[1,2])", R"("joints":[])"), HasSubstr("no joints"));
  EXPECT_THAT(error(R"("joints":[1,2])", R"("joints":[1,2,0])"),
              HasSubstr("3 joints and 2 matrices"));
  EXPECT_THAT(error(R"("JOINTS_0")", R"("JOINTS_7")"), HasSubstr("no joints or no weights"));
  EXPECT_THAT(error(R"({"children":[2]})", R"({"children":[2,1]})"), HasSubstr("cycles"));
  EXPECT_THAT(error(R"("inverseBindMatrices":4)", R"("inverseBindMatrices":3)"),
              HasSubstr("another type"));
}

// 500 joints at 300,000 times would take minutes.
TEST(GltfSkins, OfTooManyJointsAtTooManyTimesAreRefused) {
  Gltf file;
  constexpr std::size_t count = 300'000;
  std::vector<float> times(count), turns(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    times[i] = static_cast<float>(i);
    turns[4 * i + 3] = 1;
  }
  const int points = file.points(triangle), joints = file.bytes(std::string(12, '\0')),
            weights = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4),
            input = file.floats(times, "SCALAR", 1), output = file.floats(turns, "VEC4", 4);
  std::string all = "1";
  for (int i = 1; i < 500; ++i) all += ",1";
  EXPECT_THAT(
      test::complaint([&] {
        file.scene(fmt::format(
            R"("nodes":[{{"mesh":0,"skin":0}},{{}}],"meshes":[{{"primitives":[{{"attributes":)"
            R"({{"POSITION":{},"JOINTS_0":{},"WEIGHTS_0":{}}}}}]}}],"skins":[{{"joints":[{}]}}],)"
            R"("animations":[{{"channels":[{{"sampler":0,"target":{{"node":1,"path":"rotation"}}}}],)"
            R"("samplers":[{{"input":{},"output":{}}}]}}])",
            points, joints, weights, all, input, output));
      }),
      HasSubstr("150000000 joints"));
}

// A part of a mesh without targets stays as it is.
TEST(GltfMorphs, MayBeOfOnePartAlone) {
  Gltf file;
  const int base = file.points(triangle), one = file.points({0, 0, 2, 0, 0, 0, 0, 0, 0}),
            times = file.floats({1, 3}, "SCALAR", 1), weights = file.floats({0, 1}, "SCALAR", 1);
  const Scene scene = file.scene(fmt::format(
      R"("nodes":[{{"mesh":0}}],"meshes":[{{"weights":[1],"primitives":[)"
      R"({{"attributes":{{"POSITION":{}}}}},)"
      R"({{"attributes":{{"POSITION":{}}},"targets":[{{"POSITION":{}}}]}}]}}],)"
      R"("animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}],)"
      R"("samplers":[{{"input":{},"output":{}}}]}}])",
      base, base, one, times, weights));
  ASSERT_EQ(scene.shapes.size(), 2U);
  const auto& still = std::get<TriangleMeshShape>(scene.shapes[0].geometry);
  EXPECT_TRUE(still.times.empty());
  EXPECT_EQ(still.positions.size(), 3U);
  const auto& moving = std::get<TriangleMeshShape>(scene.shapes[1].geometry);
  EXPECT_EQ(moving.times, (std::vector<double>{1, 3}));
  EXPECT_EQ(moving.positions.at(3), vec3(0, 0, 2));
}

// Two sets of joints: a vertex without weights stays with the first joint, others have either or
// both.
TEST(GltfSkins, HaveAnyNumberOfJoints) {
  const auto read = [](const std::vector<float>& second) {
    Gltf file;
    const int points = file.points(triangle), first = file.bytes(std::string(12, '\0')),
              ones = file.bytes(std::string("\1\0\0\0\1\0\0\0\1\0\0\0", 12)),
              weights = file.floats({0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4),
              others = file.floats(second, "VEC4", 4);
    return mesh_of(file.scene(fmt::format(
        R"("nodes":[{{"mesh":0,"skin":0,"children":[1,2]}},{{"translation":[0,0,2]}},)"
        R"({{"translation":[0,0,4]}}],"skins":[{{"joints":[1,2]}}],"meshes":[{{"primitives":[)"
        R"({{"attributes":{{"POSITION":{},"JOINTS_0":{},"WEIGHTS_0":{},"JOINTS_1":{},)"
        R"("WEIGHTS_1":{}}}}}]}}])",
        points, first, weights, ones, others)));
  };
  EXPECT_EQ(read({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}).positions,
            (std::vector<vec3>{{0, 0, 2}, {1, 0, 3}, {0, 1, 4}}));
  EXPECT_THAT(test::complaint([&] {
                read({0, 0, 0, 0, 1, 0, 0, 0});
              }),
              HasSubstr("another number of joints or weights"));
}

// Copies of a node that moves move with it.
TEST(GltfCopies, Move) {
  Gltf file;
  const int points = file.points(triangle), places = file.points({1, 0, 0, 0, 5, 0}),
            times = file.floats({0, 1}, "SCALAR", 1), way = file.points({0, 0, 0, 0, 0, 3});
  const Scene scene = file.scene(fmt::format(
      R"("nodes":[{{"mesh":0,"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":)"
      R"({{"TRANSLATION":{}}}}}}}}}],"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}}}}]}}],)"
      R"("animations":[{{"channels":[{{"sampler":0,"target":{{"node":0,"path":"translation"}}}}],)"
      R"("samplers":[{{"input":{},"output":{}}}]}}])",
      places, points, times, way));
  ASSERT_EQ(scene.instances.size(), 2U);
  ASSERT_EQ(scene.instances[1].motion.size(), 2U);
  expect_near(vec3(scene.instances[0].motion[1].matrix[3]), {1, 0, 3});
  expect_near(vec3(scene.instances[1].motion[0].matrix[3]), {0, 5, 0});
  expect_near(vec3(scene.instances[1].motion[1].matrix[3]), {0, 5, 3});
}

// Places of EXT_mesh_gpu_instancing, within the node's; positions as whole numbers.
TEST(GltfCopies, AreInstances) {
  Gltf file;
  const std::string corners("\0\0\0\0\4\0\0\0\0\6\0\0", 12);  // rows of four bytes, of which three
  const int points = file.bytes_of_points(corners), places = file.points({1, 0, 0, 0, 5, 0}),
            turns = file.floats({0, 0, 0, 1, 0, 0, half_angle, half_angle}, "VEC4", 4),
            one = file.points({2, 2, 2});
  const auto scene = [&](int scales) {
    return file.scene(fmt::format(
        R"("extensionsRequired":["KHR_mesh_quantization","EXT_mesh_gpu_instancing"],)"
        R"("nodes":[{{"mesh":0,"scale":[2,2,2],"extensions":{{"EXT_mesh_gpu_instancing":)"
        R"({{"attributes":{{"TRANSLATION":{},"ROTATION":{},"SCALE":{}}}}}}}}}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":{}}}}}]}}])",
        places, turns, scales, points));
  };
  const Scene copies = scene(places);
  ASSERT_EQ(copies.instances.size(), 2U);
  EXPECT_EQ(std::get<TriangleMeshShape>(copies.objects.at(0).shapes.at(0).geometry).positions,
            (std::vector<vec3>{{0, 0, 0}, {4, 0, 0}, {0, 6, 0}}));
  const auto at = [&](std::size_t i, const glm::dvec3& p) {
    return vec3(copies.instances[i].world_from_object * glm::dvec4(p, 1));
  };
  expect_near(at(0, {1, 0, 0}), {4, 0, 0},
              1e-5F);  // scaled by (1 0 0), moved by (1 0 0), twice as large
  expect_near(at(1, {0, 1, 0}), {-10, 10, 0});  // scaled by (0 5 0), turned to -x, moved by (0 5 0)
  EXPECT_THAT(test::complaint([&] { scene(one); }), HasSubstr("2 places and 1 values of SCALE"));
}

TEST(GltfMorphs, RefuseWhatIsNone) {
  const auto error = [](std::size_t points, const std::string& weights, const std::string& places) {
    return test::complaint([&] {
      Gltf file;
      const int base = file.points(triangle), one = file.points(std::vector<float>(3 * points)),
                other = file.sparse_points(3, places, std::vector<float>(3 * places.size()));
      file.scene(fmt::format(
          R"("nodes":[{{"mesh":0}}],"meshes":[{{"weights":{},"primitives":[{{"attributes":)"
          R"({{"POSITION":{}}},"targets":[{{"POSITION":{}}},{{"POSITION":{}}}]}}]}}])",
          weights, base, one, other));
    });
  };
  EXPECT_EQ(error(3, "[1,1]", std::string("\0\2", 2)), "");
  EXPECT_THAT(error(2, "[1,1]", std::string("\0\2", 2)), HasSubstr("another number of vertices"));
  EXPECT_THAT(error(3, "[1]", std::string("\0\2", 2)), HasSubstr("1 weights of 2 morph targets"));
  EXPECT_THAT(error(3, "[1,1]", std::string("\2\1", 2)), HasSubstr("sparse indices"));
  EXPECT_THAT(error(3, "[1,1]", std::string("\1\3", 2)), HasSubstr("sparse indices"));
}

}  // namespace
}  // namespace caplet::gltf_bending_test
