// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The comparison of a device with the reference: agrees where it should, and notices every kind of
// fault. Faults are put into what the device really answered.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>

#include "base/error.h"
#include "base/interrupt.h"
#include "film/image.h"
#include "import/import.h"
#include "support/data.h"
#include "support/kinds.h"
#include "support/test_device.h"
#include "verify/bounds.h"
#include "verify/cases.h"
#include "verify/rays.h"
#include "verify/torture.h"
#include "verify/verify.h"

namespace caplet::verify {
namespace {

using testing::HasSubstr;

const std::vector<Device>& devices() {
  static const std::vector<Device> out{test::test_device()};
  return out;
}

TEST(KindNames, AreThoseOfTheList) {
  std::vector<std::string> listed;
  for (const test::ShapeKind& kind : test::shape_kinds()) listed.emplace_back(kind.name);
  EXPECT_THAT(reference::kind_names, testing::UnorderedElementsAreArray(listed));
}

TEST(TortureScenes, AreValidAndHaveEveryKind) {
  for (std::uint64_t round = 0; round < 20; ++round) {
    const Scene scene = torture_scene(7, round);
    Diagnostics diagnostics;
    validate(scene, diagnostics);
    EXPECT_NO_THROW(diagnostics.finish()) << round;
    const reference::SceneReference reference(scene);
    std::array<int, reference::kind_names.size()> kinds{};
    for (std::size_t i = 0; i < reference.size(); ++i)
      ++kinds[reference::kind_of(reference.placed(i).primitive)];
    for (std::size_t k = 0; k < kinds.size(); ++k)
      EXPECT_GT(kinds[k], 0) << reference::kind_names[k] << " in round " << round;
  }
}

TEST(TortureScenes, DependOnSeedAndRound) {
  const auto radius = [](std::uint64_t seed, std::uint64_t round) {
    return std::get<SphereShape>(torture_scene(seed, round).shapes[0].geometry).radius;
  };
  EXPECT_EQ(radius(1, 2), radius(1, 2));
  EXPECT_NE(radius(1, 2), radius(1, 3));
  EXPECT_NE(radius(1, 2), radius(2, 2));
}

TEST(Rays, AreAddressedByTheirNumber) {
  const Scene scene = torture_scene(1, 0);
  const reference::SceneReference reference(scene);
  const RaySource one(scene, reference, 3), same(scene, reference, 3), other(scene, reference, 4);
  std::array<int, family_names.size()> families{};
  int different = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const VerifyRay a = one.ray(1999 - i), b = same.ray(1999 - i);
    EXPECT_EQ(std::memcmp(&a.ray, &b.ray, sizeof(RayRecord)), 0) << i;
    const RayRecord c = other.ray(1999 - i).ray;
    different += std::memcmp(&a.ray, &c, sizeof(RayRecord)) != 0;
    ++families[static_cast<std::size_t>(a.family)];
    for (const float x : {a.ray.ox, a.ray.oy, a.ray.oz, a.ray.dx, a.ray.dy, a.ray.dz})
      EXPECT_TRUE(std::isfinite(x)) << i;
    EXPECT_GT(std::abs(a.ray.dx) + std::abs(a.ray.dy) + std::abs(a.ray.dz), 0) << i;
  }
  EXPECT_GT(different, 1700);  // camera rays through the same pixel are the same
  for (std::size_t f = 0; f < families.size(); ++f) EXPECT_GT(families[f], 50) << family_names[f];
}

TEST(Distribution, Percentiles) {
  Distribution d, rest;
  for (int i = 1; i <= 500; ++i) d.add(i);
  for (int i = 501; i <= 1000; ++i) rest.add(i);
  d.add(rest);
  EXPECT_EQ(d.count(), 1000u);
  EXPECT_EQ(d.worst(), 1000);
  EXPECT_NEAR(d.percentile(0.5), 500, 25);  // a sixteenth of an octave
  EXPECT_NEAR(d.percentile(0.99), 990, 50);
  EXPECT_EQ(Distribution().percentile(0.5), 0);
  Distribution zeros;
  zeros.add(0);
  zeros.add(HUGE_VAL);
  EXPECT_EQ(zeros.percentile(0.5), 0);
  EXPECT_EQ(zeros.worst(), HUGE_VAL);
}

TEST(Verify, ThisDeviceAgreesOnTheTortureSet) {
  const Report report = verify(nullptr, "", devices(), {.rays = 40'000, .seed = 11});
  ASSERT_EQ(report.devices.size(), 1u);
  const Statistics& s = report.devices[0].statistics;
  EXPECT_EQ(s.rays, 40'000u);
  EXPECT_EQ(report.disagreements(), 0u)
      << report.devices[0].failures.front().disagreements.front().text;
  EXPECT_GT(s.hits, 20'000u);
  for (std::size_t k = 0; k < s.kinds.size(); ++k) {
    EXPECT_GT(s.kinds[k].hits, 100u) << reference::kind_names[k];
    EXPECT_LT(s.kinds[k].grazed, s.rays / 10) << reference::kind_names[k];
    // A bound that is never used to a hundredth would not be one.
    EXPECT_GT(s.kinds[k].worst(), 0.01) << reference::kind_names[k];
  }
}

// Its rays see it at two times. At another one they would not agree.
TEST(Verify, ThisDeviceAgreesOnASceneThatMoves) {
  const Scene scene =
      import_scene(test::source_folder() / "scenes" / "motion.pbrt", FileImageReader());
  const Report report = verify(&scene, "motion.pbrt", devices(), {.rays = 70'000, .seed = 3});
  const Statistics& s = report.devices[0].statistics;
  EXPECT_EQ(s.rays, 70'000u);
  EXPECT_GT(s.hits, 35'000u);
  EXPECT_EQ(report.disagreements(), 0u)
      << report.devices[0].failures.front().disagreements.front().text;
  const Scene then = seen_at(scene, 0.5f);
  SceneCheck check(then, devices(), &scene, 0.25f);
  const RaySource source(then, check.reference(), 4);
  std::vector<RayRecord> rays;
  for (std::uint64_t i = 0; i < 2'000; ++i) rays.push_back(source.ray(i).ray);
  std::atomic<int> wrong = 0;
  check.check(rays, [&](const SceneCheck::Checked& ray) {
    wrong += ray.outcomes[0].disagreements.empty() ? 0 : 1;
  });
  EXPECT_GT(wrong, 200);
}

TEST(Verify, ThreadsAndRunsDoNotMatter) {
  const Options options{.rays = 10'000, .seed = 2};
  const Report a = verify(nullptr, "", devices(), options),
               b = verify(nullptr, "", devices(), options);
  const Statistics &x = a.devices[0].statistics, &y = b.devices[0].statistics;
  EXPECT_EQ(x.hits, y.hits);
  EXPECT_EQ(x.worst(), y.worst());
  for (std::size_t k = 0; k < x.kinds.size(); ++k) EXPECT_EQ(x.kinds[k].hits, y.kinds[k].hits);
}

TEST(Verify, TwoQueuesOfADeviceAgreeToTheBit) {
  const Report report =
      verify(nullptr, "", {devices()[0], devices()[0]}, {.rays = 5'000, .seed = 3});
  ASSERT_EQ(report.differences.size(), 1u);
  EXPECT_EQ(report.differences[0].same, 5'000u);
  EXPECT_EQ(report.differences[0].other_t + report.differences[0].other_place, 0u);
}

TEST(Verify, EndsWhenInterrupted) {
  Options options{.rays = 10'000'000};
  options.progress = [](std::uint64_t) { set_interrupt_requested(true); };
  const Report report = verify(nullptr, "", devices(), options);
  set_interrupt_requested(false);
  EXPECT_TRUE(report.interrupted);
  EXPECT_GT(report.devices[0].statistics.rays, 0u);
  EXPECT_LT(report.devices[0].statistics.rays, 1'000'000u);
}

/// A scene of every kind with a hit list that is plain: rays from outside through the middle of
/// things.
class Faults : public testing::Test {
 protected:
  Faults()
      : scene_(torture_scene(5, 0)),
        check_(scene_, devices()),
        comparison_(scene_, check_.reference()) {
    const RaySource source(scene_, check_.reference(), 5);
    std::vector<RayRecord> rays;
    for (std::uint64_t i = 0; i < 4000; ++i) rays.push_back(source.ray(i).ray);
    std::mutex mutex;
    std::map<std::size_t, Answer> ordered;
    check_.check(rays, [&](const SceneCheck::Checked& ray) {
      if (!ray.outcomes[0].disagreements.empty() || !ray.outcomes[0].grazed.empty() ||
          ray.found[0].list.size() < 2 || grazes(ray.expected))
        return;
      const std::lock_guard lock(mutex);
      ordered[ray.ray] = {
          ray.expected, ray.found[0].nearest, {ray.found[0].list.begin(), ray.found[0].list.end()}};
    });
    for (auto& [number, answer] : ordered) answers_.push_back(std::move(answer));
  }

  struct Answer {
    Expected expected;
    PickRecord nearest{};
    std::vector<PickRecord> list;
  };
  /// Whether rounding may change which crossings there are.
  bool grazes(const Expected& expected) const {
    return std::ranges::any_of(expected.hits, [&](const reference::SceneHit& hit) {
      const LocalRay local = comparison_.bounds().local(hit.index, expected.ray);
      return std::holds_alternative<reference::Csg>(*local.primitive) ||
             std::abs(local.value(0)) <= local.bound ||
             reference::comes_within(*local.primitive, local.ray, local.bound);
    });
  }

  /// In how many of the answers that `spoil` applies to (returns true) the fault is found. A fault
  /// may have several names.
  struct Noticed {
    int spoiled = 0, found = 0;
    double share() const { return spoiled == 0 ? 0 : static_cast<double>(found) / spoiled; }
  };
  Noticed notice(const std::vector<Fault>& faults,
                 const std::function<bool(Answer&)>& spoil) const {
    Noticed out;
    for (Answer answer : answers_) {
      if (!spoil(answer)) continue;
      ++out.spoiled;
      const Outcome outcome = comparison_.compare(answer.expected, {answer.nearest, answer.list});
      out.found += std::ranges::any_of(outcome.disagreements, [&](const Disagreement& d) {
        return std::ranges::count(faults, d.fault) > 0;
      });
    }
    EXPECT_GT(out.spoiled, 100);
    return out;
  }

  Scene scene_;
  SceneCheck check_;
  Comparison comparison_;
  std::vector<Answer> answers_;
};

TEST_F(Faults, NoneAreSeenInWhatIsRight) {
  ASSERT_GT(answers_.size(), 500u);
  for (const Answer& answer : answers_)
    EXPECT_TRUE(
        comparison_.compare(answer.expected, {answer.nearest, answer.list}).disagreements.empty());
}

TEST_F(Faults, AMissingCrossingIsNoticed) {
  EXPECT_EQ(notice({Fault::hit}, [](Answer& a) { return a.list.pop_back(), true; }).share(), 1);
}
TEST_F(Faults, AnExtraCrossingIsNoticed) {
  EXPECT_EQ(notice({Fault::hit},
                   [](Answer& a) {
                     a.list.push_back(a.list.back());
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, AMissIsNoticed) {
  EXPECT_EQ(notice({Fault::hit},
                   [](Answer& a) {
                     a.nearest.object = CAPLET_NONE;
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, TheSecondInPlaceOfTheNearestIsNoticed) {
  // Where both are close, either is right.
  EXPECT_GT(notice({Fault::order},
                   [](Answer& a) {
                     a.nearest = a.list[1];
                     return true;
                   })
                .share(),
            0.9);
}
TEST_F(Faults, ANearestHitOnNothingIsNoticed) {
  // But for rays that begin so near to a surface that they are all along within its bound.
  EXPECT_GT(notice({Fault::hit, Fault::order},
                   [](Answer& a) {
                     a.nearest.t *= 0.5f;
                     return true;
                   })
                .share(),
            0.99);
}
TEST_F(Faults, AnotherOrderIsNoticed) {
  EXPECT_EQ(notice({Fault::order},
                   [](Answer& a) {
                     if (a.list[0].t == a.list[1].t) return false;
                     std::swap(a.list[0], a.list[1]);
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, AnotherPrimitiveIsNoticed) {
  EXPECT_EQ(notice({Fault::id, Fault::hit},
                   [](Answer& a) {
                     ++a.list[0].primitive;
                     return true;
                   })
                .share(),
            1);
  EXPECT_EQ(notice({Fault::id},
                   [](Answer& a) {
                     a.nearest.object = 12345678;
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, TheOtherSideIsNoticed) {
  EXPECT_EQ(notice({Fault::side},
                   [](Answer& a) {
                     a.list[0].leaving ^= 1u;
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, AnotherMaterialIsNoticed) {
  EXPECT_EQ(notice({Fault::material},
                   [](Answer& a) {
                     ++a.list[0].material;
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, AnotherSurfaceIsNoticed) {
  const auto spoil = [&](Answer& a) {
    const auto& first = a.expected.hits[0];
    const auto& primitive = check_.reference().placed(first.index).primitive;
    const int count = reference::surface_count(primitive);
    // Opposite faces; caps and sides may go over into each other smoothly, and csg surfaces may lie
    // on each other.
    if (!std::holds_alternative<reference::Box>(primitive)) return false;
    for (PickRecord& pick : a.list)
      if (std::abs(pick.t - first.t) <= 1e-3 * first.t)
        pick.surface = (pick.surface ^ 1u) % static_cast<uint>(count);
    return true;
  };
  EXPECT_GT(notice({Fault::surface}, spoil).share(), 0.95);
}
TEST_F(Faults, AnotherPlaceIsNoticed) {
  // A thousandth of t, where that is far more than the bound: the surfaces of a ray through several
  // things are far apart.
  EXPECT_GT(notice({Fault::t, Fault::order, Fault::hit},
                   [](Answer& a) {
                     for (PickRecord& pick : a.list) pick.t *= 1.001f;
                     return true;
                   })
                .share(),
            0.9);
  EXPECT_EQ(notice({Fault::t, Fault::order},
                   [](Answer& a) {
                     a.list[0].t = NAN;
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, AnotherPointIsNoticed) {
  const auto move = [](Answer& a, float bounds) {
    for (int k = 0; k < 3; ++k)
      a.list[0].point[k] += bounds * a.list[0].error * a.list[0].normal[k];
  };
  // The allowance holds the rounding of the scene beside the point's own error.
  EXPECT_GT(notice({Fault::point}, [&](Answer& a) { return move(a, 50), true; }).share(), 0.95);
  EXPECT_EQ(notice({Fault::point},
                   [](Answer& a) {
                     a.list[0].point[1] = INFINITY;
                     return true;
                   })
                .share(),
            1);
}
TEST_F(Faults, AnotherNormalIsNoticed) {
  EXPECT_GT(notice({Fault::normal},
                   [](Answer& a) {
                     for (float& x : a.list[0].normal) x = -x;
                     return true;
                   })
                .share(),
            0.98);
  EXPECT_GT(notice({Fault::normal},
                   [](Answer& a) {
                     for (float& x : a.list[0].normal) x *= 0.9f;  // no unit vector
                     return true;
                   })
                .share(),
            0.9);
}
// Beside edges too: what counts is the surface that the device names.
TEST_F(Faults, ATiltedNormalIsNoticed) {
  const Noticed noticed = notice({Fault::normal}, [](Answer& a) {
    const glm::vec3 n(a.list[0].normal[0], a.list[0].normal[1], a.list[0].normal[2]);
    const glm::vec3 other = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    const glm::vec3 tilted = glm::normalize(n + 0.01f * glm::normalize(glm::cross(n, other)));
    for (int i = 0; i < 3; ++i) a.list[0].normal[i] = tilted[i];
    return true;
  });
  // On far shapes, and on small patches of molecules, the normal turns as far within the error.
  EXPECT_GT(noticed.share(), 0.85);
}
TEST_F(Faults, AnotherUvIsNoticed) {
  EXPECT_GT(notice({Fault::uv},
                   [](Answer& a) {
                     a.list[0].v += a.list[0].v > 0.5f ? -0.25f : 0.25f;
                     return true;
                   })
                .share(),
            0.9);
}

// Rays so close to the plane of a ring that either side of it is right: between them they pass its
// hole.
TEST(Comparison, TheHoleOfAPartialDiskIsNoDistance) {
  Scene scene;
  scene.materials.emplace_back();
  scene.shapes.emplace_back().geometry = DiskShape{0, 1, 0.9};
  SceneCheck check(scene, devices());
  const Comparison comparison(scene, check.reference());
  const auto crosses_at = [](float x) {
    return RayRecord{.ox = -3,
                     .oy = 0,
                     .oz = 1e-6f * (3 + x),
                     .t_min = 0,
                     .dx = 6,
                     .dy = 0,
                     .dz = -6e-6f,
                     .t_max = HUGE_VALF};
  };
  int compared = 0;
  check.check(std::vector{crosses_at(0.95f)}, [&](const SceneCheck::Checked& ray) {
    ASSERT_EQ(ray.found[0].list.size(), 1u);
    EXPECT_GT(ray.found[0].list[0].point[0], 0.9f);
    const Expected other = comparison.expected(crosses_at(-0.95f));
    ASSERT_EQ(other.hits.size(), 1u);
    const Outcome outcome = comparison.compare(other, ray.found[0]);
    EXPECT_TRUE(outcome.disagreements.empty()) << outcome.disagreements.front().text;
    ASSERT_EQ(outcome.matches.size(), 1u);
    const double off =
        outcome.matches[0].deviations[static_cast<std::size_t>(Quantity::t)].in_bounds;
    EXPECT_NEAR(off, 1.9e-6 / comparison.bounds().local(0, other.ray).bound, 1e-3);
    ++compared;
  });
  EXPECT_EQ(compared, 1);
}

// A patch folded so that its two sides are closer than the bound: which of them the ray meets first
// is for rounding to say.
TEST(Comparison, SidesOfAFoldMayComeInEitherOrder) {
  Scene scene;
  scene.materials.emplace_back();
  BilinearMeshShape fold;
  fold.positions = {{-0.816438556f, -0.479016423f, 0.322445929f},
                    {0.14514336f, 0.508792877f, 0.8485654f},
                    {0.0148992138f, 0.509117723f, 0.860567927f},
                    {0.0253444444f, -0.99760592f, -0.064343393f}};
  fold.patches = {{0, 1, 2, 3}};
  scene.shapes.emplace_back().geometry = fold;
  SceneCheck check(scene, devices());
  const Comparison comparison(scene, check.reference());
  const RayRecord ray = {.ox = 6869.22589f,
                         .oy = -686.688535f,
                         .oz = 10665.8857f,
                         .t_min = 0,
                         .dx = -3729.18791f,
                         .dy = 372.804917f,
                         .dz = -5789.91404f,
                         .t_max = HUGE_VALF};
  int compared = 0;
  check.check(std::vector{ray}, [&](const SceneCheck::Checked& answer) {
    std::vector<PickRecord> list(answer.found[0].list.begin(), answer.found[0].list.end());
    ASSERT_EQ(list.size(), 2u);
    ASSERT_NE(list[0].leaving, list[1].leaving);
    for (int order = 0; order < 2; ++order) {
      const Outcome outcome = comparison.compare(answer.expected, {answer.found[0].nearest, list});
      EXPECT_TRUE(outcome.disagreements.empty()) << outcome.disagreements.front().text;
      EXPECT_EQ(outcome.matches.size(), 2u);
      ++compared;
      std::swap(list[0], list[1]);
      std::swap(list[0].t, list[1].t);
    }
  });
  EXPECT_EQ(compared, 2);
}

// Rays through torture sets on which device and reference once disagreed.
TEST(Verify, KeptRaysAgree) {
  struct KeptRay {
    const char* what;
    std::uint64_t seed, round;
    RayRecord ray;
  };
  const KeptRay kept[] = {{"follows a torus, with three crossings in 1/500 of its size",
                           0,
                           0,
                           {.ox = -0x1.036c4p-4f,
                            .oy = -0x1.c2374ep-4f,
                            .oz = -0x1.944bb2p-5f,
                            .t_min = 0,
                            .dx = -0x1.f10c8p-12f,
                            .dy = 0x1.b77ab8p-11f,
                            .dz = -0x1.24aa08p-12f,
                            .t_max = HUGE_VALF}},
                          {"comes from far to where a torus ends at its axis",
                           0,
                           2,
                           {.ox = 0x1.8cbd32p+27f,
                            .oy = -0x1.de29dcp+27f,
                            .oz = -0x1.f13904p+22f,
                            .t_min = 0,
                            .dx = -0x1.16edecp-6f,
                            .dy = 0x1.502cdep-6f,
                            .dz = 0x1.5d933p-11f,
                            .t_max = HUGE_VALF}}};
  for (const KeptRay& one : kept) {
    const Scene scene = torture_scene(one.seed, one.round);
    SceneCheck check(scene, devices());
    int compared = 0;
    check.check(std::vector{one.ray}, [&](const SceneCheck::Checked& answer) {
      for (const Disagreement& found : answer.outcomes[0].disagreements)
        ADD_FAILURE() << one.what << ": " << found.text;
      ++compared;
    });
    EXPECT_EQ(compared, 1);
  }
}

TEST(Cases, KeepTheBitsOfTheirRays) {
  const auto folder = test::temporary_folder() / "cases";
  Failure failure;
  failure.scene = {"", 3, 4};
  failure.ray = {0.1f, -0.0f, 1e-30f, 0, 0x1.fffffep127f, -3.0000002f, 0x1p-149f, INFINITY};
  failure.disagreements = {{Fault::surface, 1, "what"}};
  Failure of_file = failure;
  of_file.scene = {"some.pbrt"};
  of_file.scene.time = 0.3f;
  save_cases(folder, {failure, of_file});
  const std::vector<Case> cases = load_cases(folder);
  ASSERT_EQ(cases.size(), 2u);
  for (const Case& one : cases)
    EXPECT_EQ(std::memcmp(&one.ray, &failure.ray, sizeof(RayRecord)), 0);
  EXPECT_EQ(cases[0].scene.seed, 3u);
  EXPECT_EQ(cases[0].scene.round, 4u);
  EXPECT_EQ(cases[0].scene.time, 0);
  EXPECT_EQ(cases[1].scene.time, 0.3f);
  EXPECT_EQ(cases[1].scene.file, std::filesystem::absolute("some.pbrt").string());
  EXPECT_EQ(load_cases(folder / "case-00002.json").size(), 1u);
}

TEST(Cases, BadOnesAreRefused) {
  const auto folder = test::temporary_folder();
  const auto refused = [&](const std::string& text) -> std::string {
    const auto file = folder / "case-00001.json";
    std::ofstream(file, std::ios::binary) << text;
    try {
      load_cases(file);
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("case-00001.json"));
      return error.what();
    }
    return "taken";
  };
  const std::string head = R"({"format": "caplet verify case 1", )";
  EXPECT_THAT(refused(""), HasSubstr("not a case"));
  EXPECT_THAT(refused("[1, 2]"), HasSubstr("not a case"));
  EXPECT_THAT(refused(R"({"format": 3})"), HasSubstr("not a case"));
  EXPECT_THAT(refused(head + R"("torture": {"seed": -1.5}})"),
              HasSubstr("seed is a whole number from 0 up, not -1.5"));
  EXPECT_THAT(refused(head + R"("torture": {"seed": 1, "round": "2"}})"),
              HasSubstr("round is a whole number"));
  EXPECT_THAT(refused(head + R"("torture": {"seed": 1}})"), HasSubstr("not a case"));
  EXPECT_THAT(
      refused(head + R"("scene": "a", "ray": {"origin": [1, 2, 1e300], "direction": [0, 0, 1]}})"),
      HasSubstr("finite"));
  EXPECT_THAT(refused(head + R"("scene": 5, "ray": {}})"), HasSubstr("not a case"));
  EXPECT_THAT(
      refused(head + R"("scene": "a", "ray": {"origin": ["1", "2"], "direction": [0, 0, 1]}})"),
      HasSubstr("not a case"));
  EXPECT_THAT(
      refused(head +
              R"("scene": "a", "ray": {"origin": ["1", "2", "x"], "direction": [0, 0, 1]}})"),
      HasSubstr("finite"));
  EXPECT_THAT(
      refused(head +
              R"("scene": "a", "ray": {"origin": ["1", "2", "nan"], "direction": [0, 0, 1]}})"),
      HasSubstr("finite"));
  EXPECT_EQ(
      refused(head +
              R"("scene": "a", "ray": {"origin": ["1", "2", "0x1p-3"], "direction": [0, 0, 1]}})"),
      "taken");
  EXPECT_THROW(load_cases(folder / "none"), InputError);
  EXPECT_THROW(load_cases(test::temporary_folder()), InputError);
}

// The plane through three points turns by more the nearer they lie to a line, whichever side is the
// longest.
TEST(Bounds, TiltOfTrianglesGrowsAsTheirAltitudeShrinks) {
  const auto tilt = [](double height, std::size_t first) {
    const glm::vec3 corners[] = {{0, 0, 0}, {64, 0, 0}, {64, static_cast<float>(height), 0}};
    TriangleMeshShape mesh;
    for (std::size_t i = 0; i < 3; ++i) mesh.positions.push_back(corners[(first + i) % 3]);
    mesh.triangles = {{0, 1, 2}};
    Scene scene;
    scene.materials.emplace_back();
    scene.shapes.emplace_back().geometry = std::move(mesh);
    const reference::SceneReference reference(scene);
    return Bounds(reference).tilt(0);
  };
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    EXPECT_NEAR(tilt(1e-5, first) / tilt(1e-3, first), 100, 1);
    // Corners move by more than a rounding of their numbers, and by less than 128.
    EXPECT_GT(tilt(1e-3, first), 64 * eps / 1e-3);
    EXPECT_LT(tilt(1e-3, first), 128 * 64 * eps / 1e-3);
  }
}

}  // namespace
}  // namespace caplet::verify
