// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What an importer made of a robot's file, as JSON for tools/beside_mujoco.py: list_geoms FILE
// [OPTION=VALUE]...
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "film/image.h"
#include "import/import.h"

using namespace caplet;

int main(int count, char** words) {
  if (count < 2) return 2;
  ImportOptions options;
  options.set("up", "y");
  for (int i = 2; i < count; ++i) {
    const std::string word = words[i];
    options.set(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
  }
  try {
    const Scene scene = import_scene(words[1], FileImageReader(), options);
    nlohmann::json out = nlohmann::json::array();
    for (const Shape& shape : scene.shapes) {
      nlohmann::json one{{"name", shape.name}, {"backdrop", shape.is_backdrop}};
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
          one["world"].push_back(shape.world_from_object[column][row]);
      if (const auto* sphere = std::get_if<SphereShape>(&shape.geometry))
        one.update({{"type", "sphere"}, {"size", {sphere->radius}}});
      if (const auto* box = std::get_if<BoxShape>(&shape.geometry))
        one.update({{"type", "box"}, {"size", {box->p1.x, box->p1.y, box->p1.z}}});
      if (const auto* cylinder = std::get_if<CylinderShape>(&shape.geometry))
        one.update({{"type", "cylinder"}, {"size", {cylinder->radius, cylinder->p1.z}}});
      if (const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry))
        one.update({{"type", "capsule"}, {"size", {capsules->radius0[0], capsules->p1[0].z}}});
      if (const auto* mesh = std::get_if<TriangleMeshShape>(&shape.geometry)) {
        one.update({{"type", "mesh"},
                    {"triangles", mesh->triangles.size()},
                    {"points", nlohmann::json::array()}});
        for (const glm::vec3& p : mesh->positions)
          for (int k = 0; k < 3; ++k) one["points"].push_back(p[k]);
      }
      out.push_back(std::move(one));
    }
    std::puts(out.dump().c_str());
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
