// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "random_scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "shared/kinds.h"

namespace caplet::test {

FlatPrimitive random_primitive(Random& random, unsigned shape, float size) {
  FlatPrimitive p{shape, 0, {}};
  for (int k = 0; k < 3; k++) p.data[k] = random.uniform(-1, 1);
  switch (shape) {
    case shape_sphere:
      p.data[3] = random.uniform(0.1f, 0.5f) * size;
      break;
    case shape_capsule:
    case shape_tapered_capsule:
      for (int k = 0; k < 3; k++) p.data[3 + k] = p.data[k] + random.uniform(-1, 1) * size;
      p.data[6] = random.uniform(0.01f, 0.3f) * size;
      if (shape == shape_tapered_capsule) p.data[7] = random.uniform(0, 1) < 0.2f ? 2 * size : random.uniform(0, 0.3f) * size;
      break;
    case shape_triangle:
      for (int k = 0; k < 6; k++) p.data[3 + k] = p.data[k % 3] + random.uniform(-1, 1) * size;
      break;
    default: {
      float n[3], l = 0;
      for (float& x : n) {
        x = random.uniform(-1, 1);
        l += x * x;
      }
      for (int k = 0; k < 3; k++) p.data[3 + k] = n[k] / std::sqrt(l);
      p.data[6] = random.uniform(0.1f, 0.5f) * size;
    }
  }
  return p;
}

std::vector<FlatPrimitive> random_scene(unsigned seed, unsigned shape, unsigned count, float size) {
  Random random(seed);
  std::vector<FlatPrimitive> out;
  for (unsigned i = 0; i < count; i++) {
    out.push_back(random_primitive(random, shape == shape_instance ? random_kinds[i % std::size(random_kinds)] : shape, size));
    out.back().id = i;
  }
  return out;
}

std::vector<RayRecord> random_rays(unsigned seed, int count) {
  Random random(seed);
  std::vector<RayRecord> out;
  for (int i = 0; i < count; i++) {
    const float reach = i % 3 == 0 ? 1.0f : 3.0f, speed = std::exp2(random.uniform(-6, 6));
    RayRecord r{};
    float* o[] = {&r.ox, &r.oy, &r.oz};
    float* d[] = {&r.dx, &r.dy, &r.dz};
    for (int k = 0; k < 3; k++) {
      *o[k] = random.uniform(-reach, reach);
      *d[k] = (random.uniform(-1, 1) - *o[k]) * speed;
    }
    r.t_min = 0;
    r.t_max = std::numeric_limits<float>::infinity();
    out.push_back(r);
  }
  return out;
}

Encoded encode(const std::vector<FlatPrimitive>& primitives, int kind_bits) {
  Encoded out;
  out.tree = encode_tree(primitives, out.nodes, out.leaves, kind_bits);
  return out;
}

}  // namespace caplet::test
