// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Skins of MJCF: meshes whose vertices follow several bodies, in the pose.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

#include "base/check.h"
#include "import/detail/gzip_file.h"
#include "import/detail/mjcf.h"
#include "import/detail/text_file.h"
#include "import/detail/xml.h"

namespace caplet::mjcf {

namespace {

constexpr std::size_t kMostNumbers = std::size_t{1} << 32;

/// A bone moves vertices by these weights.
struct Bone {
  std::string body;
  glm::dvec3 position{0};
  glm::dquat rotation{1, 0, 0, 0};
  std::vector<std::uint32_t> vertices;
  std::vector<double> weights;
};
struct Skin {
  TriangleMeshShape mesh;
  std::vector<Bone> bones;
};

void check_vertices(const Element& of, const Skin& skin) {
  const std::size_t count = skin.mesh.positions.size();
  for (const glm::vec3& p : skin.mesh.positions)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(p[k]) <= largest_number))
        of.fail("a vertex of the skin is not finite or out of range");
  for (const auto& triangle : skin.mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= count)
        of.fail(fmt::format("face: {} is no vertex of the skin, of {}", vertex, count));
  for (const Bone& bone : skin.bones)
    for (const std::uint32_t vertex : bone.vertices)
      if (vertex >= count)
        of.fail(fmt::format("bone {}: {} is no vertex, of {}", bone.body, vertex, count));
}

glm::dquat turn(const Element& of, double w, double x, double y, double z) {
  const glm::dquat out(w, x, y, z);
  const double length = glm::length(out);
  if (!(length > 1e-14) || !std::isfinite(length)) of.fail("bindquat has no length");
  return out / length;
}

/// Reads a .skn file: four counts, vertices, texture coordinates, faces, and the bones, each with a
/// body name of 40 letters.
class SkinFile {
 public:
  SkinFile(const Element& of, const std::filesystem::path& path)
      : of_(of), path_(path), bytes_(read_file(path, of.where())) {}

  Skin read() {
    Skin out;
    const std::uint64_t vertices = count(), uvs = count(), faces = count(), bones = count();
    take(out.mesh.positions, vertices);
    take(out.mesh.uvs, uvs);
    take(out.mesh.triangles, faces);
    for (std::uint64_t i = 0; i < bones; ++i) {
      Bone bone;
      std::vector<char> name;
      std::vector<float> bind, weights;
      take(name, 40);
      bone.body.assign(name.begin(), std::ranges::find(name, '\0'));
      take(bind, 7);
      bone.position = {bind[0], bind[1], bind[2]};
      bone.rotation = turn(of_, static_cast<double>(bind[3]), static_cast<double>(bind[4]),
                           static_cast<double>(bind[5]), static_cast<double>(bind[6]));
      const std::uint64_t of_bone = count();
      take(bone.vertices, of_bone);
      take(weights, of_bone);
      bone.weights.assign(weights.begin(), weights.end());
      out.bones.push_back(std::move(bone));
    }
    if (at_ != bytes_.size())
      fail(fmt::format("{} bytes follow what it announces", bytes_.size() - at_));
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({path_.string()}, "the skin: " + message);
  }
  template <class Value>
  void take(std::vector<Value>& to, std::uint64_t count) {
    if (count > (bytes_.size() - at_) / sizeof(Value))
      fail(fmt::format("{} times {} bytes are announced, and {} are there", count, sizeof(Value),
                       bytes_.size() - at_));
    to.resize(count);
    if (count > 0) std::memcpy(to.data(), bytes_.data() + at_, count * sizeof(Value));
    at_ += count * sizeof(Value);
  }
  std::uint64_t count() {
    std::vector<std::int32_t> value;
    take(value, 1);
    if (value[0] < 0) fail("a count is negative");
    return static_cast<std::uint64_t>(value[0]);
  }

  const Element& of_;
  const std::filesystem::path& path_;
  std::string bytes_;
  std::size_t at_ = 0;
};

/// Reads a skin that is written in the model itself.
Skin written_skin(const Model& model, const Element& of) {
  const auto numbers = [](const Element& from, const char* name, std::size_t of_each) {
    std::vector<double> v = numbers_of(from.text(name), 0, kMostNumbers, from.where(), name);
    if (v.size() % of_each != 0)
      from.fail(fmt::format("{}: a multiple of {} numbers is needed", name, of_each));
    return v;
  };
  const auto whole = [](const Element& from, double v) {
    if (!(v >= 0) || v != std::floor(v) || v > 4e9) from.fail(fmt::format("{} is no vertex", v));
    return static_cast<std::uint32_t>(v);
  };
  Skin out;
  const std::vector<double> positions = numbers(of, "vertex", 3), uvs = numbers(of, "texcoord", 2),
                            faces = numbers(of, "face", 3);
  for (std::size_t i = 0; i < positions.size(); i += 3)
    out.mesh.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  for (std::size_t i = 0; i < uvs.size(); i += 2) out.mesh.uvs.emplace_back(uvs[i], uvs[i + 1]);
  for (std::size_t i = 0; i < faces.size(); i += 3)
    out.mesh.triangles.push_back(
        {whole(of, faces[i]), whole(of, faces[i + 1]), whole(of, faces[i + 2])});
  model.each(of.node(), [&](pugi::xml_node child) {
    if (std::string_view(child.name()) != "bone")
      model.fail(child, "<skin> has no " + quoted(std::string_view(child.name())));
    const Element element(model, child, "bone", nullptr);
    Bone bone;
    bone.body = element.text("body");
    bone.position = element.vector("bindpos", {0, 0, 0});
    const std::vector<double> q = element.numbers("bindquat", 4, {1, 0, 0, 0});
    bone.rotation = turn(element, q[0], q[1], q[2], q[3]);
    for (const double v : numbers(element, "vertid", 1)) bone.vertices.push_back(whole(element, v));
    bone.weights = numbers(element, "vertweight", 1);
    if (bone.weights.size() != bone.vertices.size())
      element.fail(
          fmt::format("{} weights of {} vertices", bone.weights.size(), bone.vertices.size()));
    out.bones.push_back(std::move(bone));
  });
  return out;
}

}  // namespace

void read_skin(const Model& model, pugi::xml_node node,
               const std::function<const glm::dmat4*(const std::string&)>& body, bool is_whole,
               Robot& robot, Assets& assets) {
  const Element of(model, node, "skin", nullptr);
  Skin skin;
  if (const std::string file = of.text("file"); !file.empty()) {
    const std::filesystem::path path = model.file(of, file, model.compiler().meshes);
    skin = SkinFile(of, path).read();
  } else {
    skin = written_skin(model, of);
  }
  check_vertices(of, skin);
  TriangleMeshShape& mesh = skin.mesh;
  if (mesh.triangles.empty() || skin.bones.empty()) of.fail("a skin has faces and bones");
  if (mesh.uvs.size() != mesh.positions.size()) mesh.uvs.clear();
  for (glm::vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  // Weights are normalised by their sum. Each bone moves a vertex from its bind pose to the body's
  // pose.
  std::vector<glm::dvec3> moved(mesh.positions.size(), glm::dvec3(0));
  std::vector<double> sum(mesh.positions.size(), 0);
  for (const Bone& bone : skin.bones)
    for (std::size_t i = 0; i < bone.vertices.size(); ++i) {
      if (!(std::abs(bone.weights[i]) <= static_cast<double>(largest_number)))
        of.fail("a weight of the skin is not finite");
      sum[bone.vertices[i]] += bone.weights[i];
    }
  for (std::size_t i = 0; i < sum.size(); ++i)
    if (!(sum[i] > 1e-14)) of.fail(fmt::format("vertex {} of the skin goes with no bone", i));
  for (const Bone& bone : skin.bones) {
    const glm::dmat4* at = body(bone.body);
    if (!at && !is_whole) return;
    if (!at)
      of.fail("there is no body " + quoted(std::string_view(bone.body)) +
              ", which the skin goes with");
    const glm::dmat3 rotation = glm::dmat3(*at) * glm::mat3_cast(glm::conjugate(bone.rotation));
    for (std::size_t i = 0; i < bone.vertices.size(); ++i) {
      const std::uint32_t vertex = bone.vertices[i];
      const glm::dvec3 p =
          rotation * (glm::dvec3(mesh.positions[vertex]) - bone.position) + glm::dvec3((*at)[3]);
      moved[vertex] += bone.weights[i] / sum[vertex] * p;
    }
  }
  for (std::size_t i = 0; i < moved.size(); ++i) mesh.positions[i] = moved[i];
  check_vertices(of, skin);
  if (of.number("inflate", 0) != 0)
    Diagnostics().warning(of.where(), "the skin is drawn as it is: inflate is not read");
  RobotGeom geom;
  geom.where = of.where();
  geom.name = of.text("name").empty() ? "skin" : of.text("name");
  geom.kind = GeomKind::mesh;
  geom.parts = std::make_shared<const MeshParts>(MeshParts{std::move(mesh)});
  geom.group = static_cast<int>(std::clamp(of.number("group", 0), -1.0, 6.0));
  if (of.has("rgba")) {
    const std::vector<double> c = of.numbers("rgba", 4, {0.5, 0.5, 0.5, 1});
    if (c != std::vector<double>{0.5, 0.5, 0.5, 1}) geom.rgba = {c[0], c[1], c[2], c[3]};
  }
  if (of.has("material")) geom.material = assets.material(model, of.text("material"), geom.where);
  robot.geoms.push_back(std::move(geom));
}

}  // namespace caplet::mjcf
