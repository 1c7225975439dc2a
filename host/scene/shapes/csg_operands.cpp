// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Properties of csg shapes that follow from their operands.
#include "scene/shape.h"

namespace caplet {

std::size_t solids_of(const CsgShape& csg) {
  std::size_t count = 0;
  for (const auto& operand : csg.operands) {
    count += solid_count(*operand);
    if (count > max_csg_operands) break;
  }
  return count;
}

std::size_t surfaces_of(const CsgShape& csg) {
  std::size_t count = 0;
  for (const auto& operand : csg.operands) count += surface_count(*operand);
  return count;
}

void check(const CsgShape& csg, ShapeCheck& report) {
  if (csg.operands.size() < 2) return report.error("the csg has fewer than two operands");
  for (const auto& operand : csg.operands) {
    const auto* capsules = std::get_if<CapsulesShape>(&operand->geometry);
    if (!is_closed(*operand)) return report.error("the csg has an operand that is an open surface");
    if (capsules && capsules->p0.size() != 1)
      return report.error("the csg has an operand that is not one capsule that rests");
    if (operand->emission) return report.error("the csg has an operand that is an area light");
  }
  std::size_t solids = 0;
  for (const auto& operand : csg.operands) {
    solids += solid_count(*operand);
    if (solids > max_csg_operands)
      return report.error("the csg holds more than " + std::to_string(max_csg_operands) +
                          " solids");
  }
  for (const auto& operand : csg.operands) report.operand(*operand);
}

}  // namespace caplet
