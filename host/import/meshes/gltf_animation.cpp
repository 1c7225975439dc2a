// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/vector_float1.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/error.h"
#include "import/detail/gltf.h"

namespace caplet::gltf {

namespace {

constexpr std::size_t kMostKeys = 10'000'000;  // of all moving things: 1.4 GB
// Steps between two times where the way is curved, at most, and how long one is at least (seconds).
// AnimatedTransform takes chords: of a quarter turn in 32 steps they are off by 1 - cos(pi / 128) =
// 1 / 3,300 of the radius.
constexpr double kMostSteps = 32, kShortestStep = 1.0 / 240;
constexpr double kStep = 1e-6;  // of an interval, in which what steps goes on to its next value
constexpr double kLeastScale = 1e-6;  // of an axis: a scale of 0 has no inverse

glm::dquat quaternion_of(const glm::dvec4& v) { return {v.w, v.x, v.y, v.z}; }

glm::dvec4 mixed(const glm::dvec4& a, const glm::dvec4& b, double u, bool turns) {
  if (!turns) return (1 - u) * a + u * b;
  const glm::dquat q = glm::slerp(quaternion_of(a), quaternion_of(b), u);
  return {q.x, q.y, q.z, q.w};
}

}  // namespace

Animation::Animation(File& file) : file_(file) {
  const Json& all = file.list("animations");
  if (all.empty()) return;
  if (all.size() > 1) warn(fmt::format("the first of {} animations is read", all.size()));
  const Json& channels = file.list_of(all[0], "channels");
  const Json& samplers = file.list_of(all[0], "samplers");
  for (const Json& channel : channels) {
    const Json& target = file.object(channel, "target");
    const auto node = file.index(target, "node", file.list("nodes").size(), "node");
    const std::string path = file.text(target, "path", "");
    if (!node) continue;  // extensions have other targets
    if (path == "weights") {
      warn("animations of morphs are left out");
      continue;
    }
    const auto part = std::ranges::find(part_names, path);
    if (part == part_names.end()) file.fail("an animation of '" + path + "'");
    const auto sampler = file.index(channel, "sampler", samplers.size(), "sampler");
    if (!sampler) file.fail("an animation's channel names no sampler");
    add(*node, static_cast<std::size_t>(part - part_names.begin()), samplers[*sampler]);
  }
}

void Animation::warn(const std::string& what) const {
  Diagnostics().warning({file_.path.string(), 0, 0}, what);
}

void Animation::add(std::size_t node, std::size_t part, const Json& sampler) {
  const std::size_t accessors = file_.list("accessors").size();
  const auto input = file_.index(sampler, "input", accessors, "accessor"),
             output = file_.index(sampler, "output", accessors, "accessor");
  if (!input || !output) file_.fail("an animation's sampler has no input or no output");
  Channel out;
  const std::string way = file_.text(sampler, "interpolation", "LINEAR");
  if (way == "STEP")
    out.way = Way::step;
  else if (way == "CUBICSPLINE")
    out.way = Way::cubic;
  else if (way != "LINEAR")
    file_.fail("an animation's interpolation is '" + way + "'");
  for (const glm::vec1& time : file_.vectors<glm::vec1>(*input)) {
    if (!out.times.empty() && !(static_cast<double>(time.x) > out.times.back()))
      file_.fail(fmt::format("the times of accessor {} do not rise", *input));
    out.times.push_back(static_cast<double>(time.x));
  }
  if (part == rotation)
    for (const glm::vec4& value : file_.vectors<glm::vec4>(*output)) out.values.emplace_back(value);
  else
    for (const glm::vec3& value : file_.vectors<glm::vec3>(*output))
      out.values.emplace_back(glm::dvec3(value), 0);
  const std::size_t each = out.way == Way::cubic ? 3 : 1;
  if (out.times.empty() || out.values.size() != each * out.times.size())
    file_.fail(fmt::format("an animation has {} times and {} values", out.times.size(),
                           out.values.size()));
  if (part == rotation)
    for (std::size_t i = each / 2; i < out.values.size(); i += each)
      if (!(glm::length(out.values[i]) > 0)) file_.fail("a rotation is no quaternion");
  nodes_[node][part] = std::move(out);
}

glm::dvec4 Animation::Channel::at(double time, bool turns) const {
  const std::size_t each = way == Way::cubic ? 3 : 1, first = each / 2;
  const auto after = std::ranges::upper_bound(times, time);
  const std::size_t i =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - times.begin())) - 1;
  const glm::dvec4& a = values[each * i + first];
  if (after == times.begin() || i + 1 == times.size() || way == Way::step) return a;
  const glm::dvec4& b = values[each * (i + 1) + first];
  const double seconds = times[i + 1] - times[i], u = (time - times[i]) / seconds;
  if (way == Way::linear)
    return mixed(turns ? glm::normalize(a) : a, turns ? glm::normalize(b) : b, u, turns);
  // Hermite's cubic: values are in-tangent, value, out-tangent.
  const double u2 = u * u, u3 = u2 * u;
  return (2 * u3 - 3 * u2 + 1) * a + seconds * (u3 - 2 * u2 + u) * values[each * i + 2] +
         (3 * u2 - 2 * u3) * b + seconds * (u3 - u2) * values[each * (i + 1)];
}

glm::dmat4 Animation::transform_at(std::size_t node, double time) const {
  const Json& of = file_.list("nodes")[node];
  const auto found = nodes_.find(node);
  if (found == nodes_.end()) return file_.transform_of(of);
  if (of.contains("matrix")) file_.fail(fmt::format("node {} has a matrix and is animated", node));
  Parts parts = file_.parts_of(of);
  const auto& channels = found->second;
  if (channels[translation]) parts.translation = channels[translation]->at(time, false);
  if (channels[rotation])
    parts.rotation = glm::normalize(quaternion_of(channels[rotation]->at(time, true)));
  if (channels[scale]) parts.scale = channels[scale]->at(time, false);
  for (int k = 0; k < 3; ++k)
    if (std::abs(parts.scale[k]) < kLeastScale)
      parts.scale[k] = std::copysign(kLeastScale, parts.scale[k]);
  return parts.matrix();
}

TransformKeys Animation::keys(const std::vector<std::size_t>& nodes, const glm::dmat4& world) {
  if (nodes_.empty()) return {};
  std::vector<double> times;
  bool is_curved = false;
  for (const std::size_t node : nodes) {
    const auto found = nodes_.find(node);
    if (found == nodes_.end()) continue;
    // A node alone turns about its own origin, as AnimatedTransform does.
    is_curved |= nodes.size() > 1 && (found->second[rotation] || found->second[scale]);
    for (const std::optional<Channel>& channel : found->second) {
      if (!channel) continue;
      times.insert(times.end(), channel->times.begin(), channel->times.end());
      is_curved |= channel->way == Way::cubic;
      if (channel->way == Way::step)
        for (std::size_t i = 1; i < channel->times.size(); ++i)
          times.push_back(channel->times[i] - kStep * (channel->times[i] - channel->times[i - 1]));
    }
  }
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()),
              times.end());  // clang 14 lacks ranges::unique
  TransformKeys out;
  const auto add = [&](double time) {
    if (++keys_ > kMostKeys)
      file_.fail(fmt::format("its animation has more than {} keys", kMostKeys));
    glm::dmat4 matrix = world;
    for (const std::size_t node : nodes) matrix *= transform_at(node, time);
    out.push_back({time, matrix});
  };
  for (std::size_t i = 0; i < times.size(); ++i) {
    add(times[i]);
    if (!is_curved || i + 1 == times.size()) continue;
    const double seconds = times[i + 1] - times[i];
    const int steps =
        static_cast<int>(std::clamp(std::ceil(seconds / kShortestStep), 1.0, kMostSteps));
    for (int k = 1; k < steps; ++k) add(times[i] + seconds * k / steps);
  }
  return out;
}

}  // namespace caplet::gltf
