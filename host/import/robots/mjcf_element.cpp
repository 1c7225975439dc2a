// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Attributes of MJCF, with the defaults of their classes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

#include "import/detail/mjcf.h"
#include "import/detail/text_file.h"

namespace caplet::mjcf {

namespace {

constexpr const char* kTurns[] = {"quat", "axisangle", "euler", "xyaxes", "zaxis"};

glm::dvec3 unit(const glm::dvec3& v, const Model& model, pugi::xml_node node, const char* what) {
  const double length = glm::length(v);
  if (!(length > 1e-14)) model.fail(node, std::string(what) + " has no length");
  return v / length;
}

}  // namespace

glm::dquat from_z(const glm::dvec3& direction) {
  const glm::dvec3 d = glm::normalize(direction);
  const glm::dvec3 axis(-d.y, d.x, 0);  // the cross product of z and d
  const double sine = glm::length(axis);
  return glm::angleAxis(std::atan2(sine, d.z), sine < 1e-10 ? glm::dvec3(1, 0, 0) : axis / sine);
}

glm::dmat4 placed(const glm::dvec3& position, const glm::dquat& rotation) {
  glm::dmat4 out = glm::mat4_cast(rotation);
  out[3] = {position, 1};
  return out;
}

SourceLocation Element::where() const { return model_->place(node_); }
void Element::fail(const std::string& message) const { model_->fail(node_, message); }

template <class Use>
void Element::levels(Use&& use) const {
  if (use(node_)) return;
  for (const Class* at = class_; at; at = at->parent)
    for (auto element = at->elements.rbegin(); element != at->elements.rend(); ++element)
      if (std::string_view(element->name()) == tag_ && use(*element)) return;
}

pugi::xml_attribute Element::attribute(const char* name) const {
  pugi::xml_attribute out;
  levels([&](pugi::xml_node node) { return static_cast<bool>(out = node.attribute(name)); });
  return out;
}

std::string Element::text(const char* name, const std::string& otherwise) const {
  const pugi::xml_attribute found = attribute(name);
  return found ? found.value() : otherwise;
}

std::size_t Element::choice(const char* name, std::initializer_list<const char*> choices,
                            std::size_t otherwise) const {
  const pugi::xml_attribute found = attribute(name);
  if (!found) return otherwise;
  const std::string_view value = found.value();
  const auto* const at = std::ranges::find(choices, value);
  if (at != choices.end()) return static_cast<std::size_t>(at - choices.begin());
  fail(fmt::format("{}: {} is none of: {}", name, quoted(value), fmt::join(choices, ", ")));
}

bool Element::yes(const char* name, bool otherwise) const {
  return choice(name, {"false", "true"}, otherwise ? 1 : 0) == 1;
}

std::vector<double> Element::numbers(const char* name, std::size_t least,
                                     std::vector<double> otherwise) const {
  std::vector<std::vector<double>> said;
  const std::size_t most = otherwise.size();
  levels([&](pugi::xml_node node) {
    if (const pugi::xml_attribute found = node.attribute(name))
      said.push_back(numbers_of(found.value(), least, most, model_->place(node), name));
    return !said.empty() && said.back().size() == most;
  });
  for (auto values = said.rbegin(); values != said.rend(); ++values)
    std::ranges::copy(*values, otherwise.begin());
  return otherwise;
}

glm::dvec3 Element::vector(const char* name, glm::dvec3 otherwise) const {
  const std::vector<double> v = numbers(name, 3, {otherwise.x, otherwise.y, otherwise.z});
  return {v[0], v[1], v[2]};
}

double Element::angle(const char* name, double otherwise) const {
  return has(name) ? number(name, 0) * (model_->compiler().degrees ? glm::radians(1.0) : 1)
                   : otherwise;
}

glm::dquat Element::rotation() const {
  pugi::xml_node at;
  const char* how = nullptr;
  levels([&](pugi::xml_node node) {
    for (const char* turn : kTurns)
      if (node.attribute(turn)) {
        if (how) model_->fail(node, fmt::format("both {} and {} say how it is turned", how, turn));
        how = turn;
        at = node;
      }
    return how != nullptr;
  });
  if (!how) return {1, 0, 0, 0};
  const std::string_view turn = how;
  const std::size_t count = turn == "xyaxes" ? 6 : turn == "quat" || turn == "axisangle" ? 4 : 3;
  const std::vector<double> v =
      numbers_of(at.attribute(how).value(), count, count, model_->place(at), how);
  const double scale = model_->compiler().degrees ? glm::radians(1.0) : 1;
  if (turn == "quat") {
    const glm::dquat q(v[0], v[1], v[2], v[3]);
    const double length = glm::length(q);
    if (!(length > 1e-14)) model_->fail(at, "quat has no length");
    return q / length;
  }
  if (turn == "axisangle")
    return glm::angleAxis(v[3] * scale, unit({v[0], v[1], v[2]}, *model_, at, "the axis"));
  if (turn == "zaxis") return from_z(unit({v[0], v[1], v[2]}, *model_, at, "zaxis"));
  if (turn == "xyaxes") {
    const glm::dvec3 x = unit({v[0], v[1], v[2]}, *model_, at, "the x axis"),
                     given(v[3], v[4], v[5]);
    const glm::dvec3 y = unit(given - glm::dot(x, given) * x, *model_, at, "the y axis across x");
    return glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y))));
  }
  glm::dquat out(1, 0, 0, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const char letter = model_->compiler().euler[i];
    const bool moves = letter >= 'a';  // lower case letters rotate about the moving axes
    glm::dvec3 axis(0);
    axis[(moves ? letter - 'x' : letter - 'X')] = 1;
    const glm::dquat one = glm::angleAxis(v[i] * scale, axis);
    out = moves ? out * one : one * out;
  }
  return out;
}

glm::dmat4 Element::pose() const { return placed(vector("pos", {0, 0, 0}), rotation()); }

}  // namespace caplet::mjcf
