// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/ext/vector_float1.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <set>

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
// Vertices of a skin go straight between two times. Where a joint turns by 0.1 radian they are off
// by 1 - cos(0.05) = 1 / 800 of the radius. Cubics are in eight parts.
constexpr double kTurnStep = 0.1, kCurveSteps = 8;

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
    const auto part = std::ranges::find(part_names, path);
    const bool is_weights = path == "weights";
    if (part == part_names.end() && !is_weights) file.fail("an animation of '" + path + "'");
    const auto sampler = file.index(channel, "sampler", samplers.size(), "sampler");
    if (!sampler) file.fail("an animation's channel names no sampler");
    if (is_weights)
      add_weights(*node, samplers[*sampler]);
    else
      add(*node, static_cast<std::size_t>(part - part_names.begin()), samplers[*sampler]);
  }
}

void Animation::warn(const std::string& what) const {
  Diagnostics().warning({file_.path.string(), 0, 0}, what);
}

std::size_t Animation::read_times(const Json& sampler, Times& out) {
  const std::size_t accessors = file_.list("accessors").size();
  const auto input = file_.index(sampler, "input", accessors, "accessor"),
             output = file_.index(sampler, "output", accessors, "accessor");
  if (!input || !output) file_.fail("an animation's sampler has no input or no output");
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
  return *output;
}

void Animation::add(std::size_t node, std::size_t part, const Json& sampler) {
  Channel out;
  const std::size_t output = read_times(sampler, out);
  if (part == rotation)
    for (const glm::vec4& value : file_.vectors<glm::vec4>(output)) out.values.emplace_back(value);
  else
    for (const glm::vec3& value : file_.vectors<glm::vec3>(output))
      out.values.emplace_back(glm::dvec3(value), 0);
  const std::size_t each = out.each();
  if (out.times.empty() || out.values.size() != each * out.times.size())
    file_.fail(fmt::format("an animation has {} times and {} values", out.times.size(),
                           out.values.size()));
  if (part == rotation)
    for (std::size_t i = each / 2; i < out.values.size(); i += each)
      if (!(glm::length(out.values[i]) > 0)) file_.fail("a rotation is no quaternion");
  nodes_[node][part] = std::move(out);
}

void Animation::add_weights(std::size_t node, const Json& sampler) {
  Weights out;
  for (const glm::vec1& value : file_.vectors<glm::vec1>(read_times(sampler, out)))
    out.values.push_back(static_cast<double>(value.x));
  if (out.times.empty() || out.values.empty() ||
      out.values.size() % (out.each() * out.times.size()) != 0)
    file_.fail(fmt::format("an animation has {} times and {} weights", out.times.size(),
                           out.values.size()));
  weights_[node] = std::move(out);
}

Animation::Share Animation::Times::at(double time) const {
  const auto after = std::ranges::upper_bound(times, time);
  Share out;
  out.key = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, after - times.begin())) - 1;
  if (after == times.begin() || out.key + 1 == times.size() || way == Way::step) return out;
  const double seconds = times[out.key + 1] - times[out.key];
  const double u = out.u = (time - times[out.key]) / seconds;
  if (way == Way::linear) {
    out.a = 1 - u;
    out.b = u;
    return out;
  }
  // Hermite's cubic.
  const double u2 = u * u, u3 = u2 * u;
  out.a = 2 * u3 - 3 * u2 + 1;
  out.out_tangent = seconds * (u3 - 2 * u2 + u);
  out.b = 3 * u2 - 2 * u3;
  out.in_tangent = seconds * (u3 - u2);
  return out;
}

glm::dvec4 Animation::Channel::at(double time, bool turns) const {
  const Share share = Times::at(time);
  const auto value = [&](std::size_t key) { return values[each() * key + each() / 2]; };
  const glm::dvec4& a = value(share.key);
  if (share.b == 0 && share.a == 1) return a;
  const glm::dvec4& b = value(share.key + 1);
  if (way == Way::linear)
    return mixed(turns ? glm::normalize(a) : a, turns ? glm::normalize(b) : b, share.u, turns);
  // Values are in-tangent, value, out-tangent.
  return share.a * a + share.out_tangent * values[3 * share.key + 2] + share.b * b +
         share.in_tangent * values[3 * (share.key + 1)];
}

std::vector<double> Animation::weights_at(std::size_t node, double time,
                                          std::vector<double> resting) const {
  const auto found = weights_.find(node);
  if (found == weights_.end()) return resting;
  const Weights& of = found->second;
  const std::size_t count = of.values.size() / of.each() / of.times.size();
  if (count != resting.size())
    file_.fail(fmt::format("node {} has {} morph targets, and {} weights in the animation", node,
                           resting.size(), count));
  const Share share = of.at(time);
  const auto value = [&](std::size_t key, std::size_t part, std::size_t i) {
    return of.values[(of.each() * key + part) * count + i];
  };
  for (std::size_t i = 0; i < count; ++i) {
    resting[i] = share.a * value(share.key, of.each() / 2, i);
    if (share.b != 0) resting[i] += share.b * value(share.key + 1, of.each() / 2, i);
    if (of.way == Way::cubic && share.b != 0)
      resting[i] += share.out_tangent * value(share.key, 2, i) +
                    share.in_tangent * value(share.key + 1, 0, i);
  }
  return resting;
}

void Animation::gather(const Times& channel, std::vector<double>& times) {
  times.insert(times.end(), channel.times.begin(), channel.times.end());
  if (channel.way == Way::step)
    for (std::size_t i = 1; i < channel.times.size(); ++i)
      times.push_back(channel.times[i] - kStep * (channel.times[i] - channel.times[i - 1]));
}

double Animation::turn_of(const std::vector<std::size_t>& nodes, double from, double to) const {
  double out = 0;
  for (const std::size_t node : nodes) {
    const auto found = nodes_.find(node);
    if (found == nodes_.end() || !found->second[rotation]) continue;
    const glm::dvec4 a = glm::normalize(found->second[rotation]->at(from, true)),
                     b = glm::normalize(found->second[rotation]->at(to, true));
    out += 2 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
  }
  return out;
}

template <class Add>
void Animation::for_channels(std::size_t node, const std::vector<std::vector<std::size_t>>& joints,
                             const Add& add) const {
  if (const auto found = weights_.find(node); found != weights_.end()) add(found->second);
  std::set<std::size_t> seen;
  for (const std::vector<std::size_t>& chain : joints)
    for (const std::size_t joint : chain)
      if (const auto found = nodes_.find(joint); found != nodes_.end() && seen.insert(joint).second)
        for (const std::optional<Channel>& channel : found->second)
          if (channel) add(*channel);
}

std::vector<double> Animation::key_times(
    std::size_t node, const std::vector<std::vector<std::size_t>>& joints) const {
  std::vector<double> out;
  for_channels(node, joints, [&](const Times& channel) { gather(channel, out); });
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());  // clang 14 lacks ranges::unique
  return out;
}

std::vector<double> Animation::bending_times(
    std::size_t node, const std::vector<std::vector<std::size_t>>& joints) const {
  const std::vector<double> keys = key_times(node, joints);
  bool is_curved = false;
  for_channels(node, joints, [&](const Times& channel) { is_curved |= channel.way == Way::cubic; });
  std::vector<double> out;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    out.push_back(keys[i]);
    if (i + 1 == keys.size()) break;
    double steps = is_curved ? kCurveSteps : 1;
    for (const std::vector<std::size_t>& chain : joints)
      steps = std::max(steps, turn_of(chain, keys[i], keys[i + 1]) / kTurnStep);
    steps = std::min(std::ceil(steps), kMostSteps);
    for (double k = 1; k < steps; ++k) out.push_back(keys[i] + (keys[i + 1] - keys[i]) * k / steps);
  }
  return out;
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
      gather(*channel, times);
      is_curved |= channel->way == Way::cubic;
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
