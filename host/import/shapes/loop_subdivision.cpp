// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Subdivision surfaces by Loop's rules (Loop 1987; borders and limits by Hoppe et al. 1994), as in
// pbrt-v4: refined `levels` times, then vertices are moved to the limit.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <unordered_map>

#include "import/detail/pbrt/geometry.h"

namespace caplet::pbrt {

namespace {

constexpr std::size_t most_triangles = std::size_t{1} << 24;

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Edge {
  std::array<std::uint32_t, 2> ends{}, opposite{};
  int faces = 0;
  std::uint32_t first_from = 0;  // where the first face's edge starts
};

/// The neighbourhood of each vertex of a mesh.
struct Around {
  explicit Around(std::size_t vertices)
      : ring(vertices), border(vertices), valence(vertices), borders(vertices) {}
  std::vector<glm::dvec3> ring, border;  // sums of its neighbours, and of those along a border
  std::vector<int> valence, borders;
};

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

struct Edges {
  std::vector<Edge> list;
  std::unordered_map<std::uint64_t, std::uint32_t> number;
};

/// Collects the edges of the faces; `problem` receives the reason if they are no surface.
Edges edges_of(const Triangles& faces, std::string& problem) {
  Edges edges;
  for (const auto& face : faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % 3], opposite = face[(k + 2) % 3];
      const auto [at, fresh] =
          edges.number.emplace(key_of(a, b), static_cast<std::uint32_t>(edges.list.size()));
      if (fresh) edges.list.push_back({{a, b}, {}, 0, a});
      Edge& edge = edges.list[at->second];
      const std::string between =
          " between the vertices " + std::to_string(a) + " and " + std::to_string(b);
      if (problem.empty() && a == b)
        problem = "has a triangle with the vertex " + std::to_string(a) + " twice";
      if (problem.empty() && edge.faces == 2) problem = "has three triangles at the edge" + between;
      if (problem.empty() && edge.faces == 1 && edge.first_from == a)
        problem = "has triangles that are turned differently at the edge" + between;
      if (!problem.empty()) return edges;
      edge.opposite[static_cast<std::size_t>(edge.faces++)] = opposite;
    }
  return edges;
}

Around around(const std::vector<glm::dvec3>& points, const Edges& edges) {
  Around out(points.size());
  for (const Edge& edge : edges.list)
    for (std::size_t end = 0; end < 2; ++end) {
      const std::uint32_t at = edge.ends[end], other = edge.ends[1 - end];
      out.ring[at] += points[other];
      ++out.valence[at];
      if (edge.faces == 2) continue;
      out.border[at] += points[other];
      ++out.borders[at];
    }
  return out;
}

double even_weight(int valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence); }

/// Moves vertices by weights of their neighbours: of the subdivision rule, or of the limit.
template <class Weight>
std::vector<glm::dvec3> smoothed(const std::vector<glm::dvec3>& points, const Around& of,
                                 double border_weight, Weight weight) {
  std::vector<glm::dvec3> out = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (of.valence[i] == 0) continue;
    if (of.borders[i] > 0)
      out[i] = (1 - 2 * border_weight) * points[i] + border_weight * of.border[i];
    else
      out[i] = (1 - of.valence[i] * weight(of.valence[i])) * points[i] +
               weight(of.valence[i]) * of.ring[i];
  }
  return out;
}

void refine(std::vector<glm::dvec3>& points, Triangles& faces, const Edges& edges) {
  const auto evens = static_cast<std::uint32_t>(points.size());
  std::vector<glm::dvec3> next = smoothed(points, around(points, edges), 1.0 / 8, even_weight);
  for (const Edge& edge : edges.list) {
    const glm::dvec3 ends = points[edge.ends[0]] + points[edge.ends[1]];
    next.push_back(edge.faces == 1
                       ? 0.5 * ends
                       : 3.0 / 8 * ends +
                             1.0 / 8 * (points[edge.opposite[0]] + points[edge.opposite[1]]));
  }
  Triangles finer;
  finer.reserve(4 * faces.size());
  for (const auto& face : faces) {
    std::array<std::uint32_t, 3> odd;
    for (std::size_t k = 0; k < 3; ++k)
      odd[k] = evens + edges.number.at(key_of(face[k], face[(k + 1) % 3]));
    finer.push_back({face[0], odd[0], odd[2]});
    finer.push_back({odd[0], face[1], odd[1]});
    finer.push_back({odd[2], odd[1], face[2]});
    finer.push_back({odd[0], odd[1], odd[2]});
  }
  points = std::move(next);
  faces = std::move(finer);
}

/// Returns the neighbours of each vertex in counter-clockwise order; at a border they run from one
/// border edge to the other.
std::vector<std::vector<std::uint32_t>> rings(const Triangles& faces, std::size_t vertices) {
  std::vector<std::vector<std::array<std::uint32_t, 2>>> steps(vertices);
  for (const auto& face : faces)
    for (std::size_t k = 0; k < 3; ++k)
      steps[face[k]].push_back({face[(k + 1) % 3], face[(k + 2) % 3]});
  std::vector<std::vector<std::uint32_t>> out(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    if (steps[i].empty()) continue;
    const auto is_entered = [&](std::uint32_t a) {
      return std::ranges::any_of(steps[i], [a](const auto& s) { return s[1] == a; });
    };
    std::uint32_t at = steps[i][0][0];
    for (const auto& step : steps[i])
      if (!is_entered(step[0])) at = step[0];
    for (std::size_t taken = 0; taken <= steps[i].size(); ++taken) {
      if (taken > 0 && at == out[i][0]) break;
      out[i].push_back(at);
      const auto step = std::ranges::find_if(steps[i], [at](const auto& s) { return s[0] == at; });
      if (step == steps[i].end()) break;
      at = (*step)[1];
    }
  }
  return out;
}

/// Returns the limit normal, on the side from which faces are counter-clockwise. The ring is in
/// order.
glm::dvec3 limit_normal(const glm::dvec3& at, const std::vector<glm::dvec3>& ring, bool is_border) {
  const std::size_t n = ring.size();
  glm::dvec3 s(0), t(0);
  if (!is_border) {
    for (std::size_t j = 0; j < n; ++j) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(n);
      s += std::cos(angle) * ring[j];
      t += std::sin(angle) * ring[j];
    }
    return glm::cross(s, t);
  }
  s = ring[n - 1] - ring[0];
  if (n == 2) {
    t = ring[0] + ring[1] - 2.0 * at;
  } else if (n == 3) {
    t = ring[1] - at;
  } else if (n == 4) {
    t = -ring[0] + 2.0 * ring[1] + 2.0 * ring[2] - ring[3] - 2.0 * at;
  } else {
    const double angle = std::numbers::pi / static_cast<double>(n - 1);
    t = -std::sin(angle) * (ring[0] + ring[n - 1]);
    for (std::size_t k = 1; k + 1 < n; ++k)
      t += (2 - 2 * std::cos(angle)) * std::sin(static_cast<double>(k) * angle) * ring[k];
  }
  return glm::cross(t, s);
}

}  // namespace

TriangleMeshShape make_loop_subdivision(Parameters& parameters) {
  const int levels = parameters.integer("levels", 3);
  parameters.ignore("scheme");
  const TriangleMeshShape base = make_vertices_and_triangles(parameters);
  TriangleMeshShape mesh;
  if (levels < 0) parameters.error("levels", "must not be negative");
  if (base.triangles.empty() || levels < 0) return mesh;
  if (levels > 12 || base.triangles.size() << (2 * levels) > most_triangles) {
    parameters.error("levels", "make more than 2^24 triangles");
    return mesh;
  }
  std::vector<glm::dvec3> points(base.positions.begin(), base.positions.end());
  Triangles faces = base.triangles;
  std::string problem;
  Edges edges = edges_of(faces, problem);
  const Around ends = around(points, edges);
  for (std::size_t i = 0; problem.empty() && i < points.size(); ++i)
    if (ends.borders[i] > 2)
      problem = "has more than one border at the vertex " + std::to_string(i);
  if (!problem.empty()) {
    parameters.error("indices", problem);
    return mesh;
  }
  for (int level = 0; level < levels; ++level) {
    refine(points, faces, edges);
    edges = edges_of(faces, problem);
  }
  const Around last = around(points, edges);
  points = smoothed(points, last, 1.0 / 5,
                    [](int valence) { return 1 / (valence + 3 / (8 * even_weight(valence))); });
  const auto neighbours = rings(faces, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<glm::dvec3> ring;
    for (const std::uint32_t other : neighbours[i]) ring.push_back(points[other]);
    const glm::dvec3 normal =
        ring.size() < 2 ? glm::dvec3(0, 0, 1) : limit_normal(points[i], ring, last.borders[i] > 0);
    const double length = glm::length(normal);
    mesh.positions.emplace_back(points[i]);
    // pbrt-v4 walks round the vertex the other way: the normals of counter-clockwise meshes point
    // inward.
    mesh.normals.emplace_back(length > 0 ? -normal / length : glm::dvec3(0, 0, 1));
  }
  for (const auto& face : faces) mesh.triangles.push_back({face[0], face[2], face[1]});
  return mesh;
}

}  // namespace caplet::pbrt
