// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Morph targets and skins of glTF 2.0.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "import/detail/gltf.h"

namespace caplet::gltf {

namespace {

constexpr std::size_t kMostMoved = 100'000'000;  // vertices at all times: 2.4 GB with normals
constexpr std::size_t kDeepestJoint = 256;
constexpr std::size_t kMostJoints = 100'000'000;  // with all that they lie within, at all times

}  // namespace

Bending::Bending(File& file, const Animation& animation, const glm::dmat4& world)
    : file_(file), animation_(animation), world_(world) {
  const Json& nodes = file.list("nodes");
  parents_.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const Json& child : file.list_of(nodes[i], "children"))
      parents_[file.index_value(child, nodes.size(), "node")] = i;
}

bool Bending::has_skin(std::size_t node) const {
  return file_.index(file_.list("nodes")[node], "skin", file_.list("skins").size(), "skin")
      .has_value();
}

bool Bending::bends(std::size_t node) const {
  const auto mesh =
      file_.index(file_.list("nodes")[node], "mesh", file_.list("meshes").size(), "mesh");
  if (!mesh) return false;
  if (has_skin(node)) return true;
  const Json& primitives = file_.list_of(file_.list("meshes")[*mesh], "primitives");
  return std::ranges::any_of(primitives, [&](const Json& primitive) {
    return !file_.list_of(primitive, "targets").empty();
  });
}

std::vector<Bending::Target> Bending::targets_of(const Json& primitive, std::size_t count) {
  std::vector<Target> out;
  const std::size_t accessors = file_.list("accessors").size();
  for (const Json& from : file_.list_of(primitive, "targets")) {
    Target& target = out.emplace_back();
    if (const auto positions = file_.index(from, "POSITION", accessors, "accessor"))
      target.positions = file_.vectors<glm::vec3>(*positions);
    if (const auto normals = file_.index(from, "NORMAL", accessors, "accessor"))
      target.normals = file_.vectors<glm::vec3>(*normals);
    if ((!target.positions.empty() && target.positions.size() != count) ||
        (!target.normals.empty() && target.normals.size() != count))
      file_.fail("a morph target has another number of vertices than its mesh");
  }
  return out;
}

std::vector<double> Bending::resting_weights(std::size_t node, std::size_t count) const {
  const Json& of = file_.list("nodes")[node];
  const Json* weights = &file_.list_of(of, "weights");
  if (weights->empty())
    if (const auto mesh = file_.index(of, "mesh", file_.list("meshes").size(), "mesh"))
      weights = &file_.list_of(file_.list("meshes")[*mesh], "weights");
  std::vector<double> out;
  for (const Json& weight : *weights) out.push_back(file_.number_value(weight, "a weight"));
  if (out.empty()) out.resize(count);
  if (out.size() != count)
    file_.fail(fmt::format("node {} has {} weights of {} morph targets", node, out.size(), count));
  return out;
}

std::vector<std::size_t> Bending::chain_of(std::size_t node) const {
  std::vector<std::size_t> out;
  for (std::optional<std::size_t> at = node; at; at = parents_[*at]) {
    if (out.size() > kDeepestJoint)
      file_.fail(fmt::format("joint {} lies within more than {} nodes: are there cycles?", node,
                             kDeepestJoint));
    out.push_back(*at);
  }
  std::ranges::reverse(out);
  return out;
}

std::optional<Bending::Skin> Bending::skin_of(std::size_t node, const Json& primitive,
                                              std::size_t count) {
  const auto index =
      file_.index(file_.list("nodes")[node], "skin", file_.list("skins").size(), "skin");
  if (!index) return std::nullopt;
  const Json& from = file_.list("skins")[*index];
  const std::size_t accessors = file_.list("accessors").size();
  Skin out;
  for (const Json& joint : file_.list_of(from, "joints"))
    out.chains.push_back(chain_of(file_.index_value(joint, parents_.size(), "node")));
  if (out.chains.empty()) file_.fail(fmt::format("skin {} has no joints", *index));
  if (const auto binds = file_.index(from, "inverseBindMatrices", accessors, "accessor"))
    out.inverse_bind = file_.matrices(*binds);
  else
    out.inverse_bind.assign(out.chains.size(), glm::dmat4(1));
  if (out.inverse_bind.size() < out.chains.size())
    file_.fail(fmt::format("skin {} has {} joints and {} matrices", *index, out.chains.size(),
                           out.inverse_bind.size()));
  const Json& attributes = file_.object(primitive, "attributes");
  for (int set = 0;; ++set) {
    const std::string number = std::to_string(set);
    const auto joints =
                   file_.index(attributes, ("JOINTS_" + number).c_str(), accessors, "accessor"),
               weights =
                   file_.index(attributes, ("WEIGHTS_" + number).c_str(), accessors, "accessor");
    if (!joints || !weights) break;
    const std::vector<glm::vec4> these = file_.vectors<glm::vec4>(*joints),
                                 shares = file_.vectors<glm::vec4>(*weights);
    if (these.size() != count || shares.size() != count)
      file_.fail("a mesh has another number of joints or weights than of positions");
    for (std::size_t i = 0; i < count; ++i)
      for (glm::length_t k = 0; k < 4; ++k)
        if (shares[i][k] != 0 &&
            !(these[i][k] >= 0 && these[i][k] < static_cast<float>(out.chains.size())))
          file_.fail(
              fmt::format("vertex {} has joint {}, of {}", i, these[i][k], out.chains.size()));
    out.joints.insert(out.joints.end(), these.begin(), these.end());
    out.weights.insert(out.weights.end(), shares.begin(), shares.end());
  }
  if (out.joints.empty()) file_.fail("a mesh with a skin has no joints or no weights");
  return out;
}

void Bending::morph(const std::vector<Target>& targets, const std::vector<double>& weights,
                    TriangleMeshShape& mesh) {
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto add = [&](const std::vector<glm::vec3>& from, std::vector<glm::vec3>& to) {
      if (from.empty() || weights[i] == 0) return;
      for (std::size_t vertex = 0; vertex < to.size(); ++vertex)
        to[vertex] += static_cast<float>(weights[i]) * from[vertex];
    };
    add(targets[i].positions, mesh.positions);
    add(targets[i].normals, mesh.normals);
  }
}

bool Bending::apply(const Skin& skin, double time, TriangleMeshShape& mesh) const {
  std::map<std::size_t, glm::dmat4> own;  // of nodes that several chains share
  std::vector<glm::dmat4> joints;
  for (std::size_t i = 0; i < skin.chains.size(); ++i) {
    glm::dmat4 matrix = world_;
    for (const std::size_t node : skin.chains[i]) {
      const auto [found, fresh] = own.try_emplace(node);
      if (fresh) found->second = animation_.transform_at(node, time);
      matrix *= found->second;
    }
    joints.push_back(matrix * skin.inverse_bind[i]);
  }
  const std::size_t count = mesh.positions.size(), sets = skin.joints.size() / count;
  for (std::size_t i = 0; i < count; ++i) {
    glm::dmat4 sum(0);
    double all = 0;
    for (std::size_t set = 0; set < sets; ++set)
      for (glm::length_t k = 0; k < 4; ++k) {
        const auto weight = static_cast<double>(skin.weights[set * count + i][k]);
        if (weight == 0) continue;
        sum += weight * joints[static_cast<std::size_t>(skin.joints[set * count + i][k])];
        all += weight;
      }
    // A vertex without weights stays with the first joint.
    const glm::dmat4 matrix = all > 0 ? sum / all : joints[0];
    mesh.positions[i] =
        glm::vec3(glm::dvec3(matrix * glm::dvec4(glm::dvec3(mesh.positions[i]), 1)));
    if (mesh.normals.empty()) continue;
    const glm::dmat3 linear(matrix);
    // The cofactors: right for normals up to their length, also where the matrix has no inverse.
    const glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                              glm::cross(linear[0], linear[1]));
    const glm::dvec3 normal = cofactor * glm::dvec3(mesh.normals[i]);
    const double length = glm::length(normal);
    mesh.normals[i] = length > 0 ? glm::vec3(normal / length) : glm::vec3(0);
  }
  return glm::determinant(glm::dmat3(joints[0])) < 0;
}

void Bending::check_joints(const std::vector<std::vector<std::size_t>>& chains,
                           std::size_t times) const {
  std::size_t nodes = 0;
  for (const std::vector<std::size_t>& chain : chains) nodes += chain.size();
  if (nodes * times > kMostJoints)
    file_.fail(fmt::format("its animation moves {} joints, counted at all times", nodes * times));
}

void Bending::bend(std::size_t node, const Json& primitive, TriangleMeshShape& mesh) {
  const std::size_t count = mesh.positions.size();
  const std::vector<Target> targets = targets_of(primitive, count);
  const std::optional<Skin> skin = skin_of(node, primitive, count);
  const std::vector<double> resting =
      targets.empty() ? std::vector<double>() : resting_weights(node, targets.size());
  if (skin) check_joints(skin->chains, animation_.key_times(node, skin->chains).size());
  std::vector<double> times =
      animation_.bending_times(node, skin ? skin->chains : std::vector<std::vector<std::size_t>>());
  if (targets.empty() && !skin) return;  // another part of the mesh has some
  if (times.empty()) times.push_back(0);
  moved_ += count * times.size();
  if (moved_ > kMostMoved)
    file_.fail(fmt::format("its animation moves {} vertices, counted at all times", moved_));
  if (skin) check_joints(skin->chains, times.size());
  const TriangleMeshShape still = std::move(mesh);
  mesh = {{}, still.triangles, {}, still.uvs, {}};
  mesh.positions.reserve(count * times.size());
  mesh.normals.reserve(still.normals.size() * times.size());
  bool is_mirrored = false;
  for (const double time : times) {
    TriangleMeshShape now{still.positions, {}, still.normals, {}, {}};
    if (!targets.empty()) morph(targets, animation_.weights_at(node, time, resting), now);
    if (skin) is_mirrored = apply(*skin, time, now);
    mesh.positions.insert(mesh.positions.end(), now.positions.begin(), now.positions.end());
    mesh.normals.insert(mesh.normals.end(), now.normals.begin(), now.normals.end());
  }
  if (times.size() > 1) mesh.times = std::move(times);
  if (is_mirrored)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

}  // namespace caplet::gltf
