// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The known answers are the reference's too; kernels that are right give them, and a fault in any
// shape, side or stage is seen.
#include "render/known_answers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "lower/lower.h"
#include "reference/scene_reference.h"
#include "render/detail/known_rays.h"
#include "render_scene.h"
#include "shared/shapes.h"
#include "support/data.h"
#include "support/kinds.h"

namespace caplet::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

/// While it lives, kernels come from a copy in which each `from` of a file is replaced by `to`.
class ChangedKernels {
 public:
  struct Change {
    const char *file, *from, *to;
  };
  explicit ChangedKernels(const std::vector<Change>& changes) {
    const fs::path folder = temporary_folder();
    fs::copy(source_folder() / "kernels", folder, fs::copy_options::recursive);
    for (const Change& change : changes) {
      std::ifstream in(folder / change.file);
      std::string text{std::istreambuf_iterator<char>(in), {}};
      const std::size_t at = text.find(change.from);
      if (at == std::string::npos)
        throw std::logic_error(std::string(change.file) + " has no '" + change.from + "'");
      text.replace(at, std::string(change.from).size(), change.to);
      std::ofstream(folder / change.file) << text;
    }
    ::setenv("CAPLET_KERNELS", folder.c_str(), 1);
  }
  ~ChangedKernels() { ::unsetenv("CAPLET_KERNELS"); }
  ChangedKernels(const ChangedKernels&) = delete;
  ChangedKernels& operator=(const ChangedKernels&) = delete;
};

constexpr std::uint64_t every_shape = ~std::uint64_t{0},
                        tapered_and_instances =
                            shape_bit(shape_tapered_capsule) | shape_bit(shape_instance);
constexpr Trial rendering{every_shape, true, false, false},
    nearest{every_shape, false, true, false}, lists{every_shape, false, false, true};

std::vector<std::string> names(std::uint64_t shapes) {
  std::vector<std::string> out;
  for (int shape = 0; shape < shape_count; ++shape)
    if (shapes & shape_bit(static_cast<std::uint32_t>(shape))) out.push_back(shape_name(shape));
  return out;
}

TEST(KnownRays, AreOfEveryShape) {
  for (std::uint32_t shape = 0; shape <= shape_count; ++shape) {
    const std::uint64_t asked = shape < shape_count ? shape_bit(shape) : every_shape;
    if (shape == shape_instance) continue;  // of nothing
    const KnownScene known = known_scene(asked);
    std::set<std::string> seen;
    for (const KnownRay& ray : known.rays) seen.insert(shape_name(ray.kind));
    const std::vector<std::string> all = names(shapes_on_trial(asked));
    EXPECT_EQ(seen, std::set<std::string>(all.begin(), all.end()));
    // What is tried is what a scene of these shapes will use.
    EXPECT_EQ(lower(known.scene, links_of_known()).shapes, shapes_on_trial(asked))
        << (shape < shape_count ? shape_name(static_cast<int>(shape)) : "all shapes");
  }
}

TEST(KnownRays, CrossingsAreTheReferences) {
  const KnownScene known = known_scene(every_shape);
  const reference::SceneReference reference(known.scene);
  std::size_t crossings = 0;
  for (std::size_t i = 0; i < known.rays.size(); ++i) {
    const KnownRay& ray = known.rays[i];
    SCOPED_TRACE(testing::Message() << i << ": " << shape_name(ray.kind));
    std::vector<reference::SceneHit> found;
    for (const reference::SceneHit& hit : reference.all(
             {{ray.ray.ox, ray.ray.oy, ray.ray.oz}, {ray.ray.dx, ray.ray.dy, ray.ray.dz}}))
      if (hit.t < static_cast<double>(ray.ray.t_max)) found.push_back(hit);
    ASSERT_EQ(found.size(), ray.crossings.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      // The ray's floats: 2^-24 of coordinates up to 100, at 17 degrees or more and directions of
      // 0.2 or more.
      EXPECT_NEAR(found[k].t, ray.crossings[k].t, 1e-3);
      if (ray.crossings[k].side != KnownCrossing::Side::either) {
        EXPECT_EQ(found[k].leaving, ray.crossings[k].side == KnownCrossing::Side::leaving);
      }
      ++crossings;
    }
  }
  EXPECT_GT(crossings, 1500u);
}

TEST(KnownAnswers, AreGivenHere) {
  for (const Encoding encoding : {Encoding::wide, Encoding::single}) {
    EXPECT_THAT(known_answer_failures(test_device(encoding), whole_trial), IsEmpty());
    EXPECT_THAT(known_answer_failures(test_device(encoding),
                                      {.shapes = shape_bit(shape_capsule), .render = true}),
                IsEmpty());
  }
}

/// A line for each shape that begins with its name and this check.
void expect_all(const std::vector<std::string>& failures, const std::string& check) {
  for (const std::string& name : names(every_shape))
    EXPECT_THAT(failures, Contains(StartsWith(name + ": " + check))) << name;
}

TEST(KnownAnswers, SeeAParameterThatIsOffInAnyShape) {
  const ChangedKernels changed(
      {{"trace/hits.cl", "ok &= (t > shape->t_min)", "t *= 1.05f;\n  ok &= (t > shape->t_min)"}});
  const std::vector<std::string> failures = known_answer_failures(test_device(), rendering);
  expect_all(failures, "nearest crossing (extend)");
  expect_all(failures, "any crossing (connect)");
}

TEST(KnownAnswers, SeeCrossingsThatAreMissedByShadowRaysAlone) {
  const ChangedKernels changed(
      {{"trace/trace.cl", "if (nearest.found && nearest.t < enough)",
        "if (nearest.t < enough) nearest.found = 0;\n        if (0)"},
       {"trace/single.cl", "if (nearest.found && nearest.t < enough)",
        "if (nearest.t < enough) nearest.found = 0;\n    if (0)"},
       {"trace/pool.cl", "if (r->nearest.found && r->nearest.t < r->enough) top = 1;",
        "if (r->nearest.t < r->enough) r->nearest.found = 0;"}});
  const std::vector<std::string> failures =
      known_answer_failures(test_device(), {.shapes = tapered_and_instances, .render = true});
  ASSERT_EQ(failures.size(), names(tapered_and_instances).size());
  for (const std::string& name : names(tapered_and_instances))
    EXPECT_THAT(failures, Contains(StartsWith(name + ": any crossing (connect)"))) << name;
}

TEST(KnownAnswers, SeeWrongRecordsOfCrossings) {
  // The normal of one shape alone turned around, and the object of all counted from 1.
  const ChangedKernels normals({{"stages/pick_record.cl", "vstore3(normal, 0, out.normal);",
                                 "vstore3(surfaces->geometries[s.geometry].shape == shape_cone ? "
                                 "-normal : normal, 0, out.normal);"}});
  const std::vector<std::string> failures = known_answer_failures(test_device(), nearest);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_THAT(failures[0], AllOf(StartsWith("cone: nearest crossing (pick)"),
                                 HasSubstr("a normal along the ray")));
}

// Its square is within 1e-3 of 1: floats that are normalised are within 1e-6.
TEST(KnownAnswers, SeeNormalsThatAreNotUnitVectors) {
  const ChangedKernels longer({{"stages/pick_record.cl", "vstore3(normal, 0, out.normal);",
                                "vstore3(surfaces->geometries[s.geometry].shape == shape_cone ? "
                                "1.0007f * normal : normal, 0, out.normal);"}});
  const std::vector<std::string> failures = known_answer_failures(test_device(), nearest);
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_THAT(failures[0], AllOf(StartsWith("cone: nearest crossing (pick)"),
                                 HasSubstr("a normal of length 1.0007")));
}

TEST(KnownAnswers, SeeWrongLists) {
  const ChangedKernels changed(
      {{"trace/list.cl", "(uint)exit_surface[i] | CAPLET_LEAVING", "(uint)exit_surface[i]"}});
  const std::vector<std::string> failures = known_answer_failures(test_device(), lists);
  for (const char* solid : {"sphere", "capsule", "tapered_capsule", "cylinder", "cone", "box",
                            "polyhedron", "instance"})
    EXPECT_THAT(failures, Contains(AllOf(StartsWith(solid), HasSubstr("enters where it leaves"))))
        << solid;
}

TEST(KnownAnswers, SeeTheSidesOfOneSidedShapesSwapped) {
  const ChangedKernels changed(
      {{"trace/hits.cl",
        "if (shape->sees_leaving == 0) ok &= (side & int_of(CAPLET_LEAVING)) == 0;",
        "if (shape->sees_leaving == 0) ok &= (side & int_of(CAPLET_LEAVING)) != 0;"}});
  const std::uint64_t solids =
      shape_bit(shape_sphere) | shape_bit(shape_capsule) | tapered_and_instances;
  const std::vector<std::string> failures =
      known_answer_failures(test_device(), {.shapes = solids, .render = true});
  for (const char* solid : {"sphere", "capsule", "tapered_capsule"})
    EXPECT_THAT(failures, Contains(StartsWith(std::string(solid) + ": nearest crossing (extend)")))
        << solid;
}

TEST(KnownAnswers, AreRememberedByKernelsAndEncoding) {
  ::setenv("CAPLET_CACHE", temporary_folder().c_str(), 1);
  const Trial& trial = {.shapes = tapered_and_instances, .render = true};
  const Device wide = test_device(Encoding::wide), single = test_device(Encoding::single);
  EXPECT_TRUE(needs_trial(wide, trial));
  try_device(wide, trial);
  EXPECT_FALSE(needs_trial(wide, trial));
  EXPECT_TRUE(needs_trial(wide, rendering));
  EXPECT_TRUE(needs_trial(single, trial));
  {
    const ChangedKernels changed({{"trace/hits.cl", "{fmin(t_max, MAXFLOAT), 0, CAPLET_NONE, 0, 0}",
                                   "{fmin(t_max, MAXFLOAT), 0, CAPLET_NONE, 1, 0}"}});
    EXPECT_TRUE(needs_trial(wide, trial));
  }
  const ChangedKernels wrong(
      {{"trace/hits.cl", "nearest->t = ts[i];", "nearest->t = ts[i] * 1.1f;"}});
  EXPECT_THROW(try_device(wide, trial), RunError);
  EXPECT_THROW(try_device(wide, trial), RunError);
  ::unsetenv("CAPLET_CACHE");
}

}  // namespace
}  // namespace caplet::test
