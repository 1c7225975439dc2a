// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Properties of csg shapes that follow from their operands.
#include <algorithm>

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

bool moves(const CsgShape& csg) {
  return std::ranges::any_of(csg.motions,
                             [](const TransformKeys& keys) { return !keys.empty(); }) ||
         std::ranges::any_of(csg.operands, [](const auto& operand) { return moves(*operand); });
}

void visit_key_times(const CsgShape& csg, const std::function<void(double)>& visit) {
  for (const TransformKeys& keys : csg.motions)
    for (const TransformKey& key : keys) visit(key.time);
  for (const auto& operand : csg.operands) visit_key_times(*operand, visit);
}

void check(const CsgShape& csg, ShapeCheck& report) {
  if (csg.operands.size() < 2) return report.error("the csg has fewer than two operands");
  for (const auto& operand : csg.operands) {
    const auto* capsules = std::get_if<CapsulesShape>(&operand->geometry);
    if (!is_closed(*operand)) return report.error("the csg has an operand that is an open surface");
    if (capsules && count_of(*capsules) != 1)
      return report.error("the csg has an operand that is not one capsule");
    if (operand->emission) return report.error("the csg has an operand that is an area light");
  }
  if (!csg.motions.empty() && csg.motions.size() != csg.operands.size())
    return report.error("the csg has motions of " + std::to_string(csg.motions.size()) +
                        " operands, but " + std::to_string(csg.operands.size()) + " operands");
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
