// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <array>
#include <bit>

#include "base/check.h"
#include "lower/detail/shapes.h"
#include "lower/linking.h"

namespace caplet {

namespace {

static_assert(sizeof(LinkedCapsule) <= sizeof(FlatPrimitive::data));
static_assert(CAPLET_LINK_R + CAPLET_WIDTH < CAPLET_LINK_U &&
              CAPLET_LINK_U <= 8 * CAPLET_LINK_ROWS &&
              CAPLET_LINK_U + CAPLET_WIDTH < 8 * (CAPLET_LINK_ROWS + 1));

bool can_link(const FlatPrimitive& p) {
  return p.shape == shape_capsule || p.shape == shape_tapered_capsule;
}

/// Returns a capsule or tapered capsule as a linked one; `u`: at its ends; null: it is in no chain.
FlatPrimitive linked(const FlatPrimitive& p, const glm::vec2* u) {
  const bool tapered = p.shape == shape_tapered_capsule;
  LinkedCapsule to{};
  std::copy_n(tapered ? tapered_capsule_p0(p.data) : capsule_p0(p.data), 3, to.p0);
  std::copy_n(tapered ? tapered_capsule_p1(p.data) : capsule_p1(p.data), 3, to.p1);
  to.r0 = tapered ? tapered_capsule_r0(p.data) : capsule_r(p.data);
  to.r1 = tapered ? tapered_capsule_r1(p.data) : capsule_r(p.data);
  if (u) {
    to.u0 = u->x;
    to.u1 = u->y;
    to.has_u = 1;
  }
  FlatPrimitive out{shape_linked_capsule, p.id, {}};
  const auto floats = std::bit_cast<std::array<float, sizeof to / sizeof(float)>>(to);
  std::ranges::copy(floats, out.data);
  return out;
}

FlatPrimitive tapered(const FlatPrimitive& p) {
  const LinkedCapsule from = linked_capsule(p);
  FlatPrimitive out{shape_tapered_capsule, p.id, {}};
  std::copy_n(from.p0, 3, out.data + tapered_capsule_at_p0);
  std::copy_n(from.p1, 3, out.data + tapered_capsule_at_p1);
  out.data[tapered_capsule_at_r0] = from.r0;
  out.data[tapered_capsule_at_r1] = from.r1;
  return out;
}

}  // namespace

LinkedCapsule linked_capsule(const FlatPrimitive& p) {
  CHECK_EQ_(p.shape, std::uint32_t{shape_linked_capsule});
  std::array<float, sizeof(LinkedCapsule) / sizeof(float)> floats;
  std::copy_n(p.data, floats.size(), floats.begin());
  return std::bit_cast<LinkedCapsule>(floats);
}

bool are_linked(const FlatPrimitive& before, const FlatPrimitive& after) {
  if (before.shape != shape_linked_capsule || after.shape != shape_linked_capsule) return false;
  const LinkedCapsule a = linked_capsule(before), b = linked_capsule(after);
  return after.id == before.id + 1 && std::equal(a.p1, a.p1 + 3, b.p0) && a.r1 == b.r0 &&
         a.u1 == b.u0 && a.has_u == b.has_u;
}

bool link_capsules(std::span<FlatPrimitive> primitives, std::span<const glm::vec2> u,
                   std::size_t least_run) {
  const auto as_linked = [&](std::size_t i) {
    return linked(primitives[i], u.empty() ? nullptr : &u[i]);
  };
  bool all = true;
  for (std::size_t first = 0, end = 0; first < primitives.size(); first = end) {
    end = first;
    if (can_link(primitives[first])) {
      FlatPrimitive before = as_linked(first);
      for (++end; end < primitives.size() && can_link(primitives[end]); ++end) {
        const FlatPrimitive after = as_linked(end);
        if (!are_linked(before, after)) break;
        before = after;
      }
    }
    if (end - first < least_run) {
      all = false;
      end = std::max(end, first + 1);
      continue;
    }
    for (std::size_t i = first; i < end; ++i) primitives[i] = as_linked(i);
  }
  return all;
}

std::uint32_t link_rows(const FlatPrimitive& p) {
  return linked_capsule(p).has_u != 0 ? CAPLET_LINK_ROWS + 1 : CAPLET_LINK_ROWS;
}

void write_links(std::span<const FlatPrimitive> capsules, float* block) {
  std::fill_n(block, std::size_t{8} * link_rows(capsules[0]), 0.f);
  block[0] = std::bit_cast<float>(capsules[0].id);
  block[1] = std::bit_cast<float>(narrow<std::uint32_t>(capsules.size()));
  const std::size_t last = capsules.size();
  for (std::size_t i = 0; i <= CAPLET_WIDTH; ++i) {
    // Lanes without a capsule go back and forth along the last one, so that no arithmetic meets odd
    // values there.
    const std::size_t at = i <= last ? i : last - (i - last) % 2;
    const LinkedCapsule of = linked_capsule(capsules[std::min(at, last - 1)]);
    const float* point = at < last ? of.p0 : of.p1;
    block[CAPLET_LINK_X + i] = point[0];
    block[CAPLET_LINK_Y + i] = point[1];
    block[CAPLET_LINK_Z + i] = point[2];
    block[CAPLET_LINK_R + i] = at < last ? of.r0 : of.r1;
    if (of.has_u != 0) block[CAPLET_LINK_U + i] = at < last ? of.u0 : of.u1;
  }
}

ExactBox linked_capsule_box(const FlatPrimitive& p) { return tapered_capsule_box(tapered(p)); }

double linked_capsule_area(const FlatPrimitive& p, const std::vector<float>& leaves) {
  return tapered_capsule_area(tapered(p), leaves);
}

void linked_capsule_pieces(const FlatPrimitive& p, const std::vector<float>& leaves,
                           Pieces& pieces) {
  tapered_capsule_pieces(tapered(p), leaves, pieces);
}

FlatPrimitive linked_capsule_grown(FlatPrimitive p, double b, std::vector<float>& leaves) {
  return tapered_capsule_grown(tapered(p), b, leaves);
}

}  // namespace caplet
