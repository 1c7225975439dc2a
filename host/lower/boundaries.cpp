// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "base/check.h"
#include "lower/detail/media.h"

namespace caplet {

namespace {

uint number_of(const std::optional<std::uint32_t>& medium) { return medium.value_or(CAPLET_NONE); }

double surface_of(const Bounds& box) {
  if (box.empty()) return 0;
  const glm::dvec3 d = box.max - box.min;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

/// MediumInterface is a shape that separates media, and the geometries that it became.
struct MediumInterface {
  BoundaryRecord record;
  double size;
  std::size_t begin, end;
};

class BoundaryLowering {
 public:
  BoundaryLowering(const Scene& scene, FlatScene& out) : scene_(scene), out_(out) {}

  void run(const LoweredGeometry& geometry) {
    add(scene_.shapes, geometry.world, {glm::dmat4(1)});
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) {
      std::vector<glm::dmat4> placed;
      for (const Instance& instance : scene_.instances)
        if (instance.object == i) placed.push_back(instance.world_from_object);
      if (!placed.empty()) add(scene_.objects[i].shapes, geometry.objects[i], placed);
    }
    // All open surfaces of the same media count together, because several may bound one volume.
    std::map<std::pair<uint, uint>, double> whole;
    for (const MediumInterface& one : all_)
      if (!is_closed(one.record)) whole[sides(one.record)] += one.size;
    for (MediumInterface& one : all_)
      if (!is_closed(one.record)) one.size = whole[sides(one.record)];
    std::ranges::stable_sort(all_, [](const MediumInterface& a, const MediumInterface& b) {
      return a.size != b.size ? a.size > b.size : key(a.record) < key(b.record);
    });
    out_.geometry_boundary.assign(out_.geometries.size(), CAPLET_NONE);
    for (const MediumInterface& one : all_) {
      if (out_.boundaries.empty() || key(out_.boundaries.back()) != key(one.record))
        out_.boundaries.push_back(one.record);
      std::fill(out_.geometry_boundary.begin() + static_cast<std::ptrdiff_t>(one.begin),
                out_.geometry_boundary.begin() + static_cast<std::ptrdiff_t>(one.end),
                narrow<uint>(out_.boundaries.size() - 1));
    }
    if (out_.boundaries.size() > CAPLET_MOST_BOUNDARIES)
      throw InputError(SourceLocation{scene_.source},
                       "the scene has more than 16 million shapes with different media");
  }

 private:
  static std::pair<uint, uint> sides(const BoundaryRecord& record) {
    return {record.inside, record.outside};
  }
  static std::tuple<uint, uint, uint> key(const BoundaryRecord& record) {
    return {record.inside, record.outside, record.flags};
  }
  static bool is_closed(const BoundaryRecord& record) {
    return (record.flags & CAPLET_BOUNDARY_CLOSED) != 0;
  }

  void add(const std::vector<Shape>& shapes, const LoweredShapes& lowered,
           const std::vector<glm::dmat4>& placed) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Shape& shape = shapes[i];
      if (!shape.media.differ() || shape.one_sided || !lowered.extents[i].subtree) continue;
      MediumInterface one{};
      one.begin = lowered.extents[i].begin.geometries;
      one.end = lowered.extents[i].end.geometries;
      one.record.inside = number_of(shape.media.inside);
      one.record.outside = number_of(shape.media.outside);
      if (caplet::is_closed(shape)) {
        one.record.flags = CAPLET_BOUNDARY_CLOSED;
        if (shape.reverse_orientation) std::swap(one.record.inside, one.record.outside);
      } else {
        one.record.flags =
            CAPLET_BOUNDARY_SHEET |
            (!shape.reverse_orientation && open_edges(shape) == 0 ? CAPLET_BOUNDARY_CLOSED : 0u);
      }
      one.size = std::numeric_limits<double>::infinity();
      for (const glm::dmat4& m : placed)
        one.size =
            std::min(one.size, surface_of(bounds_of(shape.geometry, m * shape.world_from_object)));
      all_.push_back(one);
    }
  }

  const Scene& scene_;
  FlatScene& out_;
  std::vector<MediumInterface> all_;
};

}  // namespace

void lower_boundaries(const Scene& scene, const LoweredGeometry& geometry, FlatScene& out) {
  if (out.has_media()) BoundaryLowering(scene, out).run(geometry);
}

}  // namespace caplet
