// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Embree's own test scenes of round curves, hit for hit: Embree with the curves as in the file,
// ours with a (tapered) capsule a segment and with the csg union of them. 16,384 camera rays of the
// .ecs a file and 12,800 rays that begin where those hit; CAPLET_TEST_SCALE=N draws N times as many
// of the latter. And the pixels that Embree's pictures of them cover.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <memory>
#include <mutex>
#include <optional>

#include "curves_file.h"
#include "device_tracer.h"
#include "film/image.h"
#include "lower/detail/shapes.h"
#include "reference/from_scene.h"
#include "support/data.h"
#include "support/test_device.h"
#include "tally.h"

namespace caplet::test {
namespace {

using glm::dvec3;

dvec3 origin_of(const RayRecord& ray) { return {ray.ox, ray.oy, ray.oz}; }
dvec3 direction_of(const RayRecord& ray) { return {ray.dx, ray.dy, ray.dz}; }

/// A curve in the three ways that it is traced, and what the reference has of it.
class Curve {
 public:
  explicit Curve(const RoundCurves& curves)
      : peer_(curves, PeerMode::robust), tracer_(test_device(), test_width()) {
    CsgShape csg;
    for (const unsigned first : curves.first) {
      const auto &a = curves.vertices[first], &b = curves.vertices[first + 1];
      const std::array<float, 3> p0{a[0], a[1], a[2]}, p1{b[0], b[1], b[2]};
      segments_.push_back(a[3] == b[3] ? make_capsule(p0, p1, a[3])
                                       : make_tapered(p0, p1, a[3], b[3]));
      segments_.back().id = static_cast<std::uint32_t>(segments_.size() - 1);
      segment_references_.push_back(reference_of(segments_.back()));
      auto operand = std::make_shared<Shape>();
      operand->geometry =
          CapsulesShape{{{a[0], a[1], a[2]}}, {{b[0], b[1], b[2]}}, {a[3]}, {b[3]}, {}};
      csg.operands.push_back(operand);
    }
    const EncodedTree tree = encode_tree(segments_, nodes_, leaves_);
    root_ = tree.root;
    if (csg.operands.size() == 1) {
      union_.push_back(segments_[0]);
      union_reference_.push_back(segment_references_[0]);
    } else {
      union_.push_back(flat_primitive(csg, glm::dmat4(1), union_leaves_));
      Shape shape;
      shape.geometry = csg;
      union_reference_ = reference::primitives_of(shape);
    }
    probe_.emplace(test_device(), test_width(), union_, union_leaves_);
  }

  struct Result {
    Tally segments, outside, inside;  // rays from outside against the segments; and those from
                                      // outside and inside, the union
    std::uint64_t other = 0,
                  other_clear = 0;  // another segment is named; and only one has its surface there
    std::uint64_t not_neighbour =
        0;  // of inside: Embree reports a point inside a segment that is no neighbour
  };

  void compare(const std::vector<RayRecord>& rays, Result& out) {
    tracer_.upload(nodes_, leaves_, {}, root_);
    const std::vector<HitRecord> ours = tracer_.closest(rays);
    const std::vector<PeerHit> theirs = peer_.closest(rays);
    const auto united = probe_->trace(std::vector<std::uint32_t>(rays.size(), 0), rays);
    std::mutex mutex;
    tbb::parallel_for(std::size_t{0}, rays.size(), [&](std::size_t i) {
      const Judge whole(union_, union_reference_, rays[i]);
      if (whole.begins_at_surface()) {
        const std::lock_guard lock(mutex);
        ++out.outside.left_out;
        return;
      }
      const auto where = [&](float t) {
        return [&, t] {
          return fmt::format("  t {} ours {} Embree\n  ", t, theirs[i].t) + described(rays[i]);
        };
      };
      const bool hit = theirs[i].id != CAPLET_NONE;
      const HitRecord& united_hit = united[i].hit;
      const Judgement embree = whole.judge(hit ? 0 : CAPLET_NONE, theirs[i].t);
      (whole.begins_inside() ? out.inside : out.outside)
          .add(whole, whole.judge(united_hit.slot == CAPLET_NONE ? CAPLET_NONE : 0, united_hit.t),
               embree, {}, where(united_hit.t));
      if (whole.begins_inside()) {
        const std::lock_guard lock(mutex);
        out.not_neighbour += hit && embree.wrong() && inside_another(theirs[i], rays[i]);
        return;
      }
      const Judge each(segments_, segment_references_, rays[i]);
      const std::uint32_t id = ours[i].slot == CAPLET_NONE
                                   ? CAPLET_NONE
                                   : std::bit_cast<std::uint32_t>(leaves_[ours[i].slot]);
      out.segments.add(each, each.judge(id, ours[i].t), each.judge_point(hit, theirs[i].t), {},
                       where(ours[i].t));
      const std::lock_guard lock(mutex);
      if (id == theirs[i].id || id == CAPLET_NONE || !hit) return;
      ++out.other;
      out.other_clear += !shared(ours[i].t, rays[i]);
    });
  }

  /// Directions all around, from a little off the surface where these rays hit.
  std::vector<RayRecord> bounced(const std::vector<RayRecord>& rays, std::size_t count,
                                 std::uint32_t seed) const {
    std::vector<RayRecord> out;
    CaseMaker random(seed);
    std::vector<dvec3> points;
    for (const RayRecord& ray : rays)
      for (const reference::Crossing& c :
           reference::crossings(union_reference_[0], reference_ray(ray)))
        if (c.t > 0) points.push_back(origin_of(ray) + c.t * direction_of(ray));
    while (!points.empty() && out.size() < count) {
      const dvec3 x = points[static_cast<std::size_t>(random.uniform(0, 1) *
                                                      static_cast<double>(points.size()))];
      out.push_back(make_ray(x + 0.01 * random.direction(), random.direction()));
    }
    return out;
  }

  std::size_t covered(const std::vector<RayRecord>& rays, const std::vector<bool>& mask,
                      std::size_t* different) {
    tracer_.upload(nodes_, leaves_, {}, root_);
    const std::vector<HitRecord> hits = tracer_.closest(rays);
    std::size_t count = 0;
    *different = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const bool hit = hits[i].slot != CAPLET_NONE;
      count += hit;
      *different += hit != mask[i];
    }
    return count;
  }

 private:
  double value(std::size_t segment, const RayRecord& ray, double t) const {
    return reference::value(segment_references_[segment], origin_of(ray) + t * direction_of(ray));
  }
  double bound(std::size_t segment, const RayRecord& ray) const {
    return surface_bound(segments_[segment], segment_references_[segment], ray);
  }
  /// Several segments have their surface within both bounds of the point.
  bool shared(float t, const RayRecord& ray) const {
    int count = 0;
    for (std::size_t i = 0; i < segments_.size(); ++i)
      count += std::abs(value(i, ray, t)) <= 2 * bound(i, ray);
    return count > 1;
  }
  bool inside_another(const PeerHit& hit, const RayRecord& ray) const {
    for (std::size_t i = 0; i < segments_.size(); ++i)
      if ((i > hit.id + 1 || i + 1 < hit.id) && value(i, ray, hit.t) < -bound(i, ray)) return true;
    return false;
  }

  Peer peer_;
  DeviceTracer tracer_;
  std::vector<FlatPrimitive> segments_, union_;
  std::vector<reference::Primitive> segment_references_, union_reference_;
  std::vector<float> nodes_, leaves_, union_leaves_;
  std::uint32_t root_ = 0;
  std::optional<Probe> probe_;
};

class EmbreeCurves : public testing::TestWithParam<int> {
 protected:
  std::filesystem::path file(const std::string& extension) const {
    return data_folder() / "fibres" / "embree_curves" /
           fmt::format("round_line_segments_{}.{}", GetParam(), extension);
  }
};

TEST_P(EmbreeCurves, HitForHit) {
  CAPLET_NEEDS_DATA();
  Curve curve(read_round_curves(file("xml")));
  const auto camera = camera_rays(read_ecs(file("ecs")), 128);
  const auto scale = static_cast<std::size_t>(test_scale());
  for (const bool bounce : {false, true}) {
    Curve::Result result;
    curve.compare(bounce ? curve.bounced(camera, 12800 * scale, 9) : camera, result);
    const std::string name = fmt::format("{} {}", GetParam(), bounce ? "bounce" : "camera");
    result.segments.print(name + ", segments, from outside");
    result.outside.print(name + ", union, from outside");
    result.inside.print(name + ", union, from inside");
    fmt::print(
        "  another segment named {}, where one alone has its surface there {}; inside a segment "
        "that is no neighbour {}\n",
        result.other, result.other_clear, result.not_neighbour);
    for (const Tally* tally : {&result.segments, &result.outside, &result.inside}) {
      EXPECT_EQ(tally->our_errors.wrong(), 0u);
      EXPECT_LE(tally->our_errors.touching, tally->rays / 100);
      // Seen: all, but for 2 % of the rays from inside of the last file, where Embree does not look
      // beyond direct neighbours.
      EXPECT_GE(tally->embree_agrees(), tally == &result.inside && GetParam() == 4 ? 0.95 : 0.999);
    }
    EXPECT_EQ(result.other_clear, 0u);
    EXPECT_GT(result.outside.hits + result.inside.hits, 2000u);
    EXPECT_LT(result.outside.left_out, bounce ? camera.size() * scale / 10 : 1);
  }
}

TEST_P(EmbreeCurves, CoverTheirPixels) {
  CAPLET_NEEDS_DATA();
  const LayeredImage image = read_exr(file("ecs.embree_viewer.exr"));
  std::vector<bool> mask(image.channels[0].floats.size());
  for (const Channel& channel : image.channels)
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = mask[i] || channel.floats[i] > 0;
  Curve curve(read_round_curves(file("xml")));
  std::size_t different = 0;
  const std::size_t count =
      curve.covered(camera_rays(read_ecs(file("ecs")), 512), mask, &different);
  fmt::print("{} of {} pixels covered, {} differ\n", count, mask.size(), different);
  EXPECT_GT(count, mask.size() / 8);
  // Directions in single precision are off by 1e-7, 1e-4 of a pixel: of the 2,000 pixels along an
  // outline one may fall on the other side.
  EXPECT_LE(different, 2u);
}

INSTANTIATE_TEST_SUITE_P(Files, EmbreeCurves, testing::Range(0, 5));

}  // namespace
}  // namespace caplet::test
