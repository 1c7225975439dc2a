// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Combines solids by their values: union min, intersection max, complement minus.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "reference/detail/parts.h"
#include "reference/detail/uv.h"
#include "reference/from_scene.h"
#include "reference/primitive.h"

namespace caplet::reference {

using glm::dvec2;
using glm::dvec3;

namespace {

dvec3 apply(const glm::dmat4& m, const dvec3& p) { return dvec3(m * glm::dvec4(p, 1)); }

// Returns the greatest singular value, by squaring A^T A until one direction is left; rounded up.
double greatest_stretch(const glm::dmat4& matrix) {
  const glm::dmat3 a(matrix);
  glm::dmat3 power = glm::transpose(a) * a;
  for (int i = 0; i < 40; ++i) {
    double size = 0;
    for (int c = 0; c < 3; ++c) size = std::max(size, glm::length(power[c]));
    if (!(size > 0)) return 0;
    power = power * (1 / size);
    power = power * power;
  }
  int longest = 0;
  for (int c = 1; c < 3; ++c)
    if (glm::length(power[c]) > glm::length(power[longest])) longest = c;
  return glm::length(a * glm::normalize(power[longest])) * (1 + 1e-12);
}

// Returns operand i's value at x for the maximum (or minimum).
double operand_value(const CsgOperand& operand, const dvec3& x) {
  return value(operand.primitive, apply(operand.operand_from_csg, x)) / operand.stretch;
}

bool takes_least(const Csg& csg) { return csg.operation == Csg::Operation::set_union; }
double sign_of(const Csg& csg, std::size_t i) {
  return csg.operation == Csg::Operation::set_difference && i > 0 ? -1 : 1;
}

Ball ball_around(Csg::Operation operation, const std::vector<CsgOperand>& operands) {
  std::vector<Ball> balls;
  for (const CsgOperand& operand : operands) {
    const Ball inner = bounding_ball(operand.primitive);
    const glm::dmat4 outward = glm::inverse(operand.operand_from_csg);
    balls.push_back({apply(outward, inner.center), greatest_stretch(outward) * inner.radius});
  }
  if (operation == Csg::Operation::set_difference) return balls[0];
  if (operation == Csg::Operation::set_intersection)
    return *std::min_element(balls.begin(), balls.end(),
                             [](const Ball& a, const Ball& b) { return a.radius < b.radius; });
  dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const Ball& ball : balls) {
    low = glm::min(low, ball.center - ball.radius);
    high = glm::max(high, ball.center + ball.radius);
  }
  Ball out{0.5 * (low + high), 0};
  for (const Ball& ball : balls)
    out.radius = std::max(out.radius, glm::length(ball.center - out.center) + ball.radius);
  return out;
}

}  // namespace

Csg make_csg(Csg::Operation operation, std::span<const CsgPart> parts) {
  auto body = std::make_shared<CsgBody>();
  int surfaces = 0;
  for (const CsgPart& part : parts) {
    const glm::dmat4 inverse = glm::inverse(part.csg_from_operand);
    body->operands.push_back({part.primitive, inverse, greatest_stretch(inverse), surfaces});
    surfaces += surface_count(part.primitive);
  }
  const Ball ball = ball_around(operation, body->operands);
  body->ball_center = ball.center;
  body->ball_radius = ball.radius;
  return {operation, std::move(body)};
}

double value_of(const Csg& csg, const dvec3& x) {
  double out = takes_least(csg) ? HUGE_VAL : -HUGE_VAL;
  const auto& operands = csg.body->operands;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const double f = sign_of(csg, i) * operand_value(operands[i], x);
    out = takes_least(csg) ? std::min(out, f) : std::max(out, f);
  }
  return out;
}

SurfaceAt surface_of(const Csg& csg, const dvec3& x) {
  const auto& operands = csg.body->operands;
  double best = 0, second = HUGE_VAL;
  std::size_t active = 0;
  for (std::size_t i = 0; i < operands.size(); ++i) {
    const double f = (takes_least(csg) ? 1 : -1) * sign_of(csg, i) * operand_value(operands[i], x);
    if (i == 0 || f < best) {
      if (i > 0) second = best;
      best = f;
      active = i;
    } else {
      second = std::min(second, f);
    }
  }
  const CsgOperand& operand = operands[active];
  const SurfaceAt inner = surface_at(operand.primitive, apply(operand.operand_from_csg, x));
  return {operand.surface_begin + inner.surface,
          std::min(0.5 * (second - best), inner.margin / operand.stretch)};
}

double distance_from(const Csg& csg, const dvec3& x, int surface) {
  for (const CsgOperand& operand : csg.body->operands) {
    const int own = surface - operand.surface_begin;
    if (own >= 0 && own < surface_count(operand.primitive))
      return distance_from_surface(operand.primitive, apply(operand.operand_from_csg, x), own) /
             operand.stretch;
  }
  return HUGE_VAL;
}

Ball ball_of(const Csg& csg) { return {csg.body->ball_center, csg.body->ball_radius}; }

bool has_inside(const Csg&) { return true; }
int surfaces_of(const Csg& csg) {
  const CsgOperand& last = csg.body->operands.back();
  return last.surface_begin + surface_count(last.primitive);
}

dvec2 uv_of(const Csg& csg, const dvec3& x, int surface) {
  return csg_uv_of(csg, x, surface, dvec3(0));
}

dvec2 csg_uv_of(const Csg& csg, const dvec3& x, int surface, const dvec3& direction) {
  for (const CsgOperand& operand : csg.body->operands) {
    const int own = surface - operand.surface_begin;
    if (own >= 0 && own < surface_count(operand.primitive))
      return uv_at(operand.primitive, dvec3(operand.operand_from_csg * glm::dvec4(x, 1)), own,
                   dvec3(operand.operand_from_csg * glm::dvec4(direction, 0)));
  }
  return {0, 0};
}

std::vector<Primitive> references_of(const CsgShape& csg) {
  std::vector<CsgPart> parts;
  for (const auto& operand : csg.operands)
    parts.push_back({primitives_of(*operand).at(0), operand->world_from_object});
  const auto operation = csg.operation == CsgShape::Operation::set_union ? Csg::Operation::set_union
                         : csg.operation == CsgShape::Operation::set_intersection
                             ? Csg::Operation::set_intersection
                             : Csg::Operation::set_difference;
  return {make_csg(operation, parts)};
}

}  // namespace caplet::reference
