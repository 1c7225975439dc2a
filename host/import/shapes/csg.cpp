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
  if (!key_times(shape).empty()) return "moves; an operand rests";
  if (capsules && capsules->p0.size() > 1)
    return "holds " + std::to_string(capsules->p0.size()) +
           " capsules in one shape; an operand is one closed shape";
  if (!is_closed(shape)) return "is an open surface; operands are closed solids";
  if (shape.emission) return "is an area light; only the csg itself may be one";
  if (shape.reverse_orientation)
    return "is turned by ReverseOrientation; only the csg itself may be";
  if (shape.one_sided) return "is \"onesided\"; only the csg itself may be";
  return {};
}

/// Returns the operand with a material for each of its surfaces.
std::shared_ptr<const Shape> operand_of(const Shape& shape) {
  auto operand = std::make_shared<Shape>(shape);
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
  std::set<std::string> said;  // messages already reported, because an object may be named twice
  const auto wrong = [&](const std::string& message) {
    if (said.insert(message).second) parameters.error("operands", message);
    good = false;
  };
  std::size_t solids = 0;
  for (const std::string& name : operands->strings) {
    std::string problem;
    const Object* object = objects(name, problem);
    if (!object) {
      wrong(problem);
      continue;
    }
    if (object->shapes.empty() && parameters.diagnostics().has_errors()) {
      good = false;  // its only shape may have been refused
      continue;
    }
    if (object->shapes.size() != 1) {
      wrong("names " + in_quotes(name) + " (" + object->where.to_string() + "), which holds " +
            std::to_string(object->shapes.size()) + " shapes; an operand is one closed shape");
      continue;
    }
    const Shape& shape = object->shapes[0];
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
    csg.operands.push_back(operand_of(shape));
  }
  if (operands->strings.size() < 2) wrong("takes two names or more, not 1");
  if (solids > max_csg_operands)
    wrong("come to " + std::to_string(solids) +
          " solids, nested ones counted; a csg shape holds at most " +
          std::to_string(max_csg_operands));
  if (!good) csg.operands.clear();
  return csg;
}

}  // namespace caplet::pbrt
