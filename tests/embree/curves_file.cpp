// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "curves_file.h"

#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <pugixml.hpp>
#include <sstream>
#include <stdexcept>
#include <string>

#include "probe.h"

namespace caplet::test {
namespace {

template <class T>
std::vector<T> numbers(const char* text, const std::filesystem::path& file) {
  std::istringstream stream(text);
  std::vector<T> out;
  for (T x; stream >> x;) out.push_back(x);
  if (!stream.eof()) throw std::runtime_error(file.string() + ": not a number");
  return out;
}

}  // namespace

RoundCurves read_round_curves(const std::filesystem::path& xml) {
  pugi::xml_document document;
  if (const auto result = document.load_file(xml.c_str()); !result)
    throw std::runtime_error(xml.string() + ": " + result.description());
  const auto found = document.select_nodes("//RoundLineSegments");
  if (found.size() != 1) throw std::runtime_error(xml.string() + ": not one RoundLineSegments");
  const pugi::xml_node node = found[0].node();
  const auto positions = numbers<float>(node.child_value("positions"), xml);
  RoundCurves out;
  out.first = numbers<unsigned>(node.child_value("indices"), xml);
  if (positions.size() % 4 != 0 || out.first.empty())
    throw std::runtime_error(xml.string() + ": no whole vertices or no indices");
  for (std::size_t i = 0; i < positions.size(); i += 4)
    out.vertices.push_back({positions[i], positions[i + 1], positions[i + 2], positions[i + 3]});
  for (const unsigned i : out.first)
    if (std::size_t{i} + 1 >= out.vertices.size())
      throw std::runtime_error(xml.string() + ": no such vertex");
  return out;
}

EcsCamera read_ecs(const std::filesystem::path& ecs) {
  std::ifstream file(ecs);
  if (!file) throw std::runtime_error(ecs.string() + ": cannot be read");
  EcsCamera out;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      const std::string name = word.substr(std::min(word.find_first_not_of('-'), word.size()));
      const auto vector = [&](glm::dvec3& v) { words >> v.x >> v.y >> v.z; };
      if (name == "vp") vector(out.eye);
      if (name == "vi") vector(out.target);
      if (name == "vu") vector(out.up);
      if (name == "fov") words >> out.fov;
      if (name == "lefthanded") throw std::runtime_error(ecs.string() + ": a left-handed camera");
    }
    if (!words.eof()) throw std::runtime_error(ecs.string() + ": not a number");
  }
  return out;
}

std::vector<RayRecord> camera_rays(const EcsCamera& camera, int size) {
  const glm::dvec3 z = glm::normalize(camera.target - camera.eye);
  const glm::dvec3 x = glm::normalize(glm::cross(z, camera.up)), y = glm::cross(x, z);
  const double half = 0.5 * size;
  std::vector<RayRecord> out;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column)
      out.push_back(make_ray(camera.eye,
                             glm::normalize((column - half) * x + (half - row) * y +
                                            half / std::tan(0.5 * glm::radians(camera.fov)) * z)));
  return out;
}

}  // namespace caplet::test
