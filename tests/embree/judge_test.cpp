// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The judge has to notice what these tests are there to count.
#include <gtest/gtest.h>

#include "judge.h"
#include "shared/kinds.h"

namespace caplet::test {
namespace {

const FlatPrimitive capsule = make_capsule({0, 0, 0}, {0, 0, 4}, 1);
const reference::Primitive reference = reference_of(capsule);

Judge judge_at(double y) {
  return Judge({&capsule, 1}, {&reference, 1}, make_ray({-5, y, 2}, {1, 0, 0}));
}

TEST(Judge, KnowsHitsAndMisses) {
  EXPECT_EQ(judge_at(0).judge(0, 4).verdict, Verdict::right);
  EXPECT_EQ(judge_at(0).judge(0, 4 + 1e-7).verdict, Verdict::right);
  EXPECT_EQ(judge_at(1.1).judge(CAPLET_NONE, HUGE_VAL).verdict, Verdict::right);
}

TEST(Judge, SeesWhatIsMissed) {
  const Judgement judgement = judge_at(0.5).judge(CAPLET_NONE, HUGE_VAL);
  EXPECT_EQ(judgement.verdict, Verdict::missed);
  EXPECT_NEAR(judgement.depth, 0.5, 1e-9);
}

TEST(Judge, SeesWhatIsNotThere) {
  const Judgement judgement = judge_at(1.1).judge(0, 5);
  EXPECT_EQ(judgement.verdict, Verdict::false_hit);
  EXPECT_NEAR(judgement.depth, 0.1, 1e-7);
}

TEST(Judge, SeesWhatIsElsewhere) {
  const Judgement off = judge_at(0).judge(0, 4.004), far_side = judge_at(0).judge(0, 6);
  EXPECT_EQ(off.verdict, Verdict::displaced);
  EXPECT_NEAR(off.t_error, 1e-3, 1e-9);
  EXPECT_NEAR(off.off_surface, 4e-3, 1e-9);
  EXPECT_EQ(far_side.verdict, Verdict::displaced);
  EXPECT_NEAR(far_side.t_error, 0.5, 1e-9);
  EXPECT_FALSE(off.later);
  EXPECT_TRUE(far_side.later);
}

TEST(Judge, LetsTouchingRaysBe) {
  EXPECT_EQ(judge_at(1 - 1e-7).judge(CAPLET_NONE, HUGE_VAL).verdict, Verdict::touching);
  EXPECT_EQ(judge_at(1 + 1e-7).judge(0, 5).verdict, Verdict::touching);
  EXPECT_EQ(judge_at(1 + 1e-7).judge(0, 7).verdict, Verdict::displaced);
}

TEST(Judge, KnowsWhereRaysBegin) {
  EXPECT_FALSE(judge_at(0).begins_inside() || judge_at(0).begins_at_surface());
  EXPECT_TRUE(
      Judge({&capsule, 1}, {&reference, 1}, make_ray({0, 0, 2}, {1, 0, 0})).begins_inside());
  EXPECT_TRUE(
      Judge({&capsule, 1}, {&reference, 1}, make_ray({1, 0, 2}, {1, 0, 0})).begins_at_surface());
}

TEST(Judge, TellsPrimitivesApart) {
  const FlatPrimitive both[] = {make_sphere({0, 0, 0}, 1), make_sphere({3, 0, 0}, 1)};
  const reference::Primitive references[] = {reference_of(both[0]), reference_of(both[1])};
  const Judge judge(both, references, make_ray({-5, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(judge.judge(0, 4).verdict, Verdict::right);
  EXPECT_EQ(judge.judge(1, 7).verdict, Verdict::missed);
  EXPECT_EQ(judge.judge(1, 4).verdict, Verdict::displaced);
  EXPECT_EQ(judge.judge_point(true, 4).verdict, Verdict::right);
  EXPECT_EQ(judge.judge_point(true, 7).verdict, Verdict::missed);
}

TEST(Judge, LetsRaysTouchOnePartOfACsgShape) {
  // The line goes through the first ball, behind the ray, and just passes by the second.
  const reference::CsgPart parts[] = {{reference::Sphere{{0, 0, 0}, 1.5}, glm::dmat4(1)},
                                      {reference::Sphere{{4, 0, 0}, 1}, glm::dmat4(1)}};
  const reference::Primitive balls =
      reference::make_csg(reference::Csg::Operation::set_union, parts);
  const FlatPrimitive csg{shape_csg, 0, {}};
  const Judge judge({&csg, 1}, {&balls, 1}, make_ray({2, 1 + 1.2e-7, 0}, {1, 0, 0}));
  EXPECT_FALSE(judge.hit());
  EXPECT_EQ(judge.judge(CAPLET_NONE, HUGE_VAL).verdict, Verdict::right);
  EXPECT_EQ(judge.judge(0, 2).verdict, Verdict::touching);
  EXPECT_EQ(judge.judge(0, 2.5).verdict, Verdict::displaced);
}

}  // namespace
}  // namespace caplet::test
