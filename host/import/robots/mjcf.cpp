// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Reads an MJCF model as a robot. MuJoCo's own library would read it best, but Debian does not have
// it, and it merges bodies and loses names and the places of errors. tools/beside_mujoco.py
// compares.
#include "import/detail/mjcf.h"

namespace caplet {

Robot read_mjcf(const std::filesystem::path& path, const Pose& pose, const ImageReader& images) {
  const mjcf::Model model(path, {}, {});
  Robot robot;
  mjcf::Assets assets(robot, images);
  mjcf::read_bodies(model, pose, robot, assets);
  robot.headlight_ambient = glm::dvec3(0.1);
  robot.headlight_diffuse = glm::dvec3(0.4);
  for (const pugi::xml_node section : model.sections("visual"))
    model.each(section, [&](pugi::xml_node node) {
      if (std::string_view(node.name()) != "headlight") return;
      const mjcf::Element light(model, node, "headlight", nullptr);
      robot.headlight_ambient = light.vector("ambient", *robot.headlight_ambient);
      robot.headlight_diffuse = light.vector("diffuse", *robot.headlight_diffuse);
      if (light.number("active", 1) == 0)
        robot.headlight_ambient = robot.headlight_diffuse = std::nullopt;
    });
  robot.sky = assets.sky(model);
  return robot;
}

}  // namespace caplet
