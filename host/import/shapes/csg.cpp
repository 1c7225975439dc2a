// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <set>
#include <variant>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

CsgShape::Operation operation_of(Parameters& parameters) {
  if (!parameters.has("operation")) parameters.error("\"string operation\" is missing");
  const std::string name = parameters.text("operation", "union");
  if (name == "intersection") return CsgShape::Operation::set_intersection;
  if (name == "difference") return CsgShape::Operation::set_difference;
  if (name != "union")
    parameters.error("operation", "must be \"union\", \"intersection\" or \"difference\", not " +
                                      in_quotes(name));
  return CsgShape::Operation::set_union;
}

/// Returns why a shape cannot be an operand; empty: it can.
std::string objection(const Shape& shape) {
  const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
  if (capsules && count_of(*capsules) > 1)
    return "holds " + std::to_string(count_of(*capsules)) +
           " capsules in one shape; an operand is one closed shape";
  if (!is_closed(shape)) return "is an open surface; operands are closed solids";
  if (shape.emission) return "is an area light; only the csg itself may be one";
  if (shape.reverse_orientation)
    return "is turned by ReverseOrientation; only the csg itself may be";
  if (shape.one_sided) return "is \"onesided\"; only the csg itself may be";
  return {};
}

/// Returns the operand with a material for each of its surfaces, where it is at first.
std::shared_ptr<const Shape> operand_of(const Shape& shape, const TransformKeys& motion) {
  auto operand = std::make_shared<Shape>(shape);
  if (!motion.empty()) operand->world_from_object = motion.front().matrix;
  if (auto* capsules = std::get_if<CapsulesShape>(&operand->geometry);
      capsules && !capsules->materials.empty()) {
    operand->material = capsules->materials[0];
    capsules->materials.clear();
  }
  return operand;
}

}  // namespace

CsgShape make_csg(Parameters& parameters, const ObjectLookup& objects) {
  CsgShape csg;
  csg.operation = operation_of(parameters);
  if (!parameters.has("operands")) parameters.error("\"string operands\" is missing");
  const Parameter* operands = parameters.values("operands", {"string"});
  if (!operands) return {};
  bool good = true;
  const TransformKeys rests;
  std::set<std::string> said;  // messages already reported, because an object may be named twice
  const auto wrong = [&](const std::string& message) {
    if (said.insert(message).second) parameters.error("operands", message);
    good = false;
  };
  std::size_t solids = 0;
  for (const std::string& name : operands->strings) {
    std::string problem;
    const FinishedObject object = objects(name, problem);
    if (!object.object) {
      wrong(problem);
      continue;
    }
    const std::size_t shapes = object.object->shapes.size() + object.moving.size();
    if (shapes == 0 && parameters.diagnostics().has_errors()) {
      good = false;  // its only shape may have been refused
      continue;
    }
    if (shapes != 1) {
      wrong("names " + in_quotes(name) + " (" + object.object->where.to_string() +
            "), which holds " + std::to_string(shapes) + " shapes; an operand is one closed shape");
      continue;
    }
    const bool is_moving = !object.moving.empty();
    const Shape& shape = is_moving ? *object.moving[0].shape : object.object->shapes[0];
    const auto* nested = std::get_if<CsgShape>(&shape.geometry);
    const auto* capsules = std::get_if<CapsulesShape>(&shape.geometry);
    if ((nested && nested->operands.empty()) || (capsules && capsules->p0.empty())) {
      good = false;  // reported where the object was made
      continue;
    }
    if (const std::string why = objection(shape); !why.empty()) {
      wrong("names " + in_quotes(name) + " (" + shape.where.to_string() + "), which " + why);
      continue;
    }
    solids += solid_count(shape);
    csg.operands.push_back(operand_of(shape, is_moving ? *object.moving[0].motion : rests));
    if (is_moving) csg.motions.resize(csg.operands.size());
    if (is_moving) csg.motions.back() = *object.moving[0].motion;
  }
  if (operands->strings.size() < 2) wrong("takes two names or more, not 1");
  if (solids > max_csg_operands)
    wrong("come to " + std::to_string(solids) +
          " solids, nested ones counted; a csg shape holds at most " +
          std::to_string(max_csg_operands));
  if (!csg.motions.empty()) csg.motions.resize(csg.operands.size());
  if (!good) {
    csg.operands.clear();
    csg.motions.clear();
  }
  return csg;
}

}  // namespace caplet::pbrt
